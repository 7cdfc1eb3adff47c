#include "tests/bench/peers/flyball_side.hpp"

#include "engine/report/analysis.hpp"
#include "engine/report/messages.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/refine.hpp"

#include <cmath>
#include <stdexcept>

namespace flyball::peers {
namespace {

// N m s/rad, of every hinge of a chain of 1 m and 1 kg: a linear model of it says that implicit Euler steps,
// as long as they stay stable, settle it soonest at this.
constexpr double chain_damping = 0.38;

Vec plain(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// What a user's program repeats: compiled once, solved again and again.
struct Solve {
  System system;
  Parameters parameters;
  Scaling scaling;
  Workspace workspace;
  Found found;
  std::vector<double> history;
  Eigen::VectorXd drawn;
  ErrorEstimate error;

  explicit Solve(const Mechanism& mechanism) : system(compile(mechanism)) {
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, drawn);
  }
  Problem problem() const { return {system, parameters, scaling, nullptr, system.kkt_form}; }
  void cold() {
    find_equilibrium(problem(), drawn, false, false, workspace, history, found);
    if (found.status == Status::converged) refine(problem(), found.z, found.newton, workspace, error);
  }
};

} // namespace

Job make_job(const std::string& name, const Mechanism& mechanism) {
  const Solution solution = Analysis(mechanism).solve();
  if (solution.status != Status::converged) throw std::invalid_argument(name + ": " + solution.message);
  Job job;
  job.name = name;
  job.chain = mechanism.joints.size() > 10;
  job.gravity = plain(mechanism.gravity);
  for (const Body& b : mechanism.bodies)
    job.bodies.push_back({b.name, b.mass, plain(b.position), b.inertia});
  for (const Joint& j : mechanism.joints) {
    const auto index = [&](int end) {
      return body_index(mechanism, j.bodies[static_cast<std::size_t>(end)]);
    };
    if (j.type == JointType::distance) {
      job.links.push_back({index(0), index(1), plain(j.points[0]), plain(j.points[1]),
                           j.length.value_or(drawn_distance(j.points))});
      continue;
    }
    if (j.type != JointType::revolute && j.type != JointType::prismatic)
      throw std::invalid_argument(name + ": the peers are given hinges and sliders only");
    const Coordinate& c = j.coordinates[0];
    JobJoint joint;
    joint.name = j.name;
    joint.parent = index(0);
    joint.child = index(1);
    joint.slides = j.type == JointType::prismatic;
    joint.at = plain(j.at);
    joint.axis = plain(j.axis.normalized());
    joint.drawn = c.drawn;
    if (c.spring) {
      joint.stiffness = c.spring->stiffness;
      joint.free = c.spring->free;
    }
    joint.damping = job.chain ? chain_damping : c.damping;
    joint.driven = c.drive.has_value();
    joint.speed = joint.driven ? c.drive->speed : 0;
    // The governor's arms are alike and share a damper.
    const bool second = j.name.back() == '2' && !job.joints.empty() && job.joints.back().name == "arm1";
    joint.damper = joint.driven ? 0 : second ? job.joints.back().damper : job.dampers++;
    for (const CoordinateSolution& s : solution.coordinates)
      if (s.joint == j.name) joint.target = s.value;
    job.joints.push_back(joint);
  }
  return job;
}

FlyballResult measure_flyball(const Mechanism& mechanism, bool cold_too) {
  FlyballResult result;
  Solve solve(mechanism);
  solve.cold();
  if (solve.found.status != Status::converged)
    throw std::invalid_argument(message(solve.found, solve.problem()));
  result.iterations = solve.found.iterations;
  result.error = solve.error.solution.size() > 0 ? solve.error.solution.maxCoeff() : 0;
  const Unknowns answer = solve.found.z;
  const Problem problem = solve.problem();
  Workspace& w = solve.workspace;

  // The guess: as far beside the answer as four iterations mend.
  Unknowns z = answer;
  double off = 1;
  NewtonOutcome outcome;
  NewtonSettings settings;
  settings.max_iterations = 5;
  const auto from_beside = [&] {
    z = answer;
    w.step.resize(solve.system.nv);
    for (Eigen::Index k = 0; k < w.step.size(); ++k)
      w.step[k] = off * (k % 2 == 0 ? 1 : -0.5) * solve.scaling.column[k];
    retract<double>(solve.system, w.step, z.q);
    solve.history.clear();
    outcome = newton(problem, z, w, settings, &solve.history);
  };
  for (; off > 1e-12; off *= 0.6) {
    from_beside();
    if (outcome.converged && outcome.iterations <= 4 && (z.q - answer.q).cwiseAbs().maxCoeff() < 1e-9) break;
  }
  if (!outcome.converged || outcome.iterations > 4) throw std::invalid_argument("no guess is good enough");
  result.warm = time_of(from_beside);
  result.warm_iterations = outcome.iterations;
  result.warm_error = (z.q - answer.q).cwiseAbs().maxCoeff();
  result.iteration = time_of([&] {
    z = answer;
    evaluate(problem, z, 0, w);
    factor(problem, z, w);
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, z.lambda);
  });
  result.residual = time_of([&] {
    forward<double>(solve.system, solve.parameters, answer.q, 0, w.kinematics);
    evaluate_residual<double>(solve.system, solve.parameters, answer.q, answer.lambda, w.kinematics,
                              w.residual);
  });
  if (cold_too) result.cold = time_of([&] { solve.cold(); });
  return result;
}

} // namespace flyball::peers
