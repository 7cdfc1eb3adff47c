// Froude's pendulum hangs by a sleeve on a shaft that turns: friction that falls as the sleeve slides faster
// drags it aside and, beyond a speed, keeps it swinging (Andronov, Vitt and Khaikin, Theory of Oscillators,
// 1966, section III.7). With friction M(v) at the sliding speed v, air damping c and the angle p,
//
//     I p'' + c p' + m g l sin p = M(w - p'),   sin p0 = M(w) / (m g l),
//     I s^2 + (c + M'(w)) s + m g l cos p0 = 0,   Hopf where M'(w) = -c, soft where M''' > 0
//
// for the terms of second order are even in p' and, alone, leave its motions closed. Friction stands here at
// the hinge to the ground, by w less the rate there: what it is at rest as a torque, the rest as a damper.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/periodic/periodic_state.hpp"
#include "engine/study/branch_grid.hpp"
#include "engine/study/hopf_curve.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double froude_mass = 1.2, froude_length = 0.3, froude_own = 0.01;
constexpr double froude_peak = 1.5, froude_at = 3; // friction at most (N m), at that speed (rad/s)
const double froude_inertia = froude_own + froude_mass * froude_length * froude_length,
             froude_moment = froude_mass * standard_gravity * froude_length;
const std::string of_shaft = "parameters.w", of_air = "parameters.c";

Mechanism froude_pendulum(double speed, double damping) {
  Mechanism m = read_scene(R"scene({"flyball": 2, "name": "Froude's pendulum", "gravity": [0, -9.80665, 0],
    "parameters": {"T": {"value": 1.5, "unit": "N m"}, "b": {"value": 3, "unit": "rad/s"},
      "w": {"value": 1, "unit": "rad/s"}, "c": {"value": 0.1, "unit": "N m s/rad"}},
    "bodies": [{"name": "shaft", "mass": 2, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.001]},
      {"name": "pendulum", "mass": 1.2, "position": [0, -0.3, 0], "inertia": [0.01, 0.01, 0.01]}],
    "joints": [
      {"name": "shaft", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "drive": {"speed": "=w"}},
      {"name": "swing", "type": "revolute", "bodies": ["ground", "pendulum"], "at": [0, 0, 0],
        "axis": [0, 0, 1],
        "damping_force":
          "=c*rate + 2*T*b*((rate - w)/((rate - w)^2 + b^2) + w/(w^2 + b^2))"}],
    "forces": [{"name": "drag", "type": "torque", "body": "pendulum", "frame": "world",
      "vector": [0, 0, "=2*T*b*w/(w^2 + b^2)"]}]})scene");
  set_parameter(m, of_shaft, speed);
  set_parameter(m, of_air, damping);
  return m;
}

// M = k v / (v^2 + b^2) and derivatives.
struct Sliding {
  double moment, first, third;
};
Sliding sliding(double v) {
  const double k = 2 * froude_peak * froude_at, b2 = froude_at * froude_at, below = v * v + b2;
  return {k * v / below, k * (b2 - v * v) / (below * below),
          -6 * k * (v * v * v * v - 6 * v * v * b2 + b2 * b2) / std::pow(below, 4)};
}

// At the steady angle.
double froude_frequency(double speed) {
  const double sine = sliding(speed).moment / froude_moment;
  return std::sqrt(froude_moment * std::sqrt(1 - sine * sine) / froude_inertia);
}

// The speeds at which M' = -c.
std::array<double, 2> froude_limits(double c) {
  const double k = 2 * froude_peak * froude_at, b2 = froude_at * froude_at;
  // c x^2 + (2 c b^2 - k) x + c b^4 + k b^2 = 0, x = v^2
  const double half = (k - 2 * c * b2) / 2, root = std::sqrt(half * half - c * (c * b2 * b2 + k * b2));
  return {std::sqrt((half - root) / c), std::sqrt((half + root) / c)};
}

} // namespace

TEST_CASE("Froude's pendulum hangs aside as the sleeve drags it, and swings about that", "[froude]") {
  for (const double w : {0.5, 3., 3.5, 6., 20., -6.}) {
    CAPTURE(w);
    const Solution s = solve(froude_pendulum(w, 0.1), nearest());
    REQUIRE(s.status == Status::converged);
    const Sliding m = sliding(w);
    const double angle = std::asin(m.moment / froude_moment);
    check_value(s, "swing", angle, 1e-10);
    const double half = (0.1 + m.first) / (2 * froude_inertia), frequency = froude_frequency(w);
    REQUIRE(s.eigenvalues);
    REQUIRE(s.eigenvalues->size() == 2);
    const std::complex<double> wanted(-half, std::sqrt(frequency * frequency - half * half));
    for (const std::complex<double> e : *s.eigenvalues)
      CHECK(std::min(std::abs(e - wanted), std::abs(e - std::conj(wanted))) < 1e-10);
    CHECK(s.stable == (half > 0));
  }
}

