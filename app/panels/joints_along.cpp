#include "app/panels/joints_along.hpp"

#include "app/panels/widgets.hpp"

namespace flyball {

OuterJoints joints_of_moved(const App& app, bool opposite) {
  return app.inspector.leave_joints != opposite ? OuterJoints::stay : OuterJoints::follow;
}

void tell_joints(App& app, const Selection& moved, bool opposite) {
  const std::vector<std::string> names = outer_joints(app.mechanism(), moved);
  if (names.empty()) return;
  const bool one = names.size() == 1;
  if (joints_of_moved(app, opposite) == OuterJoints::follow)
    app.notice = name_list(names) + " went along.";
  else
    app.notice = name_list(names) + (one ? " stays where it was." : " stay where they were.");
}

} // namespace flyball
