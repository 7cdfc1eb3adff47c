// The menu of a right click in the view.
#include "app/ui/commands.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/view_frame.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "robot.hpp"
#include "tests/catch.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr int right = 1;

Vec3 place(const App& app, const std::string& body) {
  const auto i = static_cast<std::size_t>(body_index(app.session.mechanism(), body));
  return app.session.mode == Mode::build ? app.session.mechanism().bodies[i].position
                                         : app.session.poses[i].position;
}

bool open(const App& app) {
  return app.ui.widgets.count("view/menu/title") == 1;
}

void open_at(Robot& robot, ImVec2 at) {
  robot.click(at, right);
  robot.frames(2);
}

ImVec2 empty_space(Robot& robot) {
  const WidgetRect view = robot.widget("view");
  return {view.from.x + 0.1f * (view.to.x - view.from.x), view.from.y + 0.3f * (view.to.y - view.from.y)};
}

} // namespace

TEST_CASE("a right click on a part selects it and offers what can be done with it") {
  Robot robot({1280, 900});
  App& app = robot.app;
  open_at(robot, robot.pixel(place(app, "ball1")));
  REQUIRE(open(app));
  CHECK(app.session.selection().parts == std::vector<Part>{{PartKind::body, "ball1"}});
  for (const char* id : {"edit.rename", "edit.duplicate", "edit.delete", "view.fit_selected", "view.hide",
                         "view.isolate", "view.loads"})
    CHECK(app.ui.widgets.count(std::string("view/menu/") + id) == 1);
  robot.click("view/menu/view.loads");
  robot.frames(2);
  CHECK_FALSE(open(app));
  CHECK(app.view.loads);
  CHECK(view_frame(app.session, app.ui, app.tool, app.view).loads_body ==
        body_index(app.session.mechanism(), "ball1"));
  const std::size_t bodies = app.session.mechanism().bodies.size();
  open_at(robot, robot.pixel(place(app, "ball2")));
  robot.click("view/menu/edit.delete");
  robot.frames(2);
  CHECK(app.session.mechanism().bodies.size() == bodies - 1);
  undo(app.session);
  CHECK(app.session.mechanism().bodies.size() == bodies);
}

TEST_CASE("a drag with the right button opens no menu, and Escape closes one") {
  Robot robot;
  App& app = robot.app;
  robot.drag("view", {0.3f, 0.3f}, {0.6f, 0.5f}, right);
  robot.frames(2);
  CHECK_FALSE(open(app));
  open_at(robot, empty_space(robot));
  CHECK(open(app));
  robot.key(key_escape);
  robot.frames(2);
  CHECK_FALSE(open(app));
}

TEST_CASE("beside the parts the menu is the view's, and adds parts while building") {
  Robot robot({1280, 900});
  App& app = robot.app;
  open_at(robot, empty_space(robot));
  REQUIRE(open(app));
  CHECK(app.ui.widgets.count("view/menu/add") == 0);
  const bool grid = app.view.grid;
  robot.click("view/menu/view.grid");
  robot.frames(2);
  CHECK(app.view.grid != grid);
  set_mode(app.session, Mode::build);
  robot.frames(2);
  open_at(robot, empty_space(robot));
  robot.click("view/menu/add");
  robot.frames(3);
  robot.click("view/menu/insert.spring");
  robot.frames(2);
  CHECK(app.tool.tool == Tool::spring);
}

TEST_CASE("a joint is driven and a number gets a slider from the menu") {
  Robot robot({1280, 900});
  App& app = robot.app;
  select(app.session, {{Part{PartKind::joint, "arm1"}}});
  robot.key(299, false, true); // Shift+F10
  robot.frames(2);
  REQUIRE(open(app));
  robot.click("view/menu/drive/0");
  robot.frames(2);
  const auto arm = [&] {
    return app.session.mechanism().joints[static_cast<std::size_t>(
        find_part(app.session.mechanism(), {PartKind::joint, "arm1"}).index)];
  };
  CHECK(arm().coordinates[0].drive);
  CHECK(app.session.document.steps().back().name == "Add drive to arm1");
  undo(app.session);
  CHECK_FALSE(arm().coordinates[0].drive);
  robot.key(348); // the menu key
  robot.frames(2);
  REQUIRE(open(app));
  robot.click("view/menu/pins");
  robot.frames(3);
  const std::string address = "joints.arm1.damping";
  REQUIRE_FALSE(is_pinned(app.session.mechanism(), address));
  robot.click("view/menu/pin/" + address);
  robot.frames(2);
  CHECK(is_pinned(app.session.mechanism(), address));
}

TEST_CASE("hidden parts are neither seen nor pointed at, and come back") {
  Robot robot({1280, 900});
  App& app = robot.app;
  const ImVec2 ball = robot.pixel(place(app, "ball1"));
  const std::size_t all = shown_scene(app.context())->solid.instances.size();
  robot.click(ball);
  robot.key('H', false, true);
  CHECK(shown_scene(app.context())->solid.instances.size() < all);
  robot.point({ball.x + 1, ball.y});
  robot.frames(1);
  CHECK(part_of(app.session.mechanism(), app.view.hovered).name != "ball1");
  CHECK(converged(app.session)); // it acts as before
  robot.key('H', true, true);
  CHECK(shown_scene(app.context())->solid.instances.size() == all);
  robot.click(ball);
  robot.key('I');
  for (const Instance& instance : shown_scene(app.context())->solid.instances)
    CHECK(instance.part == find_part(app.session.mechanism(), {PartKind::body, "ball1"}));
  const double distance = app.view.camera.distance;
  robot.key('Z');
  robot.frames(1);
  CHECK(app.view.camera.distance < 0.7 * distance);
}
