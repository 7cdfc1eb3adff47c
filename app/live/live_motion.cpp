#include "app/live/live_motion.hpp"

#include "engine/dynamics/joined.hpp"
#include "engine/dynamics/simulator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

namespace flyball {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double slice = 0.02; // s of computing between looks at what else is wanted
constexpr double apart = 0.04; // s between two pieces of news, at least
constexpr double share = 10;   // copying the run must take no more than one part in so many of the time

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

struct LiveMotion::State {
  struct Job {
    std::uint64_t ticket = 0;
    std::shared_ptr<const Mechanism> mechanism;
    SimulationOptions options;
    std::shared_ptr<const Run> before; // to go on from; or null
    double time = 0;
  };

  State(LiveSolver::Mode chosen, std::function<void()> callback)
      : mode(chosen), on_news(std::move(callback)) {}

  // Returns the ticket. In immediate mode it is computed before.
  std::uint64_t ask(Job job);
  void work(const std::stop_token& stop);
  void compute(Job job);
  void publish(MotionNews fresh);

  std::atomic<bool> cancel{false};
  const LiveSolver::Mode mode;
  Callback on_news;

  std::mutex mutex; // guards all below
  std::condition_variable_any wake;
  std::uint64_t tickets = 0, stopped = 0;
  bool running = false;
  std::optional<Job> next;
  std::optional<MotionNews> news;
};

LiveMotion::LiveMotion(LiveSolver::Mode mode, std::function<void()> on_news)
    : state_(std::make_shared<State>(mode, std::move(on_news))) {
  if (mode == LiveSolver::Mode::background)
    thread_ = Worker([state = state_](const std::stop_token& stop) { state->work(stop); });
}

LiveMotion::~LiveMotion() {
  state_->on_news.silence();
  const std::lock_guard lock(state_->mutex);
  state_->cancel = true;
  state_->next.reset();
}

std::uint64_t LiveMotion::start(std::shared_ptr<const Mechanism> mechanism, SimulationOptions options) {
  return state_->ask({0, std::move(mechanism), std::move(options), nullptr, 0});
}

std::uint64_t LiveMotion::go_on(std::shared_ptr<const Mechanism> mechanism, SimulationOptions options,
                                std::shared_ptr<const Run> run, double time) {
  return state_->ask({0, std::move(mechanism), std::move(options), std::move(run), time});
}

std::uint64_t LiveMotion::State::ask(Job job) {
  std::unique_lock lock(mutex);
  const std::uint64_t ticket = job.ticket = ++tickets;
  news.reset();
  if (mode == LiveSolver::Mode::immediate) {
    cancel = false;
    lock.unlock();
    compute(std::move(job));
    return ticket;
  }
  cancel = true;
  next = std::move(job);
  lock.unlock();
  wake.notify_one();
  return ticket;
}

void LiveMotion::stop() {
  const std::lock_guard lock(state_->mutex);
  state_->cancel = true;
  state_->stopped = state_->tickets; // also if it has not begun
}

std::optional<MotionNews> LiveMotion::take() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->news, std::nullopt);
}

bool LiveMotion::running() const {
  const std::lock_guard lock(state_->mutex);
  return state_->running || state_->next;
}

void LiveMotion::State::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex);
  while (wake.wait(lock, stop, [this] { return next.has_value(); })) {
    if (stop.stop_requested()) return;
    Job job = *std::exchange(next, std::nullopt);
    cancel = stop.stop_requested() || job.ticket <= stopped;
    running = true;
    lock.unlock();
    compute(std::move(job));
    lock.lock();
    running = false;
  }
}

// News of a run that was replaced meanwhile are dropped.
void LiveMotion::State::publish(MotionNews fresh) {
  {
    const std::lock_guard lock(mutex);
    if (fresh.ticket != tickets) return;
    if (fresh.finished) running = false;
    news = std::move(fresh);
  }
  on_news();
}

void LiveMotion::State::compute(Job job) {
  SimulationOptions& options = job.options;
  options.cancel = &cancel;
  options.progress = {};
  std::size_t last = 0;
  double duration = options.duration;
  try {
    if (job.before && job.before->time.empty()) job.before = nullptr;
    if (job.before) {
      last = sample_before(*job.before,
                           job.time + 1e-9 * (1 + std::abs(job.time))); // a sample that is meant counts
      duration -= job.before->time[last] - job.before->time.front();
      options.start = Start::state;
      options.state = state_at(*job.before, last);
    }
    Simulator simulator(*job.mechanism, options);
    if (simulator.run().time.empty()) // cancelled before it began
      return publish({job.ticket, job.before, true, simulator.run().message});
    const double begin = simulator.time(), end = begin + std::max(duration, 0.);
    const auto send = [&](bool finished) {
      auto run = std::make_shared<const Run>(job.before ? joined(*job.before, last, simulator.run())
                                                        : simulator.run());
      publish({job.ticket, std::move(run), finished, {}});
    };
    double step = options.rate > 0 ? 1 / options.rate : end - begin, wait = apart;
    auto told = Clock::now();
    bool well = true;
    for (double until = begin; well && until < end;) {
      const auto started = Clock::now();
      until = std::min(end, until + step);
      well = simulator.advance(until, until == end);
      const double took = since(started);
      if (options.rate > 0) step *= std::clamp(slice / std::max(took, 1e-6), 0.5, 2.);
      if (well && until < end && since(told) > wait) {
        const auto copying = Clock::now();
        send(false);
        wait = std::max(apart, share * since(copying));
        told = Clock::now();
      }
    }
    send(true);
  } catch (const std::exception& error) { // SceneError, or no memory
    publish({job.ticket, job.before, true, error.what()});
  }
}

} // namespace flyball
