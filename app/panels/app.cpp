#include "app/panels/app.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"

#include <cmath>

namespace flyball {

namespace {

void ask(App& app, bool another, bool warm) {
  app.live.ask({.mechanism = app.mechanism, .time = app.playback.time, .another = another, .warm = warm});
}

bool converged(const App& app) {
  return app.answer.ticket && !app.answer.error && app.answer.solution.status == Status::converged;
}

int drive_count(const Mechanism& mechanism) {
  int count = 0;
  for (const Joint& joint : mechanism.joints)
    for (const Coordinate& coordinate : joint.coordinates)
      if (coordinate.drive) ++count;
  return count;
}

void take_answer(App& app) {
  if (std::optional<LiveAnswer> answer = app.live.take_answer()) {
    app.answer = std::move(*answer);
    app.drawn = drawn_poses(app.answer.mechanism);
    app.poses = app.answer.poses;
    // The time may have gone on, or back, while this was solved.
    app.moved_time = app.moved_time || app.answer.time != app.playback.time;
  }
  if (!converged(app)) return;
  if (app.moved_time && app.playback.time == 0) {
    app.poses = app.answer.solution.poses;
    app.moved_time = false;
  } else if (app.moved_time) {
    app.live.ask_poses(app.playback.time);
    app.moved_time = false;
  }
  if (std::optional<LivePoses> poses = app.live.take_poses())
    if (poses->ticket == app.answer.ticket && app.playback.time != 0) app.poses = std::move(poses->poses);
}

void fit_view(App& app, ViewSize size) {
  if (!app.view.fit || !app.open) return;
  const ViewFrame frame = view_frame(app);
  Bounds bounds = scene_of(frame).bounds;
  if (app.view.ghost)
    for (const Instance& instance : build_ghost(*frame.mechanism, frame.ghost, {}))
      bounds.add(instance_bounds(instance));
  if (app.view.keep_direction)
    app.view.camera.fit(bounds, size);
  else
    app.view.camera = initial_camera(*frame.mechanism, bounds, size);
  // Until the first answer is there nobody knows what will have to be in view.
  if (app.answer.ticket) app.view.fit = false;
}

} // namespace

App::App(AppOptions chosen)
    : options(std::move(chosen)), live(options.mode, options.on_news), theme(options.theme) {}

void open_mechanism(App& app, Mechanism mechanism, const std::filesystem::path& file) {
  const bool same_file = app.open && file == app.file;
  app.problem.clear();
  app.notice.clear();
  app.file = file;
  app.original = app.mechanism = std::move(mechanism);
  app.open = true;
  app.parameters = parameter_controls(app.mechanism);
  app.answer = {};
  app.poses.clear();
  app.drawn = drawn_poses(app.mechanism);
  app.panels.editing.clear();
  if (!same_file) {
    app.playback = {.factor = app.playback.factor};
    app.view.fit = true;
    app.view.keep_direction = false;
  }
  app.view.hovered = {};
  ask(app, true, false);
}

void open_scene(App& app, const std::filesystem::path& file) {
  try {
    open_mechanism(app, load_scene(file), file);
  } catch (const SceneError& error) {
    app.problem = error.what();
  }
}

void reload_scene(App& app) {
  if (!app.file.empty()) open_scene(app, std::filesystem::path(app.file));
}

void change_parameter(App& app, const std::string& address, double value) {
  if (!app.open || !std::isfinite(value)) return;
  try {
    const double before = get_parameter(app.mechanism, address);
    set_parameter(app.mechanism, address, value);
    // A lone drive keeps its phase, so that nothing jumps when its speed changes.
    if (address.ends_with(".speed") && app.playback.time != 0 && drive_count(app.mechanism) == 1 &&
        value != 0)
      app.playback.time *= before / value;
  } catch (const SceneError&) {
    return;
  }
  ask(app, false, true);
}

void reset_parameters(App& app) {
  app.mechanism = app.original;
  ask(app, false, false);
}

void solve_from_drawn_pose(App& app) {
  if (app.open) ask(app, false, false);
}

void look_from(App& app, double azimuth, double elevation) {
  app.view.camera.azimuth = azimuth;
  app.view.camera.elevation = elevation;
  app.view.fit = app.view.keep_direction = true;
}

void play(App& app, bool playing) {
  app.playback.playing = playing && app.open;
}

void rewind(App& app) {
  app.playback.time = 0;
  app.moved_time = true;
}

void update(App& app, double seconds, ViewSize view) {
  if (in_motion(app)) {
    app.playback.time += seconds * app.playback.factor;
    app.moved_time = true;
  }
  take_answer(app);
  fit_view(app, view);
}

ViewFrame view_frame(const App& app) {
  ViewFrame frame;
  if (!app.open) return frame;
  frame.mechanism = app.answer.ticket ? &app.answer.mechanism : &app.mechanism;
  if (converged(app) && app.view.solid) {
    frame.poses = app.poses;
    if (app.view.ghost) frame.ghost = app.drawn;
  }
  frame.camera = app.view.camera;
  frame.theme = app.theme;
  frame.options.grid = app.view.grid;
  frame.options.shadow = app.view.shadow;
  frame.options.scale = app.scale;
  frame.hovered = app.view.hovered;
  frame.cut_joints = app.answer.summary.cut_joints;
  return frame;
}

bool in_motion(const App& app) {
  return app.playback.playing && converged(app);
}

} // namespace flyball
