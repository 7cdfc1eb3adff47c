// The inspector of bodies and of the scene, fields, and pinned sliders, used by a robot.
#include "inspector_hand.hpp"

#include "app/document/create.hpp"
#include "app/session/quantity.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/mass_properties.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cctype>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a body's numbers are typed, each a step") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  hand.one_step([&] { hand.fill("inspector/mass", "1500 g"); });
  CHECK(hand.body("ball1").mass == 1.5);
  CHECK(hand.last_step() == "Set mass of ball1");
  hand.one_step([&] { hand.fill("inspector/inertia/yy", "0.3*0.5"); });
  CHECK(hand.body("ball1").inertia[1] == 0.15);
  hand.press_widget("inspector/products");
  hand.one_step([&] { hand.fill("inspector/inertia/xy", "1e-3"); });
  CHECK(hand.body("ball1").inertia[3] == 1e-3);
  hand.one_step([&] { hand.fill("inspector/description", "the heavy one"); });
  CHECK(hand.body("ball1").description == "the heavy one");

  SECTION("a position takes along what is on the body") {
    const Vec3 end = hand.joint("link1").points[0];
    hand.one_step([&] { hand.fill("inspector/position/y", "0.21 m"); });
    CHECK(hand.body("ball1").position.y() == 0.21);
    CHECK(hand.joint("link1").points[0].y() == Approx(end.y() + 0.01));
  }
  SECTION("unless the mass centre is to move alone") {
    const Vec3 end = hand.joint("link1").points[0];
    hand.press_widget("inspector/mass alone");
    hand.one_step([&] { hand.fill("inspector/position/y", "21 cm"); });
    CHECK(hand.body("ball1").position.y() == Approx(0.21));
    CHECK(hand.joint("link1").points[0] == end);
  }
  SECTION("a rotation is typed in degrees and stays as typed") {
    hand.press_widget("inspector/rotation section");
    hand.fill("inspector/rotation/z", "270");
    CHECK(hand.app.panels->inspector.state().turns.z() == 270);
    const Vec3 x = hand.body("ball1").rotation * Vec3::UnitX();
    CHECK((x + Vec3::UnitY()).norm() < 1e-14);
    hand.fill("inspector/rotation/x", "pi/2 rad");
    CHECK(hand.app.panels->inspector.state().turns == Vec3(90, 0, 270));
    hand.one_step([&] { hand.fill("inspector/rotation/y", "1"); });
    CHECK(find_mistakes(hand.mechanism()).empty());
  }
}

