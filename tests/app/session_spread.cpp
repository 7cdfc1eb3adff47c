// The study of the spread and the band around the response curve, without a window.
#include "app/document/rename.hpp"
#include "app/session/session.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "session_wait.hpp"
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

const std::string speed = "parameters.w", arm = "parameters.L";

struct SpreadSession : Session {
  explicit SpreadSession(const std::string& scene, LiveSolver::Mode solved = LiveSolver::Mode::immediate)
      : Session({.mode = solved}) {
    open_scene(*this, shipped_file(scene));
    frames();
  }
  void frames(int count = 3) {
    for (int i = 0; i < count; ++i)
      update(*this, 0);
  }
  const SpreadOutput& output(const std::string& name) {
    REQUIRE(study.spread.samples.found);
    const auto& all = study.spread.samples.found->result.outputs;
    const auto found = std::ranges::find(all, name, &SpreadOutput::name);
    REQUIRE(found != all.end());
    return *found;
  }
};

} // namespace

TEST_CASE("Session: the spread begins with the pinned numbers, and is what the command finds") {
  SpreadSession session("governor_parametric");
  SpreadState& state = session.study.spread;
  CHECK(state.choice.tolerances.empty());
  CHECK_FALSE(state.samples.asked); // nothing is made before it is asked for
  open_study(session, StudyKind::spread);
  session.frames();
  REQUIRE(state.choice.tolerances.size() == 2);
  CHECK(state.choice.tolerances[0] == ChosenTolerance{speed, Distribution::normal, 1, true});
  CHECK(state.choice.tolerances[1] == ChosenTolerance{arm, Distribution::normal, 1, true});
  REQUIRE(state.samples.found);
  CHECK_FALSE(state.stale);
  CHECK(state.output == "slide");
  const std::vector<Tolerance> tolerances = chosen_tolerances(session);
  REQUIRE(tolerances.size() == 2);
  CHECK(tolerances[1].width == Approx(0.0016).epsilon(1e-12));
  SpreadOptions options;
  options.samples = 2000;
  ThreadSharing sharing(1);
  const SpreadAnswer own = spread(session.mechanism(), tolerances, options, sharing);
  const SpreadAnswer& found = state.samples.found->result;
  CHECK(found.counts == own.counts);
  for (std::size_t k = 0; k < own.outputs.size(); ++k) {
    CHECK(found.outputs[k].followed.mean == Approx(own.outputs[k].followed.mean).epsilon(1e-12));
    CHECK(found.outputs[k].followed.deviation == Approx(own.outputs[k].followed.deviation).epsilon(1e-9));
  }

  SECTION("it follows a slider, and a percentage its number") {
    const double nominal = session.output("slide").nominal;
    state.samples.found->run_time = 0; // whatever it took on a busy machine
    change_parameter(session, arm, 0.14);
    session.frames();
    CHECK(chosen_tolerances(session)[1].width == Approx(0.0014).epsilon(1e-12));
    CHECK(session.output("slide").nominal == Approx(value(session.answer.solution, "slide")).epsilon(1e-10));
    CHECK(session.output("slide").nominal != nominal);
    CHECK_FALSE(state.stale);
  }
  SECTION("told in its unit a width stays what it is") {
    tell_in_percent(session, 1, false);
    CHECK(state.choice.tolerances[1].width == Approx(0.0016).epsilon(1e-12));
    CHECK(chosen_tolerances(session)[1].width == Approx(tolerances[1].width).epsilon(1e-12));
    tell_in_percent(session, 1, true);
    CHECK(state.choice.tolerances[1].width == Approx(1).epsilon(1e-12));
  }
  SECTION("twice the tolerance scatters twice as far, by the same random numbers") {
    const double before = session.output("slide").linear_deviation;
    for (ChosenTolerance& each : state.choice.tolerances)
      each.width = 2;
    session.frames();
    CHECK(session.output("slide").linear_deviation == Approx(2 * before).epsilon(1e-6));
  }
  SECTION("what is gone has none, and what is zero is given one in its unit") {
    state.choice.tolerances.push_back({"parameters.gone"}); // it may come back, by Undo
    session.frames();
    CHECK(chosen_tolerances(session).size() == 2);
    add_tolerance(session, "gravity.0");
    REQUIRE(state.choice.tolerances.size() == 4);
    ChosenTolerance& zero = state.choice.tolerances[3];
    CHECK_FALSE(zero.percent);
    CHECK(zero.width > 0);
    tell_in_percent(session, 3, true); // of nothing
    CHECK_FALSE(zero.percent);
    zero.percent = true;
    CHECK(chosen_tolerances(session).size() == 2);
  }
  SECTION("closed it takes everything along but what was chosen") {
    open_study(session, StudyKind::none);
    CHECK_FALSE(state.samples.found);
    CHECK(state.choice.tolerances.size() == 2);
    change_parameter(session, arm, 0.14);
    session.frames();
    CHECK_FALSE(state.samples.asked);
  }
}

