// Trying values while exploring changes nothing of the document, until they are kept.
#include "app/document/rename.hpp"
#include "app/ui/file_commands.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "file_robot.hpp"
#include "robot.hpp"
#include "temporary_folder.hpp"
#include "tests/catch.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

double in_file(const fs::path& file) {
  return get_parameter(load_scene(file), speed);
}

void drag_speed(Robot& robot) {
  robot.drag(std::string("parameters/") + speed, {0.4f, 0.5f}, {0.8f, 0.5f});
}

} // namespace

TEST_CASE("a slider that is moved leaves nothing to be saved") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  const fs::path file = governor_in(folder);
  robot.open(file);
  const Solution before = app.session.answer.solution;
  drag_speed(robot);
  const double tried = robot.speed_now();
  REQUIRE(tried > 15);
  CHECK(app.session.answer.solution.coordinates.back().value != before.coordinates.back().value);
  CHECK(app.session.answer.mechanism ==
        app.session.document.shared()); // the same object, not only an equal one
  CHECK_FALSE(app.session.document.unsaved());
  CHECK_FALSE(has_unsaved_work(app.session));
  CHECK(robot.shows("explored/keep"));

  SECTION("closing asks nothing, and the file is as it was") {
    robot.pass(6);
    CHECK(app.session.files.autosave.path().empty());
    quit(app);
    CHECK(app.quit);
    CHECK_FALSE(app.dialog.showing);
    CHECK(in_file(file) == 11.0174);
  }
  SECTION("saving writes the stored value, and says so") {
    const std::string text = read_bytes(file);
    robot.key('S', true);
    CHECK(in_file(file) == 11.0174);
    CHECK_THAT(app.session.notice, ContainsSubstring("without the explored value"));
    CHECK(robot.speed_now() == tried);
    CHECK(robot.shows("explored/keep"));
  }
  SECTION("kept, it is an edit") {
    robot.click("explored/keep");
    CHECK(app.session.document.unsaved());
    CHECK(robot.speed_now() == tried);
    CHECK_FALSE(robot.shows("explored/keep"));
    robot.key('S', true);
    CHECK(in_file(file) == tried);
  }
  SECTION("and back, it is gone") {
    robot.click("explored/back");
    CHECK(robot.speed_now() == 11.0174);
    CHECK(app.session.document.explored().empty());
    robot.key('Z', true);
    CHECK(robot.speed_now() == tried);
    robot.key('Z', true);
    CHECK(robot.speed_now() == 11.0174);
  }
  SECTION("building shows the stored value, and edits it") {
    set_mode(app.session, Mode::build);
    robot.frames(3);
    CHECK(robot.speed_now() == 11.0174);
    CHECK(robot.shows("explored/keep"));
    edit_parameter(app.session, "bodies.collar.mass", 2);
    CHECK(app.session.document.unsaved());
    CHECK(robot.speed_now() == 11.0174);
    // Undoing takes back what is seen.
    undo(app.session);
    CHECK_FALSE(app.session.document.unsaved());
    redo(app.session);
    set_mode(app.session, Mode::explore);
    robot.frames(3);
    CHECK(robot.speed_now() == tried);
    CHECK(get_parameter(app.session.mechanism(), "bodies.collar.mass") == 2);
  }
  SECTION("what another program writes is read at once, beside it") {
    Mechanism theirs = load_scene(file);
    set_parameter(theirs, "bodies.collar.mass", 4);
    write_bytes(file, write_scene(theirs));
    robot.pass(3);
    CHECK_FALSE(app.session.files.conflict);
    CHECK(get_parameter(app.session.mechanism(), "bodies.collar.mass") == 4);
    CHECK(robot.speed_now() == tried);
    CHECK_FALSE(app.session.document.unsaved());
  }
}

TEST_CASE("what is copied while exploring has the stored numbers, as a duplicate has") {
  Robot robot({1280, 900});
  Session& session = robot.app.session;
  change_parameter(session, "bodies.ball1.mass", 2);
  select(session, {{{PartKind::body, "ball1"}}});
  robot.frames(2);
  const std::size_t bodies = session.document.stored().bodies.size();
  const bool duplicate = GENERATE(false, true);
  for (const int key : duplicate ? std::vector<int>{'D'} : std::vector<int>{'C', 'V'})
    robot.key(key, true);
  REQUIRE(session.document.stored().bodies.size() == bodies + 1);
  CHECK(session.document.stored().bodies.back().mass == 1);
}

