// Laws of drives by places, distances, angles and velocities of points: the same answers as by the
// coordinates that say as much, closed forms, derivatives against differences, long motions; and what is
// refused.
#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/hopf_point.hpp"
#include "engine/study/linear_model.hpp"
#include "engine/system/extended.hpp"
#include "engine/system/linearization.hpp"
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;
using Complex = std::complex<double>;

namespace {

// Haug's governor with engine; its collar's coordinate is 0.2 m less its height. "top" is on the shaft's
// axis, "aside" is not.
Mechanism governor(const std::string& law) {
  Mechanism m = shipped("governor_engine");
  m.points.push_back({"top", {0, 0.2, 0}});
  m.points.push_back({"aside", {0.1, 0.2, 0}});
  m.measures.push_back({"height", "", "y(collar)", "m"});
  m.measures.push_back({"opening", "", "0.05 m - height", "m"});
  return with_torque(std::move(m), law);
}

const std::string by_coordinate = "gain*(coordinate(slide) - 0.15 m)";
const std::vector<std::string> by_places{
    "gain*opening", "gain*(0.05 m - y(collar))", "gain*(distance(collar, ground@top) - 0.15 m)",
    "gain*(distance(collar, spindle) - 0.15 m)", "gain*(y(spindle@top) - y(collar) - 0.15 m)"};

double difference(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (const Complex x : a) {
    double nearest = 1e300;
    for (const Complex y : b)
      nearest = std::min(nearest, std::abs(x - y));
    most = std::max(most, nearest);
  }
  return most;
}

SpecialPoint hopf_point(const Mechanism& m, const std::string& address, double from, double to) {
  const ResponseDiagram d = follow_branches(m, address, from, to);
  INFO(d.message);
  for (const SpecialPoint& s : d.special)
    if (s.type == SpecialPointType::hopf) return s;
  FAIL("no Hopf point");
  return {};
}

std::string refusal(const Mechanism& m) {
  try {
    validate(m);
    static_cast<void>(Analysis(m));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

// d/dh of f at zero, by central differences extrapolated three times.
template <class Function>
Eigen::VectorXd slope(const Function& f) {
  using Vector = Configuration<Extended>;
  const auto central = [&](Extended h) -> Vector { return (f(h) - f(-h)) / (2 * h); };
  const Extended h = 2e-3;
  const Vector d1 = central(h), d2 = central(h / 2), d4 = central(h / 4);
  return ((16 * (4 * d4 - d2) / 3 - (4 * d2 - d1) / 3) / 15).template cast<double>();
}

Force bearing(const std::string& name, const std::string& first, const std::string& second, const Vec3& at,
              const Vec3& axis, const BearingMatrix& stiffness, const BearingMatrix& damping) {
  Force out;
  out.name = name;
  out.type = ForceType::bearing;
  out.bodies = {first, second};
  out.at = at;
  out.axis = axis;
  out.bearing_stiffness = stiffness;
  out.bearing_damping = damping;
  return out;
}

// Two springs, one with a damper, three bearings with cross terms, two of which resist turns as well, and
// joints with springs by numbers and by laws. The hinge carries both bodies of the last bearing.
Mechanism strung(Mechanism m) {
  m.forces.push_back(bearing("edge", "collar", "arm", {0.2, -0.1, 0.05}, {0.2, 1, 0.1}, {9, 1, -2, 6},
                             {0.5, 0.2, -0.1, 0.4}));
  BearingMatrix stiffness, damping;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      stiffness.push_back(i == j ? 1.5 + 0.3 * i : 0.1 * std::sin(1 + 3 * i + 7 * j));
      damping.push_back(i == j ? 0.2 + 0.02 * i : 0.02 * std::sin(2 + 5 * i + 3 * j));
    }
  m.forces.push_back(bearing("seat", "shaft", "bob", {0.3, -0.3, 0.1}, {0.1, 0.3, 1}, stiffness, damping));
  m.forces.push_back(bearing("wrist", "arm", "bob", {0.35, -0.35, 0.1}, {1, 0.4, -0.2}, stiffness, damping));
  m.forces.push_back(point_spring("string", "shaft", "bob", {0, 0.3, 0}, {0.4, -0.5, 0.1}, 12, 0.3));
  m.forces.back().damping = 0.7;
  m.forces.push_back(point_spring("band", "collar", "arm", {0, 0.2, 0}, {0.3, -0.4, 0.1}, 0, 0.2));
  m.forces.back().force = 0;
  m.forces.back().formulas.push_back({"force", "8 N/m*deflection + 20 N/m^3*deflection^3"});
  return m;
}

const std::vector<std::string> by_springs{"1 m * tension(string)",
                                          "1 m * force(string) + 0.5 m * tension(band)",
                                          "0.4 m * force_y(band)",
                                          "2 m * spring(slide)",
                                          "1 N m * sin(spring(hinge)/(1 N m)) + spring(ball.1)",
                                          "0.3 m*tension(string)*tension(band)/(1 N) + 1 m*force_y(string)"};

const std::vector<std::string> by_bearings{"1 m * force_y(edge)",
                                           "0.5 m * force(edge)",
                                           "0.5 m * force_y(seat) + 0.2 * couple_y(seat)",
                                           "0.4 m * force(seat) - 0.3 * couple(seat)",
                                           "couple_y(seat)*force(edge)/(1 N)",
                                           "0.3 m * force_y(wrist) + 0.4 * couple_y(wrist)"};

// A shaft whose balls swing on arms and joints of their own, with a collar that slides.
Mechanism swinging(const std::string& law) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.points.push_back({"tip", {0.3, -0.4, 0.1}});
  m.points.push_back({"top", {0, 0.5, 0}});
  m.bodies = {body("shaft", 2, {0, 0, 0}, {0.2, 0.3, 0.2}),
              body("arm", 1, {0.3, -0.2, 0.05}, {0.02, 0.03, 0.01}),
              body("bob", 0.5, {0.4, -0.5, 0.1}, {0.01, 0.01, 0.02}), body("collar", 0.3, {0, 0.2, 0})};
  m.joints = {driven(revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 1, 0}), 4),
              sprung(revolute("hinge", "shaft", "arm", {0.1, 0, 0}, {0, 0.3, 1}), 3),
              joint(JointType::spherical, "ball", "arm", "bob", {0.35, -0.35, 0.1}),
              sprung(prismatic("slide", "shaft", "collar", {0, 0.2, 0}, {0, 1, 0}), 40)};
  for (const std::size_t i : {0u, 1u, 2u})
    m.joints[2] = sprung(m.joints[2], 1.5, 0, i);
  return with_torque(std::move(m), law);
}

