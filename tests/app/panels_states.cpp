// All equilibria of a mechanism in the window, as a person uses the list.
#include "robot.hpp"
#include "session_wait.hpp"

#include "app/document/rename.hpp"
#include "app/session/states.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize wide{1280, 900};

struct StatesRobot : Robot {
  explicit StatesRobot(const std::string& scene = "conical_pendulum") : Robot(wide) {
    open_scene(app.session, shipped_file(scene));
    frames(3);
    key('E');
    frames(3);
  }
  const std::vector<Solution>& all() { return app.session.study.states.found->result.equilibria; }
};

} // namespace

TEST_CASE("nothing is searched before it is asked for, and a closed list is gone") {
  Robot robot(wide);
  CHECK_FALSE(robot.app.session.study.states.asked);
  CHECK(robot.app.ui.widgets.count("study/states") == 0);
  robot.key('E');
  robot.frames(2);
  REQUIRE(robot.app.session.study.states.found);
  CHECK_FALSE(robot.app.session.study.states.found->result.equilibria.empty());
  const auto found = robot.app.session.study.states.found;
  REQUIRE(found);
  open_study(robot.app.session, StudyKind::response); // behind another tab it stays
  robot.frames(2);
  CHECK(robot.app.session.study.states.found == found);
  open_study(robot.app.session, StudyKind::states);
  robot.frames(2);
  CHECK(robot.app.session.study.states.found == found);
  robot.click("study/close");
  CHECK_FALSE(robot.app.session.study.states.asked);
  CHECK_FALSE(robot.app.session.study.states.found);
  CHECK(robot.app.ui.widgets.count("states/row/1") == 0);
}

TEST_CASE("the conical pendulum's four states are listed: two stable ones aside, two unstable ones upright") {
  StatesRobot robot;
  const std::vector<Solution>& all = robot.all();
  REQUIRE(all.size() == 4);
  // Its speed of 5 rad/s is above the critical one.
  const Mechanism& m = robot.app.session.mechanism();
  const double length = std::hypot(m.bodies[1].position.x(), 1 - m.bodies[1].position.y());
  const double angle = std::acos(9.80665 / (25 * length));
  int aside = 0, upright = 0;
  for (const Solution& s : all) {
    const double theta = value(s, "swing");
    if (s.stable == true) {
      CHECK(std::abs(theta) == Approx(angle).epsilon(1e-3));
      ++aside;
    } else {
      CHECK(s.stable == false);
      CHECK(std::min(std::abs(theta), std::abs(std::abs(theta) - std::numbers::pi)) < 1e-9);
      ++upright;
    }
  }
  CHECK(aside == 2);
  CHECK(upright == 2);
  // Lowest potential first, and all of them have a row.
  CHECK(std::ranges::is_sorted(all, {}, [](const Solution& s) { return s.potential.value(); }));
  robot.widget("states/row/4");
  robot.widget("states/search");
  // The one that is shown is one of the stable ones.
  const std::optional<std::size_t> shown = shown_state(robot.app.session);
  REQUIRE(shown);
  CHECK(all[*shown].stable == true);
  robot.widget("states/shown");
}

TEST_CASE("where speeds were looked for is told in their unit") {
  StatesRobot robot("governor_engine");
  CHECK(robot.copied("states/bound/spin").ends_with(" rad/s"));
  CHECK(robot.copied("states/bound/arm1").ends_with(" °"));
  robot.app.session.units.speed = SpeedUnit::rpm;
  robot.frames(2);
  CHECK(robot.copied("states/bound/spin").ends_with(" rpm"));
}

TEST_CASE("a click on a row puts the mechanism into that state, stable or not") {
  StatesRobot robot;
  App& app = robot.app;
  const std::uint64_t revision = app.session.document.revision();
  for (std::size_t i = 0; i < robot.all().size(); ++i) {
    CAPTURE(i);
    robot.click("states/row/" + std::to_string(i + 1));
    CHECK(shown_state(app.session) == i);
    const Solution& wanted = robot.all()[i];
    CHECK(app.session.answer.solution.stable == wanted.stable);
    CHECK(std::remainder(value(app.session.answer.solution, "swing") - value(wanted, "swing"),
                         2 * std::numbers::pi) == Approx(0).margin(1e-9));
    REQUIRE(app.session.poses.size() == wanted.poses.size());
    CHECK(app.session.poses[1].position.isApprox(wanted.poses[1].position, 1e-9));
  }
  CHECK(app.session.document.revision() == revision); // looking is no edit
}

