#include "app/ui/widgets/ui_style.hpp"

#include <array>

namespace flyball {

namespace {

ImVec4 hex(std::uint32_t value, float alpha = 1) {
  return to_imgui(rgb(value, alpha));
}

ImVec4 with_alpha(ImVec4 color, float alpha) {
  color.w = alpha;
  return color;
}

UiColors make(Theme theme) {
  const ImVec4 accent = to_imgui(palette(theme).accent);
  if (theme == Theme::light) {
    return {.text = hex(0x20262D),
            .dim = hex(0x5A6570),
            .faint = hex(0xC3CBD3),
            .panel = hex(0xF7F9FA),
            .raised = hex(0xE9EDF1),
            .border = hex(0xD3DAE0),
            .pointed = hex(0xD3DAE0),
            .pressed = hex(0xC3CBD3),
            .accent = accent,
            .on_accent = hex(0xFFFFFF),
            .focus = hex(0x005A9C),
            .good = hex(0x00734F),
            .warn = hex(0x8A5A00),
            .bad = hex(0xB34700)};
  }
  if (theme == Theme::high_contrast) {
    return {.text = hex(0xFFFFFF),
            .dim = hex(0xE4E4E4),
            .faint = hex(0x9A9A9A),
            .panel = hex(0x000000),
            .raised = hex(0x242424),
            .border = hex(0x8C8C8C),
            .pointed = hex(0x3C3C3C),
            .pressed = hex(0x484848),
            .accent = accent,
            .on_accent = hex(0x000000),
            .focus = hex(0xFFEB3B),
            .good = hex(0x5CFFB0),
            .warn = hex(0xFFD75C),
            .bad = hex(0xFFAE85)};
  }
  return {.text = hex(0xE3E8ED),
          .dim = hex(0x9CA8B4),
          .faint = hex(0x4A545F),
          .panel = hex(0x1C2126),
          .raised = hex(0x2A3138),
          .border = hex(0x353E47),
          .pointed = hex(0x353E47),
          .pressed = hex(0x4A545F),
          .accent = accent,
          .on_accent = hex(0x0E1216),
          .focus = hex(0x7CC4FF),
          .good = hex(0x3CC79B),
          .warn = hex(0xE6B450),
          .bad = hex(0xF28C4B)};
}

} // namespace

ImVec4 to_imgui(Color color) {
  return {color.r, color.g, color.b, color.a};
}

const UiColors& ui_colors(Theme theme) {
  static const std::array<UiColors, 3> colors{make(Theme::light), make(Theme::dark),
                                              make(Theme::high_contrast)};
  return colors[static_cast<std::size_t>(theme)];
}

PlotGround plot_ground(Theme theme) {
  switch (theme) {
  case Theme::light: return PlotGround::light;
  case Theme::dark: return PlotGround::dark;
  case Theme::high_contrast: break;
  }
  return PlotGround::high_contrast;
}

void apply_style(Theme theme, float scale) {
  const UiColors& c = ui_colors(theme);
  ImGuiStyle style;
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.IndentSpacing = 14;
  style.ScrollbarSize = 11;
  style.ScrollbarRounding = 6;
  style.GrabMinSize = 12;
  style.FrameRounding = 4;
  style.PopupRounding = 6;
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.ChildBorderSize = 0;
  style.PopupBorderSize = 1;
  style.CellPadding = {4, 2};
  style.ScaleAllSizes(scale);
  style.PopupBorderSize = scale < 1.5f ? 1.f : 2.f;

  ImVec4* colors = style.Colors;
  if (theme == Theme::light)
    ImGui::StyleColorsLight(&style);
  else
    ImGui::StyleColorsDark(&style);
  colors[ImGuiCol_Text] = c.text;
  colors[ImGuiCol_TextDisabled] = c.dim;
  colors[ImGuiCol_WindowBg] = c.panel;
  colors[ImGuiCol_ChildBg] = with_alpha(c.panel, 0);
  colors[ImGuiCol_PopupBg] = c.panel;
  colors[ImGuiCol_MenuBarBg] = c.panel;
  colors[ImGuiCol_Border] = c.border;
  colors[ImGuiCol_Separator] = c.border;
  colors[ImGuiCol_SeparatorHovered] = with_alpha(c.accent, 0.7f);
  colors[ImGuiCol_SeparatorActive] = c.accent;
  colors[ImGuiCol_FrameBg] = c.raised;
  colors[ImGuiCol_FrameBgHovered] = c.pointed;
  colors[ImGuiCol_FrameBgActive] = c.pointed;
  colors[ImGuiCol_Button] = with_alpha(c.raised, 0);
  colors[ImGuiCol_ButtonHovered] = c.raised;
  colors[ImGuiCol_ButtonActive] = c.pointed;
  colors[ImGuiCol_Header] = with_alpha(c.raised, 0);
  colors[ImGuiCol_HeaderHovered] = c.raised;
  colors[ImGuiCol_HeaderActive] = c.pointed;
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = c.raised;
  colors[ImGuiCol_CheckMark] = c.accent;
  colors[ImGuiCol_SliderGrab] = colors[ImGuiCol_SliderGrabActive] = c.accent;
  colors[ImGuiCol_ScrollbarBg] = with_alpha(c.panel, 0);
  colors[ImGuiCol_ScrollbarGrab] = c.faint;
  colors[ImGuiCol_ScrollbarGrabHovered] = colors[ImGuiCol_ScrollbarGrabActive] = c.dim;
  colors[ImGuiCol_TextSelectedBg] = with_alpha(c.accent, 0.35f);
  colors[ImGuiCol_PlotHistogram] = with_alpha(c.accent, 0.3f); // of bars that words are read on
  colors[ImGuiCol_NavHighlight] = c.accent;
  colors[ImGuiCol_ModalWindowDimBg] = theme == Theme::light  ? hex(0x20262D, 0.28f)
                                      : theme == Theme::dark ? hex(0x000000, 0.5f)
                                                             : hex(0x000000, 0.7f);
  ImGui::GetStyle() = style;
}

} // namespace flyball
