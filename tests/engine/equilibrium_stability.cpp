// Eigenvalues and verdicts of stability against closed forms.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/linear/pencil.hpp"
#include "engine/report/report.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/stability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <complex>
#include <random>

using namespace flyball;
using namespace flyball::test;

namespace {

using Complex = std::complex<double>;

// Of s^2 M + s D + K with regular M, by way of the companion matrix.
std::vector<Complex> quadratic_pencil(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                      const Eigen::MatrixXd& stiffness) {
  const Eigen::Index n = mass.rows();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -mass.inverse() * stiffness;
  a.bottomRightCorner(n, n) = -mass.inverse() * velocity;
  const Eigen::VectorXcd s = Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
  return {s.begin(), s.end()};
}

// Each wanted eigenvalue has one of its own among the found.
void check_eigenvalues(const Solution& s, std::vector<Complex> wanted, double tolerance = 1e-9) {
  REQUIRE(s.eigenvalues.has_value());
  std::vector<Complex> found = *s.eigenvalues;
  CAPTURE(found, wanted, s.message);
  REQUIRE(found.size() == wanted.size());
  double size = 0;
  for (const Complex x : wanted)
    size = std::max(size, std::abs(x));
  for (const Complex x : wanted) {
    const auto nearest_one = std::ranges::min_element(
        found, [&](Complex a, Complex b) { return std::abs(a - x) < std::abs(b - x); });
    CHECK(std::abs(*nearest_one - x) <= tolerance * size);
    found.erase(nearest_one);
  }
}

// A disc that turns about x in two gimbals, the outer about y and sprung, the inner about z and sprung.
Mechanism two_gimbals(double rotor_speed, double outer, double inner, double axial, double across) {
  Mechanism m;
  m.bodies = {body("outer", 0.1, {0, 0, 0}, {1e-3, 2e-3, 1e-3}),
              body("inner", 0.1, {0, 0, 0}, {1e-3, 1e-3, 1e-3}),
              body("rotor", 1, {0, 0, 0}, {axial, across, across})};
  m.joints = {sprung(revolute("outer", "ground", "outer", {0, 0, 0}, {0, 1, 0}), outer),
              sprung(revolute("inner", "outer", "inner", {0, 0, 0}, {0, 0, 1}), inner),
              driven(revolute("rotor", "inner", "rotor", {0, 0, 0}, {1, 0, 0}), rotor_speed)};
  return m;
}

// A mass on a turntable held by springs across.
Mechanism puck(double speed, double kx, double ky, double mass) {
  Mechanism m;
  m.bodies = {spindle(), body("x", 0, {0, 0, 0}), body("puck", mass, {0, 0, 0})};
  m.joints = {spin(speed, {0, 0, 1}), sprung(prismatic("x", "spindle", "x", {0, 0, 0}, {1, 0, 0}), kx),
              sprung(prismatic("y", "x", "puck", {0, 0, 0}, {0, 1, 0}), ky)};
  return m;
}

// A top standing on its tip in massless gimbals, driven about its own axis.
Mechanism top(double rotor_speed, double mass, double height, double axial, double across) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("cross", 0, {0, 0, 0}), body("top", mass, {0, height, 0}, {across, axial, across})};
  Joint tip = joint(JointType::universal, "tip", "ground", "cross", {0, 0, 0}, {1, 0, 0});
  tip.axis2 = {0, 0, 1};
  m.joints = {tip, driven(revolute("spin", "cross", "top", {0, 0, 0}, {0, 1, 0}), rotor_speed)};
  return m;
}

} // namespace

TEST_CASE("a mass on a spring and a damper") {
  for (const double damping : {0., 0.5, 200.}) {
    const double mass = 0.4, stiffness = 90;
    Mechanism m;
    m.bodies = {body("mass", mass, {0, 0, 0})};
    m.joints = {
        dampened(sprung(prismatic("slide", "ground", "mass", {0, 0, 0}, {1, 0, 0}), stiffness), damping)};
    const Complex half(damping / (2 * mass)), disc = std::sqrt(half * half - Complex(stiffness / mass));
    const Solution s = solve(m);
    CAPTURE(damping);
    check_eigenvalues(s, {-half + disc, -half - disc});
    CHECK(s.stability_reason == StabilityReason::minimum);
    CHECK(stable(s));
  }
}

