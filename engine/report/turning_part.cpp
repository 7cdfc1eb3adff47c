#include "engine/report/turning_part.hpp"

#include "engine/solve/newton.hpp"

#include <cmath>
#include <numeric>

namespace flyball {
namespace {

// How much the force that no multipliers balance changes from the drawn phase to another, scaled; on loops
// closed at each.
double change_of_balance(const Problem& problem, const Eigen::VectorXd& q, double phase, Workspace& w) {
  Eigen::VectorXd f[2];
  for (const int i : {0, 1}) {
    evaluate(problem, {q, Eigen::VectorXd::Zero(problem.system.rows)}, i == 0 ? 0. : phase, w);
    factor_constraints(problem, w);
    w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
    w.kkt(problem).project(w.scaled_force, f[i]);
  }
  return (f[1] - f[0]).norm();
}

// The same mechanism with nothing that could change.
Parameters without_parts(Parameters only) {
  for (LinkParameters& l : only.links) {
    l.mass = 0;
    l.has_inertia = false;
    l.elastic = false;
  }
  for (PointSpringParameters& s : only.springs)
    s.remove();
  for (BearingParameters& b : only.bearings) {
    b.stiffness.setZero();
    b.damping.setZero();
  }
  for (BodyForceParameters& f : only.body_forces) {
    f.vector.setZero();
    f.linear = f.quadratic = f.normal_quadratic = 0;
  }
  for (BodyForceParameters& f : only.turning_air)
    f.linear = f.quadratic = f.normal_quadratic = 0;
  for (CutDamperParameters& d : only.cut_dampers)
    d.remove_damper();
  return only;
}

std::vector<std::size_t> indices(std::size_t count) {
  std::vector<std::size_t> out(count);
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

} // namespace

std::string turning_part(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& q,
                         double phase, Workspace& w) {
  const System& system = problem.system;
  const Parameters bare = without_parts(problem.parameters);
  Parameters only = bare;
  const Problem part{system, only, problem.scaling, problem.cancel, problem.form};
  const auto change = [&] { return change_of_balance(part, q, phase, w); };
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
  std::vector<std::size_t> bodies;
  for (std::size_t l = 0; l < only.links.size(); ++l) {
    const LinkParameters& real = problem.parameters.links[l];
    if (system.links[l].body >= 0 && (real.mass != 0 || real.has_inertia)) bodies.push_back(l);
  }
  const auto body_name = [&](std::size_t l) {
    return mechanism.bodies[static_cast<std::size_t>(system.links[l].body)].name;
  };
  const auto force_of = [&](const auto& element) -> const Force& {
    return mechanism.forces[static_cast<std::size_t>(element.force)];
  };
  const auto from = [&](bool on) -> const Parameters& { return on ? problem.parameters : bare; };
  only.moving = false;
  search(
      bodies, [&](std::size_t l, bool on) { only.links[l].mass = from(on).links[l].mass; },
      [&](std::size_t l) { return "the weight of " + body_name(l); });
  only.moving = problem.parameters.moving;
  only.gravity.setZero();
  search(
      bodies,
      [&](std::size_t l, bool on) {
        only.links[l].mass = from(on).links[l].mass;
        only.links[l].has_inertia = from(on).links[l].has_inertia;
      },
      [&](std::size_t l) { return "the inertia of " + body_name(l); });
  only.gravity = problem.parameters.gravity;
  search(
      indices(only.springs.size()), [&](std::size_t i, bool on) { only.springs[i] = from(on).springs[i]; },
      [&](std::size_t i) { return "the spring " + force_of(system.springs[i]).name; });
  search(
      indices(only.bearings.size()), [&](std::size_t i, bool on) { only.bearings[i] = from(on).bearings[i]; },
      [&](std::size_t i) { return "the bearing " + force_of(system.bearings[i]).name; });
  search(
      indices(only.body_forces.size()),
      [&](std::size_t i, bool on) { only.body_forces[i] = from(on).body_forces[i]; },
      [&](std::size_t i) {
        const Force& f = force_of(system.body_forces[i]);
        return "the " + std::string(type_name(f.type)) + " " + f.name;
      });
  return phrase;
}

bool weight_turns(const Problem& problem, const Eigen::VectorXd& q, double phase, Workspace& w) {
  if (!(problem.parameters.gravity.norm() > 0)) return false;
  Parameters weightless = problem.parameters;
  weightless.gravity.setZero();
  const Problem without{problem.system, weightless, problem.scaling, problem.cancel, problem.form};
  const double whole = change_of_balance(problem, q, phase, w);
  return std::isfinite(whole) && change_of_balance(without, q, phase, w) <= tolerance::constant_push * whole;
}

} // namespace flyball
