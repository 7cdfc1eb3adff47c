// Linear models against closed forms, against `solve`, and against differences and runs of the motion itself.
#include "engine/dynamics/equations.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/kkt/constraint_space.hpp"
#include "engine/linear/exponential.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "engine/study/linear_model.hpp"
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Complex = std::complex<double>;
using Names = std::vector<std::string>;

namespace {

LinearModel made(const Mechanism& m, const Names& inputs, const Names& outputs,
                 const LinearModelOptions& options = {}) {
  LinearModel model = linearize(m, inputs, outputs, options);
  INFO(model.refusal);
  REQUIRE(model.refusal.empty());
  return model;
}

std::string refusal(const Mechanism& m, const Names& inputs, const Names& outputs) {
  return linearize(m, inputs, outputs).refusal;
}

// Both forms.
void check_transfer(const LinearModel& model, Eigen::Index output, Eigen::Index input, Complex s,
                    Complex wanted, double tolerance = 1e-10) {
  for (const StateSpace& x : {model.descriptor, best_form(model)}) {
    const auto h = transfer(x, s);
    REQUIRE(h);
    CAPTURE(s, wanted, (*h)(output, input));
    CHECK(std::abs((*h)(output, input) - wanted) <= tolerance * std::abs(wanted));
  }
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
  CHECK_THAT(refusal(rubbing(0), inputs, outputs), ContainsSubstring("once the joints slip"));
  LinearModelOptions options;
  options.slipping = true;
  const LinearModel slips = linearize(rubbing(0), inputs, outputs, options),
                    without = made(free, inputs, outputs);
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
  const LinearModel model =
      made(m, {"torque(" + hinge + ")", "joints.spin.drive.speed", "gravity.1", "bodies." + ball + ".mass"},
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
      made(m, {"joints.spin.drive.speed", "torque(hinge)"}, {"hinge", "rate(hinge)", "rate(spin)"});
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
  const LinearModel torque = made(m, {"torque(hinge)"}, {"torque(spin)", "moment_y(spin)"});
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
  const LinearModel model = made(m, {"joints.rod.length", "force_x(first)"}, {"x1", "x2"});
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
  const LinearModel model = made(m, {"torque(spin)", "torque(slide)"}, {"rate(spin)", "slide"});
  CHECK(model.states.size() == 3);
  CHECK(model.states[0].name != "spin");
  LinearModelOptions phases;
  phases.phases = true;
  const LinearModel whole = made(m, {"torque(spin)"}, {"rate(spin)", "coordinate(spin)"}, phases);
  CHECK(whole.states.size() == 4);
  CHECK_FALSE(whole.gain);
  CHECK(std::abs(whole.poles.front()) < 1e-9);
  const auto h = transfer(*whole.explicit_form, {0, 1.3});
  CHECK(std::abs((*h)(0, 0) - (*h)(1, 0) * Complex(0, 1.3)) < 1e-12 * std::abs((*h)(0, 0)));
  CHECK(std::abs((*h)(0, 0) - (*transfer(*model.explicit_form, {0, 1.3}))(0, 0)) <
        1e-12 * std::abs((*h)(0, 0)));
  CHECK_THAT(refusal(m, {"torque(spin)"}, {"coordinate(spin)"}), ContainsSubstring("without end"));
}

namespace {

// The entries of a step of q_R that these states are.
std::vector<int> entries_of(const MotionModel& model, const LinearModel& linear, std::size_t count) {
  std::vector<int> out;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = linear.states[i].name;
    int found = -1;
    for (const CoordinateInfo& c : model.system.coordinates) {
      const Link& link = model.system.links[static_cast<std::size_t>(c.link)];
      const bool ball = link.type == LinkType::spherical;
      const int k = c.index - link.coordinate;
      const std::string& joint = model.system.tree_joints[static_cast<std::size_t>(c.tree_joint)].name;
      if (name == (ball ? joint + ".turn." + "xyz"[k] : name_of_coordinate(model, link.v)))
        found = link.v + (ball ? k : 0);
    }
    REQUIRE(found >= 0);
    out.push_back(found);
  }
  return out;
}

} // namespace

TEST_CASE("A, B, C and D are the derivatives of the motion's accelerations and measures", "[linear-model]") {
  int compared = 0, by_speed = 0, by_mass = 0, seen = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    reference::RandomOptions o;
    o.massless = false;
    o.stops = false;
    o.loops = static_cast<int>(seed % 3);
    o.spring_share = 1;
    o.air = seed % 3 == 1;
    o.tree_types = {JointType::revolute,  JointType::prismatic, JointType::cylindrical,
                    JointType::universal, JointType::planar,    JointType::spherical};
    Mechanism m = reference::random_mechanism(seed, o);
    // What is the same from wherever one looks at it.
    const std::string held = argument_text(m.joints.front().name), part = argument_text(m.bodies.back().name),
                      first = argument_text(m.bodies.front().name);
    m.measures = {{"o1", "", "speed(" + part + ")", "m/s"},
                  {"o2", "", "acceleration(" + part + ")", "m/s^2"},
                  {"o3", "", "reaction(" + held + ")", "N"},
                  {"o4", "", "moment(" + held + ")", "N m"},
                  {"o5", "", "distance(" + part + ", " + first + ")", "m"}};
    // Something free, its torque, the drive's speed and a mass.
    const Solution steady = Analysis(m).solve();
    if (steady.status != Status::converged || !steady.neutral.empty() || steady.floquet) continue;
    Names inputs;
    for (const CoordinateSolution& c : steady.coordinates)
      if (!c.driven && !c.dependent && inputs.empty()) {
        const int joint = joint_index(m, c.joint);
        if (joint < 0) continue;
        inputs.push_back("torque(" + argument_text(c.joint) +
                         (c.count == 1 ? "" : "." + std::to_string(c.index)) + ")");
      }
    if (inputs.empty()) continue;
    const std::size_t torque_inputs = inputs.size();
    Names numbers;
    for (const Joint& joint : m.joints)
      for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
        if (joint.coordinates[i].drive)
          numbers.push_back("joints." + joint.name + ".drive." +
                            (joint.coordinates.size() == 1 ? "" : std::to_string(i) + ".") + "speed");
    numbers.push_back("bodies." + m.bodies.back().name + ".mass");
    Names all = inputs;
    all.insert(all.end(), numbers.begin(), numbers.end());
    LinearModel linear = linearize(m, all, Names{"mass()"});
    if (!linear.refusal.empty()) continue;
    if (!linear.explicit_form) continue;
    const StateSpace& x = *linear.explicit_form;
    const auto k = static_cast<Eigen::Index>(linear.states.size() / 2);
    if (k == 0) continue;

    MotionModel model = make_motion_model(m, true);
    SimulationOptions start;
    start.start = Start::equilibrium;
    Eigen::VectorXd q, u;
    find_start(start, model, q, u);
    const Watch watch;
    const std::vector<int> chosen = entries_of(model, linear, static_cast<std::size_t>(k));
    // Whole changes of all coordinates by those of the chosen: on the null space of the constraints.
    Eigen::MatrixXd basis;
    {
      Equations equations(model, watch);
      equations.analyse(0, q, u);
      if (equations.has_massless() || !equations.evaluate(0, q, u)) continue;
      Linearization l;
      linearize_constraints(model.released, model.parameters, equations.kinematics(), l);
      ConstraintSpace space;
      const int n = model.system.nv;
      space.factor(model.scaling.row.asDiagonal() * l.constraint.leftCols(n) *
                       model.scaling.column.asDiagonal(),
                   1e-9);
      const Eigen::MatrixXd null_space = model.scaling.column.asDiagonal() * space.basis();
      REQUIRE(null_space.cols() == k);
      Eigen::MatrixXd rows(k, k);
      for (Eigen::Index i = 0; i < k; ++i)
        rows.row(i) = null_space.row(chosen[static_cast<std::size_t>(i)]);
      basis = null_space * rows.inverse();
    }
    const auto accelerations = [&](const MotionModel& of, const Eigen::VectorXd& dq,
                                   const Eigen::VectorXd& du) {
      Equations equations(of, watch);
      Eigen::VectorXd at = q, s = u;
      equations.analyse(0, at, s);
      at = q;
      const Eigen::VectorXd step = basis * dq;
      retract<double>(of.system, step, at);
      s = u + basis * du;
      REQUIRE(equations.project(0, at, s));
      REQUIRE(equations.evaluate(0, at, s));
      Eigen::VectorXd out(k + 5);
      for (Eigen::Index i = 0; i < k; ++i)
        out[i] = equations.acceleration()[chosen[static_cast<std::size_t>(i)]];
      MeasureSet measures;
      measures.bind(of.mechanism, of.system, of.parameters);
      const TransmittedForces forces = equations.reactions();
      out.tail(5) = measures.evaluate(
          {of.system, of.parameters, equations.configuration(), equations.accelerated_kinematics(), &forces});
      return out;
    };
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(k);
    const double h = 1e-5;
    Eigen::MatrixXd all_rates(k + 5, 2 * k);
    for (Eigen::Index i = 0; i < k; ++i) {
      const Eigen::VectorXd e =
          h * model.scaling.column[chosen[static_cast<std::size_t>(i)]] * Eigen::VectorXd::Unit(k, i);
      const double step = 2 * e[i];
      all_rates.col(i) = (accelerations(model, e, none) - accelerations(model, -e, none)) / step;
      all_rates.col(k + i) = (accelerations(model, none, e) - accelerations(model, none, -e)) / step;
    }
    const Eigen::MatrixXd a = all_rates.topRows(k);
    const auto close = [&](const Eigen::MatrixXd& found, const Eigen::MatrixXd& wanted, double scale) {
      return (found - wanted).cwiseAbs().maxCoeff() <= 2e-6 * std::max(scale, wanted.cwiseAbs().maxCoeff());
    };
    const Eigen::MatrixXd lower = x.a.bottomRows(k);
    CHECK(close(lower.leftCols(k), a.leftCols(k), 0));
    CHECK(close(lower.rightCols(k), a.rightCols(k), 1e-3 * a.cwiseAbs().maxCoeff()));
    ++compared;
    Eigen::MatrixXd by_number(5, static_cast<Eigen::Index>(numbers.size()));
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      const double value = get_parameter(m, numbers[j]), step = 1e-5 * std::max(1e-3, std::abs(value));
      std::vector<Eigen::VectorXd> sides;
      for (const double side : {step, -step}) {
        Mechanism varied = m;
        set_parameter(varied, numbers[j], value + side);
        MotionModel other = make_motion_model(varied, true);
        other.scaling = model.scaling; // one null space
        sides.push_back(accelerations(other, none, none));
      }
      const Eigen::VectorXd difference = (sides[0] - sides[1]).head(k) / (2 * step);
      by_number.col(static_cast<Eigen::Index>(j)) = (sides[0] - sides[1]).tail(5) / (2 * step);
      const auto column = static_cast<Eigen::Index>(torque_inputs + j);
      // True rates stand still: what the states of the rates lack of them is what the input adds.
      const Eigen::VectorXd predicted =
          x.b.col(column).tail(k) - lower.rightCols(k) * x.b.col(column).head(k);
      CAPTURE(numbers[j], predicted.transpose(), difference.transpose());
      CHECK(close(predicted, difference, 1e-6 * a.cwiseAbs().maxCoeff()));
      ++(j + 1 == numbers.size() ? by_mass : by_speed);
    }
    for (const std::string name : {"o1", "o2", "o3", "o4", "o5"}) {
      CAPTURE(name);
      const LinearModel one = linearize(m, Names{numbers.back()}, Names{name});
      if (!one.refusal.empty()) continue; // such as of a length of nothing
      ++seen;
      const Eigen::Index row = k + (name[1] - '1');
      const Eigen::RowVectorXd c = one.explicit_form->c, wanted = all_rates.row(row);
      const double size = std::max(wanted.head(k).cwiseAbs().maxCoeff(), 10.);
      CAPTURE(c, wanted, one.output_error[0]);
      CHECK(close(c.head(k), wanted.head(k), 1e-4 * size + 1e-5 * std::abs(one.outputs[0].value)));
      CHECK(close(c.tail(k), wanted.tail(k), 1e-3 * size + 1e-5 * std::abs(one.outputs[0].value)));
      const double d = by_number(row - k, by_number.cols() - 1);
      CHECK(std::abs(one.explicit_form->d(0, 0) - d) <=
            1e-6 * std::max(std::abs(d), std::abs(one.outputs[0].value)));
    }
  }
  CHECK(seen > 50);
  CHECK(compared > 15);
  CHECK(by_speed > 10);
  CHECK(by_mass > 10);
}

