// The damped motion beside the steady state, as a person uses it.
#include "robot.hpp"
#include "session_wait.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/motion.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/dynamics/joined.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize wide{1280, 900};

const Run& run_of(const App& app) {
  const MotionRun* shown = shown_motion(app.session);
  REQUIRE(shown);
  return *shown->run;
}

const CoordinateTrack& track(const Run& run, std::string_view joint) {
  return *std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
}

// The motion is asked for with the key M.
struct MotionRobot : Robot {
  MotionRobot() : Robot(wide) {
    key('M');
    frames(3);
  }
};

// A comparison that looks for its solution: for ever where it is to wait, and ends with this.
void look_for_solution(Session& session, const Comparison& end, bool waits) {
  session.study.compare.measured.ask(session.options, {{session.document.shared()}, 1, 60},
                                     [=](const CompareRequest&, const TaskContext<Comparison>& context) {
                                       context.progress({"direct solution"});
                                       while (waits && !context.cancel)
                                         std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                       return end;
                                     });
}

} // namespace

TEST_CASE("without being asked for there is no motion, no integrator and no panel of it") {
  Robot robot(wide);
  CHECK_FALSE(robot.app.session.motion.on);
  for (const MotionRun& run : robot.app.session.motion.runs)
    CHECK_FALSE(run.task);
  CHECK_FALSE(robot.app.session.study.compare.measured.asked);
  CHECK(robot.app.ui.widgets.count("motion/play") == 0);
  CHECK(robot.app.ui.widgets.count("study/motion") == 0);
  CHECK(robot.app.ui.widgets.count("parameters/joints.slide.damping") == 0);
}

TEST_CASE("the motion begins when it is asked for, and ends in the steady state") {
  MotionRobot robot;
  App& app = robot.app;
  REQUIRE(app.session.motion.on);
  CHECK(app.session.playback.playing);
  const Run& run = run_of(app);
  CHECK(run.damped);
  CHECK(run.time.back() == Approx(app.session.mechanism().simulation.duration));
  REQUIRE(app.session.motion.runs[1].run);
  CHECK_FALSE(app.session.motion.runs[1].run->damped);
  REQUIRE(app.session.motion.settled);
  CHECK(app.session.motion.settled->distance < 2e-3);
  // Played to its end, the two pictures are one.
  robot.frames(130, 0.1);
  CHECK_FALSE(app.session.playback.playing);
  CHECK(app.session.playback.time == run.time.back());
  REQUIRE(app.session.motion.poses.size() == app.session.poses.size());
  for (std::size_t i = 0; i < app.session.poses.size(); ++i)
    CHECK((app.session.motion.poses[i].position - app.session.poses[i].position).norm() < 1e-3);
  // And at the beginning they were not.
  robot.click("motion/first");
  CHECK(app.session.playback.time == 0);
  double apart = 0;
  for (std::size_t i = 0; i < app.session.poses.size(); ++i)
    apart = std::max(apart, (app.session.motion.poses[i].position - app.session.poses[i].position).norm());
  CHECK(apart > 0.02);
}

TEST_CASE("how near a motion has come is told in the units of the screen, and a plot's eye agrees") {
  MotionRobot robot;
  Session& session = robot.app.session;
  REQUIRE(session.motion.settled);
  const double away =
      std::abs(track(run_of(robot.app), "arm1").value.back() - value(session.answer.solution, "arm1"));
  REQUIRE(away > 1e-4);
  REQUIRE(away < 0.02);
  const auto told = [&](double factor, const std::string& unit) {
    return "Nearly settled after 12 s: arm1 is " + short_text(factor * away, 2) + unit +
           " from the steady state.";
  };
  CHECK(settled_words(session) == told(180 / std::acos(-1), "°"));
  session.units.angle = AngleUnit::radian;
  CHECK(settled_words(session) == told(1, " rad"));
  // Known from when the run came, not looked for at each frame.
  CHECK(session.motion.nearly_settled);
  session.motion.nearly_settled = false;
  robot.frames(2);
  CHECK_THAT(settled_words(session), Catch::Matchers::StartsWith("Not settled after 12 s: "));
  session.motion.duration = 1;
  restart_motion(session);
  robot.frames(3);
  CHECK_THAT(settled_words(session), Catch::Matchers::StartsWith("Not settled after 1 s: "));
  session.motion.duration = 60;
  restart_motion(session);
  robot.frames(3);
  CHECK_THAT(settled_words(session), Catch::Matchers::StartsWith("Settled after "));
  CHECK_FALSE(session.motion.nearly_settled);
}

