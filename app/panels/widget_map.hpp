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

// Puts ImGui's last item on the map, if any of it can be seen.
inline void note_widget(WidgetMap& map, const std::string& name) {
  if (ImGui::IsItemVisible()) map[name] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
}

} // namespace flyball
