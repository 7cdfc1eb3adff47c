// The interface of a mechanism of ten thousand bodies: what a frame costs does not grow with them.
#include "app/ui/panel_list.hpp"
#include "large_answer.hpp"
#include "large_mechanisms.hpp"
#include "robot.hpp"
#include "session_wait.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string_view>

// Sanitizers bring allocation functions of their own; elsewhere there is no way in below malloc.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FLYBALL_COUNT_MEMORY 1
#else
#define FLYBALL_COUNT_MEMORY 0
#endif

namespace {

thread_local bool counting = false;
thread_local std::size_t allocations = 0, bytes = 0;

[[maybe_unused]] void count(std::size_t size) {
  allocations += counting;
  bytes += counting ? size : 0;
}

} // namespace

#if FLYBALL_COUNT_MEMORY
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_realloc(void*, std::size_t);

// operator new ends up in the first; ImGui's vectors, too.
void* malloc(std::size_t size) noexcept {
  count(size);
  return __libc_malloc(size);
}
void* realloc(void* old, std::size_t size) noexcept {
  count(size);
  return __libc_realloc(old, size);
}
}
#endif

using namespace flyball;
using namespace flyball::test;

namespace {

struct Cost {
  std::size_t allocations = 0, bytes = 0;
};

// Of a frame in which nothing has happened.
Cost quiet_frame(Robot& robot) {
  robot.frames(4);
  allocations = bytes = 0;
  counting = true;
  robot.frames(1);
  counting = false;
  return {allocations, bytes};
}

void open_large(Robot& robot, const Mechanism& mechanism) {
  open_document(robot.app.session, Document(unsolved(mechanism)));
  REQUIRE_FALSE(robot.app.session.mistakes.empty());
  answer_as_drawn(robot.app);
  robot.app.panels->results.sections().reactions = true;
  robot.frames(2);
}

std::size_t widgets(const Robot& robot, std::string_view prefix) {
  return static_cast<std::size_t>(std::ranges::count_if(
      robot.app.ui.widgets, [&](const auto& widget) { return widget.first.starts_with(prefix); }));
}

} // namespace

TEST_CASE("a quiet frame of ten thousand bodies costs what one of a hundred does") {
  Robot robot({1280, 800});
  for (const Mode mode : {Mode::explore, Mode::build}) {
    INFO((mode == Mode::build ? "building" : "exploring"));
    std::array<Cost, 2> costs;
    for (const int large : {0, 1}) {
      open_large(robot, long_chain(large ? 10000 : 100));
      set_mode(robot.app.session, mode);
      costs[static_cast<std::size_t>(large)] = quiet_frame(robot);
      CHECK(widgets(robot, mode == Mode::build ? "outline/bodies/" : "results/hinge") > 5);
      CHECK(robot.app.ui.widgets.size() < 400);
    }
    INFO("allocations " << costs[0].allocations << ", " << costs[1].allocations);
    INFO("bytes " << costs[0].bytes << ", " << costs[1].bytes);
    if (FLYBALL_COUNT_MEMORY) CHECK(costs[0].allocations > 100);
    CHECK(costs[1].allocations < costs[0].allocations + 150); // four sliders more are in sight
    CHECK(costs[1].bytes < costs[0].bytes + 20000);
  }
}

TEST_CASE("of a thousand coordinates the first are told, and what comes below is in reach") {
  Robot robot({1280, 800});
  open_large(robot, long_chain(1000));
  robot.app.panels->results.sections().reactions = false;
  robot.frames(3);
  CHECK(widgets(robot, "results/hinge") >= 12);
  CHECK(robot.app.ui.widgets.contains("results/reactions"));
  robot.click("results/coordinates/all");
  robot.frames(3);
  CHECK_FALSE(robot.app.ui.widgets.contains("results/reactions"));
  robot.click("results/coordinates/all");
  robot.frames(3);
  CHECK(robot.app.ui.widgets.contains("results/reactions"));
}