const std::vector<std::string> all_kinds{"2 N * y(bob)",
                                         "2 N * y(bob@tip)",
                                         "3 N s * vy(collar)",
                                         "1 N s * speed(bob)",
                                         "1 N s * speed(arm@tip)",
                                         "2 N * distance(bob, collar)",
                                         "2 N * distance(bob@tip, ground@top)",
                                         "2 N m * angle(bob, collar, arm)",
                                         "2 N m * angle(bob@tip, ground@top, collar)",
                                         "1 N m s * rate(spin) * sin(y(bob)/(1 m)) + 5 N m * "
                                         "exp(-distance(arm, collar)^2/(1 m^2))*speed(bob)/(1 m/s)"};

// Laws that ask for what springs and bearings exert, too.
std::vector<std::string> all_laws() {
  std::vector<std::string> laws = all_kinds;
  laws.insert(laws.end(), by_springs.begin(), by_springs.end());
  laws.insert(laws.end(), by_bearings.begin(), by_bearings.end());
  return laws;
}

} // namespace

TEST_CASE("Haug's governor throttled by the collar's place answers as by its coordinate",
          "[torque][places]") {
  const Mechanism direct = governor(by_coordinate);
  const Solution wanted = Analysis(direct).solve();
  const SpecialPoint hunting = hopf_point(direct, "joints.slide.damping", 60, 5),
                     by_gain = hopf_point(direct, "parameters.gain", 5000, 15000);
  const auto loss = [](const Mechanism& m, const SpecialPoint& at) {
    return describe_hopf(with_parameter(m, "joints.slide.damping", at.at.parameter), at.at,
                         hopf_frequency(at.at.eigenvalues));
  };
  const HopfPoint edge = loss(direct, hunting);
  REQUIRE(edge.lyapunov);
  SimulationOptions options;
  options.duration = 3;
  options.rate = 4;
  options.at = {{"slide", 0.14}};
  const Run motion = simulate(direct, options);
  const std::vector<std::string> inputs{"parameters.gain"}, outputs{"rate(spin)"};
  const LinearModel model = linearize(direct, inputs, outputs, {});
  REQUIRE(model.refusal.empty());
  for (const std::string& law : by_places) {
    CAPTURE(law);
    const Mechanism m = governor(law);
    validate(m);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(speed(wanted, "spin"), 1e-13));
    CHECK(std::abs(value(s, "slide") - 0.15) < 1e-14);
    CHECK(std::abs(value(s, "slide") - 0.15) <= coordinate(s, "slide").error);
    CHECK(s.stable == true);
    CHECK(difference(*s.eigenvalues, *wanted.eigenvalues) < 1e-10);
    CHECK(difference(*s.at_constant_speed->eigenvalues, *wanted.at_constant_speed->eigenvalues) < 1e-10);
    const SpecialPoint there = hopf_point(m, "joints.slide.damping", 60, 5);
    CHECK_THAT(there.at.parameter, WithinRel(hunting.at.parameter, 1e-9));
    CHECK_THAT(hopf_point(m, "parameters.gain", 5000, 15000).at.parameter,
               WithinRel(by_gain.at.parameter, 1e-9));
    const HopfPoint begins = loss(m, there);
    REQUIRE(begins.lyapunov);
    CHECK(std::abs(*begins.lyapunov - *edge.lyapunov) <=
          begins.error + edge.error + 1e-6 * std::abs(*edge.lyapunov));
    const Run moved = simulate(m, options);
    REQUIRE(moved.status == RunStatus::completed);
    for (std::size_t c = 0; c < moved.coordinates.size(); ++c)
      for (std::size_t i = 0; i < moved.time.size(); ++i)
        CHECK(std::abs(moved.coordinates[c].value[i] - motion.coordinates[c].value[i]) < 1e-6);
    CHECK(std::abs(moved.energy.balance.back()) < 1e-6 * moved.energy.kinetic.back());
    const LinearModel same = linearize(m, inputs, outputs, {});
    INFO(same.refusal);
    REQUIRE(same.refusal.empty());
    CHECK(difference(same.poles, model.poles) < 1e-9);
  }
}

