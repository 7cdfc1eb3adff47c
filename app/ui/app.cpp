#include "app/ui/app.hpp"

#include "app/session/follow_names.hpp"
#include "app/session/settings.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/view_frame.hpp"

#include <algorithm>
#include <utility>

namespace flyball {

namespace {

bool is_within(const ViewCamera& camera, ViewSize size, const Vec3& point) {
  const auto at = camera.project(point, size);
  return at && at->x() >= 0 && at->y() >= 0 && at->x() <= size.width && at->y() <= size.height;
}

// Arrows that have come and leave a view that held everything are to be taken into it: then true. When they
// have gone the camera goes back, if nobody has moved it since.
bool fit_loads(const ViewContext& context, ViewSize size) {
  ViewState& view = context.view;
  if (!view.fit_loads || view.fit) return false;
  const ViewScene& scene = *shown_scene(context);
  if (view.loads && scene.arrows.arrows.empty()) return false; // not yet
  view.fit_loads = false;
  const ViewCamera camera = settled_camera(view);
  if (!view.loads) {
    if (const auto was = std::exchange(view.loads_fit, {}); was && camera == was->after) {
      if (was->fitted && was->fitted->size != size) {
        fit_all(view);
      } else {
        glide_goal(view) = was->before;
        view.fitted = was->fitted;
      }
    }
    return false;
  }
  const bool all_seen = std::ranges::all_of(scene.solid.instances, [&](const Instance& instance) {
    return is_within(camera, size, instance.position);
  });
  const bool arrows_seen = std::ranges::all_of(scene.arrows.arrows, [&](const LoadArrow& arrow) {
    return is_within(camera, size, arrow.from) && is_within(camera, size, arrow.to);
  });
  if (!all_seen || arrows_seen) return false;
  fit_all(view);
  if (!view.loads_fit || camera != view.loads_fit->after) {
    const bool fitted = view.fitted && camera == view.fitted->camera;
    view.loads_fit = {camera, camera, fitted ? view.fitted : std::nullopt};
  }
  return true;
}

// How far the tools reach into the view, where something would lie behind them: from its left edge, or from
// the upper one where there is more room below them than beside (pixels); zero otherwise.
Vec2 hidden_by_tools(const ViewContext& context, const ViewCamera& camera, ViewSize size) {
  const WidgetMap& widgets = context.ui.widgets;
  const auto strip = widgets.find("tool strip"), whole = widgets.find("view");
  if (context.session.mode != Mode::build || strip == widgets.end() || whole == widgets.end())
    return Vec2::Zero();
  const ImVec2 origin = whole->second.from;
  const Vec2 end(static_cast<double>(strip->second.to.x - origin.x),
                 static_cast<double>(strip->second.to.y - origin.y));
  const auto hidden = [&](const Instance& instance) {
    const Bounds box = instance_bounds(instance);
    Vec2 low(1e300, 1e300);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 at(corner & 1 ? box.upper.x() : box.lower.x(), corner & 2 ? box.upper.y() : box.lower.y(),
                    corner & 4 ? box.upper.z() : box.lower.z());
      if (const auto pixel = camera.project(at, size)) low = low.cwiseMin(*pixel);
    }
    return low.x() < end.x() && low.y() < end.y();
  };
  const ViewScene& scene = *shown_scene(context);
  const bool any = std::ranges::any_of(scene.solid.instances, hidden) ||
                   std::ranges::any_of(scene.ghost, hidden) || std::ranges::any_of(scene.drawn, hidden);
  if (!any) return Vec2::Zero();
  const double beside = size.width - end.x(), below = size.height - end.y();
  const bool left = std::min(beside, size.height) >= std::min(below, size.width);
  constexpr double least = 0.25; // of the view, below which it is better seen behind them
  if (left) return beside > least * size.width ? Vec2(end.x(), 0) : Vec2(0, 0);
  return below > least * size.height ? Vec2(0, end.y()) : Vec2(0, 0);
}

void fit_whole(const ViewContext& context, ViewSize size) {
  const ViewScene& scene = *shown_scene(context);
  Bounds bounds = scene.solid.bounds;
  for (const std::vector<Instance>* beside : {&scene.ghost, &scene.drawn})
    for (const Instance& instance : *beside)
      bounds.add(instance_bounds(instance));
  const Mechanism& mechanism = *shown_mechanism(context.session, context.tool);
  if (!context.view.keep_direction) context.view.glide.reset();
  ViewCamera& camera = context.view.glide ? context.view.glide->to : context.view.camera;
  const auto fit = [&](ViewSize room) {
    if (context.view.keep_direction)
      camera.fit(bounds, room);
    else
      camera = initial_camera(mechanism, bounds, room);
  };
  fit(size);
  const bool chosen = !context.view.keep_direction && mechanism.view.camera; // as the scene has it
  if (const Vec2 tools = hidden_by_tools(context, camera, size); tools.any() && !chosen) {
    fit({size.width - tools.x(), size.height - tools.y()});
    camera.zoom(1 - tools.y() / size.height, {size.width / 2, size.height / 2}, size);
    camera.pan(tools.x() / 2, tools.y() / 2, size);
  }
  // Until the first answer is there nobody knows what will have to be in view, nor where the tools are before
  // they were drawn.
  const bool tools_known = context.session.mode != Mode::build || context.ui.widgets.contains("tool strip");
  if (!solving(context.session) && tools_known) context.view.fit = false;
  context.view.fitted.reset();
  if (!bounds.empty) context.view.fitted = {camera, size}; // what is drawn by and by leaves the view as it is
}

// A view of another size, as of a smaller window, is fitted anew while nobody has moved the camera.
void fit_another_size(ViewState& view, ViewSize size) {
  if (!view.fitted || view.fitted->size == size || view.fit) return;
  if (settled_camera(view) == view.fitted->camera)
    view.fit = true;
  else
    view.fitted.reset();
}

void fit_view(const ViewContext& context, ViewSize size) {
  ViewState& view = context.view;
  fit_another_size(view, size);
  const bool by_loads = view.loads_fit && settled_camera(view) == view.loads_fit->after;
  if (view.fit) {
    fit_whole(context, size);
    if (by_loads) view.loads_fit->after = settled_camera(view);
  }
  if (!fit_loads(context, size)) return;
  fit_whole(context, size);
  view.loads_fit->after = settled_camera(view);
}

// Another document is looked at afresh.
void show_document(App& app, bool same_file) {
  app.panels->outline = {};
  app.panels->inspector = {};
  app.panels->history.forget();
  app.panels->palette.forget();
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
  app.panels->studies.forget();
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
      panels(std::make_unique<Panels>()) {
  const Settings settings = read_settings(session.options.state);
  view.legend = settings.legend;
  view.ghost = settings.ghost;
  view.grid = settings.grid;
  view.shadow = settings.shadow;
  view.navigation = settings.navigation;
  view.animated = chosen.animated;
  ui.system_theme = chosen.theme;
  ui.zoom = settings.zoom;
  ui.theme_kept = settings.theme;
  ui.theme_choice = chosen.theme_choice.value_or(settings.theme);
  ui.theme = theme_of(ui.theme_choice, chosen.theme);
  session.on_document_opened = [this](bool same_file) { show_document(*this, same_file); };
  session.on_mode_chosen = [this] {
    if (session.mode == Mode::explore && tool.tool != Tool::pull) tool.tool = Tool::select;
  };
  session.on_edited = [this](const Mechanism& before) {
    for (Part& part : view.hidden)
      part = renamed_part(part, before, session.mechanism());
  };
  show_document(*this, false);
}

App::~App() = default;

void update(App& app, double seconds, ViewSize view) {
  update(app.session, seconds);
  update_report(app.session, app.report);
  app.panels->studies.forget_closed(app.session);
  app.view.size = view;
  fit_view(app.context(), view);
  advance_glide(app.view, seconds);
}

double next_progress(const App& app) {
  constexpr double beat = 0.2;
  return writing_report(app.report) ? beat : next_progress(app.session);
}

Layout layout_of(const App& app, float width, float height) {
  if (app.view.alone) return view_alone_layout(width, height);
  return layout_of(app.session, app.ui, app.sizes, width, height);
}

} // namespace flyball
