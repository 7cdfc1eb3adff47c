// Dry friction on what a torque turns, itself or through gears, and on what it turns through springs: whether
// it slips or comes to rest, against closed forms and against the motion.
#include "engine/dynamics/simulator.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/friction_ways.hpp"
#include "engine/report/standstill.hpp"
#include "engine/report/turns_in_place.hpp"
#include "engine/study/friction_branches.hpp"
#include "engine/study/friction_report.hpp"
#include "tests/catch.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

std::string body_at(const std::string& name, double x, double mass = 1) {
  return R"({"name": ")" + name + R"(", "mass": )" + number_text(mass) + R"(, "position": [)" +
         number_text(x) + R"(, 0, 0], "inertia": [0.1, 0.15, 0.1]})";
}

std::string bearing_at(const std::string& name, const std::string& body, double x, const std::string& more) {
  return R"({"name": ")" + name + R"(", "type": "revolute", "bodies": ["ground", ")" + body +
         R"("], "at": [)" + number_text(x) + R"(, 0, 0], "axis": [0, 1, 0])" +
         (more.empty() ? "" : ", " + more) + "}";
}

std::string friction(double limit) {
  return R"("friction": {"limit": )" + number_text(limit) + "}";
}

std::string torque(const std::string& law, double speed = 5) {
  return R"("drive": {"torque": "=)" + law + R"(", "speed": )" + number_text(speed) + "}";
}

std::string meshing(const std::string& name, const std::string& a, const std::string& b, double ratio) {
  return R"({"name": ")" + name + R"(", "type": "gear", "joints": [")" + a + R"(", ")" + b +
         R"("], "ratio": )" + number_text(ratio) + "}";
}

Mechanism scene(const std::string& bodies, const std::string& joints, const std::string& more = "") {
  return read_scene(R"({"flyball": 2, "name": "Brake", )" + more + R"("bodies": [)" + bodies +
                    R"(], "joints": [)" + joints + "]}");
}

// A shaft by `law`, geared at -2 to a countershaft with friction (N m).
Mechanism countershaft(double limit, const std::string& law = "2 N m - 0.4 N m s*rate(pa)",
                       const std::string& more = "") {
  return scene(body_at("a", 0) + ", " + body_at("c", 0.3),
               bearing_at("pa", "a", 0, torque(law)) + ", " + bearing_at("pc", "c", 0.3, friction(limit)) +
                   ", " + meshing("g", "pa", "pc", -2),
               more);
}

// A screw of 10 mm that lifts 5 kg with 30 N of friction in the guide.
Mechanism jack(double at_rest) {
  return scene(
      body_at("a", 0) + R"(, {"name": "n", "mass": 5, "position": [0, 0.3, 0], "inertia": [0.1, 0.1, 0.1]})",
      bearing_at("pa", "a", 0,
                 torque(number_text(at_rest) + " N m - 0.4 N m s*rate(pa)", std::copysign(0.2, at_rest))) +
          R"(, {"name": "n", "type": "prismatic", "bodies": ["ground", "n"], "at": [0, 0.3, 0],
              "axis": [0, 1, 0], )" +
          friction(30) +
          R"(}, {"name": "g", "type": "gear", "kind": "screw", "joints": ["pa", "n"], "lead": 0.01})",
      R"("gravity": [0, -9.81, 0], )");
}

// Dry friction between a body and another or the ground (-1), N m.
struct Rubbing {
  int a, b;
  double limit;
};

// The speeds of coaxial shafts with T_i - c_i w_i each: the least of sum(c w^2 / 2 - T w) + sum(limit |w_b -
// w_a|), which is convex, over all ways in which they may stick and slip.
std::vector<double> least_speeds(const std::vector<double>& torques, const std::vector<double>& resistances,
                                 const std::vector<Rubbing>& rubbing) {
  const auto of = [](const std::vector<double>& w, int i) {
    return i < 0 ? 0 : w[static_cast<std::size_t>(i)];
  };
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (int way = 0; way < std::pow(3, rubbing.size()); ++way) {
    std::vector<double> pushed = torques;
    std::vector<int> group(torques.size()); // what sticks together; -1: to the ground
    for (std::size_t i = 0; i < group.size(); ++i)
      group[i] = static_cast<int>(i);
    int digits = way;
    for (const Rubbing& r : rubbing) {
      const int slip = digits % 3 - 1;
      digits /= 3;
      if (r.a >= 0) pushed[static_cast<std::size_t>(r.a)] += slip * r.limit;
      pushed[static_cast<std::size_t>(r.b)] -= slip * r.limit;
      if (slip != 0) continue;
      const int one = r.a < 0 ? -1 : group[static_cast<std::size_t>(r.a)],
                other = group[static_cast<std::size_t>(r.b)];
      std::ranges::replace(group, std::max(one, other), std::min(one, other));
    }
    std::vector<double> w(torques.size());
    double dissipated = 0;
    for (std::size_t i = 0; i < w.size(); ++i) {
      double torque = 0, resistance = 0;
      for (std::size_t k = 0; k < w.size(); ++k)
        if (group[k] == group[i]) torque += pushed[k], resistance += resistances[k];
      w[i] = group[i] < 0 ? 0 : torque / resistance;
      dissipated += resistances[i] * w[i] * w[i] / 2 - torques[i] * w[i];
    }
    for (const Rubbing& r : rubbing)
      dissipated += r.limit * std::abs(of(w, r.b) - of(w, r.a));
    if (dissipated < least) {
      least = dissipated;
      best = w;
    }
  }
  return best;
}

} // namespace

