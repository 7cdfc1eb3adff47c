// Rates from the implicit function theorem against differences of whole solves.
#include "tests/engine/equilibrium_mechanisms.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE("sensitivities to the sliders agree with differences of solves", "[sensitivity]") {
  int compared = 0;
  for (const char* name : {"governor", "pendulum", "watt_governor", "fourbar_turntable", "rate_gyro",
                           "governor_bearing", "conical_pendulum"}) {
    const Mechanism m = shipped(name);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    REQUIRE(s.sensitivities.size() == m.sliders.size());
    for (const Sensitivity& x : s.sensitivities) {
      INFO(name << " " << x.address);
      const double value = get_parameter(m, x.address), h = 1e-4 * std::abs(value);
      std::vector<Solution> sides;
      for (double side : {h, -h}) {
        Mechanism varied = m;
        set_parameter(varied, x.address, value + side);
        sides.push_back(Analysis(varied).solve());
        REQUIRE(sides.back().status == Status::converged);
      }
      for (const Sensitivity::Rate& r : x.rates) {
        const auto of = [&](const Solution& at) {
          return std::ranges::find_if(
                     at.coordinates,
                     [&](const CoordinateSolution& c) { return c.joint == r.joint && c.index == r.index; })
              ->value;
        };
        const double expected = (of(sides[0]) - of(sides[1])) / (2 * h);
        CHECK(r.value == Approx(expected).epsilon(1e-5).margin(1e-10 / h));
        ++compared;
      }
    }
  }
  CHECK(compared > 20);
}

TEST_CASE("the conical pendulum's angle has the rate of its closed form", "[sensitivity]") {
  Mechanism m = shipped("conical_pendulum");
  const Solution s = Analysis(m).solve();
  const double speed = get_parameter(m, "joints.spin.drive.speed");
  // cos(a) = g / (w^2 L), so da/dw = 2 cot(a) / w.
  const double angle = s.coordinates[1].value;
  REQUIRE(!s.sensitivities.empty());
  CHECK(s.sensitivities[0].address == "joints.spin.drive.speed");
  CHECK(s.sensitivities[0].rates[0].value == Approx(2 / std::tan(angle) / speed).epsilon(1e-13));
}
