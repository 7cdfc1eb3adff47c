// What it costs to look at a mechanism of 10 to 10 000 bodies: frames of the window while the camera turns,
// while everything moves and while nothing happens, on OpenGL in software, which is the slowest there is.
// Nothing is solved: the drawn pose stands for the steady state.
#include "app/render/offscreen.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/stage.hpp"
#include "app/viewport/picking.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/app/large_answer.hpp"
#include "tests/app/large_mechanisms.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>

using namespace flyball;
using namespace flyball::test;

namespace {

using Clock = std::chrono::steady_clock;

constexpr PixelSize window{1280, 800};
constexpr ViewSize view{1280, 800};

// The fastest of a few runs, in ms.
template <class Run>
double fastest(int runs, const Run& run) {
  double best = 1e300;
  for (int i = 0; i < runs; ++i) {
    const auto start = Clock::now();
    run();
    best = std::min(best, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return best;
}

// Drawing alone, 1280 x 800 with four samples a pixel.
void draw_view(const char* name, const Mechanism& m) {
  ViewRenderer renderer;
  Framebuffer target(window.width, window.height, 4);
  ViewFrame frame;
  frame.mechanism = &m;
  frame.camera = initial_camera(m, scene_of(frame).bounds, view);
  auto scene = std::make_shared<const ViewScene>(view_scene(frame));
  ViewReport report;
  const auto draw = [&] {
    frame.camera.orbit(9, 3, view);
    report = renderer.draw(frame, scene, target);
    glFinish();
  };
  draw(); // meshes and shaders are made
  const double turning = fastest(5, draw);
  const double list = fastest(3, [&] { scene = std::make_shared<const ViewScene>(view_scene(frame)); });
  const double moving = fastest(3, [&] {
    scene = std::make_shared<const ViewScene>(view_scene(frame));
    draw();
  });
  const int calls = report.draw_calls;
  frame.options.shadow = false;
  const double unshaded = fastest(5, draw);
  const double picking = fastest(3, [&] {
    pick(scene->solid.instances, frame.camera.ray({640, 400}, view));
  });
  std::printf("%-6s %6zu %8d %8d %6d %9.1f %9.1f %9.1f %9.1f %9.2f\n", name, m.bodies.size(),
              report.instances, report.drawn, calls, turning, unshaded, moving, list, picking);
}

// The whole window, of which the view is a part; `moves` is done before every frame.
void use_window(const Mechanism& m) {
  App app({.mode = LiveSolver::Mode::background, .on_news = {}, .scenes = {}, .numbers = {}});
  const auto file = std::filesystem::temp_directory_path() / "flyball-draw-bench.json";
  write_bytes(file, write_scene(unsolved(m)));
  Stage stage(app.ui, 1);
  const double opening = fastest(2, [&] { open_scene(app.session, file); });
  std::filesystem::remove(file);
  answer_as_drawn(app);
  const auto frame = [&] { stage.frame(app, window, 0.01); };
  for (int i = 0; i < 4; ++i)
    frame();
  const int drawn = stage.views_changed();
  const double still = fastest(5, frame);
  const bool drew = stage.views_changed() != drawn;
  set_mode(app.session, Mode::build);
  for (int i = 0; i < 4; ++i)
    frame();
  const double building = fastest(5, frame);
  const std::string& body = app.session.mechanism().bodies.back().name;
  const double editing = fastest(3, [&] {
    edit(app.session, "Mass", [&](Mechanism& changed, Selection&) { changed.bodies.back().mass += 1; });
    answer_as_drawn(app);
  });
  const double selecting = fastest(3, [&] {
    Selection all;
    for (const Body& each : app.session.mechanism().bodies)
      all.parts.push_back({PartKind::body, each.name});
    select(app.session, std::move(all));
  });
  select(app.session, {{{PartKind::body, body}}});
  const double undoing = fastest(2, [&] { undo(app.session); });
  std::printf("%12zu %10.1f %12.2f%s %12.2f %12.2f %12.2f %12.2f\n", m.bodies.size(), opening, still,
              drew ? "!" : " ", building, editing, undoing, selecting);
}

} // namespace

int main() {
  OffscreenContext context;
  std::printf("The view, 1280 x 800, 4 samples a pixel, %s; ms, fastest of five\n"
              "%-6s %6s %8s %8s %6s %9s %9s %9s %9s %9s\n",
              context.description().c_str(), "", "bodies", "solids", "seen", "calls", "turning", "no shadow",
              "moving", "list", "picking");
  const std::array counts{10, 100, 1000, 10000};
  for (const int count : counts)
    draw_view("chain", long_chain(count));
  for (const int count : counts)
    draw_view("tree", branching_tree(count));
  for (const int count : counts)
    draw_view("net", cable_net(static_cast<int>(std::lround(std::sqrt(count)))));
  std::printf("\nThe window with a chain; ms\n%12s %10s %13s %12s %12s %12s %12s\n", "bodies", "opening",
              "still frame", "building", "an edit", "undo", "select all");
  for (const int count : counts)
    use_window(long_chain(count));
}
