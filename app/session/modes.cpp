#include "app/session/modes.hpp"

#include "app/session/session.hpp"

#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr int most_coordinates = 300;
constexpr double full_turn = 2 * std::numbers::pi;

// Of so many free coordinates; empty where that is not too many.
std::string refusal_of(int free) {
  if (free <= most_coordinates) return {};
  return "Modes are found of at most " + std::to_string(most_coordinates) +
         " free coordinates; this mechanism has " + std::to_string(free) + ".";
}

FoundModes find(std::shared_ptr<const Mechanism> mechanism,
                const std::vector<std::pair<std::string, double>>& start,
                const TaskContext<FoundModes>& context) {
  FoundModes found;
  found.analysis = std::make_unique<Analysis>(std::move(mechanism));
  if (const std::string refusal = refusal_of(found.analysis->summary().free_coordinates); !refusal.empty())
    throw std::runtime_error(refusal);
  SolveOptions options;
  options.nearest = true;
  options.start = start;
  options.cancel = &context.cancel;
  options.progress = context.progress;
  const Solution solution = found.analysis->solve(options);
  if (solution.status != Status::converged) throw std::runtime_error(solution.message);
  found.singular_loops = solution.singular_loops;
  report_progress(context.progress, "modes");
  found.modes = found.analysis->modes();
  for (const VibrationMode& mode : found.modes)
    found.whirls.push_back(found.analysis->whirl(mode));
  found.evidence = found.analysis->stability_evidence();
  return found;
}

// Poses of the chosen mode as it stands now.
void pose(Session& session) {
  ModesState& modes = session.study.modes;
  const VibrationMode* mode = moving_mode(session);
  if (!mode) {
    modes.poses.clear();
    return;
  }
  const ModesState::Posed now{modes.list.found->of, *modes.chosen,        modes.amplitude,
                              modes.phase,          steady_time(session), modes.both_ends};
  if (!modes.poses.empty() && now == modes.posed) return;
  Analysis& analysis = *modes.list.found->result.analysis;
  modes.poses = analysis.mode_poses(*mode, modes.amplitude, modes.phase, now.time);
  if (modes.both_ends)
    for (const Pose& pose :
         analysis.mode_poses(*mode, modes.amplitude, modes.phase + full_turn / 2, now.time))
      modes.poses.push_back(pose);
  modes.posed = now;
}

} // namespace

bool modes_are_current(const Session& session) {
  return session.study.modes.list.is_of({session.answer.ticket}) && converged(session);
}

void find_modes_again(Session& session) {
  if (!converged(session)) return;
  session.study.modes.list.ask(
      session.options, {session.answer.ticket},
      [mechanism = session.answer.mechanism, start = start_values(session.answer.solution.coordinates)](
          const ModesRequest&, const TaskContext<FoundModes>& context) {
        return find(mechanism, start, context);
      });
}

std::string modes_refusal(const Session& session) {
  return refusal_of(session.answer.summary.free_coordinates);
}

void update_modes(Session& session) {
  if (session.study.open != StudyKind::modes) return;
  ModesState& modes = session.study.modes;
  const std::size_t before = modes.list.found ? modes.list.found->result.modes.size() : 0;
  if (modes.list.take()) {
    if (!modes.list.problem.empty()) modes.list.found.reset();
    // A mode keeps its place among as many others; where there are others it is not the same.
    if (!modes.list.found || modes.list.found->result.modes.size() != before) modes.chosen.reset();
  }
  if (session.mode == Mode::explore && converged(session) && !modes.list.running() &&
      modes.list.asked != ModesRequest{session.answer.ticket} && (!modes.list.found || modes.list.quick()))
    find_modes_again(session);
  pose(session);
  update_campbell(session);
}

void close_modes(Session& session) {
  const CampbellState& campbell = session.study.modes.campbell;
  ModesState fresh;
  fresh.amplitude = session.study.modes.amplitude;
  fresh.campbell.drive = campbell.drive;
  fresh.campbell.from = campbell.from;
  fresh.campbell.to = campbell.to;
  fresh.campbell.orders = campbell.orders;
  session.study.modes = std::move(fresh);
}

bool finding_modes(const Session& session) {
  const ModesState& modes = session.study.modes;
  return modes.list.running() || modes.campbell.diagram.running();
}

void choose_mode(Session& session, std::optional<std::size_t> mode) {
  ModesState& modes = session.study.modes;
  modes.chosen = mode;
  modes.phase = 0;
  modes.poses.clear();
  modes.playing = mode.has_value();
  session.playback.playing = false; // what turns as well hides how it swings
}

const VibrationMode* moving_mode(const Session& session) {
  const ModesState& modes = session.study.modes;
  if (session.study.open != StudyKind::modes || session.mode != Mode::explore || !modes.chosen)
    return nullptr;
  const auto& found = modes.list.found;
  if (!found || *modes.chosen >= found->result.modes.size() || !converged(session)) return nullptr;
  return &found->result.modes[*modes.chosen];
}

void advance_mode(Session& session, double seconds) {
  const VibrationMode* mode = moving_mode(session);
  if (!mode || !session.study.modes.playing) return;
  double& phase = session.study.modes.phase;
  phase = std::fmod(phase + full_turn * seconds / shown_period(*mode), full_turn);
}

double shown_period(const VibrationMode& mode) {
  const std::optional<double> slower = shown_slower(mode);
  return slower ? *slower * full_turn / mode.frequency : 2;
}

std::optional<double> shown_slower(const VibrationMode& mode) {
  if (!mode.oscillates()) return std::nullopt;
  constexpr double shortest = 0.8, longest = 4; // s, of what can be watched as it is
  const double period = full_turn / mode.frequency;
  if (period >= shortest && period <= longest) return 1;
  // A round factor that brings it to about two seconds.
  const double wanted = 2 / period;
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  const double digit = wanted / decade;
  return decade * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

bool grows(const VibrationMode& mode) {
  return mode.eigenvalue.real() > 1e-7 * std::max(1., mode.natural_frequency);
}

} // namespace flyball
