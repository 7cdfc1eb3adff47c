// Shafts left to themselves: their speeds against closed forms, against the same state at prescribed speed
// and against damped motions that keep their momentum; their stability against Routh's potential by hand.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/report.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/study/design.hpp"
#include "engine/system/motion.hpp"
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <random>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

double found_speed(const Solution& s, std::string_view joint, int index = 0) {
  INFO(s.message);
  return coordinate(s, joint, index).speed.value();
}

Slider slider(const std::string& address, double from, double to) {
  Slider out;
  out.parameter = address;
  out.from = from;
  out.to = to;
  return out;
}

Joint left_to_itself(Joint j, double speed) {
  Drive& drive = j.coordinates[0].drive.emplace();
  drive.speed = speed;
  drive.keeps = DriveKeeps::momentum;
  return j;
}

// A ring of 1 kg on a rod that spins, pulled inwards by a spring: J w = (J0 + m r^2) w with the ring where it
// is drawn, and k (r - free) = m r w^2.
struct RingOnRod {
  static constexpr double hub = 0.3, stiffness = 100, free = 0.2, drawn = 0.25, damping = 4;
  double momentum;
  explicit RingOnRod(double speed) : momentum((hub + drawn * drawn) * speed) {}
  double speed(double r) const { return momentum / (hub + r * r); }
  double radius() const {
    double r = drawn;
    for (int i = 0; i < 100; ++i) {
      const double w = speed(r), slope = -2 * r * w / (hub + r * r);
      const double f = stiffness * (r - free) - r * w * w;
      r -= f / (stiffness - w * w - 2 * r * w * slope);
    }
    return r;
  }
  // Of Routh's potential V + H^2 / 2 J.
  double routh_stiffness(double r) const {
    const double j = hub + r * r, w = momentum / j;
    return stiffness - w * w + 4 * r * r * w * w / j;
  }
  static Mechanism mechanism(double speed) {
    Mechanism m;
    m.bodies = {body("rod", 2, {0, 0, 0}, {0.1, hub, 0.1}), body("ring", 1, {drawn, 0, 0})};
    m.joints = {left_to_itself(revolute("spin", "ground", "rod", {0, 0, 0}, {0, 1, 0}), speed),
                joint(JointType::prismatic, "slide", "rod", "ring", {drawn, 0, 0}, {1, 0, 0})};
    Coordinate& slide = m.joints[1].coordinates[0];
    slide.drawn = drawn;
    slide.damping = damping;
    slide.spring = CoordinateSpring{stiffness, free};
    m.sliders = {slider("joints.spin.drive.speed", 0.1, 12)};
    return m;
  }
};

// The same with the speed prescribed.
Mechanism at_speed(Mechanism m, std::size_t joint, double speed) {
  m.joints[joint].coordinates[0].drive = Drive{.speed = speed};
  return m;
}

} // namespace

TEST_CASE("a ring on a rod left to itself: it slows down as the ring goes out", "[momentum]") {
  const RingOnRod ring(7);
  const Mechanism m = RingOnRod::mechanism(7);
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double r = ring.radius();
  CHECK_THAT(value(s, "slide"), WithinRel(r, 1e-13));
  CHECK_THAT(found_speed(s, "spin"), WithinRel(ring.speed(r), 1e-13));
  CHECK(found_speed(s, "spin") < 7);
  CHECK(std::abs(found_speed(s, "spin") - ring.speed(r)) <=
        coordinate(s, "spin").speed_error + 1e-14 * ring.speed(r));
  CHECK(s.stable == true);
  CHECK(s.stability_reason == StabilityReason::minimum);
  // s^2 + c s + K = 0: neither the phase nor the states of other momenta are among them.
  REQUIRE(s.eigenvalues);
  REQUIRE(s.eigenvalues->size() == 2);
  const double k = ring.routh_stiffness(r);
  const Complex root =
      -RingOnRod::damping / 2 + std::sqrt(Complex(RingOnRod::damping * RingOnRod::damping / 4 - k));
  CHECK(std::min(std::abs((*s.eigenvalues)[0] - root), std::abs((*s.eigenvalues)[1] - root)) < 1e-9);
  // At constant speed the ring is held by less.
  REQUIRE(s.at_constant_speed);
  CHECK(s.at_constant_speed->stable == true);
  CHECK(s.drive_torques.at(0).value == Approx(0).margin(1e-12));
}

