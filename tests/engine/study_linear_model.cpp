// Linear models against closed forms and against `solve`; and what has none.
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/engine/coupled_shafts.hpp"
#include "tests/engine/linear_models.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Complex = std::complex<double>;

namespace {

std::string refusal(const Mechanism& m, const Names& inputs, const Names& outputs) {
  return linearize(m, inputs, outputs).refusal;
}

constexpr double g = standard_gravity;

} // namespace

TEST_CASE("of joints that slip the linear model is that without their hold", "[linear-model]") {
  const Mechanism free = shipped("governor");
  const Names inputs{"joints.spin.drive.speed"}, outputs{"slide"};
  const auto rubbing = [&](double share) {
    Mechanism m = free;
    for (Joint& joint : m.joints)
      if (joint.name == "slide") joint.coordinates[0].friction = Friction{.limit = 3, .share = share};
    return m;
  };
  CHECK(linear_model(rubbing(0), inputs, outputs).states.empty()); // which friction holds
  LinearModelOptions options;
  options.slipping = true;
  const LinearModel slips = linearize(rubbing(0), inputs, outputs, options),
                    without = linear_model(free, inputs, outputs);
  REQUIRE(slips.refusal.empty());
  REQUIRE(slips.poles.size() == without.poles.size());
  for (std::size_t i = 0; i < slips.poles.size(); ++i)
    CHECK(std::abs(slips.poles[i] - without.poles[i]) < 1e-9);
  const Complex s(0.1, 4);
  check_transfer(slips, 0, 0, s, (*transfer(without.descriptor, s))(0, 0));
  // A share is a force of the state: its model is about another place, as its eigenvalues are.
  const LinearModel pushed = linearize(rubbing(0.5), inputs, outputs, options);
  REQUIRE(pushed.steady.eigenvalues);
  REQUIRE(pushed.poles.size() == pushed.steady.eigenvalues->size());
  for (std::size_t i = 0; i < pushed.poles.size(); ++i)
    CHECK(std::abs(pushed.poles[i] - (*pushed.steady.eigenvalues)[i]) < 1e-9);
  CHECK(std::abs(pushed.poles[0] - without.poles[0]) > 1e-6);
}

TEST_CASE("a pendulum on a spindle has the transfer functions of its equation", "[linear-model]") {
  const double length = 0.7, offset = 0.2, w = 5.3, mass = 1.4, c = 0.9;
  Mechanism m = conical(length, offset, w, 0.8, mass);
  const std::string hinge = m.joints[1].name, ball = m.bodies[1].name;
  m.joints[1].coordinates[0].damping = c;
  const LinearModel model = linear_model(
      m, {"torque(" + hinge + ")", "joints.spin.drive.speed", "gravity.1", "bodies." + ball + ".mass"},
      {hinge, "rate(" + hinge + ")", "y(" + ball + ")"});
  const double a = model.outputs[0].value, sine = std::sin(a), cosine = std::cos(a),
               inertia = mass * length * length;
  // L^2 m a'' = m L cos(a) w^2 (offset + L sin(a)) - m g L sin(a) - c a' + torque
  const double k =
      mass * length * (w * w * (sine * (offset + length * sine) - length * cosine * cosine) + g * cosine);
  REQUIRE(model.states.size() == 2);
  CHECK(model.states[0].name == hinge);
  CHECK(model.states[1].unit == "rad/s");
  CHECK(model.explicit_form);
  for (const double omega : {0., 0.4, 3., 40.}) {
    const Complex s(0, omega), d = inertia * s * s + c * s + k;
    const double by_speed = mass * length * cosine * 2 * w * (offset + length * sine);
    check_transfer(model, 0, 0, s, 1. / d);
    check_transfer(model, 0, 1, s, by_speed / d);
    check_transfer(model, 0, 2, s, mass * length * sine / d); // gravity.1 is -g
    if (omega > 0) check_transfer(model, 1, 1, s, s * by_speed / d);
    // Heights grow by L sin(a) with the angle.
    check_transfer(model, 2, 0, s, length * sine / d);
    const auto none = transfer(best_form(model), s);
    CHECK(std::abs((*none)(0, 3)) < 1e-12);
  }
  REQUIRE(model.poles.size() == 2);
  for (const Complex s : model.poles)
    CHECK(std::abs(inertia * s * s + c * s + k) < 1e-11 * std::abs(k));
  CHECK(zeros(*model.explicit_form, 0, 0)->empty());
  const auto at_zero = zeros(*model.explicit_form, 0, 1);
  REQUIRE(at_zero);
  REQUIRE(at_zero->size() == 1);
  CHECK(std::abs(at_zero->front()) < 1e-11);
}

