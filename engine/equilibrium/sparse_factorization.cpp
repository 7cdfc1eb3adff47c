#include "engine/equilibrium/sparse_factorization.hpp"

#include <dmumps_c.h>

#include <algorithm>
#include <limits>
#include <mutex>

namespace flyball {
namespace {

constexpr int initialise = -1, analyse = 1, factorise = 2, back_substitute = 3, terminate = -2;
constexpr int use_comm_world = -987654; // what MUMPS wants to be told where there is one process

} // namespace

struct SparseFactorization::State {
  DMUMPS_STRUC_C mumps{};
  SparsePattern pattern;
  std::vector<double> given, scaled; // values of the matrix, and of the equilibrated one
  double zero = 0;
  Eigen::VectorXd scale, largest;      // of each row and column
  Eigen::VectorXd wanted, left, terms; // of a solve: right-hand side, what is left of it, sizes of its sums
  Eigen::MatrixXd null_space;
  bool open = false;

  ~State() { close(); }

  // Settings by their numbers in the MUMPS users' guide, counted from 1.
  MUMPS_INT& setting(int i) { return mumps.icntl[i - 1]; }

  // One at a time: MUMPS keeps some of its state in global variables while it runs.
  void run(int job) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    mumps.job = job;
    dmumps_c(&mumps);
  }

  void close() {
    if (open) run(terminate);
    open = false;
  }

  // Rows and columns to largest entries of one, by square roots from both sides (Ruiz, A scaling algorithm to
  // equilibrate both rows and columns norms in matrices, 2001). Afresh, so that no answer depends on those
  // before.
  void equilibrate() {
    constexpr double even = 1.2; // further apart rows need another pass
    const std::size_t count = given.size();
    scale.setOnes(pattern.size);
    scaled.resize(count);
    for (int pass = 0;; ++pass) {
      largest.setZero(pattern.size);
      for (std::size_t e = 0; e < count; ++e) {
        const Eigen::Index i = pattern.rows[e] - 1, j = pattern.columns[e] - 1;
        scaled[e] = given[e] * (scale[i] * scale[j]);
        const double size = std::abs(scaled[e]);
        largest[i] = std::max(largest[i], size);
        largest[j] = std::max(largest[j], size);
      }
      bool done = true;
      for (double& x : largest) {
        x = x > 0 ? 1 / std::sqrt(x) : 1;
        done = done && x < even && x * even > 1;
      }
      if (done || pass == 6) return;
      scale.array() *= largest.array();
    }
  }

  void substitute(Eigen::VectorXd& x) {
    setting(25) = 0;
    mumps.rhs = x.data();
    mumps.nrhs = 1;
    mumps.lrhs = mumps.n;
    run(back_substitute);
  }

  // What x leaves of what is wanted, compared with the terms of each equation (Oettli and Prager, 1964), or
  // with a thousandth of the largest of all.
  double leave(const Eigen::VectorXd& x) {
    left = wanted;
    terms = wanted.cwiseAbs();
    const auto take = [&](Eigen::Index row, double term) {
      left[row] -= term;
      terms[row] += std::abs(term);
    };
    for (std::size_t e = 0; e < scaled.size(); ++e) {
      const Eigen::Index i = pattern.rows[e] - 1, j = pattern.columns[e] - 1;
      take(i, scaled[e] * x[j]);
      if (pattern.symmetric && i != j) take(j, scaled[e] * x[i]);
    }
    const double floor = std::max(1e-3 * terms.maxCoeff(), 1e-300);
    return (left.array().abs() / terms.array().max(floor)).maxCoeff();
  }

  void begin(const SparsePattern& p) {
    close();
    pattern = p;
    mumps = {};
    mumps.par = 1;
    mumps.sym = p.symmetric ? 2 : 0;
    mumps.comm_fortran = use_comm_world;
    run(initialise);
    open = true;
    for (int i : {1, 2, 3})
      setting(i) = -1; // no output
    setting(4) = 0;    // nor messages
    setting(7) = 2;    // ordering: approximate minimum fill; PORD ends the program on some small graphs
    setting(12) = 1;   // on the graph as it is: pairing multipliers with motions by the first values misleads
    setting(8) = 0;    // the matrix comes equilibrated
    setting(13) = 1;   // the root is factored like the rest, for its zero pivots to be found
    setting(14) = 100; // per cent of memory more than estimated, for pivots that have to wait
    setting(24) = 1;   // find zero pivots
    // A pivot may be this small beside its row: waiting for larger ones makes triple the work in nets of
    // cables. What it costs in digits solve() gets back.
    mumps.cntl[0] = 1e-6;
    mumps.n = p.size;
    mumps.nnz = static_cast<MUMPS_INT8>(p.rows.size());
    mumps.irn = pattern.rows.data();
    mumps.jcn = pattern.columns.data();
  }
};

SparseFactorization::SparseFactorization() = default;
SparseFactorization::~SparseFactorization() = default;
SparseFactorization::SparseFactorization(SparseFactorization&&) noexcept = default;
SparseFactorization& SparseFactorization::operator=(SparseFactorization&&) noexcept = default;

bool SparseFactorization::factor(const SparsePattern& pattern, const std::vector<double>& values,
                                 double zero) {
  if (!state_) state_ = std::make_unique<State>();
  State& s = *state_;
  const bool known = s.open && s.pattern == pattern;
  if (known && s.zero == zero && s.given == values) return true;
  if (!known) s.begin(pattern);
  s.given = values;
  s.zero = zero;
  s.equilibrate();
  s.mumps.a = s.scaled.data();
  s.mumps.cntl[2] = zero;
  s.null_space.resize(0, 0);
  if (!known) s.run(analyse);
  for (int tries = 0; s.mumps.infog[0] >= 0 && tries < 4; ++tries) {
    s.run(factorise);
    constexpr int short_of_memory = -9, short_of_integers = -8;
    if (s.mumps.infog[0] != short_of_memory && s.mumps.infog[0] != short_of_integers) break;
    s.setting(14) *= 2;
    s.mumps.infog[0] = 0;
  }
  const bool done = s.mumps.infog[0] >= 0;
  if (!done) s.close();
  return done;
}

void SparseFactorization::solve(Eigen::VectorXd& x) {
  State& s = *state_;
  x.array() *= s.scale.array();
  s.wanted = x;
  s.substitute(x);
  constexpr double enough = 1e-11;
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 4; ++round) {
    const double error = s.leave(x);
    if (!(error > enough) || !(error < 0.5 * before)) break;
    before = error;
    s.substitute(s.left);
    x += s.left;
  }
  x.array() *= s.scale.array();
}

int SparseFactorization::negative() const {
  return state_->mumps.infog[11];
}

int SparseFactorization::nullity() const {
  return state_->mumps.infog[27];
}

const Eigen::MatrixXd& SparseFactorization::null_space() {
  State& s = *state_;
  if (s.null_space.cols() == nullity()) return s.null_space;
  s.null_space.setZero(s.mumps.n, nullity());
  s.setting(25) = -1;
  s.mumps.rhs = s.null_space.data();
  s.mumps.nrhs = nullity();
  s.mumps.lrhs = s.mumps.n;
  s.run(back_substitute);
  s.setting(25) = 0;
  s.null_space = s.scale.asDiagonal() * s.null_space;
  return s.null_space;
}

} // namespace flyball
