#include "engine/stability/phase_stiffness.hpp"

#include "engine/linear/central_difference.hpp"
#include "engine/linear/largest.hpp"
#include "engine/stability/linear_motion.hpp"

namespace flyball {
namespace {

constexpr double far[] = {0.9, -1.7};   // rad or reaches: of no particular mechanism
constexpr double matters = 1e-11;       // of the largest force
constexpr double slope_rounding = 1e-9; // the same, of slopes as loops let the angles turn

// Whether the slopes matter as the loops let the angles turn: one that they hold by others moves nothing
// alone.
bool matter_with_loops(const Problem& problem, const Unknowns& z, const PhaseStiffness& angles, double size,
                       Workspace& w) {
  if (problem.system.rows == 0) return true;
  evaluate(problem, z, 0, w);
  factor_constraints(problem, w);
  const Eigen::MatrixXd basis = problem.scaling.column.asDiagonal() * w.dense.constraints().basis();
  if (basis.cols() == 0) return false;
  const Eigen::MatrixXd stiffness = basis.transpose() * angles.columns * basis(angles.entries, Eigen::all);
  return stiffness.cwiseAbs().maxCoeff() > slope_rounding * size;
}

} // namespace

PhaseStiffness phase_stiffness(const Problem& of, const Unknowns& z, Workspace& w) {
  const System& system = of.system;
  PhaseStiffness out;
  if (system.torques.empty() || of.parameters.phase_free) return out;
  // Angles are compared, so that forces count by these, whatever the unit of time.
  const Scaling scaling = motion_scaling(of);
  const Problem problem{system, of.parameters, scaling, of.cancel};
  Parameters moved = problem.parameters;
  const Eigen::VectorXd& scale = problem.scaling.column;
  const auto force_at = [&](std::size_t link, double by) {
    moved.links[link].start = problem.parameters.links[link].start + by;
    forward<double>(system, moved, z.q, 0, w.kinematics);
    evaluate_residual<double>(system, moved, z.q, z.lambda, w.kinematics, w.residual);
    moved.links[link].start = problem.parameters.links[link].start;
    Eigen::VectorXd f = w.residual.f;
    for (Eigen::Index i = 0; i < w.residual.taken.size(); ++i) // where momentum is kept the row is of that
      if (const DriveTorqueElement& torque = system.torques[static_cast<std::size_t>(i)];
          torque.keeps_momentum)
        f[system.links[static_cast<std::size_t>(torque.link)].v] = w.residual.taken[i];
    return f;
  };
  const Eigen::VectorXd drawn = force_at(0, 0);
  evaluate_magnitudes(system, problem.parameters, z.q, z.lambda, w.kinematics, w.magnitudes);
  Eigen::VectorXd terms = w.magnitudes.force;
  for (Eigen::Index i = 0; i < w.magnitudes.taken.size(); ++i)
    if (const DriveTorqueElement& torque = system.torques[static_cast<std::size_t>(i)]; torque.keeps_momentum)
      terms[system.links[static_cast<std::size_t>(torque.link)].v] = w.magnitudes.taken[i];
  const double size = largest(terms.cwiseProduct(scale));
  for (const DriveTorqueElement& torque : system.torques) {
    const auto l = static_cast<std::size_t>(torque.link);
    const Link& link = system.links[l];
    if (!finds_speed(link)) continue;
    const double unit = link.type == LinkType::revolute ? 1 : problem.parameters.length;
    const auto changes = [&](double by) {
      return largest_size((force_at(l, by * unit) - drawn).cwiseProduct(scale)) > matters * size;
    };
    if (!changes(far[0]) && !changes(far[1])) continue;
    out.entries.push_back(link.v);
    out.columns.conservativeResize(system.nv, out.columns.cols() + 1);
    out.columns.rightCols<1>() = central_difference([&](double by) { return force_at(l, by); }, unit);
  }
  if (!out.entries.empty() && !matter_with_loops(problem, z, out, size, w)) return {};
  return out;
}

bool balanced_along(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& turned, Workspace& w,
                    const Eigen::MatrixXd* free) {
  const System& system = problem.system;
  Parameters moved = problem.parameters;
  const Problem there{system, moved, problem.scaling, problem.cancel};
  for (const double by : far) {
    for (std::size_t l = 0; l < system.links.size(); ++l)
      if (const Link& link = system.links[l]; finds_speed(link))
        moved.links[l].start = problem.parameters.links[l].start + by * turned[link.v];
    Unknowns at{z.q, Eigen::VectorXd::Zero(system.rows)};
    evaluate(there, at, 0, w);
    if (system.rows > 0 && !free) {
      factor_constraints(there, w);
      best_multipliers(there, w, at.lambda);
      evaluate(there, at, 0, w);
    }
    const Eigen::VectorXd left = free ? (free->transpose() * w.residual.f).eval()
                                      : w.residual.f.cwiseProduct(problem.scaling.column).eval(),
                          terms = w.magnitudes.force.cwiseProduct(problem.scaling.column);
    if (!(largest_size(left) <= tolerance::phase_balance * largest(terms))) return false;
  }
  return true;
}

} // namespace flyball
