// What of a force or torque redundant loops leave open: along some directions many others balance as well,
// and what lies across these is unique. Told by the multipliers that balance among themselves
// (Phi_q^T lambda = 0): what none of them moves is unique.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <vector>

namespace flyball {

struct OpenDirections {
  Mat3 projector = Mat3::Zero(); // orthogonal, onto the open directions

  bool any() const { return projector.diagonal().maxCoeff() > 0; }
  bool component(int i) const { return projector(i, i) > 0; }
  // Every component is open or unique altogether.
  bool along_axes() const { return projector.isDiagonal(0); }
  Vec3 unique_part(const Vec3& v) const { return v - projector * v; }
};

// Of a force and a torque about one point.
struct OpenWrench {
  OpenDirections force, torque;
  bool any() const { return force.any() || torque.any(); }
};

// Spanned by what changes a vector; changes up to `least` are rounding.
OpenDirections open_directions(std::vector<Vec3> changes, double least);

} // namespace flyball
