// The inspector of joints and forces of every kind, used by a robot.
#include "inspector_hand.hpp"

#include "app/document/create.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"

#include <numbers>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("drive, spring, damper and stop are ticked onto a joint") {
  Hand hand;
  hand.choose(PartKind::joint, "slide");
  REQUIRE(hand.joint("slide").coordinates[0].spring);
  hand.one_step([&] { hand.fill("inspector/spring/stiffness", "1.2 N/mm"); });
  CHECK(hand.joint("slide").coordinates[0].spring->stiffness == Approx(1200));
  hand.one_step([&] { hand.fill("inspector/spring/free", "16 cm"); });
  CHECK(hand.joint("slide").coordinates[0].spring->free == Approx(0.16));
  hand.one_step([&] { hand.fill("inspector/damping", "40"); });
  CHECK(hand.joint("slide").coordinates[0].damping == 40);
  hand.one_step([&] { hand.press_widget("inspector/stop"); });
  REQUIRE(hand.joint("slide").coordinates[0].stop);
  CHECK(*hand.joint("slide").coordinates[0].stop->lower == Approx(0.0744 - 0.1));
  CHECK(*hand.joint("slide").coordinates[0].stop->upper == Approx(0.0744 + 0.1));
  hand.one_step([&] { hand.fill("inspector/stop/lower", "50 mm"); });
  CHECK(hand.joint("slide").coordinates[0].stop->lower == Approx(0.05));
  hand.one_step([&] { hand.press_widget("inspector/stop/upper/reset"); });
  CHECK_FALSE(hand.joint("slide").coordinates[0].stop->upper);
  hand.one_step([&] { hand.press_widget("inspector/stop/upper/add"); });
  CHECK(hand.joint("slide").coordinates[0].stop->upper);
  hand.one_step([&] { hand.fill("inspector/coordinate", "0.2 - 0.1256"); });
  CHECK(hand.joint("slide").coordinates[0].drawn == Approx(0.0744));
  CHECK(find_mistakes(hand.mechanism()).empty());

  SECTION("stops of an angle are whole degrees about where it is drawn") {
    hand.choose(PartKind::joint, "arm1");
    hand.one_step([&] { hand.press_widget("inspector/stop"); });
    const Coordinate arm = hand.joint("arm1").coordinates[0];
    CHECK(*arm.stop->lower == Approx(arm.drawn - std::numbers::pi / 6));
    CHECK(*arm.stop->upper == Approx(arm.drawn + std::numbers::pi / 6));
  }
  SECTION("in a mechanism of another size stops of a length are as far in proportion") {
    hand.press_widget("inspector/stop");
    for (const double size : {0.01, 100.}) {
      CAPTURE(size);
      edit(hand.app.session, "Scale", [&](Mechanism& m, Selection&) {
        for (Body& body : m.bodies)
          body.position *= size;
        for (Joint& joint : m.joints)
          joint.at *= size;
      });
      hand.frames(2);
      hand.one_step([&] { hand.press_widget("inspector/stop"); });
      const Stop stop = *hand.joint("slide").coordinates[0].stop;
      CHECK(*stop.upper - *stop.lower == Approx(0.2 * size));
      hand.press_widget("inspector/stop");
      undo(hand.app.session), undo(hand.app.session), undo(hand.app.session);
      hand.frames(2);
    }
  }
  SECTION("a drive is refused beside a spring") {
    hand.press_widget("inspector/drive");
    CHECK_FALSE(hand.joint("slide").coordinates[0].drive);
  }
  SECTION("and taken off again") {
    for (const char* tick : {"inspector/spring", "inspector/stop", "inspector/damper"})
      hand.one_step([&] { hand.press_widget(tick); });
    CHECK(hand.joint("slide").coordinates[0] ==
          Coordinate{.drawn = 0.2 - 0.1256, .spring = {}, .stop = {}, .drive = {}});
    // The pinned slider of the spring is gone with it, or the scene could not be solved.
    CHECK(find_mistakes(hand.mechanism()).empty());
    hand.one_step([&] { hand.press_widget("inspector/drive"); });
    hand.one_step([&] { hand.fill("inspector/drive/speed", "20 mm/s"); });
    CHECK(hand.joint("slide").coordinates[0].drive->speed == 0.02);
    // And now the spring is refused.
    hand.press_widget("inspector/spring");
    CHECK_FALSE(hand.joint("slide").coordinates[0].spring);
  }
}

