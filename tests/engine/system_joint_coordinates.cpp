// Coordinates of joints from relative poses: against those of the tree, for every type and either order.
#include "engine/system/joint_coordinates.hpp"
#include "tests/catch.hpp"
#include "tests/engine/system_model.hpp"
#include "tests/support/mechanisms.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// One body on one joint, the body its child or its parent, at random places with random labels.
Mechanism one_joint(JointType type, bool body_is_child, Dice& dice) {
  Mechanism m;
  m.name = "one joint";
  m.bodies = {body("b", 1, dice.box(1), {0.1, 0.1, 0.1})};
  Joint j = joint(type, "j", body_is_child ? "ground" : "b", body_is_child ? "b" : "ground", dice.box(1),
                  dice.box(1) + Vec3(0, 0, 2));
  j.axis2 = dice.box(1) + Vec3(2, 0, 0);
  for (Coordinate& c : j.coordinates)
    c.drawn = dice.between(-0.5, 0.5);
  m.joints = {j};
  return m;
}

// The joint of the tree as if it were a cut.
CutJoint as_cut(const System& system, JointType type, bool body_is_child) {
  CutJoint cut;
  cut.joint = 0;
  cut.type = type;
  (body_is_child ? cut.ends.b : cut.ends.a) = system.body_link[0];
  for (std::size_t l = 0; l < system.links.size(); ++l)
    for (int k = 0; k < (system.links[l].type == LinkType::spherical ? 3 : 1); ++k)
      if (system.links[l].v >= 0)
        cut.ends.support.push_back({system.links[l].v + k, static_cast<int>(l), body_is_child});
  return cut;
}

} // namespace

TEST_CASE("coordinates of every joint follow from the relative pose of its bodies, and so do their rates") {
  for (JointType type : {JointType::revolute, JointType::prismatic, JointType::cylindrical,
                         JointType::universal, JointType::spherical, JointType::planar, JointType::free})
    for (bool body_is_child : {true, false})
      for (std::uint32_t seed = 0; seed < 5; ++seed) {
        INFO(type_name(type) << ", body is child " << body_is_child << ", seed " << seed);
        Dice dice(seed + 10 * static_cast<std::uint32_t>(type));
        const Mechanism m = one_joint(type, body_is_child, dice);
        const System system = compile(m);
        Parameters p;
        bind(system, m, p);
        const JointFrame frame = joint_frame(m.joints[0]);
        CutParameters numbers;
        numbers.frame = frame.axes;
        numbers.drawn = frame.drawn;
        const Vec3 at = m.joints[0].at - p.origin;
        const Vec3 in_body = at - p.links[static_cast<std::size_t>(system.body_link[0])].origin;
        numbers.a = body_is_child ? at : in_body;
        numbers.b = body_is_child ? in_body : at;
        const CutJoint cut = as_cut(system, type, body_is_child);

        Eigen::VectorXd drawn, step(system.nv);
        drawn_configuration(system, p, drawn);
        for (double& x : step)
          x = dice.between(-1, 1);
        const auto configuration = [&](double along, int v) {
          Eigen::VectorXd q = drawn, small = Eigen::VectorXd::Zero(system.nv);
          retract<double>(system, step, q);
          if (v >= 0) small[v] = along;
          retract<double>(system, small, q);
          return q;
        };
        const auto measured = [&](const Eigen::VectorXd& q, Kinematics<double>& k) {
          forward<double>(system, p, q, 0, k);
          return joint_coordinates(cut, numbers, k);
        };
        Kinematics<double> k, moved;
        const Eigen::VectorXd q = configuration(0, -1);
        const JointCoordinates here = measured(q, k);
        for (const CoordinateInfo& c : system.coordinates) {
          const double value = coordinate_value(system, p, q, c);
          CHECK(std::abs(here.value[static_cast<std::size_t>(c.index)] -
                         (c.angle && !is_rotation_vector(type, c.index) ? wrapped_angle(value) : value)) <
                1e-14);
        }
        for (const SupportColumn& column : cut.ends.support) {
          const auto rates = (here.rate * relative_velocity(cut, numbers, k, column)).eval();
          constexpr double h = 1e-6;
          const JointCoordinates plus = measured(configuration(h, column.v), moved);
          const JointCoordinates minus = measured(configuration(-h, column.v), moved);
          for (int i = 0; i < coordinate_count(type); ++i) {
            const auto n = static_cast<std::size_t>(i);
            CHECK(std::abs(rates[i] - (plus.value[n] - minus.value[n]) / (2 * h)) < 1e-8);
          }
        }
      }
}

TEST_CASE("a compiled system lists the coordinates of all joints in the scene's order") {
  Mechanism m;
  m.name = "slider-crank";
  m.bodies = {body("crank", 1, {0.5, 0, 0}), body("rod", 1, {1.5, 0, 0}), body("piston", 1, {2, 0, 0})};
  m.joints = {prismatic("stroke", "ground", "piston", {2, 0, 0}, Vec3::UnitX()),
              revolute("turn", "ground", "crank", {0, 0, 0}, Vec3::UnitZ()),
              revolute("elbow", "crank", "rod", {1, 0, 0}, Vec3::UnitZ()),
              revolute("wrist", "rod", "piston", {2, 0, 0}, Vec3::UnitZ())};
  m.joints[0].cut = true;
  const System system = compile(m);
  REQUIRE(system.reported.size() == 4);
  CHECK(system.coordinates.size() == 3);
  CHECK(system.reported[0].joint == "stroke");
  CHECK(system.reported[0].cut == 0);
  CHECK_FALSE(system.reported[0].angle);
  for (std::size_t i = 1; i < 4; ++i)
    CHECK(system.reported[i].coordinate == static_cast<int>(i) - 1);
}
