// Sparse matrices factored, against dense ones.
#include "tests/catch.hpp"

#include "engine/linear/elimination_order.hpp"
#include "engine/linear/sparse_factorization.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <numbers>
#include <numeric>
#include <random>
#include <thread>

using namespace flyball;

namespace {

// A saddle point [K J^T; J 0] of a chain of blocks, with entries of K down to `least`.
struct SaddlePoint {
  SparsePattern pattern;
  std::vector<double> values;
  Eigen::MatrixXd dense;
};

SaddlePoint saddle_point(int blocks, double least, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1), digits(std::log10(least), 0);
  SaddlePoint out;
  const int motions = 3 * blocks, rows = blocks;
  out.pattern.clear(motions + rows, true);
  out.pattern.motions = motions;
  out.dense.setZero(motions + rows, motions + rows);
  const auto add = [&](int i, int j, double value) { // the lower triangle
    out.pattern.rows.push_back(i);
    out.pattern.columns.push_back(j);
    out.values.push_back(value);
    out.dense(i, j) = out.dense(j, i) = value;
  };
  for (int b = 0; b < blocks; ++b) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        add(3 * b + i, 3 * b + j, any(random) * std::pow(10, digits(random)));
    if (b > 0) add(3 * b, 3 * b - 1, any(random));
    for (int i = 0; i < 3; ++i)
      add(motions + b, 3 * b + i, any(random));
    if (b > 0) add(motions + b, 3 * b - 3, any(random));
  }
  return out;
}

Eigen::VectorXd random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  Eigen::VectorXd x(size);
  for (double& entry : x)
    entry = any(random);
  return x;
}

double backward_error(const Eigen::MatrixXd& a, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
  return (a * x - b).cwiseAbs().maxCoeff() / (a.cwiseAbs() * x.cwiseAbs() + b.cwiseAbs()).maxCoeff();
}

// Entries alone, of matrices too large to be written out.
struct LargeMatrix {
  SparsePattern pattern;
  std::vector<double> values;

  explicit LargeMatrix(int size) { pattern.clear(size, true); }

  void add(int i, int j, double value) {
    pattern.rows.push_back(std::max(i, j));
    pattern.columns.push_back(std::min(i, j));
    values.push_back(value);
  }

  // What x leaves of b, of the terms of the sums.
  double backward_error(const Eigen::VectorXd& x, const Eigen::VectorXd& b) const {
    Eigen::VectorXd left = b, terms = b.cwiseAbs();
    const auto take = [&](Eigen::Index row, double term) {
      left[row] -= term;
      terms[row] += std::abs(term);
    };
    for (std::size_t e = 0; e < values.size(); ++e) {
      const Eigen::Index i = pattern.rows[e], j = pattern.columns[e];
      take(i, values[e] * x[j]);
      if (i != j) take(j, values[e] * x[i]);
    }
    return left.cwiseAbs().maxCoeff() / terms.maxCoeff();
  }
};

void check_solves(SparseFactorization& factors, const LargeMatrix& a) {
  const Eigen::VectorXd b = random_vector(a.pattern.size, 7);
  Eigen::VectorXd x = b;
  factors.solve(x, 1e-13);
  CHECK(a.backward_error(x, b) < 1e-13);
}

// Three membranes of a x b knots, each less a multiple of the identity, numbered in any order: eigenvalues
// 4 - 2 cos(i pi / (a + 1)) - 2 cos(j pi / (b + 1)) - shift.
struct Membranes {
  static constexpr int across = 72, along = 74;
  static constexpr std::array<double, 3> shift{0.3, 0.0123, 2.777};
  LargeMatrix matrix{3 * across * along};
  std::vector<int> place;
  int negative = 0;