TEST_CASE("a joint's place, axis, bodies and type are edited") {
  Hand hand;
  hand.choose(PartKind::joint, "arm1");
  hand.one_step([&] { hand.fill("inspector/axis/y", "0.1"); });
  CHECK(hand.joint("arm1").axis == Vec3(0, 0.1, 1));
  hand.one_step([&] { hand.press_widget("inspector/axis/along/x"); });
  CHECK(hand.joint("arm1").axis == Vec3(1, 0, 0));
  hand.one_step([&] { hand.press_widget("inspector/axis/flip"); });
  CHECK(hand.joint("arm1").axis == Vec3(-1, 0, 0));
  hand.one_step([&] { hand.press_widget("inspector/bodies/swap"); });
  CHECK(hand.joint("arm1").bodies == std::array<std::string, 2>{"ball1", "spindle"});
  hand.one_step([&] { hand.choose_from("inspector/bodies/1", "ground"); });
  CHECK(hand.joint("arm1").bodies == std::array<std::string, 2>{"ball1", "ground"});
  // The other end's body: they change places.
  hand.one_step([&] { hand.choose_from("inspector/bodies/1", "ball1"); });
  CHECK(hand.joint("arm1").bodies == std::array<std::string, 2>{"ground", "ball1"});

  hand.choose(PartKind::joint, "slide");
  hand.one_step([&] { hand.choose_from("inspector/type", "cylindrical"); });
  REQUIRE(hand.joint("slide").coordinates.size() == 2);
  CHECK_FALSE(hand.joint("slide").coordinates[0].spring);
  CHECK(hand.joint("slide").coordinates[1].spring->stiffness == 1000);
  CHECK(hand.mechanism().sliders[1].parameter == "joints.slide.spring.1.stiffness");
  CHECK(find_mistakes(hand.mechanism()).empty());
  hand.one_step([&] { hand.press_widget("inspector/drive/0"); });
  CHECK(hand.joint("slide").coordinates[0].drive);
  hand.one_step([&] { hand.fill("inspector/spring/1/stiffness", "2 kN/m"); });
  CHECK(hand.joint("slide").coordinates[1].spring->stiffness == 2000);
}

TEST_CASE("a type changed keeps what fits, in gears and sliders too") {
  Mechanism m;
  m.bodies = {test::body("a"), test::body("b")};
  const std::string one = add_joint(m, JointType::cylindrical, {"ground", "a"}, Vec3::Zero(), Vec3::UnitZ());
  const std::string two = add_joint(m, JointType::revolute, {"ground", "b"}, Vec3::Zero(), Vec3::UnitZ());
  add_gear(m, {one + ".0", two}, 1);
  m.joints[0].coordinates[0].drive.emplace().speed = 3;
  m.joints[0].coordinates[1].damping = 7;
  for (const char* number : {".drive.0.speed", ".damping.1"})
    m.sliders.emplace_back().parameter = "joints." + one + number;
  change_joint_type(m, one, JointType::revolute);
  CHECK(m.joints[0].coordinates.size() == 1);
  CHECK(m.joints[0].coordinates[0].drive->speed == 3);
  CHECK(m.joints[2].joints[0] == one);
  REQUIRE(m.sliders.size() == 1);
  CHECK(m.sliders[0].parameter == "joints." + one + ".drive.speed");
  change_joint_type(m, one, JointType::planar); // x, y, angle
  CHECK(m.joints[0].coordinates[2].drive->speed == 3);
  CHECK(m.joints[2].joints[0] == one + ".2");
  CHECK(m.sliders[0].parameter == "joints." + one + ".drive.2.speed");
  CHECK(m.joints[0].axis.cross(m.joints[0].axis2).norm() > 0.1);
  change_joint_type(m, one, JointType::spherical); // its rotation vector cannot be driven
  for (const Coordinate& coordinate : m.joints[0].coordinates)
    CHECK_FALSE(coordinate.drive);
  CHECK(m.sliders.empty());
  change_joint_type(m, one, JointType::distance);
  CHECK(m.joints[0].coordinates.empty());
}

