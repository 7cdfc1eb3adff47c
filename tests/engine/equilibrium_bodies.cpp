// The sparse equations of all bodies: the same steps as the dense equations, for loops and whatever hangs on
// springs.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/search/find_equilibrium.hpp"

#include <Eigen/Eigenvalues>

#include <random>

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

// Point masses in a square frame that turns about the vertical, each tied to its neighbours.
template <class At, class Tie>
Mechanism net(int side, double speed, At at, Tie tie_together) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(speed)};
  const auto name = [&](int i, int j) {
    const bool inside = std::min(i, j) >= 0 && std::max(i, j) < side;
    return inside ? "knot" + std::to_string(i) + "_" + std::to_string(j) : std::string("spindle");
  };
  const auto tie = [&](int i, int j, int k, int l) {
    tie_together(m, {name(i, j), name(k, l)}, {at(i, j), at(k, l)});
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      m.bodies.push_back(body(name(i, j), 1. / (side * side), at(i, j)));
  for (int i = 0; i < side; ++i)
    for (int j = -1; j < side; ++j) {
      tie(i, j, i, j + 1);
      tie(j, i, j + 1, i);
    }
  return m;
}

using Names = std::array<std::string, 2>;
using Points = std::array<Vec3, 2>;

// By stretched springs.
Mechanism spring_net(int side, double speed) {
  const double cell = 1. / (side + 1);
  const auto at = [&](int i, int j) { return Vec3((i + 1) * cell - 0.5, 0, (j + 1) * cell - 0.5); };
  return net(side, speed, at, [&](Mechanism& m, const Names& bodies, const Points& points) {
    Force s;
    s.name = "cable" + std::to_string(m.forces.size());
    s.bodies = bodies;
    s.points = points;
    s.stiffness = 200;
    s.free_length = cell / 1.1;
    m.forces.push_back(s);
  });
}

// By cables of a given length, in the rim of a bowl.
Mechanism cable_net(int side, double speed) {
  const double cell = 2. / (side + 1);
  const auto at = [&](int i, int j) {
    const double x = (i + 1) * cell - 1, z = (j + 1) * cell - 1;
    return Vec3(x, 0.4 * (x * x + z * z) + 0.05 * std::sin(2 * x + z), z);
  };
  return net(side, speed, at, [&](Mechanism& m, const Names& bodies, const Points& points) {
    Joint cable;
    cable.name = "cable" + std::to_string(m.joints.size());
    cable.type = JointType::distance;
    cable.bodies = bodies;
    cable.points = points;
    m.joints.push_back(cable);
  });
}

struct Case {
  Mechanism mechanism;
  System system;
  Parameters parameters;
  Scaling scaling;
  Unknowns z;
  Workspace sparse, dense;

  explicit Case(Mechanism m) : mechanism(std::move(m)), system(compile(mechanism)) {
    system.kkt_form = KktForm::sparse;
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, z.q);
    z.lambda.setZero(system.rows);
  }
  Problem problem(bool large) const {
    return {system, parameters, scaling, nullptr, large ? KktForm::sparse : KktForm::dense};
  }
  void factor_at(const Eigen::VectorXd& step) {
    retract<double>(system, step, z.q);
    for (const bool large : {false, true}) {
      Workspace& w = large ? sparse : dense;
      evaluate(problem(large), z, 0, w);
      factor(problem(large), z, w);
    }
  }
  // The whole matrix of eq. 21, scaled.
  Eigen::MatrixXd matrix() const {
    const Eigen::Index n = system.nv, m = system.rows;
    Eigen::MatrixXd k = dense.dense.stiffness();
    if (problem(false).symmetric()) k = ((k + k.transpose()) / 2).eval();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m, n + m);
    all.topLeftCorner(n, n) = k;
    all.bottomLeftCorner(m, n) = dense.dense.jacobian();
    all.topRightCorner(n, m) = dense.dense.jacobian().transpose();
    return all;
  }
};

struct Tried {
  int symmetric = 0, unsymmetric = 0, divided = 0;
};

