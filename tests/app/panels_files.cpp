// Documents and files as a person meets them: new, open, save, questions, crashes, and what others do to a
// file.
#include "robot.hpp"
#include "temporary_folder.hpp"

#include "app/document/autosave.hpp"
#include "app/panels/file_commands.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <set>

using namespace flyball;
using namespace flyball::test;
namespace fs = std::filesystem;

namespace {

constexpr const char* speed = "joints.spin.drive.speed";
constexpr int key_down = 264, key_right = 262;

// A program that ended without saying goodbye: its name is no running process.
constexpr const char* crashed = "another machine:1:1";

// The program with a state folder, and time that passes when it is told to.
class FileRobot : public Robot {
 public:
  explicit FileRobot(const TemporaryFolder& folder, const char* owner = nullptr) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyMap[ImGuiKey_DownArrow] = key_down;
    io.KeyMap[ImGuiKey_RightArrow] = key_right;
    app.options.state = folder / "state";
    if (owner) app.files.owner = owner;
    begin_files(app);
    frames(3);
  }
  void pass(double seconds) {
    for (double t = 0; t < seconds; t += 0.25) {
      update_files(app, 0.25);
      app.files.autosave.wait();
    }
    frames(3);
  }
  void set_speed(double value) {
    ++app.gesture;
    change_parameter(app, speed, value);
    frames(1);
  }
  double speed_now() const { return get_parameter(app.mechanism(), speed); }
  bool shows(const std::string& widget) const { return app.widgets.contains(widget); }
  void open(const fs::path& file) {
    open_file(app, file);
    frames(3);
  }
};

fs::path governor_in(const TemporaryFolder& folder, const char* name = "governor.json") {
  fs::copy_file(FLYBALL_ASSETS "/scenes/governor.json", folder / name);
  return folder / name;
}

Body a_body(const char* name) {
  Body body;
  body.name = name;
  body.mass = 1;
  return body;
}

double speed_in(const fs::path& file) {
  return get_parameter(parse_scene(read_bytes(file)), speed);
}

void set_speed_in(const fs::path& file, double value) {
  Mechanism mechanism = parse_scene(read_bytes(file));
  set_parameter(mechanism, speed, value);
  save_scene(mechanism, file);
}

// Of hidden files in the folder, those that end so.
std::size_t hidden(const TemporaryFolder& folder, const std::string& end) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    count += name.starts_with('.') && name.ends_with(end) ? 1 : 0;
  }
  return count;
}

} // namespace