TEST_CASE("a compound pendulum swings about hanging and falls from upright") {
  const double mass = 2, arm = 0.3, inertia = 0.04, damping = 0.7;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("rod", mass, {0, -arm, 0}, {inertia, 0, inertia})};
  m.joints = {dampened(revolute("hinge", "ground", "rod", {0, 0, 0}, {0, 0, 1}), damping)};
  const double i = inertia + mass * arm * arm, k = mass * standard_gravity * arm;
  const auto roots = [&](double stiffness) {
    const Complex half(damping / (2 * i)), disc = std::sqrt(half * half - Complex(stiffness / i));
    return std::vector<Complex>{-half + disc, -half - disc};
  };
  check_eigenvalues(solve(m), roots(k));
  m.bodies[0].position = {0, arm, 0};
  const Solution up = solve(m, nearest());
  REQUIRE(up.status == Status::converged);
  check_eigenvalues(up, roots(-k));
  CHECK(up.stable == false);
  CHECK(up.stability_reason == StabilityReason::unstable);
  const Solution fallen = solve(m);
  CHECK(stable(fallen));
  CHECK(std::abs(std::abs(value(fallen, "hinge")) - std::numbers::pi) < 1e-12);
}

TEST_CASE("a conical pendulum swings about its cone at speed times sine of its angle") {
  // U'' / (m L^2) = (g cos(a) / L - w^2 cos(2 a)), with cos(a) = g / (w^2 L): w^2 sin(a)^2.
  const double length = 0.6;
  for (const double speed : {4.2, 6., 15.}) {
    const Solution s = solve(conical(length, 0, speed, 0.3));
    const double cosine = standard_gravity / (speed * speed * length);
    const double rate = speed * std::sqrt(1 - cosine * cosine);
    check_eigenvalues(s, {Complex(0, rate), Complex(0, -rate)}, 1e-12);
    CHECK(stable(s));
  }
}

TEST_CASE("the swing pendulum's linearised motion") {
  const Mechanism m = shipped("pendulum");
  const Solution s = solve(m);
  // About its tip's place: m d^2 a'' + 2 m d w d' + ..., m d'' - 2 m d w a' + ..., from
  // T = m ((x' - w y)^2 + (y' + w x)^2) / 2 with x = 1 + d cos(a), y = d sin(a).
  const double a = value(s, "theta"), d = value(s, "d"), w = 20, mass = 1;
  Eigen::Matrix2d inertia, velocity, stiffness;
  inertia << mass * d * d, 0, 0, mass;
  velocity << 10, 2 * mass * d * w, -2 * mass * d * w, 100;
  const double cross = mass * w * w * std::sin(a);
  stiffness << 300 + mass * w * w * d * std::cos(a), cross, cross, 50000 - mass * w * w;
  // The massless arm leaves all four of them finite: the weight moves with it.
  check_eigenvalues(s, quadratic_pencil(inertia, velocity, stiffness));
  CHECK(stable(s));
}

TEST_CASE("a rate gyro's tilt swings as its one coordinate does") {
  const Mechanism m = shipped("rate_gyro");
  const Solution s = solve(m);
  const Body &gimbal = m.bodies[1], &rotor = m.bodies[2];
  const double a = value(s, "tilt"), w = 0.5, rate = 800;
  const double square = w * w * (gimbal.inertia[0] - gimbal.inertia[1] + rotor.inertia[0] - rotor.inertia[1]);
  const double k = 1 - square * std::cos(2 * a) + rotor.inertia[0] * rate * w * std::sin(a);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  check_eigenvalues(s, quadratic_pencil((gimbal.inertia[2] + rotor.inertia[2]) * one, 0.02 * one, k * one),
                    1e-8);
  CHECK(stable(s));
}

TEST_CASE("a spinning rotor couples its gimbals") {
  const double axial = 0.01, across = 0.006;
  for (const double rate : {0., 30., 3000.}) {
    const Solution s = solve(two_gimbals(rate, 4, 7, axial, across));
    Eigen::Matrix2d inertia, velocity, stiffness;
    inertia << 2e-3 + 1e-3 + across, 0, 0, 1e-3 + across;
    velocity << 0, axial * rate, -axial * rate, 0;
    stiffness << 4, 0, 0, 7;
    CAPTURE(rate);
    check_eigenvalues(s, quadratic_pencil(inertia, velocity, stiffness));
    CHECK(s.stability_reason == StabilityReason::minimum);
  }
}

