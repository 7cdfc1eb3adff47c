#include "app/plot/label_places.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double mark_radius = 6; // points, with some air

std::size_t count_of(double length, double side) {
  return static_cast<std::size_t>(std::max(1., std::ceil(length / side)));
}

std::size_t square_at(double offset, double side, std::size_t count) {
  return static_cast<std::size_t>(std::clamp(std::floor(offset / side), 0., static_cast<double>(count - 1)));
}

void add_ink(PlotInk& ink, const PlotBox& area, const PixelPoint& a, const PixelPoint& b) {
  const double length = std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1]));
  const int steps = std::clamp(static_cast<int>(std::ceil(2 * length / ink.side)), 1, 10'000);
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double x = a[0] + t * (b[0] - a[0]), y = a[1] + t * (b[1] - a[1]);
    if (area.contains(x, y))
      ink.squares[square_at(y - area.top, ink.side, ink.rows) * ink.columns +
                  square_at(x - area.left, ink.side, ink.columns)] = 1;
  }
}

PlotInk ink_of_lines(const PlotLayout& layout) {
  const PlotBox& area = layout.area;
  PlotInk ink;
  ink.side = 4 * layout.scale;
  ink.columns = count_of(area.width(), ink.side);
  ink.rows = count_of(area.height(), ink.side);
  ink.squares.assign(ink.columns * ink.rows, 0);
  for (const PlotCurveLines& curve : layout.curves) {
    for (const PixelLine& line : curve.lines)
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
        add_ink(ink, area, line[i], line[i + 1]);
    for (const PixelPoint& p : curve.shapes)
      add_ink(ink, area, p, p);
  }
  for (const PlotBandLines& band : layout.bands)
    for (const auto& lower_upper : band.lower_upper)
      for (const PixelLine& edge : lower_upper)
        for (std::size_t i = 0; i + 1 < edge.size(); ++i)
          add_ink(ink, area, edge[i], edge[i + 1]);
  return ink;
}

double ink_under(const PlotInk& ink, const PlotBox& area, const PlotBox& box) {
  int sum = 0;
  if (ink.squares.empty()) return 0;
  for (std::size_t row = square_at(box.top - area.top, ink.side, ink.rows);
       row <= square_at(box.bottom - area.top, ink.side, ink.rows); ++row)
    for (std::size_t column = square_at(box.left - area.left, ink.side, ink.columns);
         column <= square_at(box.right - area.left, ink.side, ink.columns); ++column)
      sum += ink.squares[row * ink.columns + column];
  return sum;
}

PlotText text_at(const std::string& text, double left, double top, double anchor,
                 const PlotMetrics& metrics) {
  const double width = metrics.width_of(PlotFont::words, text), height = metrics.height_of(PlotFont::words);
  return {text, {left, top, left + width, top + height}, anchor, PlotFont::words};
}

// The best first.
std::vector<PlotText> places_beside(double x, double y, const std::string& text, double reach,
                                    const PlotMetrics& metrics) {
  const double width = metrics.width_of(PlotFont::words, text), height = metrics.height_of(PlotFont::words);
  std::vector<PlotText> places;
  for (double grown : {1., 2., 3.2}) {
    const double r = reach * grown, d = 0.75 * r;
    const double above = y - d - height, below = y + d, middle = y - height / 2;
    places.push_back(text_at(text, x + d, above, -1, metrics));
    places.push_back(text_at(text, x - d - width, above, 1, metrics));
    places.push_back(text_at(text, x + d, below, -1, metrics));
    places.push_back(text_at(text, x - d - width, below, 1, metrics));
    places.push_back(text_at(text, x + r + 2 * metrics.scale, middle, -1, metrics));
    places.push_back(text_at(text, x - r - 2 * metrics.scale - width, middle, 1, metrics));
    places.push_back(text_at(text, x - width / 2, y - r - height, 0, metrics));
    places.push_back(text_at(text, x - width / 2, y + r, 0, metrics));
  }
  return places;
}

