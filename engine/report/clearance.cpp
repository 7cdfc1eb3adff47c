#include "engine/report/clearance.hpp"

#include "engine/mechanism/mass_properties.hpp"

#include <cmath>
#include <limits>

namespace flyball {
namespace {

// From Parameters::origin.
template <class N>
BasicConvexSolid<N> placed(const Kinematics<N>& k, const BasicSolid<N>& solid) {
  const LinkState<N>& link = k.at(solid.link);
  BasicConvexSolid<N> out = solid.shape;
  out.centre = link.o + link.R * solid.shape.centre;
  for (Vec3T<N>& edge : out.half_edges)
    edge = link.R * edge;
  return out;
}

template <class N>
BasicConvexSolid<N> solid_of(const Shape& shape, const Body& body, const NumberReader<N>& read) {
  BasicConvexSolid<N> out;
  if (is_rod(shape.type)) {
    const Vec3T<N> from = read(shape.from), to = read(shape.to);
    out.centre = N(0.5) * (from + to);
    out.half_edges[0] = N(0.5) * (to - from);
  } else {
    out.centre = read(shape.at, read(body.position));
  }
  if (shape.type == ShapeType::box) {
    const Vec3T<N> size = read(shape.size);
    const Mat3T<N> axes = read(body.rotation).normalized().toRotationMatrix();
    for (int i = 0; i < 3; ++i)
      out.half_edges[static_cast<std::size_t>(i)] = N(0.5) * size[i] * axes.col(i);
  } else {
    (shape.type == ShapeType::cylinder ? out.disc : out.radius) = read(shape.radius);
  }
  return out;
}

Vec3 values(const Vec3T<Dual>& v) {
  return {v[0].value, v[1].value, v[2].value};
}
Vec3 rates(const Vec3T<Dual>& v) {
  return {v[0].rate, v[1].rate, v[2].rate};
}

// Of a point of the core that keeps its place on the half edges and, by its share of the radius, on the disc.
Vec3 carried_rate(const BasicConvexSolid<Dual>& solid, const Vec3& point) {
  Vec3 rest = point - values(solid.centre), out = rates(solid.centre);
  for (const Vec3T<Dual>& dual : solid.half_edges) {
    const Vec3 edge = values(dual);
    if (edge.isZero(0)) continue;
    const double part = rest.dot(edge) / edge.squaredNorm();
    out += part * rates(dual);
    rest -= part * edge;
  }
  if (solid.disc.value == 0) return out;
  const Vec3T<Dual> axis = solid.half_edges[0].normalized();
  return out + rest * (solid.disc.rate / solid.disc.value) - values(axis) * rest.dot(rates(axis));
}

} // namespace

template <class N>
void add_solids(const System& system, const BasicParameters<N>& p, const Mechanism& m, int body,
                const NumberReader<N>& read, std::vector<BasicSolid<N>>& out) {
  const Body& of = m.bodies[static_cast<std::size_t>(body)];
  const int link = system.body_link[static_cast<std::size_t>(body)];
  for (const Shape& shape : of.shapes) {
    out.push_back({link, solid_of(shape, of, read)});
    out.back().shape.centre -= p.origin + p.links[static_cast<std::size_t>(link)].origin;
  }
}
template void add_solids(const System&, const Parameters&, const Mechanism&, int, const NumberReader<double>&,
                         std::vector<Solid>&);
template void add_solids(const System&, const BasicParameters<Dual>&, const Mechanism&, int,
                         const NumberReader<Dual>&, std::vector<BasicSolid<Dual>>&);

Clearance find_clearance(const Kinematics<double>& k, std::span<const Solid> one,
                         std::span<const Solid> other) {
  Clearance least;
  least.gap = std::numeric_limits<double>::infinity();
  const auto carried = [&](int link, const Vec3& p) {
    return TrackedPoint{link, k.at(link).R.transpose() * (p - k.at(link).o)};
  };
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t j = 0; j < other.size(); ++j) {
      const ConvexDistance found = find_distance(placed(k, one[i]), placed(k, other[j]));
      if (found.gap >= least.gap) continue;
      least = {found.gap,
               found.error,
               found.normal,
               carried(one[i].link, found.a),
               carried(other[j].link, found.b),
               i,
               j};
      if (std::isnan(found.gap)) return least;
    }
  return least;
}

double clearance_rate(const Clearance& c, const Kinematics<Dual>& k, std::span<const BasicSolid<Dual>> one,
                      std::span<const BasicSolid<Dual>> other) {
  const auto rate = [&](const BasicSolid<Dual>& solid, const TrackedPoint& point) {
    const LinkState<Dual>& link = k.at(point.link);
    const Vec3 at = values(link.o + link.R * point.at.cast<Dual>());
    return carried_rate(placed(k, solid), at);
  };
  const BasicSolid<Dual>&a = one[c.one], &b = other[c.other];
  return c.normal.dot(rate(b, c.b) - rate(a, c.a)) - a.shape.radius.rate - b.shape.radius.rate;
}

} // namespace flyball
