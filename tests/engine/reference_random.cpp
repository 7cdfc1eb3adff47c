// The reference against itself on random mechanisms: properties that hold whatever the mechanism.
#include "tests/catch.hpp"
#include "tests/engine/reference/b_matrix.hpp"
#include "tests/engine/reference/mujoco_reference.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/mechanism/validate.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>

using namespace flyball;
using namespace flyball::reference;

namespace {

double largest(const VectorR& v) {
  return v.size() == 0 ? 0 : static_cast<double>(v.cwiseAbs().maxCoeff());
}

// A reproducible step of about this size in every free coordinate.
VectorR random_step(const Evaluation& e, std::uint32_t seed, Real size) {
  std::mt19937 engine(seed);
  VectorR step = VectorR::Zero(static_cast<Eigen::Index>(e.tree.coordinates.size()));
  for (const int i : e.free)
    step[i] = size * (2 * static_cast<Real>(engine()) / 4294967296.0L - 1);
  return step;
}

ReferenceState random_state(const Mechanism& m, const std::vector<std::string>& cuts, std::uint32_t seed,
                            Real size) {
  const Evaluation e = evaluate(m, cuts, {});
  return advance(m, e.tree, {}, random_step(e, seed, size));
}

// Derivative of a vector function of the state along one coordinate, by central differences and Richardson's
// extrapolation.
template <typename Function>
VectorR slope(const Mechanism& m, const Tree& tree, const ReferenceState& s, Eigen::Index coordinate,
              const Function& f, Real h = 2e-3L) {
  const VectorR unit = VectorR::Unit(static_cast<Eigen::Index>(tree.coordinates.size()), coordinate);
  const auto central = [&](Real step) -> VectorR {
    return (f(advance(m, tree, s, step * unit)) - f(advance(m, tree, s, -step * unit))) / (2 * step);
  };
  const VectorR d1 = central(h), d2 = central(h / 2), d4 = central(h / 4);
  return (16 * (4 * d4 - d2) / 3 - (4 * d2 - d1) / 3) / 15;
}

// The tree that results from cutting another joint of a loop where one can: every joint that closes loops is
// offered to the tree before the others, but for those with drives.
std::vector<std::string> other_cuts(const Mechanism& m) {
  Mechanism reordered = m;
  std::reverse(reordered.joints.begin(), reordered.joints.end());
  return default_cuts(reordered);
}

// The force on admissible motions as the motion of absolute velocities it is largest along: the same whatever
// the tree. Singular values are scaled by SI units, which do for these mechanisms.
VectorR absolute_force(const Evaluation& e) {
  const MatrixR& a = e.constraint_jacobian;
  MatrixR motions = e.B;
  VectorR f = e.balance;
  if (a.rows() > 0) {
    const Eigen::JacobiSVD<MatrixR> svd(a, Eigen::ComputeFullV);
    Eigen::Index rank = 0;
    while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-9L)
      ++rank;
    const MatrixR n = svd.matrixV().rightCols(a.cols() - rank);
    motions = e.B * n;
    f = n.transpose() * f;
  }
  // Massive or not, a body moved by no coordinate has no row; equal motions have equal powers.
  Eigen::CompleteOrthogonalDecomposition<MatrixR> decomposition;
  decomposition.setThreshold(1e-9L);
  decomposition.compute(motions.transpose());
  return decomposition.solve(f);
}

} // namespace

