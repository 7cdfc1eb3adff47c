// Words and signs stand out from what is behind them: WCAG's contrast, (L1 + 0.05) / (L2 + 0.05).
#include "app/plot/colors.hpp"
#include "app/ui/widgets/ui_style.hpp"
#include "app/viewport/load_arrows.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;

namespace {

double linear(double part) {
  return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
}
double luminance(const ImVec4& c) {
  return 0.2126 * linear(static_cast<double>(c.x)) + 0.7152 * linear(static_cast<double>(c.y)) +
         0.0722 * linear(static_cast<double>(c.z));
}
double contrast(const ImVec4& a, const ImVec4& b) {
  const double first = luminance(a), second = luminance(b);
  return (std::max(first, second) + 0.05) / (std::min(first, second) + 0.05);
}
ImVec4 of(std::uint32_t hex) {
  return to_imgui(rgb(hex));
}
// As it is seen on what is behind it.
ImVec4 over(const Color& color, const Color& ground) {
  return to_imgui(mix({ground.r, ground.g, ground.b, 1}, {color.r, color.g, color.b, 1}, color.a));
}

} // namespace

TEST_CASE("words have a contrast of 4.5 in every theme, of 7 in the high-contrast one") {
  CHECK(contrast(of(0x000000), of(0xFFFFFF)) == Approx(21));
  for (const Theme theme : {Theme::light, Theme::dark, Theme::high_contrast}) {
    const double least = theme == Theme::high_contrast ? 7 : 4.5;
    const UiColors& c = ui_colors(theme);
    INFO("theme " << static_cast<int>(theme));
    for (const ImVec4* words : {&c.text, &c.dim, &c.good, &c.warn, &c.bad})
      CHECK(contrast(*words, c.panel) >= least);
    for (const ImVec4* ground : {&c.raised, &c.pointed, &c.pressed})
      CHECK(contrast(c.text, *ground) >= least);
    CHECK(contrast(c.dim, c.raised) >= least);
    CHECK(contrast(c.on_accent, c.accent) >= least);
    CHECK(contrast(c.accent, c.panel) >= least);
    const PlotColors& plot = plot_colors(plot_ground(theme));
    for (const std::uint32_t ground : {plot.page, plot.area}) {
      CHECK(contrast(of(plot.text), of(ground)) >= least);
      CHECK(contrast(of(plot.dim), of(ground)) >= least);
    }
    // Names are written over the view.
    const Palette& view = palette(theme);
    for (const Color& ground : {view.background_top, view.background_bottom})
      CHECK(contrast(c.text, to_imgui(ground)) >= least);
  }
}

TEST_CASE("words on a bar are read in every theme, however full it is") {
  ImGuiContext* const former = ImGui::GetCurrentContext();
  ImGuiContext* const context = ImGui::CreateContext();
  ImGui::SetCurrentContext(context);
  for (const Theme theme : {Theme::light, Theme::dark, Theme::high_contrast}) {
    apply_style(theme, 1);
    const ImVec4* const colors = ImGui::GetStyle().Colors;
    const auto color = [](const ImVec4& c) { return Color{c.x, c.y, c.z, c.w}; };
    const ImVec4 full = over(color(colors[ImGuiCol_PlotHistogram]), color(colors[ImGuiCol_FrameBg]));
    const double least = theme == Theme::high_contrast ? 7 : 4.5;
    CHECK(contrast(colors[ImGuiCol_Text], full) >= least);
    CHECK(contrast(full, colors[ImGuiCol_FrameBg]) >= 1.15); // and tells how full it is
  }
  ImGui::DestroyContext(context);
  ImGui::SetCurrentContext(former);
}

TEST_CASE("the ring of the keyboard's focus has a contrast of 3 in every theme") {
  for (const Theme theme : {Theme::light, Theme::dark, Theme::high_contrast}) {
    const UiColors& c = ui_colors(theme);
    for (const ImVec4* ground : {&c.panel, &c.raised})
      CHECK(contrast(c.focus, *ground) >= 3);
    for (const Color& ground : {palette(theme).background_top, palette(theme).background_bottom})
      CHECK(contrast(c.focus, to_imgui(ground)) >= 3);
  }
}

TEST_CASE("with high contrast signs and lines have a contrast of 3") {
  const UiColors& c = ui_colors(Theme::high_contrast);
  for (const ImVec4* sign : {&c.border, &c.faint, &c.accent})
    CHECK(contrast(*sign, c.panel) >= 3);
  const Palette& view = palette(Theme::high_contrast);
  const Color& ground = view.background_top;
  CHECK(view.background_bottom == ground);
  for (const Color* sign : {&view.accent, &view.metal, &view.metal_dark, &view.drawn, &view.motion,
                            &view.tension, &view.compression, &view.slack, &view.cut, &view.force,
                            &view.axis_x, &view.axis_y, &view.axis_z, &view.grid})
    CHECK(contrast(over(*sign, ground), to_imgui(ground)) >= 3);
  for (const Color& body : view.bodies)
    CHECK(contrast(to_imgui(body), to_imgui(ground)) >= 3);
  const PlotColors& plot = plot_colors(PlotGround::high_contrast);
  for (const std::uint32_t line : {plot.frame, plot.faint, plot.grid})
    CHECK(contrast(of(line), of(plot.area)) >= 3);
  for (int curve = 0; curve < 7; ++curve)
    CHECK(contrast(of(curve_color(curve, PlotGround::high_contrast)), of(plot.area)) >= 3);
  for (int band = 0; band < 7; ++band) {
    Color fill = rgb(curve_color(band, PlotGround::high_contrast));
    fill.a = static_cast<float>(band_fill(PlotGround::high_contrast));
    CHECK(contrast(over(fill, rgb(plot.area)), of(plot.area)) >= 2);
  }
}

TEST_CASE("with high contrast arrows of loads have a contrast of 3 on their side without light, too") {
  constexpr double unlit = 0.4; // of the light on the other side
  for (std::size_t kind = 0; kind < load_kinds; ++kind) {
    INFO(kind);
    const Color color = load_color(static_cast<LoadKind>(kind), palette(Theme::high_contrast));
    CHECK((unlit * luminance(to_imgui(color)) + 0.05) / 0.05 >= 3);
  }
}
