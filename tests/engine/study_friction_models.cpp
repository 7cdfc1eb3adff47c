// Small motions about states that dry friction holds, or in which joints slip: linear models and modes
// against closed forms and the motion; and studies that have no part in such states.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/campbell.hpp"
#include "engine/study/design.hpp"
#include "engine/study/friction_branches.hpp"
#include "engine/study/hopf_curve.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/engine/linear_models.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double bob = 2, arm = 0.5, damping = 0.1, weight = 10; // kg, m, N m s/rad, m/s^2

// A pendulum on a block of 3 kg that slides along an axis with friction (N), and may have a spring.
Mechanism pendulum_on_block(const std::string& axis, double limit, const std::string& more) {
  return read_scene(R"({"flyball": 2, "name": "Pendulum on a block", "gravity": [0, -10, 0],
    "bodies": [{"name": "block", "mass": 3, "position": [0, 0, 0]},
      {"name": "bob", "mass": 2, "position": [0, -0.5, 0]}],
    "joints": [{"name": "slide", "type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": )" +
                    axis + more + R"(, "friction": {"limit": )" + number_text(limit) + R"(}},
      {"name": "hinge", "type": "revolute", "bodies": ["block", "bob"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "damping": 0.1}]})");
}

// Of the pendulum on a block that stands: s of m L^2 s^2 + c s + m g L = 0 with Im s > 0.
std::complex<double> swing(double mass = bob) {
  const double inertia = mass * arm * arm;
  return {-damping / (2 * inertia), std::sqrt(weight / arm - std::pow(damping / (2 * inertia), 2))};
}

void check_pole(const LinearModel& model, std::complex<double> wanted) {
  CHECK(std::ranges::any_of(model.poles, [&](std::complex<double> pole) {
    return std::abs(pole - wanted) < 1e-10 * std::max(1., std::abs(wanted));
  }));
}

const std::string sprung = R"(, "spring": {"stiffness": 50, "free": 0.03})";

} // namespace

TEST_CASE("a pendulum beside a joint that friction holds away from the drawn pose", "[linear-model]") {
  Mechanism m = pendulum_on_block("[1, 0, 0]", 8, sprung);
  m.joints[0].coordinates[0].friction->share = 0.5;
  const double stands = 0.03 + 4. / 50;
  const LinearModel model =
      linear_model(m, {"torque(hinge)", "torque(slide)", "joints.slide.spring.stiffness", "gravity.0"},
                   {"hinge", "slide", "reaction_x(slide)"});
  CHECK(model.held == Names{"slide"});
  CHECK(model.slipping.empty());
  CHECK(model.stable == true);
  REQUIRE(model.states.size() == 2);
  CHECK(model.states[0].name == "hinge");
  REQUIRE(model.poles.size() == 2);
  check_pole(model, swing());
  const Eigen::MatrixXd& gain = *model.gain;
  CHECK_THAT(gain(0, 0), WithinRel(1 / (bob * weight * arm), 1e-10));
  CHECK_THAT(gain(0, 3), WithinRel(1 / weight, 1e-10));
  CHECK(gain.row(1).isZero(0)); // it stands
  CHECK(gain.col(1).isZero(1e-12));
  CHECK(gain.col(2).isZero(1e-12));
  CHECK_THAT(gain(2, 3), WithinRel(-5., 1e-10)); // the weight of both
  CHECK_THAT(model.outputs[1].value, WithinRel(stands, 1e-12));
  // The motion beside it.
  SimulationOptions options;
  options.duration = 1;
  options.tolerance = 1e-10;
  options.at = {{"slide", stands}, {"hinge", 1e-4}};
  const Run run = simulate(m, options);
  REQUIRE(run.status == RunStatus::completed);
  const std::complex<double> s = swing();
  const double w = s.imag(), d = -s.real();
  CHECK(run.coordinates[0].value.back() == stands);
  CHECK_THAT(run.coordinates[1].value.back(),
             WithinAbs(1e-4 * std::exp(-d) * (std::cos(w) + d / w * std::sin(w)), 1e-10));
}

TEST_CASE("a linear model of what only friction holds as drawn", "[linear-model]") {
  const Mechanism m = pendulum_on_block("[1, 0.2, 0]", 20, "");
  const LinearModel model = linear_model(m, {"torque(hinge)"}, {"hinge", "slide"});
  CHECK(model.held == Names{"slide"});
  REQUIRE(model.poles.size() == 2);
  check_pole(model, swing());
  CHECK(model.stable == true);
  CHECK_THAT((*model.gain)(0, 0), WithinRel(0.1, 1e-10));
  CHECK((*model.gain)(1, 0) == 0);
}

TEST_CASE("friction at its limit holds small motions to one side only: no linear model", "[linear-model]") {
  Mechanism m = pendulum_on_block("[1, 0, 0]", 8, sprung);
  m.joints[0].coordinates[0].friction->share = -1;
  CHECK_THAT(linearize(m, Names{"torque(hinge)"}, Names{"hinge"}).refusal,
             ContainsSubstring("Dry friction in slide is at its limit"));
}

