// Branches and lists of equilibria against closed forms and the reference values of the conical pendulum and
// the chain.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/support/campaign.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/solve/solution_difference.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

Mechanism turntable(double drive) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1, Vec3::Zero())};
  m.joints = {joint(JointType::revolute, "spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY())};
  m.joints[0].coordinates[0].drive = Drive{drive};
  return m;
}

// A point mass on a massless rod of length 0.7 m, hinged `offset` from the spin axis.
Mechanism conical(double offset) {
  Mechanism m = turntable(0);
  m.bodies.push_back(body("bob", 1, {offset, -0.7, 0}));
  m.joints.push_back(joint(JointType::revolute, "swing", "hub", "bob", {offset, 0, 0}));
  return m;
}

// Thin uniform rods, 1 m and 1 kg in total, hanging straight on the spin axis, all hinges along z.
Mechanism rods(int count) {
  Mechanism m = turntable(0);
  const double length = 1. / count, mass = 1. / count, inertia = mass * length * length / 12;
  for (int i = 0; i < count; ++i) {
    const std::string name = "rod" + std::to_string(i);
    m.bodies.push_back(body(name, mass, {0, -(i + 0.5) * length, 0}, {inertia, 0, inertia}));
    m.joints.push_back(joint(JointType::revolute, "hinge" + std::to_string(i),
                             i == 0 ? "hub" : "rod" + std::to_string(i - 1), name, {0, -i * length, 0}));
  }
  return m;
}

std::vector<const SpecialPoint*> of_type(const ResponseDiagram& d, SpecialPointType type) {
  std::vector<const SpecialPoint*> out;
  for (const SpecialPoint& s : d.special)
    if (s.type == type) out.push_back(&s);
  return out;
}

double first_coordinate(const ResponsePoint& p) {
  for (const CoordinateSolution& c : p.coordinates)
    if (!c.driven) return c.value;
  return 0;
}

} // namespace

TEST_CASE("the conical pendulum branches at sqrt(g/L) into two stable bent states", "[branches]") {
  const ResponseDiagram d = follow_branches(conical(0), speed, 0, 10);
  REQUIRE(d.status == Status::converged);
  const auto crossings = of_type(d, SpecialPointType::branch_point);
  REQUIRE(crossings.size() == 1);
  CHECK(std::abs(crossings[0]->at.parameter - std::sqrt(standard_gravity / 0.7)) < 1e-8);
  REQUIRE(d.branches.size() == 3);
  for (const ResponsePoint& p : d.branches[0].points) {
    CHECK(std::abs(first_coordinate(p)) < 1e-9);
    if (std::abs(p.parameter - crossings[0]->at.parameter) > 1e-3)
      CHECK(p.stable == (p.parameter < crossings[0]->at.parameter));
  }
  double sides = 0;
  for (int b : {1, 2}) {
    const auto& points = d.branches[static_cast<std::size_t>(b)].points;
    CHECK(std::abs(points.back().parameter - 10) < 1e-12);
    sides += std::copysign(1, first_coordinate(points.back()));
    for (std::size_t i = 2; i < points.size(); ++i) { // cos(angle) = g / (w^2 L)
      const double w = points[i].parameter;
      CHECK(std::cos(first_coordinate(points[i])) == Approx(standard_gravity / (w * w * 0.7)).margin(1e-10));
      CHECK(points[i].stable == true);
    }
  }
  CHECK(sides == 0);
}