TEST_CASE("the speed of a drive enters with its rate where it accelerates what it carries",
          "[linear-model]") {
  // An arm of length L, hinged about the spindle's direction at R from its axis, held by a spring:
  // m (L^2 + R L cos(f)) w' + m L^2 f'' + m R L w^2 sin(f) + c f' + k f = 0, f = 0 in the steady state.
  const double length = 0.3, radius = 0.5, w = 7, mass = 2, c = 0.4, k = 11;
  Mechanism m;
  m.gravity = {0, -g, 0};
  m.bodies = {spindle(), body("bob", mass, {radius + length, 0, 0})};
  m.joints = {spin(w),
              dampened(sprung(revolute("hinge", "spindle", "bob", {radius, 0, 0}, {0, 1, 0}), k), c)};
  const LinearModel model =
      linear_model(m, {"joints.spin.drive.speed", "torque(hinge)"}, {"hinge", "rate(hinge)", "rate(spin)"});
  CHECK(model.states[1].less_input);
  for (const double omega : {0.3, 2., 9., 60.}) {
    const Complex s(0, omega),
        d = mass * length * length * s * s + c * s + k + mass * radius * length * w * w;
    const Complex by_speed = -mass * (length * length + radius * length) * s / d;
    check_transfer(model, 0, 0, s, by_speed);
    check_transfer(model, 1, 0, s, s * by_speed);
    check_transfer(model, 2, 0, s, 1);
    check_transfer(model, 0, 1, s, 1. / d);
  }
  // The drive's torque feels the acceleration itself, and the rate of the slide that of a length.
  CHECK_THAT(refusal(m, {"joints.spin.drive.speed"}, {"torque(spin)"}), ContainsSubstring("feels the rate"));
  const LinearModel torque = linear_model(m, {"torque(hinge)"}, {"torque(spin)", "moment_y(spin)"});
  for (const double omega : {0.3, 9.}) {
    // By the momentum about the axis: m ((R + L)^2 w + (L^2 + R L) f').
    const Complex s(0, omega),
        d = mass * length * length * s * s + c * s + k + mass * radius * length * w * w;
    check_transfer(torque, 0, 0, s, mass * (length * length + radius * length) * s * s / d, 1e-9);
    check_transfer(torque, 1, 0, s, mass * (length * length + radius * length) * s * s / d, 1e-9);
  }
}

TEST_CASE("the length of a rod is an input whose rates enter", "[linear-model]") {
  // A slider of mass m on the x axis, pushed by a rod of variable length from a slider of mass M that springs
  // and dampers hold: x2 = x1 + l, so (m + M) x1'' + c x1' + c2 (x1 + l)' + k x1 + k2 (x1 + l) + m l'' = 0.
  const double m1 = 1.7, m2 = 0.6, c1 = 0.8, c2 = 0.3, k1 = 40, k2 = 25;
  Mechanism m;
  m.bodies = {body("first", m1, {0, 0, 0}), body("second", m2, {0.5, 0, 0})};
  m.joints = {dampened(sprung(prismatic("x1", "ground", "first", {0, 0, 0}, {1, 0, 0}), k1), c1),
              dampened(sprung(prismatic("x2", "ground", "second", {0.5, 0, 0}, {1, 0, 0}), k2), c2),
              distance("rod", "first", "second", {0, 0, 0}, {0.5, 0, 0}, 0.5)};
  const LinearModel model = linear_model(m, {"joints.rod.length", "force_x(first)"}, {"x1", "x2"});
  for (const double omega : {0.5, 4., 30.}) {
    const Complex s(0, omega), d = (m1 + m2) * s * s + (c1 + c2) * s + k1 + k2;
    check_transfer(model, 0, 0, s, -(m2 * s * s + c2 * s + k2) / d);
    check_transfer(model, 1, 0, s, (m1 * s * s + c1 * s + k1) / d);
    check_transfer(model, 0, 1, s, 1. / d);
  }
  CHECK_THAT(refusal(m, {"joints.rod.length"}, {"rate(x2)"}), ContainsSubstring("feels the rate"));
}