TEST_CASE("a motion that settles in another steady state says in which, and shows it") {
  Robot robot(wide);
  App& app = robot.app;
  change_parameter(app.session, "joints.spin.drive.speed", 12.566370614359172);
  robot.frames(3);
  const double direct = value(app.session.answer.solution, "arm1");
  robot.key('M');
  robot.frames(3);
  REQUIRE(app.session.motion.settled);
  CHECK_FALSE(app.session.motion.settled->time);
  REQUIRE(app.session.motion.elsewhere);
  // The arms have swung over the top, to the mirrored state.
  CHECK_THAT(elsewhere_words(app.session), ContainsSubstring("another steady state: arm1 at 139.36°"));
  robot.click("motion/go elsewhere");
  robot.frames(3);
  CHECK(value(app.session.answer.solution, "arm1") == Approx(std::acos(-1) - direct).epsilon(1e-9));
  CHECK_FALSE(app.session.motion.elsewhere);
  CHECK(app.ui.widgets.count("motion/elsewhere") == 0);
  CHECK(app.ui.widgets.count("motion/settled") == 1);

  // One that settles where solving answers says nothing of others.
  change_parameter(app.session, "joints.spin.drive.speed", 11);
  solve_from_drawn_pose(app.session);
  robot.frames(3);
  CHECK_FALSE(app.session.motion.elsewhere);
}

TEST_CASE("a closed panel takes everything of the motion with it") {
  MotionRobot robot;
  robot.click("study/close");
  CHECK_FALSE(robot.app.session.motion.on);
  for (const MotionRun& run : robot.app.session.motion.runs)
    CHECK_FALSE(run.task);
  CHECK(robot.app.session.motion.poses.empty());
  CHECK(robot.app.session.playback.time == 0);
  CHECK(robot.app.session.study.open == StudyKind::none);
}

TEST_CASE("the motion is paused, stepped and scrubbed") {
  MotionRobot robot;
  App& app = robot.app;
  robot.click("motion/play");
  CHECK_FALSE(app.session.playback.playing);
  const double step = run_of(app).time[1] - run_of(app).time[0];
  robot.click("motion/first");
  robot.click("motion/forward");
  robot.click("motion/forward");
  CHECK(app.session.playback.time == Approx(2 * step));
  robot.click("motion/back");
  CHECK(app.session.playback.time == Approx(step));
  robot.drag("motion/scrub", {0.1f, 0.5f}, {0.5f, 0.5f});
  CHECK(app.session.playback.time == Approx(6).margin(0.7));
  // The picture follows.
  const std::vector<Pose> expected = poses_at(run_of(app), app.session.playback.time);
  CHECK(app.session.motion.poses[1].position.isApprox(expected[1].position, 1e-12));
  // Space plays on from there.
  const double before = app.session.playback.time;
  robot.key(' ');
  robot.frames(3, 0.05);
  CHECK(app.session.playback.time > before);
}

