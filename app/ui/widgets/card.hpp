// Windows that lie over the view as cards, with a thin frame and round corners, each as large as what is in
// it unless SetNextWindowSize() says otherwise. ImGui::End ends them.
#pragma once

#include <imgui.h>

namespace flyball {

// `scale`: pixels of a point.
void begin_card(const char* name, float scale, ImVec2 padding, ImGuiWindowFlags more_flags = 0);

// One that tells something in passing: it takes no keys, and may be as small as one likes.
void begin_chip(const char* name, float scale, float rounding, ImVec2 padding);

// Whether the mouse is over one that has nothing to scroll.
bool points_at_still_card();

// The next button stands beside what was last, or below it where there is no room for its words.
void beside_or_below(const char* words);

} // namespace flyball