TEST_CASE("distance joints and gears are edited") {
  Hand hand;
  hand.choose(PartKind::joint, "link1");
  const Joint before = hand.joint("link1");
  hand.one_step([&] { hand.fill("inspector/length", "110 mm"); });
  CHECK(hand.joint("link1").length == Approx(0.11));
  hand.one_step([&] { hand.press_widget("inspector/length/reset"); });
  CHECK_FALSE(hand.joint("link1").length);
  hand.one_step([&] { hand.fill("inspector/points/1/y", "0.12"); });
  CHECK(hand.joint("link1").points[1].y() == 0.12);
  hand.one_step([&] { hand.press_widget("inspector/bodies/swap"); });
  CHECK(hand.joint("link1").bodies[0] == before.bodies[1]);
  CHECK(hand.joint("link1").points[1] == before.points[0]);

  edit(hand.app.session, "Gear", [](Mechanism& m, Selection& s) {
    s.set({PartKind::joint, add_gear(m, {"arm1", "arm2"}, -1)});
  });
  hand.frames(2);
  const std::string gear = hand.app.session.selection().parts.front().name;
  hand.one_step([&] { hand.fill("inspector/ratio", "-1/2"); });
  CHECK(hand.joint(gear.c_str()).ratio == -0.5);
  hand.one_step([&] { hand.choose_from("inspector/joints/1", "spin"); });
  CHECK(hand.joint(gear.c_str()).joints[1] == "spin");
  hand.one_step([&] { hand.fill("inspector/offset", "90 deg"); });
  CHECK(hand.joint(gear.c_str()).offset == Approx(1.5707963267948966));
}

TEST_CASE("two hinges become wheels of a belt, a hinge and a slide pinion and rack or a screw") {
  Hand hand;
  const auto join = [&](std::vector<Part> parts, const char* command) {
    select(hand.app.session, {std::move(parts)});
    hand.frames(2);
    hand.app.commands.run(command);
    hand.frames(2);
    return hand.app.session.selection().parts.front().name;
  };
  const Part arm1{PartKind::joint, "arm1"}, arm2{PartKind::joint, "arm2"}, slide{PartKind::joint, "slide"};
  SECTION("a gear that becomes a belt of its ratio") {
    const std::string gear = join({arm1, arm2}, "insert.gear");
    CHECK(gear == "gear1");
    hand.one_step([&] { hand.fill("inspector/ratio", "-1/2"); });
    hand.one_step([&] { hand.choose_from("inspector/kind", "belt"); });
    CHECK(hand.joint("gear1").kind == GearKind::belt);
    CHECK(hand.joint("gear1").crossed);
    CHECK(gear_ratio(hand.joint("gear1")) == -0.5);
    hand.one_step([&] { hand.fill("inspector/radii/1", "20 mm"); });
    CHECK(hand.joint("gear1").radii[1] == 0.02);
    hand.one_step([&] { hand.press_widget("inspector/crossed"); });
    CHECK(gear_ratio(hand.joint("gear1")) == Approx(1.25));
  }
  SECTION("a rack whose pinion is the one that turns, and the screw of its ratio") {
    CHECK(join({slide, arm1}, "insert.rack") == "rack1");
    CHECK(hand.joint("rack1").joints == std::array<std::string, 2>{"arm1", "slide"});
    hand.one_step([&] { hand.fill("inspector/radius", "-30 mm"); });
    CHECK(hand.joint("rack1").radii[0] == -0.03);
    hand.one_step([&] { hand.choose_from("inspector/kind", "screw"); });
    CHECK(gear_ratio(hand.joint("rack1")) == Approx(-0.03));
    hand.one_step([&] { hand.fill("inspector/lead", "2 mm"); });
    CHECK(hand.joint("rack1").lead == 0.002);
  }
  SECTION("a belt over three wheels, the middle one of one radius") {
    edit(hand.app.session, "Add", [&](Mechanism& m, Selection&) {
      const std::string wheel = add_body(m, {});
      add_joint(m, JointType::revolute, {"ground", wheel}, {1, 0, 0}, {0, 0, 1});
    });
    select(hand.app.session, {{arm1, arm2, {PartKind::joint, "revolute1"}}});
    hand.frames(2);
    hand.app.commands.run("insert.belt");
    hand.frames(2);
    CHECK(hand.last_step() == "Belt of arm1, arm2 and revolute1");
    CHECK(hand.joint("belt1").joints == std::array<std::string, 2>{"arm1", "arm2"});
    CHECK(hand.joint("belt2").joints == std::array<std::string, 2>{"arm2", "revolute1"});
    edit(hand.app.session, "Wheel",
         [](Mechanism& m, Selection&) { set_parameter(m, "parameters.radius", 0.3); });
    CHECK(hand.joint("belt1").radii[1] == 0.3);
    CHECK(hand.joint("belt2").radii[0] == 0.3);
  }
  SECTION("backlash, or why there is none") {
    select(hand.app.session, {{arm1, arm2}});
    hand.frames(2);
    CHECK_FALSE(hand.app.commands.enabled(command("edit.backlash")));
    hand.app.commands.run("insert.gear");
    hand.frames(2);
    REQUIRE(hand.app.commands.enabled(command("edit.backlash")));
    hand.press_widget("inspector/edit.backlash");
    hand.frames(2);
    CHECK(hand.last_step() == "Backlash of gear1");
    CHECK(hand.joint("play1").coordinates[0].stop);
    undo(hand.app.session);
    edit(hand.app.session, "Damp", [](Mechanism& m, Selection& s) {
      for (const char* name : {"arm1", "arm2"})
        m.joints[static_cast<std::size_t>(joint_index(m, name))].coordinates[0].damping = 1;
      s.set({PartKind::joint, "gear1"});
    });
    hand.frames(2);
    hand.app.commands.run("edit.backlash");
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("would act on the rim"));
  }
  SECTION("only what suits them is offered") {
    select(hand.app.session, {{arm1, arm2}});
    CHECK(hand.app.commands.enabled(command("insert.belt")));
    CHECK_FALSE(hand.app.commands.enabled(command("insert.rack")));
    select(hand.app.session, {{slide}});
    CHECK_FALSE(hand.app.commands.enabled(command("insert.gear")));
    CHECK_FALSE(hand.app.commands.enabled(command("insert.screw")));
  }
}

