// Springs and dampers by laws: equilibria, frequencies and motions that have a formula; energies against
// forces; folds at the crests of a table; kinks that are told.
#include "engine/continuation/branches.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/mechanism/value_table.hpp"
#include "engine/report/analysis.hpp"
#include "engine/system/bound_law.hpp"
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

Joint by_law(Joint j, const std::string& force) {
  j.coordinates[0].spring = CoordinateSpring{0, 0, "", 0};
  j.formulas.push_back({"spring.force", force});
  return j;
}

Joint damped_by_law(Joint j, const std::string& force) {
  j.coordinates[0].damping_force = 0;
  j.formulas.push_back({"damping_force", force});
  return j;
}

// A mass that hangs on its spring; the slide is positive downwards.
Mechanism hanging(double mass, const std::string& law) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("mass", mass, {0, 0, 0})};
  m.joints = {by_law(prismatic("slide", "ground", "mass", {0, 0, 0}, {0, -1, 0}), law)};
  return m;
}

Mechanism sliding(double mass, Joint slide) {
  Mechanism m;
  m.bodies = {body("mass", mass, {0, 0, 0})};
  m.joints = {std::move(slide)};
  return m;
}
Joint slide_along_x() {
  return prismatic("slide", "ground", "mass", {0, 0, 0}, {1, 0, 0});
}

Solution solved(const Mechanism& m) {
  validate(m);
  Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  return s;
}

// Where f is zero between a and b.
template <class F>
double zero_between(const F& f, double a, double b) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (a + b) / 2;
    ((f(middle) > 0) == (f(b) > 0) ? b : a) = middle;
  }
  return (a + b) / 2;
}

BoundLaw law_of(const std::string& text) {
  return {std::make_shared<const ForceLaw>(text, spring_variable), {}};
}

} // namespace

TEST_CASE("a hardening spring gives way as its cubic says, and swings with its slope", "[laws]") {
  for (const double mass : {0.1, 1., 50.}) {
    const Solution s = solved(hanging(mass, "800 N/m*deflection + 2e5 N/m^3*deflection^3"));
    const double load = mass * standard_gravity;
    // Cardano: of x^3 + p x = q.
    const double p = 800 / 2e5, q = load / 2e5, d = std::sqrt(q * q / 4 + p * p * p / 27);
    const double x = std::cbrt(q / 2 + d) + std::cbrt(q / 2 - d);
    CHECK_THAT(value(s, "slide"), WithinRel(x, 1e-13));
    CHECK(s.stable == true);
    CHECK(s.stability_reason == StabilityReason::minimum);
    REQUIRE(s.eigenvalues);
    CHECK_THAT((*s.eigenvalues)[0].imag(), WithinRel(std::sqrt((800 + 6e5 * x * x) / mass), 1e-12));
    const AllSolutions all =
        Analysis(hanging(mass, "800 N/m*deflection + 2e5 N/m^3*deflection^3")).solve_all();
    REQUIRE(all.equilibria.size() == 1);
    CHECK(std::abs(*all.equilibria[0].potential - (400 * x * x + 5e4 * x * x * x * x - load * x)) <
          1e-13 * load);
  }
}

TEST_CASE("a table's equilibria are those of its curve, and of straight lines beyond its ends", "[laws]") {
  const std::vector<ValueTable::Point> points{{-0.01, -30}, {0, 0}, {0.005, 40}, {0.009, 200}, {0.01, 500}};
  const ValueTable table(points);
  for (const double load : {1., 39., 41., 120., 499., 2000., 1e5}) {
    CAPTURE(load);
    const Solution s = solved(hanging(load / standard_gravity,
                                      "table(deflection, [-10 mm, -30 N], [0 mm, 0 N], [5 mm, 40 N], "
                                      "[9 mm, 200 N], [10 mm, 500 N])"));
    const double x = zero_between([&](double at) { return table(Dual(at)).value - load; }, 0, 10);
    CHECK(std::abs(value(s, "slide") - x) <= 1e-13 * (0.01 + x));
    CHECK(s.stable == true);
  }
}

