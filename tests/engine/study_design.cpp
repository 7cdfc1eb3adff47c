// Parameters solved for a wanted coordinate, against closed forms.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/design.hpp"
#include "engine/study/fold_curve.hpp"

#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

} // namespace

TEST_CASE("the speed at which a conical pendulum leans as wanted", "[design]") {
  const double length = 0.7;
  for (const double angle : {0.05, 0.8, 1.3}) {
    const DesignAnswer answer = design(conical(length, 0, 1), speed, 0, 10, "swing", angle);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    REQUIRE(answer.solutions.size() == 1);
    const DesignSolution& s = answer.solutions[0];
    const double wanted = std::sqrt(standard_gravity / (length * std::cos(angle)));
    CHECK(std::abs(s.parameter - wanted) <= s.parameter_error);
    CHECK(s.parameter_error < 1e-13);
    CHECK(value(s.at.coordinates, "swing") == Approx(angle).epsilon(1e-14));
    CHECK(s.at.stable == true);
    CHECK(s.residual < 1e-13);
    // cos(a) = g / (w^2 L): da/dw = 2 cos(a) / (w sin(a))
    REQUIRE(s.rate.has_value());
    CHECK(*s.rate == Approx(2 * std::cos(angle) / (wanted * std::sin(angle))).epsilon(1e-7));
    CHECK_FALSE(s.at.reactions.empty());
  }
}

TEST_CASE("both branches of a pendulum hinged off the axis answer", "[design]") {
  // w^2 (o + L sin a) = g tan a. Leaning in by 0.9 and by 0.3 are on the branch that folds, apart from the
  // drawn pose's; the first is stable.
  for (const double angle : {-0.9, -0.3, 0.4}) {
    const DesignAnswer answer = design(conical(0.7, 0.1, 1), speed, 0, 10, "swing", angle);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    REQUIRE(answer.solutions.size() == 1);
    const DesignSolution& s = answer.solutions[0];
    CHECK(
        s.parameter ==
        Approx(std::sqrt(standard_gravity * std::tan(angle) / (0.1 + 0.7 * std::sin(angle)))).epsilon(1e-13));
    CHECK(s.at.stable == (angle != -0.3));
    CHECK(s.connected == (angle > 0));
  }
  DesignOptions connected;
  connected.all = false;
  CHECK(design(conical(0.7, 0.1, 1), speed, 0, 10, "swing", -0.9, connected).solutions.empty());
}

TEST_CASE("the speed at which the governor's collar is at 0.12 m", "[design]") {
  const Mechanism m = shipped("governor");
  const DesignAnswer answer = design(m, speed, 0, 30, "slide", 0.12);
  INFO(answer.message);
  REQUIRE(answer.status == Status::converged);
  const auto slide = [](long double a) {
    return 0.08L * std::sin(a) + std::sqrt(0.10922L * 0.10922L - 0.0064L * std::cos(a) * std::cos(a));
  };
  const long double angle = root([&](long double a) { return slide(a) - 0.12L; }, 0.1L, 1.2L);
  // dV/da + w^2 0.0512 sin(a) cos(a) = 0
  const long double sine = std::sin(angle), cosine = std::cos(angle);
  const long double slope =
      0.08L * cosine + 0.0064L * sine * cosine / std::sqrt(0.10922L * 0.10922L - 0.0064L * cosine * cosine);
  const long double force =
      -2 * standard_gravity * 0.16L * cosine + (1000 * (0.12L - 0.15L) - standard_gravity) * slope;
  const auto wanted = static_cast<double>(std::sqrt(-force / (0.0512L * sine * cosine)));
  const auto near = std::ranges::find_if(
      answer.solutions, [&](const DesignSolution& s) { return std::abs(s.parameter - wanted) < 1e-6; });
  REQUIRE(near != answer.solutions.end());
  CHECK(std::abs(near->parameter - wanted) < 1e-12);
  CHECK(near->parameter_error < 1e-12);
  CHECK(near->at.stable == true);
  // Solving there finds it.
  Mechanism there = m;
  set_parameter(there, speed, near->parameter);
  CHECK(std::abs(value(Analysis(there).solve(), "slide") - 0.12) < 1e-14);
}

TEST_CASE("a value that is never reached is told with what is covered", "[design]") {
  const DesignAnswer answer = design(shipped("governor"), speed, 5, 15, "slide", 0.5);
  CHECK(answer.status == Status::not_converged);
  CHECK(answer.solutions.empty());
  CHECK(answer.lowest < answer.highest);
  CHECK(answer.highest < 0.2);
  CHECK(answer.message.find("never is 0.5 m") != std::string::npos);
  CHECK(answer.message.find("covers") != std::string::npos);
}