TEST_CASE("four joints with friction of which clutches close loops: as enumerated") {
  std::mt19937 random(4);
  int slipped = 0, stuck = 0, balanced = 0;
  for (int trial = 0; trial < 8; ++trial) {
    std::vector<double> torques, resistances;
    const std::vector<Rubbing> rubbing{{-1, 1, uniform(random, 0.1, 2)},
                                       {0, 1, uniform(random, 0.1, 4)},
                                       {1, 2, uniform(random, 0.1, 4)},
                                       trial % 2 ? Rubbing{0, 2, uniform(random, 0.1, 4)}
                                                 : Rubbing{-1, 2, uniform(random, 0.1, 2)}};
    std::string bodies, joints;
    for (int i = 0; i < 3; ++i) {
      torques.push_back(uniform(random, -5, 5));
      resistances.push_back(uniform(random, 0.1, 1));
      const std::string b = "b" + std::to_string(i), j = "p" + std::to_string(i);
      const auto brake = std::ranges::find_if(rubbing, [&](const Rubbing& r) { return r.a < 0 && r.b == i; });
      bodies += (i ? ", " : "") + body_at(b, 0);
      joints +=
          (i ? ", " : "") + bearing_at(j, b, 0,
                                       torque(number_text(torques.back()) + " N m - " +
                                                  number_text(resistances.back()) + " N m s*rate(" + j + ")",
                                              torques.back()) +
                                           (brake == rubbing.end() ? "" : ", " + friction(brake->limit)));
    }
    for (const Rubbing& r : rubbing)
      if (r.a >= 0)
        joints += R"(, {"name": "k)" + std::to_string(r.a) + std::to_string(r.b) +
                  R"(", "type": "revolute", "bodies": ["b)" + std::to_string(r.a) + R"(", "b)" +
                  std::to_string(r.b) + R"("], "at": [0, 0, 0], "axis": [0, 1, 0], )" + friction(r.limit) +
                  "}";
    const Solution s = Analysis(scene(bodies, joints)).solve();
    const std::vector<double> expected = least_speeds(torques, resistances, rubbing);
    CAPTURE(trial, expected, s.message);
    REQUIRE(s.status == Status::converged);
    for (int i = 0; i < 3; ++i)
      CHECK_THAT(coordinate(s, "p" + std::to_string(i)).speed.value_or(0),
                 WithinAbs(expected[static_cast<std::size_t>(i)], 1e-9));
    std::vector<double> left = torques; // of each shaft's balance
    for (std::size_t i = 0; i < left.size(); ++i)
      left[i] -= resistances[i] * expected[i];
    bool all = true; // are known
    for (const FrictionForce& force : s.frictions) {
      ++(force.slips ? slipped : stuck);
      all = all && force.value;
      if (!force.value) continue;
      CHECK(std::abs(*force.value) <= force.limit * (1 + 1e-12));
      left[static_cast<std::size_t>(force.joint.back() - '0')] += *force.value;
      if (force.joint[0] == 'k') left[static_cast<std::size_t>(force.joint[1] - '0')] -= *force.value;
    }
    balanced += all;
    for (const double each : left)
      CHECK((!all || std::abs(each) < 1e-9));
  }
  CHECK(slipped > 6);
  CHECK(stuck > 3);
  CHECK(balanced > 6);
}

