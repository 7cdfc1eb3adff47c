// What redundant loops leave open of reactions, component by component, against statics by hand.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/mechanism.hpp"

#include <Eigen/Geometry>

using namespace flyball;
using namespace flyball::test;

namespace {

const Reaction& reaction_of(const Solution& s, std::string_view joint) {
  const auto found = std::ranges::find(s.reactions, joint, &Reaction::joint);
  REQUIRE(found != s.reactions.end());
  return *found;
}

// A four-bar whose plane stands at right angles to turned z: crank a and rocker d with weights, the coupler
// between them without, a spring at the crank. Its parts lie beside each other, so that forces in the plane
// twist it, which its hinges bear somehow.
struct FourBar {
  Mat3 turn;
  Vec3 a = at(0, 0, 0), b = at(0.1, 0.3, 0.03), c = at(0.5, 0.35, -0.02), d = at(0.45, 0, 0.05);
  Vec3 crank = at(0.08, 0.15, 0.02), rocker = at(0.5, 0.2, -0.04); // mass centres
  double crank_mass = 1.3, rocker_mass = 0.8;

  Vec3 at(double x, double y, double z) const { return turn * Vec3(x, y, z); }
  Vec3 normal() const { return at(0, 0, 1); }
  Vec3 gravity() const { return at(1, -9, 0); }

  Mechanism mechanism() const {
    Mechanism m;
    m.name = "four-bar";
    m.gravity = gravity();
    m.bodies = {body("crank", crank_mass, crank, {0.01, 0.01, 0.01}), body("coupler", 0),
                body("rocker", rocker_mass, rocker, {0.01, 0.01, 0.01})};
    m.joints = {sprung(revolute("A", "ground", "crank", a, normal()), 40),
                revolute("B", "crank", "coupler", b, normal()),
                revolute("C", "coupler", "rocker", c, normal()),
                revolute("D", "ground", "rocker", d, normal())};
    return m;
  }
};

} // namespace

TEST_CASE("Of a planar four-bar of hinges the forces in its plane are unique") {
  const bool oblique = GENERATE(false, true);
  CAPTURE(oblique);
  const FourBar bar{oblique ? Eigen::AngleAxisd(0.8, Vec3(1, 2, -0.5).normalized()).toRotationMatrix()
                            : Mat3(Mat3::Identity())};
  Mechanism m = bar.mechanism();
  m.measures = {{"across", "", "reaction_x(C)", "N"},
                {"along", "", "reaction_z(C)", "N"},
                {"size", "", "reaction(C)", "N"},
                {"about", "", "moment_z(C)", "N m"}};
  const Solution s = solve(m);
  CAPTURE(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.reactions_nonunique);
  // The coupler bears a force along its line alone, by the moments of the rocker about its hinge.
  const auto carried = [&](int part, const Vec3& point) {
    const Pose& pose = s.poses[static_cast<std::size_t>(part)];
    return Vec3(pose.position + pose.rotation * (point - m.bodies[static_cast<std::size_t>(part)].position));
  };
  const Vec3 n = bar.normal();
  const auto in_plane = [&](const Vec3& v) -> Vec3 { return v - n.dot(v) * n; };
  const Vec3 b = carried(0, bar.b), c = carried(2, bar.c), rocker = s.poses[2].position;
  REQUIRE((b - bar.b).norm() > 0.005); // it gives way
  const Vec3 line = in_plane(c - b).normalized(), weight = bar.rocker_mass * bar.gravity();
  const double push = -n.dot((rocker - bar.d).cross(weight)) / n.dot((c - bar.d).cross(line));
  const Vec3 coupler = push * line;
  const std::vector<std::pair<std::string, Vec3>> exact{{"A", coupler - bar.crank_mass * bar.gravity()},
                                                        {"B", coupler},
                                                        {"C", coupler},
                                                        {"D", -weight - coupler}};
  for (const auto& [joint, force] : exact) {
    CAPTURE(joint);
    const Reaction& r = reaction_of(s, joint);
    CHECK(r.nonunique());
    CHECK((r.open.force.projector - n * n.transpose()).norm() < 1e-9);
    CHECK((r.open.torque.projector - (Mat3::Identity() - n * n.transpose())).norm() < 1e-9);
    CHECK((r.open.force.unique_part(r.force) - force).norm() < 1e-10 * coupler.norm());
    const double spring = joint == "A" ? n.dot(r.torque) : 0;
    CHECK((r.open.torque.unique_part(r.torque) - spring * n).norm() < 1e-10 * coupler.norm());
    CHECK(r.open.force.along_axes() == !oblique);
    for (int i = 0; i < 3; ++i) {
      CHECK(r.open.force.component(i) == (oblique || i == 2));
      CHECK(r.open.torque.component(i) == (oblique || i != 2));
    }
  }
  for (const MeasureSolution& measure : s.measures)
    CHECK(measure.nonunique == (oblique || measure.name == "along" || measure.name == "size"));
}

