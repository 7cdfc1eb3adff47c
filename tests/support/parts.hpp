// Parts to build mechanisms from.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>

namespace flyball::test {

Body body(const std::string& name, double mass = 1, const Vec3& position = Vec3::Zero(),
          const Vec3& inertia = Vec3::Zero());
// A thin uniform one.
Body rod(const std::string& name, double mass, const Vec3& from, const Vec3& to);

Joint joint(JointType type, const std::string& name, const std::string& parent, const std::string& child,
            const Vec3& at, const Vec3& axis = Vec3::UnitZ());
Joint revolute(const std::string& name, const std::string& parent, const std::string& child, const Vec3& at,
               const Vec3& axis = Vec3::UnitZ());
Joint prismatic(const std::string& name, const std::string& parent, const std::string& child, const Vec3& at,
                const Vec3& axis);
Joint distance(const std::string& name, const std::string& a, const std::string& b, const Vec3& on_a,
               const Vec3& on_b, std::optional<double> length = {});
Joint gear(const std::string& name, const std::string& a, const std::string& b, double ratio);

Joint driven(Joint j, double speed);
Joint sprung(Joint j, double stiffness, double free = 0, std::size_t i = 0);
Joint dampened(Joint j, double damping, std::size_t i = 0);

// A spring between points of two bodies.
Force point_spring(const std::string& name, const std::string& a, const std::string& b, const Vec3& on_a,
                   const Vec3& on_b, double stiffness, std::optional<double> free_length = {});

} // namespace flyball::test