TEST_CASE("a law typed for a stiffness or damping stands in its place, its slider gone") {
  Hand hand;
  hand.click("outline/joints/slide");
  REQUIRE(is_pinned(hand.mechanism(), "joints.slide.spring.stiffness"));
  const auto slide = [&]() -> const Coordinate& { return hand.joint("slide").coordinates[0]; };
  hand.one_step([&] {
    hand.fill("inspector/spring/stiffness",
              "=table(deflection, [-200 mm, -150 N], [0 mm, 0 N], [50 mm, 40 N])");
  });
  CHECK(hand.app.ui.fields.typing.mistake.empty());
  CHECK(slide().spring->force);
  CHECK_FALSE(is_pinned(hand.mechanism(), "joints.slide.spring.stiffness"));
  hand.one_step([&] { hand.fill("inspector/damping", "=40 N*tanh(rate/(0.1 m/s))"); });
  CHECK(slide().damping_force);
  CHECK(hand.app.session.mistakes.empty());
  hand.one_step([&] { hand.fill("inspector/spring/force", "=1500 N/m*deflection"); });
  CHECK(slide().spring->force);
  CHECK(converged(hand.app.session));
}

TEST_CASE("forces of every type are edited") {
  Hand hand;
  // At rest, where what is fixed in the world lets it be: no motion has to be found after every step.
  edit(hand.app.session, "Stop", [](Mechanism& m, Selection&) {
    m.joints[static_cast<std::size_t>(joint_index(m, "spin"))].coordinates[0].drive->speed = 0;
  });
  const auto add = [&](const auto& make) {
    edit(hand.app.session, "Add", [&](Mechanism& m, Selection& s) { s.set({PartKind::force, make(m)}); });
    hand.frames(2);
    return hand.app.session.selection().parts.front().name;
  };
  SECTION("spring") {
    const std::string name = add([](Mechanism& m) {
      return add_spring(m, {"ground", "ball1"}, {Vec3(0, 0, 0), Vec3(-0.16, 0.2, 0)}, 10, 0);
    });
    const auto spring = [&]() -> const Force& { return hand.force(name.c_str()); };
    hand.one_step([&] { hand.fill("inspector/stiffness", "1 kN/m"); });
    CHECK(spring().stiffness == 1000);
    hand.one_step([&] { hand.fill("inspector/free_length", "0.2"); });
    CHECK(spring().free_length == 0.2);
    hand.one_step([&] { hand.press_widget("inspector/free_length/reset"); });
    CHECK_FALSE(spring().free_length);
    hand.one_step([&] { hand.fill("inspector/damping", "3"); });
    CHECK(spring().damping == 3);
    hand.one_step([&] { hand.fill("inspector/points/0/z", "0.1"); });
    CHECK(spring().points[0].z() == 0.1);
    hand.one_step([&] { hand.choose_from("inspector/bodies/0", "spindle"); });
    CHECK(spring().bodies[0] == "spindle");
  }
  SECTION("force") {
    const std::string name = add([](Mechanism& m) {
      return add_force(m, ForceType::force, "ball1", {-0.16, 0.2, 0}, {0, 1, 0});
    });
    const auto force = [&]() -> const Force& { return hand.force(name.c_str()); };
    hand.one_step([&] { hand.fill("inspector/vector/x", "2 kg * 9.81 m/s^2"); });
    CHECK(force().vector == Vec3(19.62, 1, 0));
    hand.one_step([&] { hand.choose_from("inspector/frame", "body"); });
    CHECK(force().frame == ForceFrame::body);
    hand.one_step([&] { hand.choose_from("inspector/body", "collar"); });
    CHECK(force().body == "collar");
    hand.one_step([&] { hand.fill("inspector/at/x", "0.01"); });
    CHECK(force().at->x() == 0.01);
    hand.one_step([&] { hand.press_widget("inspector/at/x/reset"); });
    CHECK_FALSE(force().at);
  }
  SECTION("torque") {
    const std::string name = add([](Mechanism& m) {
      return add_force(m, ForceType::torque, "ball1", {0, 0, 0}, {0, 0, 1});
    });
    hand.one_step([&] { hand.fill("inspector/vector/z", "500 N mm"); });
    CHECK(hand.force(name.c_str()).vector.z() == Approx(0.5));
  }
  SECTION("drag") {
    const std::string name = add([](Mechanism& m) {
      return add_force(m, ForceType::drag, "ball1", {0, 0, 0}, {0, 0, 0});
    });
    hand.one_step([&] { hand.fill("inspector/quadratic", "0.02"); });
    CHECK(hand.force(name.c_str()).quadratic == 0.02);
    hand.one_step([&] { hand.fill("inspector/linear", "0.5"); });
    CHECK(hand.force(name.c_str()).linear == 0.5);
  }
}

