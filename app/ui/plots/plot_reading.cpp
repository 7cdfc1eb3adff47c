#include "app/plot/colors.hpp"
#include "app/plot/layout_heat.hpp"
#include "app/plot/nearest.hpp"
#include "app/session/number_text.hpp"
#include "app/ui/plots/plot_parts.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// What one pixel means there.
double resolution(const PlotRuler& ruler, double pixel) {
  return std::abs(ruler.value(pixel + 0.5) - ruler.value(pixel - 0.5));
}

std::string value_at(const PlotRuler& ruler, double value, bool whole = false) {
  if (whole && std::isfinite(value)) return std::to_string(std::llround(value));
  const double pixel = ruler.pixel(value);
  return reading_text(value, std::isfinite(pixel) ? resolution(ruler, pixel) : 0);
}

std::string name_of(const Plot& plot, int axis) {
  const std::string& label = axis_of(plot, axis).label;
  return !label.empty() ? label : axis == 0 ? "x" : "y";
}

std::string spaced_unit(const std::string& unit) {
  return unit.empty() || unit == "°" ? unit : " " + unit;
}

bool has_lines(const Plot& plot) {
  return std::ranges::any_of(plot.curves,
                             [](const PlotCurve& c) { return c.line != PlotLine::none && !c.hatching; });
}

PlotReadingLine axis_line(const PlotFrame& frame, int axis, double value) {
  const PlotAxis& a = axis_of(frame.plot, axis);
  return {name_of(frame.plot, axis), value_at(frame.layout.ruler(axis), value, a.whole), a.unit};
}

// The mark under the pointer says what it is, also where its label found no room.
void add_mark(const PlotFrame& frame, const PixelPoint& at, std::vector<PlotReadingLine>& lines) {
  for (const PlotPlaced& placed : frame.layout.marks) {
    const PlotMark& mark = frame.plot.marks[placed.index];
    if (mark.label.empty() || std::hypot(placed.x - at[0], placed.y - at[1]) > 9 * frame.layout.scale)
      continue;
    lines.push_back({mark.label, "", ""});
    return;
  }
}

void dot(const PlotFrame& frame, double x, double y, ImU32 color) {
  draw_shape(frame.pen, PlotShape::circle, x, y, 8, packed_color(plot_colors(frame.pen.ground).area));
  draw_shape(frame.pen, PlotShape::circle, x, y, 6, color);
}

// The value of a map's cell, and where it was computed: in its middle.
void add_heat(const PlotFrame& frame, double x, double y, std::vector<PlotReadingLine>& lines) {
  const PlotHeat& heat = *frame.plot.heat;
  const auto cell = heat_cell(heat, x, y, frame.layout.x.logarithmic, frame.layout.y.logarithmic);
  if (!cell || !frame.layout.bar) return;
  const auto [i, j] = *cell;
  const std::size_t index = j * heat.x.size() + i;
  if (!std::isfinite(heat.values[index])) return;
  lines.push_back({heat.label.empty() ? "value" : heat.label,
                   value_at(frame.layout.bar->ruler, heat.values[index]), heat.unit});
  std::string words = index < heat.notes.size() ? heat.notes[index] : "";
  if (!words.empty()) words += ", ";
  words += "computed at " + short_text(heat.x[i], 6) + spaced_unit(frame.plot.x.unit) + ", " +
           short_text(heat.y[j], 6) + spaced_unit(frame.plot.y.unit);
  lines.push_back({words, "", ""});
}

std::vector<PlotReadingLine> lines_at(const PlotFrame& frame, const PixelPoint& at) {
  const PlotLayout& layout = frame.layout;
  const auto color_of = [&](std::size_t curve) {
    return packed_color(curve_color(frame.plot.curves[curve].color, frame.pen.ground));
  };
  std::vector<PlotReadingLine> lines;
  add_mark(frame, at, lines);
  // Points of measurements are read themselves; lines where the pointer is along x.
  if (const auto& hit = frame.events.hovered; hit && frame.plot.curves[hit->curve].shape != PlotShape::none) {
    const PlotCurve& curve = frame.plot.curves[hit->curve];
    lines.push_back({curve.name.empty() ? "point" : curve.name, "", "", color_of(hit->curve)});
    lines.push_back(axis_line(frame, 0, hit->x));
    lines.push_back(axis_line(frame, 1, hit->y));
    if (const auto i = static_cast<std::size_t>(hit->index);
        i < curve.notes.size() && !curve.notes[i].empty())
      lines.push_back({curve.notes[i], "", ""});
    draw_shape(frame.pen, PlotShape::circle, layout.x.pixel(hit->x), layout.y.pixel(hit->y),
               curve.shape_size + 6, color_of(hit->curve),
               packed_color(plot_colors(frame.pen.ground).area, 0));
    return lines;
  }
  const double x = layout.x.value(at[0]);
  lines.push_back(axis_line(frame, 0, x));
  const std::vector<PlotReading> readings = readings_at(frame.plot, frame.view.look, layout, x, at[1]);
  for (const PlotReading& r : readings) {
    const double pixel = layout.y.pixel(r.y);
    const std::string& name = frame.plot.curves[r.curve].name;
    lines.push_back({name.empty() ? name_of(frame.plot, 1) : name,
                     value_at(layout.y, r.y, frame.plot.y.whole), frame.plot.y.unit, color_of(r.curve)});
    if (const auto& along = frame.plot.curves[r.curve].along; along && r.along)
      lines.push_back({along->label, reading_text((*r.along)[0], (*r.along)[1]), along->unit});
    if (!r.note.empty()) lines.push_back({r.note, "", ""});
    if (pixel >= layout.area.top && pixel <= layout.area.bottom) dot(frame, at[0], pixel, color_of(r.curve));
  }
  const std::vector<BandReading> bands = bands_at(frame.plot, frame.view.look, layout, x, at[1]);
  for (const BandReading& r : bands) {
    const PlotBand& band = frame.plot.bands[r.band];
    const std::string upper = value_at(layout.y, r.upper, frame.plot.y.whole);
    const bool bars = std::ranges::all_of(band.points, [](const auto& point) { return point[1] == 0; });
    lines.push_back({band.name,
                     bars ? upper : value_at(layout.y, r.lower, frame.plot.y.whole) + " … " + upper,
                     frame.plot.y.unit, packed_color(curve_color(band.color, frame.pen.ground))});
  }
  const double y = layout.y.value(at[1]);
  // The pointer's own height, except where it would be taken for that of a line that is not there.
  if (frame.plot.heat || (bands.empty() && readings.empty() && !has_lines(frame.plot)))
    lines.push_back(axis_line(frame, 1, y));
  if (frame.plot.heat) add_heat(frame, x, y, lines);
  return lines;
}

