// Mechanisms moved along their joints by a hand.
#include "engine/solve/assembly_drag.hpp"

#include "tests/bench/large_scenes.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

Vec3 carried(const Mechanism& m, const MechanismPose& pose, const std::string& body, const Vec3& drawn) {
  return carried_point(m, pose.bodies, body_index(m, body), drawn);
}

double label(const Mechanism& m, const MechanismPose& pose, const std::string& joint, int index = 0) {
  return pose.coordinates[static_cast<std::size_t>(joint_index(m, joint))][static_cast<std::size_t>(index)];
}

// By how far joints have come apart: points that have to meet (m), links that have to keep their length (m),
// axes that have to stay one (rad).
double opening(const Mechanism& m, const MechanismPose& pose) {
  double most = 0;
  for (const Joint& joint : m.joints) {
    if (joint.type == JointType::gear) {
      const auto value = [&](const std::string& end) {
        const CoordinateReference r = find_coordinate(m, end);
        return pose.coordinates[static_cast<std::size_t>(r.joint)][static_cast<std::size_t>(r.coordinate)];
      };
      most = std::max(most, std::abs(value(joint.joints[1]) - joint.ratio * value(joint.joints[0]) -
                                     joint.offset.value_or(drawn_offset(m, joint))));
      continue;
    }
    const auto at = [&](int end, const Vec3& point) {
      return carried(m, pose, joint.bodies[static_cast<std::size_t>(end)], point);
    };
    if (joint.type == JointType::distance) {
      const double length = (at(1, joint.points[1]) - at(0, joint.points[0])).norm();
      most = std::max(most, std::abs(length - joint.length.value_or(drawn_distance(joint.points))));
      continue;
    }
    const Vec3 apart = at(1, joint.at) - at(0, joint.at);
    const auto axis = [&](int end) {
      return carried_vector(m, pose.bodies, body_index(m, joint.bodies[static_cast<std::size_t>(end)]),
                            joint.axis.normalized());
    };
    switch (joint.type) {
    case JointType::revolute: most = std::max({most, apart.norm(), axis(0).cross(axis(1)).norm()}); break;
    case JointType::prismatic:
    case JointType::cylindrical:
      most = std::max({most, apart.cross(axis(0)).norm(), axis(0).cross(axis(1)).norm()});
      break;
    case JointType::universal:
    case JointType::spherical: most = std::max(most, apart.norm()); break;
    default: break;
    }
  }
  return most;
}

Mechanism crank(double radius) {
  Mechanism m;
  m.gravity = {0, -9.8, 0};
  m.bodies = {{.name = "crank", .description = {}, .mass = 1, .position = {radius, 0, 0}, .shapes = {}}};
  Joint joint;
  joint.name = "hinge";
  joint.bodies = {"ground", "crank"};
  joint.coordinates.resize(1);
  m.joints = {joint};
  return m;
}

} // namespace

TEST_CASE("a governor's ball goes where it is pulled, and the loops stay closed") {
  const Mechanism m = shipped("governor");
  AssemblyDrag drag(m);
  REQUIRE(drag.assembled());
  const BodyPoint ball{"ball1"};
  const Vec3 from = drag.position(ball),
             pivot = m.joints[static_cast<std::size_t>(joint_index(m, "arm1"))].at;
  const double arm = (from - pivot).norm();
  const double spin = label(m, drag.pose(), "spin");
  for (int i = 1; i <= 20; ++i) {
    const double angle = std::atan2(from.y() - pivot.y(), from.x() - pivot.x()) + 0.03 * i;
    const Vec3 target = pivot + arm * Vec3(std::cos(angle), std::sin(angle), 0);
    const DragOutcome out = drag.pull(ball, {.at = target, .sight = Vec3::UnitZ()});
    INFO(i);
    CHECK(out.settled);
    CHECK((drag.position(ball) - target).norm() < 1e-12);
    CHECK(opening(m, drag.pose()) < 1e-12);
  }
  const MechanismPose pose = drag.pose();
  CHECK(label(m, pose, "spin") == Approx(spin).margin(1e-12)); // in the plane of the arms nothing turns
  CHECK(std::abs(label(m, pose, "arm1")) > 0.5);
}

TEST_CASE("a pull out of the plane of its arms turns a governor's spindle, driven or not") {
  const Mechanism m = shipped("governor");
  AssemblyDrag drag(m);
  const BodyPoint ball{"ball1"};
  const Vec3 target = Eigen::AngleAxisd(0.7, Vec3::UnitY()) * drag.position(ball);
  const DragOutcome out = drag.pull(ball, {.at = target});
  CHECK(out.settled);
  CHECK(out.away < 1e-12);
  CHECK(label(m, drag.pose(), "spin") - m.joints[0].coordinates[0].drawn == Approx(0.7).margin(1e-9));
  CHECK(opening(m, drag.pose()) < 1e-12);
}

