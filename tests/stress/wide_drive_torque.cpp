// The torques of drives once more, for further numbers: see wide_kinematics.cpp.
#include "engine/system/drive_torque.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

template void add_drive_torques<stress::Dual>(const System&, const Parameters&,
                                              const Configuration<stress::Dual>&,
                                              const Kinematics<stress::Dual>&, Configuration<stress::Dual>&);

template void add_drive_torques<stress::OtherExtended>(const System&, const Parameters&,
                                                       const Configuration<stress::OtherExtended>&,
                                                       const Kinematics<stress::OtherExtended>&,
                                                       Configuration<stress::OtherExtended>&);

} // namespace flyball
