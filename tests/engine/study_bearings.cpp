// Bearings: statics, frequencies and the onset of whirl that have a formula; energies; motions that settle.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/bearing_axes.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/engine/dynamics_runs.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <complex>
#include <limits>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

Force bearing(const std::string& a, const std::string& b, const Vec3& at, BearingMatrix stiffness,
              BearingMatrix damping = {}) {
  Force f;
  f.name = "bearing";
  f.type = ForceType::bearing;
  f.bodies = {a, b};
  f.at = at;
  f.bearing_stiffness = std::move(stiffness);
  f.bearing_damping = std::move(damping);
  return f;
}

// A Jeffcott rotor: a disc turns about z on a journal that shifts along x and y, held at its middle.
Mechanism jeffcott(double mass, BearingMatrix stiffness, BearingMatrix damping, double speed = 30) {
  Mechanism m;
  m.bodies = {body("cross", 0), body("journal", 0), body("disc", mass, {0, 0, 0}, {0.02, 0.02, 0.03})};
  m.joints = {prismatic("x", "ground", "cross", {0, 0, 0}, {1, 0, 0}),
              prismatic("y", "cross", "journal", {0, 0, 0}, {0, 1, 0}),
              driven(revolute("spin", "journal", "disc", {0, 0, 0}), speed)};
  m.forces = {bearing("ground", "disc", {0, 0, 0}, std::move(stiffness), std::move(damping))};
  return m;
}

Solution solved(const Mechanism& m) {
  validate(m);
  Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  return s;
}

// Each of `expected` is among those found.
void check_eigenvalues(const Solution& s, const std::vector<Complex>& expected, double tolerance) {
  REQUIRE(s.eigenvalues);
  REQUIRE(s.eigenvalues->size() == expected.size());
  for (const Complex& e : expected) {
    double nearest = 1e300;
    for (const Complex& found : *s.eigenvalues)
      nearest = std::min(nearest, std::abs(found - e));
    CAPTURE(e);
    CHECK(nearest < tolerance * std::abs(e));
  }
}

} // namespace

TEST_CASE("a rotor sinks as its bearing's matrix says, cross terms and all", "[bearings]") {
  Mechanism m = jeffcott(12, {8e4, 5e4, -3e4, 2e5}, {900, 0, 0, 900}, 3);
  m.gravity = {0, -standard_gravity, 0};
  const Solution s = solved(m);
  Eigen::Matrix2d k;
  k << 8e4, 5e4, -3e4, 2e5;
  const Eigen::Vector2d at = k.inverse() * Eigen::Vector2d(0, -12 * standard_gravity);
  CHECK_THAT(value(s, "x"), WithinRel(at.x(), 1e-13));
  CHECK_THAT(value(s, "y"), WithinRel(at.y(), 1e-13));
  const Run run = simulate(m, lasting(1.5, Integrator::automatic, 1e-11));
  check_sound(run, 1e-6);
  CHECK(find_settled(run, s, 1e-8).time.has_value());
}

TEST_CASE("an anisotropic bearing has two frequencies", "[bearings]") {
  const Solution s = solved(jeffcott(5, {2e4, 0, 0, 9e4}, {}));
  check_eigenvalues(
      s,
      {{0, std::sqrt(2e4 / 5)}, {0, -std::sqrt(2e4 / 5)}, {0, std::sqrt(9e4 / 5)}, {0, -std::sqrt(9e4 / 5)}},
      1e-12);
  // In axes turned by 30 degrees it is the same bearing.
  const double c = std::cos(0.5), n = std::sin(0.5);
  Mechanism turned = jeffcott(5, {2e4, 0, 0, 9e4}, {});
  turned.forces[0].x_axis = Vec3(c, n, 0);
  turned.gravity = {0, -standard_gravity, 0};
  const Solution t = solved(turned);
  CHECK_THAT(value(t, "x"), WithinRel(-5 * standard_gravity * c * n * (1 / 2e4 - 1 / 9e4), 1e-12));
}

