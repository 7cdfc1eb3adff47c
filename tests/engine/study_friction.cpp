// The band that dry friction makes of a steady state, and what holding takes: against closed forms, and
// against each other.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/friction_report.hpp"
#include "engine/study/friction_ribbon.hpp"
#include "engine/study/linear_model.hpp"
#include "engine/study/steady_map.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const BandExtent& extent(const FrictionBand& band, std::string_view name) {
  INFO(band.message);
  REQUIRE(band.found);
  const auto found = std::ranges::find(band.extents, name, &BandExtent::name);
  REQUIRE(found != band.extents.end());
  return *found;
}

// 18 N of 21.6 N, in gravity of 10 m/s^2.
Mechanism block_on_a_slope() {
  return read_scene(R"({"flyball": 1, "name": "Slope", "gravity": [0, -10, 0],
    "bodies": [{"name": "block", "mass": 3, "position": [0, 0, 0]}],
    "joints": [{"name": "slope", "type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0],
      "axis": [0.8, 0.6, 0], "friction": {"mu": 0.9, "preload": 24}}]})");
}

} // namespace

TEST_CASE("friction holds a pendulum within sin theta = T / m g l") {
  const double limit = 1.5, most = std::asin(limit / (2 * 10 * 0.5));
  const FrictionBand band = find_friction_band(rubbing_pendulum(limit));
  const BandExtent& hinge = extent(band, "hinge");
  CHECK_THAT(hinge.low, WithinRel(-most, 1e-12));
  CHECK_THAT(hinge.high, WithinRel(most, 1e-12));
  CHECK(hinge.unit == "rad");
  CHECK(band.whole);
  CHECK(hinge.shares_high == std::vector<double>{1});
}

TEST_CASE("more friction than weight holds a pendulum all round, through the folds") {
  const FrictionBand band = find_friction_band(rubbing_pendulum(12));
  CHECK_FALSE(band.whole);
  CHECK(band.folds);
  // Not how far that was followed.
  CHECK(extent(band, "hinge").high == std::numeric_limits<double>::infinity());
  CHECK(extent(band, "hinge").low == -std::numeric_limits<double>::infinity());
  CHECK(band.message == "Friction holds it at any angle: hinge can go round.");
}

