// Curves of states that stand turned: branches through folds, values that are looked for beyond them, and
// where they hunt.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/design.hpp"
#include "engine/study/fold_curve.hpp"
#include "engine/study/hopf_curve.hpp"
#include "engine/study/lyapunov.hpp"
#include "tests/catch.hpp"
#include "tests/engine/coupled_shafts.hpp"
#include "tests/engine/torque_parts.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

// Two shafts tied by a spring of free length zero, of which T drives the one and brakes the other:
// 4.5 N m sin(p - q) = per_torque T.
constexpr double per_torque = 1. / 3 + 0.05 * (2. / 3) / 0.25, strongest = 50 * 0.09;

Mechanism driven_and_braked() {
  Mechanism m = shafts(false);
  m.parameters.push_back({"T", "", 2, "N m", {}});
  m.joints[0].formulas[0].text = "T - 0.2 N m s * rate(p)";
  m.joints[1].formulas[0].text = "-T/3 - 0.05 N m s * rate(q)";
  m.forces[0].free_length = 0;
  m.points = {{"A", {0.3, 0, 0}}, {"B", {0.3, 0, 0.5}}};
  m.measures.push_back({"apart", "", "distance(a@A, b@B)", "m"});
  validate(m);
  return m;
}

double apart_at(double twist) {
  return std::sqrt(0.25 + 2 * 0.09 * (1 - std::cos(twist)));
}

double value_at(const ResponsePoint& p, std::string_view name) {
  return std::ranges::find(p.coordinates, name, &CoordinateSolution::joint)->value;
}

} // namespace

TEST_CASE("branches of states that stand turned go through their folds", "[phase][coupling]") {
  const Mechanism m = driven_and_braked();
  const double fold = strongest / per_torque;
  const ResponseDiagram d = follow_branches(m, "parameters.T", 1, 12);
  INFO(d.message);
  REQUIRE(d.status == Status::converged);
  CHECK_THAT(d.message, ContainsSubstring("stands turned against the drawn pose"));
  REQUIRE(d.branches.size() == 1);
  CHECK(d.branches[0].end == "the beginning of the range");
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::fold);
  CHECK_THAT(d.special[0].at.parameter, WithinRel(fold, 1e-12));
  CHECK_THAT(value_at(d.special[0].at, "p") - value_at(d.special[0].at, "q"),
             WithinAbs(1.5707963267948966, 1e-6));
  int beyond = 0;
  for (const ResponsePoint& p : d.branches[0].points) {
    CAPTURE(p.parameter);
    const double twist = value_at(p, "p") - value_at(p, "q");
    CHECK_THAT(strongest * std::sin(twist), WithinRel(per_torque * p.parameter, 1e-9));
    CHECK_THAT(std::ranges::find(p.coordinates, "q", &CoordinateSolution::joint)->speed.value(),
               WithinRel(2 * p.parameter / 3 / 0.25, 1e-9));
    if (p.parameter > 0.999 * fold) continue;
    CHECK(p.stable == (twist < 1.57));
    beyond += twist > 1.57 ? 1 : 0;
  }
  CHECK(beyond > 10);
  const ResponseDiagram whole = follow_branches(m, "parameters.T", 6, 1);
  REQUIRE(whole.branches.size() == 1);
  CHECK(whole.branches[0].points.back().parameter == 1);
  CHECK(whole.branches[0].end == "the end of the range");
}

