#include "engine/dynamics/tree_motion.hpp"

namespace flyball {

TreeMotion::TreeMotion(const MotionModel& model) : model_(model), bodies_(model.released, model.system.nv) {
  if (!has_pairs(model.system))
    elimination_.emplace(model.released, model.system.nv);
  else
    step_.emplace(model);
}

bool TreeMotion::factor(const MotionPoint& point) {
  return bodies_.factor(point.parameters, point.kinematics);
}

bool TreeMotion::accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) {
  set_body_wrenches(model_.released, point.parameters, point.kinematics, wrenches_);
  set_coordinate_forces(model_.released, point, force_);
  add_pair_forces(model_.released, point.parameters, point.kinematics, force_);
  a.resize(model_.system.nv);
  lambda.resize(0);
  bodies_.solve(wrenches_, force_, a);
  drive_forces_.clear();
  for (const DrivenCoordinate& d : model_.system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    const Link& link = model_.released.links[l];
    const Vec6 wrench = bodies_.transmitted(l, wrenches_);
    const Vec3& axis = point.kinematics.links[l].axis;
    drive_forces_.push_back(axis.dot(wrench.segment<3>(link.type == LinkType::revolute ? 0 : 3)) +
                            force_[link.v]);
  }
  return a.allFinite();
}

std::string TreeMotion::unsolved() const {
  return bodies_.overflowed() ? "the numbers overflow" : "the mass matrix is singular to rounding";
}

bool TreeMotion::linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) {
  return step_ ? step_->linearise(point, lambda) : elimination_->linearise(point);
}

bool TreeMotion::factor_step(double gamma, const std::vector<Mat3>& turns) {
  if (!step_) return elimination_->factor(gamma, turns);
  step_->factor(gamma);
  return step_->nullity() == 0;
}

void TreeMotion::solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) {
  if (step_)
    step_->solve(b_q, s);
  else
    elimination_->solve(b_q, s);
}

} // namespace flyball
