#include "app/plot/colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

const PlotColors& plot_colors(PlotGround ground) {
  static constexpr PlotColors on_light = {.page = 0xFFFFFF,
                                          .area = 0xFFFFFF,
                                          .text = 0x20262D,
                                          .dim = 0x4E5964,
                                          .faint = 0xB4BDC6,
                                          .grid = 0xDFE4E9,
                                          .minor_grid = 0xF0F3F5,
                                          .frame = 0x8A949E};
  static constexpr PlotColors on_dark = {.page = 0x1C2126,
                                         .area = 0x15191D,
                                         .text = 0xE3E8ED,
                                         .dim = 0xA6B1BC,
                                         .faint = 0x56606B,
                                         .grid = 0x2D343B,
                                         .minor_grid = 0x20262B,
                                         .frame = 0x6B7681};
  static constexpr PlotColors on_black = {.page = 0x000000,
                                          .area = 0x000000,
                                          .text = 0xFFFFFF,
                                          .dim = 0xE4E4E4,
                                          .faint = 0x9A9A9A,
                                          .grid = 0x6A6A6A,
                                          .minor_grid = 0x2E2E2E,
                                          .frame = 0xFFFFFF};
  switch (ground) {
  case PlotGround::light: return on_light;
  case PlotGround::dark: return on_dark;
  case PlotGround::high_contrast: break;
  }
  return on_black;
}

std::uint32_t curve_color(int index, PlotGround ground) {
  static constexpr std::array<std::uint32_t, 7> on_light = {0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7,
                                                            0xE69F00, 0x56B4E9, 0x20262D};
  // Lighter where the originals are dim on a dark ground.
  static constexpr std::array<std::uint32_t, 7> on_dark = {0x3E9FE6, 0xE8762B, 0x1DB58A, 0xE08DBB,
                                                           0xE9AE2B, 0x9AD8FA, 0xE3E8ED};
  const auto count = static_cast<int>(on_light.size());
  const auto i = static_cast<std::size_t>((index % count + count) % count);
  // And all of them as light as letters have to be on black.
  static constexpr std::array<std::uint32_t, 7> on_black = {0x5CB8FF, 0xFF9A52, 0x2EE6A8, 0xFF9BD2,
                                                            0xFFC233, 0xB8E6FF, 0xFFFFFF};
  return ground == PlotGround::light ? on_light[i] : ground == PlotGround::dark ? on_dark[i] : on_black[i];
}

std::uint32_t heat_color(double part) {
  // Polynomials fitted to the table of viridis, one row a power.
  static constexpr double fit[7][3] = {{0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
                                       {0.1050930431085774, 1.404613529898575, 1.384590162594685},
                                       {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
                                       {-4.634230498983486, -5.799100973351585, -19.33244095627987},
                                       {6.228269936347081, 14.17993336680509, 56.69055260068105},
                                       {4.776384997670288, -13.74514537774601, -65.35303263337234},
                                       {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
  const double t = std::clamp(std::isnan(part) ? 0 : part, 0., 1.);
  std::uint32_t color = 0;
  for (int channel = 0; channel < 3; ++channel) {
    double value = 0;
    for (int power = 6; power >= 0; --power)
      value = value * t + fit[power][channel];
    color = color << 8 | static_cast<std::uint32_t>(std::lround(255 * std::clamp(value, 0., 1.)));
  }
  return color;
}

} // namespace flyball