TEST_CASE("the band of an angle goes on beyond half a turn, as that which it hangs from goes round") {
  // The second rod hangs straight down, whatever friction does to the first.
  const auto two_rods = [](double limit, double stiffness) {
    Mechanism m = rubbing_pendulum(limit);
    m.bodies.push_back(body("second", 0.2, {0, -0.8, 0}));
    Joint& hinge = m.joints[0];
    if (stiffness > 0) hinge.coordinates[0].spring = CoordinateSpring{stiffness, 0, "", 0};
    m.joints.push_back(revolute("knee", "bob", "second", {0, -0.5, 0}, {0, 0, 1}));
    m.joints[1].coordinates[0].drawn = 0.4;
    return m;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  const FrictionBand free = find_friction_band(two_rods(13, 0));
  CHECK(extent(free, "hinge").low == -infinity);
  CHECK(extent(free, "knee").low == -infinity);
  CHECK(extent(free, "knee").high == infinity);
  CHECK(free.message == "Friction holds it at any angle: hinge and knee can go round.");
  // 0.9 N m q + 11 N m sin q within 13 N m, beyond a whole turn.
  const FrictionBand sprung = find_friction_band(two_rods(13, 0.9));
  const BandExtent &hinge = extent(sprung, "hinge"), &knee = extent(sprung, "knee");
  CHECK(hinge.high > 2 * std::numbers::pi);
  CHECK_THAT(0.9 * hinge.high + 11 * std::sin(hinge.high), WithinRel(13, 1e-6));
  CHECK_THAT(knee.low, WithinAbs(0.4 - hinge.high, 1e-6));
  CHECK_THAT(knee.high, WithinAbs(0.4 - hinge.low, 1e-6));
}

TEST_CASE("the band of a measured angle goes on beyond half a turn") {
  // The bob hangs where the angle jumps from pi to -pi.
  const double limit = GENERATE(5., 9.9, 12.);
  CAPTURE(limit);
  Mechanism m = rubbing_pendulum(limit);
  m.measures.push_back(
      {.name = "upwards", .description = {}, .text = "atan2(-x(bob), y(bob))", .unit = "rad"});
  const FrictionBand band = find_friction_band(m);
  const BandExtent& angle = extent(band, "upwards");
  CHECK(std::abs(angle.value) > 3.14);
  const double most = limit < 10 ? std::asin(limit / 10) : std::numeric_limits<double>::infinity();
  CHECK_THAT(angle.low, WithinRel(angle.value - most, 1e-9));
  CHECK_THAT(angle.high, WithinRel(angle.value + most, 1e-9));
  if (limit > 10) CHECK(band.message == "Friction holds it at any angle: hinge and upwards can go round.");
}

TEST_CASE("through folds a measured angle goes on beyond half a turn, and tells its crests") {
  // 10.5 N m against 10 N m sin q within 1.5 N m, from 0.9 to 1 at the top and down to 0.9 again.
  Mechanism m = rubbing_pendulum(1.5);
  Force push;
  push.name = "push";
  push.type = ForceType::torque;
  push.body = "bob";
  push.vector = {0, 0, 10.5};
  m.forces = {push};
  m.measures.push_back({.name = "turned",
                        .description = {},
                        .text = "atan2(-y(bob), -x(bob)) + 0.1 rad*sin(coordinate(hinge))",
                        .unit = "rad"});
  const BandExtent turned = extent(report_friction(m, Analysis(m).solve()).band, "turned");
  // The angle from -x is pi/2 + q, which jumps at q = pi/2.
  const double low = std::asin(0.9), high = std::numbers::pi - low, half = std::numbers::pi / 2;
  CHECK_THAT(turned.high - turned.low, WithinRel(high - low, 1e-6));
  CHECK_THAT(std::remainder(turned.low - (half + low + 0.09), 2 * std::numbers::pi), WithinAbs(0, 1e-9));
}

TEST_CASE("friction in the guide of a slider-crank holds it at any angle of the crank: d from -0.2 to 0") {
  // 22.55 N are needed at most, so that the ways round leave the dead centre near the limit or far below it.
  for (const double limit : {22.6, 23., 30., 100.}) {
    CAPTURE(limit);
    const FrictionBand band = find_friction_band(rubbing_slider_crank(limit));
    INFO(band.message);
    CHECK(band.folds);
    CHECK_THAT(extent(band, "d").low, WithinAbs(-0.2, 1e-9));
    CHECK_THAT(extent(band, "d").high, WithinAbs(0, 1e-9));
    CHECK(extent(band, "a").low == -std::numeric_limits<double>::infinity());
    CHECK(extent(band, "a").high == std::numeric_limits<double>::infinity());
  }
}

TEST_CASE("a spring's table that falls within friction's limits ends the band of what stands beyond") {
  // The force falls from 13.9 N at 0.42 m to -5.35 N at 0.6 m. At 0.77 m, where it is zero on its way up
  // again, friction holds it from where the table has fallen to the limit on. States that are held far on the
  // near side, where the force is beyond -5.35 N, too, are no part of that.
  const double limit = GENERATE(7., 10., 10.474);
  const auto scene = [](double most) {
    return read_scene(R"json({"flyball": 2, "name": "Table", "gravity": [0, 0, 0],
      "bodies": [{"name": "b", "mass": 1, "position": [0, 0, 0]}],
      "joints": [{"name": "q", "type": "prismatic", "bodies": ["ground", "b"], "at": [0, 0, 0],
        "axis": [1, 0, 0], "spring": {"force": "=table(deflection, [-0.9894 m, -22.9157 N], )json"
                      "[0.3534 m, 6.9918 N], [0.4208 m, 13.897 N], [0.5978 m, -5.3508 N], "
                      "[0.9178 m, 19.6816 N])\"}, \"friction\": {\"limit\": " +
                      number_text(most) + "}}]}");
  };
  const FrictionBand band = find_friction_band(scene(limit), {.start = {{"q", 0.77}}});
  const BandExtent& q = extent(band, "q");
  CAPTURE(limit, band.message, q.low, q.high);
  CHECK(band.folds);
  CHECK(q.low > 0.4208);
  CHECK(q.high > 0.77);
  // Friction is just at its limit at either end.
  for (const double end : {q.low, q.high})
    CHECK_THAT(find_holding(scene(limit), {{"q", end}}).takes.value(), WithinRel(1, 1e-6));
  // More than the peak holds it on both sides.
  CHECK(extent(find_friction_band(scene(15), {.start = {{"q", 0.77}}}), "q").low < 0);
}

TEST_CASE("what depends on the band's coordinates has its extremes inside, too") {
  Mechanism m = rubbing_pendulum(1.5);
  m.measures.push_back(
      {.name = "off", .description = {}, .text = "(coordinate(hinge) - 0.1 rad)^2", .unit = "rad^2"});
  const double most = std::asin(0.15);
  const FrictionBand band = find_friction_band(m);
  CHECK_THAT(extent(band, "off").low, WithinAbs(0, 1e-15));
  CHECK_THAT(extent(band, "off").high, WithinRel((most + 0.1) * (most + 0.1), 1e-12));
  // Of two shares, along both; and where the band passes folds.
  Mechanism two = read_scene(R"json({"flyball": 2, "name": "Double pendulum", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "p", "mass": 1, "position": [0, -0.5, 0]},
               {"name": "q", "mass": 0.7, "position": [0, -0.9, 0]}],
    "joints": [
      {"name": "h", "type": "revolute", "bodies": ["ground", "p"], "at": [0, 0, 0], "axis": [0, 0, 1],
       "friction": {"limit": 0.8}},
      {"name": "k", "type": "revolute", "bodies": ["p", "q"], "at": [0, -0.5, 0], "axis": [0, 0, 1],
       "friction": {"limit": 0.3}}],
    "measures": {"r2": {"value": "=(coordinate(h)-0.05 rad)^2+(coordinate(k)-0.03 rad)^2", "unit": "rad^2"}}})json");
  const FrictionBand both = find_friction_band(two);
  const BandExtent& r2 = extent(both, "r2");
  CHECK(r2.low < 1e-13);
  CHECK(r2.low <= r2.error.value());
  Mechanism round = rubbing_pendulum(12);
  round.measures.push_back({.name = "height", .description = {}, .text = "y(bob)", .unit = "m"});
  const FrictionBand folded = find_friction_band(round);
  CHECK_THAT(extent(folded, "height").low, WithinAbs(-0.5, 1e-12));
  CHECK_THAT(extent(folded, "height").high, WithinAbs(0.5, 1e-12));
}

TEST_CASE("holding a pendulum as drawn takes its moment") {
  const Holding holding = find_holding(rubbing_pendulum(1.5, 0.1), {});
  REQUIRE(holding.takes);
  CHECK_THAT(*holding.takes, WithinRel(10 * std::sin(0.1) / 1.5, 1e-12));
  REQUIRE(holding.joints.size() == 1);
  CHECK_THAT(holding.joints[0].force.value(), WithinRel(10 * std::sin(0.1), 1e-12));
  CHECK_THAT(holding.message, ContainsSubstring("holds it"));
  const Holding beyond = find_holding(rubbing_pendulum(1.5), {{"hinge", -0.4}});
  CHECK_THAT(beyond.takes.value(), WithinRel(10 * std::sin(0.4) / 1.5, 1e-12));
  CHECK_THAT(beyond.message, ContainsSubstring("hinge slips"));
  CHECK(find_holding(rubbing_pendulum(0, 0.1), {}).takes == std::numeric_limits<double>::infinity());
}

TEST_CASE("a share of the limit moves the steady state within the band") {
  Mechanism m = rubbing_pendulum(1.5);
  set_parameter(m, "joints.hinge.friction.share", -0.4);
  const Solution solution = Analysis(m).solve();
  CHECK_THAT(value(solution, "hinge"), WithinRel(-std::asin(0.4 * 0.15), 1e-13));
  const BandExtent hinge = extent(find_friction_band(m), "hinge");
  CHECK_THAT(hinge.high, WithinRel(std::asin(0.15), 1e-12));
}

TEST_CASE("friction that holds where nothing is steady without it has a band") {
  // The weight turns the hinge by 10 N m at most: less than the torque without friction, and more than what
  // friction leaves of it.
  Mechanism m = rubbing_pendulum(1.5);
  const double torque = GENERATE(10.5, -10.5);
  CAPTURE(torque);
  Force push;
  push.name = "push";
  push.type = ForceType::torque;
  push.body = "bob";
  push.vector = {0, 0, torque};
  m.forces = {push};
  const Solution s = Analysis(m).solve();
  CHECK(s.status == Status::not_converged);
  const FrictionReport report = report_friction(m, s);
  INFO(report.band.message);
  const BandExtent& hinge = extent(report.band, "hinge");
  const double low = std::asin(0.9), high = std::numbers::pi - low;
  CHECK_THAT(hinge.low, WithinRel(torque > 0 ? low : -high, 1e-9));
  CHECK_THAT(hinge.high, WithinRel(torque > 0 ? high : -low, 1e-9));
  push.vector.z() = 1.2 * torque; // too much for both
  m.forces = {push};
  CHECK_FALSE(report_friction(m, Analysis(m).solve()).band.found);
}

TEST_CASE("insensitivity of a bead on a turning rod") {
  const double n = 12, m = 0.5, k = 400, r0 = 0.2, limit = 1.25, r = k * r0 / (k - m * n * n);
  const Mechanism bead = bead_on_rod(n, limit);
  const FrictionReport report = report_friction(bead, Analysis(bead).solve());
  const BandExtent& slide = extent(report.band, "slide");
  CHECK_THAT(slide.value, WithinRel(r, 1e-13));
  CHECK_THAT(slide.low, WithinRel((k * r0 - limit) / (k - m * n * n), 1e-12));
  CHECK_THAT(slide.high, WithinRel((k * r0 + limit) / (k - m * n * n), 1e-12));
  REQUIRE(report.speeds.size() == 1);
  const double n1 = std::sqrt((k * (r - r0) - limit) / (m * r)),
               n2 = std::sqrt((k * (r - r0) + limit) / (m * r));
  CHECK_THAT(report.speeds[0].lower.value(), WithinRel(n1, 1e-10));
  CHECK_THAT(report.speeds[0].upper.value(), WithinRel(n2, 1e-10));
  CHECK_THAT(report.speeds[0].insensitivity().value(), WithinRel(2 * (n2 - n1) / (n1 + n2), 1e-9));
  CHECK_FALSE(find_held_speeds(bead_on_rod(2, 30), {})[0].lower);
}

TEST_CASE("what runs away once it slips is not said to do so where friction holds it") {
  Mechanism bead = bead_on_rod(2, 30); // held as drawn by a thirtieth of that
  bead.joints[1].coordinates[0].spring.reset();
  const Solution s = Analysis(bead).solve();
  CHECK(s.stable == false);
  INFO(s.message);
  CHECK(
      s.message.find("Nothing but dry friction holds slide against the centrifugal force: where it slips it "
                     "goes on without end.") != std::string::npos);
  CHECK_THAT(extent(report_friction(bead, s).band, "slide").high, WithinRel(30 / (0.5 * 2 * 2), 1e-12));

  // Nor beside a spring that the centrifugal force, growing by m n^2 = 450 N/m, outgrows: from where it is
  // drawn it is pushed by 92.5 N.
  const Mechanism soft = bead_on_rod(30, 200);
  const Solution softer = Analysis(soft).solve();
  INFO(softer.message);
  CHECK(softer.stable == false);
  CHECK(softer.message.find("softer than the centrifugal force") != std::string::npos);
  CHECK(softer.message.find(": where it slips it goes on without end. It needs a stiffer spring") !=
        std::string::npos);
  const FrictionReport report = report_friction(soft, softer);
  CHECK_THAT(report.drawn.takes.value(), WithinRel(92.5 / 200, 1e-12));
  CHECK_THAT(extent(report.band, "slide").high, WithinRel((200 - 400 * 0.2) / 50, 1e-12));
}

TEST_CASE("two hinges with friction: each coordinate has corners of its own") {
  Mechanism m = read_scene(R"json({"flyball": 2, "name": "Double pendulum", "gravity": [0, -10, 0],
    "bodies": [{"name": "upper", "mass": 2, "position": [0, -0.5, 0]},
               {"name": "lower", "mass": 1, "position": [0, -1.25, 0]}],
    "joints": [
      {"name": "a", "type": "revolute", "bodies": ["ground", "upper"], "at": [0, 0, 0], "axis": [0, 0, 1],
       "friction": {"limit": 1.5}},
      {"name": "b", "type": "revolute", "bodies": ["upper", "lower"], "at": [0, -1, 0], "axis": [0, 0, 1],
       "friction": {"mu": 0.3, "preload": 100, "radius": 0.01}}],
    "measures": {"height": {"value": "=y(lower)", "unit": "m"}}})json");
  const double upper = std::asin((1.5 + 0.3) / 20), lower = std::asin(0.3 / 2.5);
  const FrictionBand band = find_friction_band(m);
  CHECK_THAT(extent(band, "a").high, WithinRel(upper, 1e-12));
  CHECK_THAT(extent(band, "b").high, WithinRel(lower + upper, 1e-12));
  CHECK_THAT(extent(band, "b").low, WithinRel(-lower - upper, 1e-12));
  // Highest at a corner; lowest hanging straight down, inside.
  CHECK_THAT(extent(band, "height").high, WithinRel(-std::cos(upper) - 0.25 * std::cos(lower), 1e-9));
  CHECK_THAT(extent(band, "height").low, WithinAbs(-1.25, 1e-9));
}

TEST_CASE("band and holding agree, in loops where joints share the load") {
  for (const double hinges : {0., 0.4}) {
    CAPTURE(hinges);
    const Mechanism m = rubbing_governor(15, hinges);
    const FrictionBand band = find_friction_band(m);
    const BandExtent& slide = extent(band, "slide");
    CHECK(slide.low < slide.value);
    CHECK(slide.high > slide.value);
    // The pose at an end of the band takes all that friction gives.
    for (const std::vector<double>& shares : {slide.shares_low, slide.shares_high}) {
      Mechanism at = m;
      std::size_t i = 0;
      for (Joint& joint : at.joints)
        for (Coordinate& c : joint.coordinates)
          if (c.friction) c.friction->share = shares.at(i++);
      const Holding holding = find_holding(m, start_values(Analysis(at).solve().coordinates));
      CHECK_THAT(holding.takes.value(), WithinRel(1., 1e-9));
      CHECK_THAT(holding.at_least, WithinRel(1., 1e-9));
    }
    const std::vector<HeldSpeeds> speeds = find_held_speeds(m, start_values(Analysis(m).solve().coordinates));
    REQUIRE(speeds.size() == 1);
    CHECK(speeds[0].insensitivity().value() > 0);
  }
}

TEST_CASE("friction in every joint of loops, those that close them included") {
  for (const char* name : {"watt_governor", "fourbar_turntable"}) {
    CAPTURE(name);
    Mechanism m = shipped(name);
    for (Joint& joint : m.joints)
      for (Coordinate& c : joint.coordinates)
        if (!c.drive) c.friction.emplace().limit = joint.type == JointType::prismatic ? 1.5 : 0.05;
    const FrictionReport report = report_friction(m, Analysis(m).solve());
    INFO(report.band.message << report.drawn.message);
    REQUIRE(report.band.found);
    REQUIRE(report.speeds.size() == 1);
    const BandExtent& first = report.band.extents.front();
    CHECK(first.low < first.value);
    CHECK(first.high > first.value);
    Mechanism at = m;
    std::size_t i = 0;
    for (Joint& joint : at.joints)
      for (Coordinate& c : joint.coordinates)
        if (c.friction) c.friction->share = first.shares_high.at(i++);
    const Solution there = Analysis(at).solve();
    CHECK_THAT(value(there, first.name), WithinRel(first.high, 1e-10));
    const Holding holding = find_holding(m, start_values(there.coordinates));
    INFO(holding.message);
    CHECK_THAT(holding.takes.value(), WithinRel(1., 1e-8));
    CHECK(find_holding(m, start_values(Analysis(m).solve().coordinates)).takes.value() < 1e-9);
  }
}

TEST_CASE("Porter's governor with friction: (m + M +- F / g) g / (m h) is the square of its speed") {
  const Mechanism m = shipped("governor_friction");
  const double ball = 3, sleeve = 15, w = 16, limit = 12, g = 9.80665;
  const FrictionReport report = report_friction(m, Analysis(m).solve());
  const BandExtent& h = extent(report.band, "h");
  CHECK_THAT(h.low, WithinRel(((ball + sleeve) * g - limit) / (ball * w * w), 1e-12));
  CHECK_THAT(h.high, WithinRel(((ball + sleeve) * g + limit) / (ball * w * w), 1e-12));
  REQUIRE(report.speeds.size() == 1);
  const double part = limit / ((ball + sleeve) * g);
  CHECK_THAT(report.speeds[0].lower.value(), WithinRel(w * std::sqrt(1 - part), 1e-10));
  CHECK_THAT(report.speeds[0].upper.value(), WithinRel(w * std::sqrt(1 + part), 1e-10));
  // Along the response: the same at each speed.
  std::vector<RibbonPlace> places;
  for (const double speed : {15., 17., 19.}) {
    Mechanism there = m;
    set_parameter(there, "parameters.w", speed);
    places.push_back({speed, start_values(Analysis(there).solve().coordinates)});
  }
  const std::vector<RibbonPoint> ribbon = friction_ribbon(m, "parameters.w", places);
  REQUIRE(ribbon.size() == 3);
  for (const RibbonPoint& point : ribbon) {
    const BandExtent* band = find_extent(point, "h");
    REQUIRE(band);
    CHECK_THAT(band->high,
               WithinRel(((ball + sleeve) * g + limit) / (ball * point.number * point.number), 1e-12));
  }
}

TEST_CASE("a governor on its engine has a band, and what holding takes is found") {
  Mechanism m = shipped("governor_engine");
  for (Joint& joint : m.joints)
    if (joint.name == "slide") joint.coordinates[0].friction.emplace().limit = 5;
  const FrictionReport report = report_friction(m, Analysis(m).solve());
  const BandExtent& speed = extent(report.band, "spin.speed");
  CHECK(speed.low < speed.value);
  CHECK(speed.high > speed.value);
  // As drawn the engine would have to be braked.
  CHECK_FALSE(report.drawn.takes);
  CHECK_THAT(report.drawn.message,
             ContainsSubstring("standing still there, the others find no steady state"));
  CHECK_THAT(report.drawn.message, ContainsSubstring("it slows down"));
  CHECK(report.speeds.empty());
  const Holding steady = find_holding(m, start_values(Analysis(m).solve().coordinates));
  CHECK(steady.takes.value() < 1e-9);
  CHECK_THAT(steady.message, ContainsSubstring("spin at 11.0212 rad/s"));
}

TEST_CASE("what holding takes where a torque asks for the coordinate that friction holds") {
  const double angle = 0.3, x = 0.3 * std::sin(angle), y = -0.3 * std::cos(angle);
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Hoop", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "hoop", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
      {"name": "bead", "mass": 0.5, "position": [)json" +
                                 number_text(x) + ", " + number_text(y) +
                                 R"json(, 0]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "hoop"], "at": [0, 0, 0],
        "axis": [0, 1, 0], "drive": {"torque": "=2 N m*(1.2 rad - coordinate(b))",
          "load": "=0.05 N m s*rate(spin)", "speed": 8}},
      {"name": "b", "type": "revolute", "bodies": ["hoop", "bead"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "coordinate": 0.3, "damping": 0.05, "friction": {"limit": 0.1}}]})json");
  const double w = 2 * (1.2 - angle) / 0.05;
  const double needed = 0.5 * 0.3 * std::sin(angle) * (9.80665 - 0.3 * w * w * std::cos(angle));
  const Holding holding = find_holding(m, {});
  INFO(holding.message);
  CHECK_THAT(holding.joints.at(0).force.value(), WithinRel(needed, 1e-12));
  CHECK_THAT(holding.takes.value(), WithinRel(std::abs(needed) / 0.1, 1e-12));
  CHECK_THAT(holding.message, ContainsSubstring("does not hold it there, with spin at 36 rad/s: b slips"));
}