TEST_CASE("mass and inertia follow the size of a uniform solid until they are typed") {
  Hand hand;
  hand.one_step([&] {
    edit(hand.app.session, "Add", [](Mechanism& mechanism, Selection& selection) {
      selection.set({PartKind::body, add_body(mechanism, {.form = BodyForm::ball, .at = {1, 0, 0}})});
    });
    hand.frames(2);
  });
  const std::string name = hand.app.session.selection().parts.front().name;
  const auto ball = [&]() -> const Body& { return hand.body(name.c_str()); };
  REQUIRE(is_uniform_solid(ball()));
  const double mass = ball().mass, inertia = ball().inertia[0];
  hand.one_step([&] { hand.fill("inspector/shapes/0/radius", "0.1"); });
  CHECK(ball().mass == Approx(8 * mass));
  CHECK(ball().inertia[0] == Approx(32 * inertia));
  hand.one_step([&] { hand.fill("inspector/density", "1 g/cm^3"); });
  CHECK(density_of(ball()) == Approx(1000));
  hand.one_step([&] { hand.fill("inspector/mass", "2"); });
  CHECK(ball().mass == 2);
  CHECK(ball().inertia[0] == Approx(0.4 * 2 * 0.01));
  CHECK(is_uniform_solid(ball()));

  SECTION("a mass of zero takes the inertia, and any other brings it back") {
    hand.fill("inspector/mass", "0");
    CHECK(ball().inertia[0] == 0);
    hand.fill("inspector/mass", "3");
    CHECK(ball().mass == 3);
    CHECK(ball().inertia[0] == Approx(0.4 * 3 * 0.01));
    hand.fill("inspector/density", "0");
    CHECK(ball().mass == 0);
    hand.fill("inspector/density", "1 g/cm^3");
    CHECK(is_uniform_solid(ball()));
    CHECK(ball().inertia[2] > 0);
  }
  SECTION("a point stays one") {
    for (const char* axis : {"xx", "yy", "zz"})
      hand.fill(std::string("inspector/inertia/") + axis, "0");
    for (const char* given : {"0", "3"})
      hand.fill("inspector/mass", given);
    CHECK(ball().mass == 3);
    CHECK(ball().inertia == std::array<double, 6>{});
  }
  SECTION("typed inertia is kept when the mass changes") {
    hand.fill("inspector/inertia/xx", "0.1");
    hand.fill("inspector/mass", "4");
    CHECK(ball().inertia[0] == 0.1);
    CHECK(ball().inertia[1] == Approx(0.4 * 2 * 0.01));
    // And a tick makes it a solid again.
    hand.one_step([&] { hand.press_widget("inspector/uniform"); });
    CHECK(ball().inertia[0] == Approx(0.4 * 4 * 0.01));
  }
  SECTION("the tick taken away, the size changes alone") {
    hand.press_widget("inspector/uniform");
    hand.one_step([&] { hand.fill("inspector/shapes/0/radius", "0.2"); });
    CHECK(ball().mass == Approx(2));
  }
  SECTION("shapes are changed, coloured, added and taken away") {
    hand.one_step([&] { hand.choose_from("inspector/shapes/0/type", "box"); });
    CHECK(ball().shapes[0].type == ShapeType::box);
    CHECK(ball().shapes[0].size == Vec3(0.2, 0.2, 0.2));
    CHECK(ball().mass == 2); // as typed; the density follows
    hand.one_step([&] { hand.fill("inspector/shapes/0/size/y", "0.4"); });
    CHECK(ball().shapes[0].size.y() == 0.4);
    hand.one_step([&] { hand.choose_from("inspector/shapes/0/type", "cylinder"); });
    CHECK((ball().shapes[0].to - ball().shapes[0].from).norm() == Approx(0.4));
    // A disc about z by two numbers and a letter, where it is.
    const Vec3 middle = (ball().shapes[0].from + ball().shapes[0].to) / 2;
    hand.one_step([&] { hand.fill("inspector/shapes/0/length", "0.05"); });
    hand.one_step([&] { hand.press_widget("inspector/shapes/0/along/z"); });
    hand.one_step([&] { hand.fill("inspector/shapes/0/radius", "0.3"); });
    CHECK(ball().shapes[0].radius == 0.3);
    CHECK((ball().shapes[0].from - middle + Vec3(0, 0, 0.025)).norm() < 1e-15);
    CHECK((ball().shapes[0].to - middle - Vec3(0, 0, 0.025)).norm() < 1e-15);
    hand.one_step([&] { hand.press_widget("inspector/shapes/0/color/2"); });
    REQUIRE(ball().shapes[0].color);
    CHECK((*ball().shapes[0].color)[1] == Approx(158 / 255.0)); // Okabe and Ito's green
    hand.one_step([&] { hand.press_widget("inspector/shapes/add"); });
    CHECK(ball().shapes.size() == 2);
    hand.one_step([&] { hand.press_widget("inspector/shapes/0/remove"); });
    CHECK(ball().shapes.size() == 1);
    CHECK(ball().shapes[0].type == ShapeType::sphere);
  }
}

TEST_CASE("why a name cannot be taken is a sentence, as of a number") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  for (const char* name : {"ball2", "ground", "a.b", " "}) {
    hand.fill("inspector/name", name);
    const std::string why = hand.app.ui.fields.typing.mistake;
    CAPTURE(name, why);
    REQUIRE_FALSE(why.empty());
    CHECK(std::isupper(static_cast<unsigned char>(why.front())));
    CHECK(why.back() == '.');
    hand.click("inspector/title");
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("was not taken. " + why));
  }
}

