// Equations of motion of one form, to be compared with those of another.
#pragma once

#include "tests/engine/dynamics_runs.hpp"

#include "engine/dynamics/motion_ode.hpp"
#include "engine/dynamics/start.hpp"

#include <random>

namespace flyball::test {

enum class Form { dense, tree, sparse };

// A mechanism in motion, with its equations of one kind.
struct Motion {
  Motion(const Mechanism& mechanism, Form form) : model(make_motion_model(mechanism, true)) {
    model.along_tree = form == Form::tree;
    model.sparse = form == Form::sparse;
    equations = std::make_unique<Equations>(model, watch);
  }

  // At a steady state. Throws SceneError where there is none.
  void settle() {
    SimulationOptions o;
    o.start = Start::equilibrium;
    find_start(o, model, q, s);
    set_sides();
  }

  // Anywhere, everything moving; `spin` is the part of that of rotations of three coordinates.
  void stir(std::uint32_t seed, double spin) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    drawn_configuration(model.system, model.parameters, q);
    Eigen::VectorXd step(model.system.nv);
    s.resize(model.system.nv);
    for (int v = 0; v < model.system.nv; ++v) {
      step[v] = 0.4 * any(random) * model.scaling.column[v];
      s[v] = 3 * any(random) * model.scaling.column[v];
    }
    for (const Link& link : model.system.links)
      if (link.v >= 0 && link.type == LinkType::spherical) s.segment<3>(link.v) *= spin;
    retract<double>(model.system, step, q);
    set_sides();
  }

  // Where it is, with its rotations as they are.
  void set_sides() {
    flips = list_flips(model.system, model.parameters);
    for (FlipElement& flip : flips) {
      const auto l = static_cast<std::size_t>(flip.link);
      flip.side = joint_rotation(model.system.links[l], model.parameters.links[l], q).w() >= 0;
    }
    equations->latch({}, {}, flips);
    equations->analyse(time, q, s);
    REQUIRE(equations->evaluate(time, q, s));
  }

  // (I - gamma J)^-1 of any vector, in coordinates and rates.
  Eigen::VectorXd newton_step(double gamma, bool by_quotients) {
    MotionOde ode(*equations, watch, 1e-10, 1, 1);
    Eigen::VectorXd y;
    ode.pack(q, s, Eigen::Vector3d::Zero(), y);
    NewtonMatrix matrix;
    if (by_quotients) {
      const auto rate = [&](const double* at, double* out) { return ode.rate(time, at, out); };
      Eigen::VectorXd rates(y.size());
      REQUIRE(ode.rate(time, y.data(), rates.data()));
      REQUIRE(matrix.take_quotients(rate, y.data(), rates.data(),
                                    Eigen::VectorXd::Ones(model.system.nq + model.system.nv), ode.size()));
    } else {
      REQUIRE(equations->evaluate(time, q, s));
      REQUIRE(matrix.take_derivatives(*equations, y.data()));
    }
    REQUIRE(matrix.factor(gamma));
    for (Eigen::Index i = 0; i < y.size(); ++i)
      y[i] = std::sin(1.1 * static_cast<double>(i) + 0.2);
    matrix.solve(y.data());
    return y.head(model.system.nq + model.system.nv);
  }

  // The configuration after so many seconds from rest.
  Eigen::VectorXd after(double seconds, Integrator method) {
    SimulationOptions o;
    Eigen::VectorXd u, y;
    find_start(o, model, q, u);
    equations->latch({}, {}, list_flips(model.system, model.parameters));
    equations->analyse(0, q, u);
    REQUIRE(equations->reduce(0, q, u, s));
    MotionOde ode(*equations, watch, 1e-10, 1, 1);
    ode.pack(q, s, Eigen::Vector3d::Zero(), y);
    const auto stepper = method == Integrator::runge_kutta ? make_runge_kutta_stepper(ode, 0)
                                                           : make_cvode_stepper(ode, method);
    stepper->start(0, y);
    for (double t = 0; t < seconds;) {
      const StepOutcome outcome = stepper->step(seconds);
      REQUIRE(outcome.kind == StepOutcome::advanced);
      t = outcome.time;
    }
    stepper->state_at(seconds, y);
    return y.head(model.system.nq);
  }

  static constexpr double time = 0.37; // s
  Watch watch;
  MotionModel model;
  std::unique_ptr<Equations> equations;
  std::vector<FlipElement> flips;
  Eigen::VectorXd q, s;
};

inline double size_of(const Eigen::VectorXd& v) {
  return v.lpNorm<Eigen::Infinity>();
}

// Of the mass matrix in scaled units, largest eigenvalue over smallest.
inline double condition(const Motion& m) {
  MassMatrix mass;
  evaluate_mass(m.model.released, m.model.parameters, m.equations->kinematics(), mass);
  const int n = m.model.system.nv;
  const auto column = m.model.scaling.column.asDiagonal();
  const Eigen::MatrixXd scaled = column * mass.mass.topLeftCorner(n, n) * column;
  const auto values = symmetric_eigenvalues(scaled);
  REQUIRE(values);
  return (*values)[n - 1] / (*values)[0];
}

} // namespace flyball::test
