// A run exported as a film, as a person does it: the dialog, its progress, giving up, and what is in the
// files.
#include "fake_ffmpeg.hpp"
#include "robot.hpp"

#include "app/session/modes.hpp"
#include "app/session/motion.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/motion/movie_export.hpp"
#include "app/ui/studies/motion/run_movie.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"

#include <array>
#include <numbers>
#include <set>

using namespace flyball;
using namespace flyball::test;
namespace fs = std::filesystem;

namespace {

// With small pictures.
class FilmRobot : public Robot {
 public:
  FilmRobot() {
    app.movie.width = 160;
    app.movie.height = 91;
    app.movie.rate = 10;
  }
  // Types the name of the film.
  void name(const fs::path& file) {
    click("movie/png"); // leaves the field of the path
    app.panels->movie.query().path = file.string();
    frames(2);
  }
  // Until it is made, or is not; returns how many frames of the window that took.
  int wait() {
    int count = 0;
    for (; count < 2000 && (app.movie.request || app.movie.progress); ++count) {
      frames(1);
      if (app.movie.progress) most_drawn = std::max(most_drawn, app.movie.progress->drawn);
    }
    frames(2);
    return count;
  }
  std::size_t most_drawn = 0;
};

// With half a second of the governor's motion, and its dialog open.
class MovieRobot : public FilmRobot {
 public:
  MovieRobot() {
    app.session.motion.duration = 0.5;
    app.commands.run("study.motion");
    frames(3);
    app.commands.run("study.export");
    frames(3);
    REQUIRE(app.dialog.showing);
    point({2, 2}); // nothing lights up
  }
};

std::set<std::string> names_in(const TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    names.insert(entry.path().filename().string());
  return names;
}
using Names = std::set<std::string>;

} // namespace

TEST_CASE("a run is exported as numbered frames while the window goes on") {
  const TemporaryFolder folder;
  MovieRobot robot;
  robot.name(folder / "run.png");
  robot.click("movie/save");
  // 0, 0.1 ... 0.5 s: six frames, one a frame of the window.
  CHECK(robot.wait() >= 6);
  CHECK(robot.most_drawn >= 5);
  CHECK_FALSE(robot.app.dialog.showing);
  CHECK(robot.app.session.notice ==
        "Saved 6 frames, " + (folder / "run-0001.png").string() + " to run-0006.png");
  REQUIRE(names_in(folder) == Names{"run-0001.png", "run-0002.png", "run-0003.png", "run-0004.png",
                                    "run-0005.png", "run-0006.png"});
  std::set<std::string> pictures;
  for (std::size_t i = 0; i < 6; ++i) {
    const fs::path file = frame_file(folder / "run.png", i, 6);
    const Image image = read_png(file);
    CHECK(image.width == 160);
    CHECK(image.height == 91);
    pictures.insert(encode_png(image));
  }
  CHECK(pictures.size() == 6);
}

TEST_CASE("frames show the moments and the part of the run that were asked for") {
  const TemporaryFolder folder;
  MovieRobot robot;
  robot.click("movie/whole");
  robot.app.movie.from = 0.1;
  robot.app.movie.to = 0.2;
  robot.app.movie.factor = 0.2;
  robot.name(folder / "run.png");
  robot.click("movie/save");
  robot.wait();
  CHECK(names_in(folder).size() == 6); // 0.1, 0.12 ... 0.2 s
  // The same moment, seen in the window's own view from the same place, is the same picture.
  seek_motion(robot.app.session, 0.14);
  robot.frames(3);
  ViewFrame frame = view_frame(robot.app.session, robot.app.ui, robot.app.tool, robot.app.view);
  frame.hovered = {};
  ViewRenderer renderer;
  Framebuffer target(160, 91, robot.app.view.samples);
  renderer.draw(frame, target);
  CHECK(target.read() == read_png(folder / "run-0003.png"));
}

TEST_CASE("a film has no forces of the moment it was begun at, whatever the window goes on to") {
  const auto begun = [](bool forces) {
    const TemporaryFolder folder;
    MovieRobot robot;
    robot.app.view.loads = forces;
    robot.name(folder / "run.png");
    robot.click("movie/save");
    robot.frames(1);
    REQUIRE(robot.app.movie.progress);
    // Another answer takes the place of the one whose forces were seen.
    edit_parameter(robot.app.session, "bodies.collar.mass", 2);
    robot.wait();
    return std::array{read_png(frame_file(folder / "run.png", 0, 6)),
                      read_png(frame_file(folder / "run.png", 5, 6))};
  };
  const auto with = begun(true), without = begun(false);
  CHECK(with[0] == without[0]);
  CHECK(with[1] == without[1]);
}

