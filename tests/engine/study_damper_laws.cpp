// Dampers by laws that may take up energy or give it, as a number says: where solving and studies begin.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("with a damper by a law of a number the answer is what the drawn pose leads down to", "[laws]") {
  // A pendulum, drawn near upright, where Newton-Raphson goes.
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.parameters = {{"c", "", 0.5, "N m s", {}}};
  m.bodies = {body("bob", 2, {0.5 * std::sin(3.), -0.5 * std::cos(3.), 0})};
  m.joints = {revolute("hinge", "ground", "bob", {0, 0, 0}, {0, 0, 1})};
  m.joints[0].coordinates[0].drawn = 3;
  m.joints[0].coordinates[0].damping_force = 0;
  m.joints[0].formulas.push_back({"damping_force", "c*rate"});
  validate(m);
  const auto hangs = [](const CoordinateSolution& c) {
    return std::abs(std::remainder(c.value, 2 * std::numbers::pi)) < 1e-12;
  };
  Analysis analysis(m);
  for (const double damping : {0.5, -0.5, 0.5, 0.}) { // or it drives
    CAPTURE(damping);
    set_parameter(m, "parameters.c", damping);
    analysis.update(m);
    const Solution s = analysis.solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(hangs(coordinate(s, "hinge")));
    CHECK(s.stable == (damping >= 0));
    CHECK(s.stability_reason == (damping >= 0 ? StabilityReason::minimum : StabilityReason::unstable));
    CHECK((s.message.find("stable one") != std::string::npos) == (damping >= 0));
    // Branches begin there, too, beside the state nearest to the drawn pose.
    const ResponseDiagram d = follow_branches(m, "parameters.c", damping, 1);
    const auto branch = std::ranges::find_if(
        d.branches, [&](const ResponseBranch& x) { return hangs(x.points.front().coordinates[0]); });
    REQUIRE(branch != d.branches.end());
    CHECK(branch->points.front().stable == (damping >= 0));
    CHECK(branch->points.back().stable == true);
    CHECK(d.special.size() == (damping < 0 ? 1 : 0));
  }
}