TEST_CASE("rates of what is left to itself with the given speed, a length and a spring", "[momentum]") {
  Mechanism m = RingOnRod::mechanism(7);
  m.sliders.push_back(slider("joints.slide.spring.stiffness", 50, 200));
  m.sliders.push_back(slider("bodies.ring.mass", 0.5, 2));
  m.sliders.push_back(slider("bodies.rod.inertia.1", 0.1, 1));
  m.sliders.push_back(slider("bodies.ring.position.0", 0.1, 1));
  const Solution s = Analysis(m).solve();
  REQUIRE(s.sensitivities.size() == m.sliders.size());
  for (const Sensitivity& x : s.sensitivities) {
    CAPTURE(x.address);
    const double at = get_parameter(m, x.address), h = 1e-4 * at;
    const auto there = [&](double number) {
      Mechanism moved = m;
      set_parameter(moved, x.address, number);
      return Analysis(moved).solve();
    };
    const Solution above = there(at + h), below = there(at - h);
    REQUIRE(x.rates.size() == 2);
    for (const Sensitivity::Rate& rate : x.rates) {
      const double difference = rate.speed ? found_speed(above, rate.joint) - found_speed(below, rate.joint)
                                           : value(above, rate.joint) - value(below, rate.joint);
      CHECK(std::abs(rate.value - difference / (2 * h)) < 1e-6 * (1 + std::abs(rate.value)));
    }
  }
}

TEST_CASE("branches and design over the speed that gives the momentum", "[momentum][branches]") {
  const Mechanism m = RingOnRod::mechanism(7);
  const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 1, 12);
  INFO(d.message);
  REQUIRE(d.branches.size() == 1);
  REQUIRE(d.branches[0].points.size() > 3);
  for (const ResponsePoint& point : d.branches[0].points) {
    const double r = RingOnRod(point.parameter).radius();
    for (const CoordinateSolution& c : point.coordinates)
      if (c.joint == "slide") CHECK_THAT(c.value, WithinRel(r, 1e-9));
    CHECK(point.stable == true);
  }
  const DesignAnswer answer = design(m, "joints.spin.drive.speed", 1, 12, "slide", 0.3);
  REQUIRE(answer.status == Status::converged);
  CHECK_THAT(RingOnRod(answer.solutions[0].parameter).radius(), WithinRel(0.3, 1e-10));
}

TEST_CASE("Haug's governor left to itself settles where its momentum says", "[momentum]") {
  Mechanism m = shipped("governor");
  m.joints[0].coordinates[0].drive->keeps = DriveKeeps::momentum;
  m.joints[0].coordinates[0].drive->speed = 12;
  m.bodies[0].inertia = {0.5, 1, 0.5}; // light, so that the balls are felt
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  const double speed = found_speed(s, "spin");
  CHECK(std::abs(speed - 12) > 1e-3);
  const Solution there = Analysis(at_speed(m, 0, speed)).solve();
  for (const char* joint : {"arm1", "arm2", "slide"})
    CHECK(std::abs(value(s, joint) - value(there, joint)) < 1e-12);
  // The momentum is what that of the drawn pose is.
  const double arm = 0.16, fixed = 1 + 0.125 + 2 * 0.1;
  const auto inertia = [&](double angle) { return fixed + 2 * std::pow(arm * std::cos(angle), 2); };
  CHECK_THAT(speed * inertia(value(s, "arm1")), WithinRel(12 * inertia(0), 1e-11));
  CHECK(s.stable == true);

  SimulationOptions options;
  options.duration = 60;
  options.rate = 1;
  options.at = {{"slide", 0.13}};
  const Run run = simulate(m, options);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(distance_from(run, run.time.size() - 1, s) < 1e-6);
  options.start = Start::equilibrium;
  options.at.clear();
  options.duration = 5;
  CHECK(distance_from(simulate(m, options), 5, s) < 1e-9);
}

