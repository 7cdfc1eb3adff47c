// Nothing of a plot runs into anything else, whatever is shown.
#include "tests/catch.hpp"

#include "app/plot/colors.hpp"
#include "app/plot/layout.hpp"
#include "app/plot/layout_heat.hpp"
#include "app/plot/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace flyball;

namespace {

// All that are placed.
std::vector<const PlotText*> texts_of(const PlotLayout& layout) {
  std::vector<const PlotText*> texts;
  const auto add = [&](const std::optional<PlotText>& text) {
    if (text && !text->text.empty()) texts.push_back(&*text);
  };
  add(layout.title);
  add(layout.x_label);
  add(layout.y_label);
  for (const auto* ticks : {&layout.x_ticks, &layout.y_ticks})
    for (const PlotTick& tick : *ticks)
      add(tick.label);
  for (const PlotLegendEntry& entry : layout.legend)
    texts.push_back(&entry.text);
  if (layout.bar) {
    for (const PlotTick& tick : layout.bar->ticks)
      add(tick.label);
    add(layout.bar->label);
  }
  for (const auto* placed : {&layout.references, &layout.marks})
    for (const PlotPlaced& p : *placed)
      add(p.label);
  return texts;
}

void check_apart(const PlotLayout& layout) {
  const std::vector<const PlotText*> texts = texts_of(layout);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const PlotBox& box = texts[i]->box;
    INFO(texts[i]->text);
    CHECK(box.left >= -0.5);
    CHECK(box.top >= -0.5);
    CHECK(box.right <= layout.width + 0.5);
    CHECK(box.bottom <= layout.height + 0.5);
    for (std::size_t k = 0; k < i; ++k) {
      INFO("and " << texts[k]->text);
      CHECK_FALSE(box.overlaps(texts[k]->box));
    }
  }
  for (const PlotPlaced& mark : layout.marks)
    if (mark.label)
      for (const PlotPlaced& other : layout.marks)
        CHECK_FALSE(mark.label->box.grown(-1).contains(other.x, other.y));
  for (const PlotCurveLines& curve : layout.curves)
    for (const PixelLine& line : curve.lines)
      for (const PixelPoint& p : line)
        CHECK(layout.area.grown(20).contains(p[0], p[1]));
}

Plot random_plot(std::mt19937_64& random, bool extreme) {
  std::uniform_real_distribution<double> part(-1, 1), exponent(extreme ? -299 : -6, extreme ? 299 : 6);
  const auto value = [&](double size) { return part(random) * size; };
  Plot plot;
  plot.title = "A title of some length";
  plot.x = {.label = "abscissa", .unit = "rad/s", .logarithmic = random() % 3 == 0};
  plot.y = {.label = "ordinate", .unit = "m", .logarithmic = random() % 3 == 0};
  const double wide = std::pow(10., exponent(random)), high = std::pow(10., exponent(random));
  const double far = random() % 4 == 0 ? wide * 1e6 : 0;
  for (std::size_t c = 0; c < random() % 5; ++c) {
    PlotCurve curve;
    curve.name = "curve " + std::to_string(c);
    for (std::size_t i = 0; i < 1 + random() % 40; ++i)
      curve.points.push_back({far + value(wide), random() % 20 == 0 ? NAN : value(high)});
    plot.curves.push_back(std::move(curve));
  }
  for (std::size_t m = 0; m < random() % 6; ++m)
    plot.marks.push_back({{far + value(wide), value(high)}, "fold " + std::to_string(m)});
  if (random() % 2) plot.references = {{1, value(high), "steady value"}, {0, far + value(wide), "rated"}};
  return plot;
}

} // namespace

TEST_CASE("texts never overlap and stay in the picture", "[plot]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> width(60, 1400), height(50, 900), scale(1, 3);
  for (int i = 0; i < 400; ++i) {
    PlotMetrics metrics;
    metrics.scale = i % 2 ? 1 : scale(random);
    for (double& line : metrics.height)
      line *= metrics.scale;
    const Plot plot = random_plot(random, i % 3 == 0);
    INFO("case " << i);
    check_apart(plot_layout(plot, {}, width(random), height(random), metrics));
  }
}

TEST_CASE("an ordinary picture has ticks on both axes, and all its labels", "[plot]") {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    Plot plot = random_plot(random, i % 2);
    INFO("case " << i);
    const PlotLayout layout = plot_layout(plot, {}, 700, 460, {});
    REQUIRE(layout.drawable());
    for (const auto* ticks : {&layout.x_ticks, &layout.y_ticks}) {
      int labelled = 0;
      for (const PlotTick& tick : *ticks)
        labelled += tick.label.has_value();
      CHECK(labelled >= 2);
    }
    CHECK(layout.title);
    CHECK(layout.x_label->text == "abscissa [rad/s]");
    CHECK(layout.y_label->upright);
    CHECK(layout.legend.size() == plot.curves.size());
  }
}

