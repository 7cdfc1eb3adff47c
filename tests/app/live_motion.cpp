#include "app/live/motion.hpp"

#include "engine/dynamics/joined.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

std::shared_ptr<const Mechanism> shared(const Mechanism& mechanism) {
  return std::make_shared<const Mechanism>(mechanism);
}

SimulationOptions lasting(double duration) {
  SimulationOptions options;
  options.duration = duration;
  options.tolerance = 1e-9;
  return options;
}

const CoordinateTrack& track(const Run& run, std::string_view joint) {
  return *std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
}

using Motions = Background<Motion>;

void start(Motions& motions, MotionRequest request) {
  motions.start([request = std::move(request)](const TaskContext<Motion>& context) {
    return compute_motion(request, context);
  });
}
void start(Motions& motions, const Mechanism& mechanism, const SimulationOptions& options) {
  start(motions, {shared(mechanism), options, nullptr});
}

// The last of it, waited for with a limit.
Motion finished(Motions& motions) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < limit) {
    if (const auto news = motions.take(); news && news->result->finished) return *news->result;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  FAIL("no end within a minute");
  return {};
}

} // namespace

TEST_CASE("a motion in the background is the motion") {
  const Mechanism governor = shipped("governor");
  const Run whole = simulate(governor, lasting(3));
  for (const auto mode : {BackgroundWorker::Mode::background, BackgroundWorker::Mode::immediate}) {
    Motions live(mode);
    start(live, governor, lasting(3));
    const Motion news = finished(live);
    REQUIRE(news.run);
    CHECK(news.problem.empty());
    CHECK(news.run->time == whole.time);
    CHECK(track(*news.run, "slide").value == track(whole, "slide").value);
    CHECK_FALSE(live.running());
  }
}

TEST_CASE("a whole run is published before the state that it rests in is looked for") {
  const std::atomic<bool> cancel{false};
  Motion last;
  const auto publish = [&](Motion motion) { last = std::move(motion); };
  const Motion end = compute_motion({shared(shipped("governor")), lasting(3), nullptr},
                                    {.cancel = cancel, .progress = {}, .publish = publish});
  CHECK(last.run == end.run);
  CHECK_FALSE(last.finished);
}

TEST_CASE("a motion ends where it would take too much memory, and says so") {
  MotionRequest request{shared(shipped("governor")), lasting(1e9), nullptr};
  request.most_memory = 8'000'000;
  Motions live(BackgroundWorker::Mode::immediate);
  start(live, request);
  const Motion end = finished(live);
  REQUIRE(end.run);
  CHECK(end.problem.find("too much memory") != std::string::npos);
  CHECK(end.problem.find(rounded_text(end.run->time.back(), 6) + " s") != std::string::npos);
  CHECK(memory_of(*end.run) > request.most_memory);
  CHECK(memory_of(*end.run) < 2 * request.most_memory);
  // A shorter one is whole.
  request.options.duration = 20;
  start(live, request);
  CHECK(finished(live).problem.empty());
}

TEST_CASE("a long motion is told of as it grows, and can be stopped") {
  Motions live(BackgroundWorker::Mode::background);
  SimulationOptions options = lasting(1e6);
  options.damped = false;
  start(live, shipped("pendulum"), options);
  std::vector<double> reached;
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (reached.size() < 3 && std::chrono::steady_clock::now() < limit)
    if (const auto news = live.take()) reached.push_back(news->result->run->time.back());
  REQUIRE(reached.size() == 3);
  CHECK(reached[0] < reached[1]);
  CHECK(reached[1] < reached[2]);
  CHECK(live.running());
  live.cancel();
  const Motion last = finished(live);
  REQUIRE(last.run);
  CHECK(last.run->status == RunStatus::cancelled);
  CHECK(last.run->time.back() >= reached[2]);
  CHECK(last.run->time.back() < 1e6);
}

TEST_CASE("a motion that is stopped in the midst of a step keeps what it has") {
  SimulationOptions options = lasting(1e6);
  options.damped = false;
  for (int round = 0; round < 20; ++round) {
    Motions live(BackgroundWorker::Mode::background);
    start(live, shipped("governor"), options);
    while (!live.take())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::microseconds(100 * round));
    live.cancel();
    const Motion last = finished(live);
    REQUIRE(last.run);
    CHECK(last.run->status == RunStatus::cancelled);
    CHECK(last.problem.empty());
  }
}

