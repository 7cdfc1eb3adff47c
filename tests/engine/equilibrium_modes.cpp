// VibrationMode shapes against closed forms, their poses against the loops, and the two criteria of stability
// against each other.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

using Complex = std::complex<double>;

Complex part(const VibrationMode& mode, const std::string& joint, int index = 0) {
  const auto found = std::ranges::find_if(
      mode.amplitudes, [&](const ModeAmplitude& a) { return a.joint == joint && a.index == index; });
  REQUIRE(found != mode.amplitudes.end());
  return found->value;
}

std::vector<VibrationMode> modes_of(const Mechanism& m, const SolveOptions& options = {}) {
  Analysis analysis(m);
  const Solution s = analysis.solve(options);
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  return analysis.modes();
}

// Two pendulums of length 0.5 m side by side, a spring between them 0.3 m below the hinges.
Mechanism two_pendulums(double stiffness) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("a", 1, {0, -0.5, 0}), body("b", 1, {1, -0.5, 0})};
  m.joints = {revolute("left", "ground", "a", {0, 0, 0}, {0, 0, 1}),
              revolute("right", "ground", "b", {1, 0, 0}, {0, 0, 1})};
  if (stiffness > 0) {
    Force spring;
    spring.name = "between";
    spring.type = ForceType::spring;
    spring.bodies = {"a", "b"};
    spring.points = {Vec3(0, -0.3, 0), Vec3(1, -0.3, 0)};
    spring.stiffness = stiffness;
    m.forces = {spring};
  }
  return m;
}

// How far the joints' ends are apart in these poses, m; distance joints against their length.
double opening(const Mechanism& m, const std::vector<Pose>& poses) {
  const auto carried = [&](const std::string& name, const Vec3& p) -> Vec3 {
    const int b = body_index(m, name);
    if (b < 0) return p;
    const Body& drawn = m.bodies[static_cast<std::size_t>(b)];
    const Pose& now = poses[static_cast<std::size_t>(b)];
    return now.position + now.rotation * drawn.rotation.normalized().conjugate() * (p - drawn.position);
  };
  double worst = 0;
  for (const Joint& j : m.joints) {
    if (j.type == JointType::distance) {
      const double drawn = (j.points[1] - j.points[0]).norm();
      const double now = (carried(j.bodies[1], j.points[1]) - carried(j.bodies[0], j.points[0])).norm();
      worst = std::max(worst, std::abs(now - j.length.value_or(drawn)));
    } else if (j.type == JointType::revolute || j.type == JointType::spherical ||
               j.type == JointType::universal) {
      worst = std::max(worst, (carried(j.bodies[0], j.at) - carried(j.bodies[1], j.at)).norm());
    }
  }
  return worst;
}

} // namespace

TEST_CASE("frequencies and damping ratios of an eigenvalue", "[modes]") {
  CHECK(natural_frequency({-3, 4}) == 5);
  CHECK(damped_frequency({-3, -4}) == 4);
  CHECK(damping_ratio({-3, 4}) == Approx(0.6));
  CHECK(damping_ratio({2, 0}) == -1);
  CHECK(damping_ratio(0) == 0);
  CHECK(hertz(2 * std::numbers::pi) == Approx(1));
}

TEST_CASE("a conical pendulum's modes about hanging, leaning and standing", "[modes]") {
  const double length = 0.6, critical = std::sqrt(standard_gravity / length);
  SECTION("hanging, slower than critical") {
    const std::vector<VibrationMode> modes = modes_of(conical(length, 0, 0.5 * critical));
    REQUIRE(modes.size() == 1);
    CHECK(modes[0].frequency == Approx(critical * std::sqrt(0.75)).epsilon(1e-12));
    CHECK(modes[0].damping_ratio == Approx(0).margin(1e-12));
    CHECK(part(modes[0], "swing") == 1.);
  }
  SECTION("leaning, faster") {
    const double w = 2 * critical;
    const std::vector<VibrationMode> modes = modes_of(conical(length, 0, w, 0.3));
    REQUIRE(modes.size() == 1);
    CHECK(modes[0].frequency == Approx(w * std::sqrt(1 - 1. / 16)).epsilon(1e-12));
  }
  SECTION("hanging, faster: one mode grows and one decays") {
    const std::vector<VibrationMode> modes = modes_of(conical(length, 0, 2 * critical), nearest());
    REQUIRE(modes.size() == 2);
    for (int i : {0, 1}) {
      CHECK_FALSE(modes[static_cast<std::size_t>(i)].oscillates());
      CHECK(modes[static_cast<std::size_t>(i)].eigenvalue.real() ==
            Approx((i == 0 ? 1 : -1) * critical * std::sqrt(3.)).epsilon(1e-12));
    }
    CHECK(modes[0].damping_ratio == Approx(-1));
  }
}

