// Pictures of the tools, drawn rather than taken from a font.
#pragma once

#include "app/ui/tool_state.hpp"

#include <imgui.h>

namespace flyball {

// Within a square of half the size `half` (pixels) around the centre.
void draw_tool_glyph(ImDrawList& list, Tool tool, ImVec2 center, float half, ImU32 ink);
void draw_magnet_glyph(ImDrawList& list, ImVec2 center, float half, ImU32 ink);

} // namespace flyball
