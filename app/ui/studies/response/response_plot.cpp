// From branches to curves: what is stable, what is not, and where that changes.
#include "app/session/number_text.hpp"
#include "app/ui/studies/response/response_control.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

enum class Kind { stable, unstable, undecided };

struct KindLook {
  const char* name;
  PlotLine line;
  int color;
};

KindLook look_of(Kind kind) {
  switch (kind) {
  case Kind::stable: return {"stable", PlotLine::solid, plot_color::blue};
  case Kind::unstable: return {"unstable", PlotLine::dashed, plot_color::vermillion};
  case Kind::undecided: break;
  }
  return {"undecided", PlotLine::dotted, plot_color::neutral};
}

Kind kind_of(const ResponsePoint& point) {
  return !point.stable ? Kind::undecided : *point.stable ? Kind::stable : Kind::unstable;
}

// How far apart two points look: the parameter over `range`, coordinates in radians and metres.
double distance(const ResponsePoint& a, const ResponsePoint& b, double range) {
  double square = std::pow((a.parameter - b.parameter) / range, 2);
  for (std::size_t i = 0; i < a.coordinates.size() && i < b.coordinates.size(); ++i) {
    double step = a.coordinates[i].value - b.coordinates[i].value;
    if (a.coordinates[i].angle) step = std::remainder(step, 2 * std::numbers::pi);
    square += step * step;
  }
  return std::sqrt(square);
}

// Where a special point belongs in its branch: the gap that it lengthens least. 0: before all points, or at
// the first itself.
std::size_t gap_for(const ResponsePoint& point, const std::vector<ResponsePoint>& points, double range) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double longer = distance(points[i - 1], point, range) + distance(point, points[i], range) -
                          distance(points[i - 1], points[i], range);
    if (longer >= least) continue;
    least = longer;
    best = i;
  }
  return best;
}

// Whether point i only marks where two pieces meet: there stability is undecided by nature.
bool is_border(const ResponseLine& line, std::size_t i) {
  if (line.special[i]) return true;
  if (kind_of(line.points[i]) != Kind::undecided) return false;
  const auto decided = [&](std::size_t k) {
    return line.special[k] || kind_of(line.points[k]) != Kind::undecided;
  };
  return line.points.size() > 1 && (i == 0 || decided(i - 1)) &&
         (i + 1 == line.points.size() || decided(i + 1));
}

// Of the stretch between points i and i + 1.
Kind kind_between(const ResponseLine& line, std::size_t i) {
  const bool before = is_border(line, i), beyond = is_border(line, i + 1);
  if (!before && !beyond) {
    const Kind a = kind_of(line.points[i]), b = kind_of(line.points[i + 1]);
    return a == b ? a : a == Kind::stable ? b : a; // not stable before it is known to be
  }
  if (!before) return kind_of(line.points[i]);
  if (!beyond) return kind_of(line.points[i + 1]);
  // Between two special points: as the next that is neither.
  for (std::size_t k = i + 2; k < line.points.size(); ++k)
    if (!is_border(line, k)) return kind_of(line.points[k]);
  return Kind::undecided;
}

// An angle that is told in (-pi, pi] goes round between the two.
bool goes_round(double a, double b, const std::string& key, const ResponseQuantity& quantity) {
  return key.starts_with("value ") && quantity.unit == "rad" && std::abs(a - b) > std::numbers::pi;
}

bool same_points(const PlotCurve& a, const PlotCurve& b) {
  return a.points == b.points;
}