TEST_CASE("a heavy top left to itself: steady precession with both momenta kept", "[momentum]") {
  const double inertia = 0.02, across = 0.015 + 2 * 0.15 * 0.15, weight = 2 * standard_gravity * 0.15;
  Mechanism m;
  m.gravity = {0, 0, -standard_gravity};
  m.bodies = {body("yoke", 0), body("ring", 0),
              body("top", 2, {0, -0.15 * std::sin(0.6), 0.15 * std::cos(0.6)})};
  const Vec3 along(0, -std::sin(0.6), std::cos(0.6));
  m.bodies[2].rotation = Quat(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
  m.bodies[2].inertia = {0.015, 0.015, 0.02};
  m.joints = {left_to_itself(revolute("precession", "ground", "yoke", {0, 0, 0}, {0, 0, 1}), 1.5),
              revolute("nutation", "yoke", "ring", {0, 0, 0}, {1, 0, 0}),
              left_to_itself(revolute("spin", "ring", "top", {0, 0, 0}, along), 180)};
  m.joints[1].coordinates[0].drawn = 0.6;
  validate(m);
  // Of the drawn pose: p_psi = I3 (r + p cos a), p_phi = I1 p sin^2 a + p_psi cos a.
  const double of_spin = inertia * (180 + 1.5 * std::cos(0.6));
  const double of_precession = across * 1.5 * std::pow(std::sin(0.6), 2) + of_spin * std::cos(0.6);
  const auto precession = [&](double a) {
    return (of_precession - of_spin * std::cos(a)) / (across * std::pow(std::sin(a), 2));
  };
  // m g l = p_psi p - I1 p^2 cos a
  double a = 0.6;
  const auto left = [&](double at) {
    const double p = precession(at);
    return weight - of_spin * p + across * p * p * std::cos(at);
  };
  for (int i = 0; i < 60; ++i)
    a -= left(a) * 2e-6 / (left(a + 1e-6) - left(a - 1e-6));
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "nutation"), WithinRel(a, 1e-10));
  CHECK_THAT(found_speed(s, "precession"), WithinRel(precession(a), 1e-10));
  CHECK_THAT(found_speed(s, "spin"), WithinRel(of_spin / inertia - precession(a) * std::cos(a), 1e-11));
  CHECK(s.stability_reason == StabilityReason::minimum);
  // One nutation is left of six eigenvalues: w^2 = V''(a) / I1 by differences of Routh's potential.
  const auto potential = [&](double at) {
    return weight * std::cos(at) +
           std::pow(of_precession - of_spin * std::cos(at), 2) / (2 * across * std::pow(std::sin(at), 2));
  };
  const double h = 1e-4;
  const double curvature = (potential(a + h) - 2 * potential(a) + potential(a - h)) / (h * h);
  REQUIRE(s.eigenvalues->size() == 2);
  CHECK_THAT(std::abs(s.eigenvalues->back().imag()), WithinRel(std::sqrt(curvature / across), 1e-5));
}

