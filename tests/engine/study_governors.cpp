// The four classical governors as parametric scenes, against the closed forms of textbooks (R. S. Khurmi, J.
// K. Gupta, Theory of Machines, chapter 18): height, sensitivity, effort and power, isochronism.
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/design.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double g = 9.80665;
using Numbers = std::vector<std::pair<std::string, double>>;

double number(const Mechanism& m, const std::string& parameter) {
  return get_parameter(m, "parameters." + parameter);
}

// Angle of an arm that carries its ball, and the ball's distance from the axis.
struct Arm {
  double angle = 0, radius = 0;
  double height() const { return radius / std::tan(angle); } // below the apex of the cone
};

Arm hanging_arm(const Mechanism& m, const Solution& solution) {
  const double angle = value(solution, "arm1");
  return {angle, number(m, "e") + number(m, "L") * std::sin(angle)};
}

// Also of an unstable state.
SolveOptions nearest() {
  SolveOptions options;
  options.nearest = true;
  return options;
}

DesignOptions connected() {
  DesignOptions options;
  options.all = false;
  return options;
}

// Of the solutions the one with both balls outside: the mechanisms can be put together with one of them
// inside.
const DesignSolution& both_outside(const DesignAnswer& answer) {
  const auto found = std::ranges::find_if(answer.solutions, [](const DesignSolution& s) {
    const auto angle = [&](const std::string& side) {
      for (const CoordinateSolution& c : s.at.coordinates)
        if (c.angle && !c.driven && c.joint.ends_with(side)) return c.value;
      return 0.;
    };
    return std::abs(angle("1") - angle("2")) < 1e-6;
  });
  REQUIRE(found != answer.solutions.end());
  return *found;
}

// The speed (rad/s) at which the sleeve stands there.
double speed_for_lift(const Mechanism& m, double lift, double from, double to) {
  const DesignAnswer answer = design(m, "parameters.w", from, to, "lift", lift, connected());
  INFO(answer.message);
  return both_outside(answer).parameter;
}

// The force (N) on the sleeve that keeps it where it is when the speed has risen by the share `rise`.
double force_at_rise(Mechanism m, double rise) {
  const Solution before = Analysis(m).solve({});
  REQUIRE(before.status == Status::converged);
  set_parameter(m, "parameters.w", (1 + rise) * number(m, "w"));
  const DesignAnswer answer = design(m, "parameters.E", 0, 50, "lift", value(before, "lift"), connected());
  INFO(answer.message);
  return both_outside(answer).parameter;
}

} // namespace

TEST_CASE("Watt's governor stands at g over the square of the speed, whatever it weighs") {
  for (const Numbers& changes : {Numbers{}, Numbers{{"parameters.w", 6.5}}, Numbers{{"parameters.w", 13}},
                                 Numbers{{"parameters.m", 0.7}}, Numbers{{"parameters.L", 0.42}},
                                 Numbers{{"parameters.e", 0}, {"parameters.w", 9}}}) {
    const Mechanism m = shipped("governor_watt", changes);
    const Solution solution = Analysis(m).solve({});
    INFO(solution.message);
    REQUIRE(solution.status == Status::converged);
    const double w = number(m, "w");
    CHECK(hanging_arm(m, solution).height() == Approx(g / (w * w)).epsilon(1e-12));
    CHECK(solution.stable == true);
  }
}

TEST_CASE("Porter's governor: its height, with arms and links that differ, too") {
  for (const Numbers& changes : {Numbers{}, Numbers{{"parameters.M", 30}, {"parameters.w", 21}},
                                 Numbers{{"parameters.l", 0.31}, {"parameters.d", 0.05}},
                                 Numbers{{"parameters.m", 5}, {"parameters.L", 0.33}}}) {
    Mechanism m = shipped("governor_porter");
    for (const auto& [address, to] : changes) {
      if (const std::string name = address.substr(11); name == "l" || name == "d")
        m.parameters[static_cast<std::size_t>(parameter_index(m, name))].formulas.clear();
      set_parameter(m, address, to);
    }
    const Solution solution = Analysis(m).solve({});
    INFO(solution.message);
    REQUIRE(solution.status == Status::converged);
    const Arm arm = hanging_arm(m, solution);
    const double w = number(m, "w"), ball = number(m, "m"), sleeve = number(m, "M");
    const double in = arm.radius - number(m, "d"), link = number(m, "l");
    const double k = in / std::sqrt(link * link - in * in) / std::tan(arm.angle);
    CHECK(arm.height() ==
          Approx((ball + sleeve / 2 * (1 + k)) / ball * g / (w * w)).epsilon(1e-12)); // Khurmi 18.6
    CHECK(solution.stable == true);
  }
}

