// Measures of steady states, against closed forms; their rates, against differences; and in every study.
#include "tests/engine/dynamics_runs.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/dice.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/report/measures.hpp"
#include "engine/study/design.hpp"
#include "engine/study/sweep.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

const MeasureSolution& measure(const std::vector<MeasureSolution>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &MeasureSolution::name);
  REQUIRE(found != all.end());
  return *found;
}

// Within what is claimed.
void check_measure(const Solution& s, const std::string& name, double wanted) {
  const MeasureSolution& found = measure(s.measures, name);
  CAPTURE(name, wanted, found.reason, s.message);
  REQUIRE(found.value.has_value());
  REQUIRE(found.error.has_value());
  CAPTURE(*found.value, *found.error);
  CHECK(std::abs(*found.value - wanted) <= *found.error + 1e-15 * std::abs(wanted));
  CHECK(*found.error < 1e-10 * (1 + std::abs(wanted)));
}

Mechanism measured_pendulum(double length, double w) {
  Mechanism m = conical(length, 0, w, 0.5, 1.7);
  const std::string bob = m.bodies.back().name;
  m.points = {{"P", Vec3::Zero(), {}}, {"U", Vec3(0, 1, 0), {}}};
  m.measures = {{"lean", "", "angle(" + bob + ", ground@P, ground@U)", "rad"},
                {"swing_angle", "", "coordinate(swing)", "rad"},
                {"depth", "", "-y(" + bob + ")", "m"},
                {"ball_speed", "", "speed(" + bob + ")", "m/s"},
                {"pull", "", "acceleration(" + bob + ")*mass(" + bob + ")", "N"},
                {"hinge", "", "reaction(swing)", "N"},
                {"up", "", "reaction_y(swing)", "N"},
                {"bend", "", "moment_y(swing)", "N m"},
                {"drive", "", "torque(spin)", "N m"},
                {"power_in", "", "power(spin)", "W"},
                {"turning", "", "rate(spin)", "rad/s"},
                {"rod", "", "distance(" + bob + ", ground@P)", "m"},
                {"undefined", "", "sqrt(-rod / (1 m))", ""}};
  return m;
}

// A body held by springs and stops, between spheres and rods.
Mechanism hung() {
  Mechanism m;
  m.name = "hung";
  m.gravity = Vec3(0, -10, 0);
  m.bodies = {body("weight", 2, Vec3(0, -1, 0), Vec3::Constant(0.1)), body("fixed", 1, Vec3(3, 0, 0))};
  m.bodies[0].shapes.emplace_back().radius = 0.25;
  Shape post;
  post.type = ShapeType::capsule;
  post.radius = 0.5;
  post.from = Vec3(3, 4, 0);
  post.to = Vec3(3, -9, 0);
  m.bodies[1].shapes = {post};
  Joint fall = sprung(prismatic("fall", "ground", "weight", Vec3(0, -1, 0), -Vec3::UnitY()), 50, 0);
  fall.coordinates[0].stop = Stop{-0.5, 2, 1000, ""};
  m.joints = {fall, joint(JointType::fixed, "post", "ground", "fixed", Vec3(3, 0, 0))};
  m.forces = {point_spring("coil", "ground", "weight", Vec3::Zero(), Vec3(0, -1, 0), 30)};
  m.measures = {{"way", "", "coordinate(fall)", "m"},        {"held", "", "tension(coil)", "N"},
                {"long", "", "length(coil)", "m"},           {"inner", "", "spring(fall)", "N"},
                {"room", "", "clearance(fall)", "m"},        {"gap", "", "clearance(weight, fixed)", "m"},
                {"sum", "", "held - inner + gap*1 N/m", "N"}};
  return m;
}

// Of two rows or six, between the ground and a body, any way round.
Force random_bearing(std::uint32_t seed, const std::string& body) {
  Dice dice(seed + 500);
  Force f;
  f.name = "film";
  f.type = ForceType::bearing;
  f.bodies =
      seed % 3 ? std::array{std::string(ground_name), body} : std::array{body, std::string(ground_name)};
  f.at = Vec3(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1));
  f.axis = dice.direction();
  const std::size_t size = seed % 2 ? 6 : 2;
  for (std::size_t i = 0; i < size * size; ++i) {
    f.bearing_stiffness.push_back(dice.between(-20, 20));
    f.bearing_damping.push_back(dice.between(-2, 2));
  }
  return f;
}

