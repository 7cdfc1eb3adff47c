#include "app/ui/widgets/widgets.hpp"

#include "app/session/units.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/tooltip.hpp"
#include "engine/mechanism/unit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace flyball {

namespace {

// Text in a font, whatever is current.
void text_in(ImFont* font, const ImVec4& color, const std::string& text) {
  ImGui::PushFont(font);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void show_help(const char* help, bool above) {
  const bool keyed = keyed_item();
  if (!help || !*help || !(keyed || ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ||
      !pointed_long())
    return;
  if (keyed) // below it, wherever the mouse is
    ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y + 6});
  if (above)
    ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, ImGui::GetItemRectMin().y - 6}, ImGuiCond_Always,
                            {0, 1});
  else
    place_beside_window();
  ImGui::BeginTooltip();
  const float width = ImGui::GetFontSize() * 22;
  ImGui::PushTextWrapPos(width);
  ImGui::TextUnformatted(in_lines(help, width - ImGui::GetCursorPosX()).c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

} // namespace

void help_on_hover(const char* help) {
  show_help(help, false);
}

void help_above(const char* help) {
  show_help(help, true);
}

bool icon_button(Ui& ui, const std::string& name, const char* icon, const char* help, bool on) {
  const UiColors& colors = colors_of(ui);
  const float side = ImGui::GetFrameHeight() + 2 * ui.scale;
  ImGui::PushStyleColor(ImGuiCol_Text, on ? colors.accent : colors.text);
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, colors.raised);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
  ImGui::PushID(name.c_str());
  const bool pressed = ImGui::Button(icon, {side, side});
  ImGui::PopID();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(on ? 2 : 1);
  note_widget(ui.widgets, name);
  help_on_hover(help);
  return pressed;
}

bool text_button(Ui& ui, const std::string& name, const char* text, bool primary) {
  const UiColors& colors = colors_of(ui);
  ImGui::PushStyleColor(ImGuiCol_Button, primary ? colors.accent : colors.raised);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, primary ? colors.accent : colors.pointed);
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, primary ? colors.accent : colors.pressed);
  ImGui::PushStyleColor(ImGuiCol_Text, primary ? colors.on_accent : colors.text);
  ImGui::PushID(name.c_str());
  const bool pressed = ImGui::Button(text);
  ImGui::PopID();
  ImGui::PopStyleColor(4);
  note_widget(ui.widgets, name);
  return pressed;
}

bool option_button(Ui& ui, const std::string& name, const char* text, bool on, const char* help, float width,
                   KeyUse use) {
  const UiColors& colors = colors_of(ui);
  ImGui::PushStyleColor(ImGuiCol_Text, on ? colors.on_accent : colors.text);
  ImGui::PushStyleColor(ImGuiCol_Button, on ? colors.accent : colors.raised);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, on ? colors.accent : colors.border);
  ImGui::PushID(name.c_str());
  const bool pressed = ImGui::Button(text, {width, 0});
  ImGui::PopID();
  ImGui::PopStyleColor(3);
  note_widget(ui.widgets, name, use);
  help_on_hover(help);
  return pressed;
}

void heading(Ui& ui, const char* text) {
  ImGui::Dummy({0, 2 * ui.scale});
  text_in(ui.fonts.strong, colors_of(ui).text, text);
}

bool section(Ui& ui, const std::string& name, const char* text, bool& open) {
  const UiColors& colors = colors_of(ui);
  const float height = ImGui::GetTextLineHeight() + 6 * ui.scale;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 1.f);
  if (ImGui::InvisibleButton(name.c_str(), {width, height})) open = !open;
  note_widget(ui.widgets, name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered())
    list.AddRectFilled({from.x - 4 * ui.scale, from.y}, {from.x + width, from.y + height},
                       packed(colors.raised), ImGui::GetStyle().FrameRounding);
  const float r = 3.5f * ui.scale, cx = from.x + r, cy = from.y + height / 2;
  if (open)
    list.AddTriangleFilled({cx - r, cy - r / 2}, {cx + r, cy - r / 2}, {cx, cy + r / 1.5f},
                           packed(colors.dim));
  else
    list.AddTriangleFilled({cx - r / 2, cy - r}, {cx + r / 1.5f, cy}, {cx - r / 2, cy + r},
                           packed(colors.dim));
  list.AddText(ui.fonts.strong, ImGui::GetFontSize(), {from.x + 14 * ui.scale, from.y + 3 * ui.scale},
               packed(colors.text), text);
  return open;
}

float digits_drop(const Ui& ui) {
  return std::round(ui.fonts.text->Ascent - ui.fonts.digits->Ascent);
}

void right_digits(Ui& ui, const std::string& text, const ImVec4& color) {
  ImFont* font = ui.fonts.digits;
  const float width = font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.f, ImGui::GetContentRegionAvail().x - width));
  text_in(font, color, text);
}