TEST_CASE("a hinge off the axis folds the leaning-in branch", "[branches]") {
  const ResponseDiagram d = follow_branches(conical(0.1), speed, 10, 0);
  const auto folds = of_type(d, SpecialPointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK(std::abs(folds[0]->at.parameter - 4.75536807929276) < 1e-8);
  CHECK(std::abs(first_coordinate(folds[0]->at) + 0.5500829670481832) <
        1e-5); // half the digits of the parameter
  // The branch turns back: it ends where it began, on the other side of the fold.
  CHECK(std::abs(d.branches[0].points.back().parameter - 10) < 1e-12);
  CHECK(d.branches[0].points.front().stable != d.branches[0].points.back().stable);
}

TEST_CASE("the straight chain of twenty rods loses its stability where it should", "[branches]") {
  BranchOptions options;
  options.switch_branches = false;
  const ResponseDiagram d = follow_branches(rods(20), speed, 0, 15, options);
  const auto crossings = of_type(d, SpecialPointType::branch_point);
  const double expected[] = {3.7657120752760553, 8.66502558221858, 13.689185570192233};
  REQUIRE(crossings.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(std::abs(crossings[i]->at.parameter - expected[i]) < 1e-8);
}

TEST_CASE("a branch agrees with a sweep that knows nothing of it", "[branches]") {
  for (const char* name : {"governor", "pendulum", "watt_governor", "fourbar_turntable"}) {
    INFO(name);
    const Mechanism m = shipped(name);
    BranchOptions options;
    options.switch_branches = false;
    const double drawn = get_parameter(m, speed);
    const ResponseDiagram d = follow_branches(m, speed, drawn, 1.3 * drawn, options);
    REQUIRE(d.status == Status::converged);
    REQUIRE(d.branches[0].points.size() > 5);
    // Each point must be an equilibrium: Newton-Raphson started there does not move.
    for (std::size_t i = 0; i < d.branches[0].points.size(); i += 3) {
      const ResponsePoint& p = d.branches[0].points[i];
      Mechanism there = m;
      set_parameter(there, speed, p.parameter);
      SolveOptions solve;
      solve.nearest = true;
      for (const CoordinateSolution& c : p.coordinates)
        if (!c.driven && !c.dependent)
          solve.start.push_back({c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index), c.value});
      const Solution s = Analysis(there).solve(solve);
      REQUIRE(s.status == Status::converged);
      CHECK(s.iterations <= 2);
      for (std::size_t c = 0; c < s.coordinates.size(); ++c)
        CHECK(std::abs(s.coordinates[c].value - p.coordinates[c].value) < 1e-7);
      CHECK(s.stable == p.stable);
    }
  }
}

TEST_CASE("the governor's curve is the one it works on, from rest to full speed", "[branches]") {
  // At rest plain Newton-Raphson stops where the links are stretched: an unstable state.
  const ResponseDiagram d = follow_branches(shipped("governor"), speed, 0, 30);
  INFO(d.message);
  const auto works = std::ranges::find_if(d.branches, [](const ResponseBranch& b) {
    return b.connected && b.points.front().stable == true && b.points.back().stable == true;
  });
  REQUIRE(works != d.branches.end());
  CHECK(std::abs(works->points.front().coordinates[3].value - 0.1826698079360885) < 1e-9);
  CHECK(std::abs(works->points.back().parameter - 30) < 1e-12);
}

TEST_CASE("branches that nothing connects are found from the lists of equilibria", "[branches]") {
  BranchOptions options;
  const ResponseDiagram drawn = follow_branches(conical(0.1), speed, 0, 10, options);
  REQUIRE(drawn.branches.size() == 1); // leaning out: no fold, no crossing
  CHECK(drawn.special.empty());
  options.all = true;
  const ResponseDiagram d = follow_branches(conical(0.1), speed, 0, 10, options);
  INFO(d.message);
  // Leaning in, with its fold, and standing on its head.
  REQUIRE(d.branches.size() == 3);
  CHECK(d.branches[0].connected);
  CHECK_FALSE(d.branches[1].connected);
  CHECK_FALSE(d.branches[2].connected);
  CHECK(d.searched == std::vector<double>{0, 10});
  CHECK(d.starts > 50);
  CHECK(d.message.find("there may be more") != std::string::npos);
  const auto folds = of_type(d, SpecialPointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK(std::abs(folds[0]->at.parameter - 4.75536807929276) < 1e-8);
  const ResponseBranch& folded = d.branches[static_cast<std::size_t>(folds[0]->branch)];
  CHECK(std::abs(folded.points.front().parameter - 10) < 1e-12);
  CHECK(std::abs(folded.points.back().parameter - 10) < 1e-12);
  CHECK(folded.points.front().stable != folded.points.back().stable);
  for (const ResponseBranch& b : d.branches)
    for (const ResponsePoint& p : b.points) { // w^2 (o + L sin a) = g tan a
      const double a = first_coordinate(p), w = p.parameter;
      CHECK(w * w * (0.1 + 0.7 * std::sin(a)) * std::cos(a) ==
            Approx(standard_gravity * std::sin(a)).margin(1e-8));
    }
}

TEST_CASE("what is connected is not followed twice", "[branches]") {
  BranchOptions options;
  options.all = true;
  const ResponseDiagram d = follow_branches(conical(0), speed, 0, 10, options);
  REQUIRE(d.branches.size() == 4); // straight, bent either way, and on its head
  CHECK(std::ranges::count(d.branches, false, &ResponseBranch::connected) == 1);
  CHECK(of_type(d, SpecialPointType::branch_point).size() == 1);
  // From one value in the middle only, followed both ways to both ends.
  options.all_at = {5};
  const ResponseDiagram middle = follow_branches(conical(0), speed, 0, 10, options);
  REQUIRE(middle.branches.size() == 4);
  const ResponseBranch& head = middle.branches.back();
  CHECK(std::abs(head.points.front().parameter) < 1e-12);
  CHECK(std::abs(head.points.back().parameter - 10) < 1e-12);
  CHECK(head.begin == "the beginning of the range");
  CHECK(head.end == "the end of the range");
}

TEST_CASE("points carry reactions and drive torques where asked", "[branches]") {
  BranchOptions options;
  options.switch_branches = false;
  CHECK(follow_branches(conical(0.1), speed, 0, 10, options).branches[0].points[3].reactions.empty());
  options.reactions = true;
  const ResponseDiagram d = follow_branches(conical(0.1), speed, 0, 10, options);
  for (const ResponsePoint& p : d.branches[0].points) {
    REQUIRE(p.reactions.size() == 2);
    const Reaction& hinge = p.reactions[1];
    CHECK(hinge.joint == "swing");
    const double r = 0.1 + 0.7 * std::sin(first_coordinate(p)), w = p.parameter;
    CHECK(hinge.force.x() == Approx(-w * w * r).margin(1e-9));
    CHECK(hinge.force.y() == Approx(standard_gravity).margin(1e-9));
    REQUIRE(p.drive_torques.size() == 1);
    CHECK(std::abs(p.drive_torques[0].value) < 1e-9);
  }
}

TEST_CASE("a rotor with inner and outer damping flutters at its closed form", "[branches]") {
  // m u'' + (c_i + c_e) u' + (k - i w c_i) u = 0, u in a frame that does not turn: Hopf at w = n (1 + c_e /
  // c_i).
  const double mass = 0.5, natural = 10, inner = 0.6, outer = 0.15;
  Mechanism m;
  m.bodies = {spindle(), body("x", 0, Vec3::Zero()), body("puck", mass, Vec3::Zero())};
  m.joints = {
      spin(0, {0, 0, 1}),
      dampened(sprung(prismatic("x", "spindle", "x", Vec3::Zero(), {1, 0, 0}), mass * natural * natural),
               inner),
      dampened(sprung(prismatic("y", "x", "puck", Vec3::Zero(), {0, 1, 0}), mass * natural * natural),
               inner)};
  Force air;
  air.name = "air";
  air.type = ForceType::drag;
  air.body = "puck";
  air.linear = outer;
  m.forces = {air};
  const ResponseDiagram d = follow_branches(m, speed, 1, 20);
  INFO(d.message);
  const auto hopf = of_type(d, SpecialPointType::hopf);
  REQUIRE(hopf.size() == 1);
  CHECK(std::abs(hopf[0]->at.parameter - natural * (1 + outer / inner)) < 1e-8);
  for (const ResponsePoint& p : d.branches[0].points)
    CHECK(p.stable == (p.parameter < hopf[0]->at.parameter));
}

TEST_CASE("all equilibria of the conical pendulum, in the order of their potential", "[all]") {
  Mechanism m = conical(0);
  set_parameter(m, speed, 5);
  const AllSolutions all = Analysis(m).solve_all();
  REQUIRE(all.equilibria.size() == 4);
  const double bent = std::acos(standard_gravity / (25 * 0.7));
  for (int i : {0, 1}) {
    const Solution& s = all.equilibria[static_cast<std::size_t>(i)];
    CHECK(std::abs(std::abs(s.coordinates[1].value) - bent) < 1e-12);
    CHECK(s.stable == true);
  }
  CHECK(all.equilibria[0].coordinates[1].value * all.equilibria[1].coordinates[1].value < 0);
  CHECK(std::abs(all.equilibria[2].coordinates[1].value) < 1e-12);
  CHECK(all.equilibria[2].stable == false);
  CHECK(std::abs(std::abs(all.equilibria[3].coordinates[1].value) - std::numbers::pi) < 1e-12);
  CHECK(all.equilibria[3].stable == false);
  for (std::size_t i = 1; i < 4; ++i)
    CHECK(*all.equilibria[i - 1].potential <= *all.equilibria[i].potential + 1e-12);
}

TEST_CASE("the list of all equilibria holds the answer, is repeatable and never claims to be complete",
          "[all]") {
  std::vector<const char*> names{"governor", "pendulum", "fourbar_turntable", "rate_gyro"};
  if (in_campaign()) names.insert(names.end(), {"watt_governor", "governor_bearing"});
  for (const char* name : names) {
    INFO(name);
    const Mechanism m = shipped(name);
    const Solution answer = Analysis(m).solve();
    const AllSolutions all = Analysis(m).solve_all(), again = Analysis(m).solve_all();
    REQUIRE(all.equilibria.size() == again.equilibria.size());
    CHECK(std::ranges::any_of(all.equilibria, [&](const Solution& s) {
      for (std::size_t c = 0; c < s.coordinates.size(); ++c)
        if (std::abs(s.coordinates[c].value - answer.coordinates[c].value) > 1e-9) return false;
      return true;
    }));
    for (const Solution& s : all.equilibria)
      CHECK(s.residual < 1e-10);
    CHECK(all.message.find("may be more") != std::string::npos);
  }
}

TEST_CASE("a branch ends where the balance would turn with the drive", "[branches]") {
  // With the weight across the spin axis there is a steady state at rest alone.
  Mechanism m = shipped("conical_pendulum");
  m.gravity = {standard_gravity, -standard_gravity, 0};
  const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 0, 10);
  for (const ResponseBranch& branch : d.branches) {
    CHECK(branch.points.size() == 1);
    CHECK(branch.points.front().parameter == 0);
    CHECK_THAT(branch.end, ContainsSubstring("no steady state"));
  }
}

TEST_CASE("where nothing resists a direction no crossings are made up", "[branches]") {
  const Mechanism m = shipped("ball_on_string");
  const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 0, 10);
  CHECK(d.status == Status::converged);
  CHECK(d.branches.size() <= 2);
  CHECK(d.message.find("not looked for") == std::string::npos);
  CHECK(d.special.empty());
  // Each point is a steady state: solved from there, nothing moves.
  for (std::size_t i = 0; i < d.branches.back().points.size(); i += 20) {
    const ResponsePoint& p = d.branches.back().points[i];
    Mechanism there = m;
    set_parameter(there, "joints.spin.drive.speed", p.parameter);
    SolveOptions options;
    options.nearest = true;
    for (const CoordinateSolution& c : p.coordinates)
      if (!c.driven && !c.dependent)
        options.start.push_back({c.joint + "." + std::to_string(c.index), c.value});
    const Solution s = Analysis(there).solve(options);
    REQUIRE(s.status == Status::converged);
    for (std::size_t c = 0; c < s.coordinates.size(); ++c)
      if (!s.coordinates[c].angle)
        CHECK(s.coordinates[c].value == Approx(p.coordinates[c].value).margin(1e-7));
  }
}

