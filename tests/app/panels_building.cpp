// From nothing to the paper's results by mouse and keys alone.
#include "building.hpp"

#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

double value_of(const App& app, const std::string& joint) {
  for (const CoordinateSolution& c : app.answer.solution.coordinates)
    if (c.joint == joint) return c.value;
  return NAN;
}

} // namespace

TEST_CASE("the swing pendulum is built from an empty document") {
  Robot robot(building_size);
  build_pendulum(robot);
  REQUIRE(robot.app.mistakes.empty());
  REQUIRE(robot.app.answer.solution.status == Status::converged);
  CHECK(value_of(robot.app, "theta") == Approx(0.4537717).margin(5e-8));
  CHECK(value_of(robot.app, "d") == Approx(1.0153129).margin(5e-8));
  CHECK(robot.app.answer.solution.stable == true);
  // What was built is a scene like any other.
  CHECK(read_scene(write_scene(robot.app.mechanism())) == robot.app.mechanism());
}

TEST_CASE("the governor is built from an empty document, its second arm by mirror") {
  Robot robot(building_size);
  build_governor(robot);
  REQUIRE(robot.app.mistakes.empty());
  REQUIRE(robot.app.answer.solution.status == Status::converged);
  CHECK(value_of(robot.app, "slide") == Approx(0.1500174581252971).epsilon(1e-10));
  CHECK(std::abs(value_of(robot.app, "hinge1")) == Approx(0.7856156814882422).epsilon(1e-10));
  CHECK(value_of(robot.app, "hinge2") == Approx(value_of(robot.app, "hinge1")).epsilon(1e-10));
  CHECK(robot.app.mechanism().bodies.size() == 6);
}