namespace {

// A motor that gives `law` and shafts that two clutches of 0.5 and 0.6 N m turn, each against 0.1 N m s.
Mechanism two_clutches(const std::string& law, const std::string& more = "") {
  const auto clutch = [](const std::string& name, const std::string& other, double limit) {
    return R"(, {"name": ")" + name + R"(", "type": "revolute", "bodies": ["a", ")" + other +
           R"("], "at": [0, 0, 0], "axis": [0, 1, 0], )" + friction(limit) + "}";
  };
  return scene(body_at("a", 0) + ", " + body_at("b", 0) + ", " + body_at("c", 0),
               bearing_at("pa", "a", 0, torque(law)) + ", " + bearing_at("pb", "b", 0, R"("damping": 0.1)") +
                   ", " + bearing_at("pc", "c", 0, R"("damping": 0.1)" + more) + clutch("kb", "b", 0.5) +
                   clutch("kc", "c", 0.6));
}

} // namespace

TEST_CASE("two clutches on a motor that runs away are refused, and it is told that it does") {
  const Mechanism m = two_clutches("9 N m");
  SolveOptions options;
  options.search = 0.03; // else some seconds
  const Solution s = Analysis(m).solve(options);
  CHECK(s.status != Status::converged);
  CHECK_THAT(s.message, ContainsSubstring("it runs away"));
}

TEST_CASE("what turns in place rests nowhere but where friction holds it") {
  const Mechanism m = two_clutches("5 N m - 1 N m s*rate(pa)");
  CHECK(turns_in_place(m));
  const std::vector<FrictionParts> parts = first_parts(m, nullptr);
  CHECK(parts.size() == 9); // each clutch holds, or slips forwards or backwards
  for (const FrictionParts& each : parts)
    CHECK(std::ranges::count(each, FrictionPart::none) == 0);
  CHECK(may_rest(m, {}).size() == 1);
  // A spring, gravity on a mass beside the axis or a torque of a place may hold it anywhere.
  Mechanism sprung = two_clutches("5 N m - 1 N m s*rate(pa)", R"(, "spring": {"stiffness": 10})");
  CHECK_FALSE(turns_in_place(sprung));
  CHECK(first_parts(sprung, nullptr).size() == 15);
  CHECK(may_rest(sprung, {}).size() == 2);
  Mechanism beside = m;
  beside.bodies[1].position.x() = 0.1;
  CHECK_FALSE(turns_in_place(beside));
  CHECK_FALSE(turns_in_place(two_clutches("5 N m - 1 N m*coordinate(pb)")));
}

TEST_CASE("a shaft whose speed is the other way round than its search begins is found beside two clutches") {
  // -1.27 N m + 1.92 N m tanh((w - 2.7 rad/s)/1.5 rad/s) - 0.19 N m s w leaves the clutch's 1.27 N m at
  // -10.15 rad/s; beyond it all stands.
  const std::string law = "-1.2677484928891865 N m + 1.9213120027523747 N m*tanh((rate(p0) - "
                          "2.6840747996489895 rad/s)/(1.4859234931402692 rad/s)) - 0.18875684199987264 N m "
                          "s*rate(p0)";
  const auto clutch = [](const std::string& name, const std::string& a, const std::string& b, double limit) {
    return R"(, {"name": ")" + name + R"(", "type": "revolute", "bodies": [")" + a + R"(", ")" + b +
           R"("], "at": [0, 0, 0], "axis": [0, 1, 0], )" + friction(limit) + "}";
  };
  const Mechanism m = scene(
      body_at("b0", 0) + ", " + body_at("b1", 0) + ", " + body_at("b2", 0),
      bearing_at("p0", "b0", 0, torque(law, 8.586408324925854)) + ", " +
          bearing_at("p1", "b1", 0, R"("damping": 0.24)") + ", " +
          bearing_at("p2", "b2", 0, R"("damping": 0.14, )" + friction(1.5293438612798749)) +
          clutch("k01", "b0", "b1", 1.2738810123605713) + clutch("k12", "b1", "b2", 2.4354755257336227));
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "p0"), WithinRel(-10.146277832644543, 1e-9));
  CHECK(s.frictions.size() == 3);
}

TEST_CASE("a brake on a countershaft slips: it loads the shaft by the ratio") {
  const Mechanism m = countershaft(0.5);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "pa"), WithinRel((2 - 2 * 0.5) / 0.4, 1e-12));
  CHECK_THAT(speed(s, "pc"), WithinRel(-2 * (2 - 2 * 0.5) / 0.4, 1e-12));
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].slips);
  CHECK(s.frictions[0].value == 0.5);
  REQUIRE(s.drive_torques.size() == 1);
  CHECK_THAT(s.drive_torques[0].value, WithinRel(1., 1e-12));
  CHECK(s.stable == true);
  CHECK_THAT(s.message, ContainsSubstring("pc slips at a constant rate"));
  CHECK_THAT(s.message, !ContainsSubstring("Without friction there is no steady state"));
  expect_same_motion(m, s, "pa", 30, 1);
}

