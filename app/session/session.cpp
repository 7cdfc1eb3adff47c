#include "app/session/session.hpp"

#include "app/session/follow_names.hpp"
#include "app/session/settings.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"
#include "engine/mechanism/validate.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace flyball {

namespace {

using StartValues = std::vector<std::pair<std::string, double>>;

// Asks for the document's steady state, or knows better.
void ask(Session& session, bool another, bool warm, StartValues start = {}) {
  if (!warm) session.on_branch = false;
  if (session.mechanism().bodies.empty() || !session.mistakes.empty()) {
    session.answer = {};
    session.poses.clear();
    session.awaited =
        std::numeric_limits<std::uint64_t>::max(); // what may be under way is of no use any more
    session.waited = 0;
    return;
  }
  session.awaited = session.asked = session.live.ask({.mechanism = session.document.shared(),
                                                      .time = session.playback.time,
                                                      .another = another,
                                                      .warm = warm,
                                                      .nearest = session.on_branch,
                                                      .start = std::move(start),
                                                      .points = told_points(session)});
}

void validate_all(Session& session) {
  session.mistakes = find_mistakes(session.mechanism());
  session.warnings =
      session.mistakes.empty() ? find_warnings(session.mechanism()) : std::vector<SceneError>();
}

// After nothing of the mechanism but the number at `address` has changed.
void validate_number(Session& session, const std::string& address) {
  if (!session.mistakes.empty() || address.starts_with("bodies."))
    return validate_all(session); // they have warnings
  session.mistakes = find_mistakes(session.mechanism(), address);
  if (!session.mistakes.empty()) session.warnings.clear();
}

// The drives keep their phase, so that nothing jumps when all their speeds change alike, as a lone drive's
// does: the time becomes the one at which they stand as they did.
void keep_phase(Session& session) {
  std::vector<double> speeds;
  for (const PrescribedSpeed& speed : prescribed_speeds(session.mechanism()))
    speeds.push_back(speed.value);
  const std::vector<double> before = std::exchange(session.speeds, speeds);
  if (session.motion.on || session.playback.time == 0 || before.size() != speeds.size()) return;
  std::optional<double> factor;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    if (speeds[i] == 0 && before[i] == 0) continue;
    const double now = before[i] / speeds[i];
    if (!std::isfinite(now) || (factor && std::abs(now - *factor) > 1e-12 * std::abs(*factor))) return;
    factor = now;
  }
  if (factor) session.playback.time *= *factor;
}

// After the document's mechanism has changed; `address` where that is only the number there.
void take_document(Session& session, bool another, bool warm, StartValues start = {},
                   const std::string& address = {}) {
  const std::shared_ptr<const Mechanism> before = std::exchange(session.named, session.document.shared());
  if (address.empty() && !another && before) {
    follow_names(session, *before);
    if (session.on_edited) session.on_edited(*before);
  }
  if (address.empty())
    validate_all(session);
  else
    validate_number(session, address);
  if (address.empty() ||
      !take_value(session.parameters, session.mechanism(), session.document.stored(), address))
    session.parameters = parameter_controls(session.mechanism(), session.document.stored(), session.units);
  session.drawn = drawn_poses(session.mechanism());
  keep_phase(session);
  session.moved_time = true;
  ask(session, another, warm, std::move(start));
  follow_motion(session, another);
}

// Whether a hand has pulled so far that nothing near stands any more: the answer is none, or unstable where
// what was shown is not.
bool runs_away(const Session& session, const LiveAnswer& answer) {
  if (answer.error || answer.ticket > session.pulled || !converged(session) ||
      session.answer.solution.stable == false)
    return false;
  return answer.solution.status != Status::converged || answer.solution.stable == false;
}

void take_answer(Session& session) {
  if (std::optional<LiveAnswer> answer = session.live.take_answer();
      answer && session.awaited != std::numeric_limits<std::uint64_t>::max() &&
      answer->ticket >= session.opened) {
    session.pulled_too_far = runs_away(session, *answer);
    if (session.pulled_too_far) { // what was last found stays
      session.answer.ticket = answer->ticket;
    } else {
      session.answer = std::move(*answer);
      session.poses = session.answer.poses;
    }
    if (session.answer.left_branch && session.on_branch && session.answer.ticket == session.awaited) {
      session.on_branch = false;
      session.notice = "The branch ends here; this is the state that the drawn pose settles in.";
    }
    // The time may have gone on, or back, while this was solved.
    session.moved_time = session.moved_time || session.answer.time != steady_time(session);
  }
  if (!converged(session)) return;
  const double time = steady_time(session);
  if (session.moved_time && time == 0) {
    session.poses = session.answer.solution.poses;
    session.moved_time = false;
  } else if (session.moved_time) {
    session.live.ask_poses(time);
    session.moved_time = false;
  }
  if (std::optional<LivePoses> poses = session.live.take_poses())
    if (poses->ticket == session.answer.ticket && time != 0) session.poses = std::move(poses->poses);
}

} // namespace

