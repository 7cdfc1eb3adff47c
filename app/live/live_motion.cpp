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

LiveMotion::LiveMotion(LiveSolver::Mode mode, std::function<void()> on_news)
    : mode_(mode), on_news_(std::move(on_news)) {
  if (mode_ == LiveSolver::Mode::background)
    thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

LiveMotion::~LiveMotion() {
  thread_.request_stop();
  const std::lock_guard lock(mutex_);
  cancel_ = true;
}

std::uint64_t LiveMotion::start(Mechanism mechanism, SimulationOptions options) {
  return ask({0, std::move(mechanism), std::move(options), nullptr, 0});
}

std::uint64_t LiveMotion::go_on(Mechanism mechanism, SimulationOptions options,
                                std::shared_ptr<const Run> run, double time) {
  return ask({0, std::move(mechanism), std::move(options), std::move(run), time});
}

std::uint64_t LiveMotion::ask(Job job) {
  std::unique_lock lock(mutex_);
  const std::uint64_t ticket = job.ticket = ++tickets_;
  news_.reset();
  if (mode_ == LiveSolver::Mode::immediate) {
    cancel_ = false;
    lock.unlock();
    compute(std::move(job));
    return ticket;
  }
  cancel_ = true;
  next_ = std::move(job);
  lock.unlock();
  wake_.notify_one();
  return ticket;
}

void LiveMotion::stop() {
  const std::lock_guard lock(mutex_);
  cancel_ = true;
  stopped_ = tickets_; // also if it has not begun
}

std::optional<MotionNews> LiveMotion::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, std::nullopt);
}

bool LiveMotion::running() const {
  const std::lock_guard lock(mutex_);
  return running_ || next_;
}

void LiveMotion::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return next_.has_value(); })) {
    if (stop.stop_requested()) return;
    Job job = *std::exchange(next_, std::nullopt);
    cancel_ = stop.stop_requested() || job.ticket <= stopped_;
    running_ = true;
    lock.unlock();
    compute(std::move(job));
    lock.lock();
    running_ = false;
  }
}

// News of a run that was replaced meanwhile are dropped.
void LiveMotion::publish(MotionNews news) {
  {
    const std::lock_guard lock(mutex_);
    if (news.ticket != tickets_) return;
    if (news.finished) running_ = false;
    news_ = std::move(news);
  }
  if (on_news_) on_news_();
}

void LiveMotion::compute(Job job) {
  SimulationOptions& options = job.options;
  options.cancel = &cancel_;
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
    Simulator simulator(job.mechanism, options);
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
