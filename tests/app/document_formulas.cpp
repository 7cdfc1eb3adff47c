// Editing what parameters, points and expressions hold together.
#include "app/document/clipboard.hpp"
#include "app/document/copies.hpp"
#include "app/document/document.hpp"
#include "app/document/formula_edits.hpp"
#include "app/document/image.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/rename.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace flyball;

namespace {

Mechanism governor() {
  return load_scene(FLYBALL_ASSETS "/scenes/governor_parametric.json");
}

// Edits as a hand does: the numbers alone.
void change(Document& document, const std::function<void(Mechanism&)>& act) {
  Mechanism next = document.stored();
  act(next);
  document.edit("Change", std::move(next), {});
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "none";
}

bool says(const std::string& text, const std::string& part) {
  INFO(text);
  const bool found = text.find(part) != std::string::npos;
  CHECK(found);
  return found;
}

} // namespace

TEST_CASE("dragging a joint that stands at a point moves the point and all that stands there") {
  Document document(governor());
  change(document, [](Mechanism& m) { m.joints[0].at = {0.01, 0.25, 0.02}; });
  const Mechanism& m = document.stored();
  CHECK((m.points[0].at - Vec3(0.01, 0.25, 0.02)).norm() < 1e-15);
  CHECK((m.joints[1].at - Vec3(0.01, 0.25, 0.02)).norm() < 1e-15);
  CHECK((m.bodies[0].position - Vec3(0.01, 0.25, 0.02)).norm() < 1e-15);
  CHECK(std::abs(m.bodies[0].shapes[0].to.y() - 0.28) < 1e-15);
  CHECK(formula_at(m, "joints.spin.at.0") == "P.x");
  CHECK(document.undo());
  CHECK(document.stored() == governor());
}

TEST_CASE("a number that one parameter determines takes it along") {
  Document document(governor());
  document.edit_number("Mass", "bodies.ball1.mass", 2.5);
  CHECK(document.stored().bodies[2].mass == 2.5);
  CHECK(get_parameter(document.stored(), "parameters.m") == 2.5);
  // Through a dependent parameter.
  document.edit_number("Attachment", "parameters.c", 0.09);
  CHECK(std::abs(get_parameter(document.stored(), "parameters.L") - 0.18) < 1e-15);
}

TEST_CASE("what expressions leave open, or never give, is refused with what holds it") {
  Document document(governor());
  const Mechanism before = document.stored();
  // Higher by the pivot, or by the link, or by the arm?
  says(refusal([&] { document.edit_number("Slide", "joints.slide.coordinate", 0.1); }),
       "joints.slide.coordinate: given by \"=P.y - S.y\"");
  says(refusal([&] { document.edit_number("Slide", "joints.slide.coordinate", 0.1); }),
       "rests on points.P.1, parameters.l, parameters.L");
  change(document, [](Mechanism& m) { set_expression(m, "bodies.ball2.mass", "2 kg"); });
  says(refusal([&] { document.edit_number("Mass", "bodies.ball2.mass", 3); }), "given by \"=2 kg\"");
  document.undo();
  CHECK(document.stored() == before);
  // A value that no arm makes.
  says(refusal([&] { document.edit_number("Arm", "parameters.L", 0.5); }), "the value is not finite");
  says(refusal([&] { document.explore("Arm", {{"parameters.L", 0.5}}); }), "the value is not finite");
  CHECK(document.stored() == before);
  CHECK(document.mechanism() == before);
}

TEST_CASE("numbers that are tried are evaluated, and put away again") {
  Document document(governor());
  document.explore("Arm", {{"parameters.L", 0.2}});
  CHECK(document.mechanism().bodies[2].position.x() == 0.2);
  CHECK(document.stored().bodies[2].position.x() == 0.16);
  CHECK_FALSE(document.unsaved());
  document.keep_explored();
  CHECK(document.stored().bodies[2].position.x() == 0.2);
  CHECK(find_mistakes(document.stored()).empty());
}

