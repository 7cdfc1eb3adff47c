#include "app/document/create.hpp"
#include "engine/mechanism/mass_properties.hpp"
#include "tests/app/document_mechanisms.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using std::numbers::pi;

namespace {

Shape sphere(double radius) {
  Shape shape;
  shape.radius = radius;
  return shape;
}

Shape rod(ShapeType type, double radius, const Vec3& from, const Vec3& to) {
  Shape shape;
  shape.type = type;
  shape.radius = radius;
  shape.from = from;
  shape.to = to;
  return shape;
}

Body with_shapes(std::vector<Shape> shapes) {
  Body body;
  body.name = "body";
  body.shapes = std::move(shapes);
  return body;
}

Mat3 tensor(const Body& body) {
  const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
  Mat3 inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return inertia;
}

void check_near(const Mat3& a, const Mat3& b, double tolerance = 1e-12) {
  CAPTURE(a, b);
  CHECK((a - b).norm() <= tolerance * b.norm());
}

bool is_inside(const Shape& shape, const Body& body, const Vec3& point) {
  const Vec3 from_centre = point - shape.at.value_or(body.position);
  const Vec3 line = shape.to - shape.from;
  const double t = line.dot(point - shape.from) / line.squaredNorm();
  switch (shape.type) {
  case ShapeType::sphere: return from_centre.norm() < shape.radius;
  case ShapeType::box:
    return ((body.rotation.conjugate() * from_centre).cwiseAbs().array() < 0.5 * shape.size.array()).all();
  case ShapeType::cylinder: return t > 0 && t < 1 && (point - shape.from - t * line).norm() < shape.radius;
  case ShapeType::capsule:
    return (point - shape.from - std::min(std::max(t, 0.0), 1.0) * line).norm() < shape.radius;
  }
  return false;
}

// By counting the points of a fine grid; right to about a hundredth.
MassProperties counted(const Body& body, double density, double half, int steps) {
  MassProperties all;
  Mat3 second = Mat3::Zero();
  const double step = 2 * half / steps, mass = density * step * step * step;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j)
      for (int k = 0; k < steps; ++k) {
        const Vec3 p = body.position + step * Vec3(i + 0.5, j + 0.5, k + 0.5) - Vec3::Constant(half);
        for (const Shape& shape : body.shapes)
          if (is_inside(shape, body, p)) {
            all.mass += mass;
            all.centre += mass * p;
            second += mass * p * p.transpose();
          }
      }
  all.centre /= all.mass;
  second -= all.mass * all.centre * all.centre.transpose();
  all.inertia = second.trace() * Mat3::Identity() - second;
  return all;
}

} // namespace

TEST_CASE("a ball, a block, a rod, a plate and a disc have their closed forms") {
  Mechanism m;
  add_body(m, {.form = BodyForm::ball, .at = {1, 2, 3}, .radius = 0.1, .density = 1000});
  const Body& ball = m.bodies[0];
  CHECK(ball.mass == Approx(1000 * 4. / 3 * pi * 0.001).epsilon(1e-14));
  check_near(tensor(ball), 0.4 * ball.mass * 0.01 * Mat3::Identity());
  CHECK(ball.position == Vec3(1, 2, 3));
  CHECK_FALSE(ball.shapes[0].at);

  add_body(m, {.form = BodyForm::block, .size = {0.1, 0.2, 0.4}, .density = 500});
  const Body& block = m.bodies[1];
  CHECK(block.mass == Approx(4).epsilon(1e-14));
  check_near(tensor(block), Vec3(0.2, 0.17, 0.05).asDiagonal().toDenseMatrix() * 4 / 12);

  add_body(m, {.form = BodyForm::rod, .radius = 0.1, .from = {0, 1, 0}, .to = {0, 3, 0}, .density = 100});
  const Body& rod = m.bodies[2];
  CHECK(rod.mass == Approx(100 * pi * 0.01 * 2).epsilon(1e-14));
  CHECK(rod.position == Vec3(0, 2, 0));
  CHECK(rod.rotation.coeffs() == Quat::Identity().coeffs());
  const double across = rod.mass * (4. / 12 + 0.01 / 4), along = rod.mass * 0.01 / 2;
  check_near(tensor(rod), Vec3(across, along, across).asDiagonal());

  add_body(m, {.form = BodyForm::plate, .size = {0.3, 0.01, 0.3}, .density = 1000});
  CHECK(m.bodies[3].inertia[1] == Approx(m.bodies[3].mass * 0.18 / 12).epsilon(1e-14));
  CHECK(m.bodies[3].name == "plate1");

  add_body(m, {.form = BodyForm::disc, .radius = 0.3, .from = {0, 0, 0.02}, .to = {0, 0, -0.02}});
  CHECK(m.bodies[4].name == "disc1");
  CHECK(m.bodies[4].mass == Approx(steel * pi * 0.09 * 0.04).epsilon(1e-14));
  CHECK(m.bodies[4].inertia[2] == Approx(m.bodies[4].mass * 0.045).epsilon(1e-14));
  CHECK(m.bodies[4].position == Vec3::Zero());
}

