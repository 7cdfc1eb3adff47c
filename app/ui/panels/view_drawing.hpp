// Lines, dots and labels over the 3-D view, in the current window. Lengths in points.
#pragma once

#include "app/session/units.hpp"
#include "app/ui/panels/view_input.hpp"

#include <imgui.h>

#include <span>
#include <string>

namespace flyball {

// Words over the view, on a halo of its background: to be read over dark parts, too.
void draw_words(const Ui& ui, ImFont* font, ImVec2 at, const ImVec4& color, const std::string& words);

ImU32 packed(const Color& color, float alpha = 1);
Color axis_color(Theme theme, int axis);

// With a margin in the background's colour, so that it is seen before anything.
void draw_line(const Ui& ui, ImVec2 from, ImVec2 to, const Color& color, float width, float alpha = 1);
void draw_lines(const Ui& ui, std::span<const ImVec2> points, const Color& color, float width,
                bool closed = false, float alpha = 1);
// A small disc, or a circle in the accent's colour.
void draw_dot(const Ui& ui, ImVec2 at, float radius, bool open = false);
// A shadowed square: a point that can be dragged.
void draw_square(const Ui& ui, ImVec2 at, float half, bool lit);
// A label beside a pixel of the view, within it: a line of words, a line of numbers; either may be empty.
void draw_tag(const Ui& ui, const ViewInput& input, Vec2 beside, const std::string& words,
              const std::string& numbers);

// "x 0.10  y -0.20  z 0 m", with the digits that a grid of this step (m) calls for; 0: three significant of
// them.
std::string place_text(const Vec3& point, double step, const DisplayUnits& units);
// A multiple of the grid's step (m) with the digits that the step has, anything else with four significant
// ones; without the unit, which is shown_unit("m").
std::string length_text(double metres, double step, const DisplayUnits& units);

} // namespace flyball
