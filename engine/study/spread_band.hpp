// How steady states scatter along a response curve: a spread at each of several values of the varied number,
// by the same random numbers everywhere, so that what is chance moves all of the band alike.
#pragma once

#include "engine/study/spread.hpp"

namespace flyball {

// A steady state of the curve, about which samples are made.
struct BandPlace {
  double number = 0;                                 // value of the varied number, in its unit
  std::vector<std::pair<std::string, double>> start; // as of SolveOptions
};

struct BandPoint {
  double number = 0;
  // By SampleFate; all zero where there are no samples: the state is singular, as at a fold.
  std::array<std::size_t, fates> counts{};
  std::vector<SpreadStatistics> outputs; // of samples that followed; empty where there are none

  std::size_t samples() const;
  std::size_t others() const; // that did not follow to a stable state
};

struct SpreadBand {
  std::vector<std::string> outputs;
  std::vector<BandPoint> points; // by place
  bool cancelled = false;        // points are missing at the end
};

// A tolerance of the varied number itself counts about each of its values, with the same width. Throws
// SceneError as spread() does.
SpreadBand spread_band(const Mechanism& mechanism, const std::string& address,
                       std::span<const BandPlace> places, std::span<const Tolerance> tolerances,
                       const SpreadOptions& options, WorkSharing& sharing);

} // namespace flyball
