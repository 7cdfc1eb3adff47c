// The parts of a plot on the screen: what the hand does, what is read off, the menu.
#pragma once

#include "app/ui/plots/plot_draw.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "app/ui/widgets/widget_map.hpp"

namespace flyball {

// One plot in one frame.
struct PlotFrame {
  Session& session;
  Ui& ui;
  const std::string& name; // "plot/NAME"
  PlotView& view;
  const Plot& plot;
  const PlotLayout& layout;
  const PlotPen& pen;
  PlotEvents& events;
};

inline constexpr double plot_key_share = 0.01; // of the area, that a key moves

// The pointer, in pixels from the plot's corner.
PixelPoint pointer_in(const PlotPen& pen);
// Zooms by the factor (above one: out) about a pixel.
void zoom_plot(PlotView& view, const PlotLayout& layout, int axis, double pixel, double factor);

// An invisible button over a box of the plot, as the widget of that name.
bool button_over(const PlotFrame& frame, const char* id, const PlotBox& box, const std::string& name,
                 ImGuiButtonFlags buttons, KeyUse use);

// Area, axes, legend and the marker's grip as widgets. Returns the pixel to read at: that of the pointer
// while it is in the area with nothing else in hand, or that of the keyboard's cursor.
std::optional<PixelPoint> take_plot_input(const PlotFrame& frame);
// What the keyboard does in the plot; where it reads, if it does.
std::optional<PixelPoint> take_plot_keys(const PlotFrame& frame);
// The marker's grip, "plot/NAME/pull", where the marker has one: before the area, which lies under it.
void take_plot_grip(const PlotFrame& frame);
void draw_plot_grip(const PlotFrame& frame);
// What a pixel of the area stands for, in round numbers.
std::array<double, 2> place_in_plot(const PlotFrame& frame, const PixelPoint& at);
// Cross-hair and a card with x, the curves' values there and the point under the pointer; `along_x`: where
// another plot is read, without the level line.
void show_plot_reading(const PlotFrame& frame, const PixelPoint& at, bool along_x = false);
// What a right click brings.
void plot_menu(const PlotFrame& frame);

} // namespace flyball
