// How the mouse moves the camera: a choice of habits.
#pragma once

#include <array>

namespace flyball {

enum class Navigation {
  own,     // left orbits
  blender, // the middle button
  cad,     // the middle or the right button; of Onshape's and SolidWorks' kind
};

// What dragging with a button does to the camera.
enum class CameraDrag { none, orbit, pan, zoom };
// `button` 0 left, 1 right, 2 middle.
CameraDrag camera_drag(Navigation navigation, int button, bool ctrl, bool shift);

// Whether dragging with the left button frames parts, rather than moving the camera.
bool frames_with_left(Navigation navigation);

// For the sheet of shortcuts.
struct NavigationLine {
  const char* keys;
  const char* does;
};
std::array<NavigationLine, 4> navigation_lines(Navigation navigation); // orbit, pan, zoom, select a box

} // namespace flyball
