// Steady states with a closed form, or with one equation that a bisection solves.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include <complex>

using namespace flyball;
using namespace flyball::test;

namespace {

using Real = long double;
constexpr Real g = standard_gravity;

// Torque on the conical pendulum's hinge per unit of mass, and its derivative: of the amended potential
// -g L cos(a) - w^2 (offset + L sin(a))^2 / 2.
Real conical_slope(Real length, Real offset, Real speed, Real a) {
  return g * length * std::sin(a) - speed * speed * (offset + length * std::sin(a)) * length * std::cos(a);
}
Real conical_curvature(Real length, Real offset, Real speed, Real a) {
  const Real r = offset + length * std::sin(a);
  return g * length * std::cos(a) -
         speed * speed * length * (length * std::cos(a) * std::cos(a) - r * std::sin(a));
}

// Derivative of an analytic function by a complex step: exact, because nothing cancels.
template <class F>
Real slope(F f, Real x) {
  const Real h = 1e-200L;
  return f(std::complex<Real>(x, h)).imag() / h;
}

// A body of a linkage that moves in the plane z = 0, of which the whole turns about y.
template <class S>
struct PlaneBody {
  Real mass;
  S x, y;             // m, mass centre
  S c, s;             // cosine and sine of its turn from the drawn pose
  Real i11, i22, i12; // kg m^2, drawn pose
};

// V - T of a body in the turning plane: weight, and inertia about the spin axis.
template <class S>
S amended(const PlaneBody<S>& b, Real speed) {
  const S iyy = b.s * b.s * b.i11 + b.c * b.c * b.i22 + Real(2) * b.s * b.c * b.i12;
  return b.mass * g * b.y - Real(0.5) * speed * speed * (b.mass * b.x * b.x + iyy);
}

// The body of a mechanism, turned by the angle with this cosine and sine about a point that goes from `from`
// to (to_x, to_y).
template <class S>
PlaneBody<S> carried(const Mechanism& m, const std::string& name, const Vec3& from, S to_x, S to_y, S c,
                     S s) {
  const Body& b = m.bodies[static_cast<std::size_t>(body_index(m, name))];
  const Real dx = b.position.x() - from.x(), dy = b.position.y() - from.y();
  return {b.mass, to_x + c * dx - s * dy, to_y + s * dx + c * dy, c,
          s,      b.inertia[0],           b.inertia[1],           b.inertia[3]};
}

const Joint& joint_of(const Mechanism& m, std::string_view name) {
  return m.joints[static_cast<std::size_t>(joint_index(m, name))];
}

} // namespace

TEST_CASE("a conical pendulum hangs below its critical speed and stands out above") {
  const double length = 0.7, critical = std::sqrt(standard_gravity / length);
  for (const double drawn : {0., 0.1, -0.4}) {
    for (const double share : {0., 0.3, 0.9, 0.999}) {
      CAPTURE(drawn, share);
      const Solution s = solve(conical(length, 0, share * critical), from("swing", drawn));
      REQUIRE(s.status == Status::converged);
      CHECK(stable(s));
      check_value(s, "swing", 0);
    }
    for (const double share : {1.001, 1.1, 2., 10.}) {
      CAPTURE(drawn, share);
      const double speed = share * critical;
      const Solution s = solve(conical(length, 0, speed), from("swing", drawn));
      REQUIRE(s.status == Status::converged);
      CHECK(stable(s));
      const Real angle = std::acos(g / (Real(speed) * speed * Real(length)));
      CHECK(std::abs(std::abs(value(s, "swing")) - static_cast<double>(angle)) < 1e-12);
      if (drawn != 0) check_value(s, "swing", drawn > 0 ? angle : -angle);
      // Drawn hanging, that state is an equilibrium too: the plain answer, and unstable.
      if (drawn != 0) continue;
      CHECK(s.fallback == Fallback::descent);
      CHECK_THAT(s.message, ContainsSubstring("unstable"));
      const Solution plain = solve(conical(length, 0, speed), nearest());
      CHECK(plain.status == Status::converged);
      CHECK(plain.stable == false);
      check_value(plain, "swing", 0);
    }
  }
}

