#include "engine/stability/neutral_directions.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/play.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Whether a step (scaled) along null directions leads to another balanced state, the rest giving way as it
// must: a bob that turns about the vertical goes along an arc.
bool stays_balanced(const FactoredState& at, const Eigen::MatrixXd& null_space,
                    const Eigen::VectorXd& first) {
  const Problem& problem = at.problem;
  Workspace& w = at.w.elsewhere();
  Unknowns moved = at.z;
  Eigen::VectorXd step = first;
  for (int i = 0; i < 8; ++i) {
    w.step = step.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, w.step, moved.q);
    if (!assemble(problem, moved.q, 0, w)) return false;
    evaluate_with_multipliers(problem, moved, w);
    factor(problem, moved, w); // without loops the basis is made by this alone
    const Eigen::MatrixXd& basis = w.dense.constraints().basis();
    const Eigen::VectorXd left = basis.transpose() * w.residual.f.cwiseProduct(problem.scaling.column);
    const double force = largest(w.magnitudes.force.cwiseProduct(problem.scaling.column));
    if (left.size() == 0 || left.lpNorm<Eigen::Infinity>() <= tolerance::neutral_force * force) return true;
    const auto all = orthonormal_completion(basis.transpose() * null_space);
    if (!all || all->cols() <= null_space.cols()) return false;
    const auto rest = all->rightCols(all->cols() - null_space.cols());
    const auto solved = least_squares(large::projected(w.dense.stiffness(), basis) * rest, -left);
    if (!solved) return false;
    step = basis * (rest * *solved);
    if (!(step.lpNorm<Eigen::Infinity>() <= first.lpNorm<Eigen::Infinity>())) return false;
  }
  return false;
}

} // namespace

Eigen::MatrixXd without_drift(const FactoredState& at, const PhaseStiffness& angles,
                              const Eigen::MatrixXd& null_space) {
  const Problem& problem = at.problem;
  const System& system = problem.system;
  const Eigen::MatrixXd& constraint = at.w.dense.linearization.constraint;
  const Eigen::Index n = system.nv;
  Eigen::MatrixXd ties = Eigen::MatrixXd::Zero(n + system.rows, n); // of forces and loops, by angles
  for (std::size_t i = 0; i < angles.entries.size(); ++i)
    ties.col(angles.entries[i]).head(n) =
        angles.columns.col(static_cast<Eigen::Index>(i)).cwiseProduct(problem.scaling.column);
  if (const double size = largest_size(ties); size > 0) ties /= size;
  if (system.rows > 0)
    ties.bottomRows(system.rows) =
        problem.scaling.row.asDiagonal() *
        (constraints_of_motion(system, problem.parameters, at.w.kinematics, constraint) - constraint);
  const auto parts = singular_vectors(ties * problem.scaling.column.asDiagonal() * null_space);
  if (!parts) return null_space;
  constexpr double drifts = 1e-9; // of the largest effect of an angle
  const double least = drifts * largest_size(ties) * largest(problem.scaling.column);
  Eigen::Index rank = 0;
  while (rank < parts->values.size() && parts->values[rank] > least)
    ++rank;
  return null_space * parts->right.rightCols(null_space.cols() - rank);
}

NeutralDirections neutral_directions(const FactoredState& at, const Eigen::MatrixXd& null_space) {
  const Problem& problem = at.problem;
  NeutralDirections out;
  out.directions.resize(problem.system.nv, null_space.cols());
  const auto stays_along = [&](const Eigen::VectorXd& direction) {
    const auto step = [&](double size) { return step_within_play(problem, at.z.q, size * direction); };
    return stays_balanced(at, null_space, step(0.05)) && stays_balanced(at, null_space, step(-0.11));
  };
  // What holds for a mixture of many holds for each.
  const bool all = null_space.cols() > few_null_directions && stays_along(mixture_of(null_space));
  for (Eigen::Index c = 0; c < null_space.cols(); ++c) {
    Eigen::VectorXd direction = null_space.col(c);
    const double size = direction.lpNorm<Eigen::Infinity>();
    if (!(size > 0)) continue;
    direction /= size;
    if (!all && !stays_along(direction)) continue;
    ++out.count;
    out.directions.col(out.count - 1) = direction;
    for (int i = 0; i < problem.system.nv; ++i)
      if (std::abs(direction[i]) > tolerance::takes_part &&
          std::ranges::find(out.coordinates, i) == out.coordinates.end())
        out.coordinates.push_back(i);
  }
  out.directions.conservativeResize(Eigen::NoChange, out.count);
  std::ranges::sort(out.coordinates);
  return out;
}

} // namespace flyball
