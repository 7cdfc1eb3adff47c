// Finds places for the labels of marks and reference lines.
#pragma once

#include "app/plot/layout.hpp"

namespace flyball {

// Fills in layout.ink and the labels of layout.references and layout.marks: inside the frame, off one another
// and off all marks, and where there is a choice off the curves. The better places go to those that come
// first; where there is none left a label is left out.
void place_labels(const Plot& plot, PlotLayout& layout, const PlotMetrics& metrics);

} // namespace flyball
