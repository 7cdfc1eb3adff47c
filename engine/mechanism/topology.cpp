#include "engine/mechanism/topology.hpp"

#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Laws of drives are compiled with the places of points in the list.
bool same_points(const Mechanism& a, const Mechanism& b) {
  return std::ranges::equal(a.points, b.points, {}, &NamedPoint::name, &NamedPoint::name);
}

// Drives of coordinate i: none, by speed, or by torques that are both numbers or the same expressions.
bool same_kind(const Mechanism& of_a, const Joint& a, const Mechanism& of_b, const Joint& b, int i) {
  const auto &x = a.coordinates[static_cast<std::size_t>(i)].drive,
             &y = b.coordinates[static_cast<std::size_t>(i)].drive;
  if (!x || !y) return x.has_value() == y.has_value();
  if (x->torque.has_value() != y->torque.has_value() || x->keeps != y->keeps) return false;
  if (!x->torque) return true;
  for (const char* which : {"torque", "load"}) {
    const Formula *law_a = drive_law(of_a, a, i, which), *law_b = drive_law(of_b, b, i, which);
    if ((law_a == nullptr) != (law_b == nullptr)) return false;
    if (!law_a) continue;
    if (!same_points(of_a, of_b) || with_measures(of_a, law_a->text) != with_measures(of_b, law_b->text))
      return false;
  }
  return true;
}

bool same_law(const Formula* a, const Formula* b) {
  return (a == nullptr) == (b == nullptr) && (!a || a->text == b->text);
}

bool same_laws(const Joint& a, const Joint& b, int i) {
  const Coordinate &x = a.coordinates[static_cast<std::size_t>(i)],
                   &y = b.coordinates[static_cast<std::size_t>(i)];
  return (x.spring && x.spring->force) == (y.spring && y.spring->force) &&
         x.damping_force.has_value() == y.damping_force.has_value() &&
         same_law(spring_law(a, i), spring_law(b, i)) && same_law(damper_law(a, i), damper_law(b, i));
}

bool same_laws(const Force& a, const Force& b) {
  return a.force.has_value() == b.force.has_value() &&
         a.damping_force.has_value() == b.damping_force.has_value() &&
         same_law(spring_law(a), spring_law(b)) && same_law(damper_law(a), damper_law(b)) &&
         a.lift.has_value() == b.lift.has_value() && a.drag.has_value() == b.drag.has_value() &&
         same_law(lift_law(a), lift_law(b)) && same_law(drag_law(a), drag_law(b));
}

} // namespace

bool same_topology(const Mechanism& a, const Mechanism& b) {
  if (a.bodies.size() != b.bodies.size() || a.joints.size() != b.joints.size() ||
      a.forces.size() != b.forces.size() || a.air.turns_with != b.air.turns_with)
    return false;
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    if (a.bodies[i].name != b.bodies[i].name) return false;
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    const Joint &x = a.joints[i], &y = b.joints[i];
    if (x.name != y.name || x.type != y.type || x.bodies != y.bodies || x.cut != y.cut ||
        x.joints != y.joints || x.coordinates.size() != y.coordinates.size())
      return false;
    for (std::size_t k = 0; k < x.coordinates.size(); ++k) {
      const Coordinate &c = x.coordinates[k], &d = y.coordinates[k];
      if (c.spring.has_value() != d.spring.has_value() || c.stop.has_value() != d.stop.has_value() ||
          c.friction.has_value() != d.friction.has_value() || !same_kind(a, x, b, y, static_cast<int>(k)) ||
          (c.damping != 0) != (d.damping != 0) || !same_laws(x, y, static_cast<int>(k)))
        return false;
    }
  }
  for (std::size_t i = 0; i < a.forces.size(); ++i) {
    const Force &x = a.forces[i], &y = b.forces[i];
    if (x.name != y.name || x.type != y.type || x.bodies != y.bodies || x.body != y.body ||
        x.frame != y.frame || (x.damping != 0) != (y.damping != 0) || !same_laws(x, y) ||
        bearing_size(x) != bearing_size(y))
      return false;
  }
  return true;
}

void find_dampers(const Mechanism& m, std::vector<bool>& dampers) {
  dampers.clear();
  for (const Joint& joint : m.joints)
    for (const Coordinate& coordinate : joint.coordinates)
      dampers.push_back(coordinate.damping != 0);
  for (const Force& force : m.forces)
    dampers.push_back(force.damping != 0);
}

} // namespace flyball
