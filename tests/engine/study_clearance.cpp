// Distances of convex solids against closed forms, against bounds from both sides that share nothing with the
// program, and their rates against differences.
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/report/measures.hpp"
#include "tests/catch.hpp"
#include "tests/engine/dynamics_runs.hpp"
#include "tests/support/dice.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

ConvexSolid ball(const Vec3& centre, double radius) {
  return {.centre = centre, .radius = radius};
}
ConvexSolid rod_solid(const Vec3& from, const Vec3& to, double radius) {
  ConvexSolid s = ball(0.5 * (from + to), radius);
  s.half_edges[0] = 0.5 * (to - from);
  return s;
}
ConvexSolid block(const Vec3& centre, const Vec3& size) {
  ConvexSolid s = ball(centre, 0);
  for (int i = 0; i < 3; ++i)
    s.half_edges[static_cast<std::size_t>(i)] = 0.5 * size[i] * Vec3::Unit(i);
  return s;
}
ConvexSolid drum(const Vec3& from, const Vec3& to, double radius) {
  ConvexSolid s = rod_solid(from, to, 0);
  s.disc = radius;
  return s;
}

ConvexSolid moved(ConvexSolid s, const Quat& turn, const Vec3& shift) {
  s.centre = turn * s.centre + shift;
  for (Vec3& edge : s.half_edges)
    edge = turn * edge;
  return s;
}

enum class Kind { ball, rod, block, drum };
ConvexSolid random_solid(Dice& dice, Kind kind, double spread) {
  ConvexSolid s;
  const auto size = [&] { return dice.decade(-1.5, 0.3); };
  if (kind == Kind::ball) s = ball(Vec3::Zero(), size());
  if (kind == Kind::rod) s = rod_solid(Vec3(0, 0, size()), Vec3::Zero(), size());
  if (kind == Kind::block) s = block(Vec3::Zero(), Vec3(size(), size(), size()));
  if (kind == Kind::drum) s = drum(Vec3(0, 0, size()), Vec3::Zero(), size());
  return moved(s, dice.chance(0.3) ? Quat::Identity() : dice.rotation(), dice.box(spread));
}

// How far the solid reaches in a direction (its support function).
double reach(const ConvexSolid& s, const Vec3& n) {
  double sum = n.dot(s.centre) + s.radius * n.norm();
  for (const Vec3& edge : s.half_edges)
    sum += std::abs(n.dot(edge));
  if (s.disc == 0) return sum;
  return sum + s.disc * n.cross(s.half_edges[0].normalized()).norm();
}

// The point of the core that is nearest to x.
Vec3 nearest_in(const ConvexSolid& s, const Vec3& x) {
  Vec3 rest = x - s.centre, out = s.centre;
  for (const Vec3& edge : s.half_edges) {
    if (edge.isZero(0)) continue;
    const double part = rest.dot(edge) / edge.squaredNorm();
    rest -= part * edge;
    out += std::clamp(part, -1., 1.) * edge;
  }
  if (s.disc > 0 && rest.norm() > 0) out += rest * std::min(1., s.disc / rest.norm());
  return out;
}

// By projections to and fro, accelerated (Nesterov, started again where it overshoots): from above.
double by_projections(const ConvexSolid& a, const ConvexSolid& b) {
  Vec3 x = nearest_in(a, b.centre), ahead = x;
  double t = 1, last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4000; ++i) {
    const Vec3 next = nearest_in(a, nearest_in(b, ahead));
    const double now = (next - nearest_in(b, next)).norm();
    const double grown = now > last ? 1 : (1 + std::sqrt(1 + 4 * t * t)) / 2;
    ahead = now > last ? next : Vec3(next + (t - 1) / grown * (next - x));
    x = next;
    t = grown;
    last = now;
  }
  return (x - nearest_in(b, x)).norm() - a.radius - b.radius;
}

const std::vector<Kind> kinds{Kind::ball, Kind::rod, Kind::block, Kind::drum};

} // namespace