TEST_CASE("Porter's governor: sensitivity, effort and power") {
  const Mechanism m = shipped("governor_porter");
  const Solution solution = Analysis(m).solve({});
  REQUIRE(solution.status == Status::converged);
  const double w = number(m, "w"), weight = (number(m, "m") + number(m, "M")) * g;
  const double lift = value(solution, "lift");

  // Sensitivity: the range of speeds over their mean that a range of lifts takes, from heights alone. The
  // sleeve moves twice as far as the balls, and the apex moves with them where the pivots are off the axis.
  const auto speed_at = [&](double at) {
    // Half the distance between pivots and pins is how far the balls hang below the pivots.
    const double below = (0.55 - at) / 2, arm = number(m, "L");
    const double out = std::sqrt(arm * arm - below * below);
    const double h = below * (1 + number(m, "e") / out);
    return std::sqrt(weight / (number(m, "m") * h));
  };
  const double slow = speed_for_lift(m, lift - 0.02, 14, 20), fast = speed_for_lift(m, lift + 0.02, 14, 20);
  CHECK(slow == Approx(speed_at(lift - 0.02)).epsilon(1e-12));
  CHECK(fast == Approx(speed_at(lift + 0.02)).epsilon(1e-12));
  const double sensitivity = 2 * (fast - slow) / (fast + slow);
  CHECK(sensitivity == Approx(2 * (speed_at(lift + 0.02) - speed_at(lift - 0.02)) /
                              (speed_at(lift + 0.02) + speed_at(lift - 0.02)))
                           .epsilon(1e-10));

  // Effort: the mean force on the sleeve while a hundredth more speed lifts it, c (m + M) g but for c^2 / 2.
  const double c = 0.01, force = force_at_rise(m, c);
  CHECK(force == Approx(((1 + c) * (1 + c) - 1) * weight).epsilon(1e-9));
  CHECK(force / 2 == Approx(c * weight).epsilon(0.51 * c));

  // Power: effort times the lift that this speed brings; with pivots on the axis 4 c^2 / (1 + 2 c) (m + M) g
  // h.
  const Mechanism on_axis = shipped("governor_porter", {{"parameters.e", 0}});
  Mechanism faster = on_axis;
  set_parameter(faster, "parameters.w", (1 + c) * w);
  const Solution low = Analysis(on_axis).solve({}), high = Analysis(faster).solve({});
  const double rise = value(high, "lift") - value(low, "lift");
  const double axis_height = hanging_arm(on_axis, low).height();
  CHECK(rise == Approx(2 * axis_height * (1 - 1 / ((1 + c) * (1 + c)))).epsilon(1e-10));
  CHECK(force_at_rise(on_axis, c) / 2 * rise ==
        Approx(4 * c * c / (1 + 2 * c) * weight * axis_height).epsilon(2 * c));
}

TEST_CASE("Watt's effort is the weight of its balls") {
  // Links at two thirds of the arms: the sleeve moves 4/3 as far as the balls where arms and links are alike.
  const Mechanism m = shipped("governor_watt");
  const double c = 0.01;
  CHECK(force_at_rise(m, c) ==
        Approx(((1 + c) * (1 + c) - 1) * 2 * number(m, "m") * g * 3 / 4).epsilon(1e-9));
}

TEST_CASE("Proell's governor: the speed at which the balls stand above the knees") {
  for (const Numbers& changes : {Numbers{}, Numbers{{"parameters.b", 0.14}}, Numbers{{"parameters.M", 4}},
                                 Numbers{{"parameters.b", 0.01}, {"parameters.m", 5}}}) {
    Mechanism m = shipped("governor_proell", changes);
    const double a = std::numbers::pi * 35 / 180, ball = number(m, "m"), arm = number(m, "L");
    const double knee = number(m, "l") * std::cos(a); // above the pin of the sleeve: FM, and BM = FM + b
    const double h = (number(m, "e") + arm * std::sin(a)) / std::tan(a);
    const double square =
        knee / (knee + number(m, "b")) * (ball + number(m, "M")) / ball * g / h; // Khurmi 18.7
    const double expected = std::sqrt(square);
    set_parameter(m, "parameters.w", expected);
    const Solution solution = Analysis(m).solve(nearest());
    INFO(solution.message);
    REQUIRE(solution.status == Status::converged);
    CHECK(std::abs(value(solution, "foot1")) < 1e-11);
    CHECK(std::abs(value(solution, "foot2")) < 1e-11);
  }
}