TEST_CASE("a place is known where its joint closes the loops", "[torque][places][found]") {
  Mechanism m = governor("gain*opening");
  const Solution before = Analysis(m).solve();
  for (Joint& joint : m.joints)
    if (joint.name == "slide") joint.cut = true;
  const Solution after = Analysis(m).solve();
  CHECK_THAT(speed(after, "spin"), WithinRel(speed(before, "spin"), 1e-12));
  CHECK(difference(*after.eigenvalues, *before.eigenvalues) < 1e-9);
  SimulationOptions options;
  options.start = Start::equilibrium;
  options.duration = 3;
  CHECK(distance_from(simulate(m, options), 3, after) < 1e-8);
}

TEST_CASE("a governor throttled by the distance of its balls", "[torque][places]") {
  // d = 2 * 0.16 m cos a with the arms' angle a. Free of load the torque is zero, so that the balls stand at
  // the wanted distance.
  const double wanted = 0.226, arm = HaugGovernor::arm;
  const Solution s = Analysis(governor("3000 N*(0.226 m - distance(ball1, ball2))")).solve();
  REQUIRE(s.status == Status::converged);
  const double angle = std::acos(wanted / (2 * arm));
  const HaugGovernor closed(angle);
  CHECK_THAT(speed(s, "spin"), WithinRel(closed.speed(), 1e-12));
  CHECK_THAT(value(s, "slide"), WithinRel(closed.s, 1e-12));
  REQUIRE(s.eigenvalues->size() == 3);
  const double slope = 3000 * 2 * arm * std::sin(angle); // of the torque with the angle
  const auto p = closed.characteristic(30, slope / closed.s1);
  for (const Complex x : *s.eigenvalues)
    CHECK(std::abs(cubic(p, x)) < 1e-9 * std::abs(p[1]) * std::norm(x));
}

TEST_CASE("a law by points goes on with them where the list of points is another", "[torque][places]") {
  const Mechanism by_bodies = governor("3000 N*(0.226 m - distance(ball1, ball2))");
  Mechanism m = by_bodies;
  m.points.push_back({"left", {-0.16, 0.2, 0}});
  m.points.push_back({"right", {0.16, 0.2, 0}});
  m = with_torque(std::move(m), "3000 N*(0.226 m - distance(ball1@left, ball2@right))");
  const Solution direct = Analysis(by_bodies).solve();
  Analysis analysis(m);
  CHECK_THAT(speed(analysis.solve(), "spin"), WithinRel(speed(direct, "spin"), 1e-12));
  m.points.erase(m.points.begin());
  analysis.update(m);
  CHECK_THAT(speed(analysis.solve(), "spin"), WithinRel(speed(direct, "spin"), 1e-12));
}

TEST_CASE("laws by velocities of points", "[torque][places]") {
  // The collar's velocity is the rate of its coordinate, turned round.
  const Solution by_rate = Analysis(governor(by_coordinate + " - 200 N s*rate(slide)")).solve(),
                 by_velocity = Analysis(governor("gain*opening + 200 N s*vy(collar)")).solve();
  CHECK(difference(*by_rate.eigenvalues, *by_velocity.eigenvalues) < 1e-10);
  CHECK(difference(*by_rate.eigenvalues, *Analysis(governor(by_coordinate)).solve().eigenvalues) > 1e-3);
  // A ball goes as fast as the shaft turns, to first order.
  const Solution turning = Analysis(governor("200 N s*(1.2 m/s - rate(spin)*0.16 m*cos(coordinate(arm1)))"))
                               .solve(),
                 moving = Analysis(governor("200 N s*(1.2 m/s - speed(ball1))")).solve();
  REQUIRE(moving.status == Status::converged);
  CHECK_THAT(speed(moving, "spin"), WithinRel(speed(turning, "spin"), 1e-12));
  CHECK_THAT(speed(moving, "spin") * 0.16 * std::cos(value(moving, "arm1")), WithinRel(1.2, 1e-12));
  CHECK(difference(*moving.eigenvalues, *turning.eigenvalues) < 1e-9);
}