TEST_CASE("a pendulum hinged off the axis has a fold on the far side") {
  const double length = 0.7, offset = 0.1;
  // Leaning inwards by p there is balance at speed^2 = g tan(p) / (L sin(p) - offset), least at the fold:
  // where its logarithm's slope vanishes.
  const Real p = root(
      [&](Real x) {
        return 1 / (std::sin(x) * std::cos(x)) - length * std::cos(x) / (length * std::sin(x) - offset);
      },
      std::asin(Real(offset) / length) + 1e-6L, 1.5L);
  const auto fold =
      static_cast<double>(std::sqrt(g * std::tan(p) / (Real(length) * std::sin(p) - Real(offset))));
  CHECK(fold > std::sqrt(standard_gravity / length));
  for (const double share : {0.2, 0.7, 0.95, 1.05, 1.5, 4.}) {
    const double speed = share * fold;
    const auto f = [&](Real a) { return conical_slope(length, offset, speed, a); };
    const Real outwards = root(f, 0, std::numbers::pi_v<Real> / 2);
    for (const double drawn : {0., 0.5, -0.2, -1.2}) {
      CAPTURE(share, speed, drawn);
      const Mechanism m = conical(length, offset, speed);
      SolveOptions options = from("swing", drawn);
      const Solution s = solve(m, options);
      REQUIRE(s.status == Status::converged);
      CHECK(stable(s));
      const double a = value(s, "swing");
      CHECK(std::abs(static_cast<double>(f(a))) < 1e-11 * speed * speed + 1e-11);
      CHECK(conical_curvature(length, offset, speed, a) > 0);
      // Never uphill.
      const auto u = [&](double x) {
        const double r = offset + length * std::sin(x);
        return -standard_gravity * length * std::cos(x) - speed * speed * r * r / 2;
      };
      CHECK(u(a) <= u(drawn) + 1e-9 * speed * speed);
      if (share < 1 || drawn >= 0) {
        check_value(s, "swing", outwards);
      } else if (drawn == -1.2) {
        // Beyond the ridge of the far side: the inward state is the one below this start.
        const Real ridge = root(f, -p, 0);
        if (ridge > drawn) CHECK(a < 0);
      }
      options.nearest = true;
      const Solution plain = solve(m, options);
      if (plain.status != Status::converged) continue;
      const double b = value(plain, "swing");
      CHECK(std::abs(static_cast<double>(f(b))) < 1e-11 * speed * speed + 1e-11);
      CHECK(plain.stable == (conical_curvature(length, offset, speed, b) > 0));
    }
  }
}

TEST_CASE("a sprung slider on a turntable leaves when its spring is too weak") {
  const double mass = 0.8, stiffness = 200, free = 0.05, radius = 0.3;
  for (const double share : {0., 0.5, 0.99, 1.01, 2.}) { // of m w^2 in k
    const double speed = std::sqrt(share * stiffness / mass);
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {spindle(), body("slider", mass, {radius, 0.1, 0})};
    m.joints = {spin(speed), sprung(prismatic("slide", "spindle", "slider", {radius, 0.1, 0}, {1, 0, 0}),
                                    stiffness, free)};
    CAPTURE(share, speed);
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    const Real pull = Real(mass) * speed * speed;
    const Real wanted = (stiffness * Real(free) + pull * radius) / (stiffness - pull);
    check_value(s, "slide", wanted, 1e-12 * std::max(1., std::abs(static_cast<double>(wanted)) * 100));
    CHECK(s.stable == (share < 1));
    CHECK((s.stability_reason == StabilityReason::minimum) == (share < 1));
    if (share > 1)
      CHECK_THAT(s.message,
                 ContainsSubstring("the potential falls on") || ContainsSubstring("The potential falls on"));
  }
}