TEST_CASE("outputs answer to a step as the motion does", "[linear-model]") {
  struct Case {
    const char* scene;
    std::string number;
    Names outputs;
    double step;
  };
  for (const Case& c :
       {Case{"governor", "joints.slide.spring.free", {"slide", "rate(slide)", "tension"}, 1e-6},
        Case{"governor",
             "joints.slide.spring.stiffness",
             {"slide", "reaction_y(spin)", "torque(spin)"},
             1e-3}}) {
    CAPTURE(c.scene, c.number);
    Mechanism m = shipped(c.scene);
    m.measures.push_back({"tension", "", "reaction(link1)", "N"});
    m.measures.push_back({"seen_spin", "", "torque(spin)", "N m"});
    m.measures.push_back({"seen_bearing", "", "reaction_y(spin)", "N"});
    const LinearModel model = made(m, {c.number}, c.outputs);
    const Solution steady = Analysis(m).solve();
    Mechanism stepped = m;
    set_parameter(stepped, c.number, get_parameter(m, c.number) + c.step);
    SimulationOptions o;
    o.duration = 1.5;
    o.rate = 20;
    o.tolerance = 1e-13;
    o.start = Start::state;
    for (const CoordinateSolution& x : steady.coordinates)
      if (!x.dependent) o.state.coordinates.push_back({x.joint, x.index, x.value, x.speed.value_or(0)});
    const Run run = simulate(stepped, o);
    REQUIRE(run.status == RunStatus::completed);
    // x' = A x + B u from zero: the exponential of [A B; 0 0].
    const StateSpace& x = *model.explicit_form;
    const Eigen::Index n = x.a.rows();
    for (std::size_t i = 0; i < c.outputs.size(); ++i) {
      double most = 0, worst = 0;
      for (std::size_t k = 1; k < run.time.size(); ++k) {
        Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n + 1, n + 1);
        block.topLeftCorner(n, n) = x.a * run.time[k];
        block.topRightCorner(n, 1) = x.b * run.time[k];
        const Eigen::VectorXd state = matrix_exponential(block)->topRightCorner(n, 1);
        const auto row = static_cast<Eigen::Index>(i);
        const double predicted = c.step * ((x.c.row(row) * state)(0) + x.d(row, 0));
        const auto measured = [&]() -> double {
          const std::string& name = c.outputs[i];
          if (name == "slide" || name == "rate(slide)")
            for (const CoordinateTrack& t : run.coordinates)
              if (t.joint == "slide") return name == "slide" ? t.value[k] : t.rate[k];
          const std::string wanted = name == "torque(spin)"       ? "seen_spin"
                                     : name == "reaction_y(spin)" ? "seen_bearing"
                                                                  : name;
          for (const MeasureTrack& t : run.measures)
            if (t.name == wanted) return t.value[k];
          FAIL("no track of " << name);
          return 0;
        };
        most = std::max(most, std::abs(predicted));
        worst = std::max(worst, std::abs(measured() - model.outputs[i].value - predicted));
      }
      CAPTURE(c.outputs[i], most, worst);
      CHECK(most > 0);
      CHECK(worst < 2e-4 * most);
    }
  }
}

