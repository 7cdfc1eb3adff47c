#include "app/session/navigation.hpp"

namespace flyball {

namespace {

constexpr int left_button = 0, middle_button = 2;

} // namespace

CameraDrag camera_drag(Navigation navigation, int button, bool ctrl, bool shift) {
  const bool left = button == left_button, middle = button == middle_button;
  switch (navigation) {
  case Navigation::own:
    if (left) return shift ? CameraDrag::pan : CameraDrag::orbit;
    return middle && shift ? CameraDrag::orbit : CameraDrag::pan;
  case Navigation::blender:
    if (!middle) return CameraDrag::none;
    return shift ? CameraDrag::pan : ctrl ? CameraDrag::zoom : CameraDrag::orbit;
  case Navigation::cad:
    if (left) return CameraDrag::none;
    return ctrl ? CameraDrag::pan : shift ? CameraDrag::zoom : CameraDrag::orbit;
  }
  return CameraDrag::none;
}

bool frames_with_left(Navigation navigation) {
  return navigation != Navigation::own;
}

std::array<NavigationLine, 4> navigation_lines(Navigation navigation) {
  switch (navigation) {
  case Navigation::own: break;
  case Navigation::blender:
    return {{{"Middle drag", "Orbit"},
             {"Shift+middle drag", "Pan"},
             {"Wheel, Ctrl+middle drag", "Zoom to the pointer"},
             {"Drag", "Select a box"}}};
  case Navigation::cad:
    return {{{"Right drag, middle drag", "Orbit"},
             {"Ctrl+right, Ctrl+middle drag", "Pan"},
             {"Wheel, Shift+middle drag", "Zoom to the pointer"},
             {"Drag", "Select a box"}}};
  }
  return {{{"Drag", "Orbit"},
           {"Right drag, Shift+drag", "Pan"},
           {"Wheel", "Zoom to the pointer"},
           {"Ctrl+drag", "Select a box"}}};
}

} // namespace flyball
