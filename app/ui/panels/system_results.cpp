// What was compiled for solving, and what was left out because this scene has no use for it.
#include "app/ui/panels/result_sections.hpp"
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

void system_results(const Session& session, Ui& ui, ResultSections& open) {
  const UiColors& colors = colors_of(ui);
  const SystemSummary& summary = session.answer.summary;
  if (!section(ui, "results/system", "System", open.system)) return;
  row(ui, "Bodies", std::to_string(summary.bodies), "");
  row(ui, "Coordinates, free", std::to_string(summary.free_coordinates), "");
  row(ui, "Coordinates, driven", std::to_string(summary.driven_coordinates), "");
  if (summary.constraint_equations > 0)
    row(ui, "Constraint equations", std::to_string(summary.constraint_equations), "");
  if (!summary.cut_joints.empty()) row(ui, "Cut joints", name_list(summary.cut_joints), "");
  if (!summary.implicit_joints.empty()) row(ui, "Added joints", name_list(summary.implicit_joints), "");
  for (const std::string& note : summary.notes)
    paragraph(note, colors.dim);
  list_of(ui, "In use", summary.in, colors.dim);
  list_of(ui, "Left out", summary.left_out, colors.dim);
}

} // namespace flyball
