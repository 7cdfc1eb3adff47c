// A sparse matrix in the hands of MUMPS, which works for one thread at a time.
#pragma once

#include "engine/linear/sparse_pattern.hpp"

#include <dmumps_c.h>
#include <Eigen/Core>

namespace flyball {

class Mumps {
 public:
  static constexpr int analyse = 1, factorise = 2, substitute = 3;
  // Settings by their numbers in the users' guide, counted from 1.
  static constexpr int ordering = 7, scaling = 8, compressed_graph = 12, undivided_root = 13,
                       extra_memory = 14, find_null_pivots = 24, null_space = 25;

  // A pivot may be this small beside its row: waiting for larger ones makes triple the work in nets of
  // cables. What it costs in digits SparseFactorization::solve() gets back.
  static constexpr double least_pivot = 1e-6;

  Mumps() = default;
  ~Mumps() { close(); }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  // The pattern must stay where it is.
  void open(SparsePattern& pattern);
  void close();
  bool is_open() const { return open_; }

  // For a matrix that comes equilibrated, its unknowns ordered in this way (empty: by approximate minimum
  // fill).
  void prepare(std::vector<int>& order);
  // Pivots below this count as none: of the matrix's norm, or where it is negative as it is.
  void set_zero(double zero) { data.cntl[2] = zero; }

  void run(int job);
  // With more memory, should it take more than was foreseen. False where it cannot be had.
  bool run_factorise();
  void run_substitute(double* x, Eigen::Index columns = 1);

  MUMPS_INT& setting(int i) { return data.icntl[i - 1]; }
  bool failed() const { return data.infog[0] < 0; }
  int negative() const { return data.infog[11]; }
  int nullity() const { return data.infog[27]; }

  DMUMPS_STRUC_C data{};

 private:
  bool open_ = false;
};

} // namespace flyball
