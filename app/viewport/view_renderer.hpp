// Draws a mechanism: the 3-D view of the window and of pictures alike.
#pragma once

#include "app/render/framebuffer.hpp"
#include "app/viewport/view_scene.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace flyball {

// What was done, and by omission what was not needed.
struct ViewReport {
  std::vector<std::string_view> passes; // of "background", "shadow", "solid", "outline", "grid", "loads",
                                        // "others", "motion", "ghost", "drawn", "triad", in the order drawn
  int instances = 0;                    // solids of the scene, each counted once
  int drawn = 0;                        // of them, those in view and not too small to be seen
  int draw_calls = 0;
};

// Needs a current context for its whole life. Draw only when something changed.
class ViewRenderer {
 public:
  ViewRenderer();
  ~ViewRenderer();
  ViewRenderer(ViewRenderer&&) noexcept;
  ViewRenderer& operator=(ViewRenderer&&) noexcept;

  // Draws into `target` (multisampled or not) and resolves it. `scene` is that of the frame; the same one as
  // in the last picture has kept its shadow.
  ViewReport draw(const ViewFrame& frame, const std::shared_ptr<const ViewScene>& scene, Framebuffer& target);
  // The same with a scene made for this picture.
  ViewReport draw(const ViewFrame& frame, Framebuffer& target);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
