#include "app/session/spread_band.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr double parts = 40;             // of the range, along one line
constexpr std::size_t most_places = 160; // of all lines

FoundBand find_band(const BandRequest& request, const TaskContext<FoundBand>& context) {
  const ResponseRequest& of = request.curve->of;
  SpreadOptions options;
  options.samples = band_samples;
  options.seed = request.seed;
  options.cancel = &context.cancel;
  options.progress = [&](std::size_t done, std::size_t all) {
    context.progress({"making the band", static_cast<double>(done) / static_cast<double>(all)});
  };
  FoundBand found;
  std::vector<BandPlace> places;
  for (const BandRun& run : band_runs(*request.curve, BandOf::stable)) {
    found.stretches.push_back({places.size(), run.apart.size()});
    for (const std::size_t i : run.apart)
      places.push_back({run.states[i]->parameter, start_values(run.states[i]->coordinates)});
  }
  ThreadSharing sharing;
  found.band = spread_band(*of.mechanism, of.address, places, request.tolerances, options, sharing);
  return found;
}

bool rests_on_friction(const ResponseLine& line) {
  return !line.points.empty() && !line.points.front().frictions.empty();
}

std::string share_text(double share) {
  return share < 0.001 ? "under 0.1 %" : short_text(100 * share, 2) + " %";
}

} // namespace

std::vector<BandRun> band_runs(const ResponseCurve::Found& curve, BandOf which) {
  std::vector<BandRun> runs;
  for (const ResponseLine& line : curve.result.lines) {
    if (rests_on_friction(line)) continue;
    bool on = false;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const ResponsePoint& point = line.points[i];
      if ((which == BandOf::any || point.stable == true) && !line.special[i]) {
        if (!on) runs.emplace_back();
        on = true;
        runs.back().states.push_back(&point);
      } else {
        on = on && line.special[i];
      }
    }
  }
  const ResponseRequest& of = curve.of;
  // How far along the axis, in parts of it.
  const auto along = [&](double number) {
    return of.logarithmic ? std::log(number / of.from) / std::log(of.to / of.from)
                          : (number - of.from) / (of.to - of.from);
  };
  std::size_t places = 0;
  double step = 1 / parts;
  do {
    places = 0;
    for (BandRun& run : runs) {
      run.apart.clear();
      double last = 0;
      for (std::size_t i = 0; i < run.states.size(); ++i) {
        const double at = along(run.states[i]->parameter);
        if (i > 0 && i + 1 < run.states.size() && std::abs(at - last) < step) continue;
        last = at;
        run.apart.push_back(i);
      }
      places += run.apart.size();
    }
    step *= 1.5;
  } while (places > most_places && step < 1);
  return runs;
}

std::string band_refusal(const Session& session) {
  const auto& curve = session.study.response.curve.found;
  if (!curve) return "There is no curve.";
  if (!curve->result.lines.empty() && std::ranges::all_of(curve->result.lines, rests_on_friction))
    return "What rests on friction has no band of tolerances.";
  if (session.study.spread.begun && chosen_tolerances(session).empty())
    return "No number has a tolerance: give one to some in Spread.";
  return {};
}

std::optional<std::size_t> band_output(const Session& session) {
  const auto& found = session.study.band.computed.found;
  if (!found) return std::nullopt;
  const std::vector<std::string>& outputs = found->result.band.outputs;
  const std::string& key = session.study.response.choice.quantity;
  for (std::size_t k = 0; k < outputs.size(); ++k)
    if (key == "value " + outputs[k] || key == "measure " + outputs[k]) return k;
  return std::nullopt;
}

std::string band_words(const Session& session) {
  const BandState& state = session.study.band;
  if (!state.wanted || !state.computed.found) return {};
  const ResponseRequest& of = state.computed.found->of.curve->of;
  const SpreadBand& band = state.computed.found->result.band;
  if (!band_output(session))
    return "There is no band of what is shown: samples tell coordinates and measures.";
  std::array<double, fates> most{}; // shares
  double from = 0, to = 0;
  bool any = false;
  for (const BandPoint& point : band.points) {
    if (point.others() == 0) continue;
    from = any ? std::min(from, point.number) : point.number;
    to = any ? std::max(to, point.number) : point.number;
    any = true;
    for (std::size_t fate = 0; fate < most.size(); ++fate)
      most[fate] = std::max(most[fate],
                            static_cast<double>(point.counts[fate]) / static_cast<double>(point.samples()));
  }
  std::string words = "Band: the middle 90 % of " + std::to_string(band_samples) + " samples at each of " +
                      std::to_string(band.points.size()) + " stable states.";
  if (!any) return words;
  const ShownUnit unit = shown_unit(parameter_unit(*of.mechanism, of.address), session.units);
  const std::string after = unit.text.empty() ? "" : " " + unit.text;
  const std::string begin = short_text(unit.shown(from), 4), end = short_text(unit.shown(to), 4);
  words += begin == end ? " At " + begin + after : " From " + begin + " to " + end + after;
  words += " not all follow: ";
  bool first = true;
  const auto add = [&](SampleFate fate, const char* what) {
    const double share = most[static_cast<std::size_t>(fate)];
    if (share == 0) return;
    words += (first ? "up to " : ", ") + share_text(share) + " " + what;
    first = false;
  };
  add(SampleFate::elsewhere, "are in another steady state");
  add(SampleFate::unstable, "in an unstable one");
  add(SampleFate::none, "have none");
  add(SampleFate::no_mechanism, "make no mechanism");
  return words + ".";
}

void update_band(Session& session) {
  BandState& state = session.study.band;
  const auto& curve = session.study.response.curve.found;
  if (!state.wanted || session.study.open != StudyKind::response || !curve) {
    state.computed = {};
    return;
  }
  state.computed.take("Making the band was stopped.");
  if (session.mode != Mode::explore || session.study.response.curve.running()) return;
  choose_tolerances(session);
  BandRequest wanted{curve, chosen_tolerances(session), session.study.spread.choice.seed};
  if (wanted.tolerances.empty()) {
    state.computed = {};
    return;
  }
  if (state.computed.asked == wanted) return;
  // As of the curve: what moves with one slider is worth seeing, another question's is not.
  const auto& asked = state.computed.asked;
  const bool same = asked && asked->curve->of.address == curve->of.address &&
                    asked->curve->of.from == curve->of.from && asked->curve->of.to == curve->of.to;
  state.computed.ask(session.options, std::move(wanted), find_band,
                     same ? BackgroundWorker::Running::finished : BackgroundWorker::Running::cancelled);
  state.computed.take();
}

} // namespace flyball
