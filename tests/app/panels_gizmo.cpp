// Moving and turning in the 3-D view by handles, done by a robot.
#include "drawing.hpp"

#include "app/ui/tools/tools.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("an arrow moves along its axis, onto the grid, in one step") {
  Drawing d;
  d.have_ball({0.0123, 0.0456, 0.0789});
  d.pull("gizmo/x", {0.14, 0.08, 0});
  d.release();
  CHECK(d.m().bodies[0].position == Vec3(0.15, 0.0456, 0.0789));
  CHECK(d.steps() == 2);
  CHECK(d.last_step() == "Move ball1");
  undo(d.app.session);
  CHECK(d.m().bodies[0].position == Vec3(0.0123, 0.0456, 0.0789));
}

TEST_CASE("patches and the ball in the middle move in their plane") {
  Drawing d;
  d.have_ball({0, 0, 0.01});
  d.pull(GENERATE("gizmo/xy", "gizmo/centre"), {0.24, -0.11, 0});
  d.release();
  CHECK(d.m().bodies[0].position == Vec3(0.25, -0.1, 0.01));
  CHECK(d.steps() == 2);
}

TEST_CASE("what is moved snaps to points, without snapping it goes anywhere") {
  Drawing d;
  d.have_ball({0.3, 0.123, 0});
  d.have_ball({0, 0, 0});
  SECTION("to another ball's centre") {
    d.pull("gizmo/centre", {0.302, 0.121, 0});
    REQUIRE(d.app.tool.grab);
    CHECK(d.app.tool.grab->what == "centre of ball1");
    d.release();
    CHECK(d.m().bodies[1].position == Vec3(0.3, 0.123, 0));
  }
  SECTION("never to what moves along") {
    d.pull("gizmo/centre", {0.012, 0.012, 0});
    CHECK(d.app.tool.grab->what == "origin");
    d.release();
    CHECK(d.steps() == 2); // back where it was: no step
  }
  SECTION("freely while Ctrl is held") {
    d.hold(true, false);
    d.pull("gizmo/centre", {0.111, 0.033, 0});
    d.release();
    CHECK((d.m().bodies[1].position - Vec3(0.111, 0.033, 0)).norm() < 0.002);
    CHECK(d.m().bodies[1].position != Vec3(0.1, 0.05, 0));
    CHECK(d.app.session.selection().parts == std::vector{body_part("ball2")});
  }
}

TEST_CASE("Escape or the right button takes a drag back entirely") {
  Drawing d;
  d.have_ball({0, 0, 0});
  const Mechanism before = d.m();
  d.pull("gizmo/x", {0.2, 0, 0});
  CHECK(d.m().bodies[0].position.x() == 0.2);
  if (GENERATE(false, true)) {
    d.key(key_escape);
  } else {
    d.press(1);
    d.release(1);
  }
  CHECK(d.m() == before);
  // The rest of the movement does nothing more.
  d.point_at({-0.3, 0.3, 0});
  d.release();
  CHECK(d.m() == before);
  CHECK(d.app.view.camera.azimuth == 0);
  CHECK(d.steps() == 1);
  CHECK(d.app.session.document.steps().size() == 2); // nothing to redo either
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")});
}

TEST_CASE("a number typed while dragging counts") {
  Drawing d;
  d.have_ball({0, 0, 0});
  SECTION("metres along an arrow") {
    d.pull("gizmo/x", {0.2, 0, 0});
    for (const char key : std::string("0.16/2"))
      d.key(key);
    d.release();
    CHECK(d.m().bodies[0].position == Vec3(0.08, 0, 0));
    CHECK(d.app.view.camera.azimuth == 0);
  }
  SECTION("degrees round a ring") {
    d.key('R');
    d.pull("gizmo/ring/z", {0.02, 0.02, 0});
    for (const char key : std::string("-90"))
      d.key(key);
    d.release();
    const Quat q = d.m().bodies[0].rotation;
    CHECK(q.isApprox(Quat(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitZ())), 1e-12));
  }
  CHECK(d.steps() == 2);
}

