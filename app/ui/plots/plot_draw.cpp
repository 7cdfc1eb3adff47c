#include "app/ui/plots/plot_draw.hpp"

#include "app/plot/colors.hpp"
#include "app/plot/shapes.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

ImFont* font_of(const UiFonts& fonts, PlotFont font) {
  return font == PlotFont::strong ? fonts.strong : fonts.text;
}

// Digits of the text's font set tabularly: all as wide as the widest.
float digit_width(const ImFont& font) {
  float widest = 0;
  for (ImWchar digit = '0'; digit <= '9'; ++digit)
    widest = std::max(widest, font.GetCharAdvance(digit));
  return widest;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Calls with each run of other letters and each digit, and where it begins; returns the width.
template <typename Place>
float set_digits(const ImFont& font, std::string_view text, const Place& place) {
  const float cell = digit_width(font);
  float x = 0;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    while (!is_digit(text[i]) && end < text.size() && !is_digit(text[end]))
      ++end;
    const char *from = text.data() + i, *to = text.data() + end;
    const float width = font.CalcTextSizeA(font.FontSize, 1e9f, 0, from, to).x;
    const bool digit = is_digit(text[i]);
    place(from, to, digit ? x + (cell - width) / 2 : x);
    x += digit ? cell : width;
    i = end;
  }
  return x;
}

// One or more whole pixels wide.
float hair(const PlotPen& pen) {
  return std::max(1.f, std::floor(pen.scale + 0.25f));
}

void upright_hair(const PlotPen& pen, double x, double top, double bottom, ImU32 color) {
  const float left = std::floor(pen.origin.x + static_cast<float>(x)) - std::floor((hair(pen) - 1) / 2);
  pen.list.AddRectFilled({left, pen.at(0, top).y}, {left + hair(pen), pen.at(0, bottom).y}, color);
}

void level_hair(const PlotPen& pen, double y, double left, double right, ImU32 color) {
  const float top = std::floor(pen.origin.y + static_cast<float>(y)) - std::floor((hair(pen) - 1) / 2);
  pen.list.AddRectFilled({pen.at(left, 0).x, top}, {pen.at(right, 0).x, top + hair(pen)}, color);
}

void draw_grid(const PlotPen& pen, const PlotLayout& layout, const PlotColors& colors) {
  const PlotBox& a = layout.area;
  const ImU32 minor = packed_color(colors.minor_grid), major = packed_color(colors.grid);
  // Decades need their parts, to be read at all; a linear axis has ticks.
  for (double x : layout.x_minor)
    if (layout.x.logarithmic) upright_hair(pen, x, a.top, a.bottom, minor);
  for (double y : layout.y_minor)
    if (layout.y.logarithmic) level_hair(pen, y, a.left, a.right, minor);
  for (const PlotTick& tick : layout.x_ticks)
    upright_hair(pen, tick.at, a.top, a.bottom, major);
  for (const PlotTick& tick : layout.y_ticks)
    level_hair(pen, tick.at, a.left, a.right, major);
}

void draw_frame(const PlotPen& pen, const PlotLayout& layout, const PlotColors& colors) {
  const PlotBox& a = layout.area;
  const ImU32 color = packed_color(colors.frame);
  const double line = hair(pen), length = std::round(5 * pen.scale), less = std::round(3 * pen.scale);
  for (double x : {a.left, a.right})
    upright_hair(pen, x, a.top, a.bottom + line, color);
  for (double y : {a.top, a.bottom})
    level_hair(pen, y, a.left, a.right + line, color);
  for (const PlotTick& tick : layout.x_ticks)
    upright_hair(pen, tick.at, a.bottom, a.bottom + length + line, color);
  for (const PlotTick& tick : layout.y_ticks)
    level_hair(pen, tick.at, a.left - length, a.left, color);
  for (double x : layout.x_minor)
    upright_hair(pen, x, a.bottom, a.bottom + less + line, color);
  for (double y : layout.y_minor)
    level_hair(pen, y, a.left - less, a.left, color);
  if (!layout.bar) return;
  for (const PlotTick& tick : layout.bar->ticks)
    level_hair(pen, tick.at, layout.bar->box.right, layout.bar->box.right + length, color);
}

// `rim`: of the ground, which keeps a line in sight on any colour.
void draw_curve(const PlotPen& pen, const PlotCurve& curve, const PlotCurveLines& lines, double rim) {
  const ImU32 color = packed_color(curve_color(curve.color, pen.ground)),
              ground = packed_color(plot_colors(pen.ground).area);
  for (const PixelLine& line : lines.lines)
    if (rim > 0) draw_line(pen, line, PlotLine::solid, curve.width + 2 * rim, ground);
  for (const PixelLine& line : lines.lines)
    draw_line(pen, line, curve.line, curve.width, color);
  for (const PixelPoint& p : lines.shapes)
    draw_shape(pen, curve.shape, p[0], p[1], curve.shape_size, color);
}