Session::Session(SessionOptions chosen)
    : options(std::move(chosen)), live(options.mode, options.on_news),
      units(read_settings(options.state).units) {
  open_document(*this, Document());
}

void open_document(Session& session, Document document) {
  const bool same_file = !document.file().empty() && document.file() == session.document.file();
  session.problem.clear();
  session.notice.clear();
  session.goals = {};
  session.document = std::move(document);
  session.answer = {};
  session.poses.clear();
  if (!same_file) {
    session.points.clear();
    find_cycle(session, false);
    session.playback = {.factor = session.playback.factor};
    session.mode = session.mechanism().bodies.empty() ? Mode::build : Mode::explore;
  }
  session.document.put_explored_aside(session.mode == Mode::build);
  if (session.on_document_opened) session.on_document_opened(same_file);
  session.opened = session.asked + 1;
  take_document(session, true, false);
}

void edit(Session& session, const std::string& name,
          const std::function<void(Mechanism&, Selection&)>& change) {
  Mechanism next = session.document.stored();
  Selection selection = session.selection();
  const std::uint64_t before = session.document.revision();
  try {
    change(next, selection);
    session.document.edit(name, std::move(next), std::move(selection), session.gesture);
  } catch (const SceneError& error) {
    return show_error(session, error.what());
  }
  session.notice.clear();
  if (session.document.revision() != before) take_document(session, false, false);
}

void replace_mechanism(Session& session, const std::string& name, Mechanism mechanism,
                       const std::optional<NamedHues>& hues) {
  const std::uint64_t before = session.document.revision();
  session.document.replace(name, std::move(mechanism), hues);
  session.notice.clear();
  if (session.document.revision() != before) take_document(session, false, false);
}

void undo(Session& session) {
  const Document& document = session.document;
  if (!session.document.undo()) return;
  session.notice = "Undone: " + document.steps()[document.position() + 1].name;
  take_document(session, false, false);
}

void redo(Session& session) {
  const Document& document = session.document;
  if (!session.document.redo()) return;
  session.notice = "Redone: " + document.steps()[document.position()].name;
  take_document(session, false, false);
}

void go_to_step(Session& session, std::size_t step) {
  if (step == session.document.position()) return;
  session.document.go_to(step);
  take_document(session, false, false);
}

void select(Session& session, Selection selection) {
  session.document.select(std::move(selection));
}

namespace {

// Sets the number as a step of the history. False where it is refused, and nothing has changed.
bool set_parameter_from(Session& session, const std::string& address, double value, StartValues start) {
  if (!std::isfinite(value)) return false;
  const std::uint64_t revision = session.document.revision();
  const std::string step = "Set " + parameter_phrase(address);
  try {
    get_parameter(session.mechanism(), address); // which there must be
    if (session.mode == Mode::explore)
      session.document.explore(step, {{address, value}}, session.gesture);
    else
      session.document.edit_number(step, address, value, session.gesture);
  } catch (const SceneError& error) {
    show_error(session, error.what());
    return false;
  }
  // What was solved last, or `start`, is where solving begins.
  if (session.document.revision() != revision)
    take_document(session, false, true, std::move(start), address);
  else if (!start.empty())
    ask(session, false, true, std::move(start));
  return true;
}

// While exploring; `warm` solves from the last answer, or from `start` where there is one.
void explore_numbers(Session& session, const std::string& step, const Explored& values, bool warm,
                     StartValues start) {
  const std::uint64_t revision = session.document.revision();
  try {
    session.document.explore(step, values, session.gesture);
  } catch (const SceneError& error) {
    return show_error(session, error.what());
  }
  if (session.document.revision() != revision) take_document(session, false, warm, std::move(start));
}

} // namespace

void edit_parameter(Session& session, const std::string& address, double value) {
  const std::uint64_t revision = session.document.revision();
  try {
    session.document.edit_number("Set " + parameter_phrase(address), address, value, session.gesture);
  } catch (const SceneError& error) {
    return show_error(session, error.what());
  }
  session.notice.clear();
  if (session.document.revision() != revision)
    take_document(session, false, session.mode == Mode::explore, {}, address);
}

void change_parameter(Session& session, const std::string& address, double value) {
  set_parameter_from(session, address, value, {});
}

