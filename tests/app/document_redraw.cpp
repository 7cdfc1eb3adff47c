// A mechanism drawn in another of its configurations is the same mechanism.
#include "document_mechanisms.hpp"

#include "app/document/redraw.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/solve/assembly_drag.hpp"
#include "tests/support/scenes.hpp"

#include <map>

using namespace flyball;
using namespace flyball::test;

namespace {

// Pulls at some body, farther than it can follow as a rule.
MechanismPose pull_somewhere(const Mechanism& m, Dice& dice) {
  AssemblyDrag drag(m);
  REQUIRE(drag.assembled());
  const Body& body = dice.one_of(m.bodies);
  const BodyPoint grabbed{body.name, body.position + dice.box(0.1)};
  const Vec3 from = drag.position(grabbed), by = dice.box(0.4);
  for (int i = 1; i <= 5; ++i)
    drag.pull(grabbed, {.at = from + by * i / 5});
  return drag.pose();
}

// The components of spherical and free joints are along the world's axes, with which their parent has turned.
struct Coordinates {
  std::map<std::pair<std::string, int>, double> values;

  Coordinates(const Mechanism& m, const Solution& solution, const MechanismPose* turned) {
    for (const CoordinateSolution& c : solution.coordinates)
      values[{c.joint, c.index}] = c.value;
    if (!turned) return;
    for (const Joint& joint : m.joints) {
      if (joint.type != JointType::spherical && joint.type != JointType::free) continue;
      const int parent = body_index(m, joint.bodies[0]);
      if (parent < 0) continue;
      const auto p = static_cast<std::size_t>(parent);
      const Quat turn = turned->bodies[p].rotation * m.bodies[p].rotation.normalized().conjugate();
      for (int first = 0; first < coordinate_count(joint.type); first += 3) {
        Vec3 r;
        for (int k = 0; k < 3; ++k)
          r[k] = values.at({joint.name, first + k});
        r = turn * r;
        for (int k = 0; k < 3; ++k)
          values.at({joint.name, first + k}) = r[k];
      }
    }
  }
};

// Checks that what is drawn in this pose is closed, has the same parts and settles where the first does.
void check_same_mechanism(const Mechanism& m, const MechanismPose& pose) {
  const Redrawn out = redrawn(m, pose);
  const Mechanism& other = out.mechanism;
  CHECK(out.along_other_axes.empty());
  REQUIRE_NOTHROW(validate(other));
  if (!out.slack_elsewhere.empty()) return; // it is another mechanism, and says so
  CHECK(other.gravity == m.gravity);
  CHECK(other.sliders == m.sliders);
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    CHECK(other.bodies[i].mass == m.bodies[i].mass);
    CHECK(other.bodies[i].inertia == m.bodies[i].inertia);
    // What has moved by less stays where it was, digit for digit.
    constexpr double no_motion = 1.1e-11;
    CHECK((other.bodies[i].position - pose.bodies[i].position).norm() < no_motion);
    CHECK(other.bodies[i].rotation.angularDistance(pose.bodies[i].rotation) < no_motion);
  }
  for (std::size_t i = 0; i < m.joints.size(); ++i)
    if (m.joints[i].type == JointType::distance)
      CHECK(std::abs(m.joints[i].length.value_or(drawn_distance(m.joints[i].points)) -
                     drawn_distance(other.joints[i].points)) < 1e-12);
  // Closed as it is drawn: closing it moves nothing.
  AssemblyDrag closed(other);
  REQUIRE(closed.assembled());
  const MechanismPose drawn = closed.pose();
  for (std::size_t i = 0; i < m.bodies.size(); ++i)
    CHECK((drawn.bodies[i].position - other.bodies[i].position).norm() < 1e-12);
  for (std::size_t i = 0; i < m.joints.size(); ++i)
    for (std::size_t k = 0; k < other.joints[i].coordinates.size(); ++k)
      CHECK(std::abs(std::remainder(drawn.coordinates[i][k] - other.joints[i].coordinates[k].drawn,
                                    2 * std::numbers::pi)) < 1e-11);

  for (const Joint& joint : m.joints)
    for (const Coordinate& c : joint.coordinates)
      if (c.drive && c.drive->keeps == DriveKeeps::momentum)
        return; // another one, where it is drawn elsewhere

