#include "app/document/image.hpp"

#include "app/document/coordinate_image.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/bearing_axes.hpp"
#include "engine/mechanism/force_law.hpp"

#include <algorithm>
#include <array>

namespace flyball {
namespace {

Quat tidy(const Quat& q) {
  const Quat unit = q.normalized();
  const double sign = unit.w() < 0 ? -1 : 1;
  return Quat(
      Eigen::Vector4d(unit.coeffs().unaryExpr([&](double x) { return without_round_off(sign * x); })));
}

// Without round-off where nothing turns.
Quat turned(const Mat3& rotation, const Quat& q) {
  return rotation.isIdentity(0) ? q : tidy(Quat(rotation) * q);
}

// Axes of a body's image: a right-handed frame even where the isometry is a reflection. Then the body axis
// nearest to the plane's normal is turned round in it, so that a body with the world's axes keeps them.
struct FrameImage {
  Quat rotation = Quat::Identity();
  Vec3 signs = Vec3::Ones(); // of a vector's image in the new axes, by the vector in the old ones
};
FrameImage image_of_frame(const Quat& rotation, const Isometry& isometry) {
  if (isometry.sense() > 0) return {turned(isometry.linear, rotation), Vec3::Ones()};
  const Mat3 axes = rotation.normalized().toRotationMatrix();
  // A tie goes to the first, here and in the image of the image.
  constexpr double tie = 1e-9;
  int nearest = 0;
  const auto turn = [&](int i) { return axes.col(i).dot(isometry.linear * axes.col(i)); };
  for (int i = 1; i < 3; ++i)
    if (turn(i) < turn(nearest) - tie) nearest = i;
  const Vec3 axis = axes.col(nearest);
  const Mat3 flip = Mat3::Identity() - 2 * axis * axis.transpose();
  FrameImage image{turned(isometry.linear * flip, rotation), Vec3::Ones()};
  image.signs[nearest] = -1;
  return image;
}

} // namespace

Body image_of(const Body& body, const Isometry& isometry) {
  Body image = body;
  image.position = isometry.point(body.position);
  const FrameImage frame = image_of_frame(body.rotation, isometry);
  image.rotation = frame.rotation;
  const Vec3& s = frame.signs;
  const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
  image.inertia = {xx, yy, zz, s.x() * s.y() * xy + 0.0, s.x() * s.z() * xz + 0.0, s.y() * s.z() * yz + 0.0};
  for (Shape& shape : image.shapes) {
    if (shape.at) shape.at = isometry.point(*shape.at);
    if (shape.type != ShapeType::cylinder && shape.type != ShapeType::capsule) continue;
    shape.from = isometry.point(shape.from);
    shape.to = isometry.point(shape.to);
  }
  return image;
}

namespace {

// Where the coordinate is turned round its law gives at every place what it gave at the opposite one.
std::string law_image(const std::string& text, std::string_view variable, double sign) {
  if (sign > 0) return text;
  return "-(" + renamed_in(text, variable, "(-" + std::string(variable) + ")") + ")";
}

// Laws of springs and dampers go with their coordinates.
void move_laws(const Joint& joint, const Isometry& isometry, Joint& image) {
  const std::vector<CoordinateImage> images = images_of_coordinates(joint.type, isometry);
  for (std::size_t i = 0; i < images.size() && i < joint.coordinates.size(); ++i) {
    const auto move = [&](const Formula* law, std::string_view part, std::string_view rest,
                          std::string_view variable) {
      if (!law) return;
      Formula& moved = image.formulas[static_cast<std::size_t>(law - joint.formulas.data())];
      moved.key = coordinate_key(joint, images[i].index, part) + std::string(rest);
      moved.text = law_image(law->text, variable, images[i].sign);
    };
    move(spring_law(joint, static_cast<int>(i)), "spring", ".force", spring_variable);
    move(damper_law(joint, static_cast<int>(i)), "damping_force", "", damper_variable);
  }
  std::ranges::sort(image.formulas, {}, &Formula::key);
}

} // namespace

Joint image_of(const Joint& joint, const Isometry& isometry) {
  Joint image = joint;
  image.coordinates = image_of(joint.coordinates, joint.type, isometry);
  if (!joint.formulas.empty()) move_laws(joint, isometry, image);
  if (has_at(joint.type)) image.at = isometry.point(joint.at);
  switch (joint.type) {
  case JointType::revolute: image.axis = isometry.axial(joint.axis); break;
  case JointType::prismatic:
  case JointType::cylindrical: image.axis = isometry.vector(joint.axis); break;
  case JointType::universal:
    image.axis = isometry.axial(joint.axis);
    image.axis2 = isometry.axial(joint.axis2);
    break;
  case JointType::planar: // the second in-plane axis is normal x x_axis, a vector as it should be
    image.axis = isometry.axial(joint.axis);
    image.axis2 = isometry.vector(joint.axis2);
    break;
  case JointType::distance:
    for (Vec3& point : image.points)
      point = isometry.point(point);
    break;
  case JointType::spherical:
  case JointType::free:
  case JointType::fixed:
  case JointType::gear: break;
  }
  return image;
}

namespace {

// Of a mirrored bearing x and z are the images, y is what makes them right-handed: shifts along y and turns
// about x and z change their sign.
void turn_bearing(const Force& bearing, const Isometry& isometry, Force& image) {
  if (isometry.linear.isIdentity(0)) return;
  image.axis = isometry.vector(bearing.axis);
  image.x_axis = isometry.vector(bearing.x_axis.value_or(Vec3(bearing_axes(bearing).col(0))));
  if (isometry.sense() > 0) return;
  constexpr std::array<double, 6> signs{1, -1, 1, -1, 1, -1};
  for (BearingMatrix* matrix : {&image.bearing_stiffness, &image.bearing_damping}) {
    const std::size_t size = matrix->size() > 4 ? 6 : 2;
    for (std::size_t i = 0; i < matrix->size(); ++i)
      (*matrix)[i] = signs[i / size] * signs[i % size] * (*matrix)[i] + 0.0;
  }
}

} // namespace

void turn_vane(Force& vane, const Isometry& isometry) {
  vane.normal = isometry.vector(vane.normal);
  if (vane.chord) vane.chord = isometry.vector(*vane.chord);
}

Force image_of(const Force& force, const Isometry& isometry, const Quat& body, bool body_too) {
  Force image = force;
  if (force.type == ForceType::spring) {
    for (Vec3& point : image.points)
      point = isometry.point(point);
    return image;
  }
  if (force.at) image.at = isometry.point(*force.at);
  if (force.type == ForceType::vane) turn_vane(image, isometry);
  if (is_of_air(force.type)) return image;
  if (force.type == ForceType::bearing) {
    turn_bearing(force, isometry, image);
    return image;
  }
  const bool axial = force.type == ForceType::torque;
  if (force.frame == ForceFrame::world) {
    image.vector = axial ? isometry.axial(force.vector) : isometry.vector(force.vector);
  } else if (body_too) {
    const double sign = axial ? isometry.sense() : 1;
    image.vector = (sign * image_of_frame(body, isometry).signs.cwiseProduct(force.vector)).array() + 0.0;
  } else {
    const Mat3 axes = body.normalized().toRotationMatrix();
    const Isometry in_body{axes.transpose() * isometry.linear * axes, Vec3::Zero()};
    image.vector = axial ? in_body.axial(force.vector) : in_body.vector(force.vector);
  }
  return image;
}

} // namespace flyball
