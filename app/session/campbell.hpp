// The Campbell diagram: the frequencies of the modes over a drive's speed, along the branch of the state that
// is shown. Nothing of it is made before a person asks.
#pragma once

#include "app/live/background.hpp"
#include "engine/continuation/branches.hpp"

#include <array>
#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

struct FoundCampbell {
  std::string drive;       // address of the speed along the axis
  double from = 0, to = 0; // its range
  ResponseDiagram diagram;
  // By branch, point and line: see track_eigenvalues().
  std::vector<std::vector<std::vector<std::complex<double>>>> lines;
  bool cancelled = false;
  double run_time_s = 0;
};

struct CampbellState {
  std::unique_ptr<Background<FoundCampbell>> task;
  std::optional<FoundCampbell> result;
  // As chosen. An empty drive is the first; both ends 0: as the speed's slider.
  std::string drive;
  double from = 0, to = 0;
  // As last followed: also the mechanism with that speed 0, and that of the result.
  std::string asked_drive;
  double asked_from = 0, asked_to = 0;
  Mechanism asked, of;
  std::uint64_t revision = 0;     // of the document when `current` was found
  bool current = false;           // the result is of the mechanism as it is
  std::uint64_t asked_ticket = 0; // of the answer when it was asked for
  bool on_branch = true;          // the result holds the branch of the state that is shown,
  std::uint64_t judged_result = 0, judged_ticket = 0; // of this result and this answer
  std::string problem;
  std::uint64_t results = 0; // so far
};

// Addresses of the drives' speeds.
std::vector<std::string> drive_speeds(const Mechanism& mechanism);
// Drive and range as they were chosen, or as they are at first; no drive: "".
std::string campbell_drive(const Session& session);
std::array<double, 2> campbell_range(const Session& session);

void follow_campbell(Session& session);
// Takes what was followed; follows anew after changes of anything but the speed where that takes no time to
// speak of.
void update_campbell(Session& session);
// The branch that the state lies on.
std::optional<std::size_t> campbell_branch(const Session& session);

} // namespace flyball
