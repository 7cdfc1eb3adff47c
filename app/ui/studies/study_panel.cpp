#include "app/render/icons.hpp"
#include "app/session/units.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr float least_transport = 400; // points; a slider shorter than that finds no moment

struct Tab {
  StudyKind study;
  const char* name;
  const char* title;
  const char* help;
};
constexpr std::array tabs{
    Tab{StudyKind::motion, "study/motion", "Motion", "The damped motion beside the steady state"},
    Tab{StudyKind::response, "study/response", "Response",
        "The steady states over one parameter: branches, folds and crossings"},
    Tab{StudyKind::states, "study/states", "States", "Every equilibrium that a bounded search finds"},
    Tab{StudyKind::modes, "study/modes", "Modes", "How the steady state swings, and at which speeds"},
    Tab{StudyKind::map, "study/map", "Map", "A coordinate over the plane of two parameters, with its folds"},
    Tab{StudyKind::spread, "study/spread", "Spread",
        "How the steady state scatters with tolerances of numbers"},
    Tab{StudyKind::transfer, "study/transfer", "Transfer",
        "The linear model about the steady state: transfer function, poles and zeros"},
    Tab{StudyKind::compare, "study/compare", "Compare", "Error against run time: direct solution and motion"},
};

// What is left and right of the tabs' words, which is less where all of it is more than their room.
float tab_padding(const Ui& ui, float room) {
  float words = 0;
  for (const Tab& each : tabs)
    words += ImGui::CalcTextSize(each.title).x;
  return std::clamp((room - words) / (2 * static_cast<float>(tabs.size())), 3 * ui.scale, 8 * ui.scale);
}

// A word with a line below it where it is the one that shows.
bool tab(const Session& session, Ui& ui, const Tab& wanted, float padding) {
  const UiColors& colors = colors_of(ui);
  const bool on = session.study.open == wanted.study;
  const float s = ui.scale;
  const ImVec2 text = ImGui::CalcTextSize(wanted.title), from = ImGui::GetCursorScreenPos();
  const ImVec2 size(text.x + 2 * padding, text.y + 10 * s);
  const bool pressed = ImGui::InvisibleButton(wanted.name, size);
  note_widget(ui.widgets, wanted.name, KeyUse::tab);
  if (on) mark_chosen(ui.widgets);
  help_above(wanted.help);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText({from.x + padding, from.y + 4 * s},
               packed(on                       ? colors.text
                      : ImGui::IsItemHovered() ? colors.accent
                                               : colors.dim),
               wanted.title);
  if (on)
    list.AddRectFilled({from.x + padding, from.y + size.y - 3 * s},
                       {from.x + size.x - padding, from.y + size.y - s}, packed(colors.accent));
  ImGui::SameLine(0, 0);
  return pressed;
}

} // namespace

void StudyPanel::draw(Session& session, Ui& ui, const CommandRunner& commands, const PanelRect& rect) {
  const float s = ui.scale;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * s, 4 * s});
  begin_panel("study", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImGui::GetWindowDrawList()->AddLine({rect.x, rect.y}, {rect.x + rect.width, rect.y},
                                      packed(colors_of(ui).border), std::max(1.f, std::round(s)));
  StudyKind wanted = StudyKind::none;
  const float top = ImGui::GetCursorPosY();
  const float side = ImGui::GetFrameHeight() + 2 * s;
  const float padding = tab_padding(ui, rect.width - side - 16 * s);
  for (const Tab& each : tabs)
    if (tab(session, ui, each, padding) && each.study != session.study.open) wanted = each.study;
  bool transport_below = false; // where the tabs leave too little room
  if (session.study.open == StudyKind::motion && session.motion.on) {
    const float from = std::max(314 * s, ImGui::GetCursorPosX() + 12 * s);
    const float room = rect.width - side - 24 * s - from;
    transport_below = room < least_transport * s;
    if (!transport_below) {
      ImGui::SetCursorPosX(from);
      motion_transport(session, ui, room);
      ImGui::SameLine();
    }
  }
  ImGui::SetCursorPos({rect.width - side - 8 * s, top});
  const bool closed = icon_button(ui, "study/close", icon::close, "Close");
  ui.plot_drawn = false;
  switch (session.study.open) {
  case StudyKind::none: break;
  case StudyKind::motion: motion_panel(session, ui, shown_.motion, commands, transport_below); break;
  case StudyKind::compare: compare_panel(session, ui, shown_.compare); break;
  case StudyKind::response: response_panel(session, ui, shown_.response); break;
  case StudyKind::states: states_panel(session, ui); break;
  case StudyKind::modes: modes_panel(session, ui, shown_.campbell, commands); break;
  case StudyKind::map: map_panel(session, ui, shown_.map); break;
  case StudyKind::spread: spread_panel(session, ui, shown_.spread); break;
  case StudyKind::transfer: transfer_panel(session, ui, shown_.transfer, commands); break;
  }
  ui.plot_file_wanted = PlotFile::none; // there is no plot
  ImGui::End();
  if (closed) open_study(session, StudyKind::none);
  if (wanted != StudyKind::none) open_study(session, wanted);
}

void StudyPanel::forget_closed(const Session& session) {
  const StudyKind open = session.study.open;
  if (open != StudyKind::response) shown_.response = {};
  if (open != StudyKind::map) shown_.map = {};
  if (open != StudyKind::spread) shown_.spread = {};
  if (open != StudyKind::transfer) {
    const bool hertz = shown_.transfer.hertz;
    shown_.transfer = {};
    shown_.transfer.hertz = hertz;
  }
  if (open != StudyKind::modes) {
    const bool hertz = shown_.campbell.hertz;
    shown_.campbell = {};
    shown_.campbell.hertz = hertz;
  }
}

std::string range_label(const Session& session, const Ui& ui, const std::string& label,
                        const std::string& si_unit, const std::array<double, 2>& ends) {
  const ShownUnit unit = shown_unit(si_unit, session.units);
  const float row = ImGui::GetContentRegionAvail().x - label_width(ui) - margin_width(ui);
  const float room = (row - 6 * ui.scale) / 2 - 2 * 6 * ui.scale - 5 * ui.scale; // in each, without padding
  const ImFont* digits = ui.fonts.digits;
  const bool fits = std::ranges::all_of(ends, [&](double end) {
    const std::string number = short_text(unit.shown(end), 3);
    return digits->CalcTextSizeA(digits->FontSize, 1e9f, 0, number.c_str()).x +
               ImGui::CalcTextSize(unit.text.c_str()).x <=
           room;
  });
  return fits || unit.text.empty() ? label : label + " (" + unit.text + ")";
}

void StudyPanel::fit() {
  fit_plot(shown_.response.view);
  fit_plot(shown_.map.view);
  fit_plot(shown_.campbell.view);
  for (MotionPlot& plot : shown_.motion)
    fit_plot(plot.view);
}

} // namespace flyball
