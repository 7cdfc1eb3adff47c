// The first Lyapunov coefficient against closed forms and against long motions.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/sampled_later.hpp"
#include "tests/support/campaign.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/hopf_curve.hpp"
#include "engine/study/lyapunov.hpp"

#include <numbers>
#include <random>

using namespace flyball;
using namespace flyball::test;
using Complex = std::complex<double>;

namespace {

// Two rotors of 1 kg m^2 whose torques are a polynomial of a = rate(r1) - 5 and b = rate(r2) - 5:
// a' = (mu - bend nu^2) a - omega b - kappa a^3, b' = omega a - nu b.
Mechanism rotors(double mu, double nu, double omega, double kappa, double bend = 0) {
  Mechanism m = read_scene(R"scene({"flyball": 2, "name": "rotors",
    "parameters": {"mu": {"value": 0, "unit": "N m s"}, "nu": {"value": 0, "unit": "N m s"},
      "omega": {"value": 0, "unit": "N m s"}, "kappa": {"value": 0, "unit": "N m s^3"},
      "bend": {"value": 0}},
    "bodies": [{"name": "one", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
      {"name": "two", "mass": 1, "position": [0, 1, 0], "inertia": [1, 1, 1]}],
    "joints": [
      {"name": "r1", "type": "revolute", "bodies": ["ground", "one"], "at": [0, 0, 0], "axis": [0, 1, 0],
        "drive": {"speed": 5, "torque":
          "=(mu - bend*nu^2/(1 N m s))*(rate(r1) - 5) - omega*(rate(r2) - 5) - kappa*(rate(r1) - 5)^3"}},
      {"name": "r2", "type": "revolute", "bodies": ["ground", "two"], "at": [0, 1, 0], "axis": [0, 1, 0],
        "drive": {"speed": 5, "torque": "=omega*(rate(r1) - 5) - nu*(rate(r2) - 5)"}}]})scene");
  for (const auto& [name, value] :
       {std::pair{"mu", mu}, {"nu", nu}, {"omega", omega}, {"kappa", kappa}, {"bend", bend}})
    set_parameter(m, std::string("parameters.") + name, value);
  return m;
}
const std::string of_mu = "parameters.mu", of_nu = "parameters.nu", of_kappa = "parameters.kappa";

const CoordinateTrack& track(const Run& run, const std::string& joint) {
  return *std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
}

// Half the range that values cover between two times.
double amplitude(const Run& run, const std::vector<double>& values, double from, double to) {
  double low = 1e300, high = -1e300;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (run.time[i] >= from && run.time[i] <= to) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
  return (high - low) / 2;
}

// l1 for a q whose first entry is 1/2: the amplitude of x_0.
double of_first(const LyapunovCoefficient& l, double value) {
  return value / (4 * std::norm(l.q[0]));
}

HopfPoint hopf_of(const Mechanism& m, const std::string& address, double from, double to) {
  const ResponseDiagram d = follow_branches(m, address, from, to);
  INFO(d.message);
  for (const SpecialPoint& s : d.special)
    if (s.type == SpecialPointType::hopf)
      return describe_hopf(with_parameter(m, address, s.at.parameter), s.at,
                           hopf_frequency(s.at.eigenvalues));
  FAIL("no Hopf point");
  return {};
}

} // namespace

TEST_CASE("the coefficient of the normal form", "[hopf]") {
  // r' = b r^3 at w: l1 = b / w by the amplitude of x.
  for (const double b : {-0.7, 0.3}) {
    const double w = 2.5;
    const auto l = first_lyapunov_coefficient(
        [&](const Eigen::VectorXd& x, Eigen::VectorXd& rate) {
          const double r2 = x.squaredNorm();
          rate = Eigen::Vector2d(-w * x[1] + b * r2 * x[0], w * x[0] + b * r2 * x[1]);
          return true;
        },
        2, w);
    REQUIRE(l);
    CHECK(std::abs(l->eigenvalue - std::complex<double>(0, w)) < 1e-11);
    CHECK(std::abs(of_first(*l, l->value) - b / w) < 1e-10);
    CHECK(std::abs(of_first(*l, l->value) - b / w) <= of_first(*l, l->error));
    CHECK(l->error < 1e-7);
  }
}

