// The plot of a resonance curve: what is stable, what is not, and where there is nothing.
#include "app/plot/csv.hpp"
#include "app/plot/resonance_plot.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;

namespace {

std::shared_ptr<const ResonancePoint> motion_at(double number, std::optional<bool> stable, double mean = 1) {
  ResonancePoint point;
  point.number = number;
  point.stable = stable;
  point.outputs = {{OutputKind::coordinate, "up", "m", {mean, mean - 0.5, mean + 0.5, 0}},
                   {OutputKind::motion, "period", "s", {2, 2, 2, 0}}};
  return std::make_shared<const ResonancePoint>(point);
}

std::shared_ptr<const ResonancePoint> nothing_at(double number) {
  ResonancePoint point;
  point.number = number;
  point.trouble = "It grows without end.";
  return std::make_shared<const ResonancePoint>(point);
}

} // namespace

TEST_CASE("a resonance curve is dashed where it is unstable, and broken where there is no motion") {
  ResonanceCurve curve;
  curve.points = {motion_at(0, true), motion_at(1, true), motion_at(2, false), motion_at(3, false),
                  nothing_at(4),      nothing_at(5),      motion_at(6, {}),    motion_at(7, {}, std::nan("")),
                  motion_at(8, true), motion_at(9, true)};
  Plot plot;
  add_resonance(plot, curve, OutputKind::coordinate, "up");
  REQUIRE(plot.curves.size() == 4);
  CHECK(plot.curves[0].name == "mean, stable");
  CHECK(plot.curves[0].line == PlotLine::solid);
  CHECK(plot.curves[0].points == std::vector<std::array<double, 2>>{{0, 1}, {1, 1}});
  CHECK(plot.curves[1].name == "mean, unstable");
  CHECK(plot.curves[1].line == PlotLine::dashed);
  // From the last stable one on: that is no gap.
  CHECK(plot.curves[1].points == std::vector<std::array<double, 2>>{{1, 1}, {2, 1}, {3, 1}});
  CHECK(plot.curves[2].line == PlotLine::dotted);
  CHECK(plot.curves[2].points.size() == 1);
  CHECK(plot.curves[3].points == std::vector<std::array<double, 2>>{{8, 1}, {9, 1}});
  REQUIRE(plot.bands.size() == 3);
  CHECK(plot.bands[0].points ==
        std::vector<std::array<double, 3>>{{0, 0.5, 1.5}, {1, 0.5, 1.5}, {2, 0.5, 1.5}, {3, 0.5, 1.5}});
  CHECK(plot.bands[2].points.size() == 2);
  const std::vector<ResonanceGap> gaps = resonance_gaps(curve);
  REQUIRE(gaps.size() == 1);
  CHECK(gaps[0].from == 4);
  CHECK(gaps[0].to == 5);
  plot.x = {.label = "n", .unit = "rad/s"};
  plot.y = {.label = "up", .unit = "m"};
  const std::string csv = to_csv(plot);
  CHECK_THAT(csv, ContainsSubstring("\"mean, unstable\",2,1"));
  CHECK_THAT(csv, ContainsSubstring("\"least to most, from\",2,0.5"));
  CHECK_THAT(csv, ContainsSubstring("\"least to most, to\",2,1.5"));
}

TEST_CASE("what is one number of each motion has no band, and steady states are told apart") {
  ResonanceCurve curve;
  ResonancePoint steady;
  steady.number = 3;
  steady.steady = true;
  steady.stable = true;
  steady.outputs = {{OutputKind::coordinate, "up", "m", {2, 2, 2, 0}}};
  curve.points = {motion_at(1, true), motion_at(2, true), std::make_shared<const ResonancePoint>(steady)};
  Plot plot;
  add_resonance(plot, curve, OutputKind::motion, "period");
  REQUIRE(plot.curves.size() == 1);
  CHECK(plot.curves[0].name == "stable");
  CHECK(plot.curves[0].points == std::vector<std::array<double, 2>>{{1, 2}, {2, 2}});
  CHECK(plot.bands.empty());
  Plot up;
  add_resonance(up, curve, OutputKind::coordinate, "up");
  REQUIRE(up.curves.size() == 2);
  CHECK(up.curves[1].name == "steady state");
  CHECK(up.curves[1].points == std::vector<std::array<double, 2>>{{3, 2}}); // nothing leads over to it
  REQUIRE(up.bands.size() == 1);
  CHECK(up.bands[0].points.size() == 2);
}
