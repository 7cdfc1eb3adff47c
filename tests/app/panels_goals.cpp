// Sliders in reverse by mouse and keys: read-outs and bodies dragged to where they should be.
#include "robot.hpp"

#include "app/ui/camera_glide.hpp"
#include "app/ui/commands.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

struct GoalRobot : Robot {
  GoalRobot() : Robot({1280, 900}) {
    open_scene(app.session, shipped_file("governor_parametric"));
    set_mode(app.session, ::flyball::Mode::explore);
    look_from(app.view, 0, 0);
    frames(4);
  }
  double number(const std::string& address) const { return get_parameter(app.session.mechanism(), address); }
  double settled(const char* joint) const { return value(app.session.answer.solution, joint); }
  Vec3 shown(const char* name) const {
    return app.session.poses.at(static_cast<std::size_t>(body_index(app.session.mechanism(), name))).position;
  }
};

} // namespace

TEST_CASE("a read-out is dragged, and the pinned sliders follow") {
  GoalRobot robot;
  const double before = robot.settled("slide"), w = robot.number("parameters.w");
  const ImVec2 at = robot.widget("results/slide").center();
  robot.point(at);
  robot.press();
  for (int i = 1; i <= 10; ++i)
    robot.point({at.x - 4.f * static_cast<float>(i), at.y});
  robot.release();
  robot.frames(3);
  CHECK(robot.settled("slide") < before);
  CHECK(robot.number("parameters.w") > w);
  const GoalAnswer* answer = sought(robot.app.session);
  REQUIRE(answer);
  CHECK(robot.settled("slide") == Approx(answer->goals[0].goal).epsilon(1e-9));
  CHECK(robot.app.session.document.steps().size() == 2);
  undo(robot.app.session);
  robot.frames(2);
  CHECK(robot.number("parameters.w") == w);
  CHECK(robot.settled("slide") == Approx(before).epsilon(1e-9));
}

TEST_CASE("a goal is typed over a read-out, in any unit") {
  GoalRobot robot;
  robot.double_click("results/slide");
  robot.frames(2);
  robot.key('A', true);
  robot.type("14 cm");
  robot.key(key_enter);
  robot.frames(3);
  CHECK(robot.settled("slide") == Approx(0.14).epsilon(1e-9));
}

TEST_CASE("a number that is held stays while others go to the goal") {
  GoalRobot robot;
  const double L = robot.number("parameters.L");
  robot.click("parameters/parameters.L/hold");
  robot.frames(1);
  CHECK(is_held(robot.app.session, "parameters.L"));
  robot.double_click("results/slide");
  robot.frames(2);
  robot.key('A', true);
  robot.type("0.14 m");
  robot.key(key_enter);
  robot.frames(3);
  CHECK(robot.number("parameters.L") == L);
  CHECK(robot.settled("slide") == Approx(0.14).epsilon(1e-9));
  robot.click("parameters/parameters.L/hold");
  CHECK_FALSE(is_held(robot.app.session, "parameters.L"));
}

TEST_CASE("a body is dragged to where it should settle, and Escape takes it back") {
  GoalRobot robot;
  const double w = robot.number("parameters.w"), collar = robot.shown("collar").y();
  const bool turned = GENERATE(false, true);
  if (turned) { // the drives a third of a turn on: the hand turns along
    robot.app.session.playback.time = 0.2;
    robot.app.session.moved_time = true;
    robot.frames(3);
  }
  const Vec3 from = robot.shown("collar"), to = from + Vec3(0, 0.012, 0);
  robot.hold(false, true, true);
  robot.point(robot.pixel(from));
  robot.press();
  REQUIRE(robot.app.tool.reach);
  robot.frames(2);
  const ImVec2 start = robot.pixel(from), end = robot.pixel(to);
  for (int i = 1; i <= 8; ++i) {
    const float t = static_cast<float>(i) / 8;
    robot.point({start.x + t * (end.x - start.x), start.y + t * (end.y - start.y)});
  }
  robot.frames(3);
  CHECK(std::abs(robot.shown("collar").y() - (collar + 0.012)) < 1e-3); // a pixel
  CHECK(robot.number("parameters.w") > w);
  const bool back = GENERATE(false, true);
  if (back) robot.key(key_escape);
  robot.release();
  robot.hold(false, false, false);
  robot.frames(3);
  CHECK_FALSE(robot.app.tool.reach);
  CHECK(robot.app.session.document.can_undo() == !back);
  CHECK((robot.number("parameters.w") == w) == back);
}

TEST_CASE("a measure's read-out takes a goal, too") {
  GoalRobot robot;
  const auto height = [&] {
    const auto& all = robot.app.session.answer.solution.measures;
    return std::ranges::find(all, "height", &MeasureSolution::name)->value.value();
  };
  const double before = height();
  robot.double_click("results/measure/height");
  robot.frames(2);
  robot.key('A', true);
  robot.type("10 cm");
  robot.key(key_enter);
  robot.frames(3);
  CHECK(before != Approx(0.1));
  CHECK(height() == Approx(0.1).epsilon(1e-9));
}