TEST_CASE("all states of a top in a heavy yoke that keep its momenta are found, whichever way they turn it",
          "[momentum]") {
  // Routh's potential V(a) = m g l cos a + (p_phi - p_psi cos a)^2 / (2 (J + I1 sin^2 a)) on a circle: its
  // stationary places are those of the mechanism, upright and hanging among them, and even in number.
  const double mass = 2, length = 0.15, inertia = 0.02, across = 0.015 + mass * length * length;
  for (const auto& [yoke, spin] : {std::pair{0.01, 180.}, {0.01, -180.}, {1e-3, 180.}, {1e-3, 18.}}) {
    CAPTURE(yoke, spin);
    Mechanism m;
    m.gravity = {0, 0, -standard_gravity};
    m.bodies = {body("yoke", 0, {0, 0, 0}, {0, 0, yoke}), body("ring", 0),
                body("top", mass, {0, -length * std::sin(0.6), length * std::cos(0.6)})};
    m.bodies[2].rotation = Quat(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
    m.bodies[2].inertia = {0.015, 0.015, inertia};
    m.joints = {
        left_to_itself(revolute("precession", "ground", "yoke", {0, 0, 0}, {0, 0, 1}), 1.5),
        dampened(revolute("nutation", "yoke", "ring", {0, 0, 0}, {1, 0, 0}), 0.01),
        left_to_itself(revolute("spin", "ring", "top", {0, 0, 0}, {0, -std::sin(0.6), std::cos(0.6)}), spin)};
    m.joints[1].coordinates[0].drawn = 0.6;
    validate(m);
    const double of_spin = inertia * (spin + 1.5 * std::cos(0.6));
    const auto inertia_about_axis = [&, of_yoke = yoke](double a) {
      return of_yoke + across * std::pow(std::sin(a), 2);
    };
    const double of_precession = inertia_about_axis(0.6) * 1.5 + of_spin * std::cos(0.6);
    const auto precession = [&](double a) {
      return (of_precession - of_spin * std::cos(a)) / inertia_about_axis(a);
    };
    const auto slope = [&](double a) {
      const double p = precession(a);
      return std::sin(a) * (-mass * standard_gravity * length + of_spin * p - across * p * p * std::cos(a));
    };
    const std::vector<Solution> found = Analysis(m).solve_all().equilibria;
    constexpr int steps = 20000;
    std::size_t count = 0;
    for (int i = 0; i < steps; ++i) {
      double from = -3.1 + 2 * std::numbers::pi * i / steps,
             to = -3.1 + 2 * std::numbers::pi * (i + 1) / steps;
      if (slope(from) * slope(to) > 0) continue;
      for (int k = 0; k < 60; ++k) {
        const double middle = (from + to) / 2;
        (slope(from) * slope(middle) > 0 ? from : to) = middle;
      }
      ++count;
      CAPTURE(from, precession(from));
      CHECK(std::ranges::any_of(found, [&](const Solution& s) {
        return std::abs(std::remainder(value(s, "nutation") - from, 2 * std::numbers::pi)) < 1e-9 &&
               std::abs(found_speed(s, "precession") - precession(from)) <
                   1e-8 * (1 + std::abs(precession(from)));
      }));
    }
    CHECK(count >= 4);
    CHECK(found.size() == count);
  }
}

TEST_CASE("a top left to itself is as stable however it lies in space", "[momentum]") {
  Mechanism m;
  m.bodies = {body("yoke", 0), body("ring", 0), body("top", 1, {0.5, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {left_to_itself(revolute("precession", "ground", "yoke", {0, 0, 0}), 3),
              revolute("nutation", "yoke", "ring", {0, 0, 0}),
              left_to_itself(revolute("spin", "ring", "top", {0, 0, 0}), 120)};
  std::mt19937 dice(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 12; ++i) {
    const Mat3 turn = Quat(normal(dice), normal(dice), normal(dice), normal(dice)).normalized().matrix();
    const Vec3 along = Eigen::AngleAxisd(0.7, Vec3::UnitX()) * Vec3::UnitZ();
    m.gravity = turn * Vec3(0, 0, -standard_gravity);
    m.bodies[2].position = turn * (0.5 * along);
    m.bodies[2].rotation = Quat(turn) * Quat(Eigen::AngleAxisd(0.7, Vec3::UnitX()));
    m.joints[0].axis = turn * Vec3::UnitZ();
    m.joints[1].axis = turn * Vec3::UnitX();
    m.joints[2].axis = turn * along;
    const Solution s = Analysis(m).solve();
    CAPTURE(i, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stability_reason == StabilityReason::minimum);
  }
}

TEST_CASE("random mechanisms left to themselves have the state of their speed found, prescribed",
          "[momentum][random]") {
  int found = 0;
  const std::uint32_t seeds = few_or_all(20u, 80u);
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    CAPTURE(seed);
    const Mechanism prescribed = reference::random_sprung_mechanism(seed);
    const Solution there = Analysis(prescribed).solve();
    if (there.status != Status::converged || there.drive_torques.size() != 1 ||
        there.drive_torques[0].varying || !there.neutral.empty())
      continue;
    const DriveTorque& torque = there.drive_torques[0];
    Mechanism m = prescribed;
    Coordinate& c = m.joints[static_cast<std::size_t>(joint_index(m, torque.joint))]
                        .coordinates[static_cast<std::size_t>(torque.index)];
    if (c.drive->speed == 0 || c.damping != 0) continue;
    c.drive->keeps = DriveKeeps::momentum;
    validate(m);
    const Solution s = Analysis(m).solve();
    if (s.status != Status::converged) {
      CHECK_FALSE(s.message.empty());
      continue;
    }
    ++found;
    // Two ways to the momentum: a composite-body mass matrix in both poses, and the row of the balance.
    const double speed = found_speed(s, torque.joint, torque.index);
    Mechanism same = m;
    Coordinate& turned = same.joints[static_cast<std::size_t>(joint_index(m, torque.joint))]
                             .coordinates[static_cast<std::size_t>(torque.index)];
    turned.drive->keeps = DriveKeeps::speed;
    turned.drive->speed = speed;
    SolveOptions nearest;
    nearest.nearest = true;
    for (const CoordinateSolution& x : s.coordinates)
      if (!x.driven && !x.dependent) nearest.start.emplace_back(coordinate_label(x), x.value);
    const Solution again = Analysis(same).solve(nearest);
    REQUIRE(again.status == Status::converged);
    for (const CoordinateSolution& x : again.coordinates)
      if (!x.driven && !x.dependent)
        CHECK(std::abs(x.value - value(s, x.joint, x.index)) < 1e-7 * (1 + std::abs(x.value)));
    // The momentum about the drive's coordinate, along its motion: twice the kinetic energy by the speed.
    const auto energy = [](const Mechanism& of, bool drawn, const Solution& at) {
      const System system = compile_for_drives(of);
      Parameters p;
      bind(system, of, p);
      Eigen::VectorXd q;
      drawn_configuration(system, p, q);
      if (!drawn) {
        std::vector<std::pair<std::string, double>> start;
        for (const CoordinateSolution& x : at.coordinates)
          if (!x.driven && !x.dependent) start.emplace_back(coordinate_label(x), x.value);
        set_start(system, p, start, q);
      }
      Kinematics<double> k;
      forward<double>(system, p, q, 0, k);
      return kinetic_energy(system, p, k);
    };
    const double given = 2 * energy(prescribed, true, there) / c.drive->speed;
    const double kept = 2 * energy(same, false, s) / speed;
    CHECK(std::abs(kept - given) < 1e-8 * std::abs(given));
  }
  CAPTURE(found);
  CHECK(found > static_cast<int>(seeds / 8));
}

TEST_CASE("rows of kept momenta: their derivatives against differences", "[momentum][random]") {
  int looked = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    reference::RandomOptions options;
    options.drives = seed % 2 == 0 ? reference::RandomDrives::root : reference::RandomDrives::several;
    options.rotated_bodies = true;
    Mechanism m = reference::random_mechanism(seed, options);
    for (Joint& joint : m.joints)
      for (Coordinate& c : joint.coordinates)
        if (c.drive) {
          c.drive->keeps = DriveKeeps::momentum;
          c.damping = 0;
        }
    if (std::ranges::any_of(m.joints, [](const Joint& j) { return j.type == JointType::gear; })) continue;
    const System system = compile(m);
    if (system.torques.empty()) continue;
    ++looked;
    Parameters p;
    bind(system, m, p);
    Eigen::VectorXd q;
    drawn_configuration(system, p, q);
    std::mt19937 random(seed);
    Eigen::VectorXd step(system.nv);
    for (double& x : step)
      x = std::uniform_real_distribution(-0.2, 0.2)(random);
    retract<double>(system, step, q);
    const Eigen::VectorXd lambda = Eigen::VectorXd::Zero(system.rows);
    const auto balance = [&](const Eigen::VectorXd& moved) {
      Kinematics<double> k;
      forward<double>(system, p, moved, 0, k);
      Residual<double> residual;
      evaluate_residual<double>(system, p, moved, lambda, k, residual);
      return residual.f;
    };
    Kinematics<double> k;
    forward<double>(system, p, q, 0, k);
    Residual<double> residual;
    evaluate_residual<double>(system, p, q, lambda, k, residual);
    Linearization l;
    linearize(system, p, q, lambda, k, residual, l);
    for (int j = 0; j < system.nv; ++j) {
      CAPTURE(j);
      const auto central = [&](double h) -> Eigen::VectorXd {
        Eigen::VectorXd above = q, below = q;
        retract<double>(system, h * Eigen::VectorXd::Unit(system.nv, j), above);
        retract<double>(system, -h * Eigen::VectorXd::Unit(system.nv, j), below);
        return (balance(above) - balance(below)) / (2 * h);
      };
      const Eigen::VectorXd difference = (4 * central(5e-4) - central(1e-3)) / 3;
      for (const DriveTorqueElement& torque : system.torques) {
        const int i = system.links[static_cast<std::size_t>(torque.link)].v;
        const double size = 1 + l.stiffness.row(i).cwiseAbs().maxCoeff();
        CHECK(std::abs(l.stiffness(i, j) - difference[i]) < 1e-8 * size);
      }
    }
  }
  CAPTURE(looked);
  CHECK(looked > 15);
}

TEST_CASE("what is left to itself and pushed is refused with the reason", "[momentum]") {
  Mechanism m = RingOnRod::mechanism(7);
  SECTION("drag") {
    Force drag;
    drag.name = "air";
    drag.type = ForceType::drag;
    drag.body = "ring";
    drag.linear = 0.5;
    m.forces = {drag};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::no_steady_state);
    CHECK_THAT(s.message,
               ContainsSubstring("spin is left to itself, but") && ContainsSubstring("hold it back"));
  }
  SECTION("a weight that turns with it") {
    m.gravity = {0, 0, -1};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::no_steady_state);
  }
  SECTION("mistakes, each at its place") {
    const auto mistake = [&] {
      const auto found = find_mistakes(m);
      REQUIRE(found.size() == 1);
      return found[0];
    };
    Coordinate& spin = m.joints[0].coordinates[0];
    spin.damping = 1;
    CHECK(mistake().where() == "joints.spin.damping");
    spin.damping = 0;
    spin.drive->torque = 3;
    CHECK(mistake().where() == "joints.spin.drive.keeps");
    spin.drive->torque.reset();
    spin.drive->load = 3;
    CHECK(mistake().where() == "joints.spin.drive.load");
  }
  SECTION("in a file") {
    const std::string text = write_scene(m);
    CHECK_THAT(text, ContainsSubstring("\"keeps\": \"momentum\"") && ContainsSubstring("\"flyball\": 2"));
    CHECK(read_scene(text) == m);
  }
  SECTION("a drive by torque on it") {
    m.bodies.push_back(body("wheel", 1, {0, 0.1, 0}, {0.1, 0.2, 0.1}));
    Joint wheel = revolute("wheel", "rod", "wheel", {0, 0.1, 0}, {0, 1, 0});
    wheel.coordinates[0].drive = Drive{.speed = 3, .torque = 1.};
    m.joints.push_back(wheel);
    CHECK_THROWS_WITH(Analysis(m), ContainsSubstring("expected speed, or no drive by torque"));
  }
}

