#include "app/ui/widgets/tooltip.hpp"
#include "app/render/imgui_compat.hpp"

#include <imgui_internal.h>

#include <algorithm>

namespace flyball {

bool pointed_long() {
  auto* state = static_cast<TooltipState*>(ImGui::GetIO().UserData);
  if (!state) return true;
  const ImVec2 item = ImGui::GetItemRectMin();
  const int frame = ImGui::GetFrameCount();
  const bool same = item.x == state->item.x && item.y == state->item.y && frame - state->frame <= 1;
  if (!same) {
    state->item = item;
    state->since = state->clock;
    state->done = false;
  }
  state->frame = frame;
  // Who presses what cannot be pressed wants to know why.
  for (const bool down : ImGui::GetIO().MouseDown)
    state->done = state->done || (down && !imgui_compat::last_item_disabled());
  if (state->done) return false;
  const double left = state->since + TooltipState::patience - state->clock;
  if (left > 0) state->due = std::min(state->due, left);
  return left <= 0;
}

bool keyed_item() {
  const auto* state = static_cast<TooltipState*>(ImGui::GetIO().UserData);
  return state && state->keyed != 0 && state->keyed == ImGui::GetItemID();
}

void place_beside_window() {
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize(), screen = ImGui::GetIO().DisplaySize;
  const float gap = 6;
  if (size.x > 0.5f * screen.x || size.y < 3 * ImGui::GetFrameHeight()) return;
  const bool left = at.x > screen.x - at.x - size.x; // more room there
  const bool low = ImGui::GetItemRectMin().y > 0.6f * screen.y;
  ImGui::SetNextWindowPos(
      {left ? at.x - gap : at.x + size.x + gap, low ? ImGui::GetItemRectMax().y : ImGui::GetItemRectMin().y},
      ImGuiCond_Always, {left ? 1.f : 0.f, low ? 1.f : 0.f});
}

} // namespace flyball
