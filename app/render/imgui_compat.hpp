// What differs between the Dear ImGui of Debian 12 (1.86) and newer ones, in one place.
#pragma once

#include <imgui.h>

#include <cstdint>

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

} // namespace flyball::imgui_compat