TEST_CASE("the coefficient with quadratic terms, by Guckenheimer's and Holmes's formula", "[hopf]") {
  // x' = -w y + f, y' = w x + g: 16 a = f_xxx + f_xyy + g_xxy + g_yyy + (f_xy (f_xx + f_yy) - g_xy (g_xx +
  // g_yy)
  // - f_xx g_xx + f_yy g_yy) / w, r' = a r^3 (Nonlinear Oscillations, 1983, eq. 3.4.11).
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const double w = 1 + trial % 5;
    double f[2][2], g[2][2], f3[4], g3[4];
    for (auto* of : {f, g}) {
      of[0][0] = any(random);
      of[0][1] = of[1][0] = any(random);
      of[1][1] = any(random);
    }
    for (auto* of : {f3, g3})
      for (int k = 0; k < 4; ++k)
        of[k] = any(random);
    const auto value = [](const double(&two)[2][2], const double(&three)[4], double x, double y) {
      return (two[0][0] * x * x + 2 * two[0][1] * x * y + two[1][1] * y * y) / 2 +
             (three[0] * x * x * x + 3 * three[1] * x * x * y + 3 * three[2] * x * y * y +
              three[3] * y * y * y) /
                 6;
    };
    const auto l = first_lyapunov_coefficient(
        [&](const Eigen::VectorXd& x, Eigen::VectorXd& rate) {
          rate = Eigen::Vector2d(-w * x[1] + value(f, f3, x[0], x[1]), w * x[0] + value(g, g3, x[0], x[1]));
          return true;
        },
        2, w);
    REQUIRE(l);
    const double a = (f3[0] + f3[2] + g3[1] + g3[3] +
                      (f[0][1] * (f[0][0] + f[1][1]) - g[0][1] * (g[0][0] + g[1][1]) - f[0][0] * g[0][0] +
                       f[1][1] * g[1][1]) /
                          w) /
                     16;
    CHECK(std::abs(of_first(*l, l->value) - a / w) < 1e-9);
    CHECK(std::abs(of_first(*l, l->value) - a / w) <= of_first(*l, l->error));
  }
}

TEST_CASE("a coefficient that is zero is left open", "[hopf]") {
  const auto l = first_lyapunov_coefficient(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd& rate) {
        rate = Eigen::Vector2d(-x[1], std::sin(x[0]));
        return true;
      },
      2, 1);
  REQUIRE(l);
  CHECK(std::abs(l->value) <= l->error);
}

TEST_CASE("two rotors: coefficient, frequency and the oscillation beyond a soft loss", "[hopf]") {
  // Averaged over a turn a^3 is 3/8 of its amplitude's; the angle's amplitude is that of the speed over w.
  const double w = 2;
  for (const double k : {0.3, -0.3}) {
    const HopfPoint p = hopf_of(rotors(-0.2, 0, w, k), of_mu, -0.5, 0.5);
    INFO(p.reason);
    REQUIRE(p.lyapunov);
    CHECK(p.frequency == Approx(w).epsilon(1e-9));
    CHECK(p.growing == 0);
    CHECK(p.coordinate.joint == "r1");
    CHECK(std::abs(*p.lyapunov + 3 * k * w / 8) < 1e-8);
    CHECK(std::abs(*p.lyapunov + 3 * k * w / 8) <= p.error);
    CHECK(p.loss() == (k > 0 ? HopfLoss::soft : HopfLoss::hard));
  }
  SimulationOptions options;
  options.duration = 250;
  options.start = Start::equilibrium;
  options.kick = {{"r1", 0.05}};
  for (const double beyond : {0.04, 0.01}) {
    const Run run = simulate(rotors(beyond, 0, w, 0.3), options);
    REQUIRE(run.status == RunStatus::completed);
    // The longer motion does not move on.
    if (beyond > 0.02)
      CHECK(amplitude(run, track(run, "r1").rate, 240, 250) ==
            Approx(std::sqrt(beyond / 2 / (3 * 0.3 / 8))).epsilon(0.01));
    else
      CHECK(amplitude(run, track(run, "r1").rate, 240, 250) < std::sqrt(beyond / 2 / (3 * 0.3 / 8)));
  }
}