TEST_CASE("poles are the eigenvalues that solving tells, and the static gain the sensitivities",
          "[linear-model]") {
  int compared = 0;
  for (const char* name :
       {"governor", "governor_engine", "pendulum", "watt_governor", "fourbar_turntable", "rate_gyro",
        "governor_bearing", "governor_hartnell", "governor_parametric", "governor_watt"}) {
    CAPTURE(name);
    const Mechanism m = shipped(name);
    const Solution steady = Analysis(m).solve();
    REQUIRE(steady.status == Status::converged);
    Names outputs;
    for (const CoordinateSolution& c : steady.coordinates)
      if (is_found(c)) {
        const std::string label = c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index);
        outputs.push_back(c.speed ? "rate(" + label + ")" : label);
      }
    for (const Sensitivity& slider : steady.sensitivities) {
      CAPTURE(slider.address);
      const LinearModel model = linearize(m, Names{slider.address}, outputs);
      if (!model.refusal.empty()) { // it places parts
        CHECK_THAT(model.refusal, ContainsSubstring("places parts"));
        continue;
      }
      REQUIRE(model.explicit_form);
      const Eigen::VectorXcd found =
          Eigen::EigenSolver<Eigen::MatrixXd>(model.explicit_form->a, false).eigenvalues();
      REQUIRE(steady.eigenvalues);
      REQUIRE(static_cast<std::size_t>(found.size()) == steady.eigenvalues->size());
      double size = 0;
      for (const Complex s : *steady.eigenvalues)
        size = std::max(size, std::abs(s));
      for (std::size_t i = 0; i < model.poles.size(); ++i) {
        CHECK(std::abs(model.poles[i] - (*steady.eigenvalues)[i]) < 1e-9 * size);
        double nearest = size;
        for (const Complex s : found)
          nearest = std::min(nearest, std::abs(s - (*steady.eigenvalues)[i]));
        CHECK(nearest < 1e-9 * size);
      }
      REQUIRE(model.gain);
      double largest = 0;
      for (const Sensitivity::Rate& rate : slider.rates)
        largest = std::max(largest, std::abs(rate.value));
      std::size_t matched = 0;
      for (const Sensitivity::Rate& rate : slider.rates) {
        std::string label = rate.count == 1 ? rate.joint : rate.joint + "." + std::to_string(rate.index);
        if (rate.speed) label = "rate(" + label + ")";
        const auto at = std::ranges::find(outputs, label);
        if (at == outputs.end()) continue;
        ++matched;
        CHECK(std::abs((*model.gain)(at - outputs.begin(), 0) - rate.value) <= 1e-10 * largest);
      }
      CHECK(matched > 0);
      ++compared;
    }
  }
  CHECK(compared > 10);
}

TEST_CASE("an engine's governor by torques, and the shaft's angle where it is asked for", "[linear-model]") {
  const Mechanism m = shipped("governor_engine");
  const LinearModel model = linear_model(m, {"torque(spin)", "torque(slide)"}, {"rate(spin)", "slide"});
  CHECK(model.states.size() == 3);
  CHECK(model.states[0].name != "spin");
  LinearModelOptions phases;
  phases.phases = true;
  const LinearModel whole = linear_model(m, {"torque(spin)"}, {"rate(spin)", "coordinate(spin)"}, phases);
  CHECK(whole.states.size() == 4);
  CHECK_FALSE(whole.gain);
  CHECK(std::abs(whole.poles.front()) < 1e-9);
  // Outputs that are states are exactly so.
  const auto expect_state = [](const LinearModel& of, Eigen::Index output, const std::string& name) {
    for (const Eigen::MatrixXd& c : {of.descriptor.c, of.explicit_form->c})
      for (Eigen::Index s = 0; s < c.cols(); ++s)
        CHECK(c(output, s) == (of.states[static_cast<std::size_t>(s)].name == name ? 1 : 0));
  };
  expect_state(model, 0, "spin.rate");
  expect_state(whole, 0, "spin.rate");
  expect_state(whole, 1, "spin");
  const auto h = transfer(*whole.explicit_form, {0, 1.3});
  CHECK(std::abs((*h)(0, 0) - (*h)(1, 0) * Complex(0, 1.3)) < 1e-12 * std::abs((*h)(0, 0)));
  CHECK(std::abs((*h)(0, 0) - (*transfer(*model.explicit_form, {0, 1.3}))(0, 0)) <
        1e-12 * std::abs((*h)(0, 0)));
  CHECK_THAT(refusal(m, {"torque(spin)"}, {"coordinate(spin)"}), ContainsSubstring("without end"));
  Mechanism geared = m; // and what turns with it
  geared.bodies.push_back(body("fan", 1, {1, 0, 0}, {0.1, 0.1, 0.1}));
  geared.joints.push_back(revolute("fan", "ground", "fan", {1, 0, 0}, {0, 1, 0}));
  geared.joints.push_back(gear("belt", "spin", "fan", 2));
  validate(geared);
  CHECK_THAT(refusal(geared, {"torque(spin)"}, {"coordinate(fan)"}), ContainsSubstring("without end"));
}

