// A drive for what elastic bearings hold.
#include "app/document/bearing_drive.hpp"

#include "app/document/create.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <complex>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

// The shipped rotor without its sleeve's mass, and the same as a stranger draws it: a body in two bearings.
Mechanism with_massless_sleeve() {
  Mechanism m = shipped("rotor_oil_whip");
  Body& sleeve = m.bodies[static_cast<std::size_t>(body_index(m, "sleeve"))];
  sleeve.mass = 0;
  sleeve.inertia = {};
  return m;
}

Mechanism without_sleeve() {
  Mechanism m = shipped("rotor_oil_whip");
  std::erase_if(m.bodies, [](const Body& body) { return body.name != "rotor"; });
  m.joints.clear();
  m.measures.clear();
  for (Force& force : m.forces)
    force.bodies[1] = "rotor";
  return m;
}

double fastest(const Solution& solution) {
  REQUIRE(solution.eigenvalues);
  return std::ranges::max_element(*solution.eigenvalues, {},
                                  [](const std::complex<double>& e) { return e.real(); })
      ->real();
}

} // namespace

TEST_CASE("a rotor that is drawn in two bearings and driven runs as the shipped one") {
  Mechanism m = without_sleeve();
  REQUIRE(find_mistakes(m).empty());
  REQUIRE(bearing_drive_refused(m, "rotor").empty());
  const std::string spin = give_bearing_drive(m, "rotor", 100);
  REQUIRE(find_mistakes(m).empty());
  CHECK(get_parameter(m, "joints." + spin + ".drive.speed") == 100);
  Analysis own(m), shipped_one(with_massless_sleeve());
  const Solution a = own.solve({}), b = shipped_one.solve({});
  REQUIRE(a.status == Status::converged);
  REQUIRE(b.status == Status::converged);
  const auto sag = std::ranges::find_if(
      a.coordinates, [](const CoordinateSolution& c) { return c.joint.starts_with("up"); });
  REQUIRE(sag != a.coordinates.end());
  CHECK_THAT(sag->value, WithinRel(value(b.coordinates, "up"), 1e-9));
  CHECK(a.stable == b.stable);
  CHECK_THAT(fastest(a), WithinAbs(fastest(b), 1e-6));
}

TEST_CASE("bearings that are stiff along their axis leave the shaft that slide") {
  Mechanism m;
  m.gravity = {0, -9.80665, 0};
  add_body(m, {.form = BodyForm::rod, .radius = 0.02, .from = {-0.2, 0, 0}, .to = {0.2, 0, 0}});
  for (const double x : {-0.2, 0.2}) {
    add_bearing(m, {"ground", "rod1"}, {x, 0, 0}, {1, 0, 0});
    Force& bearing = m.forces.back();
    bearing.bearing_stiffness.assign(36, 0);
    bearing.bearing_damping.assign(36, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      bearing.bearing_stiffness[7 * i] = 1e6;
      bearing.bearing_damping[7 * i] = 1000;
    }
  }
  const std::string spin = give_bearing_drive(m, "rod1", 50);
  REQUIRE(find_mistakes(m).empty());
  CHECK(m.joints.size() == 5);
  const Solution solution = Analysis(m).solve({});
  REQUIRE(solution.status == Status::converged);
  CHECK(solution.stable == true);
  CHECK(solution.neutral.empty());
}

TEST_CASE("where the drive would be of no use it is refused, and nothing changes") {
  Mechanism m = without_sleeve();
  const auto refused = [](Mechanism changed, const char* why) {
    const Mechanism before = changed;
    CHECK_THAT(bearing_drive_refused(changed, "rotor"), ContainsSubstring(why));
    CHECK_THROWS_AS(give_bearing_drive(changed, "rotor", 10), SceneError);
    CHECK(changed == before);
  };
  Mechanism joined = m;
  add_joint(joined, JointType::revolute, {"ground", "rotor"}, {0, 0, 0}, {1, 0, 0});
  refused(joined, "joins rotor and ground already");
  Mechanism skew = m;
  skew.forces[1].axis = {1, 0.1, 0};
  refused(skew, "not on one axis");
  Mechanism bare = m;
  bare.forces.clear();
  refused(bare, "No bearing holds rotor");
  // What it moved by freely goes.
  add_joint(m, JointType::free, {"ground", "rotor"}, {0, 0, 0}, {1, 0, 0});
  CHECK(bearing_drive_refused(m, "rotor").empty());
  give_bearing_drive(m, "rotor", 10);
  CHECK(std::ranges::none_of(m.joints, [](const Joint& j) { return j.type == JointType::free; }));
}