TEST_CASE("both ends of what is covered are told apart, or it stays where it is", "[design]") {
  DesignAnswer answer;
  answer.end = DesignEnd::never;
  answer.value = 0.5;
  const auto told = [&](double lowest, double highest) {
    answer.covered = {{lowest, highest}};
    return design_message(answer, 0, 1, true,
                          {.wanted = "s",
                           .wanted_unit = "m",
                           .varied = "n",
                           .varied_unit = "rad/s",
                           .shown = {},
                           .shown_varied = {}});
  };
  CHECK(told(-0.0292200014, -0.0292199986).find(": it covers -0.02922 m to -0.02922 m") == std::string::npos);
  CHECK(told(-0.0292200014, -0.0292199986).find(": it covers -0.029220001 m to -0.029219999 m.") !=
        std::string::npos);
  CHECK(told(-0.02922, -0.02922).find(": it stays at -0.02922 m.") != std::string::npos);
  CHECK(told(0.1, 0.2).find(": it covers 0.1 m to 0.2 m.") != std::string::npos);
}

TEST_CASE("beside each peak of a measure both places where it has a value are found", "[design]") {
  // sin(20 a) of the lean a, cos(a) = g / (w^2 L): between points of the branch it bends much, and its peaks
  // stand hardly above what is wanted.
  Mechanism m = conical(0.7, 0, 1);
  m.measures.push_back({"ripples", "", "sin(20*coordinate(swing))", ""});
  const double length = 0.7, wanted = 0.999999, from = 4, to = 20;
  std::vector<double> speeds;
  for (int turn = -10; turn <= 10; ++turn)
    for (const double beside : {-1., 1.}) {
      const double angle =
          (std::numbers::pi / 2 + beside * std::acos(wanted) + 2 * std::numbers::pi * turn) / 20;
      if (std::abs(angle) >= std::numbers::pi / 2) continue;
      const double w = std::sqrt(standard_gravity / (length * std::cos(angle)));
      if (w > from && w < to) speeds.push_back(w);
    }
  REQUIRE(speeds.size() == 14);
  const DesignAnswer answer = design(m, speed, from, to, "ripples", wanted);
  INFO(answer.message);
  CHECK(answer.solutions.size() == speeds.size());
  for (const double w : speeds)
    CHECK(std::ranges::any_of(answer.solutions,
                              [&](const DesignSolution& s) { return std::abs(s.parameter - w) < 1e-9; }));
}

TEST_CASE("a value that is reached at the very end of the range is found", "[design]") {
  const double w = std::sqrt(standard_gravity / (0.7 * std::cos(1.)));
  for (const double end : {w, std::nextafter(w, 0.), std::nextafter(w, 10.)}) {
    INFO(end - w);
    for (const bool back : {false, true}) {
      const DesignAnswer answer =
          design(conical(0.7, 0, 1), speed, back ? end : 1, back ? 1 : end, "swing", 1);
      INFO(answer.message);
      REQUIRE(answer.solutions.size() == 1);
      CHECK(answer.solutions[0].parameter == Approx(w).epsilon(1e-15));
    }
  }
}

TEST_CASE("a value that holds all along a branch singles out no parameter", "[design]") {
  DesignOptions connected;
  connected.all = false;
  const DesignAnswer answer = design(conical(0.7, 0, 1), speed, 0, 3, "swing", 0, connected);
  CHECK(answer.status == Status::not_converged);
  CHECK(answer.message.find("all along") != std::string::npos);
}

TEST_CASE("stiffness and mass can be asked for, too", "[design]") {
  const Mechanism m = shipped("governor");
  DesignOptions connected;
  connected.all = false;
  const Solution drawn = Analysis(m).solve();
  for (const auto& [address, from, to] :
       {std::tuple{"joints.slide.spring.stiffness", 500., 3000.}, {"bodies.ball1.mass", 0.3, 3.}}) {
    CAPTURE(address);
    const double now = get_parameter(m, address);
    const DesignAnswer answer = design(m, address, from, to, "slide", value(drawn, "slide"), connected);
    INFO(answer.message);
    CHECK(std::ranges::any_of(
        answer.solutions, [&](const DesignSolution& s) { return std::abs(s.parameter - now) < 1e-9 * now; }));
  }
}

TEST_CASE("what cannot be asked is refused, and cancelling ends", "[design]") {
  const Mechanism m = shipped("governor");
  CHECK_THROWS_AS(design(m, speed, 0, 10, "nothing", 1), SceneError);
  CHECK_THROWS_AS(design(m, speed, 0, 10, "spin", 1), SceneError);
  CHECK_THROWS_AS(design(m, "joints.spin.drive.sped", 0, 10, "slide", 1), SceneError);
  const std::atomic<bool> cancel = true;
  DesignOptions options;
  options.cancel = &cancel;
  const DesignAnswer answer = design(m, speed, 0, 10, "slide", 0.12, options);
  CHECK(answer.solutions.empty());
  CHECK(answer.status != Status::converged);
}