TEST_CASE("distances of all pairs of solids are those of closed forms", "[clearance]") {
  struct Case {
    std::string what;
    ConvexSolid a, b;
    double gap;
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), o = Vec3::Zero();
  const double root2 = std::sqrt(2.);
  const std::vector<Case> cases{
      {"balls", ball(o, 0.5), ball(3 * x, 1), 1.5},
      {"balls that overlap", ball(o, 0.5), ball(x, 0.75), -0.25},
      {"balls in one another", ball(o, 0.5), ball(o, 0.75), -1.25},
      {"ball beside a rod", ball(o, 0.5), rod_solid(2 * x - z, 2 * x + z, 0.25), 1.25},
      {"ball beyond a rod's end", ball(o, 0.5), rod_solid(3 * x + 4 * z, 3 * x + 9 * z, 0.25), 4.25},
      {"ball over a face", ball(3 * z, 0.5), block(o, Vec3(2, 4, 2)), 1.5},
      {"ball off a corner", ball(Vec3(2, 3, 2), 0.5), block(o, Vec3(2, 4, 2)), std::sqrt(3.) - 0.5},
      {"ball within a block", ball(Vec3(0.1, 0.2, 0.7), 0.5), block(o, Vec3(2, 4, 2)), -0.8},
      {"ball beside a drum", ball(3 * x, 0.5), drum(-z, z, 1), 1.5},
      {"ball over a drum", ball(0.5 * x + 3 * z, 0.5), drum(-z, z, 1), 1.5},
      {"ball off a rim", ball(4 * x + 5 * z, 0.5), drum(-z, z, 1), 4.5},
      {"ball within a drum", ball(0.75 * x, 0.5), drum(-z, z, 1), -0.75},
      {"ball on a drum's axis", ball(0.75 * z, 0.5), drum(-z, z, 1), -0.75},
      {"rods that cross", rod_solid(-x, x, 0.25), rod_solid(2 * z - y, 2 * z + y, 0.5), 1.25},
      {"rods side by side", rod_solid(-x, x, 0.25), rod_solid(2 * z - 3 * x, 2 * z, 0.5), 1.25},
      {"rods in line", rod_solid(-x, x, 0.25), rod_solid(3 * x, 4 * x, 0.5), 1.25},
      {"rods through one another", rod_solid(-x, x, 0.25), rod_solid(-y, y, 0.5), -0.75},
      {"rods within one another", rod_solid(-x, x, 0.25), rod_solid(o, 2 * x, 0.5), -0.75},
      {"rod across an edge", rod_solid(Vec3(3, -1, -4), Vec3(-1, 3, 4), 0.25), block(o, Vec3(1, 1, 1)),
       root2 / 2 - 0.25},
      {"rod along a face", rod_solid(2 * x, 2 * x + 5 * z, 0.25), block(o, Vec3(2, 2, 2)), 0.75},
      {"rod within a block", rod_solid(-0.5 * x, 0.5 * x, 0.25), block(o, Vec3(4, 3, 2)), -1.25},
      {"rod beside a drum", rod_solid(2 * x - z, 2 * x + z, 0.25), drum(-z, z, 1), 0.75},
      {"rod over a drum", rod_solid(2 * z - 5 * x, 2 * z + 5 * x, 0.25), drum(-z, z, 1), 0.75},
      {"blocks face to face", block(o, Vec3(2, 2, 2)), block(Vec3(3, 0.5, 0.25), Vec3(1, 3, 1)), 1.5},
      {"blocks edge to edge", block(o, Vec3(2, 2, 2)), block(Vec3(3, 3, 0.5), Vec3(2, 2, 2)), root2},
      {"blocks corner to corner", block(o, Vec3(2, 2, 2)), block(Vec3(3, 3, 3), Vec3(2, 2, 2)),
       std::sqrt(3.)},
      {"blocks that touch", block(o, Vec3(2, 2, 2)), block(Vec3(2, 0.5, 0), Vec3(2, 2, 2)), 0},
      {"blocks that overlap", block(o, Vec3(2, 2, 2)), block(Vec3(1.75, 0.5, 1), Vec3(2, 2, 2)), -0.25},
      {"edges that cross",
       moved(block(o, Vec3(2, 2, 2)), Quat(Eigen::AngleAxisd(std::numbers::pi / 4, x)), o),
       moved(block(o, Vec3(2, 2, 2)), Quat(Eigen::AngleAxisd(std::numbers::pi / 4, y)), 3 * z),
       3 - 2 * root2},
      {"edges that cross and overlap",
       moved(block(o, Vec3(2, 2, 2)), Quat(Eigen::AngleAxisd(std::numbers::pi / 4, x)), o),
       moved(block(o, Vec3(2, 2, 2)), Quat(Eigen::AngleAxisd(std::numbers::pi / 4, y)), 2.8 * z),
       2.8 - 2 * root2},
      {"block on a drum", block(3 * z, Vec3(1, 1, 2)), drum(-z, z, 1), 1},
      {"block that stands on a drum", block(2 * z, Vec3(1, 1, 2)), drum(-z, z, 1), 0},
      {"block beside a drum", block(4 * x, Vec3(2, 1, 1)), drum(-z, z, 1), 2},
      {"corner off a rim", block(Vec3(5, 0, 6), Vec3(2, 2, 2)), drum(-z, z, 1), 5},
      {"drums side by side", drum(-z, z, 1), drum(4 * x - 2 * z, 4 * x, 0.5), 2.5},
      {"drums in line", drum(-z, z, 1), drum(4 * z, 6 * z, 0.5), 3},
      {"drums that cross", drum(-z, z, 1), drum(4 * x - 2 * y, 4 * x + 2 * y, 0.5), 2.5},
      {"rim to rim", drum(-z, z, 1), drum(Vec3(4.5, 0, 5), Vec3(4.5, 0, 6), 0.5), 5},
      {"end to side", drum(-z, z, 1), drum(3 * x, 5 * x, 0.5), 2}};
  Dice dice(3);
  for (const Case& each : cases)
    for (int i = 0; i < 40; ++i) {
      const Quat turn = i == 0 ? Quat::Identity() : dice.rotation();
      const Vec3 shift = i == 0 ? o : dice.box(3);
      const ConvexSolid a = moved(each.a, turn, shift), b = moved(each.b, turn, shift);
      CAPTURE(each.what, i);
      for (const bool round : {false, true}) {
        const ConvexDistance found = round ? find_distance(b, a) : find_distance(a, b);
        CAPTURE(found.gap, found.error);
        CHECK(std::abs(found.gap - each.gap) <= found.error);
        CHECK(found.error < 1e-12);
        CHECK(std::abs(found.normal.dot(found.b - found.a) - a.radius - b.radius - found.gap) < 1e-13);
      }
    }
}

