// Small motions about the steady state: the eigenvalues that solving reports are those of the motion.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/dynamics/equations.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/kkt/constraint_space.hpp"

#include <Eigen/Eigenvalues>

#include <complex>

using namespace flyball;
using namespace flyball::test;

namespace {

using Complex = std::complex<double>;

// About the steady state, by central differences of the equations of motion on the constraints. Empty where
// massless bodies make some of it algebraic.
std::vector<Complex> eigenvalues_by_differences(const Mechanism& m) {
  MotionModel model = make_motion_model(m, true);
  SimulationOptions o;
  o.start = Start::equilibrium;
  Eigen::VectorXd q, u;
  find_start(o, model, q, u);
  const Watch watch;
  Equations equations(model, watch);
  equations.analyse(0, q, u);
  if (equations.has_massless() || !equations.evaluate(0, q, u)) return {};
  Linearization l;
  linearize_constraints(model.released, model.parameters, equations.kinematics(), l);
  const int n = model.system.nv;
  const Eigen::VectorXd& column = model.scaling.column;
  ConstraintSpace space;
  space.factor(model.scaling.row.asDiagonal() * l.constraint.leftCols(n) * column.asDiagonal(), 1e-9);
  const Eigen::MatrixXd& basis = space.basis(); // of scaled coordinates
  const Eigen::Index f = basis.cols();
  if (f == 0) return {};
  const auto acceleration = [&](const Eigen::VectorXd& place, const Eigen::VectorXd& rate) {
    Eigen::VectorXd at = q, s = u + column.cwiseProduct(basis * rate);
    const Eigen::VectorXd step = column.cwiseProduct(basis * place);
    retract<double>(model.system, step, at);
    REQUIRE(equations.project(0, at, s));
    REQUIRE(equations.evaluate(0, at, s));
    return Eigen::VectorXd(basis.transpose() * equations.acceleration().cwiseQuotient(column));
  };
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * f, 2 * f);
  a.topRightCorner(f, f).setIdentity();
  const double h = 1e-5;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(f);
  for (Eigen::Index i = 0; i < f; ++i) {
    const Eigen::VectorXd e = h * Eigen::VectorXd::Unit(f, i);
    a.block(f, i, f, 1) = (acceleration(e, none) - acceleration(-e, none)) / (2 * h);
    a.block(f, f + i, f, 1) = (acceleration(none, e) - acceleration(none, -e)) / (2 * h);
  }
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
  return {values.begin(), values.end()};
}

// Each of one has one of its own among the others. Double eigenvalues are known to the square root only.
void check_same(std::vector<Complex> found, const std::vector<Complex>& wanted) {
  REQUIRE(found.size() == wanted.size());
  double size = 0;
  for (const Complex x : wanted)
    size = std::max(size, std::abs(x));
  CAPTURE(found, wanted);
  for (const Complex x : wanted) {
    const auto there = std::ranges::min_element(
        found, [&](Complex a, Complex b) { return std::abs(a - x) < std::abs(b - x); });
    double apart = size; // from the next of the wanted
    bool itself = false;
    for (const Complex y : wanted)
      if (y != x || std::exchange(itself, true)) apart = std::min(apart, std::abs(x - y));
    CHECK(std::abs(*there - x) <= (apart < 1e-2 * size ? 1e-3 : 1e-6) * size);
    found.erase(there);
  }
}

} // namespace

TEST_CASE("eigenvalues of the shipped scenes, by differences of their motion") {
  for (const std::string& name : shipped_names) {
    if (moves_periodically(name)) continue;
    CAPTURE(name);
    const Mechanism m = shipped(name);
    const Solution steady = solve(m);
    REQUIRE(steady.eigenvalues);
    std::vector<Complex> found = eigenvalues_by_differences(m);
    REQUIRE_FALSE(found.empty());
    // The angle of a shaft whose speed is found has the eigenvalue zero, a momentum that is kept another;
    // they say nothing.
    while (found.size() > steady.eigenvalues->size()) {
      const auto zero = std::ranges::min_element(found, {}, [](Complex x) { return std::abs(x); });
      CHECK(std::abs(*zero) < 1e-5);
      found.erase(zero);
    }
    check_same(found, *steady.eigenvalues);
  }
}

