// How the branches of a response diagram are drawn.
#include "app/plot/branch_plot.hpp"
#include "engine/continuation/branches.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("the branch of a family is neutral, which is not unstable") {
  // A bob on a ball joint beside the axis of a turntable turns about its own rod.
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1, Vec3::Zero()), body("bob", 1, {0.1, -0.7, 0}, {1e-3, 1e-3, 1e-3})};
  m.joints = {joint(JointType::revolute, "spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()),
              joint(JointType::spherical, "swing", "hub", "bob", {0.1, 0, 0})};
  m.joints[0].coordinates[0].drive = Drive{0};
  for (Coordinate& c : m.joints[1].coordinates)
    c.damping = 0.05; // undamped, gyroscopic forces keep some of the others
  const std::string speed = "joints.spin.drive.speed";
  BranchOptions options;
  options.all = true;
  const ResponseDiagram d = follow_branches(m, speed, 1, 10, options);
  REQUIRE(d.branches.size() == 3);
  const auto shown = find_plotted(m, d, "swing.2");
  REQUIRE(shown);
  const Plot plot = branch_plot(m, speed, d, *shown);
  // Outwards it is neutral; leaning in and upside down it is unstable.
  REQUIRE(plot.curves.size() >= 3);
  CHECK(plot.curves[0].name == "neutral");
  CHECK(plot.curves[0].points.size() == d.branches[0].points.size());
  CHECK(std::ranges::count(plot.curves, "neutral", &PlotCurve::name) == 1);
  CHECK(std::ranges::any_of(plot.curves, [](const PlotCurve& c) { return c.name == "not stable"; }));
}