TEST_CASE("after a change the list is that of the mechanism as it is") {
  StatesRobot robot;
  App& app = robot.app;
  app.session.study.states.found->run_time = 0;                // whatever it took on a busy machine
  change_parameter(app.session, "joints.spin.drive.speed", 1); // below the critical speed
  robot.frames(3);
  CHECK(states_are_current(app.session));
  CHECK(robot.all().size() == 2);
  // A search that took long is not begun again unasked.
  app.session.study.states.found->run_time = 10;
  change_parameter(app.session, "joints.spin.drive.speed", 5);
  robot.frames(3);
  CHECK_FALSE(states_are_current(app.session));
  CHECK_FALSE(shown_state(app.session));
  CHECK(robot.all().size() == 2);
  robot.click("states/row/1"); // of another mechanism: not to be chosen
  CHECK_FALSE(states_are_current(app.session));
  robot.click("states/search_again");
  robot.frames(2);
  CHECK(states_are_current(app.session));
  CHECK(robot.all().size() == 4);
}

TEST_CASE("a search in the background can be stopped, and what was found before stays") {
  App app({.mode = LiveSolver::Mode::background, .on_news = {}, .scenes = {}, .numbers = {}});
  open_scene(app.session, shipped_file("chain20"));
  const auto wait = [&](const auto& until) {
    REQUIRE(steps_until([&] { update(app, 0.01, {400, 300}); }, until));
  };
  wait([&] { return app.session.answer.ticket != 0; });
  open_study(app.session, StudyKind::states);
  update(app, 0.01, {400, 300});
  REQUIRE(app.session.study.states.asked);
  app.session.study.states.stop();
  wait([&] { return !app.session.study.states.problem.empty(); });
  CHECK_FALSE(studying(app.session));
  CHECK_FALSE(app.session.study.states.found);
  CHECK(app.session.study.states.problem == "The search was stopped.");
}

TEST_CASE("every shipped scene's list can be shown, in both themes and in a narrow window") {
  for (const char* scene : {"ball_on_string", "fourbar_turntable", "rate_gyro", "watt_governor"}) {
    CAPTURE(scene);
    StatesRobot robot(scene);
    REQUIRE(robot.app.session.study.states.found);
    CHECK(robot.app.session.study.states.problem.empty());
    robot.size = {820, 560};
    robot.frames(3);
    robot.app.ui.theme = Theme::dark;
    robot.frames(2);
    for (const CoordinateSolution& c : robot.app.session.answer.solution.coordinates)
      if (!c.driven && !robot.all().empty()) {
        robot.widget("states/row/1");
        break;
      }
  }
}

TEST_CASE("the studies' tabs leave the button beside them in sight in a narrow window") {
  StatesRobot robot("conical_pendulum");
  const float wide_tab = robot.widget("study/compare").to.x - robot.widget("study/compare").from.x;
  robot.size = {512, 600};
  robot.frames(3);
  const WidgetRect last = robot.widget("study/compare"), close = robot.widget("study/close");
  CHECK(last.to.x <= close.from.x);
  CHECK(last.to.x - last.from.x < wide_tab);
  CHECK(close.to.x <= 512);
}

TEST_CASE("a long name leaves its column's numbers in sight") {
  Robot robot(wide);
  Mechanism m = shipped("conical_pendulum");
  const std::string name(90, 'w');
  rename_part(m, {PartKind::joint, "swing"}, name);
  open_document(robot.app.session, Document(m));
  robot.frames(3);
  robot.key('E');
  robot.frames(3);
  REQUIRE(robot.app.session.study.states.found);
  REQUIRE_FALSE(robot.app.session.study.states.found->result.equilibria.empty());
  const WidgetRect title = robot.widget("states/column/3");
  CHECK(title.to.x - title.from.x > 60);
  CHECK(title.to.x < 900);
}