TEST_CASE("a new document is built, saved where it is told, and saved again at once") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  robot.key('N', true);
  CHECK_FALSE(app.dialog.showing); // nothing would be lost
  CHECK(app.mechanism() == Document::empty_mechanism());
  CHECK(document_name(app) == "Untitled");
  edit(app, "Add", [](Mechanism& m, Selection&) { m.bodies.push_back(a_body("ball")); });
  CHECK(app.document.unsaved());

  robot.key('S', true);
  REQUIRE(app.dialog.showing);
  robot.type((folder / "new_arm").string());
  robot.key(key_enter);
  REQUIRE_FALSE(app.dialog.showing);
  const fs::path file = folder / "new_arm.json";
  REQUIRE(fs::exists(file));
  CHECK(app.document.file() == file);
  CHECK_FALSE(app.document.unsaved());
  CHECK(app.notice == "Saved new_arm.json");
  CHECK(app.mechanism().name == "New arm");
  CHECK(document_name(app) == "new_arm.json");
  // Unfinished as it is: the ball hangs on nothing.
  CHECK(parse_scene(read_bytes(file)) == app.mechanism());
  CHECK_FALSE(app.mistakes.empty());
  CHECK(recent_files(app).front() == file);

  edit(app, "Mass", [](Mechanism& m, Selection&) { m.bodies[0].mass = 2; });
  robot.key('S', true);
  CHECK_FALSE(app.dialog.showing);
  CHECK(parse_scene(read_bytes(file)).bodies[0].mass == 2);
  robot.key('Z', true);
  CHECK(app.document.unsaved()); // the file holds the edit
  CHECK(parse_scene(read_bytes(file)).bodies[0].mass == 2);
  robot.key('S', true);
  CHECK(parse_scene(read_bytes(file)).bodies[0].mass == 1);
  CHECK_FALSE(app.document.unsaved());

  SECTION("and opens again, unfinished as it is") {
    robot.key('N', true);
    robot.open(file);
    CHECK(app.problem.empty());
    CHECK(app.mechanism().bodies.size() == 1);
    CHECK_FALSE(app.mistakes.empty());
  }
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
  CHECK(app.dialog.path == "governor.json");

  SECTION("asked twice, then replaced") {
    robot.click("save/other.json"); // from the list
    robot.click("save/save");
    CHECK(app.dialog.showing);
    CHECK(read_bytes(other) == "something else");
    robot.click("save/save");
    CHECK_FALSE(app.dialog.showing);
    CHECK(speed_in(other) == 5);
    CHECK(app.document.file() == other);
    CHECK(speed_in(file) == 11.0174);
  }
  SECTION("given up") {
    robot.type((folder / "other.json").string());
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    robot.key(key_escape);
    CHECK_FALSE(app.dialog.showing);
    CHECK(read_bytes(other) == "something else");
    CHECK(app.document.file() == file);
  }
  SECTION("to where nothing can be written") {
    robot.type((folder / "no such folder/x").string());
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK_THAT(app.files.message, ContainsSubstring("x.json was not saved"));
    CHECK(app.document.file() == file);
    CHECK(robot.speed_now() == 5);
    CHECK(app.document.unsaved());
    // Another name, and it goes on.
    robot.click("save/path");
    robot.key('A', true);
    robot.type("y");
    robot.key(key_enter);
    CHECK_FALSE(app.dialog.showing);
    CHECK(speed_in(folder / "y.json") == 5);
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
  fs::copy_file(FLYBALL_ASSETS "/scenes/governor.json", file);
  FileRobot robot(folder);
  robot.open(file);
  robot.set_speed(5);
  fs::remove_all(folder / "gone");
  robot.key('S', true);
  REQUIRE(robot.app.dialog.showing);
  CHECK_THAT(robot.app.files.message, ContainsSubstring("governor.json was not saved"));
  CHECK(robot.app.document.unsaved());
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
    case Way::fresh: return app.document.file().empty();
    case Way::open: return app.document.file() == other;
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
    CHECK(app.document.unsaved());
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
  edit(app, "Add", [](Mechanism& m, Selection&) { m.bodies.push_back(a_body("ball")); });
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
    CHECK(app.document.unsaved());
    show_save_dialog(app);
    robot.frames(2);
    robot.type((folder / "later.json").string());
    robot.key(key_enter);
    CHECK(fs::exists(folder / "later.json"));
    CHECK_FALSE(app.quit);
  }
}

TEST_CASE("unsaved work is kept beside the file while it lasts") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(file);
  robot.pass(3);
  CHECK(hidden(folder, "-autosave") == 0);
  robot.set_speed(5);
  robot.pass(2);
  REQUIRE(hidden(folder, "-autosave") == 1);
  CHECK(get_parameter(parse_scene(parse_autosave(read_bytes(app.files.autosave.path())).scene), speed) == 5);
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
    CHECK(app.document.file().empty());
  }
  CHECK(hidden(folder, "-autosave") == 0);
}

TEST_CASE("an opening that fails keeps the work and its autosave") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  robot.open(file);
  robot.set_speed(5);
  robot.pass(2);
  write_bytes(folder / "broken.json", "no scene");
  robot.open(folder / "broken.json");
  robot.click("unsaved/discard");
  robot.frames(2);
  CHECK_THAT(robot.app.problem, ContainsSubstring("broken.json"));
  CHECK(robot.app.document.file() == file);
  CHECK(robot.speed_now() == 5);
  CHECK(hidden(folder, "-autosave") == 1);
  CHECK(recent_files(robot.app).front() == file);
}