TEST_CASE("a rate gyro tilts by the rate of turn") {
  for (const double turn : {-3., 0.1, 0.5, 2.}) {
    for (const double rotor_speed : {0., 800.}) {
      const Mechanism m =
          shipped("rate_gyro", {{"joints.turn.drive.speed", turn}, {"joints.spin.drive.speed", rotor_speed}});
      const Body &gimbal = m.bodies[1], &rotor = m.bodies[2];
      // Tilted by a about z the turntable's y axis has components (sin a, cos a, 0) in the gimbal; the torque
      // is dT/da of T = [(Gx (W sin a)^2 + Gy (W cos a)^2) + A (W sin a + s)^2 + B (W cos a)^2] / 2.
      const Real w = turn, spin_rate = rotor_speed;
      const Real a = rotor.inertia[0],
                 square =
                     w * w * (Real(gimbal.inertia[0]) - Real(gimbal.inertia[1]) + a - Real(rotor.inertia[1]));
      const Real k = m.joints[1].coordinates[0].spring->stiffness;
      const Real tilt = root(
          [&](Real x) {
            return k * x - square * std::sin(x) * std::cos(x) - a * spin_rate * w * std::cos(x);
          },
          -1.5L, 1.5L);
      CAPTURE(turn, rotor_speed);
      const Solution s = solve(m);
      REQUIRE(s.status == Status::converged);
      check_value(s, "tilt", tilt);
      CHECK(stable(s));
      if (rotor_speed > 0) CHECK(value(s, "tilt") * turn > 0);
    }
  }
}

TEST_CASE("masses hang on springs") {
  const double mass = 1.3, stiffness = 70;
  SECTION("in a slider") {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("mass", mass, {0, 0, 0})};
    m.joints = {sprung(prismatic("slide", "ground", "mass", {0, 0, 0}, {0, -1, 0}), stiffness, 0.2)};
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    check_value(s, "slide", Real(0.2) + Real(mass) * g / stiffness);
    CHECK(stable(s));
  }
  SECTION("on a point spring, free to move") {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("mass", mass, {0.3, -0.5, 0.1}, {0.01, 0.02, 0.015})};
    Force spring;
    spring.name = "spring";
    spring.type = ForceType::spring;
    spring.bodies = {"ground", "mass"};
    spring.points = {Vec3(0, 0, 0), Vec3(0.3, -0.4, 0.1)}; // 0.1 above the mass centre
    spring.stiffness = stiffness;
    spring.free_length = 0.4;
    m.forces = {spring};
    const Solution s = solve(m);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const double stretched = 0.4 + mass * standard_gravity / stiffness;
    CHECK((s.poses[0].position - Vec3(0, -stretched - 0.1, 0)).norm() < 1e-9);
    // Nothing resists turning about the vertical.
    CHECK(s.neutral.size() == 1);
    CHECK_FALSE(s.stable.has_value());
    CHECK(s.stability_reason == StabilityReason::neutral);
  }
}

TEST_CASE("a planar joint holds a puck on a turntable by its springs") {
  const double mass = 0.6, speed = 7, kx = 90, ky = 150, ka = 0.4, radius = 0.25;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle(), body("puck", mass, {radius, 0, 0}, {0.001, 0.002, 0.003})};
  Joint puck = joint(JointType::planar, "puck", "spindle", "puck", {radius, 0, 0}, {0, 1, 0});
  puck.axis2 = {1, 0, 0};
  puck = sprung(sprung(sprung(puck, kx, 0.01, 0), ky, 0.03, 1), ka, 0.7, 2);
  m.joints = {spin(speed), puck};
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  const Real pull = Real(mass) * speed * speed;
  check_value(s, "puck", (kx * Real(0.01) + pull * radius) / (kx - pull), 1e-12, 0);
  check_value(s, "puck", ky * Real(0.03) / (ky - pull), 1e-12, 1);
  check_value(s, "puck", 0.7, 1e-12, 2);
  CHECK(stable(s));
}

TEST_CASE("a spherical pendulum hangs, or turns on a cone") {
  const double length = 0.5;
  for (const double speed : {0., 3., 6., 9.}) {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {spindle(), body("bob", 0.4, {length * std::sin(0.3), -length * std::cos(0.3), 0},
                                {0.0002, 0.0002, 0.0002})};
    m.joints = {spin(speed), joint(JointType::spherical, "socket", "spindle", "bob", {0, 0, 0})};
    CAPTURE(speed);
    const Solution s = solve(m);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const double cosine = std::min(1., standard_gravity / (speed * speed * length));
    CHECK(std::abs(s.poses[1].position.y() + length * cosine) < 1e-9);
    CHECK(std::abs(s.poses[1].position.norm() - length) < 1e-12);
    // It may turn about its own axis, and about the vertical.
    CHECK(s.neutral == std::vector<std::string>{"socket"});
    CHECK(s.stability_reason == StabilityReason::neutral);
    CHECK_FALSE(s.stable.has_value());
  }
}

