#include "app/render/offscreen.hpp"
#include "app/render/shader.hpp"
#include "app/viewport/view_renderer.hpp"
#include "tests/app/viewport_mechanisms.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

bool has(const ViewReport& report, std::string_view pass) {
  return std::find(report.passes.begin(), report.passes.end(), pass) != report.passes.end();
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += std::abs(a.pixels[i] - b.pixels[i]);
  return sum / static_cast<double>(a.pixels.size());
}

} // namespace

TEST_CASE("passes that are not needed are left out") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(160, 120, 1);
  const Mechanism m = governor();
  const std::vector<Pose> drawn = drawn_poses(m);
  ViewFrame frame;
  frame.mechanism = &m;
  frame.camera = initial_camera(m, scene_of(frame).bounds, {160, 120});

  ViewReport report = renderer.draw(frame, target);
  CHECK(has(report, "shadow"));
  CHECK_FALSE(has(report, "ghost"));
  CHECK_FALSE(has(report, "motion"));
  CHECK_FALSE(has(report, "outline"));
  const Image plain = target.read();

  frame.ghost = frame.motion = drawn;
  frame.selected = {{PartKind::body, 1}, {PartKind::joint, 2}};
  report = renderer.draw(frame, target);
  CHECK(has(report, "motion"));
  CHECK(has(report, "outline"));
  CHECK(mean_difference(plain, target.read()) > 0.05);

  frame.options.grid = frame.options.shadow = false;
  report = renderer.draw(frame, target);
  CHECK_FALSE(has(report, "shadow"));
  CHECK_FALSE(has(report, "grid"));
}

TEST_CASE("where nothing is drawn there is no floor to be seen from the side, whose height would change") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(160, 120, 1);
  Mechanism m;
  ViewFrame frame;
  frame.mechanism = &m;
  frame.camera.target = {0, 0.1, 0};
  frame.camera.distance = 1;
  frame.camera.elevation = 0;
  CHECK_FALSE(has(renderer.draw(frame, target), "grid"));
  frame.camera.elevation = 0.5;
  CHECK(has(renderer.draw(frame, target), "grid"));
  m = governor();
  frame.camera.elevation = 0;
  CHECK(has(renderer.draw(frame, target), "grid"));
}

TEST_CASE("beside a small body seen from above the grid reaches as far as where there is none") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(240, 180, 1);
  ViewFrame frame;
  frame.camera.distance = 1;
  frame.camera.elevation = 1.5;
  frame.options.shadow = false;
  // How much of the picture's outer parts the grid changes.
  const auto inked = [&](const Mechanism& m) {
    frame.mechanism = &m;
    std::array<Image, 2> pictures;
    for (const bool grid : {false, true}) {
      frame.options.grid = grid;
      renderer.draw(frame, target);
      pictures[grid] = target.read();
    }
    int changed = 0;
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 240; ++x)
        changed += std::hypot(x - 120, y - 90) > 60 && *pictures[0].at(x, y) != *pictures[1].at(x, y);
    return changed;
  };
  Mechanism small;
  small.bodies = {body("bead", 1, {0, 0, 0})};
  Shape bead;
  bead.radius = 0.01;
  small.bodies[0].shapes = {bead};
  const int without = inked(Mechanism());
  REQUIRE(without > 1000);
  CHECK(inked(small) > 0.9 * without);
}

TEST_CASE("a ghost that coincides with the solid stays hidden behind it") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(320, 240, 1);
  const Mechanism m = governor();
  const std::vector<Pose> drawn = drawn_poses(m);
  ViewFrame frame;
  frame.mechanism = &m;
  frame.camera = initial_camera(m, scene_of(frame).bounds, {320, 240});
  renderer.draw(frame, target);
  const Image without = target.read();
  frame.ghost = drawn;
  renderer.draw(frame, target);
  CHECK(mean_difference(without, target.read()) < 0.02);
}

TEST_CASE("an empty view shows the grid, extreme mechanisms draw without a fuss") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(96, 64, 4);
  ViewFrame frame;
  CHECK(has(renderer.draw(frame, target), "grid"));
  const Mechanism nothing;
  frame.mechanism = &nothing;
  CHECK(has(renderer.draw(frame, target), "grid"));
  Mechanism extreme;
  extreme.bodies = {body("tiny", 1, {1e-9, 0, 0}), body("far", 1, {1e9, 1e9, 0})};
  extreme.joints = {joint(JointType::spherical, "a", "ground", "tiny", {0, 0, 0}, {0, 0, 1}),
                    distance("b", "tiny", "far", {1e-9, 0, 0}, {1e9, 1e9, 0})};
  frame.mechanism = &extreme;
  frame.camera = initial_camera(extreme, scene_of(frame).bounds, {96, 64});
  CHECK(renderer.draw(frame, target).instances > 0);
  frame.camera.orthographic = true;
  CHECK_NOTHROW(renderer.draw(frame, target));
}

TEST_CASE("thousands of bodies take as few draw calls as a handful") {
  OffscreenContext context;
  ViewRenderer renderer;
  Framebuffer target(64, 64, 1);
  const auto chain = [](int links) {
    Mechanism m;
    for (int i = 0; i < links; ++i) {
      m.bodies.push_back(body("link" + std::to_string(i), 1, {i + 0.5, 0, 0}));
      m.joints.push_back(revolute("joint" + std::to_string(i), i ? "link" + std::to_string(i - 1) : "ground",
                                  "link" + std::to_string(i), {double(i), 0, 0}, {0, 0, 1}));
    }
    return m;
  };
  const Mechanism few = chain(5), many = chain(2000);
  ViewFrame frame;
  frame.mechanism = &few;
  const ViewReport small = renderer.draw(frame, target);
  frame.mechanism = &many;
  const ViewReport large = renderer.draw(frame, target);
  CHECK(large.instances > 100 * small.instances);
  CHECK(large.draw_calls < small.draw_calls + primitive_count); // of other sizes in the picture, some of them
}

TEST_CASE("pictures that cannot be had are refused in words") {
  OffscreenContext context;
  CHECK_THROWS_AS(Framebuffer(0, 10), GlError);
  CHECK_THROWS_AS(Framebuffer(10, 1 << 24), GlError);
  CHECK_THROWS_AS(ShaderProgram("lit.vert", "missing.frag"), GlError);
}
