#include "app/ui/stage.hpp"

#include "app/ui/app.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/view_frame.hpp"
#include "app/ui/widgets/ui_style.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

constexpr float interface_text_size = 16; // points
constexpr int many_solids = 3000;
constexpr std::chrono::milliseconds rest{250}; // without movement, until a draft is drawn in full

ViewKey key_of(const ViewState& view, const ViewFrame& frame, const std::shared_ptr<const ViewScene>& scene,
               PixelSize size) {
  ViewKey key;
  key.size = size;
  key.samples = view.samples;
  key.grid = frame.options.grid;
  key.shadow = frame.options.shadow;
  key.scene = scene;
  key.selected = frame.selected;
  key.theme = frame.theme;
  key.scale = frame.options.scale;
  key.hovered = frame.hovered;
  key.camera = frame.camera;
  return key;
}

PixelSize pixels_of(const PanelRect& rect) {
  return {static_cast<int>(rect.width), static_cast<int>(rect.height)};
}

ImGuiContext* new_context(ImFontAtlas* fonts) {
  ImGuiContext* context = ImGui::CreateContext(fonts);
  ImGui::SetCurrentContext(context);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  return context;
}

} // namespace

Stage::Stage(Ui& ui, float scale, KeptFonts* kept)
    : former_(ImGui::GetCurrentContext()), kept_(kept),
      context_(new_context(kept ? &kept->atlas : nullptr), ImGui::DestroyContext) {
  set_scale(ui, scale);
}

Stage::~Stage() {
  ImGui::SetCurrentContext(former_);
}

void Stage::set_scale(Ui& ui, float scale) {
  ImGui::SetCurrentContext(context_.get());
  ui.scale = scale;
  if (kept_ && kept_->scale == scale) {
    ui.fonts = kept_->fonts;
  } else {
    ui.fonts = load_fonts(*ImGui::GetIO().Fonts, interface_text_size, scale);
    if (kept_) {
      kept_->fonts = ui.fonts;
      kept_->scale = scale;
    }
  }
  ImGui::GetIO().FontDefault = ui.fonts.text;
  renderer_.upload_fonts();
  apply_style(ui.theme, scale);
}

void Stage::frame(App& app, PixelSize size, double seconds, bool further) {
  ImGui::SetCurrentContext(context_.get());
  const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  const Layout layout = layout_of(app, width, height);
  const PanelRect& view = layout.view;
  opened_ = app.session.opened;
  view_rect_ = layout.view;
  beside_rect_ = layout.beside;
  update(app, seconds, {static_cast<double>(view.width), static_cast<double>(view.height)});
  ViewFrame shown = view_frame(app.session, app.ui, app.tool, app.view);
  shown.options.triad = !has_view_cube(app.ui, app.view, view); // the cube shows the axes
  app.view.texture =
      prepare(app.view, view_, shown, show_scene(app.session, app.tool, app.view, shown), pixels_of(view));
  if (layout.beside.width > 0) {
    ViewFrame motion = motion_frame(app.session, app.view, shown);
    motion.options.triad = true; // there is no cube
    app.view.texture_beside =
        prepare(app.view, beside_, motion, show_motion_scene(app.session, app.tool, app.view, motion),
                pixels_of(layout.beside));
  } else {
    beside_ = {};
  }
  if (const bool coarse = view_.is_coarse() || beside_.is_coarse(); coarse != told_coarse_) {
    told_coarse_ = coarse;
    if (coarse) app.session.notice = "The view is too large for OpenGL here and is drawn more coarsely.";
  }
  scene_pictures_.update(app.session, app.ui, app.view, app.panels->gallery,
                         app.dialog.wanted == Dialog::gallery, view_renderer_);
  movie_.update(app.context(), app.movie, view_renderer_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {width, height};
  io.DisplayFramebufferScale = {1, 1};
  io.UserData = &app.ui.tooltip;
  app.ui.tooltip.clock += seconds;
  app.ui.tooltip.due = std::numeric_limits<double>::infinity();
  constexpr float no_time = 1e-6f; // s, as good as none, which ImGui does not take
  io.DeltaTime =
      further ? no_time : std::max(static_cast<float>(seconds), 1.f / 60); // dialogs fade in with it
  ImGui::NewFrame();
  build_gui(app);
  ImGui::Render();
}

bool Stage::behind(const App& app, PixelSize size) const {
  const Layout layout = layout_of(app, static_cast<float>(size.width), static_cast<float>(size.height));
  return app.session.opened != opened_ || layout.view != view_rect_ || layout.beside != beside_rect_;
}

bool Stage::has_news() {
  ImGui::SetCurrentContext(context_.get());
  const bool changed = drawn_.take(*ImGui::GetDrawData());
  return changed || view_.due || beside_.due;
}

void Stage::render(const Ui& ui, const Framebuffer& target) {
  draw_due(view_);
  draw_due(beside_);
  target.bind();
  draw_interface(ui, {target.width(), target.height()});
}

void Stage::render(const Ui& ui, PixelSize window) {
  draw_due(view_);
  draw_due(beside_);
  bind_window_framebuffer(window.width, window.height);
  draw_interface(ui, window);
}

void Stage::draw_interface(const Ui& ui, PixelSize size) {
  ImGui::SetCurrentContext(context_.get());
  const ImVec4 background = ui_colors(ui.theme).panel;
  glViewport(0, 0, size.width, size.height);
  glClearColor(background.x, background.y, background.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  renderer_.draw(*ImGui::GetDrawData());
}

unsigned Stage::prepare(const ViewState& state, View& view, const ViewFrame& shown, const ShownScene& scene,
                        PixelSize size) {
  ViewKey key = key_of(state, shown, scene.scene, size);
  const auto now = std::chrono::steady_clock::now();
  if (key.samples != view.key.samples) {
    view.target.reset();
    view.quick.reset();
  }
  const bool changed = !view.target || !(key == view.key);
  if (!changed && !view.draft) return view.target->texture();
  if (changed) view.moved = now;
  const bool moving = view.target && (changed || now - view.moved < rest);
  const bool draft = drafts_ && moving && key.samples > 1 && view.solids > many_solids && draws_in_software();
  if (!changed && draft) return view.quick->texture();
  std::optional<Framebuffer>& target = draft ? view.quick : view.target;
  PixelSize& made = draft ? view.quick_made_for : view.target_made_for;
  if (!target || made != size) {
    target.reset(); // both at once may be too much
    target.emplace(largest_framebuffer(size.width, size.height, draft ? 1 : key.samples));
    made = size;
  }
  view.key = std::move(key);
  view.draft = draft;
  view.due = DueView{shown, scene.mechanism, scene.scene};
  ViewFrame& frame = view.due->frame;
  frame.mechanism = scene.mechanism.get();
  frame.poses = frame.ghost = frame.motion = {};
  frame.loads = nullptr;
  frame.loads_motion = nullptr;
  frame.load_scales = nullptr;
  frame.loads_turning = {};
  frame.cut_joints = {};
  frame.options.draft = draft;
  if (target->width() < size.width) // shown larger, with lines as thick as ever
    frame.options.scale *= static_cast<float>(target->width()) / static_cast<float>(size.width);
  ++views_changed_;
  return target->texture();
}

void Stage::draw_due(View& view) {
  if (!view.due) return;
  Framebuffer& target = view.draft ? *view.quick : *view.target;
  view.solids = view_renderer_.draw(view.due->frame, view.due->scene, target).drawn;
  view.due.reset();
}

} // namespace flyball
