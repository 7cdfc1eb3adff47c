#include "app/ui/snapshot.hpp"

#include "app/ui/app.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/plots/plot_picture.hpp"
#include "app/ui/plots/plot_save.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/mechanism/file.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace flyball {

Image view_picture(App& app, PixelSize size) {
  const ViewState former_view = app.view; // which another size may fit anew
  update(app, 0, {static_cast<double>(size.width), static_cast<double>(size.height)});
  ViewRenderer renderer;
  Framebuffer target(size.width, size.height, app.view.samples);
  ViewFrame frame = view_frame(app.session, app.ui, app.tool, app.view);
  frame.hovered = {};
  renderer.draw(frame, target);
  app.view = former_view;
  return target.read();
}

namespace {

// A switch of the app for as long as a picture takes, which may fail.
class Switched {
 public:
  Switched(bool& flag, bool value) : flag_(flag), former_(std::exchange(flag, value)) {}
  ~Switched() { flag_ = former_; }
  Switched(const Switched&) = delete;
  Switched& operator=(const Switched&) = delete;

 private:
  bool& flag_;
  bool former_;
};

} // namespace

Image view_picture(App& app, PixelSize size, float scale) {
  if (!app.view.loads) return view_picture(app, size);
  const Switched alone(app.view.alone, true);
  return interface_picture(app, size, scale);
}

Image interface_picture(App& app, PixelSize size, float scale) {
  const float former_scale = app.ui.scale;
  const UiFonts former_fonts = app.ui.fonts;
  const WidgetMap former_widgets = std::exchange(app.ui.widgets, {});
  const KeyboardState former_keyboard = std::exchange(app.ui.keyboard, {});
  const ViewState former_view = app.view;
  app.view.hovered = {};
  app.view.camera = settled_camera(app.view);
  app.view.glide.reset();
  app.view.animated = false;
  app.view.fit_loads = app.view.loads; // a picture has another shape than the window
  Image image;
  {
    Stage stage(app.ui, scale);
    // Sizes that ImGui learns from one frame settle in the next; the shade behind a dialog takes ten.
    for (int i = 0; i < 11; ++i)
      stage.frame(app, size, 0);
    Framebuffer target(size.width, size.height, 1);
    stage.render(app.ui, target);
    image = target.read();
  }
  app.ui.scale = former_scale;
  app.ui.fonts = former_fonts;
  app.ui.widgets = former_widgets;
  app.ui.keyboard = former_keyboard;
  app.view = former_view;
  return image;
}

void export_picture(App& app, PixelSize window) {
  if (!app.export_request) return;
  const ExportRequest request = *std::exchange(app.export_request, std::nullopt);
  const PixelSize size{request.width, request.height};
  app.session.notice.clear();
  if (request.report) return begin_report(app, request);
  try {
    // A larger picture of the panels has larger letters, not more room.
    const float grown = std::min(static_cast<float>(size.width) / static_cast<float>(window.width),
                                 static_cast<float>(size.height) / static_cast<float>(window.height));
    const float scale = std::max(1.f, std::round(4 * app.ui.scale * grown) / 4);
    const Switched loads(app.view.loads, request.loads);
    const Image image = request.plot     ? plot_picture(*request.plot, size)
                        : request.panels ? interface_picture(app, size, scale)
                                         : view_picture(app, size, scale);
    replace_file(request.file, encode_png(image));
    app.session.notice = "Saved " + request.file.string();
  } catch (const std::exception& error) {
    const std::string why = std::string("Not saved: ") + error.what();
    if (request.plot)
      app.panels->plot.refuse(app.dialog, *request.plot, why);
    else
      app.panels->picture.refuse(app.dialog, why);
  }
}

} // namespace flyball
