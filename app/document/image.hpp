// Parts as an isometry puts them elsewhere: equal coordinates (see coordinate_image.hpp) mean poses that are
// images of one another.
#pragma once

#include "app/document/isometry.hpp"

namespace flyball {

Body image_of(const Body& body, const Isometry& isometry);

// Of a joint with its coordinates; a gear, which has no place, stays as it is.
Joint image_of(const Joint& joint, const Isometry& isometry);

// Of a vane's directions, which are drawn in the world.
void turn_vane(Force& vane, const Isometry& isometry);

// `body`: axes of the body acted on, if any. With `body_too` that body becomes its image as well, and what
// is in its axes keeps to it.
Force image_of(const Force& force, const Isometry& isometry, const Quat& body, bool body_too);

} // namespace flyball
