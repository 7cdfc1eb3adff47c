// Stiff motions of any size: how they are recognised, and the matrix of their implicit steps.
#include "tests/engine/dynamics_runs.hpp"

#include "engine/dynamics/choose_method.hpp"
#include "engine/dynamics/fastest_rates.hpp"
#include "engine/dynamics/motion_ode.hpp"
#include "engine/linear/pencil.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// Springs and dampers in every hinge, N m and N m s, and a spindle whose turning bends it.
Mechanism springy_chain(int links, double stiffness, double damping) {
  Mechanism m = hanging_chain(links, 5);
  for (std::size_t i = 1; i < m.joints.size(); ++i)
    m.joints[i] = dampened(sprung(m.joints[i], stiffness, 0.01), damping);
  return m;
}

// A mechanism in motion, with its equations.
struct Motion {
  Motion(const Mechanism& mechanism, double stir)
      : model(make_motion_model(mechanism, true)), equations(model, watch) {
    drawn_configuration(model.system, model.parameters, q);
    Eigen::VectorXd step(model.system.nv), u(model.system.nv);
    for (int v = 0; v < model.system.nv; ++v) {
      step[v] = 0.3 * stir * std::sin(2.1 * v + 1) * model.scaling.column[v];
      u[v] = stir * std::cos(1.3 * v + 2) * model.scaling.column[v];
    }
    retract<double>(model.system, step, q);
    equations.latch({}, {}, list_flips(model.system, model.parameters));
    equations.analyse(0, q, u);
    REQUIRE(equations.reduce(0, q, u, s));
    REQUIRE(equations.evaluate(0, q, s));
  }

  Watch watch;
  MotionModel model;
  Equations equations;
  Eigen::VectorXd q, s;
};

// The largest difference between (I - gamma J)^-1 b by derivatives and by difference quotients, in the
// coordinates and their rates, relative.
double matrix_error(const Mechanism& mechanism, double stir, double gamma) {
  Motion m(mechanism, stir);
  MotionOde ode(m.equations, m.watch, 1e-10, 1, 1);
  Eigen::VectorXd y;
  ode.pack(m.q, m.s, Eigen::Vector3d::Zero(), y);
  Eigen::VectorXd rate(y.size());
  REQUIRE(ode.rate(0, y.data(), rate.data()));
  const int known = m.model.system.nq + m.model.system.nv;
  NewtonMatrix exact, quotients;
  const auto rate_at = [&](const double* at, double* out) { return ode.rate(0, at, out); };
  REQUIRE(quotients.take_quotients(rate_at, y.data(), rate.data(), Eigen::VectorXd::Ones(known), ode.size()));
  REQUIRE(m.equations.evaluate(0, m.q, m.s));
  REQUIRE(exact.take_derivatives(m.equations, y.data()));
  REQUIRE(exact.factor(gamma));
  REQUIRE(quotients.factor(gamma));
  Eigen::VectorXd a(y.size());
  for (Eigen::Index i = 0; i < a.size(); ++i)
    a[i] = std::sin(1.1 * static_cast<double>(i) + 0.2);
  Eigen::VectorXd b = a;
  exact.solve(a.data());
  quotients.solve(b.data());
  return (a - b).head(known).lpNorm<Eigen::Infinity>() / b.head(known).lpNorm<Eigen::Infinity>();
}

} // namespace

TEST_CASE("the matrix of implicit steps is the derivative of the motion's rates") {
  for (const double gamma : {1e-4, 1e-2, 0.3}) {
    CAPTURE(gamma);
    CHECK(matrix_error(springy_chain(6, 20, 0.3), 1, gamma) < 1e-5); // of which the quotients have most
    CHECK(matrix_error(shipped("conical_pendulum"), 1, gamma) < 1e-6);
    CHECK(matrix_error(shipped("pendulum"), 0.2, gamma) < 1e-6);
    // Of loops the curvature is left out, of free rotations what their own spin adds: nothing at rest.
    if (gamma > 0.1) continue; // steps as long as that are none that loops are taken in
    CHECK(matrix_error(shipped("ball_on_string"), 0, gamma) < 0.3);
    CHECK(matrix_error(shipped("governor"), 0, gamma) < 0.3);
  }
}

TEST_CASE("the fastest rates of a motion are those of its pencil") {
  for (const double damping : {0., 1e-4, 0.1}) {
    CAPTURE(damping);
    Motion m(springy_chain(20, 10, damping), 0.1);
    const Equations::Pencil p = m.equations.pencil();
    double largest = 0, found = 0;
    const auto rates = pencil_eigenvalues(p.mass, p.velocity, p.stiffness);
    REQUIRE(rates);
    for (const std::complex<double>& rate : *rates)
      largest = std::max(largest, std::abs(rate));
    for (const std::complex<double>& rate : fastest_rates(m.equations, 0, m.q, m.s))
      found = std::max(found, std::abs(rate));
    CHECK(found == Approx(largest).epsilon(0.02));
  }
}

TEST_CASE("a stiff chain is followed by BDF at any size, and as explicit steps do") {
  for (const int links : {12, 80}) {
    CAPTURE(links);
    const Mechanism m = springy_chain(links, 10, 0.02);
    SimulationOptions options = lasting(links == 12 ? 0.02 : 0.001);
    options.rate = 10 / options.duration;
    options.method = Integrator::bdf;
    const Run implicit = simulate(m, options);
    options.method = Integrator::runge_kutta;
    const Run explicit_one = simulate(m, options);
    check_sound(implicit);
    check_sound(explicit_one);
    REQUIRE(implicit.time == explicit_one.time);
    for (std::size_t k = 0; k < implicit.coordinates.size(); ++k)
      for (std::size_t i = 0; i < implicit.time.size(); ++i)
        CHECK(std::abs(implicit.coordinates[k].value[i] - explicit_one.coordinates[k].value[i]) < 1e-8);
  }
  SimulationOptions options = lasting(1);
  options.time_limit = 30;
  const Run run = simulate(springy_chain(100, 10, 0.02), options);
  CAPTURE(run.message, run.method_reason, run.statistics.steps, run.statistics.run_time_s);
  CHECK(run.method == Integrator::bdf);
  check_sound(run, 1e-6);
  CHECK(run.statistics.steps < 10000);
}
