// The outline, the inspector of every kind of part, the history list and pinned sliders, used by a robot.
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/render/imgui_compat.hpp"
#include "app/session/quantity.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/mass_properties.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <functional>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize window{1280, 900};
constexpr int key_tab = 258, key_up = 265, key_f2 = 291;

// In a window, with a scene open and being built.
struct Hand : Robot {
  explicit Hand(PixelSize in = window) : Robot(in) {
    imgui_compat::map_key(ImGuiKey_Tab, key_tab);
    imgui_compat::map_key(ImGuiKey_UpArrow, key_up);
    app.panels.inspector_share = 0.85f;
    set_mode(app.session, Mode::build);
    frames(2);
  }

  const Mechanism& mechanism() const { return app.session.mechanism(); }
  const Body& body(const char* name) const {
    return mechanism().bodies.at(static_cast<std::size_t>(body_index(mechanism(), name)));
  }
  const Joint& joint(const char* name) const {
    return mechanism().joints.at(static_cast<std::size_t>(joint_index(mechanism(), name)));
  }
  const Force& force(const char* name) const {
    return mechanism().forces.at(static_cast<std::size_t>(force_index(mechanism(), name)));
  }

  void choose(PartKind kind, const char* name) {
    select(app.session, {{{kind, name}}});
    frames(2);
  }
  // Scrolls the inspector until all of the widget can be seen.
  void reveal(const std::string& name) {
    const PanelRect panel =
        layout_of(app, static_cast<float>(size.width), static_cast<float>(size.height)).inspector;
    const auto seen = [&] {
      const auto found = app.ui.widgets.find(name);
      return found != app.ui.widgets.end() && found->second.to.y - found->second.from.y >= 16;
    };
    for (const float notches : {20.f, -1.f})
      for (int i = 0; i < 40 && !seen(); ++i) {
        point({panel.x + 4, panel.y + panel.height / 2});
        ImGui::GetIO().MouseWheel = notches;
        frames(2);
      }
  }
  void press_widget(const std::string& name) {
    if (name.starts_with("inspector/")) reveal(name);
    click(name);
  }
  void fill(const std::string& field, const std::string& text) {
    press_widget(field);
    type(text);
    key(key_enter);
  }
  void choose_from(const std::string& list, const std::string& item) {
    press_widget(list);
    click(list + "/" + item);
  }
  std::string last_step() const { return app.session.document.steps()[app.session.document.position()].name; }
  // What `act` does is one step, and undoing it leaves nothing behind.
  void one_step(const std::function<void()>& act) {
    const Mechanism before = mechanism();
    const std::size_t position = app.session.document.position();
    act();
    REQUIRE(app.session.document.position() == position + 1);
    const Mechanism after = mechanism();
    undo(app.session);
    frames(2);
    CHECK(mechanism() == before);
    redo(app.session);
    frames(2);
    CHECK(mechanism() == after);
  }
};

} // namespace

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
    CHECK(hand.app.inspector.turns.z() == 270);
    const Vec3 x = hand.body("ball1").rotation * Vec3::UnitX();
    CHECK((x + Vec3::UnitY()).norm() < 1e-14);
    hand.fill("inspector/rotation/x", "pi/2 rad");
    CHECK(hand.app.inspector.turns == Vec3(90, 0, 270));
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
  hand.one_step([&] { hand.fill("inspector/stop/lower", "50 mm"); });
  CHECK(hand.joint("slide").coordinates[0].stop->lower == Approx(0.05));
  hand.one_step([&] { hand.press_widget("inspector/stop/upper/reset"); });
  CHECK_FALSE(hand.joint("slide").coordinates[0].stop->upper);
  hand.one_step([&] { hand.press_widget("inspector/stop/upper/add"); });
  CHECK(hand.joint("slide").coordinates[0].stop->upper);
  hand.one_step([&] { hand.fill("inspector/coordinate", "0.2 - 0.1256"); });
  CHECK(hand.joint("slide").coordinates[0].drawn == Approx(0.0744));
  CHECK(find_mistakes(hand.mechanism()).empty());

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
    run_command(hand.app, command);
    hand.frames(2);
    return hand.app.session.selection().parts.front().name;
  };
  const Part arm1{PartKind::joint, "arm1"}, arm2{PartKind::joint, "arm2"}, slide{PartKind::joint, "slide"};
  SECTION("a gear that becomes a belt of its ratio") {
    const std::string gear = join({arm1, arm2}, "edit.gear");
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
    CHECK(join({slide, arm1}, "edit.rack") == "rack1");
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
    run_command(hand.app, "edit.belt");
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
    CHECK_FALSE(is_enabled(hand.app, command("edit.backlash")));
    run_command(hand.app, "edit.gear");
    hand.frames(2);
    REQUIRE(is_enabled(hand.app, command("edit.backlash")));
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
    run_command(hand.app, "edit.backlash");
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("would act on the rim"));
  }
  SECTION("only what suits them is offered") {
    select(hand.app.session, {{arm1, arm2}});
    CHECK(is_enabled(hand.app, command("edit.belt")));
    CHECK_FALSE(is_enabled(hand.app, command("edit.rack")));
    select(hand.app.session, {{slide}});
    CHECK_FALSE(is_enabled(hand.app, command("edit.gear")));
    CHECK_FALSE(is_enabled(hand.app, command("edit.screw")));
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
  const auto add = [&](const auto& make) {
    edit(hand.app, "Add", [&](Mechanism& m, Selection& s) { s.set({PartKind::force, make(m)}); });
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
  REQUIRE(hand.app.session.selection().parts.size() == 2);
  hand.one_step([&] { hand.fill("inspector/all/mass", "3"); });
  CHECK(hand.body("ball1").mass == 3);
  CHECK(hand.body("ball2").mass == 3);
  CHECK(hand.body("spindle").mass == 200);
  hand.one_step([&] { hand.press_widget("inspector/edit.delete"); });
  CHECK(body_index(hand.mechanism(), "ball1") < 0);
}

TEST_CASE("renaming takes every reference along and refuses names that are taken") {
  Hand hand;
  SECTION("in the outline, by a double click") {
    hand.double_click("outline/bodies/ball1");
    REQUIRE(hand.app.ui.fields.typing.name == "outline/bodies/ball1/name");
  }
  SECTION("in the outline, by F2") {
    hand.click("outline/bodies/ball1");
    hand.key(key_f2);
    REQUIRE(hand.app.ui.fields.typing.name == "outline/bodies/ball1/name");
  }
  SECTION("in the inspector") {
    hand.click("outline/bodies/ball1");
    hand.press_widget("inspector/name");
  }
  hand.frames(2);
  hand.type("ball2");
  hand.key(key_enter);
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("ball2"));
  hand.frames(3);
  hand.key('A', true);
  hand.type("a.b");
  hand.key(key_enter);
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("dots"));
  hand.frames(3);
  hand.key('A', true);
  hand.type("left weight");
  hand.one_step([&] { hand.key(key_enter); });
  CHECK(hand.last_step() == "Rename ball1 to left weight");
  CHECK(hand.joint("arm1").bodies[1] == "left weight");
  CHECK(hand.app.session.selection().has({PartKind::body, "left weight"}));
  CHECK(hand.app.session.mistakes.empty());
}

