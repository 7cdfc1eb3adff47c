// Motion by sparse equations of the bodies: the same as by the dense equations, at any size.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/dynamics_forms.hpp"
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"

using namespace flyball;
using namespace flyball::test;
using reference::RandomDrives;
using reference::RandomOptions;

namespace {

RandomOptions loops(std::uint32_t seed) {
  RandomOptions o;
  o.bodies = 6;
  o.loops = static_cast<int>(seed % 3);
  o.steady = false;
  o.massless = false;
  o.parallel_axes = seed % 2 == 0;
  o.drives = static_cast<RandomDrives>(seed % 3);
  o.air = seed % 4 == 1;
  return o;
}

bool is_sparse(const Motion& m) {
  return dynamic_cast<SparseMotion*>(&m.equations->solver());
}

// At a point where the loops are closed: false where they cannot be.
bool close(Motion& m) {
  if (m.model.system.rows == 0) return true;
  try {
    for (int round = 0; round < 2; ++round) { // rows may be dependent at one of these places alone
      if (!m.equations->project(Motion::time, m.q, m.s)) return false;
      m.equations->analyse(Motion::time, m.q, m.s);
    }
    return m.equations->evaluate(Motion::time, m.q, m.s) && m.equations->position_drift() < 1e-12 &&
           m.equations->velocity_drift() < 1e-12;
  } catch (const SceneError&) {
    return false;
  }
}

} // namespace

TEST_CASE("accelerations, multipliers and drive torques by sparse equations are those of the dense ones") {
  int compared = 0, drives = 0, with_loops = 0, redundant = 0, laws = 0;
  for (std::uint32_t seed = 1; seed <= 600; ++seed) {
    Mechanism mechanism = reference::random_mechanism(seed, loops(seed));
    if (seed % 2 == 0) mechanism = reference::with_damper_laws(mechanism);
    Motion dense(mechanism, Form::dense), sparse(mechanism, Form::sparse);
    if (!no_drive_rides(sparse.model.system) || sparse.model.system.nv == 0) continue;
    CAPTURE(seed, sparse.model.system.nv, sparse.model.system.rows);
    try {
      dense.stir(seed, 1);
    } catch (const SceneError&) {
      continue;
    }
    if (!close(dense)) continue;
    dense.set_sides();
    if (dense.equations->has_massless() || dense.equations->independence() < 1e-3) continue;
    const double k = condition(dense);
    if (k > 1e6) continue;
    sparse.q = dense.q;
    sparse.s = dense.s;
    sparse.equations->latch({}, {}, dense.flips);
    sparse.equations->analyse(Motion::time, sparse.q, sparse.s);
    if (!is_sparse(sparse)) continue;
    REQUIRE(sparse.equations->evaluate(Motion::time, sparse.q, sparse.s));
    const Eigen::VectorXd& column = sparse.model.scaling.column;
    const Eigen::VectorXd a = dense.equations->acceleration().cwiseQuotient(column),
                          b = sparse.equations->acceleration().cwiseQuotient(column);
    CHECK(size_of(a - b) <= 1e-8 * (1 + size_of(a)));
    double power = 0, difference = 0;
    for (std::size_t d = 0; d < sparse.model.system.drives.size(); ++d) {
      const double one = dense.equations->drive_force(static_cast<int>(d)),
                   other = sparse.equations->drive_force(static_cast<int>(d));
      power = std::max(power, std::abs(one));
      difference = std::max(difference, std::abs(one - other));
    }
    CHECK(difference <= 1e-8 * (power + sparse.equations->energy_scale()));
    ++compared;
    laws += !sparse.model.system.cut_damper_laws.empty();
    drives += static_cast<int>(sparse.model.system.drives.size());
    with_loops += sparse.model.system.rows > 0;
    Linearization l;
    linearize_constraints(sparse.model.released, sparse.model.parameters, sparse.equations->kinematics(), l);
    PivotedQr qr;
    if (l.constraint.rows() > 0 && qr.compute(l.constraint.transpose()))
      redundant += qr.rank(1e-9) < l.constraint.rows();
  }
  CAPTURE(compared, drives, with_loops, redundant, laws);
  CHECK(compared > 60);
  CHECK(drives > 40);
  CHECK(with_loops > 30);
  CHECK(redundant > 5);
  CHECK(laws > 3);
}

TEST_CASE("motions without mass are not taken for redundant rows") {
  int massless = 0, taken = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    RandomOptions o = loops(seed);
    o.loops = 1 + static_cast<int>(seed % 2);
    o.massless = true;
    const Mechanism mechanism = reference::random_mechanism(seed, o);
    Motion dense(mechanism, Form::dense), sparse(mechanism, Form::sparse);
    if (!no_drive_rides(sparse.model.system) || sparse.model.system.rows == 0) continue;
    CAPTURE(seed, sparse.model.system.nv, sparse.model.system.rows);
    try {
      dense.stir(seed, 1);
      if (!close(dense) || !dense.equations->has_massless() || dense.equations->independence() < 1e-3)
        continue;
      sparse.q = dense.q;
      sparse.s = dense.s;
      sparse.equations->latch({}, {}, dense.flips);
      sparse.equations->analyse(Motion::time, sparse.q, sparse.s);
    } catch (const SceneError&) {
      continue;
    }
    ++massless;
    if (!is_sparse(sparse)) continue;
    ++taken; // nothing acts on what has no mass
    REQUIRE(sparse.equations->evaluate(Motion::time, sparse.q, sparse.s));
    const Eigen::VectorXd& column = sparse.model.scaling.column;
    const Eigen::VectorXd a = dense.equations->acceleration().cwiseQuotient(column),
                          b = sparse.equations->acceleration().cwiseQuotient(column);
    CHECK(size_of(a - b) <= 1e-6 * (1 + size_of(a)));
  }
  CAPTURE(massless, taken);
  CHECK(massless > 20);
  CHECK(taken < massless);
}

