#include "app/ui/widgets/widget_map.hpp"

#include "app/render/imgui_compat.hpp"

#include <algorithm>

namespace flyball {

void note_stop(WidgetMap& map, const std::string& name, KeyUse use) {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const ImGuiID id = context.LastItemData.ID;
  if (use == KeyUse::none || id == 0 || imgui_compat::last_item_disabled()) return;
  // A group counts as the item in it that is held.
  if (!map.stops.empty() && (map.stops.back().name == name || map.stops.back().id == id)) return;
  map.stops.push_back({.name = name,
                       .id = id,
                       .from = ImGui::GetItemRectMin(),
                       .to = ImGui::GetItemRectMax(),
                       .window = context.CurrentWindow,
                       .use = use,
                       .chosen = false,
                       .address = {}});
}

void note_widget(WidgetMap& map, const std::string& name, KeyUse use) {
  note_stop(map, name, use);
  if (!ImGui::IsItemVisible()) return;
  const ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from = list.GetClipRectMin(), to = list.GetClipRectMax();
  const ImVec2 item_from = ImGui::GetItemRectMin(), item_to = ImGui::GetItemRectMax();
  map[name] = {{std::max(item_from.x, from.x), std::max(item_from.y, from.y)},
               {std::min(item_to.x, to.x), std::min(item_to.y, to.y)}};
}

void mark_chosen(WidgetMap& map) {
  if (!map.stops.empty()) map.stops.back().chosen = true;
  // A list that opens has it in its middle.
  const ImGuiWindow& window = *ImGui::GetCurrentWindow();
  if (window.Appearing && (window.Flags & ImGuiWindowFlags_Popup) != 0) ImGui::SetScrollHereY();
}

void mark_address(WidgetMap& map, const std::string& address) {
  if (!map.stops.empty()) map.stops.back().address = address;
}

} // namespace flyball
