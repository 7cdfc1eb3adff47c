// What a drive's torque may be a law of: speeds with several answers or none, tables, measures, a clutch,
// coordinates that loops would cut; and which laws are mistakes.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("a shaft with several steady speeds: all are found, with their eigenvalues", "[torque]") {
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 2, 0.1})};
  // T - c w = 0.3 (w - 1)(w - 3)(w - 5)
  m.joints = {dampened(
      torque_driven(
          revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 2,
          "0.5 N m s * rate(shaft) + 0.3 N m s^3 * (rate(shaft) - 1)*(rate(shaft) - 3)*(rate(shaft) - 5)"),
      0.5)};
  validate(m);
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 3);
  std::vector<std::pair<double, double>> found;
  for (const Solution& s : all.equilibria) {
    REQUIRE(s.eigenvalues->size() == 1);
    found.emplace_back(speed(s, "shaft"), s.eigenvalues->front().real());
    CHECK(s.stable == (std::abs(speed(s, "shaft") - 3) < 0.5));
  }
  std::ranges::sort(found);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK_THAT(found[i].first, WithinRel(std::array{1., 3., 5.}[i], 1e-12));
    CHECK_THAT(found[i].second, WithinRel(0.3 * std::array{8., -4., 8.}[i] / 2, 1e-9));
  }
  REQUIRE(all.bounds.size() == 1);
  CHECK(all.bounds[0].speed);
  CHECK(all.bounds[0].upper >= 6);
}

TEST_CASE("steady speeds are found orders of magnitude from where the search begins", "[torque]") {
  // T = 3 w exp(-w) + w / 10: three roots for this torque, of which the start is near none.
  const auto load = [](double w) { return 3 * w * std::exp(-w) + 0.1 * w; };
  for (const double start : {0.02, 0.1, 4., 900.}) {
    CAPTURE(start);
    Mechanism m;
    m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
    m.joints = {
        torque_driven(revolute("a", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), start,
                      "0.9 N m - 1 N m*(3*rate(a)/(1 rad/s)*exp(-rate(a)/(1 rad/s)) + rate(a)/(10 rad/s))")};
    validate(m);
    const AllSolutions all = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == 3);
    std::vector<double> found;
    for (const Solution& s : all.equilibria) {
      found.push_back(speed(s, "a"));
      CHECK(std::abs(load(found.back()) - 0.9) < 1e-12);
      CHECK(s.stable == (found.back() < 1 || found.back() > 5));
    }
    CHECK(all.bounds.at(0).upper >= 2900 * start);
  }
  // There is no end of them.
  Mechanism wavy;
  wavy.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
  wavy.joints = {
      torque_driven(revolute("a", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 2, "1 N m*sin(rate(a)*1 s)")};
  const std::size_t count = Analysis(wavy).solve_all().equilibria.size();
  CHECK(count > 20);
  CHECK(count < 100);
}

TEST_CASE("shafts that feel nothing of each other run at every combination of their steady speeds",
          "[torque]") {
  // Of the first two speeds lie near each other, of the second far above where the search begins.
  const std::array<std::array<double, 3>, 3> speeds{
      {{6.575, 7.1297, 7.3808}, {0.86, 12, 45}, {2.9, 5.4, 9.97}}};
  Mechanism m;
  std::size_t expected = 1;
  for (std::size_t i = 0; i < GENERATE(1u, 2u, 3u); ++i) {
    const std::string name = "s" + std::to_string(i), w = "(rate(" + name + ")*1 s - ";
    const auto factor = [&](std::size_t k) { return w + number_text(speeds[i][k]) + ")"; };
    m.bodies.push_back(body("b" + name, 1, {3. * static_cast<double>(i), 0, 0}, {1, 1, 1}));
    m.joints.push_back(
        torque_driven(revolute(name, "ground", "b" + name, {3. * static_cast<double>(i), 0, 0}, {0, 1, 0}),
                      1.7, "-0.3 N m*" + factor(0) + "*" + factor(1) + "*" + factor(2)));
    expected *= 3;
  }
  validate(m);
  const AllSolutions all = Analysis(m).solve_all();
  CHECK(all.equilibria.size() == expected);
  CHECK(std::ranges::count(all.equilibria, true, [](const Solution& s) { return s.stable == true; }) ==
        std::lround(std::pow(2, m.joints.size())));
}

