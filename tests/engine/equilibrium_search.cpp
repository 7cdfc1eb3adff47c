// What a search all over the ranges adds: the list of all equilibria, and answers where the way from the
// start leads to none that holds.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"

#include <complex>
#include <cstring>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double pi = std::numbers::pi;

// An unsymmetric rotor in a gimbal on a turntable, which a spring draws towards the turntable's axis: only
// there does the balance hold as the rotor turns.
Mechanism gimbal(double turn, double rotor_speed, const Vec3& inertia, double stiffness) {
  Mechanism m;
  m.bodies = {spindle(), body("gimbal", 0.1, {0, 0, 0}, {0.001, 0.001, 0.001}),
              body("rotor", 0.5, {0, 0, 0}, inertia)};
  m.joints = {
      spin(turn),
      dampened(sprung(revolute("tilt", "spindle", "gimbal", {0, 0, 0}, {0, 0, 1}), stiffness, pi / 2), 0.1),
      driven(revolute("rotor", "gimbal", "rotor", {0, 0, 0}, {1, 0, 0}), rotor_speed)};
  return m;
}

// An arm on a level shaft: its weight turns with the shaft, but has no moment about the hinge where the arm
// stands at right angles to the shaft.
Mechanism arm_on_level_shaft(double speed, double angle) {
  Mechanism m = conical(0.5, 0.1, speed, angle);
  m.gravity = {-standard_gravity, 0, 0};
  m.joints[1].coordinates[0].damping = 0.5;
  return m;
}

void check_list(const AllSolutions& all) {
  for (std::size_t i = 0; i < all.equilibria.size(); ++i) {
    const Solution& s = all.equilibria[i];
    for (const AllSolutions::Bound& b : all.bounds) {
      const double at = value(s, b.joint, b.index);
      CAPTURE(b.joint, b.index, at, b.lower, b.upper);
      CHECK(at >= b.lower - 1e-9);
      CHECK(at <= b.upper + 1e-9);
    }
    for (std::size_t k = 0; k < i; ++k) {
      bool copy = true;
      for (const AllSolutions::Bound& b : all.bounds) {
        double away = value(s, b.joint, b.index) - value(all.equilibria[k], b.joint, b.index);
        if (b.angle) away = std::remainder(away, 2 * pi);
        copy = copy && std::abs(away) < 1e-6;
      }
      CAPTURE(i, k);
      CHECK_FALSE(copy);
    }
  }
}

} // namespace

