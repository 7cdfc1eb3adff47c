// The engine's kinematics once more, for numbers with a derivative of 113 bits and for the extended numbers
// that the engine does without here. Its templates are defined in
// this source file; linked as an object, it stands in for the library's own and defines the same functions.
#include "engine/system/kinematics.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

template void forward<stress::Dual>(const System&, const Parameters&, const Configuration<stress::Dual>&,
                                    double, Kinematics<stress::Dual>&);
template void retract<stress::Dual>(const System&, const Configuration<stress::Dual>&,
                                    Configuration<stress::Dual>&);
template Vec3T<stress::Dual> rotation_vector<stress::Dual>(const Link&, const LinkParameters&,
                                                           const Configuration<stress::Dual>&);

template void forward<stress::OtherExtended>(const System&, const Parameters&,
                                             const Configuration<stress::OtherExtended>&, double,
                                             Kinematics<stress::OtherExtended>&);
template void retract<stress::OtherExtended>(const System&, const Configuration<stress::OtherExtended>&,
                                             Configuration<stress::OtherExtended>&);
template Vec3T<stress::OtherExtended>
rotation_vector<stress::OtherExtended>(const Link&, const LinkParameters&,
                                       const Configuration<stress::OtherExtended>&);

} // namespace flyball
