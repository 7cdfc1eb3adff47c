// Where the last frame's widgets are, by name, so that tests can point at them as a person would.
#pragma once

#include <imgui.h>

#include <map>
#include <string>

namespace flyball {

struct WidgetRect {
  ImVec2 from, to; // pixels of the window
  ImVec2 center() const { return {(from.x + to.x) / 2, (from.y + to.y) / 2}; }
};

// Names are paths: "toolbar/play", "parameters/joints.spin.drive.speed", "results/reactions", "view".
using WidgetMap = std::map<std::string, WidgetRect, std::less<>>;

// Puts what can be seen of ImGui's last item on the map.
inline void note_widget(WidgetMap& map, const std::string& name) {
  if (!ImGui::IsItemVisible()) return;
  const ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from = list.GetClipRectMin(), to = list.GetClipRectMax();
  const ImVec2 item_from = ImGui::GetItemRectMin(), item_to = ImGui::GetItemRectMax();
  map[name] = {{item_from.x > from.x ? item_from.x : from.x, item_from.y > from.y ? item_from.y : from.y},
               {item_to.x < to.x ? item_to.x : to.x, item_to.y < to.y ? item_to.y : to.y}};
}

} // namespace flyball