TEST_CASE("a vane and the air are edited") {
  Hand hand;
  edit(hand.app.session, "Add", [&](Mechanism& m, Selection& s) {
    s.set({PartKind::force, add_force(m, ForceType::vane, "ball1", {-0.16, 0.2, 0}, {0, 0, 1})});
  });
  hand.frames(2);
  const auto vane = [&]() -> const Force& { return hand.force("vane1"); };
  hand.one_step([&] { hand.fill("inspector/area", "20 cm * 5 cm"); });
  CHECK(vane().area == Approx(0.01));
  hand.one_step([&] { hand.fill("inspector/normal/x", "1"); });
  CHECK(vane().normal == Vec3(1, 0, 1));
  hand.one_step([&] { hand.fill("inspector/cn", "2"); });
  hand.one_step([&] { hand.fill("inspector/cd", "0.1"); });
  CHECK(vane().cn == 2);
  CHECK(vane().cd == 0.1);
  hand.one_step([&] { hand.choose_from("inspector/form", "blade"); });
  REQUIRE(vane().chord);
  hand.one_step([&] { hand.fill("inspector/chord/y", "0.5"); });
  CHECK(vane().chord->y() == 0.5);
  hand.one_step([&] { hand.choose_from("inspector/form", "airfoil"); });
  REQUIRE(vane().lift);
  CHECK(vane().chord->y() == 0.5);
  CHECK(vane().formulas ==
        Formulas{{"drag", "2*sin(incidence)^2 + 0.1"}, {"lift", "2*sin(incidence)*cos(incidence)"}});
  CHECK(find_mistakes(hand.mechanism()).empty());
  hand.one_step([&] { hand.fill("inspector/lift", "=1.1*sin(2*incidence)"); });
  CHECK(vane().formulas[1].text == "1.1*sin(2*incidence)");
  hand.one_step([&] { hand.fill("inspector/drag", "0.3"); });
  CHECK(vane().drag == 0.3);
  CHECK(vane().formulas.size() == 1);
  hand.one_step([&] { hand.choose_from("inspector/form", "blade"); });
  CHECK_FALSE(vane().lift);
  CHECK_FALSE(vane().drag);
  CHECK(vane().formulas.empty());
  CHECK(vane().cn == 2);
  hand.one_step([&] { hand.choose_from("inspector/form", "plate"); });
  CHECK_FALSE(vane().chord);
  select(hand.app.session, {});
  hand.frames(2);
  hand.one_step([&] { hand.fill("inspector/wind/x", "3 km/h"); });
  CHECK(hand.mechanism().air.wind.x() == Approx(3 / 3.6));
  hand.one_step([&] { hand.choose_from("inspector/turns_with", "spindle"); });
  CHECK(hand.mechanism().air.turns_with == "spindle");
  CHECK(hand.mechanism().air.wind.isZero(0));
}

