#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/scene.hpp"

#include "tests/catch.hpp"
#include "tests/engine/mechanism_everything.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("Every address of every scene can be read and set, and changes nothing else") {
  std::vector<Mechanism> mechanisms{read_scene(everything)};
  for (const std::string& file : shipped_files())
    mechanisms.push_back(load_scene(file));
  for (const Mechanism& original : mechanisms) {
    const std::vector<std::string> addresses = parameter_addresses(original);
    CHECK(std::set<std::string>(addresses.begin(), addresses.end()).size() == addresses.size());
    int number = 0;
    for (const std::string& address : addresses) {
      INFO(original.name << ": " << address);
      const double value = get_parameter(original, address);
      // No further than expressions can make something of it.
      const bool named = address.starts_with("parameters.") || address.starts_with("points.");
      const double other = value + (named ? 0.005 : 0.5);
      Mechanism changed = original;
      set_parameter(changed, address, other);
      REQUIRE(get_parameter(changed, address) == other);
      REQUIRE_FALSE(changed == original);
      REQUIRE(parameter_addresses(changed) == addresses);
      int different = 0;
      for (const std::string& each : addresses)
        if (get_parameter(changed, each) != get_parameter(original, each)) ++different;
      // Gears' offsets and a link's length, while absent, follow what they are derived from.
      REQUIRE(different >= 1);
      if (!named) REQUIRE(different <= 3);
      // Absent optional fields now hold what they stood for; apart from these all is as before.
      Mechanism restored = changed;
      set_parameter(restored, address, value);
      for (const std::string& each : addresses)
        REQUIRE(get_parameter(restored, each) == get_parameter(original, each));
      if (number++ % few_or_all(4, 1) == 0) REQUIRE_NOTHROW(parse_scene(write_scene(changed)));
    }
  }
}

TEST_CASE("Addresses reach the fields they name, with units") {
  const Mechanism m = read_scene(everything);
  struct Expected {
    const char* address;
    double value;
    const char* unit;
  };
  const Expected all[] = {
      {"gravity.1", -9.80665, "m/s^2"},
      {"bodies.table.mass", 2, "kg"},
      {"bodies.table.position.1", 0.5, "m"},
      {"bodies.arm.inertia.5", 0.03, "kg m^2"},
      {"joints.spin.drive.speed", 10, "rad/s"},
      {"joints.hinge.at.0", 1, "m"},
      {"joints.hinge.axis.2", 2, ""},
      {"joints.hinge.coordinate", 0.5, "rad"},
      {"joints.hinge.spring.stiffness", 300, "N m/rad"},
      {"joints.hinge.spring.free", 0.1, "rad"},
      {"joints.hinge.damping", 4, "N m s/rad"},
      {"joints.hinge.stop.lower", -1, "rad"},
      {"joints.hinge.stop.stiffness", 900, "N m/rad"},
      {"joints.slide.damping", 0, "N s/m"},
      {"joints.thread.coordinate.1", 0.3, "m"},
      {"joints.thread.spring.1.stiffness", 70, "N/m"},
      {"joints.thread.damping.0", 5, "N m s/rad"},
      {"joints.thread.stop.1.upper", 3, "m"},
      {"joints.thread.drive.0.speed", 6, "rad/s"},
      {"joints.ice.drive.2.speed", 7, "rad/s"},
      {"joints.ice.x_axis.2", 1, ""},
      {"joints.cardan.axes.1.1", 1, ""},
      {"joints.flight.drive.0.speed", 8, "m/s"},
      {"joints.tie.points.1.2", 5, "m"},
      {"joints.tie.length", 5.5, "m"},
      {"joints.teeth.ratio", -2, ""},
      {"joints.teeth.offset", 0.75, "rad"},
      {"joints.worm.offset", -1.5, "rad"}, // 0 - 3 * 0.5, from the drawn values
      {"forces.coil.stiffness", 120, "N/m"},
      {"forces.coil.free_length", 0.9, "m"},
      {"forces.coil.damping", 1.5, "N s/m"},
      {"forces.coil.points.1.0", 1, "m"},
      {"forces.push.vector.2", 6, "N"},
      {"forces.push.at.1", 2, "m"},
      {"forces.turn.vector.0", 7, "N m"},
      {"forces.turn.at.0", 1, "m"}, // the mass centre
      {"forces.air.linear", 0.125, "N s/m"},
      {"forces.air.quadratic", 0.375, "N s^2/m^2"},
      {"joints.strap.radii.1", 0.5, "m"},
      {"joints.bar.radius", -0.125, "m"},
      {"joints.bolt.lead", 0.0625, "m"},
      {"forces.sail.normal.2", 2, ""},
      {"forces.sail.cn", 3, ""},
      {"air.density", 1.5, "kg/m^3"},
      {"air.wind.0", 1, "m/s"},
      {"simulation.duration", 20, "s"},
  };
  const std::vector<std::string> addresses = parameter_addresses(m);
  for (const Expected& expected : all) {
    INFO(expected.address);
    CHECK(get_parameter(m, expected.address) == expected.value);
    CHECK(parameter_unit(m, expected.address) == expected.unit);
    CHECK(std::find(addresses.begin(), addresses.end(), expected.address) != addresses.end());
  }
  CHECK(addresses.front() == "parameters.L");
  CHECK(addresses.back() == "simulation.duration");
}

