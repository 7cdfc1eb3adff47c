#include "app/ui/panels/view_drawing.hpp"

#include "app/ui/widgets/ui_style.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/snapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr float ring_margin = 1.5f; // points, in the background's colour

Color background(const Ui& ui) {
  return palette(ui.theme).background_top;
}

} // namespace

void draw_words(const Ui& ui, ImFont* font, ImVec2 at, const ImVec4& color, const std::string& words) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr int sides = 12;
  const float reach = 2 * ui.scale;
  for (int i = 0; i < sides; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / sides;
    list.AddText(font, font->FontSize, {at.x + reach * std::cos(angle), at.y + reach * std::sin(angle)},
                 packed(background(ui), 0.5f), words.c_str());
  }
  list.AddText(font, font->FontSize, at, packed(color), words.c_str());
}

ImU32 packed(const Color& color, float alpha) {
  ImVec4 c = to_imgui(color);
  c.w = std::clamp(c.w * alpha, 0.f, 1.f);
  return ImGui::ColorConvertFloat4ToU32(c);
}

Color axis_color(Theme theme, int axis) {
  const Palette& p = palette(theme);
  return axis == 0 ? p.axis_x : axis == 1 ? p.axis_y : p.axis_z;
}

void draw_line(const Ui& ui, ImVec2 from, ImVec2 to, const Color& color, float width, float alpha) {
  const std::array points{from, to};
  draw_lines(ui, points, color, width, false, alpha);
}

void draw_lines(const Ui& ui, std::span<const ImVec2> points, const Color& color, float width, bool closed,
                float alpha) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const int count = static_cast<int>(points.size());
  const ImDrawFlags flags = closed ? ImDrawFlags_Closed : ImDrawFlags_None;
  list.AddPolyline(points.data(), count, packed(background(ui), 0.7f * alpha), flags,
                   (width + 2 * ring_margin) * ui.scale);
  list.AddPolyline(points.data(), count, packed(color, alpha), flags, width * ui.scale);
}

void draw_dot(const Ui& ui, ImVec2 at, float radius, bool open) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = ui.scale;
  const Color& accent = palette(ui.theme).accent;
  if (open) {
    list.AddCircle(at, radius * s, packed(background(ui), 0.7f), 0, 5 * s);
    list.AddCircle(at, radius * s, packed(accent), 0, 2 * s);
    return;
  }
  list.AddCircleFilled(at, (radius + ring_margin) * s, packed(background(ui), 0.8f));
  list.AddCircleFilled(at, radius * s, packed(accent));
}

void draw_square(const Ui& ui, ImVec2 at, float half, bool lit) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = ui.scale, h = std::round((lit ? half + 1.5f : half) * s);
  const ImVec2 from(std::round(at.x) - h, std::round(at.y) - h),
      to(std::round(at.x) + h, std::round(at.y) + h);
  const UiColors& colors = colors_of(ui);
  list.AddRectFilled(from, to, packed(lit ? colors.accent : colors.panel), 1.5f * s);
  list.AddRect(from, to, packed(colors.accent), 1.5f * s, 0, 1.5f * s);
}

void draw_tag(const Ui& ui, const ViewInput& input, Vec2 beside, const std::string& words,
              const std::string& numbers) {
  if (words.empty() && numbers.empty()) return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, pad = 6 * s, leading = 2 * s;
  const auto size_of = [](const ImFont* font, const std::string& text) {
    return text.empty() ? ImVec2(0, 0) : font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.c_str());
  };
  const ImVec2 upper = size_of(ui.fonts.text, words), lower = size_of(ui.fonts.digits, numbers);
  const float gap = words.empty() || numbers.empty() ? 0 : leading;
  const ImVec2 size(std::max(upper.x, lower.x) + 2 * pad, upper.y + gap + lower.y + pad);
  const ImVec2 at = input.on_screen(beside);
  const PanelRect& rect = input.rect;
  const float gap_x = 18 * s, gap_y = 20 * s;
  ImVec2 from(at.x + gap_x, at.y + gap_y);
  if (from.x + size.x > rect.x + rect.width) from.x = at.x - gap_x - size.x;
  if (from.y + size.y > rect.y + rect.height) from.y = at.y - gap_y - size.y;
  from = {std::round(from.x), std::round(from.y)};
  const ImVec2 to(from.x + size.x, from.y + size.y);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImVec4 panel = colors.panel;
  panel.w = 0.94f;
  list.AddRectFilled(from, to, packed(panel), 4 * s);
  list.AddRect(from, to, packed(colors.border), 4 * s, 0, std::max(1.f, std::round(s)));
  const float y = from.y + pad / 2;
  if (!words.empty())
    list.AddText(ui.fonts.text, ui.fonts.text->FontSize, {from.x + pad, y}, packed(colors.text),
                 words.c_str());
  if (!numbers.empty())
    list.AddText(ui.fonts.digits, ui.fonts.digits->FontSize, {from.x + pad, y + upper.y + gap},
                 packed(words.empty() ? colors.text : colors.dim), numbers.c_str());
}

std::string length_text(double metres, double step, const DisplayUnits& units) {
  const ShownUnit unit = shown_unit("m", units);
  const double length = unit.shown(metres), grid = unit.shown(step);
  if (metres == 0 || !(step > 0) || std::abs(metres - round_to(metres, step)) > 1e-9 * step)
    return short_text(length, 4);
  // On the grid always as many digits, so that the label keeps its width.
  const int places = std::max(0, static_cast<int>(std::ceil(-std::log10(grid) - 1e-9)));
  return fmt::format("{:.{}f}", length, places);
}

std::string place_text(const Vec3& point, double step, const DisplayUnits& units) {
  return "x " + length_text(point.x(), step, units) + "  y " + length_text(point.y(), step, units) + "  z " +
         length_text(point.z(), step, units) + " " + shown_unit("m", units).text;
}

} // namespace flyball
