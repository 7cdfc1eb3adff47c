// New, save, and questions before work is lost.
#include "app/ui/panel_list.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "file_robot.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/scenes.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a new document is built, saved where it is told, and saved again at once") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  robot.key('N', true);
  CHECK_FALSE(app.dialog.showing); // nothing would be lost
  CHECK(app.session.mechanism() == Document::empty_mechanism());
  CHECK(document_name(app.session) == "Untitled");
  edit(app.session, "Add", [](Mechanism& m, Selection&) { m.bodies.push_back(test::body("ball")); });
  CHECK(app.session.document.unsaved());

  robot.key('S', true);
  REQUIRE(app.dialog.showing);
  robot.type((folder / "new_arm").string());
  robot.key(key_enter);
  REQUIRE_FALSE(app.dialog.showing);
  const fs::path file = folder / "new_arm.flyball.json";
  REQUIRE(fs::exists(file));
  CHECK(app.session.document.file() == file);
  CHECK_FALSE(app.session.document.unsaved());
  CHECK(app.session.notice == "Saved new_arm.flyball.json");
  CHECK(app.session.mechanism().name == "New arm");
  // The name is the file's: saving is no edit, and what is undone later keeps it.
  REQUIRE(app.session.document.steps().size() == 2);
  CHECK(app.session.document.steps().front().name == "New");
  robot.key('Z', true);
  CHECK(app.session.mechanism().bodies.empty());
  CHECK(app.session.mechanism().name == "New arm");
  robot.key('Y', true);
  CHECK_FALSE(app.session.document.unsaved());
  CHECK(document_name(app.session) == "new_arm.flyball.json");
  // Unfinished as it is: the ball hangs on nothing.
  CHECK(parse_scene(read_bytes(file)) == app.session.mechanism());
  CHECK_FALSE(app.session.mistakes.empty());
  CHECK(app.session.files.recent.front() == file);

  edit(app.session, "Mass", [](Mechanism& m, Selection&) { m.bodies[0].mass = 2; });
  robot.key('S', true);
  CHECK_FALSE(app.dialog.showing);
  CHECK(parse_scene(read_bytes(file)).bodies[0].mass == 2);
  robot.key('Z', true);
  CHECK(app.session.document.unsaved()); // the file holds the edit
  CHECK(parse_scene(read_bytes(file)).bodies[0].mass == 2);
  robot.key('S', true);
  CHECK(parse_scene(read_bytes(file)).bodies[0].mass == 1);
  CHECK_FALSE(app.session.document.unsaved());

  SECTION("and opens again, unfinished as it is") {
    robot.key('N', true);
    robot.open(file);
    CHECK(app.session.problem.empty());
    CHECK(app.session.mechanism().bodies.size() == 1);
    CHECK_FALSE(app.session.mistakes.empty());
  }
}

TEST_CASE("the name that comes with the first save leaves what was computed as it is") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  robot.key('N', true);
  edit(app.session, "Build", [](Mechanism& m, Selection&) {
    const std::string name = m.name;
    m = test::shipped("governor");
    m.name = name;
  });
  app.session.motion.duration = 0.2;
  const StudyKind study = GENERATE(StudyKind::states, StudyKind::map, StudyKind::motion);
  open_study(app.session, study);
  robot.frames(4);
  const std::uint64_t ticket = app.session.answer.ticket;
  const auto* const cells = app.session.study.map.cells.found.get();
  const MotionRun* const run = shown_motion(app.session);
  const auto* const samples = run ? run->run.get() : nullptr;
  robot.key('S', true);
  robot.type((folder / "named").string());
  robot.key(key_enter);
  robot.frames(3);
  REQUIRE(app.session.mechanism().name == "Named");
  CHECK(app.session.answer.ticket == ticket);
  if (study == StudyKind::states) CHECK(states_are_current(app.session));
  if (study == StudyKind::map) {
    CHECK(cells);
    CHECK(app.session.study.map.cells.found.get() == cells);
    CHECK_FALSE(app.session.study.map.stale);
  }
  if (study == StudyKind::motion) {
    REQUIRE(shown_motion(app.session));
    CHECK(shown_motion(app.session)->run.get() == samples);
  }
}

