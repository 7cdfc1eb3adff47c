// Sparse elimination: the same equations as the dense ones, for whatever hangs on springs.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/equilibrium/find_equilibrium.hpp"

#include <Eigen/Eigenvalues>

#include <random>

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

// Point masses in a square frame that turns about the vertical, tied to their neighbours by stretched
// springs.
Mechanism net(int side, double speed) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(speed)};
  const double cell = 1. / (side + 1);
  const auto at = [&](int i, int j) { return Vec3((i + 1) * cell - 0.5, 0, (j + 1) * cell - 0.5); };
  const auto name = [&](int i, int j) {
    const bool inside = std::min(i, j) >= 0 && std::max(i, j) < side;
    return inside ? "knot" + std::to_string(i) + "_" + std::to_string(j) : std::string("spindle");
  };
  const auto tie = [&](int i, int j, int k, int l) {
    Force s;
    s.name = "cable" + std::to_string(m.forces.size());
    s.bodies = {name(i, j), name(k, l)};
    s.points = {at(i, j), at(k, l)};
    s.stiffness = 200;
    s.free_length = cell / 1.1;
    m.forces.push_back(s);
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      m.bodies.push_back(body(name(i, j), 1. / (side * side), at(i, j)));
  for (int i = 0; i < side; ++i)
    for (int j = -1; j < side; ++j) {
      tie(i, j, i, j + 1);
      tie(j, i, j + 1, i);
    }
  return m;
}

struct Case {
  Mechanism mechanism;
  System system;
  Parameters parameters;
  Scaling scaling;
  Unknowns z;
  Workspace sparse, dense;

  explicit Case(Mechanism m) : mechanism(std::move(m)), system(compile(mechanism)) {
    system.elimination = Elimination::sparse;
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, z.q);
    z.lambda.resize(0);
  }
  Problem problem(bool whole) const { return {system, parameters, scaling, nullptr, whole}; }
  void factor_at(const Eigen::VectorXd& step) {
    retract<double>(system, step, z.q);
    for (const bool whole : {false, true}) {
      Workspace& w = whole ? dense : sparse;
      evaluate(problem(whole), z, 0, w);
      factor(problem(whole), z, w);
    }
  }
};

} // namespace

TEST_CASE("a step by sparse elimination solves the dense equations") {
  int symmetric = 0, unsymmetric = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    ref::RandomOptions options;
    options.bodies = 9;
    options.massless = false;
    options.conservative = seed % 2 == 0;
    options.drives = seed % 3 == 0 ? ref::RandomDrives::several : ref::RandomDrives::root;
    Case x(ref::random_mechanism(seed, options));
    if (x.system.rows > 0 || x.system.nv == 0) continue;
    CAPTURE(seed, x.system.nv);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-0.3, 0.3);
    Eigen::VectorXd step(x.system.nv), rhs(x.system.nv), solved;
    for (int i = 0; i < x.system.nv; ++i) {
      step[i] = any(random) * x.scaling.column[i];
      rhs[i] = any(random);
    }
    x.factor_at(step);
    Eigen::MatrixXd k = x.dense.scaled_stiffness;
    const bool potential = x.problem(false).symmetric();
    if (potential) k = ((k + k.transpose()) / 2).eval();
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(k).singularValues();
    if (values.minCoeff() < 1e-9 * values.maxCoeff() || !x.sparse.sparse.flat().empty()) continue;
    x.sparse.sparse.solve(rhs, solved);
    CHECK((k * solved - rhs).norm() <= 1e-9 * (values.maxCoeff() * solved.norm() + rhs.norm()));
    if (potential) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
      CHECK(x.sparse.sparse.negative_count() == (eigen.eigenvalues().array() < 0).count());
    }
    ++(potential ? symmetric : unsymmetric);
  }
  CHECK(symmetric > 25);
  CHECK(unsymmetric > 25);
}

TEST_CASE("a net of springs hangs in its turning frame") {
  // As many bodies as make the dense equations slow: sags, keeps the square's symmetry, and the weight hangs
  // on the spindle.
  const int side = 20;
  const Solution s = solve(net(side, 3));
  REQUIRE(s.status == Status::converged);
  CHECK(s.residual < 1e-12);
  CHECK(s.stability_reason == StabilityReason::neutral); // the point masses may turn
  const auto knot = [&](int i, int j) {
    return s.poses[static_cast<std::size_t>(1 + i * side + j)].position;
  };
  CHECK(knot(side / 2, side / 2).y() < -0.01);
  for (int i = 0; i < side; ++i) {
    CHECK(std::abs(knot(i, 3).y() - knot(3, i).y()) < 1e-12);
    CHECK(std::abs(knot(i, 3).y() - knot(side - 1 - i, 3).y()) < 1e-12);
  }
  CHECK(std::abs(s.reactions.front().force.y() - 2 * standard_gravity) < 1e-9);
}
