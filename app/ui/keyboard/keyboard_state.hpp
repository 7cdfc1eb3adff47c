// Where in the window the keyboard is, for those who work without a mouse; see keyboard.hpp.
#pragma once

#include "app/ui/widgets/widget_map.hpp"
#include "app/viewport/camera.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

// What keys do to the slider, plot or line between panels that has them, in one frame.
struct KeyNudge {
  std::string name; // of the widget; empty: nothing
  int x = 0, y = 0; // steps to the right and upwards
  double size = 1;  // of a step: a tenth with Shift, ten with Ctrl
  int end = 0;      // -1: to the lower end, 1: to the upper
  int zoom = 0;     // 1: in, -1: out
  bool fit = false, enter = false;
};

// Where keys go; see key_focus.hpp.
struct KeyFocus {
  bool in_panel = false;     // the last click was in a panel, or one types there
  bool among_fields = false; // in one of numbers and words, rather than a list of parts
  // Letters are commands all the same, as long as no number is begun: among plots, and once one has been a
  // command in the view.
  bool letters = false;
  bool number_begun = false; // a digit or sign was pressed there outside of any field
};

struct KeyboardState {
  KeyFocus focus;
  std::string at;                                      // the widget that has the keys; empty: the 3-D view
  bool ring = false;                                   // it was a key that went there, and it is shown
  bool by_key = false;                                 // the last that the hand did was to press a key
  int reveal = 0;                                      // frames in which it is still brought into sight
  int missing = 0;                                     // frames in which it has not been drawn
  std::size_t place = 0;                               // among the stops, where it was last drawn
  std::string region;                                  // that it is part of
  std::vector<KeyStop> stops;                          // of the last frame
  std::map<std::string, std::string, std::less<>> was; // where the keyboard was in each region
  // Where it was when each open popup opened, and whether that was shown.
  std::vector<std::pair<std::string, bool>> behind;
  std::string entry; // the widget that has the keys in the dialog that is opening
  KeyNudge nudge;
  std::string nudged;            // the last one: going on with it is one step of the history
  WidgetRect view;               // of the last frame
  std::optional<Vec2> in_view{}; // pixel of the view that the mouse is over
  ImVec2 mouse{};                // where it was
  std::string menu_of;           // the widget whose context menu is asked for
  std::string sought;            // address of the number whose widget is to have the keys
  int sought_frames = 0;         // in which it is still looked for
  std::string section;           // of the inspector, that is being drawn
  std::string open_menu;         // title of the menu to be opened
  int menu = -1;                 // of the bar that is open by keys; -1: none
  // Characters typed before the field they are meant for has the keyboard, and the frames until it has.
  std::vector<ImWchar> ahead;
  int ahead_frames = 0;
  std::string opening; // the field that is to be typed in, until it is: what was typed before may rename it
};

} // namespace flyball
