// Thousands of bodies: they look as a few do, only faster.
#include "app/render/compare.hpp"
#include "app/render/offscreen.hpp"
#include "app/viewport/level_of_detail.hpp"
#include "app/viewport/picking.hpp"
#include "app/viewport/primitives.hpp"
#include "app/viewport/view_renderer.hpp"
#include "tests/app/large_mechanisms.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

ViewFrame frame_of(const Mechanism& mechanism, ViewSize view) {
  ViewFrame frame;
  frame.mechanism = &mechanism;
  frame.camera.fit(scene_of(frame).bounds, view);
  return frame;
}

ViewFrame bare(ViewFrame frame) {
  frame.options.grid = frame.options.shadow = frame.options.triad = false;
  return frame;
}

// Each pixel the mean of `times` x `times`.
Image shrunk(const Image& large, int times) {
  Image small(large.width / times, large.height / times);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int i = 0; i < times * times; ++i)
          sum += large.at(times * x + i % times, times * y + i / times)[c];
        small.at(x, y)[c] = static_cast<std::uint8_t>((sum + times * times / 2) / (times * times));
      }
  return small;
}

bool alike(const std::uint8_t* a, const std::uint8_t* b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

SeenSolid seen_from(double distance, Instance instance, ViewSize view = {1280, 800}) {
  ViewCamera camera;
  camera.distance = distance;
  const Sight sight = sight_of(camera, view);
  const auto seen = see(instance, sight, sight.facing());
  REQUIRE(seen);
  return *seen;
}

} // namespace

TEST_CASE("many bodies drawn at once look as when drawn a few at a time") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(320, 200, 1);
  constexpr int columns = 30, rows = 18;
  const Mechanism all = ball_grid(columns, rows, 0.04);
  ViewFrame frame = bare(frame_of(all, {320, 200}));
  frame.options.joints = false;
  Mechanism none;
  frame.mechanism = &none;
  renderer.draw(frame, target);
  const Image empty = target.read();
  frame.mechanism = &all;
  renderer.draw(frame, target);
  const Image picture = target.read();

  int covered = 0;
  const std::vector<Color> colors = [&] {
    std::vector<Color> own;
    for (const Instance& instance : scene_of(frame).instances)
      own.push_back(instance.color);
    return own;
  }();
  for (int part = 0; part < 6; ++part) {
    Mechanism few;
    for (std::size_t i = 0; i < all.bodies.size(); ++i) {
      if (static_cast<int>(i) * 6 / (columns * rows) != part) continue;
      few.bodies.push_back(all.bodies[i]);
      few.bodies.back().shapes[0].color = {{colors[i].r, colors[i].g, colors[i].b}};
    }
    frame.mechanism = &few;
    renderer.draw(frame, target);
    const Image own = target.read();
    int differing = 0;
    for (int y = 0; y < own.height; ++y)
      for (int x = 0; x < own.width; ++x) {
        if (alike(own.at(x, y), empty.at(x, y))) continue;
        ++covered;
        differing += !alike(own.at(x, y), picture.at(x, y));
      }
    INFO("part " << part);
    CHECK(differing == 0);
  }
  int shown = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      shown += !alike(picture.at(x, y), empty.at(x, y));
  CHECK(covered == shown);
  CHECK(shown > 10000);
}

TEST_CASE("coarse solids look like fine ones at the size they are drawn in") {
  OffscreenContext context;
  ViewRenderer renderer;
  for (const Mechanism& m : {long_chain(40), branching_tree(60), cable_net(12), governor()}) {
    INFO(m.name);
    const ViewSize view{240, 160};
    const ViewFrame frame = bare(frame_of(m, view));
    Framebuffer small(240, 160, 4), large(1920, 1280, 1);
    renderer.draw(frame, small);
    const Image picture = small.read();
    renderer.draw(frame, large);
    const ImageComparison compared =
        compare(picture, shrunk(large.read(), 8), {.channel = 48, .stray = 0.004});
    INFO(compared.message);
    CHECK(compared.same);
  }
}

