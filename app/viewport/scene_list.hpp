// What would be drawn: a mechanism in given poses as a list of simple solids. No OpenGL, so that tests
// and picking see exactly what the renderer sees.
#pragma once

#include "app/document/body_hues.hpp"
#include "app/document/part.hpp"
#include "app/viewport/bounds.hpp"
#include "app/viewport/theme.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball {

// Unit solids. The surface point of a vertex is  position + rotation * (core * extent + normal * round):
// `extent` scales the core of the solid, `round` (m) is the radius of its edges, ends, tube or wire.
enum class Primitive {
  sphere,      // core a point: radius = round
  capsule,     // core the line from -z to +z
  cylinder,    // core the disc of radius 1 swept from -z to +z; its edges are rounded
  box,         // core the cube from -1 to 1; its edges are rounded
  tube,        // like the cylinder with a hole of 0.62 of the radius
  cone,        // base disc of radius 1 at z = 0, tip at z = 1; extent uniform in x and y
  bowl,        // open half shell of radius 1 below z = 0; extent uniform
  ring,        // circle of radius 1 about z, as a tube of radius round
  arc,         // three quarters of it, from +x counter-clockwise
  broken_ring, // the ring in four dashes
  coil,        // eight turns about z from z = 0 to z = 1, ends running to the axis
  open_coil,   // the same with ends that close around a rod
  spiral,      // flat spiral about z, from the axis out to +x
  gear,        // toothed disc about z from -1 to 1
};
inline constexpr int primitive_count = 14;

enum class Surface { plain, metal, hatched };

// What an instance stands for.
enum class Role {
  body,
  joint,
  anchor,
  drive,
  spring,
  damper,
  force,
  cut_mark,
  link,
};

struct Instance {
  Primitive primitive = Primitive::sphere;
  Vec3 position = Vec3::Zero(); // m, world
  Quat rotation = Quat::Identity();
  Vec3 extent = Vec3::Zero(); // m
  double round = 0;           // m
  Color color;
  Surface surface = Surface::plain;
  Role role = Role::body;
  PartId part;
};

// Lengths that glyphs are drawn with, from the drawn pose alone so that nothing changes size while parts
// move.
struct SceneScale {
  double unit = 0.02; // m, about the radius of a joint
  Bounds bounds;      // of the drawn pose's points
  Vec3 up = Vec3::UnitY();
};
SceneScale scene_scale(const Mechanism& mechanism);

struct SceneOptions {
  Theme theme = Theme::light;
  bool joints = true, drives = true, forces = true; // forces: springs and dampers too
  std::span<const std::string> cut_joints{};        // names, to be marked
  BodyColouring colouring{};
};

struct SceneList {
  std::vector<Instance> instances;
  Bounds bounds; // of all instances
  SceneScale scale;
  double floor = 0; // m along scale.up: below everything, at every phase of the drives
};

// `poses` has a pose for each body (else the drawn poses are used). Instances that are not finite are left
// out.
SceneList build_scene(const Mechanism& mechanism, std::span<const Pose> poses,
                      const SceneOptions& options = {});
// Bodies and distance links only, in one colour: the drawn pose or the damped motion behind the solid one.
std::vector<Instance> build_ghost(const Mechanism& mechanism, std::span<const Pose> poses, Color color);
// The same with a colour for each body, that of links, and without those bodies (and links between them)
// that stand in the poses `beside` as well.
struct GhostColors {
  std::vector<Color> bodies;
  Color links;
};
std::vector<Instance> build_ghost(const Mechanism& mechanism, std::span<const Pose> poses,
                                  const GhostColors& colors, std::span<const Pose> beside);

// Box around one instance, world coordinates.
Bounds instance_bounds(const Instance& instance);

} // namespace flyball
