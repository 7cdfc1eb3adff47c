// Large dense decompositions are right, and end at once when they are asked to.
#include "engine/linear/interruption.hpp"
#include "engine/linear/large.hpp"
#include "tests/catch.hpp"
#include "tests/time_to_stop.hpp"

#include <Eigen/Dense>

#include <random>
#include <thread>

using namespace flyball;
using namespace flyball::large;
using flyball::test::time_to_stop;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> any;
  Eigen::MatrixXd a(rows, columns);
  for (double& entry : a.reshaped())
    entry = any(random);
  return a;
}

Eigen::MatrixXd random_symmetric(Eigen::Index n, unsigned seed) {
  const Eigen::MatrixXd a = random_matrix(n, n, seed);
  return a + a.transpose();
}

} // namespace

TEST_CASE("products by pieces are products") {
  const Eigen::MatrixXd a = random_matrix(300, 420, 1), b = random_matrix(420, 350, 2);
  Eigen::MatrixXd out;
  multiply(a, b, out);
  CHECK((out - a * b).norm() < 1e-13 * out.norm());
  const Eigen::MatrixXd k = random_matrix(420, 420, 3);
  out = projected(k, b);
  CHECK((out - b.transpose() * k * b).norm() < 1e-13 * out.norm());
  CHECK(projected(k, Eigen::MatrixXd::Identity(420, 420)) == k);
  multiply(Eigen::MatrixXd(3, 0), Eigen::MatrixXd(0, 2), out);
  CHECK(out.isZero(0));
}

TEST_CASE("a large matrix is factored by Cholesky, or found to be indefinite") {
  const Eigen::MatrixXd half = random_matrix(261, 261, 4), a = half * half.transpose();
  Eigen::MatrixXd factor = a;
  REQUIRE(factor_cholesky(factor));
  const Eigen::MatrixXd l = factor.triangularView<Eigen::Lower>();
  CHECK((l * l.transpose() - a).norm() < 1e-13 * a.norm());
  factor = a;
  factor(200, 200) = -1;
  CHECK_FALSE(factor_cholesky(factor));
  factor = a;
  factor(240, 3) = NAN;
  CHECK_FALSE(factor_cholesky(factor));
}

TEST_CASE("a large matrix is factored by LU with pivots") {
  const Eigen::MatrixXd a = random_matrix(261, 261, 5);
  Eigen::MatrixXd lu = a, permuted = a;
  Eigen::VectorXi exchanges;
  factor_lu(lu, exchanges);
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    permuted.row(i).swap(permuted.row(exchanges[i]));
  const Eigen::MatrixXd l = lu.triangularView<Eigen::UnitLower>(), u = lu.triangularView<Eigen::Upper>();
  CHECK((l * u - permuted).norm() < 1e-12 * a.norm());
  CHECK(lu.triangularView<Eigen::StrictlyLower>().toDenseMatrix().cwiseAbs().maxCoeff() <= 1);
}

TEST_CASE("a large matrix of low rank is factored by QR with pivots as Eigen does") {
  for (const auto& [m, n, rank] :
       {std::tuple(200, 300, 200), std::tuple(300, 200, 200), std::tuple(260, 240, 90)}) {
    const Eigen::MatrixXd a = random_matrix(m, rank, 6) * random_matrix(rank, n, 7);
    Eigen::MatrixXd qr = a;
    Eigen::VectorXd coefficients;
    Eigen::VectorXi order;
    factor_pivoted_qr(qr, coefficients, order);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> eigen(a);
    for (int i = 0; i < rank; ++i)
      CHECK(std::abs(qr(i, i)) == Approx(std::abs(eigen.matrixQR()(i, i))).epsilon(1e-8));
    if (rank < std::min(m, n)) CHECK(std::abs(qr(rank, rank)) < 1e-10 * std::abs(qr(0, 0)));
    Eigen::MatrixXd q = qr.triangularView<Eigen::Upper>();
    Eigen::VectorXd work(n);
    for (Eigen::Index k = coefficients.size() - 1; k >= 0; --k)
      q.bottomRows(m - k).applyHouseholderOnTheLeft(qr.col(k).tail(m - k - 1), coefficients[k], work.data());
    Eigen::MatrixXd permuted(m, n);
    for (Eigen::Index i = 0; i < n; ++i)
      permuted.col(i) = a.col(order[i]);
    CHECK((q - permuted).norm() < 1e-12 * a.norm());
  }
}