TEST_CASE("out of reach the nearest point is found") {
  const Mechanism m = crank(0.3);
  AssemblyDrag drag(m);
  const double distance = GENERATE(0.31, 0.6, 5., 500.), angle = GENERATE(-2.9, -0.4, 0.2, 1.5);
  const Vec3 target(distance * std::cos(angle), distance * std::sin(angle), 0.1);
  DragOutcome out;
  for (int i = 0; i < 5 && !out.settled; ++i)
    out = drag.pull({"crank"}, {.at = target});
  CHECK(out.settled);
  const Vec3 nearest(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0);
  CHECK((drag.position({"crank"}) - nearest).norm() < 1e-5);
  CHECK(out.away == Approx((target - nearest).norm()));
}

TEST_CASE("along the line of sight a distance counts little") {
  // The crank's circle seen at an angle: the point comes under the cursor.
  const Mechanism m = crank(0.3);
  AssemblyDrag drag(m);
  const Vec3 sight = Vec3(0, std::sin(1.2), -std::cos(1.2)); // 69 degrees off the axis
  const Vec3 wanted(0.3 * std::cos(0.8), 0.3 * std::sin(0.8), 0);
  const Vec3 start = drag.position({"crank"});
  // Where the ray through that place meets the plane across the sight through where the hand took hold.
  const Vec3 target = wanted + sight * (start - wanted).dot(sight);
  drag.pull({"crank"}, {.at = target, .sight = sight});
  const Vec3 off = drag.position({"crank"}) - target;
  const Vec3 seen = off - sight * off.dot(sight);
  CHECK(seen.norm() < 0.006);
  drag.pull({"crank"}, {.at = target});
  const Vec3 all = drag.position({"crank"}) - target;
  CHECK((all - sight * all.dot(sight)).norm() > 0.02);
}

TEST_CASE("stops hold, and let go") {
  Mechanism m = crank(1);
  m.joints[0].coordinates[0].stop = Stop{-0.2, 0.5, 1000};
  AssemblyDrag drag(m);
  DragOutcome out = drag.pull({"crank"}, {.at = {0, 1, 0}});
  CHECK(out.settled);
  CHECK(out.at_stop);
  CHECK(label(m, drag.pose(), "hinge") == Approx(0.5).epsilon(1e-9));
  out = drag.pull({"crank"}, {.at = {std::cos(0.3), std::sin(0.3), 0}});
  CHECK_FALSE(out.at_stop);
  CHECK(label(m, drag.pose(), "hinge") == Approx(0.3).epsilon(1e-9));
  out = drag.pull({"crank"}, {.at = {0, -1, 0}});
  CHECK(label(m, drag.pose(), "hinge") == Approx(-0.2).epsilon(1e-9));
  SECTION("what is drawn beyond one goes no farther") {
    m.joints[0].coordinates[0].stop = Stop{{}, -0.1, 1000};
    AssemblyDrag beyond(m);
    beyond.pull({"crank"}, {.at = {0, 1, 0}});
    CHECK(label(m, beyond.pose(), "hinge") == Approx(0).margin(1e-12));
    beyond.pull({"crank"}, {.at = {0, -1, 0}});
    CHECK(label(m, beyond.pose(), "hinge") == Approx(-std::numbers::pi / 2).epsilon(1e-9));
  }
}

TEST_CASE("a stop of a joint that closes a loop holds, too") {
  Mechanism m = shipped("fourbar_turntable");
  const Solution solved = Analysis(m).solve();
  const auto cut = std::ranges::find(solved.coordinates, true, &CoordinateSolution::dependent);
  REQUIRE(cut != solved.coordinates.end());
  AssemblyDrag free(m);
  const auto j = static_cast<std::size_t>(joint_index(m, cut->joint));
  const double drawn = m.joints[j].coordinates[0].drawn;
  CHECK(free.move(cut->joint, 0, drawn + 0.2).away < 1e-10);
  CHECK(opening(m, free.pose()) < 1e-12);
  m.joints[j].coordinates[0].stop = Stop{{}, drawn + 0.07, 1000};
  AssemblyDrag stopped(m);
  const DragOutcome out = stopped.move(cut->joint, 0, drawn + 0.2);
  CHECK(out.at_stop);
  CHECK(label(m, stopped.pose(), cut->joint) == Approx(drawn + 0.07).margin(1e-9));
  CHECK(opening(m, stopped.pose()) < 1e-12);
}

