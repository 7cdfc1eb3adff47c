#include "app/session/compare.hpp"

#include "app/session/session.hpp"

namespace flyball {

namespace {

Comparison measure(const CompareRequest& request, const TaskContext<Comparison>& context) {
  CompareOptions options;
  options.repeats = request.repeats;
  options.cancel = &context.cancel;
  options.progress = [&](std::size_t done, std::size_t all) {
    context.progress({"measuring motions", static_cast<double>(done) / static_cast<double>(all)});
  };
  return compare(*request.mechanism, options);
}

} // namespace

void begin_comparison(Session& session) {
  CompareState& state = session.study.compare;
  state.measured.ask(session.options, {{session.document.shared()}, state.repeats}, measure);
}

void update_comparison(Session& session) {
  session.study.compare.measured.take();
}

bool comparing(const Session& session) {
  return session.study.compare.measured.running();
}

bool comparison_is_current(const Session& session) {
  const auto& found = session.study.compare.measured.found;
  return found && found->of.mechanism == SharedMechanism{session.document.shared()};
}

} // namespace flyball
