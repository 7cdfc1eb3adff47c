#pragma once

#include <vector>

namespace flyball {

// Where a sparse matrix has entries: by row and column, counted from 1; repeated ones add up. Of a symmetric
// matrix one triangle.
struct SparsePattern {
  int size = 0;
  bool symmetric = true;
  std::vector<int> rows, columns;
  void clear(int n, bool is_symmetric) {
    size = n;
    symmetric = is_symmetric;
    rows.clear();
    columns.clear();
  }
  bool operator==(const SparsePattern&) const = default;
};

} // namespace flyball