TEST_CASE("cross stiffness drives whirl where it exceeds damping times frequency", "[bearings]") {
  const double mass = 3, k = 3e4, c = 40, onset = c * std::sqrt(k / mass);
  for (const double cross : {0., 0.5 * onset, 0.999 * onset, 1.001 * onset, 2 * onset}) {
    CAPTURE(cross / onset);
    const Solution s = solved(jeffcott(mass, {k, cross, -cross, k}, {c, 0, 0, c}));
    // m s^2 + c s + k = +-i kc.
    std::vector<Complex> expected;
    for (const double sign : {1., -1.}) {
      const Complex root = std::sqrt(Complex(c * c - 4 * mass * k, 4 * mass * cross * sign));
      expected.push_back((-c + root) / (2 * mass));
      expected.push_back((-c - root) / (2 * mass));
    }
    check_eigenvalues(s, expected, 1e-10);
    CHECK(s.stable == (cross < onset));
    CHECK(s.stability_reason != StabilityReason::minimum);
  }
  // Which way round: forwards, with the sense of kxy > 0 and so of the rotor.
  const Run run = simulate(jeffcott(mass, {k, 1.2 * onset, -1.2 * onset, k}, {c, 0, 0, c}),
                           kicked(lasting(2), "x", 1e-3));
  const CoordinateTrack &x = track(run, "x"), &y = track(run, "y");
  const std::size_t n = run.time.size() - 1;
  CHECK(x.value[n] * y.rate[n] - y.value[n] * x.rate[n] > 0);
  CHECK(std::hypot(x.value[n], y.value[n]) > 3e-5);
}

TEST_CASE("oil whip: the branch over the speed finds its onset at twice the frequency",
          "[bearings][branches]") {
  Mechanism m = jeffcott(3, {3e4, 0, 0, 3e4}, {40, 0, 0, 40});
  m.parameters = {{"w", "", 100, "rad/s", {}}};
  m.joints[2].formulas.push_back({"drive.speed", "w"});
  m.forces[0].formulas = {{"stiffness.0.1", "40 N s/m*w/2"}, {"stiffness.1.0", "-40 N s/m*w/2"}};
  set_parameter(m, "parameters.w", 100);
  const ResponseDiagram d = follow_branches(m, "parameters.w", 10, 400);
  INFO(d.message);
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::hopf);
  CHECK_THAT(d.special[0].at.parameter, WithinRel(2 * std::sqrt(3e4 / 3), 1e-9));
  for (const ResponsePoint& p : d.branches[0].points)
    if (std::abs(p.parameter - 200) > 0.01) CHECK(p.stable == (p.parameter < 200));
}

TEST_CASE("six rows hold a body in all its motions, at the frequencies of its pencil", "[bearings]") {
  Eigen::Matrix<double, 6, 6> root;
  root.setZero();
  Dice dice(5);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      root(i, j) = (i == j ? 1 : 0.2) * dice.between(0.5, 1.5) * (i < 3 ? 200 : 20);
  const Eigen::Matrix<double, 6, 6> k = root * root.transpose();
  BearingMatrix entries;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      entries.push_back(k(std::min(i, j), std::max(i, j)));
  Mechanism m;
  const Vec3 arm(0.1, -0.05, 0.2); // from the bearing to the mass centre
  m.bodies = {body("block", 2, arm, {0.1, 0.15, 0.2})};
  m.forces = {bearing("ground", "block", {0, 0, 0}, entries)};
  const Solution s = solved(m);
  // M of shifts of the bearing's point and turns, in its axes: x, y, z by default.
  Eigen::Matrix<double, 6, 6> mass;
  Mat3 cross;
  cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  mass << 2 * Mat3::Identity(), -2 * cross, 2 * cross,
      Mat3(Vec3(0.1, 0.15, 0.2).asDiagonal()) - 2 * cross * cross;
  const Mat3 axes = bearing_axes(m.forces[0]);
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = axes;
  const Eigen::Matrix<double, 6, 6> in_world = turn * k * turn.transpose();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(in_world, mass);
  std::vector<Complex> expected;
  for (const double square : eigen.eigenvalues())
    for (const double sign : {1., -1.})
      expected.emplace_back(0, sign * std::sqrt(square));
  check_eigenvalues(s, expected, 1e-9);
  // Its potential is exact at any turn: energy stays in large motions.
  const Run run =
      simulate(m, undamped(kicked(kicked(lasting(2, Integrator::automatic, 1e-12), "block.free.3", 9),
                                  "block.free.4", -7)));
  check_sound(run, 1e-7);
  double largest = 0;
  for (const double x : track(run, "block.free", 3).value)
    largest = std::max(largest, std::abs(x));
  CHECK(largest > 0.1);
}