TEST_CASE("how laws by places change with the state, against differences", "[torque][places]") {
  Dice dice(5);
  for (const std::string& law : all_laws()) {
    CAPTURE(law);
    const Mechanism m = strung(swinging(law));
    validate(m);
    const System system = compile(m);
    Parameters p;
    bind(system, m, p);
    Eigen::VectorXd q;
    drawn_configuration(system, p, q);
    Eigen::VectorXd step(system.nv);
    for (double& x : step)
      x = dice.between(-0.3, 0.3);
    retract<double>(system, step, q);
    const Eigen::VectorXd none;
    Kinematics<double> k;
    Residual<double> residual;
    Linearization l;
    forward<double>(system, p, q, 0, k);
    evaluate_residual<double>(system, p, q, none, k, residual);
    linearize(system, p, q, none, k, residual, l);
    for (int v = 0; v < system.nv; ++v) {
      const Eigen::VectorXd column = slope([&](Extended h) {
        Configuration<Extended> moved = q.cast<Extended>();
        retract<Extended>(system, h * Configuration<Extended>::Unit(system.nv, v), moved);
        Kinematics<Extended> there;
        Residual<Extended> balance;
        forward<Extended>(system, p, moved, 0, there);
        evaluate_residual<Extended>(system, p, moved, Configuration<Extended>(), there, balance);
        return Configuration<Extended>(balance.f);
      });
      CHECK((l.stiffness.col(v) - column).lpNorm<Eigen::Infinity>() < 1e-10 * (1 + column.norm()));
    }
  }
}

TEST_CASE("laws by places: rates with numbers, eigenvalues and motions about the state", "[torque][places]") {
  std::size_t settled = 0;
  for (const std::string& law : all_laws()) {
    CAPTURE(law);
    Mechanism m = strung(swinging("3 N m - 0.6 N m s*rate(spin) + 0.2*(" + law + ")"));
    for (Joint& each : m.joints)
      for (std::size_t i = 0; i < each.coordinates.size(); ++i)
        if (each.name != "spin") each = dampened(each, 0.5, i);
    for (std::size_t i = 0; i < 3; ++i)
      m.points[0].at[static_cast<int>(i)] += 0.01 * static_cast<double>(i);
    validate(m);
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    for (const std::string address : {"points.tip.0", "bodies.bob.position.0", "joints.hinge.at.1"}) {
      const double at = get_parameter(m, address), h = 1e-5;
      Mechanism asked = m;
      asked.sliders.assign(1, {});
      asked.sliders[0].parameter = address;
      const Solution with_rates = Analysis(asked).solve();
      const Solution above = Analysis(with_parameter(m, address, at + h)).solve(),
                     below = Analysis(with_parameter(m, address, at - h)).solve();
      for (const Sensitivity& x : with_rates.sensitivities)
        for (const Sensitivity::Rate& rate : x.rates) {
          if (x.address != address || !rate.speed) continue;
          const double by_difference = (speed(above, rate.joint) - speed(below, rate.joint)) / (2 * h);
          CHECK(std::abs(rate.value - by_difference) < 1e-6 * (1 + std::abs(by_difference)));
        }
    }
    if (s.stable != true) continue;
    double slowest = 1e9;
    for (const Complex x : *s.eigenvalues)
      slowest = std::min(slowest, -x.real());
    SimulationOptions options;
    options.duration = std::log(1e6) / slowest;
    options.rate = 1;
    options.tolerance = 1e-8; // a thousandth of how near it is to come
    options.at = {{"hinge", value(s, "hinge") + 0.05}};
    const Run run = simulate(m, options);
    REQUIRE(run.status == RunStatus::completed);
    CAPTURE(slowest);
    CHECK(distance_from(run, run.time.size() - 1, s) < 1e-5);
    ++settled;
  }
  CHECK(settled > 10);
}

TEST_CASE("laws by forces of springs answer as those by what these follow from",
          "[torque][places][springs]") {
  // The collar's spring: 1000 N/m from 0.15 m. Free of load it is slack.
  const Mechanism direct = governor(by_coordinate);
  const Solution wanted = Analysis(direct).solve();
  SimulationOptions options;
  options.duration = 2;
  options.rate = 4;
  options.at = {{"slide", 0.14}};
  const Run motion = simulate(direct, options);
  const auto same = [&](const Mechanism& m) {
    validate(m);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(speed(wanted, "spin"), 1e-12));
    CHECK(difference(*s.eigenvalues, *wanted.eigenvalues) < 1e-9);
    CHECK(s.stable == true);
    const Run moved = simulate(m, options);
    REQUIRE(moved.status == RunStatus::completed);
    for (std::size_t c = 0; c < moved.coordinates.size(); ++c)
      for (std::size_t i = 0; i < moved.time.size(); ++i)
        CHECK(std::abs(moved.coordinates[c].value[i] - motion.coordinates[c].value[i]) < 1e-6);
  };
  same(governor("gain*spring(slide)/(-1000 N/m)"));
  Mechanism by_law = governor("gain*spring(slide)/(-1000 N/m)");
  for (Joint& joint : by_law.joints)
    if (joint.name == "slide") {
      joint.coordinates[0].spring->stiffness = 0;
      joint.coordinates[0].spring->force = 0;
      joint.formulas.push_back({"spring.force", "1000 N/m*deflection"});
    }
  same(by_law);
  // A spring of no stiffness to speak of, stretched along the axis: its length is 0.5 m less the way up.
  // Its other end lies below.
  for (const bool table : {false, true})
    for (const std::string of : {"tension(feeler)", "force_y(feeler)", "force(feeler)"}) {
      CAPTURE(of, table);
      Mechanism m = governor("gain*(" + of + "/(1e-9 N/m) + 0.1 m - 0.15 m)");
      m.forces.push_back(point_spring("feeler", "spindle", "collar", {0, 0.2, 0}, {0, 0.1256, 0}, 1e-9, 0.1));
      if (table) {
        m.forces.back().stiffness = 0;
        m.forces.back().force = 0;
        m.forces.back().formulas.push_back({"force", "table(deflection, [-1 m, -1e-9 N], [1 m, 1e-9 N])"});
      }
      same(m);
    }
}

