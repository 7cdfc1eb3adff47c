// Small pictures of the gallery's scenes: drawn one a frame, so that the gallery opens at once, and kept.
// Needs a current OpenGL context for its whole life.
#pragma once

#include "app/render/framebuffer.hpp"
#include "app/ui/dialogs/gallery_dialog.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"
#include "app/viewport/view_renderer.hpp"

#include <vector>

namespace flyball {

inline constexpr float scene_picture_width = 240, scene_picture_height = 150; // points

class ScenePictures {
 public:
  // Draws the next one that the gallery misses (where the app solves at once: all of them) and tells the
  // cards which pictures are theirs. `wanted`: it is about to open.
  void update(const Session& session, const Ui& ui, const ViewState& view, GalleryDialog& gallery,
              bool wanted, ViewRenderer& renderer);

 private:
  struct Picture {
    Mechanism mechanism;
    Theme theme;
    float scale;
    Framebuffer drawn;
  };
  const Picture* find(const Ui& ui, const SceneCard& card) const;

  std::vector<Picture> pictures_;
};

} // namespace flyball
