// Small mechanisms of any size, and mechanisms in another size or mass.
#pragma once

#include "tests/support/parts.hpp"

namespace flyball::test {

inline constexpr double standard_gravity = 9.80665; // m/s^2

// A spindle on a vertical (y) axis through the origin.
Body spindle();
Joint spin(double speed, const Vec3& axis = Vec3::UnitY());

// A point mass on a massless rod, hinged about z at (offset, 0, 0) on the spindle; drawn at `angle` from
// hanging, outwards.
Mechanism conical(double length, double offset, double speed, double angle = 0, double mass = 1);

// Thin rods hinged end to end about z, 1 m and 1 kg in all, hanging from the spindle's axis.
Mechanism hanging_chain(int count, double speed);

// The mechanism in another size: lengths times `factor`, inertias with their square.
Mechanism resized(Mechanism m, double factor);
// With another mass: inertias along with it.
Mechanism heavier(Mechanism m, double factor);

} // namespace flyball::test
