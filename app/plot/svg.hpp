// Plots as SVG text.
#pragma once

#include "app/plot/plot.hpp"

namespace flyball {

std::string to_svg(const Plot& plot, int width = 800, int height = 520);

} // namespace flyball
