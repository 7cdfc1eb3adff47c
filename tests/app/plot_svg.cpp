// Plots as SVG and CSV.
#include "tests/catch.hpp"

#include "app/plot/csv.hpp"
#include "app/plot/svg.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

using namespace flyball;

namespace {

// Whether every element is closed in order, every attribute quoted and every entity known.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  std::size_t i = 0;
  int roots = 0;
  while (i < xml.size()) {
    if (xml[i] == '&') {
      bool known = false;
      for (const char* entity : {"&amp;", "&lt;", "&gt;", "&quot;"})
        known = known || xml.compare(i, std::string(entity).size(), entity) == 0;
      if (!known) return false;
    }
    if (static_cast<unsigned char>(xml[i]) < 0x20 && xml[i] != '\n' && xml[i] != '\t') return false;
    if (xml[i] != '<') {
      ++i;
      continue;
    }
    bool quoted = false;
    std::size_t end = i + 1;
    for (; end < xml.size() && (quoted || xml[end] != '>'); ++end) {
      if (xml[end] == '"') quoted = !quoted;
      if (xml[end] == '<') return false;
    }
    if (end == xml.size() || quoted) return false;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag.front() == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      roots += open.empty();
      open.push_back(name);
    }
    i = end + 1;
  }
  return open.empty() && roots == 1;
}

Plot every_kind() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Plot plot;
  plot.title = "a < b & \"c\"\x01";
  plot.x = {.label = "speed", .unit = "rad/s"};
  plot.y = {.label = "angle", .unit = "rad"};
  plot.curves = {{"stable", {{0, 1}, {1, nan}, {2, 3}, {3, 3}}, PlotLine::solid, 0},
                 {"", {{0, 0}, {2, 2}}, PlotLine::dashed, 1}};
  for (PlotShape shape : {PlotShape::circle, PlotShape::square, PlotShape::triangle, PlotShape::diamond,
                          PlotShape::cross, PlotShape::plus})
    plot.curves.push_back(
        {.name = "<marks>", .points = {{1, 1}, {2, 1}}, .line = PlotLine::none, .shape = shape});
  plot.references = {{1, 2, "steady & still"}, {0, 1, "rated"}};
  plot.marks = {{{2, 3}, "fold"}, {{nan, 0}, "lost"}};
  plot.marker = PlotMarker{1, 1, "now"};
  return plot;
}

std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1);
  rows.back().emplace_back();
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      rows.back().back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\r') {
      REQUIRE(text[++i] == '\n');
      if (i + 1 < text.size()) rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  return rows;
}

} // namespace

TEST_CASE("an SVG has every curve, dashes, marks and labels, and no number that is not one", "[plot]") {
  const std::string svg = to_svg(every_kind());
  CHECK(well_formed(svg));
  CHECK(svg.find("a &lt; b &amp; &quot;c&quot;") != std::string::npos);
  CHECK(svg.find("stroke-dasharray=\"7 5\"") != std::string::npos);
  CHECK(svg.find(">fold<") != std::string::npos);
  CHECK(svg.find(">steady &amp; still<") != std::string::npos);
  CHECK(svg.find(">now<") != std::string::npos);
  CHECK(svg.find("lost") == std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  CHECK(svg.find("speed [rad/s]") != std::string::npos);
  CHECK(to_svg(every_kind(), {.font = "\"Latin Modern\", serif"}).find("&quot;Latin Modern&quot;") !=
        std::string::npos);
  CHECK(to_svg(every_kind(), {}, {.hidden = {"stable"}}) != svg);
}

TEST_CASE("SVG is well-formed for empty, tiny, dark and heat plots", "[plot]") {
  CHECK(well_formed(to_svg(Plot{})));
  CHECK(well_formed(to_svg(every_kind(), {.width = 10, .height = 10})));
  Plot plot;
  plot.heat = PlotHeat{{0, 1}, {0, 1}, {1, 2, 3, NAN}, "collar <h>", "m"};
  const std::string svg = to_svg(plot, {.ground = PlotGround::dark});
  CHECK(well_formed(svg));
  CHECK(svg.find("collar &lt;h&gt; [m]") != std::string::npos);
  CHECK(svg.find("linearGradient") != std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
  // Several in one page have ids of their own.
  const std::string named = to_svg(plot, {.prefix = "one-"});
  CHECK(named.find("id=\"one-area\"") != std::string::npos);
  CHECK(named.find("url(#one-area)") != std::string::npos);
  CHECK(named.find("id=\"one-bar\"") != std::string::npos);
  CHECK(named.find("url(#one-bar)") != std::string::npos);
}

TEST_CASE("an SVG of a million points is small", "[plot]") {
  Plot plot;
  plot.curves.emplace_back();
  for (int i = 0; i < 1'000'000; ++i)
    plot.curves[0].points.push_back({i * 1e-5, std::sin(i * 0.3) * std::sin(i * 1e-5)});
  CHECK(to_svg(plot).size() < 100'000);
}

TEST_CASE("numbers in CSV read back exactly, whatever the names", "[plot]") {
  Plot plot = every_kind();
  plot.curves = {{"a, \"b\"\nc", {{0.1, 1. / 3}, {1e-300, -1.7976931348623157e308}, {NAN, 2}}},
                 {"", {{4.9e-324, -0.45377171949723583}}}};
  const auto rows = read_csv(to_csv(plot));
  REQUIRE(rows.size() == 7);
  CHECK(rows[0] == std::vector<std::string>{"curve", "speed [rad/s]", "angle [rad]"});
  CHECK(rows[1][0] == "a, \"b\"\nc");
  CHECK(std::strtod(rows[1][2].c_str(), nullptr) == 1. / 3);
  CHECK(std::strtod(rows[2][1].c_str(), nullptr) == 1e-300);
  CHECK(std::strtod(rows[2][2].c_str(), nullptr) == -1.7976931348623157e308);
  CHECK(rows[3][1].empty());
  CHECK(rows[4][0] == "angle"); // what has no name is what the axis says
  CHECK(std::strtod(rows[4][1].c_str(), nullptr) == 4.9e-324);
  CHECK(std::strtod(rows[4][2].c_str(), nullptr) == -0.45377171949723583);
  CHECK(rows[5][0] == "fold");
  CHECK(read_csv(to_csv(plot, {.hidden = {""}})).size() == 6);
}

TEST_CASE("a heat map in CSV has its values in a fourth column", "[plot]") {
  Plot plot;
  plot.curves = {{"line", {{1, 2}}}};
  plot.heat = PlotHeat{{0, 1}, {5}, {7.5, NAN}, "collar", "m"};
  const auto rows = read_csv(to_csv(plot));
  REQUIRE(rows.size() == 4);
  for (const auto& row : rows)
    CHECK(row.size() == 4);
  CHECK(rows[0][3] == "collar [m]");
  CHECK(rows[2] == std::vector<std::string>{"map", "0", "5", "7.5"});
  CHECK(rows[3][3].empty());
}
