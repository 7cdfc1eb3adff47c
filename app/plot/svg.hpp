// Plots as SVG text.
#pragma once

#include "app/plot/colors.hpp"
#include "app/plot/plot.hpp"

namespace flyball {

struct SvgOptions {
  int width = 800, height = 520;
  std::string font = "Inter, Helvetica, Arial, sans-serif";
  PlotGround ground = PlotGround::light;
  std::string prefix{}; // of its ids, where a page holds several
};

// Valid XML whatever the texts hold.
std::string to_svg(const Plot& plot, const SvgOptions& options = {}, const PlotLook& look = {});

} // namespace flyball
