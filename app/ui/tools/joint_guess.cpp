#include "app/ui/tools/joint_guess.hpp"

#include "app/viewport/assembly.hpp"
#include "app/viewport/bodies_near.hpp"
#include "app/viewport/camera.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

struct Structure {
  std::vector<bool> grounded;                // by body: a chain of joints leads to the ground
  std::vector<std::array<int, 2>> neighbors; // -1: ground

  explicit Structure(const Mechanism& mechanism) : grounded(mechanism.bodies.size()) {
    const std::vector<Pose> drawn = drawn_poses(mechanism);
    const Assembly assembly(mechanism, drawn);
    std::vector<std::vector<std::size_t>> joined(mechanism.bodies.size());
    std::vector<std::size_t> open;
    const auto reach = [&](std::size_t body) {
      if (!grounded[body]) open.push_back(body);
      grounded[body] = true;
    };
    for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
      if (!has_at(mechanism.joints[j].type)) continue;
      const auto [a, b] = assembly.joint_bodies[j];
      neighbors.push_back({a, b});
      if (a >= 0 && b >= 0) {
        joined[static_cast<std::size_t>(a)].push_back(static_cast<std::size_t>(b));
        joined[static_cast<std::size_t>(b)].push_back(static_cast<std::size_t>(a));
      } else if (a >= 0 || b >= 0) {
        reach(static_cast<std::size_t>(std::max(a, b)));
      }
    }
    while (!open.empty()) {
      const std::size_t body = open.back();
      open.pop_back();
      for (const std::size_t other : joined[body])
        reach(other);
    }
  }
  bool hangs(int body) const { return grounded[static_cast<std::size_t>(body)]; }
  std::size_t joints_of(int body) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        neighbors, [&](const auto& pair) { return pair[0] == body || pair[1] == body; }));
  }
  bool joined(int a, int b) const {
    return std::ranges::any_of(neighbors, [&](const auto& pair) {
      return (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
    });
  }
};

// Of two bodies the one that hangs on the ground first.
std::array<int, 2> in_order(const Structure& structure, int a, int b) {
  return structure.hangs(b) && !structure.hangs(a) ? std::array{b, a} : std::array{a, b};
}

// Where all at the point are joined already: the end of a chain, with the ground that it is not joined to.
std::optional<std::array<int, 2>> end_to_ground(const Structure& structure, const std::vector<int>& there) {
  std::optional<std::array<int, 2>> found;
  std::size_t fewest = 0; // joints
  for (const int body : there) {
    if (structure.joined(-1, body)) continue;
    const std::size_t joints = structure.joints_of(body);
    if (found && joints >= fewest) continue;
    fewest = joints;
    found = {-1, body};
  }
  return found;
}

// `loose_one`: a selected body that no joint leads to; -1: none. It is rather what the one at the point is to
// be joined with than the ground once more.
std::array<int, 2> pair_at(const Structure& structure, const std::vector<int>& there, int loose_one,
                           bool again) {
  if (there.size() == 1 && loose_one >= 0 && loose_one != there[0] && structure.joined(-1, there[0]))
    return {there[0], loose_one};
  if (there.size() == 1) return {-1, there[0]};
  for (const int loose : there)
    for (const int other : there)
      if (!structure.hangs(loose) && structure.hangs(other)) return {other, loose};
  for (std::size_t i = 0; i < there.size(); ++i)
    for (std::size_t k = i + 1; k < there.size(); ++k)
      if (!structure.joined(there[i], there[k]))
        return {std::min(there[i], there[k]), std::max(there[i], there[k])};
  if (const auto found = end_to_ground(structure, there); found && !again) return *found;
  return {std::min(there[0], there[1]), std::max(there[0], there[1])};
}

bool parallel(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() < 1e-9;
}

// Its centre line, with the greatest coordinate positive; nothing for other bodies. A disc is no `slender`
// one.
std::optional<Vec3> rod_axis(const Body& body, bool slender = false) {
  for (const Shape& shape : body.shapes) {
    if (shape.type != ShapeType::cylinder && shape.type != ShapeType::capsule) continue;
    if (slender && (shape.to - shape.from).norm() < 4 * shape.radius) continue;
    Vec3 axis = (shape.to - shape.from).stableNormalized();
    Vec3::Index largest = 0;
    if (!(axis.cwiseAbs().maxCoeff(&largest) > 0)) continue;
    if (axis[largest] < 0) axis = -axis;
    return Vec3(axis.array() + 0.0);
  }
  return std::nullopt;
}

