#include "engine/solve/tied_motions.hpp"

#include "engine/linear/spectral.hpp"

namespace flyball {
namespace {

constexpr double tied = 1e-9; // scaled: what is left of a motion that follows from others, or is none

} // namespace

TiedMotions find_tied_motions(const Problem& problem, const Eigen::VectorXd& q, std::span<const int> entries,
                              Workspace& w) {
  const auto count = static_cast<Eigen::Index>(entries.size());
  TiedMotions out;
  if (problem.system.rows == 0) {
    for (std::size_t i = 0; i < entries.size(); ++i)
      out.independent.push_back(i);
    out.follow.resize(0, count);
    return out;
  }
  const Problem by_matrices{problem.system, problem.parameters, problem.scaling, problem.cancel};
  evaluate(by_matrices, {q, Eigen::VectorXd::Zero(problem.system.rows)}, 0, w);
  factor_constraints(by_matrices, w);
  const Eigen::MatrixXd& basis = w.dense.constraints().basis();
  Eigen::MatrixXd chosen(basis.cols(), 0); // columns
  std::vector<Eigen::VectorXd> follows;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd motion = basis.row(entries[static_cast<std::size_t>(i)]).transpose();
    const auto by = chosen.cols() > 0 ? least_squares(chosen, motion) : std::nullopt;
    const Eigen::VectorXd left = by ? (motion - chosen * *by).eval() : motion;
    if (left.norm() > tied) {
      chosen.conservativeResize(Eigen::NoChange, chosen.cols() + 1);
      chosen.rightCols<1>() = motion;
      out.independent.push_back(static_cast<std::size_t>(i));
    } else {
      out.others.push_back(static_cast<std::size_t>(i));
      follows.push_back(by.value_or(Eigen::VectorXd()));
    }
  }
  out.follow = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(follows.size()), chosen.cols());
  const auto unit = [&](std::size_t i) { return problem.scaling.column[entries[i]]; };
  for (std::size_t i = 0; i < follows.size(); ++i)
    for (Eigen::Index k = 0; k < follows[i].size(); ++k)
      out.follow(static_cast<Eigen::Index>(i), k) =
          follows[i][k] * unit(out.others[i]) / unit(out.independent[static_cast<std::size_t>(k)]);
  return out;
}

} // namespace flyball