TEST_CASE("two bearings bear a rotor's weight by its levers", "[bearings][measures]") {
  const double mass = 12, left = 0.3, right = 0.5, weight = mass * standard_gravity;
  // Shifts along x and y, tilts about both; a horizontal shaft along z, its centre between the bearings.
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("cross", 0), body("journal", 0), body("yoke", 0),
              body("rotor", mass, {0, 0, 0}, {0.2, 0.2, 0.05})};
  Joint tilt = joint(JointType::universal, "tilt", "journal", "yoke", {0, 0, 0});
  tilt.axis = {1, 0, 0};
  tilt.axis2 = {0, 1, 0};
  m.joints = {prismatic("x", "ground", "cross", {0, 0, 0}, {1, 0, 0}),
              prismatic("y", "cross", "journal", {0, 0, 0}, {0, 1, 0}), tilt,
              driven(revolute("spin", "yoke", "rotor", {0, 0, 0}), 30)};
  m.forces = {bearing("ground", "rotor", {0, 0, -left}, {8e4, 0, 0, 8e4}, {300, 0, 0, 300}),
              bearing("ground", "rotor", {0, 0, right}, {5e4, 0, 0, 3e4}, {})};
  m.forces[0].name = "A";
  m.forces[1].name = "B";
  m.measures = {{"a", "", "force_y(A)", "N"},         {"b", "", "force_y(B)", "N"},
                {"across", "", "force_x(A)", "N"},    {"size", "", "force(B)", "N"},
                {"couple_a", "", "couple(A)", "N m"}, {"both", "", "a + b", "N"}};
  m.sliders = {{"bodies.rotor.mass", 1, 20, SliderScale::linear, ""},
               {"forces.A.stiffness.1.1", 1e4, 1e6, SliderScale::linear, ""}};
  const Solution s = solved(m);
  // Both arms shorten alike where the shaft tilts.
  const double on_a = weight * right / (left + right), on_b = weight * left / (left + right);
  const auto told = [&](std::size_t i) { return *s.measures.at(i).value; };
  CHECK_THAT(told(0), WithinRel(on_a, 1e-12));
  CHECK_THAT(told(1), WithinRel(on_b, 1e-12));
  CHECK(std::abs(told(2)) < 1e-12 * weight);
  CHECK_THAT(told(3), WithinRel(on_b, 1e-12));
  CHECK(told(4) == 0);
  CHECK_THAT(told(5), WithinRel(weight, 1e-12));
  for (const MeasureSolution& each : s.measures) {
    REQUIRE(each.error);
    CHECK(*each.error < 1e-9 * weight);
  }
  CHECK(std::abs(told(0) - on_a) <= *s.measures[0].error);
  REQUIRE(s.sensitivities.size() == 2);
  CHECK_THAT(s.sensitivities[0].measures[0], WithinRel(on_a / mass, 1e-6));
  CHECK(std::abs(s.sensitivities[1].measures[0]) < 1e-9 * weight); // by statics alone

  REQUIRE(s.bearings.size() == 2);
  CHECK(s.bearings[0].bearing == "A");
  CHECK((s.bearings[0].force - Vec3(0, on_a, 0)).norm() < 1e-12 * weight);
  CHECK((s.bearings[1].force - Vec3(0, on_b, 0)).norm() < 1e-12 * weight);
  CHECK(s.bearings[0].torque.isZero(0));
  CHECK_FALSE(s.bearings[0].varying);
  // The other way round it is the ground that feels it.
  std::swap(m.forces[0].bodies[0], m.forces[0].bodies[1]);
  const Solution turned = solved(m);
  CHECK_THAT(*turned.measures[0].value, WithinRel(-on_a, 1e-4)); // its axes tilt with the shaft
}

