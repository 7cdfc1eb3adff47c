// The distance of two convex sets is that of the origin from the set of differences of their points, of which
// only the farthest point in a direction is asked: Gilbert, Johnson and Keerthi, A fast procedure for
// computing the distance between complex objects in three-dimensional space, 1988; the nearest point of a
// simplex as in Wolfe, Finding the nearest point in a polytope, 1976. Every direction bounds the distance
// from below, every point from above. The depth of an overlap is the distance of the origin from the nearest
// plane that bounds the differences; those of lines and boxes are a zonotope, whose planes are known.
#include "engine/report/convex_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double most_size = 1e100; // m: squares of what is larger, or less than its inverse, have no digits

// What of a vector is in the plane of the disc; twice, so that what is left of a small rest is, too.
Vec3 disc_part(const ConvexSolid& s, const Vec3& v) {
  const Vec3 axis = s.half_edges[0].normalized();
  const Vec3 once = v - axis * axis.dot(v), twice = once - axis * axis.dot(once);
  return twice.norm() > 4 * epsilon * v.norm() ? twice : Vec3(Vec3::Zero());
}

// The point of the core, from its centre, that is farthest in a direction.
Vec3 farthest(const ConvexSolid& s, const Vec3& direction) {
  Vec3 out = Vec3::Zero();
  for (const Vec3& edge : s.half_edges)
    out += edge.dot(direction) < 0 ? Vec3(-edge) : edge;
  if (s.disc == 0) return out;
  const Vec3 across = disc_part(s, direction);
  const double length = across.norm();
  return length > 0 ? Vec3(out + across * (s.disc / length)) : out;
}

double extent(const ConvexSolid& s) {
  double sum = s.disc;
  for (const Vec3& edge : s.half_edges)
    sum += edge.norm();
  return sum;
}

// The difference of a point of each.
struct Vertex {
  Vec3 a, b; // of the cores, from their centres
  Vec3 difference;
};

// The least combination of up to four differences, with weights above zero.
class Simplex {
 public:
  // Adds one and finds the nearest point again; false where there is nothing to add.
  bool add(const Vertex& vertex) {
    for (std::size_t i = 0; i < count_; ++i)
      if (vertices_[i].difference == vertex.difference) return false;
    if (count_ == vertices_.size()) return false;
    vertices_[count_] = vertex;
    weights_[count_] = 0;
    ++count_;
    for (;;) {
      const std::array<double, 4> wanted = find_plane();
      double step = 1;
      for (std::size_t i = 0; i < count_; ++i)
        if (wanted[i] <= 0) step = std::min(step, weights_[i] / (weights_[i] - wanted[i] + least));
      for (std::size_t i = 0; i < count_; ++i)
        weights_[i] += step * (wanted[i] - weights_[i]);
      if (step >= 1 || !drop()) break;
    }
    nearest_ = sum(&Vertex::difference);
    return true;
  }

  const Vec3& nearest() const { return nearest_; }
  // At right angles to the plane or line of the vertices, where the nearest point is in it; keeps its digits
  // where this is nearly the origin.
  const Vec3& normal() const { return normal_; }
  bool full() const { return count_ == vertices_.size(); }
  Vec3 sum(Vec3 Vertex::*part) const {
    Vec3 out = Vec3::Zero();
    for (std::size_t i = 0; i < count_; ++i)
      out += weights_[i] * (vertices_[i].*part);
    return out;
  }

 private:
  static constexpr double least = std::numeric_limits<double>::min();

  // The weights, of any sign, of the nearest point in the plane through all of them (Gram and Schmidt,
  // twice).
  std::array<double, 4> find_plane() {
    std::array<Vec3, 3> across;
    std::array<std::array<double, 3>, 3> r{};
    const std::size_t edges = count_ - 1;
    normal_ = vertices_[0].difference;
    std::array<double, 3> along{};
    for (std::size_t i = 0; i < edges; ++i) {
      Vec3 edge = vertices_[i + 1].difference - vertices_[0].difference;
      const double length = edge.norm();
      for (int turn = 0; turn < 2; ++turn)
        for (std::size_t k = 0; k < i; ++k) {
          const double part = across[k].dot(edge);
          r[k][i] += part;
          edge -= part * across[k];
        }
      r[i][i] = edge.norm();
      across[i] = r[i][i] > 8 * epsilon * length ? Vec3(edge / r[i][i]) : Vec3(Vec3::Zero());
    }
    for (int turn = 0; turn < 2; ++turn)
      for (std::size_t k = 0; k < edges; ++k) {
        const double part = across[k].dot(normal_);
        along[k] -= part;
        normal_ -= part * across[k];
      }
    std::array<double, 4> out{1, 0, 0, 0};
    for (std::size_t i = edges; i-- > 0;) {
      double x = along[i];
      for (std::size_t k = i + 1; k < edges; ++k)
        x -= r[i][k] * out[k + 1];
      out[i + 1] = across[i].isZero(0) ? 0 : x / r[i][i];
    }
    out[0] -= out[1] + out[2] + out[3];
    return out;
  }

