// A shaft in elastic bearings, from an empty document to a rotor that turns in them.
#include "drawing.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/state_words.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/edit_commands.hpp"
#include "tests/catch.hpp"
#include "tests/support/solutions.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

struct ShaftInBearings : Drawing {
  ShaftInBearings() : Drawing({1280, 900}) {
    have_rod({-0.3, 0, 0}, {0.3, 0, 0});
    for (const double end : {-0.3, 0.3}) {
      choose_nothing();
      key('J', false, true);
      click_at({end, 0, 0});
      frames(2);
      key(key_enter);
    }
    choose_nothing();
    frames(3);
  }
  const Solution& solution() const { return app.session.answer.solution; }
  bool offers() const { return app.ui.widgets.contains("results/remedy/drive/rod1"); }
  const Joint* joint(const std::string& name) const {
    const int j = joint_index(m(), name);
    return j < 0 ? nullptr : &m().joints[static_cast<std::size_t>(j)];
  }
};

} // namespace

TEST_CASE("a shaft that two bearings hold is given a drive by a button, in one step") {
  ShaftInBearings d;
  REQUIRE(d.m().forces.size() == 2);
  REQUIRE(d.solution().status == Status::converged);
  CHECK(d.solution().neutral == std::vector<std::string>{"rod1.free"});
  REQUIRE(d.offers());
  const Mechanism before = d.m();
  const std::size_t steps = d.steps();
  SECTION("in the results") {
    d.click("results/remedy/drive/rod1");
  }
  SECTION("in the inspector of the body or a bearing") {
    select(d.app.session, {{GENERATE(body_part("rod1"), Part{PartKind::force, "bearing1"})}});
    d.app.sizes.inspector_share = 0.95f;
    d.frames(2);
    d.click("inspector/edit.bearing_drive");
  }
  SECTION("by the command, with the body selected") {
    select(d.app.session, {{body_part("rod1")}});
    REQUIRE(d.app.commands.enabled(command("edit.bearing_drive")));
    d.app.commands.run(command("edit.bearing_drive"));
  }
  SECTION("by the command, with a bearing selected") {
    select(d.app.session, {{{PartKind::force, "bearing2"}}});
    REQUIRE(d.app.commands.enabled(command("edit.bearing_drive")));
    d.app.commands.run(command("edit.bearing_drive"));
  }
  d.frames(3);
  CHECK(d.steps() == steps + 1);
  REQUIRE(d.joint("spin1"));
  CHECK(d.joint("spin1")->coordinates[0].drive->speed == 10);
  CHECK(d.app.session.selection().parts == std::vector{Part{PartKind::joint, "spin1"}});
  REQUIRE(d.m().sliders.size() == 1);
  CHECK(d.m().sliders[0].parameter == "joints.spin1.drive.speed");
  CHECK(d.m().sliders[0].to > 10);
  REQUIRE(d.solution().status == Status::converged);
  CHECK(d.solution().stable == true);
  const double mass = d.m().bodies[0].mass;
  CHECK(value(d.solution(), "up1") == Approx(-mass * d.m().gravity.norm() / 2e6).epsilon(1e-9));
  CHECK_FALSE(d.offers());
  d.app.session.notice.clear();
  undo(d.app.session);
  d.frames(2);
  CHECK(d.m() == before);
}

TEST_CASE("a hinge beside bearings is said to make them idle, and put into their sleeve") {
  ShaftInBearings d;
  ++d.app.session.gesture;
  edit(d.app.session, "Join", [](Mechanism& next, Selection&) {
    add_joint(next, JointType::revolute, {"ground", "rod1"}, {0, 0, 0}, Vec3::UnitX());
    next.joints[0].coordinates[0].drive.emplace().speed = 50;
  });
  d.frames(3);
  REQUIRE(d.offers());
  const std::size_t steps = d.steps();
  d.click("results/remedy/drive/rod1");
  d.frames(3);
  CHECK(d.steps() == steps + 1);
  CHECK(d.joint("revolute1")->bodies == std::array<std::string, 2>{"sleeve1", "rod1"});
  CHECK(d.joint("revolute1")->coordinates[0].drive->speed == 50);
  CHECK(d.solution().status == Status::converged);
  CHECK(value(d.solution(), "up1") < 0);
  CHECK_FALSE(d.offers());
}

TEST_CASE("what cannot be driven in its bearings is told so") {
  ShaftInBearings d;
  ++d.app.session.gesture;
  edit(d.app.session, "Turn", [](Mechanism& next, Selection&) { next.forces[1].axis = Vec3::UnitY(); });
  d.frames(3);
  CHECK_FALSE(d.offers());
  drive_in_bearings(d.app.session, "rod1");
  CHECK_THAT(d.app.session.notice, ContainsSubstring("not on one axis"));
}

TEST_CASE("coordinates are told in words") {
  Solution solution;
  solution.message = "Nothing resists rotor.free and slide; their values are arbitrary.";
  solution.coordinates.resize(2);
  solution.coordinates[0].joint = "rotor.free";
  solution.coordinates[1].joint = "slide";
  CHECK(window_message(solution) == "Nothing resists rotor and slide; their values are arbitrary.");

  CHECK(coordinate_words("slide", 0, 1, false) == "slide");
  CHECK(coordinate_words("rotor.free", 0, 6, false) == "rotor, shift x");
  CHECK(coordinate_words("rotor.free", 5, 6, true) == "rotor, rotation z");
  CHECK(coordinate_words("ball", 1, 3, true) == "ball, rotation y");
  CHECK(coordinate_words("plane", 1, 3, false) == "plane, shift y");
  CHECK(coordinate_words("tilt", 0, 2, true) == "tilt, angle");
  CHECK(coordinate_words("tilt", 1, 2, true) == "tilt, angle at the child");
  CHECK(coordinate_words("tube", 1, 2, false) == "tube, slide");
  CHECK(joint_words("rotor.free") == "rotor");

  Mechanism mechanism;
  mechanism.bodies.emplace_back().name = "rotor";
  mechanism.joints.resize(2);
  mechanism.joints[0].name = "tilt";
  mechanism.joints[0].type = JointType::universal;
  mechanism.joints[1].name = "slide";
  mechanism.joints[1].type = JointType::prismatic;
  CHECK(label_words(mechanism, "tilt.1") == "tilt, angle at the child");
  CHECK(label_words(mechanism, "tilt.0.speed") == "speed of tilt, angle");
  CHECK(label_words(mechanism, "slide") == "slide");
  CHECK(label_words(mechanism, "rotor.free.5") == "rotor, rotation z");
  CHECK(label_words(mechanism, "elsewhere.2") == "elsewhere.2");
  CHECK(joint_words("free1") == "free1");
}
