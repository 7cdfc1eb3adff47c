// The motion that takes the steady state's place, without a window.
#include "app/session/session.hpp"
#include "app/session/state_words.hpp"
#include "session_wait.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

struct RotorSession : Session {
  explicit RotorSession(LiveSolver::Mode solved = LiveSolver::Mode::immediate) : Session({.mode = solved}) {
    open_scene(*this, shipped_file("horizontal_rotor"));
    frames();
  }
  void frames(int count = 3) {
    for (int i = 0; i < count; ++i)
      update(*this, 0);
  }
};

} // namespace

TEST_CASE("Session: where the balance turns the periodic motion is found, shown and played") {
  RotorSession session;
  CHECK(session.answer.solution.status == Status::no_steady_state);
  const PeriodicState* motion = periodic_motion(session);
  REQUIRE(motion);
  CHECK(motion->stable == true);
  CHECK(motion->period == Approx(2 * std::numbers::pi / 30).epsilon(1e-12));
  REQUIRE(session.poses.size() == 3);
  // Half a period on the disc has turned half round, and after a whole one all is as it was.
  const std::vector<Pose> begin = session.poses;
  play(session, true);
  CHECK(in_motion(session));
  update(session, motion->period / 2);
  CHECK(std::abs(begin[2].rotation.dot(session.poses[2].rotation)) < 1e-9);
  update(session, motion->period / 2);
  for (std::size_t b = 0; b < begin.size(); ++b)
    CHECK((session.poses[b].position - begin[b].position).norm() < 1e-9);
  // A slider takes it along.
  change_parameter(session, "parameters.n", 60);
  session.frames();
  motion = periodic_motion(session);
  REQUIRE(motion);
  CHECK(motion->period == Approx(2 * std::numbers::pi / 60).epsilon(1e-12));
}

TEST_CASE("Session: nothing periodic is looked for where there is a steady state, or it is forgotten") {
  RotorSession session;
  REQUIRE(periodic_motion(session));
  edit(session, "Balanced", [](Mechanism& m, Selection&) {
    m.gravity.setZero();
    m.bodies[2].formulas.clear();
    m.bodies[2].position.setZero();
  });
  session.frames();
  CHECK(session.answer.solution.status == Status::converged);
  CHECK_FALSE(periodic_state(session));
  CHECK_FALSE(session.study.periodic.search.asked);
  CHECK(session.poses.size() == 3);
}

TEST_CASE("Session: the motion begins in the periodic one and stays there") {
  RotorSession session;
  const PeriodicState* motion = periodic_motion(session);
  REQUIRE(motion);
  show_periodic_motion(session, *motion);
  session.frames(5);
  const MotionRun* shown = shown_motion(session);
  REQUIRE(shown);
  const Run& run = *shown->run;
  for (const CoordinateTrack& track : run.coordinates)
    for (const PeriodicCoordinate& c : motion->coordinates) {
      if (track.joint != c.joint) continue;
      for (const double value : track.value) {
        CHECK(value < c.range.most + 1e-6);
        CHECK(value > c.range.least - 1e-6);
      }
    }
}

TEST_CASE("Session: the search is left to the background, and the window goes on") {
  RotorSession session(LiveSolver::Mode::background);
  CHECK(wait_until(session, [&] { return periodic_motion(session) != nullptr; }));
}

TEST_CASE("Session: how an unstable state is left is told in words") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, shipped_file("governor_engine"));
  update(session, 0);
  CHECK(growth_words(session.answer.solution).empty());
  change_parameter(session, "joints.slide.damping", 15);
  update(session, 0);
  const Solution& hunting = session.answer.solution;
  REQUIRE(hunting.stable == false);
  const std::string words = growth_words(hunting);
  INFO(words);
  double growth = 0, turns = 0;
  for (const std::complex<double>& each : *hunting.eigenvalues)
    if (each.real() > growth) {
      growth = each.real();
      turns = std::abs(each.imag()) / (2 * std::numbers::pi);
    }
  double said = 0, doubled = 0;
  REQUIRE(std::sscanf(words.c_str(), "It hunts: swings at %lf Hz double every %lf s.", &said, &doubled) == 2);
  CHECK(said == Approx(turns).epsilon(0.01));
  CHECK(doubled == Approx(std::log(2) / growth).epsilon(0.01));
}

TEST_CASE("what leaves the stability undecided is told where it is a swing without a damper") {
  Solution clutch;
  clutch.stability_reason = StabilityReason::marginal;
  clutch.eigenvalues = {
      {-22, 0}, {-1e-18, 7076.55}, {-1e-18, -7076.55}, {1.5e-15, 7076.55}, {1.5e-15, -7076.55}};
  CHECK(undamped_words(clutch) == "Nothing damps the swing at 1126 Hz: it neither grows nor dies out.");
  clutch.eigenvalues->push_back({0, 6.2831853});
  CHECK(undamped_words(clutch) ==
        "Nothing damps swings, the slowest at 1 Hz: they neither grow nor die out.");
  clutch.eigenvalues = {{-1, 5}, {-1, -5}};
  CHECK(undamped_words(clutch).empty());
  clutch.eigenvalues = {{0, 5}, {0, -5}, {1e-7, 0}}; // at a fold
  CHECK(undamped_words(clutch).empty());
}