void draw_card(const PlotFrame& frame, const PixelPoint& at, const std::vector<PlotReadingLine>& lines) {
  const UiFonts& fonts = frame.ui.fonts;
  const UiColors& colors = colors_of(frame.ui);
  const float s = frame.ui.scale, pad = 7 * s, gap = 10 * s, line = std::round(1.2f * fonts.text->FontSize);
  const auto width = [](ImFont* font, const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.c_str()).x;
  };
  float names = 0, values = 0, units = 0;
  bool dots = false;
  for (const PlotReadingLine& l : lines) {
    dots = dots || l.color;
    names = std::max(names, width(fonts.text, l.name) - (l.value.empty() ? gap : 0));
    values = std::max(values, width(fonts.digits, l.value));
    if (!l.unit.empty()) units = std::max(units, width(fonts.text, l.unit) + 5 * s);
  }
  const float indent = dots ? 13 * s : 0;
  const ImVec2 size(indent + names + (values > 0 ? gap + values : 0) + units + 2 * pad,
                    line * static_cast<float>(lines.size()) + 2 * pad - (line - fonts.text->FontSize));
  // Right above the pointer where there is room, always inside the frame.
  const PlotBox& a = frame.layout.area;
  const ImVec2 low = frame.pen.at(a.left + 3, a.top + 3), high = frame.pen.at(a.right - 3, a.bottom - 3);
  const ImVec2 pointer = frame.pen.at(at[0], at[1]);
  const float off = 14 * s;
  float x = pointer.x + off + size.x <= high.x ? pointer.x + off : pointer.x - off - size.x;
  float y = pointer.y - off - size.y >= low.y ? pointer.y - off - size.y : pointer.y + off;
  x = std::round(std::max(low.x, std::min(x, high.x - size.x)));
  y = std::round(std::max(low.y, std::min(y, high.y - size.y)));
  ImDrawList& list = frame.pen.list;
  ImVec4 ground = colors.panel;
  ground.w = 0.94f;
  list.AddRectFilled({x, y}, {x + size.x, y + size.y}, packed(ground), 4 * s);
  list.AddRect({x, y}, {x + size.x, y + size.y}, packed(colors.border), 4 * s, 0,
               std::max(1.f, std::round(s)));
  float top = y + pad;
  const float drop = digits_drop(frame.ui);
  for (const PlotReadingLine& l : lines) {
    if (l.color) list.AddCircleFilled({x + pad + 4 * s, top + fonts.text->FontSize / 2}, 3.5f * s, *l.color);
    list.AddText(fonts.text, fonts.text->FontSize, {x + pad + indent, top},
                 packed(l.value.empty() ? colors.text : colors.dim), l.name.c_str());
    const float right = x + size.x - pad - units;
    list.AddText(fonts.digits, fonts.digits->FontSize,
                 {std::round(right - width(fonts.digits, l.value)), top + drop}, packed(colors.text),
                 l.value.c_str());
    list.AddText(fonts.text, fonts.text->FontSize, {right + 5 * s, top}, packed(colors.dim), l.unit.c_str());
    top += line;
  }
}

} // namespace

void show_plot_reading(const PlotFrame& frame, const PixelPoint& at, bool along_x) {
  const PlotBox& a = frame.layout.area;
  if (!a.contains(at[0], at[1])) return;
  const ImU32 color = packed_color(plot_colors(frame.pen.ground).frame, 0.7f);
  const float line = std::max(1.f, std::round(frame.ui.scale));
  const ImVec2 cross = frame.pen.at(std::floor(at[0]), std::floor(at[1]));
  const ImVec2 low = frame.pen.at(a.left, a.top), high = frame.pen.at(a.right, a.bottom);
  frame.pen.list.AddRectFilled({cross.x, low.y}, {cross.x + line, high.y}, color);
  if (!along_x) frame.pen.list.AddRectFilled({low.x, cross.y}, {high.x, cross.y + line}, color);
  frame.view.card = lines_at(frame, at);
  draw_card(frame, at, frame.view.card);
}

} // namespace flyball