TEST_CASE("what cannot be taken stays in the field and says why") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  const std::size_t steps = hand.app.session.document.steps().size();
  hand.fill("inspector/mass", "12 m");
  CHECK(hand.app.ui.fields.typing.name == "inspector/mass");
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("Expected a mass"));
  hand.frames(3);

  SECTION("Escape puts the old back") {
    hand.key(key_escape);
    CHECK(hand.app.ui.fields.typing.name.empty());
    CHECK_FALSE(hand.app.session.selection().empty());
  }
  SECTION("so does leaving, with a word") {
    hand.click("inspector/title");
    CHECK(hand.app.ui.fields.typing.name.empty());
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("“12 m” was not taken"));
  }
  SECTION("it can be mended at once") {
    hand.key('A', true);
    hand.type("12 kg");
    hand.key(key_enter);
    CHECK(hand.body("ball1").mass == 12);
    return;
  }
  CHECK(hand.body("ball1").mass == 1);
  CHECK(hand.app.session.document.steps().size() == steps);
  hand.fill("inspector/mass", "-1");
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("zero or more"));
}

TEST_CASE("looking into a field changes nothing, and leaving takes what was typed") {
  Hand hand;
  hand.choose(PartKind::joint, "spin");
  edit(hand.app.session, "Third",
       [](Mechanism& m, Selection&) { set_parameter(m, "joints.spin.at.0", 1.0 / 3); });
  hand.frames(1);
  const std::size_t steps = hand.app.session.document.steps().size();
  hand.press_widget("inspector/at/x");
  hand.press_widget("inspector/title");
  CHECK(hand.joint("spin").at.x() == 1.0 / 3);
  CHECK(hand.app.session.document.steps().size() == steps);

  SECTION("to another field") {
    hand.press_widget("inspector/at/x");
    hand.type("0.5");
    hand.press_widget("inspector/at/z");
    CHECK(hand.joint("spin").at.x() == 0.5);
  }
  SECTION("by Tab, to the next field") {
    hand.press_widget("inspector/at/x");
    hand.type("0.5");
    hand.key(key_tab);
    CHECK(hand.joint("spin").at.x() == 0.5);
    CHECK(hand.app.ui.fields.typing.name == "inspector/at/y");
    hand.type("0.6");
    hand.key(key_tab, false, true);
    CHECK(hand.joint("spin").at.y() == 0.6);
    CHECK(hand.app.ui.fields.typing.name == "inspector/at/x");
    CHECK(hand.app.session.mode == Mode::build); // where Tab is a shortcut otherwise
  }
  SECTION("to another part, of which the field is not the one typed in") {
    hand.press_widget("inspector/at/x");
    hand.type("0.5");
    hand.click("outline/joints/slide");
    hand.frames(3);
    CHECK(hand.joint("spin").at.x() == 0.5);
    CHECK(hand.joint("slide").at.x() == 0);
    CHECK(hand.app.session.selection().has({PartKind::joint, "slide"}));
  }
}

TEST_CASE("a command of files takes what is being typed and runs") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  hand.press_widget("inspector/mass");
  hand.type("2.5");
  SECTION("which is right") {
    hand.key('O', true);
    hand.frames(3);
    CHECK(hand.body("ball1").mass == 2.5);
    CHECK(hand.app.ui.fields.typing.name.empty());
    CHECK((hand.app.dialog.showing || hand.app.dialog.wanted != Dialog::none));
  }
  SECTION("unless that is wrong, which is said") {
    hand.type(" m");
    hand.frames(2);
    hand.key('O', true);
    hand.frames(3);
    CHECK(hand.body("ball1").mass == 1);
    CHECK_FALSE(hand.app.dialog.showing);
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("was not taken"));
  }
}

TEST_CASE("a command of files takes what is being typed in a note, too, before it runs") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  hand.press_widget("inspector/description");
  hand.type("cast");
  hand.key('N', true);
  hand.frames(3);
  CHECK((hand.app.dialog.showing || hand.app.dialog.wanted == Dialog::unsaved)); // there is work to lose
  REQUIRE(hand.mechanism().bodies.size() > 1);
  CHECK(hand.body("ball1").description == "cast");
}