TEST_CASE("two equal pendulums swing together and against each other", "[modes]") {
  const double stiffness = 7, low = std::sqrt(standard_gravity / 0.5);
  const double high = std::sqrt(standard_gravity / 0.5 + 2 * stiffness * 0.09 / 0.25);
  const std::vector<VibrationMode> modes = modes_of(two_pendulums(stiffness));
  REQUIRE(modes.size() == 2);
  CHECK(modes[0].frequency == Approx(low).epsilon(1e-12));
  CHECK(std::abs(part(modes[0], "left") - part(modes[0], "right")) < 1e-12);
  CHECK(modes[1].frequency == Approx(high).epsilon(1e-12));
  CHECK(std::abs(part(modes[1], "left") + part(modes[1], "right")) < 1e-12);
  for (const VibrationMode& mode : modes)
    CHECK(mode.residual < 1e-13);
}

TEST_CASE("equal frequencies have as many shapes as there are motions", "[modes]") {
  const std::vector<VibrationMode> modes = modes_of(two_pendulums(0));
  REQUIRE(modes.size() == 2);
  Eigen::Matrix2cd shapes;
  for (int i : {0, 1})
    shapes.col(i) << part(modes[static_cast<std::size_t>(i)], "left"),
        part(modes[static_cast<std::size_t>(i)], "right");
  CHECK(std::abs(shapes.determinant()) > 0.5);
}

TEST_CASE("a rotor in gimbals nods: gyroscopic modes move a quarter turn apart", "[modes]") {
  const double axial = 0.01, across = 0.006, rate = 300, outer = 4, inner = 7;
  Mechanism m;
  m.bodies = {body("outer", 0.1, {0, 0, 0}, {1e-3, 2e-3, 1e-3}),
              body("inner", 0.1, {0, 0, 0}, {1e-3, 1e-3, 1e-3}),
              body("rotor", 1, {0, 0, 0}, {axial, across, across})};
  m.joints = {sprung(revolute("outer", "ground", "outer", {0, 0, 0}, {0, 1, 0}), outer),
              sprung(revolute("inner", "outer", "inner", {0, 0, 0}, {0, 0, 1}), inner),
              driven(revolute("rotor", "inner", "rotor", {0, 0, 0}, {1, 0, 0}), rate)};
  const std::vector<VibrationMode> modes = modes_of(m);
  REQUIRE(modes.size() == 2);
  // i1 i2 w^4 - (i1 k2 + i2 k1 + g^2) w^2 + k1 k2 = 0
  const double i1 = 3e-3 + across, i2 = 1e-3 + across, g = axial * rate;
  const double b = i1 * inner + i2 * outer + g * g, root = std::sqrt(b * b - 4 * i1 * i2 * inner * outer);
  const double nutation = std::sqrt((b + root) / (2 * i1 * i2));
  const double precession = std::sqrt(outer * inner / (i1 * i2)) / nutation;
  CHECK(modes[0].frequency == Approx(precession).epsilon(1e-9));
  CHECK(modes[1].frequency == Approx(nutation).epsilon(1e-12));
  CHECK(nutation == Approx(g / std::sqrt(i1 * i2)).epsilon(0.01)); // of the free rotor
  for (const VibrationMode& mode : modes) {
    // i1 a'' + g b' + k1 a = 0
    const double w = mode.frequency;
    const Complex ratio = -(outer - i1 * w * w) / (Complex(0, w) * g);
    CHECK(std::abs(part(mode, "inner") / part(mode, "outer") - ratio) < 1e-9 * std::abs(ratio));
  }
}

