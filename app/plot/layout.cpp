#include "app/plot/layout.hpp"

#include "app/plot/label_places.hpp"
#include "app/plot/layout_heat.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// What a picture that is too small leaves out, in this order.
enum class Detail { all, without_words, bare };

std::string cut_text(const PlotMetrics& metrics, PlotFont font, std::string text, double width) {
  if (metrics.width_of(font, text) <= width) return text;
  while (!text.empty() && metrics.width_of(font, text + "…") > width) {
    // Whole characters: bytes of the form 10xxxxxx continue one.
    while ((static_cast<unsigned char>(text.back()) & 0xC0) == 0x80 && text.size() > 1)
      text.pop_back();
    text.pop_back();
  }
  return text.empty() ? text : text + "…";
}

struct Builder {
  const Plot& plot;
  const PlotLook& look;
  const PlotMetrics& metrics;
  PlotSides least_sides; // room beside the frame
  PlotLayout out;
  Detail detail = Detail::all;
  int rows = 0;         // of the legend
  bool y_above = false; // the label of y lies above the frame

  double s() const { return metrics.scale; }
  double line(PlotFont font) const { return metrics.height_of(font); }

  PlotText text(PlotFont font, const std::string& words, double x, double top, double anchor) const {
    const double width = metrics.width_of(font, words), left = x - width * (anchor + 1) / 2;
    return {words, {left, top, left + width, top + line(font)}, anchor, font};
  }

  PlotText upright(const std::string& words, double center_x, double center_y, double room) const {
    const std::string cut = cut_text(metrics, PlotFont::words, words, room);
    const double half_width = line(PlotFont::words) / 2,
                 half_length = metrics.width_of(PlotFont::words, cut) / 2;
    return {cut,
            {center_x - half_width, center_y - half_length, center_x + half_width, center_y + half_length},
            0,
            PlotFont::words,
            true};
  }

  bool overlap(const std::vector<PlotTick>& ticks, double gap_x, double gap_y) const {
    const PlotBox* before = nullptr;
    for (const PlotTick& tick : ticks) {
      if (!tick.label) continue;
      const PlotBox& box = tick.label->box;
      if (before && box.left < before->right + gap_x && before->left < box.right + gap_x &&
          box.top < before->bottom + gap_y && before->top < box.bottom + gap_y)
        return true;
      before = &box;
    }
    return false;
  }

  // As many ticks as there is room for; `place` gives the label's box.
  template <typename Place>
  std::vector<PlotTick> ticks_of(const PlotRuler& ruler, const std::string& unit, double spacing,
                                 double gap_x, double gap_y, const Place& place,
                                 std::vector<double>* minor) const {
    const double length = std::abs(ruler.to - ruler.from);
    std::vector<PlotTick> ticks;
    // Fills in so many ticks, or about; returns whether their labels have room.
    const auto fits = [&](int wanted) {
      const AxisTicks found = unit == "°" && !ruler.logarithmic
                                  ? degree_ticks(ruler.lower, ruler.upper, wanted)
                                  : axis_ticks(ruler.lower, ruler.upper, wanted, ruler.logarithmic);
      ticks.clear();
      for (std::size_t i = 0; i < found.major.size(); ++i) {
        const double at = ruler.pixel(found.major[i]);
        ticks.push_back({found.major[i], at, place(found.labels[i], at)});
      }
      if (minor) {
        minor->clear();
        // Not so many that they run into one another.
        const auto count = static_cast<double>(found.minor.size() + found.major.size());
        if (count > 0 && length / count >= 5 * s())
          for (double value : found.minor)
            minor->push_back(ruler.pixel(value));
      }
      return !overlap(ticks, gap_x, gap_y);
    };
    // One number says little: a short axis gets its numbers closer.
    constexpr int most = 12;
    constexpr std::size_t enough = 3; // numbers; fewer do not say what the scale is
    const int least = std::clamp(static_cast<int>(length / (0.6 * spacing)), 1, 4);
    int wanted = std::clamp(static_cast<int>(length / spacing), least, most);
    while (wanted > 1 && !fits(wanted))
      --wanted;
    if (wanted > 1 || fits(1)) {
      if (ticks.size() >= enough) return ticks;
      // As many numbers as have room: a wide step may have none or one of its multiples in sight.
      int best = wanted;
      std::size_t count = ticks.size();
      for (int more = wanted + 1; more <= most; ++more) {
        if (!fits(more) || ticks.size() <= count) continue;
        if (ticks.size() >= enough) return ticks;
        best = more;
        count = ticks.size();
      }
      fits(best);
      return ticks;
    }
    for (std::size_t i = 1; i < ticks.size(); ++i)
      ticks[i].label.reset();
    return ticks;
  }

