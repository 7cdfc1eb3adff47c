#include "engine/system/law_elements.hpp"

#include <algorithm>

namespace flyball {
namespace {

const Joint& joint_of(const Mechanism& m, const System& s, int tree_joint) {
  return m.joints[static_cast<std::size_t>(s.tree_joints[static_cast<std::size_t>(tree_joint)].joint)];
}

// Where a coordinate stands that a law asks for.
int tree_coordinate(const Mechanism& m, const System& s, const ResultQuantity& asked) {
  const ResultQuantity::Of& at = asked.of[0];
  const bool rate = asked.result == Result::rate;
  const std::string name = coordinate_name(m.joints[static_cast<std::size_t>(at.part)], at.coordinate);
  const auto found = std::ranges::find_if(s.coordinates, [&](const CoordinateInfo& c) {
    return s.tree_joints[static_cast<std::size_t>(c.tree_joint)].joint == at.part && c.index == at.coordinate;
  });
  if (found == s.coordinates.end())
    throw ExpressionError("expected a coordinate that closes no loop, found " + name +
                          "; with \"cut\": false on that joint its loop is cut elsewhere");
  const Link& link = s.links[static_cast<std::size_t>(found->link)];
  if (link.drive >= 0 && !rate)
    throw ExpressionError("expected a rate: the coordinate " + name + " goes on and on as its drive turns");
  if (rate && link.type == LinkType::spherical)
    throw ExpressionError("expected no rate of " + name + ", a component of a rotation vector");
  return static_cast<int>(found - s.coordinates.begin());
}

DriveLaw::Input input_of(const Mechanism& m, const System& s, const ResultCall& call) {
  DriveLaw::Input out{find_law_quantity(m, call)};
  if (asks_for_coordinate(call)) out.coordinate = tree_coordinate(m, s, out.quantity);
  if (call.result >= Result::length && call.result <= Result::couple) {
    const auto place = [&](const auto& elements, auto force) {
      const auto found = std::ranges::find(elements, out.quantity.of[0].part, force);
      return found == elements.end() ? -1 : static_cast<int>(found - elements.begin());
    };
    out.spring = place(s.springs, &PointSpringElement::force);
    out.bearing = place(s.bearings, &BearingElement::force);
  }
  return out;
}

DriveLaw law_of(const Mechanism& m, const System& s, const Joint& of, int coordinate,
                std::string_view which) {
  DriveLaw out;
  read_drive_law_of(m, of, coordinate, which, [&](const Expression& law) {
    for (const ResultCall& call : law.results())
      out.inputs.push_back(input_of(m, s, call));
    out.expression = law;
  });
  return out;
}

// The momentum of the drawn pose is given only where nothing that a torque turns has a share in it.
void expect_given_momentum(const System& s) {
  const auto name_at = [&](int link) -> const std::string& {
    const int t = s.links[static_cast<std::size_t>(link)].tree_joint;
    return s.tree_joints[static_cast<std::size_t>(t)].name;
  };
  for (const DriveTorqueElement& kept : s.torques)
    for (const DriveTorqueElement& other : s.torques)
      if (kept.keeps_momentum && !other.keeps_momentum &&
          (hangs_from(s, kept.link, other.link) || hangs_from(s, other.link, kept.link)))
        throw SceneError("joints." + name_at(kept.link) + ".drive.keeps",
                         "expected speed, or no drive by torque that carries it or that it carries, found " +
                             name_at(other.link) + ": its momentum in the drawn pose is not given then");
}

} // namespace

std::shared_ptr<const ForceLaw> read_force_law(const Formula* law, std::string_view variable,
                                               const std::string& part) {
  try {
    return law ? std::make_shared<const ForceLaw>(law->text, variable) : nullptr;
  } catch (const ExpressionError& error) {
    throw SceneError(part + "." + law->key, "\"=" + law->text + "\": " + error.what());
  }
}

void add_drive_torques(const Mechanism& m, const std::vector<int>& links, System& s) {
  for (const int l : links) {
    const Link& link = s.links[static_cast<std::size_t>(l)];
    const Joint& x = joint_of(m, s, link.tree_joint);
    const auto& drive = x.coordinates[static_cast<std::size_t>(link.coordinate)].drive;
    s.torques.push_back({l, law_of(m, s, x, link.coordinate, "torque"),
                         law_of(m, s, x, link.coordinate, "load"), drive && !drive->torque, !drive});
  }
  expect_given_momentum(s);
}

void add_force_laws(const Mechanism& m, System& s) {
  for (int l = 0; l < static_cast<int>(s.links.size()); ++l) {
    const Link& x = s.links[static_cast<std::size_t>(l)];
    if (s.tree_joints[static_cast<std::size_t>(x.tree_joint)].joint < 0 || x.type == LinkType::fixed)
      continue;
    const Joint& of = joint_of(m, s, x.tree_joint);
    const std::string part = "joints." + of.name;
    for (int k = 0; k < (x.type == LinkType::spherical ? 3 : 1); ++k) {
      const int i = x.coordinate + k;
      const Coordinate& c = of.coordinates[static_cast<std::size_t>(i)];
      const bool spring = c.spring && c.spring->force, damper = c.damping_force.has_value();
      if (spring || damper)
        s.coordinate_laws.push_back({l, k, spring, damper,
                                     read_force_law(spring_law(of, i), spring_variable, part),
                                     read_force_law(damper_law(of, i), damper_variable, part)});
    }
  }
  for (int i = 0; i < static_cast<int>(s.springs.size()); ++i) {
    const Force& x = m.forces[static_cast<std::size_t>(s.springs[static_cast<std::size_t>(i)].force)];
    const std::string part = "forces." + x.name;
    if (x.force || x.damping_force)
      s.spring_laws.push_back({i, 0, x.force.has_value(), x.damping_force.has_value(),
                               read_force_law(spring_law(x), spring_variable, part),
                               read_force_law(damper_law(x), damper_variable, part)});
  }
  for (int i = 0; i < static_cast<int>(s.cut_dampers.size()); ++i) {
    const CutDamperElement& e = s.cut_dampers[static_cast<std::size_t>(i)];
    const Joint& of = m.joints[static_cast<std::size_t>(e.joint)];
    if (of.coordinates[static_cast<std::size_t>(e.coordinate)].damping_force)
      s.cut_damper_laws.push_back(
          {i, 0, false, true, nullptr,
           read_force_law(damper_law(of, e.coordinate), damper_variable, "joints." + of.name)});
  }
}

} // namespace flyball
