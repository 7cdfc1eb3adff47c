// A mechanism solved over a grid of parameter values. Every point is solved from the drawn pose, so that a
// row says the same as a solve of its own would, in whatever order the rows were computed.
#pragma once

#include "engine/periodic/periodic_state.hpp"
#include "engine/report/analysis.hpp"

#include <functional>
#include <span>

namespace flyball {

// s, SolveOptions::search of each of the points of a study, of which there may be thousands.
inline constexpr double point_search = 0.05;

struct Variation {
  std::string address;
  double from = 0, to = 0;
  int count = 2; // values, ends included; 1: `from` alone
  double value(int i) const;
  bool operator==(const Variation&) const = default;
};

struct SweepPoint {
  std::vector<double> parameters; // by variation
  Solution solution;              // without details
  // Of solve_all: how many there are here, and which of them this is, from zero.
  std::size_t equilibria = 0, equilibrium = 0;
  // Of solve_periodic: the motion that takes the place of a steady state, where a search looked for one.
  std::optional<PeriodicState> periodic{};
};

// How many combinations there are, and the values of one of them, the last variation moving fastest.
std::size_t grid_size(std::span<const Variation> variations);
std::vector<double> grid_values(std::span<const Variation> variations, std::size_t i);

// Throws SceneError where a number is there twice.
void expect_each_once(std::span<const std::string> addresses);

// Solves points of a grid one after the other, in any order; for one thread.
class GridSolver {
 public:
  // Throws SceneError for an address that the mechanism does not take.
  GridSolver(const Mechanism& mechanism, std::span<const Variation> variations);

  // Throws SceneError for a value that the mechanism does not take, unless expressions make it from
  // parameters: then it is one of the point's. `cancel` is polled between iterations; the point is then
  // not_converged.
  SweepPoint solve(std::size_t i, const std::atomic<bool>* cancel = nullptr);
  // All equilibria that a bounded search finds (Analysis::solve_all, by the search's options), each a point.
  // Where there are none, one point that says why, as solve() does.
  std::vector<SweepPoint> solve_all(std::size_t i, const SolveOptions& search);
  // As solve(), and the periodic motion in place of the steady state where drives make the balance turn; also
  // a stable one where the steady state is unstable. Cancelled, what was found of either stays.
  SweepPoint solve_periodic(std::size_t i, const std::atomic<bool>* cancel = nullptr);

 private:
  // False where no mechanism can be made of its numbers, as the point then says.
  bool set(std::size_t i, SweepPoint& point);

  Mechanism mechanism_;
  std::vector<Variation> variations_;
  Analysis analysis_;
  bool geometry_varies_;
};

// All combinations. Uses up to `threads` threads (0: all cores); `progress` is called from the calling thread
// with the number of points done. `cancel` is polled between points and iterations; points that were not
// reached are then not_converged. Throws SceneError for an address or a value that the mechanism does not
// take.
std::vector<SweepPoint> sweep(const Mechanism& mechanism, std::span<const Variation> variations,
                              int threads = 0,
                              const std::function<void(std::size_t done, std::size_t all)>& progress = {},
                              const std::atomic<bool>* cancel = nullptr);

} // namespace flyball