// Solves for random right-hand sides at random states with random multipliers, by both.
// In parts where that can be done, as a rule.
Tried try_random(const ref::RandomOptions& sort, std::uint32_t seeds) {
  Tried tried;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    ref::RandomOptions options = sort;
    options.conservative = seed % 2 == 0;
    options.air = seed % 4 == 1;
    options.drives = seed % 3 == 0 ? ref::RandomDrives::several : ref::RandomDrives::root;
    Case x(ref::random_mechanism(seed, options));
    if (x.system.nv == 0 || !no_drive_rides(x.system)) continue;
    if (seed / 2 % 4 != 0) x.system.division = divide(x.system, 2);
    CAPTURE(seed, x.system.nv, x.system.rows);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-0.3, 0.3);
    Eigen::VectorXd step(x.system.nv), rhs(x.system.nv), closing(x.system.rows), solved, lambda;
    for (int i = 0; i < x.system.nv; ++i) {
      step[i] = any(random) * x.scaling.column[i];
      rhs[i] = any(random);
    }
    for (int i = 0; i < x.system.rows; ++i) {
      closing[i] = any(random);
      x.z.lambda[i] = 100 * any(random) * x.scaling.row[i];
    }
    x.factor_at(step);
    const Eigen::MatrixXd all = x.matrix();
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(all).singularValues();
    if (values.minCoeff() < 1e-9 * values.maxCoeff()) continue;
    REQUIRE(x.sparse.sparse.null_directions().empty());
    REQUIRE(x.sparse.sparse.redundant() == 0);
    x.sparse.sparse.solve(rhs, closing, solved, lambda);
    Eigen::VectorXd whole(all.rows()), right(all.rows());
    whole << solved, lambda;
    right << rhs, closing;
    CHECK((all * whole - right).norm() <= 1e-9 * (values.maxCoeff() * whole.norm() + right.norm()));
    const bool potential = x.problem(true).symmetric();
    if (potential) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(all, Eigen::EigenvaluesOnly);
      CHECK(x.sparse.sparse.negative_count() == (eigen.eigenvalues().array() < 0).count() - x.system.rows);
    }
    ++(potential ? tried.symmetric : tried.unsymmetric);
    tried.divided += x.system.division.parts.size() > 1;
  }
  return tried;
}

// The shortest y with J y = closing; and of a force what is left by the multipliers that balance it best, as
// W times the motion that it causes, which keeps the loops closed.
void check_metric(Case& x, const Eigen::VectorXd& force) {
  factor_constraints(x.problem(true), x.sparse);
  SparseKkt& kkt = x.sparse.sparse;
  const Eigen::MatrixXd& jacobian = x.dense.dense.jacobian();
  const Eigen::VectorXd closing = Eigen::VectorXd::LinSpaced(x.system.rows, -1, 2);
  Eigen::VectorXd y, motion, lambda, product;
  kkt.close(closing, y);
  CHECK((jacobian * y - closing).norm() < 1e-8 * closing.norm());
  kkt.project(force, motion);
  motion /= kkt.mass() * x.parameters.length * x.parameters.length;
  kkt.balance(force, lambda);
  kkt.metric(motion, product);
  CHECK((jacobian * motion).norm() <= 1e-8 * motion.norm() * jacobian.norm());
  CHECK((product + jacobian.transpose() * lambda - force).norm() <= 1e-8 * force.norm());
  kkt.metric(y, product); // is balanced by constraint forces alone
  kkt.balance(product, lambda);
  CHECK((product - jacobian.transpose() * lambda).norm() < 1e-8 * product.norm());
}

} // namespace

TEST_CASE("a step by the bodies' equations solves those of the coordinates") {
  ref::RandomOptions options;
  options.bodies = 9;
  options.massless = false;
  SECTION("trees and springs") {
    const Tried tried = try_random(options, 200);
    CHECK(tried.symmetric > 25);
    CHECK(tried.unsymmetric > 25);
    CHECK(tried.divided > 6);
  }
  SECTION("loops") {
    options.loops = 3;
    const Tried tried = try_random(options, 1000);
    CHECK(tried.symmetric > 80);
    CHECK(tried.unsymmetric > 10);
    CHECK(tried.divided > 6);
  }
}

