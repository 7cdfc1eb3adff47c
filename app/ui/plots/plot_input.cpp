#include "app/plot/nearest.hpp"
#include "app/render/imgui_compat.hpp"
#include "app/ui/plots/plot_parts.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double tremble = 4;       // points that a click may move
constexpr double point_reach = 9;   // points within which a data point or the marker is meant
constexpr double wheel_step = 1.18; // of one notch of the wheel

void zoom_with_wheel(const PlotFrame& frame, bool along_x, bool along_y) {
  if (!ImGui::IsItemHovered()) return;
  imgui_compat::take_wheel();
  const float notches = ImGui::GetIO().MouseWheel;
  if (notches == 0) return;
  const PixelPoint at = pointer_in(frame.pen);
  const double factor = std::pow(wheel_step, -static_cast<double>(notches));
  if (along_x) zoom_plot(frame.view, frame.layout, 0, at[0], factor);
  if (along_y) zoom_plot(frame.view, frame.layout, 1, at[1], factor);
}

bool on_marker(const PlotFrame& frame, const PixelPoint& at) {
  if (!frame.plot.marker) return false;
  const double x = frame.layout.x.pixel(frame.plot.marker->x), y = frame.layout.y.pixel(frame.plot.marker->y);
  return frame.layout.area.grown(1).contains(x, y) &&
         std::hypot(at[0] - x, at[1] - y) <= point_reach * frame.layout.scale;
}

PlotHit hit_of(const PlotNear& near) {
  return {near.curve, near.index, near.x, near.y};
}

std::array<double, 2> place_of(const PlotFrame& frame, const PixelPoint& at) {
  const PlotBox& a = frame.layout.area;
  const PixelPoint inside{std::clamp(at[0], a.left, a.right), std::clamp(at[1], a.top, a.bottom)};
  std::array<double, 2> place{};
  for (std::size_t k = 0; k < 2; ++k) {
    const PlotRuler& ruler = frame.layout.ruler(static_cast<int>(k));
    const double worth = std::abs(ruler.value(inside[k] + 0.5) - ruler.value(inside[k] - 0.5));
    const double grain = worth > 0 ? std::pow(10, std::floor(std::log10(worth))) : 0;
    const double value = ruler.value(inside[k]);
    // Dividing by a whole number leaves the nearest decimal.
    place[k] = grain == 0  ? value
               : grain < 1 ? std::round(value / grain) / std::round(1 / grain)
                           : std::round(value / grain) * grain;
  }
  return place;
}

void begin_drag(const PlotFrame& frame, PlotView::Drag drag, std::array<bool, 2> axes) {
  PlotView& view = frame.view;
  const PixelPoint at = pointer_in(frame.pen);
  view.button = ImGui::IsMouseDown(0) ? 0 : 1;
  view.drag = drag;
  view.drag_axis = axes;
  view.drag_from = at;
  view.dragged = false;
  const PlotLayout& l = frame.layout;
  view.drag_range = {PlotRange{l.x.lower, l.x.upper}, PlotRange{l.y.lower, l.y.upper}};
}

// The ranges with which the drag began, moved as far as the pointer.
void pan(const PlotFrame& frame) {
  PlotView& view = frame.view;
  const PixelPoint at = pointer_in(frame.pen);
  for (std::size_t k = 0; k < 2; ++k) {
    if (!view.drag_axis[k]) continue;
    PlotRuler ruler = frame.layout.ruler(static_cast<int>(k));
    ruler.lower = view.drag_range[k][0];
    ruler.upper = view.drag_range[k][1];
    const double moved = at[k] - view.drag_from[k];
    view.look.range[k] = ruler.range_between(ruler.from - moved, ruler.to - moved);
  }
}

void zoom_to_box(const PlotFrame& frame) {
  const PlotBox& a = frame.layout.area;
  const PixelPoint from = frame.view.drag_from, to = pointer_in(frame.pen);
  const std::array<PlotRange, 2> ends = {
      PlotRange{std::clamp(from[0], a.left, a.right), std::clamp(to[0], a.left, a.right)},
      PlotRange{std::clamp(from[1], a.top, a.bottom), std::clamp(to[1], a.top, a.bottom)}};
  // A long and narrow box means one axis.
  for (std::size_t k = 0; k < 2; ++k)
    if (std::abs(ends[k][1] - ends[k][0]) >= 2 * tremble * frame.layout.scale)
      frame.view.look.range[k] =
          frame.layout.ruler(static_cast<int>(k)).range_between(ends[k][0], ends[k][1]);
}

void follow_drag(const PlotFrame& frame) {
  PlotView& view = frame.view;
  const PixelPoint at = pointer_in(frame.pen);
  if (std::hypot(at[0] - view.drag_from[0], at[1] - view.drag_from[1]) > tremble * frame.layout.scale)
    view.dragged = true;
  if (!view.dragged) return;
  if (view.drag == PlotView::Drag::pan) pan(frame);
  if (view.drag == PlotView::Drag::marker) frame.events.dragged_at = place_of(frame, at);
  if (view.drag == PlotView::Drag::marker)
    if (const auto near = nearest_along(frame.plot, view.look, frame.layout, at[0], at[1]))
      frame.events.dragged_to = hit_of(*near);
}

