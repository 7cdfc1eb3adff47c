// The engine's balance once more, for further numbers: see wide_kinematics.cpp.
#include "engine/system/residual.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

template void evaluate_residual<stress::Dual>(const System&, const Parameters&,
                                              const Configuration<stress::Dual>&,
                                              const Configuration<stress::Dual>&,
                                              const Kinematics<stress::Dual>&, Residual<stress::Dual>&);

template void evaluate_residual<stress::OtherExtended>(const System&, const Parameters&,
                                                       const Configuration<stress::OtherExtended>&,
                                                       const Configuration<stress::OtherExtended>&,
                                                       const Kinematics<stress::OtherExtended>&,
                                                       Residual<stress::OtherExtended>&);

template SpringState<stress::OtherExtended> spring_state(const PointSpringElement&,
                                                         const PointSpringParameters&,
                                                         const Kinematics<stress::OtherExtended>&);

} // namespace flyball