TEST_CASE_METHOD(OpenGovernor, "a picture is offered a place beside the file, as a report is") {
  robot.key('E', true);
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  CHECK(fs::path(app.panels->picture.query().path).parent_path() == file.parent_path());
}

TEST_CASE("a picture of an example is not offered a place among the examples") {
  Robot robot;
  REQUIRE(is_example(robot.app.session));
  robot.key('E', true);
  robot.frames(2);
  REQUIRE(robot.app.dialog.showing);
  const fs::path offered = robot.app.panels->picture.query().path;
  CHECK(offered.parent_path() == fs::current_path());
  CHECK(offered.filename() == "flyball-governor.png");
}

TEST_CASE("a new document is not offered a place among the examples that were opened before it") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  fs::create_directory(folder / "shipped");
  fs::copy_file(shipped_file("governor"), folder / "shipped/governor.json");
  fs::create_directory_symlink(folder / "shipped", folder / "scenes"); // as a build folder has them
  robot.app.session.options.scenes = folder / "scenes";
  robot.open(folder / "scenes/governor.json");
  REQUIRE(is_example(robot.app.session));
  REQUIRE(robot.app.session.files.recent.size() == 1);
  robot.key('N', true);
  REQUIRE(robot.app.session.document.file().empty());
  CHECK(usual_folder(robot.app.session) == fs::current_path());
}

TEST_CASE("a picture of a file of the program's own is called without its two endings") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  robot.open(governor_in(folder, "w.flyball.json"));
  robot.key('E', true);
  robot.frames(2);
  REQUIRE(robot.app.dialog.showing);
  CHECK(fs::path(robot.app.panels->picture.query().path).filename() == "flyball-w.png");
}

TEST_CASE("saving over another file is asked about, and a failure loses nothing") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder), other = folder / "other.json";
  write_bytes(other, "something else");
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(file);
  robot.set_speed(5);
  show_save_dialog(app);
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  CHECK(app.panels->save.query().path == "governor.json");

  SECTION("asked twice, then replaced") {
    robot.click("save/other.json"); // from the list
    robot.click("save/save");
    CHECK(app.dialog.showing);
    CHECK(read_bytes(other) == "something else");
    robot.click("save/save");
    CHECK_FALSE(app.dialog.showing);
    CHECK(speed_in(other) == 5);
    CHECK(app.session.document.file() == other);
    CHECK(speed_in(file) == 11.0174);
  }
  SECTION("given up") {
    robot.type((folder / "other.json").string());
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    robot.key(key_escape);
    CHECK_FALSE(app.dialog.showing);
    CHECK(read_bytes(other) == "something else");
    CHECK(app.session.document.file() == file);
  }
  SECTION("to a folder that is made first, if that is meant") {
    robot.type((folder / "new/folder/x").string());
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK(app.ui.widgets.contains("file question"));
    CHECK_FALSE(fs::exists(folder / "new"));
    CHECK(app.session.document.file() == file);
    robot.key(key_enter);
    CHECK_FALSE(app.dialog.showing);
    CHECK(speed_in(folder / "new/folder/x.flyball.json") == 5);
  }
  SECTION("a folder alone is made, and shown") {
    robot.type((folder / "plots/").string());
    robot.key(key_enter);
    CHECK(app.ui.widgets.contains("file question"));
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK(fs::is_directory(folder / "plots"));
    CHECK(app.panels->save.query().list.shown == folder / "plots");
    CHECK(app.panels->save.query().path.empty());
  }
  SECTION("to where nothing can be written") {
    robot.type((folder / "other.json/x").string()); // that is no folder
    robot.key(key_enter);
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK_THAT(app.panels->save.query().message, ContainsSubstring("other.json cannot be made"));
    CHECK(app.session.document.file() == file);
    CHECK(robot.speed_now() == 5);
    CHECK(app.session.document.unsaved());
    // Another name, and it goes on.
    robot.click("save/path");
    robot.key('A', true);
    robot.type("y");
    robot.key(key_enter);
    CHECK_FALSE(app.dialog.showing);
    CHECK(speed_in(folder / "y.flyball.json") == 5);
  }
  SECTION("its own file is no other") {
    robot.key(key_enter);
    CHECK_FALSE(app.dialog.showing);
    CHECK(speed_in(file) == 5);
  }
}