  Analysis first(m), second(other);
  const Solution a = first.solve();
  if (a.status != Status::converged) return;
  const Coordinates wanted(m, a, &pose);
  SolveOptions there;
  for (const CoordinateSolution& c : a.coordinates)
    if (!c.driven && !c.dependent && joint_index(m, c.joint) >= 0)
      there.start.emplace_back(c.count > 1 ? c.joint + "." + std::to_string(c.index) : c.joint,
                               wanted.values.at({c.joint, c.index}));
  const Solution b = second.solve(there);
  INFO(a.message << "\n" << b.message);
  REQUIRE(b.status == Status::converged);
  if (a.stability_reason == StabilityReason::neutral) return; // it may stand anywhere
  const Coordinates found(other, b, nullptr);
  int drives = 0;
  double phase = 0; // s, by which the drives are further on than the first's
  for (const CoordinateSolution& c : a.coordinates) {
    const double is = found.values.at({c.joint, c.index}), was = wanted.values.at({c.joint, c.index});
    if (c.driven) {
      const int j = joint_index(m, c.joint);
      const auto& drive =
          m.joints[static_cast<std::size_t>(j)].coordinates[static_cast<std::size_t>(c.index)].drive;
      drives += drive || c.speed; // or what turns at a speed of its own
      if (drive) phase = (is - was) / c.speed.value_or(drive->speed);
      continue;
    }
    INFO(c.joint << "." << c.index << ", error " << c.error);
    CHECK(std::abs(c.angle ? std::remainder(is - was, 2 * std::numbers::pi) : is - was) < 1e-8);
  }
  if (drives > 1) return; // they need not have come to one phase
  const std::vector<Pose> expected = first.poses_at(phase);
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    INFO(m.bodies[i].name);
    CHECK((b.poses[i].position - expected[i].position).norm() < 1e-8);
    CHECK(b.poses[i].rotation.angularDistance(expected[i].rotation) < 1e-7);
  }
}

} // namespace

TEST_CASE("a random mechanism pulled along its joints is the same mechanism") {
  const auto seed = GENERATE(range(1u, 80u));
  INFO("seed " << seed);
  const Mechanism m = random_mechanism(seed, {.alike = true});
  Dice dice(seed);
  if (!AssemblyDrag(m).assembled()) return;
  check_same_mechanism(m, pull_somewhere(m, dice));
}

TEST_CASE("so is a shipped scene") {
  for (const std::string& file : shipped_files()) {
    INFO(file);
    const Mechanism m = load_scene(file);
    Dice dice(7);
    for (int i = 0; i < 3; ++i)
      check_same_mechanism(m, pull_somewhere(m, dice));
  }
}

TEST_CASE("what no pull moves keeps its digits, and a pull back takes everything back") {
  const Mechanism given = shipped("governor");
  // Its links are given with five digits, so that it is not drawn quite closed.
  const Mechanism m = redrawn(given, AssemblyDrag(given).pose()).mechanism;
  AssemblyDrag drag(m);
  CHECK(is_drawn_in(m, drag.pose()));
  CHECK(redrawn(m, drag.pose()).mechanism == m);
  const BodyPoint ball{"ball1"};
  const Vec3 from = drag.position(ball);
  drag.pull(ball, {.at = from + Vec3(0.02, 0.03, 0), .sight = Vec3::UnitZ()});
  const Mechanism moved = redrawn(m, drag.pose()).mechanism;
  const auto body = [](const Mechanism& in, const char* name) {
    return in.bodies[static_cast<std::size_t>(body_index(in, name))];
  };
  CHECK(body(moved, "spindle").position == body(m, "spindle").position);
  CHECK(body(moved, "spindle").rotation.angularDistance(body(m, "spindle").rotation) < 1e-7);
  CHECK(moved.joints[0].at == m.joints[0].at);
  CHECK(moved.joints[0].coordinates[0].drawn == Approx(m.joints[0].coordinates[0].drawn).margin(1e-7));
  CHECK(body(moved, "collar").position != body(m, "collar").position);
  CHECK_FALSE(is_drawn_in(m, drag.pose()));
  for (int i = 0; i < 3; ++i)
    drag.pull(ball, {.at = from});
  for (std::size_t i = 0; i < m.bodies.size(); ++i)
    CHECK((drag.pose().bodies[i].position - m.bodies[i].position).norm() < 1e-9);
}