TEST_CASE("massless coordinates have no eigenvalues of their own") {
  const double k1 = 30, k2 = 80, mass = 0.5;
  Mechanism m;
  m.bodies = {body("joint", 0, {0, 0, 0}), body("mass", mass, {1, 0, 0})};
  m.joints = {sprung(prismatic("a", "ground", "joint", {0, 0, 0}, {1, 0, 0}), k1, 0.2),
              sprung(prismatic("b", "joint", "mass", {1, 0, 0}, {1, 0, 0}), k2, -0.1)};
  SECTION("two springs in series are one") {
    const double rate = std::sqrt(k1 * k2 / (k1 + k2) / mass);
    const Solution s = solve(m);
    check_eigenvalues(s, {Complex(0, rate), Complex(0, -rate)});
    CHECK(stable(s));
    CHECK(s.stability_reason == StabilityReason::minimum);
  }
  SECTION("a damper on one of them adds a real eigenvalue") {
    const double c = 5;
    m.joints[0].coordinates[0].damping = c;
    // m (a + b)'' + k2 b = 0, c a' + k1 a = k2 b; with x = a + b:
    // m c s^3 + m (k1 + k2) s^2 + c k2 s + k1 k2 = 0.
    Eigen::Matrix3d companion;
    companion << -(k1 + k2) / c, -k2 / mass, -k1 * k2 / (mass * c), 1, 0, 0, 0, 1, 0;
    const Eigen::Vector3cd roots = Eigen::EigenSolver<Eigen::Matrix3d>(companion, false).eigenvalues();
    const Solution s = solve(m);
    check_eigenvalues(s, {roots[0], roots[1], roots[2]});
    CHECK(stable(s));
  }
}

TEST_CASE("negative stiffness is unstable without mass, too") {
  // A massless pointer pressed upright by a compressed spring that would rather lie; a mass on a spring
  // beside.
  Mechanism m;
  m.bodies = {body("pointer", 0, {0, 0.5, 0}), body("mass", 1, {1, 0, 0})};
  m.joints = {revolute("pointer", "ground", "pointer", {0, 0, 0}, {0, 0, 1}),
              sprung(prismatic("slide", "ground", "mass", {1, 0, 0}, {1, 0, 0}), 10, 0.1)};
  Force spring;
  spring.name = "press";
  spring.type = ForceType::spring;
  spring.bodies = {"ground", "pointer"};
  spring.points = {Vec3(0, 1.5, 0), Vec3(0, 1, 0)};
  spring.stiffness = 20;
  spring.free_length = 0.9;
  m.forces = {spring};
  SECTION("with a potential") {
    const Solution s = solve(m, nearest());
    REQUIRE(s.status == Status::converged);
    check_value(s, "pointer", 0);
    CHECK(s.stable == false);
    CHECK(s.stability_reason == StabilityReason::unstable);
    // By default it tips over to where the spring is slack: 1.5^2 + 1 - 3 cos(a) = 0.9^2.
    const Solution tipped = solve(m);
    INFO(tipped.message);
    REQUIRE(tipped.status == Status::converged);
    CHECK(stable(tipped));
    CHECK(std::abs(std::abs(value(tipped, "pointer")) - std::acos((1.5 * 1.5 + 1 - 0.9 * 0.9) / (2 * 1.5))) <
          1e-12);
  }
  SECTION("and without one") {
    Force air;
    air.name = "air";
    air.type = ForceType::drag;
    air.body = "mass";
    air.linear = 1;
    m.forces.push_back(air);
    const Solution s = solve(m);
    REQUIRE(s.status == Status::converged);
    check_value(s, "pointer", 0);
    CHECK(s.stable == false);
    CHECK(s.stability_reason == StabilityReason::unstable);
  }
}

