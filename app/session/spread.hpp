// How the steady state scatters with tolerances of numbers, by samples. What has a tolerance is kept while
// the program runs, as what is chosen of the other studies; nothing is computed before a person asks.
#pragma once

#include "app/session/shared_mechanism.hpp"
#include "app/session/study.hpp"
#include "engine/study/spread.hpp"

#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct Session;

struct ChosenTolerance {
  std::string address;
  Distribution distribution = Distribution::normal;
  double width = 1; // as of a Tolerance, or in % of the number as it is
  bool percent = true;
  bool operator==(const ChosenTolerance&) const = default;
};

struct SpreadChoice {
  std::vector<ChosenTolerance> tolerances; // each address once
  std::size_t samples = 2000;
  std::uint64_t seed = 1;
  bool operator==(const SpreadChoice&) const = default;
};

struct SpreadRequest {
  SharedMechanism mechanism;
  std::vector<Tolerance> tolerances;
  std::size_t samples = 0;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, double>> start; // the state that is shown
  bool operator==(const SpreadRequest&) const = default;
};

struct SpreadState {
  SpreadChoice choice;
  bool begun = false; // whether tolerances were chosen, at first by the program
  std::string output; // that is shown: a free coordinate or measure
  SpreadChoice asked; // what the samples were last made for
  Study<SpreadRequest, SpreadAnswer> samples;
  bool refused = false; // the state that was shown could not scatter, as at a fold
  bool stale = false;   // they are of what was before the last changes
};

// Takes the samples; makes them anew when something else is chosen, and after changes of the mechanism where
// that takes no time to speak of.
void update_spread(Session& session);
void sample_spread(Session& session);
// Everything goes but what was chosen.
void close_spread(Session& session);

// The chosen tolerances in their numbers' units; without those that are nothing, as 1 % of zero.
std::vector<Tolerance> chosen_tolerances(const Session& session);
// At first those of the pinned numbers, 1 %; without those that the mechanism no longer has.
void choose_tolerances(Session& session);
// Numbers that may be given one.
std::vector<std::string> numbers_without_tolerance(const Session& session);
void add_tolerance(Session& session, const std::string& address);
// Its width is told in % from now on, or in the number's unit, and stays as it is as far as that can be.
void tell_in_percent(Session& session, std::size_t tolerance, bool percent);

// The output that is shown; null where there is none.
const SpreadOutput* shown_output(const Session& session);

} // namespace flyball