  explicit Membranes(unsigned seed) : place(static_cast<std::size_t>(3 * across * along)) {
    for (std::size_t u = 0; u < place.size(); ++u)
      place[u] = static_cast<int>(u);
    std::ranges::shuffle(place, std::mt19937(seed));
    for (int m = 0; m < 3; ++m)
      for (int i = 0; i < across; ++i)
        for (int j = 0; j < along; ++j) {
          matrix.add(at(i, j, m), at(i, j, m), 4 - shift[static_cast<std::size_t>(m)]);
          if (i > 0) matrix.add(at(i, j, m), at(i - 1, j, m), -1);
          if (j > 0) matrix.add(at(i, j, m), at(i, j - 1, m), -1);
          using std::numbers::pi;
          const double eigenvalue =
              4 - 2 * std::cos((i + 1) * pi / (across + 1)) - 2 * std::cos((j + 1) * pi / (along + 1));
          if (eigenvalue < shift[static_cast<std::size_t>(m)]) ++negative;
        }
  }

  int at(int i, int j, int m) const { return place[static_cast<std::size_t>((i * along + j) * 3 + m)]; }
};

} // namespace

TEST_CASE("a saddle point is solved to its digits, whatever its pivots") {
  SparseFactorization factors;
  for (unsigned seed = 0; seed < 40; ++seed) {
    INFO("seed " << seed);
    const SaddlePoint a = saddle_point(60, seed % 2 == 0 ? 1e-1 : 1e-9, seed);
    factors.factor(a.pattern, a.values, 1e-14);
    CHECK(factors.nullity() == 0);
    const Eigen::VectorXd b = random_vector(a.dense.rows(), seed + 100);
    Eigen::VectorXd x = b;
    factors.solve(x, 1e-11);
    CHECK(backward_error(a.dense, x, b) < 1e-11);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a.dense, Eigen::EigenvaluesOnly);
    CHECK(factors.negative() == (eigen.eigenvalues().array() < 0).count());
  }
}

// Any signs, pairs of unknowns without diagonals, rows twice, more or less coupling: [K J^T; J 0].
TEST_CASE("solutions, inertia and null space are those of the dense matrix") {
  int singular = 0, symmetric = 0;
  for (unsigned seed = 1; seed < 1000; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const int motions = 4 + static_cast<int>(seed % 30),
              rows = std::min(static_cast<int>(seed % 7), motions / 2);
    SparsePattern pattern;
    pattern.clear(motions + rows, seed % 3 != 0);
    pattern.motions = motions;
    std::vector<double> values;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(motions + rows, motions + rows);
    const auto add = [&](int i, int j, double below, double above) {
      const auto put = [&](int row, int column, double value) {
        pattern.rows.push_back(row);
        pattern.columns.push_back(column);
        values.push_back(value);
      };
      put(i, j, below);
      dense(i, j) += below;
      if (i == j) return;
      if (pattern.symmetric) above = below;
      dense(j, i) += above;
      if (!pattern.symmetric) put(j, i, above);
    };
    const auto one_of_motions = [&] { return static_cast<int>(random() % static_cast<unsigned>(motions)); };
    for (int i = 0; i < motions; ++i)
      add(i, i, seed % 5 == 0 ? 0 : any(random), 0);
    for (int k = 0; k < 2 * motions; ++k)
      if (const int i = one_of_motions(), j = one_of_motions(); i != j)
        add(std::max(i, j), std::min(i, j), any(random), any(random));
    for (int r = 0; r < rows; ++r) {
      if (r == 2 && seed % 2 == 0) {
        for (int j = 0; j < motions; ++j)
          if (const double same = dense(motions, j); same != 0) add(motions + r, j, same, same);
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const double entry = any(random);
        add(motions + r, one_of_motions(), entry, entry);
      }
    }
    SparseFactorization factors;
    factors.factor(pattern, values, 1e-12);
    const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::MatrixXd>(dense).singularValues();
    CHECK(factors.nullity() == (sizes.array() < 1e-12 * sizes[0]).count());
    const Eigen::VectorXd b = dense * random_vector(dense.rows(), seed);
    Eigen::VectorXd x = b;
    factors.solve(x, 1e-13);
    CHECK((dense * x - b).norm() < 1e-9 * b.norm());
    if (factors.nullity() > 0) {
      const Eigen::MatrixXd null = factors.null_space();
      CHECK((dense * null).norm() < 1e-9);
      CHECK(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(null).rank() == null.cols());
      ++singular;
    }
    if (!pattern.symmetric) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense, Eigen::EigenvaluesOnly);
    CHECK(factors.negative() == (eigen.eigenvalues().array() < -1e-11).count());
    ++symmetric;
  }
  CHECK(singular > 100);
  CHECK(symmetric > 600);
}

