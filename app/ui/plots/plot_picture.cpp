#include "app/ui/plots/plot_picture.hpp"

#include "app/plot/colors.hpp"
#include "app/render/framebuffer.hpp"
#include "app/render/imgui_renderer.hpp"
#include "app/ui/plots/plot_draw.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// An ImGui context of its own, for as long as a picture takes.
class Sketchbook {
 public:
  explicit Sketchbook(PixelSize size) : former_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(own_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_VIEWPORT, viewport_);
  }
  ~Sketchbook() {
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    ImGui::DestroyContext(own_);
    ImGui::SetCurrentContext(former_);
  }
  Sketchbook(const Sketchbook&) = delete;
  Sketchbook& operator=(const Sketchbook&) = delete;

 private:
  ImGuiContext *former_, *own_;
  GLint framebuffer_ = 0, viewport_[4] = {};
};

constexpr float text_size = 16; // points

} // namespace

Image draw_plot_picture(const Plot& plot, const PlotPictureOptions& options, const PlotLook& look) {
  const Sketchbook sketchbook(options.size);
  const UiFonts fonts = load_fonts(*ImGui::GetIO().Fonts, text_size, options.scale);
  ImGuiRenderer renderer;
  renderer.upload_fonts();
  const Framebuffer target(options.size.width, options.size.height, 1);
  ImGui::NewFrame();
  const PlotPen pen{*ImGui::GetBackgroundDrawList(), fonts, {0, 0}, options.scale, options.ground};
  const PlotLayout layout =
      plot_layout(plot, look, options.size.width, options.size.height, plot_metrics(fonts, options.scale));
  draw_plot(pen, plot, look, layout);
  draw_marker(pen, plot, layout, false);
  ImGui::Render();
  target.bind();
  const ImVec4 page = ImGui::ColorConvertU32ToFloat4(packed_color(plot_colors(options.ground).page));
  glClearColor(page.x, page.y, page.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  renderer.draw(*ImGui::GetDrawData());
  return target.read();
}

Image plot_picture(const PlotSave& save, PixelSize size) {
  const double grown =
      std::min(size.width / std::max(save.width, 1.), size.height / std::max(save.height, 1.));
  const auto scale = static_cast<float>(std::clamp(std::round(4 * grown) / 4, 1., 8.));
  return draw_plot_picture(save.plot, {.size = size, .scale = scale, .ground = save.ground}, save.look);
}

} // namespace flyball