TEST_CASE("a branch goes on where a stop is reached, and bends there", "[branches]") {
  // Conical pendulum whose swing has soft stops at 0.8 rad: beyond, the stop shares the load.
  constexpr double stiffness = 500, limit = 0.8, length = 0.7;
  Mechanism m = shipped("conical_pendulum");
  m.joints[1].coordinates[0].stop = Stop{-limit, limit, stiffness, {}};
  const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 0, 12);
  REQUIRE(d.branches.size() == 3);
  for (const ResponseBranch& branch : d.branches)
    CHECK(branch.end == "the end of the range");
  std::size_t beyond = 0;
  for (const ResponsePoint& p : d.branches[1].points) {
    const double angle = std::abs(p.coordinates[1].value);
    if (angle > limit + 1e-9) {
      ++beyond;
      // The same without the stop, with the stop's torque on top.
      const double speed_squared = p.parameter * p.parameter;
      double mass = 0;
      for (const Body& b : m.bodies)
        if (b.name == m.joints[1].bodies[1]) mass = b.mass;
      const double balance = mass * length * length * speed_squared * std::sin(angle) * std::cos(angle) -
                             mass * standard_gravity * length * std::sin(angle) - stiffness * (angle - limit);
      CHECK(std::abs(balance) < 1e-8);
      CHECK(p.stable == true);
    }
  }
  CHECK(beyond > 10);
}

