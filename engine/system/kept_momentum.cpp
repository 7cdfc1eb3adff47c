#include "engine/system/kept_momentum.hpp"

#include "engine/system/extended.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Calls act(drive, link) for each.
template <class Act>
void for_kept(const System& system, const Act& act) {
  for (std::size_t i = 0; i < system.torques.size(); ++i)
    if (system.torques[i].keeps_momentum) act(i, system.torques[i].link);
}

// Calls act(l) for each link with mass that hangs from `from`, itself included.
template <class N, class Act>
void for_bodies(const System& system, const BasicParameters<N>& p, int from, const Act& act) {
  for (int l = from; l < static_cast<int>(system.links.size()); ++l)
    if (const BasicLinkParameters<N>& lp = p.links[static_cast<std::size_t>(l)];
        (lp.mass != N(0) || lp.has_inertia) && hangs_from(system, l, from))
      act(l, lp);
}

template <class S>
S momentum(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k, int from) {
  const LinkState<S>& turning = k.links[static_cast<std::size_t>(from)];
  const bool turns = system.links[static_cast<std::size_t>(from)].type == LinkType::revolute;
  S sum = 0;
  for_bodies<NumberOf<S>>(system, p, from, [&](int l, const LinkParametersOf<S>& lp) {
    const LinkState<S>& x = k.links[static_cast<std::size_t>(l)];
    const Vec3T<S> c = x.R * lp.com.template cast<S>();
    const Vec3T<S> linear = S(lp.mass) * (x.v + x.w.cross(c));
    if (!turns) {
      sum += turning.axis.dot(linear);
      return;
    }
    Vec3T<S> angular = (x.o + c - turning.o).cross(linear);
    if (lp.has_inertia) angular += x.R * (lp.inertia.template cast<S>() * (x.R.transpose() * x.w));
    sum += turning.axis.dot(angular);
  });
  return sum;
}

// The sum of what its bodies have, whichever way it points.
double momentum_size(const System& system, const Parameters& p, const Kinematics<double>& k, int from) {
  const LinkState<double>& turning = k.links[static_cast<std::size_t>(from)];
  const bool turns = system.links[static_cast<std::size_t>(from)].type == LinkType::revolute;
  double sum = 0;
  for_bodies<double>(system, p, from, [&](int l, const LinkParameters& lp) {
    const LinkState<double>& x = k.links[static_cast<std::size_t>(l)];
    const Vec3 c = x.R * lp.com;
    const double linear = lp.mass * (x.v + x.w.cross(c)).norm();
    sum += turns ? (x.o + c - turning.o).norm() * linear + lp.inertia.norm() * x.w.norm() : linear;
  });
  return sum;
}

// Of all that hangs from each link, about its origin; Linearization::composites has the linear ones.
void fill_spins(const System& system, const Parameters& p, const Kinematics<double>& k, Linearization& out) {
  out.spins.assign(system.links.size(), Vec3::Zero());
  for (std::size_t i = system.links.size(); i-- > 0;) {
    if (!system.links[i].mobile) continue;
    const LinkState<double>& x = k.links[i];
    const LinkParameters& lp = p.links[i];
    const Vec3 c = x.R * lp.com;
    out.spins[i] += c.cross(lp.mass * (x.v + x.w.cross(c))) + x.R * (lp.inertia * (x.R.transpose() * x.w));
    if (const int parent = system.links[i].parent; parent >= 0)
      out.spins[static_cast<std::size_t>(parent)] +=
          out.spins[i] + (x.o - k.at(parent).o).cross(out.composites[i].momentum);
  }
}