TEST_CASE("a steady state that the way from the start misses is found before solving refuses", "[search]") {
  const Solution shipped_case = solve(stored_case("steady_at_another_root"));
  INFO(shipped_case.message);
  REQUIRE(shipped_case.status == Status::converged);
  CHECK(shipped_case.fallback == Fallback::search);
  CHECK_THAT(shipped_case.message, ContainsSubstring("search"));
  check_value(shipped_case, "h", pi / 2);

  for (const double turn : {2., -4.})
    for (const double rotor : {30., -75.}) {
      const Solution s = solve(gimbal(turn, rotor, {0.003, 0.002, 0.0025}, 0.3));
      CAPTURE(turn, rotor, s.message);
      REQUIRE(s.status == Status::converged);
      CHECK(std::abs(std::remainder(value(s, "tilt") - pi / 2, 2 * pi)) < 1e-12);
    }
  for (const double angle : {-2.5, -0.4, 0.3, 1.2}) {
    const Solution s = solve(arm_on_level_shaft(7, angle));
    CAPTURE(angle, s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(std::abs(std::cos(value(s, "swing"))) < 1e-12);
  }
  // Nearest is nearest: it refuses, and says that others were not tried.
  const Solution plain = solve(arm_on_level_shaft(7, 0.3), nearest());
  INFO(plain.message);
  CHECK(plain.status == Status::no_steady_state);
}

TEST_CASE("a gyrocompass points north at the Earth's rate", "[search]") {
  // Along it the potential, C w^2 / 2 for the most part, changes by 1e-8 of itself.
  const double latitude = 0.7, drawn = 3, c = 0.01, a = 0.006;
  for (const double rate : {1e-2, 7.292e-5}) {
    CAPTURE(rate);
    Mechanism m;
    m.gravity = Vec3::Zero();
    m.bodies = {body("earth", 1, Vec3::Zero(), {1, 1, 1}),
                body("gimbal", 0.1, Vec3::Zero(), {1e-3, 1e-3, 1e-3}),
                body("rotor", 1, Vec3::Zero(), {a, a, a})};
    const double x = std::cos(drawn), z = std::sin(drawn);
    m.bodies[2].inertia = {a + (c - a) * x * x, a, a + (c - a) * z * z, 0, (c - a) * x * z, 0};
    m.joints = {driven(revolute("turns", "ground", "earth", Vec3::Zero(),
                                {std::cos(latitude), std::sin(latitude), 0}),
                       rate),
                dampened(revolute("vertical", "earth", "gimbal", Vec3::Zero(), {0, 1, 0}), 1e-4),
                driven(revolute("spins", "gimbal", "rotor", Vec3::Zero(), {x, 0, z}), 2500)};
    const Solution s = solve(m);
    CAPTURE(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    CHECK(std::abs(s.coordinates[1].value - drawn) < 1e-6);
  }
}

TEST_CASE("a refusal says what was tried", "[search]") {
  Mechanism leaning = conical(0.5, 0.2, 5, 0.2);
  leaning.gravity = standard_gravity * Vec3(0, -std::cos(0.3), std::sin(0.3));
  const Solution s = solve(leaning);
  INFO(s.message);
  CHECK(s.status == Status::no_steady_state);
  CHECK_THAT(s.message,
             ContainsSubstring("holds at every phase") || ContainsSubstring("the only equilibrium"));

  SolveOptions at_once;
  at_once.search = 0;
  const Solution brief = solve(leaning, at_once);
  INFO(brief.message);
  CHECK(brief.status == Status::no_steady_state);
  CHECK_THAT(brief.message, ContainsSubstring("this start alone"));
  CHECK_THAT(brief.message, ContainsSubstring("--all"));
}

TEST_CASE("where Newton-Raphson and its fallbacks lead nowhere a search may", "[search]") {
  const Solution s = solve(stored_case("five_bodies_from_afar"));
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.fallback == Fallback::search);
  CHECK(s.residual < 1e-10);

  std::atomic<bool> cancel = true;
  SolveOptions cancelled;
  cancelled.cancel = &cancel;
  CHECK(solve(stored_case("five_bodies_from_afar"), cancelled).status == Status::not_converged);
}

TEST_CASE("branches begin where solving answers, though the drawn pose leads to nothing", "[search]") {
  for (const char* name : {"five_bodies_from_afar", "steady_at_another_root"}) {
    const Mechanism m = stored_case(name);
    const std::string speed = "joints." + m.joints.front().name + ".drive.speed";
    const double now = get_parameter(m, speed);
    BranchOptions few;
    few.max_points = 5;
    const ResponseDiagram d = follow_branches(m, speed, now, 1.02 * now, few);
    CAPTURE(name, d.message);
    REQUIRE(d.status == Status::converged);
    CHECK_THAT(d.message, ContainsSubstring("a search found"));
    const Solution s = solve(m);
    REQUIRE(s.coordinates.size() == d.branches.front().points.front().coordinates.size());
    for (std::size_t i = 0; i < s.coordinates.size(); ++i)
      CHECK(std::abs(d.branches.front().points.front().coordinates[i].value - s.coordinates[i].value) < 1e-8);
  }
}

TEST_CASE("a pendulum on a ball joint hangs and stands", "[all]") {
  Mechanism m;
  m.name = "ball";
  m.gravity = -standard_gravity * Vec3::UnitZ();
  m.bodies = {body("bob", 1, -Vec3::UnitZ())};
  m.joints = {joint(JointType::spherical, "h", "ground", "bob", Vec3::Zero())};
  const AllSolutions all = Analysis(m).solve_all();
  CAPTURE(all.message);
  REQUIRE(all.equilibria.size() == 2);
  CHECK(all.equilibria[0].potential.value() == Approx(-standard_gravity));
  CHECK(all.equilibria[1].potential.value() == Approx(standard_gravity));
  CHECK(all.equilibria[1].stable == false);
}

TEST_CASE("what falls for certain is unstable, whatever another direction leaves open", "[search]") {
  // A pendulum on a cart that nothing holds along its rail.
  Mechanism m;
  m.name = "cart";
  m.gravity = -standard_gravity * Vec3::UnitZ();
  m.bodies = {body("cart", 1, Vec3::Zero()), body("bob", 1, -Vec3::UnitZ(), {0.01, 0.01, 0.01})};
  m.joints = {prismatic("x", "ground", "cart", Vec3::Zero(), Vec3::UnitY()),
              revolute("p", "cart", "bob", Vec3::Zero(), Vec3::UnitX())};
  SolveOptions upright;
  upright.nearest = true;
  upright.start = {{"p", GENERATE(3.1, 3.1415926, std::numbers::pi)}};
  const Solution s = solve(m, upright);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == false);
  CHECK(s.stability_reason == StabilityReason::unstable);
  CHECK(s.neutral == std::vector<std::string>{"x"});
}

