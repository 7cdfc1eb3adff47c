#include "app/ui/panels/view_input.hpp"

#include "app/ui/camera_glide.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/card.hpp"

#include <cmath>

namespace flyball {

namespace {

constexpr double zoom_step = 1.15; // a notch of the wheel
constexpr float click_slack = 4;   // points that the hand may move in a click

} // namespace

ViewInput view_input(const Ui& ui, const ViewState& view, const PanelRect& rect) {
  const ImGuiIO& io = ImGui::GetIO();
  ViewInput input;
  input.rect = rect;
  input.size = {static_cast<double>(rect.width), static_cast<double>(rect.height)};
  input.camera = view.camera;
  input.point = static_cast<double>(ui.scale);
  input.cursor = {static_cast<double>(io.MousePos.x - rect.x), static_cast<double>(io.MousePos.y - rect.y)};
  input.hovered = ImGui::IsItemHovered();
  input.active = ImGui::IsItemActive();
  input.pressed = ImGui::IsItemActivated() && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  input.held = input.active && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  input.released = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left);
  const float slack = click_slack * ui.scale;
  input.moved = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] >= slack * slack;
  input.menu = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Right) &&
               io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Right] < slack * slack;
  input.ctrl = io.KeyCtrl;
  input.shift = io.KeyShift;
  input.alt = io.KeyAlt;
  return input;
}

namespace {

void drag_camera(ViewState& view, const ViewInput& input, CameraDrag drag, Vec2 by, Vec2 from) {
  constexpr double zoom_by_pixel = 1.006;
  ViewCamera& camera = view.camera;
  if (drag == CameraDrag::orbit) camera.orbit(by.x(), by.y(), input.size);
  if (drag == CameraDrag::pan) camera.pan(by.x(), by.y(), input.size);
  if (drag == CameraDrag::zoom) camera.zoom(std::pow(zoom_by_pixel, -by.y() / input.point), from, input.size);
}

// What lies over the view and has nothing to scroll leaves the wheel to it.
bool on_still_card(const ViewInput& input) {
  return input.cursor.x() >= 0 && input.cursor.x() < input.size.width && input.cursor.y() >= 0 &&
         input.cursor.y() < input.size.height && points_at_still_card();
}

} // namespace

void steer(const ToolState& tool, ViewState& view, const ViewInput& input) {
  const ImGuiIO& io = ImGui::GetIO();
  const Vec2 by(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
  // Whoever has taken hold of the camera wants it where he puts it, also while the first answer is awaited.
  if (input.active && by != Vec2::Zero()) {
    stop_glide(view);
    for (const int button : {ImGuiMouseButton_Middle, ImGuiMouseButton_Right, ImGuiMouseButton_Left}) {
      // How the mouse came to where it was pressed is no drag.
      if (!ImGui::IsMouseDown(button) || ImGui::IsMouseClicked(button)) continue;
      if (button == ImGuiMouseButton_Left && (!input.moved || takes_left_drag(tool, view, input))) break;
      const ImVec2& pressed = io.MouseClickedPos[button];
      drag_camera(
          view, input, camera_drag(view.navigation, button, input.ctrl, input.shift), by,
          {static_cast<double>(pressed.x - input.rect.x), static_cast<double>(pressed.y - input.rect.y)});
      break;
    }
  }
  if (io.MouseWheel != 0 && !tool.pull && (input.hovered || on_still_card(input))) {
    stop_glide(view);
    view.camera.zoom(std::pow(zoom_step, static_cast<double>(io.MouseWheel)), input.cursor, input.size);
  }
  if (!input.hovered) return;
  const bool on_handle = tool.hovered != Handle::none || tool.hovered_point || !tool.hovered_name.empty();
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && view.hovered.kind == PartKind::none &&
      !on_handle && !places(tool.tool) &&
      (frames_with_left(view.navigation) || !takes_left_drag(tool, view, input)))
    fit_all(view);
}

} // namespace flyball
