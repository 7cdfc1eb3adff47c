// Equal parts from one: a governor has two or three equal arms.
//
// Selected bodies are copied with every joint and force that holds them; where such a one also holds a body
// that is not selected, the copy holds that same body ("spindle" stays shared). Gears are copied where both
// their joints are. Joints and forces selected by themselves are copied between the same bodies. Each copy
// gets the next unused name of its stem ("arm1" and "arm" give "arm2"). A force's vector is put where the
// rest is, also one in world axes. Sliders are not copied.
//
// Equal coordinates mean poses that are images of one another, but for an angle of a cylindrical joint in the
// mirror, and for spherical and free joints: see coordinate_image.hpp, also for what is not exact there.
//
// Returned: the copies of what was selected, in its order; nothing, and nothing is copied, where numbers are
// not finite or a direction is none.
#pragma once

#include "app/document/part.hpp"

namespace flyball {

// `by` (m) apart, so that it can be seen.
Selection duplicate_parts(Mechanism& mechanism, const Selection& selection, const Vec3& by);

// At the plane through `point` with `normal` (any length). Axes of revolute joints are mirrored as the
// vectors of rotation they are, so that equal coordinates mean mirrored poses; bodies' axes stay a
// right-handed frame, their tensor is the mirror image's.
Selection mirror_parts(Mechanism& mechanism, const Selection& selection, const Vec3& point,
                       const Vec3& normal);

// `count` in all, the original included, evenly round the axis through `point`. count >= 2.
Selection circular_copy(Mechanism& mechanism, const Selection& selection, const Vec3& point, const Vec3& axis,
                        int count);

} // namespace flyball