TEST_CASE("air resistance holds a trailing arm back") {
  const double arm = 0.4, length = 0.3, mass = 0.5, stiffness = 6;
  for (const double speed : {1., 5., -12.}) {
    for (const double linear : {0., 0.2}) {
      const double quadratic = 0.1;
      Mechanism m;
      m.gravity = {0, 0, -standard_gravity};
      m.bodies = {spindle(), body("bob", mass, {arm + length, 0, 0})};
      m.joints = {spin(speed, {0, 0, 1}),
                  sprung(revolute("trail", "spindle", "bob", {arm, 0, 0}, {0, 0, 1}), stiffness)};
      Force drag;
      drag.name = "air";
      drag.type = ForceType::drag;
      drag.body = "bob";
      drag.linear = linear;
      drag.quadratic = quadratic;
      m.forces = {drag};
      // Spring, centrifugal torque m w^2 a L sin(x), and the drag (c + q v) w r across the radius.
      const Real w = speed;
      const Real x = root(
          [&](Real a) {
            const Real r = std::hypot(arm + length * std::cos(a), length * std::sin(a));
            const Real c = linear + quadratic * std::abs(w) * r;
            return stiffness * a + Real(mass) * w * w * arm * length * std::sin(a) +
                   c * w * length * (length + arm * std::cos(a));
          },
          -2, 2);
      CAPTURE(speed, linear);
      const Solution s = solve(m);
      REQUIRE(s.status == Status::converged);
      check_value(s, "trail", x);
      CHECK(value(s, "trail") * speed < 0);
      // The drive makes up for what the air takes.
      const double r =
          std::hypot(arm + length * std::cos(value(s, "trail")), length * std::sin(value(s, "trail")));
      REQUIRE(s.drive_torques.size() == 1);
      CHECK(s.drive_torques[0].value == Approx((linear + quadratic * std::abs(speed) * r) * speed * r * r));
      CHECK_FALSE(s.drive_torques[0].varying);
    }
  }
}

TEST_CASE("gears drive, and gears tie free coordinates") {
  SECTION("a slider on the driven wheel") {
    const double motor = 4, ratio = -2.5, stiffness = 300, mass = 0.7, radius = 0.2;
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {spindle(), body("wheel", 1, {1, 0, 0}, {0.1, 0.2, 0.1}),
                body("slider", mass, {1 + radius, 0, 0})};
    m.joints = {spin(motor), revolute("wheel", "ground", "wheel", {1, 0, 0}, {0, 1, 0}),
                sprung(prismatic("slide", "wheel", "slider", {1 + radius, 0, 0}, {1, 0, 0}), stiffness),
                gear("teeth", "spin", "wheel", ratio)};
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    const Real pull = Real(mass) * ratio * ratio * motor * motor;
    check_value(s, "slide", pull * radius / (stiffness - pull));
    CHECK(coordinate(s, "wheel").driven);
    CHECK(stable(s));
    CHECK(s.drive_torques.size() == 1);
  }
  SECTION("two pendulums, one sprung") {
    const double ratio = 0.6, stiffness = 2;
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("a", 0.5, {0.4, 0, 0}), body("b", 0.3, {2, -0.5, 0})};
    m.joints = {sprung(revolute("a", "ground", "a", {0, 0, 0}, {0, 0, 1}), stiffness),
                revolute("b", "ground", "b", {2, 0, 0}, {0, 0, 1}), gear("teeth", "a", "b", ratio)};
    // a from horizontal, b from hanging; b = ratio a.
    const Real x = root(
        [&](Real a) {
          return Real(0.5) * g * Real(0.4) * std::cos(a) +
                 ratio * Real(0.3) * g * Real(0.5) * std::sin(ratio * a) + stiffness * a;
        },
        -1.5L, 1);
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    check_value(s, "a", x);
    check_value(s, "b", ratio * x);
    CHECK(stable(s));
  }
}

