#include "app/ui/studies/modes/modes_control.hpp"

#include "app/session/state_words.hpp"
#include "app/ui/studies/modes/campbell.hpp"
#include "app/ui/studies/motion/motion_control.hpp"

#include <chrono>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr double no_time = 0.3; // s
constexpr int most_coordinates = 300;
constexpr double turn = 2 * std::numbers::pi;

FoundModes find(std::shared_ptr<const Mechanism> mechanism,
                const std::vector<std::pair<std::string, double>>& start,
                const Background<FoundModes>::Watch& watch) {
  const auto begin = std::chrono::steady_clock::now();
  FoundModes found;
  found.analysis = std::make_unique<Analysis>(std::move(mechanism));
  if (const int free = found.analysis->summary().free_coordinates; free > most_coordinates)
    throw std::runtime_error("Modes are found of at most " + std::to_string(most_coordinates) +
                             " free coordinates; this mechanism has " + std::to_string(free) + ".");
  SolveOptions options;
  options.nearest = true;
  options.start = start;
  options.cancel = &watch.cancel;
  options.progress = watch.progress;
  const Solution solution = found.analysis->solve(options);
  if (solution.status != Status::converged) throw std::runtime_error(solution.message);
  found.modes = found.analysis->modes();
  found.evidence = found.analysis->stability_evidence();
  found.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

// Poses of the chosen mode as it stands now.
void pose(App& app) {
  ModesState& modes = app.study.modes;
  const VibrationMode* mode = moving_mode(app);
  if (!mode) {
    modes.poses.clear();
    return;
  }
  const ModesState::Posed now{modes.of, *modes.chosen, modes.amplitude, modes.phase, steady_time(app)};
  if (!modes.poses.empty() && now == modes.posed) return;
  modes.poses = modes.result->analysis->mode_poses(*mode, modes.amplitude, modes.phase, now.time);
  modes.posed = now;
}

} // namespace

bool modes_are_current(const App& app) {
  const ModesState& modes = app.study.modes;
  return modes.result && modes.of == app.answer.ticket && converged(app);
}

void find_modes_again(App& app) {
  ModesState& modes = app.study.modes;
  if (!converged(app)) return;
  if (!modes.task)
    modes.task = std::make_unique<Background<FoundModes>>(app.options.mode, app.options.on_news);
  modes.asked = app.answer.ticket;
  modes.problem.clear();
  modes.task->start(
      [mechanism = app.answer.mechanism, start = start_values(app.answer.solution.coordinates)](
          const Background<FoundModes>::Watch& watch) { return find(mechanism, start, watch); });
}

void update_modes(App& app) {
  if (app.study.open != Study::modes) return;
  ModesState& modes = app.study.modes;
  if (modes.task)
    if (auto news = modes.task->take()) {
      modes.problem = news->problem;
      if (!news->result) {
        modes.result.reset();
        modes.chosen.reset();
      } else {
        // A mode keeps its place among as many others; where there are others it is not the same.
        if (!modes.result || modes.result->modes.size() != news->result->modes.size()) modes.chosen.reset();
        modes.result = std::move(news->result);
      }
      modes.of = modes.asked;
    }
  if (app.mode == Mode::explore && converged(app) && modes.asked != app.answer.ticket) {
    const bool idle = !modes.task || !modes.task->running();
    const bool quick = !modes.result || modes.result->run_time_s < no_time;
    if (idle && quick) find_modes_again(app);
  }
  pose(app);
  update_campbell(app);
}

void close_modes(App& app) {
  const CampbellState& campbell = app.study.modes.campbell;
  ModesState fresh;
  fresh.amplitude = app.study.modes.amplitude;
  fresh.campbell.drive = campbell.drive;
  fresh.campbell.from = campbell.from;
  fresh.campbell.to = campbell.to;
  fresh.campbell.hertz = campbell.hertz;
  app.study.modes = std::move(fresh);
}

bool finding_modes(const App& app) {
  const ModesState& modes = app.study.modes;
  return (modes.task && modes.task->running()) || (modes.campbell.task && modes.campbell.task->running());
}

void choose_mode(App& app, std::optional<std::size_t> mode) {
  ModesState& modes = app.study.modes;
  modes.chosen = mode;
  modes.phase = 0;
  modes.poses.clear();
  modes.playing = mode.has_value();
  app.playback.playing = false; // what turns as well hides how it swings
}

const VibrationMode* moving_mode(const App& app) {
  const ModesState& modes = app.study.modes;
  if (app.study.open != Study::modes || app.mode != Mode::explore || !modes.chosen) return nullptr;
  if (!modes.result || *modes.chosen >= modes.result->modes.size() || !converged(app)) return nullptr;
  return &modes.result->modes[*modes.chosen];
}

void advance_mode(App& app, double seconds) {
  const VibrationMode* mode = moving_mode(app);
  if (!mode || !app.study.modes.playing) return;
  double& phase = app.study.modes.phase;
  phase = std::fmod(phase + turn * seconds / shown_period(*mode), turn);
}

double shown_period(const VibrationMode& mode) {
  const std::optional<double> slower = shown_slower(mode);
  return slower ? *slower * turn / mode.frequency : 2;
}

std::optional<double> shown_slower(const VibrationMode& mode) {
  if (!mode.oscillates()) return std::nullopt;
  constexpr double shortest = 0.8, longest = 4; // s, of what can be watched as it is
  const double period = turn / mode.frequency;
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
