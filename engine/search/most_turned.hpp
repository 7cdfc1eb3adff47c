// How large a mechanism may be whose turned states are looked for: with 200 coordinates finding none takes
// two seconds.
#pragma once

namespace flyball {

constexpr int most_turned_coordinates = 200; // see find_turned_state()

} // namespace flyball
