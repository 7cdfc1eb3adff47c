// How the panels stand, and which of their sections are open.
#pragma once

#include "app/ui/widgets/shown_rate.hpp"

#include <map>
#include <string>

namespace flyball {

// Sizes in points, so that they mean the same on every display.
struct PanelState {
  float parameters_width = 290, results_width = 345, stacked_width = 330;
  // Of the height, for the parameters above the results; 0 until the person chooses: as much as they need.
  float stacked_share = 0;
  float parameters_height = 0; // what they needed in the last frame
  float inspector_share =
      0.55f; // of the height, for the inspector above the results, or the outline above it
  bool pinned = true, named = true, springs = true, drives = true;
  float study_share = 0.42f; // of the height, for the studies below the view
  bool dampers = true;
  bool legend = true;         // of the view
  bool legend_low = false;    // in the lower corner, where it hides fewer arrows
  bool legend_anyway = false; // also where it covers much of the view
  bool torques = true, reactions = false, eigenvalues = false, system = false;
  std::map<std::string, KeptRates> rates; // by the slider's address
};

} // namespace flyball
