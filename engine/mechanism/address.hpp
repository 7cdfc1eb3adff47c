// Parameter addresses: the path by names to one number of a mechanism, such as
// `joints.spin.drive.speed`, `joints.x.drive.0.speed`, `bodies.ball1.mass` or `gravity.1`. The same
// address works in --set, --vary, sliders and panels.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// The number at an address. Throws SceneError naming the part that does not exist and what does.
double get_parameter(const Mechanism& mechanism, std::string_view address);
// Changes it. Does not validate the mechanism as a whole; throws SceneError like get_parameter, and for a
// value that is not finite.
void set_parameter(Mechanism& mechanism, std::string_view address, double value);
// Unit of the number, as shown to a person: "rad/s", "N/m", "kg", "" where it has none.
std::string parameter_unit(const Mechanism& mechanism, std::string_view address);
// Every address that can be set, in the scene's order.
std::vector<std::string> parameter_addresses(const Mechanism& mechanism);

} // namespace flyball