TEST_CASE("a constant force balances one weight only", "[laws]") {
  Mechanism m = hanging(2, "0 N");
  m.joints[0].formulas.clear();
  m.joints[0].coordinates[0].spring->force = 15;
  CHECK(Analysis(m).solve().status == Status::not_converged);
  m.joints[0].coordinates[0].spring->force = 2 * standard_gravity;
  CHECK(Analysis(m).solve().stable != false);
}

TEST_CASE("a turning mass on a spring by a law stands where its force is m w^2 r", "[laws]") {
  const double speed = 20, mass = 0.3;
  Mechanism m;
  m.bodies = {spindle(), body("mass", mass, {0.2, 0, 0})};
  m.joints = {spin(speed), prismatic("slide", "spindle", "mass", {0, 0, 0}, {1, 0, 0})};
  m.joints[1].coordinates[0].drawn = 0.2;
  Force f = point_spring("coil", "spindle", "mass", {0, 0, 0}, {0.2, 0, 0}, 0, 0.15);
  f.force = 0;
  f.formulas.push_back({"force", "300 N/m*deflection + 8000 N/m^2*deflection^2"});
  m.forces = {f};
  m.measures = {{"pull", "", "tension(coil)", "N"}};
  const Solution s = solved(m);
  const double r = value(s, "slide");
  CHECK_THAT(r, WithinRel(zero_between(
                              [&](double at) {
                                const double d = at - 0.15;
                                return 300 * d + 8000 * d * d - mass * speed * speed * at;
                              },
                              0.15, 1),
                          1e-13));
  REQUIRE(s.measures.size() == 1);
  CHECK_THAT(s.measures[0].value.value(), WithinRel(mass * speed * speed * r, 1e-12));
  CHECK_THAT((*s.eigenvalues)[0].imag(),
             WithinRel(std::sqrt((300 + 16000 * (r - 0.15)) / mass - speed * speed), 1e-11));
}

TEST_CASE("a law's energy is the integral of its force", "[laws]") {
  struct Case {
    std::string text;
    double (*energy)(double);
  };
  for (const Case& c :
       {Case{"30*deflection + 8*deflection^3", [](double x) { return 15 * x * x + 2 * x * x * x * x; }},
        Case{"abs(deflection - 0.3)",
             [](double x) { return x < 0.3 ? 0.3 * x - x * x / 2 : 0.045 + (x - 0.3) * (x - 0.3) / 2; }},
        Case{"5*max(deflection, 0.1)",
             [](double x) { return x < 0.1 ? 0.5 * x : 0.05 + 2.5 * (x * x - 0.01); }},
        Case{"sinh(3*deflection)", [](double x) { return 2 * std::pow(std::sinh(1.5 * x), 2) / 3; }}})
    for (const double x : {-2., -0.4, -1e-9, 0., 1e-6, 0.25, 0.31, 1., 3.}) {
      CAPTURE(c.text, x);
      CHECK(std::abs(law_of(c.text).energy(x) - c.energy(x)) <=
            2e-14 * (1e-12 + std::abs(c.energy(x)) + x * x));
    }
  // Tables: against sums over their pieces, which are cubic between their points.
  const BoundLaw table = law_of("table(deflection, [-1, -3], [0, 0], [0.5, 4], [0.7, 4.5], [2, 9])");
  const auto simpson = [&](double a, double b) { // exact for cubics
    return (b - a) / 6 * (table.value(a) + 4 * table.value((a + b) / 2) + table.value(b));
  };
  CHECK(std::abs(table.energy(3) - (simpson(0, 0.5) + simpson(0.5, 0.7) + simpson(0.7, 2) + simpson(2, 3))) <
        1e-13 * table.energy(3));
  CHECK(std::abs(table.energy(-2) + simpson(-2, -1) + simpson(-1, 0)) < 1e-13 * table.energy(-2));
}

