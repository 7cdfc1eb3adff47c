#include "engine/study/sweep.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/study/work_sharing.hpp"

#include <algorithm>
#include <memory>

namespace flyball {

double Variation::value(int i) const {
  if (count < 2 || i == 0) return from;
  if (i == count - 1) return to;
  return from + (to - from) * i / (count - 1);
}

std::size_t grid_size(std::span<const Variation> variations) {
  std::size_t size = 1;
  for (const Variation& v : variations)
    size *= static_cast<std::size_t>(std::max(1, v.count));
  return size;
}

std::vector<double> grid_values(std::span<const Variation> variations, std::size_t i) {
  std::vector<double> values(variations.size());
  for (std::size_t v = variations.size(); v-- > 0;) {
    const auto count = static_cast<std::size_t>(std::max(1, variations[v].count));
    values[v] = variations[v].value(static_cast<int>(i % count));
    i /= count;
  }
  return values;
}

void expect_each_once(std::span<const std::string> addresses) {
  for (auto each = addresses.begin(); each != addresses.end(); ++each)
    if (std::find(addresses.begin(), each, *each) != each)
      throw SceneError(*each, "expected another number: it is varied already");
}

GridSolver::GridSolver(const Mechanism& mechanism, std::span<const Variation> variations)
    : mechanism_(mechanism), variations_(variations.begin(), variations.end()), analysis_(mechanism),
      geometry_varies_(!mechanism.parameters.empty() || !mechanism.points.empty()) {
  std::vector<std::string> addresses;
  for (const Variation& variation : variations)
    addresses.push_back(variation.address);
  expect_each_once(addresses);
  analysis_.vary(addresses);
}

bool GridSolver::set(std::size_t i, SweepPoint& point) {
  point.parameters = grid_values(variations_, i);
  try {
    analysis_.set(point.parameters);
    return true;
  } catch (const SceneError& error) {
    if (!geometry_varies_) throw; // a mistake of one point is one of all
    point.solution.status = Status::infeasible;
    point.solution.message = error.what();
    return false;
  }
}

SweepPoint GridSolver::solve(std::size_t i, const std::atomic<bool>* cancel) {
  SweepPoint point;
  if (!set(i, point)) return point;
  SolveOptions options;
  options.details = false;
  options.search = point_search;
  options.cancel = cancel;
  point.solution = analysis_.solve(options);
  return point;
}

std::vector<SweepPoint> GridSolver::solve_all(std::size_t i, const SolveOptions& options) {
  SweepPoint point;
  if (!set(i, point)) return {point};
  SolveOptions all = options;
  all.details = false;
  std::vector<SweepPoint> points;
  std::vector<Solution> equilibria = analysis_.solve_all(all).equilibria;
  for (Solution& solution : equilibria)
    points.push_back({point.parameters, std::move(solution), equilibria.size(), points.size()});
  if (points.empty()) {
    points.push_back(solve(i, options.cancel)); // which says why
    points.front().equilibria = points.front().solution.status == Status::converged ? 1 : 0;
  }
  return points;
}

SweepPoint GridSolver::solve_periodic(std::size_t i, const std::atomic<bool>* cancel) {
  SweepPoint point = solve(i, cancel);
  const bool leaves = point.solution.status == Status::converged && point.solution.stable == false;
  if (!leaves && point.solution.status != Status::no_steady_state) return point;
  std::vector<ParameterValue> numbers;
  for (std::size_t v = 0; v < variations_.size(); ++v)
    numbers.push_back({variations_[v].address, point.parameters[v]});
  set_parameters(mechanism_, numbers);
  PeriodicOptions options;
  options.cancel = cancel;
  point.periodic = find_periodic_state(mechanism_, options);
  if (leaves && (point.periodic->status != PeriodicStatus::found || point.periodic->stable != true))
    point.periodic.reset();
  return point;
}

std::vector<SweepPoint> sweep(const Mechanism& mechanism, std::span<const Variation> variations, int threads,
                              const std::function<void(std::size_t, std::size_t)>& progress,
                              const std::atomic<bool>* cancel) {
  std::vector<SweepPoint> points(grid_size(variations));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].parameters = grid_values(variations, i);
    points[i].solution.message = "The sweep was cancelled before this point.";
  }
  SharedWork work;
  work.count = points.size();
  work.maker = [&]() -> BlockMaker {
    return [&, solver = std::make_shared<GridSolver>(mechanism, variations)](std::size_t begin,
                                                                             std::size_t end) {
      for (std::size_t i = begin; i < end && !(cancel && cancel->load(std::memory_order_relaxed)); ++i)
        points[i] = solver->solve(i, cancel);
      return std::string(); // all is told
    };
  };
  work.progress = progress;
  work.cancel = cancel;
  ThreadSharing(threads).run(work);
  return points;
}

} // namespace flyball
