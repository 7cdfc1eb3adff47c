// How the gizmo looks.
#pragma once

#include "app/ui/panels/view_input.hpp"

namespace flyball {

void draw_handles(const App& app, const ViewInput& input, const std::vector<HandleShape>& shapes, Handle lit);
// What is held: how far it has come, along what, and what it snapped to.
void draw_grabbed(const App& app, const ViewInput& input);

} // namespace flyball
