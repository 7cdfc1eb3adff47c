#include "app/viewport/theme.hpp"

namespace flyball {

namespace {

constexpr std::array<Color, 6> base_hues = {okabe_ito::green,  okabe_ito::sky_blue,   okabe_ito::purple,
                                            okabe_ito::yellow, okabe_ito::vermillion, rgb(0x7B8794)};

// Each hue, then each in a darker shade.
constexpr std::array<Color, 12> graded_hues = [] {
  std::array<Color, 12> all;
  for (std::size_t i = 0; i < base_hues.size(); ++i) {
    all[i] = base_hues[i];
    all[i + base_hues.size()] = mix(base_hues[i], okabe_ito::black, 0.38f);
  }
  return all;
}();

constexpr Palette light = {
    .background_top = rgb(0xFBFCFD),
    .background_bottom = rgb(0xE2E7EC),
    .grid = rgb(0x5B6B7C, 0.34f),
    .accent = okabe_ito::blue,
    .metal = rgb(0xA9B1BA),
    .metal_dark = rgb(0x59626D),
    .drawn = rgb(0x3A434D),
    .motion = rgb(0xE69F00, 0.42f),
    .tension = okabe_ito::vermillion,
    .compression = okabe_ito::blue,
    .slack = rgb(0x8C949D),
    .cut = rgb(0xA8487E),
    .force = rgb(0x30363D),
    .reaction = rgb(0xD11F45),
    .bodies = graded_hues,
    .axis_x = okabe_ito::vermillion,
    .axis_y = okabe_ito::green,
    .axis_z = okabe_ito::blue,
};

constexpr Palette dark = {
    .background_top = rgb(0x23282F),
    .background_bottom = rgb(0x14171B),
    .grid = rgb(0xA9BACB, 0.20f),
    .accent = rgb(0x4DA6E8),
    .metal = rgb(0xAEB6BF),
    .metal_dark = rgb(0x66707B),
    .drawn = rgb(0xC9D2DB),
    .motion = rgb(0xE69F00, 0.40f),
    .tension = rgb(0xE8762B),
    .compression = rgb(0x3E93D6),
    .slack = rgb(0x9AA3AD),
    .cut = rgb(0xE08DBB),
    .force = rgb(0xE6EBF0),
    .reaction = rgb(0xD11F45),
    .bodies = graded_hues,
    .axis_x = rgb(0xE8762B),
    .axis_y = rgb(0x1DB58A),
    .axis_z = rgb(0x4DA6E8),
};

// Each hue, then each in a lighter shade: a darker one would be too near to black.
constexpr std::array<Color, 12> light_graded_hues = [] {
  constexpr std::array<Color, 6> light_hues = {rgb(0x1FD6A0), rgb(0x56B4E9), rgb(0xE58DC0),
                                               rgb(0xF0E442), rgb(0xFF8A3D), rgb(0xB4BEC8)};
  std::array<Color, 12> all;
  for (std::size_t i = 0; i < light_hues.size(); ++i) {
    all[i] = light_hues[i];
    all[i + light_hues.size()] = mix(light_hues[i], rgb(0xFFFFFF), 0.45f);
  }
  return all;
}();

constexpr Palette high_contrast = {
    .background_top = rgb(0x000000),
    .background_bottom = rgb(0x000000),
    .grid = rgb(0xFFFFFF, 0.42f),
    .accent = rgb(0x00E5FF),
    .metal = rgb(0xD6DCE2),
    .metal_dark = rgb(0x9AA3AD),
    .drawn = rgb(0xFFFFFF),
    .motion = rgb(0xFFB000, 0.55f),
    .tension = rgb(0xFF8A3D),
    .compression = rgb(0x5CB8FF),
    .slack = rgb(0xC8C8C8),
    .cut = rgb(0xFF9BD2),
    .force = rgb(0xFFFFFF),
    .reaction = rgb(0xFF5566),
    .bodies = light_graded_hues,
    .axis_x = rgb(0xFF8A3D),
    .axis_y = rgb(0x2EE6A8),
    .axis_z = rgb(0x5CB8FF),
};

} // namespace

const Palette& palette(Theme theme) {
  switch (theme) {
  case Theme::light: return light;
  case Theme::dark: return dark;
  case Theme::high_contrast: break;
  }
  return high_contrast;
}

} // namespace flyball