TEST_CASE("the governor's collar bounces as its one degree of freedom does", "[modes]") {
  const Mechanism m = shipped("governor");
  Analysis analysis(m);
  const Solution s = analysis.solve();
  const double angle = value(s, "arm1"), speed = 11.0174;
  const auto slide = [](long double a) {
    return 0.08L * std::sin(a) + std::sqrt(0.10922L * 0.10922L - 0.0064L * std::cos(a) * std::cos(a));
  };
  const auto potential = [&](long double a) {
    const long double x = slide(a), g = standard_gravity, stretch = x - 0.15L, cosine = std::cos(a);
    return -2 * g * 0.16L * std::sin(a) - g * x + 500 * stretch * stretch -
           static_cast<long double>(speed) * speed * 0.0256L * cosine * cosine;
  };
  const long double h = 1e-4L, a = angle;
  const auto slope = static_cast<double>((slide(a + h) - slide(a - h)) / (2 * h));
  const auto k = static_cast<double>((16 * (potential(a + h) + potential(a - h)) - potential(a + 2 * h) -
                                      potential(a - 2 * h) - 30 * potential(a)) /
                                     (12 * h * h));
  const double inertia = 2 * (0.1 + 0.0256) + slope * slope, damping = 30 * slope * slope;
  const std::vector<VibrationMode> modes = analysis.modes();
  REQUIRE(modes.size() == 1);
  CHECK(modes[0].natural_frequency == Approx(std::sqrt(k / inertia)).epsilon(1e-6));
  CHECK(modes[0].damping_ratio == Approx(damping / (2 * std::sqrt(k * inertia))).epsilon(1e-6));
  CHECK(std::abs(part(modes[0], "arm1") - part(modes[0], "arm2")) < 1e-12);
  CHECK(std::abs(part(modes[0], "slide") / part(modes[0], "arm1") - slope) < 1e-6);
}

TEST_CASE("massless coordinates follow the mode", "[modes]") {
  const double k1 = 30, k2 = 80;
  Mechanism m;
  m.bodies = {body("joint", 0, {0, 0, 0}), body("mass", 0.5, {1, 0, 0})};
  m.joints = {sprung(prismatic("a", "ground", "joint", {0, 0, 0}, {1, 0, 0}), k1, 0.2),
              sprung(prismatic("b", "joint", "mass", {1, 0, 0}, {1, 0, 0}), k2, -0.1)};
  const std::vector<VibrationMode> modes = modes_of(m);
  REQUIRE(modes.size() == 1);
  CHECK(modes[0].frequency == Approx(std::sqrt(k1 * k2 / (k1 + k2) / 0.5)));
  CHECK(std::abs(part(modes[0], "a") / part(modes[0], "b") - k2 / k1) < 1e-12); // one force through both
}

TEST_CASE("poses along a mode keep the loops closed and come back after a turn", "[modes]") {
  for (const char* name : {"governor", "watt_governor", "fourbar_turntable", "governor_bearing", "chain20"}) {
    INFO(name);
    const Mechanism m = shipped(name);
    Analysis analysis(m);
    REQUIRE(analysis.modes().empty()); // nothing is solved yet
    REQUIRE(analysis.solve().status == Status::converged);
    const std::vector<VibrationMode> modes = analysis.modes();
    REQUIRE_FALSE(modes.empty());
    const std::vector<Pose> steady = analysis.poses_at(0.3);
    for (const VibrationMode& mode : modes) {
      CHECK(mode.residual < 1e-9);
      double furthest = 0;
      for (int i = 0; i < 12; ++i) {
        const double phase = 2 * std::numbers::pi * i / 12;
        const std::vector<Pose> poses = analysis.mode_poses(mode, 0.2, phase, 0.3);
        CHECK(opening(m, poses) < 1e-12);
        const std::vector<Pose> again = analysis.mode_poses(mode, 0.2, phase + 2 * std::numbers::pi, 0.3);
        for (std::size_t b = 0; b < poses.size(); ++b) {
          CHECK((poses[b].position - again[b].position).norm() < 1e-12);
          furthest = std::max({furthest, (poses[b].position - steady[b].position).norm(),
                               poses[b].rotation.angularDistance(steady[b].rotation)});
        }
      }
      CHECK(furthest > 0.01);
      const std::vector<Pose> still = analysis.mode_poses(mode, 0, 1, 0.3);
      for (std::size_t b = 0; b < still.size(); ++b)
        CHECK((still[b].position - steady[b].position).norm() < 1e-12);
    }
    analysis.update(m);
    CHECK(analysis.modes().empty());
  }
}