// Flat, so that no seams show where its parts meet.
void draw_band(const PlotPen& pen, const PlotBand& band, const PlotBandLines& lines) {
  const std::uint32_t color = curve_color(band.color, pen.ground);
  const ImU32 fill = packed_color(color, static_cast<float>(band_fill(pen.ground))),
              edge = packed_color(color, static_cast<float>(band_edge));
  for (const auto& [lower, upper] : lines.lower_upper) {
    const ImDrawListFlags before = pen.list.Flags;
    pen.list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (std::size_t i = 1; i < upper.size(); ++i)
      if (upper[i][0] != upper[i - 1][0])
        pen.list.AddQuadFilled(pen.at(upper[i - 1][0], upper[i - 1][1]), pen.at(upper[i][0], upper[i][1]),
                               pen.at(lower[i][0], lower[i][1]), pen.at(lower[i - 1][0], lower[i - 1][1]),
                               fill);
    pen.list.Flags = before;
    draw_line(pen, upper, PlotLine::solid, 1, edge);
    draw_line(pen, lower, PlotLine::solid, 1, edge);
  }
}

void draw_references(const PlotPen& pen, const Plot& plot, const PlotLayout& layout) {
  for (const PlotPlaced& placed : layout.references) {
    const PlotReference& r = plot.references[placed.index];
    const ImU32 color = packed_color(curve_color(r.color, pen.ground));
    const PlotBox& a = layout.area;
    // In the middle of a pixel, or it would be a blur two pixels wide.
    const double x = std::floor(placed.x) + 0.5, y = std::floor(placed.y) + 0.5;
    if (r.axis == 1)
      draw_line(pen, {{a.left, y}, {a.right, y}}, r.line, reference_width, color);
    else
      draw_line(pen, {{x, a.top}, {x, a.bottom}}, r.line, reference_width, color);
  }
}

// A rim of the ground keeps it readable on curves and colours, and where these cross it more of it.
void draw_label(const PlotPen& pen, const PlotText& text, const PlotColors& colors) {
  if (const PlotBox box = text.box.grown(label_ground_room * static_cast<double>(pen.scale)); text.backed)
    pen.list.AddRectFilled(pen.at(box.left, box.top), pen.at(box.right, box.bottom),
                           packed_color(colors.area, static_cast<float>(label_ground)));
  const float rim = std::max(1.f, 1.5f * pen.scale);
  for (int i = 0; i < 8; ++i) {
    const float angle = static_cast<float>(i) * 0.785398163f;
    const PlotPen moved{pen.list,
                        pen.fonts,
                        {pen.origin.x + rim * std::cos(angle), pen.origin.y + rim * std::sin(angle)},
                        pen.scale,
                        pen.ground};
    draw_text(moved, text, packed_color(colors.area));
  }
  draw_text(pen, text, packed_color(colors.text));
}

void draw_legend(const PlotPen& pen, const Plot& plot, const PlotLook& look, const PlotLayout& layout,
                 const PlotColors& colors) {
  for (const PlotLegendEntry& entry : layout.legend) {
    const bool hidden = look.hidden.contains(entry.name);
    if (entry.of == PlotLegendEntry::Of::band) {
      const std::uint32_t own = curve_color(plot.bands[entry.index].color, pen.ground);
      const double middle = std::floor((entry.sample.top + entry.sample.bottom) / 2), half = 5 * layout.scale;
      pen.list.AddRectFilled(pen.at(entry.sample.left, middle - half),
                             pen.at(entry.sample.right, middle + half),
                             packed_color(hidden ? colors.faint : own,
                                          std::min(2 * static_cast<float>(band_fill(pen.ground)), 1.f)));
      draw_text(pen, entry.text, packed_color(hidden ? colors.faint : colors.text));
      continue;
    }
    const PlotCurve c = legend_line(plot, entry);
    const ImU32 color = packed_color(hidden ? colors.faint : curve_color(c.color, pen.ground));
    const double y = std::floor((entry.sample.top + entry.sample.bottom) / 2) + 0.5;
    if (c.line != PlotLine::none)
      draw_line(pen, {{entry.sample.left, y}, {entry.sample.right, y}}, c.line, c.width, color);
    draw_shape(pen, c.shape, (entry.sample.left + entry.sample.right) / 2, y, c.shape_size, color);
    draw_text(pen, entry.text, packed_color(hidden ? colors.faint : colors.text));
  }
}

