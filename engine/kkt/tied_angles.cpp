#include "engine/kkt/tied_angles.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/system/constraint_row.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

constexpr double ties = 1e-9; // of a radian, or the reach

// Calls act(row, v, gradient) for the speeds that are found in loops that are not tied by rates.
template <class Act>
void for_angles(const System& system, const Parameters& p, const Kinematics<double>& k, const Act& act) {
  if (system.torques.empty()) return;
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    if (cut.by_rates || cut.type == JointType::gear ||
        std::ranges::none_of(cut.ends.support, [&](const SupportColumn& column) {
          return finds_speed(system.links[static_cast<std::size_t>(column.link)]);
        }))
      continue;
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      row_gradient(cut, p.cuts[c], cut.rows[r], k, [&](int v, double g) {
        for (const SupportColumn& column : cut.ends.support)
          if (column.v == v && finds_speed(system.links[static_cast<std::size_t>(column.link)]))
            return act(cut.first_row + static_cast<int>(r), v, g);
      });
  }
}

} // namespace

bool loops_tie_angles(const Problem& problem, const Kinematics<double>& k) {
  bool any = false;
  for_angles(problem.system, problem.parameters, k,
             [&](int row, int, double g) { any = any || std::abs(g) * problem.scaling.row[row] > ties; });
  return any;
}

Eigen::MatrixXd constraints_of_motion(const System& system, const Parameters& p, const Kinematics<double>& k,
                                      const Eigen::MatrixXd& of_balance) {
  Eigen::MatrixXd out = of_balance;
  for_angles(system, p, k, [&](int row, int v, double g) { out(row, v) += g; });
  return out;
}

bool balance_with_tied_angles(const Problem& problem, const Kinematics<double>& k,
                              const Eigen::VectorXd& scaled_force, Eigen::VectorXd& scaled_lambda) {
  if (problem.form != KktForm::dense || !loops_tie_angles(problem, k)) return false;
  Linearization l;
  linearize_constraints(problem.system, problem.parameters, k, l);
  const Eigen::MatrixXd all =
      problem.scaling.column.asDiagonal() *
      constraints_of_motion(problem.system, problem.parameters, k, l.constraint).transpose() *
      problem.scaling.row.asDiagonal();
  const auto found = least_squares(all, scaled_force);
  if (!found) return false;
  scaled_lambda = *found;
  return true;
}

} // namespace flyball
