#include "engine/study/motion_outputs.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/joint_coordinates.hpp"

#include <numbers>

namespace flyball {

MotionOutputs::MotionOutputs(const MotionModel& model, std::span<const std::string> addresses,
                             std::size_t count, bool accelerated)
    : model_(model), count_(count), accelerated_(accelerated), varied_(model.mechanism),
      numbers_(varied_, addresses) {
  for (const std::string& address : addresses)
    set_.push_back(get_parameter(varied_, address));
  coordinates_.resize(model.system.reported.size());
  rates_.resize(coordinates_.size());
  measures_.bind(varied_, model.system, model.parameters);
}

Eigen::VectorXd MotionOutputs::evaluate(const MotionOfAll& at, const Parameters& p) {
  const System& system = model_.system;
  move(model_.released, p, {at.q, at.u, nullptr, &at.a}, kinematics_, carried_);
  for (std::size_t i = 0; i < system.reported.size(); ++i) {
    const ReportedCoordinate& r = system.reported[i];
    if (r.cut >= 0) {
      const CutJoint& cut = system.cuts[static_cast<std::size_t>(r.cut)];
      const CutParameters& numbers = p.cuts[static_cast<std::size_t>(r.cut)];
      const JointCoordinates joint = joint_coordinates(cut, numbers, kinematics_);
      coordinates_[i] = joint.value[static_cast<std::size_t>(r.index)];
      rates_[i] = joint.rate.row(r.index) * relative_velocity(cut, numbers, kinematics_);
      if (i < near_.size() && r.angle && !is_rotation_vector(cut.type, r.index))
        coordinates_[i] = near_[i] + std::remainder(coordinates_[i] - near_[i], 2 * std::numbers::pi);
      continue;
    }
    const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(r.coordinate)];
    const Link& link = model_.released.links[static_cast<std::size_t>(c.link)];
    const LinkParameters& l = p.links[static_cast<std::size_t>(c.link)];
    if (link.type == LinkType::spherical) {
      const int k = c.index - link.coordinate;
      coordinates_[i] = rotation_vector<double>(link, l, at.q)[k];
      rates_[i] = rotation_vector_rate(link, l, at.q).row(k) * at.u.segment<3>(link.v);
    } else {
      coordinates_[i] = at.q[link.q];
      rates_[i] = at.u[link.v];
    }
  }
  TransmittedForces forces;
  if (measures_.needs_forces()) {
    const Eigen::VectorXd q = at.q.head(system.nq);
    evaluate_residual<double>(system, p, q, at.lambda, kinematics_, residual_);
    forces = transmitted_forces(system, p, at.lambda, kinematics_, residual_);
  }
  torques_.clear();
  for (std::size_t i = 0; i < system.torques.size(); ++i)
    torques_.push_back(drive_torque(model_.released, p, i, at.q, kinematics_));
  const MeasuredState state{system,       p,      at.q,    kinematics_, &forces, accelerated_,
                            coordinates_, rates_, torques_};
  return measures_.evaluate(state).tail(static_cast<Eigen::Index>(count_));
}

Eigen::VectorXd MotionOutputs::values(const MotionOfAll& at) {
  near_.clear();
  Eigen::VectorXd out = evaluate(at, model_.parameters);
  near_ = coordinates_;
  return out;
}

MotionOutputs::Rates MotionOutputs::along(const MotionOfAll& at, const MotionDirection& direction) {
  const Eigen::VectorXd here = values(at); // and for whole turns
  MotionOfAll moved;
  const auto beside = [&](double step) {
    moved.q = at.q;
    retract<double>(model_.released, Eigen::VectorXd(step * direction.q), moved.q);
    moved.u = at.u + step * direction.u;
    moved.a = at.a + step * direction.a;
    moved.lambda = at.lambda + step * direction.lambda;
    if (direction.number < 0) return evaluate(moved, model_.parameters);
    double& number = set_[static_cast<std::size_t>(direction.number)];
    const double before = number;
    number += step * direction.change;
    numbers_.set(set_);
    bind_motion(model_.system, varied_, parameters_);
    measures_.bind(varied_, model_.system, parameters_);
    Eigen::VectorXd out = evaluate(moved, parameters_);
    number = before;
    numbers_.set(set_);
    measures_.bind(varied_, model_.system, model_.parameters);
    return out;
  };
  // And how the slope changes over twice the step: in its proportion, but on a kink, and as one over it where
  // it is rounding.
  Eigen::VectorXd bend;
  const auto difference = [&](double step) {
    const Eigen::VectorXd forth = beside(step), back = beside(-step);
    bend = (forth + back - 2 * here) / (2 * step);
    return Eigen::VectorXd((forth - back) / (2 * step));
  };
  // Smaller ones where a curve is sharp, as the size of a vector that nearly vanishes, or of a force that is
  // far larger off the balance.
  constexpr double good = 1e-10;
  constexpr double steps[] = {4e-3, 4e-4, 4e-5, 4e-6};
  Rates out;
  bool straight = true; // the slope changes less and less
  for (const double h : steps) {
    const Eigen::VectorXd d1 = difference(h), wide = bend.cwiseAbs(), d2 = difference(h / 2),
                          d3 = difference(h / 4);
    const Eigen::VectorXd once = (4 * d2 - d1) / 3, twice = (4 * d3 - d2) / 3,
                          last = twice + (twice - once) / 15;
    // Each half of a step shall change a quarter of what the one before did. Where it is more, as beside a
    // kink and by rounding, there is nothing to extrapolate.
    const Eigen::ArrayXd first = (d2 - d1).array().abs(), second = (d3 - d2).array().abs();
    const Eigen::VectorXd changed =
        (last - twice).array().abs().max((3 * second > first).select(second / 2, 0.));
    if (out.value.size() == 0) {
      out = {last, changed, wide};
      straight = (bend.array().abs() <= wide.array() / 2).all();
    } else {
      for (Eigen::Index i = 0; i < last.size(); ++i)
        if (changed[i] < out.error[i]) {
          out.value[i] = last[i];
          out.error[i] = changed[i];
        }
    }
    if ((out.error.array() <= good * out.value.array().abs()).all()) break;
  }
  if (straight) {
    out.kink.setZero();
    return out;
  }
  // A kink's is the same over each of them. Where it falls with the step, and rises again by rounding, it may
  // be as large over the longest as over the shortest, but not between; and all of it is rounding where as
  // much is left over steps within which nothing bends.
  difference(steps[1]);
  const Eigen::VectorXd between = bend.cwiseAbs();
  Eigen::VectorXd rounding = Eigen::VectorXd::Zero(bend.size()); // over the last of the steps
  for (const double h : {3e-8, 2e-8, 1e-8}) {
    difference(h);
    rounding = rounding.cwiseMax(bend.cwiseAbs() * (h / steps[2]));
  }
  difference(steps[2]);
  for (Eigen::Index i = 0; i < bend.size(); ++i) {
    const double near = std::abs(bend[i]), far = out.kink[i];
    const bool same = near > far / 4 && near < 4 * far && between[i] > near / 1.6 && between[i] < 1.6 * near;
    if (!same || near < 16 * rounding[i]) out.kink[i] = 0;
  }
  return out;
}

} // namespace flyball
