#include "engine/linear/assignment.hpp"

#include <limits>

namespace flyball {

std::vector<Eigen::Index> assign(const Eigen::MatrixXd& cost) {
  constexpr Eigen::Index none = -1;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Index n = cost.rows(), m = cost.cols();
  Eigen::VectorXd row_price = Eigen::VectorXd::Zero(n), column_price = Eigen::VectorXd::Zero(m + 1);
  // Of each column and of one outside, which stands for the row to be placed.
  Eigen::VectorX<Eigen::Index> row_of = Eigen::VectorX<Eigen::Index>::Constant(m + 1, none),
                               from = Eigen::VectorX<Eigen::Index>::Constant(m + 1, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    row_of[m] = i;
    Eigen::VectorXd least = Eigen::VectorXd::Constant(m, infinity);
    std::vector<bool> used(static_cast<std::size_t>(m) + 1, false);
    Eigen::Index at = m;
    do {
      used[static_cast<std::size_t>(at)] = true;
      const Eigen::Index row = row_of[at];
      double delta = infinity;
      Eigen::Index next = m;
      for (Eigen::Index j = 0; j < m; ++j) {
        if (used[static_cast<std::size_t>(j)]) continue;
        const double reduced = cost(row, j) - row_price[row] - column_price[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          from[j] = at;
        }
        if (least[j] < delta) {
          delta = least[j];
          next = j;
        }
      }
      for (Eigen::Index j = 0; j <= m; ++j) {
        if (used[static_cast<std::size_t>(j)]) {
          row_price[row_of[j]] += delta;
          column_price[j] -= delta;
        } else if (j < m) {
          least[j] -= delta;
        }
      }
      at = next;
    } while (row_of[at] != none);
    for (; at != m; at = from[at])
      row_of[at] = row_of[from[at]];
  }
  std::vector<Eigen::Index> column(static_cast<std::size_t>(n), none);
  for (Eigen::Index j = 0; j < m; ++j)
    if (row_of[j] != none) column[static_cast<std::size_t>(row_of[j])] = j;
  return column;
}

} // namespace flyball
