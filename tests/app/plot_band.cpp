// Areas between two values, and the histogram that is made of them.
#include "app/plot/axis.hpp"
#include "app/plot/csv.hpp"
#include "app/plot/nearest.hpp"
#include "app/plot/ribbon_plot.hpp"
#include "app/plot/spread_plot.hpp"
#include "app/plot/svg.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace flyball;

namespace {

const double nothing = std::numeric_limits<double>::quiet_NaN();

Plot banded() {
  Plot plot;
  plot.x.label = "x";
  plot.y.label = "y";
  plot.x.room = plot.y.room = 0;
  plot.bands.push_back({"range", {{0, 1, 2}, {1, 2, 4}, {2, nothing, nothing}, {3, 1, 3}, {4, 1, 5}}});
  return plot;
}

PlotLayout layout_of(const Plot& plot, const PlotLook& look = {}) {
  return plot_layout(plot, look, 400, 300, {});
}

} // namespace

TEST_CASE("a band takes its room, is broken where it has no values, and stands in the legend") {
  const Plot plot = banded();
  CHECK(axis_range(plot, {}, 0) == PlotRange{0, 4});
  CHECK(axis_range(plot, {}, 1) == PlotRange{1, 5});
  const PlotLayout layout = layout_of(plot);
  REQUIRE(layout.bands.size() == 1);
  REQUIRE(layout.bands[0].lower_upper.size() == 2);
  const auto& [lower, upper] = layout.bands[0].lower_upper[0];
  REQUIRE(lower.size() == 2);
  CHECK(upper[1][1] == Approx(layout.y.pixel(4)));
  CHECK(lower[1][1] == Approx(layout.y.pixel(2)));
  REQUIRE(layout.legend.size() == 1);
  CHECK(layout.legend[0].of == PlotLegendEntry::Of::band);
  CHECK(layout.legend[0].name == "range");
  PlotLook hidden;
  hidden.hidden.insert("range");
  CHECK(layout_of(plot, hidden).bands.empty());
  CHECK(layout_of(plot, hidden).legend.size() == 1);
}

TEST_CASE("a band is read between its points, and not where it is broken") {
  const Plot plot = banded();
  const PlotLayout layout = layout_of(plot);
  const auto at = bands_at(plot, {}, layout, 0.5, 0);
  REQUIRE(at.size() == 1);
  CHECK(at[0].lower == Approx(1.5));
  CHECK(at[0].upper == Approx(3));
  CHECK(bands_at(plot, {}, layout, 1.5, 0).empty());
  CHECK(readings_at(plot, {}, layout, 0.5, 0).empty());
  CHECK_FALSE(nearest_along(plot, {}, layout, 100, 100)); // nothing is dragged along its edges
}

TEST_CASE("a label keeps off the edges of a band, which its ground would cover") {
  Plot plot;
  plot.x.range = PlotRange{0, 4};
  plot.y.range = PlotRange{0, 5};
  plot.bands.push_back({"range", {{0, 1, 3}, {4, 1, 3}}});
  plot.marks.push_back({{2, 2.9}, "fold"});
  const PlotLayout layout = layout_of(plot);
  REQUIRE(layout.marks.size() == 1);
  REQUIRE(layout.marks[0].label);
  const PlotBox& box = layout.marks[0].label->box;
  const double edge = layout.y.pixel(3);
  CHECK((box.bottom < edge || box.top > edge));
  CHECK_FALSE(layout.marks[0].label->backed);
}

TEST_CASE("on a logarithmic axis bars stand on the frame") {
  Plot plot = banded();
  plot.y.logarithmic = true;
  plot.bands[0].points = {{0, 0, 10}, {1, 0, 100}};
  const PlotLayout layout = layout_of(plot);
  REQUIRE(layout.bands[0].lower_upper.size() == 1);
  CHECK(layout.bands[0].lower_upper[0][0][0][1] == layout.area.bottom);
}

TEST_CASE("both ends of a band are in the table, and its ground in the picture") {
  const Plot plot = banded();
  const std::string table = to_csv(plot);
  CHECK_THAT(table, ContainsSubstring("\"range, from\",1,2\r\n"));
  CHECK_THAT(table, ContainsSubstring("\"range, to\",1,4\r\n"));
  CHECK_THAT(to_svg(plot), ContainsSubstring("fill-opacity=\"0.22\""));
}

