// The motion's moment, without a window.
#include "app/session/session.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE("Session: the motion is stepped sample by sample, however short it is") {
  const double duration = GENERATE(1e-6, 0.5);
  CAPTURE(duration);
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, shipped_file("governor"));
  update(session, 0);
  session.motion.duration = duration;
  show_motion(session, true);
  play(session, false);
  update(session, 0);
  const MotionRun* shown = shown_motion(session);
  REQUIRE(shown);
  const std::vector<double>& times = shown->run->time;
  REQUIRE(times.size() == 2001);
  seek_motion(session, times[5]);
  step_motion(session, 1);
  CHECK(session.playback.time == times[6]);
  step_motion(session, -1);
  CHECK(session.playback.time == times[5]);
  // From between two samples, back means to the one before, on to the one after.
  seek_motion(session, (times[5] + times[6]) / 2);
  step_motion(session, -1);
  CHECK(session.playback.time == times[5]);
  seek_motion(session, (times[5] + times[6]) / 2);
  step_motion(session, 1);
  CHECK(session.playback.time == times[6]);
  step_motion(session, 5000);
  CHECK(session.playback.time == times.back());
  step_motion(session, -1);
  CHECK(session.playback.time == times[times.size() - 2]);
}

TEST_CASE("Session: of two motions it is said which has stopped") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, shipped_file("governor"));
  update(session, 0);
  session.motion.duration = 0.01;
  session.motion.runs[1].wanted = GENERATE(true, false);
  show_motion(session, true);
  update(session, 0);
  CHECK(motion_problems(session).empty());
  for (MotionRun& run : session.motion.runs)
    run.problem = "It stopped.";
  CHECK(motion_problems(session) ==
        (session.motion.runs[1].wanted
             ? std::vector<std::string>{"Damped: It stopped.", "Undamped: It stopped."}
             : std::vector<std::string>{"It stopped."}));
}
