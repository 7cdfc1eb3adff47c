// Drives left to themselves once more, for further numbers: see wide_kinematics.cpp.
#include "engine/system/kept_momentum.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

template void set_kept_momenta<stress::Dual>(const System&, const Parameters&,
                                             const Kinematics<stress::Dual>&, Residual<stress::Dual>&);

template void set_kept_momenta<stress::OtherExtended>(const System&, const Parameters&,
                                                      const Kinematics<stress::OtherExtended>&,
                                                      Residual<stress::OtherExtended>&);

} // namespace flyball
