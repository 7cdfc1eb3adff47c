#include "engine/equilibrium/sparse_factorization.hpp"

#include <dmumps_c.h>

#include <algorithm>

namespace flyball {
namespace {

constexpr int initialise = -1, analyse = 1, factorise = 2, back_substitute = 3, terminate = -2;
constexpr int use_comm_world = -987654; // what MUMPS wants to be told where there is one process

} // namespace

struct SparseFactorization::State {
  DMUMPS_STRUC_C mumps{};
  SparsePattern pattern;
  Eigen::MatrixXd null_space;
  bool open = false;

  ~State() { close(); }

  // Settings by their numbers in the MUMPS users' guide, counted from 1.
  MUMPS_INT& setting(int i) { return mumps.icntl[i - 1]; }

  void run(int job) {
    mumps.job = job;
    dmumps_c(&mumps);
  }

  void close() {
    if (open) run(terminate);
    open = false;
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
      setting(i) = -1;   // no output
    setting(4) = 0;      // nor messages
    setting(7) = 0;      // ordering: approximate minimum degree
    setting(13) = 1;     // the root is factored like the rest, for its zero pivots to be found
    setting(14) = 50;    // per cent of memory more than estimated, for pivots that have to wait
    setting(24) = 1;     // find zero pivots
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

bool SparseFactorization::factor(const SparsePattern& pattern, std::vector<double>& values, double zero) {
  if (!state_) state_ = std::make_unique<State>();
  State& s = *state_;
  const bool known = s.open && s.pattern == pattern;
  if (!known) s.begin(pattern);
  s.mumps.a = values.data();
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
  s.setting(25) = 0;
  s.mumps.rhs = x.data();
  s.mumps.nrhs = 1;
  s.mumps.lrhs = s.mumps.n;
  s.run(back_substitute);
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
  return s.null_space;
}

} // namespace flyball
