#include "app/ui/widgets/card.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

void begin_over_view(const char* name, float scale, float rounding, ImVec2 padding,
                     ImGuiWindowFlags more_flags) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, rounding * scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(scale)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize | more_flags);
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

void beside_or_below(const char* words) {
  const float button = ImGui::CalcTextSize(words).x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < button) ImGui::NewLine();
}

} // namespace flyball
