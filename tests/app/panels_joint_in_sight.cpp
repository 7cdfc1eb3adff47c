// What acts in a joint can be seen and reached without scrolling, in a window as small as most.
#include "app/ui/layout.hpp"
#include "robot.hpp"
#include "tests/catch.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize window{1280, 800};

void check_in_sight(Robot& robot, const std::string& name) {
  const PanelRect panel = layout_of(robot.app, window.width, window.height).inspector;
  const WidgetRect& rect = robot.widget("inspector/" + name);
  CAPTURE(name);
  CHECK(rect.from.x >= panel.x);
  CHECK(rect.to.x <= panel.x + panel.width);
  CHECK(rect.from.y >= panel.y);
  CHECK(rect.to.y <= panel.y + panel.height);
  CHECK(rect.to.y - rect.from.y >= 14);
}

} // namespace

TEST_CASE("drive, spring, damper, stop and friction of a joint are in sight without scrolling") {
  Robot robot(window);
  App& app = robot.app;
  set_mode(app.session, GENERATE(Mode::build, Mode::explore));
  const char* joint = GENERATE("arm1", "slide"); // a revolute and a prismatic one
  select(app.session, {{{PartKind::joint, joint}}});
  robot.frames(3);
  for (const char* tick : {"drive", "spring", "damper", "stop", "friction"})
    check_in_sight(robot, tick);
  // With all on that can be, their numbers, too, and no tick has moved.
  const WidgetRect stop = robot.widget("inspector/stop");
  edit(app.session, "Add", [&](Mechanism& mechanism, Selection&) {
    Coordinate& c = mechanism.joints[static_cast<std::size_t>(joint_index(mechanism, joint))].coordinates[0];
    c.spring.emplace().stiffness = 10;
    c.damping = 1;
    c.stop.emplace().stiffness = 100;
    c.stop->lower = -1;
    c.stop->upper = 1;
  });
  robot.frames(3);
  for (const char* tick : {"drive", "spring", "damper", "stop", "friction"})
    check_in_sight(robot, tick);
  for (const char* number :
       {"spring/stiffness", "spring/free", "damping", "stop/lower", "stop/upper", "stop/stiffness"})
    check_in_sight(robot, number);
  CHECK(robot.widget("inspector/stop").from.y == stop.from.y);
}

TEST_CASE("a drive that is ticked moves no row above its numbers") {
  Robot robot(window);
  App& app = robot.app;
  set_mode(app.session, Mode::build);
  select(app.session, {{{PartKind::joint, "arm1"}}});
  robot.frames(3);
  const WidgetRect drawn = robot.widget("inspector/coordinate"), drive = robot.widget("inspector/drive");
  robot.click("inspector/drive");
  robot.frames(2);
  CHECK(robot.widget("inspector/coordinate").from.y == drawn.from.y);
  CHECK(robot.widget("inspector/drive").from.y == drive.from.y);
  check_in_sight(robot, "drive/speed");
}