TEST_CASE("factors are those of the last values") {
  SparseFactorization factors;
  SaddlePoint a = saddle_point(20, 1e-2, 5);
  const Eigen::VectorXd b = random_vector(a.dense.rows(), 6);
  for (int round = 0; round < 4; ++round) {
    if (round > 1) { // the first two rounds have the same values
      for (double& value : a.values)
        value *= 1.5;
      a.dense *= 1.5;
    }
    factors.factor(a.pattern, a.values, 1e-14);
    Eigen::VectorXd x = b;
    factors.solve(x, 1e-11);
    CHECK(backward_error(a.dense, x, b) < 1e-11);
  }
}

TEST_CASE("rows that depend on each other are pivots of zero") {
  SaddlePoint a = saddle_point(12, 1e-1, 9);
  const int motions = 36, last = motions + 11;
  for (std::size_t e = 0; e < a.values.size(); ++e) // the last row of J becomes the first
    if (a.pattern.rows[e] == last) a.values[e] = 0;
  const Eigen::MatrixXd first = a.dense.row(motions).leftCols(motions);
  for (int j = 0; j < motions; ++j) {
    a.dense(last, j) = a.dense(j, last) = first(0, j);
    if (first(0, j) == 0) continue;
    a.pattern.rows.push_back(last);
    a.pattern.columns.push_back(j);
    a.values.push_back(first(0, j));
  }
  SparseFactorization factors;
  factors.factor(a.pattern, a.values, 1e-12);
  REQUIRE(factors.nullity() == 1);
  const Eigen::VectorXd null = factors.null_space().col(0);
  CHECK((a.dense * null).norm() < 1e-12 * null.norm());
  Eigen::VectorXd b = a.dense * random_vector(a.dense.rows(), 3), x = b;
  factors.solve(x, 1e-11);
  CHECK((a.dense * x - b).norm() < 1e-10 * b.norm());
}

TEST_CASE("a large matrix has the signs of its eigenvalues and solves to its digits") {
  const Membranes membranes(GENERATE(1U, 2U));
  const LargeMatrix& a = membranes.matrix;
  SparseFactorization factors;
  factors.factor(a.pattern, a.values, 1e-12);
  CHECK(factors.nullity() == 0);
  CHECK(factors.negative() == membranes.negative);
  check_solves(factors, a);
}

// Knots of some motions, with a row along each edge in a random direction.
struct Net {
  LargeMatrix matrix{0};
  int rows = 0;

  Net(int across, int along, int motions) {
    const auto knot = [&](int i, int j) { return i * along + j; };
    std::vector<std::array<int, 2>> edges;
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < along; ++j) {
        if (i > 0 && (across < 3 || j % 2 == 0)) edges.push_back({knot(i, j), knot(i - 1, j)});
        if (j > 0) edges.push_back({knot(i, j), knot(i, j - 1)});
      }
    rows = static_cast<int>(edges.size());
    const int all = motions * across * along, size = all + rows;
    matrix = LargeMatrix(size);
    matrix.pattern.motions = all;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int v = 0; v < all; ++v)
      matrix.add(v, v, 2 + any(random));
    for (int e = 0; e < rows; ++e)
      for (const int k : edges[static_cast<std::size_t>(e)])
        for (int c = 0; c < motions; ++c)
          matrix.add(all + e, motions * k + c, any(random));
  }
};

