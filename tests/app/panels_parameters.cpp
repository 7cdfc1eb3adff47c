// Parameters and expressions by mouse and keys.
#include "desk.hpp"

#include "app/document/create.hpp"
#include "app/document/formula_edits.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/turns.hpp"
#include "app/session/parameter_list.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a number that has no room is not longer for it") {
  Desk d;
  const Ui& ui = d.app.ui;
  const ImFont& font = *ui.fonts.digits;
  const auto width = [&](const char* text) { return font.CalcTextSizeA(font.FontSize, 1e9f, 0, text).x; };
  CHECK(fitting_text(ui, 1000, width("1000") - 0.25f) == "1000"); // of a room that was made for it
  CHECK(fitting_text(ui, 1000, width("10")) == "1000");           // "1e+03" is longer
  CHECK(fitting_text(ui, 1234567, width("1.23e+06")) == "1234567");
  CHECK(fitting_text(ui, 11.0174123, width("11.017")) == "11.017");
  CHECK(fitting_text(ui, 11.0174123, width("1")) == "11");
  CHECK(fitting_text(ui, 1e-7 / 3, width("3.333e-08")) == "3.333e-08");
}

TEST_CASE("below a slider a long name leaves the rate its room") {
  Desk d;
  d.build();
  d.pick(PartKind::joint, "arm1");
  const std::string name = "arm1 of the rather lengthy demonstration apparatus in room 12b";
  d.enter("inspector/name", "  " + name + " "); // blanks at its ends nobody sees
  REQUIRE(joint_index(d.m(), name) >= 0);
  set_mode(d.app.session, Mode::explore);
  d.frames(3);
  const WidgetRect label = d.widget("parameters/joints.spin.drive.speed/rate/name"),
                   line = d.widget("parameters/joints.spin.drive.speed/rate");
  CHECK(label.from.x >= line.from.x - 1);
  CHECK(label.to.x < line.to.x - 100); // "-2.9 °/(rad/s)" and the margin
}

TEST_CASE("a name of blanks is none") {
  Desk d;
  d.build();
  d.pick(PartKind::joint, "arm1");
  d.enter("inspector/name", "   ");
  CHECK(joint_index(d.m(), "arm1") >= 0);
  CHECK(d.app.ui.fields.typing.mistake.find("not empty") != std::string::npos);
  d.key(key_escape);
  d.enter("inspector/name", "arm2 "); // looks like the other
  CHECK(joint_index(d.m(), "arm1") >= 0);
  CHECK(d.app.ui.fields.typing.mistake.find("already") != std::string::npos);
}

TEST_CASE("an expression is typed where a number is, and a number over it") {
  Desk d("governor_parametric");
  d.build();
  d.pick(PartKind::body, "spindle");
  d.enter("inspector/mass", "=100*m + 50 kg");
  CHECK(d.m().bodies[0].mass == 150);
  CHECK(formula_at(d.m(), "bodies.spindle.mass") == "100*m + 50 kg");
  const std::size_t steps = d.app.session.document.position();
  SECTION("it is shown for typing, and stays as it is when nothing is changed") {
    d.frames(60);
    d.click("inspector/mass");
    CHECK(d.app.ui.fields.typing.text == "=100*m + 50 kg");
    d.key(key_escape);
    d.frames(2);
    CHECK(d.app.session.document.position() == steps);
  }
  SECTION("a number takes its place in one step") {
    d.enter("inspector/mass", "120");
    CHECK(d.m().bodies[0].mass == 120);
    CHECK_FALSE(formula_at(d.m(), "bodies.spindle.mass"));
    CHECK(d.app.session.document.position() == steps + 1);
    d.key('Z', true);
    CHECK(formula_at(d.m(), "bodies.spindle.mass") == "100*m + 50 kg");
  }
  SECTION("what is wrong with it is said in its place") {
    d.frames(60);
    d.click("inspector/mass");
    d.type("=L");
    d.frames(1);
    CHECK(d.app.ui.fields.typing.mistake.find("expected kg, found m") != std::string::npos);
    d.key(key_escape);
  }
}