TEST_CASE("a damper in what a law asks for is felt in motion alone", "[torque][places][springs]") {
  // tension = k (s - free) + c s' of the spring along the axis.
  Mechanism m = governor("");
  m.forces.push_back(point_spring("feeler", "spindle", "collar", {0, 0.2, 0}, {0, 0.1256, 0}, 50, 0.1));
  m.forces.back().damping = 4;
  const Mechanism by_force = with_torque(m, "150 m*(tension(feeler) - 2.5 N)"),
                  by_rate =
                      with_torque(m, "150 m*(50 N/m*(coordinate(slide) - 0.15 m) + 4 N s/m*rate(slide))");
  const Solution a = Analysis(by_force).solve(), b = Analysis(by_rate).solve();
  CHECK_THAT(speed(a, "spin"), WithinRel(speed(b, "spin"), 1e-12));
  CHECK(difference(*a.eigenvalues, *b.eigenvalues) < 1e-9);
  CHECK(
      difference(*a.eigenvalues,
                 *Analysis(with_torque(m, "150 m*50 N/m*(coordinate(slide) - 0.15 m)")).solve().eigenvalues) >
      1e-3);
  SimulationOptions options;
  options.duration = 2;
  options.rate = 4;
  options.at = {{"slide", 0.14}};
  const Run one = simulate(by_force, options), other = simulate(by_rate, options);
  for (std::size_t c = 0; c < one.coordinates.size(); ++c)
    for (std::size_t i = 0; i < one.time.size(); ++i)
      CHECK(std::abs(one.coordinates[c].value[i] - other.coordinates[c].value[i]) < 1e-6);
  const LinearModel model = linearize(by_force, std::vector<std::string>{"forces.feeler.damping"},
                                      std::vector<std::string>{"slide"}, {});
  CHECK(model.refusal.empty());
}

TEST_CASE("a shaft braked by what its bearing bears", "[torque][places][bearings]") {
  // A mass m on a radial slide, held by a bearing of stiffness k, e off the axis as drawn: k x = m w^2 (e +
  // x), and friction of the coefficient f at the radius r of what the bearing bears: T = c w + f r k x.
  const double mass = 2, k = 5000, e = 0.05, drag = 0.3, torque = 8, arm = 0.02;
  const auto rotor = [&](const std::string& load, double damping) {
    Mechanism m;
    m.bodies = {body("shaft", 1, {0, 0, 0}, {0.1, 0.1, 0.1}), body("mass", mass, {e, 0, 0})};
    m.joints = {dampened(revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 1, 0}), drag),
                prismatic("slide", "shaft", "mass", {e, 0, 0}, {1, 0, 0})};
    m.joints[0] = torque_driven(m.joints[0], 5, "8", load);
    m.forces = {
        bearing("held", "shaft", "mass", {e, 0, 0}, {0, 1, 0}, {k, 0, 0, k}, {damping, 0, 0, damping})};
    validate(m);
    return m;
  };
  const Solution s = Analysis(rotor("0.02 m*force(held)", 0)).solve();
  REQUIRE(s.status == Status::converged);
  const double w = speed(s, "spin"), x = mass * w * w * e / (k - mass * w * w);
  CHECK_THAT(value(s, "slide"), WithinRel(x, 1e-12));
  CHECK_THAT(drag * w + arm * k * x, WithinRel(torque, 1e-12));
  // In motion with what it damps, as by the slide's coordinate and rate.
  const Mechanism by_force = rotor("0.02 m*force(held)", 40),
                  by_slide = rotor("0.02 m*(5000 N/m*coordinate(slide) + 40 N s/m*rate(slide))", 40);
  const Solution a = Analysis(by_force).solve(), b = Analysis(by_slide).solve();
  CHECK_THAT(speed(a, "spin"), WithinRel(speed(b, "spin"), 1e-12));
  CHECK(difference(*a.eigenvalues, *b.eigenvalues) < 1e-9 * k);
  CHECK(difference(*a.eigenvalues,
                   *Analysis(rotor("0.02 m*5000 N/m*coordinate(slide)", 40)).solve().eigenvalues) > 1e-3);
  SimulationOptions options;
  options.duration = 2;
  options.rate = 4;
  const Run one = simulate(by_force, options), other = simulate(by_slide, options);
  for (std::size_t c = 0; c < one.coordinates.size(); ++c)
    for (std::size_t i = 0; i < one.time.size(); ++i)
      CHECK(std::abs(one.coordinates[c].value[i] - other.coordinates[c].value[i]) < 1e-6);
  // Just where it begins to bear something its size has a kink.
  const Solution still = Analysis([&] {
                           Mechanism m = rotor("0.02 m*force(held)", 0);
                           m.bodies[1].position = Vec3::Zero();
                           m.joints[1].at = m.forces[0].at.emplace(Vec3::Zero());
                           return m;
                         }())
                             .solve();
  CHECK_THAT(still.message, ContainsSubstring("kink") && ContainsSubstring("force(held)"));
}

