#include "engine/linear/linear_program.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace flyball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double parallel = 1e-12; // to a row, or to all active ones, of the length

struct ActiveRow {
  Index row;
  double sense; // 1 at its upper bound, -1 at its lower one
};

} // namespace

VectorXd largest_within(const VectorXd& g, const MatrixXd& A, const VectorXd& lower, const VectorXd& upper) {
  const Index n = g.size(), m = A.rows() + n;
  MatrixXd rows(m, n);
  rows << MatrixXd::Identity(n, n), A;
  VectorXd low(m), high(m);
  low << VectorXd::Constant(n, -1), lower;
  high << VectorXd::Constant(n, 1), upper;
  VectorXd x = VectorXd::Zero(n);
  std::vector<ActiveRow> active;
  for (Index turn = 0; turn < 10 * (m + 1); ++turn) {
    VectorXd along = g, multipliers;
    if (!active.empty()) {
      MatrixXd held(n, static_cast<Index>(active.size()));
      for (std::size_t a = 0; a < active.size(); ++a)
        held.col(static_cast<Index>(a)) = rows.row(active[a].row).transpose();
      const auto found = least_squares(held, g);
      if (!found) break;
      multipliers = *found;
      along -= held * multipliers;
    }
    if (along.norm() <= parallel * g.norm()) {
      // One that holds x back from nothing is let go.
      std::size_t worst = active.size();
      double most = 0;
      for (std::size_t a = 0; a < active.size(); ++a) {
        const Index row = active[a].row;
        const double pulls = -active[a].sense * multipliers[static_cast<Index>(a)] * rows.row(row).norm();
        if (pulls > most + parallel * g.norm()) {
          most = pulls;
          worst = a;
        }
      }
      if (worst == active.size()) break;
      active.erase(active.begin() + static_cast<std::ptrdiff_t>(worst));
      continue;
    }
    double farthest = std::numeric_limits<double>::infinity();
    ActiveRow next{-1, 0};
    const double length = along.norm();
    for (Index r = 0; r < m; ++r) {
      if (std::ranges::find(active, r, &ActiveRow::row) != active.end()) continue;
      const double rate = rows.row(r).dot(along);
      if (!(std::abs(rate) > parallel * rows.row(r).norm() * length)) continue;
      const double at = rows.row(r).dot(x);
      const double way = std::max(0., (rate > 0 ? high[r] - at : low[r] - at) / rate);
      if (way < farthest) {
        farthest = way;
        next = {r, rate > 0 ? 1. : -1.};
      }
    }
    if (next.row < 0) break;
    x += farthest * along;
    active.push_back(next);
  }
  return x;
}

std::optional<double> least_largest(const MatrixXd& A, const VectorXd& b) {
  constexpr Index most_columns = 60;
  constexpr double balanced = 1e-9;
  const Index n = A.cols();
  if (b.isZero(0)) return 0.;
  if (n > most_columns) return std::nullopt;
  // The most that entries up to 1 give along b and along nothing else.
  const VectorXd along = b.normalized();
  const auto across = orthonormal_completion(along);
  if (!across) return std::nullopt;
  MatrixXd null = MatrixXd::Identity(n, n);
  if (b.size() > 1) {
    const auto found = null_space(across->rightCols(b.size() - 1).transpose() * A);
    if (!found || found->cols() == 0) return std::nullopt;
    null = *found;
  }
  const auto basis = orthonormal_completion(null);
  if (!basis) return std::nullopt;
  const MatrixXd entries = std::sqrt(static_cast<double>(n)) * basis->leftCols(null.cols());
  const VectorXd x = entries * largest_within(entries.transpose() * (A.transpose() * along), entries,
                                              VectorXd::Constant(n, -1), VectorXd::Constant(n, 1));
  const VectorXd given = A * x;
  const double most = along.dot(given);
  if (!(most > 0) || (given - most * along).norm() > balanced * most) return std::nullopt;
  return b.norm() / most;
}

} // namespace flyball