// What six rows have to do where a drive turns what they hold.
void resist_shifts_alone(Force& bearing) {
  for (BearingMatrix* each : {&bearing.bearing_stiffness, &bearing.bearing_damping})
    for (std::size_t i = 0; i < each->size() && each->size() == 36; ++i)
      if (i % 6 >= 3 || i / 6 >= 3) (*each)[i] = 0;
}

// "force_x(coil)" and its like, with their units; sizes have a kink where they are zero.
std::vector<std::pair<std::string, std::string>> elastic_results(const Force& force) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const char* of : {"_x", "_y", "_z"}) {
    all.emplace_back("force" + std::string(of) + "(" + argument_text(force.name) + ")", "N");
    if (force.type == ForceType::bearing)
      all.emplace_back("couple" + std::string(of) + "(" + argument_text(force.name) + ")", "N m");
  }
  return all;
}

// Told by differences of two orders: a damper by its law may have one where it rests.
bool has_corner(double coarse, double fine) {
  return std::abs(coarse - fine) > 1e-5 * std::abs(coarse);
}

// With a named point, a bearing, and any drives and loops.
Mechanism random_to_measure(std::uint32_t seed, int bodies) {
  reference::RandomOptions options;
  options.bodies = bodies;
  options.loops = seed % 3 == 0 ? 1 : 0;
  options.drives = seed % 2 ? reference::RandomDrives::several : reference::RandomDrives::root;
  options.steady = false;
  Mechanism m = reference::random_mechanism(seed, options);
  m.points = {{"A", Vec3(0.3, -0.2, 0.5), {}}};
  m.forces.push_back(random_bearing(seed, m.bodies.back().name));
  if (compile(m).bearings.front().turning >= 0) resist_shifts_alone(m.forces.back());
  m.measures.clear();
  return m;
}

} // namespace

TEST_CASE("measures of a conical pendulum are those of the closed form", "[measures]") {
  for (const double w : {4., 6., 12.}) {
    const double length = 0.7, g = standard_gravity, mass = 1.7;
    const Solution s = solve(measured_pendulum(length, w));
    REQUIRE(s.status == Status::converged);
    const double cosine = std::min(1., g / (w * w * length)), sine = std::sqrt(1 - cosine * cosine);
    CAPTURE(w);
    check_measure(s, "depth", length * cosine);
    check_measure(s, "ball_speed", w * length * sine);
    check_measure(s, "pull", mass * w * w * length * sine);
    check_measure(s, "hinge", mass * g / cosine);
    check_measure(s, "up", mass * g);
    check_measure(s, "bend", 0);
    check_measure(s, "drive", 0);
    check_measure(s, "power_in", 0);
    check_measure(s, "turning", w);
    check_measure(s, "rod", length);
    if (w > 4) check_measure(s, "lean", std::numbers::pi - std::acos(cosine));
    const MeasureSolution& undefined = measure(s.measures, "undefined");
    CHECK_FALSE(undefined.value.has_value());
    CHECK_FALSE(undefined.error.has_value());
    CHECK_FALSE(undefined.reason.empty());
  }
}

TEST_CASE("springs, stops and clearances are those of Hooke and Euclid", "[measures]") {
  const Solution s = solve(hung());
  REQUIRE(s.status == Status::converged);
  const double way = 2. * 10 / 80;
  check_measure(s, "way", way);
  check_measure(s, "held", 30 * way);
  check_measure(s, "long", 1 + way);
  check_measure(s, "inner", -50 * way);
  check_measure(s, "room", way + 0.5);
  check_measure(s, "gap", 3 - 0.25 - 0.5);
  check_measure(s, "sum", 80 * way + 2.25);
}

TEST_CASE("what is not asked for is not computed, and nothing changes without measures", "[measures]") {
  Mechanism m = measured_pendulum(0.7, 6);
  System system = compile(m);
  Parameters p;
  bind(system, m, p);
  MeasureSet all;
  all.bind(m, system, p);
  CHECK(all.needs_forces());
  CHECK(all.needs_accelerations());
  m.measures.resize(3);
  all.bind(m, system, p);
  CHECK(all.size() == 3);
  CHECK_FALSE(all.needs_forces());
  CHECK_FALSE(all.needs_accelerations());
  m.measures.clear();
  CHECK(solve(m).measures.empty());
}