namespace {

// A shaft by the torque 5 N m - 1 N m s w, and on a radial slide of it a body that its own inertia resists.
Mechanism slide_on_shaft() {
  Mechanism m;
  m.bodies = {body("shaft", 1, {0, 0, 0}, {0.2, 0.2, 0.2}), body("bob", 0.5, {0.3, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {revolute("spin", "ground", "shaft", {0, 0, 0}),
              dampened(sprung(prismatic("slide", "shaft", "bob", {0.3, 0, 0}, {1, 0, 0}), 150, 0.3), 2)};
  Drive& drive = m.joints[0].coordinates[0].drive.emplace();
  drive.speed = 5;
  drive.torque = 0;
  drive.load = 0;
  m.joints[0].formulas.push_back({"drive.torque", "5 N m - 1 N m s*rate(spin)"});
  m.joints[1].coordinates[0].drawn = 0.3;
  return m;
}

} // namespace

TEST_CASE("reactions feel at once the acceleration that a number causes", "[linear-model]") {
  // The moment on the bob about its own mass centre is 0.1 kg m^2 times the shaft's acceleration.
  const LinearModel shaft =
      made(slide_on_shaft(), {"joints.spin.drive.load", "torque(spin)"}, {"moment_z(slide)", "rate(spin)"});
  for (const Eigen::Index input : {0, 1})
    for (const Complex s : {Complex(0, 0.3), Complex(0, 9), Complex(4, 200)}) {
      const auto h = transfer(best_form(shaft), s);
      REQUIRE(h);
      check_transfer(shaft, 0, input, s, 0.1 * s * (*h)(1, input), 1e-9);
    }
  // At rest: what the joint gives a body is its acceleration less the force on it.
  const double mass = 2, c = 3, k = 50;
  Mechanism still;
  still.bodies = {body("bob", mass, {0, 0, 0})};
  still.joints = {dampened(sprung(prismatic("slide", "ground", "bob", {0, 0, 0}, {1, 0, 0}), k), c)};
  const LinearModel pushed = made(still, {"force_x(bob)"}, {"reaction_x(slide)"});
  for (const double omega : {0.3, 5., 40.}) {
    const Complex s(0, omega), d = mass * s * s + c * s + k;
    check_transfer(pushed, 0, 0, s, mass * s * s / d - 1., 1e-9);
  }
}

TEST_CASE("static gains of reactions are the slopes of what solving tells", "[linear-model]") {
  const Names outputs{"reaction_y(arm1)", "moment_y(arm1)", "reaction_y(slide)", "torque(spin)",
                      "power(spin)"};
  for (const char* scene : {"governor", "governor_engine"}) {
    Mechanism m = shipped(scene);
    for (const std::string& text : outputs)
      m.measures.push_back({"output " + text, "", text, std::string(result_unit(m, text))});
    for (const std::string& input :
         Names{"bodies.ball1.mass", "joints.slide.spring.stiffness", "gravity.1"}) {
      CAPTURE(scene, input);
      const LinearModel model = made(m, {input}, outputs);
      REQUIRE(model.gain);
      const double at = get_parameter(m, input), step = 1e-4 * std::abs(at);
      std::vector<double> sides[2];
      for (const int side : {0, 1}) {
        Mechanism beside = m;
        set_parameter(beside, input, at + (side == 0 ? -step : step));
        const Solution s = Analysis(beside).solve();
        REQUIRE(s.status == Status::converged);
        for (std::size_t i = 0; i < outputs.size(); ++i)
          sides[side].push_back(s.measures[s.measures.size() - outputs.size() + i].value.value());
      }
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        const double slope = (sides[1][i] - sides[0][i]) / (2 * step),
                     size = std::max(std::abs(sides[0][i]) / std::abs(at), std::abs(slope));
        CAPTURE(outputs[i], slope, (*model.gain)(static_cast<Eigen::Index>(i), 0));
        CHECK(std::abs((*model.gain)(static_cast<Eigen::Index>(i), 0) - slope) <= 1e-5 * size + 1e-9);
      }
    }
  }
}

TEST_CASE("what a drive by torque gives is an output, and a measure of the motion", "[linear-model]") {
  Mechanism m = slide_on_shaft();
  const LinearModel model =
      made(m, {"joints.spin.drive.load", "torque(slide)"}, {"torque(spin)", "power(spin)", "rate(spin)"});
  CHECK(model.outputs[0].value == Approx(0).margin(1e-9));
  const double speed = model.outputs[2].value;
  for (const Eigen::Index input : {0, 1})
    for (const Complex s : {Complex(0, 0.3), Complex(0, 9)}) {
      const auto h = transfer(best_form(model), s);
      REQUIRE(h);
      const Complex torque = -(*h)(2, input) - (input == 0 ? 1. : 0.); // of the law, less the load
      check_transfer(model, 0, input, s, torque, 1e-9);
      check_transfer(model, 1, input, s, speed * torque, 1e-9);
    }
  m.measures = {{"given", "", "torque(spin)", "N m"}, {"power", "", "power(spin)", "W"}};
  SimulationOptions options;
  options.duration = 0.3;
  const Run run = simulate(m, options);
  REQUIRE(run.measures.size() == 2);
  REQUIRE(run.measures[0].value.size() == run.time.size());
  const CoordinateTrack& spin = run.coordinates[0];
  REQUIRE(spin.joint == "spin");
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    CHECK(run.measures[0].value[i] == Approx(5 - spin.rate[i]).margin(1e-12));
    CHECK(run.measures[1].value[i] == Approx((5 - spin.rate[i]) * spin.rate[i]).margin(1e-12));
  }
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
  CHECK_THAT(refusal(shipped("governor_friction"), {"gravity.1"}, {"lift"}), ContainsSubstring("friction"));
  CHECK_THAT(refusal(stored_case("parametric_rotor"), {"gravity.1"}, {"mass()"}),
             ContainsSubstring("turns with the drives"));
}

TEST_CASE("the size of a vector that vanishes is no output, unless it stays so", "[linear-model]") {
  const Mechanism engine = shipped("governor_engine");
  const Names mass{"bodies.ball1.mass"};
  CHECK_THAT(refusal(engine, mass, {"reaction(slide)"}), ContainsSubstring("kink"));
  CHECK_THAT(refusal(engine, mass, {"moment(arm1)"}), ContainsSubstring("kink"));
  CHECK(refusal(engine, {"joints.spin.drive.load"}, {"reaction(slide)", "reaction(arm1)"}).empty());
  const LinearModel none = made(engine, mass, {"moment(slide)"});
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
  const LinearModel model = made(m, {"torque(x2)"}, {"x1", "x(heavy)"});
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

TEST_CASE("loops that hold nothing leave the coordinates free", "[linear-model]") {
  // A door on two hinges of one axis: every row of the second says what the first says.
  const LinearModel model = made(stored_case("reactions_nonunique_by_joint"), {"torque(p1)"}, {"p1", "p2"});
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
  const LinearModel model =
      made(m, {"torque(spin)", "torque(slide)", "joints.slide.spring.stiffness"}, {"slide", "rate(spin)"});
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
      made(m, {"torque(left)", "torque(right)"}, {"rate(left)", "rate(right)", "rate(planet1)"});
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