std::vector<PlotText> places_along(const PlotLayout& layout, const PlotReference& reference, double at,
                                   const PlotMetrics& metrics) {
  const double width = metrics.width_of(PlotFont::words, reference.label);
  const double height = metrics.height_of(PlotFont::words), gap = 4 * metrics.scale, near = metrics.scale;
  const PlotBox& area = layout.area;
  std::vector<PlotText> places;
  if (reference.axis == 1) {
    for (double top : {at - near - height, at + near})
      for (double part : {1., 0., 0.75, 0.25, 0.5})
        places.push_back(text_at(reference.label, area.left + gap + part * (area.width() - 2 * gap - width),
                                 top, 2 * part - 1, metrics));
  } else {
    for (double part : {0., 1., 0.25, 0.75, 0.5})
      for (bool right : {true, false})
        places.push_back(text_at(reference.label, right ? at + gap : at - gap - width,
                                 area.top + gap + part * (area.height() - 2 * gap - height), right ? -1 : 1,
                                 metrics));
  }
  return places;
}

struct Obstacle {
  PlotBox box;
  const PlotPlaced* owner = nullptr; // whose label may lie close to it
};

std::optional<PlotText> best_place(const PlotLayout& layout, const std::vector<PlotText>& places,
                                   const std::vector<Obstacle>& taken, const PlotPlaced* owner) {
  const PlotText* best = nullptr;
  double least = 0;
  const PlotBox inner = layout.area.grown(-layout.scale);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PlotBox& box = places[i].box;
    if (!inner.contains(box.left, box.top) || !inner.contains(box.right, box.bottom)) continue;
    if (std::ranges::any_of(taken, [&](const Obstacle& o) {
          return box.overlaps(o.box, owner && o.owner == owner ? 0 : 2 * layout.scale);
        }))
      continue;
    const double cost = 0.4 * static_cast<double>(i) + ink_under(layout.ink, layout.area, box);
    if (best && cost >= least) continue;
    best = &places[i];
    least = cost;
  }
  if (!best) return std::nullopt;
  PlotText placed = *best;
  placed.backed = ink_under(layout.ink, layout.area, placed.box) > 0;
  return placed;
}

PlotBox around(double x, double y, double radius) {
  return {x - radius, y - radius, x + radius, y + radius};
}

} // namespace

void place_labels(const Plot& plot, PlotLayout& layout, const PlotMetrics& metrics) {
  if (plot.references.empty() && plot.marks.empty() && !plot.marker) return;
  layout.ink = ink_of_lines(layout);
  std::vector<Obstacle> taken;
  for (const PlotPlaced& mark : layout.marks)
    taken.push_back({around(mark.x, mark.y, 4 * metrics.scale), &mark});
  for (const auto* words : {&layout.x_label, &layout.y_label}) // which may lie inside
    if (*words) taken.push_back({(*words)->box, nullptr});
  for (PlotPlaced& placed : layout.references) {
    const PlotReference& reference = plot.references[placed.index];
    if (reference.label.empty() || reference.in_legend) continue;
    const double at = reference.axis == 1 ? placed.y : placed.x;
    placed.label = best_place(layout, places_along(layout, reference, at, metrics), taken, nullptr);
    if (placed.label) taken.push_back({placed.label->box, nullptr});
  }
  for (const PlotPlaced& r : layout.references)
    add_ink(layout.ink, layout.area, {r.x, r.y},
            plot.references[r.index].axis == 1 ? PixelPoint{layout.area.right, r.y}
                                               : PixelPoint{r.x, layout.area.bottom});
  for (PlotPlaced& placed : layout.marks) {
    const PlotMark& mark = plot.marks[placed.index];
    if (mark.label.empty()) continue;
    placed.label = best_place(
        layout, places_beside(placed.x, placed.y, mark.label, mark_radius * metrics.scale, metrics), taken,
        &placed);
    if (placed.label) taken.push_back({placed.label->box, nullptr});
  }
}

std::optional<PlotText> label_beside(const PlotLayout& layout, double x, double y, const std::string& text,
                                     const PlotMetrics& metrics) {
  std::vector<Obstacle> taken;
  for (const PlotPlaced& p : layout.marks)
    taken.push_back({around(p.x, p.y, 4 * metrics.scale), nullptr});
  for (const auto* placed : {&layout.references, &layout.marks})
    for (const PlotPlaced& p : *placed)
      if (p.label) taken.push_back({p.label->box, nullptr});
  for (const auto* words : {&layout.x_label, &layout.y_label})
    if (*words) taken.push_back({(*words)->box, nullptr});
  return best_place(layout, places_beside(x, y, text, (mark_radius + 3) * metrics.scale, metrics), taken,
                    nullptr);
}

} // namespace flyball