TEST_CASE("a histogram holds each sample once, and the normal curve as many") {
  SpreadAnswer answer;
  answer.nominal = {0};
  answer.samples = 1000;
  const std::vector<Tolerance> tolerances{{"a", Distribution::normal, 2}};
  std::vector<double> values, followed;
  for (std::size_t i = 0; i < answer.samples; ++i) {
    const double value = sampled_numbers(answer.nominal, tolerances, 1, i)[0];
    answer.fate.push_back(i % 10 == 0   ? SampleFate::elsewhere
                          : i % 10 == 1 ? SampleFate::none
                                        : SampleFate::followed);
    values.push_back(i % 10 == 0 ? 50 + value : i % 10 == 1 ? nothing : value);
  }
  answer.values = {values};
  SpreadOutput slide;
  slide.name = "slide";
  slide.unit = "m";
  slide.linear_deviation = 2;
  slide.linear_shares = {1};
  answer.outputs = {slide};
  add_statistics(tolerances, 1, answer);
  const Plot plot = histogram_plot(answer, 0);
  REQUIRE(plot.bands.size() == 2);
  const auto count = [](const PlotBand& band) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < band.points.size(); i += 2)
      sum += band.points[i][2];
    return sum;
  };
  CHECK(count(plot.bands[0]) == 800);
  CHECK(plot.bands[1].name == "in another steady state");
  CHECK(count(plot.bands[1]) == 100);
  REQUIRE(plot.curves.size() == 1);
  const double width = plot.bands[0].points[2][0] - plot.bands[0].points[1][0];
  double area = 0;
  const auto& curve = plot.curves[0].points;
  for (std::size_t i = 1; i < curve.size(); ++i)
    area += (curve[i][0] - curve[i - 1][0]) * (curve[i][1] + curve[i - 1][1]) / 2;
  CHECK(area / width == Approx(800).epsilon(1e-3));
  CHECK(spread_csv(answer, tolerances, 1).starts_with("a,fate,slide\n"));
  answer.outputs[0].name = "fate"; // as a joint may be called
  CHECK(spread_csv(answer, tolerances, 1).starts_with("a,fate,fate_\n"));

  SECTION("samples that are alike but for rounding have one bar as wide as those of the others") {
    for (std::size_t i = 0; i < 1000; ++i)
      if (answer.fate[i] == SampleFate::followed) answer.values[0][i] *= 1e-17;
    answer.counts = {};
    add_statistics(tolerances, 1, answer);
    answer.outputs[0].linear_deviation = 1e-17;
    const Plot narrow = histogram_plot(answer, 0);
    REQUIRE(narrow.bands.size() == 2);
    CHECK(narrow.bands[0].points.size() == 4);
    CHECK(count(narrow.bands[0]) == 800);
    const auto& others = narrow.bands[1].points;
    const auto& bar = narrow.bands[0].points;
    CHECK(bar[2][0] - bar[1][0] == Approx(others[2][0] - others[1][0]));
    CHECK((bar[1][0] + bar[2][0]) / 2 == Approx(0).margin(1e-12));
    CHECK(narrow.curves.empty());
  }
  SECTION("samples that are all alike stand at one value, to which no width is given") {
    for (double& value : answer.values[0])
      value = 3;
    answer.fate.assign(1000, SampleFate::followed);
    answer.counts = {};
    add_statistics(tolerances, 1, answer);
    const Plot flat = histogram_plot(answer, 0);
    CHECK(flat.bands.empty());
    REQUIRE(flat.curves.size() == 1);
    CHECK(flat.curves[0].points[0] == std::array<double, 2>{3, 0});
    CHECK(flat.curves[0].points[1] == std::array<double, 2>{3, 1000});
  }
}

TEST_CASE("a ribbon of friction that several branches share is drawn once") {
  const auto point = [](double number, double low, double high, bool folds, bool meets = false) {
    RibbonPoint out{.number = number, .extents = {}, .folds = folds, .meets = meets};
    out.extents.push_back({"x", "m", high, low, high, {}, {}, {}, !folds, {}, {}});
    return out;
  };
  // Up to 2 the band is that of both branches.
  const std::vector<RibbonPoint> upper{point(0, -1, 1, true), point(1, -1.2, 1.2, true),
                                       point(2, -1.4, 1.4, true), point(2, 1, 1.4, false, true),
                                       point(3, 1.5, 1.6, false)},
      lower{point(0.5, -1.1, 1.1, true), point(1.5, -1.3, 1.3, true), point(2, -1.4, 1.4, true),
            point(2, -1.4, -1, false, true), point(3, -1.6, -1.5, false)};
  Plot plot;
  add_ribbon(plot, upper, "x");
  add_ribbon(plot, lower, "x");
  REQUIRE(plot.bands.size() == 3);
  CHECK(plot.bands[0].points ==
        std::vector<std::array<double, 3>>{{0, -1, 1}, {1, -1.2, 1.2}, {2, -1.4, 1.4}});
  CHECK(plot.bands[1].points == std::vector<std::array<double, 3>>{{2, 1, 1.4}, {3, 1.5, 1.6}});
  CHECK(plot.bands[2].points == std::vector<std::array<double, 3>>{{2, -1.4, -1}, {3, -1.6, -1.5}});
  // A slow change is known along each branch by itself alone.
  CHECK(std::ranges::count(plot.curves, "slow rise and fall", &PlotCurve::name) == 2);
  CHECK(std::ranges::count(plot.curves, "edge as it rises", &PlotCurve::name) == 3);
  // None of another name.
  add_ribbon(plot, upper, "y");
  CHECK(plot.bands.size() == 3);
}