TEST_CASE("what has no linear model is refused with the reason", "[linear-model]") {
  const Mechanism governor = shipped("governor");
  CHECK_THAT(refusal(governor, {"bodies.ball1.position.0"}, {"slide"}), ContainsSubstring("places parts"));
  CHECK_THAT(refusal(governor, {"joints.link1.points.0.0"}, {"slide"}), ContainsSubstring("places parts"));
  CHECK_THAT(refusal(governor, {"force_x(ball1)"}, {"slide"}), ContainsSubstring("every phase"));
  CHECK_THAT(refusal(governor, {"torque(slide)"}, {"x(ball1)"}), ContainsSubstring("every phase"));
  CHECK_THAT(refusal(governor, {"torque(slide)"}, {"coordinate(spin)"}), ContainsSubstring("every phase"));
  CHECK_THAT(refusal(governor, {"torque(spin)"}, {"slide"}), ContainsSubstring("prescribed"));
  CHECK(refusal(governor, {"force_y(ball1)"}, {"slide", "y(ball1)", "ay(collar)", "speed(ball1)"}).empty());
  CHECK_THROWS_AS(refusal(governor, {"joints.nothing.damping"}, {"slide"}), SceneError);
  CHECK_THROWS_AS(refusal(governor, {"torque(nothing)"}, {"slide"}), SceneError);
  CHECK_THROWS_AS(refusal(governor, {"force_x(nothing)"}, {"slide"}), SceneError);
  CHECK_THROWS_AS(refusal(governor, {"torque(slide)"}, {"nothing"}), SceneError);
  CHECK_THROWS_AS(refusal(governor, {"torque(slide)", "torque(slide)"}, {"slide"}), SceneError);
  for (const char* output : {"ball.free.0", "coordinate(ball.free.0)", "coordinate('ball.free'.0)"})
    CHECK_THROWS_WITH(refusal(shipped("ball_on_string"), {"gravity.1"}, {output}),
                      ContainsSubstring("a joint of the type free"));
  CHECK_THAT(refusal(stored_case("no_equilibrium"), {"gravity.1"}, {"h"}), !ContainsSubstring("phase of"));
  CHECK_THAT(refusal(stored_case("parametric_rotor"), {"gravity.1"}, {"mass()"}),
             ContainsSubstring("turns with the drives"));
}

TEST_CASE("the size of a vector that vanishes is no output, unless it stays so", "[linear-model]") {
  const Mechanism engine = shipped("governor_engine");
  const Names mass{"bodies.ball1.mass"};
  CHECK_THAT(refusal(engine, mass, {"reaction(slide)"}), ContainsSubstring("kink"));
  CHECK_THAT(refusal(engine, mass, {"moment(arm1)"}), ContainsSubstring("kink"));
  // The spring's force belongs to it, and is slack at this load alone.
  CHECK_THAT(refusal(engine, {"joints.spin.drive.load"}, {"reaction(slide)"}), ContainsSubstring("kink"));
  const LinearModel loaded = linear_model(shipped("governor_engine", {{"joints.spin.drive.load", 1}}),
                                          {"joints.spin.drive.load"}, {"reaction(slide)"});
  CHECK((*loaded.gain)(0, 0) == Approx(1000. / 7500).epsilon(1e-9));
  const LinearModel none = linear_model(shipped("governor"), {"gravity.1"}, {"moment(slide)"});
  CHECK(none.gain->isZero(0));
  Mechanism still;
  still.bodies = {body("bob", 2, {0, 0, 0})};
  still.joints = {dampened(sprung(prismatic("slide", "ground", "bob", {0, 0, 0}, {1, 0, 0}), 50), 3)};
  CHECK_THAT(refusal(still, {"force_x(bob)"}, {"speed(bob)"}), ContainsSubstring("kink"));
  CHECK(refusal(still, {"force_x(bob)"}, {"vx(bob)"}).empty());
}