TEST_CASE("a brake on a countershaft that holds takes the torque at rest over the ratio") {
  const Mechanism m = countershaft(1.5);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(speed(s, "pa") == 0);
  REQUIRE(s.frictions.size() == 1);
  CHECK_FALSE(s.frictions[0].slips);
  CHECK_THAT(s.frictions[0].value.value(), WithinRel(1., 1e-12));
  REQUIRE(s.drive_torques.size() == 1);
  CHECK(s.drive_torques[0].joint == "pa");
  CHECK(s.drive_torques[0].value == 2);
  const Holding holding = find_holding(m, {});
  INFO(holding.message);
  CHECK_THAT(holding.takes.value(), WithinRel(1 / 1.5, 1e-12));
  CHECK_FALSE(report_friction(m, s).band.found);
  expect_same_motion(m, s, "pa", 30, 1);
}

TEST_CASE("friction at the very joint that a torque turns") {
  const double limit = GENERATE(0.5, 1.9, 2.1);
  CAPTURE(limit);
  const Mechanism m =
      scene(body_at("a", 0),
            bearing_at("pa", "a", 0, torque("2 N m - 0.4 N m s*rate(pa)") + ", " + friction(limit)));
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "pa"), WithinAbs(std::max(0., (2 - limit) / 0.4), 1e-12));
  REQUIRE(s.frictions.size() == 1);
  CHECK(s.frictions[0].slips == (limit < 2));
  CHECK_THAT(s.frictions[0].value.value(), WithinRel(-std::min(limit, 2.), 1e-12));
  REQUIRE(s.drive_torques.size() == 1);
  CHECK_THAT(s.drive_torques[0].value, WithinRel(std::min(limit, 2.), 1e-12));
  REQUIRE(s.drive_torques[0].given);
  CHECK_THAT(s.drive_torques[0].given->load, WithinAbs(0, 1e-15));
  expect_same_motion(m, s, "pa", 30, 1);
}

TEST_CASE("a screw jack rises, sinks, and locks itself") {
  const double r = 0.01 / (2 * std::numbers::pi), weight = 5 * 9.81;
  const Solution up = Analysis(jack(0.2)).solve();
  REQUIRE(up.status == Status::converged);
  CHECK_THAT(speed(up, "pa"), WithinRel((0.2 - r * (weight + 30)) / 0.4, 1e-12));
  expect_same_motion(jack(0.2), up, "pa", 30, 1);
  const Solution down = Analysis(jack(-0.2)).solve();
  REQUIRE(down.status == Status::converged);
  CHECK_THAT(speed(down, "pa"), WithinRel((-0.2 - r * (weight - 30)) / 0.4, 1e-12));
  const Solution locks = Analysis(jack(0.05)).solve();
  INFO(locks.message);
  REQUIRE(locks.status == Status::converged);
  CHECK(speed(locks, "pa") == 0);
  CHECK_THAT(locks.frictions.at(0).value.value(), WithinRel(weight - 0.05 / r, 1e-12));
  CHECK_THAT(find_holding(jack(0.05), {}).takes.value(), WithinRel((weight - 0.05 / r) / 30, 1e-12));
  expect_same_motion(jack(0.05), locks, "pa", 30, 1);
}

TEST_CASE("the torque at rest may depend on where others stand") {
  // A block of 2 kg hangs on 200 N/m: 0.1 m. At rest 2 N m + 10 N * 0.1 m.
  const double limit = GENERATE(1.4, 1.6); // through the gear 2.8 and 3.2 N m
  const Mechanism m =
      scene(body_at("a", 0) + ", " + body_at("c", 0.3) + ", " + body_at("b", 1, 2),
            bearing_at("pa", "a", 0, torque("2 N m - 0.4 N m s*rate(pa) + 10 N*coordinate(slide)")) + ", " +
                bearing_at("pc", "c", 0.3, friction(limit)) + ", " + meshing("g", "pa", "pc", -2) +
                R"(, {"name": "slide", "type": "prismatic", "bodies": ["ground", "b"], "at": [1, 0, 0],
              "axis": [0, -1, 0], "spring": {"stiffness": 200}, "damping": 50})",
            R"("gravity": [0, -10, 0], )");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(value(s, "slide"), WithinRel(0.1, 1e-10));
  CHECK_THAT(speed(s, "pa"), WithinAbs(std::max(0., (3 - 2 * limit) / 0.4), 1e-10));
  CHECK_THAT(s.frictions.at(0).value.value(), WithinRel(std::min(limit, 1.5), 1e-10));
  CHECK_THAT(find_holding(m, {}).takes.value(), WithinRel(1.5 / limit, 1e-10));
  CHECK(s.measures.empty());
}