TEST_CASE("random mechanisms are valid, reproducible and of all types") {
  std::set<JointType> tree, loops;
  std::set<ForceType> forces;
  std::size_t massless = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    RandomOptions options;
    options.loops = static_cast<int>(seed % 4);
    options.drives = static_cast<RandomDrives>(seed % 3);
    options.steady = seed % 2 == 0;
    options.conservative = seed % 5 == 0;
    const Mechanism m = random_mechanism(seed, options);
    CAPTURE(seed);
    CHECK(m == random_mechanism(seed, options));
    for (const SceneError& mistake : find_mistakes(m))
      FAIL_CHECK(mistake.what());
    CHECK(has_potential(m) >= options.conservative);
    const std::vector<std::string> cuts = default_cuts(m);
    for (const Joint& joint : m.joints)
      (std::find(cuts.begin(), cuts.end(), joint.name) == cuts.end() ? tree : loops).insert(joint.type);
    for (const Force& force : m.forces)
      forces.insert(force.type);
    massless += static_cast<std::size_t>(
        std::count_if(m.bodies.begin(), m.bodies.end(), [](const Body& b) { return b.mass == 0; }));
    const Evaluation e = evaluate(m, cuts, {});
    CHECK(largest(e.constraints) < 1e-15);
  }
  CHECK(tree.size() == 8);
  CHECK(loops.size() >= 9);
  CHECK(forces.size() == 4);
  CHECK(massless > 10);
}

TEST_CASE("B and Phi_q are the derivatives of positions and constraints") {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    RandomOptions options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.loops = static_cast<int>(seed % 3);
    options.drives = RandomDrives::several;
    options.steady = false;
    const Mechanism m = random_mechanism(seed, options);
    const std::vector<std::string> cuts = default_cuts(m);
    const ReferenceState s = random_state(m, cuts, seed, 0.3L);
    const Evaluation e = evaluate(m, cuts, s);
    // Positions, small rotations against now, constraints: what B and Phi_q have rows for.
    const auto placement = [&](const ReferenceState& there) {
      const Evaluation moved = evaluate(m, cuts, there);
      VectorR x(e.B.rows() + e.constraints.size());
      for (std::size_t b = 0; b < m.bodies.size(); ++b) {
        const auto row = static_cast<Eigen::Index>(6 * b);
        x.segment<3>(row) = moved.bodies[b].position;
        x.segment<3>(row + 3) = rotation_log(moved.bodies[b].rotation * e.bodies[b].rotation.transpose());
      }
      x.tail(e.constraints.size()) = moved.constraints;
      return x;
    };
    for (Eigen::Index c = 0; c < e.B.cols(); ++c) {
      VectorR formed(e.B.rows() + e.constraints.size());
      formed << e.B.col(c), e.constraint_jacobian.col(c);
      CHECK(largest(slope(m, e.tree, s, c, placement) - formed) < 1e-10);
    }
  }
}

TEST_CASE("virtual work is the gradient of the amended potential") {
  int compared = 0, kinks = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    RandomOptions options;
    options.bodies = 1 + static_cast<int>(seed % 5);
    options.loops = static_cast<int>(seed % 3);
    options.drives = seed % 4 == 0 ? RandomDrives::none : RandomDrives::root;
    options.conservative = true;
    const Mechanism m = random_mechanism(seed, options);
    const std::vector<std::string> cuts = default_cuts(m);
    const ReferenceState s = random_state(m, cuts, seed + 7, 0.15L);
    const Evaluation e = evaluate(m, cuts, s);
    for (const int c : e.free) {
      const auto potential_at = [&](const ReferenceState& there) {
        return VectorR::Constant(1, potential(m, cuts, there)).eval();
      };
      const Real gradient = slope(m, e.tree, s, c, potential_at)[0];
      ++compared;
      // A stop begins within the steps: they tell nothing.
      if (std::abs(slope(m, e.tree, s, c, potential_at, 7e-4L)[0] - gradient) >
          1e-9L * (1 + std::abs(gradient))) {
        ++kinks;
        continue;
      }
      CAPTURE(c,
              m.joints[static_cast<std::size_t>(e.tree.coordinates[static_cast<std::size_t>(c)].joint)].name);
      CHECK(static_cast<double>(std::abs(gradient - e.balance[c])) <
            1e-8 * (1 + std::abs(static_cast<double>(gradient))));
    }
  }
  CHECK(kinks < compared / 50);
}