TEST_CASE("what is typed in the inspector is an edit while exploring, too") {
  Robot robot({1280, 900});
  App& app = robot.app;
  drag_speed(robot);
  select(app.session, {{{PartKind::joint, "spin"}}});
  robot.frames(3);
  robot.click("inspector/drive/speed");
  robot.type("12 rad/s");
  robot.key(key_enter);
  CHECK(get_parameter(app.session.document.stored(), speed) == 12);
  CHECK(get_parameter(app.session.mechanism(), speed) == 12);
  CHECK(app.session.document.explored().empty());
}

TEST_CASE("after a crash unsaved edits come back, and explored values are as stored") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  {
    FileRobot robot(folder);
    robot.open(file);
    edit_parameter(robot.app.session, "bodies.collar.mass", 3);
    change_parameter(robot.app.session, speed, 20);
    robot.pass(6);
    REQUIRE_FALSE(robot.app.session.files.autosave.path().empty());
    robot.app.session.files.autosave.wait();
    const Autosave kept = parse_autosave(read_bytes(robot.app.session.files.autosave.path()));
    const Mechanism recovered = parse_scene(kept.scene);
    CHECK(get_parameter(recovered, "bodies.collar.mass") == 3);
    CHECK(get_parameter(recovered, speed) == 11.0174);
  }
}

TEST_CASE("an explored value is told with the digits of its field") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(governor_in(folder));
  change_parameter(app.session, speed, 14.2857142857);
  CHECK_THAT(explored_words(app.session).front(), ContainsSubstring(" 14.2857143 rad/s"));
  CHECK_THAT(explored_words(app.session).front(), ContainsSubstring("stored is 11.0174 rad/s"));
}

TEST_CASE("what was explored stands beside the file again when it is opened, as a step") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder), other = governor_in(folder, "other.json");
  double tried = 0;
  {
    FileRobot robot(folder);
    robot.open(file);
    drag_speed(robot);
    tried = robot.speed_now();
    REQUIRE(tried > 15);
    robot.pass(2);
  }
  FileRobot robot(folder);
  robot.open(other);
  CHECK(robot.speed_now() == 11.0174);
  robot.open(file);
  CHECK(robot.speed_now() == tried);
  CHECK(robot.shows("explored/keep"));
  CHECK_FALSE(robot.app.session.document.unsaved());
  CHECK(in_file(file) == 11.0174);
  CHECK_THAT(robot.app.session.notice, ContainsSubstring("explored last time"));
  // Left behind, it does not come again.
  robot.click("explored/back");
  robot.open(other);
  robot.open(file);
  CHECK(robot.speed_now() == 11.0174);
  CHECK_FALSE(robot.shows("explored/keep"));
}

TEST_CASE("what was explored over a number that has become another since does not come back") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  {
    FileRobot robot(folder);
    robot.open(file);
    drag_speed(robot);
    robot.pass(2);
  }
  Mechanism elsewhere = load_scene(file);
  set_parameter(elsewhere, speed, 20);
  write_bytes(file, write_scene(elsewhere));
  FileRobot robot(folder);
  robot.open(file);
  CHECK(robot.speed_now() == 20);
  CHECK_FALSE(robot.shows("explored/keep"));
}

TEST_CASE("what was explored and cannot be, as the file is now, stays kept until something is tried") {
  const TemporaryFolder folder;
  const fs::path file = folder / "governor.json";
  fs::copy_file(shipped_file("governor_parametric"), file);
  const char* const length = "parameters.L";
  {
    FileRobot robot(folder);
    robot.open(file);
    change_parameter(robot.app.session, length, 0.2);
    robot.pass(2);
  }
  const std::string before = read_bytes(file);
  Mechanism shorter = load_scene(file);
  set_parameter(shorter, "parameters.l", 0.09); // too short for an arm of 0.2 m
  write_bytes(file, write_scene(shorter));
  {
    FileRobot robot(folder);
    robot.open(file);
    CHECK(get_parameter(robot.app.session.mechanism(), length) == 0.16);
    robot.pass(2);
    robot.key('S', true); // and by saving
    robot.pass(2);
  }
  write_bytes(file, before);
  FileRobot robot(folder);
  robot.open(file);
  CHECK(get_parameter(robot.app.session.mechanism(), length) == 0.2);
}

TEST_CASE("a body that was renamed has its colour again when the file is opened") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  robot.open(file);
  Session& session = robot.app.session;
  // Names that would ask for other colours.
  edit(session, "Rename", [](Mechanism& m, Selection&) {
    rename_part(m, {PartKind::body, "ball1"}, "left");
    rename_part(m, {PartKind::body, "ball2"}, "a weight");
  });
  const BodyHues before = session.document.hues();
  REQUIRE(before != choose_hues(session.document.stored()));
  robot.key('S', true);
  REQUIRE_FALSE(session.document.unsaved());
  FileRobot again(folder);
  again.open(file);
  CHECK(again.app.session.document.hues() == before);
}