TEST_CASE("eigenvalues of random mechanisms, by differences of their motion") {
  int compared = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    reference::RandomOptions o;
    o.massless = false;
    o.stops = false;
    o.loops = static_cast<int>(seed % 2);
    o.spring_share = 1;
    o.air = seed % 4 == 3;
    const Mechanism m = reference::random_mechanism(seed, o);
    SolveOptions plain;
    const Solution steady = Analysis(m).solve(plain);
    if (steady.status != Status::converged || !steady.eigenvalues || !steady.neutral.empty()) continue;
    if (steady.floquet || steady.fallback == Fallback::search)
      continue; // no constant matrices; a start elsewhere
    const std::vector<Complex> found = eigenvalues_by_differences(m);
    if (found.empty()) continue;
    ++compared;
    check_same(found, *steady.eigenvalues);
  }
  CHECK(compared > 15);
}

namespace {

// A rotor that spins about x in a gimbal that tilts about z on a turntable about y.
struct Gyro {
  double turn = 1.3, spin = 180, axial = 2e-3, across = 1.2e-3, stiffness = 0.9, damping = 2e-3;
  double gx = 3e-4, gy = 4e-4, gz = 5e-4; // of the gimbal

  Mechanism mechanism() const {
    Mechanism m;
    m.bodies = {spindle(), body("gimbal", 0.1, {0, 0, 0}, {gx, gy, gz}),
                body("rotor", 0.2, {0, 0, 0}, {axial, across, across})};
    m.joints = {
        test::spin(turn),
        dampened(sprung(revolute("tilt", "spindle", "gimbal", {0, 0, 0}, {0, 0, 1}), stiffness), damping),
        driven(revolute("rotor", "gimbal", "rotor", {0, 0, 0}, {1, 0, 0}), spin)};
    return m;
  }
  double inertia() const { return across + gz; }
  // Of the tilt, by Lagrange's equation.
  long double acceleration(long double tilt, long double rate) const {
    using std::cos, std::sin;
    const long double w = turn, torque = axial * (spin + w * sin(tilt)) * w * cos(tilt) +
                                         (gx - gy - across) * w * w * sin(tilt) * cos(tilt);
    return (torque - stiffness * tilt - damping * rate) / inertia();
  }
};

} // namespace

TEST_CASE("a rate gyro tilts and nutates as its own equation says") {
  const Gyro gyro;
  // The scalar equation by many small classical steps in extended precision.
  std::vector<double> wanted;
  long double x = 0, v = 0;
  const int substeps = 2000;
  const long double h = 0.01L / substeps;
  for (int i = 0; i < 100; ++i) {
    wanted.push_back(static_cast<double>(x));
    for (int k = 0; k < substeps; ++k) {
      const long double a1 = gyro.acceleration(x, v), v2 = v + h / 2 * a1;
      const long double a2 = gyro.acceleration(x + h / 2 * v, v2), v3 = v + h / 2 * a2;
      const long double a3 = gyro.acceleration(x + h / 2 * v2, v3), v4 = v + h * a3;
      const long double a4 = gyro.acceleration(x + h * v3, v4);
      x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
  }
  const Mechanism m = gyro.mechanism();
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const Run run = simulate(m, lasting(1, method, 1e-12));
    check_sound(run);
    double worst = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      worst = std::max(worst, std::abs(track(run, "tilt").value[i] - wanted[i]));
    CHECK(worst < 1e-8);
  }
  // Small motions: the roots of the linearised scalar equation.
  const Solution steady = solve(m);
  const double tilt = value(steady, "tilt");
  CHECK(std::abs(gyro.acceleration(tilt, 0)) < 1e-9);
  const double k =
      static_cast<double>((gyro.acceleration(tilt - 1e-6, 0) - gyro.acceleration(tilt + 1e-6, 0)) / 2e-6L);
  const double decay = gyro.damping / gyro.inertia() / 2;
  const Complex root(-decay, std::sqrt(k - decay * decay));
  REQUIRE(steady.eigenvalues);
  check_same(*steady.eigenvalues, {root, std::conj(root)});
}
