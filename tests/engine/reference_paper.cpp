// The reference against the paper's two mechanisms and a closed form.
#include "tests/catch.hpp"
#include "tests/engine/reference/b_matrix.hpp"
#include "tests/support/parts.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::reference;
using namespace flyball::test;

namespace {

// Section 3.1: drawn along x, the arm's tip at 1 m.
Mechanism swing_pendulum() {
  Mechanism m;
  m.bodies = {body("arm", 1, {0.5, 0, 0}, {0, 0.1, 0.1}), body("rod", 0, {1.5, 0, 0}, {0, 0, 0}),
              body("slider", 1, {2.1, 0, 0}, {0, 0, 0})};
  m.joints = {revolute("spin", "ground", "arm", {0, 0, 0}, {0, 0, 1}),
              revolute("swing", "arm", "rod", {1, 0, 0}, {0, 0, 1}),
              prismatic("slide", "rod", "slider", {1, 0, 0}, {1, 0, 0})};
  m.joints[0].coordinates[0].drive = Drive{20};
  m.joints[1].coordinates[0].spring = CoordinateSpring{300, 1.0472};
  m.joints[1].coordinates[0].damping = 10;
  m.joints[2].coordinates[0].drawn = 1.1;
  m.joints[2].coordinates[0].spring = CoordinateSpring{50000, 1};
  m.joints[2].coordinates[0].damping = 100;
  return m;
}

// Section 3.2.
Mechanism governor(double g) {
  Mechanism m;
  m.gravity = {0, -g, 0};
  m.bodies = {body("spindle", 200, {0, 0.2, 0}, {25, 50, 25}),
              body("ball1", 1, {-0.16, 0.2, 0}, {0.1, 0.1, 0.1}),
              body("ball2", 1, {0.16, 0.2, 0}, {0.1, 0.1, 0.1}),
              body("collar", 1, {0, 0.1256, 0}, {0.15, 0.125, 0.15})};
  m.joints = {revolute("spin", "ground", "spindle", {0, 0.2, 0}, {0, 1, 0}),
              revolute("arm1", "spindle", "ball1", {0, 0.2, 0}, {0, 0, 1}),
              revolute("arm2", "spindle", "ball2", {0, 0.2, 0}, {0, 0, -1}),
              prismatic("slide", "spindle", "collar", {0, 0.1256, 0}, {0, -1, 0}),
              distance("link1", "ball1", "collar", {-0.08, 0.2, 0}, {0, 0.1256, 0}, 0.10922),
              distance("link2", "ball2", "collar", {0.08, 0.2, 0}, {0, 0.1256, 0}, 0.10922)};
  m.joints[0].coordinates[0].drive = Drive{11.0174};
  m.joints[3].coordinates[0].drawn = 0.0744;
  m.joints[3].coordinates[0].spring = CoordinateSpring{1000, 0.15};
  return m;
}

} // namespace

TEST_CASE("the swing pendulum balances where the paper says") {
  const Mechanism m = swing_pendulum();
  ReferenceState s;
  s.coordinates = {{"swing", {0.45377171949723577}}, {"slide", {1.0153129043019644}}};
  const Evaluation e = evaluate(m, {}, s);
  REQUIRE(e.free.size() == 2);
  // A coordinate's last digit moves its balance by some 1e-12 N (the slider's stiffness times 2e-16).
  CHECK(static_cast<double>(e.unbalanced().cwiseAbs().maxCoeff()) < 2e-11);
  // The drive need not push: neither gravity nor drag resists.
  CHECK(std::abs(static_cast<double>(e.balance[e.driven.front()])) < 1e-11);

  s.coordinates["spin"] = {1.3}; // the phase of the drive does not matter
  CHECK(static_cast<double>(evaluate(m, {}, s).unbalanced().cwiseAbs().maxCoeff()) < 2e-11);
}

TEST_CASE("the governor balances where the paper says") {
  struct Row {
    double g, angle, s;
  };
  for (const Row& row : {Row{9.80665, 0.7856156814882422, 0.1500174581252971},
                         Row{9.81, 0.7857110273452537, 0.1500261156008845}}) {
    const Mechanism m = governor(row.g);
    ReferenceState s;
    s.coordinates = {{"arm1", {row.angle}}, {"arm2", {row.angle}}, {"slide", {row.s}}};
    const Evaluation e = evaluate(m, {}, s);
    REQUIRE(e.constraints.size() == 2);
    CHECK(static_cast<double>(e.constraints.cwiseAbs().maxCoeff()) < 1e-15);
    CHECK(static_cast<double>(e.unbalanced().cwiseAbs().maxCoeff()) < 1e-12);
  }
  // As drawn the links are a little too long, and assembling closes them.
  const Mechanism m = governor(9.80665);
  CHECK(static_cast<double>(evaluate(m, {}, {}).constraints[0]) ==
        Approx(std::hypot(0.08, 0.0744) - 0.10922).epsilon(1e-12));
  CHECK(static_cast<double>(evaluate(m, {}, assemble(m, {}, {})).constraints.norm()) < 1e-16);
}