TEST_CASE("a bearing of six rows bears a moment about its point", "[bearings][measures]") {
  const double mass = 2, arm = 0.4, stiffness = 30;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("beam", mass, {arm, 0, 0}, {0.01, 0.02, 0.02})};
  BearingMatrix entries(36, 0);
  for (const std::size_t i : {0u, 1u, 2u})
    entries[7 * i] = 1e4;
  for (const std::size_t i : {3u, 4u, 5u})
    entries[7 * i] = stiffness;
  m.forces = {bearing("ground", "beam", {0, 0, 0}, entries)};
  m.measures = {{"turned", "", "couple_z(bearing)", "N m"},
                {"sideways", "", "couple_x(bearing)", "N m"},
                {"all", "", "couple(bearing)", "N m"},
                {"up", "", "force_y(bearing)", "N"}};
  const Solution s = solved(m);
  double turn = 0; // k r = m g arm cos r, downwards
  for (int i = 0; i < 200; ++i)
    turn = mass * standard_gravity * arm * std::cos(turn) / stiffness;
  CHECK_THAT(*s.measures[0].value, WithinRel(stiffness * turn, 1e-9));
  CHECK(std::abs(*s.measures[1].value) < 1e-12);
  CHECK_THAT(*s.measures[2].value, WithinRel(stiffness * turn, 1e-9));
  CHECK_THAT(*s.measures[3].value, WithinRel(mass * standard_gravity, 1e-12));
  REQUIRE(s.bearings.size() == 1);
  CHECK_THAT(s.bearings[0].torque.z(), WithinRel(stiffness * turn, 1e-9));
  // In a motion, too: with damping and without the weight's last word.
  m.forces[0].bearing_damping.assign(36, 0);
  for (std::size_t i = 0; i < 6; ++i)
    m.forces[0].bearing_damping[7 * i] = i < 3 ? 100 : 1;
  const Run run = simulate(m, lasting(8, Integrator::automatic, 1e-10));
  CHECK_THAT(run.measures.front().value.back(), WithinRel(stiffness * turn, 1e-5));
}

TEST_CASE("sensitivities to a bearing's numbers are those of the closed form", "[bearings]") {
  Mechanism m = jeffcott(12, {8e4, 5e4, -3e4, 2e5}, {900, 0, 0, 900}, 3);
  m.gravity = {0, -standard_gravity, 0};
  for (const char* entry : {"0.0", "0.1", "1.0", "1.1"})
    m.sliders.push_back({std::string("forces.bearing.stiffness.") + entry, 0, 1e6, SliderScale::linear, ""});
  const Solution s = solved(m);
  Eigen::Matrix2d k;
  k << 8e4, 5e4, -3e4, 2e5;
  const Eigen::Vector2d at = k.inverse() * Eigen::Vector2d(0, -12 * standard_gravity);
  REQUIRE(s.sensitivities.size() == 4);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const Eigen::Vector2d rate = -k.inverse().col(i) * at[j];
      const Sensitivity& found = s.sensitivities[static_cast<std::size_t>(2 * i + j)];
      CHECK_THAT(found.rates[0].value, WithinRel(rate.x(), 1e-11));
      CHECK_THAT(found.rates[1].value, WithinRel(rate.y(), 1e-11));
    }
}

TEST_CASE("sensitivities to a bearing's axis follow its x, wherever that points", "[bearings]") {
  // Off the world's axes, x is the one nearest to the plane across, less its part along the axis.
  for (const bool given : {false, true}) {
    CAPTURE(given);
    Mechanism m;
    m.gravity = {0.4, -0.7, 1.2};
    m.bodies = {body("block", 3, {0, 0, 0}, {0.1, 0.1, 0.1})};
    m.joints = {prismatic("along", "ground", "cross", {0, 0, 0}, {1, 0, 0}),
                prismatic("across", "cross", "block", {0, 0, 0}, {0, 0, 1})};
    m.bodies.push_back(body("cross", 0));
    m.forces = {bearing("ground", "block", {0, 0, 0}, {900, 80, -50, 400})};
    m.forces[0].axis = {0.5, 0.9, 0.7};
    if (given) m.forces[0].x_axis = Vec3(1, 0.2, -0.3);
    for (int i = 0; i < 3; ++i)
      m.sliders.push_back({"forces.bearing.axis." + std::to_string(i), 0, 1, SliderScale::linear, ""});
    const Solution s = solved(m);
    REQUIRE(s.sensitivities.size() == 3);
    for (int i = 0; i < 3; ++i) {
      constexpr double h = 1e-5;
      const auto beside = [&](double by) {
        Mechanism moved = m;
        moved.forces[0].axis[i] += by;
        return solved(moved);
      };
      const Solution after = beside(h), before = beside(-h);
      for (int c = 0; c < 2; ++c) {
        const auto at = static_cast<std::size_t>(c);
        const double rate = (after.coordinates[at].value - before.coordinates[at].value) / (2 * h);
        CHECK(std::abs(s.sensitivities[static_cast<std::size_t>(i)].rates[at].value - rate) < 1e-8);
      }
    }
  }
}

