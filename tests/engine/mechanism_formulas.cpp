// Expressions and what they give: closed forms, derivatives by complex step, mistakes by their place, files.
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/mechanism/varied_numbers.hpp"

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <random>

using namespace flyball;

namespace {

const std::string parametric = FLYBALL_ASSETS "/scenes/governor_parametric.json";

Mechanism with_lengths() {
  Mechanism m;
  m.name = "m";
  m.parameters = {{"L", "", 0.3, "m", {}, {}}, {"a", "", 0.5, "rad", {}, {}}, {"n", "", 3, "", {}, {}}};
  m.points = {{"A", {1, 2, 3}, {}}};
  return m;
}

double value_of(const std::string& text, const std::string& unit) {
  return evaluate_expression(with_lengths(), text, unit, "here");
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

std::string mistake_in(const std::string& text, const std::string& unit) {
  return error_of([&] { value_of(text, unit); });
}

// An expression over x and y with its value for complex x: the two are built side by side.
struct Built {
  std::string text;
  std::function<std::complex<double>(std::complex<double>)> value;
};

class Builder {
  using C = std::complex<double>;

 public:
  explicit Builder(unsigned seed) : random_(seed) {}

  Built expression(int depth) {
    switch (depth == 0 ? below(3) : below(11)) {
    case 0: return {"x", [](C x) { return x; }};
    case 1: return {"y", [](C) { return C(1.7); }};
    case 2: {
      const int n = 1 + below(9);
      return {std::to_string(n), [n](C) { return C(n); }};
    }
    case 3: return both(depth, " + ", [](C a, C b) { return a + b; });
    case 4: return both(depth, "-", [](C a, C b) { return a - b; });
    case 5: return both(depth, "*", [](C a, C b) { return a * b; });
    case 6: return both(depth, " / ", [](C a, C b) { return a / b; });
    case 7: return of(depth, "sin", [](C a) { return std::sin(a); });
    case 8: return of(depth, "tanh", [](C a) { return std::tanh(a); });
    case 9: return of(depth, "atan", [](C a) { return std::atan(a); });
    default: {
      const Built inside = expression(depth - 1);
      return {"sqrt(1+(" + inside.text + ")^2)",
              [inside](C x) { return std::sqrt(1. + inside.value(x) * inside.value(x)); }};
    }
    }
  }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  Built both(int depth, const std::string& sign, const std::function<C(C, C)>& act) {
    const Built a = expression(depth - 1), b = expression(depth - 1);
    return {"(" + a.text + ")" + sign + "(" + b.text + ")",
            [a, b, act](C x) { return act(a.value(x), b.value(x)); }};
  }
  Built of(int depth, const std::string& name, const std::function<C(C)>& act) {
    const Built inside = expression(depth - 1);
    return {name + "(" + inside.text + ")", [inside, act](C x) { return act(inside.value(x)); }};
  }

  std::mt19937 random_;
};

} // namespace

TEST_CASE("Expressions are arithmetic with units, the usual functions and names") {
  using std::numbers::pi;
  CHECK(value_of("1 + 2*3^2", "") == 19);
  CHECK(value_of("-2^2", "") == -4);
  CHECK(value_of("2^3^2", "") == 512);
  CHECK(value_of("2^-1", "") == 0.5);
  CHECK(value_of("8 - 4 - 2", "") == 2);
  CHECK(value_of("(1 + 2) * 3", "") == 9);
  CHECK(value_of(" -+ 1e-3 ", "") == -1e-3);
  CHECK(value_of("160 mm", "m") == 0.16);
  CHECK(value_of("160mm", "m") == 0.16);
  CHECK(value_of("L + 20 mm", "m") == 0.3 + 0.02);
  CHECK(value_of("300 rpm", "rad/s") == 300 * (pi / 30));
  CHECK(value_of("180°", "rad") == 180 * (pi / 180));
  CHECK(value_of("10 N/mm", "N/m") == 10 / 1e-3);
  CHECK(value_of("3 kg m^2 / 2 s^2", "N m") == 1.5);
  CHECK(value_of("L*cos(a)", "m") == 0.3 * std::cos(0.5));
  CHECK(value_of("A.x - A.z", "m") == -2);
  CHECK(value_of("sqrt(L*L)", "m") == std::sqrt(0.3 * 0.3));
  CHECK(value_of("(L^2)^(0.5)", "m") == std::sqrt(0.3 * 0.3));
  CHECK(value_of("hypot(L, 0.4)", "m") == std::hypot(0.3, 0.4));
  CHECK(value_of("atan2(L, L)", "rad") == pi / 4);
  CHECK(value_of("max(min(n, 5), 2)", "") == 3);
  CHECK(value_of("log(exp(n))", "") == 3);
  CHECK(value_of("2*pi", "rad/s") == 2 * pi); // a plain number fits anything
}

TEST_CASE("What is wrong with an expression is said by its place") {
  CHECK_THAT(mistake_in("L + a", "m"), ContainsSubstring("here: \"=L + a\": cannot add m and a number"));
  CHECK_THAT(mistake_in("L*L", "m"), ContainsSubstring("expected m, found m^2"));
  CHECK_THAT(mistake_in("sin(L)", ""), ContainsSubstring("as the argument of sin, found m"));
  CHECK_THAT(mistake_in("2^L", ""), ContainsSubstring("as an exponent, found m"));
  CHECK_THAT(mistake_in("L^n", "m"), ContainsSubstring("expected a number as the exponent of m"));
  CHECK_THAT(mistake_in("l", "m"), ContainsSubstring("there is no parameter \"l\"; did you mean \"L\"?"));
  CHECK_THAT(mistake_in("2 N*m", "N m"),
             ContainsSubstring(
                 "there is no parameter \"m\"; units follow their number without a sign, as in 2 N m"));
  CHECK_THAT(mistake_in("A", "m"), ContainsSubstring("A.x, A.y or A.z"));
  CHECK_THAT(mistake_in("sinus(a)", ""), ContainsSubstring("no function \"sinus\"; did you mean \"sin\"?"));
  CHECK_THAT(mistake_in("1/0", ""), ContainsSubstring("not finite"));
  CHECK_THAT(mistake_in("sqrt(-1)", ""), ContainsSubstring("not finite"));
  CHECK_THAT(mistake_in("1 + ", ""),
             ContainsSubstring("column 5: expected a number, a name or (, found the end"));
  CHECK_THAT(
      mistake_in("2 + 1e400", ""),
      ContainsSubstring("column 5: expected a number of a size between 1e-307 and 1e308, found \"1e400\""));
  CHECK_THAT(mistake_in("2 L", "m"), ContainsSubstring("column 3: expected an operator or a unit"));
  CHECK_THAT(mistake_in("L L", "m"), ContainsSubstring("column 3: expected an operator"));
  CHECK_THAT(mistake_in("atan2(L)", ""), ContainsSubstring("another argument of atan2"));
  CHECK_THAT(mistake_in("(1", ""), ContainsSubstring("expected )"));
  CHECK_THAT(mistake_in("", ""), ContainsSubstring("found the end"));
  // However deep, and however long.
  CHECK_THAT(mistake_in(std::string(100'000, '('), ""), ContainsSubstring("fewer parentheses"));
  CHECK_THAT(mistake_in("2" + std::string(100'000, '^'), ""), ContainsSubstring("column"));
  std::string powers = "2";
  for (int i = 0; i < 100'000; ++i)
    powers += "^2";
  CHECK_THAT(mistake_in(powers, ""), ContainsSubstring("a simpler expression"));
  CHECK(value_of(std::string(100'001, '-') + "1", "") == -1);
}

TEST_CASE("Rates of expressions are those of a complex step") {
  Mechanism m;
  m.parameters = {{"x", "", 0.8, "", {}, {}}, {"y", "", 1.7, "", {}, {}}};
  int compared = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const Built built = Builder(seed).expression(1 + static_cast<int>(seed % 4));
    const double h = 1e-30;
    const std::complex<double> there = built.value({0.8, h});
    if (!std::isfinite(there.real()) || !std::isfinite(there.imag())) continue;
    INFO(built.text);
    const double value = evaluate_expression(m, built.text, "", "here");
    const double rate = expression_gradient(m, built.text, {"parameters.x"}).front();
    CHECK(std::abs(value - there.real()) <= 1e-12 * (1 + std::abs(value)));
    CHECK(std::abs(rate - there.imag() / h) <= 1e-11 * (1 + std::abs(rate)));
    ++compared;
  }
  CHECK(compared > 250);
}

TEST_CASE("A mechanism's numbers follow from its parameters and points") {
  Mechanism m = load_scene(parametric);
  CHECK(find_mistakes(m).empty());
  CHECK(read_scene(write_scene(m)) == m);
  CHECK(formula_at(m, "bodies.ball1.mass") == "m");
  CHECK(formula_at(m, "joints.slide.at.1") == "S.y");
  CHECK(formula_at(m, "parameters.c") == "L/2");
  CHECK_FALSE(formula_at(m, "parameters.L"));
  CHECK(sources_of(m, "S.y") == std::vector<std::string>{"points.P.1", "parameters.l", "parameters.L"});

  set_parameter(m, "parameters.L", 0.18);
  CHECK(get_parameter(m, "parameters.c") == 0.09);
  CHECK(get_parameter(m, "bodies.ball2.position.0") == 0.18);
  const double s = 0.2 - std::sqrt(0.10922 * 0.10922 - 0.09 * 0.09);
  CHECK(get_parameter(m, "joints.link1.points.1.1") == s);
  CHECK(get_parameter(m, "joints.slide.coordinate") == 0.2 - s);
  CHECK(find_mistakes(m).empty());
  CHECK(read_scene(write_scene(m)) == m);

  // The pivot moves with all that stands at it.
  set_parameter(m, "points.P.1", 1.2);
  CHECK(m.joints[0].at.y() == 1.2);
  CHECK(m.bodies[0].shapes[0].to.y() == 1.2 + 0.03);

  // The way from one expression to the number is exact, through dependent parameters and points.
  const double slope = expression_gradient(m, "S.y", {"parameters.L"}).front();
  CHECK(std::abs(slope - 0.5 * 0.09 / std::sqrt(0.10922 * 0.10922 - 0.09 * 0.09)) < 1e-13);
}

TEST_CASE("A value of which an expression can make nothing leaves the mechanism as it was") {
  const Mechanism before = load_scene(parametric);
  Mechanism m = before;
  CHECK_THAT(error_of([&] { set_parameter(m, "parameters.L", 0.3); }),
             ContainsSubstring("points.S[1]: \"=P.y - sqrt(l^2 - c^2)\": the value is not finite"));
  CHECK(m == before);
  CHECK_THAT(error_of([&] { set_parameter(m, "parameters.c", 0.1); }),
             ContainsSubstring("given by \"=L/2\"; change parameters.L"));
  CHECK_THAT(error_of([&] { set_parameter(m, "joints.slide.at.1", 0.1); }),
             ContainsSubstring("change points.P.1, parameters.l or parameters.L"));
  CHECK(m == before);
  CHECK_THAT(error_of([&] { get_parameter(m, "parameters.x"); }), ContainsSubstring("expected one of L, c"));
}

TEST_CASE("After a parameter was set all parts are looked at, whatever they are called") {
  Mechanism m = load_scene(parametric);
  m.joints[1].name = "M";
  REQUIRE(find_mistakes(m).empty());
  set_parameter(m, "parameters.M", -1);
  REQUIRE(find_mistakes(m, "parameters.M").size() == 1);
  CHECK(find_mistakes(m, "parameters.M").front().where() == "bodies.collar.mass");
}

TEST_CASE("Numbers that are set again and again give what setting them from anew gives") {
  const Mechanism m = load_scene(parametric);
  const std::vector<std::string> addresses{"parameters.L", "points.P.0", "parameters.k", "gravity.1",
                                           "joints.arm2.damping"};
  Mechanism varied = m;
  VariedNumbers numbers(varied, addresses);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> length(0.1, 0.3);
  for (int i = 0; i < 50; ++i) {
    std::vector<double> values;
    std::vector<ParameterValue> anew;
    for (const std::string& address : addresses) {
      values.push_back(length(random));
      anew.push_back({address, values.back()});
    }
    Mechanism expected = varied; // by what cannot be made of values it stays
    const std::string mistake = error_of([&] { set_parameters(expected, anew); });
    CHECK(error_of([&] { numbers.set(values); }) == mistake);
    CHECK(varied == expected);
    CHECK((mistake == "no error") == (values[0] / 2 <= 0.10922));
  }
  CHECK_THROWS_AS(numbers.set(std::vector{0.2, 0., std::nan(""), 1., 1.}), SceneError);
  const std::vector<std::string> given{"parameters.c"}, lost{"parameters.x"};
  CHECK_THAT(error_of([&] { VariedNumbers(varied, given); }), ContainsSubstring("change parameters.L"));
  CHECK_THAT(error_of([&] { VariedNumbers(varied, lost); }), ContainsSubstring("expected one of"));
}

TEST_CASE("A mechanism is right by its numbers alone where it is right as a whole") {
  for (const char* scene :
       {"governor_parametric", "governor_bearing", "pendulum", "rate_gyro", "fourbar_turntable"}) {
    const Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/" + std::string(scene) + ".json");
    CHECK_NOTHROW(validate_numbers(m));
    for (const std::string& address : parameter_addresses(m))
      for (const double value : {0., -1., 1e-9, 1e31, 1e300, std::nan(""), HUGE_VAL}) {
        Mechanism varied = m;
        put_number(varied, address, value);
        if (error_of([&] { evaluate_formulas(varied); }) != "no error") continue;
        CAPTURE(scene, address, value);
        CHECK(error_of([&] { validate_numbers(varied); }) == error_of([&] { validate(varied); }));
      }
  }
}

TEST_CASE("Circles, unknown names and wrong units of parameters are named") {
  Mechanism m = with_lengths();
  m.parameters[0].formulas = {{"value", "A.x + 1 m"}};
  m.points[0].formulas = {{"0", "2*A.y"}, {"1", "L"}};
  CHECK_THAT(error_of([&] { evaluate_formulas(m); }), ContainsSubstring("expected no circle of expressions"));
  m.points[0].formulas = {{"1", "A.y"}};
  CHECK_THAT(error_of([&] { evaluate_formulas(m); }), ContainsSubstring("points.A[1]"));
  m = with_lengths();
  m.parameters[1].unit = "mm";
  CHECK_THAT(error_of([&] { evaluate_formulas(m); }),
             ContainsSubstring("parameters.a.unit: expected an SI unit"));
  m = with_lengths();
  m.parameters[1].name = "L";
  CHECK_FALSE(find_mistakes(m).empty());
  m = with_lengths();
  m.points[0].name = "L";
  CHECK_FALSE(find_mistakes(m).empty());
  m.points[0].name = "sin";
  CHECK_FALSE(find_mistakes(m).empty());
}

TEST_CASE("A scene without expressions is saved as version 1") {
  const Mechanism old = load_scene(FLYBALL_ASSETS "/scenes/governor.json");
  CHECK_THAT(write_scene(old), ContainsSubstring("\"flyball\": 1,"));
  CHECK_THAT(write_scene(load_scene(parametric)), ContainsSubstring("\"flyball\": 2,"));
}

TEST_CASE("Mass and inertia follow from a density") {
  const Mechanism m = read_scene(R"({
    "flyball": 2, "name": "rod", "gravity": [0, "=-9.8 m/s^2", 0],
    "parameters": {"r": {"value": 0.03, "unit": "m"}, "rho": {"value": 7850, "unit": "kg/m^3"}},
    "points": {"O": [0, 0, 0], "A": [0, -2, 0]},
    "bodies": [{"name": "rod", "density": "=rho",
                "shapes": [{"type": "cylinder", "radius": "=r", "from": "O", "to": "A"}]}],
    "joints": [{"name": "j", "type": "spherical", "bodies": ["ground", "rod"], "at": "O",
                "damping": ["=1 N m s", null, 2]}]})");
  const double mass = 7850 * std::numbers::pi * 0.03 * 0.03 * 2;
  CHECK(std::abs(m.bodies[0].mass - mass) < 1e-12);
  CHECK((m.bodies[0].position - Vec3(0, -1, 0)).norm() < 1e-15);
  CHECK(std::abs(m.bodies[0].inertia[1] - mass * 0.03 * 0.03 / 2) < 1e-14);
  CHECK(m.joints[0].coordinates[0].damping == 1);
  CHECK(m.gravity.y() == -9.8);
  CHECK(read_scene(write_scene(m)) == m);
  Mechanism thick = m;
  set_parameter(thick, "parameters.r", 0.06);
  CHECK(std::abs(thick.bodies[0].mass - 4 * mass) < 1e-12);
  CHECK_THAT(error_of([&] { set_parameter(thick, "bodies.rod.mass", 1); }),
             ContainsSubstring("there is no \"mass\""));
}

TEST_CASE("Names change in expressions, and in nothing that looks like them") {
  CHECK(renamed_in("m*2 m + m.x + sin(m)", "m", "mass") == "mass*2 m + mass.x + sin(mass)");
  CHECK(renamed_in("m1 + m", "m", "q") == "m1 + q");
  CHECK(renamed_in("no (expression", "no", "q") == "no (expression");
}

TEST_CASE("Speeds that drives prescribe are told by the drives, and by what their expressions rest on") {
  Mechanism m = test::shipped("horizontal_rotor");
  REQUIRE(prescribed_speeds(m).size() == 1);
  const PrescribedSpeed speed = prescribed_speeds(m)[0];
  CHECK(speed.joint == "spin");
  CHECK(speed.address == "joints.spin.drive.speed");
  CHECK(speed.value == 30);
  CHECK(speed.angle);
  CHECK(number_alone(m, speed.address) == "parameters.n");
  CHECK(number_alone(m, "parameters.n") == "parameters.n");
  CHECK(sets_speed(m, "parameters.n"));
  CHECK_FALSE(sets_speed(m, "parameters.e"));
  // By way of another parameter, and as a part of an expression.
  NamedParameter turns;
  turns.name = "turns";
  turns.unit = "rad/s";
  turns.value = 5;
  m.parameters.push_back(turns);
  m.parameters[0].formulas = {{"value", " turns "}};
  CHECK(number_alone(m, speed.address) == "parameters.turns");
  CHECK(sets_speed(m, "parameters.turns"));
  m.parameters[0].formulas = {{"value", "6*turns"}};
  CHECK(number_alone(m, speed.address).empty());
  CHECK(sets_speed(m, "parameters.turns"));
  m.parameters.back().formulas = {{"value", "n"}}; // in a circle
  m.parameters[0].formulas = {{"value", "turns"}};
  CHECK(number_alone(m, speed.address).empty());
  // A drive by torque finds its speed.
  CHECK(prescribed_speeds(test::shipped("governor_engine")).empty());
}
