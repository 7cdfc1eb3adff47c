// Branches and lists of equilibria against closed forms and the reference values of the conical pendulum and
// the chain.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/equilibrium/branches.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

Mechanism turntable(double drive) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1, Vec3::Zero())};
  m.joints = {joint(JointType::revolute, "spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY())};
  m.joints[0].coordinates[0].drive = Drive{drive};
  return m;
}

// A point mass on a massless rod of length 0.7 m, hinged `offset` from the spin axis.
Mechanism conical(double offset) {
  Mechanism m = turntable(0);
  m.bodies.push_back(body("bob", 1, {offset, -0.7, 0}));
  m.joints.push_back(joint(JointType::revolute, "swing", "hub", "bob", {offset, 0, 0}));
  return m;
}

// Thin uniform rods, 1 m and 1 kg in total, hanging straight on the spin axis, all hinges along z.
Mechanism rods(int count) {
  Mechanism m = turntable(0);
  const double length = 1. / count, mass = 1. / count, inertia = mass * length * length / 12;
  for (int i = 0; i < count; ++i) {
    const std::string name = "rod" + std::to_string(i);
    m.bodies.push_back(body(name, mass, {0, -(i + 0.5) * length, 0}, {inertia, 0, inertia}));
    m.joints.push_back(joint(JointType::revolute, "hinge" + std::to_string(i),
                             i == 0 ? "hub" : "rod" + std::to_string(i - 1), name, {0, -i * length, 0}));
  }
  return m;
}

std::vector<const SpecialPoint*> of_type(const ResponseDiagram& d, SpecialPointType type) {
  std::vector<const SpecialPoint*> out;
  for (const SpecialPoint& s : d.special)
    if (s.type == type) out.push_back(&s);
  return out;
}

double first_coordinate(const ResponsePoint& p) {
  for (const CoordinateSolution& c : p.coordinates)
    if (!c.driven) return c.value;
  return 0;
}

} // namespace

TEST_CASE("the conical pendulum branches at sqrt(g/L) into two stable bent states", "[branches]") {
  const ResponseDiagram d = follow_branches(conical(0), speed, 0, 10);
  REQUIRE(d.status == Status::converged);
  const auto crossings = of_type(d, SpecialPointType::branch_point);
  REQUIRE(crossings.size() == 1);
  CHECK(std::abs(crossings[0]->at.parameter - std::sqrt(standard_gravity / 0.7)) < 1e-8);
  REQUIRE(d.branches.size() == 3);
  for (const ResponsePoint& p : d.branches[0].points) {
    CHECK(std::abs(first_coordinate(p)) < 1e-9);
    if (std::abs(p.parameter - crossings[0]->at.parameter) > 1e-3)
      CHECK(p.stable == (p.parameter < crossings[0]->at.parameter));
  }
  double sides = 0;
  for (int b : {1, 2}) {
    const auto& points = d.branches[static_cast<std::size_t>(b)].points;
    CHECK(std::abs(points.back().parameter - 10) < 1e-12);
    sides += std::copysign(1, first_coordinate(points.back()));
    for (std::size_t i = 2; i < points.size(); ++i) { // cos(angle) = g / (w^2 L)
      const double w = points[i].parameter;
      CHECK(std::cos(first_coordinate(points[i])) == Approx(standard_gravity / (w * w * 0.7)).margin(1e-10));
      CHECK(points[i].stable == true);
    }
  }
  CHECK(sides == 0);
}