TEST_CASE("the parameter that an expression lacks has the unit that it needs there") {
  Mechanism m = test::shipped("governor_parametric");
  const auto unit = [&](const char* address, const char* text) -> std::string {
    const auto lacking = lacking_parameter(m, address, text);
    return lacking ? lacking->name + " " + lacking->unit : "none";
  };
  CHECK(unit("joints.slide.damping", "d") == "d N s/m");
  CHECK(unit("bodies.collar.mass", "2*m0") == "m0 kg");
  CHECK(unit("bodies.collar.mass", "m*factor") == "factor ");
  CHECK(unit("bodies.collar.mass", "m + rho*L^3") == "rho kg/m^3");
  CHECK(unit("joints.slide.spring.stiffness", "10 N*tanh(deflection/length)") == "length m");
  // The number stays what it is where it can.
  const double mass = get_parameter(m, "bodies.spindle.mass"), ball = get_parameter(m, "parameters.m");
  const auto value = [&](const char* text) {
    return lacking_parameter(m, "bodies.spindle.mass", text)->value;
  };
  REQUIRE(mass != 1);
  CHECK(value("m0") == mass);
  CHECK(value("4*m0") == Approx(mass / 4).epsilon(1e-11));
  CHECK(value("m*factor") == Approx(mass / ball).epsilon(1e-11));
  CHECK(value("m + m0 + 1 t") == 1); // it would be below zero
  CHECK(value("m0*tanh(m0/(1 kg))") == 1);
  CHECK(unit("bodies.collar.mass", "a*b") == "none");
  CHECK(unit("bodies.collar.mass", "m") == "none");
  CHECK(unit("bodies.collar.mass", "L + m0") == "none");
  double& spindle = m.bodies[static_cast<std::size_t>(body_index(m, "spindle"))].mass;
  spindle = 0.2;
  CHECK(value("max(m0, 0.5 kg)") == 1); // linear from there on, but no value gives what is below
}

TEST_CASE("any number is given a name, and a name another") {
  Mechanism m = governor();
  name_number(m, "joints.slide.damping", "d");
  CHECK(get_parameter(m, "parameters.d") == 30);
  CHECK(parameter_unit(m, "parameters.d") == "N s/m");
  CHECK(formula_at(m, "joints.slide.damping") == "d");
  set_parameter(m, "parameters.d", 12);
  CHECK(m.joints[3].coordinates[0].damping == 12);
  says(refusal([&] { name_number(m, "bodies.spindle.mass", "L"); }), "expected a name of its own");
  says(refusal([&] { name_number(m, "bodies.spindle.mass", "2L"); }), "letters, figures");

  rename_parameter(m, "L", "arm");
  CHECK(formula_at(m, "parameters.c") == "arm/2");
  CHECK(m.sliders[1].parameter == "parameters.arm");
  rename_point(m, "P", "pivot");
  CHECK(formula_at(m, "points.B1.0") == "pivot.x - arm");
  CHECK(users_of(m, "l") == std::vector<std::string>{"points.S.1"});
  CHECK(read_scene(write_scene(m)) == m);

  Mechanism without = m;
  remove_parameter(without, "m");
  CHECK(parameter_index(without, "m") < 0);
  CHECK(without.bodies[1].mass == 1);
  CHECK_FALSE(formula_at(without, "bodies.ball1.mass"));
  CHECK(without.bodies == [&] {
    Mechanism same = m;
    for (Body& body : same.bodies) {
      std::erase_if(body.formulas, [](const Formula& f) { return f.text == "m"; });
      for (Shape& shape : body.shapes)
        std::erase_if(shape.formulas,
                      [](const Formula& f) { return f.text.find("(m /") != std::string::npos; });
    }
    return same.bodies;
  }());
}

TEST_CASE("a law that means nothing is refused, and the one before stays") {
  const Mechanism engine = load_scene(FLYBALL_ASSETS "/scenes/governor_engine.json");
  const auto refused = [&](const char* address, const char* text) {
    Mechanism m = engine;
    const std::string why = refusal([&] { set_expression(m, address, text); });
    CHECK(m == engine);
    return why;
  };
  const char *torque = "joints.spin.drive.torque", *load = "joints.spin.drive.load";
  CHECK(says(refused(torque, "2 N m s * rate(nothing)"), "nothing"));
  CHECK(says(refused(torque, "2 N m s * rate(spin"), torque));
  CHECK(says(refused(load, "7500 N * coordinate(spin)"), load));
  CHECK(says(refused(load, "unknown * rate(spin)"), "unknown"));
  CHECK(says(refused("joints.slide.spring.stiffness", "unknown * deflection"), "unknown"));
  CHECK(says(refused("joints.slide.damping", "3 N * (rate"), "damping"));
  Mechanism m = engine;
  set_expression(m, load, "3 N m s * rate(spin)");
  CHECK(formula_at(m, load) == "3 N m s * rate(spin)");
}

