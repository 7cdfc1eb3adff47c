#include "app/session/compare.hpp"

#include "app/session/session.hpp"

namespace flyball {

void begin_comparison(Session& session) {
  CompareState& state = session.study.compare;
  if (!state.task)
    state.task = std::make_unique<Background<Comparison>>(session.options.mode, session.options.on_news);
  state.problem.clear();
  state.of = session.document.shared();
  state.task->start([mechanism = session.document.shared(),
                     repeats = state.repeats](const TaskContext<Comparison>& context) {
    CompareOptions options;
    options.repeats = repeats;
    options.cancel = &context.cancel;
    options.progress = [&](std::size_t done, std::size_t all) {
      context.progress({"measuring motions", static_cast<double>(done) / static_cast<double>(all)});
    };
    return compare(*mechanism, options);
  });
}

void update_comparison(Session& session) {
  CompareState& state = session.study.compare;
  auto news = state.task ? state.task->take() : std::nullopt;
  if (!news) return;
  state.problem = news->problem;
  if (!news->result) return;
  state.result = std::move(*news->result);
  ++state.results;
}

bool comparing(const Session& session) {
  const CompareState& state = session.study.compare;
  return state.task && state.task->running();
}

bool comparison_is_current(const Session& session) {
  const CompareState& state = session.study.compare;
  return state.result && (state.of == session.document.shared() || *state.of == session.mechanism());
}

} // namespace flyball
