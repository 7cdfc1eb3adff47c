#include "engine/system/joint_coordinates.hpp"

#include "engine/system/rotation_vector.hpp"

#include <numbers>

namespace flyball {
namespace {

template <class N>
Vec3T<N> any_perpendicular(const Vec3T<N>& z) {
  Eigen::Index least = 0;
  z.template cast<double>().cwiseAbs().minCoeff(&least);
  return z.cross(Vec3T<N>::Unit(least)).normalized();
}

// How far `to` is turned from `from` about the unit vector `axis`, both projected on its plane.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to) - axis.dot(from) * axis.dot(to));
}

} // namespace

double wrapped_angle(double angle) {
  const double turn = 2 * std::numbers::pi;
  angle = std::remainder(angle, turn);
  return angle <= -std::numbers::pi ? angle + turn : angle;
}

template <class N>
BasicJointFrame<N> joint_frame(const Joint& joint, const NumberReader<N>& read) {
  using Vector = Vec3T<N>;
  BasicJointFrame<N> frame;
  for (std::size_t i = 0; i < joint.coordinates.size() && i < frame.drawn.size(); ++i)
    frame.drawn[i] = read(joint.coordinates[i].drawn);
  if (joint.type == JointType::free) {
    frame.axes = {Vector::UnitX(), Vector::UnitY(), Vector::UnitZ(), Vector::Zero()};
    return frame;
  }
  const Vector z = has_axis(joint.type) ? Vector(read(joint.axis).normalized()) : Vector(Vector::UnitZ());
  Vector x;
  if (joint.type == JointType::planar) {
    const Vector axis2 = read(joint.axis2);
    x = (axis2 - z * z.dot(axis2)).normalized();
  } else {
    x = any_perpendicular<N>(z);
  }
  frame.axes = {x, z.cross(x), z, Vector::Zero()};
  if (joint.type == JointType::universal) frame.axes[3] = read(joint.axis2).normalized();
  return frame;
}

template JointFrame joint_frame<double>(const Joint&, const NumberReader<double>&);
template BasicJointFrame<Dual> joint_frame<Dual>(const Joint&, const NumberReader<Dual>&);

JointCoordinates joint_coordinates(JointType type, const JointFrame& frame, const Mat3& turn,
                                   const Vec3& shift) {
  const Vec3 &x = frame.axes[0], &y = frame.axes[1], &z = frame.axes[2], &second = frame.axes[3];
  JointCoordinates out;
  const auto slide = [&](int i, const Vec3& axis) {
    const auto k = static_cast<std::size_t>(i);
    out.value[k] = frame.drawn[k] + axis.dot(shift);
    out.rate.row(i).tail<3>() = axis;
  };
  const auto angle = [&](int i, double turned, const Vec3& rate) {
    const auto k = static_cast<std::size_t>(i);
    out.value[k] = wrapped_angle(frame.drawn[k] + turned);
    out.rate.row(i).head<3>() = rate;
  };
  // Of the two axes across together, so that neither's rounding decides.
  const auto about_axis = [&] {
    const Vec3 tx = turn * x, ty = turn * y;
    return std::atan2(y.dot(tx) - x.dot(ty), x.dot(tx) + y.dot(ty));
  };
  const auto rotation = [&](int first) {
    const auto k = static_cast<std::size_t>(first);
    const Quat drawn = exp_rotation<double>({frame.drawn[k], frame.drawn[k + 1], frame.drawn[k + 2]});
    const Vec3 r = log_rotation<double>((Quat(turn) * drawn).normalized());
    for (int i = 0; i < 3; ++i)
      out.value[k + static_cast<std::size_t>(i)] = r[i];
    out.rate.block<3, 3>(first, 0) = inverse_left_jacobian<double>(r);
  };
  switch (type) {
  case JointType::revolute: angle(0, about_axis(), z); break;
  case JointType::prismatic: slide(0, z); break;
  case JointType::cylindrical:
    angle(0, about_axis(), z);
    slide(1, z);
    break;
  case JointType::universal: { // w = z q_0' + u q_1' with u the second axis as the child carries it
    const Vec3 u = turn * second;
    const double c = z.dot(u), across = 1 - c * c;
    angle(0, angle_about(z, second, u), (z - c * u) / across);
    angle(1, angle_about(second, turn.transpose() * z, z), (u - c * z) / across);
    break;
  }
  case JointType::spherical: rotation(0); break;
  case JointType::planar:
    slide(0, x);
    slide(1, y);
    angle(2, about_axis(), z);
    break;
  case JointType::free:
    slide(0, x);
    slide(1, y);
    slide(2, z);
    rotation(3);
    break;
  case JointType::fixed:
  case JointType::distance:
  case JointType::gear: break;
  }
  return out;
}

JointCoordinates joint_coordinates(const CutJoint& cut, const CutParameters& p, const Kinematics<double>& k) {
  const Mat3 parent = k.at(cut.ends.a).R.transpose();
  return joint_coordinates(cut.type, {p.frame, p.drawn}, parent * k.at(cut.ends.b).R,
                           parent * (k.point(cut.ends.b, p.b) - k.point(cut.ends.a, p.a)));
}

RelativeVelocity relative_velocity(const CutJoint& cut, const CutParameters& p, const Kinematics<double>& k) {
  const Mat3 parent = k.at(cut.ends.a).R.transpose();
  const Vec3 at = k.point(cut.ends.b, p.b);
  RelativeVelocity out;
  out << parent * (k.at(cut.ends.b).w - k.at(cut.ends.a).w),
      parent * (k.velocity(cut.ends.b, at) - k.velocity(cut.ends.a, at));
  return out;
}

RelativeVelocity relative_velocity(const CutJoint& cut, const CutParameters& p, const Kinematics<double>& k,
                                   const SupportColumn& column) {
  const Mat3 parent = k.at(cut.ends.a).R.transpose() * (column.second ? 1. : -1.);
  const Column<double>& c = k.columns[static_cast<std::size_t>(column.v)];
  RelativeVelocity out;
  out << parent * c.turn(), parent * c.at(k.point(cut.ends.b, p.b));
  return out;
}

} // namespace flyball
