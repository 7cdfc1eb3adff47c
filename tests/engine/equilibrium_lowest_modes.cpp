// Modes of large mechanisms without their matrices, against the dense ones and closed forms.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/torque_parts.hpp"

#include "engine/kkt/motion_products.hpp"
#include "engine/solve/factored_state.hpp"
#include "engine/stability/lowest_modes.hpp"

#include <random>

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

double size_of(const Eigen::VectorXd& v) {
  return v.size() == 0 ? 0 : v.lpNorm<Eigen::Infinity>();
}

// A chain of `links` rods that turns about the vertical, with a spring in every joint.
struct ChainOptions {
  int links = 60;
  double speed = 3, stiffness = 20, damping = 0;
  JointType joint = JointType::revolute; // about z, or universal
  double drag = 0;                       // N s/m, on every rod
  bool loop = false;                     // the tip is tied to the spindle by a distance joint
};

Mechanism chain(const ChainOptions& o) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(o.speed)};
  const double length = 1. / o.links, mass = 1. / o.links, turning = mass * length * length / 12;
  for (int i = 0; i < o.links; ++i) {
    const std::string name = "rod" + std::to_string(i);
    m.bodies.push_back(body(name, mass, {0.1, -(i + 0.5) * length, 0}, {turning, turning / 10, turning}));
    Joint j = joint(o.joint, "hinge" + std::to_string(i), m.bodies[static_cast<std::size_t>(i)].name, name,
                    {0.1, -i * length, 0}, Vec3::UnitZ());
    for (std::size_t c = 0; c < j.coordinates.size(); ++c)
      j = dampened(sprung(j, o.stiffness, 0, c), o.damping, c);
    m.joints.push_back(j);
    if (o.drag == 0) continue;
    Force drag;
    drag.name = "drag" + std::to_string(i);
    drag.type = ForceType::drag;
    drag.body = name;
    drag.at = m.bodies.back().position;
    drag.linear = o.drag;
    m.forces.push_back(drag);
  }
  if (o.loop)
    m.joints.push_back(distance("tie", "spindle", m.bodies.back().name, {0.6, -0.2, 0}, {0.1, -1, 0}));
  return m;
}

// The steady state of a mechanism found by form, and its modes both ways.
struct BothModes {
  std::vector<VibrationMode> dense; // the nearest to zero first
  LowestModes lowest;
};

// Nothing where Newton-Raphson does not converge from the drawn pose.
std::optional<BothModes> modes_both_ways(const Mechanism& m, KktForm form, int count) {
  validate(m);
  System system = compile(m);
  system.kkt_form = form;
  Parameters parameters;
  Scaling scaling;
  Unknowns z;
  bind(system, m, parameters);
  set_scaling(system, parameters, scaling);
  drawn_configuration(system, parameters, z.q);
  z.lambda.setZero(system.rows);
  const Problem dense{system, parameters, scaling}, large{system, parameters, scaling, nullptr, form};
  Workspace w;
  NewtonSettings settings;
  settings.damped = true;
  settings.max_iterations = 200;
  if (!newton(dense, z, w, settings, nullptr).converged) return {};
  BothModes out{find_modes(factor_at(dense, z, w)), {}};
  std::ranges::stable_sort(out.dense, {}, &VibrationMode::natural_frequency);
  out.lowest = find_lowest_modes(large, z, count, w);
  return out;
}

BothModes both_modes(const Mechanism& m, KktForm form, int count) {
  auto modes = modes_both_ways(m, form, count);
  REQUIRE(modes);
  return *modes;
}

