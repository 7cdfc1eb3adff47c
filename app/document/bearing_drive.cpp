#include "app/document/bearing_drive.hpp"

#include "app/document/create.hpp"
#include "app/document/references.hpp"
#include "app/document/remove.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace flyball {
namespace {

constexpr double off_axis = 1e-6; // rad, or parts of a distance: drawn on one line

struct Held {
  std::string in;             // the body that the bearings are in
  Vec3 axis = Vec3::UnitZ();  // unit vector
  Vec3 at = Vec3::Zero();     // m, on the axis, beside the mass centre
  Vec3 beyond = Vec3::Zero(); // m, on the axis, beyond the first bearing as seen from there
  bool along = false;         // they act along the axis, too
  std::string hinge;          // about the axis, beside them; empty: none
  std::string why;            // there can be no drive, a sentence
};

// Whether a coordinate of the bearing's matrices, by its row, moves or feels anything.
bool acts_on(const Force& bearing, int row) {
  const int size = bearing_size(bearing);
  if (row >= size) return false;
  const auto named = [row](const Formula& formula) { // "stiffness.2.5"
    if (!formula.key.starts_with("stiffness.") && !formula.key.starts_with("damping.")) return false;
    const std::string entry = formula.key.substr(formula.key.find('.')), digit = "." + std::to_string(row);
    return entry.starts_with(digit) || entry.ends_with(digit);
  };
  if (std::ranges::any_of(bearing.formulas, named)) return true;
  for (const BearingMatrix* matrix : {&bearing.bearing_stiffness, &bearing.bearing_damping})
    for (std::size_t i = 0; i < matrix->size(); ++i)
      if ((*matrix)[i] != 0 && (static_cast<int>(i) / size == row || static_cast<int>(i) % size == row))
        return true;
  return false;
}

bool joins(const Joint& joint, const std::string& a, const std::string& b) {
  return joint.type != JointType::gear &&
         ((joint.bodies[0] == a && joint.bodies[1] == b) || (joint.bodies[0] == b && joint.bodies[1] == a));
}

// A free joint that nothing acts at: without it the body is as free.
bool is_idle(const Mechanism& mechanism, const Joint& joint) {
  if (joint.type != JointType::free) return false;
  const auto idle = [](Coordinate c) {
    c.drawn = 0;
    return c == Coordinate{};
  };
  return std::ranges::all_of(joint.coordinates, idle) &&
         std::ranges::none_of(mechanism.joints, [&](const Joint& gear) {
           return gear.type == JointType::gear && std::ranges::any_of(gear.joints, [&](const auto& end) {
                    return joint_of_end(end) == joint.name;
                  });
         });
}

// By which joint the body hangs on one of two others, beside a hinge and the bearings, and on which; empty:
// on none.
struct Attachment {
  std::string joint, to;
};
Attachment attached(const Mechanism& mechanism, const std::string& body,
                    const std::array<std::string_view, 2>& others, const std::string& hinge) {
  std::multimap<std::string_view, const Joint*> at;
  for (const Joint& joint : mechanism.joints)
    if (joint.name != hinge && !is_idle(mechanism, joint))
      for (const std::string& end : bodies_of(joint))
        at.emplace(end, &joint);
  const auto beyond = [](const Joint& joint, std::string_view end) -> std::string_view {
    return joint.bodies[joint.bodies[0] == end ? 1 : 0];
  };
  std::set<std::string_view> seen{body};
  for (auto [begin, end] = at.equal_range(body); begin != end; ++begin) {
    std::vector<std::string_view> open{beyond(*begin->second, body)};
    while (!open.empty()) {
      const std::string_view next = open.back();
      open.pop_back();
      if (std::ranges::find(others, next) != others.end()) return {begin->second->name, std::string(next)};
      if (!seen.insert(next).second) continue;
      for (auto [joint, last] = at.equal_range(next); joint != last; ++joint)
        open.push_back(beyond(*joint->second, next));
    }
  }
  return {};
}

Held held_in_bearings(const Mechanism& mechanism, const std::string& name) {
  Held held;
  const auto refuse = [&](std::string why) {
    held.why = std::move(why);
    return held;
  };
  std::vector<const Force*> bearings;
  for (const Force& force : mechanism.forces)
    if (force.type == ForceType::bearing && held_by(force) == name) bearings.push_back(&force);
  const int b = body_index(mechanism, name);
  if (b < 0 || bearings.empty()) return refuse("No bearing holds " + name + ".");
  const Vec3& centre = mechanism.bodies[static_cast<std::size_t>(b)].position;
  const auto in = [&](const Force& bearing) { return bearing.bodies[bearing.bodies[0] == name ? 1 : 0]; };
  held.in = in(*bearings[0]);
  held.axis = bearings[0]->axis.stableNormalized();
  const Vec3 at = bearings[0]->at.value_or(centre);
  const auto on_axis = [&](const Vec3& axis, const Vec3& point) {
    const Vec3 there = point - at, across = there - held.axis * held.axis.dot(there);
    return axis.stableNormalized().cross(held.axis).norm() <= off_axis &&
           across.norm() <= off_axis * std::max(there.norm(), (centre - at).norm());
  };
  for (const Force* bearing : bearings) {
    if (in(*bearing) != held.in) return refuse("Its bearings are in several bodies.");
    if (!on_axis(bearing->axis, bearing->at.value_or(centre)))
      return refuse("Its bearings are not on one axis.");
    if (std::ranges::any_of(bearing->formulas, [](const auto& f) { return f.key.starts_with("axis."); }))
      return refuse("The axis of " + bearing->name + " is given by an expression.");
    if (acts_on(*bearing, 5)) return refuse(bearing->name + " resists turning about its axis.");
    held.along = held.along || acts_on(*bearing, 2);
  }
  held.at = at + held.axis * held.axis.dot(centre - at);
  held.beyond = at + 0.4 * (at - held.at);
  for (const Joint& joint : mechanism.joints)
    if (joint.type == JointType::revolute && joins(joint, name, held.in) && on_axis(joint.axis, joint.at))
      held.hinge = joint.name;
  if (const Attachment other = attached(mechanism, name, {held.in, ground_name}, held.hinge);
      !other.joint.empty())
    return refuse("By " + other.joint + " it is joined to " +
                  (other.to == ground_name ? "the ground" : other.to) + " already, beside its bearings.");
  return held;
}

// Two directions across the axis: upwards where there is gravity across it.
std::array<Vec3, 2> across(const Vec3& axis, const Vec3& gravity, bool& upwards) {
  Vec3 first = -gravity + axis * axis.dot(gravity);
  upwards = first.norm() > 0.5 * gravity.norm();
  if (!upwards) {
    Vec3::Index least = 0;
    axis.cwiseAbs().minCoeff(&least);
    first = Vec3::Unit(least) - axis * axis[least];
  }
  first.normalize();
  return {first.array() + 0.0, axis.cross(first).array() + 0.0}; // no -0
}

} // namespace

