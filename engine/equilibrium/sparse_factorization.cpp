#include "engine/equilibrium/sparse_factorization.hpp"

#include <dmumps_c.h>

#include <algorithm>
#include <limits>
#include <mutex>

namespace flyball {
namespace {

constexpr int initialise = -1, analyse = 1, factorise = 2, back_substitute = 3, terminate = -2;
constexpr int use_comm_world = -987654; // what MUMPS wants to be told where there is one process

// One matrix in the hands of MUMPS.
class Mumps {
 public:
  ~Mumps() { close(); }

  void open(SparsePattern& pattern) {
    close();
    data = {};
    data.par = 1;
    data.sym = pattern.symmetric ? 2 : 0;
    data.comm_fortran = use_comm_world;
    run(initialise);
    open_ = true;
    for (int i : {1, 2, 3})
      setting(i) = -1; // no output
    setting(4) = 0;    // nor messages
    setting(7) = 2;    // ordering: approximate minimum fill; PORD ends the program on some small graphs
    setting(12) = 1;   // on the graph as it is: pairing multipliers with motions by the first values misleads
    data.n = pattern.size;
    data.nnz = static_cast<MUMPS_INT8>(pattern.rows.size());
    data.irn = pattern.rows.data();
    data.jcn = pattern.columns.data();
  }

  void close() {
    if (open_) run(terminate);
    open_ = false;
  }

  bool is_open() const { return open_; }

  // Settings by their numbers in the MUMPS users' guide, counted from 1.
  MUMPS_INT& setting(int i) { return data.icntl[i - 1]; }

  // One at a time: MUMPS keeps some of its state in global variables while it runs.
  void run(int job) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    data.job = job;
    dmumps_c(&data);
  }

  DMUMPS_STRUC_C data{};

 private:
  bool open_ = false;
};

// Minimum fill would begin with the multipliers, which meet few. But these have nothing on the diagonal, are
// no pivots until something that they meet has been one, and to wait costs much. So they are left out of the
// graph, where what they tie meets instead, and each follows the first that it meets: a body, as a rule,
// whose motions come one after the other. By unknown its place in the order, from 1; empty where there are
// none.
std::vector<int> order_multipliers_behind(const SparsePattern& pattern) {
  const auto count = static_cast<std::size_t>(pattern.size), entries = pattern.rows.size();
  const auto row = [&](std::size_t e) { return static_cast<std::size_t>(pattern.rows[e] - 1); };
  const auto column = [&](std::size_t e) { return static_cast<std::size_t>(pattern.columns[e] - 1); };
  std::vector<bool> held(count, false); // has something on the diagonal
  for (std::size_t e = 0; e < entries; ++e)
    if (row(e) == column(e)) held[row(e)] = true;
  std::vector<int> number(count, 0);
  SparsePattern graph;
  for (std::size_t u = 0; u < count; ++u)
    if (held[u]) number[u] = ++graph.size;
  if (graph.size == 0 || graph.size == pattern.size) return {};

  std::vector<std::vector<int>> met(count); // by multiplier
  for (std::size_t e = 0; e < entries; ++e) {
    const std::size_t i = row(e), j = column(e);
    if (held[i] && held[j]) {
      graph.rows.push_back(number[i]);
      graph.columns.push_back(number[j]);
    } else if (held[i] != held[j]) {
      met[held[i] ? j : i].push_back(number[held[i] ? i : j]);
    }
  }
  for (const std::vector<int>& all : met)
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        graph.rows.push_back(all[a]);
        graph.columns.push_back(all[b]);
      }
  Mumps order;
  order.open(graph);
  order.run(analyse);
  if (order.data.infog[0] < 0) return {};

