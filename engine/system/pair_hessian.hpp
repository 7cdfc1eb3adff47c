// How the motions of two bodies by their coordinates change as these move: what second derivatives of
// elements between two bodies are made of.
#pragma once

#include "engine/system/linearization.hpp"

namespace flyball {

// A coordinate of an element's support with its column, and which end it moves.
struct PairPart {
  int v, link;
  bool second;
  const Column<double>& column;
};

inline PairPart pair_part(const SupportColumn& s, const Kinematics<double>& k) {
  return {s.v, s.link, s.second, k.columns[static_cast<std::size_t>(s.v)]};
}

// Of two coordinates of one side, j carries i's axis if it lies strictly nearer the root (links are numbered
// from the root outwards); the columns of one spherical link stay put.
inline bool carries(const PairPart& j, const PairPart& i) {
  return j.link < i.link;
}

// d/dq_j of i's motion of a point carried by both: the outer one turns the inner one's motion.
inline Vec3 moved_motion(const PairPart& i, const PairPart& j, const Vec3& point) {
  return carries(j, i) ? Vec3(j.column.turn().cross(i.column.at(point)))
                       : Vec3(i.column.turn().cross(j.column.at(point)));
}

// Second derivative of u_A . (p_B - p_A).
inline double point_hessian(const Vec3& u, const Vec3& b, const PairPart& i, const PairPart& j) {
  if (i.second && j.second) return u.dot(moved_motion(i, j, b));
  if (i.second) return -u.dot(j.column.turn().cross(i.column.at(b)));
  if (j.second) return -u.dot(i.column.turn().cross(j.column.at(b)));
  // Both carry u and neither the point: the deeper one turns the motion that the other makes.
  return carries(j, i) ? u.dot(i.column.turn().cross(j.column.at(b)))
                       : u.dot(j.column.turn().cross(i.column.at(b)));
}

// Change of a carried point's velocity as coordinate j moves, at the point's own new place.
inline Vec3 velocity_change(const PairPart& j, const ScrewRates& s, const Vec3& point, const Vec3& velocity) {
  return s.dv + s.dw.cross(point - j.column.o) + j.column.turn().cross(velocity);
}

} // namespace flyball
