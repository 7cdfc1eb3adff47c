#include "app/panels/stage.hpp"

#include "app/panels/layout.hpp"
#include "app/panels/ui_style.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr float text_size = 16; // points

ViewKey key_of(const App& app, const ViewFrame& frame, PixelSize size) {
  ViewKey key;
  key.size = size;
  key.samples = app.view.samples;
  key.ghost = app.view.ghost;
  key.grid = app.view.grid;
  key.shadow = app.view.shadow;
  key.mode = app.mode;
  // While exploring, the picture waits for the answer.
  if (app.mode == Mode::build || !app.answer.ticket) key.revision = app.document.revision();
  key.selection = app.selection();
  key.theme = app.theme;
  key.scale = app.scale;
  key.hovered = app.view.hovered;
  const ViewCamera& c = frame.camera;
  key.camera = {c.target.x(), c.target.y(), c.target.z(), c.distance, c.azimuth,
                c.elevation,  c.up.x(),     c.up.y(),     c.up.z()};
  key.ticket = app.answer.ticket;
  key.poses.reserve(7 * (frame.poses.size() + frame.motion.size()));
  for (const std::span<const Pose> poses : {frame.poses, frame.motion})
    for (const Pose& pose : poses) {
      key.poses.insert(key.poses.end(), pose.position.begin(), pose.position.end());
      const auto& q = pose.rotation.coeffs();
      key.poses.insert(key.poses.end(), q.begin(), q.end());
    }
  return key;
}

PixelSize pixels_of(const PanelRect& rect) {
  return {static_cast<int>(rect.width), static_cast<int>(rect.height)};
}

ImGuiContext* new_context() {
  ImGuiContext* context = ImGui::CreateContext();
  ImGui::SetCurrentContext(context);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  return context;
}

} // namespace

Stage::Stage(App& app, float scale)
    : former_(ImGui::GetCurrentContext()), context_(new_context(), ImGui::DestroyContext) {
  set_scale(app, scale);
}

Stage::~Stage() {
  ImGui::SetCurrentContext(former_);
}

void Stage::set_scale(App& app, float scale) {
  ImGui::SetCurrentContext(context_.get());
  app.scale = scale;
  app.fonts = load_fonts(*ImGui::GetIO().Fonts, text_size, scale);
  ImGui::GetIO().FontDefault = app.fonts.text;
  renderer_.upload_fonts();
  apply_style(app.theme, scale);
}

void Stage::frame(App& app, PixelSize size, double seconds) {
  ImGui::SetCurrentContext(context_.get());
  const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  const Layout layout = layout_of(app, width, height);
  const PanelRect& view = layout.view;
  update(app, seconds, {static_cast<double>(view.width), static_cast<double>(view.height)});
  app.view.texture = draw_view(app, view_, view_frame(app), pixels_of(view));
  if (layout.beside.width > 0)
    app.view.texture_beside = draw_view(app, beside_, motion_frame(app), pixels_of(layout.beside));
  else
    beside_ = {};
  scene_pictures_.update(app, view_renderer_);
  movie_.update(app, view_renderer_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {width, height};
  io.DisplayFramebufferScale = {1, 1};
  io.DeltaTime = std::max(static_cast<float>(seconds), 1.f / 60); // shades behind dialogs fade in with it
  ImGui::NewFrame();
  build_gui(app);
  ImGui::Render();
}

void Stage::render(const App& app, PixelSize size) {
  ImGui::SetCurrentContext(context_.get());
  const ImVec4 background = ui_colors(app.theme).panel;
  glViewport(0, 0, size.width, size.height);
  glClearColor(background.x, background.y, background.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  renderer_.draw(*ImGui::GetDrawData());
}

unsigned Stage::draw_view(const App& app, View& view, const ViewFrame& frame, PixelSize size) {
  ViewKey key = key_of(app, frame, size);
  if (view.target && key == view.drawn) return view.target->texture();
  if (!view.target || size != view.drawn.size || key.samples != view.drawn.samples)
    view.target.emplace(size.width, size.height, key.samples);
  view_renderer_.draw(frame, *view.target);
  view.drawn = std::move(key);
  ++views_drawn_;
  return view.target->texture();
}

} // namespace flyball
