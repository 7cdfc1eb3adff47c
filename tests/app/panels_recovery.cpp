// Unsaved work while it lasts, and after a crash.
#include "file_robot.hpp"

#include "app/document/autosave.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE_METHOD(OpenGovernor, "unsaved work is kept beside the file while it lasts") {
  robot.pass(3);
  CHECK(hidden(folder, "-autosave") == 0);
  robot.set_speed(5);
  robot.pass(2);
  REQUIRE(hidden(folder, "-autosave") == 1);
  CHECK(get_parameter(parse_scene(parse_autosave(read_bytes(app.session.files.autosave.path())).scene),
                      speed) == 5);
  SECTION("until it is saved") {
    robot.key('S', true);
  }
  SECTION("until it is undone") {
    robot.key('Z', true);
    robot.pass(1);
  }
  SECTION("until it is given up") {
    robot.key('Q', true);
    robot.click("unsaved/discard");
    CHECK(app.quit);
  }
  SECTION("until another document takes its place") {
    robot.key('N', true);
    robot.click("unsaved/discard");
    CHECK(app.session.document.file().empty());
  }
  CHECK(hidden(folder, "-autosave") == 0);
}

TEST_CASE_METHOD(OpenGovernor, "an opening that fails keeps the work and its autosave") {
  robot.set_speed(5);
  robot.pass(2);
  write_bytes(folder / "broken.json", "no scene");
  robot.open(folder / "broken.json");
  robot.click("unsaved/discard");
  robot.frames(2);
  CHECK_THAT(robot.app.session.problem, ContainsSubstring("broken.json"));
  CHECK(robot.app.session.document.file() == file);
  CHECK(robot.speed_now() == 5);
  CHECK(hidden(folder, "-autosave") == 1);
  CHECK(robot.app.session.files.recent.front() == file);
}

TEST_CASE("work that a crash has left is offered when its file is opened") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  crash_at_speed(folder, file, 5);
  REQUIRE(hidden(folder, "-autosave") == 1);
  // Also when the program starts, because the file was used lately.
  FileRobot robot(folder);
  App& app = robot.app;
  REQUIRE(robot.shows("recover/recover"));
  robot.click("recover/later");
  CHECK_FALSE(app.dialog.showing);
  robot.open(file);
  REQUIRE(robot.shows("recover/recover"));
  CHECK(robot.speed_now() == 11.0174);

  SECTION("recovered, as a step that can be undone") {
    robot.click("recover/recover");
    CHECK_FALSE(app.dialog.showing);
    CHECK(robot.speed_now() == 5);
    CHECK(app.session.document.file() == file);
    CHECK(app.session.document.unsaved());
    CHECK(speed_in(file) == 11.0174);
    CHECK(app.session.answer.solution.status == Status::converged);
    CHECK(hidden(folder, "-autosave") == 1); // safe from the next crash at once
    robot.pass(2);
    CHECK(find_leftovers(file, app.session.options.state).empty()); // it is this program's now
    robot.key('Z', true);
    CHECK(robot.speed_now() == 11.0174);
    robot.key('Z', true);
    robot.set_speed(6);
    robot.key('S', true);
    CHECK(hidden(folder, "-autosave") == 0);
  }
  SECTION("discarded, and brought back") {
    robot.click("recover/discard");
    CHECK_FALSE(app.dialog.showing);
    CHECK(hidden(folder, "-autosave") == 0);
    CHECK(hidden(folder, "-discarded") == 1);
    robot.frames(4);
    robot.click("banner/bring_back");
    robot.frames(2);
    REQUIRE(robot.shows("recover/recover"));
    robot.key(key_enter);
    CHECK(robot.speed_now() == 5);
  }
  SECTION("discarded: not told of over another file") {
    robot.click("recover/discard");
    robot.frames(4);
    REQUIRE(robot.shows("banner/bring_back"));
    robot.open(governor_in(folder, "other.json"));
    robot.frames(4);
    CHECK_FALSE(robot.shows("banner/bring_back"));
  }
  SECTION("discarded for good by the next save") {
    robot.click("recover/discard");
    robot.set_speed(6);
    robot.key('S', true);
    CHECK(hidden(folder, "-discarded") == 0);
    CHECK_FALSE(robot.shows("banner/bring_back"));
  }
  SECTION("put off") {
    robot.key(key_escape);
    robot.frames(2);
    CHECK_FALSE(app.dialog.showing);
    CHECK(hidden(folder, "-autosave") == 1);
  }
  SECTION("recovered in two windows: the second is told") {
    const Leftover leftover = app.session.files.leftovers.at(0);
    fs::remove(leftover.path);
    robot.click("recover/recover");
    CHECK(robot.speed_now() == 11.0174);
    CHECK_THAT(app.session.notice, ContainsSubstring("no longer there"));
  }
}