TEST_CASE("what holding takes at every phase of two drives that take many turns to return together") {
  // A slide on the outer one of two arms at 4 and 6.3 rad/s: every 20 pi s, after 40 and 63 turns.
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Arms", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "h1", "mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.01]},
      {"name": "h2", "mass": 1, "position": [0.3, 0, 0], "inertia": [0.01, 0.01, 0.01]},
      {"name": "b", "mass": 1, "position": [0.4, 0, 0], "inertia": [0.01, 0.01, 0.01]}],
    "joints": [{"name": "p", "type": "revolute", "bodies": ["ground", "h1"], "at": [0, 0, 0],
        "axis": [0, 0, 1], "drive": {"speed": 4}},
      {"name": "q", "type": "revolute", "bodies": ["h1", "h2"], "at": [0.3, 0, 0], "axis": [0, 0, 1],
        "drive": {"speed": 6.3}},
      {"name": "s", "type": "prismatic", "bodies": ["h2", "b"], "at": [0.4, 0, 0], "axis": [1, 0, 0],
        "friction": {"limit": 25.21}}]})json");
  double most = 0;
  constexpr int steps = 1000000;
  for (int i = 0; i < steps; ++i) {
    const double t = 20 * std::numbers::pi * i / steps;
    most = std::max(
        most, std::abs(9.80665 * std::sin(10.3 * t) - 0.1 * 10.3 * 10.3 - 0.3 * 4 * 4 * std::cos(6.3 * t)));
  }
  CHECK(most > 25.21);
  const Holding holding = find_holding(m, {});
  INFO(holding.message);
  CHECK_THAT(std::abs(holding.joints.at(0).force.value()), WithinRel(most, 1e-7));
  CHECK(Analysis(m).solve().status == Status::no_steady_state);
}