void draw_bar(const PlotPen& pen, const PlotBar& bar, const PlotColors& colors) {
  constexpr int pieces = 64;
  for (int i = 0; i < pieces; ++i) {
    const double low = static_cast<double>(i) / pieces, high = static_cast<double>(i + 1) / pieces;
    const ImU32 below = packed_color(heat_color(low)), above = packed_color(heat_color(high));
    pen.list.AddRectFilledMultiColor(pen.at(bar.box.left, bar.box.bottom - high * bar.box.height()),
                                     pen.at(bar.box.right, bar.box.bottom - low * bar.box.height()), above,
                                     above, below, below);
  }
  for (const PlotTick& tick : bar.ticks)
    if (tick.label) draw_text(pen, *tick.label, packed_color(colors.dim));
  if (bar.label) draw_text(pen, *bar.label, packed_color(colors.text));
}

// Dear ImGui's lines grow horns where they turn back sharply: there they are cut, and joined by a disc.
void draw_strokes(const PlotPen& pen, const PixelLine& line, float width, ImU32 color) {
  constexpr std::size_t most = 4000; // points; more would not fit into its 16-bit indices
  std::vector<ImVec2> points;
  const auto flush = [&] {
    if (points.size() > 1)
      pen.list.AddPolyline(points.data(), static_cast<int>(points.size()), color, ImDrawFlags_None, width);
  };
  for (const PixelPoint& pixel : line) {
    const ImVec2 p = pen.at(pixel[0], pixel[1]);
    if (points.size() > 1) {
      const ImVec2 a = points[points.size() - 2], b = points.back();
      const float ux = b.x - a.x, uy = b.y - a.y, vx = p.x - b.x, vy = p.y - b.y;
      // A turn of more than sixty degrees.
      const bool sharp = ux * vx + uy * vy < 0.5f * std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
      if (sharp || points.size() >= most) {
        flush();
        points = {b};
        if (sharp && width > 1.2f) pen.list.AddCircleFilled(b, width / 2, color, 8);
      }
    }
    points.push_back(p);
  }
  flush();
}

} // namespace

ImU32 packed_color(std::uint32_t rgb, float alpha) {
  return IM_COL32(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255, static_cast<int>(255 * alpha));
}

PlotMetrics plot_metrics(const UiFonts& fonts, float scale) {
  PlotMetrics metrics;
  metrics.scale = static_cast<double>(scale);
  for (PlotFont font : {PlotFont::words, PlotFont::digits, PlotFont::strong})
    metrics.height[static_cast<std::size_t>(font)] = static_cast<double>(font_of(fonts, font)->FontSize);
  metrics.width = [fonts](PlotFont font, std::string_view text) {
    const ImFont* f = font_of(fonts, font);
    if (font == PlotFont::digits)
      return static_cast<double>(set_digits(*f, text, [](const char*, const char*, float) {}));
    return static_cast<double>(
        f->CalcTextSizeA(f->FontSize, 1e9f, 0, text.data(), text.data() + text.size()).x);
  };
  return metrics;
}

void draw_text(const PlotPen& pen, const PlotText& text, ImU32 color) {
  ImFont* font = font_of(pen.fonts, text.font);
  const char* from = text.text.data();
  const char* to = from + text.text.size();
  if (text.font == PlotFont::digits) {
    const ImVec2 at = pen.at(text.box.left, text.box.top);
    set_digits(*font, text.text, [&](const char* begin, const char* end, float x) {
      pen.list.AddText(font, font->FontSize, {std::round(at.x + x), std::round(at.y)}, color, begin, end);
    });
    return;
  }
  if (!text.upright) {
    const ImVec2 at = pen.at(text.box.left, text.box.top);
    pen.list.AddText(font, font->FontSize, {std::round(at.x), std::round(at.y)}, color, from, to);
    return;
  }
  // Set level, then turned about its corner by a right angle, which keeps pixels on pixels.
  const int first = pen.list.VtxBuffer.Size;
  font->RenderText(&pen.list, font->FontSize, {0, 0}, color, {-1e6f, -1e6f, 1e6f, 1e6f}, from, to);
  const ImVec2 corner = pen.at(text.box.left, text.box.bottom);
  const float x = std::round(corner.x), y = std::round(corner.y);
  for (int i = first; i < pen.list.VtxBuffer.Size; ++i) {
    ImVec2& p = pen.list.VtxBuffer[i].pos;
    p = {x + p.y, y - p.x};
  }
}