TEST_CASE("a law keeps acting without the parameter that it names, and keeps the point") {
  Mechanism engine = load_scene(FLYBALL_ASSETS "/scenes/governor_engine.json");
  remove_parameter(engine, "gain");
  CHECK(formula_at(engine, "joints.spin.drive.torque") == "(7500 N) * (coordinate(slide) - 0.15 m)");
  CHECK(read_scene(write_scene(engine)) == engine);

  Mechanism spring = load_scene(FLYBALL_ASSETS "/scenes/governor_engine.json");
  for (Joint& joint : spring.joints)
    if (joint.name == "slide") joint.coordinates[0].spring = CoordinateSpring{};
  set_expression(spring, "joints.slide.spring.stiffness", "gain * deflection / (1 m)");
  remove_parameter(spring, "gain");
  CHECK(formula_at(spring, "joints.slide.spring.force") == "(7500 N) * deflection / (1 m)");

  Mechanism pointed = load_scene(FLYBALL_ASSETS "/scenes/governor_engine.json");
  pointed.points.push_back({.name = "A", .at = {0.15, 0, 0}});
  set_expression(pointed, "joints.spin.drive.torque", "gain * (coordinate(slide) - A.x)");
  const Mechanism before = pointed;
  CHECK(says(refusal([&] { remove_point(pointed, "A"); }), "names the point A"));
  CHECK(pointed == before);
}

TEST_CASE("copies keep expressions where they mean the same") {
  const Mechanism before = governor();
  Document document(before);
  Mechanism next = before;
  Selection added = paste_text(next, copy_text(before, {{{PartKind::body, "ball1"}}}));
  document.edit("Paste", next, added);
  const Mechanism& pasted = document.stored();
  REQUIRE(pasted.bodies.size() == 5);
  const std::string name = pasted.bodies.back().name;
  CHECK(formula_at(pasted, "bodies." + name + ".mass") == "m");
  CHECK(formula_at(pasted, "bodies." + name + ".position.0") == "B1.x");

  // Moved away, it keeps its mass and stands by itself.
  next = pasted;
  next.bodies.push_back(pasted.bodies.back());
  next.bodies.back().name = "elsewhere";
  next.bodies.back().position += Vec3(1, 0, 0);
  document.edit("Copy", next, {});
  CHECK(formula_at(document.stored(), "bodies.elsewhere.mass") == "m");
  CHECK_FALSE(formula_at(document.stored(), "bodies.elsewhere.position.0"));
  CHECK(formula_at(document.stored(), "bodies.elsewhere.position.1") == "B1.y");

  // In another document, with what the expressions rest on.
  Mechanism other = Document::empty_mechanism();
  paste_text(other, copy_text(before, {{{PartKind::body, "ball1"}}}));
  CHECK(formula_at(other, "bodies.ball1.mass") == "m");
  CHECK(parameter_index(other, "L") >= 0);
  CHECK(parameter_index(other, "k") < 0);
  CHECK(other.bodies[0].position == before.bodies[1].position);

  // There, where the names mean something else, the numbers stay.
  Mechanism strange = Document::empty_mechanism();
  strange.parameters.push_back({"m", "", 7, "kg", {}, {}});
  Document there(strange);
  next = strange;
  added = paste_text(next, copy_text(before, {{{PartKind::body, "ball1"}}}));
  there.edit("Paste", next, added);
  CHECK(there.stored().bodies[0].mass == 1);
  CHECK_FALSE(formula_at(there.stored(), "bodies.ball1.mass"));
}

TEST_CASE("another type of joint and other shapes leave no expression behind") {
  Document document(governor());
  change(document, [](Mechanism& m) {
    m.joints[3].type = JointType::fixed;
    m.joints[3].coordinates.clear();
    m.bodies[1].shapes.erase(m.bodies[1].shapes.begin());
  });
  CHECK_FALSE(formula_at(document.stored(), "joints.slide.coordinate"));
  CHECK(formula_at(document.stored(), "joints.slide.at.1") == "S.y");
  const std::string text = write_scene(document.stored());
  CHECK(write_scene(parse_scene(text)) == text);
}

TEST_CASE("a joint stands at a point at a stroke") {
  Mechanism m = governor();
  stand_at_point(m, "joints.spin.at", "S");
  CHECK(m.joints[0].at == m.points[5].at);
  says(refusal([&] { stand_at_point(m, "joints.spin.at", "nowhere"); }),
       "there is no parameter \"nowhere.x\"");
  CHECK(m.joints[0].at == m.points[5].at);
}

