// New parts. Each function adds one to the mechanism under a name nobody has yet, and returns the name.
// Points and directions are in the world frame at the drawn pose, SI units.
#pragma once

#include "app/document/part.hpp"

#include <array>
#include <string>
#include <string_view>

namespace flyball {

enum class BodyForm { ball, block, rod, plate, disc };
std::string form_name(BodyForm form); // "ball"

inline constexpr double steel = 7850; // kg/m^3

struct NewBody {
  BodyForm form = BodyForm::ball;
  Vec3 at = Vec3::Zero();                       // m; ball, block, plate: the mass centre
  double radius = 0.05;                         // m; ball, rod, disc
  Vec3 size = Vec3(0.1, 0.1, 0.1);              // m; block and plate: full edges along x, y, z
  Vec3 from = Vec3::Zero(), to = Vec3::UnitX(); // m; rod, disc: ends of the centre line
  double density = steel;                       // kg/m^3, of which mass and inertia follow
};
// The body's only shape is its form (rods and discs are cylinders); its mass and inertia are those of the
// solid. A rod or disc has one of its body axes along it, the one that needs the least turn from the world's.
std::string add_body(Mechanism& mechanism, const NewBody& body);

// Joints of every type but distance and gear. `axis2` counts for universal and planar joints; one that is
// parallel to `axis` is replaced by a world axis across it.
std::string add_joint(Mechanism& mechanism, JointType type, const std::array<std::string, 2>& bodies,
                      const Vec3& at, const Vec3& axis, const Vec3& axis2 = Vec3::UnitX());
std::string add_distance(Mechanism& mechanism, const std::array<std::string, 2>& bodies,
                         const std::array<Vec3, 2>& points);
// Between coordinates as find_coordinate knows them, which suit the kind.
std::string add_gear(Mechanism& mechanism, const std::array<std::string, 2>& coordinates, double ratio,
                     GearKind kind = GearKind::gear);
// Slack as drawn, and of no length between points that coincide. A damper is a spring without stiffness.
std::string add_spring(Mechanism& mechanism, const std::array<std::string, 2>& bodies,
                       const std::array<Vec3, 2>& points, double stiffness, double damping);
// Of two rows, alike all round, whose axis is that of what turns in it.
inline constexpr double usual_bearing_stiffness = 1e6, usual_bearing_damping = 1000; // N/m, N s/m
std::string add_bearing(Mechanism& mechanism, const std::array<std::string, 2>& bodies, const Vec3& at,
                        const Vec3& axis);
// Every type but spring and bearing. Of drag `vector` does not count and the linear coefficient is 1 N s/m,
// of a vane of 1 dm^2 it is the normal.
std::string add_force(Mechanism& mechanism, ForceType type, const std::string& body, const Vec3& at,
                      const Vec3& vector);

// "ball1", "ball2", ...: the first that no part of the kind has.
std::string unused_name(const Mechanism& mechanism, PartKind kind, std::string_view stem);

} // namespace flyball