TEST_CASE("a spring whose free length is the drawn distance keeps the length it had") {
  Mechanism m;
  m.bodies = {{.name = "bob", .description = {}, .mass = 1, .position = {1, 0, 0}, .shapes = {}}};
  Joint hinge;
  hinge.name = "hinge";
  hinge.bodies = {"ground", "bob"};
  hinge.coordinates.resize(1);
  m.joints = {hinge};
  Force spring;
  spring.name = "spring";
  spring.bodies = {"ground", "bob"};
  spring.points = {Vec3(1, 1, 0), Vec3(1, 0, 0)};
  spring.stiffness = 10;
  m.forces = {spring};
  AssemblyDrag drag(m);
  drag.move("hinge", 0, 0.5);
  const Mechanism moved = redrawn(m, drag.pose()).mechanism;
  REQUIRE(moved.forces[0].free_length);
  CHECK(*moved.forces[0].free_length == 1);
  CHECK((moved.forces[0].points[1] - Vec3(std::cos(0.5), std::sin(0.5), 0)).norm() < 1e-9);
  CHECK(moved.joints[0].coordinates[0].drawn == Approx(0.5));
}

TEST_CASE("a bearing that is slack elsewhere from then on is told of") {
  Mechanism m;
  m.bodies = {{.name = "bob", .description = {}, .mass = 1, .position = {1, 0, 0}, .shapes = {}}};
  Joint hinge;
  hinge.name = "hinge";
  hinge.bodies = {"ground", "bob"};
  hinge.coordinates.resize(1);
  m.joints = {hinge};
  Force bearing;
  bearing.name = "foot";
  bearing.type = ForceType::bearing;
  bearing.bodies = {"ground", "bob"};
  bearing.bearing_stiffness = {10, 0, 0, 10};
  const auto told = [&](const Vec3& at) {
    bearing.at = at;
    m.forces = {bearing};
    AssemblyDrag drag(m);
    drag.move("hinge", 0, 0.5);
    return redrawn(m, drag.pose()).slack_elsewhere;
  };
  CHECK(told({1, 0, 0}) == std::vector<std::string>{"foot"});
  CHECK(told({0, 0, 0.3}).empty()); // about its own axis it turns freely
  bearing.bearing_stiffness.assign(36, 1);
  CHECK(told({0, 0, 0.3}) == std::vector<std::string>{"foot"});
  bearing.bearing_stiffness.clear();
  bearing.bearing_damping = {10, 0, 0, 10};
  CHECK(told({1, 0, 0}).empty());
}

TEST_CASE("springs along single axes that have turned with the parent are told of") {
  Mechanism m;
  m.bodies = {{.name = "arm", .description = {}, .mass = 1, .position = {1, 0, 0}, .shapes = {}},
              {.name = "ball", .description = {}, .mass = 1, .position = {2, 0, 0}, .shapes = {}}};
  Joint hinge;
  hinge.name = "hinge";
  hinge.bodies = {"ground", "arm"};
  hinge.coordinates.resize(1);
  Joint socket;
  socket.name = "socket";
  socket.type = JointType::spherical;
  socket.bodies = {"arm", "ball"};
  socket.at = {2, 0, 0};
  socket.coordinates.resize(3);
  socket.coordinates[0].spring = CoordinateSpring{10, 0.1};
  m.joints = {hinge, socket};
  AssemblyDrag drag(m);
  drag.move("hinge", 0, 0.5);
  CHECK(redrawn(m, drag.pose()).along_other_axes == std::vector<std::string>{"socket"});
  // By a quarter turn they are the world's again.
  drag.move("hinge", 0, std::numbers::pi / 2);
  const Redrawn quarter = redrawn(m, drag.pose());
  CHECK(quarter.along_other_axes.empty());
  REQUIRE(quarter.mechanism.joints[1].coordinates[1].spring);
  CHECK(quarter.mechanism.joints[1].coordinates[1].spring->free == Approx(0.1));
}
