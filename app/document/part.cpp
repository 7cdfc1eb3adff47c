#include "app/document/part.hpp"

#include <algorithm>
#include <array>
#include <unordered_set>

namespace flyball {

PartId find_part(const Mechanism& mechanism, const Part& part) {
  int index = -1;
  switch (part.kind) {
  case PartKind::none: break;
  case PartKind::body: index = body_index(mechanism, part.name); break;
  case PartKind::joint: index = joint_index(mechanism, part.name); break;
  case PartKind::force: index = force_index(mechanism, part.name); break;
  }
  return index < 0 ? PartId{} : PartId{part.kind, index};
}

Part part_of(const Mechanism& mechanism, PartId id) {
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::body && i < mechanism.bodies.size()) return {id.kind, mechanism.bodies[i].name};
  if (id.kind == PartKind::joint && i < mechanism.joints.size()) return {id.kind, mechanism.joints[i].name};
  if (id.kind == PartKind::force && i < mechanism.forces.size()) return {id.kind, mechanism.forces[i].name};
  return {};
}

bool Selection::has(const Part& part) const {
  return std::ranges::find(parts, part) != parts.end();
}

bool Selection::has(PartKind kind) const {
  return std::ranges::find(parts, kind, &Part::kind) != parts.end();
}

std::vector<std::string> Selection::names(PartKind kind) const {
  std::vector<std::string> found;
  for (const Part& part : parts)
    if (part.kind == kind) found.push_back(part.name);
  return found;
}

void Selection::set(Part part) {
  parts.clear();
  add(std::move(part));
}

void Selection::add(Part part) {
  if (part.kind != PartKind::none && !has(part)) parts.push_back(std::move(part));
}

void Selection::toggle(Part part) {
  if (const auto found = std::ranges::find(parts, part); found != parts.end())
    parts.erase(found);
  else
    add(std::move(part));
}

namespace {

// Looking for each in turn takes too long where more are selected.
constexpr std::size_t few = 16;

} // namespace

std::vector<PartId> find_parts(const Mechanism& mechanism, const Selection& selection) {
  std::vector<PartId> found;
  const auto add = [&](PartId id) {
    if (id.kind != PartKind::none) found.push_back(id);
  };
  if (selection.parts.size() <= few) {
    for (const Part& part : selection.parts)
      add(find_part(mechanism, part));
    return found;
  }
  const auto find_all = [&](PartKind kind, const auto& list) {
    std::unordered_set<std::string_view> names;
    for (const Part& part : selection.parts)
      if (part.kind == kind) names.insert(part.name);
    for (std::size_t i = 0; i < list.size() && !names.empty(); ++i)
      if (names.contains(list[i].name)) add({kind, static_cast<int>(i)});
  };
  find_all(PartKind::body, mechanism.bodies);
  find_all(PartKind::joint, mechanism.joints);
  find_all(PartKind::force, mechanism.forces);
  return found;
}

Selection existing(Selection selection, const Mechanism& mechanism) {
  if (selection.parts.size() <= few) {
    std::erase_if(selection.parts,
                  [&](const Part& part) { return find_part(mechanism, part).kind == PartKind::none; });
    return selection;
  }
  std::array<std::unordered_set<std::string_view>, 3> names;
  for (const Body& body : mechanism.bodies)
    names[0].insert(body.name);
  for (const Joint& joint : mechanism.joints)
    names[1].insert(joint.name);
  for (const Force& force : mechanism.forces)
    names[2].insert(force.name);
  constexpr std::array kinds{PartKind::body, PartKind::joint, PartKind::force};
  std::erase_if(selection.parts, [&](const Part& part) {
    const auto kind = std::ranges::find(kinds, part.kind);
    return kind == kinds.end() || !names[static_cast<std::size_t>(kind - kinds.begin())].contains(part.name);
  });
  return selection;
}

} // namespace flyball