TEST_CASE("Session: a tolerance that cannot be is told") {
  SpreadSession session("governor_parametric");
  session.study.spread.begun = true;
  open_study(session, StudyKind::spread);
  session.frames();
  CHECK_FALSE(session.study.spread.samples.asked); // nothing has one
  add_tolerance(session, "parameters.c");          // of dampers, which no steady state depends on
  session.frames();
  CHECK_FALSE(session.study.spread.samples.found);
  CHECK_THAT(session.study.spread.samples.problem, ContainsSubstring("parameters.c"));
}

TEST_CASE("Session: what is chosen by names goes along when these change, and when that is undone") {
  SpreadSession session("governor");
  constexpr const char* stiffness = "joints.slide.spring.stiffness";
  session.study.spread.begun = true;
  open_study(session, StudyKind::spread);
  add_tolerance(session, stiffness);
  add_tolerance(session, "bodies.collar.mass");
  session.study.spread.choice.tolerances[0].width = 7;
  hold_number(session, stiffness, true);
  tell_point(session, "collar", Vec3(0, 1, 0));
  session.frames();
  const auto tolerances = [&] {
    std::vector<std::string> all;
    for (const ChosenTolerance& each : session.study.spread.choice.tolerances)
      all.push_back(each.address);
    return all;
  };
  const std::vector<std::string> before = tolerances();
  edit(session, "Rename", [](Mechanism& m, Selection&) {
    rename_part(m, {PartKind::joint, "slide"}, "way");
    rename_part(m, {PartKind::body, "collar"}, "sleeve");
  });
  session.frames();
  CHECK(tolerances() == std::vector<std::string>{"joints.way.spring.stiffness", "bodies.sleeve.mass"});
  CHECK(session.study.spread.choice.tolerances[0].width == 7);
  CHECK(is_held(session, "joints.way.spring.stiffness"));
  REQUIRE(told_points(session).size() == 1);
  CHECK(told_points(session)[0].body == "sleeve");
  undo(session);
  session.frames();
  CHECK(tolerances() == before);
  CHECK(is_held(session, stiffness));
  CHECK(told_points(session).size() == 1);
  // What is taken away has none, and has it again when it is back.
  edit(session, "Remove", [](Mechanism& m, Selection&) {
    std::erase_if(m.joints, [](const Joint& joint) { return joint.name == "slide"; });
  });
  session.frames();
  CHECK(chosen_tolerances(session).size() == 1);
  undo(session);
  session.frames();
  CHECK(tolerances() == before);
}

TEST_CASE("Session: many samples are made in the background, and can be cancelled") {
  SpreadSession session("governor_parametric", LiveSolver::Mode::background);
  const auto wait = [&](const auto& done) { return wait_until(session, done); };
  REQUIRE(wait([&] { return converged(session) && !solving(session); }));
  session.study.spread.choice.samples = 1'000'000;
  open_study(session, StudyKind::spread);
  REQUIRE(wait([&] { return session.study.spread.samples.running(); }));
  CHECK(studying(session));
  CHECK(next_progress(session) < 1); // its progress is looked at again and again
  session.study.spread.samples.stop();
  REQUIRE(wait([&] { return !session.study.spread.samples.problem.empty(); }));
  CHECK_FALSE(session.study.spread.samples.running());
  CHECK_FALSE(session.study.spread.samples.found);
  CHECK_THAT(session.study.spread.samples.problem, ContainsSubstring("stopped"));
}