TEST_CASE("rotation can hold what the potential does not") {
  const double mass = 0.5, stiffness = 50, natural = std::sqrt(stiffness / mass);
  SECTION("a puck on equal springs, faster than they can hold still") {
    for (const double share : {0.6, 1.4, 3.}) {
      const double w = share * natural;
      // In the inertial frame an oscillator; seen turning: natural +- speed.
      const std::vector<Complex> wanted{
          {0, natural + w}, {0, -natural - w}, {0, natural - w}, {0, w - natural}};
      for (const bool near : {false, true}) {
        CAPTURE(share, near);
        SolveOptions options;
        options.nearest = near;
        const Solution s = solve(puck(w, stiffness, stiffness, mass), options);
        REQUIRE(s.status == Status::converged);
        check_value(s, "x", 0);
        check_eigenvalues(s, wanted, 1e-7);
        if (share < 1) {
          CHECK(stable(s));
          CHECK(s.stability_reason == StabilityReason::minimum);
        } else {
          CHECK_FALSE(s.stable.has_value());
          CHECK(s.stability_reason == StabilityReason::gyroscopic_only);
        }
      }
    }
  }
  SECTION("but not between the two speeds of unequal springs") {
    const Solution s = solve(puck(std::sqrt(70 / mass), 50, 90, mass), nearest());
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == false);
  }
  SECTION("and a damper spoils it") {
    Mechanism m = puck(1.4 * natural, stiffness, stiffness, mass);
    m.joints[1].coordinates[0].damping = m.joints[2].coordinates[0].damping = 0.5;
    const Solution s = solve(m, nearest());
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == false);
  }
  SECTION("a top stands if it spins fast enough") {
    const double height = 0.1, axial = 0.002, across = 0.003, weight = mass * standard_gravity * height;
    const double i = across + mass * height * height, enough = 2 * std::sqrt(i * weight) / axial;
    for (const double share : {0.5, 0.95, 1.05, 2.}) {
      CAPTURE(share);
      const Mechanism m = top(share * enough, mass, height, axial, across);
      const Solution s = solve(m, nearest());
      REQUIRE(s.status == Status::converged);
      Eigen::Matrix2d inertia = i * Eigen::Matrix2d::Identity(), velocity;
      velocity << 0, axial * share * enough, -axial * share * enough, 0;
      const Eigen::Matrix2d stiffness_matrix = -weight * Eigen::Matrix2d::Identity();
      check_eigenvalues(s, quadratic_pencil(inertia, velocity, stiffness_matrix), 1e-7);
      if (share < 1)
        CHECK(s.stable == false);
      else
        CHECK(s.stability_reason == StabilityReason::gyroscopic_only);
      // Drawn upright it stands where it can, and hangs where it cannot.
      const Solution answer = solve(m);
      INFO(answer.message);
      REQUIRE(answer.status == Status::converged);
      if (share < 1) {
        CHECK(stable(answer));
        CHECK(answer.poses[1].position.y() < -0.99 * height);
      } else {
        CHECK_FALSE(answer.stable.has_value());
        CHECK(answer.stability_reason == StabilityReason::gyroscopic_only);
        CHECK(answer.poses[1].position.y() == Approx(height));
        CHECK(answer.message.find("any damping") != std::string::npos);
      }
    }
  }
}

TEST_CASE("what a constant torque leans against a weight or a spring is a minimum") {
  Force torque;
  torque.name = "torque";
  torque.type = ForceType::torque;
  torque.vector = {0, 0, 1};
  SECTION("a pendulum: leaning, and beyond the horizontal unstable") {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("rod", 2, {0, -0.3, 0}, {0.04, 0, 0.04})};
    m.joints = {revolute("hinge", "ground", "rod", {0, 0, 0}, {0, 0, 1})};
    torque.body = "rod";
    m.forces = {torque};
    const double lean = std::asin(1 / (2 * standard_gravity * 0.3));
    const Solution s = solve(m);
    CHECK(stable(s));
    CHECK(s.stability_reason == StabilityReason::minimum);
    CHECK_THAT(value(s, "hinge"), Catch::Matchers::WithinRel(lean, 1e-12));
    const AllSolutions all = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == 2);
    CHECK(all.equilibria[0].stability_reason == StabilityReason::minimum);
    CHECK(all.equilibria[1].stability_reason == StabilityReason::unstable);
    CHECK_THAT(value(all.equilibria[1], "hinge"), Catch::Matchers::WithinRel(std::numbers::pi - lean, 1e-12));
  }
  SECTION("a rack and its pinion") {
    Mechanism m;
    m.bodies = {body("wheel", 0.6, {0, 0, 0}, {4e-4, 4e-4, 8e-4}), body("block", 0.5, {0, -0.1, 0})};
    Joint rack = gear("rack", "hinge", "slide", 1);
    rack.kind = GearKind::rack;
    rack.radii = {0.05, 1};
    m.joints = {revolute("hinge", "ground", "wheel", {0, 0, 0}, {0, 0, 1}),
                sprung(prismatic("slide", "ground", "block", {0, -0.1, 0}, {1, 0, 0}), 1000), rack};
    torque.body = "wheel";
    m.forces = {torque};
    const Solution s = solve(m);
    CHECK(stable(s));
    CHECK(s.stability_reason == StabilityReason::minimum);
    CHECK_THAT(value(s, "slide"), Catch::Matchers::WithinRel(0.02, 1e-12));
  }
  SECTION("long chains, along the tree and closed to a loop") {
    const bool closed = GENERATE(false, true);
    const int count = 70;
    CAPTURE(closed);
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    for (int i = 0; i < count; ++i) {
      const std::string name = "rod" + std::to_string(i), on = i == 0 ? "ground" : m.bodies.back().name;
      const Vec3 from(0, -0.1 * i, 0), to(0, -0.1 * (i + 1), 0);
      m.bodies.push_back(rod(name, 0.1, from, to));
      m.joints.push_back(revolute("hinge" + std::to_string(i), on, name, from, {0, 0, 1}));
    }
    if (closed)
      m.joints.push_back(
          distance("rope", "ground", m.bodies.back().name, {0, 0, 0}, {0, -0.1 * count, 0}, 4));
    torque.body = "rod0";
    m.forces = {torque};
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    CHECK(stable(s));
    CHECK(s.stability_reason == StabilityReason::minimum);
    if (closed) return;
    // The torque holds up the weight of all at the end of the first rod, and half that of the rod.
    CHECK_THAT(std::sin(value(s, "hinge0")),
               Catch::Matchers::WithinRel(1 / (0.1 * 0.1 * standard_gravity * (count - 0.5)), 1e-9));
  }
}

