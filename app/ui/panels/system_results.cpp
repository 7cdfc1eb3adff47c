// What was compiled for solving, and what was left out because this scene has no use for it.
#include "app/ui/panels.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <fmt/format.h>

namespace flyball {

namespace {

void list_of(Ui& ui, const char* title, const std::vector<std::string>& words, const ImVec4& color) {
  if (words.empty()) return;
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextUnformatted(title);
  ImGui::PopFont();
  for (const std::string& word : words)
    paragraph(word, color);
}

} // namespace

void system_results(App& app) {
  const UiColors& colors = colors_of(app);
  const SystemSummary& summary = app.answer.summary;
  if (!section(app, "results/system", "System", app.panels.system)) return;
  row(app, "Bodies", std::to_string(summary.bodies), "");
  row(app, "Coordinates, free", std::to_string(summary.free_coordinates), "");
  row(app, "Coordinates, driven", std::to_string(summary.driven_coordinates), "");
  if (summary.constraint_equations > 0)
    row(app, "Constraint equations", std::to_string(summary.constraint_equations), "");
  if (!summary.cut_joints.empty()) row(app, "Cut joints", name_list(summary.cut_joints), "");
  if (!summary.implicit_joints.empty()) row(app, "Added joints", name_list(summary.implicit_joints), "");
  for (const std::string& note : summary.notes)
    paragraph(note, colors.dim);
  list_of(app, "In use", summary.in, colors.dim);
  list_of(app, "Left out", summary.left_out, colors.dim);
}

} // namespace flyball