TEST_CASE("a shaft that starts fast runs on where one that rests is held") {
  // At rest 1 N m, at 5 rad/s 2.2 N m less what air takes: held by 1.2 N m, and slipping at a higher speed.
  const std::string law = "1 N m + 0.6 N m s*rate(pa) - 0.06 N m s^2*rate(pa)^2";
  const auto shaft = [&](double speed) {
    return scene(body_at("a", 0), bearing_at("pa", "a", 0, torque(law, speed) + ", " + friction(1.2)));
  };
  const Solution runs = Analysis(shaft(9)).solve();
  INFO(runs.message);
  REQUIRE(runs.status == Status::converged);
  CHECK_THAT(speed(runs, "pa"), WithinRel(5 + std::sqrt(25 - 0.2 / 0.06), 1e-10));
  const AllSolutions all = Analysis(shaft(9)).solve_all();
  INFO(all.message);
  CHECK(std::ranges::any_of(all.equilibria, [](const Solution& s) { return s.frictions.at(0).slips; }));
  CHECK(std::ranges::any_of(all.equilibria, [](const Solution& s) { return !s.frictions.at(0).slips; }));
}

TEST_CASE("a shaft that starts fast runs on at a speed that Newton-Raphson alone does not find") {
  // As above, and with a dip about 5 rad/s, where the torque left is least, but above zero.
  const Mechanism m =
      scene(body_at("a", 0), bearing_at("pa", "a", 0,
                                        torque("1 N m + 0.6 N m s*rate(pa) - 0.06 N m s^2*rate(pa)^2 - "
                                               "1 N m*exp(-4 s^2*(rate(pa) - 5 rad/s)^2)",
                                               5.1) +
                                            ", " + friction(1.2)));
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK_THAT(speed(s, "pa"), WithinRel(5 + std::sqrt(25 - 0.2 / 0.06), 1e-9));
}

TEST_CASE("random trains of gears with several brakes and torques: as summed on the first shaft") {
  std::mt19937 random(25);
  int held = 0, slipped = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const int shafts = 2 + trial % 3;
    std::string bodies, joints;
    double ratio = 1, torques = 0, resistance = 0, limits = 0;
    for (int i = 0; i < shafts; ++i) {
      const std::string b = "b" + std::to_string(i), j = "j" + std::to_string(i);
      const bool driven = i == trial % shafts || uniform(random, 0, 1) < 0.3;
      const bool brake = i == (trial + 1) % shafts || (uniform(random, 0, 1) < 0.4 && limits == 0);
      if (i > 0) {
        const double step = std::copysign(uniform(random, 0.4, 2.5), uniform(random, -1, 1));
        joints += ", " + meshing("g" + std::to_string(i), "j" + std::to_string(i - 1), j, step) + ", ";
        ratio *= step;
      }
      std::string more;
      if (driven) {
        const double t = uniform(random, -3, 3), c = uniform(random, 0.1, 0.6);
        more = torque(number_text(t) + " N m - " + number_text(c) + " N m s*rate(" + j + ")", t);
        torques += ratio * t;
        resistance += ratio * ratio * c;
      }
      if (brake) {
        const double limit = uniform(random, 0.2, 2.5);
        more += (more.empty() ? "" : ", ") + friction(limit);
        limits += std::abs(ratio) * limit;
      }
      bodies += (i ? ", " : "") + body_at(b, 0.3 * i);
      joints += bearing_at(j, b, 0.3 * i, more);
    }
    const Mechanism m = scene(bodies, joints);
    const Solution s = Analysis(m).solve();
    CAPTURE(trial, shafts, torques, limits, s.message);
    REQUIRE(s.status == Status::converged);
    const bool holds = std::abs(torques) < limits;
    const double speed = holds ? 0 : (torques - std::copysign(limits, torques)) / resistance;
    const CoordinateSolution& first = coordinate(s, "j0");
    CHECK_THAT(first.speed.value_or(0), WithinAbs(speed, 1e-10 * (1 + std::abs(speed))));
    CHECK(std::ranges::any_of(s.frictions, &FrictionForce::slips) == !holds);
    ++(holds ? held : slipped);
    const Holding holding = find_holding(m, {});
    INFO(holding.message);
    CHECK_THAT(holding.takes.value(), WithinRel(std::abs(torques) / limits, 1e-10));
  }
  CHECK(held > 4);
  CHECK(slipped > 4);
}

