#include "engine/solve/existence.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace flyball {
namespace {

constexpr double tolerance = 1e-8;

// Evaluates the balance without multipliers at a phase and factors the constraints there.
void evaluate_phase(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  w.zero_lambda.setZero(problem.system.rows);
  Unknowns z{q, w.zero_lambda};
  evaluate(problem, z, t, w);
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
        result.left = std::max(result.left, open);
        if (open <= tolerance || (result.loops_open && open <= result.violation)) continue;
        result = {false, true, t, open, static_cast<int>(c), result.left};
      }
    }
    if (result.loops_open) continue;
    w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
    const auto judge = [&](double left, double size) {
      if (left > 0) result.left = std::max(result.left, left / size);
      if (left > tolerance * size && left / size > result.violation)
        result = {false, false, t, left / size, -1, result.left};
    };
    if (problem.system.rows > 0) { // with the multipliers that do best
      Unknowns z{q, {}};
      best_multipliers(problem, w, z.lambda);
      evaluate(problem, z, t, w);
      w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
    }
    for (Eigen::Index k = 0; k < w.scaled_force.size(); ++k)
      judge(std::abs(w.scaled_force[k]), w.magnitudes.force[k] * problem.scaling.column[k]);
  }
  return result;
}

Eigen::VectorXd phase_variation(const Problem& problem, const Unknowns& z, const std::vector<double>& phases,
                                Workspace& w) {
  Eigen::VectorXd most = Eigen::VectorXd::Zero(problem.system.nv);
  Unknowns there{z.q, {}};
  for (double t : phases) {
    evaluate_phase(problem, z.q, t, w);
    best_multipliers(problem, w, there.lambda);
    evaluate(problem, there, t, w);
    factor(problem, there, w);
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, w.trial.lambda);
    most = most.cwiseMax(w.scaled_step.cwiseProduct(problem.scaling.column).cwiseAbs());
  }
  evaluate(problem, z, 0, w);
  factor(problem, z, w);
  return 2 * most;
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
  const Problem part{system, only, problem.scaling, problem.cancel, problem.form};
  // How much the projected force of what is left in `only` changes from the drawn phase to the bad one.
  const auto change = [&] {
    Eigen::VectorXd f[2];
    for (int i : {0, 1}) {
      evaluate_phase(part, q, i == 0 ? 0. : phase, w);
      w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
      w.kkt(part).project(w.scaled_force, f[i]);
    }
    return (f[1] - f[0]).norm();
  };
  double worst = 0;
  std::string phrase = "the balance";
  // The part whose force changes most: by trying each, or where there are many the half that changes more,
  // again and again.
  const auto search = [&](const std::vector<std::size_t>& parts, const auto& set, const auto& name) {
    const auto change_of = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        set(parts[i], true);
      const double c = change();
      for (std::size_t i = begin; i < end; ++i)
        set(parts[i], false);
      return c;
    };
    const auto consider = [&](std::size_t i) {
      if (const double c = change_of(i, i + 1); c > worst) {
        worst = c;
        phrase = name(parts[i]);
      }
    };
    std::size_t begin = 0, end = parts.size();
    while (end - begin > 100) {
      const std::size_t middle = (begin + end) / 2;
      (change_of(begin, middle) >= change_of(middle, end) ? end : begin) = middle;
    }
    for (std::size_t i = begin; i < end; ++i)
      consider(i);
  };
  std::vector<std::size_t> bodies, springs(only.springs.size()), forces(only.body_forces.size());
  for (std::size_t l = 0; l < only.links.size(); ++l) {
    const LinkParameters& real = problem.parameters.links[l];
    if (system.links[l].body >= 0 && (real.mass != 0 || real.has_inertia)) bodies.push_back(l);
  }
  std::iota(springs.begin(), springs.end(), std::size_t{0});
  std::iota(forces.begin(), forces.end(), std::size_t{0});
  const auto body_name = [&](std::size_t l) {
    return mechanism.bodies[static_cast<std::size_t>(system.links[l].body)].name;
  };
  only.moving = false;
  search(
      bodies, [&](std::size_t l, bool on) { only.links[l].mass = on ? problem.parameters.links[l].mass : 0; },
      [&](std::size_t l) { return "the weight of " + body_name(l); });
  only.moving = problem.parameters.moving;
  const Vec3 gravity = only.gravity;
  only.gravity.setZero();
  search(
      bodies,
      [&](std::size_t l, bool on) {
        only.links[l].mass = on ? problem.parameters.links[l].mass : 0;
        only.links[l].has_inertia = on && problem.parameters.links[l].has_inertia;
      },
      [&](std::size_t l) { return "the inertia of " + body_name(l); });
  only.gravity = gravity;
  search(
      springs,
      [&](std::size_t i, bool on) {
        only.springs[i] = problem.parameters.springs[i];
        if (!on) only.springs[i].stiffness = only.springs[i].damping = 0;
      },
      [&](std::size_t i) {
        return "the spring " + mechanism.forces[static_cast<std::size_t>(system.springs[i].force)].name;
      });
  search(
      forces,
      [&](std::size_t i, bool on) {
        only.body_forces[i] = problem.parameters.body_forces[i];
        if (on) return;
        only.body_forces[i].vector.setZero();
        only.body_forces[i].linear = only.body_forces[i].quadratic = 0;
      },
      [&](std::size_t i) {
        const Force& f = mechanism.forces[static_cast<std::size_t>(system.body_forces[i].force)];
        return "the " + std::string(type_name(f.type)) + " " + f.name;
      });
  return phrase;
}

} // namespace flyball
