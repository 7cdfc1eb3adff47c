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
  const auto before = measured.found;
  const bool changed =
      measured.asked && !(measured.asked->mechanism == SharedMechanism{session.document.shared()});
  if (measured.take() && measured.found != before && measured.found->stopped) {
    const Comparison& part = measured.found->result;
    const bool solved = part.status == Status::converged;
    // A whole table does not give way to a part of it.
    const bool whole_before =
        before && before->result.complete && before->of.mechanism == measured.found->of.mechanism;
    if (!solved)
      measured.problem = changed ? "The mechanism changed before its solution was found: nothing is measured."
                                 : "Cancelled before the solution was found: nothing is measured.";
    else if (before && (part.motion.empty() || whole_before))
      measured.problem = "Cancelled: these are the measurements of before.";
    if (!measured.problem.empty()) measured.found = before;
  }
  // Until then, which no limit of time ends, it is of no use for a mechanism that has changed.
  if (changed && measured.running() && measured.progress().phase == std::string_view(finding_solution))
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
