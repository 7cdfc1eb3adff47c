#include "app/plot/csv.hpp"
#include "app/ui/plots/plot_parts.hpp"
#include "app/ui/plots/plot_save.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <utility>

namespace flyball {

namespace {

bool item(const PlotFrame& frame, const char* name, const char* text, bool on = false, bool usable = true) {
  const bool chosen = ImGui::MenuItem(text, nullptr, on, usable);
  note_widget(frame.ui.widgets, frame.name + "/menu/" + name);
  return chosen;
}

// Whether anything that is shown could stand on a logarithmic axis.
bool has_positive(const PlotFrame& frame, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  for (const PlotCurve& curve : frame.plot.curves)
    if (is_shown(curve, frame.view.look))
      for (const auto& point : curve.points)
        if (point[k] > 0) return true;
  if (!frame.plot.heat) return false;
  const std::vector<double>& grid = axis == 0 ? frame.plot.heat->x : frame.plot.heat->y;
  return !grid.empty() && grid.front() > 0;
}

void scale_item(const PlotFrame& frame, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  const bool on = frame.layout.ruler(axis).logarithmic;
  if (!item(frame, axis == 0 ? "log x" : "log y", axis == 0 ? "Logarithmic x" : "Logarithmic y", on,
            on || has_positive(frame, axis)))
    return;
  frame.view.look.logarithmic[k] = !on;
  frame.view.look.range[k].reset();
}

} // namespace

void plot_menu(const PlotFrame& frame) {
  frame.ui.plot_drawn = true;
  PlotFile wanted = std::exchange(frame.ui.plot_file_wanted, PlotFile::none);
  if (ImGui::BeginPopup("menu")) {
    if (item(frame, "fit", "Fit")) fit_plot(frame.view);
    ImGui::Separator();
    scale_item(frame, 0);
    scale_item(frame, 1);
    ImGui::Separator();
    if (item(frame, "copy", "Copy as CSV")) {
      ImGui::SetClipboardText(to_csv(frame.plot, frame.view.look).c_str());
      frame.session.notice = "Copied the plot's numbers";
    }
    if (item(frame, "png", "Save as PNG…")) wanted = PlotFile::png;
    if (item(frame, "svg", "Save as SVG…")) wanted = PlotFile::svg;
    if (item(frame, "csv", "Save as CSV…")) wanted = PlotFile::csv;
    ImGui::EndPopup();
  }
  if (wanted == PlotFile::none) return;
  PlotSave save;
  save.plot = frame.plot;
  save.look = frame.view.look;
  save.kind = wanted;
  save.width = frame.layout.width / frame.layout.scale;
  save.height = frame.layout.height / frame.layout.scale;
  save.ground = frame.pen.ground;
  frame.ui.plot_to_save = std::make_shared<PlotToSave>(
      PlotToSave{frame.name.substr(std::string("plot/").size()), std::move(save)});
}

} // namespace flyball