TEST_CASE("what hangs on a slide goes as far wherever it is drawn", "[branches]") {
  // A block of 1 kg: free + m g / k. Its mass centre is drawn on the slide's line but for rounding, for what
  // an export leaves, or for a little.
  const double from_line = GENERATE(0., 1e-16, 1e-9, 1e-4, 1e-3, 1e-2);
  INFO(from_line << " m from the line");
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("b", 1, {0.3 + from_line, 0, 0})};
  m.joints = {joint(JointType::prismatic, "s", "ground", "b", {0.3, 0, 0}, -Vec3::UnitY())};
  m.joints[0].coordinates[0].drawn = 0.1;
  m.joints[0].coordinates[0].spring = CoordinateSpring{1000, 0.15};
  validate(m);
  const Solution s = Analysis(m).solve();
  INFO(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.iterations < 20);
  CHECK(value(s, "s") == Approx(0.15 + standard_gravity / 1000).epsilon(1e-14));
  const ResponseDiagram d = follow_branches(m, "joints.s.spring.stiffness", 500, 2000);
  REQUIRE(d.branches.size() == 1);
  CHECK(d.branches[0].end == "the end of the range");
  CHECK(d.branches[0].points.back().coordinates[0].value ==
        Approx(0.15 + standard_gravity / 2000).epsilon(1e-12));
}