TEST_CASE("a low plot has numbers on its axes, and its units inside the frame", "[plot]") {
  int inside = 0;
  for (const PlotRange range : {PlotRange{0.05, 0.45}, {0.083, 0.47}, {-3e-8, 4e-8}, {35.2, 39.4}, {0, 300}})
    for (double height = 70; height < 200; height += 1) {
      Plot plot;
      plot.x = {.label = "time", .unit = "s", .room = 0};
      plot.y = {.label = "lift of the sleeve", .unit = "m", .range = range};
      plot.curves = {{"", {{0, range[0]}, {10, range[1]}}}};
      plot.marks = {{{5, (range[0] + range[1]) / 2}, "fold"}};
      const PlotLayout layout = plot_layout(plot, {}, 400, height, {});
      INFO(range[0] << " to " << range[1] << ", " << height);
      if (layout.area.height() < 42) continue;
      check_apart(layout);
      const auto numbers =
          std::ranges::count_if(layout.y_ticks, [](const PlotTick& t) { return t.label.has_value(); });
      CHECK(numbers >= (layout.area.height() < 82 ? 1 : 2));
      REQUIRE(layout.y_label);
      REQUIRE(layout.x_label);
      CHECK_THAT(layout.y_label->text, Catch::Matchers::EndsWith("[m]"));
      CHECK(layout.x_label->text == "time [s]");
      const PlotBox& box = layout.y_label->box;
      if (!layout.area.contains(box.left, box.top)) continue;
      ++inside;
      CHECK(layout.area.contains(box.right, box.bottom));
      CHECK(layout.area.contains(layout.x_label->box.right, layout.x_label->box.bottom));
      CHECK(layout.y_label->backed);
    }
  CHECK(inside > 20);
}

TEST_CASE("the label of a narrow frame is whole while the picture has room for it", "[plot]") {
  Plot plot;
  plot.x = {.label = "real part of the eigenvalue", .unit = "1/s"};
  plot.y = {.label = "imaginary part", .unit = "rad/s"};
  plot.curves = {{"", {{-50, -200}, {0, 200}}}};
  const std::string whole = axis_text(plot.x.label, plot.x.unit);
  const PlotMetrics metrics;
  const double width = metrics.width_of(PlotFont::words, whole);
  for (double wide = width + 12; wide < 500; wide += 7) {
    const PlotLayout layout = plot_layout(plot, {}, wide, 300, metrics);
    INFO(wide);
    check_apart(layout);
    REQUIRE(layout.x_label);
    CHECK(layout.x_label->text == whole);
  }
}

TEST_CASE("a plot of nothing and a picture of no size are laid out", "[plot]") {
  CHECK(plot_layout(Plot{}, {}, 400, 300, {}).drawable());
  CHECK_FALSE(plot_layout(Plot{}, {}, 5, 5, {}).drawable());
  Plot plot;
  plot.curves = {{"none", {}}, {"gap", {{NAN, 1}, {1, INFINITY}}}};
  plot.heat = PlotHeat{};
  const PlotLayout layout = plot_layout(plot, {}, 400, 300, {});
  CHECK(layout.cells.empty());
  for (const PlotCurveLines& curve : layout.curves)
    CHECK(curve.lines.empty());
}

TEST_CASE("the legend has a name once, and hidden curves are not drawn", "[plot]") {
  Plot plot;
  plot.curves = {{"stable", {{0, 0}, {1, 1}}}, {"", {{0, 1}, {1, 0}}}, {"stable", {{1, 1}, {2, 2}}}};
  plot.curves.push_back({.name = "secret", .points = {{0, 0}, {9, 9}}, .hidden = true});
  PlotLayout layout = plot_layout(plot, {}, 400, 300, {});
  REQUIRE(layout.legend.size() == 1);
  CHECK(layout.legend[0].name == "stable");
  CHECK(layout.curves.size() == 3);
  layout = plot_layout(plot, {.hidden = {"stable"}}, 400, 300, {});
  CHECK(layout.legend.size() == 1);
  REQUIRE(layout.curves.size() == 1);
  CHECK(layout.curves[0].curve == 1);
}

