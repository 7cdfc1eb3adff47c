#include "engine/continuation/singularity.hpp"

#include "engine/continuation/bordered_kkt.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/newton.hpp"

#include <random>

namespace flyball {
namespace {

constexpr double difference_step = 1e-5; // scaled: of one differentiation

// v and g of a KKT matrix that is linearised.
bool solve_bordered(BorderedKkt& a, const Eigen::VectorXd& border, double size, Eigen::Index rows,
                    BorderedKkt::Vector& out) {
  const Eigen::Index n = border.size();
  a.set_columns(size * border, Eigen::MatrixXd::Zero(rows, 1));
  a.set_rows({border.transpose(), {}, Eigen::MatrixXd::Zero(1, 1)});
  return a.solve({Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(rows), Eigen::VectorXd::Ones(1)}, out);
}

// By inverse iteration, which bordering keeps regular.
std::optional<Eigen::VectorXd> null_vector(BorderedKkt& a, Eigen::Index n, Eigen::Index rows) {
  std::mt19937 random(7);
  Eigen::VectorXd border(n);
  for (double& entry : border)
    entry = static_cast<double>(random()) / 2147483648. - 1;
  BorderedKkt::Vector v;
  for (int i = 0; i < 5; ++i) {
    border.normalize();
    if (!solve_bordered(a, border, a.force_size(), rows, v)) return {};
    border = v.x;
  }
  border.normalize();
  return border;
}

} // namespace

double force_size(const Problem& problem, const Workspace& w) {
  if (problem.system.nv == 0) return 1;
  const double size = std::max(w.magnitudes.force.cwiseProduct(problem.scaling.column).maxCoeff(),
                               w.dense.stiffness().cwiseAbs().maxCoeff());
  return size > 0 ? size : 1;
}

void SingularityTest::set_borders(const Problem& problem, const Unknowns& z, Workspace& w) {
  left_ = right_ = Eigen::VectorXd::Zero(problem.system.nv);
  if (problem.form != KktForm::dense) {
    BorderedKkt a;
    a.linearize(problem, z, w);
    if (const auto border = null_vector(a, problem.system.nv, problem.system.rows)) left_ = right_ = *border;
    size_ = a.force_size();
    return;
  }
  const Eigen::MatrixXd& basis = w.dense.constraints().basis();
  if (basis.cols() == 0) return;
  const Eigen::MatrixXd reduced = large::projected(w.dense.stiffness(), basis);
  if (reduced.rows() >= large::from) {
    const auto smallest = large::smallest_singular(reduced, 1);
    if (!smallest) return;
    left_ = basis * smallest->left;
    right_ = basis * smallest->right;
  } else {
    const auto svd = singular_vectors(reduced);
    if (!svd) return;
    left_ = basis * svd->left.rightCols(1);
    right_ = basis * svd->right.rightCols(1);
  }
  size_ = force_size(problem, w);
}

Eigen::MatrixXd SingularityTest::bordered(const Workspace& w) const {
  const Eigen::MatrixXd& basis = w.dense.constraints().basis();
  const Eigen::Index k = basis.cols();
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(k + 1, k + 1);
  m.topLeftCorner(k, k) = large::projected(w.dense.stiffness(), basis) / size_;
  m.col(k).head(k) = basis.transpose() * left_;
  m.row(k).head(k) = right_.transpose() * basis;
  return m;
}

double SingularityTest::value(const Problem& problem, const Unknowns& z, Workspace& w) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (problem.form != KktForm::dense) {
    BorderedKkt a;
    BorderedKkt::Vector v;
    a.linearize(problem, z, w);
    return solve_bordered(a, left_, size_, problem.system.rows, v) ? v.m[0] : none;
  }
  const Eigen::MatrixXd m = bordered(w);
  const auto solved = solve_square(m, Eigen::VectorXd::Unit(m.rows(), m.rows() - 1));
  return solved ? (*solved)[m.rows() - 1] : none;
}

SingularityTest::Gradient SingularityTest::gradient(const Problem& problem, const Unknowns& z,
                                                    Workspace& w) const {
  Gradient out{Eigen::VectorXd::Zero(problem.system.nv), Eigen::VectorXd::Zero(problem.system.rows)};
  BorderedKkt a;
  BorderedKkt::Vector v;
  evaluate(problem, z, 0, w);
  a.linearize(problem, z, w);
  if (!solve_bordered(a, left_, size_, problem.system.rows, v)) return out;
  MotionProducts products;
  Eigen::VectorXd stiffness, constrained, closed;
  for (const double h : {difference_step, -difference_step}) {
    Unknowns moved = z;
    const Eigen::VectorXd step = h * v.x.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, step, moved.q);
    moved.lambda += h * v.lambda.cwiseProduct(problem.scaling.row);
    evaluate(problem, moved, 0, w);
    products.linearize(problem, moved, w.kinematics, w.residual);
    products.stiffness(v.x, stiffness);
    products.constraint_transposed(v.lambda, constrained);
    products.constraint(v.x, closed);
    out.x -= (stiffness + constrained) / (2 * h * size_);
    out.lambda -= closed / (2 * h * size_);
  }
  return out;
}

double SingularityTest::leaving(const Eigen::VectorXd& force_rate, const Eigen::VectorXd& loop_rate,
                                Workspace& w) const {
  const Eigen::MatrixXd m = bordered(w);
  const auto solved = solve_square(m.transpose(), Eigen::VectorXd::Unit(m.rows(), m.rows() - 1));
  if (!solved) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd across = solved->head(m.rows() - 1);
  Eigen::VectorXd closing = Eigen::VectorXd::Zero(force_rate.size());
  if (w.dense.constraints().rank() > 0) w.dense.constraints().solve(-loop_rate, closing);
  const Eigen::VectorXd force = w.dense.stiffness() * closing + force_rate;
  return across.dot(w.dense.constraints().basis().transpose() * force) / size_;
}

} // namespace flyball
