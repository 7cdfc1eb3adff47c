#include "app/plot/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Okabe and Ito's palette, darkest first.
constexpr std::array<const char*, 7> palette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                "#E69F00", "#56B4E9", "#000000"};

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text)
    switch (c) {
    case '&': out += "&amp;"; break;
    case '<': out += "&lt;"; break;
    case '>': out += "&gt;"; break;
    case '"': out += "&quot;"; break;
    default: out += c;
    }
  return out;
}

// From a value on an axis to pixels.
struct Ruler {
  double lower, upper, from, to;
  bool logarithmic;
  double operator()(double value) const {
    const double part =
        logarithmic ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
    return from + part * (to - from);
  }
};

std::string tick_text(double value, bool logarithmic) {
  return logarithmic ? fmt::format("1e{:.0f}", std::log10(value)) : fmt::format("{:.6g}", value);
}

} // namespace

std::string to_svg(const Plot& plot, int width, int height) {
  const double left = 78, right = width - 24., top = plot.title.empty() ? 24 : 48, bottom = height - 62.;
  const auto rx = axis_range(plot, 0), ry = axis_range(plot, 1);
  const Ruler x{rx[0], rx[1], left, right, plot.x.logarithmic},
      y{ry[0], ry[1], bottom, top, plot.y.logarithmic};
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Inter, Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height);
  if (!plot.title.empty())
    out += fmt::format("<text x=\"{:.1f}\" y=\"28\" font-size=\"16\" font-weight=\"600\">{}</text>\n", left,
                       escaped(plot.title));
  for (double tick : axis_ticks(rx[0], rx[1], 8, plot.x.logarithmic))
    out += fmt::format("<path d=\"M{0:.2f} {1:.2f}V{2:.2f}\" stroke=\"#e3e6e8\"/>"
                       "<text x=\"{0:.2f}\" y=\"{3:.2f}\" text-anchor=\"middle\">{4}</text>\n",
                       x(tick), top, bottom, bottom + 20, tick_text(tick, plot.x.logarithmic));
  for (double tick : axis_ticks(ry[0], ry[1], 7, plot.y.logarithmic))
    out += fmt::format("<path d=\"M{0:.2f} {1:.2f}H{2:.2f}\" stroke=\"#e3e6e8\"/>"
                       "<text x=\"{3:.2f}\" y=\"{4:.2f}\" text-anchor=\"end\">{5}</text>\n",
                       left, y(tick), right, left - 8, y(tick) + 4.5, tick_text(tick, plot.y.logarithmic));
  out += fmt::format("<path d=\"M{:.2f} {:.2f}V{:.2f}H{:.2f}\" fill=\"none\" stroke=\"#666\"/>\n", left, top,
                     bottom, right);
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", (left + right) / 2,
                     height - 18., escaped(plot.x.label));
  out +=
      fmt::format("<text transform=\"translate(20 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                  (top + bottom) / 2, escaped(plot.y.label));
  double legend = top + 18;
  for (const PlotCurve& c : plot.curves) {
    const char* color = palette[static_cast<std::size_t>(c.color) % palette.size()];
    const char* dash = c.line == PlotLine::solid    ? ""
                       : c.line == PlotLine::dashed ? " stroke-dasharray=\"7 5\""
                                                    : " stroke-dasharray=\"2 4\"";
    std::string path;
    bool pen = false;
    for (const auto& p : c.points) {
      const double px = x(p[0]), py = y(p[1]);
      if (!std::isfinite(px) || !std::isfinite(py)) {
        pen = false;
        continue;
      }
      path += fmt::format("{}{:.2f} {:.2f}", pen ? "L" : "M", px, py);
      pen = true;
    }
    if (!path.empty())
      out += fmt::format(
          "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}/>\n",
          path, color, dash);
    if (c.name.empty()) continue;
    out += fmt::format("<path d=\"M{0:.1f} {1:.1f}h28\" stroke=\"{2}\" stroke-width=\"2\"{3}/><text "
                       "x=\"{4:.1f}\" y=\"{5:.1f}\">{6}</text>\n",
                       left + 14, legend - 4.5, color, dash, left + 50, legend, escaped(c.name));
    legend += 20;
  }
  for (const PlotMark& m : plot.marks) {
    const double px = x(m.at[0]), py = y(m.at[1]);
    if (!std::isfinite(px) || !std::isfinite(py)) continue;
    const bool near_right = px > right - 120;
    out += fmt::format(
        "<circle cx=\"{0:.2f}\" cy=\"{1:.2f}\" r=\"4.5\" fill=\"#fff\" stroke=\"#222\" stroke-width=\"1.6\"/>"
        "<text x=\"{2:.2f}\" y=\"{3:.2f}\" text-anchor=\"{4}\">{5}</text>\n",
        px, py, near_right ? px - 9 : px + 9, py - 8, near_right ? "end" : "start", escaped(m.label));
  }
  return out + "</svg>\n";
}

} // namespace flyball
