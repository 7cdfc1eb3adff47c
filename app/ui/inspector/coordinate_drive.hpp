// Driving a joint's coordinate, or letting it go; what its drive prescribes.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>

namespace flyball {

struct CoordinateRows;
struct Session;
struct Ui;

// Why the coordinate cannot be driven, in a sentence; null where it can.
const char* drive_refused(const Joint& joint, int coordinate);
// An edit. A new drive has a speed to begin with.
void set_driven(Session& session, Ui& ui, const std::string& joint, int coordinate, bool driven);
// Of a coordinate that is driven: whether its speed, its torque or its momentum is given, and those numbers.
void drive_rows(const CoordinateRows& rows);

} // namespace flyball