TEST_CASE("what a law asks for must not turn with the drives", "[torque][places]") {
  for (const char* law : {"gain*x(ball1)", "gain*distance(ball1, ground@aside)", "1 N s*vx(ball1)",
                          "gain*z(spindle@aside)", "1 N m*angle(ball1, collar, ground@aside)"}) {
    CAPTURE(law);
    CHECK_THAT(refusal(governor(law)),
               ContainsSubstring("joints.spin.drive.torque") &&
                   ContainsSubstring("expected what stays as it is while drives turn"));
    CHECK_THROWS_AS(simulate(governor(law), {}), SceneError);
  }
  CHECK_THAT(
      refusal(governor("1 N m*angle(ball1, ground@top, spindle)")),
      ContainsSubstring("expected an angle between two arms, found angle(ball1, ground@top, spindle), of "
                        "which one end stands where its corner does"));
  for (const char* law : {"gain*x(collar)", "gain*distance(ball1, ground@top)", "1 N s*speed(ball1)",
                          "1 N m*angle(ball1, collar, ground@top)", "gain*distance(ball1, collar)"}) {
    CAPTURE(law);
    CHECK(refusal(governor(law)).empty());
  }
  // What holds the shaft bears the same at all phases, what holds a ball beside it does not; on the shaft
  // that turns it does.
  const auto held = [](const std::string& of, const std::string& by) {
    Mechanism m = governor("1 m*force_y(seat) - 0.1 m*force(seat)");
    m.forces.push_back(bearing("seat", by, of, of == "collar" ? Vec3(0, 0.05, 0) : Vec3(0.16, 0.1, 0),
                               {1, 0, 0}, {10, 0, 0, 10}, {}));
    return m;
  };
  CHECK(refusal(held("collar", "spindle")).empty());
  CHECK(refusal(held("ball1", "spindle")).empty());
  CHECK_THAT(refusal(governor("0.1 m*force(seat)")), ContainsSubstring("no force is called"));
  CHECK_THAT(refusal(held("ball1", "ground")), ContainsSubstring("force(seat), which changes with them"));
  // A shaft that leans turns heights, too.
  Mechanism leaning = governor("gain*y(ball1)");
  for (Joint& joint : leaning.joints)
    if (joint.name == "spin") joint.axis = {0.1, 1, 0};
  CHECK_THAT(refusal(leaning), ContainsSubstring("y(ball1), which changes with them"));
}

TEST_CASE("a slow start is not answered beyond the toggle of a governor", "[torque][places]") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  const double hinge = 0.0457, out = 0.12870976719356084, height = 0.33511659103939284,
               low = 0.15519255600627;
  m.bodies = {body("shaft", 3, {0, 0.2, 0}, {0.2, 0.2225, 0.2}), body("sleeve", 1.8424, {0, low, 0})};
  m.joints = {driven(revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 1, 0}), 1)};
  for (const double side : {1., -1.}) {
    const std::string ball = side > 0 ? "ball1" : "ball2", arm = side > 0 ? "arm1" : "arm2";
    m.bodies.push_back(body(ball, 1.3296, {side * out, height, 0}, {0.002, 0.001, 0.002}));
    m.joints.push_back(revolute(arm, "shaft", ball, {side * hinge, 0.5, 0}, {0, 0, side}));
    m.joints.push_back(distance(side > 0 ? "link1" : "link2", ball, "sleeve", {side * out, height, 0},
                                {side * hinge, low, 0}));
  }
  m.joints.push_back(
      dampened(sprung(prismatic("slide", "shaft", "sleeve", {0, low, 0}, {0, 1, 0}), 134.0086), 44.7743));
  m = with_torque(m, "5.76298 N m - 0.6955 N m s*rate(spin) - 11.0099 N*coordinate(slide)");
  validate(m);
  for (const double start : {8.5, 0.0082861, 0.1, 1.}) {
    CAPTURE(start);
    m.joints[0].coordinates[0].drive->speed = start;
    const Solution s = Analysis(m).solve();
    INFO(s.message);
    CHECK_THAT(speed(s, "spin"), WithinRel(8.52988846, 1e-8)); // where the motion settles
    CHECK(std::abs(value(s, "slide") + 0.01540045) < 1e-8);
  }
}

