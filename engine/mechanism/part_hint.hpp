// Help where the name of a part stands in the place of a number's.
#pragma once

#include <string>
#include <string_view>

namespace flyball {

struct Mechanism;

// For where results may be asked for: "; slide is a joint, whose results are written as coordinate(slide) or
// rate(slide)"; empty where no part is called so.
std::string part_hint(const Mechanism& mechanism, std::string_view name);

} // namespace flyball
