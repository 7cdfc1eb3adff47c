// What the hand does over the 3-D view in this frame, in pixels of the view.
#pragma once

#include "app/ui/layout.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"

#include <optional>

namespace flyball {

struct ToolState;

struct ViewInput {
  PanelRect rect; // pixels of the window
  ViewSize size;
  ViewCamera camera; // that the picture was drawn with: what is drawn over it must not run ahead
  double point = 1;  // pixels a point has
  Vec2 cursor = Vec2::Zero();
  bool hovered = false, active = false;   // active: a button went down over the view and is still held
  bool pressed = false, released = false; // the left button, over the view
  bool held = false;                      // it, since it was pressed over the view
  bool moved = false;                     // by more than a click allows, since it was pressed
  bool menu = false;                      // the right button clicked
  bool ctrl = false, shift = false, alt = false;

  Ray ray() const { return camera.ray(cursor, size); }
  bool clicked() const { return released && !moved; }
  double metres_per_pixel() const { return camera.pixel_size(size); } // at the camera's target
  ImVec2 on_screen(const Vec2& pixel) const {
    return {rect.x + static_cast<float>(pixel.x()), rect.y + static_cast<float>(pixel.y())};
  }
  std::optional<ImVec2> on_screen(const Vec3& world) const {
    const auto pixel = camera.project(world, size);
    return pixel ? std::optional(on_screen(*pixel)) : std::nullopt;
  }
};

// Of the last item, which is the view.
ViewInput view_input(const Ui& ui, const ViewState& view, const PanelRect& rect);
// Orbits, pans, zooms and fits; after everything that needs the camera of this frame's picture.
void steer(const ToolState& tool, ViewState& view, const ViewInput& input);

} // namespace flyball
