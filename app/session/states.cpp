#include "app/session/states.hpp"

#include "app/session/session.hpp"
#include "app/session/state_words.hpp"

#include <chrono>

namespace flyball {

namespace {

constexpr double no_time = 0.3; // s

FoundStates find_states(std::shared_ptr<const Mechanism> mechanism, const TaskContext<FoundStates>& context) {
  const auto begin = std::chrono::steady_clock::now();
  FoundStates found;
  report_progress(context.progress, "preparing");
  Analysis analysis(std::move(mechanism));
  SolveOptions options;
  options.details = false;
  options.cancel = &context.cancel;
  options.progress = context.progress;
  found.all = analysis.solve_all(options);
  found.cancelled = context.cancel;
  found.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

} // namespace

void search_states(Session& session) {
  StatesState& states = session.study.states;
  if (!session.mistakes.empty() || session.mechanism().bodies.empty()) return;
  if (!states.task)
    states.task = std::make_unique<Background<FoundStates>>(session.options.mode, session.options.on_news);
  states.asked = session.document.revision();
  states.problem.clear();
  states.task->start([mechanism = session.document.shared()](const TaskContext<FoundStates>& context) {
    return find_states(mechanism, context);
  });
}

void update_states(Session& session) {
  if (session.study.open != Study::states) return;
  StatesState& states = session.study.states;
  if (states.task)
    if (auto news = states.task->take()) {
      states.problem = news->problem;
      if (news->result && news->result->cancelled) {
        states.problem = "The search was stopped.";
      } else if (news->result) {
        states.result = std::move(*news->result);
        states.of = states.asked;
        ++states.lists;
      }
    }
  if (session.mode != Mode::explore) return;
  const bool quick = states.result && states.result->run_time_s < no_time && !states.task->running();
  if (!states.task || (quick && states.asked != session.document.revision())) search_states(session);
}

bool states_are_current(const Session& session) {
  return session.study.states.result && session.study.states.of == session.document.revision();
}

std::optional<std::size_t> shown_state(const Session& session) {
  if (!states_are_current(session) || !converged(session) || solving(session)) return std::nullopt;
  const std::vector<Solution>& all = session.study.states.result->all.equilibria;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (same_state(all[i].coordinates, session.answer.solution.coordinates, all[i].neutral)) return i;
  return std::nullopt;
}

void show_state(Session& session, std::size_t index) {
  if (!states_are_current(session) || index >= session.study.states.result->all.equilibria.size()) return;
  go_to_state(session, "", 0, start_values(session.study.states.result->all.equilibria[index].coordinates));
}

} // namespace flyball