  // Multipliers by the place that they follow.
  const auto place = [&](int n) { return order.data.sym_perm[n - 1]; };
  std::vector<std::vector<int>> next(static_cast<std::size_t>(graph.size) + 1);
  for (std::size_t u = 0; u < count; ++u) {
    if (held[u]) continue;
    std::vector<int>& all = met[u];
    std::ranges::sort(all, {}, place);
    int last = all.empty() ? graph.size : place(all[0]);
    for (int n : all)
      if (place(n) == last + 1) ++last;
    next[static_cast<std::size_t>(last)].push_back(static_cast<int>(u));
  }
  std::vector<std::size_t> unknown(static_cast<std::size_t>(graph.size) + 1);
  for (std::size_t u = 0; u < count; ++u)
    if (held[u]) unknown[static_cast<std::size_t>(place(number[u]))] = u;
  std::vector<int> out(count);
  int at = 0;
  for (std::size_t p = 1; p < unknown.size(); ++p) {
    out[unknown[p]] = ++at;
    for (int u : next[p])
      out[static_cast<std::size_t>(u)] = ++at;
  }
  return out;
}

} // namespace

struct SparseFactorization::State {
  Mumps mumps;
  SparsePattern pattern;
  std::vector<int> order;
  std::vector<double> given, scaled; // values of the matrix, and of the equilibrated one
  double zero = 0;
  Eigen::VectorXd scale, largest;      // of each row and column
  Eigen::VectorXd wanted, left, terms; // of a solve: right-hand side, what is left of it, sizes of its sums
  Eigen::MatrixXd null_space;

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
    mumps.setting(25) = 0;
    mumps.data.rhs = x.data();
    mumps.data.nrhs = 1;
    mumps.data.lrhs = mumps.data.n;
    mumps.run(back_substitute);
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
    pattern = p;
    order = p.symmetric ? order_multipliers_behind(p) : std::vector<int>{};
    mumps.open(pattern);
    if (!order.empty()) {
      mumps.setting(7) = 1;
      mumps.data.perm_in = order.data();
    }
    mumps.setting(8) = 0;    // the matrix comes equilibrated
    mumps.setting(13) = 1;   // the root is factored like the rest, for its zero pivots to be found
    mumps.setting(14) = 100; // per cent of memory more than estimated, for pivots that have to wait
    mumps.setting(24) = 1;   // find zero pivots
    // A pivot may be this small beside its row: waiting for larger ones makes triple the work in nets of
    // cables. What it costs in digits solve() gets back.
    mumps.data.cntl[0] = 1e-6;
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
  const bool known = s.mumps.is_open() && s.pattern == pattern;
  if (known && s.zero == zero && s.given == values) return true;
  if (!known) s.begin(pattern);
  s.given = values;
  s.zero = zero;
  s.equilibrate();
  s.mumps.data.a = s.scaled.data();
  s.mumps.data.cntl[2] = zero;
  s.null_space.resize(0, 0);
  if (!known) s.mumps.run(analyse);
  for (int tries = 0; s.mumps.data.infog[0] >= 0 && tries < 4; ++tries) {
    s.mumps.run(factorise);
    constexpr int short_of_memory = -9, short_of_integers = -8;
    if (s.mumps.data.infog[0] != short_of_memory && s.mumps.data.infog[0] != short_of_integers) break;
    s.mumps.setting(14) *= 2;
    s.mumps.data.infog[0] = 0;
  }
  const bool done = s.mumps.data.infog[0] >= 0;
  if (!done) s.mumps.close();
  return done;
}

void SparseFactorization::solve(Eigen::VectorXd& x, double enough) {
  State& s = *state_;
  x.array() *= s.scale.array();
  s.wanted = x;
  s.substitute(x);
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
  return state_->mumps.data.infog[11];
}

int SparseFactorization::nullity() const {
  return state_->mumps.data.infog[27];
}

const Eigen::MatrixXd& SparseFactorization::null_space() {
  State& s = *state_;
  if (s.null_space.cols() == nullity()) return s.null_space;
  s.null_space.setZero(s.mumps.data.n, nullity());
  s.mumps.setting(25) = -1;
  s.mumps.data.rhs = s.null_space.data();
  s.mumps.data.nrhs = nullity();
  s.mumps.data.lrhs = s.mumps.data.n;
  s.mumps.run(back_substitute);
  s.mumps.setting(25) = 0;
  s.null_space = s.scale.asDiagonal() * s.null_space;
  return s.null_space;
}

} // namespace flyball
