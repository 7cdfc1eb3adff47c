// Rates of the balance with the mechanism's numbers, by forward-mode differentiation through expressions,
// densities, frames and drawn lengths, against differences of the balance in extended precision and closed
// forms.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/system/balance_rate.hpp"
#include "engine/system/extended.hpp"

#include <random>

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

using ExtendedVector = Configuration<Extended>;

// The balance of a mechanism at a state that is held: forces, then loops.
ExtendedVector balance_of(const System& system, const Mechanism& m, const Eigen::VectorXd& q,
                          const Eigen::VectorXd& lambda) {
  Parameters numbers;
  bind(system, m, numbers);
  const ExtendedVector at = q.cast<Extended>(), multipliers = lambda.cast<Extended>();
  Kinematics<Extended> kinematics;
  Residual<Extended> residual;
  forward<Extended>(system, numbers, at, 0, kinematics);
  evaluate_residual<Extended>(system, numbers, at, multipliers, kinematics, residual);
  ExtendedVector all(residual.f.size() + residual.phi.size());
  all << residual.f, residual.phi;
  return all;
}

// Central differences, extrapolated from three steps to none (Richardson).
Eigen::VectorXd differences(const System& system, const Mechanism& m, const std::string& address,
                            const Eigen::VectorXd& q, const Eigen::VectorXd& lambda, double h) {
  Mechanism varied = m;
  VariedNumbers number(varied, {&address, 1});
  const double value = get_parameter(m, address);
  std::vector<ExtendedVector> of_step;
  for (const double step : {h, h / 2, h / 4}) {
    const double sides[2]{value + step, value - step};
    ExtendedVector all[2];
    for (const int i : {0, 1}) {
      number.set({&sides[i], 1});
      all[i] = balance_of(system, varied, q, lambda);
    }
    of_step.push_back((all[0] - all[1]) / (Extended(sides[0]) - Extended(sides[1])));
  }
  const ExtendedVector a = (Extended(4) * of_step[1] - of_step[0]) / Extended(3);
  const ExtendedVector b = (Extended(4) * of_step[2] - of_step[1]) / Extended(3);
  return ((Extended(16) * b - a) / Extended(15)).cast<double>();
}

struct Compared {
  int numbers = 0, moving = 0, kinks = 0;
};

// Every number of the mechanism, at a state beside the drawn pose with arbitrary multipliers.
Compared compare_all(const Mechanism& m, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Mechanism mechanism = m; // stands still: rates are kept under the numbers' places
  const System system = compile(mechanism);
  Parameters numbers;
  bind(system, mechanism, numbers);
  Eigen::VectorXd q;
  drawn_configuration(system, numbers, q);
  const Eigen::VectorXd step = Eigen::VectorXd::NullaryExpr(system.nv, [&] { return 0.1 * any(random); });
  retract<double>(system, step, q);
  const Eigen::VectorXd lambda = Eigen::VectorXd::NullaryExpr(system.rows, [&] { return 10 * any(random); });
  const double size = 1 + balance_of(system, mechanism, q, lambda).cast<double>().lpNorm<Eigen::Infinity>();
  Compared compared;
  BalanceRate balance;
  NumberRates rates;
  for (const std::string& address : parameter_addresses(mechanism)) {
    INFO(address);
    const double value = get_parameter(mechanism, address);
    // Which direction across a cut joint's axis is the first jumps where two of its components are alike; it
    // turns the rows of the loop, not what they say.
    if (value == 0 && address.find(".axis.") != std::string::npos) continue;
    const double scale = std::abs(value) > 1e-6 ? std::abs(value) : 1e-2, h = scale / 512;
    VariedNumbers(mechanism, {&address, 1}).rates(0, rates);
    balance.evaluate(system, mechanism, rates, numbers, q, lambda);
    Eigen::VectorXd found(system.nv + system.rows);
    found << balance.force(), balance.phi();
    const Eigen::VectorXd expected = differences(system, mechanism, address, q, lambda, h);
    const double rounding = 3e-11 * (size / scale + expected.lpNorm<Eigen::Infinity>());
    ++compared.numbers;
    // A stop begins, or a table has a knot, within the steps: they tell nothing.
    if (!((found - expected).lpNorm<Eigen::Infinity>() < rounding) &&
        (differences(system, mechanism, address, q, lambda, h / 3) - expected).lpNorm<Eigen::Infinity>() >
            rounding / 3) {
      ++compared.kinks;
      continue;
    }
    CHECK((found - expected).lpNorm<Eigen::Infinity>() < rounding);
    if (found.lpNorm<Eigen::Infinity>() > 0) ++compared.moving;
  }
  return compared;
}

} // namespace

TEST_CASE("the balance's rates are exact in every number of random mechanisms", "[sensitivity]") {
  std::mt19937 random(7);
  Compared all;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    ref::RandomOptions options;
    options.loops = static_cast<int>(seed % 3);
    options.steady = false;
    options.skew_universals = true;
    options.air = seed % 2 == 1;
    options.drives = seed % 4 == 0 ? ref::RandomDrives::several : ref::RandomDrives::root;
    const Compared one = compare_all(ref::random_mechanism(seed, options), random);
    all.numbers += one.numbers;
    all.moving += one.moving;
    all.kinks += one.kinks;
  }
  CHECK(all.numbers > 3000);
  CHECK(all.kinks < all.numbers / 200);
  CHECK(all.moving > 1000);
}

TEST_CASE("the balance's rates are exact in the numbers of the shipped scenes", "[sensitivity]") {
  std::mt19937 random(11);
  for (const char* name : {"governor_parametric", "governor_watt", "governor_porter", "governor_proell",
                           "governor_hartnell", "governor_engine", "rate_gyro", "fourbar_turntable"}) {
    CAPTURE(name);
    CHECK(compare_all(shipped(name), random).moving > 5);
  }
}