TEST_CASE("without a potential the eigenvalues judge") {
  Mechanism m = conical(0.5, 0.2, 6, 0.2);
  Force air;
  air.name = "air";
  air.type = ForceType::drag;
  air.body = "bob";
  air.linear = 0.1;
  m.forces = {air};
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  CHECK(stable(s));
  CHECK(s.stability_reason == StabilityReason::asymptotic);
  REQUIRE(s.eigenvalues.has_value());
  for (const Complex x : *s.eigenvalues)
    CHECK(x.real() < 0);
  // The bob's own swing through the air: m L^2 a'' + c L^2 a' + U'' a.
  const double a = value(s, "swing"), length = 0.5, w = 6, r = 0.2 + length * std::sin(a);
  const double k = standard_gravity * length * std::cos(a) -
                   w * w * length * (length * std::cos(a) * std::cos(a) - r * std::sin(a));
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  check_eigenvalues(s, quadratic_pencil(length * length * one, 0.1 * length * length * one, k * one));
}

TEST_CASE("at a critical speed the verdict stays open") {
  // The pitchfork of the conical pendulum: hanging has no stiffness, but leaning has no balance.
  const double length = 0.5;
  const Solution s = solve(conical(length, 0, std::sqrt(standard_gravity / length)));
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(std::abs(value(s, "swing")) < 1e-5);
  CHECK_FALSE(s.stable.has_value());
  CHECK(s.stability_reason == StabilityReason::marginal);
  CHECK(s.neutral.empty());
}

TEST_CASE("a coordinate that nothing depends on stays as it is drawn") {
  // A spindle that nobody drives, with one arm, a collar and the link between them.
  Mechanism m = shipped("governor");
  m.joints[0].coordinates[0].drive.reset();
  m.joints[0].coordinates[0].drawn = 0.3;
  std::erase_if(m.bodies, [](const Body& body) { return body.name == "ball2"; });
  std::erase_if(m.joints,
                [](const Joint& joint) { return joint.bodies[0] == "ball2" || joint.bodies[1] == "ball2"; });
  m.sliders.clear();
  for (const bool nearest : {false, true}) {
    SolveOptions options;
    options.nearest = nearest;
    const Solution s = Analysis(m).solve(options);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.neutral == std::vector<std::string>{"spin"});
    CHECK(value(s, "spin") == 0.3);
  }
}

TEST_CASE("only asked for its sign, stability says the same") {
  for (const char* scene : {"pendulum", "governor", "conical_pendulum", "rate_gyro", "watt_governor",
                            "ball_on_string", "fourbar_turntable", "governor_bearing", "chain20"}) {
    Analysis analysis(shipped(scene));
    for (const bool near : {false, true}) {
      SolveOptions options;
      options.nearest = near;
      const Solution full = analysis.solve(options);
      options.details = false;
      const Solution brief = analysis.solve(options);
      CAPTURE(scene, near, full.message);
      CHECK(full.stable == brief.stable);
      CHECK(full.stability_reason == brief.stability_reason);
      CHECK(full.neutral == brief.neutral);
      if (!near) CHECK(full.status == Status::converged);
    }
  }
}

