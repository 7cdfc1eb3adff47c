#include "app/document/clipboard.hpp"

#include "app/document/named_edits.hpp"
#include "app/document/names.hpp"
#include "app/document/references.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace flyball {
namespace {

// What the text calls a part, and what it is called where it is pasted.
class PastedNames {
 public:
  PastedNames(const Mechanism& to, PartKind kind, std::string stem)
      : there_(to, kind), used_(there_), stem_(std::move(stem)) {}

  // A name for a part of the text. Of several that it calls the same the first is the one referred to.
  std::string add(const std::string& name) {
    const std::string here = is_usable_name(name) ? used_.take(name) : used_.take_first(stem_);
    pasted_.emplace(name, here);
    return here;
  }
  // A part that the text has, but that is not pasted.
  void leave_out(const std::string& name) { left_out_.insert(name); }

  // What a reference in the text means: a part of the text, or else one that was there before.
  bool has(const std::string& name) const {
    return pasted_.contains(name) || (there_.has(name) && !left_out_.contains(name));
  }
  std::string operator[](const std::string& name) const {
    const auto pasted = pasted_.find(name);
    return pasted == pasted_.end() ? name : pasted->second;
  }

 private:
  const UsedNames there_;
  UsedNames used_;
  std::string stem_;
  std::unordered_map<std::string, std::string> pasted_;
  std::unordered_set<std::string> left_out_;
};

class Paste {
 public:
  Paste(Mechanism& to, Mechanism from)
      : to_(to), from_(std::move(from)), bodies_(to, PartKind::body, "body"),
        joints_(to, PartKind::joint, "joint"), forces_(to, PartKind::force, "force") {}

  Selection run() {
    add_missing(to_.parameters, from_.parameters);
    add_missing(to_.points, from_.points);
    for (Body& body : from_.bodies) {
      body.name = bodies_.add(body.name);
      append(PartKind::body, to_.bodies, body);
    }
    name_joints();
    name_forces();
    for (std::size_t i = 0; i < from_.joints.size(); ++i) {
      Joint& joint = from_.joints[i];
      if (joint_names_[i].empty()) continue;
      joint.name = joint_names_[i];
      translate(bodies_of(joint));
      if (joint.type == JointType::gear)
        for (std::string& end : joint.joints)
          end = end_at(end, joints_[joint_of_end(end)]);
      for (Formula& formula : joint.formulas)
        if (is_drive_law(from_, formula)) translate_law(formula.text);
      append(PartKind::joint, to_.joints, joint);
    }
    for (std::size_t i = 0; i < from_.forces.size(); ++i) {
      Force& force = from_.forces[i];
      if (force_names_[i].empty()) continue;
      force.name = force_names_[i];
      translate(bodies_of(force));
      append(PartKind::force, to_.forces, force);
    }
    return std::move(added_);
  }

 private:
  // Parameters and points that expressions of the text rest on.
  template <class Named>
  void add_missing(std::vector<Named>& there, const std::vector<Named>& pasted) const {
    for (const Named& each : pasted)
      if (parameter_index(to_, each.name) < 0 && point_index(to_, each.name) < 0) there.push_back(each);
  }

  bool are_there(std::span<const std::string> bodies) const {
    return std::ranges::all_of(
        bodies, [&](const std::string& name) { return name == ground_name || bodies_.has(name); });
  }

  void translate(std::span<std::string> bodies) const {
    for (std::string& name : bodies)
      if (name != ground_name) name = bodies_[name];
  }

  // Of all joints that can be here, so that a gear may stand before its joints.
  void name_joints() {
    joint_names_.resize(from_.joints.size());
    const auto name = [&](std::size_t i, bool there) {
      if (there)
        joint_names_[i] = joints_.add(from_.joints[i].name);
      else
        joints_.leave_out(from_.joints[i].name);
    };
    for (std::size_t i = 0; i < from_.joints.size(); ++i)
      if (const Joint& joint = from_.joints[i]; joint.type != JointType::gear)
        name(i, are_there(bodies_of(joint)));
    for (std::size_t i = 0; i < from_.joints.size(); ++i)
      if (const Joint& gear = from_.joints[i]; gear.type == JointType::gear)
        name(i, std::ranges::all_of(gear.joints,
                                    [&](const std::string& end) { return joints_.has(joint_of_end(end)); }));
  }