void change_parameters(Session& session, const std::string& step, const Explored& values) {
  if (session.mode == Mode::build)
    return edit(session, step, [&](Mechanism& mechanism, Selection&) {
      for (const ExploredValue& each : values)
        set_parameter(mechanism, each.address, each.value);
    });
  explore_numbers(session, step, values, false, {});
}

void go_to_numbers(Session& session, const std::string& step, const Explored& values, StartValues start) {
  explore_numbers(session, step, values, true, std::move(start));
}

void go_to_state(Session& session, const std::string& address, double value, StartValues start) {
  if (start.empty()) return change_parameter(session, address, value);
  const bool before = std::exchange(session.on_branch, true);
  if (address.empty())
    ask(session, false, true, std::move(start));
  else if (!set_parameter_from(session, address, value, std::move(start)))
    session.on_branch = before;
}

void keep_explored(Session& session) {
  if (session.document.explored().empty()) return;
  session.document.keep_explored();
  session.notice = "The explored values are the document's now.";
  take_document(session, false, true);
}

void drop_explored(Session& session) {
  if (session.document.explored().empty()) return;
  session.document.drop_explored();
  session.notice.clear();
  take_document(session, false, false);
}

std::vector<std::string> explored_words(const Session& session) {
  std::vector<std::string> words;
  for (const ExploredValue& each : session.document.explored()) {
    const ShownUnit unit = shown_unit(parameter_unit(session.document.stored(), each.address), session.units);
    const auto text = [&](double value) {
      return short_text(unit.shown(value), 9) + (unit.text.empty() ? "" : " " + unit.text);
    };
    words.push_back(parameter_phrase(each.address) + " " + text(each.value) + ", stored is " +
                    text(get_parameter(session.document.stored(), each.address)));
  }
  return words;
}

void solve_from_drawn_pose(Session& session) {
  ask(session, false, false);
}

void tell_point(Session& session, const std::string& body, const std::optional<Vec3>& at) {
  if (at && !at->allFinite()) return;
  if (at)
    session.points.insert_or_assign(body, *at);
  else
    session.points.erase(body);
  ask(session, false, true); // from the last answer: what is shown stays
  retell_motion(session);
}

std::vector<BodyPoint> told_points(const Session& session) {
  std::vector<BodyPoint> points;
  for (const auto& [body, at] : session.points)
    if (body_index(session.mechanism(), body) >= 0) points.push_back({body, at});
  return points;
}

namespace {

// Building shows what is stored.
void enter_mode(Session& session, Mode mode) {
  session.mode = mode;
  if (session.document.put_explored_aside(mode == Mode::build))
    take_document(session, false, mode == Mode::explore);
}

} // namespace

void set_mode(Session& session, Mode mode) {
  enter_mode(session, mode);
  if (mode == Mode::build) {
    show_motion(session, false);
    play(session, false);
    rewind(session);
  }
  if (session.on_mode_chosen) session.on_mode_chosen();
}

void play(Session& session, bool playing) {
  session.playback.playing = playing && !session.mechanism().bodies.empty();
  if (!session.playback.playing) return;
  enter_mode(session, Mode::explore);
  // From the end, play means again.
  const MotionRun* motion = session.motion.on ? shown_motion(session) : nullptr;
  if (motion && motion->finished && session.playback.time >= motion->run->time.back())
    seek_motion(session, motion->run->time.front());
}

void rewind(Session& session) {
  session.playback.time = 0;
  session.moved_time = true;
  if (session.motion.on) seek_motion(session, 0);
}

void update(Session& session, double seconds) {
  if (session.playback.playing && session.motion.on) {
    advance_motion(session, seconds * session.playback.factor);
  } else if (session.playback.playing && (converged(session) || periodic_motion(session))) {
    session.playback.time += seconds * session.playback.factor;
    session.moved_time = true;
  }
  advance_mode(session, seconds);
  take_answer(session);
  update_motion(session);
  update_goals(session);
  update_studies(session);
  session.waited = solving(session) ? session.waited + seconds : 0;
}

bool converged(const Session& session) {
  return session.answer.ticket && !session.answer.error &&
         session.answer.solution.status == Status::converged;
}

bool solving(const Session& session) {
  return session.awaited != std::numeric_limits<std::uint64_t>::max() &&
         session.answer.ticket < session.awaited;
}

void show_error(Session& session, std::string text) {
  session.failure = text;
  session.notice = std::move(text);
}

bool is_error(const Session& session) {
  return !session.notice.empty() && session.notice == session.failure;
}

bool motion_beside(const Session& session) {
  return session.mode == Mode::explore && session.motion.on && session.motion.beside;
}

bool in_motion(const Session& session) {
  return (session.playback.playing &&
          (session.motion.on || converged(session) || periodic_motion(session))) ||
         (session.study.modes.playing && moving_mode(session));
}

} // namespace flyball
