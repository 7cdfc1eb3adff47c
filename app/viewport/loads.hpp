// What acts on the bodies of a steady state: reactions of joints and bearings, drives, springs, weights,
// applied loads, the air and inertial loads, each as a force or a moment at a point. No OpenGL.
#pragma once

#include "app/viewport/assembly.hpp"
#include "engine/report/analysis.hpp"

#include <optional>
#include <span>
#include <vector>

namespace flyball {

// damper: dry friction, too.
enum class LoadKind { reaction, drive, spring, damper, gear, weight, applied, air, inertia };
inline constexpr std::size_t load_kinds = 9;

struct Load {
  LoadKind kind = LoadKind::reaction;
  bool moment = false;        // N m rather than N
  Vec3 at = Vec3::Zero();     // m, world
  Vec3 vector = Vec3::Zero(); // N or N m, world
  PartId part;                // the joint, gear, spring, bearing, force or body that it comes from
};

// A force or moment of this size along a joint's coordinate, on its child.
Load load_along(const Assembly& assembly, LoadKind kind, std::size_t joint, std::size_t index, double value);
// Where what acts through a joint acts on its child (m): of a link at its end there; and through a bearing on
// its second body.
Vec3 reaction_place(const Assembly& assembly, std::size_t joint);
Vec3 bearing_place(const Assembly& assembly, std::size_t force);

// The rotation that carries the loads at the drawn phase of the drives to the phase with these poses, where
// there is one: all bodies have turned alike, no reaction changes with the phase, and gravity looks the same.
std::optional<Quat> common_turn(const Mechanism& mechanism, const Solution& solution,
                                std::span<const Pose> poses);

// Of a steady state and how its bodies turn (both at the drawn phase); the assembly has its poses, turned by
// `turn` since then.
//   body < 0: of the mechanism. What each joint's parent exerts on its child, and each bearing on its second
//     body; of the former, what drives (and, as applied, the loads against them), springs and stops, dampers,
//     friction and gears exert along the joints' coordinates; springs between bodies, on both; the air;
//     inertial loads.
//   a body: its free-body diagram, which is complete: its forces, -m a of the mass centre included, add up to
//     zero, and so do their moments with the couples, -d(I w)/dt included (d'Alembert). What acts along the
//     coordinates of hinges and slides is told by itself there, and is no part of their reactions.
std::vector<Load> loads_of(const Assembly& assembly, const Solution& solution,
                           std::span<const AngularMotion> turning, int body,
                           const Quat& turn = Quat::Identity());

} // namespace flyball
