// Driving a joint's coordinate, or letting it go.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>

namespace flyball {

struct Session;
struct Ui;

// Why the coordinate cannot be driven, in a sentence; null where it can.
const char* drive_refused(const Joint& joint, int coordinate);
// An edit. A new drive has a speed to begin with.
void set_driven(Session& session, Ui& ui, const std::string& joint, int coordinate, bool driven);

} // namespace flyball