TEST_CASE("what a state leaves at other phases counts in its error", "[search]") {
  for (const double tilt : {1e-8, 3e-10, 1e-12}) {
    Mechanism m = stored_case("slightly_tilted");
    const double g = -m.gravity.z();
    m.gravity.x() = tilt * g;
    const Solution s = solve(m);
    CAPTURE(tilt, s.message);
    if (s.status == Status::no_steady_state) continue; // honest, too
    REQUIRE(s.status == Status::converged);
    // Where the balance stands as gravity turns round the shaft.
    for (const double phase : {0.5, 1.5, 3., 4.7}) {
      m.gravity = {tilt * g * std::cos(phase), -tilt * g * std::sin(phase), -g};
      SolveOptions options;
      options.start = start_values(s.coordinates);
      options.nearest = true;
      const Solution there = solve(m, options);
      CAPTURE(phase, value(there, "h"), value(s, "h"));
      CHECK(std::abs(value(there, "h") - value(s, "h")) <= coordinate(s, "h").error);
    }
  }
  Mechanism upright = stored_case("slightly_tilted");
  upright.gravity.x() = 0;
  CHECK(coordinate(solve(upright), "h").error < 1e-14);
}

TEST_CASE("all equilibria of planar pendulums on a shaft", "[all]") {
  const AllSolutions triple = Analysis(stored_case("triple_pendulum_turning")).solve_all();
  INFO(triple.message);
  CHECK(triple.equilibria.size() == 32);
  check_list(triple);
  for (const char* name : {"soft_spirals", "soft_spirals_of_two"}) {
    const AllSolutions all = Analysis(stored_case(name)).solve_all();
    CAPTURE(name, all.message, all.equilibria.size());
    check_list(all);
  }
}

TEST_CASE("of more equilibria than the budget lasts for most of it goes into finding them", "[all]") {
  // Eight pendulums on a hub that feel nothing of each other, with 2^8 4 equilibria. Comparing what is put
  // together of those known with the list once took all the time that 128 of them left.
  Mechanism m;
  m.bodies = {body("hub", 1, {0, 1, 0}, {1e-3, 1e-3, 1e-3})};
  m.joints = {driven(revolute("spin", "ground", "hub", {0, 1, 0}, {0, 1, 0}), 8)};
  for (int i = 0; i < 8; ++i) {
    const std::string name = std::to_string(i);
    const double angle = 0.1 + std::numbers::pi / 4 * i, c = std::cos(angle), s = std::sin(angle);
    const Vec3 at(0.1 * c, 1, 0.1 * s);
    m.bodies.push_back(body("b" + name, 0.5 + 0.1 * i, at - Vec3(0, 0.2 + 0.03 * i, 0), {1e-3, 1e-3, 1e-3}));
    m.joints.push_back(revolute("p" + name, "hub", "b" + name, at, {-s, 0, c}));
  }
  validate(m);
  const AllSolutions all = Analysis(m).solve_all();
  CAPTURE(all.message);
  CHECK(all.equilibria.size() > 500);
}

