// What dry friction makes of a steady state, in one: the band, whether the drawn pose holds, and between
// which speeds of its drives the state does.
#pragma once

#include "engine/report/friction_parts.hpp"
#include "engine/report/holding.hpp"
#include "engine/study/friction_band.hpp"

namespace flyball {

struct FrictionReport {
  FrictionBand band; // connected with the solution, beside what slips or stands in it; where there is none
                     // and one joint has friction, with a state in which that gives all it can
  Holding drawn;     // at the drawn pose
  std::vector<HeldSpeeds> speeds; // where the solution stands
  double run_time_s = 0;
};

// Of a mechanism with friction. `state`: its steady state as of SolveOptions::start, where there is one, and
// the parts that friction has in it (parts_of()). Throws SceneError as the two do.
FrictionReport report_friction(const Mechanism& mechanism,
                               const std::optional<std::vector<std::pair<std::string, double>>>& state,
                               const FrictionParts& parts, const std::atomic<bool>* cancel = nullptr);
// The same of what a solve answered.
FrictionReport report_friction(const Mechanism& mechanism, const Solution& solution,
                               const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
