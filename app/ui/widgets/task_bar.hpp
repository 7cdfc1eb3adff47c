// How far a long computation has come, in words over a bar, and how long it has been at it.
#pragma once

#include "engine/task/progress.hpp"

#include <string>

namespace flyball {

struct Ui;

// A bar filled by `part` (0 to 1) of its width (pixels), the words over it at the left.
void bar_with_words(const Ui& ui, float part, float width, const std::string& words);

// As wide as `width` (pixels), or where that is 0 as the room there is. Where nobody knows how much is left
// the bar stays empty and the words tell that it goes on; else how long it may still take.
void task_bar(Ui& ui, const std::string& name, const Progress& progress, double seconds, float width = 0);

} // namespace flyball
