// Studies over what expressions make of a parameter: a length moves joints, bodies and links at once.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/sweep.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

// The paper's governor with another arm, each number of it set by hand.
Mechanism with_arm(double arm) {
  const double joint = arm / 2, length = 0.10922;
  const double collar = 0.2 - std::sqrt(length * length - joint * joint);
  Mechanism m = shipped("governor");
  m.bodies[1].position.x() = -arm;
  m.bodies[2].position.x() = arm;
  m.bodies[3].position.y() = collar;
  m.joints[3].at.y() = collar;
  m.joints[3].coordinates[0].drawn = 0.2 - collar;
  for (const std::size_t side : {0U, 1U}) {
    m.joints[4 + side].points[0].x() = side == 0 ? -joint : joint;
    m.joints[4 + side].points[1].y() = collar;
    m.joints[4 + side].length = length;
  }
  return m;
}

} // namespace

TEST_CASE("a length that expressions take apart gives what setting each number by hand gives") {
  const Mechanism m = shipped("governor_parametric");
  for (const double arm : {0.1, 0.13, 0.16, 0.2}) {
    CAPTURE(arm);
    Mechanism varied = m;
    set_parameter(varied, "parameters.L", arm);
    const Solution found = Analysis(varied).solve({}), by_hand = Analysis(with_arm(arm)).solve({});
    REQUIRE(by_hand.status == Status::converged);
    CHECK(std::abs(value(found, "slide") - value(by_hand, "slide")) < 1e-14);
    CHECK(std::abs(value(found, "arm1") - value(by_hand, "arm1")) < 1e-14);
  }
}

TEST_CASE("a sweep over a length tells where no mechanism can be made, and goes on") {
  const Mechanism m = shipped("governor_parametric");
  // The link is too short for arms beyond 0.21844 m.
  const std::vector<Variation> over{{"parameters.L", 0.1, 0.3, 9}};
  const std::vector<SweepPoint> points = sweep(m, over, 2);
  REQUIRE(points.size() == 9);
  for (const SweepPoint& point : points) {
    const double arm = point.parameters[0];
    CAPTURE(arm);
    if (arm < 0.2184) {
      REQUIRE(point.solution.status == Status::converged);
      CHECK(std::abs(value(point.solution, "slide") - value(Analysis(with_arm(arm)).solve({}), "slide")) <
            1e-14);
    } else {
      CHECK(point.solution.status == Status::infeasible);
      CHECK_THAT(point.solution.message, ContainsSubstring("points.S[1]"));
    }
  }
  // What is a mistake whatever the parameters are ends it.
  const std::vector<Variation> wrong{{"parameters.c", 0.1, 0.2, 2}};
  CHECK_THROWS_AS(sweep(m, wrong, 1), SceneError);
}

TEST_CASE("a branch over a length ends where no mechanism can be made, and says so") {
  const Mechanism m = shipped("governor_parametric");
  const ResponseDiagram diagram = follow_branches(m, "parameters.L", 0.1, 0.3, {});
  REQUIRE(diagram.status == Status::converged);
  REQUIRE_FALSE(diagram.branches.empty());
  const ResponseBranch& branch = diagram.branches.front();
  CHECK_THAT(branch.end, ContainsSubstring("beyond it no mechanism can be made: points.S[1]"));
  CHECK(branch.points.back().parameter > 0.2183);
  CHECK(branch.points.back().parameter < 0.21844);
  for (std::size_t i = 0; i < branch.points.size(); i += 7) {
    const ResponsePoint& point = branch.points[i];
    CAPTURE(point.parameter);
    const Solution by_hand = Analysis(with_arm(point.parameter)).solve({});
    if (by_hand.status == Status::converged)
      CHECK(std::abs(value(point.coordinates, "slide") - value(by_hand, "slide")) < 1e-9);
  }
  // From a state inside the range, both ways.
  ResponsePoint state;
  state.parameter = 0.16;
  state.coordinates = Analysis(m).solve({}).coordinates;
  const auto through = follow_branches_through(m, "parameters.L", 0.3, 0.1, state, {});
  REQUIRE(through);
  CHECK_THAT(through->branches.front().begin, ContainsSubstring("no mechanism can be made"));
  CHECK(through->branches.front().points.back().parameter == 0.1);
}

namespace {

// A ball on a sprung lever, whose length is a root of the parameter's distance from `at`.
Mechanism with_root(const std::string& distance) {
  Mechanism m;
  m.name = "root";
  m.gravity = Vec3(0, -10, 0);
  m.parameters = {{"p", "", 0.2, "m", std::nullopt, {}}};
  m.bodies = {body("ball", 1, Vec3(0.5, 0, 0), Vec3::Constant(0.1))};
  m.bodies[0].formulas = {{"position.0", "0.3 m + sqrt(" + distance + " * 1 m)"}};
  m.joints = {sprung(revolute("hinge", "ground", "ball", Vec3::Zero()), 50)};
  evaluate_formulas(m);
  return m;
}

} // namespace

TEST_CASE("a branch begins and ends where a number's rate is infinite") {
  const Mechanism m = with_root("p");
  const auto check = [&](const ResponsePoint& point) {
    Mechanism there = m;
    set_parameter(there, "parameters.p", point.parameter);
    CHECK(std::abs(value(point.coordinates, "hinge") - value(Analysis(there).solve({}), "hinge")) < 1e-9);
  };
  for (const bool forth : {true, false}) {
    const ResponseDiagram diagram = follow_branches(m, "parameters.p", forth ? 0 : 1, forth ? 1 : 0, {});
    REQUIRE(diagram.status == Status::converged);
    REQUIRE(diagram.branches.size() == 1);
    const std::vector<ResponsePoint>& points = diagram.branches[0].points;
    CHECK(points.front().parameter == (forth ? 0 : 1));
    CHECK(std::abs(points.back().parameter - (forth ? 1 : 0)) < 1e-12);
    CHECK(diagram.branches[0].end == "the end of the range");
    for (const ResponsePoint& point : points)
      check(point);
  }
  // Beyond it there is nothing.
  const ResponseDiagram beyond = follow_branches(m, "parameters.p", 0.5, -0.5, {});
  REQUIRE_FALSE(beyond.branches.empty());
  CHECK_THAT(beyond.branches[0].end, ContainsSubstring("bodies.ball.position.0"));
  CHECK(beyond.branches[0].points.back().parameter < 1e-6);
  // A number that has a corner on the way ends it there, and says where.
  const ResponseDiagram corner = follow_branches(with_root("abs(p - 0.5 m)"), "parameters.p", 0, 1, {});
  REQUIRE(corner.status == Status::converged);
  REQUIRE_FALSE(corner.branches.empty());
  INFO(corner.branches[0].end);
  CHECK(std::abs(corner.branches[0].points.back().parameter - 0.5) < 1e-3);
  CHECK_THAT(corner.branches[0].end,
             ContainsSubstring("infinite rate") || ContainsSubstring("the corrector fails"));
}
