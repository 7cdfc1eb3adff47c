// Inertias as public robot files have them: what no real body has is told and used, negative moments are
// refused.
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

Mechanism arm(double mass, const std::array<double, 6>& inertia) {
  Mechanism m;
  m.name = "arm";
  m.bodies = {body("arm", mass, {0.5, 0, 0})};
  m.bodies[0].inertia = inertia;
  m.joints = {revolute("hinge", "ground", "arm", {0, 0, 0}, Vec3::UnitY())};
  return m;
}

} // namespace

TEST_CASE("inertias that miss the triangle inequality are used, with a warning unless rounding explains it") {
  struct Given {
    double mass;
    std::array<double, 6> inertia;
    bool warned;
  };
  for (const Given& given : {
           Given{1, {1, 1.5, 1, 0, 0, 0}, false},
           Given{1, {1, 2.5, 1, 0, 0, 0}, true},
           Given{0.1, {1e-6, 1e-6, 1e-5, 0, 0, 0}, true},
           Given{0.1, {0.01, 0.01, 0.1, 0.001, 0, 0}, true},
           Given{2, {0, 0, 0, 0, 0, 0}, false},
           Given{0, {0, 0, 0, 0, 0, 0}, false},
           Given{2, {0, 0, 1, 0, 0, 0}, true},                // a moment about one axis alone
           Given{2, {0.3, 0.2, 0.5 + 1e-16, 0, 0, 0}, false}, // a disc, but for rounding
           Given{1, {0.3, 0.2, 0.5 + 1e-12, 0, 0, 0}, false},
           Given{1, {1e-22, 1e-22, 5e-22, 0, 0, 0}, false}, // zero, but for arithmetic
           Given{1, {0, 0, 0, 1e-22, 0, 0}, false},
           Given{0.5, {4.5e-4, 4.5e-4, 9e-4 + 1e-22, 0, 0, 0}, false},
           Given{1e-12, {1e-24, 1e-24, 5e-24, 0, 0, 0}, true}, // a real one of microscopic size
           Given{1, {1e25, 1e25, 1e27, 0, 0, 0}, true},
       }) {
    CAPTURE(given.mass, given.inertia);
    const Mechanism m = arm(given.mass, given.inertia);
    CHECK(find_mistakes(m).empty());
    const std::vector<SceneError> warnings = find_warnings(m);
    REQUIRE(warnings.size() == (given.warned ? 1 : 0));
    if (!given.warned) continue;
    CHECK(warnings[0].where() == "bodies.arm.inertia");
    CHECK_THAT(warnings[0].expected(), ContainsSubstring("sum of the other two"));
  }
}

TEST_CASE("negative principal moments are a mistake, whatever the triangle inequality says") {
  for (const std::array<double, 6>& inertia : {std::array<double, 6>{-1e-6, 1e-6, 1e-6, 0, 0, 0},
                                               {1, 1, -0.1, 0, 0, 0},
                                               {1, 1, 1, 2, 0, 0},
                                               {1e-6, 1e-6, 1e-6, 0, 0, 1.1e-6},
                                               {1e25, 1e25, -1e20, 0, 0, 0}}) {
    CAPTURE(inertia);
    const std::vector<SceneError> mistakes = find_mistakes(arm(1, inertia));
    REQUIRE(mistakes.size() == 1);
    CHECK(mistakes[0].where() == "bodies.arm.inertia");
    CHECK_THAT(mistakes[0].expected(), ContainsSubstring("negative principal"));
  }
}
