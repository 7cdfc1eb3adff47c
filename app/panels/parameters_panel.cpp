#include "app/panels/panels.hpp"
#include "app/panels/widgets.hpp"
#include "app/render/icons.hpp"
#include "engine/mechanism/address.hpp"

#include <imgui_stdlib.h>

#include <algorithm>

namespace flyball {

namespace {

void start_typing(App& app, const ParameterControl& control, double value) {
  app.panels.editing = control.address;
  app.panels.typed = short_text(value, 12) + (control.unit.empty() ? "" : " " + control.unit);
  app.panels.focus_typed = true;
}

// The value as text that becomes a field when it is clicked.
void value_field(App& app, const ParameterControl& control, double value, float width) {
  const UiColors& colors = colors_of(app);
  const std::string name = "parameters/" + control.address + "/value";
  if (app.panels.editing == control.address) {
    ImGui::SetNextItemWidth(width);
    const bool understood = parse_quantity(app.panels.typed, control.unit).has_value();
    ImGui::PushStyleColor(ImGuiCol_Text, understood ? colors.text : colors.bad);
    if (app.panels.focus_typed) ImGui::SetKeyboardFocusHere();
    const bool done =
        ImGui::InputText("##typed", &app.panels.typed,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopStyleColor();
    note_widget(app.widgets, name);
    const bool left = !app.panels.focus_typed && ImGui::IsItemDeactivated();
    app.panels.focus_typed = false;
    // Leaving the field takes what was typed as Enter does; Escape puts the old text back before it leaves.
    if (done || left) {
      if (const auto typed = parse_quantity(app.panels.typed, control.unit); typed && *typed != value)
        change_parameter(app, control.address, *typed);
      app.panels.editing.clear();
    }
    return;
  }
  const std::string text = short_text(value);
  const ImFont* digits = app.fonts.digits;
  const ImVec2 size = digits->CalcTextSizeA(digits->FontSize, 1e9f, 0, text.c_str());
  const float unit_width =
      control.unit.empty() ? 0 : ImGui::CalcTextSize(control.unit.c_str()).x + 5 * app.scale;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight();
  if (ImGui::InvisibleButton(name.c_str(), {width, height})) start_typing(app, control, value);
  note_widget(app.widgets, name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered()) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
    list.AddRectFilled(from, {from.x + width, from.y + height}, packed(colors.raised),
                       ImGui::GetStyle().FrameRounding);
  }
  const float right = from.x + width - 4 * app.scale;
  const float y = from.y + ImGui::GetStyle().FramePadding.y;
  list.AddText(digits, digits->FontSize, {right - unit_width - size.x, y + digits_drop(app)},
               packed(colors.text), text.c_str());
  if (unit_width > 0)
    list.AddText({right - unit_width + 5 * app.scale, y}, packed(colors.dim), control.unit.c_str());
}

void parameter(App& app, const ParameterControl& control) {
  const UiColors& colors = colors_of(app);
  const float s = app.scale, reset_width = ImGui::GetFrameHeight() + 2 * s;
  double value = get_parameter(app.mechanism, control.address);
  ImGui::PushID(control.address.c_str());

  const float start = ImGui::GetCursorPosX(), room = ImGui::GetContentRegionAvail().x;
  const float value_width = std::min(room * 0.5f, 150 * s);
  const float label_width = room - value_width - reset_width - 6 * s;
  ImGui::AlignTextToFramePadding();
  clipped_text(control.name, label_width);
  const float used = ImGui::GetItemRectSize().x;
  if (control.what != "speed" && control.what != "stiffness" && used + 40 * s < label_width) {
    ImGui::SameLine(0, 6 * s);
    ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
    clipped_text(control.what, label_width - used - 6 * s);
    ImGui::PopStyleColor();
  }
  if (value != control.file_value) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(start + room - value_width - reset_width);
    if (icon_button(app, "parameters/" + control.address + "/reset", icon::undo,
                    ("Back to the file's " + short_text(control.file_value) + " " + control.unit).c_str()))
      change_parameter(app, control.address, control.file_value);
  }
  ImGui::SameLine();
  ImGui::SetCursorPosX(start + room - value_width);
  value_field(app, control, value, value_width);
  bool type_value = false;
  if (slider(app, "parameters/" + control.address, control, value, type_value))
    change_parameter(app, control.address, value);
  if (type_value) start_typing(app, control, value);
  ImGui::PopID();
}

void group(App& app, ParameterGroup which, const char* name, const char* title, bool& open) {
  bool begun = false;
  for (const ParameterControl& control : app.parameters) {
    if (control.group != which) continue;
    if (!begun && !section(app, name, title, open)) return;
    begun = true;
    parameter(app, control);
  }
  if (begun) ImGui::Dummy({0, 4 * app.scale});
}

} // namespace

void parameters_panel(App& app, const PanelRect& rect) {
  begin_panel("parameters", rect);
  if (app.open) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * app.scale, 3 * app.scale});
    group(app, ParameterGroup::drives, "parameters/drives", "Drive speeds", app.panels.drives);
    group(app, ParameterGroup::springs, "parameters/springs", "Spring constants", app.panels.springs);
    group(app, ParameterGroup::others, "parameters/others", "Other", app.panels.others);
    ImGui::PopStyleVar();
    if (text_button(app, "parameters/restart", "Restart from drawn pose")) solve_from_drawn_pose(app);
    help_on_hover("Sliders start from the last answer; this starts from the pose in the file, which may lead "
                  "elsewhere.");
    if (app.mechanism != app.original) {
      ImGui::SameLine();
      if (text_button(app, "parameters/reset", "Reset all")) reset_parameters(app);
    }
    app.panels.parameters_height = (ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y) / app.scale;
  } else {
    paragraph("No scene is open.", colors_of(app).dim);
    if (text_button(app, "parameters/open", "Open a scene…", true)) show_open_dialog(app);
  }
  ImGui::End();
}

} // namespace flyball
