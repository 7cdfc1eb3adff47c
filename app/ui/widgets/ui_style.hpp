// How the panels look: colours taken from the viewport's palette, sizes in points times a scale.
#pragma once

#include "app/plot/colors.hpp"
#include "app/viewport/theme.hpp"

#include <imgui.h>

namespace flyball {

struct UiColors {
  ImVec4 text, dim, faint; // faint: lines and things that do not apply now
  ImVec4 panel, raised, border;
  ImVec4 pointed, pressed; // ground of what the pointer is at, of what is held
  ImVec4 accent, on_accent;
  ImVec4 focus;           // the ring round what has the keyboard
  ImVec4 good, warn, bad; // as text on `panel`
};

const UiColors& ui_colors(Theme theme);
PlotGround plot_ground(Theme theme);
ImVec4 to_imgui(Color color);

// Sets ImGui's style for the current context.
void apply_style(Theme theme, float scale);

} // namespace flyball