TEST_CASE("torques that no speed balances are refused with the reason", "[torque]") {
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 2, 0.1})};
  const Joint shaft = revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0});
  SECTION("without resistance") {
    m.joints = {torque_driven(shaft, 3, "25")};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("shaft gives 25 N m where turning takes 0 N m: it runs away"));
  }
  SECTION("none, and nothing resists: every speed is one") {
    m.joints = {torque_driven(shaft, 3, "0")};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("Nothing determines the speed of shaft"));
  }
  SECTION("without a word of torques at a pose that the motion does not come to") {
    // A slide whose spring is softer than m w^2 = 225 N/m: at 15 rad/s it balances at -112.5 m alone,
    // unstable.
    m.bodies.push_back(body("block", 1, {0.1, 0, 0}));
    m.joints = {torque_driven(shaft, 15, "8 N m + 5 N*coordinate(slide)", "0.5 N m s*rate(shaft)"),
                dampened(joint(JointType::prismatic, "slide", "rotor", "block", {0.1, 0, 0}, {1, 0, 0}), 5)};
    m.joints[1].coordinates[0].spring = CoordinateSpring{224.8, 0, "", 0};
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_FALSE(s.message.empty());
    CHECK(s.message.find("shaft gives") == std::string::npos);
  }
  SECTION("what turns with the drive") {
    const Mechanism governor = shipped("governor_engine", {{"gravity.0", 1.}, {"bodies.ball1.mass", 1.2}});
    const Solution s = Analysis(governor).solve();
    CHECK(s.status == Status::no_steady_state);
    CHECK_THAT(s.message, ContainsSubstring("turns with the drives"));
    CHECK_THROWS_WITH(follow_branches(governor, "joints.spin.drive.speed", 5, 20),
                      ContainsSubstring("is found by the drive's torque"));
  }
  SECTION("two shafts that drag each other along") {
    m.bodies.push_back(body("other", 1, {0, 0.1, 0}, {0.1, 3, 0.1}));
    m.joints = {torque_driven(shaft, 3, "2"),
                torque_driven(revolute("second", "ground", "other", {0, 0, 0}, {0, 1, 0}), 2, "-2")};
    Joint clutch = joint(JointType::revolute, "clutch", "rotor", "other", {0, 0.05, 0}, {0, 1, 0});
    clutch.cut = true;
    m.joints.push_back(dampened(clutch, 4));
    validate(m);
    const Solution s = Analysis(m).solve();
    CHECK(s.status == Status::not_converged);
    CHECK_THAT(s.message, ContainsSubstring("Nothing determines the speeds of shaft and second together"));
    // One that resists them both settles it.
    m.joints[0] = dampened(m.joints[0], 0.25);
    const Solution settled = Analysis(m).solve();
    REQUIRE(settled.status == Status::converged);
    CHECK(std::abs(speed(settled, "shaft")) < 1e-12);
    CHECK_THAT(speed(settled, "second"), WithinRel(-0.5, 1e-12));
  }
}

TEST_CASE("shafts found at different speeds turn against each other, wherever their search began",
          "[torque]") {
  // A spring between their rims pulls along the line of the axes as drawn: there the balance holds.
  Mechanism m;
  m.bodies = {body("a", 1, Vec3::Zero()), body("b", 1, Vec3::UnitX())};
  m.bodies[0].inertia = m.bodies[1].inertia = {0.1, 0.1, 0.1};
  m.joints = {torque_driven(revolute("one", "ground", "a", Vec3::Zero(), Vec3::UnitZ()), 10,
                            "5 N m - 0.5 N m s * rate(one)"),
              torque_driven(revolute("two", "ground", "b", Vec3::UnitX(), Vec3::UnitZ()), 10,
                            "3.5 N m - 0.5 N m s * rate(two)")};
  const Solution apart = Analysis(m).solve({});
  REQUIRE(apart.status == Status::converged);
  CHECK(speed(apart, "one") == Approx(10));
  CHECK(speed(apart, "two") == Approx(7));
  Force spring;
  spring.name = "spring";
  spring.bodies = {"a", "b"};
  spring.points = {Vec3(0.2, 0, 0), Vec3(0.8, 0, 0)};
  spring.stiffness = 100;
  spring.free_length = 0.3;
  m.forces = {spring};
  CHECK(Analysis(m).solve({}).status == Status::no_steady_state);
}