  void name_forces() {
    for (const Force& force : from_.forces)
      force_names_.push_back(are_there(bodies_of(force)) ? forces_.add(force.name) : "");
  }

  // What it asks of parts of the text it asks of what they are called here.
  void translate_law(std::string& law) const {
    for (const auto& [kind, names] : {std::pair{ResultPart::joint, &joints_},
                                      {ResultPart::body, &bodies_},
                                      {ResultPart::force, &forces_}})
      law = parts_renamed_in(law, kind, [&names = *names](const std::string& name) { return names[name]; });
  }

  template <class Kind>
  void append(PartKind kind, std::vector<Kind>& parts, Kind& part) {
    added_.add({kind, part.name});
    parts.push_back(std::move(part));
  }

  Mechanism& to_;
  Mechanism from_;
  PastedNames bodies_, joints_, forces_;
  std::vector<std::string> joint_names_, force_names_; // empty for those left out
  Selection added_;
};

// A law that stands without the scene's measures; as it is where it cannot be read.
std::string without_measures(const Mechanism& mechanism, const std::string& law) {
  try {
    return with_measures(mechanism, law);
  } catch (const ExpressionError&) {
    return law;
  }
}

} // namespace

std::string copy_text(const Mechanism& mechanism, const Selection& selection) {
  Mechanism parts;
  parts.name = mechanism.name;
  parts.gravity = mechanism.gravity;
  std::unordered_set<std::string> bodies, joints;
  for (const Body& body : mechanism.bodies)
    if (selection.has({PartKind::body, body.name})) {
      bodies.insert(body.name);
      parts.bodies.push_back(body);
    }
  parts.air = mechanism.air;
  if (!bodies.contains(parts.air.turns_with)) parts.air.turns_with.clear();
  // Held to ground and to one another, with a body among them.
  const auto is_held = [&](std::span<const std::string> names) {
    const auto copied = [&](const std::string& name) { return bodies.contains(name); };
    return std::ranges::any_of(names, copied) && std::ranges::all_of(names, [&](const std::string& name) {
             return name == ground_name || copied(name);
           });
  };
  for (const Joint& joint : mechanism.joints)
    if (selection.has({PartKind::joint, joint.name}) || is_held(bodies_of(joint))) joints.insert(joint.name);
  for (const Joint& gear : mechanism.joints)
    if (gear.type == JointType::gear && std::ranges::all_of(gear.joints, [&](const std::string& end) {
          return joints.contains(joint_of_end(end));
        }))
      joints.insert(gear.name);
  for (const Joint& joint : mechanism.joints)
    if (joints.contains(joint.name)) {
      parts.joints.push_back(joint);
      for (Formula& formula : parts.joints.back().formulas)
        if (is_drive_law(mechanism, formula)) formula.text = without_measures(mechanism, formula.text);
    }
  for (const Force& force : mechanism.forces)
    if (selection.has({PartKind::force, force.name}) || is_held(bodies_of(force)))
      parts.forces.push_back(force);
  // Parameters and points by which they are given, and those that these rest on.
  parts.parameters = mechanism.parameters;
  parts.points = mechanism.points;
  const auto drop_unused = [&](auto& list) {
    std::unordered_set<std::string> unused;
    for (const auto& each : list)
      if (users_of(parts, each.name).empty()) unused.insert(each.name);
    return std::erase_if(list, [&](const auto& each) { return unused.contains(each.name); }) > 0;
  };
  while (drop_unused(parts.parameters) || drop_unused(parts.points)) {
  }
  return write_scene(parts);
}

Selection paste_text(Mechanism& mechanism, std::string_view text) {
  return Paste(mechanism, parse_scene(text)).run();
}

} // namespace flyball
