#include "app/viewport/load_arrows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr double load_rounding = 1e-9; // beside the largest
constexpr double head_length = 1.2;    // of a long arrow, in units of the glyphs

// m, of an arrow that can be seen.
double least_length(const Assembly& assembly) {
  return 0.4 * head_length * assembly.scale.unit;
}

// Across a line, to the side that is to the front.
Vec3 across(const Vec3& line) {
  const Vec3 side = line.cross(Vec3(0.5, 0.3, 0.8));
  return side.norm() > 1e-3 ? Vec3(side.normalized()) : line.unitOrthogonal();
}

// What runs along a link or a slide would be hidden in it: it is drawn beside; what pushes along a link ends
// where what pulls begins.
Vec3 beside_part(const Assembly& assembly, const Load& load, const Vec3& along, double length) {
  if (load.part.kind != PartKind::joint) return Vec3::Zero();
  const auto j = static_cast<std::size_t>(load.part.index);
  const Joint& joint = assembly.mechanism.joints[j];
  const auto [first, second] = assembly.joint_bodies[j];
  const double u = assembly.scale.unit;
  if (joint.type == JointType::distance) {
    const Vec3 a = assembly.point(first, joint.points[0]), b = assembly.point(second, joint.points[1]);
    // Anywhere along its line: outside the body that feels it.
    const Vec3 out = 0.7 * (0.5 * a + 0.5 * b - load.at), aside = out + 0.9 * u * across(along);
    return along.dot(out) < 0 ? Vec3(aside - length * along) : aside;
  }
  if (load.kind == LoadKind::reaction) return Vec3::Zero();
  double reach = 2 * u; // of what slides, across
  if (second >= 0) {
    const Bounds bounds = shape_bounds(assembly.mechanism.bodies[static_cast<std::size_t>(second)]);
    if (!bounds.empty) {
      const Vec3 half = 0.5 * (bounds.upper - bounds.lower), axis = joint.axis.stableNormalized();
      reach = std::max(reach, (half - axis.cwiseAbs() * axis.cwiseAbs().dot(half)).cwiseAbs().maxCoeff());
    }
  }
  return (reach + 0.7 * u) * across(along);
}

} // namespace

LoadScales::LoadScales(const std::vector<Load>& loads, LoadLengths lengths, double longest)
    : lengths_(lengths), longest_(longest) {
  for (const Load& load : loads) {
    double& largest = largest_[static_cast<std::size_t>(load.kind)][load.moment ? 1 : 0];
    largest = std::max(largest, load.vector.stableNorm());
    full_[load.moment ? 1 : 0] = std::max(full_[load.moment ? 1 : 0], largest);
  }
  // Moments of a mechanism that has none are rounding of its forces at their arms.
  const std::array least{load_rounding * full_[0], load_rounding * std::max(full_[1], full_[0] * longest)};
  for (const std::size_t moment : {0u, 1u}) {
    for (auto& of_kind : largest_)
      if (!(of_kind[moment] > least[moment])) of_kind[moment] = 0;
    if (!(full_[moment] > least[moment])) full_[moment] = 0;
  }
}

void LoadScales::leave_room(bool moment, double size) {
  double& full = full_[moment ? 1 : 0];
  if (full > 0) full = std::max(full, size);
}

double LoadScales::length(bool moment, double size) const {
  const double full = full_[moment ? 1 : 0];
  if (!(full > 0) || !(size > load_rounding * full)) return 0;
  const double share = size / full;
  return longest_ * (lengths_ == LoadLengths::in_proportion ? share : std::cbrt(share));
}

double LoadScales::length(const Load& load) const {
  return length(load.moment, load.vector.stableNorm());
}

double LoadScales::size(bool moment, double length) const {
  if (!(longest_ > 0)) return 0;
  const double share = length / longest_;
  return full_[moment ? 1 : 0] * (lengths_ == LoadLengths::in_proportion ? share : share * share * share);
}

LoadScales load_scales(const Assembly& assembly, const std::vector<Load>& loads,
                       std::optional<LoadLengths> lengths) {
  const double longest = std::max(0.36 * assembly.scale.bounds.radius(), 9 * assembly.scale.unit);
  // By the cube root one large force, as the weight of a spindle, leaves the others short.
  const double longest_by_root = 1.8 * longest;
  const bool by_root = lengths == LoadLengths::by_cube_root;
  const LoadScales scales(loads, lengths.value_or(LoadLengths::in_proportion),
                          by_root ? longest_by_root : longest);
  if (lengths) return scales;
  std::size_t all = 0, seen = 0;
  for (const Load& load : loads) {
    const double length = scales.length(load);
    all += length > 0 ? 1 : 0;
    seen += length >= least_length(assembly) ? 1 : 0;
  }
  return 2 * seen >= all ? scales : LoadScales(loads, LoadLengths::by_cube_root, longest_by_root);
}

LoadArrows load_arrows(const Assembly& assembly, const std::vector<Load>& loads, const LoadScales& scales,
                       const Palette& colors, bool diagram) {
  LoadArrows out;
  out.scales = scales;
  Sketch sketch(out.solids);
  const double u = assembly.scale.unit, largest_head = head_length * u, least = least_length(assembly);
  out.least = {scales.size(false, least), scales.size(true, least)};
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Load& load = loads[i];
    const double exact = out.scales.length(load);
    if (!(exact > 0)) continue;
    if (exact < least && !diagram && scales.lengths() == LoadLengths::in_proportion) {
      ++out.left_out[load.moment ? 1 : 0];
      continue;
    }
    const double length = std::max(exact, least), head = std::min(largest_head, 0.55 * length);
    const double radius = head / 6;
    const Vec3 along = load.vector.stableNormalized();
    Vec3 from = load.at;
    if (load.moment) { // a free vector: anywhere will do
      const Vec3 side = along.cross(assembly.scale.up);
      from += 1.6 * u * (side.norm() > 1e-3 ? Vec3(side.normalized()) : along.unitOrthogonal());
    } else if (!diagram) { // others fade beside a body's diagram
      from += beside_part(assembly, load, along, length);
    }
    const Vec3 to = from + length * along;
    sketch.pen = {load_color(load.kind, colors), Surface::plain, Role::force, load.part};
    sketch.rod(from, to - head * along, radius);
    sketch.cone(to - head * along, along, 0.42 * head, head);
    if (load.moment) {
      sketch.cone(to - 1.7 * head * along, along, 0.42 * head, head);
      sketch.rod(to - 0.9 * head * along, to - 0.6 * head * along, radius);
    }
    out.arrow_of.resize(out.solids.size(), out.arrows.size());
    out.arrows.push_back({i, from, to});
  }
  return out;
}

Color load_color(LoadKind kind, const Palette& colors) {
  switch (kind) {
  case LoadKind::reaction: return colors.reaction;
  case LoadKind::drive: return colors.accent;
  case LoadKind::spring: return okabe_ito::green;
  case LoadKind::damper: return rgb(0xE8836B); // a vermillion that is seen on black, too
  case LoadKind::gear: return okabe_ito::purple;
  case LoadKind::weight: return colors.slack;
  case LoadKind::applied: return colors.force;
  case LoadKind::air: return okabe_ito::sky_blue;
  case LoadKind::inertia: return okabe_ito::orange;
  }
  return colors.force;
}

} // namespace flyball