TEST_CASE("a motion that begins standing still in the world begins with the momentum that is kept",
          "[momentum]") {
  // A rod with a ball on a hinge along the same axis, right above this: the ball stands, the rod has it all.
  constexpr double hub = 0.3, far = 0.4, drawn = 5;
  Mechanism m;
  m.bodies = {body("rod", 2, {0, 0, 0}, {0.1, hub, 0.1}), body("ball", 1, {far, 0, 0})};
  m.joints = {left_to_itself(revolute("spin", "ground", "rod", {0, 0, 0}, {0, 1, 0}), drawn),
              revolute("hinge", "rod", "ball", {0, 0, 0}, {0, 1, 0})};
  m.joints[1].coordinates[0].spring = CoordinateSpring{3, 0};
  m.joints[1].coordinates[0].damping = 0.2;
  SimulationOptions options;
  options.start = Start::drawn;
  options.duration = 60;
  const Run run = simulate(m, options);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const double momentum = (hub + far * far) * drawn;
  CHECK_THAT(run.coordinates[0].rate.front(), WithinRel(momentum / hub, 1e-13));
  CHECK_THAT(run.coordinates[1].rate.front(), WithinRel(-momentum / hub, 1e-13)); // the ball stands
  // It settles in the state that a solve finds.
  CHECK_THAT(run.coordinates[0].rate.back(), WithinRel(found_speed(Analysis(m).solve(), "spin"), 1e-6));
  // A kick comes on top.
  options.duration = 0.01;
  options.kick = {{"spin", 2}};
  CHECK_THAT(simulate(m, options).coordinates[0].rate.front(), WithinRel(momentum / hub + 2, 1e-13));
}

