#include "tests/support/parts.hpp"

#include <utility>

namespace flyball::test {

Body body(const std::string& name, double mass, const Vec3& position, const Vec3& inertia) {
  Body b;
  b.name = name;
  b.mass = mass;
  b.position = position;
  b.inertia = {inertia.x(), inertia.y(), inertia.z(), 0, 0, 0};
  return b;
}

Body rod(const std::string& name, double mass, const Vec3& from, const Vec3& to) {
  Body b = body(name, mass, (from + to) / 2);
  const Vec3 d = to - from;
  const Mat3 i = mass / 12 * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  b.inertia = {i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)};
  return b;
}

Joint joint(JointType type, const std::string& name, const std::string& parent, const std::string& child,
            const Vec3& at, const Vec3& axis) {
  Joint j;
  j.name = name;
  j.type = type;
  j.bodies = {parent, child};
  j.at = at;
  j.axis = axis;
  j.coordinates.resize(static_cast<std::size_t>(coordinate_count(type)));
  return j;
}

Joint revolute(const std::string& name, const std::string& parent, const std::string& child, const Vec3& at,
               const Vec3& axis) {
  return joint(JointType::revolute, name, parent, child, at, axis);
}

Joint prismatic(const std::string& name, const std::string& parent, const std::string& child, const Vec3& at,
                const Vec3& axis) {
  return joint(JointType::prismatic, name, parent, child, at, axis);
}

Joint distance(const std::string& name, const std::string& a, const std::string& b, const Vec3& on_a,
               const Vec3& on_b, std::optional<double> length) {
  Joint j;
  j.name = name;
  j.type = JointType::distance;
  j.bodies = {a, b};
  j.points = {on_a, on_b};
  j.length = length;
  return j;
}

Joint gear(const std::string& name, const std::string& a, const std::string& b, double ratio) {
  Joint j;
  j.name = name;
  j.type = JointType::gear;
  j.joints = {a, b};
  j.ratio = ratio;
  return j;
}

Joint driven(Joint j, double speed) {
  j.coordinates[0].drive = Drive{speed};
  return j;
}

Joint sprung(Joint j, double stiffness, double free, std::size_t i) {
  j.coordinates[i].spring = CoordinateSpring{stiffness, free};
  return j;
}

Joint dampened(Joint j, double damping, std::size_t i) {
  j.coordinates[i].damping = damping;
  return j;
}

Force point_spring(const std::string& name, const std::string& a, const std::string& b, const Vec3& on_a,
                   const Vec3& on_b, double stiffness, std::optional<double> free_length) {
  Force f;
  f.name = name;
  f.type = ForceType::spring;
  f.bodies = {a, b};
  f.points = {on_a, on_b};
  f.stiffness = stiffness;
  f.free_length = free_length;
  return f;
}

} // namespace flyball::test
