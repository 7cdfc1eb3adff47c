// Axes: round ticks with labels that say what they are, and ranges that can be drawn.
#include "tests/catch.hpp"

#include "app/plot/axis.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

using namespace flyball;

namespace {

// What a label says: "−2.5×10⁻⁷" is -2.5e-7.
double read_label(std::string text) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from))
      text.replace(at, from.size(), to);
  };
  replace("×10", "e");
  if (text.starts_with("10⁻") || text.starts_with("10⁰") || text.starts_with("10¹") ||
      text.starts_with("10²") || text.starts_with("10³") || text.starts_with("10⁴") ||
      text.starts_with("10⁵") || text.starts_with("10⁶") || text.starts_with("10⁷") ||
      text.starts_with("10⁸") || text.starts_with("10⁹"))
    text = "1e" + text.substr(2);
  replace("−", "-");
  replace("⁻", "-");
  const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  for (int i = 0; i < 10; ++i)
    replace(digits[i], std::to_string(i));
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  INFO("label " << text);
  CHECK(*end == '\0');
  return value;
}

} // namespace

TEST_CASE("ticks are round, in range, and about as many as wanted", "[plot]") {
  for (double lower : {-3.7e-5, -1.0, 0.0, 0.013, 4.9e7})
    for (double width : {1e-6, 0.37, 1.0, 25.0, 9e9}) {
      INFO(lower << " + " << width);
      const std::vector<double> ticks = axis_ticks(lower, lower + width, 8, false).major;
      if (width < 1e-9 * std::abs(lower)) continue; // closer than doubles are
      REQUIRE(ticks.size() >= 3);
      CHECK(ticks.size() <= 10);
      const double step = ticks[1] - ticks[0], power = std::pow(10., std::floor(std::log10(step) + 1e-6));
      const double factor = step / power;
      CHECK(std::min({std::abs(factor - 1), std::abs(factor - 2), std::abs(factor - 5)}) < 1e-3);
      CHECK(ticks.front() >= lower - 1e-6 * width);
      CHECK(ticks.back() <= lower + width * (1 + 1e-6));
    }
  CHECK(axis_ticks(1e-3, 1e3, 7, true).major == std::vector<double>{1e-3, 1e-2, 1e-1, 1, 10, 100, 1000});
  CHECK(axis_ticks(1, 1, 5, false).major.empty());
  CHECK(axis_ticks(-1, 1, 5, true).major.empty());
}

