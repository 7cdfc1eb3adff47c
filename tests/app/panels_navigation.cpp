// How the mouse moves the camera, by the habits that a person has chosen.
#include "app/document/create.hpp"
#include "app/ui/choices.hpp"
#include "robot.hpp"
#include "temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <imgui_internal.h>

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr int left = 0, right = 1, middle = 2;

// What a drag over empty space of the view did to the camera.
CameraDrag done(Robot& robot, int button, bool ctrl, bool shift) {
  App& app = robot.app;
  select(app.session, {});
  robot.key('1');
  robot.frames(2);
  const ViewCamera before = app.view.camera;
  robot.hold(ctrl, shift);
  robot.drag("view", {0.1f, 0.2f}, {0.2f, 0.3f}, button);
  robot.hold(false, false);
  const ViewCamera& after = app.view.camera;
  const bool turned = after.azimuth != before.azimuth, nearer = after.distance != before.distance,
             moved = (after.target - before.target).norm() > 1e-9;
  CHECK(static_cast<int>(turned) + static_cast<int>(nearer) + static_cast<int>(moved && !nearer) <= 1);
  return turned ? CameraDrag::orbit : nearer ? CameraDrag::zoom : moved ? CameraDrag::pan : CameraDrag::none;
}

} // namespace

TEST_CASE("drags mean what the chosen habits say") {
  Robot robot;
  App& app = robot.app;
  CHECK(done(robot, left, false, false) == CameraDrag::orbit);
  CHECK(done(robot, left, false, true) == CameraDrag::pan);
  CHECK(done(robot, right, false, false) == CameraDrag::pan);
  CHECK(done(robot, middle, false, false) == CameraDrag::pan);
  CHECK(done(robot, middle, false, true) == CameraDrag::orbit);
  choose_navigation(app.session, app.ui, app.view, Navigation::blender);
  CHECK(done(robot, middle, false, false) == CameraDrag::orbit);
  CHECK(done(robot, middle, false, true) == CameraDrag::pan);
  CHECK(done(robot, middle, true, false) == CameraDrag::zoom);
  CHECK(done(robot, left, false, false) == CameraDrag::none);
  CHECK(done(robot, right, false, false) == CameraDrag::none);
  choose_navigation(app.session, app.ui, app.view, Navigation::cad);
  CHECK(done(robot, right, false, false) == CameraDrag::orbit);
  CHECK(done(robot, middle, false, false) == CameraDrag::orbit);
  CHECK(done(robot, right, true, false) == CameraDrag::pan);
  CHECK(done(robot, middle, true, false) == CameraDrag::pan);
  CHECK(done(robot, middle, false, true) == CameraDrag::zoom);
  CHECK(done(robot, left, false, false) == CameraDrag::none);
}

TEST_CASE("where the left button does not turn the view it frames parts") {
  Robot robot;
  App& app = robot.app;
  choose_navigation(app.session, app.ui, app.view, Navigation::cad);
  robot.drag("view", {0.15f, 0.1f}, {0.85f, 0.9f});
  CHECK(app.session.selection().parts.size() > 3);
  robot.click_at(
      app.session.poses[static_cast<std::size_t>(body_index(app.session.mechanism(), "ball1"))].position);
  CHECK(app.session.selection().parts == std::vector<Part>{{PartKind::body, "ball1"}});
}

TEST_CASE("zooming keeps what is under the pointer where it is") {
  Robot robot;
  App& app = robot.app;
  const WidgetRect view = robot.widget("view");
  const ViewSize size{static_cast<double>(view.to.x - view.from.x),
                      static_cast<double>(view.to.y - view.from.y)};
  const auto under = [&](ImVec2 at) { // in the plane of the target
    const Ray ray = app.view.camera.ray(
        {static_cast<double>(at.x - view.from.x), static_cast<double>(at.y - view.from.y)}, size);
    const Vec3 normal = app.view.camera.backward();
    return Vec3(ray.origin + ray.direction * ((app.view.camera.target - ray.origin).dot(normal) /
                                              ray.direction.dot(normal)));
  };
  const ImVec2 at(view.from.x + 0.3f * (view.to.x - view.from.x),
                  view.from.y + 0.25f * (view.to.y - view.from.y));
  robot.point(at);
  const Vec3 before = under(at);
  const double distance = app.view.camera.distance;
  for (const float notches : {1.f, 1.f, -3.f}) {
    ImGui::GetIO().MouseWheel = notches;
    robot.frames(2);
    CHECK(app.view.camera.distance != distance);
    CHECK((under(at) - before).norm() < 1e-9);
    const ImVec2 now = robot.pixel(before);
    CHECK(std::hypot(now.x - at.x, now.y - at.y) < 0.01f);
  }
  // So does dragging, about the point where the button went down.
  choose_navigation(app.session, app.ui, app.view, Navigation::blender);
  robot.hold(true, false);
  robot.drag(at, {at.x, at.y + 60}, middle);
  CHECK((under(at) - before).norm() < 1e-9);
  CHECK(app.view.camera.distance > distance);
}