TEST_CASE("an equilibrium beside a singular pose of the loops is listed once", "[all]") {
  // With the arms stretched out the loops of this governor are singular: near that pose Newton-Raphson ends
  // at another place within some 1e-5 rad each time. Three such poses were told as 28 equilibria.
  SolveOptions longer;
  longer.search_time = 4;
  const AllSolutions all = Analysis(shipped("governor_bearing")).solve_all(longer);
  CAPTURE(all.message, all.equilibria.size());
  CHECK(all.equilibria.size() >= 11);
  CHECK(all.passing <= 3);
  for (const Solution& a : all.equilibria)
    for (const Solution& b : all.equilibria) {
      if (&a == &b) continue;
      double apart = 0;
      for (std::size_t i = 0; i < a.coordinates.size(); ++i)
        apart = std::max(apart, std::abs(a.coordinates[i].value - b.coordinates[i].value));
      CHECK(apart > 1e-3);
    }
}

TEST_CASE("a search is bounded by its starts, repeats itself to the bit and can be cancelled", "[all]") {
  const Mechanism m = stored_case("soft_spirals");
  SolveOptions options;
  const AllSolutions one = Analysis(m).solve_all(options), again = Analysis(m).solve_all(options);
  REQUIRE(one.equilibria.size() == again.equilibria.size());
  CHECK(one.starts == again.starts);
  for (std::size_t i = 0; i < one.equilibria.size(); ++i)
    for (std::size_t c = 0; c < one.equilibria[i].coordinates.size(); ++c) {
      const double a = one.equilibria[i].coordinates[c].value, b = again.equilibria[i].coordinates[c].value;
      CHECK(std::memcmp(&a, &b, sizeof a) == 0);
    }
  options.search_starts = 20;
  const AllSolutions few = Analysis(m).solve_all(options);
  CHECK(few.end == SearchEnd::starts);
  CHECK(few.starts <= 25);
  CHECK(few.equilibria.size() <= one.equilibria.size());
  std::atomic<bool> cancel = true;
  options.cancel = &cancel;
  CHECK(Analysis(m).solve_all(options).end == SearchEnd::cancelled);
}

TEST_CASE("bounds reach as far as the answer does", "[all]") {
  // Wound up by two turns and a half: the answer lies where the drawn pose's label says.
  Mechanism m = conical(0.5, 0.1, 2, 0.2);
  m.joints[1].coordinates[0].drawn = 15.9;
  m.joints[1].coordinates[0].spring = CoordinateSpring{40, 16};
  const Solution answer = solve(m);
  REQUIRE(answer.status == Status::converged);
  const AllSolutions all = Analysis(m).solve_all();
  check_list(all);
  CHECK(std::ranges::any_of(all.equilibria, [&](const Solution& s) {
    return std::abs(value(s, "swing") - value(answer, "swing")) < 1e-9;
  }));
}

namespace {

// Cranks of 0.2 m on ground pivots 0.4 m apart, and a coupler as long: it can be flat, and there fold over.
Mechanism parallelogram() {
  Mechanism m;
  m.gravity = {0, -10, 0};
  m.bodies = {body("crank", 1, {0.06, 0.08, 0}, {0.001, 0.001, 0.002}),
              body("coupler", 0.5, {0.3, 0.18, 0}, {0.001, 0.001, 0.004}),
              body("rocker", 0.8, {0.45, 0.08, 0}, {0.001, 0.001, 0.002})};
  m.joints = {revolute("a", "ground", "crank", {0, 0, 0}, {0, 0, 1}),
              revolute("b", "crank", "coupler", {0.12, 0.16, 0}, {0, 0, 1}),
              revolute("c", "coupler", "rocker", {0.52, 0.16, 0}, {0, 0, 1}),
              revolute("d", "rocker", "ground", {0.4, 0, 0}, {0, 0, 1})};
  return m;
}

// The potential (J) with the crank turned by `a`, open or folded over: the coupler's other end is where the
// parallelogram has it, or mirrored at the diagonal.
double potential(double a, bool folded) {
  using Point = std::complex<double>;
  const Point ground = 0.4, drawn(0.12, 0.16), crank = drawn * std::polar(1., a);
  Point rocker = crank + ground;
  if (folded) {
    const Point diagonal = (ground - crank) / std::abs(ground - crank);
    rocker = crank + diagonal * diagonal * std::conj(ground);
  }
  const auto height = [](Point mark, Point from, Point to, Point now_from, Point now_to) {
    return (now_from + (mark - from) * (now_to - now_from) / (to - from)).imag();
  };
  return 10 * height({0.06, 0.08}, 0, drawn, 0, crank) +
         5 * height({0.3, 0.18}, drawn, drawn + ground, crank, rocker) +
         8 * height({0.45, 0.08}, ground, drawn + ground, ground, rocker);
}

} // namespace