TEST_CASE("a motor's curve as a table over the speed", "[torque]") {
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 2, 0.1})};
  m.joints = {
      dampened(torque_driven(revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 4,
                             "table(rate(shaft), [0, 12 N m], [5, 10 N m], [10, 5 N m], [12 rad/s, 0])"),
               1)};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  // Between 5 and 10 rad/s, where the curve's slopes are harmonic means of those beside.
  const double left = 2 / (1 / -0.4 + 1 / -1.), right = (9. + 12.) / (9 / -1. + 12 / -2.5);
  const auto curve = [&](double w) {
    const double t = (w - 5) / 5;
    return 10 * (2 * t * t * t - 3 * t * t + 1) + 5 * left * (t * t * t - 2 * t * t + t) +
           5 * (3 * t * t - 2 * t * t * t) + 5 * right * (t * t * t - t * t);
  };
  const double w = speed(s, "shaft");
  CHECK(w > 5);
  CHECK_THAT(curve(w), WithinRel(w, 1e-12));
  CHECK(s.stable == true);
}

TEST_CASE("at the foot of a steep interval of a torque's table the eigenvalue is that of the speed found",
          "[torque]") {
  const auto [end, width] = GENERATE(std::pair{"3.0001", 1e-4}, std::pair{"3.00001", 1e-5});
  const double from = GENERATE(0.5, 1., 2., 3., 3.00001, 4., 10.);
  CAPTURE(end, from);
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {
      torque_driven(revolute("shaft", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), from,
                    std::string("table(rate(shaft), [0, 3 N m], [3, 0 N m], [") + end + " rad/s, -50 N m])")};
  validate(m);
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "shaft"), WithinRel(3, 1e-14));
  // The slope there is the harmonic mean of those beside, -1 and -50 / width, by the intervals' widths. It
  // changes by 300 / width^2 times what the speed does, of which the last digit is 4e-16.
  const double before = 2 * width + 3, after = width + 6,
               slope = (before + after) / (before / -1 + after * width / -50);
  REQUIRE(s.eigenvalues->size() == 1);
  CHECK_THAT(s.eigenvalues->front().real(), WithinRel(slope / 0.1, 1e-13 / (width * width)));
  CHECK(s.stable == true);
}

TEST_CASE("laws of torque that mean nothing are mistakes with their place", "[torque]") {
  Mechanism m = shipped("governor_engine");
  Joint& spin = m.joints[0];
  const auto mistake = [&](const std::string& law) {
    spin.formulas[0].text = law;
    const auto found = find_mistakes(m);
    REQUIRE(found.size() == 1);
    CHECK(found[0].where().starts_with("joints.spin.drive"));
    return found[0].expected();
  };
  CHECK_THAT(mistake("gain * coordinate(slides)"), ContainsSubstring("did you mean \"slide\""));
  CHECK_THAT(mistake("gain * rate(slide)"), ContainsSubstring("expected N m, found"));
  CHECK_THAT(mistake("gains * coordinate(slide)"), ContainsSubstring("gains"));
  CHECK_THAT(mistake("gain * coordinate(slide"), ContainsSubstring("column"));
  spin.formulas[0].text = "gain * 1 m * coordinate(spin)";
  CHECK_THROWS_WITH(Analysis(m), ContainsSubstring("expected a rate"));
  spin.formulas[0].text = "gain * coordinate(slide)";
  spin.coordinates[0].drive->speed = 0;
  CHECK_THAT(find_mistakes(m).at(0).expected(), ContainsSubstring("other than zero"));
  CHECK(write_scene(shipped("governor_engine")) ==
        write_scene(read_scene(write_scene(shipped("governor_engine")))));
}

