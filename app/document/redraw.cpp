#include "app/document/redraw.hpp"

#include "app/document/coordinate_image.hpp"
#include "app/document/drawn_size.hpp"
#include "app/document/image.hpp"
#include "engine/mechanism/bearing_axes.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// What rounding leaves of no motion, in radians and in parts of the mechanism's size.
constexpr double no_motion = 1e-11;

// Where a body has gone; nothing where it has stayed.
std::optional<Isometry> motion_of(const Body& body, const Pose& pose, double size) {
  const Quat turn = (pose.rotation * body.rotation.normalized().conjugate()).normalized();
  const bool turned = 2 * turn.vec().norm() > no_motion;
  if (!turned && (pose.position - body.position).norm() <= no_motion * size) return {};
  Isometry motion;
  if (turned) motion.linear = turn.toRotationMatrix();
  motion.shift = pose.position - motion.linear * body.position;
  return motion;
}

class Redraw {
 public:
  Redraw(const Mechanism& mechanism, const MechanismPose& pose) : before_(mechanism), pose_(pose) {
    out_.mechanism = mechanism;
    const double size = drawn_size(mechanism);
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b)
      motions_.push_back(motion_of(mechanism.bodies[b], pose.bodies[b], size));
  }

  bool moves() const {
    return std::ranges::any_of(motions_, [](const auto& motion) { return motion.has_value(); });
  }

  Redrawn run() {
    for (std::size_t b = 0; b < before_.bodies.size(); ++b)
      if (motions_[b]) out_.mechanism.bodies[b] = image_of(before_.bodies[b], *motions_[b]);
    for (Force& force : out_.mechanism.forces)
      carry(force);
    for (std::size_t j = 0; j < before_.joints.size(); ++j)
      carry(out_.mechanism.joints[j], pose_.coordinates[j]);
    return std::move(out_);
  }

 private:
  const Isometry* motion(const std::string& body) const {
    const int b = body_index(before_, body);
    if (b < 0 || !motions_[static_cast<std::size_t>(b)]) return nullptr;
    return &*motions_[static_cast<std::size_t>(b)];
  }

  void carry_point(const std::string& body, Vec3& point) const {
    if (const Isometry* by = motion(body)) point = by->point(point);
  }
  void carry_axis(const std::string& body, Vec3& axis) const {
    if (const Isometry* by = motion(body)) axis = by->vector(axis);
  }
  void carry_ends(const std::array<std::string, 2>& bodies, std::array<Vec3, 2>& points) const {
    for (std::size_t end = 0; end < 2; ++end)
      carry_point(bodies[end], points[end]);
  }

  // Whether x of a bearing changes.
  bool moves_in(const Force& bearing) const {
    Vec3 in_first = bearing.at.value_or(Vec3::Zero()), in_second = in_first;
    carry_point(bearing.bodies[0], in_first);
    carry_point(bearing.bodies[1], in_second);
    const Mat3 axes = bearing_axes(bearing);
    Vec3 shift = in_second - in_first;
    Mat3 first = Mat3::Identity(), second = first;
    if (const Isometry* by = motion(bearing.bodies[0])) first = by->linear;
    if (const Isometry* by = motion(bearing.bodies[1])) second = by->linear;
    shift = axes.transpose() * (first.transpose() * shift);
    if (bearing_size(bearing) == 2) return shift.head<2>().norm() > no_motion * drawn_size(before_);
    return shift.norm() > no_motion * drawn_size(before_) || (first - second).norm() > no_motion;
  }

  void carry(Force& force) {
    if (force.type == ForceType::spring) {
      // What is left to the drawn distance is that of the pose in which it was so left.
      const double length = drawn_distance(force.points);
      carry_ends(force.bodies, force.points);
      if (!force.free_length && std::abs(drawn_distance(force.points) - length) > no_motion * length)
        force.free_length = length;
      return;
    }
    if (force.type == ForceType::bearing) { // of which the first body keeps the axes
      if (!force.bearing_stiffness.empty() && moves_in(force)) out_.slack_elsewhere.push_back(force.name);
      if (force.at) carry_point(force.bodies[1], *force.at);
      carry_axis(force.bodies[0], force.axis);
      if (force.x_axis) carry_axis(force.bodies[0], *force.x_axis);
      return;
    }
    if (force.at) carry_point(force.body, *force.at);
    if (force.type == ForceType::vane)
      if (const Isometry* by = motion(force.body)) turn_vane(force, *by);
  }

  void carry(Joint& joint, const std::array<double, 6>& labels) {
    const auto &parent = joint.bodies[0], &child = joint.bodies[1];
    switch (joint.type) {
    case JointType::gear: return;
    case JointType::distance: carry_ends(joint.bodies, joint.points); return;
    case JointType::universal: carry_axis(child, joint.axis2); break;
    case JointType::planar: carry_axis(parent, joint.axis2); break;
    default: break;
    }
    // Slides start from the child's point.
    carry_point(child, joint.at);
    if (has_axis(joint.type)) carry_axis(parent, joint.axis);
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      label(joint.coordinates[i], labels[i], is_angle(joint.type, static_cast<int>(i)));
    if (joint.type == JointType::spherical || joint.type == JointType::free)
      if (const Isometry* by = motion(parent)) turn_axes(joint, *by);
  }

  // Digits that only rounding would change stay as they were typed.
  static void label(Coordinate& coordinate, double value, bool angle) {
    const double least = no_motion * (angle ? 1 : std::max(std::abs(coordinate.drawn), 1e-3));
    if (std::abs(value - coordinate.drawn) > least) coordinate.drawn = value + 0.0;
  }

  void turn_axes(Joint& joint, const Isometry& by) {
    const Isometry turn{by.linear, Vec3::Zero()};
    const std::vector<CoordinateImage> images = images_of_coordinates(joint.type, turn);
    if (!acts_alike(joint, images)) out_.along_other_axes.push_back(joint.name);
    joint.coordinates = image_of(joint.coordinates, joint.type, turn);
    follow_coordinates(out_.mechanism, joint, images);
  }

  // Along all axes that are mixed, each triple of components by itself.
  static bool acts_alike(const Joint& joint, const std::vector<CoordinateImage>& images) {
    for (std::size_t first = 0; first < images.size(); first += 3) {
      const Coordinate* other = nullptr;
      for (std::size_t i = first; i < first + 3; ++i) {
        if (!images[i].mixed) continue;
        const Coordinate& c = joint.coordinates[i];
        if (c.stop || c.damping_force || (c.spring && c.spring->force)) return false;
        if (other && (c.damping != other->damping || c.drive.has_value() != other->drive.has_value() ||
                      stiffness(c) != stiffness(*other)))
          return false;
        other = &c;
      }
    }
    return true;
  }
  static double stiffness(const Coordinate& c) { return c.spring ? c.spring->stiffness : 0; }

  const Mechanism& before_;
  const MechanismPose& pose_;
  std::vector<std::optional<Isometry>> motions_; // by body
  Redrawn out_;
};

} // namespace

Redrawn redrawn(const Mechanism& mechanism, const MechanismPose& pose) {
  return Redraw(mechanism, pose).run();
}

bool is_drawn_in(const Mechanism& mechanism, const MechanismPose& pose) {
  return !Redraw(mechanism, pose).moves();
}

} // namespace flyball