TEST_CASE("a hinge off the axis folds the leaning-in branch", "[branches]") {
  const ResponseDiagram d = follow_branches(conical(0.1), speed, 10, 0);
  const auto folds = of_type(d, SpecialPointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK(std::abs(folds[0]->at.parameter - 4.75536807929276) < 1e-8);
  CHECK(std::abs(first_coordinate(folds[0]->at) + 0.5500829670481832) <
        1e-5); // half the digits of the parameter
  // The branch turns back: it ends where it began, on the other side of the fold.
  CHECK(std::abs(d.branches[0].points.back().parameter - 10) < 1e-12);
  CHECK(d.branches[0].points.front().stable != d.branches[0].points.back().stable);
}

TEST_CASE("the straight chain of twenty rods loses its stability where it should", "[branches]") {
  BranchOptions options;
  options.switch_branches = false;
  const ResponseDiagram d = follow_branches(rods(20), speed, 0, 15, options);
  const auto crossings = of_type(d, SpecialPointType::branch_point);
  const double expected[] = {3.7657120752760553, 8.66502558221858, 13.689185570192233};
  REQUIRE(crossings.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(std::abs(crossings[i]->at.parameter - expected[i]) < 1e-8);
}

TEST_CASE("a branch agrees with a sweep that knows nothing of it", "[branches]") {
  for (const char* name : {"governor", "pendulum", "watt_governor", "fourbar_turntable"}) {
    INFO(name);
    const Mechanism m = shipped(name);
    BranchOptions options;
    options.switch_branches = false;
    const double drawn = get_parameter(m, speed);
    const ResponseDiagram d = follow_branches(m, speed, drawn, 1.3 * drawn, options);
    REQUIRE(d.status == Status::converged);
    REQUIRE(d.branches[0].points.size() > 5);
    // Each point must be an equilibrium: Newton-Raphson started there does not move.
    for (std::size_t i = 0; i < d.branches[0].points.size(); i += 3) {
      const ResponsePoint& p = d.branches[0].points[i];
      Mechanism there = m;
      set_parameter(there, speed, p.parameter);
      SolveOptions solve;
      solve.nearest = true;
      for (const CoordinateSolution& c : p.coordinates)
        if (!c.driven)
          solve.start.push_back({c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index), c.value});
      const Solution s = Analysis(there).solve(solve);
      REQUIRE(s.status == Status::converged);
      CHECK(s.iterations <= 2);
      for (std::size_t c = 0; c < s.coordinates.size(); ++c)
        CHECK(std::abs(s.coordinates[c].value - p.coordinates[c].value) < 1e-7);
      CHECK(s.stable == p.stable);
    }
  }
}

TEST_CASE("all equilibria of the conical pendulum, in the order of their potential", "[all]") {
  Mechanism m = conical(0);
  set_parameter(m, speed, 5);
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 4);
  const double bent = std::acos(standard_gravity / (25 * 0.7));
  for (int i : {0, 1}) {
    const Solution& s = all.equilibria[static_cast<std::size_t>(i)];
    CHECK(std::abs(std::abs(s.coordinates[1].value) - bent) < 1e-12);
    CHECK(s.stable == true);
  }
  CHECK(all.equilibria[0].coordinates[1].value * all.equilibria[1].coordinates[1].value < 0);
  CHECK(std::abs(all.equilibria[2].coordinates[1].value) < 1e-12);
  CHECK(all.equilibria[2].stable == false);
  CHECK(std::abs(std::abs(all.equilibria[3].coordinates[1].value) - std::numbers::pi) < 1e-12);
  CHECK(all.equilibria[3].stable == false);
  for (std::size_t i = 1; i < 4; ++i)
    CHECK(*all.equilibria[i - 1].potential <= *all.equilibria[i].potential + 1e-12);
}

TEST_CASE("the list of all equilibria holds the answer, is repeatable and never claims to be complete",
          "[all]") {
  for (const char* name :
       {"governor", "pendulum", "watt_governor", "fourbar_turntable", "rate_gyro", "governor_bearing"}) {
    INFO(name);
    const Mechanism m = shipped(name);
    const Solution answer = Analysis(m).solve();
    const AllSolutions all = Analysis(m).solve_all(), again = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == again.equilibria.size());
    CHECK(std::ranges::any_of(all.equilibria, [&](const Solution& s) {
      for (std::size_t c = 0; c < s.coordinates.size(); ++c)
        if (std::abs(s.coordinates[c].value - answer.coordinates[c].value) > 1e-9) return false;
      return true;
    }));
    for (const Solution& s : all.equilibria)
      CHECK(s.residual < 1e-10);
    CHECK(all.message.find("may be more") != std::string::npos);
  }
}
