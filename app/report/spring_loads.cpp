#include "app/report/spring_loads.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/system/elastic_force.hpp"

#include <algorithm>

namespace flyball {
namespace {

SpringLoad elastic(std::string name, const char* kind, bool angle, double at, double deflection,
                   const ElasticForce& by, double sign) {
  return {std::move(name), kind, angle, at, deflection, sign * by.force, by.energy};
}

} // namespace

std::vector<SpringLoad> spring_loads(const Mechanism& m, const Solution& solution) {
  std::vector<SpringLoad> out;
  for (const CoordinateSolution& c : solution.coordinates) {
    const int joint = joint_index(m, c.joint);
    if (joint < 0) continue;
    const Coordinate& coordinate =
        m.joints[static_cast<std::size_t>(joint)].coordinates[static_cast<std::size_t>(c.index)];
    const auto add = [&](const char* kind, double deflection, const ElasticForce& by) {
      out.push_back(elastic(coordinate_label(c), kind, c.angle, c.value, deflection, by, -1));
    };
    if (const auto& spring = coordinate.spring) {
      const double deflection = c.value - spring->free;
      add("spring on a joint", deflection,
          elastic_force(m, m.joints[static_cast<std::size_t>(joint)], c.index, deflection));
    }
    if (!coordinate.stop) continue;
    const Stop& stop = *coordinate.stop;
    const auto beyond = [&](double deflection) {
      add("stop", deflection, {stop.stiffness * deflection, stop.stiffness * deflection * deflection / 2});
    };
    if (stop.lower && c.value < *stop.lower) beyond(c.value - *stop.lower);
    if (stop.upper && c.value > *stop.upper) beyond(c.value - *stop.upper);
  }
  if (solution.poses.size() != m.bodies.size()) return out;
  for (const Force& f : m.forces) {
    if (f.type != ForceType::spring) continue;
    const auto end = [&](std::size_t i) {
      return carried_point(m, solution.poses, body_index(m, f.bodies[i]), f.points[i]);
    };
    const double length = (end(1) - end(0)).stableNorm();
    const double free = f.free_length.value_or(drawn_distance(f.points));
    out.push_back(elastic(f.name, "spring between bodies", false, length, length - free,
                          elastic_force(m, f, length - free), 1));
  }
  return out;
}

} // namespace flyball