TEST_CASE("the parameter that an expression lacks is made where it is said to lack it, in one step") {
  Desk d("governor_engine");
  d.build();
  d.pick(PartKind::joint, "spin");
  const std::size_t steps = d.app.session.document.position();
  d.frames(60);
  const float narrow = d.widget("inspector/drive/torque").to.x - d.widget("inspector/drive/torque").from.x;
  d.click("inspector/drive/torque");
  d.type("=0.8 N m - slope*coordinate(slide)");
  d.frames(2);
  CHECK_THAT(d.app.ui.fields.typing.mistake, ContainsSubstring("there is no parameter \"slope\""));
  // The whole row is for it.
  CHECK(d.widget("inspector/drive/torque").to.x - d.widget("inspector/drive/torque").from.x > 1.3f * narrow);
  SECTION("by the mouse") {
    d.click("inspector/drive/torque/offer");
  }
  SECTION("by a key") {
    d.key(key_enter, true);
  }
  d.frames(2);
  CHECK(d.app.ui.fields.typing.name.empty());
  CHECK(get_parameter(d.m(), "parameters.slope") == 1);
  CHECK(parameter_unit(d.m(), "parameters.slope") == "N");
  CHECK(formula_at(d.m(), "joints.spin.drive.torque") == "0.8 N m - slope*coordinate(slide)");
  CHECK(d.app.session.document.position() == steps + 1);
}

TEST_CASE("who writes a joint's name in a law is offered its coordinate and speed, and no parameter") {
  Desk d("governor_engine");
  d.build();
  d.pick(PartKind::joint, "spin");
  d.frames(60);
  const std::string field = "inspector/drive/torque";
  d.click(field);
  SECTION("while it is typed") {
    d.type("=-7500 N*(0.15 m - sli");
    d.frames(3);
    REQUIRE(d.app.ui.widgets.contains(field + "/completion/rate(slide)"));
    d.click(field + "/completion/coordinate(slide)");
    d.frames(4);
    d.type(")");
    d.frames(2);
    d.key(key_enter);
    d.frames(3);
    CHECK(formula_at(d.m(), "joints.spin.drive.torque") == "-7500 N*(0.15 m - coordinate(slide))");
  }
  SECTION("and when it was") {
    d.type("=7500 N*(slide - 0.15)");
    d.frames(2);
    CHECK_THAT(
        d.app.ui.fields.typing.mistake,
        ContainsSubstring("slide is a joint, whose results are written as coordinate(slide) or rate(slide)"));
    CHECK_FALSE(d.app.ui.widgets.contains(field + "/offer"));
  }
  SECTION("a number without its unit is told by what it lacks") {
    d.type("=7500*(coordinate(slide) - 0.15)");
    d.frames(2);
    CHECK_THAT(d.app.ui.fields.typing.mistake,
               ContainsSubstring("expected N m, found m; a factor in N is missing"));
  }
}

TEST_CASE("a parameter that is made for a number alone begins with the number's value") {
  Desk d;
  d.build();
  d.pick(PartKind::joint, "slide");
  const double stiffness = get_parameter(d.m(), "joints.slide.spring.stiffness");
  REQUIRE(stiffness != 1);
  d.frames(60);
  d.click("inspector/spring/stiffness");
  d.type("=k");
  d.key(key_enter, true);
  d.frames(2);
  CHECK(formula_at(d.m(), "joints.slide.spring.stiffness") == "k");
  CHECK(get_parameter(d.m(), "parameters.k") == stiffness);
  CHECK(get_parameter(d.m(), "joints.slide.spring.stiffness") == stiffness);
  CHECK_THAT(d.app.session.notice, ContainsSubstring("k is a parameter of the scene now, 1000 N/m at first"));
}