TEST_CASE("a bearing is edited: bodies, axes, matrices of two rows or six, with their units") {
  Hand hand;
  edit(hand.app.session, "Add", [&](Mechanism& m, Selection& s) {
    s.set({PartKind::force, add_bearing(m, {"ground", "collar"}, {0, 0.1, 0}, {0, 1, 0})});
  });
  hand.frames(2);
  const auto bearing = [&]() -> const Force& { return hand.force("bearing1"); };
  hand.one_step([&] { hand.fill("inspector/stiffness/0/1", "2 kN/mm"); });
  CHECK(bearing().bearing_stiffness == BearingMatrix{1e6, 2e6, 0, 1e6});
  hand.one_step([&] { hand.fill("inspector/x_axis/z", "0.5"); });
  REQUIRE(bearing().x_axis);
  CHECK(*bearing().x_axis == Vec3(1, 0, 0.5));
  hand.one_step([&] { hand.press_widget("inspector/x_axis/x/reset"); });
  CHECK_FALSE(bearing().x_axis);
  hand.one_step([&] { hand.fill("inspector/at/y", "120 mm"); });
  CHECK(*bearing().at == Vec3(0, 0.12, 0));
  hand.one_step([&] { hand.choose_from("inspector/bodies/0", "spindle"); });
  CHECK(bearing().bodies == std::array<std::string, 2>{"spindle", "collar"});
  hand.one_step([&] { hand.choose_from("inspector/rows", "6 rows"); });
  REQUIRE(bearing().bearing_stiffness.size() == 36);
  REQUIRE(bearing().bearing_damping.size() == 36);
  CHECK(bearing().bearing_stiffness[1] == 2e6);
  CHECK(bearing().bearing_damping[7] == 1000);
  CHECK(hand.app.session.mistakes.empty());
  hand.one_step([&] { hand.fill("inspector/stiffness/5/5", "3 N m/deg"); });
  CHECK(bearing().bearing_stiffness[35] == Approx(3 * 180 / std::numbers::pi));
  hand.one_step([&] { hand.choose_from("inspector/rows", "2 rows"); });
  CHECK(bearing().bearing_stiffness == BearingMatrix{1e6, 2e6, 0, 1e6});
  hand.one_step([&] { hand.press_widget("inspector/damping"); });
  CHECK(bearing().bearing_damping.empty());
  undo(hand.app.session);
  CHECK(bearing().bearing_damping.size() == 4);
}