TEST_CASE("a file that cannot be written any more asks for another place") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "gone");
  const fs::path file = folder / "gone/governor.json";
  fs::copy_file(shipped_file("governor"), file);
  FileRobot robot(folder);
  robot.open(file);
  robot.set_speed(5);
  fs::remove_all(folder / "gone");
  robot.key('S', true);
  REQUIRE(robot.app.dialog.showing);
  CHECK_THAT(robot.app.panels->save.query().message, ContainsSubstring("governor.json was not saved"));
  CHECK(robot.app.session.document.unsaved());
}

TEST_CASE("leaving unsaved work is asked about") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder), other = governor_in(folder, "other.json");
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(file);
  robot.set_speed(5);
  enum class Way { fresh, open, quit };
  const Way way = GENERATE(Way::fresh, Way::open, Way::quit);
  const auto left = [&] {
    switch (way) {
    case Way::fresh: return app.session.document.file().empty();
    case Way::open: return app.session.document.file() == other;
    default: return app.quit;
    }
  };
  switch (way) {
  case Way::fresh: robot.key('N', true); break;
  case Way::open: robot.open(other); break; // as a file dropped on the window
  case Way::quit: robot.key('Q', true); break;
  }
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  REQUIRE(robot.shows("unsaved/save"));
  CHECK_FALSE(left());

  SECTION("cancel") {
    SECTION("by its button") {
      robot.click("unsaved/cancel");
    }
    SECTION("by Escape") {
      robot.key(key_escape);
    }
    CHECK_FALSE(left());
    CHECK(robot.speed_now() == 5);
    CHECK(app.session.document.unsaved());
    // Saving later does not go on with what was given up.
    robot.key('S', true);
    CHECK_FALSE(left());
  }
  SECTION("save") {
    SECTION("by its button") {
      robot.click("unsaved/save");
    }
    SECTION("by Enter") {
      robot.key(key_enter);
    }
    CHECK(left());
    CHECK(speed_in(file) == 5);
  }
  SECTION("don't save") {
    SECTION("by its button") {
      robot.click("unsaved/discard");
    }
    SECTION("by the keys") {
      robot.key(key_right);
      robot.key(key_enter);
    }
    CHECK(left());
    CHECK(speed_in(file) == 11.0174);
  }
  CHECK_FALSE(app.dialog.showing);
}

TEST_CASE("an untitled document can be saved on the way out, or not after all") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  robot.key('N', true);
  edit(app.session, "Add", [](Mechanism& m, Selection&) { m.bodies.push_back(test::body("ball")); });
  robot.key('Q', true);
  robot.click("unsaved/save");
  robot.frames(2);
  REQUIRE(robot.shows("save/path"));
  CHECK_FALSE(app.quit);
  SECTION("saved") {
    robot.type((folder / "last.json").string());
    robot.key(key_enter);
    CHECK(app.quit);
    CHECK(fs::exists(folder / "last.json"));
  }
  SECTION("not after all") {
    robot.click("save/cancel");
    CHECK_FALSE(app.quit);
    CHECK(app.session.document.unsaved());
    show_save_dialog(app);
    robot.frames(2);
    robot.type((folder / "later.json").string());
    robot.key(key_enter);
    CHECK(fs::exists(folder / "later.json"));
    CHECK_FALSE(app.quit);
  }
}

TEST_CASE("without a state folder the program writes nothing that was not asked for") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  Robot robot;
  open_file(robot.app, file);
  ++robot.app.session.gesture;
  change_parameter(robot.app.session, speed, 5);
  for (int i = 0; i < 40; ++i)
    update_files(robot.app.session, 0.25);
  robot.app.session.files.autosave.wait();
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("an example is never overwritten by saving") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  const fs::path copy = folder / "scenes";
  fs::create_directory(copy);
  fs::copy_file(shipped_file("governor"), copy / "governor.json");
  app.session.options.scenes = copy;
  robot.open(copy / "governor.json");
  robot.set_speed(5);
  const std::string before = read_bytes(copy / "governor.json");
  robot.key('S', true);
  robot.frames(2);
  CHECK(app.dialog.showing);
  CHECK(robot.shows("save/save"));
  CHECK(read_bytes(copy / "governor.json") == before);
  CHECK(app.session.document.unsaved());
}
