#include "app/ui/app.hpp"

#include "app/session/settings.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/load_view.hpp"

#include <algorithm>

namespace flyball {

namespace {

bool is_within(const ViewCamera& camera, ViewSize size, const Vec3& point) {
  const auto at = camera.project(point, size);
  return at && at->x() >= 0 && at->y() >= 0 && at->x() <= size.width && at->y() <= size.height;
}

// Arrows that have come and leave a view that held everything are to be taken into it: then true. When they
// have gone the camera goes back, if nobody has moved it since.
bool fit_loads(App& app, ViewSize size) {
  ViewState& view = app.view;
  if (!view.fit_loads) return false;
  const ViewScene& scene = *shown_scene(app);
  if (view.loads && scene.arrows.arrows.empty()) return false; // not yet
  view.fit_loads = false;
  const ViewCamera camera = settled_camera(view);
  if (!view.loads) {
    if (view.loads_fit && camera == (*view.loads_fit)[1]) glide_goal(view) = (*view.loads_fit)[0];
    view.loads_fit.reset();
    return false;
  }
  const bool all_seen = std::ranges::all_of(scene.solid.instances, [&](const Instance& instance) {
    return is_within(camera, size, instance.position);
  });
  const bool arrows_seen = std::ranges::all_of(scene.arrows.arrows, [&](const LoadArrow& arrow) {
    return is_within(camera, size, arrow.from) && is_within(camera, size, arrow.to);
  });
  if (!all_seen || arrows_seen) return false;
  fit_all(app);
  view.loads_fit = {camera, camera};
  return true;
}

void fit_view(App& app, ViewSize size) {
  const bool for_loads = fit_loads(app, size);
  if (!app.view.fit) return;
  const ViewScene& scene = *shown_scene(app);
  Bounds bounds = scene.solid.bounds;
  for (const Instance& instance : scene.ghost)
    bounds.add(instance_bounds(instance));
  if (app.view.keep_direction) {
    (app.view.glide ? app.view.glide->to : app.view.camera).fit(bounds, size);
  } else {
    app.view.glide.reset();
    app.view.camera = initial_camera(*shown_mechanism(app.session, app.tool), bounds, size);
  }
  if (for_loads) (*app.view.loads_fit)[1] = settled_camera(app.view);
  // Until the first answer is there nobody knows what will have to be in view.
  if (!solving(app.session)) app.view.fit = false;
}

// Another document is looked at afresh.
void show_document(App& app, bool same_file) {
  InspectorState fresh;
  fresh.history = app.inspector.history;
  app.inspector = std::move(fresh);
  app.ui.fields = {};
  app.ui.sections = {};
  app.tool = {.snap = app.tool.snap};
  if (!same_file) {
    app.view.fit = true;
    app.view.keep_direction = false;
    app.view.hidden.clear();
    KeyboardState& keyboard = app.ui.keyboard; // the view has the keys
    keyboard.at.clear();
    keyboard.ring = false;
    for (auto& behind : keyboard.behind)
      behind = {};
    keyboard.focus = {};
  }
  app.plots = {};
  app.view.hovered = {};
  app.view.scene = app.view.scene_beside = {}; // revisions begin anew
}

} // namespace

App::App(AppOptions chosen)
    : session({.mode = chosen.mode,
               .on_news = std::move(chosen.on_news),
               .scenes = std::move(chosen.scenes),
               .numbers = chosen.numbers,
               .state = std::move(chosen.state)}),
      system_theme(chosen.theme) {
  const Settings settings = read_settings(session.options.state);
  panels.legend = settings.legend;
  navigation = settings.navigation;
  view.animated = chosen.animated;
  theme_choice = chosen.theme_choice.value_or(settings.theme);
  ui.theme = theme_of(theme_choice, chosen.theme);
  session.on_document_opened = [this](bool same_file) { show_document(*this, same_file); };
  session.on_mode_chosen = [this] {
    if (session.mode == Mode::explore && tool.tool != Tool::pull) tool.tool = Tool::select;
  };
  show_document(*this, false);
}

void set_tool(App& app, Tool tool) {
  app.ui.keyboard.at.clear();                 // the tool works in the view
  for (auto& behind : app.ui.keyboard.behind) // also if it was chosen in the menu of a field
    behind = {};
  if (tool != Tool::select && tool != Tool::box && tool != Tool::pull) set_mode(app.session, Mode::build);
  app.tool.tool = tool;
}

void look_from(ViewState& view, double azimuth, double elevation) {
  ViewCamera& camera = glide_goal(view);
  camera.azimuth = azimuth;
  camera.elevation = elevation;
  view.fit = view.keep_direction = true;
}

void update(App& app, double seconds, ViewSize view) {
  update(app.session, seconds);
  update_report(app.session, app.report);
  // What is closed is looked at afresh when it is opened again.
  if (app.session.study.open != StudyKind::response) app.plots.response = {};
  if (app.session.study.open != StudyKind::map) app.plots.map = {};
  if (app.session.study.open != StudyKind::spread) app.plots.spread = {};
  if (app.session.study.open != StudyKind::transfer) {
    const bool hertz = app.plots.transfer.hertz;
    app.plots.transfer = {};
    app.plots.transfer.hertz = hertz;
  }
  if (app.session.study.open != StudyKind::modes) {
    const bool hertz = app.plots.campbell.hertz;
    app.plots.campbell = {};
    app.plots.campbell.hertz = hertz;
  }
  app.view.size = view;
  fit_view(app, view);
  advance_glide(app.view, seconds);
}

const std::shared_ptr<const Mechanism>& shown_mechanism(const Session& session, const ToolState& tool) {
  if (session.mode == Mode::build) return session.document.shared();
  if (tool.pull) return tool.pull->mechanism; // the tool draws the hand's spring
  return session.answer.ticket ? session.answer.mechanism : session.document.shared();
}

ViewFrame view_frame(const App& app) {
  ViewFrame frame;
  frame.mechanism = shown_mechanism(app.session, app.tool).get();
  const bool solved = converged(app.session) || (periodic_motion(app.session) && !app.session.poses.empty());
  if (app.session.mode == Mode::build) {
    // The answer may still be that to an earlier edit.
    if (app.tool.assembly) {
      frame.ghost = app.tool.assembly->start;
    } else if (solved && app.view.ghost &&
               app.session.poses.size() == app.session.mechanism().bodies.size()) {
      frame.ghost = app.session.poses;
      frame.ghost_pose = GhostPose::steady;
    }
  } else {
    const bool moves = app.session.motion.poses.size() == frame.mechanism->bodies.size();
    if (solved) {
      frame.poses = app.session.poses;
      if (app.view.ghost && app.session.drawn.size() == app.session.poses.size())
        frame.ghost = app.session.drawn;
      if (moves && !app.session.motion.beside) frame.motion = app.session.motion.poses;
      if (const std::vector<Pose>& mode = app.session.study.modes.poses;
          moving_mode(app.session) && !mode.empty() && mode.size() % frame.mechanism->bodies.size() == 0) {
        frame.motion = mode;
        frame.ghost = {}; // three of them would be too much to look at
      }
    } else if (moves) { // what has no steady state moves all the same
      frame.poses = app.session.motion.poses;
    }
  }
  frame.camera = app.view.camera;
  frame.theme = app.ui.theme;
  frame.options.grid = app.view.grid;
  frame.options.shadow = app.view.shadow;
  frame.options.scale = app.ui.scale;
  frame.selected = find_parts(*frame.mechanism, app.session.selection());
  frame.hovered = app.view.hovered;
  frame.hidden = find_parts(*frame.mechanism, {app.view.hidden});
  show_loads(app.session, app.tool, app.view, frame);
  frame.cut_joints = app.session.answer.summary.cut_joints;
  frame.colouring = app.session.document.colouring();
  return frame;
}

ViewFrame motion_frame(const Session& session, ViewFrame frame) {
  frame.poses = session.motion.poses;
  frame.ghost = {};
  frame.motion = {};
  frame.loads = nullptr;
  frame.hovered = {};
  return frame;
}

} // namespace flyball