TEST_CASE("a ribbon that two branches share is drawn once, though they know differently where it ends") {
  const auto ribbon = [](const std::vector<double>& numbers) {
    std::vector<RibbonPoint> out;
    for (const double number : numbers) {
      RibbonPoint point{.number = number, .extents = {}, .folds = true};
      const double half = std::sqrt(0.3 + number); // bends between the points of either
      point.extents.push_back({"x", "m", 0, -half, half, {}, {}, {}, false, {}, {}});
      out.push_back(std::move(point));
    }
    return out;
  };
  Plot plot;
  add_ribbon(plot, ribbon({0, 0.3, 0.6, 0.9, 0.999}), "x");
  REQUIRE(plot.bands.size() == 1);
  add_ribbon(plot, ribbon({0.1, 0.45, 0.75, 1.005}), "x");
  CHECK(plot.bands.size() == 1);
  // Beyond that it is another's, up to which it is not drawn again.
  add_ribbon(plot, ribbon({0.5, 0.75, 1.2, 1.5}), "x");
  REQUIRE(plot.bands.size() == 2);
  CHECK(plot.bands[1].points.front()[0] == Approx(0.999).margin(1e-4));
}

TEST_CASE("a ribbon has edges where a slow change follows them") {
  const auto point = [](double number, bool low, bool high) {
    RibbonPoint out{.number = number, .extents = {}};
    out.extents.push_back({"x", "m", 0, -1, 1, {}, {}, {}, true, low, high});
    return out;
  };
  const auto edges = [](const Plot& plot, std::string_view name) {
    int points = 0;
    for (const PlotCurve& curve : plot.curves)
      if (curve.name == name)
        points += static_cast<int>(
            std::ranges::count_if(curve.points, [](const auto& p) { return std::isfinite(p[1]); }));
    return points;
  };
  const std::vector<RibbonPoint> unstable{point(0, false, false), point(1, false, false),
                                          point(2, false, false)};
  Plot plot;
  add_ribbon(plot, unstable, "x");
  REQUIRE(plot.bands.size() == 1);
  CHECK(plot.bands[0].points.size() == 3);
  CHECK(plot.curves.empty());
  // Beyond the fold of a tip it stands on the one edge, and runs away over the other.
  const std::vector<RibbonPoint> tip{point(0, true, true), point(1, true, true), point(2, true, false),
                                     point(3, true, false)};
  plot = {};
  add_ribbon(plot, tip, "x");
  CHECK(edges(plot, "edge as it rises") == 4);
  CHECK(edges(plot, "edge as it falls") == 2);
  REQUIRE(std::ranges::count(plot.curves, "slow rise and fall", &PlotCurve::name) == 1);
  const auto way = std::ranges::find(plot.curves, "slow rise and fall", &PlotCurve::name);
  for (const auto& [number, value] : way->points)
    CHECK(number <= 1);
}

TEST_CASE("what friction does not bound breaks a ribbon") {
  std::vector<RibbonPoint> points;
  for (int i = 0; i < 5; ++i) {
    RibbonPoint point{.number = static_cast<double>(i), .extents = {}};
    const double high = i == 2 ? std::numeric_limits<double>::infinity() : 1;
    point.extents.push_back({"x", "m", 0, -1, high, {}, {}, {}, false, {}, {}});
    point.extents.push_back({"height", "m", 0, -2, 2, {}, {}, {}, false, {}, {}});
    points.push_back(std::move(point));
  }
  Plot plot;
  plot.x.room = plot.y.room = 0;
  add_ribbon(plot, points, "x");
  CHECK(axis_range(plot, {}, 1) == PlotRange{-1, 1});
  REQUIRE(layout_of(plot).bands.size() == 1);
  CHECK(layout_of(plot).bands[0].lower_upper.size() == 2);
  plot = {};
  add_ribbon(plot, points, "height");
  REQUIRE(layout_of(plot).bands.size() == 1);
  CHECK(layout_of(plot).bands[0].lower_upper.size() == 1);
}
