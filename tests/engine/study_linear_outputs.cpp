// Linear models against the motion itself: differences of its accelerations and measures, runs after a step,
// and outputs that answer at once.
#include "engine/dynamics/equations.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/kkt/constraint_space.hpp"
#include "engine/linear/exponential.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "tests/catch.hpp"
#include "tests/engine/linear_models.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Complex = std::complex<double>;

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
  const std::uint32_t seeds = few_or_all(15u, 60u);
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
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
    // Central differences, extrapolated from two steps to none.
    const auto rate = [&](const auto& at, double step) {
      const auto central = [&](double size) { return ((at(size) - at(-size)) / (2 * size)).eval(); };
      return ((4 * central(step / 2) - central(step)) / 3).eval();
    };
    for (Eigen::Index i = 0; i < k; ++i) {
      const Eigen::VectorXd e = Eigen::VectorXd::Unit(k, i);
      const double step = h * model.scaling.column[chosen[static_cast<std::size_t>(i)]];
      all_rates.col(i) = rate([&](double by) { return accelerations(model, by * e, none); }, step);
      all_rates.col(k + i) = rate([&](double by) { return accelerations(model, none, by * e); }, step);
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
  CHECK(seen > few_or_all(20, 50));
  CHECK(compared > few_or_all(5, 15));
  CHECK(by_speed > few_or_all(3, 10));
  CHECK(by_mass > few_or_all(3, 10));
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
    const LinearModel model = linear_model(m, {c.number}, c.outputs);
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
  const LinearModel shaft = linear_model(slide_on_shaft(), {"joints.spin.drive.load", "torque(spin)"},
                                         {"moment_z(slide)", "rate(spin)"});
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
  const LinearModel pushed = linear_model(still, {"force_x(bob)"}, {"reaction_x(slide)"});
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
      const LinearModel model = linear_model(m, {input}, outputs);
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
  const LinearModel model = linear_model(m, {"joints.spin.drive.load", "torque(slide)"},
                                         {"torque(spin)", "power(spin)", "rate(spin)"});
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

TEST_CASE("forces that are far larger beside the balance have their slopes at it", "[linear-model]") {
  // A slide at r on a turntable rests 3e-5 m within a hard stop: k (q - upper) = m w^2 r, and bears m w^2 r
  // along and m g across. A thousandth of a radius further it would bear ten times as much.
  constexpr double mass = 1, w = 3, drawn = 0.3, upper = 0.01, k = 1e5;
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle(), body("puck", mass, {drawn, 0, 0})};
  m.joints = {spin(w), prismatic("slide", "spindle", "puck", {drawn, 0, 0}, {1, 0, 0})};
  m.joints[1].coordinates[0].stop = Stop{{}, upper, k};
  m.joints[1].coordinates[0].damping = 10;
  const LinearModel model = linear_model(m, {"joints.slide.stop.upper", "joints.spin.drive.speed"},
                                         {"reaction(slide)", "acceleration(puck)"});
  REQUIRE(model.gain);
  const double q = (k * upper + mass * w * w * drawn) / (k - mass * w * w), r = drawn + q;
  CHECK(q - upper == Approx(2.8e-5).epsilon(0.02));
  const double along = mass * w * w * r, size = std::hypot(along, mass * standard_gravity);
  // dq / d upper and d(w^2 r) / dw.
  const double moved = k / (k - mass * w * w),
               rate = 2 * w * r + w * w * 2 * mass * w * r / (k - mass * w * w);
  CHECK((*model.gain)(0, 0) == Approx(along / size * mass * w * w * moved).epsilon(1e-7));
  CHECK((*model.gain)(0, 1) == Approx(along / size * mass * rate).epsilon(1e-7));
  CHECK((*model.gain)(1, 0) == Approx(w * w * moved).epsilon(1e-7));
  CHECK((*model.gain)(1, 1) == Approx(rate).epsilon(1e-7));
  CHECK(model.output_error.maxCoeff() < 1e-10);
}

TEST_CASE("beside a kink an output has the slope of its side, or is refused", "[linear-model]") {
  int known = 0, refused = 0;
  for (const double away : {1e-3, 1e-4, 1e-5, 5e-6, 4e-6, 3e-6, 2e-6, 1e-6, 1e-7, 1e-8})
    for (const double side : {1., -1.}) {
      CAPTURE(away, side);
      // A slide that its spring holds where it is drawn, on a turntable.
      Mechanism m;
      m.bodies = {spindle(), body("puck", 1, {0.3, 0, 0})};
      m.joints = {spin(1),
                  sprung(prismatic("slide", "spindle", "puck", {0.3, 0, 0}, {1, 0, 0}), 101, -0.3 / 101)};
      m.measures = {
          {"r", "",
           "max(coordinate(slide) + 0.5 * coordinate(slide)^2 / (1 m), " + number_text(-side * away) + " m)",
           "m"}};
      const LinearModel model = linearize(m, Names{"joints.slide.spring.free"}, Names{"r"});
      if (!model.refusal.empty()) {
        CHECK_THAT(model.refusal, ContainsSubstring("kink"));
        ++refused;
        continue;
      }
      ++known;
      const Eigen::MatrixXd& c = best_form(model).c;
      CHECK(std::abs(c(0, 0) - (side > 0 ? 1 : 0)) <= 10 * model.output_error[0] + 1e-11);
    }
  CHECK(known >= 8);
  CHECK(refused >= 4);
}
