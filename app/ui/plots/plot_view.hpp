// A plot on the screen that can be looked around in: the wheel zooms about the pointer (over an axis: that
// axis alone), a drag pans, right-drag or Shift-drag zooms to a box, a double click fits; entries of the
// legend switch curves on and off, and a right click offers scales and files. A marker is dragged along the
// curves, and by its grip anywhere. With the keyboard arrows move the marker, or else a cursor to read by;
// plus and minus zoom about it, Home fits, Enter is a click there.
#pragma once

#include "app/plot/layout.hpp"

#include <imgui.h>

#include <initializer_list>
#include <memory>

namespace flyball {

struct Session;
struct Ui;

enum class PlotFile { none, png, svg, csv };

// A point of a plot's data.
struct PlotHit {
  std::size_t curve = 0; // of Plot::curves
  double index = 0;      // of its points; with a fraction where it lies between two
  double x = 0, y = 0;
};

// Where the marker is wanted, off the curves; without x where it was pulled up or down alone.
struct PlotPull {
  std::optional<double> x;
  double y = 0;
  bool operator==(const PlotPull&) const = default;
};

// What the person did to the plot in this frame.
struct PlotEvents {
  std::optional<PlotHit> hovered;    // the point of the data under the pointer
  std::optional<PlotHit> clicked;    // the same, pressed and released without a drag
  std::optional<PlotHit> dragged_to; // where along the curves the marker is wanted; every frame of the drag
  bool drag_ended = false;           // the marker was let go
  // The same places whatever lies there, without digits that a pixel cannot tell.
  std::optional<std::array<double, 2>> clicked_at{}, dragged_at{};
  std::optional<PlotPull> pulled_to{}; // by the marker's grip; another place than before
};

// A line of what is read off: "gain", "-41.2", "dB"; words alone have no value.
struct PlotReadingLine {
  std::string name, value, unit;
  std::optional<ImU32> color{}; // of a dot before it
};

// What was laid out, while it can be used again.
struct PlotKept {
  std::uint64_t version = 0;
  PlotLook look;
  float width = 0, height = 0, scale = 0;
  PlotSides sides;
  std::shared_ptr<const PlotLayout> layout;
};

// How a person looks at one plot; a value that the panel keeps from frame to frame.
struct PlotView {
  PlotLook look;
  PlotSides sides;                            // room beside the frame, at least; see align_plots()
  std::optional<double> cursor;               // x under the pointer
  std::optional<double> followed;             // x at which another plot is read: this one is, too
  std::vector<PlotReadingLine> card;          // what is read off, as last drawn
  std::optional<std::array<double, 2>> keyed; // where the keyboard reads the plot
  // What the hand does.
  enum class Drag { none, pan, box, marker, pull } drag = Drag::none;
  std::array<bool, 2> drag_axis{true, true};
  std::array<double, 2> drag_from{}; // pixels, from the plot's corner
  std::array<PlotRange, 2> drag_range{};
  bool dragged = false; // further than a click trembles
  int button = 0;       // of the mouse
  // Of a pull: where the marker stood (pixels), whether the hand has gone sideways, where it is wanted.
  PixelPoint pull_from{};
  bool pull_sideways = false;
  std::optional<PlotPull> pull_to;
  PlotKept kept;
};

// Draws the plot into `size` pixels at ImGui's cursor; names its parts "plot/NAME/area",
// "plot/NAME/legend/CURVE", "plot/NAME/axis/x", "plot/NAME/menu/...". Curves can be long and are drawn
// quickly where Plot::version is kept.
PlotEvents plot_view(Session& session, Ui& ui, const std::string& name, PlotView& view, const Plot& plot,
                     ImVec2 size);

// Plots that stand one above the other get the same ends of their x axes, which the lowest has the numbers
// of.
struct StackedPlot {
  PlotView& view;
  const Plot& plot;
  ImVec2 size;
};
void align_plots(const Ui& ui, std::initializer_list<StackedPlot> plots);

// Another takes its place and is laid out anew: with the next version.
void replace_plot(Plot& plot, Plot next);

// All of it in view again.
void fit_plot(PlotView& view);

} // namespace flyball