TEST_CASE("no curve goes on to numbers that a scene may not have", "[branches]") {
  const Mechanism m = shipped("governor");
  CHECK_THROWS_WITH(follow_branches(m, "bodies.ball1.mass", -5, 5),
                    ContainsSubstring("bodies.ball1.mass") && ContainsSubstring("zero or more"));
  CHECK_THROWS_AS(follow_branches(m, speed, 0, 1e31), SceneError);
  // By an expression the curve ends where that is: its parameter may be anything.
  Mechanism lighter = m;
  lighter.parameters.push_back({"w", "", 1, "kg", {}, {}});
  for (Body& b : lighter.bodies)
    if (b.name == "ball1" || b.name == "ball2") b.formulas.push_back({"mass", "2 kg - w"});
  validate(lighter);
  const ResponseDiagram d = follow_branches(lighter, "parameters.w", 0, 6);
  REQUIRE(!d.branches.empty());
  CHECK_THAT(d.branches[0].end, ContainsSubstring("beyond it no mechanism can be made"));
  CHECK(d.branches[0].points.back().parameter == Approx(2).margin(1e-6));
  for (const ResponseBranch& branch : d.branches)
    for (const ResponsePoint& p : branch.points)
      CHECK(p.parameter <= 2);
}

TEST_CASE("what nothing resists at the beginning of a range alone is followed from beside it", "[branches]") {
  // The slider's own range: without load the last wheel lies anywhere within its play.
  const ResponseDiagram d = follow_branches(shipped("gear_train"), "parameters.load_c", 0, 8);
  REQUIRE(!d.branches.empty());
  CHECK(d.branches[0].end == "the end of the range");
  CHECK(d.branches[0].points.front().parameter == 0);
  CHECK(d.branches[0].points.size() > 40);
}

TEST_CASE("a curve begins where a mechanism can be made first", "[branches]") {
  Mechanism m = shipped("governor_parametric");
  NamedParameter& less = m.parameters.emplace_back();
  less.name = "less";
  less.unit = "kg";
  less.value = 1;
  for (Body& each : m.bodies)
    if (each.name.starts_with("ball")) {
      std::erase_if(each.formulas, [](const Formula& formula) { return formula.key == "mass"; });
      each.formulas.push_back({"mass", "3 kg - less"});
      std::ranges::sort(each.formulas, {}, &Formula::key);
    }
  evaluate_formulas(m);
  const ResponseDiagram forth = follow_branches(m, "parameters.less", 0, 6),
                        back = follow_branches(m, "parameters.less", 6, 0);
  REQUIRE(!forth.branches.empty());
  REQUIRE(!back.branches.empty());
  CHECK(forth.branches[0].points.back().parameter == Approx(3).margin(1e-5));
  CHECK(back.branches[0].points.front().parameter == Approx(3).margin(1e-5));
  CHECK(back.branches[0].points.back().parameter == 0);
  CHECK(back.branches[0].points.size() > 20);
  CHECK_THAT(back.message, ContainsSubstring("no mechanism can be made"));
  for (const ResponseDiagram* d : {&forth, &back})
    for (const ResponseBranch& branch : d->branches)
      for (const ResponsePoint& p : branch.points)
        CHECK(p.parameter <= 3);
  CHECK_THROWS_AS(follow_branches(m, "parameters.less", 4, 6), SceneError);
}

TEST_CASE("where many states are balanced the curve begins at the one that it tends to", "[branches]") {
  // A rod on a pin, and a force that turns it: without the force it stands anywhere, with it along the force.
  Mechanism m;
  m.bodies = {body("rod", 1, {0.5, 0.5, 0}, {0.1, 0.1, 0.1})};
  m.joints = {joint(JointType::revolute, "p", "ground", "rod", Vec3::Zero(), Vec3::UnitZ())};
  Force& pull = m.forces.emplace_back();
  pull.name = "pull";
  pull.type = ForceType::force;
  pull.body = "rod";
  pull.at = {0.5, 0.5, 0};
  pull.vector = {0, 0, 0};
  validate(m);
  const ResponseDiagram d = follow_branches(m, "forces.pull.vector.0", 0, 1);
  REQUIRE(!d.branches.empty());
  REQUIRE(d.branches[0].points.size() > 2);
  for (const ResponsePoint& p : d.branches[0].points)
    CHECK(p.coordinates[0].value == Approx(-std::numbers::pi / 4).margin(1e-9));
}

