// The engine's kinematics once more, for numbers with a derivative of 113 bits. Its templates are defined in
// this source file; linked as an object, it stands in for the library's own and defines the same functions.
#include "engine/system/kinematics.cpp"

#include "tests/stress/wide.hpp"

namespace flyball {

template void forward<stress::Dual>(const System&, const Parameters&, const Configuration<stress::Dual>&,
                                    double, Kinematics<stress::Dual>&);
template void retract<stress::Dual>(const System&, const Configuration<stress::Dual>&,
                                    Configuration<stress::Dual>&);
template Vec3T<stress::Dual> rotation_vector<stress::Dual>(const Link&, const LinkParameters&,
                                                           const Configuration<stress::Dual>&);

} // namespace flyball