TEST_CASE("a bearing that resists turns is refused where a drive turns one body on", "[bearings]") {
  const auto six_rows = [](const std::vector<double>& diagonal) {
    BearingMatrix m(36, 0.);
    for (std::size_t i = 0; i < 6; ++i)
      m[7 * i] = diagonal[i];
    return m;
  };
  Mechanism m = jeffcott(5, six_rows({2e4, 2e4, 1e5, 0, 0, 0}), six_rows({9, 9, 9, 0, 0, 0}));
  m.gravity = {0, -standard_gravity, 0};
  CHECK_THAT(value(solved(m), "y"), WithinRel(-5 * standard_gravity / 2e4, 1e-12)); // a thrust bearing
  for (const bool damping : {false, true}) {
    Mechanism tilting = m;
    BearingMatrix& matrix = damping ? tilting.forces[0].bearing_damping : tilting.forces[0].bearing_stiffness;
    matrix = six_rows({2e4, 2e4, 1e5, 50, 50, 0});
    if (damping) tilting.forces[0].bearing_stiffness.clear();
    try {
      Analysis(tilting).solve();
      FAIL("a bearing was wound up");
    } catch (const SceneError& error) {
      CHECK(error.where() == std::string("forces.bearing.") + (damping ? "damping" : "stiffness"));
      CHECK_THAT(error.expected(), ContainsSubstring("spin turns one of them on and on"));
    }
  }
  // Beside the drive, on what turns with it, it may.
  Mechanism beside = m;
  beside.forces[0].bodies = {"ground", "journal"};
  beside.forces[0].bearing_stiffness = six_rows({2e4, 2e4, 1e5, 50, 50, 50});
  CHECK_THAT(value(solved(beside), "y"), WithinRel(-5 * standard_gravity / 2e4, 1e-12));
}

TEST_CASE("a motion that takes a bearing over half a turn ends there", "[bearings]") {
  BearingMatrix k(36, 0.);
  for (const std::size_t i : {0u, 7u, 14u})
    k[i] = 400;
  for (const std::size_t i : {21u, 28u, 35u})
    k[i] = 0.5;
  Mechanism m;
  m.bodies = {body("block", 1, {0, 0, 0}, {0.01, 0.01, 0.01})};
  m.forces = {bearing("ground", "block", {0, 0, 0}, k)};
  // Its springs stop it at 3 rad and at 3.5 rad.
  const auto kick = [](double turn) { return std::sqrt(0.5 / 0.01) * turn; };
  const Run held = simulate(m, undamped(kicked(lasting(2), "block.free.3", kick(3.))));
  CHECK(held.status == RunStatus::completed);
  const Run over = simulate(m, undamped(kicked(lasting(2), "block.free.3", kick(3.5))));
  CHECK(over.status == RunStatus::diverged);
  CHECK_THAT(over.message,
             ContainsSubstring("the bodies of the bearing bearing turned by more than half a turn"));
  CHECK(over.time.back() < 1);
}

TEST_CASE("oil whip of a hanging rotor: it whirls at half its speed", "[bearings][branches]") {
  const Mechanism m = stored_case("oil_whip");
  validate(m);
  const Body& rotor = m.bodies[1];
  // I_t z'' + (c L^2 - i I_p w) z' + (k L^2 + m g l - i c w L^2 / 2) z = 0 has the root z = exp(i w t / 2)
  // there.
  const double below = 1 - rotor.position.y(), arm = 0.6;
  const double across = rotor.inertia[0] + rotor.mass * below * below, along = rotor.inertia[1];
  const double onset =
      std::sqrt((4e4 * arm * arm + rotor.mass * standard_gravity * below) / (across / 4 - along / 2));
  const ResponseDiagram d = follow_branches(m, "parameters.speed", 100, 450);
  INFO(d.message);
  std::vector<double> found;
  for (const SpecialPoint& s : d.special)
    if (s.type == SpecialPointType::hopf) found.push_back(s.at.parameter);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], WithinRel(onset, 1e-8));
  const Solution s = solved([&] {
    Mechanism at = m;
    set_parameter(at, "parameters.speed", onset);
    return at;
  }());
  double nearest = 1e300;
  for (const Complex& e : *s.eigenvalues)
    nearest = std::min(nearest, std::abs(e - Complex(0, onset / 2)));
  CHECK(nearest < 1e-5 * onset);
}