TEST_CASE("a large saddle point has a negative pivot for each of its rows") {
  // Wide ones and ladders.
  const auto [across, along, motions] =
      GENERATE(std::array{60, 60, 3}, std::array{2, 2500, 2}, std::array{2, 2500, 3}, std::array{1, 6000, 2},
               std::array{4, 1500, 3});
  CAPTURE(across, along, motions);
  const Net net(across, along, motions);
  const LargeMatrix& a = net.matrix;
  SparseFactorization factors;
  factors.factor(a.pattern, a.values, 1e-12);
  CHECK(factors.nullity() == 0);
  CHECK(factors.negative() == net.rows);
  check_solves(factors, a);
}

TEST_CASE("elimination_order gives every unknown one place") {
  const auto [across, along, motions] =
      GENERATE(std::array{9, 9, 3}, std::array{2, 40, 2}, std::array{2, 40, 1}, std::array{3, 30, 1});
  const Net net(across, along, motions);
  const SparsePattern& pattern = net.matrix.pattern;
  std::vector<int> places = elimination_order(pattern);
  REQUIRE(places.size() == static_cast<std::size_t>(pattern.size));
  std::ranges::sort(places);
  for (int place = 0; place < pattern.size; ++place)
    CHECK(places[static_cast<std::size_t>(place)] == place);
}

TEST_CASE("a pivot below the limit counts as zero, beside large numbers, too") {
  // A wheel makes the norm large, some twenty; a bead elsewhere carries nearly nothing beside it.
  constexpr int beads = 14000;
  LargeMatrix a(beads);
  for (int i = 0; i < beads; ++i) {
    a.add(i, i, i == beads - 1 ? 1 + 5e-10 : 2.5);
    if (i > 0 && i < beads - 2) a.add(i, i - 1, -1);
    if (i >= 2 && i < 1500) a.add(0, i, 0.01 * (i % 7 - 3));
  }
  a.add(beads - 2, beads - 2, -1.5);
  a.add(beads - 1, beads - 2, 1);
  for (int i = 2; i < 1500; ++i)
    a.add(0, i, 1);
  a.add(0, 0, 2000);
  SparseFactorization factors;
  factors.factor(a.pattern, a.values, 1e-10);
  CHECK(factors.nullity() == 1);
  factors.factor(a.pattern, a.values, 1e-12);
  CHECK(factors.nullity() == 0);
}

TEST_CASE("what a large matrix maps to zero is found") {
  // Three strings of beads with free ends, which move as they are.
  constexpr int beads = 5400;
  LargeMatrix a(3 * beads);
  for (int s = 0; s < 3; ++s)
    for (int i = 0; i < beads; ++i) {
      a.add(s * beads + i, s * beads + i, i == 0 || i == beads - 1 ? 1 : 2);
      if (i > 0) a.add(s * beads + i, s * beads + i - 1, -1);
    }
  SparseFactorization factors;
  factors.factor(a.pattern, a.values, 1e-12);
  REQUIRE(factors.nullity() == 3);
  CHECK(factors.negative() == 0);
  for (int n = 0; n < 3; ++n) {
    const Eigen::VectorXd null = factors.null_space().col(n);
    CHECK(a.backward_error(null, Eigen::VectorXd::Zero(null.size())) < 1e-10);
  }
}

TEST_CASE("large matrices are factored on several threads to the same digits") {
  const Membranes membranes(8);
  const LargeMatrix& a = membranes.matrix;
  const Eigen::VectorXd b = random_vector(a.pattern.size, 9);
  std::array<Eigen::VectorXd, 3> x;
  std::array<std::atomic<bool>, 3> done{};
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < x.size(); ++t)
      threads.emplace_back([&, t] {
        SparseFactorization factors;
        for (int round = 0; round < 3; ++round) {
          std::vector<double> values = a.values;
          for (double& value : values)
            value *= round + 1;
          factors.factor(a.pattern, values, 1e-12);
          done[t] = true;
          x[t] = b;
          factors.solve(x[t], 1e-13);
        }
      });
  }
  for (std::size_t t = 0; t < x.size(); ++t) {
    REQUIRE(done[t]);
    CHECK(x[t] == x[0]);
    CHECK(a.backward_error(3 * x[t], b) < 1e-13);
  }
}
