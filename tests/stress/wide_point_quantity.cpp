// What points make once more, for a further number: see wide_kinematics.cpp.
#include "engine/system/point_quantity.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

template double point_quantity<stress::OtherExtended>(Result, const TrackedPoints&, const Parameters&,
                                                      const Kinematics<stress::OtherExtended>&);

} // namespace flyball
