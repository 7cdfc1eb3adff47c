// Motion along a tree: the same as by the dense equations, at any size.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/dynamics_forms.hpp"
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

using namespace flyball;
using namespace flyball::test;
using reference::RandomDrives;
using reference::RandomOptions;

namespace {

bool is_tree(const System& system) {
  return system.rows == 0 && system.nv > 0 && (!has_pairs(system) || no_drive_rides(system));
}

RandomOptions trees(std::uint32_t seed) {
  RandomOptions o;
  o.bodies = 7;
  o.steady = false;
  o.massless = false;
  o.drives = static_cast<RandomDrives>(seed % 3);
  o.air = seed % 4 == 1;
  return o;
}

} // namespace

TEST_CASE("accelerations and drive torques along a tree are those of the dense equations") {
  int compared = 0, drives = 0, with_balls = 0, with_drag = 0, with_stops = 0, with_springs = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const Mechanism mechanism = reference::random_mechanism(seed, trees(seed));
    Motion dense(mechanism, Form::dense), tree(mechanism, Form::tree);
    if (!is_tree(tree.model.system)) continue;
    CAPTURE(seed, tree.model.system.nv);
    dense.stir(seed, 1);
    tree.stir(seed, 1);
    const bool along = dynamic_cast<TreeMotion*>(&tree.equations->solver());
    const double k = condition(dense);
    if (!along || k > 1e8) continue;
    const Eigen::VectorXd& column = tree.model.scaling.column;
    const Eigen::VectorXd a = dense.equations->acceleration().cwiseQuotient(column),
                          b = tree.equations->acceleration().cwiseQuotient(column);
    CHECK(size_of(a - b) <= 1e-13 * k * size_of(a));
    double power = 0, difference = 0;
    for (std::size_t d = 0; d < tree.model.system.drives.size(); ++d) {
      const double one = dense.equations->drive_force(static_cast<int>(d)),
                   other = tree.equations->drive_force(static_cast<int>(d));
      power = std::max(power, std::abs(one));
      difference = std::max(difference, std::abs(one - other));
    }
    CHECK(difference <= 1e-13 * k * (power + tree.equations->energy_scale()));
    ++compared;
    drives += static_cast<int>(tree.model.system.drives.size());
    with_balls += std::ranges::any_of(
        tree.model.system.links, [](const Link& l) { return l.v >= 0 && l.type == LinkType::spherical; });
    with_drag +=
        std::ranges::any_of(mechanism.forces, [](const Force& f) { return f.type == ForceType::drag; });
    with_stops += !list_stops(tree.model.system, tree.model.parameters).empty();
    with_springs += has_pairs(tree.model.system);
  }
  CAPTURE(compared, drives, with_balls, with_drag, with_stops, with_springs);
  CHECK(compared > 60);
  CHECK(drives > 60);
  CHECK(with_balls > 30);
  CHECK(with_drag > 15);
  CHECK(with_stops > 15);
  CHECK(with_springs > 15);
}

TEST_CASE("the matrix of implicit steps along a tree is that of the dense equations") {
  int compared = 0, with_balls = 0, by_quotients = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const Mechanism mechanism = reference::random_mechanism(seed, trees(seed));
    for (const double gamma : {1e-3, 3e-2}) {
      Motion dense(mechanism, Form::dense), tree(mechanism, Form::tree);
      if (!is_tree(tree.model.system) || has_pairs(tree.model.system)) break;
      CAPTURE(seed, gamma, tree.model.system.nv);
      const bool ball = std::ranges::any_of(
          tree.model.system.links, [](const Link& l) { return l.v >= 0 && l.type == LinkType::spherical; });
      // Of free rotations the dense equations leave out what their own spin adds.
      dense.stir(seed, 0);
      tree.stir(seed, 0);
      const double k = condition(dense);
      if (!dynamic_cast<TreeMotion*>(&tree.equations->solver()) || k > 1e6) break;
      const Eigen::VectorXd a = dense.newton_step(gamma, false), b = tree.newton_step(gamma, false);
      CHECK(size_of(a - b) <= 1e-12 * k * size_of(a));
      ++compared;
      with_balls += ball;
      tree.stir(seed, 1);
      const Eigen::VectorXd c = tree.newton_step(gamma, true), d = tree.newton_step(gamma, false);
      CHECK(size_of(c - d) <= 1e-4 * size_of(c)); // of which the quotients have most
      by_quotients += ball && size_of(c - d) <= 1e-6 * size_of(c);
    }
  }
  CAPTURE(compared, with_balls, by_quotients);
  CHECK(compared > 60);
  CHECK(with_balls > 30);
  CHECK(by_quotients > 30);
}

TEST_CASE("a motion along a tree is that by the dense equations") {
  const auto both = [](const Mechanism& m, double seconds, Integrator method) {
    Motion dense(m, Form::dense), tree(m, Form::tree);
    const Eigen::VectorXd a = dense.after(seconds, method), b = tree.after(seconds, method);
    CHECK(dynamic_cast<TreeMotion*>(&tree.equations->solver()));
    CHECK_FALSE(dynamic_cast<TreeMotion*>(&dense.equations->solver()));
    return size_of(a - b);
  };
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    CHECK(both(bench::springy_chain(30, 5, 0.1, 1e-3), 0.3, method) < 1e-7);
    CHECK(both(shipped("pendulum"), 0.5, method) < 1e-7); // with a body that has no mass on its way
    CHECK(both(shipped("rate_gyro"), 0.5, method) < 1e-7);
    CHECK(both(shipped("conical_pendulum"), 0.5, method) < 1e-7);
  }
}

