#include "app/session/resonance.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/number_text.hpp"
#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

constexpr double soon = 1.5; // s: until then the curve of the numbers before is worth more than a part

// `begun`: a part of this curve; null: none.
ResonanceCurve find_resonance(const ResponseRequest& of, bool same_axis,
                              const std::shared_ptr<const ResonanceStudy::Found>& begun,
                              const TaskContext<ResonanceCurve>& context) {
  const auto begin = std::chrono::steady_clock::now();
  ResonanceOptions options;
  options.logarithmic = of.logarithmic;
  options.cancel = &context.cancel;
  if (begun) options.begun = &begun->result;
  options.progress = context.progress;
  options.publish = [&](const ResonanceCurve& so_far) {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    const bool grown = so_far.points.size() >= static_cast<std::size_t>(options.coarse);
    if (!same_axis || grown || taken.count() > soon) context.publish(so_far);
  };
  return resonance_curve(*of.mechanism, of.address, of.from, of.to, options);
}

// `words`: of its name, where that is a coordinate's.
ResponseQuantity quantity_of(const ResonanceOutput& output, const std::string& words) {
  switch (output.kind) {
  case OutputKind::coordinate: return {"value " + output.name, words, "Coordinates", output.unit, 1};
  case OutputKind::measure: return {"measure " + output.name, output.name, "Measures", output.unit, 1};
  case OutputKind::drive:
    return {"drive " + output.name, (output.unit == "N m" ? "drive torque of " : "drive force of ") + words,
            "Drives", output.unit, 1};
  case OutputKind::power:
    return {"power " + output.name, "drive power of " + words, "Drives", output.unit, 1};
  case OutputKind::force:
    return {"force " + output.name, "force through " + output.name, "Reactions", output.unit, 1};
  case OutputKind::moment:
    return {"torque " + output.name, "torque through " + output.name, "Reactions", output.unit, 1};
  case OutputKind::bearing_force:
    return {"bearing_force " + output.name, "force of " + output.name, "Bearings", output.unit, 1};
  case OutputKind::bearing_moment:
    return {"bearing_torque " + output.name, "torque of " + output.name, "Bearings", output.unit, 1};
  case OutputKind::motion: break;
  }
  return {"motion " + output.name,
          output.name == "largest multiplier" ? "largest Floquet multiplier" : output.name, "Motion",
          output.unit, 1};
}

const ResonancePoint* first_told(const ResonanceCurve& curve) {
  const auto found = std::ranges::find_if(curve.points, [](const auto& point) { return point->found(); });
  return found == curve.points.end() ? nullptr : found->get();
}

} // namespace

bool is_resonance(const Session& session) {
  return session.study.response.resonates;
}

void update_resonance(Session& session, const std::optional<ResponseRequest>& wanted) {
  ResponseState& state = session.study.response;
  ResonanceStudy& study = state.resonance;
  study.take();
  if (!wanted) {
    study = {};
    return;
  }
  if (study.asked == wanted) return;
  const bool same_axis = study.found && study.found->of.address == wanted->address &&
                         study.found->of.from == wanted->from && study.found->of.to == wanted->to;
  study.ask(session.options, *wanted,
            [same_axis](const ResponseRequest& of, const TaskContext<ResonanceCurve>& context) {
              return find_resonance(of, same_axis, nullptr, context);
            });
  study.take(); // in immediate mode it is there
}

bool resonance_stopped(const Session& session) {
  const ResonanceStudy& study = session.study.response.resonance;
  return study.asked && study.found && study.is_of(*study.asked) && study.found->stopped && !study.running();
}

void go_on_with_resonance(Session& session) {
  if (!resonance_stopped(session)) return;
  ResonanceStudy& study = session.study.response.resonance;
  study.ask(session.options, ResponseRequest(*study.asked),
            [begun = study.found](const ResponseRequest& of, const TaskContext<ResonanceCurve>& context) {
              return find_resonance(of, true, begun, context);
            });
  study.take();
}

std::vector<ResponseQuantity> resonance_quantities(const Session& session) {
  const ResponseState& state = session.study.response;
  std::optional<ResonancePoint> now = present_resonance(session, state.choice.address);
  const ResonancePoint* point = now ? &*now : nullptr;
  if (!point && state.resonance.found) point = first_told(state.resonance.found->result);
  std::vector<ResponseQuantity> out;
  if (!point) return out;
  std::vector<ResponseQuantity> loads; // forces by themselves, then moments
  for (const ResonanceOutput& output : point->outputs)
    (output.kind == OutputKind::moment ? loads : out)
        .push_back(quantity_of(output, label_words(session.mechanism(), output.name)));
  add_quantities(out, loads);
  return out;
}

std::optional<ResonanceKey> resonance_key(const std::string& quantity) {
  constexpr std::pair<const char*, OutputKind> kinds[] = {{"value ", OutputKind::coordinate},
                                                          {"measure ", OutputKind::measure},
                                                          {"drive ", OutputKind::drive},
                                                          {"power ", OutputKind::power},
                                                          {"force ", OutputKind::force},
                                                          {"torque ", OutputKind::moment},
                                                          {"bearing_force ", OutputKind::bearing_force},
                                                          {"bearing_torque ", OutputKind::bearing_moment},
                                                          {"motion ", OutputKind::motion}};
  for (const auto& [begin, kind] : kinds)
    if (quantity.starts_with(begin))
      return ResonanceKey{kind, quantity.substr(std::char_traits<char>::length(begin))};
  return std::nullopt;
}

std::optional<ResonancePoint> present_resonance(const Session& session, const std::string& address) {
  const PeriodicState* motion = periodic_motion(session);
  // A motion may still be that of the number before.
  const Mechanism* of = motion               ? session.study.periodic.search.found->of.mechanism.pointer.get()
                        : converged(session) ? session.answer.mechanism.get()
                                             : nullptr;
  if (!of || !has_number(*of, address)) return std::nullopt;
  const double number = get_parameter(*of, address);
  return motion ? resonance_point(*motion, number) : resonance_point(session.answer.solution, number);
}

std::string resonance_words(const Session& session) {
  const auto& found = session.study.response.resonance.found;
  if (!found) return {};
  const auto& points = found->result.points;
  const auto without = std::ranges::count_if(points, [](const auto& point) { return !point->found(); });
  const auto steady = std::ranges::count_if(points, [](const auto& point) { return point->steady; });
  std::string words = std::to_string(points.size()) + (points.size() == 1 ? " point" : " points");
  if (steady > 0) words += ", " + std::to_string(steady) + " steady";
  if (without > 0) words += ", " + std::to_string(without) + " without a motion";
  if (found->stopped) words += ", stopped";
  return words;
}

std::string resonance_refusal(const Session& session) {
  const ResonanceStudy& study = session.study.response.resonance;
  if (!study.problem.empty()) return study.problem;
  if (!study.found || study.running() || first_told(study.found->result)) return {};
  const auto& points = study.found->result.points;
  return points.empty() ? "Nothing was computed." : points.front()->trouble;
}

} // namespace flyball