TEST_CASE("the curve of two rotors, from one double zero to the other", "[hopf]") {
  // About a = 0 the trace is zero where mu = nu, and w^2 = omega^2 - mu nu. About kappa a^2 = mu - omega^2 /
  // nu it is where mu = 6 / nu - nu / 2, with w^2 = omega^2 - nu^2: that curve ends at the same points.
  const PlaneCurves found = hopf_curves(rotors(-1, 0.5, 2, 0.3), {of_mu, -3, 3}, {of_nu, -2.5, 2.5});
  INFO(found.message);
  REQUIRE_FALSE(found.curves.empty());
  int along = 0;
  for (const PlaneCurve& curve : found.curves) {
    const bool about_zero = std::abs(curve.points[1].x - curve.points[1].y) < 1e-9;
    for (const PlanePoint& p : curve.points) {
      CAPTURE(p.x, p.y);
      CHECK(std::abs(p.x - (about_zero ? p.y : 6 / p.y - p.y / 2)) < 1e-8);
      REQUIRE(p.hopf);
      const double square = 4 - p.y * p.y;
      CHECK(std::abs(p.hopf->frequency - std::sqrt(std::max(0., square))) < 1e-5);
    }
    for (const PlanePoint& p : curve.takens) {
      CHECK(std::abs(std::abs(p.x) - 2) < 1e-8);
      CHECK(p.hopf->frequency == 0);
    }
    if (!about_zero) continue;
    ++along;
    CHECK(curve.points.size() > 20);
    REQUIRE(curve.takens.size() == 2);
    CHECK(curve.takens[0].x * curve.takens[1].x < 0);
    CHECK(curve.end.find("Bogdanov") != std::string::npos);
    CHECK(curve.begin == curve.end);
  }
  CHECK(along == 1);
}

TEST_CASE("soft turns into hard where the coefficient is zero", "[hopf]") {
  const PlaneCurves found = hopf_curves(rotors(-1, 0, 2, 0.3), {of_mu, -1, 1}, {of_kappa, -0.5, 0.4});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1);
  for (const PlanePoint& p : found.curves[0].points) {
    CHECK(std::abs(p.x) < 1e-9);
    REQUIRE(p.hopf->lyapunov);
    CHECK(std::abs(*p.hopf->lyapunov + 3 * p.y * 2 / 8) <= p.hopf->error);
  }
  REQUIRE(found.curves[0].bautin.size() == 1);
  CHECK(std::abs(found.curves[0].bautin[0].y) < 1e-7);
  CHECK(found.curves[0].takens.empty());
}

TEST_CASE("a curve that turns round in one of the parameters", "[hopf]") {
  // mu = 0.4 nu^2 + nu has its least at nu = -1.25.
  const PlaneCurves found = hopf_curves(rotors(-1, 0.5, 4, 0.3, 0.4), {of_mu, -1, 1}, {of_nu, -2.5, 1});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1);
  double least = 1;
  for (const PlanePoint& p : found.curves[0].points) {
    CHECK(std::abs(p.x - (0.4 * p.y * p.y + p.y)) < 1e-9);
    least = std::min(least, p.x);
  }
  CHECK(least == Approx(-0.625).epsilon(1e-3));
  CHECK(std::abs(found.curves[0].points.front().y - found.curves[0].points.back().y) > 3);
}

TEST_CASE("a rotor with damping that turns along whirls at prescribed speeds; its motion is linear",
          "[hopf]") {
  // m z'' + (ci + ce) z' + (k - i ci W) z = 0 seen from the ground: W = w0 (1 + ce / ci), w0 there.
  const double k = 50, mass = 2, ci = 0.3, ce = 0.2, w0 = std::sqrt(k / mass);
  Mechanism m;
  m.bodies = {body("frame", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("cross", 0), body("disc", mass)};
  m.joints = {driven(revolute("spin", "ground", "frame", {0, 0, 0}, {0, 0, 1}), 3),
              dampened(sprung(prismatic("x", "frame", "cross", {0, 0, 0}, {1, 0, 0}), k), ci),
              dampened(sprung(prismatic("y", "cross", "disc", {0, 0, 0}, {0, 1, 0}), k), ci)};
  Force air;
  air.name = "air";
  air.type = ForceType::drag;
  air.body = "disc";
  air.linear = ce;
  m.forces = {air};
  const PlaneCurves found =
      hopf_curves(m, {"joints.spin.drive.speed", 1, 20}, {"forces.air.linear", 0.05, 0.6});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1);
  for (const PlanePoint& p : found.curves[0].points) {
    CAPTURE(p.x, p.y);
    CHECK(std::abs(p.x - w0 * (1 + p.y / ci)) < 1e-8);
    CHECK(std::abs(p.hopf->frequency - w0 * p.y / ci) < 1e-8); // seen from the frame
    CHECK(p.hopf->loss() == HopfLoss::undecided);
    REQUIRE(p.hopf->lyapunov);
    CHECK(std::abs(*p.hopf->lyapunov) <= p.hopf->error);
  }
}

