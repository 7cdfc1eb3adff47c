// Studies below the view: which one is open, and what they have found.
#pragma once

#include "app/live/background.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "app/ui/studies/map/map_state.hpp"
#include "app/ui/studies/modes/modes_state.hpp"
#include "app/ui/studies/response/response_state.hpp"
#include "app/ui/studies/states/states_state.hpp"
#include "engine/study/compare.hpp"

#include <memory>

namespace flyball {

enum class Study { none, motion, compare, response, states, modes, map };

// Error against run time.
struct CompareState {
  std::unique_ptr<Background<Comparison>> task; // made when it is first asked for
  std::optional<Comparison> result;
  std::shared_ptr<const Mechanism> of; // what was compared
  std::string problem;
  int repeats = 5;
  PlotView view;
  Plot plot; // of the result
  std::uint64_t plots_made = 0;
};

struct StudyState {
  Study open = Study::none;
  CompareState compare;
  ResponseState response;
  StatesState states;
  ModesState modes;
  MapState map;
};

} // namespace flyball