TEST_CASE("along the torque a brake holds between where it slips either way") {
  Mechanism m =
      countershaft(0.5, "T - 0.4 N m s*rate(pa)", R"("parameters": {"T": {"value": 2, "unit": "N m"}}, )");
  const ResponseDiagram d = follow_response(m, "parameters.T", -3, 3);
  INFO(d.message);
  REQUIRE(d.special.size() == 2);
  std::vector<double> at{d.special[0].at.parameter, d.special[1].at.parameter};
  std::ranges::sort(at);
  CHECK_THAT(at[0], WithinAbs(-1, 1e-9));
  CHECK_THAT(at[1], WithinAbs(1, 1e-9));
  REQUIRE(d.branches.size() == 3);
  for (const ResponseBranch& branch : d.branches)
    for (const ResponsePoint& point : branch.points) {
      const double torque = point.parameter, left = std::max(0., std::abs(torque) - 1);
      CHECK_THAT(coordinate(point.coordinates, "pa").speed.value(),
                 WithinAbs(std::copysign(left, torque) / 0.4, 1e-8));
    }
}

TEST_CASE("behind a brake that holds, a flexible coupling winds up and its shaft comes to rest") {
  const double limit = GENERATE(8., 3.);
  const Mechanism m = scene(
      body_at("a", 0) + ", " + body_at("b", 0),
      bearing_at("pa", "a", 0, torque("5 N m - 1 N m s*rate(pa)")) + ", " +
          bearing_at("pb", "b", 0, friction(limit)) +
          R"(, {"name": "c", "type": "revolute", "bodies": ["a", "b"], "at": [0, 0, 0], "axis": [0, 1, 0],
              "spring": {"stiffness": 10}, "damping": 0.1})");
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  REQUIRE(s.frictions.size() == 1);
  if (limit > 5) {
    CHECK_FALSE(s.frictions[0].slips);
    CHECK_THAT(s.frictions[0].value.value(), WithinRel(-5., 1e-12));
    CHECK_THAT(value(s, "c"), WithinRel(-0.5, 1e-12));
    CHECK_THAT(value(s, "pa"), WithinRel(0.5, 1e-12));
    CHECK(value(s, "pb") == 0);
    CHECK(s.stable == true);
    REQUIRE(s.drive_torques.size() == 1);
    CHECK(s.drive_torques[0].value == 5);
    CHECK_THAT(find_holding(m, {}).takes.value(), WithinRel(5. / 8, 1e-12));
    // 0.15 x'' + (1 + 0.1) x' + 10 x = 0: the torque's slope damps, too.
    REQUIRE(s.eigenvalues);
    const double decay = 1.1 / 0.3;
    CHECK(std::ranges::any_of(*s.eigenvalues, [&](std::complex<double> e) {
      return std::abs(e - std::complex(-decay, std::sqrt(10 / 0.15 - decay * decay))) < 1e-8;
    }));
  } else {
    CHECK(s.frictions[0].slips);
    CHECK_THAT(speed(s, "pa"), WithinRel(2., 1e-9));
    CHECK_THAT(value(s, "c"), WithinRel(-0.3, 1e-9));
  }
}