TEST_CASE("work that a crash has left is offered when its file is opened") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  {
    FileRobot robot(folder, crashed);
    robot.open(file);
    robot.set_speed(5);
    robot.pass(2);
  }
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
    CHECK(app.document.file() == file);
    CHECK(app.document.unsaved());
    CHECK(speed_in(file) == 11.0174);
    CHECK(app.answer.solution.status == Status::converged);
    CHECK(hidden(folder, "-autosave") == 1); // safe from the next crash at once
    robot.pass(2);
    CHECK(find_leftovers(file, app.options.state).empty()); // it is this program's now
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
    const Leftover leftover = app.files.leftovers.at(0);
    fs::remove(leftover.path);
    robot.click("recover/recover");
    CHECK(robot.speed_now() == 11.0174);
    CHECK_THAT(app.notice, ContainsSubstring("no longer there"));
  }
}

TEST_CASE("recovering over a file that has changed since, or is gone") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  {
    FileRobot robot(folder, crashed);
    robot.open(file);
    robot.set_speed(5);
    robot.pass(2);
  }
  const bool gone = GENERATE(false, true);
  if (gone)
    fs::remove(file);
  else
    set_speed_in(file, 8);
  FileRobot robot(folder);
  App& app = robot.app;
  // A file that is gone is no recent one: whoever asks for it by name is offered what is left.
  app.files.leftovers = find_leftovers(file, app.options.state);
  REQUIRE(app.files.leftovers.size() == 1);
  CHECK(app.files.leftovers[0].outdated);
  recover(app, Leftover(app.files.leftovers[0]));
  CHECK(robot.speed_now() == 5);
  CHECK(app.document.file() == file);
  CHECK(app.document.unsaved());
  undo(app);
  if (gone)
    CHECK(app.mechanism().bodies.empty());
  else
    CHECK(robot.speed_now() == 8);
}

TEST_CASE("untitled work that a crash has left is offered at the next start") {
  const TemporaryFolder folder;
  for (const char* name : {"ball", "block"}) {
    FileRobot robot(folder, crashed);
    robot.app.files.leftovers.clear();
    robot.key(key_escape);
    robot.key('N', true);
    edit(robot.app, "Add", [&](Mechanism& m, Selection&) {
      m.name = name;
      m.bodies.push_back(a_body(name));
    });
    robot.pass(2);
  }
  FileRobot robot(folder);
  App& app = robot.app;
  REQUIRE(app.files.leftovers.size() == 2);
  robot.click("recover/1");
  const std::string wanted = app.files.leftovers[1].autosave.name;
  robot.click("recover/recover");
  CHECK(app.mechanism().bodies.at(0).name == wanted);
  CHECK(app.document.file().empty());
  CHECK(app.document.unsaved());
  robot.pass(2);
  CHECK(find_leftovers({}, app.options.state).size() == 1); // the other one, for later
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

TEST_CASE("a file that changes on disk is read again where nothing is unsaved") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(file);
  robot.pass(3);
  select(app, {{{PartKind::body, "ball1"}}});
  const ViewCamera camera = app.view.camera;
  SECTION("a scene") {
    set_speed_in(file, 8);
    robot.pass(3);
    CHECK(robot.speed_now() == 8);
    CHECK_THAT(app.notice, ContainsSubstring("Reloaded governor.json"));
    CHECK_FALSE(app.document.unsaved());
    CHECK(app.selection().has(Part{PartKind::body, "ball1"}));
    CHECK(app.view.camera.eye() == camera.eye());
    CHECK(app.answer.solution.status == Status::converged);
    robot.key('Z', true);
    CHECK(robot.speed_now() == 11.0174);
    CHECK(app.document.unsaved());
  }
  SECTION("no scene: the open one stays") {
    write_bytes(file, "{\"flyball\": 1");
    robot.pass(3);
    CHECK(robot.speed_now() == 11.0174);
    CHECK_THAT(app.notice, ContainsSubstring("cannot be read"));
  }
  SECTION("the same again: nothing happens") {
    app.notice.clear();
    write_bytes(file, read_bytes(file));
    robot.pass(3);
    CHECK(app.notice.empty());
    CHECK(app.document.steps().size() == 1);
  }
  SECTION("its own saving is no change") {
    robot.set_speed(9);
    robot.key('S', true);
    robot.pass(3);
    CHECK(app.notice == "Saved governor.json");
  }
}

