#include "app/ui/hidden_parts.hpp"

#include "app/ui/app.hpp"

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

void hide_selected(App& app) {
  for (const Part& part : app.session.selection().parts)
    hide_part(app.view, part);
  select(app.session, {});
}

void isolate_selected(App& app) {
  const Selection& selection = app.session.selection();
  const Mechanism& mechanism = app.session.mechanism();
  app.view.hidden.clear();
  const auto consider = [&](PartKind kind, const std::string& name, bool belongs) {
    if (Part part{kind, name}; !belongs && !selection.has(part)) hide_part(app.view, std::move(part));
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

void show_hidden(App& app) {
  app.view.hidden.clear();
}

} // namespace flyball