TEST_CASE("the name that a number was given is typed over at once") {
  Desk d;
  d.build();
  d.pick(PartKind::joint, "slide");
  const std::string field = "inspector/spring/stiffness";
  const auto name_it = [&] {
    d.click(ImVec2(d.widget(field).from.x + 10, d.widget(field).from.y + 8), 1);
    d.frames(2);
    d.click(field + "/name it");
    d.frames(2);
  };
  name_it();
  CHECK(d.app.ui.fields.typing.name == field + "/name");
  CHECK(d.app.ui.fields.typing.text == "stiffness");
  SECTION("Enter takes another, Escape leaves the one that was suggested") {
    const bool entered = GENERATE(true, false);
    d.type("k");
    d.key(entered ? key_enter : key_escape);
    d.frames(2);
    CHECK(formula_at(d.m(), "joints.slide.spring.stiffness") == (entered ? "k" : "stiffness"));
    CHECK(d.app.ui.fields.typing.name.empty());
    CHECK(d.widget(field).to.x > d.widget(field).from.x); // the number's own field again
  }
  SECTION("one that is taken is refused") {
    d.key(key_enter);
    d.frames(2);
    d.pick(PartKind::joint, "slide");
    d.click(ImVec2(d.widget("inspector/damping").from.x + 10, d.widget("inspector/damping").from.y + 8), 1);
    d.frames(2);
    d.click("inspector/damping/name it");
    d.frames(2);
    d.type("stiffness");
    d.key(key_enter);
    d.frames(2);
    CHECK_FALSE(d.app.ui.fields.typing.mistake.empty());
  }
}

TEST_CASE("of another mistake no parameter is offered") {
  Desk d("governor_engine");
  d.build();
  d.pick(PartKind::joint, "spin");
  d.frames(60);
  d.click("inspector/drive/torque");
  d.type(GENERATE("=0.8 N m - slope*coordinate(slyde)", "=a*b*1 N m", "=2 m + gain", "=slope +"));
  d.frames(2);
  CHECK_FALSE(d.app.ui.fields.typing.mistake.empty());
  CHECK_FALSE(d.app.ui.widgets.contains("inspector/drive/torque/offer"));
  d.key(key_escape);
}

TEST_CASE("a number is named in one gesture") {
  Desk d;
  d.pick(PartKind::body, "ball1");
  d.click(ImVec2(d.widget("inspector/mass").from.x + 10, d.widget("inspector/mass").from.y + 8), 1);
  d.frames(2);
  d.click("inspector/mass/name it");
  d.frames(2);
  CHECK(formula_at(d.m(), "bodies.ball1.mass") == "mass");
  CHECK(get_parameter(d.m(), "parameters.mass") == 1);
  CHECK(parameter_unit(d.m(), "parameters.mass") == "kg");
  // With a slider, which moves what it gives.
  d.enter("parameters/parameters.mass/value", "3");
  CHECK(d.m().bodies[1].mass == 3);
  CHECK(d.app.session.document.stored().bodies[1].mass == 1);
}

TEST_CASE("an expression typed at a slider: of numbers alone it is a value, of others it is told") {
  Desk d("governor_parametric");
  const std::string mass = "parameters.m", field = "parameters/" + mass + "/value";
  d.enter(field, "=2*1.5");
  CHECK(get_parameter(d.m(), mass) == 3);
  CHECK(get_parameter(d.app.session.document.stored(), mass) == 1); // tried, as a number is
  CHECK_FALSE(formula_at(d.m(), mass));
  CHECK(d.app.ui.widgets.contains(field));
  d.enter(field, "=250 g");
  CHECK(get_parameter(d.m(), mass) == 0.25);
  const std::string link = "parameters.l";
  d.enter("parameters/" + link + "/value", "=0.7*L");
  CHECK(formula_at(d.m(), link) == "0.7*L");
  CHECK_FALSE(d.app.ui.widgets.contains("parameters/" + link + "/value"));
  CHECK_THAT(d.app.session.notice, ContainsSubstring("l is given by an expression now and has no slider"));
  d.key('Z', true);
  d.frames(2);
  CHECK(d.app.ui.widgets.contains("parameters/" + link + "/value"));
}

