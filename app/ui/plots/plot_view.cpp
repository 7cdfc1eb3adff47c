#include "app/ui/plots/plot_view.hpp"

#include "app/ui/plots/plot_parts.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

std::shared_ptr<const PlotLayout> laid_out(const Ui& ui, PlotView& view, const Plot& plot, ImVec2 size) {
  PlotKept& kept = view.kept;
  const bool same = kept.layout && plot.version != 0 && kept.version == plot.version &&
                    kept.look == view.look && kept.width == size.x && kept.height == size.y &&
                    kept.scale == ui.scale && kept.sides == view.sides;
  if (!same)
    kept = {plot.version,
            view.look,
            size.x,
            size.y,
            ui.scale,
            view.sides,
            std::make_shared<PlotLayout>(plot_layout(plot, view.look, static_cast<double>(size.x),
                                                     static_cast<double>(size.y),
                                                     plot_metrics(ui.fonts, ui.scale), view.sides))};
  return kept.layout;
}

ImVec2 whole_pixels(ImVec2 size) {
  return {std::max(std::floor(size.x), 1.f), std::max(std::floor(size.y), 1.f)};
}

// The pixel at which the plot is read because another one is.
std::optional<PixelPoint> followed_place(const PlotFrame& frame) {
  if (!frame.view.followed) return std::nullopt;
  const PlotBox& area = frame.layout.area;
  const PixelPoint at{frame.layout.x.pixel(*frame.view.followed), (area.top + area.bottom) / 2};
  if (!area.contains(at[0], at[1])) return std::nullopt;
  return at;
}

void draw_box(const PlotFrame& frame) {
  if (frame.view.drag != PlotView::Drag::box || !frame.view.dragged) return;
  const PlotBox& a = frame.layout.area;
  const PixelPoint to = pointer_in(frame.pen);
  const ImVec2 from = frame.pen.at(frame.view.drag_from[0], frame.view.drag_from[1]),
               end = frame.pen.at(std::clamp(to[0], a.left, a.right), std::clamp(to[1], a.top, a.bottom));
  const ImVec2 low(std::min(from.x, end.x), std::min(from.y, end.y)),
      high(std::max(from.x, end.x), std::max(from.y, end.y));
  ImVec4 accent = colors_of(frame.ui).accent;
  frame.pen.list.AddRect(low, high, packed(accent), 0, 0, std::max(1.f, std::round(frame.ui.scale)));
  accent.w = 0.12f;
  frame.pen.list.AddRectFilled(low, high, packed(accent));
}

} // namespace

PlotEvents plot_view(Session& session, Ui& ui, const std::string& name, PlotView& view, const Plot& plot,
                     ImVec2 size) {
  PlotEvents events;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  size = whole_pixels(size);
  if (!ImGui::IsRectVisible(size)) {
    ImGui::Dummy(size);
    return events;
  }
  ImGui::PushID(name.c_str());
  const std::shared_ptr<const PlotLayout> layout = laid_out(ui, view, plot, size);
  const PlotPen pen{*ImGui::GetWindowDrawList(),
                    ui.fonts,
                    {std::round(at.x), std::round(at.y)},
                    ui.scale,
                    plot_ground(ui.theme)};
  const std::string path = "plot/" + name;
  const PlotFrame frame{session, ui, path, view, plot, *layout, pen, events};
  view.cursor.reset();
  view.card.clear();
  std::optional<PixelPoint> reading;
  pen.list.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  if (layout->drawable()) {
    reading = take_plot_input(frame);
    draw_plot(pen, plot, view.look, *layout);
    draw_box(frame);
  }
  const bool held = view.drag == PlotView::Drag::marker || view.drag == PlotView::Drag::pull;
  draw_marker(pen, plot, *layout, held);
  draw_plot_grip(frame);
  // The card lies over everything.
  if (reading)
    show_plot_reading(frame, *reading);
  else if (const auto place = followed_place(frame); place && layout->drawable())
    show_plot_reading(frame, *place, true);
  pen.list.PopClipRect();
  plot_menu(frame);
  ImGui::SetCursorScreenPos(at);
  ImGui::Dummy(size);
  ImGui::PopID();
  return events;
}

void align_plots(const Ui& ui, std::initializer_list<StackedPlot> plots) {
  PlotSides most;
  for (const StackedPlot& each : plots) {
    each.view.sides.x_below = &each != plots.end() - 1;
    const PlotSides own = laid_out(ui, each.view, each.plot, whole_pixels(each.size))->own_sides;
    most = {std::max(most.left, own.left), std::max(most.right, own.right)};
  }
  for (const StackedPlot& each : plots)
    each.view.sides = {most.left, most.right, each.view.sides.x_below};
}

void replace_plot(Plot& plot, Plot next) {
  next.version = plot.version + 1;
  plot = std::move(next);
}

void fit_plot(PlotView& view) {
  view.look.range = {};
}

} // namespace flyball
