// The band beside what plays a part of its own: where a steady state rests on friction that slips at a
// constant rate, or that holds what torques turn, the friction of other joints makes a band of it all the
// same.
#pragma once

#include "engine/report/friction_parts.hpp"
#include "engine/study/friction_band.hpp"

namespace flyball {

// Of a state with these parts (parts_of()), as of SolveOptions::start: what slips goes on doing so, what is
// held of what torques turn stands as drawn, and what else has friction may give any share of its limit.
// Nothing where no friction plays such a part. A band in which one of them would turn round or have to hold
// more than its limit is not told, and the message says so. Extents have no shares.
std::optional<FrictionBand> find_band_beside_brakes(const Mechanism& mechanism, const FrictionParts& parts,
                                                    const std::vector<std::pair<std::string, double>>& state,
                                                    const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