TEST_CASE("a ball on a string stands out in line with the pull") {
  for (const double speed : {0.5, 4., 9., 20.}) {
    const Solution s = solve(shipped("ball_on_string", {{"joints.spin.drive.speed", speed}}));
    CAPTURE(speed, s.message);
    REQUIRE(s.status == Status::converged);
    // From the arm's tip to the ball's centre: the string and the ball's radius of 35 mm in one line.
    const Real tip = 0.25L, length = 0.535L;
    const Real x =
        root([&](Real a) { return conical_slope(length, tip, speed, a); }, 0, std::numbers::pi_v<Real> / 2);
    const Vec3 wanted(static_cast<double>(tip + length * std::sin(x)),
                      static_cast<double>(Real(0.9L) - length * std::cos(x)), 0);
    CHECK((s.poses[1].position - wanted).norm() < 1e-9);
    // The ball may twist about its string.
    CHECK_FALSE(s.neutral.empty());
    CHECK(s.stability_reason == StabilityReason::neutral);
    REQUIRE(s.multipliers.size() == 1);
    CHECK(s.multipliers[0].joint == "string");
  }
}

TEST_CASE("all equilibria of a ball on a string, those above its anchor as well") {
  const Mechanism m = shipped("ball_on_string");
  const AllSolutions all = Analysis(m).solve_all();
  const Real tip = 0.25L, pi = std::numbers::pi_v<Real>;
  std::size_t count = 0;
  for (const Real length : {0.535L, 0.465L}) { // the string and the ball's radius: beyond each other, or back
    const auto f = [&](Real a) { return conical_slope(length, tip, 4, a); };
    const int steps = 1000;
    for (int i = 0; i < steps; ++i) {
      const Real from = -pi + 2 * pi * i / steps, to = -pi + 2 * pi * (i + 1) / steps;
      if (f(from) * f(to) > 0) continue;
      const Real a = root(f, from, to);
      const Vec3 wanted(static_cast<double>(tip + length * std::sin(a)),
                        static_cast<double>(Real(0.9L) - length * std::cos(a)), 0);
      CAPTURE(wanted.transpose());
      ++count;
      CHECK(std::ranges::any_of(
          all.equilibria, [&](const Solution& s) { return (s.poses[1].position - wanted).norm() < 1e-9; }));
    }
  }
  CHECK(all.equilibria.size() == count);
}

TEST_CASE("equilibria whose digits are lost beside a large inertia are listed once, and no others") {
  // The inertia of a ball is the same about all axes and changes none; what it takes to turn it so cancels.
  const double speed = 5, tip = 0.1, down = 0.69;
  for (const double inertia : {1e6, 1e10, 1e11, 1e12}) {
    CAPTURE(inertia);
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("hub", 1, {0, 0, 0}), body("ball", 1, {tip, -down, 0}, Vec3::Constant(inertia))};
    m.joints = {driven(revolute("spin", "ground", "hub", {0, 0, 0}, {0, 1, 0}), speed),
                revolute("swing", "hub", "ball", {0, 0, 0}, {0, 0, 1})};
    const AllSolutions all = Analysis(m).solve_all();
    CHECK(all.equilibria.size() == 4);
    CHECK((all.lost > 0) == (inertia == 1e12));
    CHECK((all.message.find("lost in rounding") != std::string::npos) == (all.lost > 0));
    const double length = std::hypot(tip, down), drawn = std::atan2(tip, down);
    const double steep = std::acos(standard_gravity / (speed * speed * length)), pi = std::numbers::pi;
    for (const double angle : {0., pi, steep, -steep}) { // from the vertical
      CAPTURE(angle);
      CHECK(std::ranges::any_of(all.equilibria, [&](const Solution& s) {
        const CoordinateSolution& swing = s.coordinates.back();
        return s.neutral.empty() &&
               std::abs(std::remainder(swing.value - (angle - drawn), 2 * pi)) < swing.error + 1e-14;
      }));
    }
  }
}