TEST_CASE("the metric of the bodies' equations is that of the motion") {
  ref::RandomOptions options;
  options.bodies = 7;
  options.loops = 2;
  options.massless = false;
  int tried = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    Case x(ref::random_mechanism(seed, options));
    if (x.system.nv == 0 || x.system.rows == 0 || !no_drive_rides(x.system)) continue;
    CAPTURE(seed);
    x.factor_at(Eigen::VectorXd::Zero(x.system.nv));
    if (x.dense.dense.constraints().rank() < x.system.rows) continue;
    check_metric(x, Eigen::VectorXd::Zero(x.system.nv));
    ++tried;
  }
  CHECK(tried > 8);
}

// Knots meet each other by cables alone; where one carries a rod, or is light, it is not solved for apart.
TEST_CASE("the metric of a net is that of the motion, whatever hangs on its knots, in parts or not") {
  for (const auto& [laden, divided] :
       {std::pair(false, false), std::pair(true, false), std::pair(false, true), std::pair(true, true)}) {
    CAPTURE(laden, divided);
    Mechanism m = cable_net(4, 2);
    if (laden) {
      m.bodies[6].mass = 1e-7;
      Joint ball;
      ball.name = "ball";
      ball.type = JointType::spherical;
      ball.bodies = {m.bodies[11].name, "rod"};
      ball.at = m.bodies[11].position;
      ball.coordinates.resize(3);
      m.joints.push_back(ball);
      Body rod = m.bodies[11];
      rod.name = "rod";
      rod.position.y() -= 0.2;
      rod.inertia = {1e-3, 1e-4, 1e-3};
      m.bodies.push_back(rod);
    }
    Case x(m);
    if (divided) x.system.division = divide(x.system, 2);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-0.3, 0.3);
    Eigen::VectorXd step(x.system.nv), force(x.system.nv);
    for (int i = 0; i < x.system.nv; ++i) {
      step[i] = 0.2 * any(random) * x.scaling.column[i];
      force[i] = any(random);
    }
    x.factor_at(step);
    REQUIRE(x.dense.dense.constraints().rank() == x.system.rows);
    check_metric(x, force);
  }
}

TEST_CASE("a net of springs hangs in its turning frame") {
  // Sags, keeps the square's symmetry, and the weight hangs
  // on the spindle.
  const int side = GENERATE(3, 20); // by either way of solving
  const Solution s = solve(spring_net(side, 3));
  REQUIRE(s.status == Status::converged);
  CHECK(s.residual < 1e-12);
  CHECK(s.stability_reason == StabilityReason::neutral); // the point masses may turn
  const auto knot = [&](int i, int j) {
    return s.poses[static_cast<std::size_t>(1 + i * side + j)].position;
  };
  CHECK(knot(side / 2, side / 2).y() < -0.01);
  for (int i = 0; i < side; ++i) {
    CHECK(std::abs(knot(i, 1).y() - knot(1, i).y()) < 1e-12);
    CHECK(std::abs(knot(i, 1).y() - knot(side - 1 - i, 1).y()) < 1e-12);
  }
  CHECK(std::abs(s.reactions.front().force.y() - 2 * standard_gravity) < 1e-9);
}

TEST_CASE("a net of cables comes to rest as long as it was drawn") {
  const int side = GENERATE(4, 12); // by either way of solving
  const Mechanism drawn = cable_net(side, 3);
  const Solution s = solve(drawn);
  REQUIRE(s.status == Status::converged);
  CHECK(s.residual < 1e-12);
  CAPTURE(s.message, int(*s.stability_reason), s.iterations);
  CHECK(s.stability_reason == StabilityReason::neutral); // the point masses may turn
  const auto body = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(drawn.bodies, name, &Body::name) -
                                    drawn.bodies.begin());
  };
  // Points are given in the drawn pose's world axes.
  const auto now = [&](std::size_t b, const Vec3& point) -> Vec3 {
    const Pose& pose = s.poses[b];
    return pose.position + pose.rotation * (point - drawn.bodies[b].position);
  };
  double stretched = 0, moved = 0;
  for (const Joint& cable : drawn.joints) {
    if (cable.type != JointType::distance) continue;
    const Vec3 a = now(body(cable.bodies[0]), cable.points[0]),
               b = now(body(cable.bodies[1]), cable.points[1]);
    stretched = std::max(stretched, std::abs((b - a).norm() - (cable.points[1] - cable.points[0]).norm()));
    moved = std::max(moved, (a - cable.points[0]).norm());
  }
  CHECK(stretched < 1e-13);
  CHECK(moved > 1e-3);
  const double weight = 2 * standard_gravity;
  CHECK(std::abs(s.reactions.front().force.y() - weight) < 1e-9 * weight);
}