TEST_CASE("a million points become few, and no extreme is lost", "[plot]") {
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i < 1'000'000; ++i)
    points.push_back({i * 1e-6, std::sin(i * 0.01)});
  points[123'456][1] = 7;
  points[654'321][1] = -5;
  const PlotRuler x{0, 1, 0, 800, false}, y{-10, 10, 600, 0, false};
  const auto lines = visible_lines(points, x, y, {0, 0, 800, 600});
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].size() <= 4 * 801);
  double low = 600, high = 0;
  for (const PixelPoint& p : lines[0]) {
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  CHECK(low == Approx(y.pixel(7)));
  CHECK(high == Approx(y.pixel(-5)));
  CHECK(visible_points(points, x, y, {0, 0, 800, 600}).size() < 100'000);
}

TEST_CASE("lines are broken at gaps and cut at the frame", "[plot]") {
  const PlotRuler unit{0, 100, 0, 100, false};
  const PlotBox box{0, 0, 100, 100};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto lines = [&](std::vector<std::array<double, 2>> points) {
    return visible_lines(points, unit, unit, box);
  };
  CHECK(lines({{10, 10}, {20, 20}, {nan, 30}, {40, 40}, {50, 50}}).size() == 2);
  // Through the box and far beyond: only what is inside, on the same line.
  const auto crossing = lines({{-1e9, 50}, {1e9, 50}});
  REQUIRE(crossing.size() == 1);
  CHECK(crossing[0].front()[0] == Approx(0).margin(1e-6));
  CHECK(crossing[0].back()[0] == Approx(100));
  CHECK(crossing[0].back()[1] == Approx(50));
  // Out at the top and in again: two pieces.
  CHECK(lines({{10, 50}, {30, 150}, {50, 50}}).size() == 2);
  CHECK(lines({{-10, -10}, {-20, 50}}).empty());
}

TEST_CASE("dashes have the lengths that were asked for, around corners", "[plot]") {
  const PixelLine line = {{0, 0}, {10, 0}, {10, 10}};
  const auto strokes = dashes(line, 7, 5);
  REQUIRE(strokes.size() == 2);
  CHECK(strokes[0].back()[0] == Approx(7));
  CHECK(strokes[1].front()[1] == Approx(2));
  CHECK(strokes[1].back()[1] == Approx(9));
}

TEST_CASE("what is near the pointer is found", "[plot]") {
  Plot plot;
  plot.curves = {{"a", {{0, 0}, {5, 5}, {10, 0}}}, {"b", {{0, 8}, {10, 8}}}};
  const PlotLayout layout = plot_layout(plot, {}, 500, 400, {});
  const double x = layout.x.pixel(5), y = layout.y.pixel(5);
  const auto point = nearest_point(plot, {}, layout, x + 3, y - 2, 9);
  REQUIRE(point);
  CHECK(point->curve == 0);
  CHECK(point->index == 1);
  CHECK_FALSE(nearest_point(plot, {}, layout, x + 30, y - 2, 9));
  const auto along = nearest_along(plot, {.hidden = {"b"}}, layout, layout.x.pixel(2.5), layout.y.pixel(2.5));
  REQUIRE(along);
  CHECK(along->index == Approx(0.5));
  CHECK(along->y == Approx(2.5));
  const auto readings = readings_at(plot, {}, layout, 7.5, 0);
  REQUIRE(readings.size() == 2);
  CHECK(readings[0].y == Approx(2.5));
  CHECK(readings[1].y == Approx(8));
}

TEST_CASE("curves without a name, and names for which the legend has no room, are read", "[plot]") {
  Plot plot;
  plot.curves = {{"", {{0, 0}, {10, 10}}}, {"named", {{0, 5}, {10, 5}}}};
  for (const double height : {400., 70.}) {
    const PlotLayout layout = plot_layout(plot, {}, 300, height, {});
    REQUIRE(layout.legend.empty() == (height < 100));
    const auto readings = readings_at(plot, {}, layout, 2, 0);
    REQUIRE(readings.size() == 2);
    CHECK(readings[0].curve == 0);
    CHECK(readings[0].y == Approx(2));
    CHECK(readings[1].y == Approx(5));
    CHECK(readings_at(plot, {.hidden = {"named"}}, layout, 2, 0).size() == 1);
  }
}

TEST_CASE("what goes along with a curve is read between its points", "[plot]") {
  Plot plot;
  plot.curves = {{.name = "boundary", .points = {{0, 1}, {10, 3}, {20, 3}}}};
  plot.curves[0].along = PlotAlong{"hunts at", "Hz", {2, 6, 7}};
  const PlotLayout layout = plot_layout(plot, {}, 400, 300, {});
  const auto readings = readings_at(plot, {}, layout, 2.5, 0);
  REQUIRE(readings.size() == 1);
  CHECK(readings[0].y == Approx(1.5));
  REQUIRE(readings[0].along);
  CHECK((*readings[0].along)[0] == Approx(3));
  CHECK((*readings[0].along)[1] == 4); // apart
  CHECK((*readings_at(plot, {}, layout, 20, 0)[0].along)[0] == Approx(7));
}

TEST_CASE("a plot begins and ends where it is told to, as another above it does", "[plot]") {
  Plot plot;
  plot.y = {.label = "gain", .unit = "dB"};
  plot.curves = {{"", {{0, 0}, {10, 1}}}};
  const PlotLayout own = plot_layout(plot, {}, 500, 200, {});
  CHECK(own.area.left == std::round(own.own_sides.left));
  CHECK(own.area.right == std::round(500 - own.own_sides.right));
  const PlotLayout told =
      plot_layout(plot, {}, 500, 200, {}, {own.own_sides.left + 20, own.own_sides.right + 7});
  CHECK(told.area.left == own.area.left + 20);
  CHECK(told.area.right == own.area.right - 7);
  CHECK(told.own_sides == own.own_sides);
  check_apart(told);
  CHECK(plot_layout(plot, {}, 500, 200, {}, {1, 1}).area.left == own.area.left);
}

TEST_CASE("a folded curve is read where the pointer is", "[plot]") {
  Plot plot;
  plot.curves = {{"a", {{0, 0}, {10, 1}, {0, 2}}}};
  const PlotLayout layout = plot_layout(plot, {}, 500, 400, {});
  CHECK(readings_at(plot, {}, layout, 5, layout.y.pixel(0))[0].y == Approx(0.5));
  CHECK(readings_at(plot, {}, layout, 5, layout.y.pixel(2))[0].y == Approx(1.5));
}

TEST_CASE("a heat map's cells reach halfway, and holes stay free", "[plot]") {
  Plot plot;
  plot.y.logarithmic = true;
  plot.heat = PlotHeat{{0, 1, 2}, {1, 100}, {0, 1, 2, 3, NAN, 5}, "angle", "rad"};
  const PlotLayout layout = plot_layout(plot, {}, 500, 400, {});
  CHECK(layout.x.lower == -0.5);
  CHECK(layout.x.upper == 2.5);
  CHECK(layout.y.lower == Approx(0.1));
  CHECK(layout.y.upper == Approx(1000));
  CHECK(layout.cells.size() == 5);
  REQUIRE(layout.bar);
  CHECK(layout.bar->label->text == "angle [rad]");
  CHECK(layout.bar->box.left > layout.area.right);
  CHECK(heat_cell(*plot.heat, 1.6, 20, false, true) == std::array<std::size_t, 2>{2, 1});
  CHECK_FALSE(heat_cell(*plot.heat, 9, 20, false, true));
  check_apart(layout);
}

TEST_CASE("the heat map's colours rise evenly in lightness", "[plot]") {
  // CIE lightness of sRGB.
  const auto lightness = [](std::uint32_t color) {
    double luminance = 0;
    const double weight[3] = {0.2126, 0.7152, 0.0722};
    for (int channel = 0; channel < 3; ++channel) {
      const double c = ((color >> (16 - 8 * channel)) & 255) / 255.;
      luminance += weight[channel] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return 116 * std::cbrt(luminance) - 16;
  };
  const double first = lightness(heat_color(0)), last = lightness(heat_color(1));
  CHECK(last - first > 70);
  for (int i = 0; i <= 20; ++i)
    CHECK(lightness(heat_color(i / 20.)) == Approx(first + (last - first) * i / 20.).margin(2.5));
}

TEST_CASE(
    "a reference line that is told in the legend has no label among the curves, and is switched off there") {
  Plot plot;
  plot.curves.push_back({.name = "damped", .points = {{0, 0}, {4, 1}}});
  plot.references.push_back({.axis = 1, .at = 0.5, .label = "steady", .in_legend = true});
  const PlotLayout layout = plot_layout(plot, {}, 400, 300, {});
  REQUIRE(layout.legend.size() == 2);
  CHECK(layout.legend[1].name == "steady");
  CHECK(legend_line(plot, layout.legend[1]).line == PlotLine::dashed);
  REQUIRE(layout.references.size() == 1);
  CHECK_FALSE(layout.references[0].label);
  PlotLook without;
  without.hidden = {"steady"};
  const PlotLayout off = plot_layout(plot, without, 400, 300, {});
  CHECK(off.references.empty());
  CHECK(off.legend.size() == 2); // to bring it back
}

TEST_CASE("a label that curves cross has a ground of its own") {
  Plot plot;
  PlotCurve fast; // fills everything
  for (int i = 0; i <= 400; ++i)
    fast.points.push_back({i * 0.01, i % 2 == 0 ? -1. : 1.});
  plot.references.push_back({.axis = 1, .at = 0, .label = "steady"});
  const auto label = [&] {
    const PlotLayout layout = plot_layout(plot, {}, 400, 300, {});
    REQUIRE(layout.references.size() == 1);
    REQUIRE(layout.references[0].label);
    return *layout.references[0].label;
  };
  plot.x.range = PlotRange{0, 4};
  plot.y.range = PlotRange{-1, 1};
  CHECK_FALSE(label().backed);
  plot.curves.push_back(fast);
  CHECK(label().backed);
}