const std::string& held_by(const Force& bearing) {
  return bearing.bodies[bearing.bodies[1] == ground_name ? 0 : 1];
}

std::string bearing_drive_refused(const Mechanism& mechanism, const std::string& body) {
  return held_in_bearings(mechanism, body).why;
}

std::vector<BodyInBearings> bodies_in_bearings(const Mechanism& mechanism) {
  std::vector<BodyInBearings> found;
  std::set<std::string_view> seen;
  for (const Force& force : mechanism.forces)
    if (force.type == ForceType::bearing && seen.insert(held_by(force)).second)
      if (Held held = held_in_bearings(mechanism, held_by(force)); held.why.empty())
        found.push_back({held_by(force), std::move(held.hinge)});
  return found;
}

std::string give_bearing_drive(Mechanism& mechanism, const std::string& body, double speed) {
  const Held held = held_in_bearings(mechanism, body);
  if (!held.why.empty()) throw SceneError("bodies." + body, held.why);
  Mechanism next = mechanism;
  Selection idle;
  for (const Joint& joint : next.joints)
    if (is_idle(next, joint) && (joins(joint, body, held.in) || joins(joint, body, std::string(ground_name))))
      idle.add({PartKind::joint, joint.name});
  remove_parts(next, idle);
  bool upwards = false;
  const std::array<Vec3, 2> axes = across(held.axis, next.gravity, upwards);
  const Vec3 &first = axes[0], &second = axes[1];
  std::string last = held.in;
  // Where slides are drawn changes nothing; where the sleeve tilts is the place whose shifts are told.
  const auto massless = [&](const char* stem, const Vec3& at) {
    Body made;
    made.name = unused_name(next, PartKind::body, stem);
    made.position = at;
    next.bodies.push_back(made);
    return made.name;
  };
  const auto join = [&](const char* stem, JointType type, const std::string& child, const Vec3& at,
                        const Vec3& axis) {
    const std::string name = unused_name(next, PartKind::joint, stem);
    add_joint(next, type, {last, child}, at, axis, second);
    next.joints.back().name = name;
    last = child;
  };
  const auto slide = [&](const char* stem, const char* child, const Vec3& axis) {
    join(stem, JointType::prismatic, massless(child, held.beyond), held.beyond, axis);
  };
  if (held.along) slide("along", "slide", held.axis);
  slide(upwards ? "up" : "across", "slide", first);
  slide("across", "yoke", second);
  const std::string sleeve = massless("sleeve", held.at);
  join("tilt", JointType::universal, sleeve, held.at, first);
  const auto to_sleeve = [&](std::array<std::string, 2>& bodies, const std::string& from) {
    std::ranges::replace(bodies, from, sleeve);
  };
  std::string driven = held.hinge;
  for (Force& force : next.forces) {
    if (force.type != ForceType::bearing || held_by(force) != body) continue;
    to_sleeve(force.bodies, body);
    if (!driven.empty()) continue;
    // The axis goes through the first one, by its expressions too.
    join("spin", JointType::revolute, body, force.at.value_or(held.at), held.axis);
    Joint& spin = next.joints.back();
    for (const Formula& formula : force.formulas)
      if (formula.key.starts_with("at.")) spin.formulas.push_back(formula);
    driven = spin.name;
  }
  Joint& spin = next.joints[static_cast<std::size_t>(joint_index(next, driven))];
  if (!held.hinge.empty()) to_sleeve(spin.bodies, held.in);
  if (!spin.coordinates.at(0).drive) spin.coordinates[0].drive.emplace().speed = speed;
  mechanism = std::move(next);
  return driven;
}

} // namespace flyball