TEST_CASE("a gear between what a shaft left to itself carries keeps its momentum, one on the shaft does not",
          "[momentum]") {
  // Two rings of 1 kg that a gear keeps at one radius, a spring at one of them: k (r - free) = 2 r w^2.
  constexpr double hub = 0.3, stiffness = 100, free = 0.2, drawn = 0.25, begun = 4;
  Mechanism m;
  m.bodies = {body("rod", 2, {0, 0, 0}, {0.1, hub, 0.1}), body("one", 1, {drawn, 0, 0}),
              body("other", 1, {-drawn, 0, 0})};
  m.joints = {left_to_itself(revolute("spin", "ground", "rod", {0, 0, 0}, {0, 1, 0}), begun),
              joint(JointType::prismatic, "out", "rod", "one", {drawn, 0, 0}, {1, 0, 0}),
              joint(JointType::prismatic, "back", "rod", "other", {-drawn, 0, 0}, {-1, 0, 0})};
  for (const std::size_t j : {1u, 2u})
    m.joints[j].coordinates[0].drawn = drawn;
  m.joints[1].coordinates[0].spring = CoordinateSpring{stiffness, free};
  m.joints[2].coordinates[0].damping = 8;
  Joint mesh;
  mesh.name = "mesh";
  mesh.type = JointType::gear;
  mesh.joints = {"out", "back"};
  mesh.ratio = 1;
  m.joints.push_back(mesh);
  validate(m);
  const double momentum = (hub + 2 * drawn * drawn) * begun;
  const auto speed = [&](double r) { return momentum / (hub + 2 * r * r); };
  double low = free, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double r = (low + high) / 2;
    (stiffness * (r - free) < 2 * r * speed(r) * speed(r) ? low : high) = r;
  }
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "out"), WithinRel(low, 1e-12));
  CHECK_THAT(value(s, "back"), WithinRel(low, 1e-12));
  CHECK_THAT(found_speed(s, "spin"), WithinRel(speed(low), 1e-12));
  SimulationOptions options;
  options.duration = 30;
  const Run run = simulate(m, options);
  REQUIRE(run.status == RunStatus::completed);
  CHECK_THAT(run.coordinates[0].rate.back(), WithinRel(speed(low), 1e-8));
  // Through a gear on the shaft itself momentum would pass to what stands.
  m.bodies.push_back(body("wheel", 1, {0, 0, 1}, {0.1, 0.2, 0.1}));
  m.joints.push_back(revolute("wheel", "ground", "wheel", {0, 0, 1}, {0, 1, 0}));
  mesh.name = "beside";
  mesh.joints = {"spin", "wheel"};
  m.joints.push_back(mesh);
  const auto found = find_mistakes(m);
  REQUIRE(found.size() == 1);
  CHECK(found[0].where() == "joints.beside.joints[0]");
}