TEST_CASE("bodies without mass leave E singular", "[linear-model]") {
  // A massless slider between a spring to ground and one, with a damper, to a mass.
  const double k1 = 30, k2 = 70, c2 = 2, mass = 1.5, c1 = 0.6;
  Mechanism m;
  m.bodies = {body("light", 0, {0, 0, 0}), body("heavy", mass, {0.5, 0, 0})};
  m.joints = {dampened(sprung(prismatic("x1", "ground", "light", {0, 0, 0}, {1, 0, 0}), k1), c1),
              dampened(sprung(prismatic("x2", "light", "heavy", {0.5, 0, 0}, {1, 0, 0}), k2), c2)};
  const LinearModel model = linear_model(m, {"torque(x2)"}, {"x1", "x(heavy)"});
  CHECK_FALSE(model.explicit_form);
  for (const double omega : {0.5, 3., 20.}) {
    // T on x2, f = T - (c2 s + k2) X2 what it leaves of it: (c1 s + k1) X1 = -f, mass s^2 (X1 + X2) = f.
    const Complex s(0, omega), z1 = c1 * s + k1, z2 = c2 * s + k2;
    const Complex f = (mass * s * s / z2) / (1. + mass * s * s * (1. / z1 + 1. / z2));
    check_transfer(model, 0, 0, s, -f / z1, 1e-9);
    check_transfer(model, 1, 0, s, -f / z1 + (1. - f) / z2, 1e-9);
  }
  CHECK(model.poles.size() == 3);
  CHECK_THAT(refusal(m, {"torque(x2)"}, {"ax(light)"}), ContainsSubstring("without mass"));
}

TEST_CASE("the angle of a shaft is no pole beside bodies without mass", "[linear-model]") {
  Mechanism m = shipped("governor_engine");
  const LinearModel without = linear_model(m, {"torque(spin)"}, {"slide"});
  m.bodies.push_back(body("light", 0, {0.1, 0.3, 0}));
  m.joints.push_back(dampened(sprung(prismatic("along", "spindle", "light", {0.1, 0.3, 0}, {0, 1, 0}), 100),
                              1)); // a pole at -100
  const LinearModel model = linear_model(m, {"torque(spin)"}, {"slide"});
  REQUIRE(model.states.size() == 5);
  REQUIRE(model.poles.size() == without.poles.size() + 1);
  const auto nearest = [&](Complex to) {
    double out = 1e300;
    for (const Complex pole : model.poles)
      out = std::min(out, std::abs(pole - to));
    return out;
  };
  CHECK(nearest(-100) < 1e-9);
  for (const Complex pole : without.poles)
    CHECK(nearest(pole) < 1e-9);
}

TEST_CASE("what is far lighter than the rest costs no digits of it", "[linear-model]") {
  // x1 of the light body, x2 of the heavy one against it.
  const double heavy = 2, k1 = 30, c1 = 1, k2 = 50, c2 = 0.5;
  for (const double light : {1e-3, 1e-6, 1e-9, 1e-10, 1e-12, 1e-14}) {
    CAPTURE(light);
    Mechanism m;
    m.bodies = {body("light", light, {0, 0, 0}), body("heavy", heavy, {1, 0, 0})};
    m.joints = {dampened(sprung(prismatic("x1", "ground", "light", {0, 0, 0}, {1, 0, 0}), k1), c1),
                dampened(sprung(prismatic("x2", "light", "heavy", {1, 0, 0}, {1, 0, 0}), k2), c2)};
    const LinearModel model = linear_model(m, {"torque(x1)", "torque(x2)"}, {"x1", "x2"});
    CHECK(model.explicit_form.has_value() == (light > 1e-8));
    REQUIRE(model.gain);
    CHECK((*model.gain - Eigen::Matrix2d{{1 / k1, 0}, {0, 1 / k2}}).norm() < 1e-10);
    const auto characteristic = [&](Complex s) {
      return (light * s * s + c1 * s + k1) * (heavy * s * s + c2 * s + k2) + heavy * s * s * (c2 * s + k2);
    };
    int slow = 0;
    for (const Complex s : model.poles) {
      if (std::abs(s) > 1e3) continue; // of the light body alone
      ++slow;
      const Complex step = 1e-4 * s,
                    slope = (characteristic(s + step) - characteristic(s - step)) / (2. * step);
      CHECK(std::abs(characteristic(s) / slope) < 1e-9 * std::abs(s));
    }
    CHECK(slow == 3);
  }
}

TEST_CASE("what moves nothing is borne all the same", "[linear-model]") {
  // A force and a torque on a governor's spindle, which its drive and its bearing take.
  Mechanism m = shipped("governor");
  Force& torque = m.forces.emplace_back();
  torque.name = "twist";
  torque.type = ForceType::torque;
  torque.body = "spindle";
  const LinearModel model = linear_model(m, {"force_y(spindle)", "forces.twist.vector.1"},
                                         {"slide", "reaction_y(spin)", "torque(spin)"});
  REQUIRE(model.gain);
  CHECK((*model.gain - Eigen::MatrixXd{{0, 0}, {-1, 0}, {0, -1}}).norm() < 1e-9);
  // Of bodies without mass the spring alone takes it.
  Mechanism light;
  light.bodies = {body("block", 0, {0, 0, 0})};
  light.joints = {dampened(sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), 30), 2)};
  const LinearModel massless = linear_model(light, {"force_x(block)"}, {"x", "reaction_x(x)"});
  REQUIRE(massless.gain);
  CHECK((*massless.gain - Eigen::Vector2d(1. / 30, -1)).norm() < 1e-9);
}