TEST_CASE("what a coordinate covers is told branch by branch") {
  // The conical pendulum below, and on its head: nothing between.
  const Mechanism m = shipped("conical_pendulum");
  const DesignAnswer answer = design(m, "joints.spin.drive.speed", 0, 12, "swing", 2.5);
  CHECK(answer.solutions.empty());
  CHECK(answer.message.find("-1.47335 rad to 1.47335 rad and 3.14159 rad") != std::string::npos);
}

TEST_CASE("a damper that is none at the beginning of a range is part of what is solved",
          "[design][branches]") {
  // In a bearing that closes a loop: (0.1 + c) w = 10 N m.
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Two bearings",
    "bodies": [{"name": "A", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]}],
    "joints": [{"name": "p", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=10 N m - 0.1 N m s*rate(p)", "load": 0, "speed": 50}},
      {"name": "b", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 1, 0], "axis": [0, 1, 0]}]})json");
  const std::string damping = "joints.b.damping";
  const ResponseDiagram diagram = follow_branches(m, damping, 0, 1);
  REQUIRE(diagram.branches.size() == 1);
  CHECK(diagram.branches[0].points.back().parameter == 1);
  for (const ResponsePoint& point : diagram.branches[0].points)
    CHECK(point.coordinates[0].speed.value() == Approx(10 / (0.1 + point.parameter)).epsilon(1e-12));

  const DesignAnswer answer = design(m, damping, 0, 1, "p.speed", 40);
  REQUIRE(answer.solutions.size() == 1);
  CHECK(answer.solutions[0].parameter == Approx(10. / 40 - 0.1).epsilon(1e-12));

  const PlaneCurves plane = value_curves(m, {damping, 0, 1}, {"joints.p.drive.load", 0, 5}, "p.speed", 40);
  REQUIRE(plane.curves.size() == 1);
  for (const PlanePoint& p : plane.curves[0].points)
    CHECK((0.1 + p.x) * 40 == Approx(10 - p.y).epsilon(1e-12));
}

TEST_CASE("a damper that sets in along a range is part of what is solved", "[design][branches]") {
  // As above, with c = max(0, n - 6) N m s, of a number that is less where the range is looked into.
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "A damper that sets in",
    "parameters": {"n": {"value": 0}},
    "bodies": [{"name": "A", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]}],
    "joints": [{"name": "p", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=10 N m - 0.1 N m s*rate(p)", "load": 0, "speed": 50}},
      {"name": "b", "type": "revolute", "bodies": ["ground", "A"], "at": [0, 1, 0], "axis": [0, 1, 0],
        "damping": "=max(0, n - 6)*1 N m s"}]})json");
  const auto speed_at = [](double n) { return 10 / (0.1 + std::max(0., n - 6)); };
  const ResponseDiagram diagram = follow_branches(m, "parameters.n", 0, 8);
  REQUIRE(diagram.branches.size() == 1);
  CHECK(diagram.branches[0].points.back().parameter == 8);
  for (const ResponsePoint& point : diagram.branches[0].points)
    CHECK(point.coordinates[0].speed.value() == Approx(speed_at(point.parameter)).epsilon(1e-10));

  const DesignAnswer answer = design(m, "parameters.n", 0, 8, "p.speed", 20);
  REQUIRE(answer.solutions.size() == 1);
  CHECK(answer.solutions[0].parameter == Approx(6.4).epsilon(1e-12));

  const PlaneCurves plane =
      value_curves(m, {"parameters.n", 0, 8}, {"joints.p.drive.load", 0, 5}, "p.speed", 20);
  REQUIRE(plane.curves.size() == 1);
  for (const PlanePoint& p : plane.curves[0].points)
    CHECK((0.1 + p.x - 6) * 20 == Approx(10 - p.y).epsilon(1e-10));
}

TEST_CASE("a weight that sets in along a range hangs where it would be carried round", "[branches]") {
  // On two bearings of one axis, of which the shaft carries the first.
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "A weight that sets in",
    "parameters": {"n": {"value": 0}}, "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "shaft", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
      {"name": "bob", "mass": "=max(0, n - 6)*1 kg", "position": [0.3, -0.4, 0.1]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0],
        "axis": [0, 0, 1], "drive": {"speed": 5}},
      {"name": "on_shaft", "type": "revolute", "bodies": ["shaft", "bob"], "at": [0, 0, 0.1], "axis": [0, 0, 1]},
      {"name": "on_ground", "type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0.2],
        "axis": [0, 0, 1]}]})json");
  const ResponseDiagram diagram = follow_branches(m, "parameters.n", 8, 0);
  INFO(diagram.message);
  REQUIRE(diagram.status == Status::converged);
  CHECK(value(diagram.branches[0].points[0].coordinates, "on_ground") ==
        Approx(-std::atan2(0.3, 0.4)).epsilon(1e-12));
}
