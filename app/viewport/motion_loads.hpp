// What acts on the bodies at a moment of a motion whose loads were recorded. No OpenGL.
#pragma once

#include "app/viewport/load_arrows.hpp"
#include "engine/dynamics/simulation.hpp"

namespace flyball {

// What each joint's parent exerts on its child, and each bearing on its second body; of the former what
// drives (and, as applied, the loads against them), springs and stops, dampers and gears exert along the
// joints' coordinates; springs between bodies with their dampers, on both. Between samples in proportion. The
// assembly has the poses of that moment (s). Inertial loads and the air are not recorded.
std::vector<Load> loads_at(const Assembly& assembly, const Run& motion, double time);

// The free-body diagram of one body at that moment, as loads_of() has it, inertial loads and the air
// included: the motion is integrated from the last sample to the moment. Nothing where accelerations are not
// known, as those of what carries bodies without mass, and of more than 50 bodies.
std::optional<std::vector<Load>> diagram_at(const Assembly& assembly, const Run& motion, double time,
                                            int body);

// Lengths of arrows that are the same through all of the motion.
LoadScales motion_load_scales(const Assembly& assembly, const Run& motion,
                              std::optional<LoadLengths> lengths);
// Of a body's diagram at one moment, in proportion: to the largest there, and that joints and bearings do to
// it through all of the motion.
LoadScales diagram_scales(const Assembly& assembly, const Run& motion, int body,
                          const std::vector<Load>& diagram);

} // namespace flyball