TEST_CASE("sensitivities to numbers in laws are those of the closed form", "[laws]") {
  Mechanism m = hanging(3, "k*deflection + b*deflection^3");
  m.parameters = {{"k", "", 500, "N/m", {}}, {"b", "", 4e4, "N/m^3", {}}};
  for (const char* name : {"parameters.k", "parameters.b"})
    m.sliders.push_back({name, 1, 1e6, SliderScale::linear, ""});
  m.measures = {{"force", "", "spring(slide)", "N"}};
  const Solution s = solved(m);
  const double x = value(s, "slide"), slope = 500 + 3 * 4e4 * x * x;
  REQUIRE(s.sensitivities.size() == 2);
  CHECK_THAT(s.sensitivities[0].rates[0].value, WithinRel(-x / slope, 1e-12));
  CHECK_THAT(s.sensitivities[1].rates[0].value, WithinRel(-x * x * x / slope, 1e-12));
  CHECK_THAT(s.measures[0].value.value(), WithinRel(-3 * standard_gravity, 1e-13));
  CHECK(std::abs(s.sensitivities[0].measures[0]) < 1e-13); // the weight stays what it is
}

TEST_CASE("snap-through: folds stand at the crests of a spring's law", "[laws][branches]") {
  // f = a d - b d^2 + c d^3, with crests at d where a - 2 b d + 3 c d^2 = 0.
  const double a = 100, b = 1000, c = 2500;
  Mechanism m = sliding(1, by_law(slide_along_x(), "100 N/m*deflection - 1000 N/m^2*deflection^2 + "
                                                   "2500 N/m^3*deflection^3 - load"));
  m.parameters = {{"load", "", 0, "N", {}}};
  const ResponseDiagram d = follow_branches(m, "parameters.load", -2, 6);
  INFO(d.message);
  std::vector<double> loads;
  for (const SpecialPoint& s : d.special)
    if (s.type == SpecialPointType::fold) loads.push_back(s.at.parameter);
  std::ranges::sort(loads);
  REQUIRE(loads.size() == 2);
  const double w = std::sqrt(b * b - 3 * a * c);
  const auto crest = [&](double x) { return x * (a + x * (-b + x * c)); };
  CHECK(std::abs(loads[1] - crest((b - w) / (3 * c))) < 1e-10);
  CHECK(std::abs(loads[0] - crest((b + w) / (3 * c))) < 1e-10);
}

TEST_CASE("the equilibria of a slide of micrometres drawn at the origin are told apart", "[laws][scale]") {
  // k d (d^2 / a^2 - 1), between stops: the reach is theirs, not a metre.
  const double a = 4e-7;
  Mechanism m = sliding(1e-9, by_law(slide_along_x(), "1.25e13 N/m^3*deflection^3 - 2 N/m*deflection"));
  m.joints[0].coordinates[0].stop = Stop{-1e-6, 1e-6, 1e3};
  const AllSolutions all = Analysis(m).solve_all();
  std::vector<double> found;
  for (const Solution& s : all.equilibria)
    found.push_back(s.coordinates[0].value);
  std::ranges::sort(found);
  REQUIRE(found.size() == 3);
  CHECK_THAT(found[0], WithinRel(-a, 1e-12));
  CHECK(std::abs(found[1]) < 1e-18);
  CHECK_THAT(found[2], WithinRel(a, 1e-12));
}

