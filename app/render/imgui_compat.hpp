// What differs between the Dear ImGui of Debian 12 (1.86) and newer ones, in one place.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <cstdint>
#include <iterator>

namespace flyball::imgui_compat {

// A texture's name carried as ImTextureID: a pointer at first, an integer since 1.91.4.
inline ImTextureID texture_id(unsigned texture) {
#if IMGUI_VERSION_NUM >= 19140
  return static_cast<ImTextureID>(texture);
#else
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
#endif
}

inline unsigned texture_name(ImTextureID id) {
#if IMGUI_VERSION_NUM >= 19140
  return static_cast<unsigned>(id);
#else
  return static_cast<unsigned>(reinterpret_cast<std::uintptr_t>(id));
#endif
}

// Since 1.87 events wait in a queue, so that what is pressed and let go within a frame is seen.
inline constexpr bool queues_events = IMGUI_VERSION_NUM >= 18700;

// All that happened since the last frame is seen in the next one, as 1.86 has it: for who gives events frame
// by frame, in steps that each see what the one before has done.
inline void take_events_at_once() {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().ConfigInputTrickleEventQueue = false;
#endif
}

// Keeps what scrolls from doing so where the wheel turns over the last item.
inline void take_wheel() {
#if IMGUI_VERSION_NUM >= 19000
  ImGui::SetItemKeyOwner(ImGuiKey_MouseWheelY);
#else
  ImGui::SetItemUsingMouseWheel();
#endif
}

#if IMGUI_VERSION_NUM >= 18700
inline constexpr ImGuiKey keypad_enter = ImGuiKey_KeypadEnter;
inline bool key_pressed(ImGuiKey key, bool repeat = true) {
  return ImGui::IsKeyPressed(key, repeat);
}
#else
inline constexpr ImGuiKey keypad_enter = ImGuiKey_KeyPadEnter;
inline bool key_pressed(ImGuiKey key, bool repeat = true) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), repeat);
}
#endif

// Whether nothing can be done with the last item now.
inline bool last_item_disabled() {
  const ImGuiLastItemData& item = ImGui::GetCurrentContext()->LastItemData;
#if IMGUI_VERSION_NUM >= 19140
  return (item.ItemFlags & ImGuiItemFlags_Disabled) != 0;
#else
  return (item.InFlags & ImGuiItemFlags_Disabled) != 0;
#endif
}

// Tab and Ctrl+Tab are the program's own, not Dear ImGui's, which from release to release goes through other
// items with them. Once a frame.
inline void keep_tab() {
#if IMGUI_VERSION_NUM >= 19000
  ImGui::SetKeyOwner(ImGuiKey_Tab, ImHashStr("tab"));
  ImGui::GetCurrentContext()->ConfigNavWindowingKeyNext = 0;
  ImGui::GetCurrentContext()->ConfigNavWindowingKeyPrev = 0;
#elif IMGUI_VERSION_NUM < 18700
  ImGui::GetIO().KeyMap[ImGuiKey_Tab] = -1;
#endif
}

// Presses an item by its ID as the keyboard does, in the next frame; in a field, begins to type. What
// ActivateItem() and its later names do, which leave out by what it was pressed.
inline void press_item(ImGuiID id, bool to_type) {
  ImGuiContext& context = *ImGui::GetCurrentContext();
  context.NavInputSource = ImGuiInputSource_Keyboard;
  context.NavNextActivateId = id;
  context.NavNextActivateFlags = to_type ? ImGuiActivateFlags_PreferInput : ImGuiActivateFlags_None;
}

// Keys as input of one frame, by GLFW's codes.
#if IMGUI_VERSION_NUM >= 18900
inline ImGuiKey key_of(int code) {
  if (code >= 'A' && code <= 'Z') return static_cast<ImGuiKey>(ImGuiKey_A + (code - 'A'));
  if (code >= '0' && code <= '9') return static_cast<ImGuiKey>(ImGuiKey_0 + (code - '0'));
  constexpr int first = 256;
  constexpr ImGuiKey named[] = {ImGuiKey_Escape,    ImGuiKey_Enter,   ImGuiKey_Tab,        ImGuiKey_Backspace,
                                ImGuiKey_Insert,    ImGuiKey_Delete,  ImGuiKey_RightArrow, ImGuiKey_LeftArrow,
                                ImGuiKey_DownArrow, ImGuiKey_UpArrow, ImGuiKey_PageUp,     ImGuiKey_PageDown,
                                ImGuiKey_Home,      ImGuiKey_End};
  const int i = code - first;
  return i >= 0 && i < static_cast<int>(std::size(named)) ? named[i] : ImGuiKey_None;
}
inline void set_key(int code, bool down) {
  if (key_of(code) != ImGuiKey_None) ImGui::GetIO().AddKeyEvent(key_of(code), down);
}
inline bool key_is_down(int code) {
  return key_of(code) != ImGuiKey_None && ImGui::IsKeyDown(key_of(code));
}
inline void map_key(ImGuiKey, int) {}
inline void set_modifiers(bool ctrl, bool shift, bool alt = false) {
  ImGui::GetIO().AddKeyEvent(ImGuiMod_Ctrl, ctrl);
  ImGui::GetIO().AddKeyEvent(ImGuiMod_Shift, shift);
  ImGui::GetIO().AddKeyEvent(ImGuiMod_Alt, alt);
}
#else
inline void set_key(int code, bool down) {
  ImGui::GetIO().KeysDown[code] = down;
}
inline bool key_is_down(int code) {
  return ImGui::GetIO().KeysDown[code];
}
inline void map_key(ImGuiKey key, int code) {
  ImGui::GetIO().KeyMap[key] = code;
}
inline void set_modifiers(bool ctrl, bool shift, bool alt = false) {
  ImGui::GetIO().KeyCtrl = ctrl;
  ImGui::GetIO().KeyShift = shift;
  ImGui::GetIO().KeyAlt = alt;
}
#endif

} // namespace flyball::imgui_compat