TEST_CASE("distances lie between bounds that share nothing with them", "[clearance]") {
  Dice dice(17);
  int apart = 0, within = 0, unknown = 0;
  for (const Kind first : kinds)
    for (const Kind second : kinds)
      for (int i = 0; i < 120; ++i) {
        const double spread = i % 3 == 0 ? 0.5 : 2;
        const ConvexSolid a = random_solid(dice, first, spread), b = random_solid(dice, second, spread);
        const ConvexDistance found = find_distance(a, b);
        CAPTURE(static_cast<int>(first), static_cast<int>(second), i, found.gap, found.error);
        const double core = by_projections(a, b) + a.radius + b.radius; // of the cores
        if (std::isnan(found.gap)) {
          CHECK(core < 1e-9);
          CHECK((first == Kind::drum || second == Kind::drum));
          ++unknown;
          continue;
        }
        CHECK(found.error < 1e-12);
        CHECK(std::abs(found.normal.norm() - 1) < 1e-14);
        // The plane between them: no point of either is beyond it. Where they overlap it is the depth itself.
        const double below = -reach(b, -found.normal) - reach(a, found.normal);
        CHECK(below >= found.gap - found.error);
        CHECK((nearest_in(a, found.a) - found.a).norm() < 1e-13);
        CHECK((nearest_in(b, found.b) - found.b).norm() < 1e-13);
        if (found.gap + a.radius + b.radius > 0) {
          CHECK(core - a.radius - b.radius >= found.gap - found.error);
          CHECK(core - a.radius - b.radius <= found.gap + 1e-7);
          ++apart;
        } else { // no other way out is shorter
          CHECK(core < 1e-7);
          for (int k = 0; k < 500; ++k) {
            const Vec3 n = dice.direction();
            CHECK(reach(b, -n) + reach(a, n) >= -found.gap - found.error);
          }
          ++within;
        }
      }
  CHECK(apart > 1000);
  CHECK(within > 20);
  CHECK(unknown > 10);
}