TEST_CASE("the wheel zooms over cards that lie in the view, too") {
  Robot robot({1000, 760});
  const auto zooms_over = [&](const char* widget) {
    INFO(widget);
    const double before = robot.app.view.camera.distance;
    robot.wheel(widget, 2);
    robot.frames(2);
    return robot.app.view.camera.distance < 0.9 * before;
  };
  CHECK(zooms_over("legend"));
  robot.key('N', true);
  robot.frames(3);
  CHECK(zooms_over("welcome/insert.rod"));
  CHECK(zooms_over("view"));
  // Not beside the view, and not behind what is open.
  CHECK_FALSE(zooms_over("toolbar/play"));
  robot.key('P', true);
  robot.frames(3);
  CHECK_FALSE(zooms_over("view"));
}

TEST_CASE("the habits are kept, and the sheet of shortcuts tells them") {
  const TemporaryFolder folder;
  {
    App app({.mode = LiveSolver::Mode::immediate,
             .on_news = {},
             .scenes = {},
             .numbers = {},
             .state = folder.path()});
    CHECK(app.view.navigation == Navigation::own);
    choose_navigation(app.session, app.ui, app.view, Navigation::blender);
  }
  App app({.mode = LiveSolver::Mode::immediate,
           .on_news = {},
           .scenes = {},
           .numbers = {},
           .state = folder.path()});
  CHECK(app.view.navigation == Navigation::blender);
  Robot robot({1280, 900});
  robot.key('?');
  robot.frames(2);
  CHECK(robot.app.ui.widgets.count("shortcuts/Right drag, Shift+drag") == 1);
  robot.key(key_escape);
  choose_navigation(robot.app.session, robot.app.ui, robot.app.view, Navigation::cad);
  robot.key('?');
  robot.frames(2);
  CHECK(robot.app.ui.widgets.count("shortcuts/Right drag, middle drag") == 1);
}

TEST_CASE("how the mouse came to where it is pressed is no drag") {
  Robot robot;
  const WidgetRect view = robot.widget("view");
  robot.point({view.from.x + 20, view.to.y - 20});
  const ViewCamera before = robot.app.view.camera;
  for (const int button : {1, 2}) {
    // Moved and pressed within one frame, as where frames are slow.
    ImGui::GetIO().MousePos = view.center();
    ImGui::GetIO().MouseDown[button] = true;
    robot.frames(1);
    CHECK(robot.app.view.camera == before);
    ImGui::GetIO().MouseDown[button] = false;
    robot.frames(3);
    CHECK(robot.app.view.camera == before);
    robot.key(key_escape);
    robot.point({view.from.x + 20, view.to.y - 20});
  }
}

TEST_CASE("what is fitted into the view while building does not lie behind the tools") {
  Robot robot({1280, 720});
  App& app = robot.app;
  robot.begin_empty(1);
  const double half = GENERATE(1.5, 0.2); // m: across the view, and across its middle
  edit(app.session, "Build", [&](Mechanism& next, Selection&) {
    add_body(next, {.form = BodyForm::rod, .radius = 0.05, .from = {-half, 0, 0}, .to = {half, 0, 0}});
    add_body(next, {.form = BodyForm::rod, .radius = 0.05, .from = {0, -0.4, 0}, .to = {0, 0.4, 0}});
  });
  robot.frames(2);
  robot.key('F');
  robot.frames(80);
  const WidgetRect tools = robot.widget("tool strip"), view = robot.widget("view");
  CHECK(robot.pixel({-half, 0, 0}).x > tools.to.x);
  CHECK(robot.pixel({half, 0, 0}).x < view.to.x);
  // Where nothing lies behind them the mechanism stands in the middle.
  const float middle = robot.pixel({0, 0, 0}).x, off = middle - (view.from.x + view.to.x) / 2;
  if (half < 1)
    CHECK(std::abs(off) < 1);
  else
    CHECK(off == Approx((tools.to.x - view.from.x) / 2).margin(4));
}

TEST_CASE("what is recovered over a mechanism that was explored does not lie behind the tools") {
  Robot robot({1280, 720});
  REQUIRE(robot.app.session.mode == Mode::explore); // without tools
  Mechanism wide;
  add_body(wide, {.form = BodyForm::rod, .radius = 0.05, .from = {-1.5, 0, 0}, .to = {1.5, 0, 0}});
  wide.view.camera.reset();
  replace_document(robot.app.session, Document(), {});
  replace_mechanism(robot.app.session, "Recover", std::move(wide));
  robot.frames(80);
  REQUIRE(robot.app.session.mode == Mode::build);
  CHECK(robot.pixel({-1.5, 0, 0}).x > robot.widget("tool strip").to.x);
}

