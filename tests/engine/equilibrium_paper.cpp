// The paper's two mechanisms, as shipped, from the paper's initial values to the last digits.
#include "tests/engine/equilibrium_mechanisms.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

struct Wanted {
  std::string joint;
  double value;
};

struct Example {
  std::string scene;
  std::vector<std::pair<std::string, double>> changes;
  std::vector<Wanted> wanted;
};

// Worked out independently of any engine, in extended precision.
const std::vector<Example> examples{
    {"pendulum", {}, {{"theta", 0.45377171949723577}, {"d", 1.0153129043019644}}},
    {"governor",
     {},
     {{"arm1", 0.7856156814882422}, {"arm2", 0.7856156814882422}, {"slide", 0.1500174581252971}}},
    {"governor",
     {{"gravity.1", -9.81}},
     {{"arm1", 0.7857110273452537}, {"arm2", 0.7857110273452537}, {"slide", 0.1500261156008845}}},
};

// Residuals r of a Newton-Raphson run shrink quadratically if, once below 1e-2 and until rounding takes over,
// each step at least gains half again as many digits as are there: r_next <= r^1.5. Linear convergence
// (r_next = r / 10, say) fails this from the second step on. Counts the steps that show it.
int quadratic_steps(const std::vector<double>& history) {
  int steps = 0;
  for (std::size_t i = 0; i + 1 < history.size(); ++i) {
    if (history[i] > 1e-2 || history[i] < 1e-14) continue;
    if (history[i + 1] > std::max(std::pow(history[i], 1.5), 1e-14)) return -1;
    ++steps;
  }
  return steps;
}

} // namespace

TEST_CASE("the paper's mechanisms settle where it says, to 1e-12") {
  for (const Example& example : examples) {
    const Mechanism m = shipped(example.scene, example.changes);
    CAPTURE(example.scene, m.gravity.y());
    // As the paper starts them.
    if (example.scene == "pendulum") {
      CHECK(m.joints[1].coordinates[0].drawn == 0);
      CHECK(m.joints[2].coordinates[0].drawn == 1.1);
    } else {
      CHECK(m.joints[1].coordinates[0].drawn == 0);
      CHECK(m.joints[3].coordinates[0].drawn == 0.0744);
    }
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    CHECK(s.residual < 1e-14);
    CHECK(s.stable == true);
    CHECK(s.stability_reason == StabilityReason::minimum);
    CHECK(s.run_time_s > 0);
    for (const Wanted& w : example.wanted)
      check_value(s, w.joint, w.value);
  }
}

TEST_CASE("error estimates bound the true error and are not silly large") {
  for (const Example& example : examples) {
    const Solution s = solve(shipped(example.scene, example.changes));
    for (const Wanted& w : example.wanted) {
      const CoordinateSolution& c = coordinate(s, w.joint);
      CAPTURE(example.scene, w.joint, c.value, c.error);
      // The reference is itself rounded to a double.
      CHECK(std::abs(c.value - w.value) <= c.error + 1.2e-16 * std::abs(w.value));
      CHECK(c.error < 1e-14);
      CHECK(c.error > 0);
    }
    CHECK(coordinate(s, "spin").driven);
    CHECK(coordinate(s, "spin").error == 0);
  }
}

TEST_CASE("the reported history converges quadratically") {
  for (const Example& example : examples) {
    Analysis analysis(shipped(example.scene, example.changes));
    for (const bool near : {true, false}) {
      SolveOptions options;
      options.nearest = near;
      const Solution s = analysis.solve(options);
      CAPTURE(example.scene, near, s.history, s.message);
      REQUIRE(s.status == Status::converged);
      CHECK(s.history.size() == static_cast<std::size_t>(s.iterations) + 1);
      CHECK(s.history.back() < 1e-14);
      CHECK(s.iterations <= 12);
      CHECK(quadratic_steps(s.history) >= 2);
    }
  }
  // The criterion itself tells quadratic from linear.
  CHECK(quadratic_steps({1, 1e-1, 1e-2, 1e-4, 1e-8, 1e-16}) == 3);
  CHECK(quadratic_steps({1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) == -1);
  CHECK(quadratic_steps({1, 1e-3, 3e-5, 1e-5}) == -1);
}

TEST_CASE("a warm start from a neighbouring state agrees with a cold one") {
  for (const auto& [scene, address, from, to] :
       {std::tuple{"pendulum", "joints.spin.drive.speed", 19.5, 20.},
        std::tuple{"governor", "joints.spin.drive.speed", 10.9, 11.0174}}) {
    Analysis analysis(shipped(scene, {{address, from}}));
    REQUIRE(analysis.solve().status == Status::converged);
    const Mechanism there = shipped(scene, {{address, to}});
    analysis.update(there);
    SolveOptions warm;
    warm.warm = true;
    const Solution a = analysis.solve(warm), b = solve(there);
    REQUIRE(a.status == Status::converged);
    CHECK(a.iterations <= b.iterations);
    for (std::size_t i = 0; i < a.coordinates.size(); ++i)
      CHECK(std::abs(a.coordinates[i].value - b.coordinates[i].value) <=
            a.coordinates[i].error + b.coordinates[i].error);
  }
}
