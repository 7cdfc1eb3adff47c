// Periodic motions over a number: Jeffcott's rotor between its closed forms, and what has no motion.
#include "engine/study/resonance_curve.hpp"
#include "tests/engine/dynamics_runs.hpp"

#include "tests/catch.hpp"

#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double rotor_mass = 4, rotor_stiffness = 1e4, rotor_damping = 120, rotor_eccentricity = 1e-3;
const std::string rotor_speed = "joints.spin.drive.speed";

// A disc in a block that slides in x and y on springs, its mass centre beside its axis; weight along -y.
Mechanism resonant_rotor(double damping = rotor_damping) {
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("across", 0), body("block", 0),
              body("disc", rotor_mass, {rotor_eccentricity, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {
      dampened(sprung(prismatic("x", "ground", "across", {0, 0, 0}, {1, 0, 0}), rotor_stiffness), damping),
      dampened(sprung(prismatic("y", "across", "block", {0, 0, 0}, {0, 1, 0}), rotor_stiffness), damping),
      driven(revolute("spin", "block", "disc", {0, 0, 0}, {0, 0, 1}), 20)};
  m.measures = {{.name = "out", .description = "", .text = "coordinate(x)", .unit = "m"}};
  return m;
}

// How far the shaft whirls out (m), at a speed (rad/s).
double whirl_at(double speed) {
  const double natural = std::sqrt(rotor_stiffness / rotor_mass), n = speed / natural,
               zeta = rotor_damping / (2 * rotor_mass * natural);
  return rotor_eccentricity * n * n / std::hypot(1 - n * n, 2 * zeta * n);
}

} // namespace

TEST_CASE("A resonance curve goes through the closed form, and is drawn close where it bends") {
  std::vector<std::size_t> published;
  ResonanceOptions options;
  options.coarse = 9;
  options.tolerance = 0.03;
  options.publish = [&](const ResonanceCurve& so_far) { published.push_back(so_far.points.size()); };
  const ResonanceCurve curve = resonance_curve(resonant_rotor(), rotor_speed, 10, 100, options);
  CHECK(curve.whole);
  REQUIRE(curve.points.size() > 9);
  CHECK(curve.points.size() < 60);
  REQUIRE(published.size() == curve.points.size()); // one after the other
  for (std::size_t i = 0; i < published.size(); ++i)
    CHECK(published[i] == i + 1);
  const double sag = rotor_mass * 9.81 / rotor_stiffness;
  for (const auto& point : curve.points) {
    CAPTURE(point->number);
    REQUIRE(point->found());
    CHECK_FALSE(point->steady);
    CHECK(point->stable == true);
    const double r = whirl_at(point->number);
    const PeriodicRange *x = point->range_of(OutputKind::coordinate, "x"),
                        *y = point->range_of(OutputKind::coordinate, "y"),
                        *out = point->range_of(OutputKind::measure, "out"),
                        *period = point->range_of(OutputKind::motion, "period");
    REQUIRE((x && y && out && period));
    CHECK_THAT(x->most, WithinAbs(r, 1e-8 * r));
    CHECK_THAT(x->least, WithinAbs(-r, 1e-8 * r));
    CHECK_THAT(y->mean, WithinAbs(-sag, 1e-10));
    CHECK_THAT(out->most, WithinAbs(r, 1e-8 * r));
    CHECK_THAT(period->mean, WithinAbs(2 * std::numbers::pi / point->number, 1e-12));
    CHECK(point->range_of(OutputKind::motion, "largest multiplier")->mean < 1);
    CHECK(point->range_of(OutputKind::drive, "spin"));
    CHECK_FALSE(point->range_of(OutputKind::coordinate, "spin")); // prescribed
  }
  // Straight lines between the points keep to the closed form within two hundredths of its height.
  const double peak = whirl_at(55);
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
    const double from = curve.points[i]->number, to = curve.points[i + 1]->number;
    CHECK(from < to);
    CHECK_THAT((whirl_at(from) + whirl_at(to)) / 2, WithinAbs(whirl_at((from + to) / 2), 0.02 * peak));
  }
}

