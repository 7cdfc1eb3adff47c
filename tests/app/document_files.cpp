// Recent files, a watched file, and what is kept of unsaved work.
#include "app/document/autosave.hpp"
#include "app/document/autosaver.hpp"
#include "app/document/file_watch.hpp"
#include "app/document/kept_beside.hpp"
#include "app/document/recent_files.hpp"
#include "app/platform/change_watch.hpp"
#include "app/platform/process.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <future>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace flyball;
using namespace flyball::test;
using flyball::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

// A process that has ended: of it leftovers are found, as of one that crashed.
std::string dead_process() {
  const pid_t child = ::fork();
  if (child == 0) {
    ::pause();
    ::_exit(0);
  }
  const std::string here = this_process();
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  return here.substr(0, here.find(':')) + ":" + std::to_string(child) + ":1";
}

Document edited(const fs::path& file) {
  Document document(shipped("governor"), file);
  Mechanism next = document.mechanism();
  next.bodies[0].mass = 123;
  document.edit("Set mass", std::move(next), {});
  return document;
}

// As the window's loop does it, with waiting for what is written.
void run(Autosaver& autosaver, const Document& document, const AutosaveSettings& settings, double seconds) {
  for (double t = 0; t < seconds; t += 0.25) {
    autosaver.tick(document, document.unsaved(), 7, settings, 0.25);
    autosaver.wait();
  }
}

std::size_t files_in(const fs::path& folder) {
  std::error_code none;
  std::size_t count = 0;
  for (fs::recursive_directory_iterator it(folder, none), end; it != end; ++it)
    count += it->is_regular_file() ? 1 : 0;
  return count;
}

} // namespace

TEST_CASE("recent files are kept, the newest first, without those that are gone") {
  const TemporaryFolder folder;
  const fs::path state = folder / "state";
  CHECK(read_recent_files(state).empty());
  std::vector<fs::path> files;
  for (int i = 0; i < 12; ++i) {
    files.push_back(folder / ("scene " + std::to_string(i) + ".json"));
    std::ofstream(files.back()) << "{}";
    add_recent_file(state, files.back());
  }
  CHECK(add_recent_file(state, files[5]).front() == files[5]);
  std::vector<fs::path> kept = read_recent_files(state);
  REQUIRE(kept.size() == most_recent_files);
  CHECK(kept[0] == files[5]);
  CHECK(kept[1] == files[11]);
  CHECK(std::ranges::count(kept, files[5]) == 1);
  CHECK(std::ranges::find(kept, files[1]) == kept.end());

  fs::remove(files[11]);
  kept = read_recent_files(state);
  CHECK(kept.size() == most_recent_files - 1);
  CHECK(kept[1] == files[10]);

  std::ofstream(state / "recent.json") << "not a list";
  CHECK(read_recent_files(state).empty());
  CHECK(add_recent_file(state, files[3]).size() == 1);
}

TEST_CASE("a pipe in the place of the recent files is not waited for") {
  const TemporaryFolder folder;
  const fs::path state = folder / "state", file = folder / "scene.json";
  std::ofstream(file) << "{}";
  fs::create_directories(state);
  REQUIRE(::mkfifo((state / "recent.json").c_str(), 0600) == 0);
  auto added = std::async(std::launch::async, [&] {
    const bool none = read_recent_files(state).empty();
    return none ? add_recent_file(state, file) : std::vector<fs::path>();
  });
  CHECK(added.wait_for(std::chrono::seconds(5)) == std::future_status::ready);
  while (added.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) // lets it go
    ::close(::open((state / "recent.json").c_str(), O_RDWR | O_NONBLOCK));
  CHECK(added.get() == std::vector<fs::path>{file});
}

