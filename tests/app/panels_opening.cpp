// The open dialog, recent files and the gallery of examples.
#include "app/session/examples.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "file_robot.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <fstream>
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

  // With the mouse.
  robot.click("gallery/" + cards[1].file.filename().string());
  CHECK_FALSE(app.dialog.showing);
  CHECK(app.session.document.file() == app.panels->gallery.cards()[1].file);
  CHECK(app.session.answer.solution.status == Status::converged);

  // With the keys.
  app.commands.run("file.examples");
  robot.frames(2);
  robot.key(key_right);
  robot.key(key_right);
  robot.key(key_enter);
  CHECK_FALSE(app.dialog.showing);
  CHECK(app.session.document.file() == app.panels->gallery.cards()[2].file);

  // Unsaved work is asked about first.
  robot.open(shipped_file("governor"));
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

namespace {

struct GalleryRobot : FileRobot {
  explicit GalleryRobot(const TemporaryFolder& folder, PixelSize window = {1000, 700}) : FileRobot(folder) {
    size = window;
    imgui_compat::map_key(ImGuiKey_UpArrow, key_up);
    imgui_compat::map_key(ImGuiKey_LeftArrow, key_left);
    imgui_compat::map_key(ImGuiKey_Backspace, key_backspace);
    open_gallery();
  }
  // Again and again by one robot: its pictures, which are kept, take most of the time.
  void open_gallery() {
    if (app.dialog.showing) key(key_escape);
    app.commands.run("file.examples");
    frames(3);
    REQUIRE(app.dialog.showing);
  }
  static constexpr int key_up = 265, key_left = 263, key_backspace = 259;

  const std::vector<SceneCard>& cards() { return app.panels->gallery.cards(); }
  // Those that are in sight.
  std::vector<std::string> shown() {
    std::vector<std::string> names;
    for (const SceneCard& card : cards())
      if (app.ui.widgets.contains("gallery/" + card.file.filename().string()))
        names.push_back(card.file.stem().string());
    return names;
  }
  std::vector<std::string> search(const std::string& text) {
    type(text);
    frames(2);
    return shown();
  }
  std::string opened() const { return app.session.document.file().stem().string(); }
};

} // namespace

TEST_CASE("the gallery's examples are in groups, and every one is in a group") {
  const TemporaryFolder folder;
  GalleryRobot robot(folder);
  std::vector<std::string> groups;
  for (const SceneCard& card : robot.cards()) {
    INFO(card.file);
    CHECK(card.group != "Others"); // assets/scenes/groups.txt does not name it
    if (groups.empty() || groups.back() != card.group) groups.push_back(card.group);
  }
  CHECK(groups.front() == "First steps");
  CHECK(std::set<std::string>(groups.begin(), groups.end()).size() == groups.size());
  CHECK(groups.size() >= 8);
  const auto group_of = [&](const std::string& scene) {
    const auto& cards = robot.cards();
    const auto found =
        std::ranges::find(cards, scene, [](const SceneCard& card) { return card.file.stem().string(); });
    return found == cards.end() ? std::string() : found->group;
  };
  CHECK(group_of("governor_porter") == "Governors");
  CHECK(group_of("free_top") == "Gyros and tops");
  CHECK(group_of("differential") == "Gears and belts");
  CHECK(group_of("rotor_oil_whip") == "Rotors on bearings");
}

TEST_CASE("what groups.txt does not name is shown last, and without it nothing is grouped") {
  const TemporaryFolder folder, scenes;
  for (const char* name : {"governor", "free_top", "pendulum"})
    fs::copy_file(shipped_file(name), scenes / (std::string(name) + ".json"));
  std::ofstream(scenes / "broken.json") << "{";
  const auto read = [&] {
    std::vector<std::pair<std::string, std::string>> found;
    for (const Example& example : read_examples(scenes.path()))
      found.emplace_back(example.file.stem().string(), example.group);
    return found;
  };
  using Found = std::vector<std::pair<std::string, std::string>>;
  CHECK(read() == Found{{"free_top", ""}, {"governor", ""}, {"pendulum", ""}});
  std::ofstream(scenes / "groups.txt") << "# a remark\n\nTops and more\r\n  pendulum\r\n  gone\n  free_top\n";
  CHECK(read() ==
        Found{{"pendulum", "Tops and more"}, {"free_top", "Tops and more"}, {"governor", "Others"}});
}

