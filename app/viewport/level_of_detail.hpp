// How finely each solid has to be drawn, by its size in pixels, and which need not be drawn at all. No
// OpenGL.
//
// An outline is at most an eighth of a pixel from where it would be with the finest mesh. What is thinner
// than a pixel is drawn a pixel wide, so that a chain of thousands of links stays a line when it is seen from
// afar; of what is smaller still only every second, fourth, ... body is drawn, as many as there is room for.
// A coil too fine for its turns to be told apart is drawn as a line that takes as much of the picture as its
// wire.
#pragma once

#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"

#include <optional>

namespace flyball {

// From where and how finely instances are seen: by a camera, or along parallel light.
struct Sight {
  Vec3 eye = Vec3::Zero(); // m; of a parallel view any point
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitY(), backward = Vec3::UnitZ();
  // Half of what is in view, m: at a distance of one metre, or at any distance in a parallel view.
  double half_width = 1, half_height = 1;
  double pixel = 0; // m across a pixel, likewise
  bool parallel = false;
  double nearest = 0;     // m, from the eye: what is nearer is not drawn
  double thinnest = 0.5;  // pixels, radius below which rods are drawn wider than they are
  double flat_coil = 2.6; // pixels, radius below which coils are drawn flat

  Quat facing() const; // whose z axis points to the eye
};
Sight sight_of(const ViewCamera& camera, ViewSize view);

struct SeenSolid {
  Primitive primitive = Primitive::sphere; // the instance's, or a simpler one
  int detail = 0;                          // see primitive_mesh()
  double grow = 1;                         // the whole instance has to be larger by this factor
  double round = 0; // m: the instance's radius of edges or ends, at least as it has to be seen
  Quat rotation = Quat::Identity(); // the instance's, of flat ones towards the eye
};
// Nothing where the instance is out of view, or so small that it is left out. `thinned` says whether it is a
// part of a mechanism that may be left out so; `facing` is sight.facing().
std::optional<SeenSolid> see(const Instance& instance, const Sight& sight, const Quat& facing,
                             bool thinned = true);

} // namespace flyball
