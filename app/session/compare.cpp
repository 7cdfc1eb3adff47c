#include "app/session/compare.hpp"

#include "app/session/session.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>

namespace flyball {

namespace {

constexpr const char* finding_solution = "direct solution"; // the phase before anything is measured

Comparison measure(const CompareRequest& request, const TaskContext<Comparison>& context) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  context.progress({finding_solution});
  CompareOptions options;
  options.repeats = request.repeats;
  options.time_limit = request.time_limit;
  options.cancel = &context.cancel;
  options.progress = [&](std::size_t done, std::size_t all) {
    // Later runs take longer; it ends when the time is over, if not before.
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    const double part =
        std::max(static_cast<double>(done) / static_cast<double>(all), seconds / request.time_limit);
    context.progress({"measuring motions", std::min(part, 1.)});
  };
  return compare(*request.mechanism, options);
}

} // namespace

void begin_comparison(Session& session) {
  CompareState& state = session.study.compare;
  state.measured.ask(session.options, {{session.document.shared()}, state.repeats, state.time_limit},
                     measure);
}

void update_comparison(Session& session) {
  auto& measured = session.study.compare.measured;
  // Stopped before its solution was found it measured nothing.
  if (measured.take() && measured.found && measured.found->stopped &&
      measured.found->result.status != Status::converged)
    measured.found.reset();
  // Until then, which no limit of time ends, it is of no use for a mechanism that has changed.
  if (measured.running() && measured.progress().phase == std::string_view(finding_solution) &&
      !(measured.asked->mechanism == SharedMechanism{session.document.shared()}))
    measured.stop();
}

bool comparing(const Session& session) {
  return session.study.compare.measured.running();
}

bool comparison_is_current(const Session& session) {
  const auto& found = session.study.compare.measured.found;
  return found && found->of.mechanism == SharedMechanism{session.document.shared()};
}

} // namespace flyball