TEST_CASE("where a law's force vanishes far away its equilibria are looked for there, too", "[laws]") {
  const auto places = [](double middle, double far) {
    const std::string a = std::to_string(middle), b = std::to_string(far);
    Mechanism m = sliding(1, by_law(slide_along_x(), "1 N/m^3*deflection*(deflection - " + a +
                                                         " m)*(deflection - " + b + " m)"));
    m.joints[0].coordinates[0].drawn = 0.05;
    std::vector<double> out;
    for (const Solution& s : Analysis(m).solve_all().equilibria)
      out.push_back(s.coordinates[0].value);
    std::ranges::sort(out);
    return out;
  };
  for (const auto& [middle, far] : {std::pair{100., 300.}, {1., 3.}, {-3., 1.}, {-4000., -20.}}) {
    CAPTURE(middle, far);
    std::vector<double> exact{0, middle, far};
    std::ranges::sort(exact);
    const std::vector<double> found = places(middle, far);
    REQUIRE(found.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK_THAT(found[i], Catch::Matchers::WithinAbs(exact[i], 1e-9 * (1 + std::abs(exact[i]))));
  }
  // A contact that begins far away: a mass on its way to it has nowhere else to be.
  Mechanism m = sliding(1, by_law(slide_along_x(), "50 N/m*max(0 m, deflection - 100 m) - 1 N"));
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 1);
  CHECK_THAT(all.equilibria[0].coordinates[0].value, WithinRel(100.02, 1e-12));
}

TEST_CASE("an undamped motion on springs by laws keeps its energy", "[laws]") {
  Mechanism m = sliding(0.7, by_law(slide_along_x(), "table(deflection, [-50 mm, -90 N], [0 mm, 0 N], "
                                                     "[20 mm, 10 N], [60 mm, 90 N])"));
  m.bodies.push_back(body("bob", 0.4, {0, -0.3, 0}));
  m.joints.push_back(
      by_law(revolute("swing", "mass", "bob", {0, 0, 0}), "2 N m*sinh(deflection) - 1 N m*deflection"));
  Force f = point_spring("tie", "ground", "bob", {0.5, -0.3, 0}, {0, -0.3, 0}, 0, 0.4);
  f.force = 0;
  f.formulas.push_back({"force", "60 N/m*deflection + 200 N/m^2*deflection^2"});
  m.forces = {f};
  validate(m);
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const Run run = simulate(
        m, undamped(starting_at(starting_at(lasting(4, method, 1e-11), "slide", 0.05), "swing", 1.2)));
    check_sound(run, 1e-6); // the slope of a table is no smooth function
    CHECK(jacobi_drift(run) < 1e-6);
  }
}

TEST_CASE("a damper that grows with the square of the rate slows down as 1/t", "[laws]") {
  const double mass = 2, c = 5, v0 = 3;
  const Mechanism m = sliding(mass, damped_by_law(slide_along_x(), "5 N s^2/m^2*rate*abs(rate)"));
  validate(m);
  for (const Integrator method : all_integrators) {
    CAPTURE(word(method));
    const Run run = simulate(m, kicked(lasting(2, method, 1e-11), "slide", v0));
    check_sound(run);
    const CoordinateTrack& x = track(run, "slide");
    for (std::size_t i = 0; i < run.time.size(); ++i) {
      const double slowed = 1 + c * v0 * run.time[i] / mass;
      CHECK(std::abs(x.rate[i] - v0 / slowed) < 1e-7);
      CHECK(std::abs(x.value[i] - mass / c * std::log(slowed)) < 1e-7);
    }
  }
  // Without dampers it goes on; in the linear motion it has none.
  const Run free = simulate(m, undamped(kicked(lasting(1), "slide", v0)));
  CHECK(track(free, "slide").value.back() == Approx(v0));
}

TEST_CASE("a damper between points by a law takes what it dissipates", "[laws]") {
  Mechanism m = sliding(1, by_law(slide_along_x(), "40 N/m*deflection"));
  Force f = point_spring("dashpot", "ground", "mass", {-0.5, 0, 0}, {0, 0, 0}, 0);
  f.damping_force = 0;
  f.formulas.push_back({"damping_force", "2 N*tanh(rate/(0.05 m/s))"});
  m.forces = {f};
  validate(m);
  const Solution s = solved(m);
  // As stiff as its slope at rest: s^2 + 40 s + 40 = 0.
  const auto eigenvalue = (*s.eigenvalues)[1];
  CHECK(std::min(std::abs(eigenvalue - std::complex<double>(-20 + std::sqrt(360.), 0)),
                 std::abs(eigenvalue - std::complex<double>(-20 - std::sqrt(360.), 0))) < 1e-9);
  CHECK(s.stable == true);
  const Run run = simulate(m, starting_at(lasting(20), "slide", 0.4));
  check_sound(run);
  CHECK(find_settled(run, s).time.has_value());
}

