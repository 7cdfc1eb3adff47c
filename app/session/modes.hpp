// The modes of the steady state that is shown, and one of them moving in the view. Nothing of it is made
// before a person asks.
#pragma once

#include "app/session/campbell.hpp"
#include "app/session/study.hpp"
#include "engine/report/analysis.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

struct FoundModes {
  std::vector<VibrationMode> modes;
  std::vector<std::optional<Whirl>> whirls; // by mode, about the axis of the first drive that turns
  std::optional<StabilityEvidence> evidence;
  bool singular_loops = false;        // why there are no modes
  std::unique_ptr<Analysis> analysis; // which stands in the state, for poses along a mode
};

struct ModesRequest {
  std::uint64_t answer = 0; // whose state it is, by its ticket
  bool operator==(const ModesRequest&) const = default;
};

struct ModesState {
  Study<ModesRequest, FoundModes> list;
  std::optional<std::size_t> chosen; // of the modes
  double amplitude = 0.15;           // of the largest coordinate: rad, or parts of the mechanism's reach
  double phase = 0;                  // rad
  bool playing = false;
  bool both_ends = false;  // the swing's end on the other side, too: for a picture
  std::vector<Pose> poses; // along the chosen mode, of both ends one after the other; empty: none
  struct Posed {
    ModesRequest of;
    std::size_t mode = 0;
    double amplitude = 0, phase = 0, time = 0;
    bool both_ends = false;
    bool operator==(const Posed&) const = default;
  } posed; // what they are of

  CampbellState campbell;
};

// Takes what was found; asks for what is missing while the study is open.
void update_modes(Session& session);
void find_modes_again(Session& session);
// Why none are looked for, nor a Campbell diagram, a sentence: too many coordinates are free. Empty where
// they are.
std::string modes_refusal(const Session& session);
// Everything goes but how the Campbell diagram is wanted.
void close_modes(Session& session);
// Whether modes or the diagram are being computed.
bool finding_modes(const Session& session);
// Whether the modes are those of the state that is shown.
bool modes_are_current(const Session& session);

// Moves the mode, or none, in the view.
void choose_mode(Session& session, std::optional<std::size_t> mode);
// The mode that moves in the view; null: none.
const VibrationMode* moving_mode(const Session& session);
// Its motion goes on by `seconds` on the screen.
void advance_mode(Session& session, double seconds);
// s, of one swing on the screen; what does not swing sways.
double shown_period(const VibrationMode& mode);
// How many times slower than it is the mode is shown; below one: faster. Nothing where it does not swing.
std::optional<double> shown_slower(const VibrationMode& mode);
// Whether disturbances of its shape grow.
bool grows(const VibrationMode& mode);

} // namespace flyball
