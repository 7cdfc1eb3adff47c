// How far two bodies are apart, by the shapes they are drawn with.
#pragma once

#include "engine/report/convex_distance.hpp"
#include "engine/system/point_motion.hpp"

#include <span>

namespace flyball {

// A shape that a link carries, from the link's origin in the axes of the drawn pose.
template <class N>
struct BasicSolid {
  int link = -1;
  BasicConvexSolid<N> shape;
};
using Solid = BasicSolid<double>;

// Adds the shapes of a body. Instantiated for double and Dual.
template <class N>
void add_solids(const System& system, const BasicParameters<N>& parameters, const Mechanism& mechanism,
                int body, const NumberReader<N>& read, std::vector<BasicSolid<N>>& out);

// m, below zero where they overlap; infinite where one has no solids, not a number where the depth is not
// known (see find_distance).
struct Clearance {
  double gap = 0, error = 0;      // m
  Vec3 normal = Vec3::Zero();     // unit, from the one to the other
  TrackedPoint a, b;              // of the cores
  std::size_t one = 0, other = 0; // between which solids
};
Clearance find_clearance(const Kinematics<double>& kinematics, std::span<const Solid> one,
                         std::span<const Solid> other);

// How fast the gap changes with the numbers' rates: the nearest points are taken along with their solids, as
// what they move on these changes their distance in second order only.
double clearance_rate(const Clearance& clearance, const Kinematics<Dual>& kinematics,
                      std::span<const BasicSolid<Dual>> one, std::span<const BasicSolid<Dual>> other);

} // namespace flyball
