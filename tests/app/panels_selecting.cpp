// Selecting in the 3-D view, done by a robot.
#include "drawing.hpp"

#include "app/ui/camera_glide.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("clicks select, toggle and drop") {
  Drawing d;
  d.have_ball({-0.2, 0, 0});
  d.have_ball({0.2, 0, 0});
  d.choose_nothing();
  d.app.session.mode = GENERATE(Mode::build, Mode::explore);
  d.frames(2);
  d.click_at({-0.2, 0, 0});
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")});
  d.click_at({0.22, 0.02, 0});
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball2")});
  const bool ctrl = GENERATE(false, true);
  d.hold(ctrl, !ctrl);
  d.click_at({-0.22, 0.02, 0});
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball2"), body_part("ball1")});
  d.click_at({0.22, 0.02, 0});
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")});
  d.hold(false, false);
  d.drag(d.pixel({0, 0.3, 0}), d.pixel({0.1, 0.3, 0}));
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")}); // that was steering
  CHECK(d.app.view.camera.azimuth != 0);
  look_from(d.app.view, 0, 0);
  d.frames(2);
  d.click(ImVec2(d.widget("view").to.x - 30, d.widget("view").to.y - 200));
  CHECK(d.app.session.selection().empty());
  CHECK(d.steps() == 2);
}

TEST_CASE("a frame selects what it holds") {
  Drawing d;
  for (const double x : {-0.3, 0.0, 0.3})
    d.have_ball({x, 0, 0});
  d.choose_nothing();
  const auto frame = [&](double from, double to) {
    d.drag(d.pixel({from, 0.12, 0}), d.pixel({to, -0.12, 0}));
  };
  const std::vector<Part> left{body_part("ball1"), body_part("ball2")};
  SECTION("while Ctrl is held") {
    d.hold(true, false);
    frame(-0.36, 0.1);
    CHECK(d.app.session.selection().parts == left);
    frame(0.1, 0.4);
    CHECK(d.app.session.selection().parts == std::vector{body_part("ball3")});
    d.hold(true, true);
    frame(-0.1, 0.1);
    CHECK(d.app.session.selection().parts == std::vector{body_part("ball3"), body_part("ball2")});
  }
  SECTION("with its tool") {
    d.key('B');
    frame(0.1, -0.4);
    CHECK(d.app.session.selection().parts == left);
    CHECK(d.app.tool.tool == Tool::select);
  }
  SECTION("unless Escape is pressed") {
    d.key('B');
    d.point(d.pixel({-0.4, 0.12, 0}));
    d.press();
    d.point(d.pixel({0.1, -0.12, 0}));
    d.key(key_escape);
    d.point(d.pixel({0.12, -0.12, 0}));
    d.release();
    CHECK(d.app.session.selection().empty());
  }
  CHECK(d.app.view.camera.azimuth == 0);
}

TEST_CASE("a double click on nothing shows everything, on a handle it does not") {
  Drawing d;
  d.have_ball({0, 0, 0});
  const double distance = d.app.view.camera.distance;
  d.double_click("gizmo/x");
  CHECK(d.app.view.camera.distance == distance);
  d.point_at({0.2, -0.3, 0});
  for (int i = 0; i < 4; ++i) {
    ImGui::GetIO().MouseDown[0] = i % 2 == 0;
    d.frames(1);
  }
  d.frames(1);
  CHECK(d.app.view.camera.distance < 0.9 * distance);
}

TEST_CASE("nothing is looked for under a cursor that rests") {
  Drawing d;
  d.have_ball({0, 0, 0});
  d.point_at({0, 0.03, 0});
  const Vec2 found_for = d.app.view.pointed_at;
  const int drawn = d.stage.views_changed();
  // Would be put right if anybody looked.
  d.app.view.hovered = {};
  d.frames(3);
  CHECK(d.app.view.hovered == PartId{});
  CHECK(d.app.view.pointed_at == found_for);
  CHECK(d.stage.views_changed() <= drawn + 1);
}

TEST_CASE("what is under a cursor that rests is looked for when the picture moves") {
  SECTION("because the camera does") {
    Drawing d;
    d.have_ball({0, 0, 0});
    d.choose_nothing();
    d.point_at({0, 0.03, 0});
    d.frames(1);
    CHECK(d.app.view.hovered.kind == PartKind::body);
    d.app.view.camera.target.x() += 0.3;
    d.frames(2);
    CHECK(d.app.view.hovered == PartId{});
  }
  SECTION("because the mechanism does") {
    Robot robot;
    look_from(robot.app.view, 0, 0);
    robot.frames(3);
    const int ball = body_index(robot.app.session.mechanism(), "ball1");
    robot.point_at(robot.app.session.poses.at(static_cast<std::size_t>(ball)).position);
    robot.frames(1);
    CHECK(robot.app.view.hovered == PartId{PartKind::body, ball});
    play(robot.app.session, true);
    robot.frames(3, 0.05); // about a quarter of a turn
    CHECK(robot.app.view.hovered != PartId{PartKind::body, ball});
  }
}
