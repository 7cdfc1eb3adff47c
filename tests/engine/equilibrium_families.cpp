// Branches of states that belong to families, as nothing resists some direction: a bob on a ball joint turns
// about its own rod, and what hangs on a shaft's axis swings out to any side.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branches.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double length = 0.7; // m, of a rod
const std::string speed = "joints.spin.drive.speed";

// A rod without mass with a ball at its end, joined to a turning hub at `offset` from its axis.
Mechanism pendulum(JointType type, double offset, double damping = 0.05) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("hub", 1, Vec3::Zero()), body("bob", 1, {offset, -length, 0}, {1e-3, 1e-3, 1e-3})};
  m.joints = {joint(JointType::revolute, "spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()),
              joint(type, "swing", "hub", "bob", {offset, 0, 0})};
  m.joints[0].coordinates[0].drive = Drive{0};
  if (type == JointType::universal) m.joints[1].axis2 = Vec3::UnitX();
  for (Coordinate& c : m.joints[1].coordinates)
    c.damping = damping;
  return m;
}

// A second such rod below the first.
Mechanism two(JointType type, double offset) {
  Mechanism m = pendulum(type, offset);
  m.bodies.push_back(body("second", 1, {offset, -2 * length, 0}, {1e-3, 1e-3, 1e-3}));
  m.joints.push_back(joint(type, "below", "bob", "second", {offset, -length, 0}));
  return m;
}

ResponseDiagram branches(const Mechanism& m, double from, double to, bool all) {
  BranchOptions options;
  options.all = all;
  return follow_branches(m, speed, from, to, options);
}

std::vector<double> places(const ResponseDiagram& d, SpecialPointType type) {
  std::vector<double> out;
  for (const SpecialPoint& s : d.special)
    if (s.type == type) out.push_back(s.at.parameter);
  std::ranges::sort(out);
  return out;
}

std::vector<double> coordinates_of(const ResponsePoint& p, const std::string& name) {
  std::vector<double> out;
  for (const CoordinateSolution& c : p.coordinates)
    if (c.joint == name) out.push_back(c.value);
  return out;
}

// Of the rod from the vertical.
double cosine_of_tilt(const ResponsePoint& p) {
  const std::vector<double> q = coordinates_of(p, "swing");
  if (q.size() == 2) return std::cos(q[0]) * std::cos(q[1]); // about z, then x
  const Vec3 turn(q[0], q[1], q[2]);
  if (!(turn.norm() > 0)) return 1;
  return (Eigen::AngleAxisd(turn.norm(), turn.normalized()) * Vec3::UnitY()).y();
}

} // namespace

