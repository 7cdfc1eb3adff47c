#include "engine/study/sweep.hpp"

#include "engine/mechanism/error.hpp"

#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

namespace flyball {

// Of a point from which no steady state is found, see SolveOptions::search: a map has thousands.
constexpr double search = 0.05; // s

double Variation::value(int i) const {
  if (count < 2 || i == 0) return from;
  if (i == count - 1) return to;
  return from + (to - from) * i / (count - 1);
}

std::vector<SweepPoint> sweep(const Mechanism& mechanism, std::span<const Variation> variations, int threads,
                              const std::function<void(std::size_t, std::size_t)>& progress,
                              const std::atomic<bool>* cancel) {
  std::size_t total = 1;
  for (const Variation& v : variations)
    total *= static_cast<std::size_t>(std::max(1, v.count));
  std::vector<SweepPoint> points(total);
  for (std::size_t i = 0; i < total; ++i) {
    points[i].parameters.resize(variations.size());
    points[i].solution.message = "The sweep was cancelled before this point.";
    std::size_t rest = i;
    for (std::size_t v = variations.size(); v-- > 0;) {
      const auto count = static_cast<std::size_t>(std::max(1, variations[v].count));
      points[i].parameters[v] = variations[v].value(static_cast<int>(rest % count));
      rest /= count;
    }
  }

  // A mistake of one point is one of all, unless expressions make the mechanism from the numbers.
  const bool geometry_varies = !mechanism.parameters.empty() || !mechanism.points.empty();
  std::vector<std::string> addresses;
  for (const Variation& variation : variations)
    addresses.push_back(variation.address);
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> stop = false; // a failure
  const auto cancelled = [&] { return stop || (cancel && cancel->load(std::memory_order_relaxed)); };
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      Analysis analysis(mechanism);
      analysis.vary(addresses);
      for (std::size_t i; !cancelled() && (i = next++) < total; ++done) {
        try {
          analysis.set(points[i].parameters);
        } catch (const SceneError& error) {
          if (!geometry_varies) throw;
          points[i].solution.status = Status::infeasible; // a parameter of which no mechanism can be made
          points[i].solution.message = error.what();
          continue;
        }
        SolveOptions options;
        options.details = false;
        options.search = search;
        options.cancel = cancel ? cancel : &stop;
        points[i].solution = analysis.solve(options);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };
  const auto cores = static_cast<std::size_t>(std::max(1u, std::thread::hardware_concurrency()));
  const std::size_t count = std::min(total, threads > 0 ? static_cast<std::size_t>(threads) : cores);
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 1; i < count; ++i)
      workers.emplace_back(work);
    if (progress) {
      workers.emplace_back(work);
      while (!cancelled() && done < total) {
        progress(done, total);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
      progress(done, total);
    } else {
      work();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return points;
}

} // namespace flyball