TEST_CASE("a file that changes on disk while there are unsaved edits is asked about") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(file);
  robot.set_speed(5);
  set_speed_in(file, 8);

  SECTION("noticed by looking") {
    robot.pass(3);
    REQUIRE(robot.shows("banner/keep"));
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
      CHECK_FALSE(app.document.unsaved());
      robot.key('Z', true);
      CHECK(robot.speed_now() == 5); // nothing is lost
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
    CHECK_FALSE(app.document.unsaved());
  }
}

TEST_CASE("a file that vanishes is told once, and its document is not lost") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  App& app = robot.app;
  robot.open(file);
  robot.pass(3);
  fs::remove(file);
  robot.pass(3);
  CHECK_THAT(app.notice, ContainsSubstring("no longer on disk"));
  app.notice.clear();
  robot.pass(5);
  CHECK(app.notice.empty());
  CHECK(has_unsaved_work(app));
  robot.key('Q', true);
  CHECK_FALSE(app.quit);
  robot.click("unsaved/save");
  CHECK(app.quit);
  CHECK(speed_in(file) == 11.0174);
}

TEST_CASE("reloading by hand can be undone") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot(folder);
  robot.open(file);
  robot.set_speed(5);
  robot.key('R', true);
  CHECK(robot.speed_now() == 11.0174);
  CHECK_FALSE(robot.app.document.unsaved());
  robot.key('Z', true);
  CHECK(robot.speed_now() == 5);
}

TEST_CASE("recent files are offered by the open dialog and survive the program") {
  const TemporaryFolder folder;
  const fs::path first = governor_in(folder, "first.json"), second = governor_in(folder, "second.json");
  {
    FileRobot robot(folder);
    CHECK(recent_files(robot.app).empty()); // what the program opens by itself does not count
    robot.open(first);
    robot.open(second);
  }
  FileRobot robot(folder);
  CHECK(recent_files(robot.app) == std::vector<fs::path>{second, first});
  robot.key('O', true);
  robot.frames(2);
  robot.click("open/recent/1");
  CHECK_FALSE(robot.app.dialog.showing);
  CHECK(robot.app.document.file() == first);
  CHECK(recent_files(robot.app).front() == first);
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
    CHECK(app.document.file() == other);
  }
  SECTION("arrow keys, into a folder") {
    robot.key(key_down);
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK(robot.shows("open/deep.json"));
    robot.key(key_down);
    robot.key(key_enter);
    CHECK(app.document.file() == folder / "inner/deep.json");
  }
  SECTION("a folder and back up, with the mouse") {
    robot.click("open/inner");
    CHECK(robot.shows("open/deep.json"));
    robot.click("open/up");
    CHECK(robot.shows("open/inner"));
    robot.click("open/resting.json");
    CHECK(app.document.file() == other);
  }
  SECTION("a path") {
    robot.type((folder / "inner/deep.json").string());
    robot.key(key_enter);
    CHECK(app.document.file() == folder / "inner/deep.json");
  }
  SECTION("a path that leads nowhere") {
    robot.type((folder / "inner/none.json").string());
    robot.key(key_enter);
    CHECK(app.dialog.showing);
    CHECK_THAT(app.files.message, ContainsSubstring("There is no"));
    CHECK(app.document.file() == here);
  }
  SECTION("Escape") {
    robot.key(key_escape);
    CHECK_FALSE(app.dialog.showing);
    CHECK(app.document.file() == here);
  }
}

