#include "engine/kkt/dense_kkt.hpp"

#include "engine/kkt/body_stiffness.hpp"
#include "engine/kkt/speed_time.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/large.hpp"

namespace flyball {

void DenseKkt::linearize(const Problem& problem, const Unknowns& z, const Evaluation& at) {
  const System& system = problem.system;
  const Eigen::VectorXd& column = problem.scaling.column;
  const int n = system.nv;
  symmetric_ = problem.symmetric();
  problem_.emplace(problem);
  kinematics_ = &at.kinematics;
  has_metric_ = false;
  flyball::linearize(system, problem.parameters, z.q, z.lambda, at.kinematics, at.residual, linearization);
  interruption_point();
  scale_constraints(problem, at, space_);
  stiffness_.resize(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      stiffness_(i, j) = linearization.stiffness(i, j) * column[i] * column[j];
  clear_rounding(problem, at.magnitudes);
  mass_ = 0;
  for (std::size_t l = 0; l < system.links.size(); ++l)
    if (system.links[l].mobile) mass_ += problem.parameters.links[l].mass;
  if (space_.rank() == 0) {
    noise_ = rounding * at.magnitudes.force.cwiseProduct(column);
    return;
  }
  const Eigen::MatrixXd& basis = space_.basis();
  if (n < large::from) {
    product_.noalias() = stiffness_ * basis;
    reduced_.noalias() = basis.transpose() * product_;
  } else {
    reduced_ = large::projected(stiffness_, basis);
  }
  noise_.resize(basis.cols());
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    double size = 0;
    for (int i = 0; i < n; ++i)
      size += basis(i, k) * basis(i, k) * at.magnitudes.force[i] * column[i];
    noise_[k] = rounding * size;
  }
}

// A point mass that may turn feels nothing of it, but the terms of its balance cancel with rounding only: of
// the forces that act along its joint's other coordinates, which nothing is there to drown.
void DenseKkt::clear_rounding(const Problem& problem, const Magnitudes& magnitudes) {
  const System& system = problem.system;
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0 || link.type != LinkType::spherical) continue;
    double force = magnitudes.link_force[l] * problem.parameters.length;
    for (int i = static_cast<int>(l); i >= 0; i = system.links[static_cast<std::size_t>(i)].parent) {
      const Link& other = system.links[static_cast<std::size_t>(i)];
      if (other.tree_joint != link.tree_joint) break;
      if (other.v >= 0) force = std::max(force, magnitudes.force[other.v] * problem.scaling.column[other.v]);
    }
    for (int v = link.v; v < link.v + 3; ++v) {
      if (stiffness_.row(v).lpNorm<Eigen::Infinity>() > rounding * force ||
          stiffness_.col(v).lpNorm<Eigen::Infinity>() > rounding * force)
        continue;
      stiffness_.row(v).setZero();
      stiffness_.col(v).setZero();
    }
  }
}

void DenseKkt::scale_constraints(const Problem& problem, const Evaluation& at, ConstraintSpace& space) {
  rows_ = problem.system.rows;
  size_ = problem.system.nv;
  jacobian_.resize(rows_, size_);
  for (int j = 0; j < size_; ++j)
    for (int i = 0; i < rows_; ++i)
      jacobian_(i, j) = linearization.constraint(i, j) * problem.scaling.row[i] * problem.scaling.column[j];
  space.factor(jacobian_, rank_tolerance(problem, at.residual.phi), row_rounding);
  alone_is_later_ = &space == &alone_;
}

void DenseKkt::factor_constraints(const Problem& problem, const Evaluation& at) {
  linearize_constraints(problem.system, problem.parameters, at.kinematics, linearization);
  scale_constraints(problem, at, alone_);
}

void DenseKkt::factor(double shift) {
  shift_ = shift;
  has_directions_ = false;
  if (shift == 0) {
    hessian_.factor(reduced(), noise_, symmetric_);
  } else {
    need_metric();
    shifted_ = stiffness_ + shift * metric_;
    if (space_.rank() > 0) {
      shifted_reduced_ = large::projected(shifted_, space_.basis());
      hessian_.factor(shifted_reduced_, noise_, symmetric_);
    } else {
      hessian_.factor(shifted_, noise_, symmetric_);
    }
  }
  known_ = hessian_.known();
  null_ = hessian_.null_count();
  negative_ = 0;
  if (symmetric_ && !hessian_.positive_definite() && known_)
    negative_ = static_cast<int>((hessian_.eigenvalues().array() < -zero).count());
}