TEST_CASE("the balance does not change with the phase of a root drive") {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    RandomOptions options;
    options.loops = static_cast<int>(seed % 3);
    options.air = seed % 2 == 1;
    const Mechanism m = random_mechanism(seed, options);
    const std::vector<std::string> cuts = default_cuts(m);
    ReferenceState s = random_state(m, cuts, seed, 0.3L);
    const Evaluation a = evaluate(m, cuts, s);
    std::vector<Real> spin = joint_values(m.joints[0], s);
    spin[0] += 1.7L;
    s.coordinates[m.joints[0].name] = spin;
    const Evaluation b = evaluate(m, cuts, s);
    CHECK(largest(a.balance - b.balance) < 1e-11 * (1 + largest(a.balance)));
    CHECK(largest(a.constraints - b.constraints) < 1e-15);
  }
}

TEST_CASE("the balance on motions the loops allow does not depend on the tree") {
  int changed = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    RandomOptions options;
    options.bodies = 3 + static_cast<int>(seed % 4);
    options.loops = 1 + static_cast<int>(seed % 2);
    options.parallel_axes = seed % 2 == 0;
    const Mechanism m = random_mechanism(seed, options);
    const std::vector<std::string> cuts = default_cuts(m), others = other_cuts(m);
    const Evaluation drawn = evaluate(m, cuts, {});
    ReferenceState s;
    try {
      s = assemble(m, cuts, advance(m, drawn.tree, {}, random_step(drawn, seed, 0.05L)));
    } catch (const std::runtime_error&) { // locked: stays as drawn
    }
    const Evaluation a = evaluate(m, cuts, s);
    const ReferenceState t = state_of_motion(m, move_bodies(m, a.tree, s, VectorR::Zero(a.balance.size())));
    const Evaluation b = evaluate(m, others, t);
    for (std::size_t i = 0; i < m.bodies.size(); ++i) {
      CHECK(static_cast<double>((a.bodies[i].position - b.bodies[i].position).norm()) < 1e-10);
      CHECK(static_cast<double>((a.bodies[i].rotation - b.bodies[i].rotation).norm()) < 1e-10);
    }
    const VectorR fa = absolute_force(a), fb = absolute_force(b);
    CHECK(static_cast<double>((fa - fb).norm()) < 1e-7 * (1 + static_cast<double>(fa.norm())));
    const std::set<std::string> ca(cuts.begin(), cuts.end()), cb(others.begin(), others.end());
    changed += ca != cb;
  }
  CHECK(changed > 30);
}

TEST_CASE("inverse dynamics of open trees agrees with MuJoCo") {
  if (!mujoco_available()) {
    WARN("skipped: MuJoCo is not installed (libmujoco-dev)");
    return;
  }
  std::set<JointType> seen;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    CAPTURE(seed);
    RandomOptions options;
    options.drives = static_cast<RandomDrives>(seed % 3);
    options.steady = seed % 2 == 0;
    options.forces = options.stops = options.massless = false;
    Mechanism m = random_mechanism(seed, options);
    for (Joint& joint : m.joints)
      for (int i = 0; i < coordinate_count(joint.type); ++i)
        if (is_rotation_vector(joint.type, i)) {
          joint.coordinates[static_cast<std::size_t>(i)].spring.reset();
          joint.coordinates[static_cast<std::size_t>(i)].damping = 0;
        }
    REQUIRE(mujoco_can_hold(m));
    const ReferenceState s = random_state(m, {}, seed, 0.8L);
    const auto ours = generalized_forces(m, {}, s);
    const auto theirs = mujoco_inverse(m, s);
    for (const Joint& joint : m.joints) {
      if (coordinate_count(joint.type) == 0) continue;
      seen.insert(joint.type);
      CAPTURE(joint.name, type_name(joint.type));
      const VectorR difference = ours.at(joint.name) - theirs.at(joint.name);
      CHECK(static_cast<double>(difference.norm()) <
            1e-9 * (1 + static_cast<double>(ours.at(joint.name).norm())));
    }
  }
  CHECK(seen.size() == 7);
}