  std::vector<PlotTick> vertical_ticks(const PlotRuler& ruler, const std::string& unit, double anchor,
                                       std::vector<double>* minor) const {
    return ticks_of(
        ruler, unit, 42 * s(), 0, 0.25 * line(PlotFont::digits),
        [&](const std::string& label, double at) {
          return text(PlotFont::digits, label, 0, at - line(PlotFont::digits) / 2, anchor);
        },
        minor);
  }

  double widest(const std::vector<PlotTick>& ticks) const {
    double width = 0;
    for (const PlotTick& tick : ticks)
      if (tick.label) width = std::max(width, tick.label->box.width());
    return width;
  }

  // The names in rows from area.left; returns how many rows they take.
  int lay_legend(double top) {
    const double height = line(PlotFont::words) + 4 * s(), sample = 24 * s(), gap = 6 * s();
    double x = out.area.left;
    int row = 0;
    std::set<std::string> known;
    using Of = PlotLegendEntry::Of;
    const auto add = [&](const std::string& full, std::size_t i, Of of) {
      if (full.empty() || !known.insert(full).second) return;
      const double room = out.area.width() - sample - gap;
      const std::string name = cut_text(metrics, PlotFont::words, full, room);
      const double width = sample + gap + metrics.width_of(PlotFont::words, name);
      if (x > out.area.left && x + width > out.area.right) {
        x = out.area.left;
        ++row;
      }
      const double y = top + row * height;
      out.legend.push_back({full,
                            i,
                            of,
                            {x - 3 * s(), y, x + width + 3 * s(), y + height},
                            {x, y, x + sample, y + height},
                            text(PlotFont::words, name, x + sample + gap, y + 2 * s(), -1)});
      x += width + 16 * s();
    };
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
      if (!plot.curves[i].hidden) add(plot.curves[i].name, i, Of::curve);
    for (std::size_t i = 0; i < plot.bands.size(); ++i)
      add(plot.bands[i].name, i, Of::band);
    for (std::size_t i = 0; i < plot.references.size(); ++i)
      if (plot.references[i].in_legend) add(plot.references[i].label, i, Of::reference);
    return out.legend.empty() ? 0 : row + 1;
  }

  void lay_frame() {
    const bool words = detail == Detail::all;
    const double pad = (words ? 10 : 6) * s(), words_height = line(PlotFont::words),
                 digits = line(PlotFont::digits);
    double top = pad;
    const bool title = words && !plot.title.empty();
    if (title) top += line(PlotFont::strong) + 6 * s();
    const double legend_top = top;
    if (rows > 0) top += rows * (words_height + 4 * s()) + 4 * s();
    if (top == pad) top = std::max(top, digits / 2 + 2 * s());
    const bool x_below = least_sides.x_below;
    const std::string x_text = x_below ? "" : axis_text(plot.x.label, plot.x.unit),
                      y_text = axis_text(plot.y.label, plot.y.unit);
    const std::string x_words = words ? x_text : "", y_words = words ? y_text : "";
    const double x_labels = std::max(8 * s(), digits / 2 + s()); // below the frame
    const double below = x_below
                             ? digits / 2 + 2 * s()
                             : x_labels + digits + 0.6 * pad + (x_words.empty() ? 0 : words_height + 3 * s());
    const double bottom = out.height - below;
    // A label too long to stand beside a low frame lies above it.
    y_above = !y_words.empty() && metrics.width_of(PlotFont::words, y_words) > bottom - top;
    if (y_above) top += words_height + 3 * s();
    const PlotRange rx = axis_range(plot, look, 0), ry = axis_range(plot, look, 1);
    out.y = {ry[0], ry[1], bottom, top, is_logarithmic(plot, look, 1)};
    // Their labels say how far left the frame can begin.
    out.y_ticks.clear();
    if (bottom - top > 1) out.y_ticks = vertical_ticks(out.y, plot.y.unit, 1, &out.y_minor);
    double left = 0.8 * pad + widest(out.y_ticks) + 8 * s();
    if (!y_words.empty() && !y_above) left += words_height + 5 * s();
    out.own_sides = {left, 1.4 * pad};
    left = std::max(left, least_sides.left);
    for (PlotTick& tick : out.y_ticks)
      if (tick.label) {
        tick.label->box.left += left - 8 * s();
        tick.label->box.right += left - 8 * s();
      }
    double right = out.width - std::max(1.4 * pad, least_sides.right);
    out.bar.reset();
    if (plot.heat && bottom - top > 1) {
      out.bar = lay_bar(top, bottom, right);
      right = out.bar->box.left - 12 * s();
    }
    out.area = {std::round(left), std::round(top), std::round(std::max(right, left)),
                std::round(std::max(bottom, top))};
    out.x = {rx[0], rx[1], out.area.left, out.area.right, is_logarithmic(plot, look, 0)};
    out.y.from = out.area.bottom;
    out.y.to = out.area.top;
    out.x_ticks.clear();
    if (out.area.width() > 1) lay_x_ticks(x_labels);
    lay_words(title, pad, x_words, y_words);
    if (detail == Detail::without_words) lay_words_inside(x_text, y_text);
    out.legend.clear();
    rows = detail == Detail::bare ? 0 : lay_legend(legend_top);
  }