TEST_CASE("what fills the picture is as smooth as can be, what is a point is not") {
  Instance ball;
  ball.round = 0.1;
  ball.part = {PartKind::body, 0};
  CHECK(seen_from(0.5, ball).detail == finest_detail);
  CHECK(seen_from(2, ball).detail == finest_detail);
  CHECK(seen_from(1000, ball).detail == 0);
  // Never farther off than an eighth of a pixel, as long as anything can be seen of it.
  int before = finest_detail;
  for (double distance = 0.5; distance < 1000; distance *= 1.07) {
    const SeenSolid seen = seen_from(distance, ball);
    CHECK(seen.detail <= before);
    before = seen.detail;
    ViewCamera camera;
    camera.distance = distance;
    const double pixels = 0.1 / camera.pixel_size({1280, 800});
    if (pixels < 0.5) {
      CHECK(seen.grow * pixels == Approx(0.5).epsilon(0.01));
      continue;
    }
    const int sides = detail_sides[static_cast<std::size_t>(seen.detail)];
    const double inner = std::cos(std::numbers::pi / sides), step = 2 * std::numbers::pi / sides;
    const double grown = seen.detail < 2 ? std::sqrt(step / std::sin(step)) : 1;
    CHECK(pixels * std::max(1 - grown * inner, grown - 1) < 0.135);
  }
}

TEST_CASE("coarse solids have a fraction of the triangles and as much to show") {
  for (int p = 0; p < primitive_count; ++p) {
    const auto triangles = [&](int detail) {
      return primitive_mesh(static_cast<Primitive>(p), detail).indices.size() / 3;
    };
    INFO("primitive " << p);
    for (int detail = 1; detail < detail_levels; ++detail)
      CHECK(triangles(detail - 1) <= triangles(detail));
    CHECK(triangles(0) <= 200);
    CHECK(triangles(1) <= 450);
  }
  for (const Primitive primitive : {Primitive::sphere, Primitive::capsule}) {
    CHECK(primitive_mesh(primitive, 0).indices.size() == 2 * 3);
    CHECK(primitive_mesh(primitive, 1).indices.size() == 4 * 3);
  }
}

TEST_CASE("what is out of view is not drawn") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(64, 48, 1);
  const Mechanism m = long_chain(500);
  ViewFrame frame = frame_of(m, {64, 48});
  frame.camera.target = m.bodies[250].position;
  frame.camera.distance = 1;
  const ViewReport near = renderer.draw(frame, target);
  CHECK(near.drawn > 0);
  CHECK(near.drawn < near.instances / 20);
  frame.camera.target.y() += 100;
  CHECK(renderer.draw(frame, target).drawn == 0);
  frame.camera.orthographic = true;
  CHECK(renderer.draw(frame, target).drawn == 0);
}

TEST_CASE("draw calls do not grow with the bodies") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(160, 120, 1);
  const auto calls = [&](int columns, int rows) {
    const Mechanism m = ball_grid(columns, rows, 0.04);
    ViewFrame frame = frame_of(m, {160, 120});
    frame.options.joints = false;
    // From so far that all are of one size in the picture.
    frame.camera.orthographic = true;
    const ViewReport report = renderer.draw(frame, target);
    CHECK(report.instances == columns * rows);
    return report.draw_calls;
  };
  const int few = calls(3, 3);
  CHECK(calls(100, 100) == few);
  CHECK(calls(30, 30) == few);

  // Whatever it is, a few dozen.
  for (const Mechanism& m : {long_chain(10000), branching_tree(10000), cable_net(100), spring_net(100)}) {
    const ViewFrame frame = frame_of(m, {160, 120});
    CHECK(renderer.draw(frame, target).draw_calls < 70);
  }
}

TEST_CASE("a net of springs costs a few triangles a spring, whose glyphs fit its meshes") {
  const ViewSize view{1280, 800};
  const auto triangles = [&](const Mechanism& m, double flat_coil) {
    const ViewFrame frame = frame_of(m, view);
    Sight sight = sight_of(frame.camera, view);
    sight.flat_coil = flat_coil;
    std::size_t sum = 0;
    for (const Instance& instance : scene_of(frame).instances) {
      if (instance.role != Role::spring) continue;
      const auto seen = see(instance, sight, sight.facing());
      if (seen) sum += primitive_mesh(seen->primitive, seen->detail).indices.size() / 3;
    }
    return static_cast<double>(sum) / static_cast<double>(m.forces.size());
  };
  constexpr double full = 2.6, draft = 9;
  const Mechanism small = spring_net(3), middle = spring_net(32), large = spring_net(100);
  CHECK(triangles(small, full) > 3000);
  CHECK(triangles(middle, full) < 1200);
  CHECK(triangles(middle, draft) < 100);
  CHECK(triangles(large, full) < 20);
  CHECK(triangles(large, full) >= 1.9);

  // A knot, a spring each way, and what holds it at the edges.
  const SceneList scene = build_scene(large, {});
  CHECK(scene.instances.size() <= 3 * large.bodies.size() + 4 * 100);
  CHECK(scene.scale.unit == Approx(0.01));
}

