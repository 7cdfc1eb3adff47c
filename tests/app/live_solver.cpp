#include "app/live/live_solver.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

// A shipped scene at this speed of its drive "spin" (rad/s).
std::shared_ptr<const Mechanism> driven(const std::string& name, double speed) {
  Mechanism mechanism = shipped(name);
  set_parameter(mechanism, "joints.spin.drive.speed", speed);
  return std::make_shared<const Mechanism>(std::move(mechanism));
}

std::shared_ptr<const Mechanism> governor(double speed) {
  return driven("governor", speed);
}

// News from the background thread, waited for with a limit.
class News {
 public:
  void tell() {
    const std::lock_guard lock(mutex_);
    ++told_;
    wake_.notify_all();
  }
  template <class Done>
  bool wait(const Done& done) {
    std::unique_lock lock(mutex_);
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done()) {
      if (std::chrono::steady_clock::now() > limit) return false;
      wake_.wait_for(lock, std::chrono::milliseconds(20));
    }
    return true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  int told_ = 0;
};

} // namespace

TEST_CASE("the immediate mode answers before ask returns") {
  LiveSolver live(LiveSolver::Mode::immediate);
  CHECK(live.ask({.mechanism = governor(11.0174), .another = true}) == 1);
  CHECK_FALSE(live.busy());
  const auto answer = live.take_answer();
  REQUIRE(answer);
  CHECK(answer->ticket == 1);
  CHECK(value(answer->solution, "slide") == Approx(0.1500174581252971).epsilon(1e-12));
  CHECK_FALSE(live.take_answer());
  live.ask_poses(0.1);
  const auto poses = live.take_poses();
  REQUIRE(poses);
  CHECK(poses->poses.size() == answer->mechanism->bodies.size());
  CHECK(poses->ticket == 1);
}

TEST_CASE("the newest request wins, and whoever asks never waits for an answer") {
  News news;
  LiveSolver live(LiveSolver::Mode::background, [&] { news.tell(); });
  std::uint64_t last = 0;
  std::optional<LiveAnswer> newest;
  for (int i = 0; i < 300; ++i) {
    last = live.ask({.mechanism = governor(5 + 0.05 * i), .another = i == 0});
    live.ask_poses(0.01 * i);
    if (auto answer = live.take_answer()) {
      CHECK(answer->ticket <= last);
      CHECK((!newest || answer->ticket > newest->ticket));
      newest = std::move(answer);
    }
  }
  REQUIRE(news.wait([&] {
    if (auto answer = live.take_answer()) newest = std::move(answer);
    return newest && newest->ticket == last;
  }));
  CHECK_FALSE(live.busy());
  Solution direct = Analysis(governor(5 + 0.05 * 299)).solve();
  CHECK(value(newest->solution, "slide") == Approx(value(direct, "slide")).epsilon(1e-9));
  CHECK(get_parameter(*newest->mechanism, "joints.spin.drive.speed") == 5 + 0.05 * 299);
}

TEST_CASE("poses can be asked for while nothing is solved") {
  News news;
  LiveSolver live(LiveSolver::Mode::background, [&] { news.tell(); });
  live.ask({.mechanism = governor(10), .another = true});
  std::optional<LiveAnswer> answer;
  REQUIRE(news.wait([&] { return (answer = live.take_answer()).has_value(); }));
  // Half a turn of the spindle exchanges the balls.
  const double half_turn = 3.141592653589793 / 10;
  live.ask_poses(half_turn);
  std::optional<LivePoses> poses;
  REQUIRE(news.wait([&] { return (poses = live.take_poses()).has_value(); }));
  const auto one = static_cast<std::size_t>(body_index(*answer->mechanism, "ball1"));
  const auto two = static_cast<std::size_t>(body_index(*answer->mechanism, "ball2"));
  CHECK((poses->poses[one].position - answer->poses[two].position).norm() < 1e-9);
}

TEST_CASE("a mechanism is shared from the request to the answer") {
  LiveSolver live(LiveSolver::Mode::immediate);
  for (const double speed : {10., 11.}) { // the second as an update
    const auto mechanism = governor(speed);
    live.ask({.mechanism = mechanism});
    const auto answer = live.take_answer();
    REQUIRE(answer);
    CHECK(answer->mechanism == mechanism);
    CHECK(mechanism.use_count() == 3); // with the analysis
  }
}

TEST_CASE("another mechanism forgets the old one, and one that cannot be compiled says why") {
  LiveSolver live(LiveSolver::Mode::immediate);
  live.ask({.mechanism = governor(11), .another = true});
  Mechanism broken = *governor(11);
  broken.joints[0].bodies[1] = "nobody";
  live.ask({.mechanism = std::make_shared<const Mechanism>(broken), .another = true});
  const auto answer = live.take_answer();
  REQUIRE(answer);
  REQUIRE(answer->error);
  CHECK_THAT(answer->error->what(), ContainsSubstring("nobody"));
  CHECK(answer->poses.empty());
  live.ask_poses(1);
  CHECK_FALSE(live.take_poses());
}

