#include "engine/dynamics/sparse_motion.hpp"

#include "engine/kkt/kkt_system.hpp"

namespace flyball {
namespace {

constexpr double enough = 1e-11;      // of the terms of each equation
constexpr double independent = 1e-10; // of a row of the constraints, its pivot with the metric

} // namespace

SparseMotion::SparseMotion(const MotionModel& model)
    : model_(model), system_(model.released), n_(model.system.nv), step_(model) {
  zero_lambda_.setZero(system_.rows);
}

bool SparseMotion::analyse(const MotionPoint& point) {
  if (!factor(point)) return false;
  expected_size_ = bodies_.pattern().size;
  redundant_ = mass_.nullity();
  return find_still(point) && (redundant_ == 0 || all_singular_are_rows(point));
}

// What is singular are multipliers of redundant rows alone, not motions without mass: then any force is in
// balance with what it accelerates.
bool SparseMotion::all_singular_are_rows(const MotionPoint& point) {
  force_.resize(n_);
  for (int v = 0; v < n_; ++v)
    force_[v] = std::sin(1.3 * v * v + 0.7);
  for (const int v : still_)
    force_[v] = 0;
  closing_.setZero(system_.rows);
  solve(force_, closing_, scaled_a_, scaled_lambda_);
  return step_.linearise(point, zero_lambda_) &&
         step_.imbalance(scaled_a_, scaled_lambda_, force_) < 1e-6; // where a motion has no mass, about one
}

// What has neither mass nor constraint: the turns of point masses as a rule. False where forces act on it.
bool SparseMotion::find_still(const MotionPoint& point) {
  still_.clear();
  const std::vector<bool>& free = bodies_.unconstrained();
  for (std::size_t u = 0; u < free.size(); ++u) {
    if (!free[u]) continue;
    const BodyNode& x = bodies_.nodes()[static_cast<int>(u / 6)];
    for (int c = 0; c < x.columns; ++c)
      if (x.d(static_cast<Eigen::Index>(u % 6), c) != 0) still_.push_back(x.v[static_cast<std::size_t>(c)]);
  }
  return still_.empty() || step_.nothing_acts(point, still_, free);
}

bool SparseMotion::structure_changed() const {
  return mass_.nullity() > redundant_ || bodies_.pattern().size != expected_size_;
}

bool SparseMotion::factor(const MotionPoint& point) {
  at_.q = point.q;
  bodies_.assemble_motion(model_.problem(), at_, point.kinematics, residual_, magnitudes_,
                          {.mass = 1, .velocity = 0, .stiffness = 0});
  const std::vector<double>& values = bodies_.sum(1, 0);
  for (const double value : values)
    if (!std::isfinite(value)) return false;
  mass_.factor(bodies_.pattern(), values, KktSystem::zero);
  return true;
}

void SparseMotion::solve(const Eigen::VectorXd& force, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                         Eigen::VectorXd& lambda) {
  x.setZero(n_);
  lambda.setZero(system_.rows);
  bodies_.assemble_rhs(force, closing, reduced_);
  if (reduced_.size() > 0) mass_.solve(reduced_, enough);
  bodies_.extract_solution(reduced_, x, lambda);
  for (const int v : still_)
    x[v] = 0;
}

bool SparseMotion::accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) {
  const Scaling& scaling = model_.scaling;
  evaluate_residual<double>(system_, point.parameters, point.q, zero_lambda_, point.kinematics, residual_);
  add_coordinate_damping(system_, point.parameters, point.q, point.u, residual_.f);
  constraint_accelerations(system_, point.parameters, point.kinematics, point.carried, bias_);
  force_ = -residual_.f.head(n_).cwiseProduct(scaling.column);
  closing_ = -bias_.cwiseProduct(scaling.row);
  solve(force_, closing_, scaled_a_, scaled_lambda_);
  a = scaled_a_.cwiseProduct(scaling.column);
  lambda = scaled_lambda_.cwiseProduct(scaling.row);
  if (!a.allFinite() || !lambda.allFinite()) return false;
  if (model_.system.drives.empty()) return true;
  all_a_.setZero(system_.nv);
  all_a_.head(n_) = a;
  move(system_, point.parameters, {point.q, point.u, nullptr, &all_a_}, accelerated_, carried_);
  evaluate_residual<double>(system_, point.parameters, point.q, lambda, accelerated_, loaded_);
  add_coordinate_damping(system_, point.parameters, point.q, point.u, loaded_.f);
  drive_forces_ = loaded_.f.tail(system_.nv - n_);
  return true;
}

double SparseMotion::drive_force(int drive) const {
  return drive_forces_[drive];
}

std::string SparseMotion::unsolved() const {
  return "the numbers overflow, or the mass matrix is singular to rounding";
}

bool SparseMotion::linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) {
  return step_.linearise(point, lambda);
}

bool SparseMotion::factor_step(double gamma, const std::vector<Mat3>&) {
  step_.factor(gamma);
  return step_.nullity() <= redundant_ && step_.size() == expected_size_;
}

void SparseMotion::solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) {
  step_.solve(b_q, s);
  for (const int v : still_)
    s[v] = 0;
}

void SparseMotion::correct_velocity(const MotionPoint& point, const Eigen::VectorXd& rates,
                                    const std::vector<Vec6>* momenta, Eigen::VectorXd& change) {
  const Scaling& scaling = model_.scaling;
  force_.setZero(n_);
  if (momenta) {
    std::vector<Vec6> beyond = *momenta;
    for (std::size_t l = beyond.size(); l-- > 0;) {
      const Link& link = model_.system.links[l];
      const Vec3& origin = point.kinematics.links[l].o;
      for (int c = 0; link.v >= 0 && c < (link.type == LinkType::spherical ? 3 : 1); ++c) {
        const Column<double>& x = point.kinematics.columns[static_cast<std::size_t>(link.v + c)];
        force_[link.v + c] = -scaling.column[link.v + c] *
                             (x.turn().dot(beyond[l].head<3>()) + x.at(origin).dot(beyond[l].tail<3>()));
      }
      if (link.parent < 0) continue;
      const auto parent = static_cast<std::size_t>(link.parent);
      beyond[parent] += about(beyond[l], origin - point.kinematics.links[parent].o);
    }
  }
  closing_ = -rates.cwiseProduct(scaling.row);
  solve(force_, closing_, scaled_a_, scaled_lambda_);
  change = scaled_a_.cwiseProduct(scaling.column);
}

void SparseMotion::factor_constraints(const MotionPoint& point) {
  constraints_.factor(model_.problem(), point.kinematics, independent, BodyEntries::Zeros::kept);
}

void SparseMotion::close(const Eigen::VectorXd& closing, Eigen::VectorXd& step) {
  force_.setZero(n_);
  constraints_.solve(force_, closing, step, unused_);
}

} // namespace flyball
