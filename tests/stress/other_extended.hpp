// Of long double and two doubles the one that the engine does not take for its extended numbers here.
#pragma once

#include "engine/system/extended.hpp"

namespace flyball::stress {

using OtherExtended = std::conditional_t<std::is_same_v<Extended, long double>, DoubleDouble, long double>;

} // namespace flyball::stress