TEST_CASE("sizes far apart, and solids that nearly touch, keep their digits", "[clearance]") {
  Dice dice(5);
  for (const double scale : {1e-6, 1., 1e6})
    for (const double gap : {1e-3, 1e-7, 1e-11})
      for (int i = 0; i < 50; ++i) {
        const Quat turn = dice.rotation();
        const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
        const std::array<ConvexSolid, 2> pairs[]{
            {block(Vec3::Zero(), Vec3(2, 2, 2)), block(Vec3(0.3, 0.1, 2 + gap), Vec3(2, 2, 2))},
            {block(Vec3::Zero(), Vec3(2, 2, 2)), drum((1 + gap) * z, 3 * z, 0.5)},
            {drum(-z, z, 1), drum((2 + gap) * x - z, (2 + gap) * x + z, 1)},
            {drum(-z, z, 1), rod_solid((1 + gap) * z - x, (1 + gap) * z + x, 0)}};
        for (const auto& [a, b] : pairs) {
          const auto scaled = [&](ConvexSolid s) {
            s = moved(s, turn, Vec3::Zero());
            s.centre *= scale;
            for (Vec3& edge : s.half_edges)
              edge *= scale;
            s.disc *= scale;
            return s;
          };
          const ConvexDistance found = find_distance(scaled(a), scaled(b));
          CAPTURE(scale, gap, i, found.gap, found.error);
          CHECK(std::abs(found.gap - gap * scale) <= found.error);
          CHECK(found.error < 1e-12 * scale);
        }
      }
}

TEST_CASE("of sizes whose squares have no digits there is no distance", "[clearance]") {
  for (const double size : {1e-300, 1e-160, 1e160, 1e300}) {
    const Vec3 x(size, 0, 0);
    CHECK_FALSE(std::isfinite(find_distance(drum(-x, x, size), drum(2 * x, 3 * x, size)).gap));
    CHECK_FALSE(std::isfinite(find_distance(ball(-x, size), block(4 * x, Vec3::Constant(size))).gap));
  }
}

namespace {

Shape random_shape(Dice& dice, ShapeType type, const Vec3& near) {
  Shape s;
  s.type = type;
  s.radius = dice.between(0.1, 0.4);
  s.size = Vec3(0.3, 0.3, 0.3) + 0.5 * dice.box(0.5);
  s.from = near + dice.box(0.3);
  s.to = s.from + 0.8 * dice.direction();
  s.at = near + dice.box(0.3);
  return s;
}

// Two bodies on joints that let them go anywhere, with a shape each.
Mechanism two_bodies(Dice& dice, ShapeType one, ShapeType other) {
  Mechanism m;
  m.name = "two";
  m.bodies = {body("one", 1, dice.box(0.3), Vec3::Constant(0.1)),
              body("other", 1, Vec3(2, 0, 0) + dice.box(0.3), Vec3::Constant(0.1))};
  for (Body& each : m.bodies)
    each.rotation = dice.rotation();
  m.bodies[0].shapes = {random_shape(dice, one, m.bodies[0].position)};
  m.bodies[1].shapes = {random_shape(dice, other, m.bodies[1].position)};
  m.joints = {revolute("turn", "ground", "one", dice.box(1), dice.direction()),
              joint(JointType::spherical, "ball", "one", "other", Vec3(1, 0, 0) + dice.box(0.3)),
              prismatic("slide", "ground", "spare", Vec3::Zero(), dice.direction())};
  m.bodies.push_back(body("spare", 1, Vec3(5, 0, 0), Vec3::Constant(0.1)));
  m.measures = {{"gap", "", "clearance(one, other)", "m"}};
  return m;
}

} // namespace

