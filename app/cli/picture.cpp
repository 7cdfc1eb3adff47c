#include "app/cli/picture.hpp"

#include "app/cli/assets.hpp"
#include "app/panels/snapshot.hpp"
#include "app/render/offscreen.hpp"
#include "engine/mechanism/scene.hpp"

namespace flyball::cli {

Picture draw_picture(const std::filesystem::path& scene, const PictureOptions& options) {
  App app({.mode = LiveSolver::Mode::immediate,
           .on_news = {},
           .scenes = shipped_scenes(),
           .theme = options.theme,
           .numbers = {}});
  app.view.samples = options.antialiased ? 4 : 1;
  app.scale = options.scale;
  open_document(app, Document(load_scene(scene), scene));
  if (options.drawn_pose) {
    app.mode = Mode::build;
    app.view.ghost = false;
  }
  const OffscreenContext context;
  const PixelSize size{options.width, options.height};
  Picture picture;
  picture.image = options.interface ? interface_picture(app, size, options.scale) : view_picture(app, size);
  picture.answer = app.answer;
  return picture;
}

} // namespace flyball::cli