TEST_CASE("ways to one file are told to be the same") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "inner");
  fs::create_directory_symlink(folder / "inner", folder / "way");
  write_bytes(folder / "inner/scene.json", "{}");
  fs::create_symlink(folder / "inner/scene.json", folder / "other.json");
  const fs::path file = folder / "inner/scene.json";
  CHECK(resolved(file) == file);
  CHECK(resolved(folder / "way/scene.json") == file);
  CHECK(resolved(folder / "way/../inner/./scene.json") == file);
  CHECK(resolved(folder / "inner/../way/new.json") == folder / "inner/new.json");
  CHECK(resolved(folder / "other.json") == folder / "other.json"); // as the person calls it
  CHECK(resolved(folder / "way/") == folder / "inner");
  CHECK(resolved(folder / "way/..") == folder.path());
  CHECK(resolved("scene.json") == fs::current_path() / "scene.json");
}

TEST_CASE("a watched file tells of changes once, and not of its own") {
  const TemporaryFolder folder;
  const fs::path file = folder / "scene.json";
  write_bytes(file, "one");
  FileWatch watch(file, "one");
  const auto looks = [&](int count) {
    FileWatch::Look found;
    for (int i = 0; i < count; ++i)
      if (FileWatch::Look look = watch.look(); look.news != FileWatch::News::none) {
        CHECK(found.news == FileWatch::News::none);
        found = std::move(look);
      }
    return found;
  };
  CHECK(looks(4).news == FileWatch::News::none);
  CHECK_FALSE(watch.differs());

  SECTION("replaced by a file of the same size") {
    write_bytes(file, "two");
    CHECK(watch.differs());
    CHECK(watch.look().news == FileWatch::News::none); // it might still be written
    const FileWatch::Look look = looks(4);
    CHECK(look.news == FileWatch::News::changed);
    CHECK(look.text == "two");
    CHECK(watch.differs()); // until somebody takes it
    CHECK(watch.hash() == text_hash("one"));
    write_bytes(file, "one");
    CHECK(looks(4).news == FileWatch::News::none);
    CHECK_FALSE(watch.differs());
  }
  SECTION("changed before the first look") {
    watch = FileWatch(file, "an earlier text");
    CHECK(watch.differs());
    CHECK(looks(4).text == "one");
  }
  SECTION("touched") {
    fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::hours(1));
    CHECK_FALSE(watch.differs());
    CHECK(looks(4).news == FileWatch::News::none);
  }
  SECTION("written slowly") {
    std::ofstream out(file, std::ios::trunc);
    for (const char* part : {"th", "re", "e"}) {
      out << part << std::flush;
      CHECK(watch.look().news == FileWatch::News::none);
    }
    CHECK(looks(4).text == "three");
  }
  SECTION("gone, and back again") {
    fs::remove(file);
    CHECK(watch.look().news == FileWatch::News::none); // about to be written anew, perhaps
    CHECK(looks(4).news == FileWatch::News::vanished);
    CHECK(watch.vanished());
    write_bytes(file, "one");
    CHECK(looks(4).news == FileWatch::News::none);
    CHECK_FALSE(watch.vanished());
  }
}

TEST_CASE("what is kept beside files is not pushed out by one whose name is not UTF-8") {
  const TemporaryFolder folder;
  const fs::path other = folder / "g.json", odd = folder / "g\xE9.json";
  KeptBeside kept;
  keep_explored(kept, shipped("governor"), {{"joints.spin.drive.speed", 15}});
  keep_beside(folder.path(), other, kept);
  for (std::size_t i = 0; i < most_kept_beside; ++i) {
    kept.explored[0].value = 16 + static_cast<double>(i);
    keep_beside(folder.path(), odd, kept);
  }
  CHECK(read_beside(folder.path(), odd) == KeptBeside());
  REQUIRE(read_beside(folder.path(), other).explored.size() == 1);
  CHECK(read_beside(folder.path(), other).explored[0].value == 15);
}

TEST_CASE("a process is known to run, and to run no longer") {
  CHECK(is_running(this_process()));
  CHECK_FALSE(is_running(dead_process()));
  CHECK_FALSE(is_running(""));
  CHECK_FALSE(is_running("another machine:1:2"));
  const std::string here = this_process();
  // The number of a former process, taken by a new one.
  CHECK_FALSE(is_running(here.substr(0, here.rfind(':')) + ":3"));
}

