#include "app/ui/panels/parameters_panel.hpp"

#include "app/render/icons.hpp"
#include "app/session/units.hpp"
#include "app/session/variable_numbers.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/sensitivity_line.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>

namespace flyball {

namespace {

// Edits the pinned slider of this address; where its range makes no sense, nothing happens but a notice.
void change_slider(Session& session, Ui& ui, const std::string& address,
                   const std::function<void(Slider&)>& change) {
  later(ui, [&session, address, change] {
    edit(session, "Range of " + parameter_phrase(address), [&](Mechanism& mechanism, Selection&) {
      for (Slider& slider : mechanism.sliders) {
        if (slider.parameter != address) continue;
        change(slider);
        if (slider.from == slider.to) throw SceneError("", "A slider's ends must differ.");
        if (slider.scale == SliderScale::log && std::min(slider.from, slider.to) <= 0)
          throw SceneError("", "A logarithmic slider's ends must be more than zero.");
      }
    });
  });
}

// From, to, scale and unpinning of a pinned slider; of another, pinning.
void range_menu(Session& session, Ui& ui, const ParameterControl& control) {
  if (!ImGui::BeginPopup("range")) return;
  const std::string name = "parameters/" + control.address + "/range";
  if (control.group == ParameterGroup::pinned) {
    const auto end = [&](const char* label, const char* key, double value, double Slider::*which) {
      const QuantityField field{.name = name + "/" + key,
                                .value = value,
                                .unit = control.unit,
                                .help = "Where the slider ends.",
                                .set = [&session, &ui, address = control.address, which](double typed) {
                                  change_slider(session, ui, address, [=](Slider& s) { s.*which = typed; });
                                }};
      ImGui::AlignTextToFramePadding();
      ImGui::TextUnformatted(label);
      ImGui::SameLine(52 * ui.scale);
      quantity_field(session, ui, field, 150 * ui.scale);
    };
    end("From", "from", control.from, &Slider::from);
    end("To", "to", control.to, &Slider::to);
    bool log = control.log;
    if (ImGui::Checkbox("Logarithmic", &log))
      change_slider(session, ui, control.address, [log](Slider& slider) {
        slider.scale = log ? SliderScale::log : SliderScale::linear;
        // From nothing there is no way up by factors.
        if (log && slider.from == 0) slider.from = slider.to / 1000;
      });
    note_widget(ui.widgets, name + "/log");
    help_on_hover("Equal steps of the hand multiply the number, rather than add to it.");
  }
  const bool pinned = control.group == ParameterGroup::pinned;
  if (text_button(ui, name + "/pin", pinned ? "Unpin" : "Pin")) {
    later(ui, [&session, address = control.address, pinned] { pin(session, address, !pinned); });
    ImGui::CloseCurrentPopup();
  }
  help_on_hover(pinned ? "Take it off the pinned sliders."
                       : "Keep it among the pinned sliders, with a range.");
  ImGui::EndPopup();
}

// A small button at the end of the row, shown where it is of use now.
bool small_icon(Ui& ui, const std::string& name, const char* icon, const char* help, bool shown,
                float width) {
  const UiColors& colors = colors_of(ui);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight();
  const bool pressed = ImGui::InvisibleButton(name.c_str(), {width, height});
  note_widget(ui.widgets, name, KeyUse::aside);
  const bool hovered = ImGui::IsItemHovered() || has_keyboard(ui, name);
  if (shown || hovered) {
    const ImVec2 size = ImGui::CalcTextSize(icon);
    ImGui::GetWindowDrawList()->AddText({from.x + (width - size.x) / 2, from.y + (height - size.y) / 2},
                                        packed(hovered ? colors.text : colors.dim), icon);
  }
  help_on_hover(help);
  return pressed;
}

// Whether the number stays where it is while others go where a goal wants them.
void hold_button(Session& session, Ui& ui, const ParameterControl& control, bool pointed, float width) {
  const bool held = is_held(session, control.address);
  if (small_icon(ui, "parameters/" + control.address + "/hold", icon::lock,
                 held
                     ? "Held: it stays while sliders follow a goal. Click to let it go."
                     : "Hold it where it is while sliders follow a goal, which a read-out below or a body in "
                       "the view (Alt+Shift) is dragged to.",
                 pointed || held, width))
    hold_number(session, control.address, !held);
}

// Whether the title of its section says what the number is: not of a torque among speeds, or one of several
// coordinates.
bool told_by_title(const ParameterControl& control) {
  return control.group != ParameterGroup::pinned &&
         (control.what == "speed" || control.what == "stiffness" || control.what == "damping");
}

// What stands behind the name, dim; empty where the section's title says it.
std::string what_shown(const ParameterControl& control) {
  return told_by_title(control) ? std::string() : control.what;
}

// Pixels of the whole label.
float control_label_width(const Ui& ui, const ParameterControl& control) {
  const std::string what = what_shown(control);
  return ImGui::CalcTextSize(control.name.c_str()).x +
         (what.empty() ? 0 : 6 * ui.scale + ImGui::CalcTextSize(what.c_str()).x);
}

// The name and what of it, as far as there is room: where it is short, of the name its beginning.
void control_label(const Ui& ui, const ParameterControl& control, float width) {
  ImGui::AlignTextToFramePadding();
  const float start = ImGui::GetCursorPosX(), least = 40 * ui.scale;
  const std::string what = what_shown(control);
  const float behind = what.empty() ? 0 : 6 * ui.scale + ImGui::CalcTextSize(what.c_str()).x;
  clipped_text(control.name, std::max(width - behind, std::min(width, least)));
  const float used = ImGui::GetItemRectSize().x;
  if (!what.empty() && used + least < width) {
    ImGui::SameLine(0, 6 * ui.scale);
    ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).dim);
    clipped_text(what, width - used - 6 * ui.scale);
    ImGui::PopStyleColor();
  }
  ImGui::SameLine();
  ImGui::SetCursorPosX(start + width);
}