// One piece of a line: as many curves as the quantity has values.
void add_piece(const ResponseLine& line, std::size_t index, std::size_t first, std::size_t last, Kind kind,
               const ResponseQuantity& quantity, Plot& plot, std::vector<ResponsePiece>& pieces) {
  std::vector<std::vector<double>> values;
  std::size_t lines = 0;
  for (std::size_t i = first; i <= last; ++i) {
    values.push_back(quantity_values(line.points[i], quantity.key));
    lines = std::max(lines, values.back().size());
  }
  const KindLook look = look_of(kind);
  const std::size_t begin = plot.curves.size();
  for (std::size_t l = 0; l < lines; ++l) {
    PlotCurve curve;
    curve.name = look.name;
    curve.line = look.line;
    curve.color = look.color;
    curve.width = kind == Kind::stable ? 2 : 1.6;
    for (std::size_t i = first; i <= last; ++i) {
      const std::vector<double>& v = values[i - first];
      curve.points.push_back(
          {line.points[i].parameter, v.size() == lines ? v[l] * quantity.factor : std::nan("")});
    }
    // Both of a conjugate pair.
    const bool twin = std::any_of(plot.curves.begin() + static_cast<std::ptrdiff_t>(begin), plot.curves.end(),
                                  [&](const PlotCurve& other) { return same_points(other, curve); });
    if (twin) continue;
    plot.curves.push_back(std::move(curve));
    pieces.push_back({index, first});
  }
}

void add_line(const ResponseLine& line, std::size_t index, const ResponseQuantity& quantity, Plot& plot,
              std::vector<ResponsePiece>& pieces) {
  for (std::size_t i = 0; i + 1 < line.points.size();) {
    const Kind kind = kind_between(line, i);
    std::size_t last = i + 1;
    const auto round = [&](std::size_t k) {
      const auto a = quantity_values(line.points[k], quantity.key),
                 b = quantity_values(line.points[k + 1], quantity.key);
      return !a.empty() && !b.empty() && goes_round(a[0], b[0], quantity.key, quantity);
    };
    if (round(i)) {
      ++i;
      continue;
    }
    while (last + 1 < line.points.size() && kind_between(line, last) == kind && !round(last))
      ++last;
    add_piece(line, index, i, last, kind, quantity, plot, pieces);
    i = last;
  }
}

std::string mark_label(const SpecialPoint& special, const ShownUnit& unit) {
  std::string label(word(special.type));
  std::ranges::replace(label, '_', ' ');
  if (special.type == SpecialPointType::hopf) label = "Hopf";
  return label + " " + short_text(unit.shown(special.at.parameter), 6) +
         (unit.text.empty() ? "" : " " + unit.text);
}

} // namespace

std::vector<ResponseLine> response_lines(ResponseDiagram& diagram) {
  std::vector<ResponseLine> lines;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (ResponseBranch& branch : diagram.branches) {
    for (const ResponsePoint& p : branch.points) {
      low = std::min(low, p.parameter);
      high = std::max(high, p.parameter);
    }
    lines.push_back({std::move(branch.points), {}, branch.connected});
    lines.back().special.assign(lines.back().points.size(), 0);
    branch.points.clear();
  }
  const double range = high > low ? high - low : 1;
  for (const SpecialPoint& special : diagram.special) {
    if (special.branch < 0 || static_cast<std::size_t>(special.branch) >= lines.size()) continue;
    ResponseLine& line = lines[static_cast<std::size_t>(special.branch)];
    const std::size_t gap = gap_for(special.at, line.points, range);
    if (gap == 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(gap);
    line.points.insert(line.points.begin() + at, special.at);
    line.special.insert(line.special.begin() + at, 1);
  }
  return lines;
}

Plot response_plot(const ResponseResult& result, const ResponseQuantity& quantity, const DisplayUnits& units,
                   std::vector<ResponsePiece>& pieces) {
  Plot plot;
  pieces.clear();
  const std::string unit = parameter_unit(*result.of.mechanism, result.of.address);
  plot.x = {.label = parameter_phrase(result.of.address),
            .unit = unit,
            .logarithmic = result.of.logarithmic,
            .range =
                PlotRange{std::min(result.of.from, result.of.to), std::max(result.of.from, result.of.to)},
            .room = 0};
  plot.y.label = quantity.title;
  plot.y.unit = quantity.unit;
  for (std::size_t i = 0; i < result.lines.size(); ++i)
    add_line(result.lines[i], i, quantity, plot, pieces);
  for (const SpecialPoint& special : result.diagram.special)
    if (const auto y = quantity_mark(special.at, quantity.key))
      plot.marks.push_back(
          {.at = {special.at.parameter, *y * quantity.factor},
           .label = mark_label(special, shown_unit(unit, units)),
           .shape = special.type == SpecialPointType::branch_point ? PlotShape::diamond : PlotShape::circle});
  return plot;
}

} // namespace flyball
