// A band around the response curve: how far the steady states along it scatter with the tolerances that the
// study of the spread has. Nothing of it is made unless a person asks and the response is open.
#pragma once

#include "app/session/response.hpp"
#include "engine/study/spread_band.hpp"

namespace flyball {

struct BandRequest {
  std::shared_ptr<const ResponseCurve::Found> curve;
  std::vector<Tolerance> tolerances;
  std::uint64_t seed = 0;
  bool operator==(const BandRequest&) const = default;
};

// Of the band's points so many that follow one another on stable states.
struct BandStretch {
  std::size_t first = 0, count = 0;
};

struct FoundBand {
  SpreadBand band;
  std::vector<BandStretch> stretches;
};

struct BandState {
  bool wanted = false;
  Study<BandRequest, FoundBand> computed;
};

constexpr std::size_t band_samples = 400; // at each point

void update_band(Session& session);
// Why there can be no band, a sentence; empty where there can.
std::string band_refusal(const Session& session);
// What it is, and where samples leave the branch; empty where there is none.
std::string band_words(const Session& session);
// Which of the band's outputs the response shows; none where it is none of them.
std::optional<std::size_t> band_output(const Session& session);

// Stable states alone; or all, which friction may hold.
enum class BandOf { stable, any };
// States of a line that follow one another, places of special points left out, and which of them are about
// a fortieth of the range apart, its ends among them.
struct BandRun {
  std::vector<const ResponsePoint*> states; // of the curve
  std::vector<std::size_t> apart;
};
// Those about which a band is made. None of what rests on friction.
std::vector<BandRun> band_runs(const ResponseCurve::Found& curve, BandOf which);

} // namespace flyball