TEST_CASE("rates of measures along the coordinates agree with differences", "[measures]") {
  Dice dice(7);
  int compared = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    Mechanism m = random_to_measure(seed, 4);
    const auto add = [&](const std::string& text, const std::string& unit) {
      m.measures.push_back({"m" + std::to_string(m.measures.size()), "", text, unit});
    };
    for (const Body& each : m.bodies) {
      const std::string name = argument_text(each.name);
      for (const char* axis : {"x", "y", "z"}) {
        add(std::string(axis) + "(" + name + "@A)", "m");
        add("v" + std::string(axis) + "(" + name + ")", "m/s");
        add("a" + std::string(axis) + "(" + name + "@A)", "m/s^2");
      }
      add("speed(" + name + "@A)", "m/s");
      add("acceleration(" + name + ")", "m/s^2");
      add("distance(" + name + ", ground@A)", "m");
      add("angle(" + name + ", ground@A, " + argument_text(m.bodies.front().name) + "@A)", "rad");
    }
    for (const Joint& each : m.joints)
      for (int i = 0; i < coordinate_count(each.type); ++i)
        add("coordinate(" + argument_text(each.name) +
                (coordinate_count(each.type) > 1 ? "." + std::to_string(i) : "") + ")",
            is_angle(each.type, i) ? "rad" : "m");
    for (const Force& each : m.forces)
      if (each.type == ForceType::spring) {
        add("length(" + argument_text(each.name) + ")", "m");
        add("tension(" + argument_text(each.name) + ")", "N");
      }
    std::vector<bool> elastic(m.measures.size(), false);
    for (const Force& each : m.forces)
      if (acts_between(each.type))
        for (const auto& [text, unit] : elastic_results(each))
          add(text, unit);
    elastic.resize(m.measures.size(), true);
    const System system = compile(m);
    if (system.nv == 0) continue;
    Parameters p;
    Scaling scaling;
    bind(system, m, p);
    set_scaling(system, p, scaling);
    const Problem problem{system, p, scaling};
    Eigen::VectorXd q;
    drawn_configuration(system, p, q);
    Eigen::VectorXd step(system.nv);
    // Where a loop is open, the coordinates of the joint that closes it are not defined by its poses alone.
    const double displaced = system.rows > 0 ? 0 : 0.4;
    for (Eigen::Index v = 0; v < step.size(); ++v)
      step[v] = dice.between(-displaced, displaced) * scaling.column[v];
    retract<double>(system, step, q);
    MeasureSet measures;
    measures.bind(m, system, p);
    CHECK_FALSE(measures.needs_forces());
    Workspace w, beside;
    measures.evaluate_at(problem, q, w);
    const Eigen::MatrixXd rates = measures.gradient(problem, q, w, beside);
    for (Eigen::Index v = 0; v < system.nv; ++v) {
      const double h = 1e-4 * scaling.column[v];
      std::array<Eigen::VectorXd, 4> at; // the error of the combination is of order h^4
      for (std::size_t i = 0; i < 4; ++i) {
        Eigen::VectorXd moved = q;
        retract<double>(system, Eigen::VectorXd::Unit(system.nv, v) * h * std::array{1., -1., 2., -2.}[i],
                        moved);
        at[i] = measures.evaluate_at(problem, moved, beside);
      }
      const Eigen::VectorXd difference = (8 * (at[0] - at[1]) - (at[2] - at[3])) / (12 * h);
      for (std::size_t i = 0; i < measures.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double expected = difference[k], size = std::abs(at[0][k]);
        if (!std::isfinite(expected) || !std::isfinite(rates(k, v))) continue;
        // An angle of joints may jump by a turn.
        if (std::abs(at[2][k] - at[3][k]) > 1 && m.measures[i].unit == "rad") continue;
        if (elastic[i] && has_corner((at[0][k] - at[1][k]) / (2 * h), expected)) continue;
        INFO("seed " << seed << " " << m.measures[i].text << " along " << v);
        CHECK(std::abs(rates(k, v) - expected) < 1e-8 * (1 + std::abs(expected)) + 1e-11 * (1 + size) / h);
        ++compared;
      }
    }
  }
  CHECK(compared > 10000);
}