// A pinned slider has a line of what it moves below it.
float row_height(const Ui& ui, ParameterGroup group) {
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  return ImGui::GetFrameHeight() + 18 * ui.scale + 2 * gap +
         (group == ParameterGroup::pinned ? sensitivity_height(ui) + gap : 0);
}

void parameter(Session& session, Ui& ui, ShownRates& rates, const ParameterControl& control) {
  const float s = ui.scale, icon_width = 22 * s;
  const std::string name = "parameters/" + control.address, value_name = name + "/value";
  ImGui::PushID(control.address.c_str());
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float start = ImGui::GetCursorPosX(), room = ImGui::GetContentRegionAvail().x;
  const bool pointed =
      ImGui::IsWindowHovered() &&
      ImGui::IsMouseHoveringRect(from, {from.x + room, from.y + row_height(ui, control.group)});
  const bool pinned = control.group == ParameterGroup::pinned;
  const bool changed = control.value != control.file_value;
  float value_width = std::min((room - icon_width) * 0.5f, 150 * s);
  if (!typing_in(ui, value_name)) { // then the label comes first
    const float buttons = (1.f + (pinned ? 1 : 0) + (changed ? 1 : 0)) * icon_width;
    const float left = room - buttons - control_label_width(ui, control) - 5 * s;
    value_width =
        std::min(value_width, std::max(left, resting_width(session, ui, control.value, control.unit)));
  }
  const float value_at = room - value_width - icon_width;
  const ShownUnit unit = shown_unit(control.unit, session.units);
  const auto set = [&session, address = control.address](double value) {
    change_parameter(session, address, value);
  };

  // Before the value: back to what is stored, and for a pinned number whether it is held.
  const float hold_at = value_at - (pinned ? icon_width : 0), reset_at = hold_at - icon_width;
  const bool holds = pinned && (pointed || is_held(session, control.address));
  control_label(ui, control, (changed ? reset_at : holds ? hold_at : value_at) - 4 * s);
  if (changed) {
    ImGui::SetCursorPosX(start + reset_at);
    const std::string help =
        "Back to the stored " + short_text(unit.shown(control.file_value)) + " " + unit.text;
    if (small_icon(ui, name + "/reset", icon::undo, help.c_str(), true, icon_width))
      later(ui, [set, value = control.file_value] { set(value); });
    ImGui::SameLine();
  }
  if (pinned) {
    ImGui::SetCursorPosX(start + hold_at);
    hold_button(session, ui, control, pointed, icon_width);
    ImGui::SameLine();
  }
  ImGui::SetCursorPosX(start + value_at);
  std::string help = "Click to type a number, with a unit if you like.";
  switch (speed_kind(session.mechanism(), control.address)) {
  case SpeedKind::prescribed: break;
  case SpeedKind::drawn:
    help = "In the drawn pose it makes the momentum that is kept; the steady speed is found. " + help;
    break;
  case SpeedKind::guessed:
    help = "Where the search for the steady speed begins, which the torque determines. " + help;
    break;
  }
  quantity_field(session, ui,
                 {.name = value_name,
                  .value = control.value,
                  .unit = control.unit,
                  .help = help,
                  .address = control.address,
                  .set = set,
                  .framed = false,
                  .slider = true},
                 value_width);
  ImGui::SameLine(0, 0);
  if (small_icon(ui, name + "/gear", icon::gear, "Range of the slider, pin and unpin.", pointed, icon_width))
    ImGui::OpenPopup("range");

  double value = control.value;
  bool type_value = false;
  if (slider(session, ui, name, control, value, type_value)) later(ui, [set, value] { set(value); });
  if (ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right)) ImGui::OpenPopup("range");
  if (takes_menu_key(ui, name) || takes_menu_key(ui, value_name)) ImGui::OpenPopup("range");
  if (type_value)
    later(ui, [&session, &ui, field = value_name,
               text = short_text(unit.shown(control.value), 12) + " " + unit.text] {
      start_typing(session, ui, field, text);
    });
  range_menu(session, ui, control);
  if (control.group == ParameterGroup::pinned) sensitivity_line(session, ui, rates, control);
  ImGui::PopID();
}