TEST_CASE("Session: a study that is stopped before it has a result is told as stopped") {
  using Doubled = Study<int, int>;
  Doubled study;
  study.ask(SessionOptions{.mode = BackgroundWorker::Mode::background}, 2,
            [](const int&, const TaskContext<int>& context) -> int {
              while (!context.cancel)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
              interruption_point();
              return -1;
            });
  study.stop();
  while (!study.take("It was stopped."))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(study.problem == "It was stopped.");
  CHECK_FALSE(study.found);
}

TEST_CASE("Session: the band around the response has at each place the spread there") {
  SpreadSession session("governor_parametric");
  open_study(session, StudyKind::response);
  choose_response(session, speed);
  session.frames();
  CHECK_FALSE(session.study.band.computed.asked);
  CHECK(band_refusal(session).empty());
  session.study.band.wanted = true;
  session.frames();
  REQUIRE(session.study.band.computed.found);
  const FoundBand& found = session.study.band.computed.found->result;
  REQUIRE(found.band.points.size() > 20);
  REQUIRE(band_output(session));
  const std::size_t slide = *band_output(session);
  CHECK(found.band.outputs[slide] == "slide");
  SpreadOptions options;
  options.samples = band_samples;
  ThreadSharing sharing(1);
  for (const std::size_t i : {std::size_t{3}, found.band.points.size() / 2}) {
    Mechanism there = session.mechanism();
    set_parameter(there, speed, found.band.points[i].number);
    const SpreadAnswer own = spread(there, chosen_tolerances(session), options, sharing);
    CHECK(found.band.points[i].outputs[slide].low == Approx(own.outputs[slide].followed.low).epsilon(1e-9));
    CHECK(found.band.points[i].outputs[slide].high == Approx(own.outputs[slide].followed.high).epsilon(1e-9));
  }
  CHECK_THAT(band_words(session), ContainsSubstring("the middle 90 % of 400 samples"));
  // It follows the curve, and goes with the response.
  change_parameter(session, arm, 0.14);
  session.frames();
  CHECK(session.study.band.computed.found->of.curve == session.study.response.curve.found);
  open_study(session, StudyKind::none);
  session.frames();
  CHECK_FALSE(session.study.band.computed.found);
}

TEST_CASE("Session: where samples leave the branch the band says so") {
  SpreadSession session("conical_pendulum");
  session.study.spread.begun = true;
  session.study.spread.choice.tolerances = {{"joints.spin.drive.speed", Distribution::uniform, 0.2, false}};
  open_study(session, StudyKind::response);
  session.study.band.wanted = true;
  session.frames();
  REQUIRE(session.study.band.computed.found);
  const FoundBand& found = session.study.band.computed.found->result;
  CHECK(found.stretches.size() >= 2);
  std::size_t places = 0;
  for (const BandStretch& stretch : found.stretches)
    places += stretch.count;
  CHECK(places == found.band.points.size());
  const std::string words = band_words(session);
  INFO(words);
  CHECK_THAT(words, ContainsSubstring("not all follow: up to "));
  const double leaves = 3.7429;
  for (const BandPoint& point : found.band.points) {
    CAPTURE(point.number, point.samples(), point.others());
    if (point.number < leaves - 0.21 || point.number > leaves + 0.21) {
      CHECK(point.samples() == band_samples);
      CHECK(point.others() == 0);
    }
  }
  choose_quantity(session, {"growth", "largest real part", "Eigenvalues", "1/s", 1});
  CHECK_THAT(band_words(session), ContainsSubstring("no band of what is shown"));
}