TEST_CASE("forces and accelerations are refused in laws", "[torque][places]") {
  for (const char* law :
       {"1 m*reaction(slide)", "1 kg m*ay(collar)", "1 m^2/s^2*mass(collar)*1", "1 s*power(spin)"}) {
    CAPTURE(law);
    CHECK_THAT(refusal(governor(law)), ContainsSubstring("follow from the balance"));
  }
  CHECK_THAT(refusal(governor("1 m*spring(arm1)")), ContainsSubstring("has no spring"));
  CHECK_THAT(refusal(governor("gain*y(collr)")), ContainsSubstring("no body is called \"collr\""));
  CHECK_THAT(refusal(governor("gain*vy(collar)")), ContainsSubstring("expected N m"));
}

TEST_CASE("kinks of laws by places are told", "[torque][places]") {
  const auto told = [](const std::string& law) {
    const Solution s = Analysis(governor(law)).solve();
    CHECK(s.status == Status::converged);
    return std::pair{s.message, s.stable};
  };
  const auto [message, stable] = told("gain*(0.05 m - y(collar)) - 40 N m*max(0, 1 - y(collar)/(0.05 m))");
  const auto [same, alike] =
      told("gain*(coordinate(slide) - 0.15 m) - 40 N m*max(0, 1 - (0.2 m - coordinate(slide))/(0.05 m))");
  CHECK(stable == alike);
  CHECK_THAT(message, ContainsSubstring("slope with y(collar) jumps from"));
  CHECK_THAT(same, ContainsSubstring("slope with coordinate(slide) jumps from"));
  // What nothing moves is a number, although a distance or speed of zero, and angles of 0 and pi, have no
  // slope.
  for (const char* constant :
       {"gain*opening + 1 N s*speed(spindle)", "gain*opening - 5 N*distance(spindle, ground@top)",
        "gain*opening + 1 N m*(angle(ground@aside, ground@top, ground@beyond) - pi)",
        "gain*opening - 5 N m*max(0, 1 - y(spindle)/(0.2 m))",
        "gain*opening - 1 N*distance(ground@top, ball1)*(angle(ball1, spindle, ball1) + 0)"}) {
    CAPTURE(constant);
    Mechanism m = governor(constant);
    m.points.push_back({"beyond", {-0.3, 0.2, 0}});
    const Solution s = Analysis(m).solve();
    CHECK_THAT(s.message, !ContainsSubstring("kink"));
    CHECK(s.stable == true);
    REQUIRE(s.eigenvalues);
    CHECK(s.stability_reason == StabilityReason::asymptotic);
  }
  // The collar stands on the axis and is at rest: its speed grows whichever way it moves.
  const auto [resting, open] = told("gain*opening - 5 N s*speed(collar)");
  CHECK(open == std::nullopt);
  CHECK_THAT(resting, ContainsSubstring("slope with speed(collar) jumps from"));
}

TEST_CASE("what grows beside the kink of an angle of zero is left for what is stable",
          "[torque][places][kinks]") {
  // A pendulum on a shaft straight below it, which the angle from straight down slows; it moves the angle
  // alone.
  const auto pendulum = [](double torque) {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.points = {{"O", {0, 0, 0}}, {"Q", {0, -1, 0}}};
    m.bodies = {body("h", 1, {0, 0, 0}, {0.3, 0.4, 0.3}),
                body("b", 1, {0.05, -0.3, 0}, {0.001, 0.001, 0.001})};
    m.joints = {driven(revolute("spin", "ground", "h", {0, 0, 0}, {0, 1, 0}), 3),
                dampened(revolute("a", "h", "b", {0, 0, 0}, {0, 0, 1}), 0.2)};
    m = with_torque(m,
                    number_text(torque) + " N m - 1 N m s*rate(spin) - 1 N m*angle(b, ground@O, ground@Q)");
    validate(m);
    return m;
  };
  const double below = -std::atan2(0.05, 0.3);
  SolveOptions nearest;
  nearest.nearest = true;
  const Solution straight = Analysis(pendulum(8)).solve(nearest);
  CHECK(std::abs(value(straight, "a") - below) < 1e-9);
  CHECK(straight.stable == false);
  CHECK_THAT(straight.message, ContainsSubstring("jumps from"));
  const Solution s = Analysis(pendulum(8)).solve();
  INFO(s.message);
  CHECK(s.stable == true);
  const double a = std::abs(value(s, "a") - below), w = speed(s, "spin");
  CHECK_THAT(w, WithinRel(8 - a, 1e-10));
  // (I + m l^2) w^2 sin a cos a = m g l sin a, the sphere's inertia being the same about all axes
  const double arm = std::hypot(0.05, 0.3);
  CHECK_THAT(w * w * arm * std::cos(a), WithinRel(standard_gravity, 1e-10));
  // Slower, where it hangs: a motion that goes to and fro across the kink is not told by either side.
  const Solution hanging = Analysis(pendulum(3)).solve();
  CHECK(hanging.stable == std::nullopt);
}