TEST_CASE("Froude's pendulum begins to hunt where M' = -c, softly, and ends hard", "[froude]") {
  const double c = 0.1;
  const std::array limits = froude_limits(c);
  const std::vector<Variation> over{{of_air, c, c, 1}};
  const GridBranches place = GridFollower(froude_pendulum(1, c), over, of_shaft, 1, 12, {}).follow(0);
  INFO(place.diagram.message);
  std::size_t found = 0;
  for (std::size_t i = 0; i < place.diagram.special.size(); ++i) {
    const SpecialPoint& s = place.diagram.special[i];
    if (s.type != SpecialPointType::hopf) continue;
    REQUIRE(found < 2);
    const double w = limits[found++], frequency = froude_frequency(w);
    CAPTURE(w);
    CHECK(s.at.parameter == Approx(w).epsilon(1e-10));
    REQUIRE(place.hunting[i]);
    const HopfPoint& hopf = *place.hunting[i];
    CHECK(hopf.frequency == Approx(frequency).epsilon(1e-9));
    REQUIRE(hopf.lyapunov);
    CHECK(*hopf.lyapunov == Approx(-sliding(w).third * frequency / (16 * froude_inertia)).epsilon(1e-6));
    CHECK(hopf.loss() == (found == 1 ? HopfLoss::soft : HopfLoss::hard));
  }
  CHECK(found == 2);
}

TEST_CASE("the boundary of hunting of Froude's pendulum is M' = -c, soft as far as M''' = 0", "[froude]") {
  const PlaneCurves found = hopf_curves(froude_pendulum(1, 0.1), {of_shaft, 3.1, 12}, {of_air, 0.05, 0.2});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1);
  for (const PlanePoint& p : found.curves[0].points)
    CHECK(p.y == Approx(-sliding(p.x).first).epsilon(1e-9));
  // It ends on the borders of the plane, without rounding.
  CHECK(found.curves[0].points.front().y == 0.05);
  CHECK(found.curves[0].points.back().x == 12);
  // x^2 - 6 x + 1 = 0, x = (v / b)^2.
  REQUIRE(found.curves[0].bautin.size() == 1);
  CHECK(found.curves[0].bautin[0].x == Approx(froude_at * std::sqrt(3 + std::sqrt(8.))).epsilon(1e-6));
}

TEST_CASE("Froude's pendulum keeps swinging as averaging says, beyond the limit", "[froude]") {
  const double c = 0.1;
  const double limit = froude_limits(c)[0];
  for (const double excess : {2e-3, 8e-3}) {
    CAPTURE(excess);
    const double w = limit * (1 + excess), frequency = froude_frequency(w);
    const PeriodicState s = find_periodic_state(froude_pendulum(w, c));
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    CHECK(s.drive_periods == 0);
    CHECK(s.stable == true);
    const auto swing = std::ranges::find(s.coordinates, "swing", &PeriodicCoordinate::joint);
    REQUIRE(swing != s.coordinates.end());
    // a' = -(c + M') / (2 I) a - M''' frequency^2 / (16 I) a^3, but for terms of a^5.
    const double a = (swing->range.most - swing->range.least) / 2;
    const double square = -8 * (c + sliding(w).first) / (sliding(w).third * frequency * frequency);
    CHECK(std::abs(a * a / square - 1) < 4 * square);
    CHECK(std::abs(s.period * frequency / (2 * std::numbers::pi) - 1) < square);
    // Motions beside it come to it at twice the rate at which small ones leave the steady state.
    REQUIRE(s.floquet.growth.size() == 1);
    CHECK(s.floquet.growth[0] == Approx((c + sliding(w).first) / froude_inertia).epsilon(4 * square));
  }
}