TEST_CASE("a solver can be left in the middle of its work") {
  for (int i = 0; i < 20; ++i) {
    LiveSolver live(LiveSolver::Mode::background);
    for (int k = 0; k < 5; ++k) {
      live.ask({.mechanism = governor(5 + k), .another = k == 0});
      live.ask_poses(k);
    }
  }
}

namespace {

// Above the speed at which the straight state gets unstable (3.74 rad/s).
std::shared_ptr<const Mechanism> conical_pendulum(double speed) {
  return driven("conical_pendulum", speed);
}

} // namespace

TEST_CASE("a start leads to another branch, which is followed while the nearest is asked for") {
  LiveSolver live(LiveSolver::Mode::immediate);
  live.ask({.mechanism = conical_pendulum(6), .another = true});
  auto answer = live.take_answer();
  REQUIRE(answer);
  const double bent = value(answer->solution, "swing");
  CHECK(std::abs(bent) > 1);
  CHECK(answer->solution.stable == true);
  // The straight state, from near it.
  live.ask({.mechanism = conical_pendulum(6), .nearest = true, .start = {{"swing", 0.02}}});
  answer = live.take_answer();
  CHECK(std::abs(value(answer->solution, "swing")) < 1e-9);
  CHECK(answer->solution.stable == false);
  CHECK_FALSE(answer->left_branch);
  for (const double speed : {7., 9., 5.}) {
    live.ask({.mechanism = conical_pendulum(speed), .nearest = true});
    answer = live.take_answer();
    CHECK(std::abs(value(answer->solution, "swing")) < 1e-9);
    CHECK(answer->solution.stable == false);
  }
  // And the other bent one.
  live.ask({.mechanism = conical_pendulum(6), .nearest = true, .start = {{"swing", -bent}}});
  answer = live.take_answer();
  CHECK(value(answer->solution, "swing") == Approx(-bent));
  // Without the wish for the nearest it is left where it is unstable.
  live.ask({.mechanism = conical_pendulum(6), .nearest = true, .start = {{"swing", 0.02}}});
  live.ask({.mechanism = conical_pendulum(6.1), .warm = false});
  answer = live.take_answer();
  CHECK(std::abs(value(answer->solution, "swing")) > 1);
}

TEST_CASE("a start survives the requests that come before it was solved") {
  LiveSolver live(LiveSolver::Mode::background);
  for (int round = 0; round < 20; ++round) {
    live.ask({.mechanism = conical_pendulum(6), .another = true});
    live.ask({.mechanism = conical_pendulum(6), .nearest = true, .start = {{"swing", 0.02}}});
    std::uint64_t last = 0;
    for (int i = 1; i <= 5; ++i)
      last = live.ask({.mechanism = conical_pendulum(6 + 0.1 * i), .nearest = true});
    std::optional<LiveAnswer> answer;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while ((!answer || answer->ticket < last) && std::chrono::steady_clock::now() < limit) {
      if (auto news = live.take_answer()) answer = std::move(news);
      std::this_thread::yield();
    }
    REQUIRE(answer);
    REQUIRE(answer->ticket == last);
    CHECK(std::abs(value(answer->solution, "swing")) < 1e-9);
  }
}

TEST_CASE("a pull that is given up while its grip is found leaves the state where it was") {
  LiveSolver live(LiveSolver::Mode::background);
  const auto answer_to = [&](std::uint64_t ticket) {
    std::optional<LiveAnswer> answer;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while ((!answer || answer->ticket < ticket) && std::chrono::steady_clock::now() < limit) {
      if (auto news = live.take_answer()) answer = std::move(news);
      std::this_thread::yield();
    }
    REQUIRE(answer);
    REQUIRE(answer->ticket == ticket);
    return *std::move(answer);
  };
  // The bent state that the drawn pose does not lead to; only what was solved last leads on to it.
  const double bent =
      value(answer_to(live.ask({.mechanism = conical_pendulum(6), .another = true})).solution, "swing");
  REQUIRE(bent > 1);
  const auto other =
      answer_to(live.ask({.mechanism = conical_pendulum(6), .nearest = true, .start = {{"swing", -bent}}}));
  REQUIRE(value(other.solution, "swing") == Approx(-bent));
  // How long it takes undisturbed, so that it is given up at every part of it, also while it looks for a
  // grip.
  using Clock = std::chrono::steady_clock;
  const auto pull = [](int round) {
    return LiveRequest{.mechanism = conical_pendulum(6 + 1e-3 * (round % 7)), .grip = BodyPoint{"ball"}};
  };
  const auto begin = Clock::now();
  answer_to(live.ask(pull(1)));
  const auto whole = Clock::now() - begin;
  constexpr int parts = 100;
  for (int round = 0; round < 5 * parts; ++round) {
    const LiveRequest first = pull(round), second{.mechanism = conical_pendulum(6 + 1e-3 * (round % 5))};
    const auto later = Clock::now() + whole * (round % parts) / parts;
    live.ask(first);
    while (Clock::now() < later)
      ;
    const LiveAnswer answer = answer_to(live.ask(second));
    INFO(round);
    REQUIRE(value(answer.solution, "swing") < -1);
  }
}
