// What others do to a file that is open.
#include "engine/mechanism/validate.hpp"
#include "file_robot.hpp"
#include "tests/catch.hpp"

#include <imgui_internal.h>

using namespace flyball;
using namespace flyball::test;

TEST_CASE_METHOD(OpenGovernor, "a file that changes on disk is read again where nothing is unsaved") {
  robot.pass(3);
  select(app.session, {{{PartKind::body, "ball1"}}});
  const ViewCamera camera = app.view.camera;
  SECTION("a scene") {
    set_speed_in(file, 8);
    robot.pass(3);
    CHECK(robot.speed_now() == 8);
    CHECK_THAT(app.session.notice, ContainsSubstring("Reloaded governor.json"));
    CHECK_FALSE(app.session.document.unsaved());
    CHECK(app.session.selection().has(Part{PartKind::body, "ball1"}));
    CHECK(app.view.camera.eye() == camera.eye());
    CHECK(app.session.answer.solution.status == Status::converged);
    robot.key('Z', true);
    CHECK(robot.speed_now() == 11.0174);
    CHECK(app.session.document.unsaved());
  }
  SECTION("twice, without a press between: two steps") {
    for (const double value : {8., 7.}) {
      set_speed_in(file, value);
      robot.pass(3);
      REQUIRE(robot.speed_now() == value);
    }
    undo(app.session);
    CHECK(robot.speed_now() == 8);
    undo(app.session);
    CHECK(robot.speed_now() == 11.0174);
  }
  SECTION("a scene with a name that is not there: theirs, with its mistake, and nothing of it is lost") {
    std::string theirs = read_bytes(file);
    const std::size_t number = theirs.find("11.0174");
    REQUIRE(number != std::string::npos);
    theirs.replace(number, 7, "\"=xq + 1\"");
    theirs.replace(theirs.find("\"flyball\": 1"), 12, "\"flyball\": 2");
    write_bytes(file, theirs);
    robot.pass(3);
    CHECK_THAT(app.session.notice, ContainsSubstring("Reloaded governor.json"));
    CHECK(find_mistakes(app.session.document.stored()).size() == 1);
    CHECK_FALSE(app.session.document.unsaved());
    robot.key('Z', true);
    CHECK(robot.speed_now() == 11.0174);
  }
  SECTION("no scene: the open one stays") {
    const std::string before = read_bytes(file);
    write_bytes(file, "{\"flyball\": 1");
    robot.pass(3);
    CHECK(robot.speed_now() == 11.0174);
    CHECK_THAT(app.session.notice, ContainsSubstring("cannot be read"));
    // Saving over it asks, and a crash meanwhile leaves work that is told to be based on another text.
    robot.set_speed(9);
    CHECK(app.session.files.watch.hash() == text_hash(before));
    robot.key('S', true);
    CHECK(read_bytes(file) == "{\"flyball\": 1");
    REQUIRE(robot.shows("banner/keep"));
    robot.click("banner/keep");
    CHECK(speed_in(file) == 9);
    CHECK_FALSE(app.session.document.unsaved());
  }
  SECTION("the same again: nothing happens") {
    app.session.notice.clear();
    write_bytes(file, read_bytes(file));
    robot.pass(3);
    CHECK(app.session.notice.empty());
    CHECK(app.session.document.steps().size() == 1);
  }
  SECTION("its own saving is no change") {
    robot.set_speed(9);
    robot.key('S', true);
    robot.pass(3);
    CHECK(app.session.notice == "Saved governor.json");
  }
}

TEST_CASE_METHOD(OpenGovernor, "a file that changes on disk while there are unsaved edits is asked about") {
  robot.set_speed(5);
  set_speed_in(file, 8);

  SECTION("noticed by looking") {
    robot.pass(3);
    REQUIRE(robot.shows("banner/keep"));
    const ImGuiWindow* banner = ImGui::FindWindowByName("file banner");
    REQUIRE(banner);
    CHECK(banner->Pos.x + banner->Size.x <= robot.widget("legend frame").from.x);
    CHECK(robot.speed_now() == 5);
    SECTION("keep mine") {
      robot.click("banner/keep");
      robot.pass(3);
      CHECK_FALSE(robot.shows("banner/keep"));
      CHECK(robot.speed_now() == 5);
      CHECK(speed_in(file) == 8);
      robot.key('S', true);
      CHECK(speed_in(file) == 5);
    }
    SECTION("take the file's") {
      robot.click("banner/reload");
      CHECK_FALSE(robot.shows("banner/keep"));
      CHECK(robot.speed_now() == 8);
      CHECK_FALSE(app.session.document.unsaved());
      robot.key('Z', true);
      CHECK(robot.speed_now() == 5); // nothing is lost
    }
    SECTION("beside the tools") {
      set_mode(app.session, Mode::build);
      robot.frames(3);
      CHECK(banner->Pos.x >= robot.widget("tool strip").to.x);
      CHECK(banner->Pos.x + banner->Size.x <= robot.widget("legend frame").from.x);
    }
    SECTION("gone meanwhile: there is nothing to be taken, and saving writes it anew") {
      robot.key('S', true);
      fs::remove(file);
      robot.pass(3);
      CHECK_FALSE(robot.shows("banner/reload"));
      CHECK_THAT(app.session.notice, ContainsSubstring("no longer on disk"));
      SECTION("as it does") {
        robot.key('S', true);
        CHECK(speed_in(file) == 5);
      }
      SECTION("and back: asked about again, and told to be gone no longer") {
        write_bytes(file, "{ half a scene");
        robot.pass(3);
        CHECK(robot.shows("banner/reload"));
        CHECK(app.session.notice.empty());
        CHECK(robot.speed_now() == 5);
      }
    }
    SECTION("changed once more") {
      robot.click("banner/keep");
      set_speed_in(file, 7);
      robot.pass(3);
      CHECK(robot.shows("banner/keep"));
    }
  }
  SECTION("noticed by saving") {
    robot.key('S', true);
    CHECK(speed_in(file) == 8);
    REQUIRE(robot.shows("banner/keep"));
    robot.click("banner/keep"); // overwrite
    CHECK(speed_in(file) == 5);
    CHECK_FALSE(robot.shows("banner/keep"));
    CHECK_FALSE(app.session.document.unsaved());
  }
}

TEST_CASE_METHOD(OpenGovernor, "a file that vanishes is told once, and its document is not lost") {
  robot.pass(3);
  fs::remove(file);
  robot.pass(3);
  CHECK_THAT(app.session.notice, ContainsSubstring("no longer on disk"));
  app.session.notice.clear();
  robot.pass(5);
  CHECK(app.session.notice.empty());
  CHECK(has_unsaved_work(app.session));
  robot.key('Q', true);
  CHECK_FALSE(app.quit);
  robot.click("unsaved/save");
  CHECK(app.quit);
  CHECK(speed_in(file) == 11.0174);
}

TEST_CASE_METHOD(OpenGovernor, "reloading by hand can be undone") {
  robot.set_speed(5);
  robot.key('R', true);
  CHECK(robot.speed_now() == 11.0174);
  CHECK_FALSE(robot.app.session.document.unsaved());
  robot.key('Z', true);
  CHECK(robot.speed_now() == 5);
}
