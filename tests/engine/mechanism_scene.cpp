#include "engine/mechanism/scene.hpp"

#include "tests/catch.hpp"

using namespace flyball;

TEST_CASE("The paper's mechanisms load") {
  const Mechanism pendulum = load_scene(FLYBALL_ASSETS "/scenes/pendulum.json");
  CHECK(pendulum.bodies.size() == 3);
  CHECK(pendulum.joints.at(2).coordinates.at(0).drawn == 1.1);
  const Mechanism governor = load_scene(FLYBALL_ASSETS "/scenes/governor.json");
  CHECK(governor.bodies.size() == 4);
  CHECK(governor.joints.at(0).coordinates.at(0).drive->speed == 11.0174);
}
