// Whether what the laws of drives ask for stays as it is while the drives turn. Where it does not there is no
// steady torque: it is refused, as the coordinate of what turns is.
//
// Looked at in one motion of no particular place or speeds, where two phases of it must agree: an analytic
// function that is the same there is the same everywhere, but for coincidences of no measure.
#pragma once

#include "engine/system/parameters.hpp"

namespace flyball {

// Whether some law asks for places or velocities of points.
bool asks_for_points(const System& system);

// Throws SceneError for a law that asks for a place, distance, angle, velocity or force of a spring that
// changes with the phase of the drives, and for an angle without an arm. Drives that stand still change none.
void refuse_turning_laws(const System& system, const Mechanism& mechanism, const Parameters& parameters);

// Whether a law tells whole turns of a coordinate (in System::coordinates) that it asks for apart, as 2 N
// m*(1 - coordinate(a)) does and sin(coordinate(a)) does not: in some states of no particular place.
bool tells_turns_apart(const DriveLaw& law, const DriveLawParameters& numbers, int coordinate);

} // namespace flyball