TEST_CASE("momentum that a planetary set passes on is not kept") {
  Mechanism m;
  const auto wheel = [](const std::string& name, const Vec3& at) {
    return body(name, 1, at, {0.1, 0.1, 0.2});
  };
  m.bodies = {wheel("sun", {0, 0, 0}), wheel("carrier", {0, 0, 0}), wheel("planet", {0.9, 0, 0}),
              wheel("ring", {0, 0, 0})};
  Joint sun = driven(revolute("sun", "ground", "sun", {0, 0, 0}, {0, 0, 1}), 100);
  sun.coordinates[0].drive->torque = 0;
  sun.coordinates[0].drive->load = 0;
  sun.formulas.push_back({"drive.load", "0.02 N m s*rate(sun)"});
  m.joints = {sun,
              left_to_itself(revolute("carrier", "ground", "carrier", {0, 0, 0}, {0, 0, 1}), 10),
              driven(revolute("ring", "ground", "ring", {0, 0, 0}, {0, 0, 1}), -5),
              revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
              revolute("sun on carrier", "carrier", "sun", {0, 0, 0}, {0, 0, 1}),
              revolute("ring on carrier", "carrier", "ring", {0, 0, 0}, {0, 0, 1}),
              gear("inner mesh", "sun on carrier", "planet", -1.5),
              gear("outer mesh", "planet", "ring on carrier", 2. / 7)};
  // Of the carrier, as others are driven; of the ring, as the carrier follows it and the sun.
  enum class Keeps { carrier, ring_beside_torque, ring_beside_speed };
  const Keeps keeps = GENERATE(Keeps::carrier, Keeps::ring_beside_torque, Keeps::ring_beside_speed);
  const std::string keeping = keeps == Keeps::carrier ? "carrier" : "ring";
  if (keeps != Keeps::carrier) {
    m.joints[1].coordinates[0].drive.reset();
    m.joints[2] = left_to_itself(revolute("ring", "ground", "ring", {0, 0, 0}, {0, 0, 1}), 40);
    m.joints[0].cut = m.joints[2].cut = false;
  }
  if (keeps == Keeps::ring_beside_speed) {
    m.joints[0].coordinates[0].drive->torque.reset();
    m.joints[0].coordinates[0].drive->load.reset();
    m.joints[0].formulas.clear();
  }
  CAPTURE(keeping);
  validate(m);
  try {
    Analysis(m).solve();
    FAIL("it was not refused");
  } catch (const SceneError& error) {
    CHECK(error.where() == "joints." + keeping + ".drive.keeps");
    CHECK_THAT(error.expected(), ContainsSubstring("its momentum passes to them"));
  }
}

