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

PointMotion point_motion(const Parameters& p, const Kinematics<double>& k, const TrackedPoint& point) {
  const LinkState<double>& x = k.at(point.link);
  const Vec3 arm = x.R * point.at;
  // The ground carries gravity as a fictitious acceleration.
  return {p.origin + x.o + arm, x.v + x.w.cross(arm),
          x.dv - k.ground.dv + x.dw.cross(arm) + x.w.cross(x.w.cross(arm))};
}

} // namespace flyball