TEST_CASE("a parallelogram is in balance where its potential is level, and not where it is flat", "[all]") {
  std::vector<double> level; // a, in the order of both forms
  for (const bool folded : {false, true}) {
    constexpr int parts = 2000;
    const auto slope = [&](double a) { return potential(a + 1e-5, folded) - potential(a - 1e-5, folded); };
    const double flat = -std::atan2(0.16, 0.12); // and half a turn further on
    for (int i = 1; i < parts - 1; ++i) {
      const double from = flat + 2 * pi * i / parts, to = flat + 2 * pi * (i + 1) / parts;
      if (2 * i == parts || 2 * (i + 1) == parts) continue;
      if (slope(from) * slope(to) < 0) level.push_back(std::remainder((from + to) / 2, 2 * pi));
    }
  }
  REQUIRE(level.size() == 6);
  const AllSolutions all = Analysis(parallelogram()).solve_all();
  CHECK(all.equilibria.size() == level.size());
  for (const Solution& s : all.equilibria) {
    CAPTURE(value(s, "a"));
    CHECK(std::ranges::any_of(level, [&](double a) {
      return std::abs(std::remainder(value(s, "a") - a, 2 * pi)) < 2 * pi / 2000;
    }));
  }
}

TEST_CASE("a linkage that hangs straight stands in a singular pose, and is in balance there", "[all]") {
  // Of links of 0.2, 0.3 and 0.4 m between points 0.5 m above each other: each hangs as low as it can.
  const Vec3 knee(0.12432199365413288, 0.1566653819254967, 0),
      wrist(0.33903586862335932, 0.3661837630392495, 0), above(0.5, 0, 0);
  REQUIRE((wrist - knee).norm() == Approx(0.3).epsilon(1e-9));
  REQUIRE((wrist - above).norm() == Approx(0.4).epsilon(1e-9));
  Mechanism m;
  m.gravity = {-standard_gravity, 0, 0};
  m.bodies = {body("crank", 1, knee / 2, {0.001, 0.001, 0.003}),
              body("coupler", 0.5, (knee + wrist) / 2, {0.001, 0.001, 0.003}),
              body("rocker", 0.8, (wrist + above) / 2, {0.001, 0.001, 0.003})};
  m.joints = {dampened(revolute("a", "ground", "crank", {0, 0, 0}, {0, 0, 1}), 0.1),
              revolute("b", "crank", "coupler", knee, {0, 0, 1}),
              revolute("c", "coupler", "rocker", wrist, {0, 0, 1}),
              revolute("d", "ground", "rocker", above, {0, 0, 1})};
  const Solution s = solve(m);
  CHECK(s.status == Status::converged);
  CHECK(s.stable == true);
  CHECK(std::abs(std::remainder(value(s, "a") - (pi - 0.9), 2 * pi)) < 1e-4);
  const AllSolutions all = Analysis(m).solve_all();
  CHECK(std::ranges::count(all.equilibria, true, [](const Solution& e) { return e.stable == true; }) == 1);
}

TEST_CASE("rods that are straight between fixed points stay where they are", "[all]") {
  Mechanism m;
  m.gravity = {0, -10, 0};
  m.bodies = {body("left", 1, {0.5, 0, 0}, {0.01, 0.01, 0.01}),
              body("right", 1, {1.5, 0, 0}, {0.01, 0.01, 0.01})};
  m.joints = {revolute("a", "ground", "left", {0, 0, 0}, {0, 0, 1}),
              revolute("b", "left", "right", {1, 0, 0}, {0, 0, 1}),
              revolute("c", "right", "ground", {2, 0, 0}, {0, 0, 1})};
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 1);
  CHECK(std::abs(value(all.equilibria[0], "a")) < 1e-5);
  CHECK(solve(m).status == Status::converged);
}
