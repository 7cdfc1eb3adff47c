// What nothing holds is named, and told from a search that failed.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/solve/newton.hpp"
#include "engine/solve/unbounded.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), origin = Vec3::Zero();

Mechanism heavy(std::vector<Body> bodies, std::vector<Joint> joints) {
  Mechanism m;
  m.name = "test";
  m.gravity = -standard_gravity * y;
  m.bodies = std::move(bodies);
  m.joints = std::move(joints);
  return m;
}

std::vector<std::string> unheld(const Solution& s) {
  std::vector<std::string> names;
  for (const UnheldCoordinate& c : s.unheld)
    names.push_back(coordinate_label(c.joint, c.index, c.count));
  return names;
}

using Names = std::vector<std::string>;

} // namespace

TEST_CASE("where no step lessens what nothing resists, damped steps end at once") {
  const Mechanism m = heavy({body("load", 3)}, {prismatic("slide", "ground", "load", origin, y)});
  const System system = compile(m);
  Parameters parameters;
  Scaling scaling;
  Unknowns at;
  bind(system, m, parameters);
  set_scaling(system, parameters, scaling);
  drawn_configuration(system, parameters, at.q);
  Workspace w;
  const NewtonOutcome outcome = newton({system, parameters, scaling}, at, w, {100, true}, nullptr);
  CHECK_FALSE(outcome.converged);
  CHECK(outcome.iterations == 0);
}

TEST_CASE("a slide that nothing holds is named, with the weight on it") {
  // At any angle to gravity but a right one, either way along its axis.
  const double tilt = GENERATE(0., 0.5, 1.3, 2.0, 3.0);
  const Vec3 axis(std::sin(tilt), std::cos(tilt), 0);
  const Mechanism m =
      heavy({body("load", 3, {0.2, 0.1, 0})}, {prismatic("slide", "ground", "load", origin, axis)});
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  REQUIRE(unheld(s) == Names{"slide"});
  CHECK(s.unheld[0].force == Approx(-3 * standard_gravity * std::cos(tilt)));
  CHECK_FALSE(s.unheld[0].angle);
  CHECK(s.unheld_by_weight);
  CHECK_THAT(s.message, ContainsSubstring("Nothing holds slide against the weight"));
  CHECK_THAT(s.message, !ContainsSubstring("Newton"));

  SECTION("a spring holds it, soft or stiff") {
    Mechanism held = m;
    held.joints[0] = sprung(held.joints[0], GENERATE(5., 1e3, 1e6));
    CHECK(solve(held).status == Status::converged);
    CHECK(solve(held).unheld.empty());
  }
  SECTION("so does a stop on the side that it falls to") {
    Mechanism held = m;
    Stop stop;
    stop.stiffness = 1e5;
    (s.unheld[0].force < 0 ? stop.lower : stop.upper) = 0;
    held.joints[0].coordinates[0].stop = stop;
    CHECK(solve(held).status == Status::converged);
  }
  SECTION("but not one on the other side") {
    Mechanism held = m;
    Stop stop;
    stop.stiffness = 1e5;
    (s.unheld[0].force < 0 ? stop.upper : stop.lower) = 0;
    held.joints[0].coordinates[0].stop = stop;
    const Solution still = solve(held);
    CHECK(still.status == Status::not_converged);
    CHECK(unheld(still) == Names{"slide"});
  }
  SECTION("and no gravity") {
    Mechanism held = m;
    held.gravity.setZero();
    CHECK(solve(held).status == Status::converged);
  }
}