TEST_CASE("along a ratio that ties the angles otherwise nothing is followed", "[phase][coupling]") {
  Mechanism m;
  const Vec3 axis(0, 1, 0), all(0.1, 0.1, 0.1);
  m.bodies = {body("a", 1, {0, 0, 0}, all), body("c", 1, {0, 0.3, 0}, all), body("b", 1, {0.3, 0, 0}, all),
              body("d", 1, {0.3, 0.3, 0}, all)};
  m.joints = {
      torque_driven(revolute("pa", "ground", "a", {0, 0, 0}, axis), 6, "3 N m - 0.4 N m s * rate(pa)"),
      revolute("pc", "ground", "c", {0, 0.3, 0}, axis),
      revolute("pb", "ground", "b", {0.3, 0, 0}, axis),
      revolute("pd", "ground", "d", {0.3, 0.3, 0}, axis),
      dampened(sprung(revolute("s", "a", "c", {0, 0.15, 0}, axis), 50), 0.2),
      dampened(sprung(revolute("t", "b", "d", {0.3, 0.15, 0}, axis), 80), 0.2),
      gear("g1", "pa", "pb", -1.5),
      gear("g2", "pc", "pd", -1.5)};
  m.joints[4].coordinates[0].spring->free = 0.1;
  m.parameters = {{"r", "", -1.5, "", {}}, {"K", "", 50, "N m/rad", {}}};
  for (Joint& joint : m.joints)
    if (joint.type == JointType::gear) joint.formulas = {{"ratio", "r"}};
  m.joints[4].formulas = {{"spring.stiffness", "K"}};
  validate(m);
  const ResponseDiagram refused = follow_branches(m, "parameters.r", -1.5, -1.2);
  CHECK(refused.status == Status::not_converged);
  CHECK(refused.branches.empty());
  CHECK(refused.turned);
  CHECK_THAT(refused.message, ContainsSubstring("A sweep solves at each value by itself."));
  CHECK(design(m, "parameters.r", -1.5, -1.2, "s", 0.03, {}).message == refused.message);
  const ResponseDiagram followed = follow_branches(m, "parameters.K", 50, 60);
  INFO(followed.message);
  REQUIRE(followed.branches.size() == 1);
  CHECK(followed.branches[0].points.back().parameter == 60);
}

TEST_CASE("design of states that stand turned, beyond a fold of theirs, too", "[phase][coupling]") {
  const Mechanism m = driven_and_braked();
  const double twist = GENERATE(0.5, 2.);
  CAPTURE(twist);
  const DesignAnswer wanted = design(m, "parameters.T", 1, 12, "apart", apart_at(twist), {});
  INFO(wanted.message);
  REQUIRE(wanted.solutions.size() == 1);
  const DesignSolution& s = wanted.solutions[0];
  CHECK_THAT(s.parameter, WithinRel(strongest * std::sin(twist) / per_torque, 1e-10));
  CHECK(s.at.stable == (twist < 1.57));
  REQUIRE(s.rate); // d apart / d twist over d T / d twist
  CHECK_THAT(
      *s.rate,
      WithinRel(0.09 * std::sin(twist) / apart_at(twist) / (strongest * std::cos(twist) / per_torque), 1e-7));
  const DesignAnswer never = design(m, "parameters.T", 1, 12, "apart", 2, {});
  CHECK(never.solutions.empty());
  CHECK(never.end == DesignEnd::never);
}

TEST_CASE("curves of folds and of values of states that stand turned", "[phase][coupling]") {
  const Mechanism m = driven_and_braked();
  const PlaneAxis torque{"parameters.T", 1, 12}, stiffness{"forces.k.stiffness", 30, 70};
  const PlaneCurves folds = fold_curves(m, torque, stiffness);
  INFO(folds.message);
  REQUIRE(folds.curves.size() == 1);
  CHECK(folds.curves[0].type == PlaneCurveType::fold);
  CHECK(folds.curves[0].points.size() > 5);
  CHECK_THAT(folds.curves[0].points.front().y, WithinAbs(30, 1e-9));
  CHECK_THAT(folds.curves[0].points.back().x, WithinAbs(12, 1e-9));
  for (const PlanePoint& p : folds.curves[0].points)
    CHECK_THAT(per_torque * p.x, WithinRel(0.09 * p.y, 1e-9));
  for (const double twist : {0.5, 2.}) {
    const PlaneCurves values = value_curves(m, torque, stiffness, "apart", apart_at(twist));
    CAPTURE(twist, values.message);
    REQUIRE(values.curves.size() == 1);
    CHECK(values.curves[0].points.size() > 5);
    for (const PlanePoint& p : values.curves[0].points) {
      CHECK_THAT(per_torque * p.x, WithinRel(0.09 * p.y * std::sin(twist), 1e-9));
      CHECK(p.stable == (twist < 1.57));
    }
  }
}