TEST_CASE("an autosave reads back as it was") {
  const char* const file = GENERATE("/folder/with \"quotes\".json", "/folder/of Latin-1: \xe9.json");
  const Autosave autosave{.file = file,
                          .name = "Governor ω",
                          .based_on = 0xFFFF'FFFF'FFFF'FFFFU,
                          .owner = "here:1:2",
                          .made = 1'700'000'000,
                          .scene = "{\n \"flyball\": 1\n}\n",
                          .hues = {{"ball ω", 3}, {"arm", 11}}};
  const Autosave back = parse_autosave(write_autosave(autosave));
  CHECK(back.file == autosave.file);
  CHECK(back.name == autosave.name);
  CHECK(back.based_on == autosave.based_on);
  CHECK(back.owner == autosave.owner);
  CHECK(back.made == autosave.made);
  CHECK(back.scene == autosave.scene);
  CHECK(back.hues == autosave.hues);
  for (const char* text : {"", "{}", "{}\n", "[]\n", "{\"flyball_autosave\": 2}\n",
                           "{\"flyball_autosave\": 1, \"file\": 3}\n", "flyball\n"})
    CHECK_THROWS_AS(parse_autosave(text), SceneError);
}

TEST_CASE("unsaved work is written beside its file within two seconds of the last edit") {
  const TemporaryFolder folder;
  const fs::path file = folder / "governor.json";
  const AutosaveSettings settings{folder / "state", dead_process()};
  Document document = edited(file);
  Autosaver autosaver;
  run(autosaver, document, settings, 2);
  REQUIRE_FALSE(autosaver.path().empty());
  CHECK(autosaver.path().parent_path() == folder.path());
  CHECK(autosaver.path().filename().string().starts_with('.'));
  CHECK(std::isinf(autosaver.due_in()));
  const Autosave kept = parse_autosave(read_bytes(autosaver.path()));
  CHECK(kept.file == file);
  CHECK(kept.owner == settings.owner);
  CHECK(kept.based_on == 7);
  CHECK(parse_scene(kept.scene) == document.mechanism());

  SECTION("not again while nothing changes") {
    const auto stamp = stamp_of(autosaver.path());
    run(autosaver, document, settings, 20);
    CHECK(stamp_of(autosaver.path()) == stamp);
  }
  SECTION("at least every five seconds while the hand never rests") {
    double mass = 200, written = 123;
    for (double t = 0; t < 5; t += 0.25) {
      Mechanism next = document.mechanism();
      next.bodies[0].mass = ++mass;
      document.edit("Set mass", std::move(next), {}, 1);
      run(autosaver, document, settings, 0.25);
      const double now = parse_scene(parse_autosave(read_bytes(autosaver.path())).scene).bodies[0].mass;
      if (now != written) CHECK(now == mass);
      written = now;
    }
    CHECK(written > 200);
  }
  SECTION("gone after undoing, and there again after redoing") {
    document.undo();
    run(autosaver, document, settings, 0.5);
    CHECK(files_in(folder.path()) == 0);
    document.redo();
    run(autosaver, document, settings, 2);
    CHECK(files_in(folder.path()) == 1);
  }
  SECTION("gone after removing") {
    autosaver.remove();
    CHECK(files_in(folder.path()) == 0);
  }
  SECTION("found when its process has ended, and taken over") {
    write_bytes(file, write_scene(document.saved()));
    autosaver = {}; // the crash
    std::vector<Leftover> found = find_leftovers(file, settings.state_folder);
    REQUIRE(found.size() == 1);
    CHECK(found[0].outdated); // 7 is no hash of the file
    CHECK(find_leftovers({}, settings.state_folder).empty());
    Autosaver next;
    CHECK(next.adopt(found[0].path, file, settings));
    CHECK(find_leftovers(file, settings.state_folder).size() == 1); // until it is written anew
    const AutosaveSettings alive{settings.state_folder, this_process()};
    run(next, document, alive, 2);
    CHECK(find_leftovers(file, settings.state_folder).empty());
    CHECK(files_in(folder.path()) == 2); // with the document's own
    Autosaver late;
    CHECK_FALSE(late.adopt(found[0].path, file, settings));
  }
  SECTION("put aside and brought back") {
    autosaver = {};
    const fs::path leftover = find_leftovers(file, settings.state_folder).at(0).path;
    const fs::path aside = put_aside(leftover);
    CHECK(find_leftovers(file, settings.state_folder).empty());
    CHECK(bring_back(aside) == leftover);
    CHECK(find_leftovers(file, settings.state_folder).size() == 1);
    put_aside(leftover);
    remove_aside(file, settings.state_folder);
    CHECK(files_in(folder.path()) == 0);
    CHECK_THROWS_AS(bring_back(aside), SceneError);
  }
  SECTION("no leftover where the file holds the same") {
    autosaver = {};
    write_bytes(file, write_scene(document.mechanism()));
    CHECK(find_leftovers(file, settings.state_folder).empty());
    CHECK(files_in(folder.path()) == 1);
  }
}