TEST_CASE("on a ball joint the leaning-in branch folds as on a hinge", "[branches][families]") {
  const ResponseDiagram d = branches(pendulum(JointType::spherical, 0.1), 0, 10, true);
  REQUIRE(d.status == Status::converged);
  INFO(d.message);
  CHECK(d.branches.size() == 3); // out, in with its fold, up: as of the hinge
  CHECK(branches(pendulum(JointType::revolute, 0.1), 0, 10, true).branches.size() == 3);
  const std::vector<double> folds = places(d, SpecialPointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK(std::abs(folds[0] - 4.75536807929276) < 1e-8); // w^2 (e + L sin) = g tan, and its derivative
  CHECK(d.message.find("not looked for") == std::string::npos);
}

TEST_CASE("a rod on a shaft's axis leaves it to any side at sqrt(g/L)", "[branches][families]") {
  const double damping = GENERATE(0., 0.05);
  const JointType type = GENERATE(JointType::spherical, JointType::universal);
  const bool searched = GENERATE(false, true);
  // Of a universal joint a search also finds where it locks, and the rod half a turn about itself away.
  const bool all = searched && type == JointType::spherical;
  CAPTURE(damping, static_cast<int>(type), all);
  const ResponseDiagram d = branches(pendulum(type, 0, damping), 0, 10, all);
  REQUIRE(d.status == Status::converged);
  const std::vector<double> crossings = places(d, SpecialPointType::branch_point);
  REQUIRE(crossings.size() == 1);
  CHECK(std::abs(crossings[0] - std::sqrt(standard_gravity / length)) < 1e-7);
  CHECK(places(d, SpecialPointType::hopf).empty());
  int tilted = 0;
  for (const ResponseBranch& branch : d.branches) {
    CHECK(branch.points.size() < 400);
    if (const double last = cosine_of_tilt(branch.points.back()); std::abs(last) > 0.999) continue;
    ++tilted;
    for (std::size_t i = 2; i < branch.points.size(); ++i) {
      const ResponsePoint& p = branch.points[i];
      CHECK(cosine_of_tilt(p) ==
            Approx(standard_gravity / (p.parameter * p.parameter * length)).margin(1e-9));
      CHECK(p.stable != false); // stable, but for where it stands in the family
    }
  }
  CHECK(tilted == 2);
}

TEST_CASE("a family has one branch, wherever in it a search arrives", "[branches][families]") {
  const ResponseDiagram balls = branches(two(JointType::spherical, 0.1), 4, 6, true),
                        hinges = branches(two(JointType::revolute, 0.1), 4, 6, true);
  REQUIRE(balls.status == Status::converged);
  // Where the shaft turns the rods stand in a plane through its axis.
  CHECK(balls.branches.size() == hinges.branches.size());
  const std::vector<double> of_balls = places(balls, SpecialPointType::fold),
                            of_hinges = places(hinges, SpecialPointType::fold);
  REQUIRE(of_balls.size() == of_hinges.size());
  for (std::size_t i = 0; i < of_balls.size(); ++i)
    CHECK(std::abs(of_balls[i] - of_hinges[i]) < 1e-8);
}

TEST_CASE("two rods on ball joints leave the axis where hinged ones do", "[branches][families]") {
  const ResponseDiagram balls = branches(two(JointType::spherical, 0), 0, 10, false),
                        hinges = branches(two(JointType::revolute, 0), 0, 10, false);
  const std::vector<double> of_balls = places(balls, SpecialPointType::branch_point),
                            of_hinges = places(hinges, SpecialPointType::branch_point);
  REQUIRE(of_balls.size() == 2);
  REQUIRE(of_hinges.size() == 2);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(std::abs(of_balls[i] - of_hinges[i]) < 1e-6);
  CHECK(places(balls, SpecialPointType::hopf).empty()); // the pair goes through zero
  CHECK(balls.branches.size() == hinges.branches.size());
}

TEST_CASE("of two like pendulums on one axis more leave it than are followed, and it is said",
          "[branches][families]") {
  Mechanism m = pendulum(JointType::revolute, 0);
  m.bodies.push_back(body("other", 1, {0, -length, 0}, {1e-3, 1e-3, 1e-3}));
  m.joints.push_back(joint(JointType::revolute, "other", "hub", "other", Vec3::Zero()));
  const ResponseDiagram d = branches(m, 0, 10, false);
  const std::vector<double> crossings = places(d, SpecialPointType::branch_point);
  REQUIRE(crossings.size() == 1);
  CHECK(std::abs(crossings[0] - std::sqrt(standard_gravity / length)) < 1e-7);
  CHECK_THAT(d.message, ContainsSubstring("more branches may leave"));
}

TEST_CASE("no crossings are made up where a shaft stands", "[branches][families]") {
  // Two ball joints, then two hinges, beside the axis: while the shaft stands they may turn about the
  // vertical.
  Mechanism m = two(JointType::spherical, 0.1);
  for (const int i : {2, 3}) {
    const std::string name = "rod" + std::to_string(i);
    m.bodies.push_back(body(name, 1, {0.1, -(i + 1) * length, 0}, {1e-3, 1e-3, 1e-3}));
    m.joints.push_back(joint(JointType::revolute, "hinge" + std::to_string(i), i == 2 ? "second" : "rod2",
                             name, {0.1, -i * length, 0}));
  }
  const ResponseDiagram d = branches(m, 2, -1, false);
  REQUIRE(d.status == Status::converged);
  CHECK(places(d, SpecialPointType::branch_point).empty());
  for (const ResponseBranch& branch : d.branches)
    CHECK(branch.points.back().parameter == Approx(-1));
}
