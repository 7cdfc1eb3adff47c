// A two-dimensional plot as a value: what is drawn, not how. See layout.hpp for where things come to lie,
// svg.hpp and csv.hpp for files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flyball {

using PlotRange = std::array<double, 2>;

struct PlotAxis {
  std::string label; // "spin speed"
  std::string unit;  // "rad/s"; may be empty
  bool logarithmic = false;
  std::optional<PlotRange> range{}; // fixed; otherwise all that is there
  double room = 0.04;               // of the range, left free at either end; time axes want 0
  double noise = 1e-15;             // a narrower linear range is rounding and drawn flat
  bool whole = false;               // counts something: its values are told as whole numbers
  // CSV files are in SI units: what `unit` is then, where it is another, and how many of `unit` make one.
  std::string si_unit{};
  double factor = 1;
};

enum class PlotLine { none, solid, dashed, dotted };
enum class PlotShape { none, circle, square, triangle, diamond, cross, plus };

// Indices of the palette (Okabe and Ito, darkest first; see colors.hpp). Others wrap around.
namespace plot_color {
inline constexpr int blue = 0, vermillion = 1, green = 2, purple = 3, orange = 4, sky_blue = 5, neutral = 6;
}

// Another quantity along a curve, read off where the curve is.
struct PlotAlong {
  std::string label, unit;
  std::vector<double> values; // by point
};

struct PlotCurve {
  std::string name; // in the legend, once for all curves that share it; empty: not there
  // In this order; a value that is not finite, or not positive on a logarithmic axis, breaks the line.
  std::vector<std::array<double, 2>> points;
  PlotLine line = PlotLine::solid;
  int color = plot_color::blue;
  double width = 1.8;                // points
  PlotShape shape = PlotShape::none; // at every point
  double shape_size = 6;             // points across
  bool hidden = false;               // neither drawn nor in the legend
  bool hatching = false;             // marks an area: nothing is read off it, nor is it data for a CSV file
  std::vector<std::string> notes{};  // by point, or none: what is said beside the value read off there
  std::optional<PlotAlong> along{};
};

// An area between two values over x, such as a range that most keep to, or the bars of a histogram.
struct PlotBand {
  std::string name;                          // in the legend, as of curves
  std::vector<std::array<double, 3>> points; // x, rising or falling, lower, upper; not finite: broken
  int color = plot_color::blue;
};

inline constexpr double reference_width = 1.2; // points

// A line from edge to edge, such as a steady value.
struct PlotReference {
  int axis = 1; // whose value it stands at; 1: a horizontal line
  double at = 0;
  std::string label;
  int color = plot_color::neutral;
  PlotLine line = PlotLine::dashed;
  bool in_legend = false; // its label is there, as of curves, and not beside it where they are everywhere
};

// A point with a label, which finds its place beside it.
struct PlotMark {
  std::array<double, 2> at{};
  std::string label;
  PlotShape shape = PlotShape::circle;
  int color = plot_color::neutral;
};

// Values over a grid, drawn as cells about the grid's points.
struct PlotHeat {
  std::vector<double> x, y;   // rising
  std::vector<double> values; // x fastest; not finite: left free
  std::string label, unit;    // of the colour bar
  bool logarithmic = false;
  std::optional<PlotRange> range{};
  std::string si_unit{}; // see PlotAxis
  double factor = 1;
  std::string notes_label{};        // "stability": the column of the notes in a CSV file
  std::vector<std::string> notes{}; // by value, or none: what is said beside it
};

// Where the present state stands; a person can drag it along the curves.
struct PlotMarker {
  double x = 0, y = 0;
  std::string label;
  std::string pull{}; // what a grip beside it does, which can be pulled anywhere; empty: it has none
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotCurve> curves;
  std::vector<PlotBand> bands{}; // below the curves
  std::vector<PlotReference> references;
  std::vector<PlotMark> marks;
  std::optional<PlotHeat> heat{};
  std::optional<PlotMarker> marker{};
  // Another number whenever anything but the marker changes, so that what was laid out can be used again; 0:
  // laid out anew every time.
  std::uint64_t version = 0;
};

// How a person looks at a plot: by axis (0: x, 1: y), and the names in the legend that he has switched off.
struct PlotLook {
  std::array<std::optional<PlotRange>, 2> range{};
  std::array<std::optional<bool>, 2> logarithmic{};
  std::set<std::string> hidden{};
  bool operator==(const PlotLook&) const = default;
};

const PlotAxis& axis_of(const Plot& plot, int axis);
// "spin speed [rad/s]"
std::string axis_text(const std::string& label, const std::string& unit);
bool is_logarithmic(const Plot& plot, const PlotLook& look, int axis);
bool is_shown(const PlotCurve& curve, const PlotLook& look);
bool is_shown(const PlotBand& band, const PlotLook& look);
bool is_shown(const PlotReference& reference, const PlotLook& look);
// The rim of the ground that the line has at either side, in points: over a map's colours, of which some are
// near its own. 0: none.
double rim_of(const Plot& plot, const PlotCurve& curve);
// Behind a label that curves cross: how much of the ground covers them, and how far beyond the letters
// (points).
inline constexpr double label_ground = 0.8, label_ground_room = 2;

} // namespace flyball
