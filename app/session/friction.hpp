// What dry friction makes of the steady state that is shown, and of the response curve. Nothing of it is
// computed of a mechanism without friction.
#pragma once

#include "app/session/response.hpp"
#include "app/session/shared_mechanism.hpp"
#include "app/session/spread_band.hpp"
#include "app/session/study.hpp"
#include "engine/study/friction_report.hpp"
#include "engine/study/friction_ribbon.hpp"

namespace flyball {

struct FrictionRequest {
  SharedMechanism mechanism;
  std::optional<std::vector<std::pair<std::string, double>>> state; // that is shown, if any
  FrictionParts parts;                                              // of friction in it
  bool operator==(const FrictionRequest&) const = default;
};

struct RibbonRequest {
  std::shared_ptr<const ResponseCurve::Found> curve;
  bool operator==(const RibbonRequest&) const = default;
};

struct FoundRibbon {
  std::vector<RibbonPoint> points;
  std::vector<BandStretch> stretches;
};

struct FrictionState {
  Study<FrictionRequest, FrictionReport> report;
  bool ribbon_wanted = true; // around the response curve
  Study<RibbonRequest, FoundRibbon> ribbon;
};

void update_friction(Session& session);
// Of the answer that is shown; null while there is none.
const FrictionReport* friction_report(const Session& session);
// The ribbon of the curve that is shown; null likewise.
std::shared_ptr<const Study<RibbonRequest, FoundRibbon>::Found> shown_ribbon(const Session& session);
// The name of the coordinate or measure over the curve; nothing where something else is shown, as friction
// makes bands of these.
std::optional<std::string> banded_quantity(const Session& session);

// Of the ribbon that is shown: where it has no band of the quantity that is shown, or no bound of it.
struct RibbonGap {
  double from = 0, to = 0; // of the varied number, in its unit
  std::string why;         // a sentence or more
};
std::vector<RibbonGap> ribbon_gaps(const Session& session);

} // namespace flyball