TEST_CASE("the lists of a view are made once and drawn once while nothing changes") {
  Robot robot;
  open_large(robot, long_chain(500));
  robot.frames(3);
  const int made = robot.app.view.scene.made, drawn = robot.stage.views_changed();
  robot.frames(5);
  CHECK(robot.app.view.scene.made == made);
  CHECK(robot.stage.views_changed() == drawn);
  // Looking from elsewhere and pointing need no new lists.
  robot.drag("view", {0.4f, 0.4f}, {0.6f, 0.5f});
  robot.point_at(robot.app.session.mechanism().bodies[250].position);
  CHECK(robot.stage.views_changed() > drawn);
  CHECK(robot.app.view.scene.made == made);
  // Another pose does.
  robot.app.session.poses[3].position.x() += 0.01;
  robot.frames(1);
  CHECK(robot.app.view.scene.made == made + 1);
  edit(robot.app.session, "Mass", [](Mechanism& m, Selection&) { m.bodies[0].mass = 2; });
  robot.frames(1);
  CHECK(robot.app.view.scene.made > made + 1);
}

TEST_CASE("a body among thousands is pointed at, chosen in the view and found in the list") {
  Robot robot({1280, 800});
  open_large(robot, cable_net(70));
  set_mode(robot.app.session, Mode::build);
  robot.frames(2);
  const std::size_t wanted = 3456;
  const std::string name = robot.app.session.mechanism().bodies[wanted].name;
  robot.app.view.fit = false;
  robot.app.view.camera.target = robot.app.session.mechanism().bodies[wanted].position;
  robot.app.view.camera.distance = 1;
  robot.app.view.camera.elevation = 1;
  robot.frames(2);
  robot.click_at(robot.app.session.mechanism().bodies[wanted].position);
  REQUIRE(robot.app.session.selection().parts.size() == 1);
  CHECK(robot.app.session.selection().parts[0].name == name);
  robot.frames(3);
  CHECK(robot.app.ui.widgets.contains("outline/bodies/" + name));
  CHECK(widgets(robot, "outline/bodies/") < 60);
}

TEST_CASE("all of thousands are selected, undone and redone") {
  Robot robot;
  open_large(robot, long_chain(5000));
  Selection all;
  for (const Body& body : robot.app.session.mechanism().bodies)
    all.parts.push_back({PartKind::body, body.name});
  select(robot.app.session, all);
  CHECK(robot.app.session.selection() == all);
  robot.frames(2);
  edit(robot.app.session, "Remove", [](Mechanism& m, Selection&) {
    m.bodies.pop_back();
    m.joints.pop_back();
  });
  CHECK(robot.app.session.selection().parts.size() == 4999);
  CHECK(robot.app.session.document.unsaved());
  undo(robot.app.session);
  CHECK(robot.app.session.mechanism().bodies.size() == 5000);
  CHECK_FALSE(robot.app.session.document.unsaved());
  redo(robot.app.session);
  CHECK(robot.app.session.document.unsaved());
  robot.frames(1);
}

TEST_CASE("snapping finds each place once, however many there are") {
  const Mechanism m = long_chain(3000);
  const std::vector<SnapPoint> points = snap_points(m);
  // A hinge at each link's start, a centre in each link, and the origin, which is the first hinge.
  CHECK(points.size() == 6000);
  CHECK(points[0].what == "hinge0");
  Mechanism doubled = m;
  for (Joint& joint : doubled.joints)
    joint.at += Vec3(1e-12, -1e-12, 0);
  doubled.joints.insert(doubled.joints.end(), m.joints.begin(), m.joints.end());
  CHECK(snap_points(doubled).size() == 6000);
}

TEST_CASE("a view of thousands is a draft while it moves, and in full when it rests") {
  const auto turn = [](Robot& robot) {
    robot.app.view.samples = 4;
    // Small ones are always drawn in full.
    robot.drag("view", {0.4f, 0.4f}, {0.6f, 0.5f});
    CHECK_FALSE(robot.stage.resting());
    open_large(robot, cable_net(45));
    robot.frames(2);
    robot.picture(); // how many there are to draw is known from the last time
    robot.app.view.camera.orbit(30, 10, {700, 500});
    robot.frames(1);
  };
  const auto rest = [](Robot& robot) {
    CHECK(steps_until([&] { robot.frames(1); }, [&] { return !robot.stage.resting(); }));
    robot.frames(2);
    return robot.picture();
  };
  Robot robot({700, 500}), plain({700, 500});
  robot.stage.draft_while_moving(true);
  turn(robot);
  CHECK(robot.stage.resting());
  const Image draft = robot.picture(), full = rest(robot);
  CHECK(draft != full);
  turn(plain);
  CHECK(rest(plain) == full);
}