TEST_CASE("linear models of a clutch that holds and of one that slips", "[linear-model]") {
  const Names in{"torque(pa)", "torque(pb)"}, out{"rate(pa)", "rate(pb)", "rate(c)"};
  const double inertia = 0.3;
  // Held: 2 I w' = 5 - 1.2 w.
  const Mechanism holds = motor_and_load(R"("friction": {"limit": 3})");
  const LinearModel held = linear_model(holds, in, out);
  CHECK(held.held == Names{"c"});
  CHECK(held.slipping.empty());
  REQUIRE(held.poles.size() == 1); // its angle is a phase
  check_pole(held, -1.2 / (2 * inertia));
  CHECK(held.stable == true);
  for (const LinearModel::State& state : held.states)
    CHECK_FALSE(state.name.starts_with("c"));
  for (const Eigen::Index input : {0, 1}) {
    CHECK_THAT((*held.gain)(0, input), WithinRel(1 / 1.2, 1e-10));
    CHECK((*held.gain)(2, input) == 0);
  }
  // It slips: I w' = 5 - w - T and I w' = -0.2 w + T.
  const Mechanism slips = motor_and_load(R"("friction": {"limit": 0.5})");
  const LinearModel slipping = linear_model(slips, in, out);
  CHECK(slipping.held.empty());
  CHECK(slipping.slipping == Names{"c"});
  // What slips has become a force, and with it the damper beside it.
  CHECK_THAT(linearize(motor_and_load(R"("damping": 0.1, "friction": {"limit": 0.5})"),
                       Names{"joints.c.damping"}, out)
                 .refusal,
             ContainsSubstring("where friction slips"));
  REQUIRE(slipping.poles.size() == 2);
  check_pole(slipping, -1 / inertia);
  check_pole(slipping, -0.2 / inertia);
  CHECK_THAT((*slipping.gain)(0, 0), WithinRel(1., 1e-10));
  CHECK_THAT((*slipping.gain)(1, 1), WithinRel(5., 1e-10));
  CHECK_THAT((*slipping.gain)(0, 1), WithinAbs(0, 1e-12));
  CHECK_THAT((*slipping.gain)(2, 0), WithinRel(-1., 1e-10));
  CHECK_THAT(linearize(slips, Names{"joints.c.friction.limit"}, out).refusal,
             ContainsSubstring("in the limit of c, which slips"));
}

TEST_CASE("a differential with one shaft that friction holds", "[linear-model]") {
  Mechanism m = shipped("differential");
  Coordinate& left = std::ranges::find(m.joints, "left", &Joint::name)->coordinates[0];
  left.damping = 0;
  left.friction = Friction{.limit = 500};
  const LinearModel model = linear_model(m, {"torque(case)"}, {"rate(case)"});
  CHECK(model.held == Names{"left"});
  REQUIRE(model.states.size() == 1);
  CHECK(model.states[0].name == "case.rate");
  // The other shaft turns twice as fast, and both are damped.
  CHECK_THAT((*model.gain)(0, 0), WithinRel(1 / 8.5, 1e-10));
}

TEST_CASE("no linear model where friction holds a joint at a dead point of its loop", "[linear-model]") {
  const Mechanism m = read_scene(R"({"flyball": 1, "name": "Slider-crank", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "crank", "mass": 1, "position": [0, -0.1, 0], "inertia": [0.001, 0.001, 0.002]},
      {"name": "slider", "mass": 0.8, "position": [0, 0.2, 0]}],
    "joints": [
      {"name": "a", "type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1],
        "damping": 0.01},
      {"name": "d", "type": "prismatic", "bodies": ["ground", "slider"], "at": [0, 0.2, 0], "axis": [0, 1, 0],
        "friction": {"limit": 5}},
      {"name": "link", "type": "distance", "bodies": ["crank", "slider"],
        "points": [[0, -0.1, 0], [0, 0.2, 0]]}]})");
  CHECK_THAT(linearize(m, Names{"torque(a)"}, Names{"a"}).refusal,
             ContainsSubstring("stands at a dead point of its loop"));
}

TEST_CASE("joints in loops that friction holds share what they bear as nothing determines",
          "[linear-model]") {
  const Mechanism m = rubbing_governor(20, 0.5);
  const LinearModel model = linear_model(m, {"gravity.1"}, {"slide"});
  CHECK(model.states.empty());
  CHECK(model.held.size() == 3);
  CHECK_THAT(linearize(m, Names{"gravity.1"}, Names{"reaction_y(slide)"}).refusal,
             ContainsSubstring("share what they bear"));
}

TEST_CASE("modes over a number of what friction holds", "[campbell]") {
  const Mechanism m = pendulum_on_block("[1, 0.2, 0]", 20, "");
  const std::string mass = "bodies.bob.mass";
  const CampbellDiagram d = campbell_diagram(m, mass, follow_response(m, mass, 1, 3), {});
  REQUIRE(d.branches.size() == 1);
  for (std::size_t i = 0; i < d.branches[0].points.size(); ++i) {
    const ResponsePoint& at = d.response.branches[0].points[i];
    CAPTURE(at.parameter);
    CHECK_FALSE(at.frictions.empty());
    REQUIRE(d.branches[0].points[i].modes.size() == 1);
    CHECK(std::abs(d.branches[0].points[i].modes[0].eigenvalue - swing(at.parameter)) < 1e-9);
  }
}

TEST_CASE("studies without a part in what friction holds say that it does") {
  const Mechanism m = pendulum_on_block("[1, 0.2, 0]", 20, "");
  const std::string rests = "The steady state rests on dry friction: slide is held. ";
  CHECK(design(m, "bodies.bob.mass", 1, 3, "hinge", 0.1).message ==
        rests + "Numbers are solved for only of states that need none.");
  CHECK(hopf_curves(m, {"bodies.bob.mass", 1, 3}, {"joints.hinge.damping", 0, 1}).message ==
        rests + "Curves in the plane of two numbers are followed only of states that need none.");
}
