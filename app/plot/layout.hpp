// Where everything of a plot comes to lie, in pixels from the picture's upper left corner: one answer for
// the screen, PNG and SVG.
#pragma once

#include "app/plot/polyline.hpp"

#include <functional>
#include <string_view>

namespace flyball {

enum class PlotFont { words, digits, strong };

// What a back end's letters are like.
struct PlotMetrics {
  double scale = 1;                                          // pixels a point has
  std::array<double, 3> height{13, 13, 15};                  // of a line of text by PlotFont (pixels)
  std::function<double(PlotFont, std::string_view)> width{}; // of a text (pixels); empty: estimated

  double height_of(PlotFont font) const { return height[static_cast<std::size_t>(font)]; }
  double width_of(PlotFont font, std::string_view text) const;
};

struct PlotText {
  std::string text;
  PlotBox box;       // that it fills
  double anchor = 0; // which end of the box holds where widths are only estimated: -1 left, 0 middle, 1 right
  PlotFont font = PlotFont::words;
  bool upright = false; // read from below to above
  bool backed = false;  // crossed by curves: a ground of its own keeps it readable
};

struct PlotTick {
  double value = 0;
  double at = 0; // pixel along the axis
  std::optional<PlotText> label{};
};

struct PlotLegendEntry {
  enum class Of { curve, band, reference };
  std::string name;
  std::size_t index = 0; // the first of that name among these
  Of of = Of::curve;
  PlotBox box;    // for clicking
  PlotBox sample; // the piece of line before the text
  PlotText text;
};

struct PlotCurveLines {
  std::size_t curve = 0;
  std::vector<PixelLine> lines; // not dashed yet
  PixelLine shapes;             // centres
};

struct PlotBandLines {
  std::size_t band = 0;
  // From break to break, as many points of one as of the other, at the same x. Only what lies far outside is
  // cut off.
  std::vector<std::array<PixelLine, 2>> lower_upper;
};

struct PlotPlaced { // a mark or reference line
  std::size_t index = 0;
  double x = 0, y = 0;
  std::optional<PlotText> label{}; // none where there is no room for it
};

struct PlotCell {
  PlotBox box;
  std::uint32_t color = 0;
};

struct PlotBar { // of a heat map's colours
  PlotBox box;
  PlotRuler ruler;
  std::vector<PlotTick> ticks;
  std::optional<PlotText> label{};
};

// Which squares of the area have curves, or edges of bands, in them, for labels to avoid; rows from the top.
struct PlotInk {
  double side = 0; // pixels
  std::size_t columns = 0, rows = 0;
  std::vector<char> squares;
};

// Room beside the frame (pixels), and whether another plot right below has the numbers of x.
struct PlotSides {
  double left = 0, right = 0;
  bool x_below = false;
  bool operator==(const PlotSides&) const = default;
};

struct PlotLayout {
  double width = 0, height = 0, scale = 1;
  PlotSides own_sides; // what labels need, whatever was asked for
  PlotBox area;        // inside the frame
  PlotRuler x, y;
  std::vector<PlotTick> x_ticks, y_ticks;
  std::vector<double> x_minor, y_minor; // pixels
  std::optional<PlotText> title{}, x_label{}, y_label{};
  std::vector<PlotLegendEntry> legend;
  std::vector<PlotCell> cells;
  std::optional<PlotBar> bar{};
  std::vector<PlotBandLines> bands;          // those shown
  std::vector<PlotCurveLines> curves;        // those shown
  std::vector<PlotPlaced> references, marks; // those in range

  PlotInk ink;

  const PlotRuler& ruler(int axis) const { return axis == 0 ? x : y; }
  bool drawable() const { return area.width() >= 8 && area.height() >= 8; }
};

// The marker is not laid out: it moves without anything else changing. `least`: room beside the frame that
// there is in any case.
PlotLayout plot_layout(const Plot& plot, const PlotLook& look, double width, double height,
                       const PlotMetrics& metrics, const PlotSides& least = {});

// The line and sign, without points, that stand before the text of an entry that is of a curve or a reference
// line.
PlotCurve legend_line(const Plot& plot, const PlotLegendEntry& entry);

// A place for a label beside a point, inside the frame, off the other texts and
// where there is a choice off the curves; none where there is none.
std::optional<PlotText> label_beside(const PlotLayout& layout, double x, double y, const std::string& text,
                                     const PlotMetrics& metrics);

} // namespace flyball