TEST_CASE("chains throttled by heights, of which the speeds border the tree", "[torque][places]") {
  for (const bool balls : {false, true}) {
    CAPTURE(balls);
    Mechanism m = hanging_chain(20, 6);
    if (balls)
      for (Joint& each : m.joints)
        if (each.name != "spin" && each.name.ends_with("5")) {
          each.type = JointType::spherical;
          each.coordinates.resize(3);
          for (std::size_t i = 0; i < 3; ++i)
            each = sprung(each, 0.1, 0, i);
        }
    const Mechanism prescribed = m;
    const std::string last = m.bodies.back().name;
    const Solution there = Analysis(prescribed).solve();
    REQUIRE(there.status == Status::converged);
    Mechanism measured = prescribed;
    measured.measures.push_back({"h", "", "y(" + argument_text(last) + ")", "m"});
    const double height = Analysis(measured).solve().measures.at(0).value.value();
    m = with_torque(m, "0.5 N*(" + number_text(-height) + " m + y(" + argument_text(last) +
                           ")) - 0.2 N m s*(rate(spin) - 6)");
    m.joints[0].coordinates[0].drive->speed = 5.9;
    validate(m);
    CHECK(compile(m).kkt_form == KktForm::tree);
    SolveOptions options;
    options.nearest = true;
    for (const CoordinateSolution& x : there.coordinates)
      if (!x.driven) options.start.emplace_back(coordinate_label(x), x.value);
    const Solution s = Analysis(m).solve(options);
    INFO(s.message);
    REQUIRE(s.status == Status::converged);
    CHECK_THAT(speed(s, "spin"), WithinRel(6, 1e-9));
    CHECK(s.iterations < 10);
  }
}

TEST_CASE("random mechanisms throttled by distances and heights settle where they are found",
          "[torque][places][random]") {
  int found = 0, moved = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Mechanism prescribed = reference::random_sprung_mechanism(seed);
    if (prescribed.bodies.size() < 2) continue;
    const std::string a = argument_text(prescribed.bodies[0].name),
                      b = argument_text(prescribed.bodies.back().name);
    prescribed.measures = {{"d", "", "distance(" + a + ", " + b + ")", "m"},
                           {"h", "", "y(" + b + ")", "m"},
                           {"v", "", "speed(" + b + ")", "m/s"}};
    const Solution there = Analysis(prescribed).solve();
    if (there.status != Status::converged || there.drive_torques.size() != 1 ||
        there.drive_torques[0].varying || there.neutral.size() > 0)
      continue;
    const DriveTorque& torque = there.drive_torques[0];
    for (std::size_t which = 0; which < 3; ++which) {
      CAPTURE(which);
      Mechanism m = prescribed;
      Joint& driver = m.joints[static_cast<std::size_t>(joint_index(m, torque.joint))];
      Coordinate& c = driver.coordinates[static_cast<std::size_t>(torque.index)];
      const double wanted = c.drive->speed;
      if (wanted == 0 || !there.measures[which].value) continue;
      const std::string name = coordinate_name(driver, torque.index);
      const double slope = 1 + std::abs(torque.value / wanted);
      c.drive->torque = 0;
      const std::string index = torque.count > 1 ? "." + std::to_string(torque.index) : "";
      const auto number = [](double x) { return "(" + number_text(x) + ")"; };
      const char* unit = std::array{"N", "N", "N s"}[which];
      driver.formulas.push_back(
          {"drive" + index + ".torque", number(torque.value) + " - " + number(slope) + " * 1 N m s*(rate(" +
                                            name + ") - " + number(wanted) + ") + " + number(0.3 * slope) +
                                            " * 1 " + unit + "*(" + prescribed.measures[which].name + " - " +
                                            number(*there.measures[which].value) + ")"});
      c.drive->speed = 0.97 * wanted;
      if (!refusal(m).empty()) continue; // it turns
      SolveOptions nearest;
      nearest.nearest = true;
      for (const CoordinateSolution& x : there.coordinates)
        if (!x.driven && !x.dependent) nearest.start.emplace_back(coordinate_label(x), x.value);
      const Solution s = Analysis(m).solve(nearest);
      INFO(s.message);
      if (s.status != Status::converged) continue; // the throttle may leave no state so near
      const double speed_found = coordinate(s, torque.joint, torque.index).speed.value();
      if (std::abs(speed_found / wanted - 1) > 1e-3) continue; // another steady speed lies close
      ++found;
      CHECK_THAT(speed_found, WithinRel(wanted, 1e-9));
      CHECK(s.at_constant_speed->stable == there.stable);
      if (s.stable != true || !s.eigenvalues || moved >= 6) continue;
      double slowest = 1e9;
      for (const Complex x : *s.eigenvalues)
        slowest = std::min(slowest, -x.real());
      if (!(slowest > 0.2)) continue;
      ++moved;
      SimulationOptions run;
      run.duration = std::log(1e7) / slowest;
      run.rate = 2 / run.duration;
      for (const CoordinateSolution& x : there.coordinates)
        if (!x.driven && !x.dependent) run.at.emplace_back(coordinate_label(x), x.value);
      const Run motion = simulate(m, run);
      REQUIRE(motion.status == RunStatus::completed);
      CHECK(distance_from(motion, motion.time.size() - 1, s) < 1e-5);
    }
  }
  CAPTURE(found, moved);
  CHECK(found > 30);
  CHECK(moved > 4);
}
