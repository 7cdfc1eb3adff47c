// Laws of drives by the angle of a joint: its whole turns count where the law tells them apart, and only
// there.
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

TEST_CASE("whole turns of an angle count that a law asks for", "[torque][places][turns]") {
  // w = 5 - a / 10, and the pendulum's balance by it.
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("h", 1, {0, 0, 0}, {0.3, 0.4, 0.3}), body("b", 1, {0.1, -0.3, 0}, {0.001, 0.001, 0.001})};
  m.joints = {driven(revolute("spin", "ground", "h", {0, 0, 0}, {0, 1, 0}), 5),
              dampened(revolute("a", "h", "b", {0.05, 0, 0}, {0, 0, 1}), 0.2)};
  m = with_torque(m, "5 N m - 1 N m s*rate(spin) - 0.1 N m*coordinate(a)");
  m.measures.push_back({"law", "", "5 N m - 1 N m s*rate(spin) - 0.1 N m*coordinate(a)", "N m"});
  validate(m);
  for (const double start : {0.1, 6.3, 20., -40.}) {
    CAPTURE(start);
    SolveOptions options;
    options.start = {{"a", start}};
    const Solution s = Analysis(m).solve(options);
    REQUIRE(s.status == Status::converged);
    CHECK(std::abs(5 - speed(s, "spin") - 0.1 * value(s, "a")) < 1e-12);
    CHECK(std::abs(s.measures.at(0).value.value()) < 1e-12);
  }
  const AllSolutions all = Analysis(m).solve_all();
  CHECK(all.equilibria.size() == 2);
  for (const Solution& s : all.equilibria) {
    CHECK(std::abs(5 - speed(s, "spin") - 0.1 * value(s, "a")) < 1e-12);
    CHECK(coordinate(s, "a").error < 1e-9);
  }
  // A label beyond a turn.
  m.joints[1].coordinates[0].drawn = 10;
  const Solution labelled = Analysis(m).solve();
  CHECK(std::abs(5 - speed(labelled, "spin") - 0.1 * value(labelled, "a")) < 1e-12);
  CHECK(std::abs(value(labelled, "a") - 10) < 3);
}

TEST_CASE("whole turns of an angle count where a law begins to ask for it many turns away",
          "[torque][places][turns]") {
  // A winch whose drum stands six turns on: 5 - w / 10 - (40 - 38) = 0.
  Mechanism m;
  m.bodies = {body("drum", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("motor", 1, {1, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {revolute("a", "ground", "drum", {0, 0, 0}, {0, 0, 1}),
              torque_driven(revolute("m", "ground", "motor", {1, 0, 0}, {0, 0, 1}), 5,
                            "5 N m - 0.1 N m s*rate(m) - 1 N m*max(0, coordinate(a) - 38)")};
  m.joints[0].coordinates[0].drawn = 40;
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "m"), WithinRel(30, 1e-12));
  CHECK_THAT(value(s, "a"), WithinRel(40, 1e-12));
}

TEST_CASE("whole turns of an angle do not count where a law goes on alike", "[torque][places][turns]") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("h", 1, {0, 0, 0}, {0.3, 0.4, 0.3}), body("b", 1, {0.1, -0.3, 0}, {0.001, 0.001, 0.001})};
  m.joints = {driven(revolute("spin", "ground", "h", {0, 0, 0}, {0, 1, 0}), 5),
              dampened(revolute("a", "h", "b", {0.05, 0, 0}, {0, 0, 1}), 0.2)};
  m = with_torque(m, "5 N m - 1 N m s*rate(spin) - 0.5 N m*sin(coordinate(a))");
  validate(m);
  const double drawn = value(Analysis(m).solve(), "a");
  SolveOptions options;
  options.start = {{"a", drawn + 2 * std::numbers::pi}};
  CHECK_THAT(value(Analysis(m).solve(options), "a"), WithinRel(drawn, 1e-9));
}