  // Those that weigh nothing; false where there were none.
  bool drop() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i)
      if (weights_[i] > 4 * epsilon) {
        vertices_[kept] = vertices_[i];
        weights_[kept++] = weights_[i];
      }
    if (kept == 0) return false; // of weights that are no numbers
    const bool some = kept < count_;
    count_ = kept;
    double all = 0;
    for (std::size_t i = 0; i < count_; ++i)
      all += weights_[i];
    for (std::size_t i = 0; i < count_; ++i)
      weights_[i] /= all;
    return some;
  }

  std::array<Vertex, 4> vertices_;
  std::array<double, 4> weights_{};
  std::size_t count_ = 0;
  Vec3 nearest_ = Vec3::Zero(), normal_ = Vec3::Zero();
};

// Of the cores, the first of them moved.
struct Apart {
  double distance = 0, below = 0; // m; not less than the latter
  Vec3 normal, a, b;              // a and b from the centres
};

// No distance where they overlap. `offset`: of the first centre from the second.
Apart find_apart(const ConvexSolid& first, const ConvexSolid& second, const Vec3& offset) {
  constexpr int most = 200, idle = 8; // steps; of them without any gain
  const double touching = 8 * epsilon * (extent(first) + extent(second) + offset.norm());
  Apart out{0, 0, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto vertex = [&](const Vec3& toward) {
    Vertex v{farthest(first, toward), farthest(second, -toward), {}};
    v.difference = offset + (v.a - v.b);
    return v;
  };
  Simplex simplex;
  simplex.add(vertex(-offset));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0, gained = 0; i < most && i - gained < idle; ++i) {
    const Vec3& nearest = simplex.nearest();
    out.distance = nearest.norm();
    if (out.distance <= touching || simplex.full()) {
      out.distance = 0;
      break;
    }
    const Vec3 away = simplex.normal().norm() > 0 && simplex.normal().dot(nearest) > 0
                          ? Vec3(simplex.normal().normalized())
                          : Vec3(nearest / out.distance);
    const Vertex next = vertex(-away);
    const double below = away.dot(next.difference);
    if (out.distance < least || below > out.below) gained = i;
    least = std::min(least, out.distance);
    if (i == 0 || below > out.below) {
      out.below = below;
      out.normal = -away;
    }
    if (out.distance - out.below <= touching || !simplex.add(next)) break;
  }
  out.a = simplex.sum(&Vertex::a);
  out.b = simplex.sum(&Vertex::b);
  return out;
}

// Directions at right angles to every plane that may bound the differences of the cores. All of them but for
// discs, between which and edges there are curved surfaces: `complete` tells.
template <class Act>
bool visit_normals(const ConvexSolid& first, const ConvexSolid& second, const Vec3& offset, const Act& act) {
  std::array<Vec3, 6> edges;
  std::size_t count = 0;
  for (const ConvexSolid* each : {&first, &second})
    for (const Vec3& edge : each->half_edges)
      if (!edge.isZero(0)) edges[count++] = edge;
  act(count == 0 ? Vec3(Vec3::UnitZ()) : edges[0].unitOrthogonal()); // where they are a line or a point
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 normal = edges[i].cross(edges[k]);
      if (normal.norm() > 1e-14 * edges[i].norm() * edges[k].norm()) act(Vec3(normal.normalized()));
    }
  bool complete = true;
  for (const ConvexSolid* each : {&first, &second}) {
    if (each->disc == 0) continue;
    const Vec3 axis = each->half_edges[0], across = disc_part(*each, offset);
    act(Vec3(axis.normalized()));
    act(across.norm() > 0 ? Vec3(across.normalized()) : axis.unitOrthogonal());
    complete = complete && count == 1; // the other is a point
  }
  return complete;
}

} // namespace

ConvexDistance find_distance(const ConvexSolid& first, const ConvexSolid& second) {
  const Vec3 offset = first.centre - second.centre;
  const double size = extent(first) + extent(second) + offset.norm(), radii = first.radius + second.radius,
               rounding = 16 * epsilon * (size + radii);
  const double infinity = std::numeric_limits<double>::infinity();
  if (!(size + radii < most_size && size + radii > 1 / most_size))
    return {.gap = infinity, .error = infinity};
  const auto placed = [&](double gap, double error, const Apart& at) {
    return ConvexDistance{gap - radii, error + rounding, at.normal, first.centre + at.a,
                          second.centre + at.b};
  };
  Apart apart = find_apart(first, second, offset);
  if (apart.distance > 0) return placed(apart.distance, apart.distance - apart.below, apart);

  double depth = infinity;
  Vec3 normal = Vec3::Zero();
  const bool complete = visit_normals(first, second, offset, [&](const Vec3& each) {
    const Vec3 n = each.dot(offset) > 0 ? Vec3(-each) : each;
    const double reach = n.dot(offset) + n.dot(farthest(first, n) - farthest(second, -n));
    if (reach >= depth) return;
    depth = reach;
    normal = n;
  });
  // Moved apart along the nearest plane's normal, and a little further, they are nearest where it touches.
  const double room = size + radii;
  apart = find_apart(first, second, offset - (depth + room) * normal);
  apart.normal = normal;
  const double known = complete || depth <= rounding ? 0 : std::numeric_limits<double>::quiet_NaN();
  return placed(known - depth, std::abs(apart.distance - room), apart);
}

} // namespace flyball
