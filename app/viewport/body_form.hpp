// How a body looks: the shapes given for it, or else solids derived from what is attached to it.
#pragma once

#include "app/document/body_hues.hpp"
#include "app/viewport/assembly.hpp"

#include <vector>

namespace flyball {

// One colour a body.
std::vector<Color> body_colors(const BodyHues& hues, Theme theme);

// Adds the body's solids to the list, where it stands.
void add_body(const Assembly& assembly, std::size_t body, Color color, std::vector<Instance>& list);

} // namespace flyball
