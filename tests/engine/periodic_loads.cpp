// What joints, bearings, gears and drives bear over a period, against closed forms and a long damped motion.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/sampled_later.hpp"

#include "engine/periodic/orbit_ranges.hpp"

#include "tests/catch.hpp"

#include <complex>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using std::numbers::pi;

namespace {

constexpr double weight = 9.81; // m/s^2

const PeriodicReaction& load(const std::vector<PeriodicReaction>& of, const std::string& name) {
  const auto found = std::ranges::find(of, name, &PeriodicReaction::name);
  REQUIRE(found != of.end());
  return *found;
}

struct Exact {
  double mean = 0, least = 0, most = 0;
};
// Of a function of the drive's angle, by a fine grid.
template <class Function>
Exact exact(const Function& f) {
  constexpr int count = 1 << 18;
  Exact out{0, f(0.), f(0.)};
  for (int i = 0; i < count; ++i) {
    const double value = f(2 * pi * i / count);
    out.mean += value / count;
    out.least = std::min(out.least, value);
    out.most = std::max(out.most, value);
  }
  return out;
}

// Within what is told as the error, which is small. The grid misses a kink by its step.
void check_range(const PeriodicRange& range, const Exact& is, double size, double grid = 1e-9,
                 double small = 1e-7) {
  CHECK(range.error < small * size);
  CHECK_THAT(range.mean, WithinAbs(is.mean, range.error + grid * size));
  CHECK_THAT(range.least, WithinAbs(is.least, range.error + grid * size));
  CHECK_THAT(range.most, WithinAbs(is.most, range.error + grid * size));
}

// A disc on a horizontal shaft along z, its mass centre beside the axis.
Mechanism unbalanced_rotor(double mass, double e, double speed) {
  Mechanism m;
  m.gravity = {0, -weight, 0};
  m.bodies = {body("disc", mass, {e, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {driven(revolute("spin", "ground", "disc", {0, 0, 0}, {0, 0, 1}), speed)};
  return m;
}

} // namespace

TEST_CASE("The shaft of an unbalanced rotor bears its weight and m e w^2 that turns") {
  const double mass = 3, e = 0.02;
  for (const double speed : {5., -40., std::sqrt(weight / e)}) { // at the last its force vanishes once a turn
    CAPTURE(speed);
    const PeriodicState s = find_periodic_state(unbalanced_rotor(mass, e, speed));
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    REQUIRE(s.reactions.size() == 1);
    const PeriodicReaction& pin = load(s.reactions, "spin");
    const double turning = mass * e * speed * speed, size = turning + mass * weight;
    const auto x = [&](double a) { return -turning * std::cos(a); };
    const auto y = [&](double a) { return mass * weight - turning * std::sin(a); };
    check_range(pin.force.component[0], exact(x), size);
    check_range(pin.force.component[1], exact(y), size);
    check_range(pin.force.component[2], {}, size);
    const bool vanishes = std::abs(turning - mass * weight) < 1e-9 * size;
    check_range(pin.force.size, exact([&](double a) { return std::hypot(x(a), y(a)); }), size,
                vanishes ? 1e-5 : 1e-9, vanishes ? 2e-5 : 1e-7);
    CHECK_THAT(pin.force.size.least, WithinAbs(std::abs(turning - mass * weight), 1e-7 * size));
    // The drive lifts the mass centre: a moment about the shaft, and nothing on the average.
    const auto lift = [&](double a) { return mass * weight * e * std::cos(a); };
    check_range(pin.torque.component[2], exact(lift), mass * weight * e);
    check_range(pin.torque.component[0], {}, mass * weight * e);
    REQUIRE(s.drive_torques.size() == 1);
    check_range(s.drive_torques[0].range, exact(lift), mass * weight * e);
    check_range(s.drive_torques[0].power, exact([&](double a) { return speed * lift(a); }),
                mass * weight * e * std::abs(speed));
    CHECK_FALSE(pin.nonunique());
    CHECK_FALSE(s.drive_torques[0].nonunique);
  }
}

TEST_CASE("The size of a load comes back that turns with a drive without a part in the period") {
  Mechanism m;
  m.gravity = Vec3::Zero();
  m.bodies = {body("table", 1, {0.05, 0, 0}, {0.01, 0.01, 0.01}),
              body("slider", 2, {0.1, 0, 0}, {0.01, 0.01, 0.01}),
              body("rotor", 0.3, {0.13, 0.02, 0}, {0.01, 0.01, 0.01})};
  m.joints = {driven(revolute("turn", "ground", "table", {0, 0, 0}), 3),
              dampened(sprung(prismatic("slide", "table", "slider", {0.1, 0, 0}, Vec3::UnitX()), 900), 8),
              driven(revolute("shake", "slider", "rotor", {0.1, 0, 0}), 7)};
  m.measures = {{"load", "", "reaction(turn)", "N"}};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK_THAT(s.period, WithinAbs(2 * pi / 7, 1e-12));
  const PeriodicVector& force = load(s.reactions, "turn").force;
  CHECK(std::isnan(force.component[0].mean)); // it turns with the table
  const PeriodicRange& told = s.measures[0].range;
  check_range(force.size, {told.mean, told.least, told.most}, told.most);
}

TEST_CASE("A bearing bears what accelerates the rotor in it, and its damper what the drive gives") {
  // Jeffcott's rotor on a bearing: the shaft follows the mass centre's e exp(i w t) by k, d.
  const double mass = 4, e = 1e-3, k = 1e4, d = 40, natural = std::sqrt(k / mass);
  for (const double n : {0.4, 1., 2.}) {
    CAPTURE(n);
    const double w = n * natural;
    Mechanism m;
    m.gravity = {0, -weight, 0};
    m.bodies = {body("across", 0), body("block", 0), body("disc", mass, {e, 0, 0}, {0.01, 0.01, 0.02})};
    m.joints = {prismatic("x", "ground", "across", {0, 0, 0}, {1, 0, 0}),
                prismatic("y", "across", "block", {0, 0, 0}, {0, 1, 0}),
                driven(revolute("spin", "block", "disc", {0, 0, 0}, {0, 0, 1}), w)};
    Force& bearing = m.forces.emplace_back();
    bearing.name = "film";
    bearing.type = ForceType::bearing;
    bearing.bodies = {"ground", "block"};
    bearing.axis = Vec3::UnitZ();
    bearing.bearing_stiffness = {k, 0, 0, k};
    bearing.bearing_damping = {d, 0, 0, d};
    const PeriodicState s = find_periodic_state(m);
    CAPTURE(s.message);
    REQUIRE(s.status == PeriodicStatus::found);
    const std::complex<double> shaft = mass * e * w * w / std::complex<double>(k - mass * w * w, d * w);
    const double turning = std::abs(std::complex<double>(k, d * w) * shaft), size = turning + mass * weight;
    const PeriodicReaction& film = load(s.bearings, "film");
    CHECK_THAT(film.force.component[0].most, WithinAbs(turning, 1e-7 * size));
    CHECK_THAT(film.force.component[0].least, WithinAbs(-turning, 1e-7 * size));
    CHECK_THAT(film.force.component[1].mean, WithinAbs(mass * weight, 1e-7 * size));
    CHECK_THAT(film.force.component[1].most, WithinAbs(mass * weight + turning, 1e-7 * size));
    CHECK_THAT(film.force.size.most, WithinAbs(mass * weight + turning, 1e-7 * size));
    CHECK_THAT(film.force.size.least, WithinAbs(std::abs(mass * weight - turning), 1e-6 * size));
    CHECK(std::abs(film.force.size.most - mass * weight - turning) <= film.force.size.error);
    CHECK(film.force.size.error < 1e-6 * size);
    CHECK_THAT(s.drive_torques.at(0).power.mean, WithinAbs(d * std::norm(w * shaft), 1e-7 * size * w * e));
    // The same goes through the hinge of the shaft: block and slides have no mass.
    CHECK_THAT(load(s.reactions, "spin").force.size.most, WithinAbs(film.force.size.most, 1e-7 * size));
  }
}

TEST_CASE("A drive carries what a bearing beside its axis resists") {
  const double r = 0.1, speed = 3, k = 100, cross = 30, c = 2;
  Mechanism m;
  m.bodies = {body("disc", 1, {0, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {driven(revolute("spin", "ground", "disc", {0, 0, 0}, {0, 0, 1}), speed)};
  Force bearing;
  bearing.name = "seat";
  bearing.type = ForceType::bearing;
  bearing.bodies = {"ground", "disc"};
  bearing.at = {r, 0, 0};
  bearing.bearing_stiffness = {k, cross, -cross, k};
  bearing.bearing_damping = {c, 0, 0, c};
  m.forces = {bearing};
  // The moment about the axis of what moves the bearing's point.
  const auto torque = [&](double a) {
    const double x = r * (std::cos(a) - 1), y = r * std::sin(a);
    const double vx = -r * speed * std::sin(a), vy = r * speed * std::cos(a);
    return r * std::cos(a) * (k * y - cross * x + c * vy) - r * std::sin(a) * (k * x + cross * y + c * vx);
  };
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  REQUIRE(s.drive_torques.size() == 1);
  check_range(s.drive_torques[0].range, exact(torque), k * r * r);
  check_range(s.drive_torques[0].power, exact([&](double a) { return speed * torque(a); }),
              k * r * r * speed);
  for (const double error : simulate(m, lasting(2)).energy.balance)
    CHECK_THAT(error, WithinAbs(0, 1e-8 * k * r * r));
}

TEST_CASE("A slider-crank's pins and slide bear what accelerates its piston") {
  const double r = 0.25, l = 0.7762, speed = 20.9, mass = 2;
  const double drawn = 0.7; // the crank's angle
  const Vec3 pin(r * std::cos(drawn), r * std::sin(drawn), 0),
      piston(pin.x() + std::sqrt(l * l - pin.y() * pin.y()), 0, 0);
  Mechanism m;
  m.bodies = {body("crank", 1, {0, 0, 0}, {0.01, 0.01, 0.01}), body("rod", 0), body("piston", mass, piston)};
  m.joints = {driven(revolute("crankshaft", "ground", "crank", {0, 0, 0}), speed),
              revolute("crankpin", "crank", "rod", pin), revolute("wristpin", "rod", "piston", piston),
              prismatic("slide", "ground", "piston", piston, {1, 0, 0})};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  const auto rod_angle = [&](double a) { return std::asin(r / l * std::sin(a)); };
  const auto thrust = [&](double a) { // of the piston, by its second derivative with the crank's angle
    const double c = std::cos(a), t = std::sin(a), root = std::sqrt(l * l - r * r * t * t);
    const double second =
        -r * c - r * r * (c * c - t * t) / root - std::pow(r, 4) * t * t * c * c / std::pow(root, 3);
    return mass * speed * speed * second;
  };
  const double size = std::abs(thrust(0));
  const Exact along_rod = exact([&](double a) { return std::abs(thrust(a)) / std::cos(rod_angle(a)); });
  for (const std::string joint : {"crankpin", "wristpin"}) {
    CAPTURE(joint);
    const PeriodicReaction& reaction = load(s.reactions, joint);
    CHECK_THAT(reaction.force.size.most, WithinAbs(along_rod.most, 1e-8 * size));
    CHECK_THAT(reaction.force.size.least, WithinAbs(0, 1e-6 * size)); // where the piston is fastest
    CHECK_THAT(reaction.force.size.mean, WithinAbs(along_rod.mean, reaction.force.size.error + 1e-7 * size));
    check_range(reaction.force.component[0], exact(thrust), size);
  }
  check_range(load(s.reactions, "slide").force.component[1],
              exact([&](double a) { return thrust(a) * std::tan(rod_angle(a)); }), size);
  // Its planar loop holds more than it needs, out of its plane.
  for (const std::string pin_of : {"crankpin", "wristpin"}) {
    const PeriodicReaction& reaction = load(s.reactions, pin_of);
    CHECK(reaction.force.open == std::array{false, false, true});
    CHECK(reaction.torque.open == std::array{true, true, false});
    REQUIRE(reaction.force.unique_size);
    CHECK_THAT(reaction.force.unique_size->most, WithinAbs(along_rod.most, 1e-8 * size));
    CHECK(reaction.force.unique_size->error < 1e-5 * size);
  }
  CHECK_FALSE(s.drive_torques.at(0).nonunique);
  CHECK_THAT(s.drive_torques.at(0).range.mean, WithinAbs(0, 1e-9 * size));
  // Of what changes its direction four times a turn, and so has as many kinks, the size is known, too.
  const PeriodicRange& turning = load(s.reactions, "crankshaft").torque.size;
  CHECK(turning.error < 1e-5 * turning.most);
}

TEST_CASE("A crank as long as its rod moves its piston through change points that samples would fall on") {
  // Cardan's straight line: rod and crank mirror each other, and the piston goes as 2 r cos(wt). Where both
  // stand upright the loop is singular, a quarter of a turn from the drawn pose.
  const double r = 0.1, speed = 1, mass = 1;
  Mechanism m;
  m.bodies = {body("crank", 1, {0, 0, 0}, {0.01, 0.01, 0.01}), body("rod", 0),
              body("piston", mass, {2 * r, 0, 0})};
  m.joints = {driven(revolute("crankshaft", "ground", "crank", {0, 0, 0}), speed),
              revolute("crankpin", "crank", "rod", {r, 0, 0}),
              revolute("wristpin", "rod", "piston", {2 * r, 0, 0}),
              prismatic("slide", "ground", "piston", {2 * r, 0, 0}, {1, 0, 0})};
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.motion->statistics.singular_positions > 0);
  const auto coordinate = [&](const std::string& joint) {
    const auto found = std::ranges::find(s.coordinates, joint, &PeriodicCoordinate::joint);
    REQUIRE(found != s.coordinates.end());
    return *found;
  };
  const PeriodicCoordinate slide = coordinate("slide"), pin = coordinate("crankpin");
  CHECK(slide.range.error < 1e-9);
  CHECK_THAT(slide.range.mean, WithinAbs(-2 * r, 1e-10));
  CHECK_THAT(slide.range.least, WithinAbs(-4 * r, 1e-10));
  CHECK_THAT(slide.range.most, WithinAbs(0, 1e-10));
  CHECK_THAT(pin.advance, WithinAbs(-4 * pi, 1e-9));
  CHECK_THAT(pin.range.least, WithinAbs(0, 1e-9)); // counted from the drawn phase
  CHECK_THAT(pin.range.most, WithinAbs(0, 1e-9));
  // What the piston takes goes through the massless rod, at the angle -wt.
  const auto thrust = [&](double a) { return -mass * 2 * r * speed * speed * std::cos(a); };
  check_range(load(s.reactions, "slide").force.component[1],
              exact([&](double a) { return thrust(a) * std::tan(a); }), 2 * r, 1e-6, 1e-5);
  // Also where a sample falls right on it a motion goes on.
  SimulationOptions options;
  options.duration = 2 * pi / speed;
  for (const int samples : {64, 100, 256}) {
    CAPTURE(samples);
    options.rate = samples / options.duration;
    const Run run = simulate(m, options);
    CAPTURE(run.message);
    CHECK(run.status == RunStatus::completed);
    CHECK(run.time.size() == static_cast<std::size_t>(samples) + 1);
  }
}

TEST_CASE("A limit cycle through positions in which arms hang straight says so") {
  const PeriodicState s = find_periodic_state(shipped("governor_engine", {{"joints.slide.damping", 15}}));
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  CHECK(s.motion->statistics.singular_positions > 0);
  CHECK_THAT(s.message, ContainsSubstring("could part into branches"));
}

TEST_CASE("Springs and dampers over a period are those of a forced oscillator") {
  // On a slide, by its own spring and damper and by those between two points: half of each.
  const double mass = 2, e = 0.01, speed = 9, stiffness = 150, damping = 8;
  Mechanism m;
  m.bodies = {body("block", 1), body("disc", mass - 1, {e, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {dampened(sprung(prismatic("slide", "ground", "block", {0, 0, 0}, {1, 0, 0}), stiffness / 2),
                       damping / 2),
              driven(revolute("spin", "block", "disc", {0, 0, 0}), speed)};
  m.forces = {point_spring("coil", "block", "ground", {0, 0, 0}, {1, 0, 0}, stiffness / 2, 0.9)};
  m.forces[0].damping = damping / 2;
  m.joints[0].coordinates[0].spring->free = -0.1; // against the coil's tension
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  REQUIRE(s.springs.size() == 2);
  const std::complex<double> force(stiffness - mass * speed * speed, damping * speed);
  const double amplitude = (mass - 1) * e * speed * speed / std::abs(force), preload = stiffness / 2 * 0.1;
  for (const PeriodicSpring& spring : s.springs) {
    CAPTURE(spring.joint);
    const double sign = spring.between_points ? 1 : -1, size = preload;
    const auto swings = [&](double mean, double by) { return Exact{mean, mean - by, mean + by}; };
    REQUIRE((spring.spring && spring.damper && spring.sum));
    CHECK_FALSE(spring.stop);
    check_range(*spring.spring, swings(sign * preload, amplitude * stiffness / 2), size);
    check_range(*spring.damper, swings(0, amplitude * speed * damping / 2), size);
    check_range(*spring.sum, swings(sign * preload, amplitude * std::hypot(stiffness, speed * damping) / 2),
                size);
  }
  CHECK(s.springs[0].joint == "slide");
  CHECK(s.springs[1].joint == "coil");
}

TEST_CASE("What a gear bears over a period turns the wheel behind it") {
  const double inertia = 0.3, mass = 2, e = 0.1, speed = 6, ratio = -2;
  Mechanism m = unbalanced_rotor(mass, e, speed);
  m.bodies.push_back(body("wheel", mass, {1 + e, 0, 0}, {inertia, inertia, inertia}));
  m.joints.push_back(revolute("behind", "ground", "wheel", {1, 0, 0}));
  m.joints.push_back(gear("teeth", "spin", "behind", ratio));
  const PeriodicState s = find_periodic_state(m);
  CAPTURE(s.message);
  REQUIRE(s.status == PeriodicStatus::found);
  REQUIRE(s.gears.size() == 1);
  CHECK(s.gears[0].joint == "teeth");
  const double lift = mass * weight * e;
  check_range(s.gears[0].b, {0, -lift, lift}, lift);
  check_range(s.gears[0].a, {0, ratio * lift, -ratio * lift}, lift);
  CHECK(s.reactions.size() == 2); // of gears there are none besides
}

TEST_CASE("Loads over a period are those that a long damped motion comes to") {
  Mechanism m = shipped("horizontal_rotor");
  const PeriodicState s = find_periodic_state(m);
  REQUIRE(s.status == PeriodicStatus::found);
  const int samples = 2048;
  const double quiet = 19 * s.period + 8;
  SimulationOptions options = lasting(quiet + s.period, Integrator::automatic, 1e-11);
  options.rate = samples / s.period;
  options.reactions = true;
  const Run run = sampled_later(m, options, quiet);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.reactions.size() == s.reactions.size());
  for (std::size_t j = 0; j < run.reactions.size(); ++j) {
    const ReactionTrack& track = run.reactions[j];
    CAPTURE(track.joint);
    REQUIRE(s.reactions[j].name == track.joint);
    Exact size{0, 1e300, 0};
    std::array<Exact, 3> component;
    component.fill({0, 1e300, -1e300});
    for (std::size_t i = track.force.size() - samples; i < track.force.size(); ++i) {
      const auto take = [&](Exact& into, double value) {
        into = {into.mean + value / samples, std::min(into.least, value), std::max(into.most, value)};
      };
      take(size, track.force[i].norm());
      for (Eigen::Index c = 0; c < 3; ++c)
        take(component[static_cast<std::size_t>(c)], track.force[i][c]);
    }
    // Samples miss extremes by the square of their distance.
    const auto check = [&](const PeriodicRange& told, const Exact& seen) {
      const double most = size.most;
      CHECK_THAT(told.mean, WithinAbs(seen.mean, 2e-6 * most));
      CHECK_THAT(told.least, WithinAbs(seen.least, 1e-5 * most));
      CHECK_THAT(told.most, WithinAbs(seen.most, 1e-5 * most));
      CHECK(told.least <= seen.least + 2e-6 * most);
      CHECK(told.most >= seen.most - 2e-6 * most);
    };
    check(s.reactions[j].force.size, size);
    for (std::size_t c = 0; c < 3; ++c)
      check(s.reactions[j].force.component[c], component[c]);
  }
}

TEST_CASE("The size of a vector has its extremes between samples, also where it vanishes") {
  std::array<std::vector<double>, 3> components;
  for (int i = 0; i <= 256; ++i) {
    const double a = 2 * pi * i / 256;
    components[0].push_back(3 * std::sin(a - 0.0123));
    components[1].push_back(4 * std::sin(a - 0.0123));
    components[2].push_back(0);
  }
  const PeriodicRange range = size_over_period(components);
  CHECK_THAT(range.most, WithinAbs(5, 1e-11));
  CHECK_THAT(range.least, WithinAbs(0, 1e-7));
  CHECK_THAT(range.mean, WithinAbs(10 / pi, std::min(range.error, 1e-5)));
  CHECK(range.error < 1e-4);
}
