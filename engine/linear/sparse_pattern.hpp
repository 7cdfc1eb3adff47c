#pragma once

#include <vector>

namespace flyball {

// Where a sparse matrix [K, J^T; J, -C] has entries: by row and column, counted from 0; repeated ones add up.
// Of a symmetric matrix one triangle.
struct SparsePattern {
  int size = 0;
  int motions = 0; // of K; the unknowns after them are the multipliers of J's rows
  bool symmetric = true;
  std::vector<int> rows, columns;
  void clear(int n, bool is_symmetric) {
    size = motions = n;
    symmetric = is_symmetric;
    rows.clear();
    columns.clear();
  }
  bool operator==(const SparsePattern&) const = default;
};

} // namespace flyball
