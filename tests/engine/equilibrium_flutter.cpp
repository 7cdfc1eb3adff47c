// Where undamped pairs of eigenvalues meet and where damped ones cross the imaginary axis, against closed
// forms; and states that gyroscopic forces keep although the potential falls from them.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/continuation/pair_crossing.hpp"
#include "engine/mechanism/address.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

using Real = long double;
using Polynomial = std::vector<Real>; // by rising powers

const std::string load = "forces.push.vector.2", speed = "joints.spin.drive.speed";

// Massless rods of 1 m on one another along z with a point mass at the end of each, hinged about y with equal
// springs of 1 N m/rad, pushed by 1 N that follows the last of them (Ziegler 1952).
Mechanism column(const std::vector<double>& masses, const std::vector<double>& dampers = {}) {
  Mechanism m;
  std::string below = "ground";
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const std::string name = "rod" + std::to_string(i);
    const auto base = static_cast<double>(i);
    m.bodies.push_back(body(name, masses[i], {0, 0, base + 1}));
    m.joints.push_back(
        sprung(revolute("hinge" + std::to_string(i), below, name, {0, 0, base}, {0, 1, 0}), 1));
    if (i < dampers.size()) m.joints.back().coordinates[0].damping = dampers[i];
    below = name;
  }
  Force push;
  push.name = "push";
  push.type = ForceType::force;
  push.frame = ForceFrame::body;
  push.body = below;
  push.vector = {0, 0, -1};
  m.forces = {push};
  return m;
}

// A mass on a spring and a damper that touches nothing else.
Mechanism with_bell(Mechanism m, double damping) {
  m.bodies.push_back(body("bell", 0.7, {3, 0, 0}));
  m.joints.push_back(
      dampened(sprung(prismatic("ring", "ground", "bell", {3, 0, 0}, {1, 0, 0}), 0.9), damping));
  return m;
}

// det(a - x b) of square matrices by its values at 0, 1, 2, ... (Newton's interpolation).
Polynomial characteristic(const Eigen::Matrix<Real, -1, -1>& a, const Eigen::Matrix<Real, -1, -1>& b) {
  const auto n = static_cast<std::size_t>(a.rows());
  Polynomial divided;
  for (std::size_t i = 0; i <= n; ++i)
    divided.push_back((a - static_cast<Real>(i) * b).determinant());
  for (std::size_t j = 1; j <= n; ++j)
    for (std::size_t i = n; i >= j; --i)
      divided[i] = (divided[i] - divided[i - 1]) / static_cast<Real>(j);
  Polynomial out{divided[n]};
  for (std::size_t i = n; i-- > 0;) { // out * (x - i) + divided[i]
    Polynomial next(out.size() + 1, 0);
    for (std::size_t k = 0; k < out.size(); ++k) {
      next[k + 1] += out[k];
      next[k] -= static_cast<Real>(i) * out[k];
    }
    next[0] += divided[i];
    out = next;
  }
  return out;
}

// The column's stiffness under the load p, in angles from the vertical.
Eigen::Matrix<Real, -1, -1> column_stiffness(Eigen::Index n, Real p) {
  Eigen::Matrix<Real, -1, -1> k = Eigen::Matrix<Real, -1, -1>::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    k(i, i) += i + 1 < n ? 2 : 1;
    if (i > 0) k(i, i - 1) = k(i - 1, i) = -1;
  }
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    k(i, i) -= p;
    k(i, n - 1) += p;
  }
  return k;
}

Eigen::Matrix<Real, -1, -1> column_mass(const std::vector<double>& masses) {
  const auto n = static_cast<Eigen::Index>(masses.size());
  Eigen::Matrix<Real, -1, -1> m = Eigen::Matrix<Real, -1, -1>::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index k = std::max(i, j); k < n; ++k)
        m(i, j) += static_cast<Real>(masses[static_cast<std::size_t>(k)]);
  return m;
}

Real discriminant(const Polynomial& c) {
  if (c.size() == 3) return c[1] * c[1] - 4 * c[2] * c[0];
  REQUIRE(c.size() == 4);
  return 18 * c[3] * c[2] * c[1] * c[0] - 4 * c[2] * c[2] * c[2] * c[0] + c[2] * c[2] * c[1] * c[1] -
         4 * c[3] * c[1] * c[1] * c[1] - 27 * c[3] * c[3] * c[0] * c[0];
}