TEST_CASE("a damper that drives at rest makes a minimum unstable", "[laws]") {
  // Rayleigh's oscillator: it swings with an amplitude of 2 sqrt(a / (3 b)) in its rate, to first order.
  Mechanism m = sliding(
      1, damped_by_law(by_law(slide_along_x(), "100 N/m*deflection"), "-b*rate + 2 N s^3/m^3*rate^3"));
  m.parameters = {{"b", "", 0.5, "N s/m", {}}};
  Analysis analysis(m);
  const Solution s = analysis.solve();
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == false);
  CHECK((*s.eigenvalues)[0].real() == Approx(0.25));
  // With the sign of a number the whole question changes.
  m.parameters[0].value = -0.5;
  analysis.update(m);
  const Solution other = analysis.solve();
  CHECK(other.stable == true);
  CHECK(other.stability_reason == StabilityReason::minimum);
  CHECK(solved(sliding(1, damped_by_law(by_law(slide_along_x(), "100 N/m*deflection"), "2 N s/m*rate")))
            .stability_reason == StabilityReason::minimum);
  // However narrow the range of rates in which it drives.
  for (const char* law : {"-5 N*tanh(1e12 s/m*rate)", "3 N s/m*rate - 5 N*tanh(1e12 s/m*rate)"})
    CHECK(solved(sliding(1, damped_by_law(by_law(slide_along_x(), "100 N/m*deflection"), law))).stable ==
          false);
  m.parameters[0].value = 0.5;
  const Run run = simulate(m, kicked(lasting(80), "slide", 0.1));
  double fastest = 0;
  for (std::size_t i = run.time.size() / 2; i < run.time.size(); ++i)
    fastest = std::max(fastest, std::abs(track(run, "slide").rate[i]));
  CHECK(fastest == Approx(2 * std::sqrt(0.5 / 6)).epsilon(0.01));
  const ResponseDiagram d = follow_branches(m, "parameters.b", -1, 1);
  INFO(d.message);
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::hopf);
  CHECK(std::abs(d.special[0].at.parameter) < 1e-9);
  REQUIRE(d.special[0].at.parameter_error);
  CHECK(std::abs(d.special[0].at.parameter) <= *d.special[0].at.parameter_error);
  CHECK(*d.special[0].at.parameter_error < 1e-9);
  for (const ResponsePoint& p : d.branches[0].points)
    if (std::abs(p.parameter) > 1e-6) CHECK(p.stable == (p.parameter < 0));
}

TEST_CASE("a steady state on a kink is told", "[laws]") {
  const Solution slack = solved(sliding(1, by_law(slide_along_x(), "100 N/m*max(deflection, 0 m)")));
  INFO(slack.message);
  CHECK_THAT(slack.message, ContainsSubstring("kink"));
  CHECK(slack.stable != true); // on one side nothing holds it
  const Solution two = solved(
      sliding(1, by_law(slide_along_x(), "100 N/m*max(deflection, 0 m) + 30 N/m*min(deflection, 0 m)")));
  CHECK_THAT(two.message, ContainsSubstring("jumps from 30 to 100 N/m"));
  CHECK_THAT(two.message, !ContainsSubstring("open"));
  CHECK(two.stable == true); // on either side the potential rises
  CHECK(two.stability_reason == StabilityReason::minimum);
  CHECK_THAT(std::abs((*two.eigenvalues)[0].imag()), WithinRel(10., 1e-12)); // of one side
  const auto nearest = [](const Mechanism& m) {
    SolveOptions options;
    options.nearest = true;
    return Analysis(m).solve(options);
  };
  const Solution ridge = nearest(
      sliding(1, by_law(slide_along_x(), "-100 N/m*max(deflection, 0 m) - 30 N/m*min(deflection, 0 m)")));
  CHECK(ridge.stable == false); // it falls on either side
  const Solution slope = nearest(
      sliding(1, by_law(slide_along_x(), "100 N/m*max(deflection, 0 m) - 30 N/m*min(deflection, 0 m)")));
  INFO(slope.message);
  CHECK(!slope.stable);
  CHECK(slope.stability_reason == StabilityReason::marginal);
  CHECK_THAT(slope.message, ContainsSubstring("whether it is stable stays open"));
  const Solution damper = solved(sliding(
      1, damped_by_law(by_law(slide_along_x(), "100 N/m*deflection"), "2 N s/m*rate + abs(rate)*1 N s/m")));
  CHECK_THAT(damper.message, ContainsSubstring("The damper of slide stands on a kink"));
  const Solution smooth = solved(hanging(1, "800 N/m*deflection + 2e5 N/m^3*deflection^3"));
  CHECK_THAT(smooth.message, !ContainsSubstring("kink"));
  const Solution table =
      solved(hanging(40 / standard_gravity, "table(deflection, [0 mm, 0 N], [5 mm, 40 N], [9 mm, 200 N])"));
  CHECK_THAT(table.message, !ContainsSubstring("kink")); // at a point of a table the slope does not jump
}