TEST_CASE("friction at a given speed loads the drive alone") {
  for (const double speed : {5., -5., 0.}) {
    const auto shafts = [&](double own, double geared) {
      return scene(
          body_at("a", 0) + ", " + body_at("c", 0.3) + ", " + body_at("b", 0.6),
          bearing_at("pa", "a", 0,
                     R"("damping": 0.2, "drive": {"speed": )" + number_text(speed) + "}, " + friction(own)) +
              ", " + bearing_at("pc", "c", 0.3, friction(geared)) + ", " + meshing("g", "pa", "pc", -2) +
              ", " + bearing_at("pb", "b", 0.6, R"("spring": {"stiffness": 10}, )" + friction(0.1)));
    };
    const Mechanism m = shafts(1, 0.75);
    CHECK(find_frictions(m).size() == 1); // which holds something
    const Solution s = Analysis(m).solve({});
    REQUIRE(s.status == Status::converged);
    CHECK(s.frictions.empty());
    REQUIRE(s.drive_torques.size() == 1);
    // What both bearings rub, seen from the drive: 1 N m + 2 x 0.75 N m.
    const double rubbed = speed == 0 ? 0 : std::copysign(2.5, speed);
    CHECK_THAT(s.drive_torques[0].value, WithinAbs(0.2 * speed + rubbed, 1e-14));
    REQUIRE(s.gears.size() == 1);
    CHECK_THAT(s.gears[0].a, WithinAbs(speed == 0 ? 0 : std::copysign(1.5, -speed), 1e-14));
    CHECK((s.message.find("At speed zero dry friction may bear up to 2.5 N m of the torque told of pa.") !=
           std::string::npos) == (speed == 0));
    SimulationOptions options;
    options.duration = 1;
    options.rate = 0;
    const Run run = simulate(m, options);
    REQUIRE(run.drives.size() == 1);
    CHECK_THAT(run.drives[0].torque.back(), WithinAbs(s.drive_torques[0].value, 1e-9));
  }
  CHECK_THROWS_WITH(
      scene(body_at("a", 0),
            bearing_at("pa", "a", 0, R"("drive": {"speed": 5}, "friction": {"limit": 1, "share": 0.5})")),
      ContainsSubstring("friction.share") && ContainsSubstring("gives all of its limit"));
}

TEST_CASE("friction at a given speed changes nothing but the torque of the drive") {
  const Mechanism governor = load_scene(FLYBALL_ASSETS "/scenes/governor.json");
  Mechanism rubbing = governor;
  const int spin = joint_index(governor, "spin");
  REQUIRE(governor.joints[static_cast<std::size_t>(spin)].coordinates[0].drive);
  rubbing.joints[static_cast<std::size_t>(spin)].coordinates[0].friction.emplace().limit = 0.3;
  CHECK_FALSE(has_friction(rubbing)); // no band
  CHECK(rubs_anywhere(rubbing));
  const Solution a = Analysis(governor).solve({}), b = Analysis(rubbing).solve({});
  REQUIRE(b.status == Status::converged);
  REQUIRE(a.coordinates.size() == b.coordinates.size());
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    CHECK(a.coordinates[i].value == b.coordinates[i].value);
  CHECK(a.eigenvalues == b.eigenvalues);
  CHECK_THAT(b.drive_torques[0].value - a.drive_torques[0].value, WithinAbs(0.3, 1e-12));
}

TEST_CASE("friction does not hold what a loop carries along with a drive") {
  const auto at = [](const char* name, const char* a, const char* b, double x, double y,
                     const std::string& more) {
    return R"({"name": ")" + std::string(name) + R"(", "type": "revolute", "bodies": [")" + a + R"(", ")" +
           b + R"("], "axis": [0, 0, 1], "at": [)" + number_text(x) + ", " + number_text(y) + ", 0]" + more +
           "}";
  };
  for (const std::string rubbing : {"p", "a", "b"}) {
    CAPTURE(rubbing);
    const auto more = [&](const std::string& name) { return name == rubbing ? ", " + friction(1) : ""; };
    const Mechanism m = scene(
        R"({"name": "c1", "mass": 1, "position": [0, 0.5, 0], "inertia": [0.01, 0.01, 0.01]},
           {"name": "c2", "mass": 1, "position": [2, 0.5, 0], "inertia": [0.01, 0.01, 0.01]},
           {"name": "k", "mass": 1, "position": [1, 1, 0], "inertia": [0.01, 0.01, 0.01]})",
        at("o", "ground", "c1", 0, 0, R"(, "drive": {"speed": 3})") + ", " +
            at("p", "ground", "c2", 2, 0, more("p")) + ", " + at("a", "c1", "k", 0, 1, more("a")) + ", " +
            at("b", "c2", "k", 2, 1, more("b")),
        R"("gravity": [0, 0, 0], )");
    const Solution s = Analysis(m).solve();
    REQUIRE(s.frictions.size() == 1);
    CHECK(s.frictions[0].slips);
    CHECK_THAT(s.drive_torques[0].value, WithinRel(1., 1e-12));
    const Holding holding = find_holding(m, {});
    CHECK_FALSE(holding.takes);
    CHECK(holding.message == "Friction does not hold " + rubbing + ", which goes on with the drives.");
  }
}

TEST_CASE("friction where momentum is kept is refused with the reason") {
  CHECK_THROWS_WITH(
      scene(body_at("a", 0),
            bearing_at("pa", "a", 0, R"("drive": {"keeps": "momentum", "speed": 5}, )" + friction(1))),
      ContainsSubstring("where friction acts no momentum is kept"));
}

