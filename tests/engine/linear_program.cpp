// Small linear programs against all their corners.
#include "engine/linear/linear_program.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/linear/uniform_random.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd random_matrix(std::mt19937& random, Index rows, Index columns) {
  MatrixXd out(rows, columns);
  for (double& entry : out.reshaped())
    entry = uniform(random, -1, 1);
  return out;
}

// The largest g . x over all points in which three of the constraints of three unknowns meet.
double best_corner(const VectorXd& g, const MatrixXd& A, const VectorXd& lower, const VectorXd& upper) {
  MatrixXd rows(A.rows() + 3, 3);
  rows << MatrixXd::Identity(3, 3), A;
  VectorXd low(rows.rows()), high(rows.rows());
  low << VectorXd::Constant(3, -1), lower;
  high << VectorXd::Constant(3, 1), upper;
  double best = 0;
  for (Index a = 0; a < rows.rows(); ++a)
    for (Index b = a + 1; b < rows.rows(); ++b)
      for (Index c = b + 1; c < rows.rows(); ++c)
        for (int sides = 0; sides < 8; ++sides) {
          MatrixXd three(3, 3);
          VectorXd at(3);
          int k = 0;
          for (const Index r : {a, b, c}) {
            three.row(k) = rows.row(r);
            at[k] = (sides >> k) & 1 ? high[r] : low[r];
            ++k;
          }
          const auto x = solve_square(three, at);
          if (!x || (three * *x - at).norm() > 1e-9) continue;
          const VectorXd values = rows * *x;
          if (((values - high).array() < 1e-9).all() && ((low - values).array() < 1e-9).all())
            best = std::max(best, g.dot(*x));
        }
  return best;
}

} // namespace

TEST_CASE("the largest product within constraints is that of the best corner") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const MatrixXd A = random_matrix(random, 4, 3);
    const VectorXd g = random_matrix(random, 3, 1);
    VectorXd lower = -random_matrix(random, 4, 1).cwiseAbs(), upper = random_matrix(random, 4, 1).cwiseAbs();
    if (trial % 3 == 0) upper[0] = 0; // begins at a constraint
    const VectorXd x = largest_within(g, A, lower, upper);
    CAPTURE(trial);
    CHECK_THAT(g.dot(x), WithinAbs(best_corner(g, A, lower, upper), 1e-9));
    CHECK(x.lpNorm<Eigen::Infinity>() <= 1 + 1e-12);
    CHECK(((A * x - upper).array() < 1e-12).all());
    CHECK(((lower - A * x).array() < 1e-12).all());
  }
}

TEST_CASE("the least largest entry is what no motion takes more of") {
  // Of one row by its limits: |b| / sum |a|. Of two, the largest work share over all directions of motion.
  std::mt19937 random(8);
  for (int trial = 0; trial < 50; ++trial) {
    const MatrixXd row = random_matrix(random, 1, 4);
    CHECK_THAT(least_largest(row, VectorXd::Constant(1, 0.7)).value(),
               WithinRel(0.7 / row.lpNorm<1>(), 1e-12));
    const MatrixXd A = random_matrix(random, 2, 5);
    const VectorXd b = random_matrix(random, 2, 1);
    double most = 0;
    for (Index i = 0; i < A.cols(); ++i) { // the least share is where one column is turned across
      const VectorXd motion{{-A(1, i), A(0, i)}};
      most = std::max(most, std::abs(b.dot(motion)) / (A.transpose() * motion).lpNorm<1>());
    }
    CHECK_THAT(least_largest(A, b).value(), WithinRel(most, 1e-9));
  }
  CHECK(least_largest(MatrixXd::Ones(2, 3), VectorXd::Zero(2)) == 0);
  CHECK_FALSE(least_largest(MatrixXd::Ones(2, 3), VectorXd{{1, 2}}));
}
