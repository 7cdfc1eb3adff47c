// Axes with sensible ticks, and plots as SVG.
#include "tests/catch.hpp"

#include "app/plot/svg.hpp"

#include <cmath>
#include <limits>

using namespace flyball;

TEST_CASE("ticks are round, in range, and about as many as wanted", "[plot]") {
  for (double lower : {-3.7e-5, -1.0, 0.0, 0.013, 4.9e7})
    for (double width : {1e-6, 0.37, 1.0, 25.0, 9e9}) {
      INFO(lower << " + " << width);
      const std::vector<double> ticks = axis_ticks(lower, lower + width, 8, false);
      if (width < 1e-9 * std::abs(lower)) continue; // closer than doubles are
      REQUIRE(ticks.size() >= 3);
      CHECK(ticks.size() <= 10);
      const double step = ticks[1] - ticks[0], power = std::pow(10., std::floor(std::log10(step) + 1e-6));
      const double factor = step / power;
      CHECK(std::min({std::abs(factor - 1), std::abs(factor - 2), std::abs(factor - 5)}) < 1e-3);
      CHECK(ticks.front() >= lower - 1e-6 * width);
      CHECK(ticks.back() <= lower + width * (1 + 1e-6));
    }
  CHECK(axis_ticks(1e-3, 1e3, 7, true) == std::vector<double>{1e-3, 1e-2, 1e-1, 1, 10, 100, 1000});
  CHECK(axis_ticks(1, 1, 5, false).empty());
}

TEST_CASE("an SVG has every curve, dashes, marks and labels, and no number that is not one", "[plot]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Plot plot;
  plot.title = "a < b & \"c\"";
  plot.x.label = "speed [rad/s]";
  plot.y.label = "angle [rad]";
  plot.curves = {{"stable", {{0, 1}, {1, nan}, {2, 3}}, PlotLine::solid, 0},
                 {"", {{0, 0}, {2, 2}}, PlotLine::dashed, 1}};
  plot.marks = {{{2, 3}, "fold"}, {{nan, 0}, "lost"}};
  const std::string svg = to_svg(plot);
  CHECK(svg.find("a &lt; b &amp; &quot;c&quot;") != std::string::npos);
  CHECK(svg.find("stroke-dasharray=\"7 5\"") != std::string::npos);
  CHECK(svg.find(">fold<") != std::string::npos);
  CHECK(svg.find("lost") == std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  CHECK(svg.find("speed [rad/s]") != std::string::npos);
  CHECK(to_svg(Plot{}).find("nan") == std::string::npos);
}
