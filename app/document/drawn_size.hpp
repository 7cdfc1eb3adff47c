// How large a mechanism is as drawn: what edits and lists measure lengths by.
#pragma once

namespace flyball {

struct Mechanism;

// The diagonal (m) of the box around its bodies and joints; 1 where they are in one place.
double drawn_size(const Mechanism& mechanism);

} // namespace flyball