TEST_CASE("where a load that eggs itself on makes two coupled shafts hunt", "[phase][coupling][hopf]") {
  const double first = 0.3, second = 0.2, drag = 1, stiffness = 10;
  Mechanism m;
  m.parameters = {{"d", "", 0.3, "N m s", {}}, {"loss", "", 0.07, "N m s", {}}};
  m.bodies = {body("a", 1, {0, 0, 0}, {0.1, 0.1, first}), body("b", 1, {0, 0, 0.5}, {0.1, 0.1, second})};
  Joint coupling = dampened(sprung(revolute("c", "a", "b", {0, 0, 0.5}, {0, 0, 1}), stiffness), 0.1);
  coupling.formulas.push_back({"damping", "loss"});
  m.joints = {torque_driven(hinge("p", "ground", "a"), 5, "5 N m - 1 N m s * rate(p)"),
              torque_driven(revolute("q", "ground", "b", {0, 0, 0.5}, {0, 0, 1}), 5,
                            "-4 N m + d * rate(q) - 0.002 N m s^3 * rate(q)^3"),
              coupling};
  // What is left of the condition for a pair on the axis by the characteristic polynomial, its zero taken
  // out: a3 x^3 + a2 x^2 + a1 x + a0; and the frequency.
  const auto speed_at = [&](double d) { // 1 - w + d w - 0.002 w^3 = 0
    double w = 2;
    for (int i = 0; i < 100; ++i)
      w -= (1 - w + d * w - 0.002 * w * w * w) / (-1 + d - 0.006 * w * w);
    return w;
  };
  const auto routh = [&](double d, double loss) {
    const double w = speed_at(d), c1 = drag, c2 = -d + 0.006 * w * w;
    const double a2 = first * (c2 + loss) + second * (c1 + loss),
                 a1 = stiffness * (first + second) + c1 * c2 + loss * (c1 + c2), a0 = stiffness * (c1 + c2),
                 a3 = first * second;
    return std::pair{(a2 * a1 - a0 * a3) / (a2 * a1), std::sqrt(a1 / a3)};
  };
  m.points = {{"A", {0.3, 0, 0}}};
  validate(m);
  const ResponseDiagram d = follow_branches(m, "parameters.d", 0.3, 1.1);
  INFO(d.message);
  REQUIRE(d.status == Status::converged);
  REQUIRE(d.special.size() == 2); // it begins, and ends again
  for (const SpecialPoint& s : d.special) {
    CAPTURE(s.at.parameter);
    CHECK(s.type == SpecialPointType::hopf);
    const auto [left, frequency] = routh(s.at.parameter, 0.07);
    CHECK(std::abs(left) < 1e-9);
    CHECK_THAT(hopf_frequency(s.at.eigenvalues), WithinRel(frequency, 1e-6));
  }
  const PlaneAxis x{"parameters.d", 0.3, 1.1}, y{"parameters.loss", 0.05, 0.15};
  const PlaneCurves curves = hopf_curves(m, x, y, {});
  INFO(curves.message);
  REQUIRE(curves.curves.size() == 1);
  const std::vector<PlanePoint>& points = curves.curves[0].points;
  CHECK(points.size() > 10);
  CHECK_THAT(points.front().y, WithinAbs(0.05, 1e-12));
  CHECK_THAT(points.back().y, WithinAbs(0.05, 1e-12));
  bool soft = false, hard = false;
  for (const PlanePoint& p : points) {
    CAPTURE(p.x, p.y);
    const auto [left, frequency] = routh(p.x, p.y);
    CHECK(std::abs(left) < 1e-8);
    REQUIRE(p.hopf);
    CHECK_THAT(p.hopf->frequency, WithinRel(frequency, 1e-6));
    // By hand, with the twist and the two speeds beside the state.
    const double w = speed_at(p.x);
    const auto motion = [&](const Eigen::VectorXd& at, Eigen::VectorXd& rate) {
      const double a = w + at[1], b = w + at[2],
                   twist = (p.x * w - 4 - 0.002 * w * w * w) / stiffness + at[0],
                   tie = stiffness * twist + p.y * (b - a);
      rate.resize(3);
      rate << b - a, (5 - drag * a + tie) / first, (-4 + p.x * b - 0.002 * b * b * b - tie) / second;
      return true;
    };
    const auto expected = first_lyapunov_coefficient(motion, 3, frequency);
    REQUIRE(expected);
    const HopfPoint::Coordinate& unit = p.hopf->coordinate;
    const double swings = unit.joint == "c" ? std::abs(expected->q[0]) // rad
                                            : std::abs(expected->q[unit.joint == "p" ? 1 : 2]) / frequency;
    CAPTURE(unit.joint);
    REQUIRE(p.hopf->lyapunov);
    CHECK_THAT(*p.hopf->lyapunov, WithinRel(expected->value / (4 * swings * swings), 1e-5));
    soft = soft || p.hopf->loss() == HopfLoss::soft;
    hard = hard || p.hopf->loss() == HopfLoss::hard;
  }
  CHECK(soft);
  CHECK(hard);
}
