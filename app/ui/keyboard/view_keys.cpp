// The view by keys: arrows turn it, with Shift they move it, plus and minus zoom; while a tool places, they
// move its cursor instead.
#include "app/ui/commands.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/tool_cursor.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"

#include <imgui_internal.h>

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
    return steer_by_key(context.ui, context.view, key, size);
  });
}

} // namespace flyball