std::vector<const SpecialPoint*> of_type(const ResponseDiagram& d, SpecialPointType type) {
  std::vector<const SpecialPoint*> out;
  for (const SpecialPoint& s : d.special)
    if (s.type == type) out.push_back(&s);
  return out;
}

void check_only(const Mechanism& m, const std::string& address, double from, double to, SpecialPointType type,
                Real wanted, double tolerance) {
  validate(m);
  const ResponseDiagram d = follow_branches(m, address, from, to);
  CAPTURE(d.message, d.special.size());
  REQUIRE(d.special.size() == 1);
  CHECK(word(d.special[0].type) == word(type));
  CAPTURE(d.special[0].at.parameter, static_cast<double>(wanted));
  CHECK(std::abs(static_cast<double>(d.special[0].at.parameter - wanted)) <= tolerance * std::abs(to - from));
}

// A top on a massless cross that turns with nothing, driven about its own axis; or, `turning`, on one that a
// driven spindle carries.
Mechanism top(double rate, bool turning = false) {
  Mechanism m;
  m.gravity = {0, 0, -standard_gravity};
  m.bodies = {body("cross", 0, {0, 0, 0}), body("top", 2, {0, 0, 0.15}, {0.015, 0.015, 0.02})};
  Joint cross = joint(JointType::universal, "tip", turning ? "spindle" : "ground", turning ? "top" : "cross",
                      {0, 0, 0}, {1, 0, 0});
  cross.axis2 = {0, 1, 0};
  if (turning) {
    m.bodies[0] = body("spindle", 1, {0, 0, 0}, {0.1, 0.1, 0.1});
    m.joints = {spin(rate, {0, 0, 1}), cross};
  } else {
    m.joints = {cross, driven(revolute("spin", "cross", "top", {0, 0, 0}, {0, 0, 1}), rate)};
  }
  return m;
}
const double top_enough = 2 * std::sqrt((0.015 + 2 * 0.15 * 0.15) * 2 * standard_gravity * 0.15) / 0.02;

} // namespace

TEST_CASE("undamped pairs flutter where they meet", "[branches][flutter]") {
  SECTION("Ziegler's column") {
    for (const std::vector<double>& masses : {std::vector<double>{2, 1}, {1, 1}, {3.7, 0.4}}) {
      const auto mass = column_mass(masses);
      const auto meeting = [&](Real p) { return discriminant(characteristic(column_stiffness(2, p), mass)); };
      Real high = 0.2L;
      while (meeting(high) > 0)
        high += 0.01L;
      const Real wanted = root(meeting, high - 0.01L, high);
      CAPTURE(masses);
      const auto beyond = static_cast<double>(-wanted - 1);
      check_only(column(masses), load, -0.1, beyond, SpecialPointType::flutter, -wanted, 1e-10);
      check_only(column(masses), load, beyond, -0.1, SpecialPointType::flutter, -wanted, 1e-10);
    }
    const Real told = root(
        [](Real p) {
          return discriminant(characteristic(column_stiffness(2, p), column_mass({2, 1})));
        },
        0.5L, 3.);
    CHECK(std::abs(static_cast<double>(told - (3.5L - std::sqrt(2.L)))) < 1e-15);
  }
  SECTION("three rods") {
    const std::vector<double> masses{1, 1.3, 0.8};
    const auto mass = column_mass(masses);
    const auto meeting = [&](Real p) { return discriminant(characteristic(column_stiffness(3, p), mass)); };
    Real high = 0.3L;
    while (meeting(high) > 0)
      high += 0.01L;
    const Real wanted = root(meeting, high - 0.01L, high);
    check_only(column(masses), load, -0.1, static_cast<double>(-high - 0.3L), SpecialPointType::flutter,
               -wanted, 1e-10);
  }
  SECTION("whatever is damped elsewhere") {
    for (const double damping : {1e-3, 0.2, 5.})
      check_only(with_bell(column({2, 1}), damping), load, -0.1, -3, SpecialPointType::flutter,
                 -(3.5L - std::sqrt(2.L)), 1e-10);
  }
  SECTION("two equal tops at once") {
    Mechanism m = top(2 * top_enough, true);
    m.bodies.push_back(m.bodies[1]);
    m.bodies[2].name = "second";
    m.bodies[2].position.z() += 1;
    m.joints.push_back(m.joints[1]);
    m.joints[2].name = "second";
    m.joints[2].bodies[1] = "second";
    m.joints[2].at.z() += 1;
    check_only(m, speed, 2 * top_enough, 0.7 * top_enough, SpecialPointType::flutter, top_enough, 1e-10);
  }
  SECTION("a top that spins too slowly") {
    for (const bool turning : {false, true}) {
      CAPTURE(turning);
      const ResponseDiagram d =
          follow_branches(top(2 * top_enough, turning), speed, 2 * top_enough, 0.5 * top_enough);
      const auto flutter = of_type(d, SpecialPointType::flutter);
      CAPTURE(d.message);
      REQUIRE(flutter.size() == 1);
      CHECK(std::abs(flutter[0]->at.parameter - top_enough) <= 1e-10 * 1.5 * top_enough);
      CHECK(of_type(d, SpecialPointType::hopf).empty());
    }
  }
}

