// Every long computation ends at once when it is asked to, whatever it is in the midst of.
#include "tests/bench/large_scenes.hpp"
#include "tests/catch.hpp"
#include "tests/support/campaign.hpp"
#include "tests/time_to_stop.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/fold_curve.hpp"
#include "engine/study/sweep.hpp"

#include <functional>
#include <random>

using namespace flyball;
using flyball::test::few_or_all;
using flyball::test::time_to_stop;

namespace {

const std::string speed = "joints.spin.drive.speed";

struct Computation {
  const char* name;
  std::function<void(const Mechanism&, const std::atomic<bool>&)> run;
};

std::vector<Computation> computations() {
  return {
      {"solve with eigenvalues",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         SolveOptions options;
         options.modes = 20;
         options.cancel = &cancel;
         (void)Analysis(m).solve(options);
       }},
      {"solve --all",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         SolveOptions options;
         options.cancel = &cancel;
         (void)Analysis(m).solve_all(options);
       }},
      {"branch --all",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         BranchOptions options;
         options.all = true;
         options.cancel = &cancel;
         (void)follow_branches(m, speed, 1, 8, options);
       }},
      {"design",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         DesignOptions options;
         options.cancel = &cancel;
         (void)design(m, speed, 1, 8, m.joints[1].name, 0.1, options);
       }},
      {"curves of folds",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         PlaneOptions options;
         options.cancel = &cancel;
         (void)fold_curves(m, {speed, 1, 8}, {"gravity.1", -12, -8}, options);
       }},
      {"map",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         const std::array variations{Variation{speed, 1, 8, 40}, Variation{"gravity.1", -12, -8, 40}};
         (void)sweep(m, variations, 1, {}, &cancel);
       }},
      {"compare",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         CompareOptions options;
         options.cancel = &cancel;
         (void)compare(m, options);
       }},
      {"simulate",
       [](const Mechanism& m, const std::atomic<bool>& cancel) {
         SimulationOptions options;
         options.cancel = &cancel;
         (void)simulate(m, options);
       }},
  };
}

// Dampers and drag, so that neither potential nor symmetry shortens the work.
Mechanism with_losses(Mechanism m) {
  m.name = "Chain with losses";
  for (std::size_t i = 1; i < m.joints.size(); i += 7)
    m.joints[i].coordinates[0].damping = 1e-4;
  Force& drag = m.forces.emplace_back();
  drag.name = "air";
  drag.type = ForceType::drag;
  drag.body = m.bodies.back().name;
  drag.at = m.bodies.back().position;
  drag.linear = 1e-4;
  return m;
}

// How long (s of processor time) each study goes on when it is asked to stop in the midst of its first
// `longest` seconds.
void check_cancelling(double most, double longest) {
  std::mt19937 random(20);
  for (const int links : {200, 1000})
    for (const Mechanism& m : {bench::chain(links, 3), with_losses(bench::chain(links, 3))})
      for (const Computation& computation : computations()) {
        const double after = longest * static_cast<double>(random()) / 4294967296.;
        INFO(m.name << " of " << links << ", " << computation.name << " asked to stop after " << after
                    << " s");
        const auto took =
            time_to_stop(after, [&](const std::atomic<bool>& cancel) { computation.run(m, cancel); });
        if (!took) continue; // it was quick
        UNSCOPED_INFO("ended after " << *took << " s");
        CHECK(*took < most);
      }
}

} // namespace

TEST_CASE("every study of a chain ends when it is asked to") {
  check_cancelling(0.5, few_or_all(0.15, 0.6)); // whatever else the machine does
}

TEST_CASE("every study of a chain ends within 50 ms of being asked to", "[.cancel]") {
  check_cancelling(0.05, 0.6);
}
