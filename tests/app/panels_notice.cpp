// What was last done is told for a while.
#include "app/ui/commands.hpp"
#include "app/ui/widgets/notice.hpp"
#include "robot.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a notice fades, and then nothing has to be drawn for it") {
  Robot robot;
  App& app = robot.app;
  CHECK(std::isinf(next_notice_change(app.session, app.notice_age)));
  app.session.notice = "Copied ball1";
  age_notice(app.session, app.notice_age, 0.1);
  CHECK(notice_strength(app.session, app.notice_age) == 1);
  CHECK(next_notice_change(app.session, app.notice_age) > 4);
  age_notice(app.session, app.notice_age, notice_life(app.session.notice) - notice_fade / 2);
  CHECK(notice_strength(app.session, app.notice_age) < 0.6f);
  CHECK(notice_strength(app.session, app.notice_age) > 0.4f);
  CHECK(next_notice_change(app.session, app.notice_age) < 0.1);
  age_notice(app.session, app.notice_age, notice_fade);
  CHECK(app.session.notice.empty());
  CHECK(std::isinf(next_notice_change(app.session, app.notice_age)));
  // The view itself was not drawn again for any of it.
  const int drawn = robot.stage.views_changed();
  robot.frames(5);
  CHECK(robot.stage.views_changed() == drawn);
}

TEST_CASE("the same notice again is told anew") {
  Robot robot;
  App& app = robot.app;
  app.session.notice = "Saved";
  age_notice(app.session, app.notice_age, 0);
  age_notice(app.session, app.notice_age, 4);
  app.session.notice = "Undone: Move";
  age_notice(app.session, app.notice_age, 4);
  CHECK(app.session.notice == "Undone: Move");
  CHECK(notice_strength(app.session, app.notice_age) == 1);
}

TEST_CASE("a notice that is pointed at stays") {
  Robot robot;
  App& app = robot.app;
  app.session.notice = "Copied ball1";
  robot.frames(2);
  age_notice(app.session, app.notice_age, 0);
  const double before = notice_life("short"), after = notice_life(std::string(100, 'x'));
  CHECK(after > before); // long ones take longer to read
  robot.point(robot.widget("notice").center());
  for (int i = 0; i < 100; ++i) {
    age_notice(app.session, app.notice_age, 1);
    robot.frames(1);
  }
  CHECK(app.session.notice == "Copied ball1");
  CHECK(notice_strength(app.session, app.notice_age) == 1);
  robot.point(ImVec2{5, 300});
  for (int i = 0; i < 20; ++i)
    age_notice(app.session, app.notice_age, 1);
  CHECK(app.session.notice.empty());
}

TEST_CASE("what was told before is listed, the latest first") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.session.notice = "Copied ball1";
  robot.frames(2);
  show_error(app.session, "Not saved: the disk is full");
  robot.frames(2);
  app.session.notice.clear();
  robot.frames(2);
  app.commands.run("help.messages");
  robot.frames(3);
  REQUIRE(app.notice_log.past.size() >= 2);
  CHECK(app.notice_log.past.back().text == "Not saved: the disk is full");
  CHECK(app.notice_log.past.back().error);
  CHECK_FALSE((app.notice_log.past.end() - 2)->error);
  CHECK(robot.widget("messages/1").from.y < robot.widget("messages/2").from.y);
  robot.click("messages/1");
  CHECK(std::string(ImGui::GetClipboardText()) == "Not saved: the disk is full");
}

TEST_CASE("what went wrong stays until it is put away") {
  Robot robot;
  App& app = robot.app;
  show_error(app.session, "Not saved: the disk is full");
  for (int i = 0; i < 100; ++i)
    age_notice(app.session, app.notice_age, 1);
  robot.frames(2);
  CHECK(is_error(app.session));
  CHECK(std::isinf(next_notice_change(app.session, app.notice_age)));
  robot.click("error/close");
  CHECK(app.session.notice.empty());
  CHECK(app.ui.widgets.count("error/close") == 0);
}