void check_modes(const BothModes& modes, int count) {
  INFO(modes.lowest.failure);
  REQUIRE(modes.lowest.failure.empty());
  REQUIRE(modes.lowest.modes.size() == static_cast<std::size_t>(count));
  std::vector<VibrationMode> found = modes.lowest.modes;
  std::ranges::stable_sort(found, {}, &VibrationMode::natural_frequency);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::complex<double> s = found[i].eigenvalue;
    double nearest = std::abs(s - modes.dense[i].eigenvalue);
    // Of one size those of either side may come first.
    for (const VibrationMode& other : modes.dense)
      nearest = std::min(nearest, std::abs(s - other.eigenvalue));
    CAPTURE(i, s, modes.dense[i].eigenvalue);
    CHECK(nearest <= 1e-8 * std::abs(s));
    CHECK(std::abs(std::abs(s) - modes.dense[i].natural_frequency) <= 1e-8 * std::abs(s));
    CHECK(found[i].residual <= 1e-8);
  }
}

} // namespace

TEST_CASE("products with the matrices of the motion are those of the dense ones", "[modes]") {
  int with_loops = 0, with_drag = 0, moving = 0;
  for (std::uint32_t seed = 1; seed <= 160; ++seed) {
    ref::RandomOptions options;
    options.bodies = 8;
    options.loops = static_cast<int>(seed % 3);
    options.air = seed % 4 == 1;
    const Mechanism m = ref::random_mechanism(seed, options);
    const System system = compile(m);
    if (system.nv == 0 || !no_drive_rides(system)) continue;
    if (!system.turning_air.empty()) continue; // which takes the matrices
    Parameters parameters;
    Scaling scaling;
    bind(system, m, parameters);
    set_scaling(system, parameters, scaling);
    const Problem problem{system, parameters, scaling};
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto random_vector = [&](int size) {
      Eigen::VectorXd x(size);
      for (double& entry : x)
        entry = any(random);
      return x;
    };
    Unknowns z;
    drawn_configuration(system, parameters, z.q);
    retract<double>(system, 0.3 * random_vector(system.nv), z.q);
    z.lambda = 10 * random_vector(system.rows);
    Workspace w;
    evaluate(problem, z, 0, w);
    linearize(system, parameters, z.q, z.lambda, w.kinematics, w.residual, w.dense.linearization);
    linearize_motion(system, parameters, z.q, w.kinematics, w.dense.linearization);
    MotionProducts products;
    products.linearize(problem, z, w.kinematics, w.residual);
    const Eigen::VectorXd x = random_vector(system.nv), lambda = random_vector(system.rows);
    Eigen::VectorXd got;
    const auto agrees = [&](const Eigen::MatrixXd& dense, const char* name) {
      const Eigen::MatrixXd a = scaling.column.asDiagonal() * dense * scaling.column.asDiagonal();
      INFO(name << " of seed " << seed);
      CHECK(size_of(got - a * x) <= 1e-12 * size_of(a.cwiseAbs() * x.cwiseAbs()));
    };
    products.mass(x, got);
    agrees(w.dense.linearization.mass, "mass");
    products.velocity(x, got);
    agrees(w.dense.linearization.velocity, "velocity");
    CHECK(products.velocity_matters() == (w.dense.linearization.velocity.norm() > 1e-12));
    products.stiffness(x, got);
    agrees(w.dense.linearization.stiffness, "stiffness");
    products.constraint_transposed(lambda, got);
    const Eigen::VectorXd forces = scaling.column.cwiseProduct(w.dense.linearization.constraint.transpose() *
                                                               scaling.row.cwiseProduct(lambda));
    CHECK(size_of(got - forces) <= 1e-12 * (1 + size_of(forces)));
    with_loops += system.rows > 0;
    moving += parameters.moving;
    with_drag += std::ranges::any_of(m.forces, [](const Force& f) { return f.type == ForceType::drag; });
  }
  CHECK(with_loops > 40);
  CHECK(with_drag > 20);
  CHECK(moving > 60);
}

TEST_CASE("the lowest modes of chains are those of the matrices", "[modes]") {
  for (const JointType joint : {JointType::revolute, JointType::universal})
    for (const double damping : {0., 2e-4})
      for (const double drag : {0., 0.01}) {
        if (drag > 0 && joint == JointType::universal && damping > 0) continue;
        CAPTURE(static_cast<int>(joint), damping, drag);
        check_modes(both_modes(chain({.damping = damping, .joint = joint, .drag = drag}), KktForm::tree, 10),
                    10);
      }
  // And from the sparse equations of the bodies, with a loop.
  check_modes(both_modes(chain({.joint = JointType::universal, .loop = true}), KktForm::sparse, 8), 8);
  check_modes(both_modes(chain({.damping = 1e-3, .loop = true}), KktForm::sparse, 8), 8);
}