namespace {

// Three shoes that slide out from a drum, of which only the first two have springs, as stiff as one another.
Mechanism three_shoes() {
  Mechanism m;
  m.name = "Shoes";
  m.bodies = {body("drum", 1)};
  m.joints = {driven(revolute("turn", "ground", "drum", {0, 0, 0}, {0, 0, 1}), 60)};
  for (const char* shoe : {"a", "b", "c"}) {
    m.bodies.push_back(body(shoe, 0.1));
    m.joints.push_back(prismatic(std::string("slide_") + shoe, "drum", shoe, {0.04, 0, 0}, {1, 0, 0}));
  }
  m.joints[1] = sprung(m.joints[1], 1000, 0.01);
  m.joints[2] = sprung(m.joints[2], 1000, 0.02);
  return m;
}

} // namespace

TEST_CASE("several joints are edited as one, with a word where they differ") {
  Hand hand;
  open_document(hand.app.session, Document(three_shoes()));
  hand.frames(2);
  const auto pick = [&](std::initializer_list<const char*> names) {
    Selection chosen;
    for (const char* name : names)
      chosen.add({PartKind::joint, name});
    select(hand.app.session, chosen);
    hand.frames(2);
  };
  const auto of = [&](const char* name) -> const Coordinate& { return hand.joint(name).coordinates[0]; };

  pick({"slide_a", "slide_b"});
  CHECK_FALSE(hand.app.ui.widgets.contains("inspector/name"));
  CHECK_FALSE(hand.app.ui.widgets.contains("inspector/move"));
  hand.one_step([&] { hand.fill("inspector/spring/stiffness", "2 N/mm"); });
  CHECK(hand.last_step() == "Set stiffness of slide_b, and 1 more");
  CHECK(of("slide_a").spring->stiffness == 2000);
  CHECK(of("slide_b").spring->stiffness == 2000);
  CHECK(of("slide_a").spring->free == 0.01);
  CHECK(of("slide_b").spring->free == 0.02);

  SECTION("what their drives prescribe is lit where it is the same") {
    const auto lit = [&] {
      std::string names;
      for (const KeyStop& stop : hand.app.ui.widgets.stops)
        if (stop.chosen && stop.name.starts_with("inspector/drive/prescribes/"))
          names += stop.name.substr(stop.name.rfind('/') + 1);
      return names;
    };
    hand.one_step([&] { hand.press_widget("inspector/spring"); });
    hand.one_step([&] { hand.press_widget("inspector/drive"); });
    CHECK(lit() == "speed");
    pick({"slide_a"});
    hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/torque"); });
    pick({"slide_a", "slide_b"});
    CHECK(lit().empty());
    hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/momentum"); });
    CHECK(lit() == "momentum");
    for (const char* name : {"slide_a", "slide_b"})
      CHECK(*of(name).drive == Drive{.speed = 0.1, .keeps = DriveKeeps::momentum});
  }
  SECTION("a field of various numbers is empty, and left so changes nothing") {
    hand.press_widget("inspector/spring/free");
    CHECK(hand.app.ui.fields.typing.text.empty());
    hand.key(key_escape);
    CHECK(of("slide_a").spring->free == 0.01);
    hand.one_step([&] { hand.fill("inspector/spring/free", "=0.03 m"); });
    CHECK(of("slide_a").spring->free == 0.03);
    CHECK(of("slide_b").spring->free == 0.03);
    CHECK(hand.joint("slide_a").formulas == hand.joint("slide_b").formulas);
    hand.one_step([&] { hand.fill("inspector/spring/free", "4 mm"); });
    CHECK(of("slide_a").spring->free == 0.004);
    CHECK(hand.joint("slide_a").formulas.empty());
    CHECK(hand.joint("slide_b").formulas.empty());
  }
  SECTION("a number that is named is one parameter of them all") {
    hand.reveal("inspector/spring/stiffness");
    hand.click(hand.widget("inspector/spring/stiffness").center(), 1);
    hand.one_step([&] { hand.click("inspector/spring/stiffness/name it"); });
    REQUIRE(hand.mechanism().parameters.size() == 1);
    hand.one_step(
        [&] { set_number(hand.app.session, "parameters." + hand.mechanism().parameters[0].name, 500); });
    CHECK(of("slide_a").spring->stiffness == 500);
    CHECK(of("slide_b").spring->stiffness == 500);
  }
  SECTION("what some have is given to all, what all have is taken off them") {
    pick({"slide_a", "slide_b", "slide_c"});
    CHECK_FALSE(hand.app.ui.widgets.contains("inspector/spring/stiffness"));
    hand.one_step([&] { hand.press_widget("inspector/spring"); });
    REQUIRE(of("slide_c").spring);
    CHECK(of("slide_a").spring->stiffness == 2000); // which had one
    hand.one_step([&] { hand.fill("inspector/spring/stiffness", "300"); });
    hand.one_step([&] { hand.press_widget("inspector/friction"); });
    hand.one_step([&] { hand.fill("inspector/friction/limit", "2"); });
    hand.one_step([&] { hand.press_widget("inspector/stop"); });
    hand.one_step([&] { hand.fill("inspector/stop/upper", "12 mm"); });
    for (const char* name : {"slide_a", "slide_b", "slide_c"}) {
      CHECK(of(name).spring->stiffness == 300);
      CHECK(of(name).friction->limit == 2.);
      CHECK(of(name).stop->upper == 0.012);
    }
    hand.one_step([&] { hand.press_widget("inspector/spring"); });
    for (const char* name : {"slide_a", "slide_b", "slide_c"})
      CHECK_FALSE(of(name).spring);
    hand.press_widget("inspector/drive"); // not beside a stop
    CHECK_FALSE(of("slide_a").drive);
    hand.one_step([&] { hand.choose_from("inspector/type", "cylindrical"); });
    CHECK(hand.joint("slide_a").type == JointType::cylindrical);
    CHECK(hand.joint("slide_c").type == JointType::cylindrical);
  }
  SECTION("of various types those of the last one picked are edited") {
    pick({"slide_a", "turn", "slide_b"});
    hand.one_step([&] { hand.fill("inspector/spring/stiffness", "7"); });
    CHECK(of("slide_a").spring->stiffness == 7);
    CHECK(of("slide_b").spring->stiffness == 7);
    CHECK_FALSE(of("turn").spring);
    pick({"slide_a", "turn"});
    CHECK_FALSE(hand.app.ui.widgets.contains("inspector/drive"));
  }
  SECTION("of one alone, nothing is of others afterwards") {
    pick({"slide_a"});
    hand.one_step([&] { hand.fill("inspector/spring/stiffness", "5"); });
    CHECK(of("slide_b").spring->stiffness == 2000);
  }
}