TEST_CASE("an expression of the deflection or rate becomes the law of a spring or damper") {
  Mechanism m = test::shipped("governor");
  set_expression(m, "joints.slide.spring.stiffness", "800 N/m*deflection + 2e5 N/m^3*deflection^3");
  set_expression(m, "joints.slide.damping", "30 N s/m*rate");
  const Joint& slide = m.joints[static_cast<std::size_t>(joint_index(m, "slide"))];
  REQUIRE(spring_law(slide, 0));
  REQUIRE(damper_law(slide, 0));
  CHECK(slide.coordinates[0].damping == 0);
  CHECK_NOTHROW(validate(m));
  CHECK_FALSE(has_number(m, "joints.slide.spring.stiffness"));
}

TEST_CASE("laws are mirrored with their coordinates") {
  Mechanism m = read_scene(R"~({"flyball": 2, "name": "t",
    "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0]}],
    "joints": [{"name": "c", "type": "cylindrical", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 0, 1],
    "spring": [{"force": "=table(deflection, [-1, -2 N m], [0, 1 N m], [1, 9 N m])", "free": 0.25},
               {"force": "=3 N/m*deflection"}], "damping_force": ["=2 N m s*rate + 1 N m s^2*rate^2", null]}]})~");
  const Joint& joint = m.joints[0];
  const Joint image = image_of(joint, Isometry{Mat3(Vec3(-1, 1, 1).asDiagonal()), Vec3::Zero()});
  REQUIRE(spring_law(image, 0));
  REQUIRE(damper_law(image, 0));
  CHECK(spring_law(image, 1)->text == spring_law(joint, 1)->text);
  CHECK(image.coordinates[0].spring->free == -0.25);
  for (const double x : {-1.5, -0.2, 0., 0.6, 3.}) {
    const auto value = [x](const Formula* law, std::string_view variable, double sign) {
      return sign * ForceLaw(law->text, variable)({}, sign * x).value;
    };
    CHECK(value(spring_law(image, 0), spring_variable, 1) ==
          value(spring_law(joint, 0), spring_variable, -1));
    CHECK(value(damper_law(image, 0), damper_variable, 1) ==
          value(damper_law(joint, 0), damper_variable, -1));
  }
}

TEST_CASE("mistakes in expressions are mended one after the other, and the rest is edited before that") {
  Mechanism wrong = governor();
  const std::vector<GivenNumber> given = given_numbers(wrong);
  REQUIRE(given.size() > 1);
  const std::string first = given.front().address, last = given.back().address;
  const auto put = [](Mechanism& mechanism, const std::string& address, const std::string& text) {
    const FormulaPlace place = formula_place(mechanism, address);
    std::ranges::find(*place.formulas, std::string(place.key), &Formula::key)->text = text;
  };
  put(wrong, first, "xq");
  put(wrong, last, "LL");
  Document document(wrong);
  change(document, [](Mechanism& m) { m.gravity.y() = -1; });
  CHECK(document.stored().gravity.y() == -1);
  // What has a value follows: a parameter moves what rests on it, and a number that is given stays so.
  const double arm = document.stored().points[1].at.x(), length = document.stored().parameters[0].value;
  change(document, [&](Mechanism& m) { m.parameters[0].value = length + 0.01; });
  CHECK(document.stored().points[1].at.x() == Approx(arm - 0.01));
  change(document, [](Mechanism& m) { m.points[1].at.x() = 7; });
  CHECK(document.stored().points[1].at.x() == Approx(arm - 0.01));
  change(document, [&](Mechanism& m) { m.parameters[0].value = length; });
  // The names are no mistake of this edit; one more is.
  CHECK(says(refusal([&] { change(document, [&](Mechanism& m) { put(m, given[1].address, "no_such"); }); }),
             "xq"));
  const auto mend = [&](const std::string& address, const std::string& text) {
    change(document, [&](Mechanism& m) { set_expression(m, address, text); });
  };
  SECTION("from the first") {
    mend(first, given.front().text);
    CHECK_FALSE(find_mistakes(document.stored()).empty());
    mend(last, given.back().text);
  }
  SECTION("from the last") {
    mend(last, given.back().text);
    CHECK_FALSE(find_mistakes(document.stored()).empty());
    mend(first, given.front().text);
  }
  CHECK(find_mistakes(document.stored()).empty());
  Mechanism right = governor();
  right.gravity.y() = -1;
  CHECK(document.stored() == right);
}