TEST_CASE("expressions, densities and drawn lengths pass rates on", "[sensitivity]") {
  // A cone of a pendulum: a ball of radius r on a massless arm of length L, both from parameters.
  const std::string text = R"({
    "flyball": 2, "name": "cone", "gravity": [0, -9.81, 0],
    "parameters": {"L": {"value": 0.7, "unit": "m"}, "r": {"value": 0.05, "unit": "m"},
                   "rho": {"value": 7850, "unit": "kg/m^3"}},
    "bodies": [{"name": "frame", "mass": 0, "position": [0, 0, 0]},
               {"name": "ball", "density": "=rho",
                "shapes": [{"type": "sphere", "radius": "=r", "at": [0, "=-L", 0]}]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "frame"], "at": [0, 0, 0],
                "axis": [0, 1, 0], "drive": {"speed": 6}},
               {"name": "arm", "type": "revolute", "bodies": ["frame", "ball"], "at": [0, 0, 0],
                "axis": [0, 0, 1]}],
    "sliders": [{"parameter": "parameters.L", "range": [0.5, 1]}, {"parameter": "parameters.r", "range": [0.01, 0.1]},
                {"parameter": "parameters.rho", "range": [1000, 9000]},
                {"parameter": "joints.spin.drive.speed", "range": [5, 9]}]})";
  const Mechanism m = parse_scene(text);
  const double L = 0.7, r = 0.05, w = 6, g = 9.81;
  const Solution s = solve(m, from("arm", 0.8));
  REQUIRE(s.status == Status::converged);
  // About the joint: cos(a) w^2 (L^2 + J/m - J/m) = g L; the ball's inertia is the same about all axes and
  // does not matter, so cos(a) = g / (w^2 L).
  const double cosine = g / (w * w * L), sine = std::sqrt(1 - cosine * cosine);
  const auto rate = [&](std::size_t i) { return s.sensitivities.at(i).rates.at(0).value; };
  REQUIRE(s.sensitivities.size() == 4);
  CHECK(rate(0) == Approx(cosine / (L * sine)).epsilon(1e-13));
  CHECK(std::abs(rate(1)) < 1e-13);
  CHECK(std::abs(rate(2)) < 1e-16);
  CHECK(rate(3) == Approx(2 * cosine / (w * sine)).epsilon(1e-13));

  Mechanism copy = m;
  const std::vector<std::string> radius{"parameters.r"};
  const VariedNumbers numbers(copy, radius);
  NumberRates rates;
  numbers.rates(0, rates);
  const Body& ball = copy.bodies[static_cast<std::size_t>(body_index(copy, "ball"))];
  constexpr double rho = 7850, pi = std::numbers::pi;
  const double mass = 4 * pi / 3 * rho * r * r * r, mass_rate = 4 * pi * rho * r * r;
  CHECK(rates.find(place_of(ball.mass)).value() == Approx(mass_rate).epsilon(1e-14));
  CHECK(rates.find(place_of(ball.inertia[0])).value() ==
        Approx(0.4 * (mass_rate * r * r + 2 * mass * r)).epsilon(1e-14));
  CHECK(std::abs(rates.find(place_of(ball.position[1])).value()) < 1e-16);
}

TEST_CASE("a number that may be absent is known by one place", "[sensitivity]") {
  const std::optional<double> number = 1;
  CHECK(place_of(number) == place_of(*number));
  const std::optional<Vec3> vector = Vec3(1, 2, 3);
  for (const int i : {0, 1, 2})
    CHECK(place_of(vector, i) == place_of((*vector)[i]));
}

TEST_CASE("an expression at the origin of hypot and atan2 takes no other number's rate", "[sensitivity]") {
  Mechanism m = shipped("governor_parametric");
  m.parameters.push_back({"zero", "", 0, "m", {}});
  m.bodies.back().formulas = {{"mass", "2 kg + 1 kg/m * hypot(zero, zero) + 1 kg * atan2(zero, zero)"}};
  evaluate_formulas(m);
  const auto rate_of_mass = [&](const std::string& address) {
    NumberRates rates;
    VariedNumbers(m, {&address, 1}).rates(0, rates);
    return rates.find(place_of(m.bodies.back().mass)).value_or(0);
  };
  CHECK(rate_of_mass("parameters.w") == 0);
  m.bodies.back().formulas = {{"mass", "2 kg + 1 kg/m * hypot(3 * zero, 4 * zero)"}};
  CHECK(rate_of_mass("parameters.zero") == Approx(5).epsilon(1e-15)); // out of the origin
}

TEST_CASE("a number without a finite rate is named", "[sensitivity]") {
  Mechanism m = shipped("governor_parametric");
  m.parameters.push_back({"zero", "", 0, "", {}});
  m.bodies.back().formulas = {{"mass", "2 kg * (1 + sqrt(zero))"}};
  evaluate_formulas(m);
  const std::string address = "parameters.zero";
  NumberRates rates;
  const VariedNumbers numbers(m, {&address, 1});
  CHECK_THROWS_WITH(numbers.rates(0, rates), ContainsSubstring("rate of change is not finite") &&
                                                 ContainsSubstring("bodies." + m.bodies.back().name));
  // The others' rates stay.
  const std::size_t told = solve(m).sensitivities.size();
  REQUIRE(told > 0);
  m.sliders.push_back({address, 0, 1, SliderScale::linear, ""});
  const Solution s = solve(m);
  CHECK(s.status == Status::converged);
  CHECK(s.sensitivities.size() == told);
}