TEST_CASE("a motion that runs away without its dampers leaves the other one in sight") {
  Robot robot(wide);
  App& app = robot.app;
  open_scene(app.session, shipped_file("rotor_oil_whip"));
  robot.frames(3);
  robot.key('M');
  robot.frames(3);
  REQUIRE(app.session.motion.runs[1].run);
  const std::vector<double>&damped = track(*app.session.motion.runs[0].run, "up").value,
        &undamped = track(*app.session.motion.runs[1].run, "up").value;
  const auto [least, most] = std::ranges::minmax(damped);
  const auto [low, high] = std::ranges::minmax(undamped);
  REQUIRE(high - low > 20 * (most - least)); // it does
  const Plot plot = motion_plot(app.session, "value up");
  REQUIRE(plot.y.range);
  CHECK((*plot.y.range)[0] < least);
  CHECK((*plot.y.range)[1] > most);
  CHECK((*plot.y.range)[1] - (*plot.y.range)[0] < 3 * (most - least));
  // One whose swings merely last has the axis that shows both.
  open_scene(app.session, shipped_file("governor"));
  robot.frames(3);
  show_motion(app.session, true);
  robot.frames(3);
  CHECK_FALSE(motion_plot(app.session, "value arm1").y.range);
}

TEST_CASE("in a small window the transport has a line of its own, and the plots have room") {
  Robot robot({800, 600});
  robot.key('M');
  robot.frames(3);
  const WidgetRect scrub = robot.widget("motion/scrub"), close = robot.widget("study/close"),
                   tab = robot.widget("study/compare"), plot = robot.widget("plot/motion/plot1/area");
  CHECK(scrub.to.x - scrub.from.x > 150);
  CHECK(scrub.from.y > tab.to.y);
  CHECK(scrub.from.y > close.from.y);
  CHECK(scrub.to.x < 800 - 60); // the time that is shown stands behind it
  CHECK(robot.widget("motion/play").from.x > 300);
  CHECK(plot.to.y - plot.from.y > 80);
  robot.drag("motion/scrub", {0.1f, 0.5f}, {0.5f, 0.5f});
  CHECK(robot.app.session.playback.time == Approx(6).margin(0.7));
  // A line that the person has drawn stays.
  const WidgetRect line = robot.widget("splitter/study");
  robot.drag(line.center(), {line.center().x, line.center().y + 60});
  CHECK(robot.widget("splitter/study").center().y == Approx(line.center().y + 60).margin(3));
}

TEST_CASE("a loop begins again, and slow motion is slow") {
  MotionRobot robot;
  App& app = robot.app;
  robot.click("motion/loop");
  seek_motion(app.session, run_of(app).time.back() - 0.05);
  robot.frames(2, 0.1);
  CHECK(app.session.playback.playing);
  CHECK(app.session.playback.time < 1);
  const double before = app.session.playback.time;
  app.session.playback.factor = 0.1;
  robot.frames(10, 0.01);
  CHECK(app.session.playback.time - before == Approx(0.01).epsilon(1e-6));
}

TEST_CASE("a slider begins the motion anew, or goes on with it, as was chosen") {
  MotionRobot robot;
  App& app = robot.app;
  robot.click("motion/play");
  seek_motion(app.session, 2);
  robot.frames(2);
  const std::vector<double> before = track(run_of(app), "slide").value;
  const std::string slider = "parameters/joints.slide.damping";
  SECTION("anew, and a paused hand stays where it is") {
    robot.drag(slider, {0.5f, 0.5f}, {0.9f, 0.5f});
    CHECK(get_parameter(app.session.mechanism(), "joints.slide.damping") > 40);
    const std::vector<double>& after = track(run_of(app), "slide").value;
    CHECK(after.front() == before.front());
    CHECK(after[20] != before[20]);
    CHECK(app.session.playback.time == Approx(2));
  }
  SECTION("going on") {
    app.session.motion.go_on = true;
    robot.drag(slider, {0.5f, 0.5f}, {0.9f, 0.5f});
    const Run& run = run_of(app);
    const std::vector<double>& after = track(run, "slide").value;
    REQUIRE(after.size() == before.size());
    const auto at = static_cast<std::size_t>(std::ranges::upper_bound(run.time, 2.) - run.time.begin()) - 1;
    for (std::size_t i = 0; i <= at; ++i)
      CHECK(after[i] == before[i]);
    CHECK(after[at + 60] != before[at + 60]);
  }
}