TEST_CASE("a pendulum half built: the slide on its arm has no spring yet") {
  const double angle = GENERATE(0., 0.4, 1.5707963267948966);
  const Vec3 along(std::cos(angle), -std::sin(angle), 0);
  const double speed = GENERATE(0., 20.);
  Mechanism m =
      heavy({body("crank", 1, {0.5, 0, 0}), body("arm", 0, {1, 0, 0}), body("weight", 1, x + 1.1 * along)},
            {driven(revolute("spin", "ground", "crank", origin, z), 0),
             revolute("theta", "crank", "arm", x, z), prismatic("d", "arm", "weight", x, along)});
  m.joints[0].coordinates[0].drive->speed = speed;
  if (speed != 0) m.gravity.setZero(); // it would turn with the drive
  const Solution s = solve(m);
  REQUIRE(unheld(s) == Names{"d"});
  CHECK(s.unheld_by_weight == (speed == 0));
  CHECK_THAT(s.message, ContainsSubstring("Nothing holds d against"));
  // With the weight on the hinge, where the arm has no inertia, it balances; nothing keeps it there.
  if (s.status == Status::converged) CHECK(s.stable == false);
}

TEST_CASE("of a slide whose spring the centrifugal force outgrows both are told") {
  // 0.5 kg on 200 N/m: the force grows by 0.5 w^2, as much at 20 rad/s.
  const auto hub = [](double speed, double stiffness) {
    Mechanism m;
    m.bodies = {body("hub", 1), body("rider", 0.5, 0.1 * x)};
    m.joints = {driven(revolute("spin", "ground", "hub", origin, z), speed),
                prismatic("slide", "hub", "rider", 0.1 * x, x)};
    if (stiffness > 0) m.joints[1] = sprung(m.joints[1], stiffness);
    return m;
  };
  CHECK(solve(hub(19, 200)).unheld.empty());
  const Solution beyond = solve(hub(22, 200));
  CHECK(beyond.stable == false);
  CHECK_THAT(
      beyond.message,
      ContainsSubstring("What holds slide, 200 N/m, is softer than the centrifugal force, which at this "
                        "speed grows by 242 N/m: it goes on without end from the drawn pose. It needs a "
                        "stiffer spring, a stop or a lower speed."));
  for (const double speed : {19.9999999, 20.}) {
    const Solution at_pole = solve(hub(speed, 200));
    CHECK(at_pole.status == Status::not_converged);
    CHECK_THAT(at_pole.message, ContainsSubstring("What holds slide, 200 N/m, is hardly stiffer than the "
                                                  "centrifugal force, which at this speed grows by 200 N/m"));
  }
  CHECK_THAT(solve(hub(22, 0)).message, ContainsSubstring("It needs a spring or a stop."));

  Mechanism two = hub(22, 200);
  two.bodies.push_back(body("other", 0.5, -0.1 * x));
  two.joints.push_back(sprung(prismatic("opposite", "hub", "other", -0.1 * x, -x), 150));
  CHECK_THAT(
      solve(two).message,
      ContainsSubstring("What holds slide and opposite, 200 N/m and 150 N/m, is softer than the centrifugal "
                        "force, which at this speed grows by 242 N/m each: they go on without end"));
}

TEST_CASE("several things that run away are all named, and nothing else") {
  const Mechanism m = heavy(
      {body("a", 1, {0, 0, 0}), body("b", 2, {1, 0, 0}), body("c", 1, {1, -1, 0}), body("d", 1, {3, -1, 0})},
      {prismatic("first", "ground", "a", {0, 0, 0}, y), prismatic("second", "ground", "b", {1, 0, 0}, y),
       revolute("swing", "b", "c", {1, 0, 0}, z),
       sprung(prismatic("held", "ground", "d", {3, 0, 0}, y), 100)});
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  CHECK(unheld(s) == Names{"first", "second"});
  CHECK_THAT(s.message, ContainsSubstring("first and second"));
  CHECK(s.unheld[1].force == Approx(-3 * standard_gravity));
}

TEST_CASE("a body that flies falls, whatever its joint is called") {
  Mechanism m = heavy({body("stone", 1, {0, 1, 0}, {0.1, 0.1, 0.1})},
                      {joint(JointType::free, "flight", "ground", "stone", {0, 1, 0})});
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  CHECK(unheld(s) == Names{"flight.1"});
  m.gravity = {1, -1, 2};
  CHECK(unheld(solve(m)) == Names{"flight.0", "flight.1", "flight.2"});
}