TEST_CASE("the list of parameters and points") {
  Desk d("governor_parametric");
  d.build();
  select(d.app.session, {});
  d.frames(2);
  d.enter("inspector/parameter/L/name", "arm");
  CHECK(formula_at(d.m(), "parameters.c") == "arm/2");
  d.enter("inspector/parameter/c", "=arm/2 + 1 mm");
  CHECK(std::abs(get_parameter(d.m(), "parameters.c") - 0.081) < 1e-15);
  d.click("inspector/parameters/add");
  d.frames(2);
  REQUIRE(parameter_index(d.m(), "p") >= 0);
  // As long as it has no unit it takes that which is typed, in SI.
  const auto added = [&] { return d.m().parameters[static_cast<std::size_t>(parameter_index(d.m(), "p"))]; };
  d.enter("inspector/parameter/p", "3 rpmm");
  CHECK(added().value == 1);
  CHECK(added().unit.empty());
  d.key(key_escape);
  struct Typed {
    const char *text, *unit;
    double value;
  };
  for (const Typed& typed : {Typed{"12 mm", "m", 0.012},
                             {"12mm", "m", 0.012},
                             {"60 rpm", "rad/s", 6.283185307179586},
                             {"0.2 N/mm", "N/m", 200},
                             {"2 g", "kg", 0.002},
                             {"90°", "rad", 1.5707963267948966},
                             {"3 cm²", "m^2", 3e-4},
                             {"1/2 kN m", "N m", 500}}) {
    INFO(typed.text);
    d.enter("inspector/parameter/p", typed.text);
    CHECK(added().unit == typed.unit);
    CHECK(added().value == Approx(typed.value).epsilon(1e-14));
    d.key('Z', true);
    d.frames(2);
    REQUIRE(added().unit.empty());
  }
  d.enter("inspector/parameter/p", "3 N m s");
  CHECK(added().value == 3);
  CHECK(added().unit == "N m s");
  d.enter("inspector/parameter/p", "4");
  CHECK(added().value == 4);
  CHECK(added().unit == "N m s");
  d.click("inspector/parameter/k/more");
  d.frames(2);
  d.enter("inspector/parameter/k/to", "8000");
  CHECK((*d.m().parameters[5].range)[1] == 8000);
  d.click("inspector/parameter/k/remove");
  d.frames(2);
  CHECK(parameter_index(d.m(), "k") < 0);
  CHECK(d.m().joints[3].coordinates[0].spring->stiffness == 1000);
  CHECK_FALSE(formula_at(d.m(), "joints.slide.spring.stiffness"));
}

TEST_CASE(
    "a parameter without a range of its own shows its slider's, and keeps the other end when one is typed") {
  Desk d("governor_parametric");
  edit(d.app.session, "Add", [](Mechanism& m, Selection&) {
    NamedParameter added;
    added.name = "gain";
    added.value = 20;
    added.unit = "N";
    m.parameters.push_back(added);
  });
  d.build();
  select(d.app.session, {});
  d.frames(2);
  d.click("inspector/parameter/gain/more");
  d.frames(2);
  d.enter("inspector/parameter/gain/from", "5");
  REQUIRE(d.m().parameters.back().range);
  CHECK((*d.m().parameters.back().range)[0] == 5);
  CHECK((*d.m().parameters.back().range)[1] == 50); // of the slider from 0 to 50
}

TEST_CASE("a slider that asks for what cannot be made says so and stays") {
  Desk d("governor_parametric");
  d.enter("parameters/parameters.L/value", "0.4");
  CHECK(d.app.session.notice.find("the value is not finite") != std::string::npos);
  CHECK(d.m() == d.app.session.document.stored());
}

namespace {

// The whole inspector of a body in sight, and nothing selected before.
struct TallDesk : Desk {
  explicit TallDesk(const std::string& scene = "governor") : Desk(scene, {1200, 2000}) {
    app.sizes.inspector_share = 0.8f;
  }
  void ask(const std::string& field) {
    frames(60);
    click(ImVec2(widget(field).from.x + 10, widget(field).from.y + 8), 1);
    frames(2);
  }
  const Body& ball() const { return m().bodies[static_cast<std::size_t>(body_index(m(), "ball1"))]; }
};

} // namespace

