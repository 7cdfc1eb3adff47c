#include "app/ui/studies/modes/critical_speeds.hpp"

#include "app/plot/campbell_plot.hpp"
#include "app/render/icons.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace flyball {

namespace {

constexpr float padding = 4;     // points, at either side of a cell
constexpr float least_mode = 36; // points: "mode 3" where there is too little room for more

struct CriticalColumn {
  const char* title;
  float width; // points
  const char* help;
};
constexpr std::array columns{
    CriticalColumn{"Line", 28, "So many oscillations a turn of the drive."},
    CriticalColumn{"Mode", 96, "As the list numbers the modes at the present speed."},
    CriticalColumn{"Whirl", 60, "Which way it goes round the drive's axis at that speed."},
    CriticalColumn{"Unbalance", 66,
                   "Whether an unbalance can excite it: that turns with the drive, once a turn, and does not "
                   "excite what goes round against it in circles."},
    CriticalColumn{
        "Speed", 84,
        "The drive's speed. A click on a row sets the number along the axis so that the drive has it."}};

constexpr std::size_t mode_column = 1; // which gives way where there is too little room

std::string help_of(const CriticalSpeed& at, const std::string& name, const std::string& speed,
                    const ShownUnit& unit) {
  std::string text = order_text(at.order) + " " + name + (at.until ? " runs along from " : " at ") + speed +
                     " " + unit.text + " ± " + short_text(unit.shown(at.error), 1) + " " + unit.text + ", " +
                     short_text(hertz(at.frequency), 6) + " Hz, damping ratio " +
                     short_text(at.damping_ratio, 3) + ".";
  if (at.touches) text += "\nIt only touches the line.";
  if (!at.stable) text += "\nThe steady state is unstable there.";
  if (at.whirl && at.whirl->turning) text += "\nIts whirl is as seen from what turns with the drive.";
  if (unbalance_excites(at)) text += "\nAn unbalance excites it.";
  return text;
}

} // namespace

std::vector<CriticalRow> critical_rows(const CampbellDiagram& diagram, std::size_t branch,
                                       std::span<const std::string> names, const ShownUnit& unit) {
  // A branch that goes through a crossing to its mirror image has each speed twice.
  const auto same = [&](const CriticalSpeed& a, const CriticalSpeed& b) {
    constexpr double rounding = 1e-9;
    return a.order == b.order && a.stable == b.stable &&
           names[static_cast<std::size_t>(a.line)] == names[static_cast<std::size_t>(b.line)] &&
           std::abs(a.speed - b.speed) <= a.error + b.error + rounding * std::abs(a.speed) &&
           std::abs(a.frequency - b.frequency) <= 1e-6 * a.frequency;
  };
  std::vector<CriticalSpeed> found;
  for (const CriticalSpeed& at : diagram.critical)
    if (at.branch == static_cast<int>(branch) &&
        std::ranges::none_of(found, [&](const CriticalSpeed& known) { return same(at, known); }))
      found.push_back(at);
  std::ranges::stable_sort(found, {}, [](const CriticalSpeed& at) { return std::tuple(at.order, at.speed); });
  std::vector<CriticalRow> rows;
  for (const CriticalSpeed& at : found) {
    const std::string& name = names[static_cast<std::size_t>(at.line)];
    std::string speed = short_text(unit.shown(at.speed), 6);
    if (at.until) speed += " … " + short_text(unit.shown(*at.until), 6);
    rows.push_back({.order = order_text(at.order),
                    .mode = name,
                    .whirl = at.whirl ? std::string(word(at.whirl->direction())) : "–",
                    .speed = speed,
                    .unbalance = unbalance_excites(at),
                    .at = at.value,
                    .help = help_of(at, name, speed, unit)});
  }
  return rows;
}

float critical_table_width(const Ui& ui) {
  float width = ImGui::GetStyle().ScrollbarSize;
  for (const CriticalColumn& column : columns)
    width += (column.width + 2 * padding) * ui.scale;
  return width;
}

float critical_table_bar(const Ui& ui, float width) {
  const float least = critical_table_width(ui) - (columns[mode_column].width - least_mode) * ui.scale;
  return width < least ? ImGui::GetStyle().ScrollbarSize : 0;
}

void critical_table(Session& session, Ui& ui, const std::vector<CriticalRow>& rows, const ShownUnit& unit,
                    const std::string& address, float height) {
  const UiColors& colors = colors_of(ui);
  const float width = std::min(critical_table_width(ui), ImGui::GetContentRegionAvail().x);
  const float mode_width =
      std::max(least_mode, columns[mode_column].width - (critical_table_width(ui) - width) / ui.scale) *
      ui.scale;
  const bool scrolls = critical_table_bar(ui, width) > 0;
  const ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerH |
                                ImGuiTableFlags_NoSavedSettings | ImGuiTableFlags_SizingFixedFit |
                                (scrolls ? ImGuiTableFlags_ScrollX : 0);
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {padding * ui.scale, 2 * ui.scale});
  ImGui::PushStyleColor(ImGuiCol_TableHeaderBg, colors.panel);
  ImGui::PushStyleColor(ImGuiCol_TableBorderLight, colors.border);
  if (ImGui::BeginTable("critical speeds", static_cast<int>(columns.size()), flags, {width, height})) {
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const CriticalColumn& column : columns)
      ImGui::TableSetupColumn(column.title, ImGuiTableColumnFlags_WidthFixed,
                              &column == &columns[mode_column] ? mode_width : column.width * ui.scale);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (const CriticalColumn& column : columns) {
      if (!ImGui::TableNextColumn()) continue;
      const bool speed = &column == &columns.back();
      ImGui::TextColored(colors.dim, "%s", speed ? ("Speed [" + unit.text + "]").c_str() : column.title);
      help_on_hover(column.help);
    }
    visible_rows(rows.size(), [&](std::size_t i) {
      const CriticalRow& row = rows[i];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable("##speed", false, ImGuiSelectableFlags_SpanAllColumns))
        later(ui, [&session, address, value = row.at] { change_parameter(session, address, value); });
      note_widget(ui.widgets, "campbell/critical/" + std::to_string(i + 1), KeyUse::row);
      help_on_hover(row.help.c_str());
      ImGui::PopID();
      ImGui::SameLine(0, 0);
      ImGui::TextUnformatted(row.order.c_str());
      if (ImGui::TableNextColumn())
        ImGui::TextUnformatted(cut_to(row.mode, ImGui::GetContentRegionAvail().x).c_str());
      for (const std::string& cell : {row.whirl, std::string(row.unbalance ? icon::check : "")})
        if (ImGui::TableNextColumn()) ImGui::TextUnformatted(cell.c_str());
      if (ImGui::TableNextColumn()) right_digits(ui, row.speed, colors.text);
    });
    ImGui::EndTable();
  }
  ImGui::PopStyleColor(2);
  ImGui::PopStyleVar();
}

} // namespace flyball
