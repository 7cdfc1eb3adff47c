// The colours of plots, as 0xRRGGBB, on light, dark and black ground. On black all words have a contrast of 7
// or more and all lines of 3.
#pragma once

#include <cstdint>

namespace flyball {

enum class PlotGround { light, dark, high_contrast };

struct PlotColors {
  std::uint32_t page, area;       // around the plot and inside the frame
  std::uint32_t text, dim, faint; // faint: what is switched off
  std::uint32_t grid, minor_grid, frame;
};

const PlotColors& plot_colors(PlotGround ground);
// Okabe and Ito's palette (2008), which every common colour vision can tell apart; see plot_color in
// plot.hpp.
std::uint32_t curve_color(int index, PlotGround ground);
// How much of its colour the ground of a band has, 0 to 1; its edges have more.
constexpr double band_fill(PlotGround ground) {
  return ground == PlotGround::high_contrast ? 0.5 : 0.22;
}
inline constexpr double band_edge = 0.7;
// Viridis: perceptually uniform, from dark blue at 0 to yellow at 1.
std::uint32_t heat_color(double part);

} // namespace flyball