TEST_CASE("the gallery finds examples by their titles, descriptions and parts as one types") {
  const TemporaryFolder folder;
  GalleryRobot robot(folder, {1000, 3000}); // all are in sight
  using Names = std::vector<std::string>;
  const Names all = robot.shown();
  REQUIRE(all.size() == robot.cards().size());

  const auto found = [&](const std::string& text) {
    robot.open_gallery();
    return robot.search(text);
  };

  CHECK(found("PORTER") == Names{"governor_porter", "governor_proell", "governor_friction"}); // of titles
  CHECK(robot.search(" fric") == Names{"governor_friction"});
  CHECK(found("striking") == Names{"fan_governor"}); // of its description: "The fly of a striking clock"
  CHECK(robot.search("x").empty());                  // the inside of a word is not found
  CHECK(found("top ").size() < all.size() / 2);      // not every stop
  CHECK(found("pulley") == Names{"fan_governor"});   // a part, in no title and no description
  CHECK(found("linkages") == Names{"ball_on_string", "chain20", "fourbar_turntable"}); // a group

  // The first that is found is chosen, and Enter opens it.
  CHECK(found("gear backlash") == Names{"gear_train"});
  robot.key(key_enter);
  CHECK_FALSE(robot.app.dialog.showing);
  CHECK(robot.opened() == "gear_train");

  // Arrows go through what is found.
  REQUIRE(found("belts") == Names{"gear_train", "differential", "fan_governor"}); // by the group, by the belt
  robot.key(key_right);
  robot.key(key_right);
  robot.key(key_enter);
  CHECK(robot.opened() == "fan_governor");

  // Titles are found before groups, descriptions and parts, whatever was chosen by the letters before.
  for (const auto& [text, scene] : {std::pair{"engine", "governor_engine"}, {"top", "free_top"}}) {
    REQUIRE(found(text).size() > 1);
    robot.key(key_enter);
    CHECK(robot.opened() == scene);
  }

  // Nothing is found: it is told, and Enter opens nothing.
  CHECK(found("zeppelin").empty());
  robot.key(key_enter);
  CHECK(robot.app.dialog.showing);
  for (int i = 0; i < 8; ++i)
    robot.key(GalleryRobot::key_backspace);
  CHECK(robot.shown() == all);
  robot.search("windmill");
  robot.key(key_enter);
  CHECK(robot.opened() == "windmill");

  // What was searched for is forgotten when it opens again.
  CHECK(found("windmill") == Names{"windmill"});
  robot.open_gallery();
  CHECK(robot.shown() == all);
}

TEST_CASE("the gallery's arrows keep the column from group to group, and the chosen card comes into sight") {
  const TemporaryFolder folder;
  const PixelSize window = GENERATE(PixelSize{800, 600}, PixelSize{1280, 720});
  GalleryRobot robot(folder, window);
  const auto rect = [&](std::size_t i) {
    return robot.widget("gallery/" + robot.cards()[i].file.filename().string());
  };
  const auto count = robot.cards().size();
  // Three in the first group, so in one row: the middle one, one row down, and back.
  REQUIRE(robot.cards()[3].group != robot.cards()[0].group);
  const auto go_to_fifth = [&] {
    REQUIRE(rect(0).from.y == rect(2).from.y);
    robot.key(key_right);
    robot.key(key_down);
    robot.key(GalleryRobot::key_up);
    robot.key(key_down);
  };
  go_to_fifth();
  CHECK(rect(4).from.x == rect(1).from.x);
  robot.key(key_enter);
  CHECK(robot.opened() == robot.cards()[4].file.stem());

  robot.open_gallery();
  go_to_fifth();
  for (std::size_t i = 0; i < count; ++i)
    robot.key(key_down);
  robot.key(key_right);
  robot.key(key_right);
  robot.frames(2);
  CHECK(rect(count - 1).to.y < static_cast<float>(robot.size.height));
  CHECK(rect(count - 1).to.y - rect(count - 1).from.y > 150);
  robot.key(key_enter);
  CHECK(robot.opened() == robot.cards()[count - 1].file.stem());

  robot.open_gallery(); // by the mouse
  go_to_fifth();
  robot.wheel("gallery/" + robot.cards()[0].file.filename().string(), -3);
  CHECK(rect(5).to.y < static_cast<float>(robot.size.height));
  robot.click("gallery/" + robot.cards()[5].file.filename().string());
  CHECK(robot.opened() == robot.cards()[5].file.stem());
}

TEST_CASE("the gallery's search has the keys again after a click beside it, and Tab goes on to the buttons") {
  const TemporaryFolder folder;
  GalleryRobot robot(folder);
  const WidgetRect field = robot.widget("gallery/search");
  robot.click(ImVec2(field.from.x + 5, field.from.y - 12)); // the dialog's title
  CHECK(robot.search("windmill") == std::vector<std::string>{"windmill"});
  robot.key(258); // Tab
  CHECK(has_keyboard(robot.app.ui, "gallery/cancel"));
  robot.key(key_enter);
  robot.frames(3);
  CHECK_FALSE(robot.app.dialog.showing);
  CHECK(robot.opened() != "windmill");
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
