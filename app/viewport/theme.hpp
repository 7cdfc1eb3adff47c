// Colours with a meaning, the same in the viewport, the plots and the panels. No OpenGL.
#pragma once

#include <array>
#include <cstdint>

namespace flyball {

// sRGB with alpha, each 0 to 1.
struct Color {
  float r = 0, g = 0, b = 0, a = 1;
  constexpr bool operator==(const Color&) const = default;
};

constexpr Color rgb(std::uint32_t hex, float alpha = 1) {
  return {static_cast<float>((hex >> 16) & 255) / 255.f, static_cast<float>((hex >> 8) & 255) / 255.f,
          static_cast<float>(hex & 255) / 255.f, alpha};
}

constexpr Color mix(Color a, Color b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t, a.a + (b.a - a.a) * t};
}

// Okabe and Ito (2008), distinguishable with every common colour vision.
namespace okabe_ito {
inline constexpr Color black = rgb(0x000000), orange = rgb(0xE69F00), sky_blue = rgb(0x56B4E9),
                       green = rgb(0x009E73), yellow = rgb(0xF0E442), blue = rgb(0x0072B2),
                       vermillion = rgb(0xD55E00), purple = rgb(0xCC79A7);
} // namespace okabe_ito

// high_contrast: on black, with words at a contrast of 7 or more to their ground and signs at 3 (WCAG AAA).
enum class Theme { light, dark, high_contrast };

struct Palette {
  Color background_top, background_bottom;
  Color grid;                        // lines on the floor
  Color accent;                      // drives, selection: the one accent colour
  Color metal;                       // joints
  Color metal_dark;                  // their housings, ground anchors
  Color drawn;                       // the drawn pose's dashed outline
  Color motion;                      // the motion, translucent amber: no body's colour
  Color tension, compression, slack; // springs
  Color cut;                         // mark of a cut joint
  Color force;                       // forces and torques
  Color reaction;                    // no body's colour
  std::array<Color, 12> bodies;      // by number, see body_hues.hpp
  Color axis_x, axis_y, axis_z;
};

const Palette& palette(Theme theme);

} // namespace flyball
