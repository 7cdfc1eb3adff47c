#include "app/render/icons.hpp"
#include "app/session/session.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace flyball {

namespace {

struct Direction {
  const char* name;
  const char* text;
  const char* help;
  double azimuth, elevation; // rad
};

constexpr double half_pi = std::numbers::pi / 2;
constexpr std::array directions{
    Direction{"toolbar/front", "Front", "Look from the front (1)", 0, 0},
    Direction{"toolbar/side", "Side", "Look from the right (2)", half_pi, 0},
    Direction{"toolbar/top", "Top", "Look from above (3)", 0, half_pi},
    Direction{"toolbar/iso", "Iso", "Look from the front, right and above (4)", half_pi / 2,
              isometric_elevation},
};

struct Factor {
  double value;
  const char* text;
};
constexpr std::array factors{Factor{10, "10×"},    Factor{5, "5×"},       Factor{2, "2×"},
                             Factor{1, "1×"},      Factor{0.5, "0.5×"},   Factor{0.2, "0.2×"},
                             Factor{0.1, "0.1×"},  Factor{0.05, "0.05×"}, Factor{0.02, "0.02×"},
                             Factor{0.01, "0.01×"}};

void space_between_groups(const Ui& ui) {
  const float s = ui.scale;
  ImGui::SameLine(0, 8 * s);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float from = at.y + 5 * s, to = at.y + ImGui::GetFrameHeight() - 3 * s;
  ImGui::GetWindowDrawList()->AddLine({at.x, from}, {at.x, to}, packed(ui_colors(ui.theme).border),
                                      std::max(1.f, std::round(s)));
  ImGui::SameLine(0, 9 * s);
}

void next(const Ui& ui) {
  ImGui::SameLine(0, 2 * ui.scale);
}

// A command's button; its tooltip is the command's sentence with its key.
void command_button(Ui& ui, const CommandRunner& commands, const char* id, const char* icon) {
  const Command& wanted = command(id);
  const std::string keys = key_text(wanted.key);
  const std::string help =
      (wanted.label ? commands.label(wanted) : wanted.help) + (keys.empty() ? "" : " (" + keys + ")");
  ImGui::BeginDisabled(!commands.enabled(wanted));
  if (icon_button(ui, "toolbar/" + std::string(id).substr(std::string(id).find('.') + 1), icon, help.c_str()))
    commands.run(wanted);
  ImGui::EndDisabled();
  next(ui);
}

void file_buttons(Ui& ui, const CommandRunner& commands) {
  command_button(ui, commands, "file.new", icon::file);
  command_button(ui, commands, "file.open", icon::folder_open);
  command_button(ui, commands, "file.save", icon::save);
  command_button(ui, commands, "file.export", icon::camera);
  space_between_groups(ui);
  command_button(ui, commands, "edit.undo", icon::undo);
  command_button(ui, commands, "edit.redo", icon::redo);
}

// Two words, of which one is lit.
void mode_switch(Session& session, Ui& ui) {
  const UiColors& colors = colors_of(ui);
  const auto word = [&](const char* name, const char* text, Mode mode, const char* help) {
    const bool on = session.mode == mode;
    ImGui::PushStyleColor(ImGuiCol_Text, on ? colors.on_accent : colors.text);
    ImGui::PushStyleColor(ImGuiCol_Button, on ? colors.accent : colors.raised);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, on ? colors.accent : colors.pointed);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {10 * ui.scale, 5 * ui.scale});
    ImGui::PushID(name);
    if (ImGui::Button(text)) set_mode(session, mode);
    ImGui::PopID();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(3);
    note_widget(ui.widgets, name);
    help_on_hover(help);
  };
  word("toolbar/build", "Build", Mode::build,
       "Edit the drawn pose; the steady state is the ghost beside it (Tab)");
  ImGui::SameLine(0, 0);
  word("toolbar/explore", "Explore", Mode::explore, "Move sliders and see where it settles (Tab)");
  next(ui);
}

void play_buttons(Session& session, Ui& ui) {
  const bool playing = session.playback.playing;
  if (icon_button(ui, "toolbar/play", playing ? icon::pause : icon::play,
                  playing ? "Stop the drives (Space)" : "Turn at the drives' speed (Space)", playing))
    play(session, !playing);
  next(ui);
  if (icon_button(ui, "toolbar/rewind", icon::step_backward, "Back to the drawn phase of the drives"))
    rewind(session);
  next(ui);
  factor_combo(session, ui, "toolbar/factor", 62 * ui.scale);
}