TEST_CASE("a family at one value of the parameter has no folds", "[branches]") {
  // A sleeping top, whose spin and precession turn about one axis.
  const ResponseDiagram d = follow_branches(shipped("free_top"), "joints.precession.drive.speed", 0, 10);
  REQUIRE(!d.branches.empty());
  for (const SpecialPoint& point : d.special) // but that of the curve which leans to either side
    if (point.type == SpecialPointType::fold) CHECK(point.branch == 0);
}

TEST_CASE("where loops are singular all along a branch no points are special", "[branches]") {
  // Arms that hang straight: along either alone more moves than the links let.
  const ResponseDiagram d = follow_branches(shipped("governor"), speed, 2.2, 22);
  REQUIRE(!d.branches.empty());
  for (const ResponseBranch& branch : d.branches)
    for (const ResponsePoint& p : branch.points)
      if (p.singular_loops) {
        CHECK(p.eigenvalues.empty());
        CHECK(p.stable != false);
      }
  for (const SpecialPoint& point : d.special)
    CHECK(std::abs(point.at.parameter - std::sqrt(standard_gravity / 0.16)) > 1e-3);
}

TEST_CASE("where arms that hang part from each other the lifted curve is found from either end",
          "[branches]") {
  // Watt's governor, its arms hinged on the axis: there the links' rows are one. V'' = 0 at
  // w^2 = (2 m + M) g / (2 m l); lifted, cos(angle) is that over w^2.
  const double m = 1, collar = 0.5, l = 0.2;
  const Mechanism governor = read_scene(R"({
    "flyball": 1, "name": "Watt", "gravity": [0, -9.80665, 0],
    "bodies": [
      {"name": "shaft", "mass": 0.1, "position": [0, 0, 0], "inertia": [0.001, 0.001, 0.001]},
      {"name": "ball1", "mass": 1, "position": [0.12, 0.14, 0]},
      {"name": "ball2", "mass": 1, "position": [-0.12, 0.14, 0]},
      {"name": "collar", "mass": 0.5, "position": [0, 0.14, 0]}],
    "joints": [
      {"name": "spin", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0], "axis": [0, 1, 0],
       "drive": {"speed": 10}},
      {"name": "arm1", "type": "revolute", "bodies": ["shaft", "ball1"], "at": [0, 0.3, 0], "axis": [0, 0, 1]},
      {"name": "arm2", "type": "revolute", "bodies": ["shaft", "ball2"], "at": [0, 0.3, 0], "axis": [0, 0, -1]},
      {"name": "slide", "type": "prismatic", "bodies": ["shaft", "collar"], "at": [0, 0.14, 0], "axis": [0, 1, 0]},
      {"name": "link1", "type": "distance", "bodies": ["ball1", "collar"], "points": [[0.06, 0.22, 0], [0, 0.14, 0]]},
      {"name": "link2", "type": "distance", "bodies": ["ball2", "collar"], "points": [[-0.06, 0.22, 0], [0, 0.14, 0]]}]
  })");
  const double lifts = (2 * m + collar) * standard_gravity / (2 * m * l), drawn = std::acos(0.8);
  for (const auto& [from, to] : {std::pair{0., 15.}, {15., 0.}}) {
    CAPTURE(from, to);
    const ResponseDiagram d = follow_branches(governor, speed, from, to);
    REQUIRE(d.branches.size() >= 2);
    REQUIRE(!d.special.empty());
    CHECK(std::ranges::any_of(d.special, [&](const SpecialPoint& point) {
      return point.type == SpecialPointType::branch_point &&
             std::abs(point.at.parameter - std::sqrt(lifts)) < 1e-5 * std::sqrt(lifts);
    }));
    int lifted = 0, hanging = 0;
    for (const ResponseBranch& branch : d.branches) {
      CHECK(branch.connected);
      for (const ResponsePoint& p : branch.points) {
        const double angle = std::abs(p.coordinates[1].value + drawn);
        if (angle < 0.1) {
          hanging += p.parameter < 5;
          continue;
        }
        CHECK(std::abs(std::cos(angle) - lifts / (p.parameter * p.parameter)) < 1e-9);
        CHECK(p.stable == true);
        ++lifted;
      }
    }
    CHECK(lifted > 20);
    CHECK(hanging > 5);
  }
}