TEST_CASE("the shipped rotor whips at half its speed, beyond twice its first frequency",
          "[bearings][branches]") {
  const Mechanism m = shipped("rotor_oil_whip");
  const double k = 2 * 30000., mass = 12.6, frequency = std::sqrt(k / mass), cross = 150 * 100.;
  // It sinks under its weight and goes aside with the oil.
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  const double weight = mass * standard_gravity, size = k * k + cross * cross;
  CHECK_THAT(s.coordinates[0].value, WithinRel(-weight * k / size, 1e-12));
  CHECK_THAT(s.coordinates[1].value, WithinRel(-weight * cross / size, 1e-12));
  CHECK(s.stable == true);
  const ResponseDiagram d = follow_branches(m, "parameters.n", 0, 250);
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::hopf);
  CHECK_THAT(d.special[0].at.parameter, WithinRel(2 * frequency, 1e-9));
}

TEST_CASE("a rotor without places has the same eigenvalues whatever its size", "[scale]") {
  // An overhung disc: its shaft's end held by a matrix, all at one point.
  const auto rotor = [](double size) {
    const double turns = size * size;
    Mechanism m;
    m.bodies = {body("hub", 0), body("disc", 3, {0, 0, 0}, turns * Vec3(0.012, 0.012, 0.017))};
    m.joints = {driven(revolute("spin", "hub", "disc", {0, 0, 0}), 50)};
    BearingMatrix stiffness(36, 0), damping(36, 0);
    const auto set = [](BearingMatrix& to, int i, int j, double value) {
      to[static_cast<std::size_t>(6 * i + j)] = value;
    };
    for (const int i : {0, 1}) {
      set(stiffness, i, i, 6e4);
      set(stiffness, 3 + i, 3 + i, 3.7e3 * turns);
      set(damping, i, i, 1.2);
      set(damping, 3 + i, 3 + i, 0.012 * turns);
    }
    set(stiffness, 2, 2, 1e6);
    set(stiffness, 5, 5, 1e5 * turns);
    set(damping, 2, 2, 10);
    set(damping, 5, 5, turns);
    set(stiffness, 0, 4, -1.3e4 * size);
    set(stiffness, 4, 0, -1.3e4 * size);
    set(stiffness, 1, 3, 1.3e4 * size);
    set(stiffness, 3, 1, 1.3e4 * size);
    m.forces = {bearing("ground", "hub", {0, 0, 0}, stiffness, damping)};
    return solved(m);
  };
  const Solution usual = rotor(1);
  REQUIRE(usual.eigenvalues);
  for (const double size : {1e-6, 1e9}) {
    CAPTURE(size);
    const Solution s = rotor(size);
    REQUIRE(s.eigenvalues);
    REQUIRE(s.eigenvalues->size() == usual.eigenvalues->size());
    for (const Complex x : *usual.eigenvalues) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Complex y : *s.eigenvalues)
        nearest = std::min(nearest, std::abs(x - y));
      CHECK(nearest < 1e-8 * std::abs(x));
    }
  }
}

TEST_CASE("the size of the force of a stiff bearing moves with the load as its closed form does",
          "[bearings][measures]") {
  // F = sqrt(P^2 + (m g)^2), however stiff the film. A step by which differences are taken presses it by far
  // more than the load does.
  const double mass = 12, side = 30, weight = mass * standard_gravity, size = std::hypot(side, weight);
  for (const double k : {1e4, 1e7, 1e9}) {
    INFO(k);
    Mechanism m = jeffcott(mass, {k, 0, 0, k}, {1e3, 0, 0, 1e3});
    m.gravity = {0, -standard_gravity, 0};
    Force push;
    push.name = "push";
    push.type = ForceType::force;
    push.body = "disc";
    push.at = {0, 0, 0};
    push.vector = {side, 0, 0};
    m.forces.push_back(push);
    m.measures = {{"load", "", "force(bearing)", "N"}};
    m.sliders = {{"forces.push.vector.0", 0, 100, SliderScale::linear, ""},
                 {"bodies.disc.mass", 1, 20, SliderScale::linear, ""}};
    const Solution s = solved(m);
    CHECK_THAT(*s.measures[0].value, WithinRel(size, 1e-9));
    REQUIRE(s.sensitivities.size() == 2);
    CHECK_THAT(s.sensitivities[0].measures.at(0), WithinRel(side / size, 1e-6));
    CHECK_THAT(s.sensitivities[1].measures.at(0), WithinRel(weight * standard_gravity / size, 1e-6));
  }
}