TEST_CASE("what is just at its stop is told to be", "[laws][stops]") {
  const auto slide_to = [](double upper, double stiffness, double spring, double free) {
    Mechanism m = sliding(1, sprung(slide_along_x(), spring, free));
    m.joints[0].coordinates[0].stop = Stop{{}, upper, stiffness};
    return m;
  };
  const Solution both = solved(slide_to(0.1, 1000, 100, 0.1));
  INFO(both.message);
  CHECK_THAT(both.message,
             ContainsSubstring("slide stands just at its stop, where its stiffness jumps from 100 "
                               "to 1100 N/m: rates and eigenvalues hold on one side of it"));
  CHECK(both.stable == true); // on either side the potential rises
  CHECK(both.stability_reason == StabilityReason::minimum);
  // On a shaft that turns at 5 rad/s: only the stop's side holds it, and nothing but a limit tells of both.
  Mechanism turned = slide_to(0.3, 1000, 12, 0.3 - 25 * 0.3 / 12);
  turned.bodies[0].position = {0.3, 0, 0};
  turned.bodies.push_back(body("shaft", 1, {0, 0, 0}, {1, 1, 1}));
  turned.joints[0].bodies[0] = "shaft";
  turned.joints[0].coordinates[0].drawn = 0.3;
  turned.joints.push_back(driven(revolute("spin", "ground", "shaft", {0, 0, 0}), 5));
  const Solution half = Analysis(turned).solve();
  INFO(half.message);
  REQUIRE(half.status == Status::converged);
  CHECK(!half.stable);
  CHECK_THAT(half.message, ContainsSubstring("whether it is stable stays open"));
  // A stiff one that is pressed by 1 N gives way by 1e-8 m or 1e-11 m, and is on its one side.
  for (const double stiffness : {1e8, 1e11}) {
    const Solution pressed = solved(slide_to(0.1, stiffness, 10, 0.2));
    INFO(pressed.message);
    CHECK(pressed.stable == true);
    CHECK_THAT(pressed.message, !ContainsSubstring("just at its stop"));
    CHECK_THAT(pressed.eigenvalues->at(0).imag(), WithinRel(std::sqrt(stiffness + 10), 1e-9));
  }
}