void end_drag(const PlotFrame& frame) {
  PlotView& view = frame.view;
  if (view.dragged && view.drag == PlotView::Drag::box) zoom_to_box(frame);
  if (view.drag == PlotView::Drag::marker) frame.events.drag_ended = view.dragged;
  if (!view.dragged && view.button == 1) ImGui::OpenPopup("menu");
  if (!view.dragged && view.button == 0) {
    const auto [x, y] = view.drag_from;
    frame.events.clicked_at = place_of(frame, view.drag_from);
    const double within = point_reach * frame.layout.scale;
    auto near = nearest_point(frame.plot, view.look, frame.layout, x, y, within);
    // Between the points of a line it is the line that is meant.
    if (!near) near = nearest_along(frame.plot, view.look, frame.layout, x, y);
    const bool line = near && frame.plot.curves[near->curve].line != PlotLine::none;
    if (near && near->distance <= within && (line || near->index == std::floor(near->index)))
      frame.events.clicked = hit_of(*near);
  }
  view.drag = PlotView::Drag::none;
  view.dragged = false;
}

void take_area(const PlotFrame& frame) {
  PlotView& view = frame.view;
  if (ImGui::IsItemActivated()) {
    const bool box = !ImGui::IsMouseDown(0) || ImGui::GetIO().KeyShift;
    begin_drag(frame,
               box                                       ? PlotView::Drag::box
               : on_marker(frame, pointer_in(frame.pen)) ? PlotView::Drag::marker
                                                         : PlotView::Drag::pan,
               {true, true});
  }
  if (ImGui::IsItemActive() && view.drag != PlotView::Drag::none) follow_drag(frame);
  if (ImGui::IsItemDeactivated()) end_drag(frame);
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) fit_plot(view);
}

// Over the ticks of an axis: the same for that axis alone.
void take_axis(const PlotFrame& frame, bool along_x) {
  const PlotBox& a = frame.layout.area;
  const PlotBox box = along_x ? PlotBox{a.left, a.bottom + 1, a.right, frame.layout.height}
                              : PlotBox{0, a.top, a.left - 1, a.bottom};
  button_over(frame, along_x ? "x" : "y", box, frame.name + (along_x ? "/axis/x" : "/axis/y"),
              ImGuiButtonFlags_MouseButtonLeft, KeyUse::none);
  zoom_with_wheel(frame, along_x, !along_x);
  if (ImGui::IsItemActivated()) begin_drag(frame, PlotView::Drag::pan, {along_x, !along_x});
  if (ImGui::IsItemActive()) follow_drag(frame);
  if (ImGui::IsItemDeactivated()) frame.view.drag = PlotView::Drag::none;
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
    frame.view.look.range[along_x ? 0 : 1].reset();
  if (ImGui::IsItemHovered())
    ImGui::SetMouseCursor(along_x ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
}

void take_legend(const PlotFrame& frame) {
  for (const PlotLegendEntry& entry : frame.layout.legend) {
    const std::string name = frame.name + "/legend/" + entry.name;
    const bool pressed =
        button_over(frame, name.c_str(), entry.box, name, ImGuiButtonFlags_MouseButtonLeft, KeyUse::press);
    if (ImGui::IsItemHovered()) {
      frame.pen.list.AddRectFilled(frame.pen.at(entry.box.left, entry.box.top),
                                   frame.pen.at(entry.box.right, entry.box.bottom),
                                   packed(colors_of(frame.ui).raised), 4 * frame.ui.scale);
      if (entry.text.text != entry.name) help_on_hover(entry.name.c_str());
    }
    if (!pressed) continue;
    std::set<std::string>& hidden = frame.view.look.hidden;
    if (!hidden.insert(entry.name).second) hidden.erase(entry.name);
  }
}

} // namespace

bool button_over(const PlotFrame& frame, const char* id, const PlotBox& box, const std::string& name,
                 ImGuiButtonFlags buttons, KeyUse use) {
  if (box.width() < 1 || box.height() < 1) return false;
  ImGui::SetCursorScreenPos(frame.pen.at(box.left, box.top));
  const bool pressed = ImGui::InvisibleButton(
      id, {static_cast<float>(box.width()), static_cast<float>(box.height())}, buttons);
  note_widget(frame.ui.widgets, name, use);
  return pressed;
}

PixelPoint pointer_in(const PlotPen& pen) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  return {static_cast<double>(mouse.x - pen.origin.x), static_cast<double>(mouse.y - pen.origin.y)};
}

void zoom_plot(PlotView& view, const PlotLayout& layout, int axis, double pixel, double factor) {
  const PlotRuler& ruler = layout.ruler(axis);
  view.look.range[static_cast<std::size_t>(axis)] =
      ruler.range_between(pixel + (ruler.from - pixel) * factor, pixel + (ruler.to - pixel) * factor);
}

std::array<double, 2> place_in_plot(const PlotFrame& frame, const PixelPoint& at) {
  return place_of(frame, at);
}

std::optional<PixelPoint> take_plot_input(const PlotFrame& frame) {
  take_plot_grip(frame);
  button_over(frame, "area", frame.layout.area, frame.name + "/area",
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight, KeyUse::plot);
  const std::optional<PixelPoint> keyed = take_plot_keys(frame);
  zoom_with_wheel(frame, true, true);
  take_area(frame);
  const bool inside = ImGui::IsItemHovered() && frame.view.drag != PlotView::Drag::pan &&
                      frame.view.drag != PlotView::Drag::marker;
  const bool drags = frame.view.drag != PlotView::Drag::none;
  if (inside && !drags) {
    const PixelPoint at = pointer_in(frame.pen);
    frame.view.cursor = frame.layout.x.value(at[0]);
    if (on_marker(frame, at)) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (const auto near = nearest_point(frame.plot, frame.view.look, frame.layout, at[0], at[1],
                                        point_reach * frame.layout.scale))
      frame.events.hovered = hit_of(*near);
  }
  take_axis(frame, true);
  take_axis(frame, false);
  take_legend(frame);
  if (keyed || !inside || drags) return keyed;
  return pointer_in(frame.pen);
}

} // namespace flyball
