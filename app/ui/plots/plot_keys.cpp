// A plot by keys: arrows move its marker, or where there is none a cursor to read by; plus and minus zoom.
#include "app/plot/nearest.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/plots/plot_parts.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double zoom_of_key = 1.18; // as a notch of the wheel

PixelPoint pixel_of(const PlotFrame& frame, double x, double y) {
  return {frame.layout.x.pixel(x), frame.layout.y.pixel(y)};
}

PixelPoint held_in(const PlotBox& area, const PixelPoint& at) {
  return {std::clamp(at[0], area.left, area.right), std::clamp(at[1], area.top, area.bottom)};
}

void move_marker(const PlotFrame& frame, const PixelPoint& to) {
  frame.events.dragged_at = place_in_plot(frame, to);
  if (const auto near = nearest_along(frame.plot, frame.view.look, frame.layout, to[0], to[1]))
    frame.events.dragged_to = PlotHit{near->curve, near->index, near->x, near->y};
  frame.events.drag_ended = true;
}

void click_at(const PlotFrame& frame, const PixelPoint& at) {
  frame.events.clicked_at = place_in_plot(frame, at);
  if (const auto near = nearest_along(frame.plot, frame.view.look, frame.layout, at[0], at[1]))
    frame.events.clicked = PlotHit{near->curve, near->index, near->x, near->y};
}

} // namespace

std::optional<PixelPoint> take_plot_keys(const PlotFrame& frame) {
  const std::string area_name = frame.name + "/area";
  if (!has_keyboard(frame.ui, area_name)) {
    frame.view.keyed.reset();
    return std::nullopt;
  }
  if (takes_menu_key(frame.ui, area_name)) ImGui::OpenPopup("menu");
  const PlotBox& area = frame.layout.area;
  const auto& marker = frame.plot.marker;
  PixelPoint at{(area.left + area.right) / 2, (area.top + area.bottom) / 2};
  if (frame.view.keyed) at = pixel_of(frame, (*frame.view.keyed)[0], (*frame.view.keyed)[1]);
  if (marker) at = pixel_of(frame, marker->x, marker->y);
  if (const KeyNudge* nudge = nudge_of(frame.ui, area_name)) {
    const double step = nudge->size * plot_key_share;
    const PixelPoint moved{at[0] + nudge->x * std::max(1.0, step * area.width()),
                           at[1] - nudge->y * std::max(1.0, step * area.height())};
    const PixelPoint to = held_in(area, moved);
    if (nudge->fit) fit_plot(frame.view);
    for (int axis = 0; axis < 2 && nudge->zoom != 0; ++axis)
      zoom_plot(frame.view, frame.layout, axis, at[static_cast<std::size_t>(axis)],
                std::pow(zoom_of_key, -nudge->zoom));
    if (nudge->enter) click_at(frame, held_in(area, at));
    if (nudge->x != 0 || nudge->y != 0) {
      if (marker) move_marker(frame, to);
      at = to;
    }
  }
  if (marker) return std::nullopt;
  frame.view.keyed = {frame.layout.x.value(at[0]), frame.layout.y.value(at[1])};
  return at;
}

} // namespace flyball
