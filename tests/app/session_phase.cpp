// The time that the picture is shown at, through changes of the drives' speeds.
#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <string>

using namespace flyball;
using namespace flyball::test;

namespace {

struct PhaseSession : Session {
  explicit PhaseSession(const char* scene) : Session({.mode = LiveSolver::Mode::immediate}) {
    open_scene(*this, shipped_file(scene));
    frames();
    playback.time = 1.25;
    moved_time = true;
    frames();
  }
  void frames() {
    for (int i = 0; i < 3; ++i)
      update(*this, 0);
  }
  // A step of a slider.
  void slide(const std::string& address, double value) {
    ++gesture;
    change_parameter(*this, address, value);
    frames();
  }
};

NamedParameter named(const char* name, double value) {
  NamedParameter parameter;
  parameter.name = name;
  parameter.value = value;
  return parameter;
}

} // namespace

TEST_CASE("Session: the drive's phase stays as a named parameter changes its speed") {
  PhaseSession session("horizontal_rotor"); // "speed": "=n"
  REQUIRE(session.poses.size() == 3);
  const Quat disc = session.poses[2].rotation;
  session.slide("parameters.n", 30.5);
  CHECK(session.playback.time == Approx(1.25 * 30 / 30.5).epsilon(1e-15));
  REQUIRE(session.poses.size() == 3);
  CHECK(session.poses[2].rotation.angularDistance(disc) < 1e-6);
  undo(session);
  session.frames();
  CHECK(session.playback.time == Approx(1.25).epsilon(1e-15));
  // What sets no speed moves no time.
  session.slide("parameters.e", 0.005);
  CHECK(session.playback.time == Approx(1.25).epsilon(1e-15));
}

TEST_CASE("Session: a parameter that is called speed is none of a drive") {
  PhaseSession session("governor");
  edit(session, "Wind", [](Mechanism& m, Selection&) { m.parameters.push_back(named("speed", 3)); });
  session.slide("parameters.speed", 4);
  CHECK(session.playback.time == 1.25);
  CHECK(get_parameter(session.mechanism(), "parameters.speed") == 4);
  session.slide("joints.spin.drive.speed", 2 * get_parameter(session.mechanism(), "joints.spin.drive.speed"));
  CHECK(session.playback.time == 1.25 / 2);
}

TEST_CASE("Session: where a drive gives a torque the speed its search begins at moves no time") {
  PhaseSession session("governor_engine");
  session.slide("joints.spin.drive.speed", 12);
  CHECK(session.playback.time == 1.25);
}

TEST_CASE("Session: several drives keep their phases where all speeds change alike") {
  PhaseSession session("rate_gyro");
  session.slide("joints.spin.drive.speed", 400);
  CHECK(session.playback.time == 1.25);
  change_parameters(session, "Half", {{"joints.spin.drive.speed", 200}, {"joints.turn.drive.speed", 0.25}});
  CHECK(session.playback.time == 2.5);
}

TEST_CASE("Session: a refused speed leaves the time as it was") {
  PhaseSession session("horizontal_rotor");
  edit(session, "Inverse", [](Mechanism& m, Selection&) {
    m.parameters.push_back(named("inverse", 0));
    m.parameters.back().formulas = {{"value", "1 rad/s / n"}};
  });
  session.slide("parameters.n", 0);
  CHECK(get_parameter(session.mechanism(), "parameters.n") == 30);
  CHECK(is_error(session));
  CHECK(session.playback.time == 1.25);
}
