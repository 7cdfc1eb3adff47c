// Where the entries of a matrix of coordinates go: a dense matrix, or a sparse one that has a place for each.
#pragma once

#include <Eigen/SparseCore>

#include <algorithm>

namespace flyball {

class Entries {
 public:
  explicit Entries(Eigen::MatrixXd& m) : dense_(&m) {}
  // `m` is compressed and its pattern holds every entry that will be asked for.
  explicit Entries(Eigen::SparseMatrix<double>& m) : sparse_(&m) {}

  double& operator()(Eigen::Index row, Eigen::Index column) const {
    if (dense_) return (*dense_)(row, column);
    const int* inner = sparse_->innerIndexPtr();
    const int *begin = inner + sparse_->outerIndexPtr()[column],
              *end = inner + sparse_->outerIndexPtr()[column + 1];
    return sparse_->valuePtr()[std::lower_bound(begin, end, static_cast<int>(row)) - inner];
  }

 private:
  Eigen::MatrixXd* dense_ = nullptr;
  Eigen::SparseMatrix<double>* sparse_ = nullptr;
};

} // namespace flyball