TEST_CASE("every verdict on an equilibrium knows the kink it stands on", "[laws][branches]") {
  Mechanism m = sliding(1, by_law(slide_along_x(), "c*max(deflection, 0 m) - 30 N/m*min(deflection, 0 m)"));
  m.parameters = {{"c", "", 100, "N/m", {}}};
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 1);
  CHECK(!all.equilibria[0].stable);
  CHECK_THAT(all.equilibria[0].message, ContainsSubstring("The spring of slide stands on a kink"));
  CHECK_THAT(all.message, ContainsSubstring("In 1: The spring of slide stands on a kink"));
  const ResponseDiagram d = follow_branches(m, "parameters.c", 50, 150);
  INFO(d.message);
  CHECK_THAT(d.message, ContainsSubstring("The spring of slide stands on a kink"));
  REQUIRE(d.branches.size() == 1);
  for (const ResponsePoint& p : d.branches[0].points)
    CHECK(!p.stable);
  m.joints[0].formulas[0].text = "c*max(deflection, 0 m) + 30 N/m*min(deflection, 0 m)";
  const ResponseDiagram held = follow_branches(m, "parameters.c", 50, 150);
  REQUIRE(held.branches.size() == 1);
  for (const ResponsePoint& p : held.branches[0].points)
    CHECK(p.stable == true);
  // Of two coordinates: the potential falls in between where one of the sides is softer than what couples
  // them.
  for (const double softer : {50., 20.}) {
    Mechanism pair =
        sliding(1, by_law(slide_along_x(), "100 N/m*max(deflection, 0 m) + " + std::to_string(softer) +
                                               " N/m*min(deflection, 0 m)"));
    pair.bodies.push_back(body("other", 1, {0, 0, 0}));
    pair.joints.push_back(
        by_law(prismatic("second", "mass", "other", {0, 0, 0}, {1, 0, 0}), "60 N/m*deflection"));
    Force push = point_spring("push", "ground", "other", {0, 0, 0}, {0, 0, 0}, -25, 0);
    pair.forces = {push};
    // k1 - 25 and 60 - 25 on the diagonal, -25 beside it.
    const Solution s = solved(pair);
    INFO(s.message);
    CHECK((s.stable == true) == ((softer - 25) * 35 > 625));
  }
}

TEST_CASE("a law that is large far away says nothing of where it stands", "[laws]") {
  // A ball held softly, its springs at 4 rad stronger by many powers of ten.
  Mechanism m;
  m.bodies = {body("ball", 1, {0, 0, 0}, {0.02, 0.03, 0.04})};
  Joint hinge = joint(JointType::spherical, "hinge", "ground", "ball", {0, 0, 0});
  for (int i = 0; i < 3; ++i) {
    hinge.coordinates[static_cast<std::size_t>(i)].spring = CoordinateSpring{0, 0, "", 0};
    hinge.formulas.push_back(
        {"spring." + std::to_string(i) + ".force", "2 N m*deflection + 1e-9 N m*sinh(20*deflection)"});
  }
  m.joints = {hinge};
  const Solution s = solved(m);
  INFO(s.message);
  CHECK(s.stability_reason == StabilityReason::minimum);
  CHECK(s.neutral.empty());
  REQUIRE(s.eigenvalues->size() == 6);
  CHECK_THAT((*s.eigenvalues)[0].imag(), WithinRel(std::sqrt(2.00000002 / 0.04), 1e-9));
}

TEST_CASE("a spring beside a damper by a law is searched where it is slack", "[laws]") {
  Mechanism m = sliding(1, damped_by_law(slide_along_x(), "3 N s/m*rate + 1 N s^3/m^3*rate^3"));
  m.joints[0].coordinates[0].spring = CoordinateSpring{50, 40};
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.bounds.size() == 1);
  CHECK(all.bounds[0].upper > 40);
  REQUIRE(all.equilibria.size() == 1);
  CHECK_THAT(value(all.equilibria[0], "slide"), WithinRel(40., 1e-12));
}

TEST_CASE("where a constant force does not hold, another spring is asked for", "[laws]") {
  Mechanism m = hanging(2, "0 N");
  m.joints[0].formulas.clear();
  m.joints[0].coordinates[0].spring->force = 15;
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  CHECK(s.status == Status::not_converged);
  CHECK_THAT(s.message,
             ContainsSubstring("It needs a spring whose force grows with its deflection, or a stop"));
}