TEST_CASE("modes of random mechanisms solve the linearised motion", "[modes]") {
  int solved = 0;
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    reference::RandomOptions options;
    options.loops = static_cast<int>(seed % 3);
    options.parallel_axes = seed % 3 != 0;
    options.spring_share = 1;
    Analysis analysis(reference::random_mechanism(seed, options));
    const Solution s = analysis.solve();
    if (s.status != Status::converged || !s.eigenvalues) continue;
    ++solved;
    INFO(seed);
    const auto wanted = std::ranges::count_if(*s.eigenvalues, [](Complex e) { return e.imag() >= 0; });
    const std::vector<VibrationMode> modes = analysis.modes();
    CHECK(static_cast<std::ptrdiff_t>(modes.size()) <= wanted);
    for (const VibrationMode& mode : modes)
      CHECK(mode.residual < 1e-7);
  }
  CHECK(solved > 60);
}

TEST_CASE("the potential and the eigenvalues agree, or it is said why not", "[modes][evidence]") {
  int agreed = 0, unstable = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    reference::RandomOptions options;
    options.conservative = true;
    options.loops = static_cast<int>(seed % 2);
    options.parallel_axes = seed % 2 != 0;
    Analysis analysis(reference::random_mechanism(seed, options));
    const Solution s = analysis.solve(nearest());
    if (s.status != Status::converged) continue;
    const std::optional<StabilityEvidence> evidence = analysis.stability_evidence();
    REQUIRE(evidence.has_value());
    CAPTURE(seed, evidence->reason, evidence->downhill, evidence->null, evidence->growing);
    CHECK_FALSE(evidence->reason.empty());
    if (!evidence->potential) continue;
    if (evidence->downhill == 0 && evidence->null == 0)
      CHECK(evidence->growing == 0); // Lagrange and Dirichlet
    if (evidence->downhill % 2 == 1 && evidence->null == 0 && evidence->growing == 0)
      CHECK(evidence->reason.find("no mass") != std::string::npos); // Kelvin, Tait and Chetaev
    if (evidence->agree)
      ++agreed;
    else
      CHECK((s.stability_reason == StabilityReason::gyroscopic_only || s.stable == false ||
             s.stability_reason == StabilityReason::marginal ||
             s.stability_reason == StabilityReason::neutral));
    if (s.stable == false) ++unstable;
  }
  CHECK(agreed > 40);
  CHECK(unstable > 3);
}

TEST_CASE("gyroscopic forces hold a puck that the potential lets go", "[modes][evidence]") {
  Mechanism m;
  m.bodies = {spindle(), body("x", 0, {0, 0, 0}), body("puck", 0.5, {0, 0, 0})};
  m.joints = {spin(14, {0, 0, 1}), sprung(prismatic("x", "spindle", "x", {0, 0, 0}, {1, 0, 0}), 50),
              sprung(prismatic("y", "x", "puck", {0, 0, 0}, {0, 1, 0}), 50)};
  Analysis analysis(m);
  const Solution s = analysis.solve(nearest());
  REQUIRE(s.stability_reason == StabilityReason::gyroscopic_only);
  const auto evidence = analysis.stability_evidence();
  REQUIRE(evidence.has_value());
  CHECK(evidence->downhill == 2);
  CHECK(evidence->growing == 0);
  CHECK_FALSE(evidence->agree);
  CHECK(evidence->reason.find("gyroscopic") != std::string::npos);
  set_parameter(m, "joints.spin.drive.speed", 5);
  analysis.update(m);
  CHECK_FALSE(analysis.stability_evidence().has_value());
  analysis.solve();
  CHECK(analysis.stability_evidence()->agree);
}
