// Sparse matrices factored with pivoting, against dense ones.
#include "tests/catch.hpp"

#include "engine/equilibrium/sparse_factorization.hpp"

#include <Eigen/Eigenvalues>

#include <random>

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
  out.dense.setZero(motions + rows, motions + rows);
  const auto add = [&](int i, int j, double value) { // the lower triangle
    out.pattern.rows.push_back(i + 1);
    out.pattern.columns.push_back(j + 1);
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

} // namespace

TEST_CASE("a saddle point is solved to its digits, whatever its pivots") {
  SparseFactorization factors;
  for (unsigned seed = 0; seed < 40; ++seed) {
    INFO("seed " << seed);
    const SaddlePoint a = saddle_point(60, seed % 2 == 0 ? 1e-1 : 1e-9, seed);
    REQUIRE(factors.factor(a.pattern, a.values, 1e-14));
    CHECK(factors.nullity() == 0);
    const Eigen::VectorXd b = random_vector(a.dense.rows(), seed + 100);
    Eigen::VectorXd x = b;
    factors.solve(x, 1e-11);
    CHECK(backward_error(a.dense, x, b) < 1e-11);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a.dense, Eigen::EigenvaluesOnly);
    CHECK(factors.negative() == (eigen.eigenvalues().array() < 0).count());
  }
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
    REQUIRE(factors.factor(a.pattern, a.values, 1e-14));
    Eigen::VectorXd x = b;
    factors.solve(x, 1e-11);
    CHECK(backward_error(a.dense, x, b) < 1e-11);
  }
}

TEST_CASE("rows that depend on each other are pivots of zero") {
  SaddlePoint a = saddle_point(12, 1e-1, 9);
  const int motions = 36, last = motions + 11;
  for (std::size_t e = 0; e < a.values.size(); ++e) // the last row of J becomes the first
    if (a.pattern.rows[e] == last + 1) a.values[e] = 0;
  const Eigen::MatrixXd first = a.dense.row(motions).leftCols(motions);
  for (int j = 0; j < motions; ++j) {
    a.dense(last, j) = a.dense(j, last) = first(0, j);
    if (first(0, j) == 0) continue;
    a.pattern.rows.push_back(last + 1);
    a.pattern.columns.push_back(j + 1);
    a.values.push_back(first(0, j));
  }
  SparseFactorization factors;
  REQUIRE(factors.factor(a.pattern, a.values, 1e-12));
  REQUIRE(factors.nullity() == 1);
  const Eigen::VectorXd null = factors.null_space().col(0);
  CHECK((a.dense * null).norm() < 1e-12 * null.norm());
  Eigen::VectorXd b = a.dense * random_vector(a.dense.rows(), 3), x = b;
  factors.solve(x, 1e-11);
  CHECK((a.dense * x - b).norm() < 1e-10 * b.norm());
}
