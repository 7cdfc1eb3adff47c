// Special points of branches that have a formula: their parameters lie within the errors that are told.
#include "engine/continuation/branches.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <cmath>
#include <random>

using namespace flyball;
using namespace flyball::test;

namespace {

void check_within_error(const SpecialPoint& special, double exact) {
  REQUIRE(special.at.parameter_error);
  const double error = *special.at.parameter_error;
  CHECK(std::abs(special.at.parameter - exact) <= error);
  CHECK(error < 1e-9 * std::abs(exact));
}

} // namespace

TEST_CASE("a pendulum that turns leaves the vertical within the error that is told") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> lengths(0.2, 3), damping(0, 2), fastest(8, 30);
  for (int i = 0; i < 12; ++i) {
    const double length = lengths(random);
    CAPTURE(i, length);
    Mechanism m = conical(length, 0, 1, 0);
    m.joints[1].coordinates[0].damping = i % 2 == 0 ? 0 : damping(random);
    const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 0.1, fastest(random));
    REQUIRE(d.special.size() == 1);
    CHECK(d.special[0].type == SpecialPointType::branch_point);
    check_within_error(d.special[0], std::sqrt(standard_gravity / length));
  }
}

TEST_CASE("a strut snaps through within the error that is told") {
  // A body on a slide with a spring to a point beside it: P = k x (1 - free / sqrt(a^2 + x^2)).
  std::mt19937 random(2);
  std::uniform_real_distribution<double> beside(0.5, 2), high(0.2, 1.2), stiff(1, 6);
  for (int i = 0; i < 12; ++i) {
    const double a = beside(random), h = a * high(random), k = std::pow(10, stiff(random)),
                 free = std::hypot(a, h);
    CAPTURE(i, a, h, k);
    Mechanism m;
    m.bodies = {body("block", 1, {0, h, 0})};
    m.joints = {dampened(prismatic("y", "ground", "block", {0, h, 0}, {0, 1, 0}), 1)};
    m.forces.resize(2);
    Force& strut = m.forces[0];
    strut.name = "strut";
    strut.bodies = {"ground", "block"};
    strut.points = {Vec3(a, 0, 0), Vec3(0, h, 0)};
    strut.stiffness = k;
    strut.free_length = free;
    Force& load = m.forces[1];
    load.name = "load";
    load.type = ForceType::force;
    load.body = "block";
    const double x = std::sqrt(std::pow(free * a * a, 2. / 3) - a * a),
                 most = k * x * (free / std::hypot(a, x) - 1);
    const ResponseDiagram d = follow_branches(m, "forces.load.vector.1", 0, -2 * most);
    REQUIRE(d.special.size() == 1);
    CHECK(d.special[0].type == SpecialPointType::fold);
    check_within_error(d.special[0], -most);
  }
}
