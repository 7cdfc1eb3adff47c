#include "app/viewport/body_form.hpp"

#include "app/viewport/sketch.hpp"
#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

namespace flyball {

namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp(along.dot(p - a) / square, 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

void draw_shape(Sketch& sketch, const Body& body, const Shape& shape, double unit) {
  const Vec3 at = shape.at.value_or(body.position);
  switch (shape.type) {
  case ShapeType::sphere: return sketch.sphere(at, shape.radius);
  case ShapeType::capsule: return sketch.rod(shape.from, shape.to, shape.radius);
  case ShapeType::cylinder:
    return sketch.cylinder(shape.from, shape.to, shape.radius, std::min(0.12 * unit, 0.15 * shape.radius));
  case ShapeType::box:
    return sketch.box(at, body.rotation.normalized(), 0.5 * shape.size,
                      std::min(0.12 * unit, 0.1 * shape.size.minCoeff()));
  }
}

// Balls grow with the cube root of their mass, within reason.
double body_ball_radius(const Assembly& assembly, const Body& body) {
  const double unit = assembly.scale.unit;
  if (!(assembly.middle_mass > 0) || !(body.mass > 0)) return 0.7 * unit;
  return 1.9 * unit * std::clamp(std::cbrt(body.mass / assembly.middle_mass), 0.8, 1.5);
}

// The uniform cylinder, ball or box with the body's inertia, shrunk to the size of the glyphs.
void draw_inertia(Sketch& sketch, const Body& body, double unit) {
  const auto& i = body.inertia;
  Mat3 tensor;
  tensor << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  const double trace = tensor.trace();
  if (!(body.mass > 0) || !(trace > 0) || !std::isfinite(trace))
    return sketch.sphere(body.position, (body.mass > 0 ? 1.5 : 0.8) * unit);
  const auto principal = principal_axes(tensor);
  if (!principal) return sketch.sphere(body.position, 1.5 * unit);
  const Vec3 m = principal->values / body.mass;
  const Mat3 axes = body.rotation.normalized() * principal->vectors;
  const double close = 0.05 * m.sum();
  const bool low_pair = m[1] - m[0] < close, high_pair = m[2] - m[1] < close;
  const auto shrink = [unit](double largest) { return std::min(1.0, 6 * unit / largest); };
  if (low_pair && high_pair)
    return sketch.sphere(body.position, std::clamp(std::sqrt(2.5 * m[1]), unit, 3 * unit));
  if (low_pair || high_pair) {
    const int odd = low_pair ? 2 : 0;
    const double radius = std::sqrt(2 * m[odd]);
    const double half = 0.5 * std::sqrt(std::max(12 * m[1] - 3 * radius * radius, 0.0));
    const double s = shrink(std::max(radius, half));
    return sketch.disc(body.position, axes.col(odd), std::max(s * half, 0.35 * unit),
                       std::max(s * radius, 0.35 * unit), 0.15 * unit);
  }
  const Vec3 half = (1.5 * (Vec3::Constant(m.sum()) - 2 * m)).cwiseMax(0).cwiseSqrt();
  Mat3 right_handed = axes;
  if (right_handed.determinant() < 0) right_handed.col(2) *= -1;
  sketch.box(body.position, Quat(right_handed), (shrink(half.maxCoeff()) * half).cwiseMax(0.35 * unit),
             0.15 * unit);
}

void draw_shaft(Sketch& sketch, const Assembly& assembly, std::size_t body, const Shaft& shaft) {
  const double unit = assembly.scale.unit;
  sketch.cylinder(shaft.origin + shaft.from * shaft.direction, shaft.origin + shaft.to * shaft.direction,
                  0.62 * unit, 0.2 * unit);
  for (const Attachment& a : assembly.attachments[body]) {
    if (a.joint < 0 || a.joint == shaft.joint) continue;
    const Joint& joint = assembly.joint(a.joint);
    // The head that carries a hinge across the shaft.
    if (joint.type == JointType::revolute &&
        joint.axis.stableNormalized().cross(shaft.direction).norm() > 0.1)
      sketch.disc(a.at, shaft.direction, 1.15 * unit, 1.1 * unit, 0.3 * unit);
  }
}

// Draws the body as a slider on its rail if it is one; returns how far from `at` the slider reaches.
double draw_slider(Sketch& sketch, const Assembly& assembly, const Attachment& a) {
  if (a.joint < 0) return 0;
  const Joint& joint = assembly.joint(a.joint);
  const auto index = static_cast<std::size_t>(a.joint);
  if (joint.type != JointType::prismatic && joint.type != JointType::cylindrical) return 0;
  if (slider_end(assembly, index) != a.end) return 0;
  const double unit = assembly.scale.unit;
  if (joint.type == JointType::cylindrical || slides_on_shaft(assembly, index))
    sketch.tube(a.at, joint.axis, 1.15 * unit, 1.9 * unit, 0.25 * unit);
  else
    sketch.box(a.at, frame_along(joint.axis, assembly.scale.up), {1.25 * unit, 1.25 * unit, 1.6 * unit},
               0.25 * unit);
  return 1.9 * unit;
}

void draw_rails(Sketch& sketch, const Assembly& assembly, std::size_t body) {
  const double unit = assembly.scale.unit;
  for (const Attachment& a : assembly.attachments[body]) {
    if (a.joint < 0) continue;
    const Joint& joint = assembly.joint(a.joint);
    const auto index = static_cast<std::size_t>(a.joint);
    if (joint.type != JointType::prismatic && joint.type != JointType::cylindrical) continue;
    if (slider_end(assembly, index) == a.end || joint.coordinates.empty()) continue;
    // The slide is a cylindrical joint's second coordinate.
    const double drawn = joint.coordinates.back().drawn;
    const SlideRange range = slide_range(assembly, index, joint.coordinates.size() - 1);
    const Vec3 axis = (a.end == 0 ? 1 : -1) * joint.axis.stableNormalized();
    sketch.rod(a.at + (range.from - drawn) * axis, a.at + (range.to - drawn + 2.4 * unit) * axis,
               0.45 * unit);
  }
}

void derive(Sketch& sketch, const Assembly& assembly, std::size_t index) {
  const Body& body = assembly.mechanism.bodies[index];
  const std::vector<Attachment>& attachments = assembly.attachments[index];
  const double unit = assembly.scale.unit;
  if (const auto shaft = shaft_of(assembly, static_cast<int>(index)))
    return draw_shaft(sketch, assembly, index, *shaft);

  draw_rails(sketch, assembly, index);
  double slider = 0;
  for (const Attachment& a : attachments)
    slider = std::max(slider, draw_slider(sketch, assembly, a));

  Vec3 hub = body.position;
  if (!(body.mass > 0) && !attachments.empty()) {
    Bounds around;
    for (const Attachment& a : attachments)
      around.add(a.at);
    hub = around.center();
  }
  std::vector<Vec3> ends; // the farthest first, so that what lies on a rod needs none of its own
  for (const Attachment& a : attachments)
    ends.push_back(a.at);
  std::stable_sort(ends.begin(), ends.end(),
                   [&](const Vec3& a, const Vec3& b) { return (a - hub).norm() > (b - hub).norm(); });
  std::vector<Vec3> drawn;
  for (const Vec3& end : ends) {
    const auto covers = [&](const Vec3& to) { return distance_to_segment(end, hub, to) < 0.35 * unit; };
    if ((end - hub).norm() < std::max(0.35 * unit, slider) || std::any_of(drawn.begin(), drawn.end(), covers))
      continue;
    sketch.rod(hub, end, 0.5 * unit);
    drawn.push_back(end);
  }

  const auto turns = [&](const Attachment& a) {
    return a.joint >= 0 && assembly.joint(a.joint).type != JointType::distance &&
           assembly.joint(a.joint).type != JointType::spherical;
  };
  if (drawn.empty()) {
    if (slider > 0) return;
    if (std::any_of(attachments.begin(), attachments.end(), turns)) return draw_inertia(sketch, body, unit);
    return sketch.sphere(hub, body_ball_radius(assembly, body));
  }
  if (!(body.mass > 0) || slider > 0) return;
  const bool between = drawn.size() > 1 && distance_to_segment(hub, drawn[0], drawn[1]) < 0.5 * unit;
  sketch.sphere(hub, between ? 0.8 * unit : body_ball_radius(assembly, body));
}

} // namespace

std::vector<Color> body_colors(const BodyHues& hues, Theme theme) {
  const auto& all = palette(theme).bodies;
  static_assert(std::tuple_size_v<std::remove_cvref_t<decltype(all)>> == body_hue_count * body_shade_count);
  std::vector<Color> colors;
  colors.reserve(hues.size());
  for (const std::uint8_t hue : hues)
    colors.push_back(all[hue % all.size()]);
  return colors;
}

namespace {

// From the drawn pose to where the body stands.
void carry(const Assembly& assembly, std::size_t index, std::span<Instance> solids) {
  const Body& body = assembly.mechanism.bodies[index];
  const Pose& pose = assembly.poses[index];
  const Quat turn = pose.rotation * body.rotation.normalized().conjugate();
  for (Instance& solid : solids) {
    solid.position = pose.position + turn * (solid.position - body.position);
    solid.rotation = turn * solid.rotation;
  }
}

} // namespace

void add_body(const Assembly& assembly, std::size_t index, Color color, std::vector<Instance>& list) {
  const std::size_t first = list.size();
  Sketch sketch(list);
  sketch.pen = {color, Surface::plain, Role::body, {PartKind::body, static_cast<int>(index)}};
  const Body& body = assembly.mechanism.bodies[index];
  for (const Shape& shape : body.shapes) {
    sketch.pen.color = color;
    if (shape.color) {
      const auto& c = *shape.color;
      sketch.pen.color = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
    }
    draw_shape(sketch, body, shape, assembly.scale.unit);
  }
  if (body.shapes.empty()) derive(sketch, assembly, index);
  carry(assembly, index, std::span(list).subspan(first));
}

} // namespace flyball
