// Parameter addresses: the path by names to one number of a mechanism, such as
// `joints.spin.drive.speed`, `joints.x.drive.0.speed`, `bodies.ball1.mass`, `gravity.1`, `parameters.L` or
// `points.A.0`. The same address works in --set, --vary, sliders and panels.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct Number; // numbers.hpp

struct ParameterValue {
  std::string address;
  double value = 0;
};

// The number at an address. Throws SceneError naming the part that does not exist and what does.
double get_parameter(const Mechanism& mechanism, std::string_view address);
// The same, to be set again and again: valid as long as its part.
Number addressed_number(Mechanism& mechanism, std::string_view address);
// Changes it, and all that expressions make of it. Does not validate the mechanism as a whole; throws
// SceneError like get_parameter, for a value that is not finite or of which an expression can make nothing,
// and for a number that is itself given by an expression; the mechanism is then as it was.
void set_parameter(Mechanism& mechanism, std::string_view address, double value);
// The same of several numbers at once: expressions are evaluated with all of them.
void set_parameters(Mechanism& mechanism, std::span<const ParameterValue> values);
// Changes this number alone, even one that an expression gives; throws SceneError like get_parameter.
void put_number(Mechanism& mechanism, std::string_view address, double value);
bool has_number(const Mechanism& mechanism, std::string_view address);
// Unit of the number, as shown to a person: "rad/s", "N/m", "kg", "" where it has none.
std::string parameter_unit(const Mechanism& mechanism, std::string_view address);
// What the keys of a part of coordinate i begin with: "drive", of a joint with several coordinates "drive.1".
std::string coordinate_key(const Joint& joint, std::size_t i, std::string_view part);
// Of the speed of its drive, whether or not it has one.
std::string drive_speed_address(const Joint& joint, std::size_t i);
// Every address that can be set, in the scene's order: of numbers that no expression gives.
std::vector<std::string> parameter_addresses(const Mechanism& mechanism);

} // namespace flyball