TEST_CASE("loops that hold nothing leave the coordinates free", "[linear-model]") {
  // A door on two hinges of one axis: every row of the second says what the first says.
  const LinearModel model =
      linear_model(stored_case("reactions_nonunique_by_joint"), {"torque(p1)"}, {"p1", "p2"});
  CHECK(model.states.size() == 4);
  REQUIRE(model.gain);
  CHECK((*model.gain)(0, 0) > 0);
  CHECK((*model.gain)(1, 0) == Approx((*model.gain)(0, 0)).epsilon(1e-11));
}

TEST_CASE("a shaft left to itself has the transfer functions of its two equations", "[linear-model]") {
  // A ring of 1 kg on a rod: r'' = r w^2 - k (r - free) - c r' + F, ((hub + r^2) w)' = torque.
  constexpr double hub = 0.3, k = 100, free = 0.2, drawn = 0.25, c = 4;
  Mechanism m;
  m.bodies = {body("rod", 2, {0, 0, 0}, {0.1, hub, 0.1}), body("ring", 1, {drawn, 0, 0})};
  m.joints = {revolute("spin", "ground", "rod", {0, 0, 0}, {0, 1, 0}),
              joint(JointType::prismatic, "slide", "rod", "ring", {drawn, 0, 0}, {1, 0, 0})};
  Drive& drive = m.joints[0].coordinates[0].drive.emplace();
  drive.speed = 7;
  drive.keeps = DriveKeeps::momentum;
  Coordinate& slide = m.joints[1].coordinates[0];
  slide.drawn = drawn;
  slide.damping = c;
  slide.spring = CoordinateSpring{k, free};
  const LinearModel model = linear_model(
      m, {"torque(spin)", "torque(slide)", "joints.slide.spring.stiffness"}, {"slide", "rate(spin)"});
  REQUIRE(model.states.size() == 3); // the angle is none
  const double r = value(model.steady, "slide"), w = coordinate(model.steady, "spin").speed.value(),
               j = hub + r * r;
  for (const Complex s : {Complex(0.3, 0), Complex(0, 5), Complex(0.7, 11), Complex(-2, 30)}) {
    const Complex d = s * s + c * s + k - w * w + 4 * r * r * w * w / j;
    const std::array forces{2 * r * w / (j * s), Complex(1), Complex(free - r)};
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Complex moved = forces[static_cast<std::size_t>(i)] / d;
      check_transfer(model, 0, i, s, moved);
      check_transfer(model, 1, i, s, (i == 0 ? 1. / (j * s) : 0.) - 2 * r * w / j * moved, 1e-9);
    }
  }
  // Other momenta are states of their own: one pole at zero.
  CHECK(std::ranges::count_if(model.poles, [](Complex p) { return std::abs(p) < 1e-9; }) == 1);
  CHECK_THAT(refusal(m, {"joints.spin.drive.speed"}, {"slide"}), ContainsSubstring("left to itself begins"));
}

TEST_CASE("the wheels of a differential answer torques as its steady states do", "[linear-model]") {
  const Mechanism m = shipped("differential");
  const Names wheels{"left", "right", "planet1"};
  const LinearModel model =
      linear_model(m, {"torque(left)", "torque(right)"}, {"rate(left)", "rate(right)", "rate(planet1)"});
  REQUIRE(model.gain);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const auto speeds = [&](double torque) {
      Mechanism pushed = m;
      Force force;
      force.name = "push";
      force.type = ForceType::torque;
      force.body = wheels[static_cast<std::size_t>(i)];
      force.frame = ForceFrame::world;
      const int wheel = joint_index(m, force.body);
      force.vector = torque * m.joints[static_cast<std::size_t>(wheel)].axis.normalized();
      pushed.forces.push_back(force);
      const Solution s = Analysis(pushed).solve();
      REQUIRE(s.status == Status::converged);
      Eigen::Vector3d out;
      for (int wheel_at = 0; wheel_at < 3; ++wheel_at)
        out[wheel_at] = coordinate(s, wheels[static_cast<std::size_t>(wheel_at)]).speed.value();
      return out;
    };
    constexpr double step = 1e-3;
    const Eigen::Vector3d wanted = (speeds(step) - speeds(-step)) / (2 * step);
    CAPTURE(i, wanted.transpose(), model.gain->col(i).transpose());
    CHECK((model.gain->col(i) - wanted).norm() < 1e-7 * wanted.norm());
  }
  CHECK_THAT(refusal(m, {"joints.left.damping"}, {"rate(left)"}),
             ContainsSubstring("inputs are torques and forces"));
}

