#include "app/ui/hidden_parts.hpp"

#include "app/session/session.hpp"
#include "app/ui/view_state.hpp"

#include <algorithm>

namespace flyball {

namespace {

void hide_part(ViewState& view, Part part) {
  if (std::ranges::find(view.hidden, part) == view.hidden.end()) view.hidden.push_back(std::move(part));
}

bool joins_selected(const Selection& selection, const std::array<std::string, 2>& bodies) {
  return std::ranges::all_of(bodies, [&](const std::string& body) {
    return selection.has(Part{PartKind::body, body});
  });
}

} // namespace

void hide_selected(Session& session, ViewState& view) {
  for (const Part& part : session.selection().parts)
    hide_part(view, part);
  select(session, {});
}

void isolate_selected(const Session& session, ViewState& view) {
  const Selection& selection = session.selection();
  const Mechanism& mechanism = session.mechanism();
  view.hidden.clear();
  const auto consider = [&](PartKind kind, const std::string& name, bool belongs) {
    if (Part part{kind, name}; !belongs && !selection.has(part)) hide_part(view, std::move(part));
  };
  for (const Body& body : mechanism.bodies)
    consider(PartKind::body, body.name, false);
  for (const Joint& joint : mechanism.joints)
    consider(PartKind::joint, joint.name, joins_selected(selection, joint.bodies));
  for (const Force& force : mechanism.forces)
    consider(PartKind::force, force.name,
             acts_between(force.type) ? joins_selected(selection, force.bodies)
                                      : selection.has(Part{PartKind::body, force.body}));
}

void show_hidden(ViewState& view) {
  view.hidden.clear();
}

} // namespace flyball
