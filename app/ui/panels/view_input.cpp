#include "app/ui/panels/view_input.hpp"

#include "app/ui/tools/tools.hpp"

#include <cmath>

namespace flyball {

namespace {

constexpr double zoom_step = 1.15; // a notch of the wheel
constexpr float click_slack = 4;   // points that the hand may move in a click

} // namespace

ViewInput view_input(const App& app, const PanelRect& rect) {
  const ImGuiIO& io = ImGui::GetIO();
  ViewInput input;
  input.rect = rect;
  input.size = {static_cast<double>(rect.width), static_cast<double>(rect.height)};
  input.camera = app.view.camera;
  input.point = static_cast<double>(app.scale);
  input.cursor = {static_cast<double>(io.MousePos.x - rect.x), static_cast<double>(io.MousePos.y - rect.y)};
  input.hovered = ImGui::IsItemHovered();
  input.active = ImGui::IsItemActive();
  input.pressed = ImGui::IsItemActivated() && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  input.held = input.active && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  input.released = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left);
  const float slack = click_slack * app.scale;
  input.moved = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] >= slack * slack;
  input.ctrl = io.KeyCtrl;
  input.shift = io.KeyShift;
  input.alt = io.KeyAlt;
  return input;
}

void steer(App& app, const ViewInput& input) {
  const ImGuiIO& io = ImGui::GetIO();
  const double dx = static_cast<double>(io.MouseDelta.x), dy = static_cast<double>(io.MouseDelta.y);
  const bool middle = ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  // Whoever has taken hold of the camera wants it where he puts it, also while the first answer is awaited.
  if (input.active && (dx != 0 || dy != 0)) {
    app.view.fit = false;
    if (middle || ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
      if (middle && input.shift)
        app.view.camera.orbit(dx, dy, input.size);
      else
        app.view.camera.pan(dx, dy, input.size);
    } else if (input.moved && !takes_left_drag(app, input)) {
      if (input.shift)
        app.view.camera.pan(dx, dy, input.size);
      else
        app.view.camera.orbit(dx, dy, input.size);
    }
  }
  if (!input.hovered) return;
  if (io.MouseWheel != 0 && !app.tool.pull) {
    app.view.fit = false;
    app.view.camera.zoom(std::pow(zoom_step, static_cast<double>(io.MouseWheel)), input.cursor, input.size);
  }
  const bool on_handle = app.tool.hovered != Handle::none || app.tool.hovered_point;
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && app.view.hovered.kind == PartKind::none &&
      !on_handle && !places(app.tool.tool) && !takes_left_drag(app, input))
    app.view.fit = app.view.keep_direction = true;
}

} // namespace flyball
