// The same answers from large matrices, which are decomposed by pieces, as Eigen's own decompositions give.
#include "engine/linear/exponential.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/lyapunov.hpp"
#include "engine/linear/spectral.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <random>

using namespace flyball;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> any;
  Eigen::MatrixXd a(rows, columns);
  for (double& entry : a.reshaped())
    entry = any(random);
  return a;
}

constexpr Eigen::Index n = large::from + 21;

} // namespace

TEST_CASE("a large definite matrix is factored and solved with") {
  const Eigen::MatrixXd half = random_matrix(n, n, 1);
  const Eigen::MatrixXd a = half * half.transpose() + Eigen::MatrixXd::Identity(n, n),
                        b = random_matrix(n, 11, 2);
  Cholesky cholesky;
  REQUIRE(cholesky.compute(a));
  Eigen::VectorXd x = b.col(3);
  cholesky.solve_in_place(x);
  CHECK((a * x - b.col(3)).norm() < 1e-9 * b.norm());
  CHECK((a * cholesky.solve(b) - b).norm() < 1e-9 * b.norm());
  const Eigen::LLT<Eigen::MatrixXd> eigen(a);
  CHECK((cholesky.forward(b) - eigen.matrixL().solve(b)).norm() < 1e-10 * b.norm());
  CHECK(cholesky.smallest_pivot() ==
        Approx(eigen.matrixLLT().diagonal().cwiseAbs2().minCoeff()).epsilon(1e-10));
  CHECK_FALSE(cholesky.compute(-a));
}

TEST_CASE("a large square matrix is solved with, and the sign of its determinant is known") {
  Eigen::MatrixXd a = random_matrix(n, n, 3);
  const Eigen::VectorXd b = random_matrix(n, 1, 4);
  for (int i = 0; i < 2; ++i) {
    Lu lu;
    REQUIRE(lu.compute(a));
    CHECK((a * lu.solve(b) - b).norm() < 1e-9 * b.norm());
    CHECK((a.transpose() * lu.solve_transposed(b) - b).norm() < 1e-9 * b.norm());
    const Eigen::PartialPivLU<Eigen::MatrixXd> eigen(a);
    int sign = eigen.permutationP().determinant() < 0 ? -1 : 1;
    for (const double pivot : eigen.matrixLU().diagonal())
      sign *= pivot < 0 ? -1 : 1;
    CHECK(lu.sign_of_determinant() == sign);
    CHECK(large::smallest_singular(a, 1)->sign == sign);
    const auto x = solve_square(a, b);
    REQUIRE(x);
    CHECK((a * *x - b).norm() < 1e-9 * b.norm());
    a.row(7).swap(a.row(90));
  }
}

TEST_CASE("least squares of least norm with large matrices of any rank") {
  for (const Eigen::Index rank : {n, Eigen::Index{100}}) {
    const Eigen::MatrixXd a = random_matrix(n, rank, 5) * random_matrix(rank, n, 6);
    const Eigen::MatrixXd b = random_matrix(n, 2, 7);
    CompleteOrthogonal ours;
    REQUIRE(ours.compute(a, 1e-10));
    CHECK(ours.rank() == rank);
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> eigen;
    eigen.setThreshold(1e-10);
    eigen.compute(a);
    const Eigen::MatrixXd expected = eigen.solve(b);
    Eigen::VectorXd x;
    ours.solve(b.col(0), x);
    CHECK((x - expected.col(0)).norm() < 1e-6 * expected.norm());
    CHECK((ours.solve(b) - expected).norm() < 1e-6 * expected.norm());
  }
}

TEST_CASE("least squares of least norm with small matrices of any shape and rank") {
  CompleteOrthogonal ours; // one for all: it keeps its storage
  for (const auto& [rows, columns, rank] : {std::array<Eigen::Index, 3>{3, 3, 3},
                                            {3, 3, 2},
                                            {5, 3, 3},
                                            {5, 3, 1},
                                            {2, 4, 2},
                                            {4, 6, 3},
                                            {3, 3, 0}}) {
    CAPTURE(rows, columns, rank);
    const Eigen::MatrixXd a = random_matrix(rows, rank, 31) * random_matrix(rank, columns, 32),
                          b = random_matrix(rows, 2, 33);
    REQUIRE(ours.compute(a, 1e-10));
    CHECK(ours.rank() == rank);
    // By singular values.
    const auto parts = singular_vectors(a);
    REQUIRE(parts);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(columns, 2);
    for (Eigen::Index i = 0; i < rank; ++i)
      expected += parts->right.col(i) * (parts->left.col(i).transpose() * b) / parts->values[i];
    CHECK((ours.solve(b) - expected).norm() <= 1e-10 * expected.norm());
    Eigen::VectorXd x;
    ours.solve(b.col(1), x);
    CHECK((x - expected.col(1)).norm() <= 1e-10 * expected.norm());
  }
}