TEST_CASE("several springs and bodies have their numbers together") {
  Hand hand;
  Mechanism m = three_shoes();
  for (const char* shoe : {"a", "b"})
    m.forces.push_back(
        point_spring(std::string("spring_") + shoe, "drum", shoe, {0, 0, 0}, {0.04, 0, 0}, 100));
  for (const char* shoe : {"a", "b"}) {
    Shape ball;
    ball.type = ShapeType::sphere;
    ball.radius = 0.01;
    m.bodies[static_cast<std::size_t>(body_index(m, shoe))].shapes = {ball};
  }
  open_document(hand.app.session, Document(m));
  hand.frames(2);
  select(hand.app.session, {{{PartKind::force, "spring_a"}, {PartKind::force, "spring_b"}}});
  hand.frames(2);
  hand.one_step([&] { hand.fill("inspector/damping", "3"); });
  CHECK(hand.force("spring_a").damping == 3);
  CHECK(hand.force("spring_b").damping == 3);
  hand.one_step([&] { hand.choose_from("inspector/bodies/1", "c"); });
  CHECK(hand.force("spring_a").bodies[1] == "c");
  CHECK(hand.force("spring_b").bodies[1] == "c");

  select(hand.app.session, {{{PartKind::body, "a"}, {PartKind::body, "b"}}});
  hand.frames(2);
  hand.one_step([&] { hand.fill("inspector/shapes/0/radius", "20 mm"); });
  CHECK(hand.body("a").shapes[0].radius == 0.02);
  CHECK(hand.body("b").shapes[0].radius == 0.02);
  hand.one_step([&] { hand.press_widget("inspector/by density"); });
  CHECK(hand.body("a").density);
  CHECK(hand.body("b").density);
}