TEST_CASE("Tab from a new name opens the value beside it, though the row has another name then") {
  Desk d("governor_parametric");
  d.build();
  select(d.app.session, {});
  d.frames(2);
  d.click("inspector/parameters/add");
  d.frames(2);
  d.click("inspector/parameter/p/name");
  d.frames(2);
  d.key('A', true);
  d.type("q");
  d.key(keys::tab);
  d.frames(10);
  CHECK(parameter_index(d.m(), "q") >= 0);
  CHECK(d.app.ui.keyboard.at == "inspector/parameter/q");
  CHECK(ImGui::GetIO().WantTextInput);
  d.type("12 mm");
  d.key(keys::enter);
  d.frames(2);
  CHECK(get_parameter(d.m(), "parameters.q") == 0.012);
  CHECK(d.app.session.selection().parts.empty());
}

TEST_CASE("a shape's numbers take expressions and names as others do") {
  TallDesk d("governor_parametric");
  d.build();
  d.pick(PartKind::body, "ball1");
  const std::size_t steps = d.app.session.document.position();
  d.enter("inspector/shapes/0/radius", "=L/8");
  CHECK(d.ball().shapes[0].radius == 0.02);
  CHECK(formula_at(d.m(), "bodies.ball1.shapes.0.radius") == "L/8");
  CHECK(d.app.session.document.steps().back().name == "Set radius of shape 0 of ball1 by an expression");
  SECTION("a number takes its place in one step, and undo brings it back") {
    d.enter("inspector/shapes/0/radius", "30 mm");
    CHECK(d.ball().shapes[0].radius == 0.03);
    CHECK_FALSE(formula_at(d.m(), "bodies.ball1.shapes.0.radius"));
    CHECK(d.app.session.document.position() == steps + 2);
    d.key('Z', true);
    CHECK(formula_at(d.m(), "bodies.ball1.shapes.0.radius") == "L/8");
  }
  SECTION("it is named, and its name has a slider") {
    d.ask("inspector/shapes/1/radius");
    d.click("inspector/shapes/1/radius/name it");
    d.frames(2);
    CHECK(formula_at(d.m(), "bodies.ball1.shapes.1.radius") == "radius2"); // a measure is called radius
    CHECK(get_parameter(d.m(), "parameters.radius2") == 0.005);
    set_mode(d.app.session, Mode::explore);
    d.frames(3);
    CHECK(d.app.ui.widgets.contains("parameters/parameters.radius2/value"));
  }
  SECTION("dragged by its label it takes what it rests on along") {
    const WidgetRect label = d.widget("inspector/shapes/0/radius/label");
    d.drag(label.center(), {label.center().x + 40, label.center().y});
    CHECK(d.ball().shapes[0].radius > 0.02);
    CHECK(std::abs(get_parameter(d.m(), "parameters.L") - 8 * d.ball().shapes[0].radius) < 1e-12);
  }
  SECTION("a vector stands at a point by its name, and leaves it") {
    d.enter("inspector/shapes/1/to/x", "=C1");
    CHECK(d.ball().shapes[1].to == d.m().points[3].at);
    CHECK(formula_at(d.m(), "bodies.ball1.shapes.1.to.2") == "C1.z");
    d.ask("inspector/shapes/1/to/y");
    d.click("inspector/shapes/1/to/y/leave point");
    d.frames(2);
    CHECK_FALSE(formula_at(d.m(), "bodies.ball1.shapes.1.to.0"));
    CHECK(d.ball().shapes[1].to == d.m().points[3].at);
  }
  SECTION("what does not fit is said in its place") {
    d.frames(60);
    d.click("inspector/shapes/0/radius");
    d.type("=m");
    d.frames(1);
    CHECK(d.app.ui.fields.typing.mistake.find("expected m, found kg") != std::string::npos);
    d.key(key_escape);
    d.frames(60);
    d.click("inspector/shapes/0/radius");
    d.type("=-L");
    d.frames(1);
    CHECK(d.app.ui.fields.typing.mistake == "Expected more than zero.");
    d.key(key_escape);
  }
}