TEST_CASE("measures move with the sliders as their closed form does", "[measures]") {
  Mechanism m = measured_pendulum(0.7, 6);
  m.sliders = {{speed, 0, 10, SliderScale::linear, ""}, {"gravity.1", -20, -5, SliderScale::linear, ""}};
  const Solution s = solve(m);
  const double w = 6, length = 0.7, mass = 1.7;
  REQUIRE(s.sensitivities.size() == 2);
  const auto rate = [&](std::size_t slider, const std::string& name) {
    const auto at = std::ranges::find(m.measures, name, &NamedMeasure::name) - m.measures.begin();
    return s.sensitivities[slider].measures.at(static_cast<std::size_t>(at));
  };
  CHECK(rate(0, "hinge") == Approx(mass * 2 * w * length).epsilon(1e-7)); // m g / cos = m w^2 L
  CHECK(rate(0, "depth") == Approx(-2 * standard_gravity / (w * w * w)).epsilon(1e-7));
  CHECK(rate(0, "turning") == Approx(1).epsilon(1e-8));
  CHECK(rate(1, "hinge") == Approx(0).margin(1e-6));
  CHECK(rate(1, "depth") == Approx(-1 / (w * w)).epsilon(1e-7)); // gravity is along -y
}

TEST_CASE("rates of measures with numbers agree with differences", "[measures]") {
  int compared = 0;
  for (std::uint32_t seed = 1; seed <= few_or_all(12u, 24u); ++seed) {
    Mechanism m = random_to_measure(seed, 3);
    const auto add = [&](const std::string& text, const std::string& unit) {
      m.measures.push_back({"m" + std::to_string(m.measures.size()), "", text, unit});
    };
    for (const Body& each : m.bodies) {
      const std::string name = argument_text(each.name);
      add("x(" + name + "@A) + A.y", "m");
      add("vy(" + name + ")", "m/s");
      add("az(" + name + "@A)", "m/s^2");
      add("distance(" + name + ", ground@A) * mass(" + name + ")", "kg m");
      add("angle(" + name + ", ground@A, " + argument_text(m.bodies.front().name) + "@A)", "rad");
    }
    for (const Joint& each : m.joints)
      for (int i = 0; i < coordinate_count(each.type); ++i) {
        const std::string name =
            argument_text(each.name) + (coordinate_count(each.type) > 1 ? "." + std::to_string(i) : "");
        const bool angle = is_angle(each.type, i);
        add("coordinate(" + name + ")", angle ? "rad" : "m");
        add("rate(" + name + ")", angle ? "rad/s" : "m/s");
        const Coordinate& c = each.coordinates[static_cast<std::size_t>(i)];
        if (c.spring) add("spring(" + name + ")", angle ? "N m" : "N");
        if (c.stop) add("clearance(" + name + ")", angle ? "rad" : "m");
      }
    for (const Force& each : m.forces)
      if (each.type == ForceType::spring) add("tension(" + argument_text(each.name) + ")", "N");
    std::vector<bool> elastic(m.measures.size(), false);
    for (const Force& each : m.forces)
      if (acts_between(each.type))
        for (const auto& [text, unit] : elastic_results(each))
          add(text, unit);
    elastic.resize(m.measures.size(), true);
    const System system = compile(m);
    if (system.nv == 0) continue;
    Parameters p;
    Scaling scaling;
    bind(system, m, p);
    set_scaling(system, p, scaling);
    const Problem problem{system, p, scaling};
    Eigen::VectorXd q;
    drawn_configuration(system, p, q);
    MeasureSet measures;
    measures.bind(m, system, p);
    Workspace w, beside;
    const std::vector<std::string> addresses = parameter_addresses(m);
    const std::vector<Eigen::VectorXd> still(addresses.size(), Eigen::VectorXd::Zero(system.nv));
    const Eigen::MatrixXd rates = measures.rates_along(problem, m, addresses, q, still, w);
    for (std::size_t a = 0; a < addresses.size(); ++a) {
      const double value = get_parameter(m, addresses[a]), h = 1e-4 * (std::abs(value) + 0.1);
      if (value == 0 && addresses[a].starts_with("forces.film.")) continue; // of turns that a drive makes
      std::array<Eigen::VectorXd, 4> at; // the error of the combination is of order h^4
      for (std::size_t i = 0; i < 4; ++i) {
        Mechanism there = m;
        set_parameter(there, addresses[a], value + h * std::array{1., -1., 2., -2.}[i]);
        Parameters numbers;
        bind(system, there, numbers);
        MeasureSet set;
        set.bind(there, system, numbers);
        at[i] = set.evaluate_at({system, numbers, scaling}, q, beside);
      }
      const Eigen::VectorXd difference = (8 * (at[0] - at[1]) - (at[2] - at[3])) / (12 * h);
      for (std::size_t i = 0; i < measures.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double found = rates(k, static_cast<Eigen::Index>(a)), expected = difference[k];
        if (!std::isfinite(expected) || !std::isfinite(found)) continue;
        // An angle of joints may jump by a turn.
        if (std::abs(at[2][k] - at[3][k]) > 1 && m.measures[i].unit == "rad") continue;
        if (elastic[i] && has_corner((at[0][k] - at[1][k]) / (2 * h), expected)) continue;
        INFO("seed " << seed << " " << m.measures[i].text << " with " << addresses[a]);
        CHECK(std::abs(found - expected) <
              2e-7 * (1 + std::abs(expected)) + 1e-11 * (1 + std::abs(at[0][k])) / h);
        ++compared;
      }
    }
  }
  CHECK(compared > few_or_all(5000, 10000));
}