TEST_CASE("the gallery shows pictures of the examples and opens one") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  show_gallery(app);
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  const auto& cards = app.files.gallery.cards;
  std::size_t shipped = 0;
  for (const auto& entry : fs::directory_iterator(app.options.scenes))
    shipped += entry.path().extension() == ".json" ? 1 : 0;
  CHECK(cards.size() == shipped);
  std::set<unsigned> pictures;
  for (const SceneCard& card : cards) {
    pictures.insert(card.picture);
    CHECK_FALSE(card.about.empty());
  }
  CHECK(pictures.size() == shipped);
  CHECK_FALSE(pictures.contains(0));
  CHECK_FALSE(app.files.gallery.drawing);

  SECTION("with the mouse") {
    robot.click("gallery/" + cards[1].file.filename().string());
    CHECK_FALSE(app.dialog.showing);
    CHECK(app.document.file() == app.files.gallery.cards[1].file);
    CHECK(app.answer.solution.status == Status::converged);
  }
  SECTION("with the keys") {
    robot.key(key_right);
    robot.key(key_right);
    robot.key(key_enter);
    CHECK_FALSE(app.dialog.showing);
    CHECK(app.document.file() == app.files.gallery.cards[2].file);
  }
  SECTION("asking first") {
    robot.key(key_escape);
    robot.set_speed(5);
    show_gallery(app);
    robot.frames(2);
    robot.click("gallery/" + cards[0].file.filename().string());
    robot.frames(2);
    REQUIRE(robot.shows("unsaved/discard"));
    CHECK(robot.speed_now() == 5);
    robot.click("unsaved/discard");
    CHECK(app.document.file() == app.files.gallery.cards[0].file);
  }
}

TEST_CASE("the gallery opens at once, its pictures come one a frame and again in other colours") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  app.options.mode = LiveSolver::Mode::background; // a person's window
  show_gallery(app);
  const auto drawn = [&] {
    return std::ranges::count_if(app.files.gallery.cards,
                                 [](const SceneCard& card) { return card.picture != 0; });
  };
  const auto count = static_cast<std::ptrdiff_t>(app.files.gallery.cards.size());
  for (std::ptrdiff_t i = 1; i <= count; ++i) {
    robot.frames(1);
    CHECK(drawn() == i);
    CHECK(app.files.gallery.drawing == (i < count));
  }
  app.theme = Theme::dark;
  robot.frames(1);
  CHECK(drawn() == 1);
  robot.frames(static_cast<int>(count));
  CHECK(drawn() == count);
}

TEST_CASE("without a state folder the program writes nothing that was not asked for") {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  Robot robot;
  open_file(robot.app, file);
  ++robot.app.gesture;
  change_parameter(robot.app, speed, 5);
  for (int i = 0; i < 40; ++i)
    update_files(robot.app, 0.25);
  robot.app.files.autosave.wait();
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("an example is never overwritten by saving") {
  const TemporaryFolder folder;
  FileRobot robot(folder);
  App& app = robot.app;
  const fs::path copy = folder / "scenes";
  fs::create_directory(copy);
  fs::copy_file(FLYBALL_ASSETS "/scenes/governor.json", copy / "governor.json");
  app.options.scenes = copy;
  robot.open(copy / "governor.json");
  robot.set_speed(5);
  const std::string before = read_bytes(copy / "governor.json");
  robot.key('S', true);
  robot.frames(2);
  CHECK(app.dialog.showing);
  CHECK(robot.shows("save/save"));
  CHECK(read_bytes(copy / "governor.json") == before);
  CHECK(app.document.unsaved());
}
