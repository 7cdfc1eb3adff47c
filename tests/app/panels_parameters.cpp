// Parameters and expressions by mouse and keys.
#include "desk.hpp"

#include "app/document/formula_edits.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("an expression is typed where a number is, and a number over it") {
  Desk d("governor_parametric");
  d.build();
  d.pick(PartKind::body, "spindle");
  d.enter("inspector/mass", "=100*m + 50 kg");
  CHECK(d.m().bodies[0].mass == 150);
  CHECK(formula_at(d.m(), "bodies.spindle.mass") == "100*m + 50 kg");
  const std::size_t steps = d.app.document.position();
  SECTION("it is shown for typing, and stays as it is when nothing is changed") {
    d.frames(60);
    d.click("inspector/mass");
    CHECK(d.app.inspector.typing.text == "=100*m + 50 kg");
    d.key(key_escape);
    d.frames(2);
    CHECK(d.app.document.position() == steps);
  }
  SECTION("a number takes its place in one step") {
    d.enter("inspector/mass", "120");
    CHECK(d.m().bodies[0].mass == 120);
    CHECK_FALSE(formula_at(d.m(), "bodies.spindle.mass"));
    CHECK(d.app.document.position() == steps + 1);
    d.key('Z', true);
    CHECK(formula_at(d.m(), "bodies.spindle.mass") == "100*m + 50 kg");
  }
  SECTION("what is wrong with it is said in its place") {
    d.frames(60);
    d.click("inspector/mass");
    d.type("=L");
    d.frames(1);
    CHECK(d.app.inspector.typing.mistake.find("expected kg, found m") != std::string::npos);
    d.key(key_escape);
  }
}

TEST_CASE("a number is named in one gesture") {
  Desk d;
  d.pick(PartKind::body, "ball1");
  d.click(ImVec2(d.widget("inspector/mass").from.x + 10, d.widget("inspector/mass").from.y + 8), 1);
  d.frames(2);
  d.click("inspector/mass/name it");
  d.frames(2);
  CHECK(formula_at(d.m(), "bodies.ball1.mass") == "mass");
  CHECK(get_parameter(d.m(), "parameters.mass") == 1);
  CHECK(parameter_unit(d.m(), "parameters.mass") == "kg");
  // With a slider, which moves what it gives.
  d.enter("parameters/parameters.mass/value", "3");
  CHECK(d.m().bodies[1].mass == 3);
  CHECK(d.app.document.stored().bodies[1].mass == 1);
}

TEST_CASE("the list of parameters and points") {
  Desk d("governor_parametric");
  d.build();
  select(d.app, {});
  d.frames(2);
  d.enter("inspector/parameter/L/name", "arm");
  CHECK(formula_at(d.m(), "parameters.c") == "arm/2");
  d.enter("inspector/parameter/c", "=arm/2 + 1 mm");
  CHECK(std::abs(get_parameter(d.m(), "parameters.c") - 0.081) < 1e-15);
  d.click("inspector/parameters/add");
  d.frames(2);
  CHECK(parameter_index(d.m(), "p") >= 0);
  d.click("inspector/parameter/k/more");
  d.frames(2);
  d.enter("inspector/parameter/k/to", "8000");
  CHECK((*d.m().parameters[5].range)[1] == 8000);
  d.click("inspector/parameter/k/remove");
  d.frames(2);
  CHECK(parameter_index(d.m(), "k") < 0);
  CHECK(d.m().joints[3].coordinates[0].spring->stiffness == 1000);
  CHECK_FALSE(formula_at(d.m(), "joints.slide.spring.stiffness"));
}

TEST_CASE("a slider that asks for what cannot be made says so and stays") {
  Desk d("governor_parametric");
  d.enter("parameters/parameters.L/value", "0.4");
  CHECK(d.app.notice.find("the value is not finite") != std::string::npos);
  CHECK(d.m() == d.app.document.stored());
}