const Body* find_body(const Mechanism& mechanism, const std::string& name) {
  const int i = body_index(mechanism, name);
  return i < 0 ? nullptr : &mechanism.bodies[static_cast<std::size_t>(i)];
}

// Where the shortest chain of joints that leads from a body over others to the ground comes there: the
// crank's pivot of a crank's block. Nothing where none does.
const Joint* ground_pivot(const Mechanism& mechanism, const std::string& body) {
  std::vector<std::string_view> reached{body};
  for (std::size_t next = 0; next < reached.size(); ++next)
    for (const Joint& joint : mechanism.joints) {
      if (!has_at(joint.type)) continue;
      const auto end = std::ranges::find(joint.bodies, reached[next]);
      if (end == joint.bodies.end()) continue;
      const std::string& other = joint.bodies[end == joint.bodies.begin() ? 1 : 0];
      if (other == ground_name && next > 0) return &joint;
      if (other != ground_name && std::ranges::find(reached, other) == reached.end())
        reached.push_back(other);
    }
  return nullptr;
}

// The direction from a pivot, across its axis where it is a hinge, to a place; that of the world's axis where
// this is nearly the same, as of a crank whose slide runs past its pivot.
std::optional<Vec3> away_from(const Joint& pivot, const Vec3& place) {
  constexpr double nearly = 0.95; // the cosine of 18 degrees
  Vec3 line = place - pivot.at;
  const double length = line.norm();
  if (pivot.type == JointType::revolute) {
    const Vec3 hinge = pivot.axis.stableNormalized();
    line -= hinge.dot(line) * hinge;
  }
  if (!(line.norm() > 1e-6 * length)) return std::nullopt;
  line.normalize();
  Vec3::Index largest = 0;
  if (line.cwiseAbs().maxCoeff(&largest) > nearly) return Vec3::Unit(largest);
  return Vec3(line.array() + 0.0);
}

} // namespace

std::array<std::string, 2> guess_bodies(const Mechanism& mechanism, std::span<const Instance> instances,
                                        const Selection& selected, const Vec3& at, double reach, bool again) {
  if (mechanism.bodies.empty()) return {};
  const Structure structure(mechanism);
  const auto names = [&](const std::array<int, 2>& pair) {
    std::array<std::string, 2> found;
    for (std::size_t i = 0; i < 2; ++i)
      found[i] =
          pair[i] < 0 ? std::string(ground_name) : mechanism.bodies[static_cast<std::size_t>(pair[i])].name;
    return found;
  };
  const std::vector<std::string> chosen = selected.names(PartKind::body);
  if (chosen.size() == 2) {
    const int a = body_index(mechanism, chosen[0]), b = body_index(mechanism, chosen[1]);
    if (a >= 0 && b >= 0) return names(in_order(structure, a, b));
  }
  const std::vector<NearBody> near = bodies_near(mechanism, instances, at);
  std::vector<int> there;
  for (const NearBody& body : near)
    if (body.distance <= reach) there.push_back(body.body);
  if (there.empty()) there.push_back(near.front().body);
  const int only = chosen.size() == 1 ? body_index(mechanism, chosen[0]) : -1;
  return names(pair_at(structure, there, only >= 0 && !structure.hangs(only) ? only : -1, again));
}

bool sits_on_shaft(const Mechanism& mechanism, const std::array<std::string, 2>& bodies, const Vec3& at) {
  const Body *a = find_body(mechanism, bodies[0]), *b = find_body(mechanism, bodies[1]);
  if (!a || !b || a->shapes.size() != 1 || b->shapes.size() != 1) return false;
  const auto slender = rod_axis(*a, true) ? std::array{a, b} : std::array{b, a};
  const std::optional<Vec3> rod = rod_axis(*slender[0], true), disc = rod_axis(*slender[1]);
  if (!rod || !disc || !parallel(*rod, *disc)) return false;
  const Shape &shaft = slender[0]->shapes.front(), &wheel = slender[1]->shapes.front();
  const double length = (shaft.to - shaft.from).norm(), near = 1e-6 * length;
  const auto off = [&](const Vec3& point) {
    return (point - shaft.from - (point - shaft.from).dot(*rod) * *rod).norm();
  };
  return (wheel.to - wheel.from).norm() < wheel.radius && wheel.radius > shaft.radius &&
         off(wheel.from) <= near && off(at) <= near;
}