TEST_CASE("forces are inputs where gears make things move at rates of their own", "[linear-model]") {
  // A drum hauls a weight up a rope: (J + m r^2) w' = T - c w - m g r + r F.
  constexpr double j = 0.5, mass = 3, r = 0.2, c = 2;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("drum", 1, {0, 0, 0}, {j, j, j}), body("weight", mass, {r, -2, 0})};
  m.joints = {torque_driven(revolute("turn", "ground", "drum", {0, 0, 0}, {0, 0, 1}), 1,
                            "30 N m - 2 N m s*rate(turn)"),
              joint(JointType::prismatic, "lift", "ground", "weight", {r, -2, 0}, {0, 1, 0})};
  Joint rope;
  rope.name = "rope";
  rope.type = JointType::gear;
  rope.joints = {"turn", "lift"};
  rope.ratio = r;
  m.joints.push_back(rope);
  const LinearModel model =
      linear_model(m, {"torque(turn)", "force_y(weight)"}, {"rate(turn)", "rate(lift)"});
  for (const Complex s : {Complex(0.3, 0), Complex(0, 5), Complex(-2, 30)}) {
    const Complex turns = 1. / ((j + mass * r * r) * s + c);
    const std::array forces{1., r};
    for (Eigen::Index i = 0; i < 2; ++i) {
      check_transfer(model, 0, i, s, forces[static_cast<std::size_t>(i)] * turns);
      check_transfer(model, 1, i, s, r * forces[static_cast<std::size_t>(i)] * turns);
    }
  }
}

TEST_CASE("the common angle of shafts that a spring ties integrates unseen", "[linear-model]") {
  // Both turn faster by what both resist with, and half of the torque goes through the spring.
  for (const bool opposite : {false, true}) {
    const Mechanism m = shafts(opposite);
    const LinearModel model =
        linear_model(m, {"torque(p)"}, {"rate(p)", "rate(q)", "torque(q)", "tension(k)"});
    CHECK(model.states.size() == 4);
    REQUIRE(model.gain);
    CHECK((*model.gain)(0, 0) == Approx(2.5).epsilon(1e-11));
    CHECK((*model.gain)(1, 0) == Approx(2.5).epsilon(1e-11));
    CHECK((*model.gain)(2, 0) == Approx(-0.5).epsilon(1e-9));
  }
}

TEST_CASE("an input of which rounding alone is left acts on nothing", "[linear-model]") {
  Mechanism m;
  m.gravity = Vec3::Zero();
  m.bodies = {body("block", 2, {0.3, 0, 0})};
  m.joints = {prismatic("slide", "ground", "block", {0.3, 0, 0}, Vec3::UnitX())};
  m.joints[0].coordinates[0].drawn = 0.3;
  const auto block = [&](double free) { // stands where the stronger spring has its free length, but rounding
    Mechanism sprung_so = m;
    sprung_so.joints[0] = sprung(m.joints[0], 10, free);
    sprung_so.forces = {
        point_spring("strong", "ground", "block", {0, 0, 0}, {0.3, 0, 0}, 1e6, 0.30000000000000004)};
    return linear_model(sprung_so, {"joints.slide.spring.stiffness", "torque(slide)"}, {"slide"});
  };
  const LinearModel none = block(0.3);
  REQUIRE(none.descriptor.b.rows() == 2);
  CHECK(none.descriptor.b.col(0).isZero(0));
  CHECK(none.explicit_form->b.col(0).isZero(0));
  check_transfer(none, 0, 1, {0, 3}, 1 / (1e6 + 10 - 2 * 9.));
  const LinearModel some = block(0.3 + 1e-6); // a weak one is none that is left out
  check_transfer(some, 0, 0, {0, 3}, (0.3 + 1e-6 - some.outputs[0].value) / (1e6 + 10 - 2 * 9.), 1e-6);
}

