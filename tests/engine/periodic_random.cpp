// Two methods against each other: shooting, and damped motions that are followed until they have settled.
#include "tests/engine/dynamics_runs.hpp"

#include "engine/periodic/periodic_state.hpp"
#include "tests/catch.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/dice.hpp"

#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using std::numbers::pi;

namespace {

// A four-bar whose crank is driven, with a chain of sprung and damped pendulums on its coupler and a sprung
// slide on its rocker, that a spring ties together; everything by chance.
Mechanism random_four_bar(Dice& dice) {
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  const double crank = dice.between(0.05, 0.12), ground = 0.5, rocker = 0.35, coupler = 0.45;
  const Vec3 a(0, crank, 0), pivot(ground, 0, 0);
  const double d = (pivot - a).norm(), along = (coupler * coupler - rocker * rocker + d * d) / (2 * d);
  const Vec3 way = (pivot - a) / d, up(-way.y(), way.x(), 0);
  const Vec3 b = a + along * way + std::sqrt(coupler * coupler - along * along) * up;
  m.bodies = {rod("crank", 1, {0, 0, 0}, a), rod("coupler", dice.between(0.5, 2), a, b),
              rod("rocker", 1, pivot, b)};
  m.joints = {driven(revolute("spin", "ground", "crank", {0, 0, 0}), dice.between(2, 12)),
              revolute("a", "crank", "coupler", a), revolute("b", "coupler", "rocker", b),
              revolute("c", "ground", "rocker", pivot)};
  std::string on = "coupler";
  Vec3 at = (a + b) / 2;
  for (int i = 0; i < 2; ++i) {
    const std::string name = "bob" + std::to_string(i);
    const Vec3 next = at + dice.between(0.1, 0.2) * Vec3(dice.between(-0.5, 0.5), -1, 0).normalized();
    m.bodies.push_back(rod(name, dice.between(0.2, 1), at, next));
    Joint swing = dampened(revolute("swing" + std::to_string(i), on, name, at), dice.between(0.05, 0.2));
    if (i == 1) swing = sprung(swing, dice.between(1, 5));
    m.joints.push_back(swing);
    on = name;
    at = next;
  }
  m.bodies.push_back(body("slider", 0.5, (b + pivot) / 2, {1e-3, 1e-3, 1e-3}));
  m.joints.push_back(dampened(
      sprung(prismatic("slide", "rocker", "slider", (b + pivot) / 2, (b - pivot).normalized()), 500), 8));
  m.forces.push_back(point_spring("tie", "bob0", "slider", m.bodies[3].position, m.bodies[5].position,
                                  dice.between(5, 40), 0.1));
  return m;
}

} // namespace

TEST_CASE("Shooting finds where random driven mechanisms with loops settle") {
  int compared = 0;
  const std::uint32_t seeds = few_or_all(3u, 8u);
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    CAPTURE(seed);
    Dice dice(seed);
    const Mechanism m = random_four_bar(dice);
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(s.message);
    if (s.status != PeriodicStatus::found || s.stable != true) continue;
    // As long as the slowest motion beside it takes to die out.
    const double slowest = -s.floquet.growth.front();
    const double periods = std::ceil(25 / slowest / s.period);
    if (periods * s.period > 200) continue;
    SimulationOptions options = lasting(periods * s.period, Integrator::automatic, 1e-11);
    options.rate = 0;
    options.start = Start::state; // beside it
    options.state = s.start;
    for (StateCoordinate& c : options.state.coordinates)
      if (c.joint == "swing0") c.rate += 0.1;
    const Run run = simulate(m, options);
    REQUIRE(run.status == RunStatus::completed);
    const SimulationState end = state_at(run, run.time.size() - 1);
    for (std::size_t i = 0; i < end.coordinates.size(); ++i) {
      const StateCoordinate &at = end.coordinates[i], &there = s.start.coordinates[i];
      CAPTURE(at.joint);
      CHECK_THAT(std::remainder(at.value - there.value, 2 * pi), WithinAbs(0, 1e-7));
      CHECK_THAT(at.rate - there.rate, WithinAbs(0, 1e-6));
    }
    // And what it tells of a period is what the motion does.
    SimulationOptions another = lasting(s.period, Integrator::automatic, 1e-11);
    another.start = Start::state;
    another.state = s.start;
    another.rate = 2000 / s.period;
    const Run period = simulate(m, another);
    for (const PeriodicCoordinate& c : s.coordinates) {
      if (c.goes_on()) continue;
      CAPTURE(c.joint);
      const std::vector<double>& values = track(period, c.joint, c.index).value;
      const auto [least, most] = std::ranges::minmax(values);
      CHECK_THAT(c.range.least, WithinAbs(least, 1e-5));
      CHECK_THAT(c.range.most, WithinAbs(most, 1e-5));
      CHECK(c.range.error < 1e-5);
    }
    ++compared;
  }
  CHECK(compared >= static_cast<int>(seeds / 2));
}
