// How a body looks: the shapes given for it, or else solids derived from what is attached to it.
#pragma once

#include "app/viewport/assembly.hpp"

#include <vector>

namespace flyball {

// One colour a body: bodies whose names differ in a trailing number only ("ball1", "ball2") share a hue.
std::vector<Color> body_colors(const Mechanism& mechanism, Theme theme);

// Solids in the drawn pose; carry() brings them to where the body stands.
std::vector<Instance> body_form(const Assembly& assembly, std::size_t body, Color color);
void carry(const Assembly& assembly, std::size_t body, std::vector<Instance>& solids);

} // namespace flyball
