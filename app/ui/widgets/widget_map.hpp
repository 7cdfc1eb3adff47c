// Where the last frame's widgets are, by name, so that tests can point at them as a person would, and what
// of them the keyboard can go to.
#pragma once

#include <imgui.h>

#include <map>
#include <string>
#include <vector>

struct ImGuiWindow;

namespace flyball {

struct WidgetRect {
  ImVec2 from, to; // pixels of the window
  ImVec2 center() const { return {(from.x + to.x) / 2, (from.y + to.y) / 2}; }
};

// What the keyboard makes of a widget.
enum class KeyUse {
  none,  // nothing: another widget does the same for keys
  press, // Enter and Space press it
  aside, // the same, but Tab passes it by and only arrows go there
  row,   // the same; of the rows of a list Tab stops at one
  tab,   // Enter and Space press it; of tabs side by side Tab stops at the chosen one
  type,  // Tab begins to type there
  slide, // arrows move its number, digits type it
  plot,  // arrows move what is read off, plus and minus zoom
};

// A widget that the keyboard can go to, in sight or scrolled out of it.
struct KeyStop {
  std::string name;
  ImGuiID id = 0;
  ImVec2 from, to;               // pixels of the window
  ImGuiWindow* window = nullptr; // of this frame
  KeyUse use = KeyUse::press;
  bool chosen = false; // where a list is entered
  std::string address; // of the mechanism's number that it shows, where it shows one
};

// Whether a click or Enter does all that there is to do with it.
inline bool is_pressed(KeyUse use) {
  return use == KeyUse::press || use == KeyUse::aside || use == KeyUse::tab;
}

// Names are paths: "toolbar/play", "parameters/joints.spin.drive.speed", "results/reactions", "view".
struct WidgetMap : std::map<std::string, WidgetRect, std::less<>> {
  std::vector<KeyStop> stops; // in the order they were drawn
};

// Puts what can be seen of ImGui's last item on the map, and the item among the keyboard's stops if it can
// be used at all.
void note_widget(WidgetMap& map, const std::string& name, KeyUse use = KeyUse::press);
// The latter alone: for an item in a group that is noted under the same name.
void note_stop(WidgetMap& map, const std::string& name, KeyUse use = KeyUse::press);
// What the last stop is besides: where the keyboard enters its list; the number that it shows.
void mark_chosen(WidgetMap& map);
void mark_address(WidgetMap& map, const std::string& address);

} // namespace flyball
