// How the mechanism is looked at, and the pictures that were drawn of it.
#pragma once

#include "app/document/part.hpp"
#include "app/session/navigation.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panels/view_cube.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/viewport/camera.hpp"

#include <optional>
#include <vector>

namespace flyball {

// What the camera was fitted to last, by the window and not by hand.
struct CameraFit {
  ViewCamera camera;
  ViewSize size; // pixels, of the view
};

// The camera before and after it took the arrows of loads into view.
struct LoadsFit {
  ViewCamera before, after;
  std::optional<CameraFit> fitted; // where `before` was one
};

struct ViewState {
  ViewCamera camera;
  ViewSize size;                    // pixels, of the last update
  std::optional<CameraGlide> glide; // while the camera is on its way
  bool animated = false;            // commands make it glide
  ViewCubeState cube;
  std::vector<Part> hidden; // not drawn, nor to be pointed at
  Navigation navigation = Navigation::own;
  bool ghost = true, grid = true, shadow = true;
  bool legend = true;                        // is open
  bool loads = false;                        // arrows of what acts; see load_view.hpp
  std::optional<LoadLengths> load_lengths{}; // that a person has chosen; without: see load_scales()
  bool alone = false;                        // no panels round it, for pictures
  int samples = 4;                           // 1: no anti-aliasing
  bool fit = true;                           // wanted at the next update
  bool fit_loads = false;                    // arrows of loads have come or gone: see fit_loads()
  std::optional<LoadsFit> loads_fit;
  bool keep_direction = false; // fit as the camera stands, rather than start as the scene says
  PartId hovered;
  Vec2 pointed_at = Vec2::Constant(-1); // pixel of the view for which `hovered` was found
  ShownScene scene, scene_beside;       // see shown_scene()
  unsigned texture = 0;                 // OpenGL's, with the picture of the view
  unsigned texture_beside = 0;          // the same of the motion, where it has a view of its own
  float lines_top = 0;                  // pixels of the window: above what is written at the view's foot
  std::optional<CameraFit> fitted;      // holds as long as nobody moves the camera
};

} // namespace flyball