TEST_CASE("a drive's speed changed on the way keeps the phases of both pictures together") {
  MotionRobot robot;
  App& app = robot.app;
  robot.click("motion/play");
  app.session.motion.go_on = true;
  seek_motion(app.session, 1);
  robot.frames(2);
  change_parameter(app.session, "joints.spin.drive.speed", 14);
  seek_motion(app.session, 9.9);
  robot.frames(3);
  // The spindle is driven: both show it at the same angle.
  const int spindle = body_index(app.session.mechanism(), "spindle");
  REQUIRE(spindle >= 0);
  const auto i = static_cast<std::size_t>(spindle);
  CHECK(app.session.motion.poses[i].rotation.angularDistance(app.session.poses[i].rotation) < 1e-9);
}

TEST_CASE("plots show the motion, the motion without dampers, and the steady value") {
  MotionRobot robot;
  App& app = robot.app;
  const Run& run = run_of(app);
  const Plot plot = motion_plot(app.session, "value slide");
  REQUIRE(plot.curves.size() == 2);
  CHECK(plot.y.unit == "m");
  REQUIRE(plot.references.size() == 1);
  CHECK(plot.references[0].at == Approx(value(app.session.answer.solution, "slide")));
  for (const PlotCurve& curve : plot.curves) {
    if (curve.name != "damped") continue;
    REQUIRE(curve.points.size() == run.time.size());
    CHECK(curve.points[7][0] == run.time[7]);
    CHECK(curve.points[7][1] == Approx(track(run, "slide").value[7]));
  }
  // Everything that is offered can be drawn.
  for (const MotionQuantity& each : motion_quantities(run)) {
    CAPTURE(each.key);
    const Plot offered = motion_plot(app.session, each.key);
    CHECK_FALSE(offered.curves.empty());
    CHECK_FALSE(offered.y.unit.empty());
  }
  // Dragging the play head scrubs.
  CHECK(app.ui.widgets.count("plot/motion/plot1/area") == 1);
}

TEST_CASE("plots show the speed that a drive by torque settles at") {
  Robot robot(wide);
  App& app = robot.app;
  open_document(app.session, Document(shipped("windmill")));
  robot.frames(4);
  robot.key('M');
  robot.frames(3);
  const auto found = std::ranges::find_if(app.session.answer.solution.coordinates,
                                          [](const CoordinateSolution& c) { return c.speed.has_value(); });
  REQUIRE(found != app.session.answer.solution.coordinates.end());
  CHECK(app.panels->studies.shown().motion[0].quantity == "rate " + found->joint);
  CHECK(app.panels->studies.shown().motion[1].quantity == "measure power");
  const Plot rate = motion_plot(app.session, "rate " + found->joint);
  CHECK(rate.y.label == "speed of " + found->joint); // as in the results
  CHECK(found_words(*found) == rate.y.label);
  REQUIRE(rate.references.size() == 1);
  CHECK(rate.references[0].at == Approx(*found->speed));
  CHECK(motion_plot(app.session, "value " + found->joint).references.empty()); // it goes on
}

TEST_CASE("plots have what a drive by torque gives and its load apart, as the response does") {
  Robot robot(wide);
  App& app = robot.app;
  open_document(app.session, Document(shipped("governor_engine")));
  change_parameter(app.session, "joints.spin.drive.load", 25);
  app.session.motion.duration = 0.5;
  robot.frames(4);
  robot.key('M');
  robot.frames(3);
  const Run& run = run_of(app);
  const auto line = [&](const char* key, const char* title, double steady) {
    CAPTURE(key);
    const Plot plot = motion_plot(app.session, key);
    CHECK(plot.y.label == title);
    CHECK(plot.y.unit == "N m");
    REQUIRE(plot.references.size() == 1);
    CHECK(plot.references[0].at == Approx(steady).margin(1e-6));
    for (const PlotCurve& curve : plot.curves)
      if (curve.name == "damped") return curve.points;
    return std::vector<std::array<double, 2>>();
  };
  const auto given = line("given spin", "drive torque of spin", 25),
             load = line("load spin", "load on spin", 25),
             less = line("drive spin", "torque less load of spin", 0);
  REQUIRE(given.size() == run.time.size());
  REQUIRE(load.size() == given.size());
  REQUIRE(less.size() == given.size());
  const CoordinateTrack& slide = track(run, "slide");
  for (const std::size_t i : {std::size_t{0}, given.size() / 2, given.size() - 1}) {
    CHECK(given[i][1] == Approx(7500 * (slide.value[i] - 0.15)).margin(1e-9)); // the engine's law
    CHECK(load[i][1] == 25);
    CHECK(less[i][1] == Approx(given[i][1] - 25).margin(1e-9));
  }
  // A drive at a given speed has one torque.
  open_document(app.session, Document(shipped("governor")));
  robot.frames(4);
  robot.key('M');
  robot.frames(3);
  std::vector<std::string> drives;
  for (const MotionQuantity& each : motion_quantities(run_of(app)))
    if (std::string_view(each.group) == "Drives") drives.push_back(each.title);
  CHECK(drives == std::vector<std::string>{"drive torque of spin"});
}