TEST_CASE("the mass of a uniform solid follows a size that an expression gives") {
  TallDesk d;
  d.build();
  edit(d.app.session, "Add ball", [](Mechanism& next, Selection& selection) {
    selection.set({PartKind::body, add_body(next, {.at = {0.5, 0, 0}, .radius = 0.1})});
  });
  d.frames(3);
  const double mass = d.m().bodies.back().mass;
  d.enter("inspector/shapes/0/radius", "=2*100 mm");
  CHECK(d.m().bodies.back().shapes[0].radius == 0.2);
  CHECK(std::abs(d.m().bodies.back().mass / mass - 8) < 1e-12);
  // Its centre stands by itself from now on, where the body's is.
  d.enter("inspector/shapes/0/at/y", "=0.25 m");
  CHECK(*d.m().bodies.back().shapes[0].at == Vec3(0.5, 0.25, 0));
  CHECK(d.m().bodies.back().position == Vec3(0.5, 0.25, 0));
}

TEST_CASE("a turn takes an expression, which is kept as one of the quaternion") {
  TallDesk d;
  d.build();
  d.pick(PartKind::body, "ball1");
  d.click("inspector/rotation section");
  d.frames(2);
  const std::string z = "inspector/rotation/z";
  const auto shows = [&](double x, double y, double angle) {
    return 1 - std::abs(d.ball().rotation.dot(rotation_by({x, y, angle}))) < 1e-14;
  };
  d.enter(z, "30");
  CHECK(shows(0, 0, 30));
  d.ask(z);
  d.click(z + "/name it");
  d.frames(2);
  d.key(key_escape); // the suggested name stays
  d.frames(2);
  CHECK(formula_at(d.m(), "bodies.ball1.rotation.0") == "cos(turn_z/2)");
  CHECK(parameter_unit(d.m(), "parameters.turn_z") == "rad");
  CHECK(shows(0, 0, 30));
  const std::size_t steps = d.app.session.document.position();
  SECTION("another turn beside it stays a number") {
    d.enter("inspector/rotation/x", "10");
    CHECK(expression_at(d.m(), "bodies.ball1.turn.2") == "turn_z");
    CHECK(shows(10, 0, 30));
    CHECK(d.app.session.document.position() == steps + 1);
    d.enter("inspector/rotation/x", "=turn_z/3");
    CHECK(shows(10, 0, 30));
    CHECK(expression_at(d.m(), "bodies.ball1.turn.0") == "turn_z/3");
  }
  SECTION("it is typed again as it was, and stays") {
    d.frames(60);
    d.click(z);
    CHECK(d.app.ui.fields.typing.text == "=turn_z");
    d.key(key_escape);
    d.frames(2);
    CHECK(d.app.session.document.position() == steps);
  }
  SECTION("a number takes its place in one step") {
    d.enter(z, "45");
    CHECK(shows(0, 0, 45));
    CHECK_FALSE(is_rotation_given(d.ball()));
    CHECK(d.app.session.document.position() == steps + 1);
    d.key('Z', true);
    CHECK(expression_at(d.m(), "bodies.ball1.turn.2") == "turn_z");
    CHECK(shows(0, 0, 30));
  }
  SECTION("dragged by its label it takes the parameter along") {
    const WidgetRect label = d.widget(z + "/label");
    d.drag(label.center(), {label.center().x + 40, label.center().y});
    const double angle = get_parameter(d.m(), "parameters.turn_z") * 180 / 3.14159265358979323846;
    CHECK(angle > 30.5);
    CHECK(shows(0, 0, angle));
  }
  SECTION("renamed") {
    edit(d.app.session, "Rename",
         [](Mechanism& next, Selection&) { rename_parameter(next, "turn_z", "phi"); });
    d.frames(2);
    CHECK(expression_at(d.m(), "bodies.ball1.turn.2") == "phi");
  }
}

