// The grip beside a plot's marker, by which it is pulled off its curve.
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/plots/plot_parts.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// Points.
constexpr double grip_away = 25; // from the marker's centre to the grip's
constexpr double grip_width = 15, grip_height = 21;
constexpr double sideways_from = 12; // that a hand which pulls up or down may go sideways
constexpr double ring_from = 4;      // farther away the way to where the marker is wanted is drawn

PixelPoint marker_pixel(const PlotFrame& frame) {
  return {frame.layout.x.pixel(frame.plot.marker->x), frame.layout.y.pixel(frame.plot.marker->y)};
}

PixelPoint inside_of(const PlotBox& a, const PixelPoint& at) {
  return {std::clamp(at[0], a.left, a.right), std::clamp(at[1], a.top, a.bottom)};
}

// Where the hand that pulls wants the marker.
PixelPoint wanted_pixel(const PlotFrame& frame) {
  const PlotView& view = frame.view;
  const PixelPoint at = pointer_in(frame.pen);
  const double across = view.pull_sideways ? at[0] - view.drag_from[0] : 0;
  return inside_of(frame.layout.area,
                   {view.pull_from[0] + across, view.pull_from[1] + at[1] - view.drag_from[1]});
}

bool is_pulled(const PlotFrame& frame) {
  return frame.view.drag == PlotView::Drag::pull;
}

bool on_a_label(const PlotLayout& layout, const PlotBox& box) {
  for (const auto* placed : {&layout.references, &layout.marks})
    for (const PlotPlaced& p : *placed)
      if (p.label && p.label->box.overlaps(box, 0)) return true;
  return false;
}

// Above the marker, or below where there is no room or a label; none where it is out of sight.
std::optional<PlotBox> grip_box(const PlotFrame& frame) {
  if (!frame.plot.marker || frame.plot.marker->pull.empty()) return std::nullopt;
  const PlotBox& area = frame.layout.area;
  const PixelPoint at = is_pulled(frame) ? wanted_pixel(frame) : marker_pixel(frame);
  if (!area.grown(1).contains(at[0], at[1])) return std::nullopt;
  const double s = frame.layout.scale, half = grip_height * s / 2;
  const auto box = [&](double y) {
    return PlotBox{at[0] - grip_width * s / 2, y - half, at[0] + grip_width * s / 2, y + half};
  };
  const PlotBox above = box(at[1] - grip_away * s), below = box(at[1] + grip_away * s);
  if (above.top < area.top) return below;
  const bool crowded = below.bottom <= area.bottom && on_a_label(frame.layout, above);
  return crowded && !on_a_label(frame.layout, below) ? below : above;
}

void follow_grip(const PlotFrame& frame) {
  PlotView& view = frame.view;
  const PixelPoint at = pointer_in(frame.pen);
  const double across = std::abs(at[0] - view.drag_from[0]);
  if (across > sideways_from * frame.layout.scale) view.pull_sideways = true;
  if (!view.pull_sideways && at[1] == view.drag_from[1] && !view.pull_to) return; // pressed, not pulled yet
  const std::array<double, 2> place = place_in_plot(frame, wanted_pixel(frame));
  const PlotPull to{view.pull_sideways ? std::optional(place[0]) : std::nullopt, place[1]};
  if (view.pull_to == to) return;
  view.pull_to = to;
  frame.events.pulled_to = to;
}

void pull_by_keys(const PlotFrame& frame, const std::string& name) {
  const KeyNudge* nudge = nudge_of(frame.ui, name);
  if (!nudge || (nudge->x == 0 && nudge->y == 0)) return;
  const PlotBox& area = frame.layout.area;
  const double step = nudge->size * plot_key_share;
  const PixelPoint from = marker_pixel(frame);
  const std::array<double, 2> place =
      place_in_plot(frame, inside_of(area, {from[0] + nudge->x * std::max(1.0, step * area.width()),
                                            from[1] - nudge->y * std::max(1.0, step * area.height())}));
  frame.events.pulled_to = PlotPull{nudge->x != 0 ? std::optional(place[0]) : std::nullopt,
                                    nudge->y != 0 ? place[1] : frame.plot.marker->y};
}

} // namespace

void take_plot_grip(const PlotFrame& frame) {
  PlotView& view = frame.view;
  const std::optional<PlotBox> box = grip_box(frame);
  if (!box) {
    if (is_pulled(frame)) view.drag = PlotView::Drag::none;
    return;
  }
  const std::string name = frame.name + "/pull";
  button_over(frame, "pull", *box, name, ImGuiButtonFlags_MouseButtonLeft, KeyUse::plot);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
  if (!ImGui::IsItemActive()) help_on_hover(frame.plot.marker->pull.c_str());
  if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    view.drag = PlotView::Drag::pull;
    view.drag_from = pointer_in(frame.pen);
    view.pull_from = marker_pixel(frame);
    view.pull_sideways = false;
    view.pull_to.reset();
  }
  if (ImGui::IsItemActive() && is_pulled(frame)) follow_grip(frame);
  if (!ImGui::IsItemActive() && is_pulled(frame)) view.drag = PlotView::Drag::none;
  pull_by_keys(frame, name);
}

void draw_plot_grip(const PlotFrame& frame) {
  const std::optional<PlotBox> box = grip_box(frame);
  if (!box) return;
  const PlotPen& pen = frame.pen;
  const UiColors& colors = colors_of(frame.ui);
  const float s = frame.ui.scale, line = std::max(1.f, std::round(s));
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const ImVec2 from = pen.at(box->left, box->top), to = pen.at(box->right, box->bottom);
  const bool pointed = mouse.x >= from.x && mouse.x < to.x && mouse.y >= from.y && mouse.y < to.y &&
                       frame.view.drag == PlotView::Drag::none && ImGui::IsWindowHovered();
  const bool lit = pointed || is_pulled(frame);
  if (is_pulled(frame)) {
    const PixelPoint at = wanted_pixel(frame), now = marker_pixel(frame);
    if (std::hypot(at[0] - now[0], at[1] - now[1]) > ring_from * frame.layout.scale) {
      draw_line(pen, {now, at}, PlotLine::dotted, 1.5, packed(colors.accent));
      pen.list.AddCircle(pen.at(at[0], at[1]), 5 * s, packed(colors.accent), 0, 1.5f * s);
    }
  }
  // A stem tells whose grip it is.
  const PixelPoint of = is_pulled(frame) ? wanted_pixel(frame) : marker_pixel(frame);
  const bool below = box->top > of[1];
  pen.list.AddLine(pen.at(of[0], of[1] + (below ? 8 : -8) * frame.layout.scale),
                   pen.at(of[0], below ? box->top : box->bottom), packed(lit ? colors.accent : colors.dim),
                   line);
  pen.list.AddRectFilled(from, to, packed(colors.panel), 4 * s);
  pen.list.AddRect(from, to, packed(lit ? colors.accent : colors.dim), 4 * s, 0, line);
  const ImU32 color = packed(lit ? colors.accent : colors.text);
  const ImVec2 middle{(from.x + to.x) / 2, (from.y + to.y) / 2};
  for (const float up : {-1.f, 1.f})
    pen.list.AddTriangleFilled({middle.x, middle.y + up * 8 * s}, {middle.x - 4 * s, middle.y + up * 3 * s},
                               {middle.x + 4 * s, middle.y + up * 3 * s}, color);
}

} // namespace flyball
