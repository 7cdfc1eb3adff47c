// A body's rotation by three turns, and expressions of these kept as expressions of the quaternion.
#include "app/document/copies.hpp"
#include "app/document/document.hpp"
#include "app/document/formula_edits.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/transform.hpp"
#include "app/document/turns.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

using namespace flyball;

namespace {

constexpr double degree = std::numbers::pi / 180;

// A box with parameters a and b, angles.
Mechanism box() {
  Mechanism m = Document::empty_mechanism();
  for (const auto& [name, value] : {std::pair("a", 0.7), std::pair("b", -0.4)}) {
    NamedParameter parameter;
    parameter.name = name;
    parameter.value = value;
    parameter.unit = "rad";
    m.parameters.push_back(parameter);
  }
  Body body;
  body.name = "box";
  body.mass = 1;
  body.inertia = {1, 1, 1};
  Shape shape;
  shape.type = ShapeType::box;
  shape.size = {0.1, 0.2, 0.3};
  body.shapes.push_back(shape);
  m.bodies.push_back(body);
  Joint joint;
  joint.name = "hinge";
  joint.bodies = {"ground", "box"};
  joint.coordinates.resize(1);
  m.joints.push_back(joint);
  return m;
}

// Of two rotations, whatever sign the quaternions have.
double between(const Quat& a, const Quat& b) {
  return 1 - std::abs(a.dot(b));
}

} // namespace

TEST_CASE("turns by expressions are quaternions by expressions, and are read back from them") {
  std::mt19937 random(20);
  const std::array<std::string, 6> texts{"", "", "a", "2*b - a", "30 deg", "(a + b)/3"};
  std::uniform_real_distribution<double> angle(-170, 170);
  const auto value_of = [](const Mechanism& m, const std::string& text) {
    return evaluate_expression(m, text, "rad", "") / degree;
  };
  for (int run = 0; run < 200; ++run) {
    Mechanism m = box();
    Turns turns;
    for (std::size_t i = 0; i < 3; ++i) {
      turns.texts[i] = texts[std::uniform_int_distribution<std::size_t>(0, texts.size() - 1)(random)];
      if (turns.texts[i].empty() && random() % 2 == 0) turns.angles[static_cast<int>(i)] = angle(random);
    }
    set_turns(m.bodies[0], turns);
    evaluate_formulas(m);
    for (const double a : {0.7, -2.0}) {
      set_parameter(m, "parameters.a", a);
      Vec3 angles = turns.angles;
      for (std::size_t i = 0; i < 3; ++i)
        if (!turns.texts[i].empty()) angles[static_cast<int>(i)] = value_of(m, turns.texts[i]);
      CAPTURE(turns.texts[0], turns.texts[1], turns.texts[2], angles.transpose());
      REQUIRE(between(m.bodies[0].rotation, rotation_by(angles)) < 1e-14);
      REQUIRE(std::abs(m.bodies[0].rotation.norm() - 1) < 1e-14);
      const std::optional<Turns> read = given_turns(m, m.bodies[0]);
      REQUIRE(read.has_value() == is_rotation_given(m.bodies[0]));
      if (!read) continue;
      REQUIRE(read->texts == turns.texts);
      REQUIRE((read->angles - angles).norm() < 1e-11);
    }
    REQUIRE(read_scene(write_scene(m)) == m);
  }
}

TEST_CASE("a quaternion that was written by hand is one of turns, or is not") {
  Mechanism m = box();
  set_expression(m, "bodies.box.rotation.0", "cos(a / 2)");
  CHECK_FALSE(given_turns(m, m.bodies[0])); // no rotation yet
  m.bodies[0].formulas.push_back({"rotation.3", "sin( a/2 )"});
  evaluate_formulas(m);
  REQUIRE(given_turns(m, m.bodies[0]));
  CHECK(expression_at(m, "bodies.box.turn.2") == "a");
  CHECK_FALSE(expression_at(m, "bodies.box.turn.0"));
  CHECK(std::abs(expressed_value(m, "bodies.box.turn.2") - 0.7) < 1e-15);

  m.bodies[0].formulas = {{"rotation.0", "sqrt(1 - a^2)"}, {"rotation.1", "a"}};
  evaluate_formulas(m);
  CHECK(is_rotation_given(m.bodies[0]));
  CHECK_FALSE(given_turns(m, m.bodies[0]));
  // A turn that is set takes the place of all of them, and the others stay as they are.
  const Vec3 before = turns_of(m.bodies[0].rotation);
  set_by_itself(m, "bodies.box.turn.1", 10 * degree);
  CHECK_FALSE(is_rotation_given(m.bodies[0]));
  CHECK(between(m.bodies[0].rotation, rotation_by({before.x(), 10, before.z()})) < 1e-14);
}