TEST_CASE("the mode that is shown is exported as it is shown") {
  const TemporaryFolder folder;
  FilmRobot robot;
  App& app = robot.app;
  robot.key('O');
  robot.frames(3);
  app.commands.run("study.export_mode"); // no mode moves yet
  robot.frames(3);
  REQUIRE_FALSE(app.dialog.showing);
  robot.click("modes/row/1");
  app.session.study.modes.amplitude = 0.2;
  robot.click("modes/export");
  robot.frames(3);
  REQUIRE(app.dialog.showing);
  CHECK(fs::path(app.panels->movie.query().path).stem() == "flyball-governor-mode-1");
  robot.point({2, 2});
  robot.name(folder / "swing.png");
  robot.click("movie/save");
  robot.wait();
  CHECK_FALSE(app.dialog.showing);
  // At 1.04 Hz, as fast as it is.
  CHECK(app.session.notice ==
        "Saved 10 frames, " + (folder / "swing-0001.png").string() + " to swing-0010.png");
  // The same phase, seen in the window's own view from the same place, is the same picture.
  app.session.study.modes.playing = false;
  app.session.study.modes.phase = 2 * std::numbers::pi * 3 / 10;
  robot.frames(3);
  ViewFrame frame = view_frame(app.session, app.ui, app.tool, app.view);
  frame.hovered = {};
  ViewRenderer renderer;
  Framebuffer target(160, 91, app.view.samples);
  renderer.draw(frame, target);
  CHECK(target.read() == read_png(folder / "swing-0004.png"));
}

TEST_CASE("a film goes through ffmpeg from the dialog") {
  const FakeFfmpeg ffmpeg;
  const TemporaryFolder folder;
  MovieRobot robot;
  CHECK(fs::path(robot.app.panels->movie.query().path).filename() == "flyball-governor.mp4");
  robot.name(folder / "run.mp4");
  robot.click("movie/gif");
  CHECK(robot.app.panels->movie.query().path == (folder / "run.gif").string());
  robot.click("movie/mp4");
  robot.click("movie/save");
  robot.wait();
  CHECK(robot.app.session.notice == "Saved " + (folder / "run.mp4").string());
  CHECK(names_in(folder) == Names{"run.mp4"});
  CHECK(fs::file_size(folder / "run.mp4") == 6 * 3 * 160 * 92);
}

TEST_CASE("an export that is given up leaves nothing, and the dialog as it was") {
  const FakeFfmpeg ffmpeg;
  const TemporaryFolder folder;
  MovieRobot robot;
  robot.app.movie.rate = 100;
  const bool film = GENERATE(false, true);
  robot.name(folder / (film ? "run.mp4" : "run.png"));
  robot.click("movie/save");
  robot.frames(3);
  REQUIRE(robot.app.movie.progress);
  CHECK(robot.app.movie.progress->frames == 51);
  CHECK(names_in(folder).size() == 1); // hidden
  SECTION("by the button") {
    robot.click("movie/cancel");
  }
  SECTION("by the key") {
    robot.key(key_escape);
  }
  robot.frames(2); // the dialog grows again
  CHECK_FALSE(robot.app.movie.progress);
  CHECK(names_in(folder).empty());
  CHECK(robot.app.dialog.showing);
  CHECK(robot.app.session.notice.empty());
  robot.click("movie/cancel");
  CHECK_FALSE(robot.app.dialog.showing);
}

TEST_CASE("without ffmpeg the dialog offers frames and says what is missing") {
  const NoFfmpeg none;
  const TemporaryFolder folder;
  MovieRobot robot;
  CHECK(fs::path(robot.app.panels->movie.query().path).filename() == "flyball-governor.png");
  robot.click("movie/mp4");
  CHECK(fs::path(robot.app.panels->movie.query().path).extension() == ".png");
  // A name that is typed all the same goes nowhere.
  robot.name(folder / "run.mp4");
  robot.click("movie/save");
  CHECK_FALSE(robot.app.movie.request);
  CHECK_FALSE(robot.app.movie.progress);
  robot.click("movie/png");
  CHECK(robot.app.panels->movie.query().path == (folder / "run.png").string());
  robot.click("movie/save");
  robot.wait();
  CHECK(names_in(folder).size() == 6);
}