TEST_CASE("labels have as few digits as tell the ticks apart", "[plot]") {
  using Labels = std::vector<std::string>;
  CHECK(axis_ticks(0, 1, 5, false).labels == Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(axis_ticks(-2, 2, 4, false).labels == Labels{"−2", "−1", "0", "1", "2"});
  CHECK(axis_ticks(0, 3e-7, 3, false).labels == Labels{"0", "1×10⁻⁷", "2×10⁻⁷", "3×10⁻⁷"});
  CHECK(axis_ticks(0, 2e9, 2, false).labels == Labels{"0", "1×10⁹", "2×10⁹"});
  CHECK(axis_ticks(0.1, 100, 5, true).labels == Labels{"0.1", "1", "10", "100"});
  CHECK(axis_ticks(1e-6, 1e-4, 5, true).labels == Labels{"10⁻⁶", "10⁻⁵", "10⁻⁴"});
  CHECK(axis_ticks(2, 60, 6, true).labels == Labels{"2", "5", "10", "20", "50"});
  // Values of decimal labels are the nearest doubles, not sums of steps.
  CHECK(axis_ticks(0, 1, 10, false).major[3] == 0.3);
}

TEST_CASE("degrees are divided as turns are", "[plot]") {
  using Labels = std::vector<std::string>;
  CHECK(degree_ticks(-30, 95, 3).labels == Labels{"0", "45", "90"});
  CHECK(degree_ticks(-180, 180, 4).labels == Labels{"−180", "−90", "0", "90", "180"});
  CHECK(degree_ticks(0, 60, 4).labels == Labels{"0", "15", "30", "45", "60"});
  CHECK(degree_ticks(0, 60, 4).minor.size() == 8);
  CHECK(degree_ticks(0, 20, 5).labels == Labels{"0", "5", "10", "15", "20"});
  CHECK(degree_ticks(0, 4000, 4).labels == Labels{"0", "1000", "2000", "3000", "4000"});
  CHECK(degree_ticks(3, 3, 4).major.empty());
}

TEST_CASE("every label says its tick's value, at any range", "[plot]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-299, 299), part(-1, 1), width(-10, 3);
  for (int i = 0; i < 3000; ++i) {
    const bool logarithmic = i % 2 == 1;
    const double size = std::pow(10., exponent(random));
    double lower = part(random) * size, upper = lower + std::pow(10., width(random)) * size;
    if (logarithmic) {
      lower = size;
      upper = size * (1 + std::pow(10., width(random)));
    }
    const PlotRange range = drawable_range({lower, upper}, logarithmic);
    INFO(range[0] << " to " << range[1] << (logarithmic ? " log" : ""));
    const AxisTicks ticks = axis_ticks(range[0], range[1], 6, logarithmic);
    REQUIRE(ticks.major.size() == ticks.labels.size());
    CHECK(ticks.major.size() <= 20);
    if (!logarithmic) CHECK(ticks.major.size() >= 2);
    const double slack = 1e-6 * (range[1] - range[0]);
    for (std::size_t k = 0; k < ticks.major.size(); ++k) {
      CHECK(ticks.major[k] >= range[0] - slack);
      CHECK(ticks.major[k] <= range[1] + slack);
      CHECK(read_label(ticks.labels[k]) == Approx(ticks.major[k]).epsilon(1e-14).margin(0));
      if (k > 0) {
        CHECK(ticks.major[k] > ticks.major[k - 1]);
        CHECK(ticks.labels[k] != ticks.labels[k - 1]);
      }
    }
  }
}

TEST_CASE("ranges hold what is shown and can always be drawn", "[plot]") {
  Plot plot;
  CHECK(axis_range(plot, {}, 0) == PlotRange{0, 1});
  plot.curves = {{"a", {{0, 2}, {4, 6}, {NAN, 99}}}, {"b", {{0, 50}, {9, 60}}}};
  plot.x.room = 0;
  CHECK(axis_range(plot, {}, 0) == PlotRange{0, 9});
  CHECK(axis_range(plot, {.hidden = {"b"}}, 0) == PlotRange{0, 4});
  // The point without an x takes no room along y.
  CHECK(axis_range(plot, {.hidden = {"b"}}, 1)[1] < 7);
  plot.references = {{1, 100, "steady"}};
  CHECK(axis_range(plot, {}, 1)[1] > 100);
  plot.y.range = PlotRange{-1, 1};
  CHECK(axis_range(plot, {}, 1) == PlotRange{-1, 1});
  CHECK(axis_range(plot, {.range = {std::nullopt, PlotRange{2, 3}}}, 1) == PlotRange{2, 3});
  // A range that a logarithm cannot show gives way to the values that it can.
  const PlotLook logarithmic{.logarithmic = {std::nullopt, true}};
  CHECK(axis_range(plot, logarithmic, 1)[0] > 0);

  SECTION("rounding is drawn flat") {
    plot = {};
    plot.curves = {{"", {{0, 1e-17}, {1, -2e-17}}}};
    CHECK(axis_range(plot, {}, 1)[1] > 0.01);
    plot.y.noise = 0;
    CHECK(axis_range(plot, {}, 1)[1] < 1e-16);
  }
  SECTION("equal and extreme ends") {
    for (double value : {0., 1e-300, -1e300, 5., std::numeric_limits<double>::max()}) {
      plot = {};
      plot.curves = {{"", {{value, value}}}};
      const PlotRange range = axis_range(plot, {}, 0);
      CHECK(range[0] < range[1]);
      CHECK(std::isfinite(range[1] - range[0]));
    }
  }
}

TEST_CASE("rulers go both ways", "[plot]") {
  for (const PlotRuler& ruler : {PlotRuler{-2, 6, 100, 500, false}, PlotRuler{1e-6, 1e3, 400, 20, true}})
    for (double pixel : {100., 250., 333.}) {
      CHECK(ruler.pixel(ruler.value(pixel)) == Approx(pixel));
      const PlotRange zoomed = ruler.range_between(ruler.from, pixel);
      CHECK(zoomed[0] == Approx(ruler.lower));
      CHECK(zoomed[1] == Approx(ruler.value(pixel)));
    }
  CHECK(std::isnan(PlotRuler{1, 10, 0, 1, true}.pixel(-1)));
}

TEST_CASE("readings have a digit more than a pixel tells", "[plot]") {
  CHECK(reading_text(0.453771719, 0.01) == "0.454");
  CHECK(reading_text(0.453771719, 1e-5) == "0.453772");
  CHECK(reading_text(-12.5, 2) == "−12.5");
  CHECK(reading_text(3.2e-9, 1e-10) == "3.20e-09");
  CHECK(reading_text(NAN, 1) == "–");
}