TEST_CASE("whether what is left to itself is stable does not depend on the unit of time",
          "[momentum][scale]") {
  const double unit = GENERATE(1., 1e-3, 1e-6, 1e-9); // s
  CAPTURE(unit);
  const double fast = 1 / unit, stiff = fast * fast;
  Mechanism m;
  m.gravity = {0, -9.81 * stiff, 0};
  m.bodies = {body("h0", 1.5, {0, 0, 0}, {0.37, 0.33, 0.37}), body("h1", 1.8, {0, 0, 0}, {0.36, 0.44, 0.36}),
              body("a", 1.2, {-0.22, 0.34, 0.16}, {0.005, 0.006, 0.004}),
              body("b", 0.7, {-0.1, 0.29, 0.08}, {0.005, 0.006, 0.004}),
              body("c", 1.1, {0.27, 0.12, 0.07}, {0.005, 0.006, 0.004})};
  m.joints = {
      left_to_itself(revolute("p0", "ground", "h0", {0, 0, 0}, {0, 1, 0}), -6.6 * fast),
      driven(revolute("p1", "ground", "h1", {0, 0, 0}, {0, 1, 0}), -7.2 * fast),
      dampened(sprung(prismatic("s0", "h0", "a", {-0.22, 0.34, 0.16}, {-0.82, 0.41, 0.58}), 2400 * stiff),
               14 * fast),
      dampened(sprung(prismatic("s1", "h0", "b", {-0.1, 0.29, 0.08}, {-0.75, 0.4, 0.66}), 1900 * stiff),
               5.7 * fast),
      dampened(sprung(revolute("s2", "h1", "c", {0.08, 0.34, 0.02}, {-0.23, -0.04, 0.97}), 10.5 * stiff),
               0.4 * fast)};
  Force spring = point_spring("sp", "a", "b", {-0.22, 0.34, 0.16}, {-0.1, 0.29, 0.08}, 235 * stiff, 0.25);
  spring.damping = 0.2 * fast;
  m.forces = {spring};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  REQUIRE(s.eigenvalues);
  REQUIRE(!s.eigenvalues->empty());
}