TEST_CASE("the outline selects one, some and a range, and shows what is pointed at") {
  Hand hand;
  hand.click("outline/bodies/spindle");
  CHECK(hand.app.session.selection().parts == std::vector<Part>{{PartKind::body, "spindle"}});
  CHECK(hand.app.view.hovered.kind == PartKind::body); // the hand still lies on it
  hand.hold(false, true);
  hand.click("outline/joints/spin");
  hand.hold(false, false);
  CHECK(hand.app.session.selection().parts.size() == hand.mechanism().bodies.size() + 1);
  hand.hold(true, false);
  hand.click("outline/bodies/spindle");
  hand.hold(false, false);
  CHECK_FALSE(hand.app.session.selection().has({PartKind::body, "spindle"}));
  hand.click("outline/joints/spin");
  CHECK(hand.app.session.selection().parts.size() == 1);
  hand.click("outline/joints");
  CHECK_FALSE(hand.app.ui.widgets.contains("outline/joints/spin"));
}

TEST_CASE("two thousand bodies are listed a screenful at a time and searched") {
  Hand hand;
  Mechanism many;
  many.name = "Many";
  Body body;
  body.mass = 1;
  body.shapes.emplace_back().type = ShapeType::box; // is quickly drawn
  body.shapes[0].size = Vec3(0.1, 0.1, 0.1);
  for (int i = 0; i < 2000; ++i) {
    body.name = "body" + std::to_string(i);
    many.bodies.push_back(body);
  }
  open_document(hand.app.session, Document(many));
  set_mode(hand.app.session, Mode::build);
  hand.frames(2);
  const auto listed = [&] {
    return std::ranges::count_if(hand.app.ui.widgets,
                                 [](const auto& w) { return w.first.starts_with("outline/bodies/"); });
  };
  CHECK(listed() > 10);
  CHECK(listed() < 100);
  // What is selected elsewhere is brought into view.
  hand.choose(PartKind::body, "body1900");
  hand.frames(2);
  CHECK(hand.app.ui.widgets.contains("outline/bodies/body1900"));
  hand.click("outline/search");
  hand.type("ODY1777");
  hand.frames(2);
  CHECK(listed() == 1);
  CHECK(hand.app.ui.widgets.contains("outline/bodies/body1777"));
}