TEST_CASE("Numbers inside ranges are not zero, wherever the ranges lie about it") {
  Mechanism m = read_scene(everything);
  set_parameter(m, "gravity.0", 0);
  for (const double from : {-1., -0.63, -0.37, -0.2, 0.}) {
    CAPTURE(from);
    const NumberRange range{"gravity.0", from, from + 1};
    const double value = get_parameter(inside_ranges(m, {&range, 1}).value(), "gravity.0");
    CHECK(value > from);
    CHECK(value < from + 1);
    CHECK(std::abs(value) > 0.1);
  }
}

TEST_CASE("An absent optional number is set into being") {
  Mechanism m = read_scene(edited(R"(, "length": 5.5)", ""));
  const double drawn = get_parameter(m, "joints.tie.length");
  CHECK(drawn == Approx(std::sqrt(26.0)));
  CHECK_FALSE(m.joints.at(10).length.has_value());
  set_parameter(m, "joints.tie.length", 4);
  CHECK(m.joints.at(10).length == 4);
  set_parameter(m, "forces.turn.at.1", 9);
  CHECK(m.forces.at(2).at == Vec3(1, 9, 0));
}

TEST_CASE("An address that names nothing is answered with what exists") {
  const Mechanism m = read_scene(everything);
  const auto check = [&](const std::string& address, const std::string& where, const std::string& expected) {
    INFO(address);
    Mechanism copy = m;
    try {
      set_parameter(copy, address, 1);
      FAIL_CHECK("accepted");
    } catch (const SceneError& error) {
      CHECK(error.where() == where);
      CHECK_THAT(error.expected(), ContainsSubstring(expected));
    }
    CHECK(copy == m);
    CHECK_THROWS_AS(get_parameter(m, address), SceneError);
    CHECK_THROWS_AS(parameter_unit(m, address), SceneError);
  };
  check("", "", "begins with parameters, points, gravity, air, bodies, joints, forces or simulation");
  check("joint.spin.drive.speed", "joint.spin.drive.speed", "did you mean \"joints\"?");
  check("joints", "joints", "expected one of spin, hinge");
  check("joints.spn.drive.speed", "joints.spn", "did you mean \"spin\"?");
  check("joints.hinge.drive.speed", "joints.hinge.drive",
        "there is no \"drive\" here; what exists: at, axis, coordinate, spring, damping, stop and friction");
  check("joints.hinge.spring.stifness", "joints.hinge.spring.stifness", "did you mean \"stiffness\"?");
  check("joints.hinge.spring", "joints.hinge.spring", "names no number yet; what exists: stiffness and free");
  check("joints.hinge", "joints.hinge", "names no number yet; what exists: at, axis");
  check("joints.hinge.damping.0", "joints.hinge.damping.0", "expected the address to end before \"0\"");
  check("joints.thread.drive.1.speed", "joints.thread.drive.1", "what exists: 0");
  check("joints.thread.drive.speed", "joints.thread.drive.speed", "what exists: 0");
  check("bodies.ground.mass", "bodies.ground", "expected one of table, arm");
  check("gravity", "gravity", "what exists: 0, 1 and 2");
  check("gravity.3", "gravity.3", "what exists: 0, 1 and 2");
  check("simulation.damped", "simulation.damped", "what exists: duration");
}

TEST_CASE("A number that is none is not set") {
  Mechanism m = read_scene(everything);
  CHECK_THROWS_WITH(set_parameter(m, "bodies.table.mass", std::numeric_limits<double>::infinity()),
                    "bodies.table.mass: expected a finite number");
  CHECK_THROWS_AS(set_parameter(m, "gravity.0", std::numeric_limits<double>::quiet_NaN()), SceneError);
  CHECK(m == read_scene(everything));
}