  void lay_x_ticks(double below) {
    out.x_ticks = ticks_of(
        out.x, plot.x.unit, 70 * s(), line(PlotFont::digits) * 0.9, 0,
        [&](const std::string& label, double at) {
          return text(PlotFont::digits, label, at, out.area.bottom + below, 0);
        },
        &out.x_minor);
    for (PlotTick& tick : out.x_ticks)
      if (tick.label &&
          (least_sides.x_below || tick.label->box.left < 0 || tick.label->box.right > out.width))
        tick.label.reset();
  }

  void lay_words(bool title, double pad, const std::string& x_words, const std::string& y_words) {
    const PlotBox& area = out.area;
    out.title.reset();
    out.x_label.reset();
    out.y_label.reset();
    if (title)
      out.title =
          text(PlotFont::strong, cut_text(metrics, PlotFont::strong, plot.title, out.width - area.left - pad),
               area.left, pad, -1);
    if (!x_words.empty()) {
      // Below the middle of the frame, or beside that where it would be cut: the unit is at its end.
      const std::string words = cut_text(metrics, PlotFont::words, x_words, out.width - pad);
      const double half = metrics.width_of(PlotFont::words, words) / 2, most = out.width - pad / 2 - half;
      out.x_label = text(PlotFont::words, words, std::min((area.left + area.right) / 2, std::max(most, half)),
                         out.height - 0.6 * pad - line(PlotFont::words), 0);
    }
    if (y_above)
      out.y_label = text(PlotFont::words, cut_text(metrics, PlotFont::words, y_words, out.width - area.left),
                         area.left, area.top - line(PlotFont::words) - 3 * s(), -1);
    else if (!y_words.empty())
      out.y_label = upright(y_words, 0.8 * pad + line(PlotFont::words) / 2, (area.top + area.bottom) / 2,
                            area.height());
  }

  // Where there is no room beside the frame, in its corners: numbers without a unit say nothing.
  void lay_words_inside(const std::string& x_words, const std::string& y_words) {
    const PlotBox inner = out.area.grown(-4 * s());
    const double height = line(PlotFont::words);
    if (inner.height() < height) return;
    const auto corner = [&](const std::string& words, double x, double top, double anchor, double room) {
      PlotText placed =
          text(PlotFont::words, cut_text(metrics, PlotFont::words, words, room), x, top, anchor);
      placed.backed = true; // curves cross it
      return placed;
    };
    const bool one_line = inner.height() < 2 * height + 4 * s();
    const double each = one_line ? inner.width() / 2 - 4 * s() : inner.width();
    if (PlotText y = corner(y_words, inner.left, inner.top, -1, each); !y.text.empty())
      out.y_label = std::move(y);
    if (PlotText x = corner(x_words, inner.right, inner.bottom - height, 1, each); !x.text.empty())
      out.x_label = std::move(x);
  }

  PlotBar lay_bar(double top, double bottom, double right) const {
    PlotBar bar;
    const PlotHeat& heat = *plot.heat;
    const PlotRange range = heat_range(heat);
    bar.ruler = {range[0], range[1], std::round(bottom), std::round(top), heat.logarithmic};
    bar.ticks = vertical_ticks(bar.ruler, heat.unit, -1, nullptr);
    const std::string words = detail == Detail::all ? axis_text(heat.label, heat.unit) : "";
    const double words_width = words.empty() ? 0 : line(PlotFont::words) + 5 * s();
    const double end = right + 6 * s() - words_width, start = end - widest(bar.ticks) - 8 * s() - 14 * s();
    bar.box = {std::round(start), std::round(top), std::round(start + 14 * s()), std::round(bottom)};
    for (PlotTick& tick : bar.ticks)
      if (tick.label) {
        tick.label->box.left += bar.box.right + 8 * s();
        tick.label->box.right += bar.box.right + 8 * s();
      }
    if (!words.empty())
      bar.label =
          upright(words, right + 6 * s() - line(PlotFont::words) / 2, (top + bottom) / 2, bottom - top);
    return bar;
  }

