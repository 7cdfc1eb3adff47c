// What coordinates are called in the window. Files, tables and expressions have names of their own, which
// stay (coordinate_label()).
#pragma once

#include "engine/solve/solution.hpp"

#include <string>

namespace flyball {

// A joint by its name; one that the program made by its body's, "rotor".
std::string joint_words(const std::string& joint);

// "slide"; of a joint with several coordinates "ball, rotation z", "tilt, angle at the child", and of a body
// that no joint holds "rotor, shift x".
std::string coordinate_words(const std::string& joint, int index, int count, bool angle);
template <class Coordinate>
std::string coordinate_words(const Coordinate& c) {
  return coordinate_words(c.joint, c.index, c.count, c.angle);
}
// "speed of spin": of a coordinate in words, as of a drive's number.
std::string speed_words(const std::string& coordinate);
// Of what coordinate_label() gave, "tilt.1", also with ".speed" behind it; as it is where the mechanism has
// no such coordinate.
std::string label_words(const Mechanism& mechanism, const std::string& label);
// Of what found_number() tells: a coordinate or a speed.
std::string found_words(const CoordinateSolution& coordinate);

} // namespace flyball
