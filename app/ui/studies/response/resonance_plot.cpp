#include "app/ui/studies/response/resonance_plot.hpp"

#include "app/plot/axis.hpp"
#include "app/plot/resonance_plot.hpp"
#include "app/session/resonance.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

Plot plot_of(const ResonanceStudy::Found& found, const ResponseQuantity& quantity) {
  const ResponseRequest& of = found.of;
  Plot plot;
  plot.x = {.label = number_phrase(*of.mechanism, of.address),
            .unit = parameter_unit(*of.mechanism, of.address),
            .logarithmic = of.logarithmic,
            .range = PlotRange{std::min(of.from, of.to), std::max(of.from, of.to)},
            .room = 0};
  plot.y.label = quantity.title;
  plot.y.unit = quantity.unit;
  if (const auto key = resonance_key(quantity.key)) add_resonance(plot, found.result, key->kind, key->name);
  return plot;
}

// Where the mean of the motion that is shown is; none where it does not tell the quantity.
std::optional<PlotMarker> present_marker(const Session& session, const ResponseView& drawn,
                                         const std::string& address) {
  const auto key = resonance_key(session.study.response.shown.key);
  const std::optional<ResonancePoint> now = key ? present_resonance(session, address) : std::nullopt;
  const PeriodicRange* range = now ? now->range_of(key->kind, key->name) : nullptr;
  if (!range || !std::isfinite(range->mean)) return std::nullopt;
  return PlotMarker{now->number * drawn.plot.x.factor, range->mean * drawn.plot.y.factor, ""};
}

} // namespace

void draw_resonance(const Session& session, ResponseView& drawn) {
  const ResponseState& state = session.study.response;
  if (drawn.fitted != state.choice) fit_plot(drawn.view);
  drawn.fitted = state.choice;
  const auto& found = state.resonance.found;
  const ResponseView::Of of{found, {}, {}, {}, state.shown.key, session.units};
  if (drawn.of != of) {
    Plot plot = plot_of(*found, state.shown);
    show_axis(plot, 0, plot.x.unit, session.units);
    show_axis(plot, 1, plot.y.unit, session.units);
    plot.y.range = axis_range(plot, {}, 1);
    replace_plot(drawn.plot, std::move(plot));
    drawn.pieces.clear();
    drawn.of = of;
  }
  drawn.plot.marker = present_marker(session, drawn, found->of.address);
}

void go_to_resonance(Session& session, const ResponseView& drawn, const PlotHit& hit) {
  const auto& found = session.study.response.resonance.found;
  if (!found) return;
  const double x = hit.x / drawn.plot.x.factor;
  // A logarithmic range needs more digits at its lower end.
  const double span = found->of.logarithmic ? std::abs(x) : std::abs(found->of.to - found->of.from);
  const double step = std::pow(10, std::floor(std::log10(span)) - 3);
  change_parameter(session, found->of.address, std::round(x / step) * step);
}

} // namespace flyball