TEST_CASE("a centrifugal clutch engages at its speed, slips, and where it would lock creeps", "[torque]") {
  // Of the scene, in its words.
  constexpr double m = 0.1, r = 0.05, gap = 0.002, radius = r + gap + 0.01, k = 8000, preload = 80,
                   hardness = 1e6, mu = 0.3, creep = 1, slope = 0.2, resistance = 0.05;
  const auto at = [](double idle) {
    const Solution s = Analysis(shipped("centrifugal_clutch", {{"parameters.idle", idle}})).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stable == true);
    return s;
  };
  // m (r + x) w^2 = preload + k x + hardness (x - gap).
  const auto capacity = [&](double w) {
    const double x = (m * r * w * w - preload + hardness * gap) / (k + hardness - m * w * w);
    return 3 * mu * radius * hardness * (x - gap);
  };
  const double engages = std::sqrt((preload + k * gap) / (m * (r + gap)));
  CHECK(std::abs(capacity(engages)) < 1e-9);
  const Solution below = at(engages * (1 - 1e-6)), above = at(engages * (1 + 1e-6));
  CHECK_THAT(speed(below, "motor"), WithinRel(engages * (1 - 1e-6), 1e-13));
  CHECK(speed(below, "drum") == 0);
  CHECK(speed(above, "drum") > 0);
  // Slipping: slope (idle - w) = capacity(w), halved into; far from locking friction is all of mu.
  for (const double idle : {150., 200., 240., 280.}) {
    CAPTURE(idle);
    double low = engages, high = idle;
    for (int i = 0; i < 100; ++i) {
      const double w = (low + high) / 2;
      (slope * (idle - w) > capacity(w) ? low : high) = w;
    }
    const Solution s = at(idle);
    CHECK_THAT(speed(s, "motor"), WithinRel(low, 1e-11));
    CHECK_THAT(speed(s, "drum"), WithinRel(capacity(low) / resistance, 1e-9));
    CHECK(speed(s, "motor") - speed(s, "drum") > 20 * creep);
  }
  // Locked: what the drum resists with is a part of what friction could give.
  const Solution locked = at(400);
  const double motor = speed(locked, "motor"), drum = speed(locked, "drum");
  CHECK_THAT(resistance * drum, WithinRel(capacity(motor) * std::tanh((motor - drum) / creep), 1e-9));
  CHECK_THAT(resistance * drum, WithinRel(slope * (400 - motor), 1e-12));
  CHECK(motor - drum < creep);
}

TEST_CASE("a torque may name measures of coordinates and rates") {
  const Mechanism by_law = shipped("governor_engine");
  Mechanism by_measure = by_law;
  by_measure.measures.push_back({"opening", "", "coordinate(slide) - closed", "m"});
  by_measure.measures.push_back({"closed", "", "0.15 m", "m"});
  for (Joint& joint : by_measure.joints)
    for (Formula& formula : joint.formulas)
      if (formula.key == "drive.torque") formula.text = "gain*opening";
  validate(by_measure);
  const Solution direct = Analysis(by_law).solve(), named = Analysis(by_measure).solve();
  CHECK(speed(named, "spin") == speed(direct, "spin"));
  CHECK(named.eigenvalues == direct.eigenvalues);
  // Taken up as a change of the law.
  Analysis analysis(by_measure);
  Mechanism other = by_measure;
  other.measures.back().text = "0.16 m";
  analysis.update(other);
  CHECK_THAT(value(analysis.solve(), "slide"), WithinRel(0.16, 1e-12));

  const auto mistake = [&](const std::string& measure, const std::string& law) {
    Mechanism m = by_law;
    m.measures.push_back({"M", "", measure, "m"});
    m.measures.push_back({"N", "", "M", "m"});
    for (Joint& joint : m.joints)
      for (Formula& formula : joint.formulas)
        if (formula.key == "drive.torque") formula.text = law;
    try {
      validate(m);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(mistake("coordinate(slide)", "gain*(N - 0.15 m)").empty());
  CHECK_THAT(mistake("1 m*reaction(slide)/(1 N)", "gain*N"),
             ContainsSubstring("M asks for reaction(): a torque or load is one of"));
  CHECK_THAT(mistake("N", "gain*M"), ContainsSubstring("circle of measures"));
  CHECK_THAT(mistake("coordinate(slide)", "1 m*reaction(slide)"),
             ContainsSubstring("is one of coordinates, rates"));
}

TEST_CASE("a law keeps the coordinates that it asks for, wherever loops could be cut") {
  const double sun = 20, planet = 16, ring = 52;
  Mechanism m;
  const auto wheel = [](const std::string& name, const Vec3& at) {
    return body(name, 1, at, {0.1, 0.1, 0.2});
  };
  m.bodies = {wheel("sun", {0, 0, 0}), wheel("carrier", {0, 0, 0}), wheel("planet", {0.9, 0, 0}),
              wheel("ring", {0, 0, 0})};
  m.joints = {torque_driven(revolute("sun", "ground", "sun", {0, 0, 0}, {0, 0, 1}), 100,
                            "10 N m - 0.02 N m s*rate(sun) - 0.01 N m s*rate(carrier)"),
              dampened(revolute("carrier", "ground", "carrier", {0, 0, 0}, {0, 0, 1}), 0.3),
              dampened(revolute("ring", "ground", "ring", {0, 0, 0}, {0, 0, 1}), 0.4),
              revolute("planet", "carrier", "planet", {0.9, 0, 0}, {0, 0, 1}),
              revolute("sun on carrier", "carrier", "sun", {0, 0, 0}, {0, 0, 1}),
              revolute("ring on carrier", "carrier", "ring", {0, 0, 0}, {0, 0, 1}),
              gear("inner mesh", "sun on carrier", "planet", -sun / planet),
              gear("outer mesh", "planet", "ring on carrier", planet / ring)};
  validate(m);
  const Solution s = Analysis(m).solve();
  const double ws = speed(s, "sun"), wc = speed(s, "carrier"), wr = speed(s, "ring");
  CHECK_THAT((ws - wc) * sun, WithinRel(-(wr - wc) * ring, 1e-12));
  const double torque = 10 - 0.02 * ws - 0.01 * wc;
  CHECK_THAT(0.3 * wc * wc + 0.4 * wr * wr, WithinRel(torque * ws, 1e-12));
  CHECK_THAT(-0.4 * wr, WithinRel(torque * ring / sun, 1e-12));
}

TEST_CASE("a kink at which a law asks twice for the same has both its sides' slopes", "[torque][kinks]") {
  // 0.5 per rad/s of the speed below 10 rad/s, where it grows, and -0.5 above.
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
  m.joints = {torque_driven(revolute("p", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), 10,
                            "-1.5 N m s*(rate(p) - 10 rad/s) + min(1 N m s*(rate(p) - 10 rad/s), "
                            "2 N m s*(rate(p) - 10 rad/s))")};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "p"), WithinRel(10, 1e-12));
  CHECK(s.stable == false);
  CHECK_THAT(s.message, ContainsSubstring("kink"));
}

