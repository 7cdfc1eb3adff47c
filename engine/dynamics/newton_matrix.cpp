#include "engine/dynamics/newton_matrix.hpp"

#include <limits>

namespace flyball {

bool NewtonMatrix::take_derivatives(Equations& equations, const double* y) {
  const System& system = equations.model().system;
  nq_ = system.nq;
  nv_ = system.nv;
  solver_ = &equations.solver();
  const bool taken = equations.linearise();
  rotations_.clear();
  scalars_.clear();
  for (const Link& link : system.links) {
    if (link.v < 0) continue;
    if (link.type != LinkType::spherical) {
      scalars_.push_back({link.q, link.v});
      continue;
    }
    Rotation r;
    r.q = link.q;
    r.v = link.v;
    const Vec3 w = Eigen::Map<const Vec3>(y + nq_ + link.v), d = Eigen::Map<const Vec3>(y + link.q + 1);
    const double scalar = y[link.q];
    r.by_position << 0, -w.transpose() / 2, w / 2, skew<double>(w) / 2;
    r.by_velocity << -d.transpose() / 2, (scalar * Mat3::Identity() - skew<double>(d)) / 2;
    r.tangent << -d, scalar * Mat3::Identity() + skew<double>(d);
    r.tangent *= 2 / (scalar * scalar + d.squaredNorm());
    rotations_.push_back(r);
  }
  turns_.resize(rotations_.size());
  return taken;
}

bool NewtonMatrix::take_quotients(const Rate& rate, const double* y, const double* rate_at_y,
                                  const Eigen::VectorXd& scale, int size) {
  solver_ = nullptr;
  perturbed_ = Eigen::Map<const Eigen::VectorXd>(y, size);
  const Eigen::Map<const Eigen::VectorXd> before(rate_at_y, size);
  rates_.resize(size);
  jacobian_.setZero(size, size);
  const double root = std::sqrt(std::numeric_limits<double>::epsilon());
  for (Eigen::Index j = 0; j < scale.size(); ++j) {
    const double kept = perturbed_[j];
    double step = root * std::max(std::abs(kept), scale[j]);
    perturbed_[j] = kept + step;
    step = perturbed_[j] - kept;
    if (!rate(perturbed_.data(), rates_.data())) {
      perturbed_[j] = kept - step;
      step = -step;
      if (!rate(perturbed_.data(), rates_.data())) return false;
    }
    jacobian_.col(j) = (rates_ - before) / step;
    perturbed_[j] = kept;
  }
  return jacobian_.allFinite();
}

bool NewtonMatrix::factor(double gamma) {
  gamma_ = gamma;
  if (!solver_) {
    Eigen::MatrixXd matrix = -gamma * jacobian_;
    matrix.diagonal().array() += 1;
    return matrix.size() == 0 || factors_.compute(matrix);
  }
  for (std::size_t i = 0; i < rotations_.size(); ++i) {
    Rotation& r = rotations_[i];
    const double turned = gamma * gamma * r.by_position.col(0).squaredNorm(); // |gamma w / 2|^2
    r.inverse = (Eigen::Matrix4d::Identity() + gamma * r.by_position) / (1 + turned);
    turns_[i] = r.tangent * r.inverse * r.by_velocity;
  }
  return solver_->factor_step(gamma, turns_);
}

void NewtonMatrix::solve(double* b) {
  if (!solver_) {
    Eigen::Map<Eigen::VectorXd> all(b, jacobian_.rows());
    all = factors_.solve(all);
    return;
  }
  step_.resize(nv_);
  for (const Scalar& x : scalars_)
    step_[x.v] = b[x.q];
  for (const Rotation& r : rotations_) {
    Eigen::Map<Eigen::Vector4d> d(b + r.q);
    d = (r.inverse * d).eval();
    step_.segment<3>(r.v) = r.tangent * d;
  }
  Eigen::Map<Eigen::VectorXd> s(b + nq_, nv_);
  s_ = s;
  solver_->solve_step(step_, s_);
  s = s_;
  for (const Scalar& x : scalars_)
    b[x.q] += gamma_ * s[x.v];
  for (const Rotation& r : rotations_)
    Eigen::Map<Eigen::Vector4d>(b + r.q) += gamma_ * (r.inverse * (r.by_velocity * s.segment<3>(r.v)));
}

} // namespace flyball
