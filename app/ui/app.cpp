#include "app/ui/app.hpp"

#include "app/ui/settings.hpp"
#include "app/ui/studies/modes/modes_control.hpp"
#include "app/ui/studies/motion/motion_control.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"

#include <cmath>
#include <limits>

namespace flyball {

namespace {

using StartValues = std::vector<std::pair<std::string, double>>;

// Asks for the document's steady state, or knows better.
void ask(App& app, bool another, bool warm, StartValues start = {}) {
  if (!warm) app.on_branch = false;
  if (app.mechanism().bodies.empty() || !app.mistakes.empty()) {
    app.answer = {};
    app.poses.clear();
    app.awaited = std::numeric_limits<std::uint64_t>::max(); // what may be under way is of no use any more
    app.waited = 0;
    return;
  }
  app.awaited = app.asked = app.live.ask({.mechanism = app.document.shared(),
                                          .time = app.playback.time,
                                          .another = another,
                                          .warm = warm,
                                          .nearest = app.on_branch,
                                          .start = std::move(start),
                                          .points = told_points(app)});
}

void validate_all(App& app) {
  app.mistakes = find_mistakes(app.mechanism());
  app.warnings = app.mistakes.empty() ? find_warnings(app.mechanism()) : std::vector<SceneError>();
}

// After nothing of the mechanism but the number at `address` has changed.
void validate_number(App& app, const std::string& address) {
  if (!app.mistakes.empty() || address.starts_with("bodies.")) return validate_all(app); // they have warnings
  app.mistakes = find_mistakes(app.mechanism(), address);
  if (!app.mistakes.empty()) app.warnings.clear();
}

// After the document's mechanism has changed; `address` where that is only the number there.
void take_document(App& app, bool another, bool warm, StartValues start = {},
                   const std::string& address = {}) {
  if (address.empty())
    validate_all(app);
  else
    validate_number(app, address);
  if (address.empty() || !take_value(app.parameters, app.mechanism(), app.document.stored(), address))
    app.parameters = parameter_controls(app.mechanism(), app.document.stored());
  app.drawn = drawn_poses(app.mechanism());
  app.moved_time = true;
  ask(app, another, warm, std::move(start));
  follow_motion(app, another);
}

int drive_count(const Mechanism& mechanism) {
  int count = 0;
  for (const Joint& joint : mechanism.joints)
    for (const Coordinate& coordinate : joint.coordinates)
      if (coordinate.drive) ++count;
  return count;
}

void take_answer(App& app) {
  if (std::optional<LiveAnswer> answer = app.live.take_answer();
      answer && app.awaited != std::numeric_limits<std::uint64_t>::max() && answer->ticket >= app.opened) {
    app.answer = std::move(*answer);
    app.poses = app.answer.poses;
    if (app.answer.left_branch && app.on_branch && app.answer.ticket == app.awaited) {
      app.on_branch = false;
      app.notice = "The branch ends here; this is the state that the drawn pose settles in.";
    }
    // The time may have gone on, or back, while this was solved.
    app.moved_time = app.moved_time || app.answer.time != steady_time(app);
  }
  if (!converged(app)) return;
  const double time = steady_time(app);
  if (app.moved_time && time == 0) {
    app.poses = app.answer.solution.poses;
    app.moved_time = false;
  } else if (app.moved_time) {
    app.live.ask_poses(time);
    app.moved_time = false;
  }
  if (std::optional<LivePoses> poses = app.live.take_poses())
    if (poses->ticket == app.answer.ticket && time != 0) app.poses = std::move(poses->poses);
}

void fit_view(App& app, ViewSize size) {
  if (!app.view.fit) return;
  const ViewFrame frame = view_frame(app);
  const ViewScene& scene = *shown_scene(app);
  Bounds bounds = scene.solid.bounds;
  for (const Instance& instance : scene.ghost)
    bounds.add(instance_bounds(instance));
  if (app.view.keep_direction)
    app.view.camera.fit(bounds, size);
  else
    app.view.camera = initial_camera(*frame.mechanism, bounds, size);
  // Until the first answer is there nobody knows what will have to be in view.
  if (!solving(app)) app.view.fit = false;
}

} // namespace

App::App(AppOptions chosen)
    : options(std::move(chosen)), live(options.mode, options.on_news), theme(options.theme) {
  const Settings settings = read_settings(options.state);
  units = settings.units;
  panels.legend = settings.legend;
  open_document(*this, Document());
}

void open_document(App& app, Document document) {
  const bool same_file = !document.file().empty() && document.file() == app.document.file();
  app.problem.clear();
  app.notice.clear();
  app.document = std::move(document);
  app.answer = {};
  app.poses.clear();
  InspectorState fresh;
  fresh.history = app.inspector.history;
  if (same_file) fresh.points = std::move(app.inspector.points);
  app.inspector = std::move(fresh);
  app.tool = {.snap = app.tool.snap};
  if (!same_file) {
    app.playback = {.factor = app.playback.factor};
    app.mode = app.mechanism().bodies.empty() ? Mode::build : Mode::explore;
    app.view.fit = true;
    app.view.keep_direction = false;
  }
  app.document.put_explored_aside(app.mode == Mode::build);
  app.view.hovered = {};
  app.view.scene = app.view.scene_beside = {}; // revisions begin anew
  app.opened = app.asked + 1;
  take_document(app, true, false);
}

void edit(App& app, const std::string& name, const std::function<void(Mechanism&, Selection&)>& change) {
  Mechanism next = app.document.stored();
  Selection selection = app.selection();
  try {
    change(next, selection);
  } catch (const SceneError& error) {
    return show_error(app, error.what());
  }
  app.notice.clear();
  const std::uint64_t before = app.document.revision();
  app.document.edit(name, std::move(next), std::move(selection), app.gesture);
  if (app.document.revision() != before) take_document(app, false, false);
}

namespace {

// Whether a step changes what the present mode shows: while building, what was tried makes no difference.
bool is_seen(const App& app, std::size_t step) {
  const std::vector<Step>& steps = app.document.steps();
  return app.mode == Mode::explore || step == 0 || steps[step].mechanism != steps[step - 1].mechanism;
}

} // namespace

void undo(App& app) {
  const Document& document = app.document;
  if (!document.can_undo()) return;
  std::size_t step = document.position();
  while (step > 1 && !is_seen(app, step))
    --step;
  app.notice = "Undone: " + document.steps()[step].name;
  app.document.go_to(step - 1);
  take_document(app, false, false);
}

void redo(App& app) {
  const Document& document = app.document;
  if (!document.can_redo()) return;
  std::size_t step = document.position() + 1;
  while (step + 1 < document.steps().size() && !is_seen(app, step))
    ++step;
  app.document.go_to(step);
  app.notice = "Redone: " + document.steps()[step].name;
  take_document(app, false, false);
}

void go_to_step(App& app, std::size_t step) {
  if (step == app.document.position()) return;
  app.document.go_to(step);
  take_document(app, false, false);
}

void select(App& app, Selection selection) {
  app.document.select(std::move(selection));
}

namespace {

// A lone drive keeps its phase, so that nothing jumps when its speed changes.
void keep_phase(App& app, const std::string& address, double before, double value) {
  if (address.ends_with(".speed") && !app.motion.on && app.playback.time != 0 &&
      drive_count(app.mechanism()) == 1 && value != 0)
    app.playback.time *= before / value;
}

// Sets the number as a step of the history.
void set_parameter_from(App& app, const std::string& address, double value, StartValues start) {
  if (!std::isfinite(value)) return;
  const std::uint64_t revision = app.document.revision();
  const std::string step = "Set " + parameter_phrase(address);
  try {
    const double before = get_parameter(app.mechanism(), address);
    keep_phase(app, address, before, value);
    if (app.mode == Mode::explore)
      app.document.explore(step, {{address, value}}, app.gesture);
    else
      app.document.edit_number(step, address, value, app.gesture);
  } catch (const SceneError&) {
    return;
  }
  // What was solved last, or `start`, is where solving begins.
  if (app.document.revision() != revision)
    take_document(app, false, true, std::move(start), address);
  else if (!start.empty())
    ask(app, false, true, std::move(start));
}

} // namespace

void edit_parameter(App& app, const std::string& address, double value) {
  const std::uint64_t revision = app.document.revision();
  try {
    const double before = get_parameter(app.mechanism(), address);
    app.document.edit_number("Set " + parameter_phrase(address), address, value, app.gesture);
    keep_phase(app, address, before, value);
  } catch (const SceneError& error) {
    return show_error(app, error.what());
  }
  app.notice.clear();
  if (app.document.revision() != revision) take_document(app, false, app.mode == Mode::explore, {}, address);
}

void change_parameter(App& app, const std::string& address, double value) {
  set_parameter_from(app, address, value, {});
}

void change_parameters(App& app, const std::string& step, const Explored& values) {
  if (app.mode == Mode::build)
    return edit(app, step, [&](Mechanism& mechanism, Selection&) {
      for (const ExploredValue& each : values)
        set_parameter(mechanism, each.address, each.value);
    });
  const std::uint64_t revision = app.document.revision();
  app.document.explore(step, values, app.gesture);
  if (app.document.revision() != revision) take_document(app, false, false);
}

void go_to_state(App& app, const std::string& address, double value, StartValues start) {
  if (start.empty()) return change_parameter(app, address, value);
  app.on_branch = true;
  if (address.empty())
    ask(app, false, true, std::move(start));
  else
    set_parameter_from(app, address, value, std::move(start));
}

void keep_explored(App& app) {
  if (app.document.explored().empty()) return;
  app.document.keep_explored();
  app.notice = "The explored values are the document's now.";
  take_document(app, false, true);
}

void drop_explored(App& app) {
  if (app.document.explored().empty()) return;
  app.document.drop_explored();
  app.notice.clear();
  take_document(app, false, false);
}

std::vector<std::string> explored_words(const App& app) {
  std::vector<std::string> words;
  for (const ExploredValue& each : app.document.explored()) {
    const ShownUnit unit = shown_unit(parameter_unit(app.document.stored(), each.address), app.units);
    const auto text = [&](double value) {
      return short_text(unit.shown(value), 9) + (unit.text.empty() ? "" : " " + unit.text);
    };
    words.push_back(parameter_phrase(each.address) + " " + text(each.value) + ", stored is " +
                    text(get_parameter(app.document.stored(), each.address)));
  }
  return words;
}

void solve_from_drawn_pose(App& app) {
  ask(app, false, false);
}

void tell_point(App& app, const std::string& body, const std::optional<Vec3>& at) {
  if (at && !at->allFinite()) return;
  if (at)
    app.inspector.points.insert_or_assign(body, *at);
  else
    app.inspector.points.erase(body);
  ask(app, false, true); // from the last answer: what is shown stays
  retell_motion(app);
}

std::vector<BodyPoint> told_points(const App& app) {
  std::vector<BodyPoint> points;
  for (const auto& [body, at] : app.inspector.points)
    if (body_index(app.mechanism(), body) >= 0) points.push_back({body, at});
  return points;
}

namespace {

// Building shows what is stored.
void enter_mode(App& app, Mode mode) {
  app.mode = mode;
  if (app.document.put_explored_aside(mode == Mode::build)) take_document(app, false, mode == Mode::explore);
}

} // namespace

void set_mode(App& app, Mode mode) {
  enter_mode(app, mode);
  if (mode == Mode::build) {
    show_motion(app, false);
    play(app, false);
    rewind(app);
  } else if (app.tool.tool != Tool::pull) {
    app.tool.tool = Tool::select;
  }
}

void set_tool(App& app, Tool tool) {
  if (tool != Tool::select && tool != Tool::box && tool != Tool::pull) set_mode(app, Mode::build);
  app.tool.tool = tool;
}

void look_from(App& app, double azimuth, double elevation) {
  app.view.camera.azimuth = azimuth;
  app.view.camera.elevation = elevation;
  app.view.fit = app.view.keep_direction = true;
}

void play(App& app, bool playing) {
  app.playback.playing = playing && !app.mechanism().bodies.empty();
  if (!app.playback.playing) return;
  enter_mode(app, Mode::explore);
  // From the end, play means again.
  const MotionRun* motion = app.motion.on ? shown_motion(app) : nullptr;
  if (motion && motion->finished && app.playback.time >= motion->run->time.back())
    seek_motion(app, motion->run->time.front());
}

void rewind(App& app) {
  app.playback.time = 0;
  app.moved_time = true;
  if (app.motion.on) seek_motion(app, 0);
}

void update(App& app, double seconds, ViewSize view) {
  if (app.playback.playing && app.motion.on) {
    advance_motion(app, seconds * app.playback.factor);
  } else if (app.playback.playing && converged(app)) {
    app.playback.time += seconds * app.playback.factor;
    app.moved_time = true;
  }
  advance_mode(app, seconds);
  take_answer(app);
  update_motion(app);
  update_studies(app);
  app.waited = solving(app) ? app.waited + seconds : 0;
  fit_view(app, view);
}

bool converged(const App& app) {
  return app.answer.ticket && !app.answer.error && app.answer.solution.status == Status::converged;
}

bool solving(const App& app) {
  return app.awaited != std::numeric_limits<std::uint64_t>::max() && app.answer.ticket < app.awaited;
}

ViewFrame view_frame(const App& app) {
  ViewFrame frame;
  const bool solved = converged(app);
  if (app.mode == Mode::build) {
    frame.mechanism = &app.mechanism();
    // The answer may still be that to an earlier edit.
    if (app.tool.assembly) {
      frame.ghost = app.tool.assembly->start;
    } else if (solved && app.view.ghost && app.poses.size() == app.mechanism().bodies.size()) {
      frame.ghost = app.poses;
      frame.ghost_pose = GhostPose::steady;
    }
  } else {
    frame.mechanism = app.answer.ticket ? app.answer.mechanism.get() : &app.mechanism();
    if (app.tool.pull) frame.mechanism = app.tool.pull->mechanism.get(); // the tool draws the hand's spring
    const bool moves = app.motion.poses.size() == frame.mechanism->bodies.size();
    if (solved) {
      frame.poses = app.poses;
      if (app.view.ghost && app.drawn.size() == app.poses.size()) frame.ghost = app.drawn;
      if (moves && !app.motion.beside) frame.motion = app.motion.poses;
      if (const std::vector<Pose>& mode = app.study.modes.poses;
          moving_mode(app) && mode.size() == frame.mechanism->bodies.size()) {
        frame.motion = mode;
        frame.ghost = {}; // three of them would be too much to look at
      }
    } else if (moves) { // what has no steady state moves all the same
      frame.poses = app.motion.poses;
    }
  }
  frame.camera = app.view.camera;
  frame.theme = app.theme;
  frame.options.grid = app.view.grid;
  frame.options.shadow = app.view.shadow;
  frame.options.scale = app.scale;
  frame.selected = find_parts(*frame.mechanism, app.selection());
  frame.hovered = app.view.hovered;
  frame.cut_joints = app.answer.summary.cut_joints;
  frame.colouring = app.document.colouring();
  return frame;
}

ViewFrame motion_frame(const App& app) {
  ViewFrame frame = view_frame(app);
  frame.poses = app.motion.poses;
  frame.ghost = {};
  frame.motion = {};
  frame.hovered = {};
  return frame;
}

bool motion_beside(const App& app) {
  return app.mode == Mode::explore && app.motion.on && app.motion.beside;
}

bool in_motion(const App& app) {
  return (app.playback.playing && (app.motion.on || converged(app))) ||
         (app.study.modes.playing && moving_mode(app));
}

} // namespace flyball
