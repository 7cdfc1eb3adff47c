// Studies over what expressions make of a parameter: a length moves joints, bodies and links at once.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/sweep.hpp"
#include "tests/catch.hpp"
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
