// What acts on a body adds up, inertial loads included (d'Alembert), and arrows tell how much it is.
#include "app/viewport/load_arrows.hpp"
#include "app/viewport/motion_loads.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/periodic/periodic_state.hpp"
#include "engine/report/analysis.hpp"
#include "slider_crank.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace flyball;
using namespace flyball::test;

namespace {

namespace fs = std::filesystem;

// Forces and moments of a free-body diagram, beside the largest of them.
struct Sum {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double largest_force = 0, largest_moment = 0;
  double force_error() const { return largest_force > 0 ? force.norm() / largest_force : force.norm(); }
  double moment_error() const { return largest_moment > 0 ? moment.norm() / largest_moment : moment.norm(); }
};

Sum sum_of(const std::vector<Load>& loads, const Vec3& about, double reach) {
  Sum sum;
  for (const Load& load : loads) {
    const Vec3 moment = load.moment ? load.vector : Vec3((load.at - about).cross(load.vector));
    if (!load.moment) sum.force += load.vector;
    sum.moment += moment;
    const double size = load.vector.norm();
    sum.largest_force = std::max(sum.largest_force, load.moment ? size / reach : size);
    sum.largest_moment = std::max(sum.largest_moment, load.moment ? size : size * reach);
  }
  return sum;
}

struct Steady {
  Mechanism mechanism;
  Solution solution;
  std::vector<AngularMotion> turning;
};

Steady solved(Mechanism mechanism) {
  Analysis analysis(mechanism);
  Solution solution = analysis.solve();
  INFO(mechanism.name << ": " << solution.message);
  REQUIRE(solution.status == Status::converged);
  return {std::move(mechanism), std::move(solution), analysis.turning_at(0)};
}

// How far the worst of the bodies is from balance, in parts of its largest load; what carries nothing but
// rounding of the others' loads in parts of these.
double worst_of(const Steady& steady, std::span<const Pose> poses, const Quat& turn) {
  const auto& [mechanism, solution, turning] = steady;
  const Assembly assembly(mechanism, poses);
  const double reach = assembly.scale.bounds.radius();
  std::vector<Sum> sums;
  double largest = 0, worst = 0; // N
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    sums.push_back(
        sum_of(loads_of(assembly, solution, turning, static_cast<int>(b), turn), poses[b].position, reach));
    largest = std::max(largest, sums.back().largest_force);
  }
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    Sum& sum = sums[b];
    if (constexpr double rounding = 1e-9; sum.largest_force < rounding * largest) {
      sum.largest_force = largest;
      sum.largest_moment = largest * reach;
    }
    INFO(mechanism.name << ", " << mechanism.bodies[b].name << ": forces " << sum.force_error()
                        << ", moments " << sum.moment_error());
    CHECK(sum.force_error() < 1e-9);
    CHECK(sum.moment_error() < 1e-9);
    worst = std::max({worst, sum.force_error(), sum.moment_error()});
  }
  return worst;
}

// An arm that hangs out of a driven hub, with one of everything that can act on it, and a wheel that a gear
// turns along.
Mechanism laden_arm() {
  return parse_scene(R"({"flyball": 1, "name": "Laden arm", "gravity": [0, -9.8, 0],
    "bodies": [
      {"name": "hub", "mass": 3, "position": [0, 0, 0], "inertia": [0.2, 0.3, 0.2]},
      {"name": "wheel", "mass": 2, "position": [0.6, 0, 0], "inertia": [0.1, 0.2, 0.1]},
      {"name": "arm", "mass": 1.5, "position": [0.25, -0.05, 0.02],
       "inertia": [0.02, 0.05, 0.06, 0.004, -0.003, 0.002]}],
    "joints": [
      {"name": "spin", "type": "revolute", "bodies": ["ground", "hub"], "at": [0, 0, 0], "axis": [0, 1, 0],
       "drive": {"speed": 6}},
      {"name": "turn", "type": "revolute", "bodies": ["ground", "wheel"], "at": [0.6, 0, 0],
       "axis": [0, 1, 0]},
      {"name": "mesh", "type": "gear", "joints": ["spin", "turn"], "ratio": -2},
      {"name": "hinge", "type": "revolute", "bodies": ["hub", "arm"], "at": [0.1, 0, 0], "axis": [0, 0, 1],
       "spring": {"stiffness": 5, "free": 0.1}, "damping": 2}],
    "forces": [
      {"name": "coil", "type": "spring", "bodies": ["hub", "arm"], "points": [[0, 0.3, 0], [0.3, 0, 0]],
       "stiffness": 40, "free_length": 0.3, "damping": 3},
      {"name": "air", "type": "drag", "body": "arm", "at": [0.4, -0.1, 0.05], "linear": 0.4,
       "quadratic": 0.3},
      {"name": "push", "type": "force", "body": "arm", "at": [0.35, 0, 0.03], "vector": [1, 2, -3],
       "frame": "body"},
      {"name": "twist", "type": "torque", "body": "arm", "vector": [0.3, 0.1, 0.2], "frame": "body"}]})");
}

} // namespace