void direction_buttons(Ui& ui, ViewState& view) {
  for (const Direction& direction : directions) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6 * ui.scale, 5 * ui.scale});
    ImGui::PushID(direction.name);
    if (ImGui::Button(direction.text)) look_from(view, direction.azimuth, direction.elevation);
    ImGui::PopID();
    ImGui::PopStyleVar();
    note_widget(ui.widgets, direction.name);
    help_on_hover(direction.help);
    next(ui);
  }
  if (icon_button(ui, "toolbar/fit", icon::expand, "All in view (F)")) fit_all(view);
}

// Whether these words have room as buttons beside what ends the bar; without it they are in the menu alone.
bool have_room(const Ui& ui, const PanelRect& rect, std::initializer_list<const char*> words, float more) {
  float width = more;
  for (const char* word : words)
    width += ImGui::CalcTextSize(word).x + (12 + 2) * ui.scale;
  const float end = ImGui::GetFrameHeight() + 2 * ui.scale + 8 * ui.scale;
  return ImGui::GetCursorPosX() + width <= rect.width - end;
}

void toggle(const Session& session, Ui& ui, ViewState& view, bool ViewState::*what, const char* name,
            const char* text, const char* help) {
  const bool on = view.*what;
  const UiColors& colors = colors_of(ui);
  ImGui::PushStyleColor(ImGuiCol_Text, on ? colors.accent : colors.dim);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6 * ui.scale, 5 * ui.scale});
  ImGui::PushID(name);
  if (ImGui::Button(text)) toggle_in_view(session, ui, view, what);
  ImGui::PopID();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  note_widget(ui.widgets, name);
  help_on_hover(help);
  next(ui);
}

} // namespace

void factor_combo(Session& session, Ui& ui, const char* name, float width) {
  const auto current = std::ranges::find(factors, session.playback.factor, &Factor::value);
  ImGui::SetNextItemWidth(width);
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + ui.scale);
  ImGui::PushID(name);
  if (ImGui::BeginCombo("##factor", current == factors.end() ? "" : current->text,
                        ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLarge)) {
    for (const Factor& factor : factors) {
      const bool chosen = factor.value == session.playback.factor;
      if (ImGui::Selectable(factor.text, chosen)) session.playback.factor = factor.value;
      note_widget(ui.widgets, std::string(name) + "/" + factor.text);
      if (chosen) mark_chosen(ui.widgets);
    }
    ImGui::EndCombo();
  } else {
    note_widget(ui.widgets, name);
  }
  ImGui::PopID();
  help_on_hover("Speed of the picture: below 1× is slow motion");
}

void toolbar_panel(Session& session, Ui& ui, ViewState& view, const CommandRunner& commands,
                   const PanelRect& rect) {
  const float s = ui.scale;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * s, 7 * s});
  begin_panel("toolbar", rect,
              ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_MenuBar);
  ImGui::PopStyleVar();
  menu_bar(session, ui, commands);
  file_buttons(ui, commands);
  space_between_groups(ui);
  mode_switch(session, ui);
  space_between_groups(ui);
  ImGui::BeginDisabled(session.mode != Mode::explore); // what follows stays where it is
  play_buttons(session, ui);
  ImGui::EndDisabled();
  // The line between groups is only where another follows.
  const float space = 17 * s, fit = ImGui::GetFrameHeight() + 2 * s;
  ImGui::SameLine(0, 0);
  if (have_room(ui, rect, {"Front", "Side", "Top", "Iso"}, space + fit + space)) {
    space_between_groups(ui);
    direction_buttons(ui, view);
    ImGui::SameLine(0, 0);
    if (have_room(ui, rect, {"Ghost", "Grid", "Shadow"}, space)) {
      space_between_groups(ui);
      toggle(session, ui, view, &ViewState::ghost, "toolbar/ghost", "Ghost",
             session.mode == Mode::build ? "Where it settles, in grey (G)" : "The drawn pose, in grey (G)");
      toggle(session, ui, view, &ViewState::grid, "toolbar/grid", "Grid", "The floor");
      toggle(session, ui, view, &ViewState::shadow, "toolbar/shadow", "Shadow", "Shadow on the floor");
    }
  }
  const float side = ImGui::GetFrameHeight() + 2 * s;
  ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), rect.width - side - 8 * s));
  const bool light = ui.theme == Theme::light;
  if (icon_button(ui, "toolbar/theme", light ? icon::moon : icon::sun,
                  light ? "Dark colours" : "Light colours"))
    choose_theme(session, ui, view, light ? ThemeChoice::dark : ThemeChoice::light);
  const float line = rect.height - std::max(1.f, std::round(s));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  list.AddRectFilled({0, line}, {rect.width, rect.height}, packed(colors_of(ui).border));
  list.PopClipRect();
  ImGui::End();
}

} // namespace flyball
