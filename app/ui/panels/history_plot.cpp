#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// Decades on the vertical axis.
struct Decades {
  int low = -16, high = 0;
  float place(double value) const {
    const double decade = std::clamp(std::log10(std::max(value, 1e-300)), double(low), double(high));
    return static_cast<float>((decade - low) / (high - low));
  }
};

Decades decades_of(const std::vector<double>& history, double noise) {
  double largest = noise, smallest = 1e300;
  for (const double value : history) {
    if (!std::isfinite(value)) continue;
    largest = std::max(largest, value);
    smallest = std::min(smallest, std::max(value, noise));
  }
  Decades decades;
  decades.high = static_cast<int>(std::ceil(std::log10(largest)));
  decades.low =
      std::min(static_cast<int>(std::floor(std::log10(std::min(smallest, largest)))), decades.high - 1);
  return decades;
}

} // namespace

void history_plot(const Session& session, Ui& ui, float width, float height) {
  const std::vector<double>& history = session.answer.solution.history;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale;
  ImGui::Dummy({0, 2 * s});
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  note_widget(ui.widgets, "results/history");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImFont* font = ui.fonts.digits;
  const float text = std::round(0.85f * font->FontSize);
  const Decades decades = decades_of(history, session.options.numbers.noise);

  const float left = from.x + 44 * s, right = from.x + width - 6 * s;
  const float top = from.y + 8 * s, bottom = from.y + height - text - 8 * s;
  const auto x = [&](std::size_t i) {
    return left + (right - left) * static_cast<float>(i) / static_cast<float>(history.size() - 1);
  };
  const auto y = [&](double value) { return bottom - (bottom - top) * decades.place(value); };

  const int step = std::max(1, (decades.high - decades.low + 3) / 4);
  for (int decade = decades.high; decade >= decades.low; decade -= step) {
    const float at = std::round(y(std::pow(10.0, decade)));
    list.AddLine({left, at}, {right, at}, packed(colors.border), std::max(1.f, std::round(s)));
    const std::string label = decade == 0 ? "1" : fmt::format("1e{}", decade);
    const float wide = font->CalcTextSizeA(text, 1e9f, 0, label.c_str()).x;
    list.AddText(font, text, {left - wide - 6 * s, at - text / 2}, packed(colors.dim), label.c_str());
  }
  const std::string last = std::to_string(history.size());
  const float wide = font->CalcTextSizeA(text, 1e9f, 0, last.c_str()).x;
  list.AddText(font, text, {left - wide / 2, bottom + 5 * s}, packed(colors.dim), "1");
  list.AddText(font, text, {right - wide, bottom + 5 * s}, packed(colors.dim), last.c_str());
  const char* axis = "residual by evaluation";
  const float axis_size = std::round(0.87f * ImGui::GetFontSize());
  const float axis_width = ui.fonts.text->CalcTextSizeA(axis_size, 1e9f, 0, axis).x;
  list.AddText(ui.fonts.text, axis_size, {(left + right - axis_width) / 2, bottom + 4 * s},
               packed(colors.dim), axis);

  for (std::size_t i = 0; i + 1 < history.size(); ++i)
    list.AddLine({x(i), y(history[i])}, {x(i + 1), y(history[i + 1])}, packed(colors.accent), 1.5f * s);
  if (history.size() <= 60)
    for (std::size_t i = 0; i < history.size(); ++i)
      list.AddCircleFilled({x(i), y(history[i])}, 2.5f * s, packed(colors.accent));
}

} // namespace flyball