TEST_CASE("a newer motion takes the place of the one that runs") {
  Motions live(BackgroundWorker::Mode::background);
  SimulationOptions endless = lasting(1e6);
  endless.damped = false;
  start(live, shipped("pendulum"), endless);
  start(live, shipped("governor"), lasting(0.5));
  const Motion news = finished(live);
  REQUIRE(news.run);
  CHECK(news.run->time.back() == Approx(0.5));
  CHECK(track(*news.run, "slide").value.size() == 51);
}

TEST_CASE("a motion goes on from any moment with other numbers") {
  Mechanism governor = shipped("governor");
  Motions live(BackgroundWorker::Mode::immediate);
  start(live, governor, lasting(4));
  const Motion first = finished(live);
  REQUIRE(first.run);
  set_parameter(governor, "joints.spin.drive.speed", 14);
  start(live, {shared(governor), lasting(4), first.run, 1.507});
  const Motion second = finished(live);
  REQUIRE(second.run);
  const Run &before = *first.run, &run = *second.run;
  REQUIRE(run.time.size() == before.time.size());
  CHECK(run.time.back() == Approx(4));
  const std::size_t last = sample_before(before, 1.507);
  CHECK(before.time[last] == Approx(1.5));
  // Up to there it is what it was; from there it is the motion from that state.
  SimulationOptions from = lasting(2.5);
  from.start = Start::state;
  from.state = state_at(before, last);
  const Run tail = simulate(governor, from);
  for (const char* joint : {"slide", "spin"})
    for (std::size_t i = 0; i < run.time.size(); ++i) {
      const double expected = i <= last ? track(before, joint).value[i] : track(tail, joint).value[i - last];
      CHECK(track(run, joint).value[i] == Approx(expected).margin(1e-12));
    }
  CHECK(std::ranges::is_sorted(run.time));
  CHECK(run.energy.delivered[last + 1] == Approx(before.energy.delivered[last] + tail.energy.delivered[1]));
  for (const double b : run.energy.balance)
    CHECK(std::abs(b) < 1e-4);
  // Poses come from either part.
  CHECK(poses_at(run, 1.2)[1].position.isApprox(poses_at(before, 1.2)[1].position, 1e-14));
  CHECK(poses_at(run, 3.2)[1].position.isApprox(poses_at(tail, 3.2)[1].position, 1e-12));
}

TEST_CASE("a motion of a microsecond goes on from the very sample that is meant") {
  Mechanism governor = shipped("governor");
  SimulationOptions options = lasting(1e-6);
  options.rate = 2e9; // as a window samples it
  Motions live(BackgroundWorker::Mode::immediate);
  start(live, governor, options);
  const Motion first = finished(live);
  REQUIRE(first.run);
  const std::vector<double>& times = first.run->time;
  REQUIRE(times.size() == 2001);
  set_parameter(governor, "joints.spin.drive.speed", 14);
  const std::size_t last = 700;
  const double distance = times[last + 1] - times[last];
  for (const double time : {times[last], times[last] + 0.4 * distance, times[last] - 1e-9 * distance}) {
    CAPTURE(time);
    CHECK(sample_before(*first.run, time) == last);
    start(live, {shared(governor), options, first.run, time});
    const Motion second = finished(live);
    REQUIRE(second.run);
    REQUIRE(second.run->segments.size() == first.run->segments.size() + 1);
    CHECK(second.run->segments.back().first == last);
    CHECK(second.run->time.size() == times.size());
    CHECK(second.run->time.back() == Approx(1e-6).epsilon(1e-12));
  }
}

TEST_CASE("a motion that cannot begin says why") {
  const Mechanism crank = shipped("governor");
  SimulationOptions options = lasting(1);
  options.start = Start::state;
  options.state.coordinates = {{"nothing", 0, 1, 0}};
  Motions live(BackgroundWorker::Mode::background);
  start(live, crank, options);
  const Motion news = finished(live);
  CHECK(news.problem.size() > 10);
  CHECK_FALSE(news.run);
}