TEST_CASE("springs too small for their turns take as much of the picture") {
  OffscreenContext context;
  ViewRenderer renderer;
  const auto mean = [](const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c)
          sum += image.at(x, y)[c];
    return sum / (3.0 * image.width * image.height);
  };
  for (const int side : {8, 24}) {
    INFO("side " << side);
    const Mechanism m = spring_net(side);
    ViewFrame frame = bare(frame_of(m, {240, 160}));
    Framebuffer small(240, 160, 4), large(1920, 1280, 1);
    renderer.draw(frame, small);
    const double coarse = mean(small.read());
    renderer.draw(frame, large);
    const double fine = mean(large.read());
    frame.options.forces = false;
    renderer.draw(frame, large);
    const double without = mean(large.read());
    INFO(coarse << ' ' << fine << ' ' << without);
    CHECK(fine < without - 2);
    CHECK(std::abs(coarse - fine) < 0.25 * (without - fine));
  }
}

TEST_CASE("a chain of ten thousand links is an unbroken line from afar") {
  OffscreenContext context;
  ViewRenderer renderer;
  constexpr int width = 320, height = 120;
  Framebuffer target(width, height, 1);
  const Mechanism m = long_chain(10000);
  ViewFrame frame = bare(frame_of(m, {width, height}));
  frame.camera.azimuth = frame.camera.elevation = 0;
  frame.camera.fit(scene_of(frame).bounds, {width, height});
  const ViewReport report = renderer.draw(frame, target);
  CHECK(report.drawn < report.instances / 10);
  const Image picture = target.read();
  const Mechanism none;
  frame.mechanism = &none;
  renderer.draw(frame, target);
  const Image empty = target.read();
  int from = width, to = 0, columns = 0;
  for (int x = 0; x < width; ++x) {
    bool inked = false;
    for (int y = 0; y < height; ++y)
      inked = inked || !alike(picture.at(x, y), empty.at(x, y));
    if (!inked) continue;
    ++columns;
    from = std::min(from, x);
    to = std::max(to, x);
  }
  CHECK(to - from > width * 0.8);
  CHECK(columns == to - from + 1);
}

TEST_CASE("the shadow is drawn once for all that the camera does") {
  OffscreenContext context;
  ViewRenderer renderer, other;
  Framebuffer target(200, 150, 1);
  const Mechanism m = governor();
  ViewFrame frame = frame_of(m, {200, 150});
  const auto scene = std::make_shared<const ViewScene>(view_scene(frame));
  const auto shadow = [](const ViewReport& report) { return std::ranges::count(report.passes, "shadow"); };
  CHECK(shadow(renderer.draw(frame, scene, target)) == 1);
  frame.camera.orbit(40, 10, {200, 150});
  frame.camera.pan(12, 5, {200, 150});
  frame.camera.zoom(1.3, {50, 50}, {200, 150});
  CHECK(shadow(renderer.draw(frame, scene, target)) == 0);
  const Image kept = target.read();
  CHECK(shadow(other.draw(frame, target)) == 1);
  CHECK(target.read() == kept);
  // Another pose casts another shadow.
  std::vector<Pose> moved = drawn_poses(m);
  moved[1].position.y() -= 0.05;
  frame.poses = moved;
  CHECK(shadow(renderer.draw(frame, std::make_shared<const ViewScene>(view_scene(frame)), target)) == 1);
}

TEST_CASE("the right one among ten thousand is picked, framed and outlined") {
  const ViewSize view{1280, 800};
  const Mechanism m = ball_grid(125, 80, 0.03);
  ViewFrame frame = frame_of(m, view);
  frame.options.joints = false;
  const SceneList scene = scene_of(frame);
  for (const int body : {0, 1, 124, 125, 5062, 7777, 9999}) {
    const auto pixel = frame.camera.project(m.bodies[static_cast<std::size_t>(body)].position, view);
    REQUIRE(pixel);
    const auto hit = pick(scene.instances, frame.camera.ray(*pixel, view));
    REQUIRE(hit);
    CHECK(hit->part.index == body);
  }
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(320, 200, 1);
  ViewFrame small = bare(frame_of(m, {320, 200}));
  small.options.joints = false;
  renderer.draw(small, target);
  const Image plain = target.read();
  small.selected = {{PartKind::body, 5062}};
  renderer.draw(small, target);
  const Image outlined = target.read();
  const auto place = small.camera.project(m.bodies[5062].position, {320, 200});
  REQUIRE(place);
  double away = 0;
  int changed = 0;
  for (int y = 0; y < plain.height; ++y)
    for (int x = 0; x < plain.width; ++x)
      if (!alike(plain.at(x, y), outlined.at(x, y))) {
        ++changed;
        away = std::max(away, (Vec2(x + 0.5, y + 0.5) - *place).norm());
      }
  CHECK(changed > 4);
  CHECK(away < 6);
}