TEST_CASE("what ffmpeg says when it fails is told in the dialog") {
  const FakeFfmpeg ffmpeg("echo 'Unknown encoder' >&2; exit 1");
  const TemporaryFolder folder;
  MovieRobot robot;
  robot.name(folder / "run.mp4");
  robot.click("movie/save");
  robot.wait();
  CHECK_THAT(robot.app.movie.problem, ContainsSubstring("exit code 1: Unknown encoder"));
  CHECK(robot.app.dialog.showing);
  CHECK(names_in(folder).empty());
}

TEST_CASE("frames that are there already are replaced when the person says so") {
  const TemporaryFolder folder;
  write_bytes(folder / "run-0001.png", "old");
  MovieRobot robot;
  robot.name(folder / "run.png");
  robot.click("movie/save");
  CHECK_FALSE(robot.app.movie.progress);
  CHECK(read_bytes(folder / "run-0001.png") == "old");
  robot.frames(1);
  robot.click("movie/save");
  robot.wait();
  CHECK(read_png(folder / "run-0001.png").width == 160);
}

TEST_CASE("a film's folder is made first, if that is meant") {
  const TemporaryFolder folder;
  MovieRobot robot;
  robot.name(folder / "films/run.png");
  robot.click("movie/save");
  robot.frames(1);
  CHECK(robot.app.ui.widgets.contains("file question"));
  CHECK_FALSE(fs::exists(folder / "films"));
  robot.click("movie/save");
  robot.wait();
  CHECK(read_png(folder / "films/run-0001.png").width == 160);
}

TEST_CASE("the export is on offer where a motion is shown") {
  Robot robot;
  CHECK_FALSE(robot.app.commands.enabled(command("study.export")));
  robot.app.session.motion.duration = 0.2;
  robot.app.commands.run("study.motion");
  robot.frames(3);
  CHECK(robot.app.commands.enabled(command("study.export")));
  robot.click("motion/export");
  robot.frames(2);
  CHECK(robot.app.dialog.showing);
  CHECK(robot.app.ui.widgets.contains("movie/save"));
}

TEST_CASE("the File menu exports a film of the motion, which begins for that, or of the mode that moves") {
  const TemporaryFolder folder;
  FilmRobot robot;
  App& app = robot.app;
  app.session.motion.duration = 0.2;
  const bool mode = GENERATE(false, true);
  if (mode) {
    robot.key('O');
    robot.frames(3);
    robot.click("modes/row/1");
  }
  REQUIRE(app.commands.enabled(command("file.film")));
  app.commands.run("file.film");
  robot.frames(3);
  REQUIRE(app.dialog.showing);
  CHECK(app.session.motion.on == !mode);
  CHECK(app.movie.of == (mode ? Filmed::mode : Filmed::run));
  robot.point({2, 2});
  robot.name(folder / "film.png");
  robot.click("movie/save");
  robot.wait();
  CHECK_FALSE(app.dialog.showing);
  CHECK(names_in(folder).size() == (mode ? 10 : 3));
}

TEST_CASE("a film is not asked for where nothing can move") {
  Robot robot;
  robot.begin_empty(1);
  CHECK_FALSE(robot.app.commands.enabled(command("file.film")));
  CHECK_FALSE(robot.app.commands.enabled(command("file.model")));
}

TEST_CASE("the frames of a run are evenly spaced and end with it") {
  Run run;
  run.time = {1, 1.5, 2};
  const auto times = movie_times(run, {0, 10, 10, 0.5});
  REQUIRE(times.size() == 21);
  CHECK(times.front() == 1);
  CHECK(times[1] == Approx(1.05));
  CHECK(times.back() == 2);
  CHECK(movie_times(run, {0, 10, 3, 1}).size() == 4); // 1, 1 1/3, 1 2/3, 2 s
  CHECK(movie_times(run, {0, 10, 4, 3}).size() == 2); // 1, 1.75 s
  CHECK(movie_times(run, {1.5, 1.5, 30, 1}).size() == 1);
  CHECK(movie_times(run, {0, 10, 1e9, 1}).size() == most_movie_frames + 1); // refused as too many
  CHECK(movie_times(Run{}, {0, 10, 30, 1}).empty());
}

TEST_CASE("what was chosen for a film that was not made is forgotten") {
  MovieRobot robot;
  const double rate = robot.app.movie.rate;
  robot.app.movie.rate = 12;
  robot.app.movie.width = 320;
  robot.frames(1);
  SECTION("by the button") {
    robot.click("movie/cancel");
  }
  SECTION("by Escape") {
    robot.key(key_escape);
  }
  robot.frames(2);
  CHECK(robot.app.movie.rate == rate);
  CHECK(robot.app.movie.width == 160);
}