TEST_CASE("speeds against the one that is asked for are among all equilibria", "[torque]") {
  for (const double asked : {1., -1., 30., -0.01}) {
    CAPTURE(asked);
    Mechanism m;
    m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
    m.joints = {
        torque_driven(revolute("p", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), asked,
                      "-1e-3 N m s^3*(rate(p) + 20 rad/s)*(rate(p) - 0.5 rad/s)*(rate(p) - 9 rad/s)")};
    validate(m);
    std::vector<double> speeds;
    for (const Solution& s : Analysis(m).solve_all().equilibria)
      speeds.push_back(speed(s, "p"));
    std::ranges::sort(speeds);
    REQUIRE(speeds.size() == 3);
    CHECK_THAT(speeds[0], WithinRel(-20, 1e-12));
    CHECK_THAT(speeds[1], WithinRel(0.5, 1e-12));
    CHECK_THAT(speeds[2], WithinRel(9, 1e-12));
  }
}

TEST_CASE("the error of a speed has the rounding of torque and load by laws", "[torque]") {
  const auto shaft = [](const std::string& torque, double load) {
    Mechanism m;
    m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 1, 1})};
    m.joints = {torque_driven(revolute("p", "ground", "rotor", {0, 0, 0}, {0, 0, 1}), 5, torque)};
    m.joints[0].coordinates[0].drive->load = load;
    validate(m);
    return m;
  };
  // 67724.3 - 0.03919 w of all that is given, in units of the last place.
  for (const double speed_asked : {2.7, 6.06730543, 9.3}) {
    const double load = 67724.3 - 0.03919 * speed_asked;
    const Solution s = Analysis(shaft("67724.3 N m - 0.03919 N m s*rate(p)", load)).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    const auto exact = static_cast<double>((67724.3L - static_cast<long double>(load)) / 0.03919L);
    CHECK_THAT(speed(s, "p"), WithinAbs(exact, coordinate(s, "p").speed_error));
  }
  // The load is all of the torque: it would stand still, but no digit of that is known.
  const Mechanism unknown = shaft("5 N m - 1e-18 N m s*rate(p)", 5);
  const Solution lost = Analysis(unknown).solve();
  CHECK(lost.status == Status::not_converged);
  CHECK_THAT(lost.message, ContainsSubstring("rounding leaves no digit of p"));
  SolveOptions few;
  few.search_starts = 20;
  const AllSolutions all = Analysis(unknown).solve_all(few);
  CHECK(all.equilibria.empty());
  CHECK_THAT(all.message, ContainsSubstring("rounding leaves no digit of p"));
  // Branches are followed, and say so.
  CHECK_THAT(follow_branches(unknown, "bodies.rotor.inertia.2", 0.5, 1.5).message,
             ContainsSubstring("rounding leaves no digit of p"));
  CHECK_THAT(follow_branches(shaft("5 N m - 1 N m s*rate(p)", 3), "joints.p.drive.load", 3, 4).message,
             !ContainsSubstring("rounding"));
}
