#include "engine/equilibrium/existence.hpp"

#include <algorithm>
#include <array>

namespace flyball {
namespace {

constexpr double tolerance = 1e-8;

// Evaluates the balance without multipliers at a phase and factors the constraints there.
void evaluate_phase(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  w.zero_lambda.setZero(problem.system.rows);
  Unknowns z{q, w.zero_lambda};
  evaluate(problem, z, t, w);
  linearize_constraints(problem.system, problem.parameters, w.kinematics, w.linearization);
  factor_constraints(problem, w);
}

} // namespace

std::vector<double> sample_phases(const System& system, const Parameters& p) {
  std::vector<double> phases;
  if (p.phase_free) return phases;
  std::vector<double> rates; // phases advance by about a radian, or a third of the reach
  for (const DrivenCoordinate& d : system.drives) {
    const double speed = std::abs(p.links[static_cast<std::size_t>(d.link)].speed);
    if (speed == 0) continue;
    const bool turns = system.links[static_cast<std::size_t>(d.link)].type == LinkType::revolute;
    const double rate = turns ? speed : 3 * speed / p.length;
    if (std::ranges::none_of(rates, [&](double r) { return std::abs(r - rate) < 1e-6 * rate; }))
      rates.push_back(rate);
  }
  if (rates.size() > 4) rates.resize(4);
  for (double rate : rates)
    for (double angle : std::array{1.0, 2.3, 3.9, 5.2})
      phases.push_back(angle / rate);
  return phases;
}

Existence check_existence(const Problem& problem, const Eigen::VectorXd& q, const std::vector<double>& phases,
                          Workspace& w) {
  Existence result;
  for (double t : phases) {
    evaluate_phase(problem, q, t, w);
    for (std::size_t c = 0; c < problem.system.cuts.size(); ++c) {
      const CutJoint& cut = problem.system.cuts[c];
      for (std::size_t r = 0; r < cut.rows.size(); ++r) {
        const auto row = static_cast<Eigen::Index>(cut.first_row) + static_cast<Eigen::Index>(r);
        const double open = std::abs(w.residual.phi[row]) * problem.scaling.row[row];
        if (open <= tolerance || (result.loops_open && open <= result.violation)) continue;
        result = {false, true, t, open, static_cast<int>(c)};
      }
    }
    if (result.loops_open) continue;
    w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
    const Eigen::MatrixXd& basis = w.constraints.basis();
    w.reduced_rhs.noalias() = basis.transpose() * w.scaled_force;
    for (Eigen::Index k = 0; k < basis.cols(); ++k) {
      const double size =
          basis.col(k).cwiseAbs().dot(w.magnitudes.force.cwiseProduct(problem.scaling.column));
      const double left = std::abs(w.reduced_rhs[k]);
      if (left > tolerance * size && left / size > result.violation)
        result = {false, false, t, left / size, -1};
    }
  }
  return result;
}

std::string blame(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& q, double phase,
                  Workspace& w) {
  const System& system = problem.system;
  Parameters only = problem.parameters;
  for (LinkParameters& l : only.links) {
    l.mass = 0;
    l.has_inertia = false;
    l.elastic = false;
  }
  for (PointSpringParameters& s : only.springs)
    s.stiffness = s.damping = 0;
  for (BodyForceParameters& f : only.body_forces) {
    f.vector.setZero();
    f.linear = f.quadratic = 0;
  }
  for (CutDamperParameters& d : only.cut_dampers)
    d.damping = 0;
  const Problem part{system, only, problem.scaling};
  // How much the projected force of what is left in `only` changes from the drawn phase to the bad one.
  const auto change = [&] {
    Eigen::VectorXd f[2];
    for (int i : {0, 1}) {
      evaluate_phase(part, q, i == 0 ? 0. : phase, w);
      f[i] = w.constraints.basis().transpose() * w.residual.f.cwiseProduct(problem.scaling.column);
    }
    return f[0].size() == f[1].size() ? (f[1] - f[0]).norm() : 0.;
  };
  double worst = 0;
  std::string phrase = "the balance";
  const auto consider = [&](const std::string& what) {
    if (const double c = change(); c > worst) {
      worst = c;
      phrase = what;
    }
  };
  const Vec3 gravity = only.gravity;
  for (std::size_t l = 0; l < only.links.size(); ++l) {
    const LinkParameters& real = problem.parameters.links[l];
    if (system.links[l].body < 0 || (real.mass == 0 && !real.has_inertia)) continue;
    const std::string& name = mechanism.bodies[static_cast<std::size_t>(system.links[l].body)].name;
    only.links[l].mass = real.mass;
    only.moving = false;
    consider("the weight of " + name);
    only.moving = problem.parameters.moving;
    only.gravity.setZero();
    only.links[l].has_inertia = real.has_inertia;
    consider("the inertia of " + name);
    only.gravity = gravity;
    only.links[l].mass = 0;
    only.links[l].has_inertia = false;
  }
  for (std::size_t i = 0; i < only.springs.size(); ++i) {
    only.springs[i] = problem.parameters.springs[i];
    consider("the spring " + mechanism.forces[static_cast<std::size_t>(system.springs[i].force)].name);
    only.springs[i].stiffness = only.springs[i].damping = 0;
  }
  for (std::size_t i = 0; i < only.body_forces.size(); ++i) {
    only.body_forces[i] = problem.parameters.body_forces[i];
    const Force& f = mechanism.forces[static_cast<std::size_t>(system.body_forces[i].force)];
    consider("the " + std::string(type_name(f.type)) + " " + f.name);
    only.body_forces[i].vector.setZero();
    only.body_forces[i].linear = only.body_forces[i].quadratic = 0;
  }
  return phrase;
}

} // namespace flyball
