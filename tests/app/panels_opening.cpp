// The open dialog, recent files and the gallery of examples.
#include "app/ui/panel_list.hpp"
#include "file_robot.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <set>
#include <string>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("recent files are offered by the open dialog and survive the program") {
  const TemporaryFolder folder;
  const fs::path first = governor_in(folder, "first.json"), second = governor_in(folder, "second.json");
  {
    FileRobot robot(folder);
    CHECK(robot.app.session.files.recent.empty()); // what the program opens by itself does not count
    robot.open(first);
    robot.open(second);
  }
  FileRobot robot(folder);
  CHECK(robot.app.session.files.recent == std::vector<fs::path>{second, first});
  robot.key('O', true);
  robot.frames(2);
  robot.click("open/recent/1");
  CHECK_FALSE(robot.app.dialog.showing);
  CHECK(robot.app.session.document.file() == first);
  CHECK(robot.app.session.files.recent.front() == first);
}

TEST_CASE("the open dialog finds files by part of a name and by path") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "inner");
  const fs::path here = governor_in(folder, "spinning.json"), other = governor_in(folder, "resting.json");
  fs::copy_file(here, folder / "inner/deep.json");
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(here);
  robot.key('O', true);
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  CHECK(robot.shows("open/resting.json"));
  CHECK(robot.shows("open/inner"));
  SECTION("part of a name") {
    robot.type("REST");
    robot.frames(1);
    CHECK_FALSE(robot.shows("open/spinning.json"));
    robot.key(key_enter);
    CHECK(app.session.document.file() == other);
  }
  SECTION("arrow keys, into a folder") {
    robot.key(key_down);
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK(robot.shows("open/deep.json"));
    robot.key(key_down);
    robot.key(key_enter);
    CHECK(app.session.document.file() == folder / "inner/deep.json");
  }
  SECTION("a folder and back up, with the mouse") {
    robot.click("open/inner");
    CHECK(robot.shows("open/deep.json"));
    robot.click("open/up");
    CHECK(robot.shows("open/inner"));
    robot.click("open/resting.json");
    CHECK(app.session.document.file() == other);
  }
  SECTION("a path") {
    robot.type((folder / "inner/deep.json").string());
    robot.key(key_enter);
    CHECK(app.session.document.file() == folder / "inner/deep.json");
  }
  SECTION("a path that leads nowhere") {
    robot.type((folder / "inner/none.json").string());
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK_THAT(app.panels->open.query().message, ContainsSubstring("There is no"));
    CHECK(app.session.document.file() == here);
  }
  SECTION("Escape") {
    robot.key(key_escape);
    CHECK_FALSE(app.dialog.showing);
    CHECK(app.session.document.file() == here);
  }
}

TEST_CASE("the gallery shows pictures of the examples and opens one") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  app.commands.run("file.examples");
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  const auto& cards = app.panels->gallery.cards();
  std::size_t shipped = 0;
  for (const auto& entry : fs::directory_iterator(app.session.options.scenes))
    shipped += entry.path().extension() == ".json" ? 1 : 0;
  CHECK(cards.size() == shipped);
  std::set<unsigned> pictures;
  std::set<std::string> names;
  for (const SceneCard& card : cards) {
    INFO(card.about);
    pictures.insert(card.picture);
    names.insert(card.mechanism.name);
    CHECK(card.about.size() > 20); // no initial
  }
  CHECK(names.size() == shipped);
  CHECK(pictures.size() == shipped);
  CHECK_FALSE(pictures.contains(0));
  CHECK_FALSE(app.panels->gallery.drawing);

  SECTION("with the mouse") {
    robot.click("gallery/" + cards[1].file.filename().string());
    CHECK_FALSE(app.dialog.showing);
    CHECK(app.session.document.file() == app.panels->gallery.cards()[1].file);
    CHECK(app.session.answer.solution.status == Status::converged);
  }
  SECTION("with the keys") {
    robot.key(key_right);
    robot.key(key_right);
    robot.key(key_enter);
    CHECK_FALSE(app.dialog.showing);
    CHECK(app.session.document.file() == app.panels->gallery.cards()[2].file);
  }
  SECTION("asking first") {
    robot.key(key_escape);
    robot.set_speed(5);
    app.commands.run("file.examples");
    robot.frames(2);
    robot.click("gallery/" + cards[0].file.filename().string());
    robot.frames(2);
    REQUIRE(robot.shows("unsaved/discard"));
    CHECK(robot.speed_now() == 5);
    robot.click("unsaved/discard");
    CHECK(app.session.document.file() == app.panels->gallery.cards()[0].file);
  }
}

TEST_CASE("the gallery opens at once, its pictures come one a frame and again in other colours") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  app.session.options.mode = LiveSolver::Mode::background; // a person's window
  app.commands.run("file.examples");
  const auto drawn = [&] {
    return std::ranges::count_if(app.panels->gallery.cards(),
                                 [](const SceneCard& card) { return card.picture != 0; });
  };
  const auto count = static_cast<std::ptrdiff_t>(app.panels->gallery.cards().size());
  for (std::ptrdiff_t i = 1; i <= count; ++i) {
    robot.frames(1);
    CHECK(drawn() == i);
    CHECK(app.panels->gallery.drawing == (i < count));
  }
  app.ui.theme = Theme::dark;
  robot.frames(1);
  CHECK(drawn() == 1);
  robot.frames(static_cast<int>(count));
  CHECK(drawn() == count);
}