TEST_CASE("a chain follows its end, and the far links stay") {
  // Half a circle of hinged links.
  constexpr int links = 20;
  Mechanism m;
  const auto knot = [](int i) {
    const double angle = std::numbers::pi * i / links;
    return Vec3(1 - std::cos(angle), -std::sin(angle), 0);
  };
  for (int i = 0; i < links; ++i) {
    Body body;
    body.name = std::string("link") + static_cast<char>('a' + i);
    body.mass = 1;
    body.position = (knot(i) + knot(i + 1)) / 2;
    Joint joint;
    joint.name = body.name;
    joint.bodies = {i == 0 ? std::string(ground_name) : m.bodies.back().name, body.name};
    joint.at = knot(i);
    joint.coordinates.resize(1);
    m.bodies.push_back(body);
    m.joints.push_back(joint);
  }
  const std::string last = m.bodies.back().name;
  AssemblyDrag drag(m);
  const Vec3 target = drag.position({last}) + Vec3(0.02, 0.01, 0);
  const DragOutcome out = drag.pull({last}, {.at = target});
  CHECK(out.settled);
  CHECK(out.away < 1e-12);
  const MechanismPose pose = drag.pose();
  const auto moved = [&](std::size_t body) {
    return (pose.bodies[body].position - m.bodies[body].position).norm();
  };
  CHECK(moved(links / 4) < 0.3 * moved(links - 1));
  SECTION("and where it is straight nothing is thrown away") {
    // To the foot of the chain: no link can give way to first order.
    const Mechanism straight = bench::chain(20, 0, 0);
    const std::string end = straight.bodies.back().name;
    AssemblyDrag stiff(straight);
    const Vec3 tip = stiff.position({end});
    for (int i = 1; i <= 10; ++i) {
      stiff.pull({end}, {.at = tip + Vec3(0, 0.05 * i, 0)});
      for (const Pose& each : stiff.pose().bodies) {
        CHECK(each.position.allFinite());
        CHECK(each.position.norm() < 2);
      }
    }
    stiff.pull({end}, {.at = tip - Vec3(0, 100, 0)});
    CHECK((stiff.position({end}) - tip).norm() < 1.5);
  }
}

TEST_CASE("a folded linkage is pulled through the position in which it could part") {
  // A parallelogram, flat at a quarter turn.
  Mechanism m;
  m.bodies = {{.name = "left", .description = {}, .mass = 1, .position = {0, 0.5, 0}, .shapes = {}},
              {.name = "top", .description = {}, .mass = 1, .position = {1, 1, 0}, .shapes = {}},
              {.name = "right", .description = {}, .mass = 1, .position = {2, 0.5, 0}, .shapes = {}}};
  const auto hinge = [&](const char* name, const char* a, const char* b, const Vec3& at) {
    Joint joint;
    joint.name = name;
    joint.bodies = {a, b};
    joint.at = at;
    joint.coordinates.resize(1);
    m.joints.push_back(joint);
  };
  hinge("a", "ground", "left", {0, 0, 0});
  hinge("b", "left", "top", {0, 1, 0});
  hinge("c", "right", "top", {2, 1, 0});
  hinge("d", "ground", "right", {2, 0, 0});
  AssemblyDrag drag(m);
  const BodyPoint tip{"left", Vec3(0, 1, 0)};
  for (int i = 1; i <= 40; ++i) {
    const double angle = std::numbers::pi / 2 - 0.06 * i; // flat at i = 26.2
    drag.pull(tip, {.at = {std::cos(angle), std::sin(angle), 0}});
    INFO(i);
    CHECK((drag.position(tip) - Vec3(std::cos(angle), std::sin(angle), 0)).norm() < 1e-9);
    CHECK(opening(m, drag.pose()) < 1e-12);
  }
}

TEST_CASE("the plane in which a body moves is known") {
  CHECK_FALSE(AssemblyDrag(shipped("governor")).plane_of({"ball1"}));
  CHECK_FALSE(AssemblyDrag(shipped("ball_on_string")).plane_of({"ball"}));
  const auto plane = AssemblyDrag(crank(1)).plane_of({"crank"});
  REQUIRE(plane);
  CHECK(std::abs(plane->z()) == Approx(1));
}

TEST_CASE("no mass, no force and no drive makes a difference") {
  Mechanism m = shipped("watt_governor"), other = m;
  for (Body& body : other.bodies)
    body.mass *= 7;
  other.bodies[0].mass = 0;
  other.gravity = {1, 2, 3};
  for (Joint& joint : other.joints)
    for (Coordinate& c : joint.coordinates)
      c.spring.reset(), c.drive.reset();
  AssemblyDrag a(m), b(other);
  const BodyPoint grabbed{m.bodies.back().name};
  const Vec3 target = a.position(grabbed) + Vec3(0.03, 0.02, 0.01);
  a.pull(grabbed, {.at = target});
  b.pull(grabbed, {.at = target});
  CHECK((a.position(grabbed) - m.bodies.back().position).norm() > 1e-3);
  for (std::size_t i = 0; i < m.bodies.size(); ++i)
    CHECK((a.pose().bodies[i].position - b.pose().bodies[i].position).norm() < 1e-12);
}