TEST_CASE("eigenvalues of a mechanism with numbers far apart make its pencil singular, each") {
  const Mechanism m = stored_case("uninitialised_eigenvalues_of_a_pencil");
  const System system = compile_for_drives(m);
  Parameters parameters;
  Scaling scaling;
  bind(system, m, parameters);
  set_scaling(system, parameters, scaling);
  Eigen::VectorXd q;
  drawn_configuration(system, parameters, q);
  const Solution solution = solve(m);
  REQUIRE(solution.status == Status::converged);
  set_start(system, parameters, start_values(solution.coordinates), q);
  Workspace w;
  const Problem problem{system, parameters, scaling};
  const LinearMotion motion = linear_motion(problem, q, 0, w);
  const Eigen::MatrixXd& n = motion.basis;
  const Eigen::MatrixXd mass = n.transpose() * motion.mass * n,
                        velocity = n.transpose() * motion.velocity * n,
                        stiffness = n.transpose() * motion.stiffness * n;
  const auto found = pencil_eigenvalues(mass, velocity, stiffness);
  REQUIRE(found);
  CHECK(found->size() > 2);
  for (const Complex x : *found) { // each makes the pencil singular
    const Eigen::MatrixXcd pencil = x * x * mass.cast<Complex>() + x * velocity.cast<Complex>() + stiffness;
    const double size = std::norm(x) * mass.norm() + std::abs(x) * velocity.norm() + stiffness.norm();
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXcd>(pencil).singularValues();
    CHECK(values.tail(1)[0] < 1e-9 * size);
  }
}

TEST_CASE("massless directions without stiffness hold what they are coupled with") {
  // x'' = -4 x + c y with 0 = c x for y: nothing moves; z swings on its own, at 3 rad/s.
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  Eigen::MatrixXd mass = Eigen::Vector3d(1, 0, 2).asDiagonal(),
                  stiffness = Eigen::Vector3d(4, 0, 18).asDiagonal();
  stiffness(0, 1) = stiffness(1, 0) = 7;
  for (const double rounding : {0., 1e-15, -1e-15}) {
    stiffness(1, 1) = rounding;
    Eigen::MatrixXd a(3, 3);
    for (double& x : a.reshaped())
      x = any(random);
    const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ();
    for (const Eigen::MatrixXd& turn : {Eigen::MatrixXd(Eigen::MatrixXd::Identity(3, 3)), q}) {
      const auto s = pencil_eigenvalues(turn * mass * turn.transpose(), Eigen::MatrixXd::Zero(3, 3),
                                        turn * stiffness * turn.transpose());
      REQUIRE(s.has_value());
      REQUIRE(s->size() == 2);
      CHECK(std::abs(s->at(0) - Complex(0, 3)) < 1e-7);
    }
  }
}

TEST_CASE("a gyroscopic coupling as small as the mass that is neglected is neglected with it") {
  // x'' = -4 x, y'' = -9 y with gyroscopic forces, and z of a mass of 1e-16 whose share in these is 1e-9: not
  // an equation of its own, which would hold x.
  Eigen::MatrixXd mass = Eigen::Vector3d(1, 1, 1e-16).asDiagonal(),
                  stiffness = Eigen::Vector3d(4, 9, 0).asDiagonal(), velocity = Eigen::MatrixXd::Zero(3, 3);
  velocity(0, 1) = 1;
  velocity(0, 2) = 1e-9;
  velocity = (velocity - velocity.transpose()).eval();
  const auto with = pencil_eigenvalues(mass, velocity, stiffness);
  const auto without = pencil_eigenvalues(mass.topLeftCorner(2, 2), velocity.topLeftCorner(2, 2),
                                          stiffness.topLeftCorner(2, 2));
  REQUIRE(with);
  REQUIRE(without);
  REQUIRE(with->size() == without->size());
  for (std::size_t i = 0; i < with->size(); ++i)
    CHECK(std::abs((*with)[i] - (*without)[i]) < 1e-12);
}