TEST_CASE("a ring turns by round angles, in one step") {
  Drawing d;
  d.have_rod({0, 0, 0}, {0.2, 0, 0});
  d.key('R');
  CHECK(d.app.tool.tool == Tool::rotate);
  const ImVec2 from = d.widget("gizmo/ring/z").center(), c = d.pixel({0.1, 0, 0});
  d.point(from);
  d.press();
  for (int i = 1; i <= 6; ++i) {
    // Counter-clockwise in the picture, whose y points down; a little less than a quarter.
    const float a = -1.5f * static_cast<float>(i) / 6, dx = from.x - c.x, dy = from.y - c.y;
    d.point({c.x + std::cos(a) * dx - std::sin(a) * dy, c.y + std::sin(a) * dx + std::cos(a) * dy});
  }
  d.release();
  const Shape& shape = d.m().bodies[0].shapes[0];
  CHECK((shape.from - Vec3(0.1, -0.1, 0)).norm() < 1e-12);
  CHECK((shape.to - Vec3(0.1, 0.1, 0)).norm() < 1e-12);
  CHECK(d.steps() == 2);
  CHECK(d.last_step() == "Rotate rod1");
}

TEST_CASE("the ends of a spring are moved by themselves") {
  Drawing d;
  d.have_ball({0.3, 0, 0});
  edit(d.app.session, "Add spring", [](Mechanism& next, Selection& selection) {
    selection.set({PartKind::force,
                   add_spring(next, {"ground", "ball1"}, {Vec3(-0.3, 0, 0), Vec3(0.3, 0, 0)}, 1000, 0)});
  });
  d.frames(2);
  d.pull("gizmo/end0", {0.1, 0.2, 0});
  d.release();
  CHECK(d.m().forces[0].points[0] == Vec3(-0.2, 0.2, 0));
  CHECK(d.m().forces[0].points[1] == Vec3(0.3, 0, 0));
  CHECK(d.last_step() == "Move end of spring1");
  CHECK(d.steps() == 3);
}

TEST_CASE("a click on a handle means the part behind it, and no move") {
  Drawing d;
  d.have_ball({0, 0, 0}, 0.1);
  d.have_ball({0.1, 0.1, 0.3}, 0.01);
  Selection both = d.app.session.selection();
  both.add(body_part("ball1"));
  select(d.app.session, both);
  d.frames(2);
  d.click("gizmo/centre");
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")});
  // There is nothing behind the head of the arrow.
  d.click("gizmo/x");
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")});
  CHECK(d.steps() == 2);
}

TEST_CASE("several parts move together") {
  Drawing d;
  d.have_ball({-0.1, 0, 0});
  d.have_ball({0.1, 0, 0});
  Selection both;
  both.add(body_part("ball1"));
  both.add(body_part("ball2"));
  select(d.app.session, both);
  d.frames(2);
  d.pull("gizmo/y", {0, 0.21, 0});
  d.release();
  CHECK(d.m().bodies[0].position == Vec3(-0.1, 0.2, 0));
  CHECK(d.m().bodies[1].position == Vec3(0.1, 0.2, 0));
  CHECK(d.last_step() == "Move 2 parts");
}

TEST_CASE("tools and handles are there while building only") {
  Drawing d;
  d.have_ball({0, 0, 0});
  CHECK(d.app.ui.widgets.contains("gizmo/x"));
  CHECK(d.app.ui.widgets.contains("tools/ball"));
  set_mode(d.app.session, Mode::explore);
  d.frames(2);
  CHECK_FALSE(d.app.ui.widgets.contains("gizmo/x"));
  CHECK_FALSE(d.app.ui.widgets.contains("tools/ball"));
  set_tool(d.app.session, d.app.ui, d.app.tool, Tool::spring);
  d.frames(2);
  CHECK(d.app.session.mode == Mode::build);
}

TEST_CASE("a drag is over when the document is another one") {
  Drawing d;
  d.have_ball({0, 0, 0});
  d.pull("gizmo/x", {0.2, 0, 0});
  open_document(d.app.session, Document());
  d.point_at({0.3, 0, 0});
  d.release();
  CHECK(d.m().bodies.empty());
  CHECK(d.steps() == 0);
}