TEST_CASE("a number is dragged by its label and stepped by the arrow keys") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  hand.reveal("inspector/mass/label");
  hand.one_step([&] { hand.drag("inspector/mass/label", {0.2f, 0.5f}, {0.8f, 0.5f}); });
  CHECK(hand.body("ball1").mass > 1);
  // Not below what it may be.
  for (int i = 0; i < 12; ++i)
    hand.drag("inspector/mass/label", {1.0f, 0.5f}, {-9.0f, 0.5f});
  CHECK(hand.body("ball1").mass >= 0);

  hand.fill("inspector/mass", "2");
  hand.press_widget("inspector/mass");
  hand.one_step([&] { hand.key(key_up); });
  CHECK(hand.body("ball1").mass == 2.01);
  CHECK(hand.app.ui.fields.typing.text == "2.01 kg");
}

TEST_CASE("the scene's own numbers are there while nothing is selected") {
  Hand hand;
  REQUIRE(hand.app.session.selection().empty());
  hand.one_step([&] { hand.press_widget("inspector/gravity/none"); });
  CHECK(hand.mechanism().gravity == Vec3::Zero());
  hand.one_step([&] { hand.press_widget("inspector/gravity/-z"); });
  CHECK(hand.mechanism().gravity == Vec3(0, 0, -9.80665));
  hand.one_step([&] { hand.fill("inspector/gravity/z", "-1.62 m/s^2"); });
  CHECK(hand.mechanism().gravity.z() == -1.62);
  hand.one_step([&] { hand.fill("inspector/name", "On the moon"); });
  CHECK(hand.mechanism().name == "On the moon");
  hand.press_widget("inspector/simulation section");
  hand.one_step([&] { hand.fill("inspector/duration", "2 min"); });
  CHECK(hand.mechanism().simulation.duration == 120);
  hand.one_step([&] { hand.press_widget("inspector/damped"); });
  CHECK_FALSE(hand.mechanism().simulation.damped);
}

TEST_CASE("several parts are given one number") {
  Hand hand;
  hand.click("outline/bodies/ball1");
  hand.hold(true, false);
  hand.click("outline/bodies/ball2");
  hand.hold(false, false);
  hand.frames(3);
  REQUIRE(hand.app.session.selection().parts.size() == 2);
  hand.one_step([&] { hand.fill("inspector/mass", "3"); });
  CHECK(hand.body("ball1").mass == 3);
  CHECK(hand.body("ball2").mass == 3);
  CHECK(hand.body("spindle").mass == 200);
  hand.one_step([&] { hand.press_widget("inspector/edit.delete"); });
  CHECK(body_index(hand.mechanism(), "ball1") < 0);
}

TEST_CASE("numbers are pinned as sliders with a range, and taken off again") {
  Hand hand;
  const std::string address = "bodies.ball1.mass";
  hand.choose(PartKind::body, "ball1");
  hand.reveal("inspector/pin/" + address);
  hand.one_step([&] { hand.press_widget("inspector/pin/" + address); });
  CHECK(hand.last_step() == "Pin mass of ball1");
  CHECK(hand.mechanism().sliders.back() ==
        Slider{.parameter = address, .from = 0, .to = 2, .description = ""});

  set_mode(hand.app.session, Mode::explore);
  select(hand.app.session, {});
  hand.frames(2);
  CHECK(hand.app.session.parameters[2].group == ParameterGroup::pinned);
  const double before = value(hand.app.session.answer.solution, "slide");
  hand.one_step([&] { hand.drag("parameters/" + address, {0.5f, 0.5f}, {0.75f, 0.5f}); });
  CHECK(hand.body("ball1").mass == Approx(1.5).margin(0.05));
  CHECK(value(hand.app.session.answer.solution, "slide") != before);

  hand.point(hand.widget("parameters/" + address).center());
  hand.click("parameters/" + address + "/gear");
  hand.one_step([&] { hand.fill("parameters/" + address + "/range/to", "5 kg"); });
  CHECK(hand.mechanism().sliders.back().to == 5);
  hand.one_step([&] { hand.click("parameters/" + address + "/range/log"); });
  CHECK(hand.mechanism().sliders.back().scale == SliderScale::log);
  CHECK(hand.mechanism().sliders.back().from == 0.005);
  hand.fill("parameters/" + address + "/range/from", "-1"); // no logarithm
  CHECK(hand.mechanism().sliders.back().from == 0.005);
  hand.one_step([&] { hand.click("parameters/" + address + "/range/pin"); });
  CHECK(hand.mechanism().sliders.size() == 2);
  CHECK(std::ranges::count(hand.app.session.parameters, address, &ParameterControl::address) == 0);
}

