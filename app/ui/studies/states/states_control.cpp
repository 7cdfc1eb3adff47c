#include "app/ui/studies/states/states_control.hpp"

#include "app/session/state_words.hpp"

#include <chrono>

namespace flyball {

namespace {

constexpr double no_time = 0.3; // s

FoundStates find_states(std::shared_ptr<const Mechanism> mechanism,
                        const Background<FoundStates>::Watch& watch) {
  const auto begin = std::chrono::steady_clock::now();
  FoundStates found;
  report_progress(watch.progress, "preparing");
  Analysis analysis(std::move(mechanism));
  SolveOptions options;
  options.details = false;
  options.cancel = &watch.cancel;
  options.progress = watch.progress;
  found.all = analysis.solve_all(options);
  found.cancelled = watch.cancel;
  found.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

} // namespace

void search_states(App& app) {
  StatesState& states = app.study.states;
  if (!app.mistakes.empty() || app.mechanism().bodies.empty()) return;
  if (!states.task)
    states.task = std::make_unique<Background<FoundStates>>(app.options.mode, app.options.on_news);
  states.asked = app.document.revision();
  states.problem.clear();
  states.task->start([mechanism = app.document.shared()](const Background<FoundStates>::Watch& watch) {
    return find_states(mechanism, watch);
  });
}

void update_states(App& app) {
  if (app.study.open != Study::states) return;
  StatesState& states = app.study.states;
  if (states.task)
    if (auto news = states.task->take()) {
      states.problem = news->problem;
      if (news->result && news->result->cancelled) {
        states.problem = "The search was stopped.";
      } else if (news->result) {
        states.result = std::move(news->result);
        states.of = states.asked;
        ++states.lists;
      }
    }
  if (app.mode != Mode::explore) return;
  const bool quick = states.result && states.result->run_time_s < no_time && !states.task->running();
  if (!states.task || (quick && states.asked != app.document.revision())) search_states(app);
}

bool states_are_current(const App& app) {
  return app.study.states.result && app.study.states.of == app.document.revision();
}

std::optional<std::size_t> shown_state(const App& app) {
  if (!states_are_current(app) || !converged(app) || solving(app)) return std::nullopt;
  const std::vector<Solution>& all = app.study.states.result->all.equilibria;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (same_state(all[i].coordinates, app.answer.solution.coordinates, all[i].neutral)) return i;
  return std::nullopt;
}

void show_state(App& app, std::size_t index) {
  if (!states_are_current(app) || index >= app.study.states.result->all.equilibria.size()) return;
  go_to_state(app, "", 0, start_values(app.study.states.result->all.equilibria[index].coordinates));
}

} // namespace flyball
