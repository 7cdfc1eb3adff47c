// The view by keys: arrows turn it, with Shift they move it, plus and minus zoom, Page Down and Page Up go
// from body to body; while a tool places, they move its cursor instead.
#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/tool_cursor.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double turn_by_key = 24,
                 closer = 1.15; // points of a drag, as far as one press turns; a press of plus

bool steer_by_key(const Ui& ui, ViewState& view, const KeyPress& key, ViewSize size) {
  const double by = turn_by_key * static_cast<double>(ui.scale) * (key.ctrl ? 3 : 1);
  const double dx = (key.key == keys::right ? by : 0) - (key.key == keys::left ? by : 0);
  const double dy = (key.key == keys::down ? by : 0) - (key.key == keys::up ? by : 0);
  ViewCamera& camera = view.camera;
  if (dx != 0 || dy != 0) {
    if (key.shift)
      camera.pan(dx, dy, size);
    else
      camera.orbit(dx, dy, size);
  } else if (!key.ctrl && (key.key == '+' || key.key == '=' || key.key == '-')) {
    camera.zoom(key.key == '-' ? 1 / closer : closer, {size.width / 2, size.height / 2}, size);
  } else {
    return false;
  }
  view.fit = false;
  return true;
}

// In the scene's order, round; at first to the first or the last.
bool go_to_body(Session& session, const KeyPress& key) {
  const bool on = key.key == keys::page_down;
  const std::vector<Body>& bodies = session.mechanism().bodies;
  if ((!on && key.key != keys::page_up) || key.ctrl || key.shift || bodies.empty()) return false;
  const std::vector<Part>& chosen = session.selection().parts;
  const auto last = std::ranges::find(chosen.rbegin(), chosen.rend(), PartKind::body, &Part::kind);
  const int now = last == chosen.rend() ? -1 : body_index(session.mechanism(), last->name),
            count = static_cast<int>(bodies.size()),
            next = now < 0 ? (on ? 0 : count - 1) : (now + (on ? 1 : count - 1)) % count;
  select(session, {{{PartKind::body, bodies[static_cast<std::size_t>(next)].name}}});
  return true;
}

} // namespace

void take_view_keys(const ViewContext& context) {
  const WidgetRect& view = context.ui.keyboard.view;
  if (view.to.x <= view.from.x || !context.ui.keyboard.at.empty() || ImGui::GetIO().WantTextInput ||
      ImGui::GetCurrentContext()->OpenPopupStack.Size > 0)
    return;
  const ViewSize size{static_cast<double>(view.to.x - view.from.x),
                      static_cast<double>(view.to.y - view.from.y)};
  std::erase_if(context.ui.keys, [&](const KeyPress& key) {
    if (context.session.mode == Mode::build && places(context.tool.tool) &&
        take_cursor_key(context, key, size))
      return true;
    if (go_to_body(context.session, key)) return true;
    return steer_by_key(context.ui, context.view, key, size);
  });
}

} // namespace flyball
