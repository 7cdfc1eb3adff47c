// The engine's balance once more, for numbers with a derivative of 113 bits: see wide_kinematics.cpp.
#include "engine/system/residual.cpp"

#include "tests/stress/wide.hpp"

namespace flyball {

template void evaluate_residual<stress::Dual>(const System&, const Parameters&,
                                              const Configuration<stress::Dual>&,
                                              const Configuration<stress::Dual>&,
                                              const Kinematics<stress::Dual>&, Residual<stress::Dual>&);

} // namespace flyball