TEST_CASE("two programs with one file keep an autosave each") {
  const TemporaryFolder folder;
  const fs::path file = folder / "governor.json";
  const Document document = edited(file);
  // The same number twice, as after a restart of the machine.
  Autosaver first, second;
  run(first, document, {folder / "state", dead_process()}, 2);
  run(second, document, {folder / "state", this_process()}, 2);
  CHECK(first.path() != second.path());
  CHECK(files_in(folder.path()) == 2);
  CHECK(find_leftovers(file, folder / "state").size() == 1);
  second.remove();
  CHECK(find_leftovers(file, folder / "state").size() == 1);
}

TEST_CASE("work without a file, or beside a folder that cannot be written to, is kept in the state folder") {
  const TemporaryFolder folder;
  const bool untitled = GENERATE(false, true);
  const fs::path file = untitled ? fs::path() : folder / "no such folder/governor.json";
  const AutosaveSettings settings{folder / "state", dead_process()};
  Autosaver autosaver;
  run(autosaver, edited(file), settings, 2);
  CHECK(autosaver.path().parent_path() == folder / "state/autosave");
  CHECK(autosaver.take_problem().empty());
  autosaver = {};
  CHECK(find_leftovers(file, settings.state_folder).size() == 1);
  CHECK(find_leftovers(folder / "another folder/governor.json", settings.state_folder).empty());
}

TEST_CASE("an autosave whose folder was away for a while goes with the others") {
  const TemporaryFolder folder;
  const fs::path stick = folder / "stick", file = stick / "governor.json";
  fs::create_directory(stick);
  const AutosaveSettings settings{folder / "state", dead_process()};
  Document document = edited(file);
  Autosaver autosaver;
  run(autosaver, document, settings, 2);
  const fs::path first = autosaver.path();
  REQUIRE(first.parent_path() == stick);
  fs::rename(stick, folder / "pulled");
  document.edit_number("Set mass", "bodies.collar.mass", 3);
  run(autosaver, document, settings, 2);
  REQUIRE(autosaver.path().parent_path() == folder / "state/autosave");
  fs::rename(folder / "pulled", stick);
  REQUIRE(fs::exists(first));
  autosaver.remove(); // it is saved
  CHECK_FALSE(fs::exists(first));
  CHECK(find_leftovers(file, settings.state_folder).empty());
}

TEST_CASE("an autosave that cannot be written says so and is tried again") {
  const TemporaryFolder folder;
  const fs::path blocked = folder / "blocked";
  write_bytes(blocked, "a file where the state folder should be");
  const AutosaveSettings settings{blocked, this_process()};
  const Document document = edited({});
  Autosaver autosaver;
  run(autosaver, document, settings, 2);
  CHECK_FALSE(autosaver.take_problem().empty());
  CHECK(autosaver.take_problem().empty());
  CHECK(autosaver.due_in() > 1);
  fs::remove(blocked);
  run(autosaver, document, settings, Autosaver::retry + 2);
  CHECK(autosaver.path().parent_path() == blocked / "autosave");
}

