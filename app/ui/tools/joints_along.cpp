#include "app/ui/tools/joints_along.hpp"

#include "app/session/session.hpp"
#include "app/ui/tool_state.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {

namespace {

using Names = std::vector<std::string>;

std::string listed(const Names& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return word_list(views, "and");
}

// "; spindle and link1 stay where they were"
std::string clause(const Names& names, const char* one, const char* many) {
  return names.empty() ? "" : "; " + listed(names) + (names.size() == 1 ? one : many);
}

// Bodies that these joints join to those that moved. The ground stays always.
Names staying_bodies(const Mechanism& mechanism, const Selection& moved, const Names& joints) {
  Names bodies;
  for (const std::string& name : joints) {
    const int j = joint_index(mechanism, name);
    if (j < 0) continue;
    for (const std::string& body : mechanism.joints[static_cast<std::size_t>(j)].bodies)
      if (body != ground_name && !moved.has(Part{PartKind::body, body}) &&
          std::ranges::find(bodies, body) == bodies.end())
        bodies.push_back(body);
  }
  return bodies;
}

// Distance joints from what moved to what stays: each end goes with its body.
Names stretched_links(const Mechanism& mechanism, const Selection& moved) {
  const auto moves = [&](const std::string& body) { return moved.has(Part{PartKind::body, body}); };
  Names links;
  for (const Joint& joint : mechanism.joints)
    if (joint.type == JointType::distance && !moved.has(Part{PartKind::joint, joint.name}) &&
        moves(joint.bodies[0]) != moves(joint.bodies[1]))
      links.push_back(joint.name);
  return links;
}

} // namespace

OuterJoints joints_of_moved(const ToolState& tool, bool opposite) {
  return tool.leave_joints != opposite ? OuterJoints::stay : OuterJoints::follow;
}

void tell_joints(Session& session, const ToolState& tool, const Selection& moved, bool opposite) {
  const Mechanism& mechanism = session.mechanism();
  const Names names = outer_joints(mechanism, moved);
  if (names.empty()) return;
  const bool one = names.size() == 1;
  const std::string joints = (one ? "Joint " : "Joints ") + listed(names);
  if (joints_of_moved(tool, opposite) == OuterJoints::follow)
    session.notice =
        joints + " went along" +
        clause(staying_bodies(mechanism, moved, names), " stays where it was", " stay where they were") +
        clause(stretched_links(mechanism, moved), " follows with one end", " follow with one end each") + ".";
  else
    session.notice = joints + (one ? " stays where it was." : " stay where they were.");
}

} // namespace flyball