TEST_CASE("springs without mass beside dampers without mass make no eigenvalues") {
  // Bodies on springs, points that dampers and springs hold and points that springs alone hold, all coupled
  // by springs and turned against the axes. What springs alone hold is condensed, the velocities of points
  // are no states: then all eigenvalues are finite.
  constexpr int bodies = 4, damped = 3, sprung = 4, n = bodies + damped + sprung, rest = bodies + damped;
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  const auto filled = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return any(random); }).eval();
  };
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n), velocity = mass;
    mass.diagonal().head(bodies).setLinSpaced(1, 2);
    velocity.diagonal().segment(bodies, damped).setLinSpaced(0.1, 10);
    const Eigen::MatrixXd half = filled(n, n);
    const Eigen::MatrixXd stiffness = half * half.transpose() + 0.3 * Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd k =
        stiffness.topLeftCorner(rest, rest) -
        stiffness.topRightCorner(rest, sprung) *
            stiffness.bottomRightCorner(sprung, sprung).llt().solve(stiffness.bottomLeftCorner(sprung, rest));
    // Positions of the bodies and of the points, velocities of the bodies.
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(bodies + rest, bodies + rest);
    a.block(0, rest, bodies, bodies).setIdentity();
    a.block(bodies, 0, damped, rest) =
        -(velocity.diagonal().segment(bodies, damped).cwiseInverse().asDiagonal() * k.bottomRows(damped));
    a.block(rest, 0, bodies, rest) =
        -(mass.diagonal().head(bodies).cwiseInverse().asDiagonal() * k.topRows(bodies));
    const Eigen::VectorXcd expected = Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();

    const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(filled(n, n)).householderQ();
    const auto turned = [&](const Eigen::MatrixXd& m) { return Eigen::MatrixXd(q * m * q.transpose()); };
    const auto found = pencil_eigenvalues(turned(mass), turned(velocity), turned(stiffness)).value();
    REQUIRE(found.size() == static_cast<std::size_t>(expected.size()));
    for (const Complex x : expected) {
      const auto apart = [&](Complex y) { return std::abs(x - y); };
      CHECK(apart(*std::ranges::min_element(found, {}, apart)) < 1e-9 * std::abs(x));
    }
  }
}

TEST_CASE("what feels neither mass nor spring nor damper has no eigenvalue") {
  // A body on a spring beside coordinates without an equation of motion, all turned against the axes.
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  for (const bool damped : {false, true}) {
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(5, 5), velocity = mass, stiffness = mass;
    mass(0, 0) = 1;
    stiffness(0, 0) = 4;
    stiffness(1, 1) = 9; // massless
    if (damped) velocity(1, 1) = 3;
    Eigen::MatrixXd a(5, 5);
    for (double& x : a.reshaped())
      x = any(random);
    const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ();
    const auto turned = [&](const Eigen::MatrixXd& m) { return Eigen::MatrixXd(q * m * q.transpose()); };
    const auto s = pencil_eigenvalues(turned(mass), turned(velocity), turned(stiffness)).value();
    CAPTURE(damped);
    REQUIRE(s.size() == (damped ? 3 : 2));
    double swings = 0, settles = 0;
    for (const Complex x : s)
      if (std::abs(x.imag()) > 1)
        swings += std::abs(x - Complex(0, std::copysign(2, x.imag())));
      else
        settles = x.real();
    CHECK(swings < 1e-9);
    if (damped) CHECK(std::abs(settles + 3) < 1e-9);
  }
}

// The null direction of a damped slide has one eigenvalue zero; what comes next in size is a motion's own,
// however stiff something else is.
TEST_CASE("a free slide with a damper hides no slow motion that grows") {
  constexpr double height = 0.4; // m
  for (const double damping : {0., 8.})
    for (const double stiffness : {1e2, 1e12}) {
      Mechanism m;
      m.gravity = {0, -standard_gravity, 0};
      m.bodies = {body("carriage", 1, {1, 0, 0}), body("bob", 1, {0, height, 0}),
                  body("block", 1, {2, 0, 0})};
      m.joints = {prismatic("slide", "ground", "carriage", {1, 0, 0}, {0, 0, 1}),
                  revolute("hinge", "ground", "bob", {0, 0, 0}, {0, 0, 1}),
                  sprung(prismatic("stiff", "ground", "block", {2, 0, 0}, {1, 0, 0}), stiffness)};
      m.joints[0].coordinates[0].damping = damping;
      const Solution s = solve(m, nearest());
      CAPTURE(damping, stiffness, s.message);
      REQUIRE(s.status == Status::converged);
      CHECK(s.stable == false);
      const double rate = std::sqrt(standard_gravity / height), omega = std::sqrt(stiffness);
      check_eigenvalues(s, {rate, -rate, 0, -damping, {0, omega}, {0, -omega}}, 1e-6);
    }
}

