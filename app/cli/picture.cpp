#include "app/cli/picture.hpp"

#include "app/cli/report_error.hpp"
#include "app/platform/data_folder.hpp"
#include "app/render/offscreen.hpp"
#include "app/ui/snapshot.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

namespace flyball::cli {

void read_size(const std::string& text, int largest, int& width, int& height) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  const bool cross = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = cross ? std::from_chars(first.ptr + 1, end, height) : first;
  const bool read = cross && second.ec == std::errc() && second.ptr == end;
  if (!read || width < 1 || height < 1 || width > largest || height > largest)
    throw SceneError("--size",
                     fmt::format("expected WIDTHxHEIGHT from 1x1 to {0}x{0}, such as 1280x720", largest));
}

Picture draw_picture(const std::filesystem::path& scene, const PictureOptions& options) {
  Mechanism mechanism = load_scene(scene);
  for (const SceneError& warning : find_warnings(mechanism))
    report_warning(scene, warning);
  return draw_picture(std::move(mechanism), scene, options);
}

namespace {

// At both ends of its swing.
void show_mode(App& app, const PictureOptions& options) {
  open_study(app.session, StudyKind::modes);
  ModesState& modes = app.session.study.modes;
  const ViewSize size{static_cast<double>(options.width), static_cast<double>(options.height)};
  // One round solves and asks for the modes, the next takes them.
  for (int round = 0; round < 2; ++round)
    update(app, 0, size);
  if (!modes.list.problem.empty()) throw SceneError("--mode", modes.list.problem);
  if (!modes.list.found) return; // there is no equilibrium, which the answer tells
  const std::size_t count = modes.list.found->result.modes.size();
  if (count == 0) throw SceneError("--mode", "expected a scene whose equilibrium has modes");
  if (static_cast<std::size_t>(options.mode) > count)
    throw SceneError("--mode", fmt::format("expected 1 to {}", count));
  modes.amplitude = options.amplitude;
  modes.both_ends = true;
  choose_mode(app.session, static_cast<std::size_t>(options.mode) - 1);
  modes.playing = false;
}

} // namespace

Picture draw_picture(Mechanism mechanism, const std::filesystem::path& scene, const PictureOptions& options) {
  App app({.mode = LiveSolver::Mode::immediate,
           .on_news = {},
           .scenes = data_folder() / "scenes",
           .theme = options.theme,
           .numbers = {}});
  app.view.samples = options.antialiased ? 4 : 1;
  app.ui.scale = options.scale;
  app.view.loads = options.loads || !options.free_body.empty();
  app.view.load_lengths = options.load_lengths;
  open_document(app.session, Document(std::move(mechanism), scene));
  if (!options.free_body.empty()) {
    if (body_index(app.session.mechanism(), options.free_body) < 0)
      throw SceneError("--free-body", "no body is called \"" + options.free_body + "\"");
    select(app.session, {{Part{PartKind::body, options.free_body}}});
  }
  if (options.drawn_pose) {
    app.session.mode = Mode::build;
    app.view.ghost = false;
  }
  if (options.mode > 0) show_mode(app, options);
  const OffscreenContext context;
  const PixelSize size{options.width, options.height};
  Picture picture;
  picture.image = options.interface ? interface_picture(app, size, options.scale)
                                    : view_picture(app, size, options.scale);
  picture.drawn_by = context.description();
  picture.answer = app.session.answer;
  return picture;
}

} // namespace flyball::cli