TEST_CASE("rates of clearances along coordinates and with numbers agree with differences", "[clearance]") {
  Dice dice(23);
  int compared = 0;
  for (int i = 0; i < 160; ++i) {
    const auto one = static_cast<ShapeType>(i % 4), other = static_cast<ShapeType>(i / 4 % 4);
    Mechanism m = two_bodies(dice, one, other);
    // One parameter moves every number of both shapes.
    m.parameters = {{"p", "", 0, "m", std::nullopt, {}}};
    for (Body& each : {std::ref(m.bodies[0]), std::ref(m.bodies[1])}) {
      Shape& shape = each.shapes[0];
      const auto follow = [&](const std::string& key, double value) {
        shape.formulas.push_back(
            {key, std::to_string(value) + " m + p*" + std::to_string(dice.between(0, 1))});
      };
      if (shape.type != ShapeType::box) follow("radius", shape.radius);
      for (int k = 0; k < 3; ++k) {
        const std::string axis = "." + std::to_string(k);
        if (shape.type == ShapeType::box) follow("size" + axis, shape.size[k]);
        if (shape.type == ShapeType::box || shape.type == ShapeType::sphere)
          follow("at" + axis, (*shape.at)[k]);
        if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule) {
          follow("from" + axis, shape.from[k]);
          follow("to" + axis, shape.to[k]);
        }
      }
    }
    evaluate_formulas(m);
    const System system = compile(m);
    Parameters p;
    Scaling scaling;
    bind(system, m, p);
    set_scaling(system, p, scaling);
    const Problem problem{system, p, scaling};
    Eigen::VectorXd q, step(system.nv);
    drawn_configuration(system, p, q);
    for (Eigen::Index v = 0; v < step.size(); ++v)
      step[v] = dice.between(-0.3, 0.3);
    retract<double>(system, step, q);
    MeasureSet measures;
    measures.bind(m, system, p);
    Workspace w, beside;
    const double gap = measures.evaluate_at(problem, q, w)[0];
    if (!std::isfinite(gap)) continue;
    // Where the nearest points change places within the differences there is no rate: none may be near.
    const auto differences = [&](const auto& at, double h) {
      const double near = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
      const double far = (8 * (at(3 * h) - at(-3 * h)) - (at(6 * h) - at(-6 * h))) / (36 * h);
      return std::abs(near - far) < 1e-7 ? near : std::numeric_limits<double>::quiet_NaN();
    };
    // Points on curved surfaces are known to the root of what distances are.
    const bool curved = one == ShapeType::cylinder || other == ShapeType::cylinder;
    const double tolerance = curved ? 1e-6 : 2e-9;
    CAPTURE(i, gap);
    const Eigen::MatrixXd rates = measures.gradient(problem, q, w, beside);
    for (Eigen::Index v = 0; v < system.nv; ++v) {
      const double expected = differences(
          [&](double h) {
            Eigen::VectorXd there = q;
            retract<double>(system, Eigen::VectorXd::Unit(system.nv, v) * h, there);
            return measures.evaluate_at(problem, there, beside)[0];
          },
          1e-4);
      if (!std::isfinite(expected)) continue;
      CHECK(std::abs(rates(0, v) - expected) < tolerance);
      ++compared;
    }
    const std::vector<std::string> address{"parameters.p"};
    const std::vector<Eigen::VectorXd> still{Eigen::VectorXd::Zero(system.nv)};
    const double by_number = measures.rates_along(problem, m, address, q, still, w)(0, 0);
    const double expected = differences(
        [&](double h) {
          Mechanism there = m;
          set_parameter(there, "parameters.p", h);
          Parameters numbers;
          bind(system, there, numbers);
          MeasureSet set;
          set.bind(there, system, numbers);
          return set.evaluate_at({system, numbers, scaling}, q, beside)[0];
        },
        1e-4);
    if (!std::isfinite(expected)) continue;
    CHECK(std::abs(by_number - expected) < tolerance);
    ++compared;
  }
  CHECK(compared > 600);
}

TEST_CASE("where a cylinder is within a box the clearance says that its depth is not known", "[clearance]") {
  Dice dice(2);
  Mechanism m = two_bodies(dice, ShapeType::box, ShapeType::cylinder);
  m.bodies[1].shapes[0].from = m.bodies[0].position;
  m.bodies[0].shapes[0].at = m.bodies[0].position;
  for (Joint& each : m.joints)
    each.type = JointType::fixed, each.coordinates.clear();
  const Solution s = solve(m);
  REQUIRE(s.measures.size() == 1);
  CHECK_FALSE(s.measures[0].value.has_value());
  CHECK_THAT(s.measures[0].reason, ContainsSubstring("how deep"));
  m.bodies[1].shapes[0].type = ShapeType::capsule;
  CHECK(solve(m).measures[0].value.value_or(0) < -0.05);
}