TEST_CASE("while exploring, the inspector's numbers are solved from the last answer") {
  Hand hand;
  set_mode(hand.app.session, Mode::explore);
  hand.choose(PartKind::joint, "spin");
  const double before = value(hand.app.session.answer.solution, "slide");
  hand.one_step([&] { hand.fill("inspector/drive/speed", "120 rpm"); });
  CHECK(hand.joint("spin").coordinates[0].drive->speed == Approx(12.566370614359172));
  CHECK(value(hand.app.session.answer.solution, "slide") != before);
}

TEST_CASE("a drive prescribes a torque where that is chosen, and its speed is found") {
  Hand hand;
  hand.choose(PartKind::joint, "spin");
  const auto drive = [&] { return *hand.joint("spin").coordinates[0].drive; };
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/torque"); });
  REQUIRE(drive().torque);
  CHECK(drive().load == 0.);
  CHECK(drive().speed == 11.0174); // where the search begins
  hand.one_step([&] { hand.fill("inspector/drive/torque", "=7500 N*(coordinate(slide) - 0.15 m)"); });
  REQUIRE(hand.joint("spin").formulas.size() == 1);
  CHECK(find_mistakes(hand.mechanism()).empty());
  for (const char* nonsense : {"=", "=2 N m s*rate(nothing)", "=2 N m s*rate(spin"}) {
    CAPTURE(nonsense);
    hand.fill("inspector/drive/torque", nonsense);
    CHECK_FALSE(hand.app.ui.fields.typing.mistake.empty());
    hand.key(key_escape);
    hand.frames(2);
    REQUIRE(hand.joint("spin").formulas.size() == 1);
    CHECK(hand.joint("spin").formulas[0].text == "7500 N*(coordinate(slide) - 0.15 m)");
  }
  hand.one_step([&] { hand.fill("inspector/drive/load", "25"); });
  set_mode(hand.app.session, Mode::explore);
  hand.frames(3);
  CHECK(coordinate(hand.app.session.answer.solution, "spin").speed.value() == Approx(10.29396051997144));
  set_mode(hand.app.session, Mode::build);
  hand.frames(2);
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/speed"); });
  CHECK(hand.last_step() == "Prescribe the speed of spin");
  CHECK_FALSE(drive().torque);
  CHECK(hand.joint("spin").formulas.empty());
}

TEST_CASE("a drive keeps its momentum where that is chosen, and its speed is found") {
  Hand hand;
  hand.choose(PartKind::joint, "spin");
  const auto drive = [&] { return *hand.joint("spin").coordinates[0].drive; };
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/momentum"); });
  CHECK(drive().keeps == DriveKeeps::momentum);
  CHECK(find_mistakes(hand.mechanism()).empty());
  set_mode(hand.app.session, Mode::explore);
  hand.frames(3);
  const CoordinateSolution& spin = coordinate(hand.app.session.answer.solution, "spin");
  REQUIRE(spin.speed);
  CHECK(*spin.speed != drive().speed);
  set_mode(hand.app.session, Mode::build);
  hand.frames(2);
  // A damper would take the momentum.
  hand.press_widget("inspector/damper");
  CHECK(hand.joint("spin").coordinates[0].damping == 0);
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/torque"); });
  CHECK(drive().keeps == DriveKeeps::speed);
  CHECK(drive().torque == 0.);
  // One step from each of the three to each other.
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/momentum"); });
  CHECK(drive().keeps == DriveKeeps::momentum);
  CHECK_FALSE(drive().torque);
  CHECK_FALSE(drive().load);
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/speed"); });
  CHECK(drive() == Drive{.speed = 11.0174});
  // What is so already is no step.
  const std::size_t position = hand.app.session.document.position();
  hand.press_widget("inspector/drive/prescribes/speed");
  CHECK(hand.app.session.document.position() == position);
}