TEST_CASE("without compression a net of cables is stiffer, and in nothing else different") {
  Case x(cable_net(5, 3));
  const Problem problem = x.problem(true);
  SparseKkt& bodies = x.sparse.sparse;
  int fewer = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-10, 10);
    for (double& lambda : x.z.lambda)
      lambda = any(random);
    const auto take_in = [&](bool convex) {
      evaluate(problem, x.z, 0, x.sparse);
      bodies.linearize(problem, x.z, x.sparse);
      if (convex) REQUIRE(bodies.linearize_convex(problem, x.z, x.sparse));
      bodies.factor();
      return bodies.negative_count();
    };
    const int exact = take_in(false), convex = take_in(true);
    CHECK(convex <= exact);
    fewer += convex < exact;
    for (double& lambda : x.z.lambda) // all pull
      lambda = std::abs(lambda);
    take_in(false);
    CHECK(!bodies.linearize_convex(problem, x.z, x.sparse));
  }
  CHECK(fewer > 10);
}

TEST_CASE("a net of rods comes to rest although every rod may spin") {
  const Mechanism m = bench::rod_net(6, 3);
  Analysis analysis(m);
  const Solution s = analysis.solve(), again = analysis.solve();
  REQUIRE(s.status == Status::converged);
  CHECK(s.residual < 1e-12);
  CHECK(s.stability_reason == StabilityReason::neutral);
  double weight = 0;
  for (const Body& b : m.bodies)
    weight += b.mass * standard_gravity;
  CHECK(std::abs(s.reactions.front().force.y() - weight) < 1e-9 * weight);
  for (std::size_t i = 0; i < s.coordinates.size(); ++i)
    CHECK(s.coordinates[i].value == again.coordinates[i].value);
  // What spinning rods make of the curvature, away from balance, leads nobody astray.
  CHECK(s.iterations <= 25);
}

TEST_CASE("all rods of a small net are told to spin freely") {
  const Mechanism m = bench::rod_net(2, 3);
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stability_reason == StabilityReason::neutral);
  // One of the two balls of each rod is in the tree, the other closes a loop or holds a knot.
  for (const Body& b : m.bodies)
    if (b.name.starts_with("cable"))
      CHECK(std::ranges::any_of(s.neutral,
                                [&](const std::string& joint) { return joint.starts_with(b.name); }));
}

// Multipliers solved for whole every time would carry the rounding of the last solve along for good.
TEST_CASE("nets of cables end at rounding and no factorisation later") {
  const Solution s = solve(bench::cable_net(32, GENERATE(3., 4.)));
  REQUIRE(s.status == Status::converged);
  CHECK(s.residual < 1e-13);
  const auto at_rounding = [](double residual) { return residual < 1e-11; };
  CHECK(std::ranges::count_if(s.history, at_rounding) <= 2);
}

// Large enough for threads; against the same with all in one part, by the search for an equilibrium alone.
TEST_CASE("a large net is solved in parts as it is as a whole, and to the same bits every time") {
  const auto found_in = [](const Mechanism& mechanism, bool whole) {
    Case x(mechanism);
    x.system.division = divide(x.system, whole ? x.system.links.size() : 400);
    REQUIRE((x.system.division.parts.size() > 1) != whole);
    Found found;
    std::vector<double> history;
    const Eigen::VectorXd drawn = x.z.q;
    find_equilibrium(x.problem(true), drawn, false, false, x.sparse, history, found);
    REQUIRE(found.status == Status::converged);
    return found.z.q;
  };
  for (const bool cables : {false, true}) {
    CAPTURE(cables);
    const Mechanism m = cables ? bench::cable_net(24, 3) : bench::spring_net(20, 3);
    const Eigen::VectorXd parts = found_in(m, false);
    CHECK((parts - found_in(m, true)).lpNorm<Eigen::Infinity>() < 1e-11);
    CHECK(parts == found_in(m, false));
  }
}