TEST_CASE("a bead on a heavy block is not taken for massless") {
  // On the block's spring the bead swings by itself: y'' = -(k / m - w^2) y + c / m y'.
  for (const double mass : {1e-7, 1e-9, 1e-12}) {
    CAPTURE(mass);
    Mechanism m;
    m.gravity = Vec3::Zero();
    m.bodies = {body("shaft", 1, Vec3::Zero(), {1, 1, 1}), body("block", 1e4, {0.1, 0, 0}),
                body("bead", mass, {0.2, 0, 0})};
    m.joints = {driven(revolute("spin", "ground", "shaft", Vec3::Zero(), Vec3::UnitZ()), 2),
                dampened(sprung(prismatic("x", "shaft", "block", {0.1, 0, 0}, Vec3::UnitX()), 4e6), 2e4),
                sprung(prismatic("y", "block", "bead", {0.2, 0, 0}, Vec3::UnitX()), 100 * mass)};
    m.joints[2].coordinates[0].damping_force = 0;
    m.joints[2].formulas = {
        {"damping_force", std::to_string(-mass / 2 * 1e15) + "e-15 N*tanh(rate/(1 m/s))"}};
    const Solution solution = solve(m);
    REQUIRE(solution.status == Status::converged);
    CHECK(solution.stable == false);
    REQUIRE(solution.eigenvalues);
    REQUIRE(solution.eigenvalues->size() == 4);
    CHECK(std::abs(solution.eigenvalues->front() - Complex(0.25, std::sqrt(96 - 0.25 * 0.25))) < 1e-8);
  }
}

TEST_CASE("a light part on a stiff spring leaves the motions of the others what they are") {
  for (const double mass : {0., 1e-12, 1e-16}) {
    CAPTURE(mass);
    Mechanism m;
    m.gravity = Vec3::Zero();
    m.bodies = {body("shaft", 1, Vec3::Zero(), {1, 1, 1}), body("block", 1, {0.1, 0, 0}),
                body("bead", 1, {0.2, 0, 0}), body("tip", mass, {0.3, 0, 0})};
    m.joints = {driven(revolute("spin", "ground", "shaft", Vec3::Zero(), Vec3::UnitZ()), 2),
                dampened(sprung(prismatic("x", "shaft", "block", {0.1, 0, 0}, Vec3::UnitX()), 100), 2),
                sprung(prismatic("y", "block", "bead", {0.2, 0, 0}, Vec3::UnitX()), 100),
                dampened(sprung(prismatic("z", "bead", "tip", {0.3, 0, 0}, Vec3::UnitX()), 1e3), 0.1)};
    m.joints[2].coordinates[0].damping_force = 0;
    m.joints[2].formulas = {{"damping_force", "-0.2 N*tanh(rate/(1 m/s))"}}; // the balance has no energy
    const Solution solution = solve(m);
    REQUIRE(solution.status == Status::converged);
    CHECK(solution.stable == true);
    REQUIRE(solution.eigenvalues);
    CHECK(std::ranges::any_of(*solution.eigenvalues,
                              [](Complex s) { return std::abs(s - Complex(-0.26681, 5.85443)) < 2e-3; }));
  }
}

TEST_CASE("A tiny link that falls off a heavy one, slowly by its damper, is told to be unstable") {
  // Upside down at the end of a pendulum of a ton, 1e-5 m long and of 1e-12 kg: by itself I q'' + d q' - k q
  // = 0 with I = 1.05 m L^2 and k = m L (g + ...), so that q grows at about k / d. By an evaluation of the
  // equations of motion with 40 digits: 97.10980 / s and 0.0981000 / s.
  const double mass = 1e-12, length = 1e-5, inertia = 0.05 * mass * length * length;
  for (const auto& [damping, growth] : {std::pair(1e-18, 97.1098), {1e-15, 0.0981}}) {
    CAPTURE(damping);
    Mechanism m;
    m.gravity = {0, -9.81, 0};
    m.bodies = {body("hub", 1, Vec3::Zero(), Vec3::Zero()), body("big", 1e3, {0.02, -10, 0}, {1e3, 1e3, 1e3}),
                body("small", mass, {0.02, -15 + length, 0}, {inertia, inertia, inertia})};
    m.joints = {driven(revolute("spin", "ground", "hub", {0, 0, 0}, Vec3::UnitY()), 0.3),
                dampened(revolute("a", "hub", "big", {0.02, 0, 0}), 500),
                dampened(revolute("b", "big", "small", {0.02, -15, 0}), damping)};
    const Solution s = solve(m, nearest());
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == false);
    REQUIRE(s.eigenvalues);
    CHECK(std::ranges::any_of(*s.eigenvalues,
                              [rate = growth](Complex x) { return std::abs(x - rate) < 1e-4 * rate; }));
    CHECK(std::ranges::any_of(
        *s.eigenvalues, [](Complex x) { return std::abs(x - Complex(-0.0024752475, 0.9392401793)) < 1e-8; }));
  }
}
