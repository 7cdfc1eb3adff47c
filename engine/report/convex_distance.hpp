// How far two convex solids are apart, and between which of their points.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

// What is within `radius` of a core: of a box or a line by its half edges, to each point of which a disc
// across the first half edge may be added. So a sphere is a point with a radius, a capsule a line with one, a
// cylinder a line with a disc. N: double, or Dual for the numbers with their rates.
template <class N>
struct BasicConvexSolid {
  using Vector = Eigen::Matrix<N, 3, 1>;
  Vector centre = Vector::Zero();                                                   // m
  std::array<Vector, 3> half_edges{Vector::Zero(), Vector::Zero(), Vector::Zero()}; // m, at right angles
  N disc = 0, radius = 0;                                                           // m
};
using ConvexSolid = BasicConvexSolid<double>;

struct ConvexDistance {
  double gap = 0;             // m; below zero the depth: how far they must be moved to come apart
  double error = 0;           // m, of the gap at most: the distance of bounds from both sides, and rounding
  Vec3 normal = Vec3::Zero(); // unit, from the first to the second
  Vec3 a = Vec3::Zero(), b = Vec3::Zero(); // m, of the cores: gap = normal (b - a) less both radii
};

// Exact but for rounding where the cores are apart; where they overlap exact of spheres, capsules and boxes,
// and of a cylinder and a sphere. The depth of other cylinders is not known: the gap then is not a number.
// Where more than one pair of points is nearest it is one of them. Infinite for sizes beyond 1e100 m, or
// within 1e-100 m, whose squares leave no digits.
ConvexDistance find_distance(const ConvexSolid& first, const ConvexSolid& second);

} // namespace flyball
