#include "app/session/spread.hpp"

#include "app/session/session.hpp"
#include "app/session/variable_numbers.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr std::size_t most_at_first = 6; // tolerances

SpreadAnswer find_samples(const SpreadRequest& request, const TaskContext<SpreadAnswer>& context) {
  SpreadOptions options;
  options.samples = request.samples;
  options.seed = request.seed;
  options.start = request.start;
  options.cancel = &context.cancel;
  options.progress = [&](std::size_t done, std::size_t all) {
    context.progress({"solving", static_cast<double>(done) / static_cast<double>(all)});
  };
  ThreadSharing sharing;
  return spread(*request.mechanism, request.tolerances, options, sharing);
}

SpreadRequest request_now(const Session& session) {
  const SpreadChoice& choice = session.study.spread.choice;
  return {{session.document.shared()},
          chosen_tolerances(session),
          choice.samples,
          choice.seed,
          start_values(session.answer.solution.coordinates)};
}

void take_samples(Session& session) {
  SpreadState& state = session.study.spread;
  if (!state.samples.take("Making the samples was stopped.")) return;
  const auto& found = state.samples.found;
  if (!found || !state.samples.problem.empty()) return;
  state.refused = found->result.status != Status::converged;
  if (state.refused) {
    state.samples.problem = found->result.message;
    state.samples.found.reset();
    return;
  }
  if (shown_output(session)) return;
  // At first what the response shows, or else a length, as of a collar.
  const std::vector<SpreadOutput>& outputs = found->result.outputs;
  const std::string& key = session.study.response.choice.quantity;
  auto first = std::ranges::find_if(outputs, [&](const SpreadOutput& output) {
    return key == "value " + output.name || key == "measure " + output.name;
  });
  if (first == outputs.end()) first = std::ranges::find(outputs, "m", &SpreadOutput::unit);
  state.output = (first == outputs.end() ? outputs.front() : *first).name;
}

} // namespace

std::vector<Tolerance> chosen_tolerances(const Session& session) {
  std::vector<Tolerance> tolerances;
  for (const ChosenTolerance& chosen : session.study.spread.choice.tolerances) {
    if (!has_number(session.mechanism(), chosen.address)) continue;
    const double value = get_parameter(session.mechanism(), chosen.address);
    const double width = chosen.percent ? std::abs(value) * chosen.width / 100 : chosen.width;
    if (width > 0) tolerances.push_back({chosen.address, chosen.distribution, width});
  }
  return tolerances;
}

void choose_tolerances(Session& session) {
  SpreadState& state = session.study.spread;
  if (state.begun || session.parameters.empty()) return;
  state.begun = true;
  // Controls come in groups, pinned ones first.
  const ParameterGroup group = session.parameters.front().group;
  for (const ParameterControl& control : session.parameters)
    if (control.group == group && control.value != 0 && state.choice.tolerances.size() < most_at_first)
      add_tolerance(session, control.address);
}

std::vector<std::string> numbers_without_tolerance(const Session& session) {
  std::vector<std::string> addresses = variable_numbers(session, Dampers::without);
  std::erase_if(addresses, [&](const std::string& address) {
    return std::ranges::find(session.study.spread.choice.tolerances, address, &ChosenTolerance::address) !=
           session.study.spread.choice.tolerances.end();
  });
  return addresses;
}

void add_tolerance(Session& session, const std::string& address) {
  ChosenTolerance chosen{.address = address};
  if (get_parameter(session.mechanism(), address) == 0) { // of which 1 % is nothing
    const Slider slider = slider_for(session.mechanism(), address, session.units);
    chosen.percent = false;
    chosen.width = std::abs(slider.to - slider.from) / 100;
  }
  session.study.spread.choice.tolerances.push_back(std::move(chosen));
}

void tell_in_percent(Session& session, std::size_t tolerance, bool percent) {
  ChosenTolerance& chosen = session.study.spread.choice.tolerances.at(tolerance);
  if (chosen.percent == percent) return;
  const double value = std::abs(get_parameter(session.mechanism(), chosen.address));
  if (percent && value == 0) return;
  chosen.width *= percent ? 100 / value : value / 100;
  chosen.percent = percent;
}

const SpreadOutput* shown_output(const Session& session) {
  const SpreadState& state = session.study.spread;
  if (!state.samples.found) return nullptr;
  const std::vector<SpreadOutput>& outputs = state.samples.found->result.outputs;
  const auto shown = std::ranges::find(outputs, state.output, &SpreadOutput::name);
  return shown == outputs.end() ? nullptr : &*shown;
}

void sample_spread(Session& session) {
  SpreadState& state = session.study.spread;
  if (!converged(session) || chosen_tolerances(session).empty()) return;
  // While a hand drags a slider every histogram that was begun is worth seeing; of another choice only its
  // own.
  const bool same = state.samples.asked && state.asked == state.choice;
  state.asked = state.choice;
  state.stale = false;
  state.samples.ask(session.options, request_now(session), find_samples,
                    same ? BackgroundWorker::Running::finished : BackgroundWorker::Running::cancelled);
  take_samples(session); // in immediate mode they are there
}

void update_spread(Session& session) {
  if (session.study.open != StudyKind::spread) return;
  SpreadState& state = session.study.spread;
  take_samples(session);
  if (session.mode != Mode::explore || !session.mistakes.empty()) return;
  choose_tolerances(session);
  if (!converged(session) || solving(session)) return;
  if (!state.samples.asked || state.asked != state.choice) return sample_spread(session);
  state.stale = *state.samples.asked != request_now(session);
  if (state.stale && (state.samples.quick() || state.refused)) sample_spread(session);
}

void close_spread(Session& session) {
  SpreadState fresh;
  fresh.choice = session.study.spread.choice;
  fresh.begun = session.study.spread.begun;
  fresh.output = session.study.spread.output;
  session.study.spread = std::move(fresh);
}

} // namespace flyball