// The row of the momentum of what hangs from `from`. A coordinate beyond moves what hangs from it by its
// screw S, and changes its velocities by I Psi' (linearization.hpp); one before changes those of all, the
// axis carried along. A speed changes the momentum by the mass between the two.
void fill_row(const System& system, const Kinematics<double>& k, int from, Linearization& out) {
  const Link& turning = system.links[static_cast<std::size_t>(from)];
  const ScrewRates& own = out.screws[static_cast<std::size_t>(turning.v)];
  const LinearizedWrench carried =
      times_inertia(out.composites[static_cast<std::size_t>(from)], own.sw, own.sv);
  const Vec3& origin = k.at(from).o;
  auto row = out.stiffness.row(turning.v);
  row.setZero();
  for (int l = 0; l < static_cast<int>(system.links.size()); ++l) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (link.v < 0) continue;
    const bool beyond = hangs_from(system, l, from);
    if (!beyond && !hangs_from(system, from, l)) continue;
    const Vec3 arm = beyond ? Vec3(k.at(l).o - origin) : Vec3(origin - k.at(l).o);
    for (int j = link.v; j < link.v + (link.type == LinkType::spherical ? 3 : 1); ++j) {
      const ScrewRates& s = out.screws[static_cast<std::size_t>(j)];
      if (!beyond) {
        const Vec3 &w = finds_speed(link) ? s.sw : s.dw, &v = finds_speed(link) ? s.sv : s.dv;
        row[j] = w.dot(carried.moment + arm.cross(carried.force)) + v.dot(carried.force);
        continue;
      }
      const CompositeBody& b = out.composites[static_cast<std::size_t>(l)];
      LinearizedWrench h = finds_speed(link) ? times_inertia(b, s.sw, s.sv) : times_inertia(b, s.dw, s.dv);
      if (!finds_speed(link)) {
        h.moment += s.sw.cross(out.spins[static_cast<std::size_t>(l)]) + s.sv.cross(b.momentum);
        h.force += s.sw.cross(b.momentum);
      }
      row[j] = own.sw.dot(h.moment + arm.cross(h.force)) + own.sv.dot(h.force);
    }
  }
}

} // namespace

bool keeps_momentum(const System& system) {
  return std::ranges::any_of(system.torques, &DriveTorqueElement::keeps_momentum);
}

template <class N>
N drawn_momentum(const System& system, const BasicParameters<N>& p, int from) {
  using Vector = Vec3T<N>;
  const auto turning = static_cast<std::size_t>(from);
  const bool turns = system.links[turning].type == LinkType::revolute;
  N sum = 0;
  for_bodies(system, p, from, [&](int l, const BasicLinkParameters<N>& lp) {
    const Vector centre = lp.origin + lp.com;
    Vector w = Vector::Zero(), v = Vector::Zero();
    for (int up = l; up >= 0; up = system.links[static_cast<std::size_t>(up)].parent) {
      const Link& link = system.links[static_cast<std::size_t>(up)];
      const BasicLinkParameters<N>& by = p.links[static_cast<std::size_t>(up)];
      if (by.speed == N(0)) continue;
      const Vector rate = by.axis * by.speed;
      if (link.type == LinkType::revolute) {
        w += rate;
        v += rate.cross(centre - by.origin);
      } else {
        v += rate;
      }
    }
    const Vector linear = lp.mass * v;
    sum += p.links[turning].axis.dot(
        turns ? Vector((centre - p.links[turning].origin).cross(linear) + lp.inertia * w) : linear);
  });
  return sum;
}

template <class S>
void set_kept_momenta(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k,
                      Residual<S>& out) {
  if (!keeps_momentum(system)) return;
  out.taken.setZero(static_cast<Eigen::Index>(system.torques.size()));
  for_kept(system, [&](std::size_t i, int l) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (!finds_speed(link)) return;
    out.taken[static_cast<Eigen::Index>(i)] = out.f[link.v];
    out.f[link.v] = momentum<S>(system, p, k, l) - S(p.torques[i].momentum);
  });
}

void set_kept_momentum_sizes(const System& system, const Parameters& p, const Kinematics<double>& k,
                             Magnitudes& out) {
  if (!keeps_momentum(system)) return;
  out.taken.setZero(static_cast<Eigen::Index>(system.torques.size()));
  for_kept(system, [&](std::size_t i, int l) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (!finds_speed(link)) return;
    out.taken[static_cast<Eigen::Index>(i)] = out.force[link.v];
    out.force[link.v] = momentum_size(system, p, k, l) + std::abs(p.torques[i].momentum);
  });
}

void set_kept_momentum_stiffness(const System& system, const Parameters& p, const Kinematics<double>& k,
                                 Linearization& out) {
  if (!keeps_momentum(system)) return;
  fill_spins(system, p, k, out);
  for_kept(system, [&](std::size_t, int l) { fill_row(system, k, l, out); });
}

template double drawn_momentum<double>(const System&, const Parameters&, int);
template Dual drawn_momentum<Dual>(const System&, const BasicParameters<Dual>&, int);
template void set_kept_momenta<double>(const System&, const Parameters&, const Kinematics<double>&,
                                       Residual<double>&);
template void set_kept_momenta<Extended>(const System&, const Parameters&, const Kinematics<Extended>&,
                                         Residual<Extended>&);
template void set_kept_momenta<Dual>(const System&, const BasicParameters<Dual>&, const Kinematics<Dual>&,
                                     Residual<Dual>&);

} // namespace flyball