TEST_CASE("a number is found at which a measure is as wanted", "[measures]") {
  const double length = 0.7, mass = 1.7;
  const Mechanism m = measured_pendulum(length, 6);
  DesignOptions connected;
  connected.all = false;
  struct Wanted {
    std::string name;
    double value, speed;
  };
  for (const auto& [name, value, expected] :
       std::vector<Wanted>{{"hinge", 60, std::sqrt(60 / (mass * length))},
                           {"depth", 0.3, std::sqrt(standard_gravity / 0.3)},
                           {"ball_speed", 2.5, 0}}) {
    const DesignAnswer answer = design(m, speed, 0, 12, name, value, connected);
    INFO(name << " " << answer.message);
    REQUIRE(answer.status == Status::converged);
    REQUIRE(answer.solutions.size() == 2); // leaning to either side
    for (const DesignSolution& s : answer.solutions) {
      if (expected > 0) CHECK(s.parameter == Approx(expected).epsilon(1e-12));
      CHECK(s.residual < 1e-12);
      CHECK(*measure(s.at.measures, name).value == Approx(value).epsilon(1e-12));
      Mechanism there = m;
      set_parameter(there, speed, s.parameter);
      CHECK(*measure(solve(there).measures, name).value == Approx(value).epsilon(1e-10));
      REQUIRE(s.rate.has_value());
    }
    CHECK(answer.unit == m.measures[static_cast<std::size_t>(measure_index(m, name))].unit);
  }
  const DesignAnswer never = design(m, speed, 0, 12, "depth", 5, connected);
  CHECK(never.status == Status::not_converged);
  CHECK(never.message.find("depth never is 5 m") != std::string::npos);
  try {
    design(m, speed, 0, 12, "nothing", 1, connected);
    FAIL("no mistake");
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()).find("one of the measures") != std::string::npos);
  }
}

TEST_CASE("every study tells the same of a measure", "[measures]") {
  const Mechanism m = measured_pendulum(0.7, 6);
  const Variation variation{speed, 5, 8, 4};
  const std::vector<SweepPoint> points = sweep(m, {&variation, 1}, 1);
  for (const SweepPoint& point : points) {
    Mechanism there = m;
    set_parameter(there, speed, point.parameters[0]);
    const Solution s = solve(there);
    REQUIRE(point.solution.measures.size() == m.measures.size());
    for (std::size_t i = 0; i + 1 < m.measures.size(); ++i)
      CHECK(*point.solution.measures[i].value == Approx(*s.measures[i].value).epsilon(1e-12).margin(1e-12));
  }
  const ResponseDiagram diagram = follow_branches(m, speed, 5, 8);
  REQUIRE_FALSE(diagram.branches.empty());
  for (const ResponsePoint& point : diagram.branches[0].points)
    if (const double w = point.parameter; *measure(point.measures, "ball_speed").value > 0.1)
      CHECK(*measure(point.measures, "hinge").value == Approx(1.7 * w * w * 0.7).epsilon(1e-9));
}

TEST_CASE("of many coordinates places have errors, forces none", "[measures]") {
  Mechanism m = hanging_chain(80, 0.5);
  m.sliders.clear();
  m.measures = {{"tip", "", "y(" + argument_text(m.bodies.back().name) + ")", "m"},
                {"top", "", "reaction(" + argument_text(m.joints[1].name) + ")", "N"}};
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  CHECK(s.measures[0].error.value_or(1) < 1e-10);
  CHECK(s.measures[1].value.has_value());
  CHECK_FALSE(s.measures[1].error.has_value());
  CHECK(*s.measures[1].value == Approx(standard_gravity).epsilon(1e-9)); // 1 kg in all
}

