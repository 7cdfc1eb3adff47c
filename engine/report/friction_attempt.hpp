// One attempt at a steady state that rests on dry friction (friction_parts.hpp): the friction of each
// coordinate plays a given part, and the mechanism with what it holds standing and what slips driven is
// solved.
#pragma once

#include "engine/report/friction_parts.hpp"
#include "engine/report/holding.hpp"
#include "engine/report/standstill.hpp"

namespace flyball {

// Nothing where there is no such state. `frictions`: find_frictions(). `holding`: what holding takes, where
// all hold and springs and stops of their own help. `implied`: of those that slip the ones whose rate follows
// from the drives, by coordinate with friction; empty: none. `loose`: what is taken to slip may stand with
// others, its limit being its share of what they hold together (its margin is 0); and whether to tell also of
// what is no state, as a coordinate without a part goes on (its margin is less its rate).
std::optional<StateOnFriction> attempt_parts(const Mechanism& mechanism,
                                             const std::vector<CoordinateReference>& frictions,
                                             const FrictionParts& parts, const SolveOptions& options,
                                             const Holding* holding = nullptr, std::vector<bool> implied = {},
                                             bool loose = false);

// The mechanism that is solved then. Throws SceneError.
Mechanism driven_by_parts(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
                          const FrictionParts& parts, std::vector<bool> implied = {});
// The same with drives by torque that have come to rest, and what stands still in it.
Standstill stand_still_by_parts(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
                                const FrictionParts& parts, std::span<const CoordinateReference> at_rest);

} // namespace flyball
