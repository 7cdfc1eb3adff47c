// The signs that joints, drives, springs, dampers and forces are drawn by.
#pragma once

#include "app/viewport/assembly.hpp"
#include "app/viewport/sketch.hpp"

namespace flyball {

void draw_joint(Sketch& sketch, const Assembly& assembly, std::size_t joint, const Palette& colors);
void draw_gear(Sketch& sketch, const Assembly& assembly, std::size_t joint, const Palette& colors);
void draw_cut_mark(Sketch& sketch, const Assembly& assembly, std::size_t joint, const Palette& colors);
void draw_drives(Sketch& sketch, const Assembly& assembly, std::size_t joint, const Palette& colors);
// The springs and dampers that act on a joint's coordinates.
void draw_joint_forces(Sketch& sketch, const Assembly& assembly, std::size_t joint, const Palette& colors);
void draw_force(Sketch& sketch, const Assembly& assembly, std::size_t force, const Palette& colors);

// A hatched plate: here something is held by ground. `normal` points away from ground.
void draw_anchor(Sketch& sketch, const Vec3& at, const Vec3& normal, double radius, double unit,
                 const Palette& colors);

} // namespace flyball