TEST_CASE("measures of the parametric governor", "[measures]") {
  const Mechanism m = shipped("governor_parametric");
  REQUIRE_FALSE(m.measures.empty());
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  for (const MeasureSolution& each : s.measures) {
    INFO(each.name);
    CHECK(each.value.has_value());
    CHECK(each.error.value_or(1) < 1e-9);
  }
  const auto of = [&](const char* name) { return *measure(s.measures, name).value; };
  const double a = value(s, "arm1"), w = get_parameter(m, "parameters.w");
  CHECK(of("height") == Approx(0.16 * std::sin(a)).epsilon(1e-13));
  CHECK(of("radius") == Approx(0.16 * std::cos(a)).epsilon(1e-13));
  CHECK(of("ball_speed") == Approx(w * of("radius")).epsilon(1e-13));
  CHECK(of("ball_pull") == Approx(w * w * of("radius")).epsilon(1e-13));
}

TEST_CASE("measures of a motion are recorded, and settle where the steady state has them", "[measures]") {
  Mechanism m = shipped("governor_parametric");
  m.measures.push_back({"drive", "", "torque(spin)", "N m"});
  m.measures.push_back({"pull_on_collar", "", "reaction(slide)", "N"});
  SimulationOptions options = lasting(40);
  options.rate = 10;
  const Run run = simulate(m, options);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.measures.size() == m.measures.size());
  const Solution s = solve(m);
  for (std::size_t i = 0; i < m.measures.size(); ++i) {
    REQUIRE(run.measures[i].value.size() == run.time.size());
    if (m.measures[i].name == "drive") continue; // turns the settling parts yet
    INFO(m.measures[i].name);
    CHECK(run.measures[i].value.back() == Approx(*s.measures[i].value).epsilon(1e-3).margin(1e-3));
  }
  // By the coordinates and rates of the motion itself.
  const auto track = [&](const char* joint) {
    return *std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
  };
  const auto measured = [&](const char* name) {
    return std::ranges::find(run.measures, name, &MeasureTrack::name)->value;
  };
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    const double a = track("arm1").value[i], rate = track("arm1").rate[i];
    CHECK(measured("height")[i] == Approx(0.16 * std::sin(a)).epsilon(1e-9));
    const double round = 11.0174 * 0.16 * std::cos(a);
    CHECK(measured("ball_speed")[i] == Approx(std::hypot(round, 0.16 * rate)).epsilon(1e-9));
  }
  SimulationOptions without = lasting(0.5);
  without.measures = false;
  CHECK(simulate(m, without).measures.empty());
}

TEST_CASE("a measure with a pole within the errors of the coordinates has no value", "[measures]") {
  const Mechanism m = shipped("governor_friction", {{"parameters.w", 0.}});
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  CHECK_FALSE(measure(s.measures, "h").value.has_value()); // radius / tan(0)
  CHECK(measure(s.measures, "h").reason.find("unbounded") != std::string::npos);
  CHECK(measure(s.measures, "radius").value.has_value());
  SolveOptions brief;
  brief.details = false;
  CHECK_FALSE(measure(Analysis(m).solve(brief).measures, "h").value.has_value());
  const ResponseDiagram response = follow_branches(m, "parameters.w", 0, 10);
  for (const ResponseBranch& branch : response.branches)
    for (const ResponsePoint& point : branch.points)
      CHECK(std::abs(measure(point.measures, "h").value.value_or(0)) < 1e9);
}

TEST_CASE("measures that are large, or zero within their errors, keep their values", "[measures]") {
  Mechanism m = measured_pendulum(0.7, 6);
  m.measures = {{"nothing", "", "lean - swing_angle", "rad"},
                {"large", "", "1e15*swing_angle", "rad"},
                {"lean", "", "coordinate(swing)", "rad"},
                {"swing_angle", "", "coordinate(swing)", "rad"}};
  for (const bool details : {true, false}) {
    SolveOptions options;
    options.details = details;
    const Solution s = Analysis(m).solve(options);
    REQUIRE(s.status == Status::converged);
    for (const MeasureSolution& each : s.measures) {
      CAPTURE(each.name, each.reason);
      CHECK(each.value.has_value());
    }
  }
}