TEST_CASE("what holding takes of a spring behind a gear") {
  const double stiffness = 100, free = 0.2, ratio = -0.5; // b = ratio a
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Geared", "gravity": [0, 0, 0],
    "bodies": [{"name": "A", "mass": 1, "position": [0, 0, 0]}, {"name": "B", "mass": 1, "position": [1, 0, 0]}],
    "joints": [{"name": "b", "type": "revolute", "bodies": ["ground", "B"], "at": [1, 0, 0], "axis": [0, 0, 1],
        "friction": {"limit": 1}},
      {"name": "g", "type": "gear", "joints": ["a", "b"], "ratio": -0.5},
      {"name": "a", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "spring": {"stiffness": 100, "free": 0.2}, "friction": {"limit": 2}}]})json");
  const double limit = 2 + 1 * std::abs(ratio);
  for (const double a : {0., 0.19, 0.25}) {
    CAPTURE(a);
    const Holding holding = find_holding(m, {{"a", a}, {"b", ratio * a}});
    INFO(holding.message);
    CHECK_THAT(holding.takes.value(), WithinRel(stiffness * std::abs(a - free) / limit, 1e-12));
  }
}

TEST_CASE("a gear bears what torques beyond it give where friction holds the train") {
  const bool nut_first = GENERATE(false, true);
  CAPTURE(nut_first);
  const std::string ends = nut_first ? R"("gear", "joints": ["nut", "spin"], "ratio": 628.31853071795865)"
                                     : R"("gear", "kind": "screw", "joints": ["spin", "nut"], "lead": 0.01)";
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Screw", "gravity": [0, -9.81, 0],
    "bodies": [{"name": "A", "mass": 1, "position": [0, 0, 0]},
      {"name": "N", "mass": 5, "position": [0, 0.3, 0], "rotation": [0.8, 0, 0, 0.6]},
      {"name": "W", "mass": 1, "position": [1, 0, 0]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 0, 0],
        "axis": [0, 1, 0], "drive": {"torque": "=0.05 N m - 0.4 N m s*rate(spin)", "speed": 0.2}},
      {"name": "nut", "type": "prismatic", "bodies": ["ground", "N"], "at": [0, 0.3, 0], "axis": [0, 1, 0],
        "friction": {"limit": 45}},
      {"name": "wheel", "type": "revolute", "bodies": ["ground", "W"], "at": [1, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=-0.02 N m - 0.1 N m s*rate(wheel)", "speed": -0.6}},
      {"name": "g", "type": )json" +
                                 ends +
                                 R"json(},
      {"name": "h", "type": "gear", "joints": ["spin", "wheel"], "ratio": -3}]})json");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  REQUIRE(s.gears.size() == 2);
  const double per_turn = 2 * std::numbers::pi / 0.01;
  const double of_wheel = -0.02, at_spin = 0.05 + -3 * of_wheel;
  const GearReaction& screw = s.gears[0];
  CHECK_THAT(nut_first ? screw.b : screw.a, WithinRel(-at_spin, 1e-12));
  CHECK_THAT(nut_first ? screw.a : screw.b, WithinRel(at_spin * per_turn, 1e-12));
  CHECK((nut_first ? screw.torque - Vec3(0, -at_spin, 0) : screw.force - Vec3(0, at_spin * per_turn, 0))
            .norm() < 1e-12);
  CHECK_THAT(s.gears[1].b, WithinRel(-of_wheel, 1e-12));
  CHECK_THAT(s.gears[1].a, WithinRel(-3 * of_wheel, 1e-12));
  CHECK_THAT(*s.frictions.at(0).value, WithinRel(5 * 9.81 - at_spin * per_turn, 1e-12));
}