TEST_CASE("a curve that turns back at a stop goes on along it", "[branches]") {
  SECTION("a pendulum in a spring's pull") {
    // Upright the rod is unstable; F pulls its top to the side: sin(q) m g h = F h cos(q) on the branch that
    // leans against the pull, until it comes to rest on its stop.
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("rod", 2, {0, 0.5, 0}, {0, 0, 0})};
    Joint hinge = revolute("hinge", "ground", "rod", {0, 0, 0}, {0, 0, 1});
    const double limit = 0.3, stiffness = 1e5;
    hinge.coordinates[0].stop = Stop{{}, limit, stiffness};
    m.joints = {hinge};
    Force pull;
    pull.name = "pull";
    pull.type = ForceType::force;
    pull.body = "rod";
    pull.vector = {1, 0, 0};
    m.forces = {pull};
    const ResponseDiagram d = follow_branches(m, "forces.pull.vector.0", 0, 20);
    REQUIRE(!d.branches.empty());
    const auto& points = d.branches[0].points;
    const double weight = 2 * standard_gravity, fold = weight * std::tan(limit);
    int leaning = 0, resting = 0;
    for (const ResponsePoint& p : points) {
      const double q = p.coordinates[0].value;
      if (q < limit) {
        CHECK(std::abs(weight * std::tan(q) - p.parameter) < 1e-8 * weight);
        if (std::abs(q - limit) > 1e-6) CHECK(p.stable == false);
        ++leaning;
      } else {
        const double moment = 0.5 * (weight * std::sin(q) - p.parameter * std::cos(q));
        CHECK(std::abs(moment - stiffness * (q - limit)) < 1e-8 * weight);
        CHECK(p.parameter < fold + 1e-9);
        CHECK(p.stable == true);
        ++resting;
      }
    }
    CHECK(leaning > 3);
    CHECK(resting > 3);
    CHECK(d.branches[0].end == "the beginning of the range");
    REQUIRE(!d.special.empty());
    CHECK(d.special[0].type == SpecialPointType::fold);
    CHECK_THAT(d.special[0].at.parameter, Catch::Matchers::WithinAbs(fold, 1e-5));
  }
  SECTION("a governor") {
    const ResponseDiagram d = follow_branches(shipped("governor_hartnell"), "parameters.k", 2000, 40000);
    REQUIRE(!d.branches.empty());
    CHECK_THAT(d.branches[0].end, ContainsSubstring("of the range"));
    CHECK(d.special.size() == 1);
  }
}

TEST_CASE("a diagram that begins at the scene's own number has the state that solving answers") {
  // Watt's: arms that are crossed inwards are nearer to the drawn pose, and stable, too.
  const Mechanism m = shipped(GENERATE(as<std::string>(), "watt_governor", "governor"));
  CAPTURE(m.name);
  const Solution s = Analysis(m).solve();
  const double own = get_parameter(m, speed);
  const ResponseDiagram d = follow_branches(m, speed, own, own + 1);
  CHECK(std::ranges::any_of(d.branches, [&](const ResponseBranch& branch) {
    return scaled_distance(branch.points.front().coordinates, s.coordinates) < 1e-9;
  }));
}

TEST_CASE("branches that nearly cross are followed one by one, whatever the step") {
  // Springs that are slack in the drawn pose, a little aside, hold the fork of the hanging chain apart:
  // nothing crosses. By the smallest steps, which pass between.
  const Mechanism m = bench::springy_chain(GENERATE(2, 4, 12), 6, 0.1, 0);
  BranchOptions options;
  options.eigenvalues = false;
  options.largest_step = 0.002;
  const ResponseDiagram fine = follow_branches(m, "joints.spin.drive.speed", 3, 10, options);
  REQUIRE(fine.branches.size() == 1);
  CHECK(fine.special.empty());
  for (const double step : {0.1, 0.05, 0.02, 0.01}) {
    CAPTURE(step);
    options.largest_step = step;
    const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 3, 10, options);
    REQUIRE(d.branches.size() == 1);
    CHECK(d.special.empty());
    const ResponsePoint &end = d.branches[0].points.back(), &reference = fine.branches[0].points.back();
    CHECK(end.parameter == 10);
    REQUIRE(end.coordinates.size() == reference.coordinates.size());
    for (std::size_t i = 0; i < end.coordinates.size(); ++i)
      CHECK(std::abs(end.coordinates[i].value - reference.coordinates[i].value) < 1e-9);
  }
}

TEST_CASE("points that a branch may have are not spent on steps that are taken again", "[branches]") {
  // Of the chain above, where steps are shortened so that none leaps.
  const Mechanism m = bench::springy_chain(4, 6, 0.1, 0);
  BranchOptions options;
  options.eigenvalues = false;
  options.largest_step = 0.1;
  const ResponseDiagram whole = follow_branches(m, "joints.spin.drive.speed", 3, 10, options);
  REQUIRE(whole.branches.size() == 1);
  const std::size_t points = whole.branches[0].points.size();
  REQUIRE(whole.branches[0].end == "the end of the range");
  options.max_points = static_cast<int>(points);
  CHECK(follow_branches(m, "joints.spin.drive.speed", 3, 10, options).branches[0].end ==
        "the end of the range");
  options.max_points = static_cast<int>(points) - 2;
  const ResponseDiagram cut = follow_branches(m, "joints.spin.drive.speed", 3, 10, options);
  CHECK(cut.branches[0].end == "the largest number of points");
  CHECK(cut.branches[0].points.size() == points - 2);
}