std::vector<BodyAxis> body_axes(const Mechanism& mechanism, const std::array<std::string, 2>& bodies) {
  std::vector<BodyAxis> axes;
  const auto add = [&](const std::string& label, const Vec3& axis) {
    for (int i = 0; i < 3; ++i)
      if (parallel(axis, Vec3::Unit(i))) return;
    if (std::ranges::none_of(axes, [&](const BodyAxis& other) { return parallel(axis, other.axis); }))
      axes.push_back({label, axis});
  };
  for (const std::string& name : bodies) {
    const Body* body = find_body(mechanism, name);
    if (!body) continue;
    if (const auto rod = rod_axis(*body)) add("along " + name, *rod);
    const Mat3 frame = body->rotation.normalized().toRotationMatrix();
    for (int i = 0; i < 3; ++i)
      add(std::string(1, "xyz"[i]) + " of " + name, frame.col(i));
  }
  return axes;
}

Vec3 guess_axis(const Mechanism& mechanism, JointType type, const std::array<std::string, 2>& bodies,
                int normal) {
  if (type != JointType::prismatic && type != JointType::cylindrical) return Vec3::Unit(normal);
  for (const std::string& name : bodies)
    if (const Body* body = find_body(mechanism, name))
      if (const auto rod = rod_axis(*body, true)) return *rod;
  const Body *a = find_body(mechanism, bodies[0]), *b = find_body(mechanism, bodies[1]);
  if (a && b && type == JointType::prismatic)
    if (const Vec3 between = (b->position - a->position).stableNormalized(); between.norm() > 0.5)
      return Vec3(between.array() + 0.0);
  if (const Body* alone = a ? a : b; alone && !(a && b) && type == JointType::prismatic)
    if (const Joint* pivot = ground_pivot(mechanism, alone->name);
        pivot && (pivot->type == JointType::revolute || pivot->type == JointType::spherical))
      if (const auto line = away_from(*pivot, alone->position)) return *line;
  return up_axis(mechanism).array() + 0.0;
}

Vec3 guess_shaft(const Mechanism& mechanism, const std::array<std::string, 2>& bodies, int normal) {
  for (const std::string& name : {bodies[1], bodies[0]}) {
    if (name == ground_name) continue;
    for (const Joint& joint : mechanism.joints)
      if ((joint.type == JointType::revolute || joint.type == JointType::cylindrical ||
           joint.type == JointType::planar) &&
          (joint.bodies[0] == name || joint.bodies[1] == name))
        return joint.axis;
    if (const Body* body = find_body(mechanism, name))
      if (const auto rod = rod_axis(*body)) return *rod;
  }
  return Vec3::Unit(normal);
}

std::optional<Vec3> shaft_axis(const Mechanism& mechanism, const Vec3& at) {
  std::optional<Vec3> found;
  for (const Body& body : mechanism.bodies) {
    const std::optional<Vec3> axis = rod_axis(body, true);
    if (!axis) continue;
    const bool turns = std::ranges::any_of(mechanism.joints, [&](const Joint& joint) {
      return (joint.type == JointType::revolute || joint.type == JointType::cylindrical) &&
             std::ranges::find(joint.bodies, body.name) != joint.bodies.end() && parallel(joint.axis, *axis);
    });
    const bool on_line = std::ranges::any_of(body.shapes, [&](const Shape& shape) {
      if (shape.type != ShapeType::cylinder && shape.type != ShapeType::capsule) return false;
      const double length = (shape.to - shape.from).norm(), along = (at - shape.from).dot(*axis),
                   off = (at - shape.from - along * *axis).norm(), near = 1e-6 * length,
                   from_end = std::min((at - shape.from).norm(), (at - shape.to).norm());
      const bool within = (at - shape.from).dot(shape.to - at) >= -near * length;
      return parallel((shape.to - shape.from).stableNormalized(), *axis) && off <= near && within &&
             (turns || from_end > near);
    });
    if (!on_line) continue;
    if (found && !parallel(*found, *axis)) return std::nullopt;
    found = axis;
  }
  return found;
}

Vec3 axis_across(const Vec3& axis) {
  Vec3::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 unit = Vec3::Unit(least);
  return (unit - axis * axis.dot(unit) / axis.squaredNorm()).normalized();
}

} // namespace flyball