TEST_CASE("what is not asked of states that rest on friction says so") {
  const Mechanism m = block_on_a_slope();
  const std::string rests = "The steady state rests on dry friction: slope is held. ";
  const Comparison compared = compare(m);
  CHECK(compared.status == Status::no_steady_state);
  CHECK(compared.message == rests + "Ways of finding it are compared only of states that need none.");
  LinearModelOptions slipping;
  slipping.slipping = true;
  const std::vector<std::string> in{"force_x(block)"}, out{"slope"};
  CHECK(linearize(m, in, out, slipping).refusal ==
        rests + "Linear models once joints slip are made only of states that need none.");
  const std::vector<FreeNumber> free{{"bodies.block.mass", 1, 5}};
  SteadyMap map(m, free, {}, nullptr);
  Solution first;
  CHECK_FALSE(map.begin({}, first));
  CHECK(first.message == rests + "How it changes with numbers is found only of states that need none.");
}

TEST_CASE("a gear bears along the coordinate that it turns, whichever of its joint's") {
  const auto gear = [](const std::string& joint, const std::string& kind) {
    const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Ends",
      "bodies": [{"name": "A", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
        {"name": "B", "mass": 1, "position": [1, 0, 0], "inertia": [0.1, 0.1, 0.1]}],
      "joints": [{"name": "brake", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 0, 0],
          "axis": [0, 0, 1], "friction": {"limit": 1}},
        {"name": "end", "bodies": ["ground", "B"], "at": [1, 0, 0], )json" +
                                   joint + R"json(},
        {"name": "g", "type": "gear", "joints": ["brake", )json" +
                                   kind + "}]}");
    const Solution s = Analysis(m).solve();
    CAPTURE(s.message);
    REQUIRE(s.status == Status::converged);
    REQUIRE(s.gears.size() == 1);
    return s.gears[0];
  };
  const GearReaction second = gear(R"("type": "universal", "axes": [[1, 0, 0], [0, 1, 0]],
        "drive": [null, {"torque": "=0.3 N m", "speed": 0.1}])",
                                   R"("end.1"], "ratio": 1)");
  CHECK((second.torque - Vec3(0, -0.3, 0)).norm() < 1e-12);
  const GearReaction rack = gear(R"("type": "planar", "axis": [0, 0, 1], "x_axis": [0, 1, 0],
        "spring": [null, {"stiffness": 100}, {"stiffness": 100}],
        "drive": [{"torque": "=0.3 N", "speed": 0.1}, null, null])",
                                 R"("end.0"], "kind": "rack", "radius": 0.1)");
  CHECK((rack.force - Vec3(0, -0.3, 0)).norm() < 1e-12);
}

