// The assignment of rows to columns of least total cost.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace flyball {

// The column given to each row, each to one row at most: by shortest augmenting paths (Jonker and Volgenant,
// A shortest augmenting path algorithm for dense and sparse linear assignment problems, 1987). `cost` is
// finite and has no more rows than columns.
std::vector<Eigen::Index> assign(const Eigen::MatrixXd& cost);

} // namespace flyball
