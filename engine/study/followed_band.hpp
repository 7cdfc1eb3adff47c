// The band of a single joint with friction, along the curve of states that its share makes: through folds of
// the balance, beyond which friction alone holds, and round.
#pragma once

#include "engine/study/free_number.hpp"
#include "engine/study/friction_band.hpp"

#include <optional>

namespace flyball {

// Sets the extents of a band about this state to those over all that hangs together along the share, whose
// names, units and values are known, and its message. Without shares and errors. The names of measures that
// jump within it and have none; nothing where no curve is found.
std::optional<std::vector<std::string>> follow_band(const Mechanism& mechanism, const FreeNumber& share,
                                                    const Solution& state, const std::atomic<bool>* cancel,
                                                    FrictionBand& band);

} // namespace flyball
