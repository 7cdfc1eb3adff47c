#include "app/document/rename.hpp"

#include "app/document/measure_edits.hpp"
#include "app/document/references.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"

namespace flyball {
namespace {

std::string_view list_of(PartKind kind) {
  constexpr std::array<std::string_view, 4> lists{"", "bodies", "joints", "forces"};
  return lists[static_cast<std::size_t>(kind)];
}

void check_name(const Mechanism& mechanism, const Part& part, const std::string& name,
                const std::string& where) {
  if (name.empty()) throw SceneError(where, "expected a name that is not empty");
  if (name == ground_name) throw SceneError(where, "expected another name; \"ground\" is the fixed world");
  if (name.find('.') != std::string::npos)
    throw SceneError(where, "expected a name without dots, which separate the parts of an address");
  if (!is_usable_name(name)) throw SceneError(where, "expected a name without control characters");
  if (find_invalid_utf8(name) != std::string::npos) throw SceneError(where, "expected UTF-8 text");
  if (find_part(mechanism, {part.kind, name}).kind != PartKind::none)
    throw SceneError(where, "expected a name of its own; there is a \"" + name + "\" already");
}

void follow_body(Mechanism& mechanism, const std::string& from, const std::string& to) {
  const auto follow = [&](auto& parts) {
    for (auto& part : parts)
      for (std::string& body : bodies_of(part))
        if (body == from) body = to;
  };
  follow(mechanism.joints);
  follow(mechanism.forces);
  if (mechanism.air.turns_with == from) mechanism.air.turns_with = to;
}

void follow_joint(Mechanism& mechanism, const std::string& from, const std::string& to) {
  for (Joint& gear : mechanism.joints)
    if (gear.type == JointType::gear)
      for (std::string& end : gear.joints)
        if (joint_of_end(end) == from) end = end_at(end, to);
}

} // namespace

void rename_part(Mechanism& mechanism, const Part& part, const std::string& name) {
  const auto [kind, index] = find_part(mechanism, part);
  const std::string list(list_of(part.kind));
  const std::string where = list + "." + part.name;
  if (kind == PartKind::none) throw SceneError(where, "there is no such part");
  if (name == part.name) return;
  check_name(mechanism, part, name, where + ".name");
  const auto i = static_cast<std::size_t>(index);
  switch (kind) {
  case PartKind::none: break;
  case PartKind::body:
    mechanism.bodies[i].name = name;
    follow_body(mechanism, part.name, name);
    break;
  case PartKind::joint:
    mechanism.joints[i].name = name;
    follow_joint(mechanism, part.name, name);
    break;
  case PartKind::force: mechanism.forces[i].name = name; break;
  }
  follow_in_measures(mechanism, part, name);
  for (Slider& slider : mechanism.sliders)
    if (slider.parameter.starts_with(where + "."))
      slider.parameter.replace(0, where.size(), list + "." + name);
}

} // namespace flyball