TEST_CASE("a conical pendulum stands at cos theta = g / (omega^2 L)") {
  const double g = 9.81, length = 0.7, omega = 6, theta = std::acos(g / (omega * omega * length));
  Mechanism m;
  m.gravity = {0, 0, -g};
  m.bodies = {body("shaft", 3, {0, 0, 0.1}, {0.1, 0.1, 0.2}), body("bob", 2, {0, 0, -length}, {0, 0, 0})};
  m.joints = {revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 0, 1}),
              revolute("hinge", "shaft", "bob", {0, 0, 0}, {0, -1, 0})};
  m.joints[0].coordinates[0].drive = Drive{omega};
  ReferenceState s;
  s.coordinates["hinge"] = {theta};
  const Evaluation e = evaluate(m, {}, s);
  CHECK(static_cast<double>(e.unbalanced().norm()) < 1e-13);
  CHECK(static_cast<double>(e.bodies[1].position.x()) == Approx(length * std::sin(theta)));
  // The string's pull is m omega^2 L.
  const Vec3R pull = e.bodies[1].inertial.force - e.bodies[1].applied.force;
  CHECK(static_cast<double>(pull.norm()) == Approx(2 * omega * omega * length));

  // Air resistance on the bob takes c v r of the drive's torque.
  Force drag;
  drag.type = ForceType::drag;
  drag.body = "bob";
  drag.linear = 0.3;
  drag.quadratic = 0.2;
  m.forces = {drag};
  const double radius = length * std::sin(theta), speed = omega * radius;
  CHECK(static_cast<double>(generalized_forces(m, {}, s).at("spin")[0]) ==
        Approx((0.3 + 0.2 * speed) * speed * radius));
}

TEST_CASE("a rate gyro's precession takes I_spin times both speeds") {
  // Rotor spinning about x in a gimbal hinged about y on a turntable about z.
  const double table_speed = 0.8, spin_speed = 200, axial = 0.002;
  Mechanism m;
  m.bodies = {body("table", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("gimbal", 0, {0, 0, 0}, {0, 0, 0}),
              body("rotor", 0.5, {0, 0, 0}, {axial, 0.001, 0.001})};
  m.joints = {revolute("table", "ground", "table", {0, 0, 0}, {0, 0, 1}),
              revolute("gimbal", "table", "gimbal", {0, 0, 0}, {0, 1, 0}),
              revolute("rotor", "gimbal", "rotor", {0, 0, 0}, {1, 0, 0})};
  m.joints[0].coordinates[0].drive = Drive{table_speed};
  m.joints[2].coordinates[0].drive = Drive{spin_speed};
  // z x x = y: the angular momentum turns towards y, so the gimbal's hinge has to push about +y.
  CHECK(static_cast<double>(generalized_forces(m, {}, {}).at("gimbal")[0]) ==
        Approx(axial * table_speed * spin_speed));
}

TEST_CASE("a gear drives its other shaft, and the drive carries the load of both") {
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("b", 1, {1, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}),
              revolute("b", "ground", "b", {1, 0, 0}, {0, 0, 1})};
  m.joints[0].coordinates[0].drive = Drive{3};
  m.joints[0].coordinates[0].damping = 0.5;
  m.joints[1].coordinates[0].damping = 0.2;
  Joint gear;
  gear.name = "gear";
  gear.type = JointType::gear;
  gear.joints = {"a", "b"};
  gear.ratio = -2;
  m.joints.push_back(gear);
  const Evaluation e = evaluate(m, {}, {});
  CHECK(e.free.empty());
  CHECK(static_cast<double>(e.bodies[1].angular_velocity.z()) == Approx(-6));
  CHECK(static_cast<double>(e.unbalanced().norm()) < 1e-15);
  // 0.5 * 3 on its own shaft and 2 * (0.2 * 6) through the gear.
  CHECK(static_cast<double>(e.by_joint(m, e.multipliers()).at("a")[0]) == Approx(1.5 + 2.4));
}
