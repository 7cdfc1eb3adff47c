#include "app/document/remove.hpp"

#include "app/document/measure_edits.hpp"
#include "app/document/references.hpp"

#include <algorithm>

namespace flyball {
namespace {

bool is_selected(const Selection& selection, PartKind kind, std::string_view name) {
  return std::ranges::any_of(selection.parts,
                             [&](const Part& p) { return p.kind == kind && p.name == name; });
}

// Whether the address begins with the part's.
bool is_of(std::string_view address, const Part& part) {
  constexpr std::array<std::string_view, 4> lists{"", "bodies.", "joints.", "forces."};
  const std::string_view list = lists[static_cast<std::size_t>(part.kind)];
  if (!address.starts_with(list)) return false;
  address.remove_prefix(list.size());
  return address.starts_with(part.name) && address.substr(part.name.size()).starts_with('.');
}

} // namespace

Selection with_dependents(const Mechanism& mechanism, const Selection& selection) {
  Selection all = selection;
  const auto body = [&](const std::string& name) { return is_selected(selection, PartKind::body, name); };
  for (const Joint& joint : mechanism.joints)
    if (std::ranges::any_of(bodies_of(joint), body)) all.add({PartKind::joint, joint.name});
  for (const Joint& gear : mechanism.joints)
    if (gear.type == JointType::gear && std::ranges::any_of(gear.joints, [&](const std::string& end) {
          return is_selected(all, PartKind::joint, joint_of_end(end));
        }))
      all.add({PartKind::joint, gear.name});
  for (const Force& force : mechanism.forces)
    if (std::ranges::any_of(bodies_of(force), body)) all.add({PartKind::force, force.name});
  return all;
}

void remove_parts(Mechanism& mechanism, const Selection& selection) {
  const Selection all = existing(with_dependents(mechanism, selection), mechanism);
  const auto gone = [&](PartKind kind) {
    return [&all, kind](const auto& part) { return is_selected(all, kind, part.name); };
  };
  std::erase_if(mechanism.bodies, gone(PartKind::body));
  std::erase_if(mechanism.joints, gone(PartKind::joint));
  std::erase_if(mechanism.forces, gone(PartKind::force));
  if (body_index(mechanism, mechanism.air.turns_with) < 0) mechanism.air.turns_with.clear();
  std::erase_if(mechanism.sliders, [&](const Slider& slider) {
    return std::ranges::any_of(all.parts, [&](const Part& part) { return is_of(slider.parameter, part); });
  });
  drop_lost_measures(mechanism);
}

} // namespace flyball