TEST_CASE("the state that is shown can be kept and started from") {
  MotionRobot robot;
  App& app = robot.app;
  robot.click("motion/play");
  seek_motion(app.session, 1.2345);
  robot.frames(2);
  robot.click("motion/keep");
  REQUIRE_FALSE(app.session.motion.saved.coordinates.empty());
  app.session.motion.start = Start::state;
  const double slide = track(run_of(app), "slide").value[sample_before(run_of(app), 1.2345)];
  restart_motion(app.session);
  robot.frames(2);
  CHECK(track(run_of(app), "slide").value.front() == Approx(slide));
  CHECK(run_of(app).time.front() == Approx(app.session.motion.saved.time));
  CHECK(app.session.playback.time >= app.session.motion.saved.time);
}

TEST_CASE("a kick sets the steady state going") {
  MotionRobot robot;
  App& app = robot.app;
  app.session.motion.start = Start::equilibrium;
  app.session.motion.kicked = "slide";
  app.session.motion.kick = 0.3;
  restart_motion(app.session);
  robot.frames(2);
  const CoordinateTrack& slide = track(run_of(app), "slide");
  CHECK(slide.rate.front() == Approx(0.3).epsilon(1e-9));
  CHECK(slide.value.front() == Approx(0.15001745812530).epsilon(1e-9));
}

TEST_CASE("the motion can have a view of its own") {
  MotionRobot robot;
  App& app = robot.app;
  app.session.playback.playing = false;
  app.session.motion.beside = true;
  robot.frames(2);
  const WidgetRect left = robot.widget("view"), right = robot.widget("beside");
  CHECK(right.from.x == Approx(left.to.x));
  CHECK(view_frame(app.session, app.ui, app.tool, app.view).motion.empty());
  // One camera for both.
  const double azimuth = app.view.camera.azimuth;
  robot.drag("beside", {0.4f, 0.5f}, {0.6f, 0.5f});
  CHECK(app.view.camera.azimuth != azimuth);
}

TEST_CASE("while nothing changes nothing is drawn, also with a motion") {
  MotionRobot robot;
  robot.app.session.playback.playing = false;
  robot.frames(3);
  const int drawn = robot.stage.views_changed();
  robot.frames(5);
  CHECK(robot.stage.views_changed() == drawn);
  CHECK_FALSE(in_motion(robot.app.session, robot.app.view));
  robot.click("motion/forward");
  CHECK(robot.stage.views_changed() > drawn);
}

TEST_CASE("an edit while the motion is shown is followed, and undone") {
  MotionRobot robot;
  App& app = robot.app;
  const double before = track(run_of(app), "slide").value[100];
  change_parameter(app.session, "bodies.ball1.mass", 3);
  robot.frames(2);
  CHECK(track(run_of(app), "slide").value[100] != before);
  undo(app.session);
  robot.frames(2);
  CHECK(track(run_of(app), "slide").value[100] == before);
}