// Blocks on a spoke that turns with it, each on the one before by a spring and a damper. With lambda_j = 4
// sin^2((2 j - 1) pi / (4 n + 2)), the eigenvalues of a chain held at one end (Gantmacher and Krein,
// Oscillation Matrices and Kernels, 1950, section 3.8), s^2 + (c / m) lambda_j s + (k / m) lambda_j - Omega^2
// = 0.
TEST_CASE("modes of a thousand springy links that turn are those of the closed form", "[modes]") {
  constexpr int n = 1000;
  constexpr double mass = 1e-3, stiffness = 2e4, speed = 5;
  for (const double damping : {0., 0.5}) {
    Mechanism m;
    m.bodies = {spindle()};
    m.joints = {spin(speed)};
    for (int i = 0; i < n; ++i) {
      const std::string name = "block" + std::to_string(i);
      m.bodies.push_back(body(name, mass, {0.01 * (i + 1), 0, 0}));
      m.joints.push_back(
          dampened(sprung(prismatic("slide" + std::to_string(i), m.bodies[static_cast<std::size_t>(i)].name,
                                    name, {0.01 * i, 0, 0}, Vec3::UnitX()),
                          stiffness),
                   damping));
    }
    Analysis analysis(m);
    SolveOptions options;
    options.modes = 10;
    const Solution solution = analysis.solve(options);
    INFO(solution.message);
    REQUIRE(solution.status == Status::converged);
    CHECK(solution.stability_reason == StabilityReason::minimum);
    const auto expected = [&](int j) {
      const double half = std::sin((2 * j - 1) * std::numbers::pi / (4 * n + 2)), lambda = 4 * half * half;
      const double b = damping / mass * lambda / 2, square = stiffness / mass * lambda - speed * speed;
      return std::complex<double>(-b, std::sqrt(square - b * b));
    };
    const std::vector<VibrationMode> modes = analysis.modes();
    REQUIRE(modes.size() == 20);
    for (int j = 1; j <= 20; ++j) {
      const VibrationMode& mode = modes[static_cast<std::size_t>(j - 1)];
      CAPTURE(damping, j, mode.eigenvalue, expected(j));
      CHECK(std::abs(mode.eigenvalue - expected(j)) <= 1e-8 * std::abs(expected(j)));
      CHECK(mode.residual <= 1e-9);
      CHECK(mode.amplitudes.size() == n);
    }
    // Both of each pair, as many as asked for.
    REQUIRE(solution.eigenvalues);
    REQUIRE(solution.eigenvalues->size() == 10);
    for (std::size_t i = 0; i < 10; ++i)
      CHECK(std::abs(std::abs((*solution.eigenvalues)[i].imag()) -
                     expected(static_cast<int>(i) / 2 + 1).imag()) <=
            1e-8 * expected(static_cast<int>(i) / 2 + 1).imag());
  }
}

TEST_CASE("repeated eigenvalues come as often as they are", "[modes]") {
  // Alike pendulums on one hub: five of one length, and as many each of others.
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(0)};
  for (int i = 0; i < 150; ++i) {
    const double length = 1. / (1 + i % 30);
    const std::string name = "bob" + std::to_string(i);
    m.bodies.push_back(body(name, 1, {0.1, -length, 0}));
    m.joints.push_back(revolute("hinge" + std::to_string(i), "spindle", name, {0.1, 0, 0}, Vec3::UnitZ()));
  }
  for (const double damping : {0., 0.1}) {
    for (std::size_t i = 1; i < m.joints.size(); ++i)
      m.joints[i].coordinates[0].damping = damping;
    const BothModes modes = both_modes(m, KktForm::tree, 12);
    check_modes(modes, 12);
    for (std::size_t i = 0; i < 12 && damping == 0; ++i) {
      const double square = standard_gravity * (1. + static_cast<double>(i / 5));
      CHECK(std::abs(modes.lowest.modes[i].frequency - std::sqrt(square)) <= 1e-9 * std::sqrt(square));
    }
  }
}

