// How far told states are apart, in the units and sizes of any mechanism.
#include "engine/report/analysis.hpp"
#include "engine/solve/solution_difference.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

CoordinateSolution told(double value, double scale = 1, bool angle = false) {
  CoordinateSolution c;
  c.joint = "a";
  c.value = value;
  c.scale = scale;
  c.angle = angle;
  return c;
}

// The governor in another size, and gravity with it, so that it moves alike.
std::vector<CoordinateSolution> governor(double size, double speed) {
  Mechanism m = resized(shipped("governor"), size);
  m.gravity *= size;
  m.joints[0].coordinates[0].drive->speed = speed;
  const Solution solution = Analysis(m).solve();
  REQUIRE(solution.status == Status::converged);
  return solution.coordinates;
}

} // namespace

TEST_CASE("Told states of a watch and of a crane are as far apart as those of the same in metres") {
  const auto slow = governor(1, 11), fast = governor(1, 13);
  const double apart = scaled_distance(slow, fast), squared = squared_distance(slow, fast);
  CHECK(apart > 1e-2);
  CHECK(squared >= apart * apart);
  CHECK(scaled_distance(slow, slow) == 0);
  CHECK(squared_distance(fast, fast) == 0);
  for (const double size : {1e-3, 1e2}) {
    CHECK_THAT(scaled_distance(governor(size, 11), governor(size, 13)), WithinRel(apart, 1e-6));
    CHECK_THAT(squared_distance(governor(size, 11), governor(size, 13)), WithinRel(squared, 1e-6));
  }
  const auto middle = coordinates_between(slow, fast, 0.5);
  CHECK_THAT(scaled_distance(slow, middle), WithinRel(apart / 2, 1e-12));
  CHECK_THAT(scaled_distance(middle, fast), WithinRel(apart / 2, 1e-12));
}

TEST_CASE("Told coordinates differ in radians the short way round, parts of the reach and of their speed") {
  using std::numbers::pi;
  CHECK_THAT(value_difference(told(1e-3, 1e-3), told(3e-3, 1e-3)), WithinRel(2., 1e-12));
  CHECK_THAT(value_difference(told(3, 1, true), told(-3, 1, true)), WithinRel(2 * pi - 6, 1e-12));
  CHECK_THAT(value_difference(told(-3, 1), told(3, 1)), WithinRel(6., 1e-12)); // a length
  CoordinateSolution driven = told(5);
  driven.driven = true;
  CHECK(value_difference(driven, told(1)) == 0);
  // A speed by the largest of both and of the start; what follows from others counts with them.
  CoordinateSolution slow = driven, fast = driven;
  slow.speed = 100;
  fast.speed = -50;
  slow.speed_scale = fast.speed_scale = 10;
  CHECK_THAT(speed_difference(slow, fast), WithinRel(-1.5, 1e-12));
  slow.speed = 1;
  fast.speed = 2;
  CHECK_THAT(speed_difference(slow, fast), WithinRel(0.1, 1e-12));
  CHECK_THAT(scaled_distance({slow}, {fast}), WithinRel(0.1, 1e-12));
  CHECK_THAT(*coordinates_between({slow}, {fast}, 0.25)[0].speed, WithinRel(1.25, 1e-12));
  slow.dependent = true;
  CHECK(speed_difference(slow, fast) == 0);
  CHECK(std::isinf(scaled_distance({slow}, {})));
  CHECK(std::isinf(squared_distance({}, {slow})));
}