TEST_CASE("Proell's governor elsewhere: moments about the instantaneous centre of the link") {
  const Mechanism m = shipped("governor_proell", {{"parameters.w", 16.5}});
  const Solution solution = Analysis(m).solve({});
  INFO(solution.message);
  REQUIRE(solution.status == Status::converged);
  // In the plane of arm and link, from the axis and from the foot.
  const double turn = value(solution, "foot1"), pin = value(solution, "lift"), e = number(m, "e");
  const double a = std::numbers::pi * 35 / 180, link = number(m, "l"), up = number(m, "b");
  const double drawn_x = link * std::sin(a), drawn_y = link * std::cos(a);
  const auto turned = [&](double x, double y) { // outwards positive
    return std::pair(e + x * std::cos(turn) + y * std::sin(turn),
                     pin + y * std::cos(turn) - x * std::sin(turn));
  };
  const auto [knee_x, knee_y] = turned(drawn_x, drawn_y);
  const auto [ball_x, ball_y] = turned(drawn_x, drawn_y + up);
  CHECK(std::hypot(knee_x - e, knee_y - 0.5) == Approx(number(m, "L")).epsilon(1e-12));
  // Where the line of the arm meets the level of the sleeve's pins.
  const double centre_x = e + (knee_x - e) * (0.5 - pin) / (0.5 - knee_y);
  const double w = number(m, "w"), ball = number(m, "m");
  CHECK(ball * w * w * ball_x * (ball_y - pin) ==
        Approx(ball * g * (centre_x - ball_x) + number(m, "M") * g / 2 * (centre_x - e)).epsilon(1e-11));
}

TEST_CASE("Hartnell's governor: forces of its spring, its stiffness from two speeds") {
  for (const double weight : {0., g}) {
    double lift[2], centrifugal[2], radius[2];
    Mechanism m = shipped("governor_hartnell", {{"gravity.1", -weight}});
    const double arm = number(m, "a"), short_arm = number(m, "b"), ball = number(m, "m");
    for (const int i : {0, 1}) {
      set_parameter(m, "parameters.w", i == 0 ? 29.5 : 30.5);
      const Solution solution = Analysis(m).solve({});
      INFO(solution.message);
      REQUIRE(solution.status == Status::converged);
      CHECK(solution.stable == true);
      const double angle = value(solution, "lever1"), w = number(m, "w");
      lift[i] = value(solution, "lift");
      radius[i] = number(m, "R") + arm * std::sin(angle);
      centrifugal[i] = ball * w * w * radius[i];
      CHECK(lift[i] == Approx(short_arm * std::sin(angle)).margin(1e-13));
      CHECK((number(m, "M") * weight + number(m, "S") + number(m, "k") * lift[i]) / 2 * short_arm ==
            Approx(centrifugal[i] * arm + ball * weight * arm * std::tan(angle)).epsilon(1e-11));
    }
    if (weight == 0) // 2 (a/b)^2 (F1 - F2) / (r1 - r2), where the weight of the balls is left out
      CHECK(2 * arm * arm / (short_arm * short_arm) * (centrifugal[1] - centrifugal[0]) /
                (radius[1] - radius[0]) ==
            Approx(number(m, "k")).epsilon(1e-9));
  }
}

TEST_CASE("Hartnell's governor is isochronous where its spring is slack with the balls on the axis") {
  Mechanism m = shipped("governor_hartnell", {{"gravity.1", 0}});
  const double arm = number(m, "a"), short_arm = number(m, "b"), ball = number(m, "m"), k = number(m, "k");
  const double isochronous = k * short_arm * number(m, "R") / arm; // N
  const auto speed_at = [&](double preload, double lift) {
    return std::sqrt((preload + k * lift) * short_arm /
                     (2 * ball * arm * (number(m, "R") + lift * arm / short_arm)));
  };
  // Sensitivity falls with the distance from that preload, from either side, and changes its sign there: with
  // more preload than that a higher lift needs a lower speed, and the governor is unstable.
  for (const double share : {0.8, 0.99, 1.01, 1.2}) {
    const double preload = share * isochronous;
    set_parameter(m, "parameters.S", preload);
    const double low = speed_for_lift(m, -0.01, 10, 60), high = speed_for_lift(m, 0.01, 10, 60);
    CHECK(low == Approx(speed_at(preload, -0.01)).epsilon(1e-11));
    CHECK(high == Approx(speed_at(preload, 0.01)).epsilon(1e-11));
    CHECK((high > low) == (share < 1));
    set_parameter(m, "parameters.w", speed_at(preload, 0));
    const Solution solution = Analysis(m).solve(nearest());
    INFO(solution.message);
    REQUIRE(solution.status == Status::converged);
    CHECK(value(solution, "lift") == Approx(0).margin(1e-9));
    CHECK(solution.stable == (share < 1));
  }
  // At it every lift is a steady state at one and the same speed.
  set_parameter(m, "parameters.S", isochronous);
  set_parameter(m, "parameters.w", std::sqrt(k / (2 * ball)) * short_arm / arm);
  for (const double angle : {-0.2, 0.1, 0.3}) {
    SolveOptions there = nearest();
    const double lift = short_arm * std::sin(angle), in = short_arm * (1 - std::cos(angle));
    there.start = {{"lever1", angle}, {"lever2", angle}, {"lift", lift}, {"groove1", in}, {"groove2", in}};
    const Solution solution = Analysis(m).solve(there);
    INFO(solution.message);
    REQUIRE(solution.status == Status::converged);
    CHECK(value(solution, "lever1") == Approx(angle).margin(1e-9));
    CHECK_FALSE(solution.stable.has_value());
  }
}