TEST_CASE("friction that cannot be is refused") {
  const auto mistake = [](const std::string& friction, const std::string& extra = "") {
    try {
      read_scene(R"({"flyball": 1, "name": "M", "bodies": [{"name": "b", "mass": 1, "position": [1, 0, 0]}],
        "joints": [{"name": "j", "type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0],
        "axis": [0, 0, 1], "friction": )" +
                 friction + extra + "}]}");
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(mistake(R"({"limit": 1})").empty());
  CHECK(mistake(R"({"limit": 1})", R"(, "drive": {"speed": 1})").empty());
  CHECK(mistake(R"({"limit": 1})", R"(, "drive": {"torque": 1, "speed": 1})").empty());
  CHECK(mistake(R"({"mu": 0.1, "preload": 20, "radius": 0.01})").empty());
  CHECK_THAT(mistake(R"({})"), ContainsSubstring("expected `limit`, or `mu` and `preload`"));
  CHECK_THAT(mistake(R"({"limit": 1, "mu": 0.1})"), ContainsSubstring("expected `limit` alone"));
  CHECK_THAT(mistake(R"({"mu": 0.1, "preload": 2})"), ContainsSubstring("radius: missing"));
  CHECK_THAT(mistake(R"({"limit": -1})"), ContainsSubstring("expected zero or more, found -1"));
  CHECK_THAT(mistake(R"({"limit": 1, "share": 1.5})"), ContainsSubstring("-1 to 1, found 1.5"));
  CHECK_THAT(mistake(R"({"limit": 1, "share": 0.5})", R"(, "drive": {"speed": 3})"),
             ContainsSubstring("which is driven"));
}

TEST_CASE("a block that friction alone holds") {
  const Mechanism m = block_on_a_slope();
  const FrictionReport report = report_friction(m, Analysis(m).solve());
  CHECK_THAT(report.drawn.takes.value(), WithinRel(3 * 10 * 0.6 / (0.9 * 24), 1e-12));
  CHECK_FALSE(report.band.found);
}

TEST_CASE("a ball joint that closes a loop stands where friction holds the rest") {
  const Mechanism m = read_scene(R"({"flyball": 2, "name": "Spatial loop", "gravity": [3, -9, 1],
    "bodies": [{"name": "table", "mass": 1, "position": [-0.1, 0, 0], "inertia": [1, 1, 1]},
      {"name": "crank", "mass": 1, "position": [0.05, 0.06, 0], "inertia": [0.001, 0.002, 0.0025]},
      {"name": "coupler", "mass": 2, "position": [0.225, 0.205, 0.11], "inertia": [0.01, 0.012, 0.02]},
      {"name": "rocker", "mass": 1.5, "position": [0.425, 0.125, 0.15], "inertia": [0.005, 0.004, 0.003]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "table"], "at": [-0.1, 0, 0],
        "axis": [0, 1, 0], "drive": {"speed": 2}},
      {"name": "j1", "type": "revolute", "bodies": ["table", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "spring": {"stiffness": 12, "free": 0.5}, "damping": 0.5, "friction": {"limit": 5}},
      {"name": "u", "type": "universal", "bodies": ["crank", "coupler"], "at": [0.1, 0.12, 0.02],
        "axes": [[0, 1, 1], [0.2, 1, -1]], "friction": [{"limit": 2}, {"limit": 2.5}]},
      {"name": "s", "type": "spherical", "bodies": ["coupler", "rocker"], "at": [0.35, 0.25, 0.2]},
      {"name": "j4", "type": "revolute", "bodies": ["table", "rocker"], "at": [0.5, 0, 0.1],
        "axis": [0.3, 0.1, 1], "friction": {"limit": 4}}]})");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  REQUIRE_FALSE(s.frictions.empty());
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i);
    const CoordinateSolution& turn = coordinate(s, "s", i);
    CHECK_FALSE(turn.driven);
    CHECK_FALSE(turn.speed);
    CHECK_THAT(turn.value, WithinAbs(0, turn.error + 1e-12));
  }
}