TEST_CASE("whoever starts with a file is not asked about another one") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder), other = governor_in(folder, "other.json");
  crash_at_speed(folder, other, 5);
  FileRobot robot(folder);
  robot.click("recover/later");
  robot.open(file);
  begin_files(robot.app.session, robot.app.dialog, true);
  robot.frames(3);
  CHECK_FALSE(robot.app.dialog.showing);
  robot.open(other);
  CHECK(robot.shows("recover/recover"));
}

TEST_CASE("recovering over a file that has changed since, or is gone") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  crash_at_speed(folder, file, 5);
  const bool gone = GENERATE(false, true);
  if (gone)
    fs::remove(file);
  else
    set_speed_in(file, 8);
  FileRobot robot(folder);
  App& app = robot.app;
  // A file that is gone is no recent one: whoever asks for it by name is offered what is left.
  app.session.files.leftovers = find_leftovers(file, app.session.options.state);
  REQUIRE(app.session.files.leftovers.size() == 1);
  CHECK(app.session.files.leftovers[0].outdated);
  recover(app, Leftover(app.session.files.leftovers[0]));
  CHECK(robot.speed_now() == 5);
  CHECK(app.session.document.file() == file);
  CHECK(app.session.document.unsaved());
  undo(app.session);
  if (gone)
    CHECK(app.session.mechanism().bodies.empty());
  else
    CHECK(robot.speed_now() == 8);
}

TEST_CASE("bodies have the colours that they had before the crash") {
  const TemporaryFolder folder;
  const bool titled = GENERATE(false, true);
  CAPTURE(titled);
  const fs::path file = titled ? governor_in(folder) : fs::path();
  std::map<std::string, int> before;
  const auto colours = [](const Document& document) {
    std::map<std::string, int> named;
    for (std::size_t i = 0; i < document.hues().size(); ++i)
      named[document.stored().bodies[i].name] = document.hues()[i];
    return named;
  };
  {
    FileRobot robot(folder, crashed);
    if (titled) robot.open(file);
    robot.frames(2);
    if (!titled) robot.key('N', true);
    // In another order than they stand in, and with other names than they came with.
    for (const char* name : {"one", "two", "three", "four"})
      edit(robot.app.session, "Add",
           [&](Mechanism& m, Selection&) { m.bodies.insert(m.bodies.begin(), test::body(name)); });
    for (const char* name : {"four", "two"})
      edit(robot.app.session, "Rename", [&](Mechanism& m, Selection&) {
        m.bodies[static_cast<std::size_t>(body_index(m, name))].name = std::string("the ") + name;
      });
    robot.pass(2);
    before = colours(robot.app.session.document);
    REQUIRE(choose_hues(robot.app.session.document.stored()) != robot.app.session.document.hues());
  }
  FileRobot robot(folder);
  if (titled) robot.open(file);
  robot.click("recover/recover");
  REQUIRE(robot.app.session.mechanism().bodies.size() >= 4);
  CHECK(colours(robot.app.session.document) == before);
}

TEST_CASE("untitled work that a crash has left is offered at the next start") {
  const TemporaryFolder folder;
  for (const char* name : {"ball", "block"}) {
    FileRobot robot(folder, crashed);
    robot.app.session.files.leftovers.clear();
    robot.key(key_escape);
    robot.key('N', true);
    edit(robot.app.session, "Add", [&](Mechanism& m, Selection&) {
      m.name = name;
      m.bodies.push_back(test::body(name));
    });
    robot.pass(2);
  }
  FileRobot robot(folder);
  App& app = robot.app;
  REQUIRE(app.session.files.leftovers.size() == 2);
  robot.click("recover/1");
  const std::string wanted = app.session.files.leftovers[1].autosave.name;
  robot.click("recover/recover");
  CHECK(app.session.mechanism().bodies.at(0).name == wanted);
  CHECK(app.session.document.file().empty());
  CHECK(app.session.document.unsaved());
  robot.pass(2);
  CHECK(find_leftovers({}, app.session.options.state).size() == 1); // the other one, for later
}

TEST_CASE("another program's running work is not offered") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  {
    FileRobot robot(folder); // of this process, which runs
    robot.open(file);
    robot.set_speed(5);
    robot.pass(2);
  }
  FileRobot robot(folder);
  robot.open(file);
  CHECK_FALSE(robot.app.dialog.showing);
  robot.set_speed(6);
  robot.pass(2);
  CHECK(hidden(folder, "-autosave") == 2);
  robot.key('S', true);
  CHECK(hidden(folder, "-autosave") == 1);
}