TEST_CASE("every body's free-body diagram adds up, inertial loads included") {
  std::size_t bodies = 0;
  for (const fs::path file : shipped_files()) {
    INFO(file.filename().string());
    if (file.stem() == "horizontal_rotor") continue; // moves periodically: it has no steady state
    const Steady steady = solved(load_scene(file));
    worst_of(steady, steady.solution.poses, Quat::Identity());
    bodies += steady.mechanism.bodies.size();
  }
  CHECK(bodies > 30);
}

TEST_CASE("gears, drag, dampers and applied loads are parts of the diagram") {
  const Steady steady = solved(laden_arm());
  const Assembly assembly(steady.mechanism, steady.solution.poses);
  const std::vector<Load> loads = loads_of(assembly, steady.solution, steady.turning, 2);
  for (const LoadKind kind : {LoadKind::reaction, LoadKind::spring, LoadKind::weight, LoadKind::applied,
                              LoadKind::air, LoadKind::inertia})
    CHECK(std::ranges::count(loads, kind, &Load::kind) >= 1);
  CHECK(worst_of(steady, steady.solution.poses, Quat::Identity()) < 1e-9);
  // Without any one of them it does not add up.
  for (std::size_t i = 0; i < loads.size(); ++i) {
    std::vector<Load> less = loads;
    less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
    const Sum sum = sum_of(less, steady.solution.poses[2].position, 0.5);
    CHECK(std::max(sum.force_error(), sum.moment_error()) > 1e-4);
  }
}

TEST_CASE("free-body diagrams of a periodic motion add up at every moment, inertial loads included") {
  Mechanism crank;
  crank.gravity = {0, -9.8, 0};
  add_driven_slider_crank(crank, 10);
  Mechanism laid = laden_arm();
  laid.gravity = {-9.8, 0, 0}; // across its drive: what it weighs turns with it
  for (const Mechanism& mechanism : {crank, laid, shipped("horizontal_rotor")}) {
    INFO(mechanism.name);
    const PeriodicState state = find_periodic_state(mechanism);
    INFO(state.message);
    REQUIRE(state.motion);
    const Run& motion = *state.motion;
    bool shorter = false;
    for (const double part : {0., 0.3141, 0.77, 1.}) { // of a period
      const double time = part * motion.time.back();
      const std::vector<Pose> poses = poses_at(motion, time);
      const Assembly assembly(mechanism, poses);
      const double reach = assembly.scale.bounds.radius();
      for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
        const auto loads = diagram_at(assembly, motion, time, static_cast<int>(b));
        REQUIRE(loads);
        const Sum sum = sum_of(*loads, poses[b].position, reach);
        INFO(mechanism.bodies[b].name << " after " << part << " of a period: forces " << sum.force_error()
                                      << ", moments " << sum.moment_error());
        CHECK(sum.force_error() < 1e-6);
        CHECK(sum.moment_error() < 1e-6);
        // There is room for what its joints do to it at other moments.
        const LoadScales scales = diagram_scales(assembly, motion, static_cast<int>(b), *loads),
                         alone = load_scales(assembly, *loads, LoadLengths::in_proportion);
        shorter = shorter || scales.length(false, 1) < 0.99 * alone.length(false, 1);
      }
    }
    CHECK(shorter);
  }
}

TEST_CASE("on an evenly turning crank the inertial load is m w^2 r, away from its axis") {
  constexpr double speed = 10; // rad/s
  Mechanism crank;
  crank.gravity = {0, -9.8, 0};
  add_driven_slider_crank(crank, speed);
  const PeriodicState state = find_periodic_state(crank);
  REQUIRE(state.motion);
  const double time = 0.37 * state.motion->time.back();
  const std::vector<Pose> poses = poses_at(*state.motion, time);
  const auto loads = diagram_at(Assembly(crank, poses), *state.motion, time, 0);
  REQUIRE(loads);
  const auto inertia = std::ranges::find(*loads, LoadKind::inertia, &Load::kind);
  REQUIRE(inertia != loads->end());
  CHECK_FALSE(inertia->moment);
  const Vec3 expected = crank.bodies[0].mass * speed * speed * poses[0].position;
  CHECK((inertia->vector - expected).norm() < 1e-7 * expected.norm());
}

