// The few kinds of widget that the panels are made of. Names are for the widget map and unique in the window.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/ui_style.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball {

inline const UiColors& colors_of(const Ui& ui) {
  return ui_colors(ui.theme);
}
inline ImU32 packed(const ImVec4& color) {
  return ImGui::ColorConvertFloat4ToU32(color);
}

// A button of one icon; `on` shows it pressed in.
bool icon_button(Ui& ui, const std::string& name, const char* icon, const char* help, bool on = false);
// A button of words; `primary` is the one that Enter means.
bool text_button(Ui& ui, const std::string& name, const char* text, bool primary = false);
// A word of several, of which one is lit; 0: as wide as the word needs.
bool option_button(Ui& ui, const std::string& name, const char* text, bool on, const char* help,
                   float width = 0, KeyUse use = KeyUse::press);

// What a panel's part is called.
void heading(Ui& ui, const char* text);
// The same, that opens and closes; returns whether it is open.
bool section(Ui& ui, const std::string& name, const char* text, bool& open);

// Digits from here to the right edge, ending there.
void right_digits(Ui& ui, const std::string& text, const ImVec4& color);
// How much lower digits must begin than words to stand on the same line (pixels).
float digits_drop(const Ui& ui);
// "label            value unit": the value in digits, ending `margin` pixels from the right. Help appears
// over the row, a right click copies value and unit.
void row(const Ui& ui, const std::string& label, const std::string& value, const char* unit,
         const char* help = nullptr, float margin = 0);
// A right click on the last item offers to copy the text, in which tabs part columns.
void offer_copy(const std::string& text);
// Draws those of so many rows of one height that are in sight.
template <class Draw>
void visible_rows(std::size_t count, const Draw& draw) {
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(count));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw(static_cast<std::size_t>(i));
}
// "a, b, c": the first of the names, and how many more there are.
std::string name_list(const std::vector<std::string>& names);
// Words broken between lines of this width (pixels) at blanks only: Dear ImGui breaks a number after its
// point, too.
std::string in_lines(std::string_view text, float width);
// Words that may take several lines.
void paragraph(const std::string& text, const ImVec4& color);
// Text cut to the width (pixels) with "…" where it is longer.
std::string cut_to(const std::string& text, float width);
// Text cut to the width with "..." where it is longer; the whole of it appears over it.
void clipped_text(const std::string& text, float width);

// A slim slider over the control's range; returns whether the value was moved. A double click, or one with
// Ctrl, asks for typing and moves nothing.
bool slider(const Session& session, Ui& ui, const std::string& name, const ParameterControl& control,
            double& value, bool& type_value);

void help_on_hover(const char* help);
// The same above the item, where what lies below it is reached for next.
void help_above(const char* help);

} // namespace flyball
