// How far a long computation has come, in words over a bar, and how long it has been at it.
#pragma once

#include "engine/task/progress.hpp"

namespace flyball {

struct Ui;

// As wide as `width` (pixels), or where that is 0 as the room there is. Where nobody knows how much is left
// the bar stays empty and the words tell that it goes on.
void task_bar(Ui& ui, const std::string& name, const Progress& progress, double seconds, float width = 0);

} // namespace flyball
