#include "app/ui/studies/response/response_plot.hpp"

#include "app/plot/axis.hpp"
#include "app/plot/friction_curve.hpp"
#include "app/plot/ribbon_plot.hpp"
#include "app/session/number_text.hpp"
#include "app/session/response_pull.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

enum class Kind { stable, unstable, undecided };

// A curve without points.
PlotCurve look_of(Kind kind, const ResponsePoint& point) {
  if (!point.frictions.empty()) {
    const auto stable = kind == Kind::undecided ? std::nullopt : std::optional<bool>(kind == Kind::stable);
    return friction_curve(slips_on_friction(point), stable);
  }
  switch (kind) {
  case Kind::stable: return {.name = "stable", .points = {}, .width = 2};
  case Kind::unstable:
    return {.name = "unstable",
            .points = {},
            .line = PlotLine::dashed,
            .color = plot_color::vermillion,
            .width = 1.6};
  case Kind::undecided: break;
  }
  return {.name = point.stability_reason == StabilityReason::neutral ? "neutral" : "undecided",
          .points = {},
          .line = PlotLine::dotted,
          .color = plot_color::neutral,
          .width = 1.6};
}

Kind kind_of(const ResponsePoint& point) {
  return !point.stable ? Kind::undecided : *point.stable ? Kind::stable : Kind::unstable;
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
  const PlotCurve look = look_of(kind, line.points[first]);
  const std::size_t begin = plot.curves.size();
  for (std::size_t l = 0; l < lines; ++l) {
    PlotCurve curve = look;
    for (std::size_t i = first; i <= last; ++i) {
      if (!line.points[i].frictions.empty()) curve.notes.push_back(friction_note(line.points[i]));
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

// `largest`: of the varied number on the curve, beside which rounding is zero.
std::string mark_label(const SpecialPoint& special, const ShownUnit& unit, double largest) {
  std::string label(word(special.type));
  std::ranges::replace(label, '_', ' ');
  if (special.type == SpecialPointType::hopf) label = "Hopf";
  const double at = std::abs(special.at.parameter) < 1e-12 * largest ? 0 : special.at.parameter;
  return label + " " + short_text(unit.shown(at), 6) + (unit.text.empty() ? "" : " " + unit.text);
}

// What was found of the band, also while it is found anew for a curve that moves.
std::shared_ptr<const void> shown_band(const Session& session) {
  const auto& band = session.study.band.computed;
  const bool fits =
      band.found && (band.found->of.curve == session.study.response.curve.found || band.running());
  return fits && session.study.band.wanted ? band.found : nullptr;
}

// In SI units. Where samples leave the branch the band is of the others alone, and looks so.
void add_band(const Session& session, Plot& plot) {
  const std::optional<std::size_t> output = band_output(session);
  if (!output || !shown_band(session)) return;
  const FoundBand& found = session.study.band.computed.found->result;
  for (const BandStretch& stretch : found.stretches) {
    bool joined = false;
    for (std::size_t i = stretch.first; i + 1 < stretch.first + stretch.count; ++i) {
      if (i + 1 >= found.band.points.size()) break;
      const BandPoint &a = found.band.points[i], &b = found.band.points[i + 1];
      if (a.outputs.empty() || b.outputs.empty() || a.outputs[*output].count == 0 ||
          b.outputs[*output].count == 0) {
        joined = false;
        continue;
      }
      const bool some = a.others() > 0 || b.others() > 0;
      const std::string name = some ? "5 % to 95 % of those that follow" : "5 % to 95 % of samples";
      if (!joined || plot.bands.back().name != name) {
        plot.bands.push_back({name, {}, some ? plot_color::orange : plot_color::sky_blue});
        plot.bands.back().points.push_back({a.number, a.outputs[*output].low, a.outputs[*output].high});
      }
      plot.bands.back().points.push_back({b.number, b.outputs[*output].low, b.outputs[*output].high});
      joined = true;
    }
  }
  // The legend begins with what is the rule.
  std::stable_partition(plot.bands.begin(), plot.bands.end(),
                        [](const PlotBand& band) { return band.color == plot_color::sky_blue; });
}

// Where friction lets coordinates and measures stand; in SI units.
void add_friction(const Session& session, Plot& plot) {
  const auto ribbon = shown_ribbon(session);
  const std::optional<std::string> name = banded_quantity(session);
  if (!ribbon || !name) return;
  const std::span<const RibbonPoint> all = ribbon->result.points;
  for (const BandStretch& stretch : ribbon->result.stretches)
    if (stretch.first < all.size())
      add_ribbon(plot, all.subspan(stretch.first, std::min(stretch.count, all.size() - stretch.first)),
                 *name);
}

} // namespace

Plot response_plot(const ResponseCurve::Found& found, const ResponseQuantity& quantity,
                   const DisplayUnits& units, std::vector<ResponsePiece>& pieces) {
  const ResponseRequest& of = found.of;
  const ResponseResult& result = found.result;
  Plot plot;
  pieces.clear();
  const std::string unit = parameter_unit(*of.mechanism, of.address);
  plot.x = {.label = number_phrase(*of.mechanism, of.address),
            .unit = unit,
            .logarithmic = of.logarithmic,
            .range = PlotRange{std::min(of.from, of.to), std::max(of.from, of.to)},
            .room = 0};
  plot.y.label = quantity.title;
  plot.y.unit = quantity.unit;
  for (std::size_t i = 0; i < result.lines.size(); ++i)
    add_line(result.lines[i], i, quantity, plot, pieces);
  for (const SpecialPoint& special : result.diagram.special)
    if (const auto y = quantity_mark(special.at, quantity.key))
      plot.marks.push_back(
          {.at = {special.at.parameter, *y * quantity.factor},
           .label =
               mark_label(special, shown_unit(unit, units), std::max(std::abs(of.from), std::abs(of.to))),
           .shape = special.type == SpecialPointType::branch_point ? PlotShape::diamond : PlotShape::circle});
  return plot;
}

void draw_response(const Session& session, ResponseView& drawn) {
  const ResponseState& state = session.study.response;

  ResponseChoice choice = state.choice;
  choice.all = false; // more branches are looked at as before
  if (drawn.fitted != choice) fit_plot(drawn.view);
  drawn.fitted = choice;
  const ResponseQuantity& quantity = state.shown;
  const auto& curve = state.curve.found;
  const auto& design = state.design.answer.found;
  // Until a curve with reactions is there the one before stays.
  const bool told = curve && (curve->of.reactions || !needs_reactions(state.choice.quantity));
  const bool pulled = drawn.view.drag == PlotView::Drag::pull;
  const ResponseView::Of of{
      curve,         design, shown_band(session), shown_ribbon(session), state.choice.quantity,
      session.units, pulled};
  if (drawn.of != of && told) {
    const std::optional<PlotRange> before = drawn.plot.y.range;
    Plot plot = response_plot(*curve, quantity, session.units, drawn.pieces);
    if (design && design->of.goal.quantity == state.choice.quantity &&
        design->of.of.address == curve->of.address) {
      const double wanted = design->of.value * quantity.factor;
      plot.references.push_back({.axis = 1, .at = wanted, .label = "wanted", .color = plot_color::green});
      for (const DesignSolution& s : design->result.solutions)
        plot.marks.push_back({.at = {s.parameter, wanted},
                              .label = "",
                              .shape = PlotShape::diamond,
                              .color = plot_color::green});
    }
    add_band(session, plot);
    add_friction(session, plot);
    show_axis(plot, 0, plot.x.unit, session.units);
    show_axis(plot, 1, quantity.unit, session.units);
    const bool same = drawn.plot.y.label == plot.y.label && drawn.plot.x.label == plot.x.label &&
                      drawn.plot.x.range == plot.x.range;
    // While one slider is dragged the axis only grows: a curve that moves is seen against it.
    PlotRange range = axis_range(plot, {}, 1);
    // While its point is pulled the axis stays, or the place under the hand would run away.
    if (before && same && pulled)
      range = *before;
    else if (before && same && drawn.gesture == session.gesture)
      range = {std::min(range[0], (*before)[0]), std::max(range[1], (*before)[1])};
    plot.y.range = range;
    replace_plot(drawn.plot, std::move(plot));
    drawn.gesture = session.gesture;
    drawn.of = of;
  }
  drawn.plot.marker.reset();
  if (!curve || !converged(session)) return;
  const std::optional<ResponsePoint> now = present_point(session, curve->of.address);
  if (!now) return;
  const auto y = quantity_mark(*now, state.choice.quantity);
  if (!y) return;
  drawn.plot.marker =
      PlotMarker{now->parameter * drawn.plot.x.factor, *y * quantity.factor * drawn.plot.y.factor, ""};
  if (pulled_goal(session).empty()) return;
  drawn.plot.marker->pull = pull_words(session);
  if (const GoalAnswer* answer = sought(session); pulled && answer && !answer->reached)
    drawn.plot.marker->label = "the nearest";
}

void go_to_hit(Session& session, const ResponseView& drawn, const PlotHit& hit, bool dragged) {
  const ResponseState& state = session.study.response;

  if (hit.curve >= drawn.pieces.size()) return;
  const ResponsePiece& piece = drawn.pieces[hit.curve];
  const double span = std::abs(state.choice.to - state.choice.from);
  double step = std::pow(10, std::floor(std::log10(span)) - 4);
  // A logarithmic range needs more digits at its lower end.
  if (const double x = hit.x / drawn.plot.x.factor; state.choice.logarithmic && x > 0)
    step = std::pow(10, std::floor(std::log10(x)) - 4);
  go_to_response(session, piece.line, static_cast<double>(piece.first) + hit.index, step, dragged);
}

} // namespace flyball