TEST_CASE("eigenvalues and vectors of large symmetric matrices") {
  Eigen::MatrixXd clustered = random_symmetric(220, 8);
  clustered.block(0, 0, 100, 100)
      .setIdentity(); // of rank one beside a multiple of the identity, and a zero block
  clustered.block(100, 0, 120, 100).setZero();
  clustered.bottomRightCorner(60, 60).setZero();
  for (const Eigen::MatrixXd& a :
       {random_symmetric(220, 9), clustered, Eigen::MatrixXd(1e-200 * random_symmetric(160, 10)),
        Eigen::MatrixXd(Eigen::MatrixXd::Zero(160, 160))}) {
    const Eigen::MatrixXd whole = a.selfadjointView<Eigen::Lower>();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(whole);
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
    REQUIRE(symmetric_eigen(a, values, &vectors));
    const double size = eigen.eigenvalues().cwiseAbs().maxCoeff();
    CHECK((values - eigen.eigenvalues()).cwiseAbs().maxCoeff() <= 1e-12 * size);
    CHECK((vectors.transpose() * vectors - Eigen::MatrixXd::Identity(a.rows(), a.rows())).norm() < 1e-11);
    if (size > 0) CHECK((whole / size * vectors - vectors * (values / size).asDiagonal()).norm() < 1e-11);
    Eigen::VectorXd alone;
    REQUIRE(symmetric_eigen(a, alone, nullptr));
    CHECK((values - alone).cwiseAbs().maxCoeff() <= 1e-13 * size);
  }
}

TEST_CASE("smallest singular values and their vectors, also of singular matrices") {
  Eigen::MatrixXd a = random_matrix(180, 180, 11);
  for (const int singular : {0, 1, 2}) {
    if (singular == 1) a.row(77) = a.row(5) - 3 * a.row(8);
    if (singular == 2) a.row(12).setZero();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const auto found = smallest_singular(a, 3);
    REQUIRE(found);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Index k = 179 - i;
      CHECK(found->values[i] == Approx(svd.singularValues()[k]).epsilon(1e-6).margin(1e-12));
      if (i == singular) // apart from its neighbours
        CHECK(std::abs(found->right.col(i).dot(svd.matrixV().col(k))) == Approx(1).epsilon(1e-5));
    }
    CHECK((a * found->right.leftCols(singular)).norm() < 1e-12 * a.norm());
    CHECK((a.transpose() * found->left.leftCols(singular)).norm() < 1e-12 * a.norm());
  }
}

TEST_CASE("interruption points look at the flag of the innermost scope that has one, on their thread alone") {
  std::atomic<bool> outer{false}, inner{true};
  interruption_point();
  {
    const Interruptible scope(&outer);
    {
      const Interruptible other(&inner);
      CHECK_THROWS_AS(interruption_point(), Interrupted);
      const Interruptible none(nullptr);
      CHECK_THROWS_AS(interruption_point(), Interrupted);
      std::thread([] { interruption_point(); }).join();
    }
    interruption_point();
    outer = true;
    CHECK_THROWS_AS(interruption_point(), Interrupted);
  }
  interruption_point();
}

TEST_CASE("every large decomposition ends soon when it is asked to") {
  const Eigen::Index n = 800;
  const Eigen::MatrixXd a = random_symmetric(n, 12);
  Eigen::MatrixXd definite = a;
  definite.diagonal().array() += 4 * std::sqrt(static_cast<double>(n));
  constexpr double soon = 0.05; // s of the thread's own processor time
  std::mt19937 random(13);
  const auto stops = [&](const char* what, double within, const auto& work) {
    INFO(what);
    for (int i = 0; i < 2; ++i) {
      const double after = within * static_cast<double>(random()) / 4294967296.;
      const auto took = time_to_stop(after, [&](const std::atomic<bool>& cancel) {
        const Interruptible scope(&cancel);
        try {
          work();
        } catch (const Interrupted&) {
        }
      });
      if (took) CHECK(*took < soon);
    }
  };
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;
  Eigen::VectorXi integers;
  stops("product", 0.2, [&] { multiply(a, definite, matrix); });
  stops("Cholesky", 0.05, [&] {
    matrix = definite;
    (void)factor_cholesky(matrix);
  });
  stops("LU", 0.1, [&] {
    matrix = a;
    factor_lu(matrix, integers);
  });
  stops("QR", 0.8, [&] {
    matrix = a;
    factor_pivoted_qr(matrix, vector, integers);
  });
  stops("symmetric eigenvalues", 2, [&] { (void)symmetric_eigen(a, vector, &matrix); });
  stops("smallest singular values", 0.3, [&] { (void)smallest_singular(a, 2); });
}