TEST_CASE("A resonance curve is even in the logarithm where its axis is") {
  ResonanceOptions options;
  options.logarithmic = true;
  options.coarse = options.most = 3;
  const ResonanceCurve curve =
      resonance_curve(resonant_rotor(), "joints.x.spring.stiffness", 1e3, 1e5, options);
  REQUIRE(curve.points.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(curve.points[i]->number == Approx(std::pow(10, 3 + static_cast<double>(i))));
  CHECK_FALSE(curve.whole); // more would bend
}

TEST_CASE("A resonance curve has steady states where nothing turns, and says why there is a gap") {
  // Nothing turns at zero; without dampers the drive pumps the motion up at the critical speed.
  ResonanceOptions options;
  options.coarse = options.most = 3;
  const ResonanceCurve curve = resonance_curve(resonant_rotor(0), rotor_speed, 0, 100, options);
  REQUIRE(curve.points.size() == 3);
  CHECK(curve.points[0]->steady);
  CHECK(curve.points[0]->range_of(OutputKind::coordinate, "y")->least ==
        Approx(-rotor_mass * 9.81 / rotor_stiffness));
  CHECK_FALSE(curve.points[1]->found());
  CHECK(curve.points[2]->found());
  const std::vector<ResonanceGap> gaps = resonance_gaps(curve);
  REQUIRE(gaps.size() == 1);
  CHECK(gaps[0].from == 50);
  CHECK(gaps[0].to == 50);
  CHECK_THAT(gaps[0].why, ContainsSubstring("grows without end"));
}

TEST_CASE("A resonance curve that is cancelled keeps what it has, and bounds end it") {
  std::atomic<bool> cancel = false;
  ResonanceOptions options;
  options.cancel = &cancel;
  options.publish = [&](const ResonanceCurve& so_far) { cancel = so_far.points.size() == 2; };
  const ResonanceCurve part = resonance_curve(resonant_rotor(), rotor_speed, 10, 100, options);
  CHECK(part.points.size() == 2);
  CHECK_FALSE(part.whole);
  ResonanceOptions bounded;
  bounded.most_evaluations = 1;
  CHECK(resonance_curve(resonant_rotor(), rotor_speed, 10, 100, bounded).points.size() == 1);
  CHECK_THROWS_AS(resonance_curve(resonant_rotor(), "joints.nothing", 10, 100), SceneError);
}

TEST_CASE("A resonance curve that was stopped goes on with the points that are there") {
  ResonanceOptions usual;
  usual.coarse = 5;
  usual.tolerance = 0.1;
  const ResonanceCurve whole = resonance_curve(resonant_rotor(), rotor_speed, 10, 100, usual);
  REQUIRE(whole.points.size() > 7);
  for (const std::size_t after : {2u, 7u}) { // among those in order, and among those between
    CAPTURE(after);
    ResonanceOptions options = usual;
    std::atomic<bool> cancel = false;
    options.cancel = &cancel;
    options.publish = [&](const ResonanceCurve& so_far) { cancel = so_far.points.size() >= after; };
    const ResonanceCurve part = resonance_curve(resonant_rotor(), rotor_speed, 10, 100, options);
    CHECK_FALSE(part.whole);
    REQUIRE(part.points.size() == after);
    std::vector<double> told;
    options.cancel = nullptr;
    options.publish = {};
    options.begun = &part;
    options.progress = [&](const Progress& now) { told.push_back(now.part); };
    const ResonanceCurve rest = resonance_curve(resonant_rotor(), rotor_speed, 10, 100, options);
    CHECK(rest.whole);
    CHECK(told.size() == whole.points.size() - after);
    CHECK(std::ranges::is_sorted(told));
    REQUIRE(rest.points.size() == whole.points.size());
    CHECK(rest.places == whole.places);
    for (std::size_t i = 0; i < whole.points.size(); ++i)
      CHECK(rest.points[i]->number == whole.points[i]->number);
    for (const auto& point : part.points) // not found again
      CHECK(std::ranges::find(rest.points, point) != rest.points.end());
  }
}

TEST_CASE("A resonance curve takes the motion where a state only nearly stands") {
  // So small an unbalance, turning slowly, is within what a steady state may be off.
  Mechanism m;
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("block", 0), body("disc", rotor_mass, {1e-8, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {dampened(sprung(prismatic("y", "ground", "block", {0.5, 0, 0}, {0, 1, 0}), rotor_stiffness),
                       rotor_damping),
              driven(revolute("spin", "block", "disc", {0, 0, 0}, {0, 0, 1}), 2)};
  const Solution steady = solve(m);
  REQUIRE(steady.status == Status::converged);
  CHECK(steady.varies);
  m.joints.back().coordinates[0].drive->speed = 0;
  CHECK_FALSE(solve(m).varies);
  ResonanceOptions options;
  options.coarse = options.most = 5;
  const ResonanceCurve curve = resonance_curve(m, rotor_speed, 0, 8, options);
  REQUIRE(curve.points.size() == 5);
  const double sag = rotor_mass * 9.81 / rotor_stiffness;
  for (const auto& point : curve.points) {
    CAPTURE(point->number, point->trouble);
    REQUIRE(point->found());
    CHECK(point->steady == (point->number == 0));
    CHECK(point->stable == true);
    const PeriodicRange *y = point->range_of(OutputKind::coordinate, "y"),
                        *force = point->range_of(OutputKind::force, "spin");
    REQUIRE((y && force));
    CHECK_THAT(y->mean, WithinAbs(-sag, 1e-13));
    CHECK_THAT(force->mean, WithinAbs(rotor_mass * 9.81, 1e-9));
  }
  CHECK_FALSE(solve(shipped("governor")).varies);
}
