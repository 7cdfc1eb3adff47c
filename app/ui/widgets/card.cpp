#include "app/ui/widgets/card.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Of every window that lies over the view as a card; panels stay behind all others besides.
constexpr ImGuiWindowFlags card_flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
constexpr ImGuiWindowFlags not_of_cards = ImGuiWindowFlags_NoBringToFrontOnFocus |
                                          ImGuiWindowFlags_ChildWindow | ImGuiWindowFlags_Tooltip |
                                          ImGuiWindowFlags_Popup | ImGuiWindowFlags_Modal;

void begin_over_view(const char* name, float scale, float rounding, ImVec2 padding,
                     ImGuiWindowFlags more_flags) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, rounding * scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(scale)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::Begin(name, nullptr, card_flags | ImGuiWindowFlags_AlwaysAutoResize | more_flags);
  ImGui::PopStyleVar(3);
}

} // namespace

void begin_card(const char* name, float scale, ImVec2 padding, ImGuiWindowFlags more_flags) {
  begin_over_view(name, scale, 6, padding, more_flags);
}

void begin_chip(const char* name, float scale, float rounding, ImVec2 padding) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  begin_over_view(name, scale, rounding, padding,
                  ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoFocusOnAppearing |
                      ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
}

bool points_at_still_card() {
  const ImGuiWindow* window = ImGui::GetCurrentContext()->HoveredWindow;
  return window && (window->Flags & card_flags) == card_flags && (window->Flags & not_of_cards) == 0 &&
         window->ScrollMax.y == 0;
}

void beside_or_below(const char* words) {
  const float button = ImGui::CalcTextSize(words).x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < button) ImGui::NewLine();
}

} // namespace flyball