TEST_CASE("a sleeve on a shaft that turns drags its pendulum aside, whichever joint stands first",
          "[froude]") {
  for (const bool sleeve_first : {false, true})
    for (const double w : {4., -2.5}) {
      CAPTURE(sleeve_first, w);
      const double drag = 0.3;
      Mechanism m = froude_pendulum(w, 0);
      m.forces.clear();
      Joint swing = dampened(revolute("swing", "ground", "pendulum", {0, 0, 0}), 0.1),
            sleeve = dampened(revolute("sleeve", "shaft", "pendulum", {0, 0, 0}), drag);
      m.joints[1] = sleeve_first ? sleeve : swing;
      m.joints.push_back(sleeve_first ? swing : sleeve);
      const Solution s = solve(m);
      REQUIRE(s.status == Status::converged);
      check_value(s, "swing", std::asin(drag * w / froude_moment));
      CHECK(s.stable == true);
      REQUIRE(s.drive_torques.size() == 1);
      CHECK(s.drive_torques[0].value == Approx(drag * w).epsilon(1e-12));
    }
}

// Its own joint is the hinge to the ground, so that the sleeve closes the loop and turns on and on.
TEST_CASE("friction by a law in the sleeve is that by its sliding speed at the hinge", "[froude]") {
  const auto with_sleeve = [](double speed, bool sleeve_first, bool from_pendulum) {
    Mechanism m = froude_pendulum(speed, 0.1);
    m.forces.clear();
    Joint swing = dampened(revolute("swing", "ground", "pendulum", {0, 0, 0}), 0.1);
    Joint sleeve = revolute("sleeve", from_pendulum ? "pendulum" : "shaft",
                            from_pendulum ? "shaft" : "pendulum", {0, 0, 0});
    sleeve.coordinates[0].damping_force = 0;
    sleeve.formulas = {{"damping_force", "2*T*b*rate/(rate^2 + b^2)"}};
    m.joints[1] = sleeve_first ? sleeve : swing;
    m.joints.push_back(sleeve_first ? swing : sleeve);
    return m;
  };
  for (const double w : {0.5, 3.5, 6., -6.})
    for (const bool sleeve_first : {false, true})
      for (const bool from_pendulum : {false, true}) {
        CAPTURE(w, sleeve_first, from_pendulum);
        const Mechanism m = with_sleeve(w, sleeve_first, from_pendulum);
        const Solution s = solve(m, nearest()), hinge = solve(froude_pendulum(w, 0.1), nearest());
        INFO(s.message);
        REQUIRE(s.status == Status::converged);
        check_value(s, "swing", std::asin(sliding(w).moment / froude_moment), 1e-10);
        REQUIRE(s.eigenvalues);
        REQUIRE(s.eigenvalues->size() == 2);
        for (const std::complex<double> e : *s.eigenvalues)
          CHECK(std::ranges::any_of(*hinge.eigenvalues,
                                    [&](std::complex<double> x) { return std::abs(e - x) < 1e-9; }));
        CHECK(s.stable == hinge.stable);
        REQUIRE(s.drive_torques.size() == 1);
        CHECK(s.drive_torques[0].value == Approx(sliding(w).moment).epsilon(1e-10));
      }
  // Beyond the limit it runs into the same cycle.
  const double w = 1.01 * froude_limits(0.1)[0];
  const PeriodicState s = find_periodic_state(with_sleeve(w, false, false)),
                      hinge = find_periodic_state(froude_pendulum(w, 0.1));
  INFO(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  REQUIRE(hinge.status == PeriodicStatus::found);
  CHECK(s.period == Approx(hinge.period).epsilon(1e-7));
  REQUIRE(s.floquet.growth.size() == 1);
  CHECK(s.floquet.growth[0] == Approx(hinge.floquet.growth[0]).epsilon(1e-4));
}

TEST_CASE("a sleeve's law is told where it stands on a kink", "[froude]") {
  Mechanism m = froude_pendulum(4, 0);
  m.forces.clear();
  m.joints[1] = dampened(revolute("swing", "ground", "pendulum", {0, 0, 0}), 0.1);
  Joint sleeve = revolute("sleeve", "shaft", "pendulum", {0, 0, 0});
  sleeve.coordinates[0].damping_force = 0;
  sleeve.formulas = {{"damping_force", "0.1 N m s*rate + 0.2 N m s*max(rate + 4 rad/s, 0 rad/s) - 0.8 N m"}};
  m.joints.push_back(sleeve);
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  check_value(s, "swing", std::asin(1.2 / froude_moment)); // 0.4 N m and the 0.8 that leave none at rest
  CAPTURE(s.message);
  CHECK(s.message.find("The damper of sleeve stands on a kink of its law, where its damping jumps") !=
        std::string::npos);
}