TEST_CASE("a turn is named, renamed, taken off and removed") {
  Mechanism m = box();
  set_turns(m.bodies[0], {{10, 0, 50}, {}});
  name_number(m, "bodies.box.turn.2", "phi");
  CHECK(std::abs(get_parameter(m, "parameters.phi") - 50 * degree) < 1e-12);
  CHECK(parameter_unit(m, "parameters.phi") == "rad");
  CHECK(expression_at(m, "bodies.box.turn.2") == "phi");
  CHECK(between(m.bodies[0].rotation, rotation_by({10, 0, 50})) < 1e-14);
  rename_parameter(m, "phi", "tilt");
  CHECK(expression_at(m, "bodies.box.turn.2") == "tilt");
  const Quat there = m.bodies[0].rotation;
  SECTION("off") {
    set_expression(m, "bodies.box.turn.2", "");
    CHECK_FALSE(is_rotation_given(m.bodies[0]));
  }
  SECTION("away") {
    set_expression(m, "bodies.box.turn.0", "a");
    set_parameter(m, "parameters.a", 10 * degree);
    remove_parameter(m, "tilt");
    CHECK_FALSE(is_rotation_given(m.bodies[0]));
  }
  CHECK(between(m.bodies[0].rotation, there) < 1e-14);
  // What has no angle is refused in its own words.
  m.parameters[0].unit = "m";
  try {
    set_expression(m, "bodies.box.turn.0", "a");
    FAIL("taken");
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()).find("\"=a\"") != std::string::npos);
  }
}

TEST_CASE("turning a body by hand changes the parameter that turns it, where that can be") {
  Mechanism m = box();
  set_expression(m, "bodies.box.turn.2", "a");
  Document document(m);
  const auto turn = [&](const Vec3& axis) {
    Mechanism next = document.stored();
    rotate_parts(next, {{{PartKind::body, "box"}}}, Vec3::Zero(), Quat(Eigen::AngleAxisd(0.2, axis)));
    document.edit("Turn", std::move(next), {});
  };
  turn(Vec3::UnitZ());
  CHECK(std::abs(get_parameter(document.stored(), "parameters.a") - 0.9) < 1e-10);
  CHECK_THROWS_AS(turn(Vec3::UnitX()), SceneError);
}

TEST_CASE("copies keep the expressions of a rotation all or none") {
  Mechanism m = box();
  set_expression(m, "bodies.box.turn.2", "a");
  Document document(m);
  const auto copy = [&](const std::function<Selection(Mechanism&, const Selection&)>& act) {
    Mechanism next = document.stored();
    Selection copies = act(next, {{{PartKind::body, "box"}}});
    document.edit("Copy", std::move(next), copies);
    return document.stored()
        .bodies[static_cast<std::size_t>(body_index(document.stored(), copies.parts.at(0).name))];
  };
  const Body same = copy([](Mechanism& next, const Selection& selection) {
    return duplicate_parts(next, selection, Vec3(0.5, 0, 0));
  });
  CHECK(given_turns(document.stored(), same));
  const Body mirrored = copy([](Mechanism& next, const Selection& selection) {
    return mirror_parts(next, selection, Vec3(1, 0, 0), Vec3::UnitX());
  });
  CHECK_FALSE(is_rotation_given(mirrored));
  document.edit_number("a", "parameters.a", 1.1);
  for (const Body& body : document.stored().bodies)
    CHECK(std::abs(body.rotation.norm() - 1) < 1e-14);
}

TEST_CASE("a shape's numbers are given, named and set as others are") {
  Mechanism m = box();
  name_number(m, "bodies.box.shapes.0.size.1", "width");
  CHECK(parameter_unit(m, "parameters.width") == "m");
  set_parameter(m, "parameters.width", 0.25);
  CHECK(m.bodies[0].shapes[0].size.y() == 0.25);
  // A shape that stands where its body does stands by itself once a coordinate is given.
  m.bodies[0].position = {1, 2, 3};
  set_expression(m, "bodies.box.shapes.0.at.1", "2*width");
  REQUIRE(m.bodies[0].shapes[0].at);
  CHECK(*m.bodies[0].shapes[0].at == Vec3(1, 0.5, 3));
  name_place(m, "bodies.box.shapes.0.at", "A");
  CHECK(formula_at(m, "points.A.1") == "2*width");
  CHECK(formula_at(m, "bodies.box.shapes.0.at.0") == "A.x");
  set_by_itself(m, "bodies.box.shapes.0.size.1", 0.4);
  CHECK_FALSE(formula_at(m, "bodies.box.shapes.0.size.1"));
  CHECK(m.bodies[0].shapes[0].size.y() == 0.4);
  CHECK_THROWS_AS(set_expression(m, "bodies.box.shapes.0.radius", "width"), SceneError); // of a box
  CHECK_THROWS_AS(set_expression(m, "bodies.box.shapes.1.size.0", "width"), SceneError);
}