TEST_CASE("a start at rest in the world is the same along a tree") {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const Mechanism mechanism = reference::random_mechanism(seed, trees(seed));
    Motion dense(mechanism, Form::dense), tree(mechanism, Form::tree);
    if (!is_tree(tree.model.system)) continue;
    CAPTURE(seed);
    tree.stir(seed, 1);
    if (!dynamic_cast<TreeMotion*>(&tree.equations->solver())) continue;
    dense.stir(seed, 1);
    const double k = condition(dense);
    if (k > 1e8) continue;
    SimulationOptions o;
    o.start = Start::drawn;
    Eigen::VectorXd q, a, b;
    find_start(o, dense.model, q, a);
    find_start(o, tree.model, q, b);
    const Eigen::VectorXd& column = tree.model.scaling.column;
    CHECK(size_of((a - b).cwiseQuotient(column)) <= 1e-12 * k * (1 + size_of(a.cwiseQuotient(column))));
  }
}

TEST_CASE("what has coordinates without mass does not go along the tree") {
  Mechanism m = bench::springy_chain(40, 5, 0.1, 1e-3);
  m.bodies.back().mass = 0;
  m.bodies.back().inertia.fill(0);
  Motion motion(m, Form::tree);
  motion.stir(1, 1);
  CHECK(motion.equations->has_massless());
  CHECK_FALSE(dynamic_cast<TreeMotion*>(&motion.equations->solver()));
  Run run = simulate(m, lasting(0.05));
  check_sound(run, 1e-6);
}

TEST_CASE("stops, drag and rotations in a large tree keep the energy's account") {
  Mechanism m = bench::springy_chain(60, 5, 0.05, 1e-4);
  for (Body& body : m.bodies) // thick, so that a straight chain turns about itself with some momentum
    for (int i = 0; i < 3; ++i)
      body.inertia[static_cast<std::size_t>(i)] += 1e-5;
  for (std::size_t i = 10; i < m.joints.size(); i += 10) {
    Joint& j = m.joints[i];
    if (i % 20 == 0) {
      j.type = JointType::spherical;
      j.coordinates.assign(3, {});
      for (Coordinate& c : j.coordinates) {
        c.spring = CoordinateSpring{0.05, 0};
        c.damping = 1e-4;
      }
    } else {
      j.coordinates[0].stop = Stop{-1e-3, 1e-3, 10, {}};
    }
  }
  Force drag;
  drag.name = "air";
  drag.type = ForceType::drag;
  drag.body = m.bodies.back().name;
  drag.at = m.bodies.back().position;
  drag.linear = 0.01;
  drag.quadratic = 0.02;
  m.forces.push_back(drag);
  for (const Integrator method : {Integrator::bdf, Integrator::automatic}) {
    SimulationOptions o = kicked(lasting(0.1, method, 1e-9), "hinge5", 1);
    o.reactions = true;
    const Run run = simulate(m, o);
    CAPTURE(run.message, word(run.method));
    check_sound(run, 1e-5);
    CHECK_FALSE(run.stops.empty());
  }
}

TEST_CASE("a straight chain of thin rods on balls, which has no mass about itself until it bends") {
  Mechanism m = bench::springy_chain(60, 5, 0.05, 1e-4);
  for (std::size_t i = 20; i < m.joints.size(); i += 20) {
    m.joints[i].type = JointType::spherical;
    m.joints[i].coordinates.assign(3, {});
    for (Coordinate& c : m.joints[i].coordinates) {
      c.spring = CoordinateSpring{0.05, 0};
      c.damping = 1e-4;
    }
  }
  const Run run = simulate(m, kicked(lasting(0.03, Integrator::bdf, 1e-9), "hinge5", 1));
  CAPTURE(run.message);
  check_sound(run, 1e-4);
}

TEST_CASE("a chain of a thousand links swings for its second, and comes to its steady state") {
  const Mechanism m = bench::springy_chain(1000, 5, 0.1, 1e-4);
  SimulationOptions o = lasting(1, Integrator::bdf);
  o.time_limit = 60;
  const Run run = simulate(m, o);
  CAPTURE(run.statistics.run_time_s, run.statistics.steps, run.statistics.evaluations);
  check_sound(run, 1e-6);
  CHECK(run.statistics.evaluations < 2 * run.statistics.steps);
  o.start = Start::equilibrium;
  o.duration = 0.1;
  const Settled settled = find_settled(simulate(m, o), Analysis(m).solve());
  CHECK(settled.time == 0.);
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("the memory of a motion grows in proportion to the bodies") {
  const auto in_use = [] {
    const struct mallinfo2 m = mallinfo2();
    return static_cast<double>(m.uordblks + m.hblkhd);
  };
  const auto used_by = [&](int links) {
    const Mechanism m = bench::springy_chain(links, 5, 0.1, 1e-4);
    SimulationOptions o = lasting(0.01, Integrator::bdf);
    o.start = Start::drawn;
    const double before = in_use();
    Simulator simulator(m, o);
    CHECK(simulator.advance(0.01));
    return in_use() - before;
  };
  used_by(100);
  CHECK(used_by(3000) < 3.5 * used_by(1000));
}
#endif