TEST_CASE("of a geared wheel drive, mesh and damper are told one by one") {
  const Steady steady = solved(parse_scene(R"json({"flyball": 2, "name": "Gear", "gravity": [0, -9.8, 0],
    "bodies": [
      {"name": "w1", "mass": 1, "position": [-0.16, 0, 0], "inertia": [0.01, 0.01, 0.01]},
      {"name": "w2", "mass": 1, "position": [0.12, 0, 0], "inertia": [0.01, 0.01, 0.01]}],
    "joints": [
      {"name": "s1", "type": "revolute", "bodies": ["ground", "w1"], "at": [-0.16, 0, 0], "axis": [0, 0, 1],
       "drive": {"torque": "=10 N m - 0.1 N m s*rate(s1)", "speed": 10}},
      {"name": "s2", "type": "revolute", "bodies": ["ground", "w2"], "at": [0.12, 0, 0], "axis": [0, 0, 1],
       "damping": 0.1},
      {"name": "mesh", "type": "gear", "joints": ["s1", "s2"], "ratio": -2}]})json"));
  const Mechanism& mechanism = steady.mechanism;
  const Assembly assembly(mechanism, steady.solution.poses);
  const auto moment = [&](int body, LoadKind kind, const char* joint) {
    for (const Load& load : loads_of(assembly, steady.solution, steady.turning, body))
      if (load.kind == kind && load.moment && load.part == find_part(mechanism, {PartKind::joint, joint}))
        return load.vector.z();
    return 0.;
  };
  // s2 = -2 s1 or s1 = -2 s2; either way power is kept: 10 - 0.1 w is what the damper takes.
  const double w1 = *steady.solution.coordinates[0].speed, w2 = *steady.solution.coordinates[1].speed;
  const double drive = 10 - 0.1 * w1, damper = -0.1 * w2;
  CHECK(drive * w1 + damper * w2 == Approx(0).margin(1e-9));
  for (const int body : {0, 1}) {
    CHECK(moment(body, LoadKind::drive, "s1") == Approx(body == 0 ? drive : 0));
    CHECK(moment(body, LoadKind::gear, "mesh") == Approx(body == 0 ? -drive : -damper));
    CHECK(moment(body, LoadKind::damper, "s2") == Approx(body == 1 ? damper : 0));
    CHECK(std::abs(moment(body, LoadKind::reaction, body == 0 ? "s1" : "s2")) < 1e-9);
  }
  // Of the mechanism they are seen, too.
  CHECK(moment(-1, LoadKind::drive, "s1") == Approx(drive));
  CHECK(moment(-1, LoadKind::gear, "mesh") != 0);
  CHECK(moment(-1, LoadKind::damper, "s2") == Approx(damper));
  CHECK(worst_of(steady, steady.solution.poses, Quat::Identity()) < 1e-9);
}

TEST_CASE("of a drive by torque what it gives and its load are told, though they leave nothing") {
  const Steady clutch = solved(shipped("centrifugal_clutch"));
  const Mechanism& mechanism = clutch.mechanism;
  const Solution& solution = clutch.solution;
  const Assembly assembly(mechanism, solution.poses);
  for (const char* name : {"motor", "drum"}) {
    CAPTURE(name);
    const auto of = std::ranges::find(solution.drive_torques, name, &DriveTorque::joint);
    REQUIRE((of != solution.drive_torques.end() && of->given));
    REQUIRE(of->given->torque > 0.1);
    REQUIRE(std::abs(of->value) < 1e-6 * of->given->torque);
    const auto joint = static_cast<std::size_t>(joint_index(mechanism, name));
    const int child = assembly.joint_bodies[joint][1];
    for (const int body : {-1, child}) {
      const std::vector<Load> loads = loads_of(assembly, solution, clutch.turning, body);
      const auto along = [&](LoadKind kind) {
        double sum = 0;
        for (const Load& load : loads)
          if (load.kind == kind && load.moment &&
              load.part == PartId{PartKind::joint, static_cast<int>(joint)})
            sum += load.vector.dot(mechanism.joints[joint].axis.normalized());
        return sum;
      };
      CHECK(along(LoadKind::drive) == Approx(of->given->torque));
      CHECK(along(LoadKind::applied) == Approx(-of->given->load));
    }
  }
}