TEST_CASE("what a drive prescribes is chosen by keys, and Tab stops at the choice once") {
  Hand hand;
  imgui_compat::map_key(ImGuiKey_RightArrow, 262);
  hand.choose(PartKind::joint, "spin");
  const auto at = [&] { return hand.app.ui.keyboard.at; };
  focus_widget(hand.app.ui, "inspector/drive");
  hand.frames(2);
  for (int i = 0; i < 6 && !at().starts_with("inspector/drive/"); ++i)
    hand.key(key_tab);
  REQUIRE(at() == "inspector/drive/prescribes/speed");
  hand.key(262);
  REQUIRE(at() == "inspector/drive/prescribes/torque");
  hand.one_step([&] { hand.key(key_enter); });
  CHECK(hand.joint("spin").coordinates[0].drive->torque == 0.);
  CHECK(at() == "inspector/drive/prescribes/torque");
  hand.key(key_tab);
  CHECK(at() == "inspector/drive/torque");
}

TEST_CASE("a driven joint has friction where that is ticked, which no momentum bears") {
  Hand hand;
  hand.choose(PartKind::joint, "spin");
  const auto spin = [&] { return hand.joint("spin").coordinates[0]; };
  hand.one_step([&] { hand.press_widget("inspector/friction"); });
  hand.one_step([&] { hand.fill("inspector/friction/limit", "2"); });
  REQUIRE(spin().friction);
  CHECK_FALSE(hand.app.ui.widgets.contains("inspector/friction/share")); // all of it loads the drive
  CHECK(find_mistakes(hand.mechanism()).empty());
  hand.press_widget("inspector/drive/prescribes/momentum");
  CHECK(spin().drive->keeps == DriveKeeps::speed);
  set_mode(hand.app.session, Mode::explore);
  hand.frames(3);
  REQUIRE(hand.app.session.answer.solution.drive_torques.size() == 1);
  CHECK(hand.app.session.answer.solution.drive_torques[0].value == Approx(2));
  set_mode(hand.app.session, Mode::build);
  hand.frames(2);
  hand.one_step([&] { hand.press_widget("inspector/drive/prescribes/torque"); });
  REQUIRE(spin().drive->torque);
  hand.frames(2);
  CHECK(hand.app.ui.widgets.contains("inspector/friction/share"));
  CHECK(find_mistakes(hand.mechanism()).empty());
}

TEST_CASE("powers in fields are written as in results, and typed either way") {
  Hand hand;
  select(hand.app.session, {});
  hand.frames(2);
  hand.click("inspector/gravity/y");
  CHECK_THAT(hand.app.ui.fields.typing.text, Catch::Matchers::EndsWith(" m/s²"));
  hand.type("-5 m/s^2");
  hand.key(key_enter);
  CHECK(hand.mechanism().gravity.y() == -5);
  hand.fill("inspector/gravity/y", "-6 m/s²");
  CHECK(hand.mechanism().gravity.y() == -6);
  CHECK(shown_unit("kg/m^3", {}).text == "kg/m³");
  CHECK(shown_unit("N s^2/m^2", {}).text == "N s²/m²");
  CHECK(shown_unit("m/s^10", {}).text == "m/s^10");
  for (const char* unit : {"m/s^2", "kg m^2", "kg/m^3", "N s^2/m^2"})
    CHECK(parse_quantity("2.5 " + written_unit(unit), unit, written_unit(unit)).value == 2.5);
}

TEST_CASE("a name with characters beyond 16 bits is edited without losing them") {
  Hand hand;
  imgui_compat::map_key(ImGuiKey_End, 269);
  edit(hand.app.session, "Rename",
       [](Mechanism& next, Selection&) { next.name = "a \U0001F642 b \U0001F680"; });
  select(hand.app.session, {});
  hand.frames(2);
  const auto end_with = [&](const char* more) {
    hand.click("inspector/name");
    hand.key(269);
    hand.type(more);
    hand.key(key_enter);
    hand.frames(2);
  };
  end_with("2");
  CHECK(hand.mechanism().name == "a \U0001F642 b \U0001F6802");
  end_with("\u00e9");
  CHECK(hand.mechanism().name == "a \U0001F642 b \U0001F6802\u00e9");
}