TEST_CASE("the first steps lie beside the tools") {
  Robot robot({GENERATE(1150, 1440, 820), 560});
  CAPTURE(robot.size.width);
  robot.key('N', true);
  robot.frames(3);
  const ImGuiWindow* card = ImGui::FindWindowByName("welcome");
  REQUIRE(card);
  const WidgetRect tools = robot.widget("tool strip"), view = robot.widget("view");
  CHECK(card->Pos.x > tools.to.x);
  CHECK(card->Pos.x + card->Size.x < view.to.x);
}

TEST_CASE("where the tools take all of the view's width what is fitted stands below them") {
  Robot robot({400, 400});
  App& app = robot.app;
  set_mode(app.session, Mode::build);
  robot.frames(3);
  robot.point(robot.widget("view").center());
  robot.key('F');
  robot.frames(80);
  const WidgetRect tools = robot.widget("tool strip"), view = robot.widget("view");
  REQUIRE(tools.to.x - view.from.x > 0.75f * (view.to.x - view.from.x));
  for (const Body& body : app.session.mechanism().bodies) {
    CHECK(robot.pixel(body.position).y > tools.to.y);
    CHECK(robot.pixel(body.position).y < view.to.y);
  }
}

TEST_CASE("a scene that is opened has its drawn pose in view, too") {
  Robot robot({1280, 800});
  App& app = robot.app;
  robot.frames(2);
  REQUIRE(app.view.scene.scene);
  REQUIRE_FALSE(app.view.scene.scene->drawn.empty());
  for (const Instance& instance : app.view.scene.scene->drawn) {
    const Bounds bounds = instance_bounds(instance);
    for (const Vec3& corner : {bounds.lower, bounds.upper}) {
      const std::optional<Vec2> at = app.view.camera.project(corner, app.view.size);
      REQUIRE(at);
      CHECK((at->x() > 0 && at->x() < app.view.size.width));
      CHECK((at->y() > 0 && at->y() < app.view.size.height));
    }
  }
}

namespace {

// Whether every body stands in the view as a whole.
bool all_in_view(Robot& robot) {
  const ViewSize size = robot.app.view.size;
  for (const Instance& solid : robot.app.view.scene.scene->solid.instances) {
    const Bounds box = instance_bounds(solid);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 at(corner & 1 ? box.upper.x() : box.lower.x(), corner & 2 ? box.upper.y() : box.lower.y(),
                    corner & 4 ? box.upper.z() : box.lower.z());
      const auto pixel = robot.app.view.camera.project(at, size);
      if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > size.width || pixel->y() > size.height)
        return false;
    }
  }
  return true;
}

} // namespace

TEST_CASE("a window made smaller and larger is fitted anew, until a hand moves the camera") {
  Robot robot({1280, 800});
  App& app = robot.app;
  open_scene(app.session, shipped_file("horizontal_rotor"));
  robot.frames(3);
  const ViewCamera before = app.view.camera;
  REQUIRE(all_in_view(robot));
  robot.size = {860, 800}; // a narrow view
  robot.frames(2);
  CHECK(all_in_view(robot));
  CHECK(app.view.camera.distance > before.distance);
  robot.size = {1280, 800};
  robot.frames(2);
  CHECK(app.view.camera == before);

  SECTION("with the loads that were taken into it") {
    open_scene(app.session, shipped_file("governor"));
    robot.frames(3);
    const ViewCamera without = app.view.camera;
    robot.key('A');
    robot.frames(2);
    REQUIRE(app.view.camera != without);
    robot.size = {860, 800};
    robot.frames(2);
    CHECK(all_in_view(robot));
    robot.key('A'); // away again: as fitted, to the view as it is now
    robot.frames(3);
    CHECK(all_in_view(robot));
    robot.size = {1280, 800};
    robot.frames(2);
    CHECK((app.view.camera.target - without.target).norm() < 1e-9);
    CHECK(app.view.camera.distance == Approx(without.distance));
  }
  SECTION("by the wheel") {
    robot.wheel("view", 3);
    const ViewCamera chosen = app.view.camera;
    robot.size = {860, 800};
    robot.frames(2);
    CHECK(app.view.camera == chosen);
    robot.size = {1280, 800};
    robot.frames(2);
    CHECK(app.view.camera == chosen);
    robot.key('F');
    robot.size = {860, 800};
    robot.frames(2);
    CHECK(all_in_view(robot));
  }
}
