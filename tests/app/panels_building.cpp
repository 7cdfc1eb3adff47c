// From nothing to the paper's results by mouse and keys alone.
#include "building.hpp"

#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {} // namespace

TEST_CASE("the swing pendulum is built from an empty document") {
  Robot robot(building_size);
  build_pendulum(robot);
  REQUIRE(robot.app.session.mistakes.empty());
  REQUIRE(robot.app.session.answer.solution.status == Status::converged);
  CHECK(value(robot.app.session.answer.solution, "theta") == Approx(0.4537717).margin(5e-8));
  CHECK(value(robot.app.session.answer.solution, "d") == Approx(1.0153129).margin(5e-8));
  CHECK(robot.app.session.answer.solution.stable == true);
  // What was built is a scene like any other.
  CHECK(read_scene(write_scene(robot.app.session.mechanism())) == robot.app.session.mechanism());
}

TEST_CASE("the governor is built from an empty document, its second arm by mirror") {
  Robot robot(building_size);
  build_governor(robot);
  REQUIRE(robot.app.session.mistakes.empty());
  REQUIRE(robot.app.session.answer.solution.status == Status::converged);
  CHECK(value(robot.app.session.answer.solution, "slide") == Approx(0.1500174581252971).epsilon(1e-10));
  CHECK(std::abs(value(robot.app.session.answer.solution, "hinge1")) ==
        Approx(0.7856156814882422).epsilon(1e-10));
  CHECK(value(robot.app.session.answer.solution, "hinge2") ==
        Approx(value(robot.app.session.answer.solution, "hinge1")).epsilon(1e-10));
  CHECK(robot.app.session.mechanism().bodies.size() == 6);
}