TEST_CASE("a damped pair crosses at Hurwitz's boundary", "[branches][flutter]") {
  const std::vector<double> masses{2, 1};
  for (const std::vector<double>& d :
       {std::vector<double>{0.1, 0.1}, {0.3, 0.02}, {1e-4, 1e-4}, {1e-5, 3e-5}}) {
    const auto mass = column_mass(masses);
    // Of det(M s^2 + C s + K) = a0 s^4 + ... + a4: a1 a2 a3 = a0 a3^2 + a1^2 a4.
    const auto hurwitz = [&](Real p) {
      const auto k = column_stiffness(2, p);
      const Real c11 = static_cast<Real>(d[0]) + static_cast<Real>(d[1]), c12 = -static_cast<Real>(d[1]);
      const auto times = [](const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
        std::array<Real, 5> out{};
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j)
            out[i + j] += a[i] * b[j];
        return out;
      };
      const auto diagonal = times({mass(0, 0), c11, k(0, 0)}, {mass(1, 1), -c12, k(1, 1)}),
                 other = times({mass(0, 1), c12, k(0, 1)}, {mass(1, 0), c12, k(1, 0)});
      std::array<Real, 5> a{};
      for (std::size_t i = 0; i < 5; ++i)
        a[i] = diagonal[i] - other[i];
      return (a[1] * a[2] * a[3] - a[0] * a[3] * a[3] - a[1] * a[1] * a[4]) /
             (static_cast<Real>(d[0]) * static_cast<Real>(d[0]));
    };
    const Real wanted = root(hurwitz, 0.2L, 3.L);
    CAPTURE(d);
    check_only(column(masses, d), load, -0.1, -3, SpecialPointType::hopf, -wanted, 1e-8);
  }
}

TEST_CASE("spectra tell what leaves the axis", "[flutter]") {
  using C = std::complex<double>;
  const Spectrum met{C(1e-3, 2), C(1e-3, -2), C(-1e-3, 2), C(-1e-3, -2), C(0, 5), C(0, -5)};
  CHECK(right_of_axis(met, false) == 2);
  auto crossings = possible_crossings(met, 2, false);
  REQUIRE(crossings.size() == 2);
  CHECK(crossings[0].coalescence);
  CHECK(std::abs(crossings[0].at - C(0, 2)) < 1e-12);
  CHECK(*crossing_value(met, crossings[0]) == Approx(4e-6));
  CHECK(*crossing_value({C(0, 1.9), C(0, 2.1), C(0, -1.9), C(0, -2.1)}, crossings[0]) == Approx(-0.04));
  const Spectrum damped{C(1e-3, 2), C(1e-3, -2), C(-2e-3, 2), C(-2e-3, -2)};
  crossings = possible_crossings(damped, 2, false);
  REQUIRE(crossings.size() == 1);
  CHECK_FALSE(crossings[0].coalescence);
  CHECK(possible_crossings({C(1, 0), C(-1, 0), C(0, 2), C(0, -2)}, 1, false).empty());
  CHECK(right_of_axis({C(1e-9, 2), C(-1e-9, 2.0000001), C(1e-9, -2)}, false) == 0);
  CHECK(right_of_axis({}, false) == 0);
}