TEST_CASE("a direction that nothing resists is a mode at zero", "[modes]") {
  for (const double damping : {0., 2e-4}) {
    Mechanism m = chain({.links = 30, .damping = damping, .joint = JointType::universal});
    m.joints[0].coordinates[0].drive.reset();
    const BothModes modes = both_modes(m, KktForm::tree, 8);
    INFO(modes.lowest.failure);
    REQUIRE(modes.lowest.modes.size() == 8);
    CHECK(modes.lowest.modes[0].eigenvalue == 0.);
    for (std::size_t i = 1; i < 8; ++i) {
      const VibrationMode& dense = modes.dense[i];
      CHECK(std::abs(std::abs(modes.lowest.modes[i].eigenvalue) - std::abs(dense.eigenvalue)) <=
            1e-7 * std::abs(dense.eigenvalue));
    }
  }
}

TEST_CASE("the lowest modes of random trees and loops are those of the matrices", "[modes]") {
  int trees = 0, loops = 0, with_dampers = 0;
  for (std::uint32_t seed = 1; seed <= 90; ++seed) {
    ref::RandomOptions options;
    options.bodies = 12;
    options.loops = static_cast<int>(seed % 3);
    options.spring_share = 1;
    if (options.loops == 0) { // nothing but what trees have, and hardly pushed
      options.bodies = 6;
      options.forces = options.stops = false;
    }
    const Mechanism m = ref::random_mechanism(seed, options);
    const System system = compile(m);
    if (system.nv < 4 || !no_drive_rides(system)) continue;
    const bool tree = is_plain_tree(system);
    CAPTURE(seed);
    const auto modes = modes_both_ways(m, tree ? KktForm::tree : KktForm::sparse, 3);
    if (!modes || modes->dense.size() < 6) continue;
    check_modes(*modes, 3);
    ++(tree ? trees : loops);
    with_dampers += std::ranges::any_of(
        modes->dense, [](const VibrationMode& mode) { return std::abs(mode.damping_ratio) > 1e-6; });
  }
  CHECK(trees > 10);
  CHECK(loops > 10);
  CHECK(with_dampers > 10);
}

TEST_CASE("of many coordinates on a shaft by torque the modes nearest to zero are told", "[modes]") {
  Mechanism m = hanging_chain(205, 3);
  for (std::size_t i = 1; i < m.joints.size(); ++i)
    m.joints[i] = dampened(sprung(m.joints[i], 2), 1e-3);
  m = with_torque(m, "6 N m - 2 N m s * rate(spin)");
  SolveOptions options;
  options.modes = 1000;
  Analysis analysis(m);
  const Solution all = analysis.solve(options);
  REQUIRE(all.eigenvalues);
  REQUIRE(all.eigenvalues->size() > 400);
  std::vector<double> sizes;
  for (const std::complex<double> s : *all.eigenvalues)
    sizes.push_back(std::abs(s));
  std::ranges::sort(sizes);
  options.modes = 5;
  const Solution some = analysis.solve(options);
  REQUIRE(some.eigenvalues);
  REQUIRE(some.eigenvalues->size() == 5);
  CHECK(std::ranges::any_of(*some.eigenvalues, [](std::complex<double> s) { return s.imag() > 1; }));
  for (const std::complex<double> s : *some.eigenvalues)
    CHECK(std::abs(s) <= sizes[4] * (1 + 1e-9));
  const std::vector<VibrationMode> modes = analysis.modes(3);
  REQUIRE(modes.size() == 3);
  for (const VibrationMode& mode : modes)
    CHECK(mode.natural_frequency <= sizes[5] * (1 + 1e-9)); // conjugate pairs counted once
}