// Of each body its inertia, seen from the coordinates that move it; and a little of each coordinate's own.
void DenseKkt::need_metric() {
  if (has_metric_) return;
  has_metric_ = true;
  const System& system = problem_->system;
  const Kinematics<double>& k = *kinematics_;
  metric_.setZero(size_, size_);
  Eigen::Matrix<double, 6, Eigen::Dynamic> motions;
  std::vector<int> moved_by;
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    BodyInertia body;
    set_body_inertia(problem_->parameters, l, k, body);
    if (body.massless()) continue;
    moved_by.clear();
    for (int i = static_cast<int>(l); i >= 0; i = system.links[static_cast<std::size_t>(i)].parent) {
      const Link& link = system.links[static_cast<std::size_t>(i)];
      for (int c = 0; link.v >= 0 && c < (link.type == LinkType::spherical ? 3 : 1); ++c)
        moved_by.push_back(link.v + c);
    }
    motions.resize(6, static_cast<Eigen::Index>(moved_by.size()));
    for (std::size_t i = 0; i < moved_by.size(); ++i) {
      const Column<double>& column = k.columns[static_cast<std::size_t>(moved_by[i])];
      motions.col(static_cast<Eigen::Index>(i)) << column.turn(), column.at(k.links[l].o);
      motions.col(static_cast<Eigen::Index>(i)) *= problem_->scaling.column[moved_by[i]];
    }
    metric_(moved_by, moved_by) += motions.transpose() * inertia_matrix(body) * motions;
  }
  if (!system.torques.empty()) {
    // Speeds that are found have their inertia for themselves, as a border of trees has (speeds_kkt.hpp).
    Eigen::ArrayXd found = Eigen::ArrayXd::Zero(size_);
    for (const Link& link : system.links)
      if (link.v >= 0 && finds_speed(link)) found[link.v] = 1;
    const double time = speed_time(*problem_);
    for (int j = 0; j < size_; ++j)
      metric_.col(j).array() *= found[j] > 0 ? Eigen::ArrayXd(time * found) : Eigen::ArrayXd(1 - found);
  }
  const double length = problem_->parameters.length;
  const double least = own_share * own_share * std::max(mass_, 1e-300) * length * length;
  for (int i = 0; i < size_; ++i)
    metric_(i, i) += metric_(i, i) > 0 ? own_share * metric_(i, i) : least;
}

double DenseKkt::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  need_metric();
  product = metric_ * x;
  return product.dot(x);
}

const std::vector<KktSystem::NullDirection>& DenseKkt::null_directions() {
  if (has_directions_) return directions_;
  has_directions_ = true;
  directions_.clear();
  if (null_ == 0) return directions_;
  const Eigen::MatrixXd all = space_.basis() * hessian_.null_basis();
  for (const auto& column : all.colwise()) {
    NullDirection& direction = directions_.emplace_back();
    const double size = column.lpNorm<Eigen::Infinity>();
    for (Eigen::Index v = 0; v < column.size(); ++v)
      if (std::abs(column[v]) > 1e-12 * size) direction.emplace_back(static_cast<int>(v), column[v] / size);
  }
  return directions_;
}

void DenseKkt::direction_of(const NullDirection& direction, Eigen::VectorXd& x) {
  x.setZero(size_);
  for (const auto& [v, share] : direction)
    x[v] = share;
}

void DenseKkt::project(const Eigen::VectorXd& force, Eigen::VectorXd& left) {
  if (constraints().rank() == 0) {
    left = force;
    return;
  }
  const Eigen::MatrixXd& basis = constraints().basis();
  reduced_rhs_.noalias() = basis.transpose() * force;
  left.noalias() = basis * reduced_rhs_;
}

void DenseKkt::solve_to(double, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing,
                        Eigen::VectorXd& x, Eigen::VectorXd& lambda) {
  if (space_.rank() == 0) {
    hessian_.solve(rhs, x);
    lambda.setZero(rows_);
    return;
  }
  space_.solve(closing, range_step_);
  target_ = rhs;
  target_.noalias() -= matrix() * range_step_;
  const Eigen::MatrixXd& basis = space_.basis();
  reduced_rhs_.noalias() = basis.transpose() * target_;
  hessian_.solve(reduced_rhs_, reduced_step_);
  x = range_step_;
  x.noalias() += basis * reduced_step_;
  // Multipliers that balance what the step leaves: J^T lambda = rhs - K x.
  target_ = rhs;
  target_.noalias() -= matrix() * x;
  space_.multipliers(target_, lambda);
}

} // namespace flyball