TEST_CASE("Watt's governor balances where its potential is stationary") {
  for (const double speed : {5., 8., 11.}) {
    const Mechanism m = shipped("watt_governor", {{"joints.spin.drive.speed", speed}});
    const Vec3 hinge = joint_of(m, "arm1").at, knee = joint_of(m, "knee1").at, foot = joint_of(m, "foot1").at;
    const Real link = (knee - foot).norm();
    const double drawn = joint_of(m, "arm1").coordinates[0].drawn;
    const auto potential = [&](std::complex<Real> angle) {
      using S = std::complex<Real>;
      const S turn = angle - Real(drawn), c = std::cos(turn), s = std::sin(turn);
      const Real kx = knee.x() - hinge.x(), ky = knee.y() - hinge.y();
      const S knee_x = Real(hinge.x()) + c * kx - s * ky, knee_y = Real(hinge.y()) + s * kx + c * ky;
      // The foot slides up and down under its place on the sleeve.
      const S across = knee_x - Real(foot.x()), up = std::sqrt(link * link - across * across);
      const S foot_y = knee_y - up;
      // Turn of the link, from its direction foot to knee then and now.
      const Real dx = (knee.x() - foot.x()) / link, dy = (knee.y() - foot.y()) / link;
      const S lc = (dx * across + dy * up) / link, ls = (dx * up - dy * across) / link;
      const auto arm = carried<S>(m, "arm1", hinge, Real(hinge.x()), Real(hinge.y()), c, s);
      const auto bar = carried<S>(m, "link1", foot, Real(foot.x()), foot_y, lc, ls);
      const S sleeve = Real(m.bodies[5].mass) * g * foot_y;
      return Real(2) * (amended(arm, speed) + amended(bar, speed)) + sleeve;
    };
    const Real wanted = root([&](Real a) { return slope(potential, a); }, 0.01L, 1.4L);
    const Solution s = solve(m);
    CAPTURE(speed, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(stable(s));
    // The scene's masses and inertias are those of a round figure, but its two sides are equal to the digit.
    check_value(s, "arm1", wanted, 1e-10);
    check_value(s, "arm2", wanted, 1e-10);
  }
}

TEST_CASE("a governor lifts a collar that does not turn") {
  for (const double speed : {6., 10., 13.}) {
    const Mechanism m = shipped("governor_bearing", {{"joints.spin.drive.speed", speed}});
    const Joint &arm_joint = joint_of(m, "arm1"), &link = joint_of(m, "link1");
    const Vec3 hinge = arm_joint.at;
    const double drawn = arm_joint.coordinates[0].drawn;
    const Real length = link.length ? *link.length : (link.points[1] - link.points[0]).norm();
    const CoordinateSpring spring = *joint_of(m, "lift").coordinates[0].spring;
    const double carried_mass = m.bodies[3].mass + m.bodies[4].mass;
    const auto potential = [&](std::complex<Real> angle) {
      using S = std::complex<Real>;
      const S turn = angle - Real(drawn), c = std::cos(turn), s = std::sin(turn);
      const Real px = link.points[0].x() - hinge.x(), py = link.points[0].y() - hinge.y();
      const S x = Real(hinge.x()) + c * px - s * py, y = Real(hinge.y()) + s * px + c * py;
      const S across = x - Real(link.points[1].x());
      const S lift = y - std::sqrt(length * length - across * across) - Real(link.points[1].y());
      const auto arm = carried<S>(m, "arm1", hinge, Real(hinge.x()), Real(hinge.y()), c, s);
      const S stretch = lift - Real(spring.free);
      return Real(2) * amended(arm, speed) + Real(carried_mass) * g * lift +
             Real(0.5) * Real(spring.stiffness) * stretch * stretch;
    };
    const Real wanted = root([&](Real a) { return slope(potential, a); }, 0.2L, 1.2L);
    const Solution s = solve(m);
    CAPTURE(speed, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(stable(s));
    check_value(s, "arm1", wanted, 1e-10);
    check_value(s, "arm2", wanted, 1e-10);
  }
}

TEST_CASE("a chain hangs straight up to its first critical speed, then bows") {
  const double critical = 3.7657120752760553; // of 20 thin rods, worked out independently
  for (const double share : {0.5, 0.99, 0.9999}) {
    const Solution s = solve(hanging_chain(20, share * critical));
    CAPTURE(share);
    REQUIRE(s.status == Status::converged);
    CHECK(stable(s));
    for (int i = 1; i <= 20; ++i)
      CHECK(std::abs(value(s, "hinge" + std::to_string(i))) < 1e-12);
  }
  for (const double share : {1.0001, 1.01, 1.5}) {
    const Mechanism m = hanging_chain(20, share * critical);
    CAPTURE(share);
    const Solution plain = solve(m, nearest());
    REQUIRE(plain.status == Status::converged);
    CHECK(plain.stable == false);
    CHECK(std::abs(value(plain, "hinge1")) < 1e-12);
    const Solution s = solve(m);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(stable(s));
    CHECK(std::abs(value(s, "hinge1")) > 1e-3);
    CHECK_THAT(s.message, ContainsSubstring("unstable"));
  }
}
