#include "engine/dynamics/sparse_step.hpp"

#include "engine/kkt/kkt_system.hpp"
#include "engine/linear/largest.hpp"

namespace flyball {
namespace {

constexpr double no_force_in_step = 1e-8; // of the terms it is made of
constexpr double enough_for_step =
    1e-6; // of the terms of each equation: Newton's iteration corrects the rest

} // namespace

SparseStep::SparseStep(const MotionModel& model) : model_(model) {
  none_.setZero(model.released.rows);
}

void SparseStep::take_in(const MotionPoint& point, const Eigen::VectorXd& lambda) {
  const System& system = model_.released;
  at_.q = point.q;
  at_.lambda = lambda;
  kinematics_ = point.kinematics;
  evaluate_residual<double>(system, point.parameters, point.q, at_.lambda, kinematics_, residual_);
  evaluate_magnitudes(system, point.parameters, point.q, at_.lambda, kinematics_, magnitudes_);
}

void SparseStep::assemble(double velocity, double stiffness) {
  bodies_.assemble_motion(model_.problem(), at_, kinematics_, residual_, magnitudes_,
                          {.mass = 1, .velocity = velocity, .stiffness = stiffness});
}

bool SparseStep::linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) {
  take_in(point, lambda.size() == none_.size() ? lambda : none_);
  products_.linearize(model_.problem(), at_, kinematics_, residual_);
  return residual_.f.allFinite();
}

bool SparseStep::nothing_acts(const MotionPoint& point, const std::vector<int>& coordinates,
                              const std::vector<bool>& unconstrained) {
  take_in(point, none_);
  for (const int v : coordinates)
    if (std::abs(residual_.f[v]) > no_force_in_step * magnitudes_.force[v]) return false;
  assemble(1, 1);
  return bodies_.unconstrained() == unconstrained;
}

double SparseStep::imbalance(const Eigen::VectorXd& x, const Eigen::VectorXd& lambda,
                             const Eigen::VectorXd& force) {
  products_.mass(x, product_);
  products_.constraint_transposed(lambda, force_);
  return largest_size(product_ + force_ - force);
}

void SparseStep::factor(double gamma) {
  gamma_ = gamma;
  assemble(gamma, gamma * gamma);
  factors_.factor(bodies_.pattern(), bodies_.sum(1, 0), KktSystem::zero);
}

// With ds = b_s + z the constraints hold z: (M + gamma C + gamma^2 K) z + J^T mu = -gamma C b_s - K (gamma^2
// b_s + gamma b_q), J z = 0.
void SparseStep::solve(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) {
  const Eigen::VectorXd& column = model_.scaling.column;
  scaled_ = s.cwiseQuotient(column);
  products_.velocity(scaled_, product_);
  force_ = -gamma_ * product_;
  scaled_ = gamma_ * (gamma_ * scaled_ + b_q.cwiseQuotient(column));
  products_.stiffness(scaled_, product_);
  force_ -= product_;
  bodies_.assemble_rhs(force_, none_, reduced_);
  if (reduced_.size() > 0) factors_.solve(reduced_, enough_for_step);
  change_.setZero(s.size());
  bodies_.extract_solution(reduced_, change_);
  s += change_.cwiseProduct(column);
}

} // namespace flyball