TEST_CASE("a branch goes on over a kink with the step that it came with", "[branches]") {
  // A pendulum held upright by a spring of k N m/rad where its weight takes 1.5 of these: from s = sqrt(1/2)
  // on k is 2, before it is 1. It is upright throughout, and there it becomes stable at once.
  Mechanism m = read_scene(R"({"flyball": 2, "name": "upright", "gravity": [0, -10, 0],
    "parameters": {"s": {"value": 0.1, "range": [0, 2]}},
    "bodies": [{"name": "rod", "mass": 1, "position": [0, 0.15, 0], "inertia": [0.01, 0.01, 0.01]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0],
                "axis": [0, 0, 1],
                "spring": {"stiffness": "=(1.5 + 0.5 * abs(s - sqrt(0.5)) / (s - sqrt(0.5))) * 1 N m"}}]})");
  BranchOptions options;
  options.largest_step = 0.05; // of the range of 2: 0.1
  options.switch_branches = false;
  const ResponseDiagram d = follow_branches(m, "parameters.s", 0, 2, options);
  REQUIRE(!d.branches.empty()); // the bent state before the kink has one, too
  REQUIRE(d.special.size() == 1);
  CHECK(d.special[0].type == SpecialPointType::branch_point);
  CHECK_THAT(d.special[0].at.parameter, Catch::Matchers::WithinAbs(std::sqrt(0.5), 1e-9));
  const std::vector<ResponsePoint>& points = d.branches[0].points;
  CHECK(d.branches[0].end == "the end of the range");
  for (const ResponsePoint& p : points) {
    CHECK(std::abs(p.coordinates[0].value) < 1e-9);
    CHECK(p.stable == (p.parameter > std::sqrt(0.5)));
  }
  const auto beyond = std::ranges::find_if(points, [](const ResponsePoint& p) { return p.stable == true; });
  REQUIRE((beyond != points.begin() && beyond != points.end()));
  CHECK_THAT(beyond->parameter - std::prev(beyond)->parameter, Catch::Matchers::WithinAbs(0.1, 1e-6));
}

TEST_CASE("a bead that nothing holds where its rod stands lies at a stop where it turns", "[branches]") {
  // Where the rod stands the bead may be anywhere between its stops. Where it turns at w it is in balance on
  // the axis, unstable, and at either stop of k N/m, pressed in to x = 0.5 k / (k - m w^2).
  constexpr double k = 1e4, mass = 2, drawn = 0.3, stop = 0.5;
  Mechanism m;
  m.bodies = {body("rod", 1, {0, 0, 0}, {1, 1, 1}), body("bead", mass, {drawn, 0, 0})};
  m.joints = {driven(revolute("spin", "ground", "rod", {0, 0, 0}, Vec3::UnitY()), 0),
              dampened(prismatic("slide", "rod", "bead", {drawn, 0, 0}, Vec3::UnitX()), 1)};
  Coordinate& c = m.joints[1].coordinates[0];
  c.drawn = drawn;
  c.stop = Stop{.lower = -stop, .upper = stop, .stiffness = k};
  BranchOptions options;
  const auto ends = [&] {
    std::vector<double> out;
    const ResponseDiagram d = follow_branches(m, "joints.spin.drive.speed", 0, 8, options);
    CHECK(d.special.empty());
    for (const ResponseBranch& branch : d.branches) {
      const ResponsePoint& last = branch.points.back();
      CHECK(last.parameter == 8);
      CHECK(branch.points.front().parameter < 1e-5);
      CHECK(last.stable == (std::abs(last.coordinates.back().value) > 0.1));
      out.push_back(last.coordinates.back().value);
    }
    std::ranges::sort(out);
    return out;
  };
  const double pressed = stop * k / (k - mass * 64);
  const std::vector<double> from_drawn = ends();
  REQUIRE(from_drawn.size() == 2);
  CHECK(std::abs(from_drawn[0]) < 1e-15);
  CHECK(from_drawn[1] == Approx(pressed).epsilon(1e-12));
  options.all = true;
  const std::vector<double> all = ends();
  REQUIRE(all.size() == 3);
  CHECK(all[0] == Approx(-pressed).epsilon(1e-12));
  CHECK(all[2] == Approx(pressed).epsilon(1e-12));
}
