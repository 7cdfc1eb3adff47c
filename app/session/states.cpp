#include "app/session/states.hpp"

#include "app/session/session.hpp"
#include "app/session/state_words.hpp"

namespace flyball {

namespace {

AllSolutions find_states(const SharedMechanism& mechanism, const TaskContext<AllSolutions>& context) {
  report_progress(context.progress, "preparing");
  Analysis analysis(mechanism.pointer);
  SolveOptions options;
  options.details = false;
  options.cancel = &context.cancel;
  options.progress = context.progress;
  return analysis.solve_all(options);
}

} // namespace

void search_states(Session& session) {
  if (!session.mistakes.empty() || session.mechanism().bodies.empty()) return;
  session.study.states.ask(session.options, {session.document.shared()}, find_states);
}

void update_states(Session& session) {
  StatesStudy& states = session.study.states;
  states.take("The search was stopped.");
  if (session.study.open != StudyKind::states) return;
  if (session.mode != Mode::explore) return;
  const bool again =
      states.quick() && !states.running() && *states.asked != SharedMechanism{session.document.shared()};
  if (!states.asked || again) search_states(session);
}

bool states_are_current(const Session& session) {
  return session.study.states.is_of({session.document.shared()});
}

std::optional<std::size_t> shown_state(const Session& session) {
  if (!states_are_current(session) || !converged(session) || solving(session)) return std::nullopt;
  const std::vector<Solution>& all = session.study.states.found->result.equilibria;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (same_state(all[i].coordinates, session.answer.solution.coordinates, all[i].neutral)) return i;
  return std::nullopt;
}

void show_state(Session& session, std::size_t index) {
  if (!states_are_current(session) || index >= session.study.states.found->result.equilibria.size()) return;
  const Solution& state = session.study.states.found->result.equilibria[index];
  if (state.frictions.empty()) return go_to_state(session, "", 0, start_values(state.coordinates));
  solve_from_drawn_pose(session);
  if (index > 0)
    session.notice =
        "The view shows what solving answers: of states that rest on friction the first, and only "
        "where there is no other.";
}

} // namespace flyball