TEST_CASE("what pushes on without end is found with laws, too", "[laws]") {
  const Solution s = Analysis(hanging(1, "5 N*tanh(deflection/(10 mm))")).solve();
  INFO(s.message);
  CHECK(s.status == Status::not_converged);
  REQUIRE(s.unheld.size() == 1);
  CHECK(s.unheld[0].joint == "slide");
  CHECK(s.unheld_by_weight);
}

TEST_CASE("random mechanisms with laws: damped motions settle where the direct solution stands", "[laws]") {
  int compared = 0, with_loops = 0;
  const std::uint32_t seeds = few_or_all(12u, 24u); // all numbers of bodies with and without loops
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    reference::RandomOptions options;
    options.bodies = 1 + static_cast<int>(seed % 3);
    options.loops = static_cast<int>(seed % 4) / 2;
    options.drives = reference::RandomDrives::none;
    options.conservative = true;
    Mechanism m = reference::random_mechanism(seed, options);
    for (Joint& j : m.joints)
      for (std::size_t i = 0; i < j.coordinates.size(); ++i) {
        Coordinate& c = j.coordinates[i];
        if (c.drive) continue;
        const bool angle = is_angle(j.type, static_cast<int>(i));
        c.spring = CoordinateSpring{0, c.drawn, "", 0};
        j.formulas.push_back({coordinate_key(j, i, "spring") + ".force",
                              angle ? "60 N m*deflection + 50 N m*deflection^3"
                                    : "table(deflection, [-1 m, -900 N], [0 m, 0 N], [1 m, 600 N])"});
        if (is_rotation_vector(j.type, static_cast<int>(i))) {
          c.damping = 8;
          continue;
        }
        c.damping = 0;
        c.damping_force = 0;
        j.formulas.push_back({coordinate_key(j, i, "damping_force"),
                              angle ? "8 N m*tanh(rate/(1 rad/s)) + 3 N m*rate/(1 rad/s)"
                                    : "30 N s/m*rate + 20 N s^2/m^2*rate*abs(rate)"});
      }
    INFO("seed " << seed);
    if (!find_mistakes(m).empty()) continue;
    const Solution s = Analysis(m).solve();
    if (s.status != Status::converged || s.stable != true) continue;
    SimulationOptions settling = lasting(60, Integrator::automatic, 1e-9);
    settling.rate = 5; // each sample takes its energies, by quadrature
    const Run run = simulate(m, settling);
    INFO(run.message << " " << s.message);
    REQUIRE(run.status == RunStatus::completed);
    const Settled settled = find_settled(run, s);
    INFO(settled.message);
    CHECK(settled.distance < 1e-5);
    ++compared;
    with_loops += options.loops > 0;
  }
  CHECK(compared >= static_cast<int>(seeds / 3));
  CHECK(with_loops >= static_cast<int>(seeds / 8));
}

TEST_CASE("the error of an answer by a law has the law's rounding", "[laws]") {
  // What is left of a preload turns the soft spring beside it: 1e-16 of the one is much of the other.
  int beyond_last_digits = 0;
  for (const double preload : {30., 470., 9100., 150000.})
    for (const double soft : {0.006, 0.11, 2.3})
      for (const double asked : {-0.83, -0.26, 0.31, 0.77}) {
        CAPTURE(preload, soft, asked);
        const double mass = (preload + soft * std::sinh(asked)) / standard_gravity;
        const Solution s = Analysis(hanging(mass, number_text(preload) + " N + " + number_text(soft) +
                                                      " N*sinh(deflection/(1 m))"))
                               .solve();
        INFO(s.message);
        REQUIRE(s.status == Status::converged);
        const long double exact = std::asinh(
            (static_cast<long double>(mass) * standard_gravity - static_cast<long double>(preload)) / soft);
        const CoordinateSolution& slide = coordinate(s, "slide");
        CHECK(std::abs(static_cast<double>(slide.value - exact)) <= slide.error);
        beyond_last_digits += std::abs(static_cast<double>(slide.value - exact)) > 1e-15;
      }
  CHECK(beyond_last_digits > 20);
}