TEST_CASE("A door on two ball joints shares its axial force alone") {
  // Its mass centre hangs in the plane of the oblique axis and gravity.
  const Vec3 axis(0.6, 0, 0.8), centre = 0.4 * Vec3(0.8, 0, -0.6), weight = 5 * Vec3(0, 0, -9.81);
  const Vec3 upper = 0.5 * axis, lower = -0.5 * axis;
  Mechanism m;
  m.name = "door";
  m.gravity = {0, 0, -9.81};
  m.bodies = {body("door", 5, centre, {0.1, 0.2, 0.25})};
  m.joints = {joint(JointType::spherical, "upper", "ground", "door", upper),
              joint(JointType::spherical, "lower", "ground", "door", lower)};
  const Solution s = solve(m);
  CAPTURE(s.message);
  REQUIRE(s.status == Status::converged);
  const Vec3 held = axis.cross((centre - lower).cross(weight)); // by the moments about the lower one
  const Vec3 radial = weight - axis.dot(weight) * axis;
  const Reaction &above = reaction_of(s, "upper"), &below = reaction_of(s, "lower");
  for (const Reaction* r : {&above, &below}) {
    CHECK((r->open.force.projector - axis * axis.transpose()).norm() < 1e-9);
    CHECK_FALSE(r->open.torque.any());
    CHECK(r->open.force.component(0));
    CHECK_FALSE(r->open.force.component(1)); // across the axis
    CHECK(r->open.force.component(2));
  }
  CHECK((above.open.force.unique_part(above.force) - held).norm() < 1e-9);
  CHECK((below.open.force.unique_part(below.force) + radial + held).norm() < 1e-9);
  CHECK(std::abs(axis.dot(above.force + below.force + weight)) < 1e-9);
}

TEST_CASE("Of two hinges on one axis all is open but the moments about it") {
  Mechanism m;
  m.name = "door";
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("door", 2, {0.3, 0, 0}, {0.1, 0.2, 0.25})};
  m.joints = {sprung(revolute("front", "ground", "door", {0, 0, 0.2}), 30),
              revolute("back", "ground", "door", {0, 0, -0.2})};
  const Solution s = solve(m);
  REQUIRE(s.status == Status::converged);
  for (const Reaction& r : s.reactions) {
    CAPTURE(r.joint);
    CHECK(r.open.force.projector == Mat3::Identity());
    CHECK(r.open.torque.projector == Mat3(Vec3(1, 1, 0).asDiagonal()));
  }
  CHECK(std::abs(reaction_of(s, "front").torque.z() + 30 * value(s, "front")) < 1e-12);
}

TEST_CASE("Directions that differ by rounding are not open") {
  const Vec3 one(0.6, 0.8, 0), other(0, 0, 2);
  CHECK_FALSE(open_directions({}, 0.1).any());
  CHECK_FALSE(open_directions({0.01 * one}, 0.1).any());
  const OpenDirections line = open_directions({one, Vec3(3 * one + 1e-9 * other)}, 1e-7);
  CHECK((line.projector - one * one.transpose()).norm() < 1e-12);
  CHECK_FALSE(line.component(2));
  CHECK_FALSE(line.along_axes());
  const OpenDirections plane = open_directions({one, Vec3(one + other)}, 1e-7);
  CHECK(std::abs(plane.projector.trace() - 2) < 1e-12);
  CHECK(plane.unique_part({1, 2, 3}).isApprox(Vec3(1, 2, 0) - 2.2 * one, 1e-12));
  CHECK(open_directions({one, other, Vec3::UnitX()}, 1e-7).projector == Mat3::Identity());
}
