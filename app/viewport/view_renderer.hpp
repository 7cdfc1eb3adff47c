// Draws a mechanism: the 3-D view of the window and of pictures alike.
#pragma once

#include "app/render/framebuffer.hpp"
#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct ViewOptions {
  bool grid = true;
  bool shadow = true;
  bool triad = true; // axes (and gravity) in the lower left corner
  bool joints = true, drives = true, forces = true;
  float scale = 1; // pixels a point has: widths of lines that do not scale with the mechanism
};

// All that one picture shows. Spans must live until draw() returns.
struct ViewFrame {
  const Mechanism* mechanism = nullptr; // null: an empty view
  std::span<const Pose> poses;          // solid: the equilibrium; empty: the drawn pose
  std::span<const Pose> ghost;          // grey, translucent: the drawn pose; may be empty
  std::span<const Pose> motion;         // amber, translucent: the damped motion; may be empty
  ViewCamera camera;
  Theme theme = Theme::light;
  ViewOptions options;
  std::vector<PartId> selected;
  PartId hovered;
  std::span<const std::string> cut_joints; // names
};

// What was done, and by omission what was not needed.
struct ViewReport {
  std::vector<std::string_view> passes; // of "background", "shadow", "solid", "outline", "grid", "motion",
                                        // "ghost", "triad", in the order drawn
  int instances = 0;                    // solids drawn, each counted once
  int draw_calls = 0;
};

// Needs a current context for its whole life. Draw only when something changed.
class ViewRenderer {
 public:
  ViewRenderer();
  ~ViewRenderer();
  ViewRenderer(ViewRenderer&&) noexcept;
  ViewRenderer& operator=(ViewRenderer&&) noexcept;

  // Draws into `target` (multisampled or not) and resolves it.
  ViewReport draw(const ViewFrame& frame, Framebuffer& target);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The list draw() draws for the frame, for picking.
SceneList scene_of(const ViewFrame& frame);

} // namespace flyball
