// A scene drawn off-screen, as `render` and a window without a display do it.
#pragma once

#include "app/render/image.hpp"
#include "app/ui/app.hpp"

#include <filesystem>

namespace flyball::cli {

// "1280x720" of an option --size, up to `largest` pixels a side. Throws SceneError.
void read_size(const std::string& text, int largest, int& width, int& height);

struct PictureOptions {
  int width = 1280, height = 720; // pixels
  bool interface = false;         // the window with its panels, else the 3-D view alone
  bool drawn_pose = false;        // instead of the equilibrium
  float scale = 1;                // pixels a point has
  Theme theme = Theme::light;
  bool antialiased = true;
  bool loads = false;                        // arrows of what acts
  std::optional<LoadLengths> load_lengths{}; // of them; without: see load_scales()
  std::string free_body;                     // of this body its free-body diagram; empty: of none
  int mode = 0;            // both ends of its swing beside the equilibrium, counted from 1; 0: none
  double amplitude = 0.15; // of it, as of Analysis::mode_poses()
};

struct Picture {
  Image image;
  std::string drawn_by; // library, renderer and version
  LiveAnswer answer;    // what it shows; where nothing was solved, ticket is 0
};

// Of a mechanism that is at hand; `scene` is its file.
Picture draw_picture(Mechanism mechanism, const std::filesystem::path& scene, const PictureOptions& options);
// Of a file, warnings to standard error. Throws SceneError for a scene that cannot be used; both throw
// GlError where nothing can be drawn.
Picture draw_picture(const std::filesystem::path& scene, const PictureOptions& options);

} // namespace flyball::cli