TEST_CASE("columns of a large matrix are orthogonalised with pivots") {
  const Eigen::MatrixXd a = random_matrix(n + 30, 60, 8) * random_matrix(60, n, 9);
  PivotedQr qr;
  REQUIRE(qr.compute(a));
  CHECK(qr.rank(1e-10) == 60);
  const Eigen::MatrixXd q = qr.q();
  CHECK((q.transpose() * q - Eigen::MatrixXd::Identity(n + 30, n + 30)).norm() < 1e-11);
  const Eigen::MatrixXd r = qr.matrix().triangularView<Eigen::Upper>();
  for (const Eigen::Index i : {0, 59, 100})
    CHECK((q * r.col(i) - a.col(qr.permutation()[i])).norm() < 1e-10 * a.norm());
  Eigen::VectorXd x = random_matrix(n + 30, 1, 10);
  const Eigen::VectorXd before = x;
  qr.apply_q_transposed(x, 60);
  qr.apply_q(x, 60);
  CHECK((x - before).norm() < 1e-11 * before.norm());
}

TEST_CASE("eigenvalues of large matrices, symmetric and not, are Eigen's") {
  const Eigen::MatrixXd a = random_matrix(n, n, 11), s = a + a.transpose();
  SymmetricEigen symmetric;
  REQUIRE(symmetric.compute(s));
  CHECK((s * symmetric.vectors() - symmetric.vectors() * symmetric.values().asDiagonal()).norm() <
        1e-10 * s.norm());
  const auto found = eigenvalues(a);
  REQUIRE(found);
  REQUIRE(found->size() == static_cast<std::size_t>(n));
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(a, false);
  for (const std::complex<double> x : eigen.eigenvalues()) {
    double nearest = 1e9;
    for (const std::complex<double> y : *found)
      nearest = std::min(nearest, std::abs(x - y));
    CHECK(nearest < 1e-8 * a.norm());
  }
}

TEST_CASE("a flag ends the eigenvalues of a large matrix without an answer") {
  const std::atomic<bool> set{true};
  CHECK_FALSE(eigenvalues(random_matrix(n, n, 12), &set));
  const Interruptible scope(&set);
  CHECK_THROWS_AS(eigenvalues(random_matrix(n, n, 12)), Interrupted);
  SymmetricEigen symmetric;
  CHECK_THROWS_AS(symmetric.compute(Eigen::MatrixXd::Identity(n, n)), Interrupted);
}

TEST_CASE("the logarithm of a rotation is skew and leads back to it; a reflection has none") {
  for (const int size : {1, 2, 3, 5, 8}) {
    const Eigen::MatrixXd half = random_matrix(size, size, 40 + static_cast<unsigned>(size));
    const Eigen::MatrixXd rotation = matrix_exponential(half - half.transpose()).value();
    const auto log = rotation_logarithm(rotation);
    REQUIRE(log);
    CHECK((*log + log->transpose()).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((matrix_exponential(*log).value() - rotation).cwiseAbs().maxCoeff() < 1e-13);
    // Two axes turned round in a random basis; then one.
    Eigen::MatrixXd turned = Eigen::MatrixXd::Identity(size, size);
    turned(0, 0) = -1;
    CHECK_FALSE(rotation_logarithm(rotation * turned * rotation.transpose()));
    if (size < 2) continue;
    turned(1, 1) = -1;
    turned = (rotation * turned * rotation.transpose()).eval();
    const auto round = rotation_logarithm(turned);
    REQUIRE(round);
    CHECK((*round + round->transpose()).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((matrix_exponential(*round).value() - turned).cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("Lyapunov's equation of stable matrices, stiff ones too; of others there is no answer") {
  std::mt19937 random(7);
  for (const int size : {1, 4, 9}) {
    Eigen::MatrixXd a(size, size), half(size, size);
    for (Eigen::MatrixXd* m : {&a, &half})
      for (double& entry : m->reshaped())
        entry = std::normal_distribution<double>()(random);
    a -= (a.norm() + 1) * Eigen::MatrixXd::Identity(size, size);
    a.row(0) *= 1e4;
    const Eigen::MatrixXd q = half * half.transpose() + Eigen::MatrixXd::Identity(size, size);
    const auto p = solve_lyapunov(a, q, 100);
    REQUIRE(p);
    CHECK((a.transpose() * *p + *p * a + q).norm() < 1e-9 * q.norm());
    CHECK_FALSE(solve_lyapunov(-a, q, 100));
  }
  const auto one = solve_lyapunov(Eigen::MatrixXd::Constant(1, 1, -3), Eigen::MatrixXd::Constant(1, 1, 2), 5);
  REQUIRE(one);
  CHECK((*one)(0, 0) == Approx(1. / 3));
}
