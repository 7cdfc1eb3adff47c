#include "engine/mechanism/mass_properties.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace flyball {
namespace {

using std::numbers::pi;

double cube(double x) {
  return x * x * x;
}

Vec3 centre_of(const Shape& shape, const Vec3& mass_centre) {
  if (shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule)
    return 0.5 * (shape.from + shape.to);
  return shape.at.value_or(mass_centre);
}

// Of a body of revolution, from its moments along the axis and across it.
Mat3 tensor(const Vec3& axis, double along, double across) {
  return across * Mat3::Identity() + (along - across) * axis * axis.transpose();
}

// About the shape's centre and by its mass (m^2), in body axes.
Mat3 inertia_by_mass(const Shape& shape, const Quat& rotation) {
  const double r = shape.radius, r2 = r * r;
  if (shape.type == ShapeType::sphere) return 0.4 * r2 * Mat3::Identity();
  if (shape.type == ShapeType::box) {
    const Vec3 squares = shape.size.cwiseAbs2();
    return ((squares.sum() - squares.array()) / 12).matrix().asDiagonal();
  }
  const Vec3 line = shape.to - shape.from;
  const double l = line.norm();
  const Vec3 axis = rotation.conjugate() * line.stableNormalized();
  const double cylinder_across = l * l / 12 + r2 / 4;
  if (shape.type == ShapeType::cylinder) return tensor(axis, r2 / 2, cylinder_across);
  // The two halves of a ball at the ends of a capsule: their mass centres are 3/8 r outside the cylinder.
  const double balls = 4 * r / (3 * l + 4 * r);
  const double ball_across = 0.4 * r2 + l * l / 4 + 0.375 * l * r;
  return tensor(axis, (1 - balls) * r2 / 2 + balls * 0.4 * r2,
                (1 - balls) * cylinder_across + balls * ball_across);
}

// Of the shapes together; `inertia` in body axes. Nothing without any volume.
std::optional<MassProperties> in_body_axes(const Body& body, double density) {
  MassProperties all;
  for (const Shape& shape : body.shapes) {
    const double mass = density * volume(shape);
    all.mass += mass;
    all.centre += mass * (centre_of(shape, body.position) - body.position);
  }
  if (!(all.mass > 0)) return {};
  all.centre = body.position + all.centre / all.mass;
  const Quat rotation = body.rotation.normalized();
  for (const Shape& shape : body.shapes) {
    const double mass = density * volume(shape);
    if (!(mass > 0)) continue;
    const Vec3 away = rotation.conjugate() * (centre_of(shape, body.position) - all.centre);
    all.inertia += mass * (inertia_by_mass(shape, rotation) + away.squaredNorm() * Mat3::Identity() -
                           away * away.transpose());
  }
  if (!std::isfinite(all.mass) || !all.centre.allFinite() || !all.inertia.allFinite()) return {};
  return all;
}

// Products of inertia that are round-off beside the moments are none.
double product(const Mat3& inertia, int i, int j) {
  constexpr double round_off = 1e-15;
  return std::abs(inertia(i, j)) > round_off * inertia.trace() ? inertia(i, j) : 0;
}

} // namespace

double volume(const Shape& shape) {
  const double r = std::max(shape.radius, 0.0);
  const double length = (shape.to - shape.from).norm();
  switch (shape.type) {
  case ShapeType::sphere: return 4 * pi / 3 * cube(r);
  case ShapeType::box: return shape.size.cwiseMax(0).prod();
  case ShapeType::cylinder: return pi * r * r * length;
  case ShapeType::capsule: return pi * r * r * length + 4 * pi / 3 * cube(r);
  }
  return 0;
}

std::optional<MassProperties> mass_properties(const Body& body, double density) {
  std::optional<MassProperties> all = in_body_axes(body, density);
  if (all) {
    const Mat3 axes = body.rotation.normalized().toRotationMatrix();
    all->inertia = axes * all->inertia * axes.transpose();
  }
  return all;
}

namespace {

void take(Body& body, const MassProperties& all, double mass) {
  // A shape that stands at the mass centre stays where it is when that moves.
  if (all.centre != body.position)
    for (Shape& shape : body.shapes)
      if (!shape.at && (shape.type == ShapeType::sphere || shape.type == ShapeType::box))
        shape.at = body.position;
  const Mat3 i = all.inertia * (mass / all.mass);
  body.mass = mass;
  body.position = all.centre;
  body.inertia = {i(0, 0), i(1, 1), i(2, 2), product(i, 0, 1), product(i, 0, 2), product(i, 1, 2)};
}

} // namespace

bool take_mass_properties(Body& body, double density) {
  const std::optional<MassProperties> all = in_body_axes(body, density);
  // Without the last digit's dust: a block of 0.2 m by 7850 kg/m^3 has 62.8 kg.
  if (all) take(body, *all, std::strtod(rounded_text(all->mass, 15).c_str(), nullptr));
  return all.has_value();
}

bool take_uniform_mass(Body& body, double mass) {
  const std::optional<MassProperties> all = in_body_axes(body, 1);
  if (all) take(body, *all, mass);
  return all.has_value();
}

std::optional<double> density_of(const Body& body) {
  double all = 0;
  for (const Shape& shape : body.shapes)
    all += volume(shape);
  if (!(all > 0) || !std::isfinite(all)) return {};
  return body.mass / all;
}

} // namespace flyball