TEST_CASE("while a motion is computed it is told how much of it there is") {
  const OffscreenContext context;
  App app({.mode = LiveSolver::Mode::background,
           .on_news = {},
           .scenes = {},
           .theme = Theme::light,
           .numbers = {}});
  Stage stage(app.ui, 1);
  open_scene(app.session, shipped_file("chain20"));
  const auto wait = [&](const auto& until) {
    REQUIRE(steps_until([&] { stage.frame(app, wide, 0.01); }, until));
  };
  wait([&] { return app.session.answer.ticket != 0; });
  app.session.motion.duration = 1000;
  open_study(app.session, StudyKind::motion);
  CHECK(computed_motion(app.session) == 0.);
  wait([&] { return app.ui.widgets.contains("motion/progress"); });
  wait([&] { return computed_motion(app.session).value_or(0) > 0; });
  CHECK(*computed_motion(app.session) < 1000);
  stop_motion(app.session);
  wait([&] { return !computing_motion(app.session); });
  CHECK_FALSE(computed_motion(app.session));
  stage.frame(app, wide, 0.01);
  CHECK_FALSE(app.ui.widgets.contains("motion/progress"));
}

TEST_CASE("building ends the motion") {
  MotionRobot robot;
  set_mode(robot.app.session, Mode::build);
  robot.frames(2);
  CHECK_FALSE(robot.app.session.motion.on);
  CHECK(robot.app.ui.widgets.count("motion/play") == 0);
}

TEST_CASE("the comparison is measured and drawn") {
  Robot robot(wide);
  App& app = robot.app;
  open_study(app.session, StudyKind::compare);
  robot.frames(2);
  app.session.study.compare.repeats = 1;
  robot.click("compare/run");
  robot.frames(2);
  REQUIRE(app.session.study.compare.measured.found);
  const Comparison& c = app.session.study.compare.measured.found->result;
  CHECK(c.status == Status::converged);
  REQUIRE(c.best);
  CHECK(c.best->ratio() > 1);
  CHECK(app.panels->studies.shown().compare.plot.curves.size() > 3);
  CHECK(app.ui.widgets.count("compare/ratio") == 1);
  // Its table has a line for each mark and run, below the heading.
  std::ptrdiff_t lines = 2 + std::ssize(c.direct);
  for (const MotionCurve& curve : c.motion)
    lines += std::ssize(curve.points);
  robot.click("compare/copy");
  const std::string table = ImGui::GetClipboardText();
  CHECK(std::ranges::count(table, '\n') == lines);
  CHECK(table.starts_with("method,duration_s,tolerance,"));
  CHECK(app.ui.widgets.count("plot/compare/area") == 1);
}

TEST_CASE("the comparison stops after the time that is typed, and keeps what it has") {
  Robot robot(wide);
  App& app = robot.app;
  open_study(app.session, StudyKind::compare);
  robot.frames(2);
  const auto measured = [&](const char* seconds) {
    robot.frames(60); // no double click
    robot.click("compare/time_limit");
    robot.type(seconds);
    robot.key(key_enter);
    robot.frames(2);
    robot.click("compare/run");
    robot.frames(2);
    REQUIRE(app.session.study.compare.measured.found);
    return app.session.study.compare.measured.found->result;
  };
  const Comparison c = measured("0.05");
  CHECK(c.status == Status::converged);
  CHECK_FALSE(c.complete);
  CHECK(c.message == "The time limit of 0.05 s was reached before all was measured.");
  CHECK(app.session.study.compare.measured.found->run_time < 5);
  // None is no limit.
  robot.frames(60);
  robot.click("compare/time_limit");
  robot.type("0");
  robot.key(key_enter);
  robot.frames(2);
  CHECK(app.session.study.compare.time_limit == 0.05);
}

