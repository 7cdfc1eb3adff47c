// Numbers for residuals whose last digits matter: near a steady state the terms of the balance all but
// cancel, and what these leave of them still has all digits of the double that it is then rounded to.
#pragma once

#include "engine/linear/double_double.hpp"

#include <limits>
#include <type_traits>

namespace flyball {

// The 80 bits of x87 are native and fast. Elsewhere long double is a double (Windows, ARM under macOS), or
// has 113 bits in software (ARM under Linux, WebAssembly), against which two doubles are several times
// faster.
#ifdef FLYBALL_DOUBLE_DOUBLE
using Extended = DoubleDouble;
#else
using Extended =
    std::conditional_t<std::numeric_limits<long double>::digits == 64, long double, DoubleDouble>;
#endif

// Relative error of one operation at most: 2^-63 or 2^-102.
inline constexpr auto extended_rounding = static_cast<double>(std::numeric_limits<Extended>::epsilon());

} // namespace flyball
