#include "engine/system/point_motion.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"

namespace flyball {

TrackedPoint find_point(const System& system, const Mechanism& mechanism, const Parameters& p,
                        const BodyPoint& point) {
  const int body = body_index(mechanism, point.body);
  if (body < 0) {
    std::vector<std::string_view> names;
    for (const Body& b : mechanism.bodies)
      names.push_back(b.name);
    throw SceneError("point " + point_label(point), "no body is called \"" + point.body + "\"" +
                                                        did_you_mean(point.body, names) + "; expected " +
                                                        (names.empty() ? "a body" : word_list(names)));
  }
  const auto b = static_cast<std::size_t>(body);
  const int link = system.body_link[b];
  return {link, point.at.value_or(mechanism.bodies[b].position) - p.origin -
                    p.links[static_cast<std::size_t>(link)].origin};
}

template <class N>
BasicPointMotion<N> motion_of(const BasicParameters<N>& p, const Kinematics<N>& k,
                              const BasicTrackedPoint<N>& point) {
  const LinkState<N>& x = k.at(point.link);
  const Vec3T<N> arm = x.R * point.at;
  // The ground carries gravity as a fictitious acceleration.
  return {p.origin + x.o + arm, x.v + x.w.cross(arm),
          x.dv - k.ground.dv + x.dw.cross(arm) + x.w.cross(x.w.cross(arm))};
}
template BasicPointMotion<double> motion_of(const Parameters&, const Kinematics<double>&,
                                            const TrackedPoint&);
template BasicPointMotion<Dual> motion_of(const BasicParameters<Dual>&, const Kinematics<Dual>&,
                                          const BasicTrackedPoint<Dual>&);

PointMotion point_motion(const Parameters& p, const Kinematics<double>& k, const TrackedPoint& point) {
  const BasicPointMotion<double> motion = motion_of(p, k, point);
  return {motion.position, motion.velocity, motion.acceleration};
}

namespace {

PointRates point_rates(const Column<double>& column, const LinkState<double>& carrier,
                       const LinkState<double>& link, const Vec3& x) {
  const Vec3 arm = x - link.o, from = x - carrier.o;
  const Vec3& w = carrier.w;
  const Vec3 velocity = link.v + link.w.cross(arm);
  const Vec3 relative = velocity - carrier.v - w.cross(from);
  const Vec3 dx = column.at(x);
  PointRates out{dx, w.cross(dx), carrier.dw.cross(dx) + w.cross(w.cross(dx))};
  if (!column.angular) return out;
  const Vec3 acceleration = link.dv + link.dw.cross(arm) + link.w.cross(link.w.cross(arm));
  const Vec3 carried = carrier.dv + carrier.dw.cross(from) + w.cross(w.cross(from));
  const Vec3 relative_acceleration = acceleration - carried - 2 * w.cross(relative);
  const Vec3 turned = column.axis.cross(relative);
  out.velocity += turned;
  out.acceleration += 2 * w.cross(turned) + column.axis.cross(relative_acceleration);
  return out;
}

} // namespace

void visit_point_rates(const System& system, const Kinematics<double>& k, const TrackedPoint& point,
                       const std::function<void(int v, const PointRates& rates)>& act) {
  const Vec3 x = k.point(point.link, point.at);
  for (int l = point.link; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (link.v < 0) continue;
    const int count = link.type == LinkType::spherical ? 3 : 1;
    for (int v = link.v; v < link.v + count; ++v)
      act(v, point_rates(k.columns[static_cast<std::size_t>(v)], k.at(link.parent), k.at(point.link), x));
  }
}

} // namespace flyball