TEST_CASE("the comparison tells how far it is, and is given up by a button") {
  Robot robot(wide);
  App& app = robot.app;
  open_study(app.session, StudyKind::compare);
  robot.frames(2);
  app.session.options.mode = LiveSolver::Mode::background;
  robot.click("compare/run");
  auto& measured = app.session.study.compare.measured;
  const auto wait = [&](const auto& until) { REQUIRE(steps_until([&] { robot.frames(1); }, until)); };
  wait([&] { return measured.progress().part > 0; });
  CHECK(std::string(measured.progress().phase) == "measuring motions");
  CHECK(robot.app.ui.widgets.contains("compare/progress"));
  robot.click("compare/cancel");
  wait([&] { return !measured.running(); });
  robot.frames(2);
  REQUIRE(measured.found);
  CHECK_FALSE(measured.found->result.complete);
  CHECK(measured.found->result.message == "Cancelled.");
  CHECK(app.ui.widgets.contains("plot/compare/area"));
}

TEST_CASE(
    "while a comparison still looks for its solution a change of the mechanism or a closed panel ends it") {
  Robot robot(wide);
  Session& session = robot.app.session;
  open_study(session, StudyKind::compare);
  robot.frames(2);
  session.options.mode = LiveSolver::Mode::background;
  auto& measured = session.study.compare.measured;
  for (const bool closed : {false, true}) {
    Comparison nothing;
    nothing.status = Status::not_converged;
    look_for_solution(session, nothing, true);
    REQUIRE(steps_until([&] { robot.frames(1); },
                        [&] { return std::string(measured.progress().phase) == "direct solution"; }));
    robot.frames(3);
    CHECK(measured.running());
    if (closed)
      robot.click("study/close");
    else
      change_parameter(session, "joints.spin.drive.speed", 12);
    CHECK(steps_until([&] { robot.frames(1); }, [&] { return !measured.running(); }));
    robot.frames(2);
    CHECK_FALSE(measured.found);
    CHECK(measured.problem.starts_with(closed ? "Cancelled" : "The mechanism changed"));
  }
}

TEST_CASE("a whole comparison stays where a new one is stopped with less") {
  Robot robot(wide);
  Session& session = robot.app.session;
  open_study(session, StudyKind::compare);
  robot.frames(2);
  session.options.mode = LiveSolver::Mode::background;
  auto& measured = session.study.compare.measured;
  const auto ask = [&](const Comparison& when_stopped, bool wait) {
    look_for_solution(session, when_stopped, wait);
    if (wait) {
      robot.frames(3);
      robot.click("study/close");
      open_study(session, StudyKind::compare);
    }
    REQUIRE(steps_until([&] { robot.frames(1); }, [&] { return !measured.running(); }));
    robot.frames(2);
  };
  Comparison whole, unsolved, part;
  whole.status = part.status = Status::converged;
  whole.motion.resize(3);
  part.motion.resize(1);
  unsolved.complete = part.complete = false;
  ask(whole, false);
  REQUIRE(measured.found);
  const auto first = measured.found;
  for (const Comparison& stopped : {unsolved, part}) {
    ask(stopped, true);
    CHECK(measured.found == first);
    CHECK_FALSE(measured.problem.empty());
  }
  // One of what the mechanism is now, as far as it came, is better than one of before.
  change_parameter(session, "joints.spin.drive.speed", 12);
  ask(unsolved, true);
  CHECK(measured.found == first);
  ask(part, true);
  CHECK(measured.found->result.motion.size() == 1);
}

TEST_CASE("the comparison shows the errors of a measure") {
  Robot robot({1280, 900});
  App& app = robot.app;
  open_scene(app.session, shipped_file("governor_parametric"));
  edit(app.session, "Short", [](Mechanism& m, Selection&) { m.simulation.duration = 0.2; });
  robot.frames(3);
  open_study(app.session, StudyKind::compare);
  robot.frames(2);
  app.session.study.compare.repeats = 1;
  robot.click("compare/run");
  robot.frames(2);
  REQUIRE(app.session.study.compare.measured.found);
  CHECK(app.ui.widgets.count("compare/shown") == 1);
  CHECK(app.panels->studies.shown().compare.plot.y.label == "error |q - q*|");
  app.session.study.compare.shown = "height";
  robot.frames(2);
  CHECK(app.panels->studies.shown().compare.plot.y.label == "error of height");
  CHECK(app.panels->studies.shown().compare.plot.y.unit == "m");
}
