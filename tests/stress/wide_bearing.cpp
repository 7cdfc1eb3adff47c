// The engine's bearings once more, for further numbers: see wide_kinematics.cpp.
#include "engine/system/bearing.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

template void add_bearings<stress::Dual>(const System&, const Parameters&, const Kinematics<stress::Dual>&,
                                         Configuration<stress::Dual>&);

template void add_bearings<stress::OtherExtended>(const System&, const Parameters&,
                                                  const Kinematics<stress::OtherExtended>&,
                                                  Configuration<stress::OtherExtended>&);

template stress::OtherExtended bearing_force<stress::OtherExtended>(Result, const BearingElement&,
                                                                    const BearingParameters&,
                                                                    const Kinematics<stress::OtherExtended>&);

} // namespace flyball