TEST_CASE("a torque that nothing resists turns a hinge for ever") {
  Mechanism m = heavy({body("wheel", 1, origin, {0.1, 0.1, 0.2}), body("bob", 1, {0.3, 0, 0})},
                      {revolute("axle", "ground", "wheel", origin, z),
                       joint(JointType::fixed, "rim", "wheel", "bob", origin)});
  Force torque;
  torque.name = "motor";
  torque.type = ForceType::torque;
  torque.body = "wheel";
  torque.vector = 10 * z; // more than the bob's weight of 2.9 N m
  m.forces = {torque};
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  REQUIRE(unheld(s) == Names{"axle"});
  CHECK(s.unheld[0].angle);
  CHECK_FALSE(s.unheld_by_weight);
  m.forces[0].vector = 2 * z; // less: the bob holds it
  CHECK(solve(m).status == Status::converged);
}

TEST_CASE("a loop that falls as a whole names what it falls along") {
  // A bar between two vertical slides on the ground.
  Mechanism m = heavy(
      {body("left", 1, {-1, 0, 0}), body("right", 1, {1, 0, 0}), body("bar", 1, {0, 0, 0}, {0.1, 0.1, 0.1})},
      {prismatic("a", "ground", "left", {-1, 0, 0}, y), prismatic("b", "ground", "right", {1, 0, 0}, y),
       revolute("pin", "left", "bar", {-1, 0, 0}, z),
       distance("tie", "bar", "right", {1, 0, 0}, {1, 0, 0.2})});
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  const Names names = unheld(s);
  CHECK(std::ranges::find(names, "a") != names.end());
  CHECK(s.unheld_by_weight);
  m.joints[0] = sprung(m.joints[0], 1000);
  m.joints[1] = sprung(m.joints[1], 1000);
  CHECK(solve(m).unheld.empty());
}

TEST_CASE("what does settle has nothing that runs away") {
  for (const char* name : {"pendulum", "governor", "conical_pendulum", "watt_governor", "rate_gyro"})
    CHECK(solve(shipped(name)).unheld.empty());
}

TEST_CASE("weight that turns with the drive is told from other things that turn") {
  Mechanism m = heavy({body("wheel", 1, origin, {0.1, 0.1, 0.2}), body("bob", 1, {0.3, 0, 0})},
                      {driven(revolute("axle", "ground", "wheel", origin, z), 5),
                       sprung(revolute("hinge", "wheel", "bob", {0.2, 0, 0}, z), 10)});
  const Solution s = solve(m);
  REQUIRE(s.status == Status::no_steady_state);
  CHECK(s.weight_turns);
  CHECK(s.unheld.empty());
  m.gravity = -standard_gravity * z;
  CHECK(solve(m).status == Status::converged);
  m.gravity.setZero();
  Force push;
  push.name = "push";
  push.type = ForceType::force;
  push.body = "bob";
  push.vector = x;
  m.forces = {push};
  const Solution pushed = solve(m);
  REQUIRE(pushed.status == Status::no_steady_state);
  CHECK_FALSE(pushed.weight_turns);
}

TEST_CASE("a slide that turning unbalance pushes to and fro does not go on without end") {
  // A disc on a sledge, its mass centre beside its axis: what pushes at the drawn phase pushes back later.
  Mechanism m;
  m.bodies = {body("sledge", 3), body("disc", 1, 0.02 * x, {0.01, 0.01, 0.02})};
  m.joints = {prismatic("rail", "ground", "sledge", origin, x),
              driven(revolute("spin", "sledge", "disc", origin, z), 5)};
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  CHECK(s.unheld.empty());
  CHECK_THAT(s.message, ContainsSubstring("turns with the drives"));
  CHECK_THAT(s.message, !ContainsSubstring("without end"));
}
