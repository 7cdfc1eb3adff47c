// Plots drawn with Dear ImGui's draw lists, on the screen and for PNG files alike. No OpenGL.
#pragma once

#include "app/plot/colors.hpp"
#include "app/plot/layout.hpp"
#include "app/render/fonts.hpp"

#include <imgui.h>

namespace flyball {

// The letters of the interface, `scale` pixels a point. Refers to the fonts.
PlotMetrics plot_metrics(const UiFonts& fonts, float scale);

struct PlotPen {
  ImDrawList& list;
  const UiFonts& fonts;
  ImVec2 origin; // of the plot; whole pixels
  float scale = 1;
  PlotGround ground = PlotGround::light;

  ImVec2 at(double x, double y) const {
    return {origin.x + static_cast<float>(x), origin.y + static_cast<float>(y)};
  }
};

ImU32 packed_color(std::uint32_t rgb, float alpha = 1);
void draw_text(const PlotPen& pen, const PlotText& text, ImU32 color);
void draw_shape(const PlotPen& pen, PlotShape shape, double x, double y, double size, ImU32 color,
                std::optional<ImU32> filled_with = std::nullopt);
// A line of any length and sharpness, anti-aliased, with round corners where it turns back.
void draw_line(const PlotPen& pen, const PixelLine& line, PlotLine kind, double width, ImU32 color);

// Everything but the marker. Curves of the legend that are hidden are grey.
void draw_plot(const PlotPen& pen, const Plot& plot, const PlotLook& look, const PlotLayout& layout);
// `lit`: under the pointer or in the hand.
void draw_marker(const PlotPen& pen, const Plot& plot, const PlotLayout& layout, bool lit);

} // namespace flyball
