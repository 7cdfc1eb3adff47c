#include "app/plot/svg.hpp"

#include "app/plot/colors.hpp"
#include "app/plot/layout.hpp"
#include "app/plot/shapes.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace flyball {
namespace {

constexpr double line_height = 16, letter_size = 13; // pixels

// For text and attributes; letters that XML does not have are left out.
std::string escaped(const std::string& text) {
  std::string out;
  const bool readable = find_invalid_utf8(text) == std::string::npos;
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    switch (c) {
    case '&': out += "&amp;"; break;
    case '<': out += "&lt;"; break;
    case '>': out += "&gt;"; break;
    case '"': out += "&quot;"; break;
    default:
      if (byte >= 0x20 || c == '\t') out += byte < 0x80 || readable ? c : '?';
    }
  }
  return out;
}

std::string hex(std::uint32_t color) {
  return fmt::format("#{:06X}", color);
}

// A coordinate with no more digits than can be seen.
std::string px(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string dash_of(PlotLine line) {
  return line == PlotLine::dashed   ? " stroke-dasharray=\"7 5\""
         : line == PlotLine::dotted ? " stroke-dasharray=\"2 4\""
                                    : "";
}

struct Drawing {
  const Plot& plot;
  const PlotLayout& layout;
  const PlotColors& colors;
  PlotGround ground;
  std::string prefix; // escaped
  std::string out{};

  void text(const PlotText& t, std::uint32_t color) {
    const char* anchor = t.anchor < -0.34 ? "start" : t.anchor > 0.34 ? "end" : "middle";
    const double half = (t.box.left + t.box.right) / 2, drop = 0.36 * letter_size;
    if (t.upright)
      out += fmt::format("<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\"",
                         px(half + drop), px((t.box.top + t.box.bottom) / 2));
    else
      out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\"",
                         px(t.anchor < -0.34  ? t.box.left
                            : t.anchor > 0.34 ? t.box.right
                                              : half),
                         px((t.box.top + t.box.bottom) / 2 + drop), anchor);
    if (color != colors.text) out += fmt::format(" fill=\"{}\"", hex(color));
    if (t.font == PlotFont::strong) out += " font-weight=\"600\"";
    out += fmt::format(">{}</text>\n", escaped(t.text));
  }

  void grid(const std::string& path, std::uint32_t color) {
    if (!path.empty()) out += fmt::format("<path d=\"{}\" stroke=\"{}\" fill=\"none\"/>\n", path, hex(color));
  }

  // In the middle of a pixel, so that the line is one pixel wide.
  static std::string crisp(double value) { return px(std::floor(value) + 0.5); }

  void frame_lines() {
    const PlotBox& a = layout.area;
    const auto upright = [&](double x) {
      return fmt::format("M{} {}V{}", crisp(x), px(a.top), px(a.bottom));
    };
    const auto level = [&](double y) { return fmt::format("M{} {}H{}", px(a.left), crisp(y), px(a.right)); };
    std::string minor, major;
    for (double x : layout.x_minor)
      if (layout.x.logarithmic) minor += upright(x);
    for (double y : layout.y_minor)
      if (layout.y.logarithmic) minor += level(y);
    for (const PlotTick& tick : layout.x_ticks)
      major += upright(tick.at);
    for (const PlotTick& tick : layout.y_ticks)
      major += level(tick.at);
    grid(minor, colors.minor_grid);
    grid(major, colors.grid);
  }

  void frame() {
    const PlotBox& a = layout.area;
    out += fmt::format("<path d=\"M{} {}H{}V{}H{}Z\" fill=\"none\" stroke=\"{}\"/>\n", crisp(a.left),
                       crisp(a.top), crisp(a.right), crisp(a.bottom), crisp(a.left), hex(colors.frame));
    std::string ticks;
    for (const PlotTick& tick : layout.x_ticks)
      ticks += fmt::format("M{} {}v5", crisp(tick.at), crisp(a.bottom));
    for (const PlotTick& tick : layout.y_ticks)
      ticks += fmt::format("M{} {}h-5", crisp(a.left), crisp(tick.at));
    for (double x : layout.x_minor)
      ticks += fmt::format("M{} {}v3", crisp(x), crisp(a.bottom));
    for (double y : layout.y_minor)
      ticks += fmt::format("M{} {}h-3", crisp(a.left), crisp(y));
    if (layout.bar)
      for (const PlotTick& tick : layout.bar->ticks)
        ticks += fmt::format("M{} {}h5", px(layout.bar->box.right), crisp(tick.at));
    grid(ticks, colors.frame);
  }

  void shape(PlotShape shape, double x, double y, double size, std::uint32_t color, bool hollow) {
    const std::string paint =
        hollow ? fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.6\"", hex(colors.area), hex(color))
               : fmt::format("fill=\"{}\"", hex(color));
    if (shape == PlotShape::circle) {
      out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", px(x), px(y), px(size / 2), paint);
      return;
    }
    std::string path;
    for (const PixelPoint& p : shape_corners(shape, size))
      path += fmt::format("{}{} {}", path.empty() ? 'M' : 'L', px(x + p[0]), px(y + p[1]));
    if (!path.empty()) {
      out += fmt::format("<path d=\"{}Z\" {}/>\n", path, paint);
      return;
    }
    const PixelLine strokes = shape_strokes(shape, size);
    if (strokes.empty()) return;
    for (std::size_t i = 0; i + 1 < strokes.size(); i += 2)
      path += fmt::format("M{} {}L{} {}", px(x + strokes[i][0]), px(y + strokes[i][1]),
                          px(x + strokes[i + 1][0]), px(y + strokes[i + 1][1]));
    out +=
        fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", path, hex(color));
  }

  void curve(const PlotCurveLines& lines) {
    const PlotCurve& c = plot.curves[lines.curve];
    const std::uint32_t color = curve_color(c.color, ground);
    std::string path;
    for (const PixelLine& line : lines.lines)
      for (std::size_t i = 0; i < line.size(); ++i)
        path += fmt::format("{}{} {}", i == 0 ? 'M' : 'L', px(line[i][0]), px(line[i][1]));
    if (const double rim = rim_of(plot, c); !path.empty() && rim > 0)
      out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" "
                         "stroke-linejoin=\"round\"/>\n",
                         path, hex(colors.area), px(c.width + 2 * rim));
    if (!path.empty())
      out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" "
                         "stroke-linejoin=\"round\"{}/>\n",
                         path, hex(color), px(c.width), dash_of(c.line));
    for (const PixelPoint& p : lines.shapes)
      shape(c.shape, p[0], p[1], c.shape_size, color, false);
  }

  void band(const PlotBandLines& lines) {
    const std::string color = hex(curve_color(plot.bands[lines.band].color, ground));
    for (const auto& [lower, upper] : lines.lower_upper) {
      std::string path, edges;
      for (std::size_t i = 0; i < upper.size(); ++i)
        path += fmt::format("{}{} {}", i == 0 ? 'M' : 'L', px(upper[i][0]), px(upper[i][1]));
      edges = path;
      for (std::size_t i = lower.size(); i-- > 0;)
        path += fmt::format("L{} {}", px(lower[i][0]), px(lower[i][1]));
      for (std::size_t i = 0; i < lower.size(); ++i)
        edges += fmt::format("{}{} {}", i == 0 ? 'M' : 'L', px(lower[i][0]), px(lower[i][1]));
      out += fmt::format("<path d=\"{}Z\" fill=\"{}\" fill-opacity=\"{}\"/>\n", path, color,
                         px(band_fill(ground)));
      out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-opacity=\"{}\"/>\n", edges, color,
                         px(band_edge));
    }
  }

  void references() {
    const PlotBox& a = layout.area;
    for (const PlotPlaced& r : layout.references) {
      const PlotReference& reference = plot.references[r.index];
      const std::string path = reference.axis == 1
                                   ? fmt::format("M{} {}H{}", px(a.left), px(r.y), px(a.right))
                                   : fmt::format("M{} {}V{}", px(r.x), px(a.top), px(a.bottom));
      out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", path,
                         hex(curve_color(reference.color, ground)), px(reference_width),
                         dash_of(reference.line));
    }
  }

  void legend() {
    for (const PlotLegendEntry& entry : layout.legend) {
      if (entry.of == PlotLegendEntry::Of::band) {
        const PlotBox& box = entry.sample;
        out += fmt::format(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"10\" fill=\"{}\" fill-opacity=\"{}\"/>\n",
            px(box.left), px((box.top + box.bottom) / 2 - 5), px(box.width()),
            hex(curve_color(plot.bands[entry.index].color, ground)), px(2 * band_fill(ground)));
        text(entry.text, colors.text);
        continue;
      }
      const PlotCurve c = legend_line(plot, entry);
      const std::uint32_t color = curve_color(c.color, ground);
      const double y = (entry.sample.top + entry.sample.bottom) / 2;
      if (c.line != PlotLine::none)
        out += fmt::format("<path d=\"M{} {}H{}\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n",
                           px(entry.sample.left), px(y), px(entry.sample.right), hex(color), px(c.width),
                           dash_of(c.line));
      if (c.shape != PlotShape::none)
        shape(c.shape, (entry.sample.left + entry.sample.right) / 2, y, c.shape_size, color, false);
      text(entry.text, colors.text);
    }
  }

  void heat() {
    if (layout.cells.empty()) return;
    out += "<g shape-rendering=\"crispEdges\">\n";
    for (const PlotCell& cell : layout.cells)
      out += fmt::format("<path d=\"M{} {}H{}V{}H{}Z\" fill=\"{}\"/>\n", px(cell.box.left), px(cell.box.top),
                         px(cell.box.right), px(cell.box.bottom), px(cell.box.left), hex(cell.color));
    out += "</g>\n";
  }

  void bar() {
    const PlotBox& box = layout.bar->box;
    out += fmt::format("<defs><linearGradient id=\"{}bar\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">", prefix);
    for (int i = 0; i <= 32; ++i)
      out += fmt::format("<stop offset=\"{}\" stop-color=\"{}\"/>", px(i / 32.), hex(heat_color(i / 32.)));
    out += fmt::format("</linearGradient></defs>\n<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" "
                       "fill=\"url(#{}bar)\"/>\n",
                       px(box.left), px(box.top), px(box.width()), px(box.height()), prefix);
    for (const PlotTick& tick : layout.bar->ticks)
      if (tick.label) text(*tick.label, colors.dim);
    if (layout.bar->label) text(*layout.bar->label, colors.text);
  }

  void words() {
    for (const auto* ticks : {&layout.x_ticks, &layout.y_ticks})
      for (const PlotTick& tick : *ticks)
        if (tick.label) text(*tick.label, colors.dim);
    for (const auto* t : {&layout.title, &layout.x_label, &layout.y_label})
      if (*t) (*t)->backed ? label(**t) : text(**t, colors.text);
  }

  // A label stands on the curves' colours: a rim of the ground keeps it readable, and where they cross it
  // more of it.
  void label(const PlotText& words) {
    if (const PlotBox box = words.box.grown(label_ground_room); words.backed)
      out += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" fill-opacity=\"{}\"/>\n",
          px(box.left), px(box.top), px(box.width()), px(box.height()), hex(colors.area), label_ground);
    out +=
        fmt::format("<g paint-order=\"stroke\" stroke=\"{}\" stroke-width=\"3\" stroke-linejoin=\"round\">",
                    hex(colors.area));
    text(words, colors.text);
    out += "</g>\n";
  }

  void marks(const PlotMetrics& metrics) {
    for (const PlotPlaced& m : layout.marks)
      shape(plot.marks[m.index].shape, m.x, m.y, 9, curve_color(plot.marks[m.index].color, ground), true);
    for (const auto* placed : {&layout.references, &layout.marks})
      for (const PlotPlaced& p : *placed)
        if (p.label) label(*p.label);
    if (!plot.marker) return;
    const double x = layout.x.pixel(plot.marker->x), y = layout.y.pixel(plot.marker->y);
    if (!layout.area.grown(0.5).contains(x, y)) return;
    shape(PlotShape::circle, x, y, 11, curve_color(plot_color::neutral, ground), false);
    if (!plot.marker->label.empty())
      if (const auto beside = label_beside(layout, x, y, plot.marker->label, metrics)) label(*beside);
  }
};

} // namespace