bool sliders_moved(const Session& session) {
  return std::ranges::any_of(session.parameters, [](const ParameterControl& control) {
    return control.value != control.file_value;
  });
}

} // namespace

void ParametersPanel::draw_group(Session& session, Ui& ui, ParameterGroup which, const char* name,
                                 const char* title, bool& open) {
  const auto first = std::ranges::lower_bound(session.parameters, which, {}, &ParameterControl::group);
  const auto last = std::ranges::upper_bound(session.parameters, which, {}, &ParameterControl::group);
  if (first == last || !section(ui, name, title, open)) return;
  if (const auto sought = std::find_if(
          first, last, [&](const ParameterControl& each) { return each.address == ui.keyboard.sought; });
      sought != last) {
    const float y = ImGui::GetCursorPosY() + static_cast<float>(sought - first) * row_height(ui, which);
    if (const float top = ImGui::GetScrollY(), room = ImGui::GetWindowHeight();
        y < top || y + row_height(ui, which) > top + room)
      ImGui::SetScrollY(std::max(y - room / 2, 0.f));
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(last - first), row_height(ui, which));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      parameter(session, ui, rates_, first[i]);
  ImGui::Dummy({0, 4 * ui.scale});
}

void ParametersPanel::open_group(ParameterGroup group) {
  switch (group) {
  case ParameterGroup::pinned: pinned_ = true; break;
  case ParameterGroup::named: named_ = true; break;
  case ParameterGroup::drives: drives_ = true; break;
  case ParameterGroup::springs: springs_ = true; break;
  case ParameterGroup::dampers: dampers_ = true; break;
  }
}

float ParametersPanel::draw(Session& session, Ui& ui, const PanelRect& rect) {
  float height = 0;
  begin_panel("parameters", rect);
  if (!session.parameters.empty()) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * ui.scale, 3 * ui.scale});
    draw_group(session, ui, ParameterGroup::pinned, "parameters/pinned", "Pinned", pinned_);
    draw_group(session, ui, ParameterGroup::named, "parameters/named", "Parameters", named_);
    const bool speeds = std::ranges::all_of(session.parameters, [](const ParameterControl& control) {
      return control.group != ParameterGroup::drives || told_by_title(control);
    });
    draw_group(session, ui, ParameterGroup::drives, "parameters/drives", speeds ? "Drive speeds" : "Drives",
               drives_);
    draw_group(session, ui, ParameterGroup::springs, "parameters/springs", "Spring constants", springs_);
    // Dampers move no steady state at prescribed speeds, but whether one that is found hunts hangs on them.
    if (session.motion.on || finds_speeds(session.mechanism()))
      draw_group(session, ui, ParameterGroup::dampers, "parameters/dampers", "Dampers", dampers_);
    ImGui::PopStyleVar();
    if (text_button(ui, "parameters/restart", "Restart from drawn pose")) solve_from_drawn_pose(session);
    help_on_hover("Sliders start from the last answer; this starts from the pose in the file, which may lead "
                  "elsewhere.");
    if (sliders_moved(session)) {
      ImGui::SameLine();
      if (text_button(ui, "parameters/reset", "Reset all")) later(ui, [&session] { drop_explored(session); });
    }
    height = (ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y) / ui.scale;
  } else {
    paragraph("Drive speeds, spring constants and named parameters get a slider here, and every number that "
              "is pinned.",
              colors_of(ui).dim);
  }
  ImGui::End();
  return height;
}

} // namespace flyball