TEST_CASE("a slanted rod lies along one of its body axes, and has no products of inertia") {
  Mechanism m;
  const Vec3 from(0.1, 0.2, -0.3), to(0.5, -0.7, 0.4);
  add_body(m, {.form = BodyForm::rod, .radius = 0.01, .from = from, .to = to});
  const Body& rod = m.bodies[0];
  CHECK((rod.rotation * -Vec3::UnitY() - (to - from).normalized()).norm() < 1e-15);
  CHECK(rod.inertia[3] == 0);
  CHECK(rod.inertia[4] == 0);
  CHECK(rod.inertia[5] == 0);
  const Vec3 axis = (to - from).normalized();
  const double l2 = (to - from).squaredNorm(), along = 0.0001 / 2, across = l2 / 12 + 0.0001 / 4;
  const Mat3 world = rod.mass * (across * Mat3::Identity() + (along - across) * axis * axis.transpose());
  check_near(mass_properties(rod, steel)->inertia, world);
}

TEST_CASE("a thin cylinder and a thin capsule are a rod, a short capsule is a ball") {
  for (const ShapeType type : {ShapeType::cylinder, ShapeType::capsule}) {
    Body thin = with_shapes({rod(type, 1e-6, {0, 0, 0}, {0, 0, 2})});
    REQUIRE(take_mass_properties(thin, 1e12));
    CHECK(thin.inertia[0] == Approx(thin.mass * 4 / 12).epsilon(1e-5));
    CHECK(thin.inertia[2] < 1e-11 * thin.mass);
  }
  Body ball = with_shapes({rod(ShapeType::capsule, 0.3, {1, 1, 1}, {1, 1, 1})});
  REQUIRE(take_mass_properties(ball, 100));
  check_near(tensor(ball), 0.4 * ball.mass * 0.09 * Mat3::Identity());
  CHECK(ball.position == Vec3(1, 1, 1));
}

TEST_CASE("shapes together are what a count of their points says") {
  Dice dice(5);
  for (int i = 0; i < 4; ++i) {
    Body body;
    body.position = dice.box(1);
    body.rotation = dice.rotation();
    for (int k = 0; k < 2; ++k) {
      Shape shape = rod(static_cast<ShapeType>((i + k) % 4), 0.2, body.position + dice.box(0.3),
                        body.position + dice.box(0.3));
      shape.size = Vec3(0.2, 0.5, 0.3);
      if (k == 1) shape.at = body.position + dice.box(0.3);
      body.shapes.push_back(shape);
    }
    const MassProperties count = counted(body, 1000, 0.8, 80);
    const auto closed = mass_properties(body, 1000);
    REQUIRE(closed);
    CHECK(closed->mass == Approx(count.mass).epsilon(0.01));
    CHECK((closed->centre - count.centre).norm() < 0.002);
    check_near(closed->inertia, count.inertia, 0.015);

    // Taken over, they are the same in body axes, and the shapes stay where they were.
    Body taken = body;
    REQUIRE(take_mass_properties(taken, 1000));
    const Mat3 axes = body.rotation.toRotationMatrix();
    check_near(axes * tensor(taken) * axes.transpose(), closed->inertia);
    CHECK((taken.position - closed->centre).norm() < 1e-15);
    const auto again = mass_properties(taken, 1000);
    check_near(again->inertia, closed->inertia, 1e-9);
    CHECK(density_of(taken) == Approx(1000).epsilon(1e-12));
  }
}

TEST_CASE("what has no volume has no mass properties") {
  Body none;
  none.mass = 3;
  CHECK_FALSE(mass_properties(none, steel));
  CHECK_FALSE(density_of(none));
  CHECK_FALSE(take_mass_properties(none, steel));
  CHECK(none.mass == 3);
  Body flat = with_shapes({sphere(0)});
  const Body before = flat;
  CHECK_FALSE(take_mass_properties(flat, steel));
  Body endless = with_shapes({sphere(1e200)});
  CHECK_FALSE(take_mass_properties(endless, steel));
  CHECK(flat == before);
}