std::string to_svg(const Plot& plot, const SvgOptions& options, const PlotLook& look) {
  PlotMetrics metrics;
  metrics.height = {line_height, line_height, line_height + 2};
  const PlotLayout layout = plot_layout(plot, look, options.width, options.height, metrics);
  Drawing d{plot, layout, plot_colors(options.ground), options.ground, escaped(options.prefix)};
  d.out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"{2}\" font-size=\"{3}\" style=\"font-variant-numeric: tabular-nums\" fill=\"{4}\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"{5}\"/>\n",
      options.width, options.height, escaped(options.font), letter_size, hex(d.colors.text),
      hex(d.colors.page));
  if (layout.drawable()) {
    const PlotBox& a = layout.area;
    d.out += fmt::format(
        "<clipPath id=\"{5}area\"><rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\"/></clipPath>\n"
        "<rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" fill=\"{4}\"/>\n",
        px(a.left), px(a.top), px(a.width()), px(a.height()), hex(d.colors.area), d.prefix);
    d.frame_lines();
    d.heat();
    d.out += fmt::format("<g clip-path=\"url(#{}area)\">\n", d.prefix);
    for (const PlotBandLines& lines : layout.bands)
      d.band(lines);
    d.references();
    for (const PlotCurveLines& lines : layout.curves)
      d.curve(lines);
    d.out += "</g>\n";
    d.frame();
    if (layout.bar) d.bar();
    d.words();
    d.legend();
    d.marks(metrics);
  }
  return d.out + "</svg>\n";
}

} // namespace flyball