TEST_CASE("long chains have the linear models that their speed and torque ask for", "[linear-model]") {
  Mechanism m = hanging_chain(100, 3); // M^-1 makes 1e10 of rounding
  for (std::size_t i = 1; i < m.bodies.size(); ++i) {
    m.bodies[i].position.x() += 0.05; // it hangs beside the axis, and leans outwards
    m.joints[i].at.x() += 0.05;
    m.joints[i] = dampened(sprung(m.joints[i], 1), 1e-3);
  }
  const auto at_speed = [&](double w) {
    Mechanism turned = m;
    turned.joints[0].coordinates[0].drive->speed = w;
    const Solution steady = Analysis(turned).solve();
    return std::ranges::find(steady.coordinates, "hinge1", &CoordinateSolution::joint)->value;
  };
  const LinearModel by_speed = linear_model(m, {"joints.spin.drive.speed"}, {"hinge1"});
  REQUIRE(by_speed.gain);
  const double step = 1e-4;
  CHECK((*by_speed.gain)(0, 0) ==
        Approx((at_speed(3 + step) - at_speed(3 - step)) / (2 * step)).epsilon(1e-6));

  const LinearModel by_torque =
      linear_model(with_torque(m, "6 N m - 2 N m s * rate(spin)"), {"torque(spin)"}, {"rate(spin)"});
  REQUIRE(by_torque.gain);
  CHECK((*by_torque.gain)(0, 0) == Approx(0.5).epsilon(1e-9));
}

TEST_CASE("rounding in reactions of a long chain is no kink", "[linear-model]") {
  constexpr int links = 150;
  constexpr double length = 0.1;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  std::vector<double> borne(links + 1, 0.); // kg, by the joints
  std::string before = "ground";
  for (int i = 0; i < links; ++i) {
    const std::string number = std::to_string(i);
    m.bodies.push_back(
        body("b" + number, 0.1 + 0.15 * (i % 7), {0, -(i + 0.5) * length, 0}, {1e-4, 1e-4, 1e-4}));
    m.joints.push_back(revolute("j" + number, before, "b" + number, {0, -i * length, 0}, {0, 0, 1}));
    if (i % 3 == 0)
      m.joints.back() =
          sprung(m.joints.back(), std::array{1., 100., 1e4}[static_cast<std::size_t>(i % 4 % 3)],
                 i % 2 != 0 ? 0.3 : -0.2);
    before = "b" + number;
  }
  for (std::size_t i = links; i-- > 0;)
    borne[i] = borne[i + 1] + m.bodies[i].mass;
  validate(m);
  const LinearModel model = linear_model(
      m, {"gravity.1"}, {"reaction_y(j0)", "reaction_x(j75)", "reaction_y(j75)", "moment_z(j0)"});
  REQUIRE(model.gain);
  const auto gain = [&](Eigen::Index i) { return (*model.gain)(i, 0); };
  CHECK(gain(0) == Approx(-borne[0]).epsilon(1e-6));
  CHECK(std::abs(gain(1)) < 1e-6 * borne[75]);
  CHECK(gain(2) == Approx(-borne[75]).epsilon(1e-6));
  // Of the spring there, 1 N m/rad, whose angle gravity changes a little.
  const auto angle = [&](double gravity) {
    Mechanism other = m;
    other.gravity.y() = gravity;
    const Solution steady = Analysis(other).solve();
    return std::ranges::find(steady.coordinates, "j0", &CoordinateSolution::joint)->value;
  };
  CHECK(gain(3) == Approx(-(angle(-9.7) - angle(-9.9)) / 0.2).margin(1e-4));
}

TEST_CASE("dampers that are none as drawn are inputs like others, or nothing is told of them",
          "[linear-model][sensitivity]") {
  // A shaft in two bearings of which b closes a loop: J w' = 3 N m - (0.1 N m s + c) w, at c = 0.
  Mechanism m;
  m.bodies = {body("rotor", 1, {0, 0, 0}, {1, 2, 1})};
  m.joints = {torque_driven(revolute("a", "ground", "rotor", {0, 0, 0}, {0, 1, 0}), 10,
                            "3 N m - 0.1 N m s * rate(a)"),
              revolute("b", "ground", "rotor", {0, 0.5, 0}, {0, 1, 0})};
  for (const char* address : {"joints.b.damping", "joints.a.damping"})
    m.sliders.emplace_back().parameter = address;
  const LinearModel model = linear_model(m, {"joints.b.damping"}, {"rate(a)"});
  const Complex s(0.1, 4);
  check_transfer(model, 0, 0, s, -30. / (2. * s + 0.1));
  // The system that solving compiles has no damper in b; of a it tells dw/dc = -w^2 / 3 N m.
  const Solution solution = Analysis(m).solve();
  REQUIRE(solution.sensitivities.size() == 1);
  CHECK(solution.sensitivities[0].address == "joints.a.damping");
  CHECK(solution.sensitivities[0].rates.at(0).value == Approx(-300).epsilon(1e-12));
}
