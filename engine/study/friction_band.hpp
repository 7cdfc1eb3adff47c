// Dry friction makes of a steady state a band: at rest every force up to its limit holds. With each joint's
// part of its limit, the share, anywhere from -1 to 1 the balance is solved as ever, so the band is the image
// of a box of shares, and its extent in a coordinate or a measure is the least and the largest value over the
// box: at a corner where every rate points outwards, or within at a root of a rate.
#pragma once

#include "engine/continuation/branches.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct BandExtent {
  std::string name, unit;         // of a found number or a measure; "rad", "m", or the measure's
  double value = 0;               // of the state it is about
  double low = 0, high = 0;       // over the band; infinite where nothing was found that bounds it
  std::optional<double> error;    // of both, estimated; none where `folds`
  std::vector<double> shares_low, // of the joints with friction there; empty where `folds`
      shares_high;
  bool stands = false; // a joint with friction, and that moves in one way only, as do all that have some: it
                       // stays as it is while nothing pushes it over an end
  // Whether it is stable at either end as friction gives its limit there: a slow change then goes along that
  // end, and over another it runs away. Nothing where that is not known.
  std::optional<bool> stable_low, stable_high;
};

struct FrictionBand {
  bool found = false;
  std::vector<BandExtent> extents; // free coordinates, speeds that are found, then measures
  bool whole = true;               // nothing folds within the box
  bool folds = false;              // followed through folds, where the balance without friction is unstable,
                                   // or by where the joints stand (placed_band.hpp)
  std::string message;             // a sentence or more
  bool at_least = false;           // not all ways were gone: extents may go farther
};

struct FrictionBandOptions {
  // The state that it is about, as of SolveOptions; empty: what a solve answers.
  std::vector<std::pair<std::string, double>> start{};
  bool errors = true; // of the extents, two solves each
  const std::atomic<bool>* cancel = nullptr;
  // Bands of several joints past folds, by where these stand: up to some seconds. Else there is none.
  bool past_folds = true;
};

// The band that is connected with a steady state; none about an unstable one that friction does not hold, as
// what is free beside the joints that have some leaves it. With several joints each extent is a local
// extremum: rates tell of no other beyond. Measures that jump within it have no extent. Throws SceneError as
// SteadyMap does.
FrictionBand find_friction_band(const Mechanism& mechanism, const FrictionBandOptions& options = {});

} // namespace flyball