TEST_CASE("a sleeping top stays where it is drawn", "[gyroscopic]") {
  for (const bool turning : {false, true})
    for (const double share : {1.01, 1.5, 4.}) {
      CAPTURE(turning, share);
      const Solution s = solve(top(share * top_enough, turning));
      CAPTURE(s.message);
      REQUIRE(s.status == Status::converged);
      CHECK_FALSE(s.stable.has_value());
      REQUIRE(s.stability_reason.has_value());
      CHECK(*s.stability_reason == StabilityReason::gyroscopic_only);
      CHECK_FALSE(s.fallback.has_value());
      CHECK(s.message.find("any damping") != std::string::npos);
      CHECK(s.message.find("downhill") == std::string::npos);
      check_value(s, "tip", 0, 1e-12, 0);
    }
}

TEST_CASE("a sleeping top of unequal moments stays, too: its multipliers judge", "[gyroscopic][floquet]") {
  const Solution s = solve(stored_case("asymmetric_sleeping_top"));
  CAPTURE(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stability_reason == StabilityReason::floquet);
  CHECK(s.stable == true);
  CHECK_FALSE(s.fallback.has_value());
  Mechanism slow = stored_case("asymmetric_sleeping_top");
  set_parameter(slow, "joints.s.drive.speed", 20);
  const Solution fallen = solve(slow);
  CAPTURE(fallen.message);
  CHECK(fallen.poses.back().position.z() < 0);
}

TEST_CASE("a top too slow to sleep goes downhill", "[gyroscopic]") {
  for (const bool turning : {false, true}) {
    const Solution s = solve(top(0.99 * top_enough, turning));
    CAPTURE(turning, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable != false);
    CHECK(s.poses[1].position.z() < 0.1);
  }
}

TEST_CASE("any damping in what falls wakes a sleeping top", "[gyroscopic]") {
  for (const double damping : {1., 1e-3, 1e-6, 1e-10, 1e-13})
    for (const int which : {0, 1}) {
      CAPTURE(damping, which);
      Mechanism m = top(1.5 * top_enough, true);
      m.joints[1].coordinates[static_cast<std::size_t>(which)].damping = damping;
      const Solution near = solve(m, nearest());
      REQUIRE(near.status == Status::converged);
      CHECK(near.stable == false);
      CHECK(near.stability_reason == StabilityReason::unstable);
      const Solution s = solve(m);
      REQUIRE(s.status == Status::converged);
      CHECK(s.poses[1].position.z() < 0.1);
    }
  SECTION("but not a damper elsewhere") {
    const Solution s = solve(with_bell(top(1.5 * top_enough, true), 0.3));
    REQUIRE(s.status == Status::converged);
    CHECK(s.stability_reason == StabilityReason::gyroscopic_only);
  }
}

TEST_CASE("what no gyroscopic force keeps goes downhill as ever", "[gyroscopic]") {
  const Solution chain = solve(hanging_chain(5, 12));
  CHECK(stable(chain));
  CHECK(std::abs(value(chain, "hinge1")) > 0.1);
  CHECK(chain.message.find("downhill") != std::string::npos);
  // A spherical pendulum that hangs straight does not feel its spindle turn; a hinged one does.
  Mechanism free_bob = conical(0.7, 0, 10);
  free_bob.joints[1] = joint(JointType::universal, "swing", "spindle", "bob", {0, 0, 0}, {1, 0, 0});
  free_bob.joints[1].axis2 = {0, 0, 1};
  const Solution hanging = solve(free_bob);
  CAPTURE(hanging.message);
  CHECK(hanging.stability_reason == StabilityReason::gyroscopic_only);
  CHECK(std::abs(value(hanging, "swing", 0)) < 1e-12);
  const Solution hinged = solve(conical(0.7, 0, 10));
  CHECK(stable(hinged));
  CHECK(std::abs(value(hinged, "swing")) > 1);
}