namespace {

// A shaft of 2 N m - 0.4 N m s w, a bob of 1 kg on an arm of 0.5 m at 0.1 m from its axis, in a hinge with
// friction (N m).
Mechanism braked_governor(const std::string& brake, double hinge, const std::string& more = "") {
  return scene(body_at("a", 0) + R"(, {"name": "bob", "mass": 1, "position": [0.1, -0.5, 0]})" +
                   (more.empty() ? "" : ", " + body_at("c", 0.3)),
               bearing_at("spin", "a", 0,
                          torque("2 N m - 0.4 N m s*rate(spin)") + (brake.empty() ? "" : ", " + brake)) +
                   R"(, {"name": "swing", "type": "revolute", "bodies": ["a", "bob"], "at": [0.1, 0, 0],
                     "axis": [0, 0, 1], )" +
                   friction(hinge) + "}" + more,
               R"("gravity": [0, -10, 0], )");
}

// Of the moments about the hinge, N m.
double swing_moment(double speed, double angle) {
  return 5 * std::sin(angle) - speed * speed * (0.1 + 0.5 * std::sin(angle)) * 0.5 * std::cos(angle);
}

BandExtent extent_of(const FrictionReport& report, std::string_view name) {
  INFO(report.band.message);
  REQUIRE(report.band.found);
  const auto found = std::ranges::find(report.band.extents, name, &BandExtent::name);
  REQUIRE(found != report.band.extents.end());
  return *found;
}

} // namespace

TEST_CASE("beside a brake that slips the other friction makes its band") {
  // On the shaft 0.5 N m leave 3.75 rad/s, on a countershaft at -2 they leave 2.5 rad/s.
  const bool geared = GENERATE(false, true);
  const Mechanism m = geared ? braked_governor("", 0.3,
                                               ", " + bearing_at("pc", "c", 0.3, friction(0.5)) + ", " +
                                                   meshing("g", "spin", "pc", -2))
                             : braked_governor(friction(0.5), 0.3);
  const FrictionReport report = report_friction(m, Analysis(m).solve());
  const double speed = geared ? 2.5 : 3.75;
  const BandExtent swing = extent_of(report, "swing"), spin = extent_of(report, "spin.speed");
  CHECK_THAT(spin.low, WithinRel(speed, 1e-12));
  CHECK_THAT(spin.high, WithinRel(speed, 1e-12));
  CHECK_THAT(swing_moment(speed, swing.low), WithinRel(-0.3, 1e-9));
  CHECK_THAT(swing_moment(speed, swing.high), WithinRel(0.3, 1e-9));
  CHECK(report.band.extents.size() == (geared ? 3 : 2)); // the speed of the countershaft, too
  CHECK_THAT(report.band.message, ContainsSubstring(geared ? "while pc slips" : "while spin slips"));
}

TEST_CASE("beside a brake that stands the other friction makes its band") {
  const Mechanism m = braked_governor(friction(2.5), 0.3);
  const FrictionReport report = report_friction(m, Analysis(m).solve());
  const BandExtent swing = extent_of(report, "swing");
  CHECK_THAT(swing.low, WithinAbs(-std::asin(0.3 / 5), 1e-12));
  CHECK_THAT(swing.high, WithinAbs(std::asin(0.3 / 5), 1e-12));
  CHECK(report.band.message == "It is the band while spin stands.");
}

TEST_CASE("no band is told in which a brake that stands would have to hold more than its limit") {
  // An arm of 2 kg hangs from a level shaft that stands against 2 N m by a torque: what its hinge, on the
  // same axis, holds the shaft has to hold, too.
  const double limit = GENERATE(2.5, 3.5);
  const Mechanism m =
      scene(body_at("a", 0) + R"(, {"name": "bob", "mass": 2, "position": [0, -0.5, 0]})",
            R"({"name": "spin", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0],
                "axis": [0, 0, 1], )" +
                torque("2 N m - 0.4 N m s*rate(spin)") + ", " + friction(limit) +
                R"(}, {"name": "hinge", "type": "revolute", "bodies": ["a", "bob"], "at": [0, 0, 0],
                   "axis": [0, 0, 1], )" +
                friction(1) + "}",
            R"("gravity": [0, -10, 0], )");
  const FrictionReport report = report_friction(m, Analysis(m).solve());
  INFO(report.band.message);
  CHECK(report.band.found == (limit > 3));
  if (report.band.found) {
    CHECK_THAT(extent_of(report, "hinge").high, WithinRel(std::asin(0.1), 1e-12));
  } else {
    CHECK_THAT(report.band.message, ContainsSubstring("may have to hold more than its limit"));
  }
}