TEST_CASE("without a state folder nothing is written anywhere") {
  const TemporaryFolder folder;
  Autosaver autosaver;
  run(autosaver, edited(folder / "governor.json"), {{}, this_process()}, 10);
  CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("a large document does not hold up the thread that asks") {
  const TemporaryFolder folder;
  Document document = edited({});
  Mechanism large = document.mechanism();
  for (int i = 0; i < 10'000; ++i) {
    Body body = large.bodies[1];
    body.name = "link " + std::to_string(i);
    large.bodies.push_back(std::move(body));
  }
  document.edit("Add links", std::move(large), {});
  const AutosaveSettings settings{folder / "state", this_process()};
  Autosaver autosaver;
  double slowest = 0;
  for (int i = 0; i < 8; ++i) {
    const auto before = std::chrono::steady_clock::now();
    autosaver.tick(document, true, 0, settings, 0.25);
    slowest =
        std::max(slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
  }
  autosaver.wait();
  CHECK(parse_autosave(read_bytes(autosaver.path())).scene.size() > 1'000'000);
  // Writing it takes about 100 ms; no test should fail because another program was busy.
  const auto before = std::chrono::steady_clock::now();
  const std::string text = write_scene(document.mechanism());
  const double writing = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  CHECK(slowest < writing);
}

TEST_CASE("the newest work is written at once when the program is about to end, from any thread") {
  const TemporaryFolder folder;
  const fs::path file = folder / "governor.json";
  const AutosaveSettings settings{folder / "state", dead_process()};
  Document document = edited(file);
  Autosaver autosaver;
  const auto kept_mass = [&] {
    return parse_scene(parse_autosave(read_bytes(autosaver.path())).scene).bodies[0].mass;
  };
  const auto end = [&] { std::thread([slot = autosaver.slot()] { CHECK(slot->write().empty()); }).join(); };
  end();
  CHECK(autosaver.path().empty()); // nothing was noted
  autosaver.note(document, true, 7, settings);
  end();
  CHECK(kept_mass() == 123);
  // Over what is being written.
  run(autosaver, document, settings, 2);
  Mechanism next = document.mechanism();
  next.bodies[0].mass = 124;
  document.edit("Set mass", std::move(next), {});
  autosaver.tick(document, true, 7, settings, 0.25);
  end();
  CHECK(kept_mass() == 124);
  const auto stamp = stamp_of(autosaver.path());
  end();
  CHECK(stamp_of(autosaver.path()) == stamp); // it is there already
  autosaver.remove();
  end();
  CHECK(autosaver.path().empty());
  CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("changes of a file are told, however they are made") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "inner");
  const fs::path file = folder / "inner/scene.json", link = folder / "link.json";
  write_bytes(file, "one");
  write_bytes(folder / "inner/other.json", "one");
  fs::create_symlink("inner/scene.json", link);
  std::atomic<int> calls = 0;
  ChangeWatch watch([&] { ++calls; });
  const auto told = [&](const auto& change) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20)); // the last of what the change before set off
    watch.take_change();
    watch.watch(link);
    calls = 0;
    change();
    for (int i = 0; i < 200 && calls == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return calls == 1 && watch.changed();
  };
  watch.watch(link);
  if (!watch.tells()) return; // no watches to be had here
  CHECK(told([&] { std::ofstream(file) << "two"; }));
  CHECK(told([&] { write_bytes(file, "three"); })); // renamed over
  CHECK(told([&] { std::ofstream(file, std::ios::app) << "four"; }));
  CHECK(told([&] { fs::remove(file); }));
  CHECK(told([&] { fs::rename(folder / "inner/other.json", file); }));
  CHECK(told([&] {
    fs::remove(link);
    fs::create_symlink("elsewhere.json", link);
  }));
  CHECK(told([&] { write_bytes(folder / "elsewhere.json", "five"); }));
  CHECK_FALSE(told([&] { write_bytes(folder / "unrelated.json", "six"); }));
  CHECK_FALSE(ChangeWatch().tells());
  FileWatch looked(file, "one");
  CHECK_FALSE(looked.settled());
  looked.look();
  looked.look();
  CHECK(looked.settled());
}