TEST_CASE("what is on a body turns with it, whether a number or an expression is typed") {
  TallDesk d;
  d.build();
  d.pick(PartKind::body, "ball1");
  d.click("inspector/rotation section");
  d.frames(2);
  const std::string z = "inspector/rotation/z";
  const Mechanism begun = d.m();
  d.enter(z, "30");
  const Mechanism by_number = d.m();
  d.key('Z', true);
  d.enter(z, "=20 deg + 10 deg");
  CHECK(expression_at(d.m(), "bodies.ball1.turn.2") == "20 deg + 10 deg");
  const auto apart = [&](const Mechanism& other) {
    double most = 0;
    for (std::size_t i = 0; i < other.bodies.size(); ++i)
      for (std::size_t k = 0; k < other.bodies[i].shapes.size(); ++k) {
        const Shape &a = d.m().bodies[i].shapes[k], &b = other.bodies[i].shapes[k];
        most = std::max({most, (a.from - b.from).norm(), (a.to - b.to).norm()});
      }
    for (std::size_t i = 0; i < other.joints.size(); ++i)
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
        most = std::max({most, (d.m().joints[i].at - other.joints[i].at).norm(),
                         (d.m().joints[i].points[end] - other.joints[i].points[end]).norm()});
    return most;
  };
  CHECK(apart(by_number) < 1e-14);
  CHECK(apart(begun) > 0.01);
  d.key('Z', true);
  CHECK(d.m() == begun);
}

TEST_CASE("a quaternion given otherwise is shown, and a turn that is typed takes its place") {
  TallDesk d;
  d.build();
  edit(d.app.session, "By hand", [](Mechanism& next, Selection&) {
    Body& ball = next.bodies[1];
    ball.formulas = {{"rotation.0", "sqrt(1 - 0.5^2)"}, {"rotation.3", "0.5"}};
    evaluate_formulas(next);
  });
  d.pick(PartKind::body, "ball1");
  d.frames(2);
  CHECK(is_rotation_given(d.ball()));
  const std::size_t steps = d.app.session.document.position();
  d.enter("inspector/rotation/x", "20");
  CHECK_FALSE(is_rotation_given(d.ball()));
  CHECK(1 - std::abs(d.ball().rotation.dot(rotation_by({20, 0, 60}))) < 1e-14);
  CHECK(d.app.session.document.position() == steps + 1);
  d.key('Z', true);
  CHECK(formula_at(d.m(), "bodies.ball1.rotation.3") == "0.5");
}

TEST_CASE("the slider, the choice and the axis of a kept momentum say that the speed is the drawn one") {
  Desk d("free_top");
  const auto slider = [&](const std::string& address) {
    return *std::ranges::find(d.app.session.parameters, address, &ParameterControl::address);
  };
  const std::string spin = "joints.spin.drive.speed";
  CHECK(slider(spin).what == "drawn speed");
  CHECK(slider(spin).unit == "rad/s");
  CHECK(number_phrase(d.m(), spin) == "drawn speed of spin");
  d.key('C');
  d.frames(3);
  d.click("response/parameter");
  d.click("response/parameter/drawn speed of spin");
  d.frames(3);
  CHECK(d.app.session.study.response.choice.address == spin);
  CHECK(d.app.panels->studies.shown().response.plot.x.label == "drawn speed of spin");
  // Once it is prescribed, the speed is what it has.
  edit(d.app.session, "Prescribe", [](Mechanism& next, Selection&) {
    for (Joint& joint : next.joints)
      for (Coordinate& coordinate : joint.coordinates)
        if (coordinate.drive) coordinate.drive->keeps = DriveKeeps::speed;
  });
  d.frames(2);
  CHECK(slider(spin).what == "speed");
}

TEST_CASE("the speed that a drive by torque is searched from is not told as the speed that it has") {
  Desk d("governor_engine");
  const std::string spin = "joints.spin.drive.speed";
  CHECK(number_phrase(d.m(), spin) == "guessed speed of spin");
  CHECK(number_control(d.m(), d.m(), spin, {})->what == "guessed speed");
  CHECK(number_phrase(d.m(), "joints.spin.drive.load") == "load on spin");
}