TEST_CASE("Haug's governor begins to hunt hard, as its motion says", "[hopf]") {
  const Mechanism m = shipped("governor_engine");
  const std::string damper = "joints.slide.damping", gain = "parameters.gain";
  const HopfPoint p = hopf_of(m, damper, 60, 5);
  INFO(p.reason);
  REQUIRE(p.lyapunov);
  CHECK(p.loss() == HopfLoss::hard);
  CHECK(p.growing == 0);
  CHECK(p.coordinate.joint == "arm1");
  CHECK(p.error < 1e-6 * *p.lyapunov);
  // Both limits lie on one curve; its points are where a plain solve has a pair on the axis.
  const PlaneCurves found = hopf_curves(m, {damper, 5, 60}, {gain, 1000, 20000});
  REQUIRE(found.curves.size() == 1);
  double to_damper = 1e9, to_gain = 1e9;
  for (const PlanePoint& at : found.curves[0].points) {
    CHECK(at.y / at.x == Approx(7500 / 21.53434002327).epsilon(1e-10));
    if (at.y == 7500) to_damper = at.x;
    const Solution s = Analysis(with_parameter(with_parameter(m, damper, at.x), gain, at.y)).solve();
    double nearest = 1e9;
    for (const Complex x : *s.eigenvalues)
      nearest = std::min(nearest, std::abs(x - Complex(0, at.hopf->frequency)));
    CHECK(nearest < 1e-8);
  }
  CHECK(std::abs(to_damper - 21.5343400) < 1e-7);
  const PlaneCurves across = hopf_curves(m, {gain, 5000, 15000}, {damper, 20, 40});
  for (const PlanePoint& at : across.curves.at(0).points)
    if (at.y == 30) to_gain = at.x;
  CHECK(std::abs(to_gain - 10448.4279) < 1e-4);
  // At the limit itself (1/a^2)' = -2 w l1.
  SimulationOptions options;
  options.start = Start::equilibrium;
  options.kick = {{"slide", 0.02}};
  options.rate = 400;
  const double period = 2 * std::numbers::pi / p.frequency;
  const auto inverse = [&](double at) {
    options.duration = at + period;
    const Run run = sampled_later(with_parameter(m, damper, to_damper), options, at);
    REQUIRE(run.status == RunStatus::completed);
    return 1 / std::pow(amplitude(run, track(run, "arm1").value, at, at + period), 2);
  };
  CHECK((inverse(20) - inverse(200)) / 180 == Approx(2 * p.frequency * *p.lyapunov).epsilon(0.02));
}

TEST_CASE("random mechanisms with engines: points of the curves have a pair on the axis", "[hopf][random]") {
  int curves = 0, told = 0;
  const std::uint32_t seeds = few_or_all(4u, 8u);
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    CAPTURE(seed);
    Mechanism m = reference::random_sprung_mechanism(seed);
    const Solution there = Analysis(m).solve();
    if (there.status != Status::converged || there.drive_torques.size() != 1 ||
        there.drive_torques[0].varying || there.neutral.size() > 0)
      continue;
    const DriveTorque& torque = there.drive_torques[0];
    const auto felt = std::ranges::find_if(there.coordinates, [](const CoordinateSolution& c) {
      return !c.driven && !c.dependent && c.count == 1;
    });
    if (felt == there.coordinates.end() || torque.count > 1) continue;
    Joint& driver = m.joints[static_cast<std::size_t>(joint_index(m, torque.joint))];
    const double wanted = driver.coordinates[0].drive->speed;
    if (wanted == 0) continue;
    // A governor: the torque falls with a coordinate.
    const auto number = [](double x) { return "(" + number_text(x) + ")"; };
    const std::string per = felt->angle ? "1 N m" : "1 N";
    driver.coordinates[0].drive->torque = 0;
    driver.formulas.push_back({"drive.torque", number(torque.value) + " - slope*(rate(" + torque.joint +
                                                   ") - " + number(wanted) + ") + gain*" + per +
                                                   "*(coordinate(" + felt->joint + ") - " +
                                                   number(felt->value) + ")"});
    m.parameters.resize(2);
    m.parameters[0].name = "slope";
    m.parameters[0].value = 1 + std::abs(torque.value / wanted);
    m.parameters[0].unit = "N m s";
    m.parameters[1].name = "gain";
    validate(m);
    PlaneOptions options;
    options.max_points = 60;
    const PlaneCurves found =
        hopf_curves(m, {"parameters.gain", -200, 200}, {"parameters.slope", 0.01, 10}, options);
    for (const PlaneCurve& curve : found.curves) {
      ++curves;
      for (std::size_t i = 0; i < curve.points.size(); i += 4) {
        const PlanePoint& p = curve.points[i];
        CAPTURE(p.x, p.y);
        Mechanism at = with_parameter(with_parameter(m, "parameters.gain", p.x), "parameters.slope", p.y);
        SolveOptions nearest;
        nearest.nearest = true;
        nearest.start = start_values(p.coordinates);
        const Solution s = Analysis(at).solve(nearest);
        REQUIRE(s.status == Status::converged);
        double away = 1e9, largest = 0;
        for (const Complex x : *s.eigenvalues) {
          away = std::min(away, std::abs(x - Complex(0, p.hopf->frequency)));
          largest = std::max(largest, std::abs(x));
        }
        CHECK(away < (p.hopf->frequency > 0 ? 1e-8 : 1e-4) * largest); // a double zero lies on a fold
        if (p.hopf->loss() != HopfLoss::undecided) ++told;
      }
    }
  }
  CAPTURE(curves, told);
  CHECK(curves >= static_cast<int>(seeds / 2));
  CHECK(told > static_cast<int>(5 * seeds / 2));
}

