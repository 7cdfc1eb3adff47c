// Trajectories of open trees against MuJoCo's.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/mujoco_reference.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include <set>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("open trees move as MuJoCo moves them") {
  if (!reference::mujoco_available()) {
    WARN("skipped: MuJoCo is not installed (libmujoco-dev)");
    return;
  }
  std::set<JointType> seen;
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    CAPTURE(seed);
    reference::RandomOptions options;
    options.drives = reference::RandomDrives::none;
    options.steady = options.forces = options.stops = options.massless = false;
    options.bodies = 2 + static_cast<int>(seed % 5);
    Mechanism m = reference::random_mechanism(seed, options);
    std::vector<std::pair<std::string, double>> rates;
    double dice = 0.3 + 0.1 * seed;
    for (Joint& joint : m.joints) {
      seen.insert(joint.type);
      for (int i = 0; i < coordinate_count(joint.type); ++i) {
        Coordinate& c = joint.coordinates[static_cast<std::size_t>(i)];
        if (is_rotation_vector(joint.type, i)) { // MuJoCo's ball means something else by springs
          c.spring.reset();
          c.damping = 0;
        } else {
          dice += 0.37;
          rates.emplace_back(coordinate_name(joint, i), 2 * std::sin(7 * dice));
        }
      }
    }
    REQUIRE(reference::mujoco_can_hold(m));
    const double duration = 0.3;
    SimulationOptions o = lasting(duration, Integrator::runge_kutta, 1e-11);
    o.kick = rates;
    const Run run = simulate(m, o);
    check_sound(run, 1e-6);
    const std::vector<Pose> ours = poses_at(run, duration);
    const auto away = [&](double step) {
      const std::vector<Pose> theirs = reference::mujoco_motion(m, rates, duration, step);
      REQUIRE(ours.size() == theirs.size());
      double worst = 0;
      for (std::size_t i = 0; i < ours.size(); ++i)
        worst = std::max({worst, (ours[i].position - theirs[i].position).norm(),
                          ours[i].rotation.angularDistance(theirs[i].rotation * m.bodies[i].rotation)});
      return worst;
    };
    const double coarse = away(1e-4), fine = away(5e-5);
    CHECK(fine < 1e-6);
    // What is left is MuJoCo's: it falls with the square of its step.
    if (fine > 1e-9) CHECK(fine < 0.3 * coarse);
  }
  CHECK(seen.size() == 8);
}