TEST_CASE("the sparse matrix of implicit steps is the dense one of what stands still in its drive's frame") {
  int compared = 0;
  const std::uint32_t seeds = few_or_all(24u, 60u);
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    RandomOptions o = loops(seed);
    o.drives = RandomDrives::root;
    o.steady = true;
    Mechanism mechanism = reference::random_mechanism(seed, o);
    if (seed % 2 == 0) mechanism = reference::with_damper_laws(mechanism);
    for (const double gamma : {1e-3, 3e-2}) {
      Motion dense(mechanism, Form::dense), sparse(mechanism, Form::sparse);
      CAPTURE(seed, gamma, dense.model.system.nv, dense.model.system.rows);
      if (dense.model.system.nv == 0 || !dense.model.system.turning_air.empty()) break; // not for this form
      try {
        dense.settle();
      } catch (const SceneError&) {
        break;
      }
      if (dense.equations->has_massless() || dense.equations->independence() < 1e-3) break;
      if (condition(dense) > 1e6) break;
      sparse.q = dense.q;
      sparse.s = dense.s;
      sparse.equations->latch({}, {}, dense.flips);
      sparse.equations->analyse(Motion::time, sparse.q, sparse.s);
      if (!is_sparse(sparse)) break;
      const Eigen::VectorXd a = dense.newton_step(gamma, false), b = sparse.newton_step(gamma, false);
      CHECK(size_of(a - b) <= 1e-5 * size_of(a));
      ++compared;
    }
  }
  CHECK(compared > static_cast<int>(seeds / 3));
}

TEST_CASE("dampers by laws are as stiff as at their rates in every form of the implicit step") {
  // Slides in a row, which feel no forces by their velocities but those of the dampers.
  Mechanism m;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "b" + std::to_string(i), before = i == 0 ? "ground" : m.bodies.back().name;
    m.bodies.push_back(body(name, 1 + 0.1 * i, {0.3 * i, 0, 0}));
    Joint slide = prismatic("slide" + std::to_string(i), before, name, {0.3 * i, 0, 0}, {1, 0, 0});
    slide.coordinates[0].spring = CoordinateSpring{40, 0};
    slide.coordinates[0].damping_force = 0;
    slide.formulas = {{"damping_force", "2 N s/m*rate + 3 N s^3/m^3*rate^3"}};
    m.joints.push_back(slide);
  }
  Force tie = point_spring("tie", "b1", "b4", {0.3, 0, 0}, {1.2, 0, 0}, 25);
  const auto compare = [&](Form form) {
    Motion dense(m, Form::dense), other(m, form);
    dense.stir(3, 1);
    other.stir(3, 1);
    for (const double gamma : {1e-3, 0.1, 1.}) {
      const Eigen::VectorXd a = dense.newton_step(gamma, false), b = other.newton_step(gamma, false);
      CAPTURE(gamma);
      CHECK(size_of(a - b) <= 1e-6 * size_of(a));
      CHECK(size_of(a - dense.newton_step(gamma, true)) <= 1e-4 * size_of(a));
    }
  };
  compare(Form::tree);
  m.forces = {tie};
  compare(Form::sparse);
}

TEST_CASE("the motion of a net is that by the dense equations") {
  const auto both = [](const Mechanism& m, double seconds, Integrator method) {
    Motion dense(m, Form::dense), sparse(m, Form::sparse);
    const Eigen::VectorXd a = dense.after(seconds, method), b = sparse.after(seconds, method);
    CHECK(is_sparse(sparse));
    CHECK_FALSE(is_sparse(dense));
    return size_of(a - b);
  };
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    CHECK(both(bench::spring_net(2, 3), 0.1, method) < 1e-7);
    CHECK(both(bench::cable_net(2, 3), 0.1, method) < 1e-7);
    CHECK(both(shipped("governor"), 0.5, method) < 1e-7);
  }
}

TEST_CASE("the motion of chains tied by springs is that by the dense equations") {
  Mechanism m = bench::springy_chain(12, 5, 0.1, 1e-3);
  for (std::size_t i = 3; i < m.bodies.size(); i += 3) {
    Force tie;
    tie.name = "tie" + std::to_string(i);
    tie.type = ForceType::spring;
    tie.bodies = {m.bodies[i - 3].name, m.bodies[i].name};
    tie.points = {m.bodies[i - 3].position + Vec3(0.02, 0, 0), m.bodies[i].position};
    tie.stiffness = 20;
    tie.damping = 0.05;
    tie.free_length = 0.8 * (tie.points[1] - tie.points[0]).norm();
    m.forces.push_back(tie);
  }
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    Motion dense(m, Form::dense), tree(m, Form::tree);
    const Eigen::VectorXd a = dense.after(0.2, method), b = tree.after(0.2, method);
    CHECK(dynamic_cast<TreeMotion*>(&tree.equations->solver()));
    CHECK(size_of(a - b) < 1e-7);
    CHECK(size_of(a) > 1e-3);
  }
}

TEST_CASE("nets of hundreds of knots move, and keep the energy's account") {
  for (const Mechanism& m : {bench::spring_net(18, 3), bench::cable_net(18, 3)}) {
    const Run run = simulate(m, lasting(0.05));
    CAPTURE(run.message);
    CHECK(run.status == RunStatus::completed);
    check_sound(run);
  }
}