TEST_CASE("bearings are parts of the diagram, of what they hold and of what holds them") {
  const Steady steady = solved(parse_scene(R"({"flyball": 1, "name": "On a foot", "gravity": [0, -9.8, 0],
    "bodies": [
      {"name": "foot", "mass": 4, "position": [0, 0, 0], "inertia": [0.2, 0.2, 0.2]},
      {"name": "rotor", "mass": 3, "position": [0.05, 0.1, 0.02], "inertia": [0.05, 0.04, 0.06]}],
    "joints": [
      {"name": "spin", "type": "revolute", "bodies": ["ground", "foot"], "at": [0, 0, 0], "axis": [0, 1, 0],
       "drive": {"speed": 4}}],
    "forces": [
      {"name": "film", "type": "bearing", "bodies": ["foot", "rotor"], "at": [0, 0.1, 0], "axis": [0, 0, 1],
       "stiffness": [[3e3, 0, 0, 0, 0, 0], [0, 4e3, 0, 0, 0, 0], [0, 0, 5e3, 0, 0, 0], [0, 0, 0, 80, 0, 0],
         [0, 0, 0, 0, 90, 0], [0, 0, 0, 0, 0, 70]],
       "damping": [[3, 0, 0, 0, 0, 0], [0, 3, 0, 0, 0, 0], [0, 0, 3, 0, 0, 0], [0, 0, 0, 1, 0, 0],
         [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]}]})"));
  for (const int body : {0, 1}) {
    const std::vector<Load> loads =
        loads_of(Assembly(steady.mechanism, steady.solution.poses), steady.solution, steady.turning, body);
    CHECK(std::ranges::any_of(loads, [](const Load& load) { return load.part.kind == PartKind::force; }));
  }
  worst_of(steady, steady.solution.poses, Quat::Identity());
  Analysis analysis(steady.mechanism);
  analysis.solve();
  const std::vector<Pose> turned = analysis.poses_at(0.37);
  const auto turn = common_turn(steady.mechanism, steady.solution, turned);
  REQUIRE(turn);
  worst_of(steady, turned, *turn);
}

TEST_CASE("loads turn with a drive that turns everything about the vertical, and only then") {
  const auto later = [](const Mechanism& mechanism) {
    Analysis analysis(mechanism);
    analysis.solve();
    return analysis.poses_at(0.37);
  };
  const Steady governor = solved(shipped("governor"));
  const std::vector<Pose> turned = later(governor.mechanism);
  const auto turn = common_turn(governor.mechanism, governor.solution, turned);
  REQUIRE(turn);
  CHECK(turn->angularDistance(Quat::Identity()) > 0.1);
  CHECK(worst_of(governor, turned, *turn) < 1e-9);
  const Steady gyro = solved(shipped("rate_gyro"));
  CHECK_FALSE(common_turn(gyro.mechanism, gyro.solution, later(gyro.mechanism)));
}

TEST_CASE("of the governor's loads the bearing bears the whole weight, and the spring holds the collar") {
  const Steady steady = solved(shipped("governor"));
  const Mechanism& mechanism = steady.mechanism;
  const std::vector<Load> loads =
      loads_of(Assembly(mechanism, steady.solution.poses), steady.solution, steady.turning, -1);
  double weight = 0;
  for (const Body& body : mechanism.bodies)
    weight += body.mass * mechanism.gravity.norm();
  const auto joint = [&](const std::string& name) { return find_part(mechanism, {PartKind::joint, name}); };
  const auto load = [&](LoadKind kind, PartId part) {
    const auto found = std::ranges::find_if(
        loads, [&](const Load& each) { return each.kind == kind && each.part == part && !each.moment; });
    REQUIRE(found != loads.end());
    return *found;
  };
  const Load bearing = load(LoadKind::reaction, joint("spin"));
  CHECK((bearing.vector - Vec3(0, weight, 0)).norm() < 1e-9 * weight);
  // 1000 N/m, free at 0.15 m, settles at 0.15001745812529710 m: along the joint's axis, which points down.
  const Load spring = load(LoadKind::spring, joint("slide"));
  CHECK(spring.vector.y() == Approx(1000 * (0.1500174581252971 - 0.15)).epsilon(1e-6));
}

TEST_CASE("arrows of springs and links of a mechanism stand beside what would hide them") {
  const Steady steady = solved(shipped("governor"));
  const Mechanism& mechanism = steady.mechanism;
  const Assembly assembly(mechanism, steady.solution.poses);
  const std::vector<Load> loads = loads_of(assembly, steady.solution, steady.turning, -1);
  const double u = assembly.scale.unit;
  int springs = 0, links = 0;
  for (const LoadArrow& arrow :
       load_arrows(assembly, loads, load_scales(assembly, loads, LoadLengths::by_cube_root),
                   palette(Theme::light), false)
           .arrows) {
    const Load& load = loads[arrow.load];
    if (load.moment || load.part.kind != PartKind::joint) continue;
    const Joint& joint = assembly.joint(load.part.index);
    const auto [first, second] = assembly.joint_bodies[static_cast<std::size_t>(load.part.index)];
    if (load.kind == LoadKind::spring) {
      ++springs; // outside the collar, whose radius is 22 mm
      CHECK(std::hypot(arrow.from.x(), arrow.from.z()) > 0.022 + 0.2 * u);
    } else if (joint.type == JointType::distance) {
      ++links; // on the link's side of the collar, beside the link
      const Vec3 a = assembly.point(first, joint.points[0]), b = assembly.point(second, joint.points[1]);
      const Vec3 along = (a - b).normalized(), middle = 0.5 * arrow.from + 0.5 * arrow.to - b;
      CHECK(along.dot(middle) > 0);
      CHECK(along.cross(middle).norm() > 0.5 * u);
    }
  }
  CHECK(springs == 1);
  CHECK(links == 2);
}

TEST_CASE("arrows: one scale for all forces and one for all moments, in proportion or by the cube root") {
  const Steady steady = solved(shipped("governor"));
  const Mechanism& mechanism = steady.mechanism;
  const Assembly assembly(mechanism, steady.solution.poses);
  const Palette& colors = palette(Theme::light);
  const std::vector<Load> all = loads_of(assembly, steady.solution, steady.turning, -1);
  const LoadScales scales = load_scales(assembly, all, LoadLengths::in_proportion),
                   roots = load_scales(assembly, all, LoadLengths::by_cube_root);
  const double reaction = scales.largest(LoadKind::reaction, false),
               inertia = scales.largest(LoadKind::inertia, false);
  CHECK(reaction > 100 * inertia); // the shaft's weight
  CHECK(scales.length(false, inertia) / inertia == Approx(scales.length(false, reaction) / reaction));
  CHECK(roots.length(false, reaction) == Approx(1.8 * scales.length(false, reaction)));
  CHECK(roots.length(false, reaction / 8) == Approx(roots.length(false, reaction) / 2));
  for (const double size : {0.3, 2., 11.})
    for (const LoadScales* each : {&scales, &roots})
      CHECK(each->size(false, each->length(false, size)) == Approx(size));
  CHECK(scales.largest(LoadKind::weight, false) == 0); // part of a body's diagram only

  // Of the mechanism too short ones are left out, and counted; all others have their exact length.
  const LoadArrows arrows = load_arrows(assembly, all, scales, colors, false);
  CHECK(arrows.left_out[0] > 3);
  CHECK(arrows.least[0] > inertia);
  for (const LoadArrow& arrow : arrows.arrows)
    CHECK((arrow.to - arrow.from).norm() == Approx(scales.length(all[arrow.load])));
  const LoadArrows rooted = load_arrows(assembly, all, roots, colors, false);
  CHECK(rooted.left_out[0] == 0);
  CHECK(load_scales(assembly, all, {}).lengths() == LoadLengths::by_cube_root);
  std::vector<Load> alike;
  for (const Load& load : all)
    if (load.kind == LoadKind::inertia) alike.push_back(load);
  CHECK(load_scales(assembly, alike, {}).lengths() == LoadLengths::in_proportion);
  CHECK(rooted.arrows.size() > arrows.arrows.size() + 3);

  const int ball = body_index(mechanism, "ball1");
  const std::vector<Load> of_ball = loads_of(assembly, steady.solution, steady.turning, ball);
  const LoadArrows diagram = load_arrows(
      assembly, of_ball, load_scales(assembly, of_ball, LoadLengths::in_proportion), colors, true);
  double longest = 0;
  Vec3 tip = Vec3::Zero(); // of all forces one after the other
  for (const LoadArrow& arrow : diagram.arrows) {
    const Load& load = of_ball[arrow.load];
    if (load.moment) continue;
    CHECK((arrow.from - load.at).norm() < 1e-12);
    const double exact = diagram.scales.length(load);
    if (exact < (arrow.to - arrow.from).norm() * (1 - 1e-9)) continue; // too short to be seen
    CHECK((arrow.to - arrow.from).cross(load.vector).norm() < 1e-9 * load.vector.norm());
    longest = std::max(longest, exact);
    tip += exact * load.vector.normalized();
  }
  CHECK(longest > 0);
  CHECK(tip.norm() < 1e-9 * longest);
}