void row(const Ui& ui, const std::string& label, const std::string& value, const char* unit, const char* help,
         float margin) {
  const UiColors& colors = colors_of(ui);
  ImGui::BeginGroup();
  const float room = ImGui::GetContentRegionAvail().x - margin;
  const float start = ImGui::GetCursorPosX();
  const float unit_width = unit && *unit ? ImGui::CalcTextSize(unit).x + 5 * ui.scale : 0;
  const ImFont* digits = ui.fonts.digits;
  const float value_width = digits->CalcTextSizeA(digits->FontSize, 1e9f, 0, value.c_str()).x;
  ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
  clipped_text(label, room - unit_width - value_width - 8 * ui.scale);
  ImGui::PopStyleColor();
  ImGui::SameLine();
  const ImVec2 at(start + std::max(0.f, room - unit_width - value_width), ImGui::GetCursorPosY());
  ImGui::SetCursorPos({at.x, at.y + digits_drop(ui)});
  text_in(ui.fonts.digits, colors.text, value);
  if (unit_width > 0) {
    ImGui::SameLine();
    ImGui::SetCursorPos({at.x + value_width + 5 * ui.scale, at.y});
    text_in(ui.fonts.text, colors.dim, unit);
  }
  ImGui::EndGroup();
  offer_copy(unit && *unit ? value + " " + unit : value);
  help_on_hover(help);
}

void offer_copy(const std::string& text) {
  if (text.empty()) return;
  ImGui::PushID(static_cast<int>(ImGui::GetItemRectMin().y)); // one below the other
  if (ImGui::BeginPopupContextItem("copy")) {
    const std::string words = text.find('\t') == std::string::npos ? "Copy " + text : "Copy";
    if (ImGui::MenuItem(words.c_str())) ImGui::SetClipboardText(text.c_str());
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

std::string name_list(const std::vector<std::string>& names) {
  constexpr std::size_t most = 100;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most; ++i)
    text += (i ? ", " : "") + names[i];
  return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

namespace {

// Where the word at a place ends; a number's goes on over its unit, which nobody looks for on the next line.
std::size_t word_end(std::string_view text, std::size_t at) {
  std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
  const std::string_view number = text.substr(at, end - at);
  if (number.empty() || number.find_first_of("0123456789") == std::string_view::npos ||
      number.find_first_not_of("0123456789.,+-e") != std::string_view::npos)
    return end;
  while (end < text.size() && text[end] == ' ') {
    const std::size_t next = std::min(text.find_first_of(" \n", end + 1), text.size());
    std::string_view unit = text.substr(end + 1, next - end - 1);
    unit = unit.substr(0, unit.find_last_not_of(".,;:") + 1);
    if (unit.empty() || !parse_unit(unit)) break;
    end = next;
  }
  return end;
}

} // namespace

std::string in_lines(std::string_view text, float width) {
  const ImFont* font = ImGui::GetFont();
  const auto width_of = [&](std::string_view part) {
    return font->CalcTextSizeA(ImGui::GetFontSize(), 1e9f, 0, part.data(), part.data() + part.size()).x;
  };
  std::string lines;
  float used = 0; // of the last line
  std::size_t at = 0;
  while (at < text.size()) {
    std::size_t end = word_end(text, at);
    if (width_of(text.substr(at, end - at)) > width)
      end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string_view word = text.substr(at, end - at), gap = at > 0 ? text.substr(at - 1, 1) : "";
    const float wide = width_of(word), room = gap == " " ? width_of(gap) : 0;
    const bool below = gap == "\n" || (used > 0 && used + room + wide > width);
    if (at > 0) lines += below ? '\n' : ' ';
    lines += word;
    used = below ? wide : used + room + wide;
    at = end + 1;
  }
  return lines;
}

void paragraph(const std::string& text, const ImVec4& color) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

std::string cut_to(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string cut = text;
  while (!cut.empty() && ImGui::CalcTextSize((cut + "…").c_str()).x > width) {
    // Whole characters: bytes of the form 10xxxxxx continue one.
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0) == 0x80)
      cut.pop_back();
    if (!cut.empty()) cut.pop_back();
  }
  return cut + "…";
}

void clipped_text(const std::string& text, float width) {
  const std::string cut = cut_to(text, width);
  ImGui::TextUnformatted(cut.c_str());
  if (cut != text) help_on_hover(text.c_str());
}

