// Keys of the shortcuts: Dear ImGui 1.86 knows them by the codes of GLFW, which are ASCII here; newer ones
// have names of their own.
#pragma once

#include <imgui.h>

namespace flyball {

// `letter` is 'A' to 'Z', a digit or ' '.
inline bool letter_pressed(char letter) {
#if IMGUI_VERSION_NUM >= 18700
  if (letter == ' ') return ImGui::IsKeyPressed(ImGuiKey_Space, false);
  if (letter <= '9') return ImGui::IsKeyPressed(static_cast<ImGuiKey>(ImGuiKey_0 + (letter - '0')), false);
  return ImGui::IsKeyPressed(static_cast<ImGuiKey>(ImGuiKey_A + (letter - 'A')), false);
#else
  return ImGui::IsKeyPressed(letter, false);
#endif
}

} // namespace flyball