  // The number of rows changes the frame, and the frame the number of rows.
  void lay_all() {
    for (Detail level : {Detail::all, Detail::without_words, Detail::bare}) {
      detail = level;
      rows = 0;
      bool settled = false;
      for (int round = 0; round < 4 && !settled; ++round) {
        const int assumed = rows;
        lay_frame();
        settled = rows <= assumed;
      }
      if (settled && out.area.width() >= 60 * s() && out.area.height() >= 40 * s()) return;
    }
    if (out.drawable()) return;
    out.x_ticks.clear();
    out.y_ticks.clear();
    out.bar.reset();
  }

  PlotBandLines band_lines(std::size_t index) const {
    const PlotBox& area = out.area;
    const double wide = 10 * area.width(), high = 10 * area.height();
    PlotBandLines lines{index, {}};
    bool joined = false;
    for (const auto& [value, lower, upper] : plot.bands[index].points) {
      const double x = out.x.pixel(value), top = out.y.pixel(upper);
      double bottom = out.y.pixel(lower);
      if (out.y.logarithmic && lower <= 0) bottom = area.bottom; // nothing, on that axis
      if (!std::isfinite(x) || !std::isfinite(top) || !std::isfinite(bottom)) {
        joined = false;
        continue;
      }
      if (!joined) lines.lower_upper.emplace_back();
      joined = true;
      const double at = std::clamp(x, area.left - wide, area.right + wide);
      for (const std::size_t k : {0U, 1U})
        lines.lower_upper.back()[k].push_back(
            {at, std::clamp(k == 0 ? bottom : top, area.top - high, area.bottom + high)});
    }
    return lines;
  }

  void lay_contents() {
    if (plot.heat) out.cells = heat_cells(*plot.heat, out);
    for (std::size_t i = 0; i < plot.bands.size(); ++i)
      if (is_shown(plot.bands[i], look)) out.bands.push_back(band_lines(i));
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
      const PlotCurve& curve = plot.curves[i];
      if (!is_shown(curve, look)) continue;
      PlotCurveLines lines{i, {}, {}};
      if (curve.line != PlotLine::none)
        lines.lines = visible_lines(curve.points, out.x, out.y, out.area.grown((curve.width + 2) * s()));
      if (curve.shape != PlotShape::none)
        lines.shapes = visible_points(curve.points, out.x, out.y, out.area.grown(0.5));
      out.curves.push_back(std::move(lines));
    }
    for (std::size_t i = 0; i < plot.references.size(); ++i) {
      const PlotReference& reference = plot.references[i];
      if (!is_shown(reference, look)) continue;
      const double at = out.ruler(reference.axis).pixel(reference.at);
      if (reference.axis == 1 ? at >= out.area.top && at <= out.area.bottom
                              : at >= out.area.left && at <= out.area.right)
        out.references.push_back({i, reference.axis == 1 ? out.area.left : at,
                                  reference.axis == 1 ? at : out.area.top, std::nullopt});
    }
    for (std::size_t i = 0; i < plot.marks.size(); ++i) {
      const double x = out.x.pixel(plot.marks[i].at[0]), y = out.y.pixel(plot.marks[i].at[1]);
      if (out.area.grown(0.5).contains(x, y)) out.marks.push_back({i, x, y, std::nullopt});
    }
    place_labels(plot, out, metrics);
  }
};

} // namespace

PlotLayout plot_layout(const Plot& plot, const PlotLook& look, double width, double height,
                       const PlotMetrics& metrics, const PlotSides& least) {
  Builder builder{plot, look, metrics, least, {}};
  builder.out.width = width;
  builder.out.height = height;
  builder.out.scale = metrics.scale;
  builder.lay_all();
  if (builder.out.drawable()) builder.lay_contents();
  return std::move(builder.out);
}

PlotCurve legend_line(const Plot& plot, const PlotLegendEntry& entry) {
  PlotCurve line;
  if (entry.of == PlotLegendEntry::Of::reference) {
    line.color = plot.references[entry.index].color;
    line.line = plot.references[entry.index].line;
    line.width = reference_width;
    return line;
  }
  const PlotCurve& curve = plot.curves[entry.index];
  line.color = curve.color;
  line.line = curve.line;
  line.width = curve.width;
  line.shape = curve.shape;
  line.shape_size = curve.shape_size;
  return line;
}

} // namespace flyball