TEST_CASE("a curve ends where the balance would turn with the drives", "[hopf]") {
  const PlaneCurves found = hopf_curves(shipped("governor_engine", {{"bodies.ball1.mass", 1.2}}),
                                        {"joints.slide.damping", 5, 60}, {"gravity.0", -0.5, 1});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1); // on the one line where gravity is along the axis
  CHECK(found.curves[0].end.find("turns with the drives") != std::string::npos);
  for (const PlanePoint& p : found.curves[0].points)
    CHECK(std::abs(p.y) < 1e-12);
}

TEST_CASE("where there is no coefficient the reason is told", "[hopf]") {
  const HopfPoint friction = describe_hopf(shipped("governor_friction"), ResponsePoint{}, 3);
  CHECK_FALSE(friction.lyapunov);
  CHECK(friction.reason.find("friction") != std::string::npos);
  CHECK(friction.loss() == HopfLoss::undecided);
}

TEST_CASE("Haug's governor with a throttle that gives less the farther it goes hunts softly", "[hopf]") {
  Mechanism m = shipped("governor_engine");
  m.parameters.emplace_back();
  m.parameters.back().name = "width";
  m.parameters.back().value = 0.02;
  m.parameters.back().unit = "m";
  for (Formula& f : m.joints[0].formulas)
    if (f.key == "drive.torque")
      f.text = "gain * (coordinate(slide) - 0.15 m) / (1 + ((coordinate(slide) - 0.15 m) / width)^2)";
  validate(m);
  const std::string damper = "joints.slide.damping";
  // Narrow ones are soft, wide ones as good as none and hard; between them the coefficient is zero.
  const PlaneCurves found = hopf_curves(m, {damper, 10, 40}, {"parameters.width", 0.02, 0.5});
  INFO(found.message);
  REQUIRE(found.curves.size() == 1);
  REQUIRE(found.curves[0].bautin.size() == 1);
  const PlanePoint& zero = found.curves[0].bautin[0];
  CHECK(std::abs(zero.x - 21.5343400233) < 1e-8);
  CHECK(std::abs(*zero.hopf->lyapunov) <= zero.hopf->error);
  for (const PlanePoint& p : found.curves[0].points)
    if (std::abs(p.y - zero.y) > 1e-4)
      CHECK(p.hopf->loss() == (p.y < zero.y ? HopfLoss::soft : HopfLoss::hard));
  // Beyond the limit the motion runs into an oscillation of a^2 = -Re(s) / (w l1).
  const HopfPoint p = hopf_of(m, damper, 40, 10);
  REQUIRE(p.loss() == HopfLoss::soft);
  const Mechanism beyond = with_parameter(m, damper, 21.2);
  double growth = 0;
  const Solution there = Analysis(beyond).solve();
  for (const Complex s : *there.eigenvalues)
    growth = std::max(growth, s.real());
  SimulationOptions options;
  options.start = Start::equilibrium;
  options.kick = {{"slide", 0.02}};
  options.duration = 900;
  options.rate = 100;
  const Run run = sampled_later(beyond, options, 850);
  REQUIRE(run.status == RunStatus::completed);
  const double expected = std::sqrt(-growth / (p.frequency * *p.lyapunov));
  const std::vector<double>& arm = track(run, "arm1").value;
  CAPTURE(zero.y, *p.lyapunov, growth, expected, amplitude(run, arm, 890, 900));
  CHECK(amplitude(run, arm, 890, 900) == Approx(expected).epsilon(0.03));
  CHECK(amplitude(run, arm, 890, 900) == Approx(amplitude(run, arm, 850, 860)).epsilon(0.01));
}