TEST_CASE("what is missing is told and leads to the part") {
  Hand hand;
  edit(hand.app.session, "Add", [](Mechanism& m, Selection& s) {
    add_body(m, {.form = BodyForm::ball, .at = {0.3, 0, 0}});
    add_body(m, {.form = BodyForm::ball, .at = {0.5, 0, 0}});
    s = {};
  });
  hand.frames(2);
  REQUIRE(hand.app.session.mistakes.size() == 2);
  const std::string second = hand.mechanism().bodies.back().name;
  SECTION("below the outline") {
    hand.click("mistakes/1");
  }
  SECTION("in place of results") {
    hand.click("results/mistakes/1");
  }
  CHECK(hand.app.session.selection().parts == std::vector<Part>{{PartKind::body, second}});
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

TEST_CASE("a drive gives a torque where that is ticked, and its speed is found") {
  Hand hand;
  hand.choose(PartKind::joint, "spin");
  const auto drive = [&] { return *hand.joint("spin").coordinates[0].drive; };
  hand.one_step([&] { hand.press_widget("inspector/drive/by_torque"); });
  REQUIRE(drive().torque);
  CHECK(drive().load == 0.);
  CHECK(drive().speed == 11.0174); // where the search begins
  hand.one_step([&] { hand.fill("inspector/drive/torque", "=7500 N*(coordinate(slide) - 0.15 m)"); });
  REQUIRE(hand.joint("spin").formulas.size() == 1);
  CHECK(find_mistakes(hand.mechanism()).empty());
  hand.one_step([&] { hand.fill("inspector/drive/load", "25"); });
  set_mode(hand.app.session, Mode::explore);
  hand.frames(3);
  CHECK(coordinate(hand.app.session.answer.solution, "spin").speed.value() == Approx(10.29396051997144));
  set_mode(hand.app.session, Mode::build);
  hand.frames(2);
  hand.one_step([&] { hand.press_widget("inspector/drive/by_torque"); });
  CHECK_FALSE(drive().torque);
  CHECK(hand.joint("spin").formulas.empty());
}

TEST_CASE("a drive is left to itself where that is ticked, and its speed is found") {
  Hand hand;
  hand.choose(PartKind::joint, "spin");
  const auto drive = [&] { return *hand.joint("spin").coordinates[0].drive; };
  hand.one_step([&] { hand.press_widget("inspector/drive/keeps"); });
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
  hand.one_step([&] { hand.press_widget("inspector/drive/by_torque"); });
  CHECK(drive().keeps == DriveKeeps::speed);
}

TEST_CASE("the history goes to any step") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  hand.fill("inspector/mass", "2");
  hand.fill("inspector/mass", "3");
  hand.fill("inspector/mass", "4");
  hand.app.inspector.history = true;
  hand.frames(3);
  hand.click("history/1");
  CHECK(hand.body("ball1").mass == 2);
  CHECK(hand.app.session.document.steps().size() == 4);
  hand.click("history/3");
  CHECK(hand.body("ball1").mass == 4);
  hand.click("history/0");
  CHECK(hand.mechanism() == hand.app.session.document.saved());
}

TEST_CASE("undo leaves the rows where they are, and a second edit at the same place means the same number") {
  Hand hand;
  open_scene(hand.app.session, shipped_file("watt_governor"));
  set_mode(hand.app.session, Mode::build);
  hand.frames(3);
  hand.click("outline/bodies/arm1");
  const Mechanism before = hand.mechanism();
  const ImVec2 at = hand.widget("inspector/position/x").center();
  const auto edit_there = [&] {
    hand.click(at);
    hand.type("300 mm");
    hand.key(key_enter);
  };
  edit_there();
  CHECK(hand.body("arm1").position.x() == 0.3);
  hand.key('Z', true);
  CHECK(hand.mechanism() == before);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::body, "arm1"}});
  CHECK(hand.widget("inspector/position/x").center().y == at.y);
  edit_there();
  CHECK(hand.body("arm1").position.x() == 0.3);
  CHECK(hand.mechanism().gravity == before.gravity);
  hand.key('Z', true);
  hand.key('Z', true, true);
  CHECK(hand.body("arm1").position.x() == 0.3);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::body, "arm1"}});
}

TEST_CASE("deleting says what goes along though it was not selected") {
  Hand hand;
  open_scene(hand.app.session, shipped_file("watt_governor"));
  set_mode(hand.app.session, Mode::build);
  hand.choose(PartKind::body, "arm1");
  hand.key(261); // Delete
  CHECK(hand.app.session.notice == "Deleted arm1 together with joints arm1 and knee1.");
  hand.choose(PartKind::joint, "foot1");
  hand.key(261);
  CHECK(hand.app.session.notice.empty());
  undo(hand.app.session);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::joint, "foot1"}});
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