void draw_shape(const PlotPen& pen, PlotShape shape, double x, double y, double size, ImU32 color,
                std::optional<ImU32> filled_with) {
  const double scaled = size * static_cast<double>(pen.scale);
  const float line = 1.6f * pen.scale;
  if (shape == PlotShape::circle) {
    const auto radius = static_cast<float>(scaled / 2);
    pen.list.AddCircleFilled(pen.at(x, y), radius, filled_with.value_or(color));
    if (filled_with) pen.list.AddCircle(pen.at(x, y), radius, color, 0, line);
    return;
  }
  std::vector<ImVec2> corners;
  for (const PixelPoint& p : shape_corners(shape, scaled))
    corners.push_back(pen.at(x + p[0], y + p[1]));
  const auto count = static_cast<int>(corners.size());
  if (count > 0) pen.list.AddConvexPolyFilled(corners.data(), count, filled_with.value_or(color));
  if (count > 0 && filled_with) pen.list.AddPolyline(corners.data(), count, color, ImDrawFlags_Closed, line);
  const PixelLine strokes = shape_strokes(shape, scaled);
  for (std::size_t i = 0; i + 1 < strokes.size(); i += 2)
    pen.list.AddLine(pen.at(x + strokes[i][0], y + strokes[i][1]),
                     pen.at(x + strokes[i + 1][0], y + strokes[i + 1][1]), color, line);
}

void draw_line(const PlotPen& pen, const PixelLine& line, PlotLine kind, double width, ImU32 color) {
  const double s = static_cast<double>(pen.scale);
  const auto thick = static_cast<float>(width * s);
  if (kind == PlotLine::solid) draw_strokes(pen, line, thick, color);
  if (kind != PlotLine::dashed && kind != PlotLine::dotted) return;
  const bool dashed = kind == PlotLine::dashed;
  for (const PixelLine& stroke : dashes(line, (dashed ? 7 : 2) * s, (dashed ? 5 : 4) * s))
    draw_strokes(pen, stroke, thick, color);
}

void draw_plot(const PlotPen& pen, const Plot& plot, const PlotLook& look, const PlotLayout& layout) {
  if (!layout.drawable()) return;
  const PlotColors& colors = plot_colors(pen.ground);
  const PlotBox& a = layout.area;
  pen.list.AddRectFilled(pen.at(a.left, a.top), pen.at(a.right, a.bottom), packed_color(colors.area));
  draw_grid(pen, layout, colors);
  pen.list.PushClipRect(pen.at(a.left, a.top), pen.at(a.right, a.bottom), true);
  for (const PlotCell& cell : layout.cells)
    pen.list.AddRectFilled(pen.at(cell.box.left, cell.box.top), pen.at(cell.box.right, cell.box.bottom),
                           packed_color(cell.color));
  for (const PlotBandLines& lines : layout.bands)
    draw_band(pen, plot.bands[lines.band], lines);
  draw_references(pen, plot, layout);
  for (const PlotCurveLines& lines : layout.curves)
    draw_curve(pen, plot.curves[lines.curve], lines, rim_of(plot, plot.curves[lines.curve]));
  pen.list.PopClipRect();
  draw_frame(pen, layout, colors);
  if (layout.bar) draw_bar(pen, *layout.bar, colors);
  for (const auto* ticks : {&layout.x_ticks, &layout.y_ticks})
    for (const PlotTick& tick : *ticks)
      if (tick.label) draw_text(pen, *tick.label, packed_color(colors.dim));
  for (const auto* text : {&layout.title, &layout.x_label, &layout.y_label}) {
    if (!*text) continue;
    if ((*text)->backed)
      draw_label(pen, **text, colors);
    else
      draw_text(pen, **text, packed_color(colors.text));
  }
  draw_legend(pen, plot, look, layout, colors);
  for (const PlotPlaced& m : layout.marks)
    draw_shape(pen, plot.marks[m.index].shape, m.x, m.y, 9,
               packed_color(curve_color(plot.marks[m.index].color, pen.ground)), packed_color(colors.area));
  for (const auto* placed : {&layout.references, &layout.marks})
    for (const PlotPlaced& p : *placed)
      if (p.label) draw_label(pen, *p.label, colors);
}

void draw_marker(const PlotPen& pen, const Plot& plot, const PlotLayout& layout, bool lit) {
  if (!plot.marker || !layout.drawable()) return;
  const double x = layout.x.pixel(plot.marker->x), y = layout.y.pixel(plot.marker->y);
  if (!layout.area.grown(0.5).contains(x, y)) return;
  const PlotColors& colors = plot_colors(pen.ground);
  draw_shape(pen, PlotShape::circle, x, y, lit ? 17 : 14, packed_color(colors.area));
  draw_shape(pen, PlotShape::circle, x, y, lit ? 13 : 10,
             packed_color(curve_color(plot_color::neutral, pen.ground)));
  if (plot.marker->label.empty()) return;
  if (const auto label = label_beside(layout, x, y, plot.marker->label, plot_metrics(pen.fonts, pen.scale)))
    draw_label(pen, *label, colors);
}

} // namespace flyball