namespace {

constexpr float slack = 3; // points that the hand may move in a click

// What the button on a slider does in this frame; `knob` and `left` are pixels of the window. Returns the
// place on the track that the knob is to go to.
std::optional<double> slider_place_wanted(Ui& ui, const std::string& name, double now, float left, float span,
                                          float radius, bool& type_value) {
  const ImGuiIO& io = ImGui::GetIO();
  SliderPress& press = ui.slider_press;
  const float at = io.MousePos.x, knob = left + span * static_cast<float>(now);
  if (ImGui::IsItemActivated()) {
    type_value = io.KeyCtrl || (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && press.name == name);
    press = {.name = name,
             .from = at,
             .grip = at - knob,
             .on_knob = std::abs(at - knob) <= radius,
             .typing = type_value};
  }
  if (press.name != name || press.typing) return std::nullopt;
  if (ImGui::IsItemActive()) {
    if (!press.on_knob) press.grip = 0;
    press.dragging = press.dragging || std::abs(at - press.from) > slack * ui.scale;
    if (!press.dragging || io.MouseDelta.x == 0) return std::nullopt;
    // With Shift the knob follows at a tenth of the hand's speed.
    if (io.KeyShift) return now + static_cast<double>(io.MouseDelta.x / span) / 10;
    return static_cast<double>((at - press.grip - left) / span);
  }
  if (ImGui::IsItemDeactivated()) {
    if (!press.dragging && !press.on_knob) {
      press.place = static_cast<double>((press.from - left) / span);
      press.since = ImGui::GetTime();
    }
    press.dragging = false;
  }
  if (!press.place || ImGui::GetTime() - *press.since < static_cast<double>(io.MouseDoubleClickTime))
    return std::nullopt;
  return std::exchange(press.place, std::nullopt);
}

// A key moves by the slider's step, on a logarithmic one by a hundredth of its length.
double nudged_value(const ParameterControl& control, double value, const KeyNudge& nudge) {
  if (nudge.end != 0) return nudge.end < 0 ? control.from : control.to;
  const double span = control.to - control.from;
  const double share = control.log || control.step <= 0 || span == 0 ? 0.01 : control.step / std::abs(span);
  const double place = slider_place(control, value) + nudge.x * nudge.size * share;
  return slider_value(control, place, nudge.size < 1);
}

// In the unit it is shown in, where the hand's steps are to be round.
ParameterControl shown_control(ParameterControl control, const ShownUnit& unit) {
  if (unit.factor == 1) return control;
  for (double* number : {&control.value, &control.file_value, &control.from, &control.to})
    *number = unit.shown(*number);
  const double span = std::abs(control.to - control.from);
  if (control.step > 0 && span > 0) control.step = slider_step(span);
  return control;
}

} // namespace

bool slider(const Session& session, Ui& ui, const std::string& name, const ParameterControl& si_control,
            double& si_value, bool& type_value) {
  const ShownUnit unit = shown_unit(si_control.unit, session.units);
  const ParameterControl control = shown_control(si_control, unit);
  double value = unit.shown(si_value);
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, height = 18 * s, radius = 6.5f * s;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 4 * radius);
  ImGui::InvisibleButton(name.c_str(), {width, height});
  note_widget(ui.widgets, name, KeyUse::slide);
  note_number(ui, name, si_control.address);
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered() || has_keyboard(ui, name);
  const float left = from.x + radius, span = width - 2 * radius, middle = from.y + height / 2;

  bool moved = false;
  if (const auto place =
          slider_place_wanted(ui, name, slider_place(control, value), left, span, radius, type_value)) {
    const double next = slider_value(control, *place, ImGui::GetIO().KeyShift);
    moved = next != value;
    value = next;
    if (moved) si_value = unit.si(next);
  }
  if (const KeyNudge* nudge = nudge_of(ui, name)) {
    const double next = nudged_value(control, value, *nudge);
    moved = moved || next != value;
    value = next;
    if (moved) si_value = unit.si(next);
  }

  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = 1.5f * s;
  const float knob = left + span * static_cast<float>(slider_place(control, value));
  // Filled from zero where the range holds it, else from the lower end.
  const float zero = left + span * static_cast<float>(control.log ? 0 : slider_place(control, 0));
  list.AddRectFilled({left - line, middle - line}, {left + span + line, middle + line}, packed(colors.faint),
                     line);
  list.AddRectFilled({std::min(zero, knob), middle - line}, {std::max(zero, knob), middle + line},
                     packed(colors.accent), line);
  const float mark = std::round(left + span * static_cast<float>(slider_place(control, control.file_value)));
  list.AddLine({mark, middle + 4 * s}, {mark, middle + 8 * s}, packed(colors.dim), std::max(1.f, s));
  list.AddCircleFilled({knob, middle}, radius, packed(colors.accent), 32);
  if (!active)
    list.AddCircleFilled({knob, middle}, radius - 2 * s, packed(hovered ? colors.raised : colors.panel), 32);
  return moved;
}

} // namespace flyball
