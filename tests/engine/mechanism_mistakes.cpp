// Every kind of mistake: where it is reported, and what is said.
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include "tests/catch.hpp"
#include "tests/engine/mechanism_everything.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/scenes.hpp"

#include <limits>

using namespace flyball;
using namespace flyball::test;

namespace {

void check_mistake(const std::string& text, std::string_view where, std::string_view expected) {
  try {
    read_scene(text);
    FAIL_CHECK("accepted, though " << where << " is wrong");
  } catch (const SceneError& error) {
    CHECK(error.where() == where);
    CHECK_THAT(error.expected(), ContainsSubstring(std::string(expected)));
  }
}

// Mistakes that are JSON of the right form.
constexpr Mistake mistakes_of_meaning[] = {
    // names
    {R"("name": "arm")", R"("name": "")", "bodies[1].name", "not empty"},
    {R"("name": "arm")", R"("name": "a.b")", "bodies[1].name", "without dots"},
    {R"("name": "arm")", R"("name": "ground")", "bodies[1].name", "the fixed world"},
    {R"("name": "arm")", R"("name": "a\nb")", "bodies[1].name", "control characters"},
    {R"("name": "arm")", R"("name": "table")", "bodies[1].name", "bodies[0] is called \"table\" too"},
    {R"("name": "slide",)", R"("name": "spin",)", "joints[2].name", "joints[0] is called \"spin\" too"},
    {R"("name": "turn")", R"("name": "push")", "forces[2].name", "forces[1]"},
    // bodies
    {R"("mass": 2)", R"("mass": -2)", "bodies.table.mass", "expected zero or more, found -2"},
    {R"("mass": 2)", R"("mass": 2e30)", "bodies.table.mass", "no more than 1e30"},
    {R"("inertia": [1, 1.5, 1])", R"("inertia": [-1, 1.5, 1])", "bodies.table.inertia", "negative principal"},
    {R"(0.7, 0.01, 0.02, 0.03)", R"(0.7, 0.6, 0, 0)", "bodies.arm.inertia", "negative principal"},
    {R"("rotation": [0.6, 0, 0.8, 0])", R"("rotation": [0, 0, 0, 0])", "bodies.table.rotation", "length 0"},
    {R"("rotation": [0.6, 0, 0.8, 0])", R"("rotation": [1, 0, 1, 0])", "bodies.table.rotation",
     "unit quaternion"},
    {R"("radius": 0.25)", R"("radius": 0)", "bodies.table.shapes[0].radius", "above zero"},
    {R"("size": [0.1, 0.2, 0.3])", R"("size": [0.1, 0, 0.3])", "bodies.table.shapes[1].size", "above zero"},
    {R"("from": [0, 0, 0], "to": [0, 0.1, 0])", R"("from": [0, 0, 0], "to": [0, 0, 0])",
     "bodies.table.shapes[2].to", "apart from"},
    {R"("color": [0.5, 0.25, 1])", R"("color": [0.5, 0.25, 255])", "bodies.table.shapes[0].color",
     "from 0 to 1"},
    // joints
    {R"("bodies": ["table", "arm"])", R"("bodies": ["tabel", "arm"])", "joints.hinge.bodies[0]",
     "no body is called \"tabel\"; did you mean \"table\"?"},
    {R"("bodies": ["table", "arm"])", R"("bodies": ["arm", "arm"])", "joints.hinge.bodies", "\"arm\" twice"},
    {R"("axis": [0, 0, 2])", R"("axis": [0, 0, 0])", "joints.hinge.axis", "not zero"},
    {R"("axis": [0, 0, 2])", R"("axis": [0, 0, 1e-300])", "joints.hinge.axis", "not zero"},
    {R"("axes": [[1, 0, 0], [0, 1, 0]])", R"("axes": [[1, 0, 0], [0, 0, 0]])", "joints.cardan.axes[1]",
     "not zero"},
    {R"("axes": [[1, 0, 0], [0, 1, 0]])", R"("axes": [[1, 1, 0], [-2, -2, 0]])", "joints.cardan.axes",
     "not parallel"},
    {R"("x_axis": [1, 0, 1])", R"("x_axis": [0, -1, 0])", "joints.ice.x_axis", "not parallel to `axis`"},
    {R"("damping": 4)", R"("damping": -4)", "joints.hinge.damping", "expected zero or more, found -4"},
    {R"("damping": [5, null])", R"("damping": [5, -1])", "joints.thread.damping[1]", "zero or more"},
    {R"("lower": -1)", R"("lower": 2)", "joints.hinge.stop.lower", "no more than `upper`"},
    {R"("stiffness": 900)", R"("stiffness": 0)", "joints.hinge.stop.stiffness", "above zero"},
    {R"("damping": [1, 2, 3])", R"("drive": [null, {"speed": 1}, null])", "joints.socket.drive[1]",
     "use revolute joints"},
    {R"([{"speed": 8}, null, null, null, null, null])", R"([null, null, null, null, null, {"speed": 8}])",
     "joints.flight.drive[5]", "use revolute joints"},
    {R"("cut": false)", R"("cut": true, "drive": {"speed": 1})", "joints.slide.drive",
     "cut joint has no coordinate"},
    {R"("length": 5.5)", R"("length": 0)", "joints.tie.length", "above zero"},
    {R"("length": 5.5)", R"("length": 5.5, "cut": false)", "joints.tie.cut",
     "a distance joint is always cut"},
    {R"("ratio": 3)", R"("ratio": 3, "cut": false)", "joints.worm.cut", "a gear joint is always cut"},
    {R"("at": [0, 0, 7])", R"("at": [0, 0, 7], "cut": true)", "joints.flight.cut",
     "a free joint holds nothing"},
    {R"([[1, 0, 0], [0, 0, 5]], "length": 5.5)", R"([[1, 0, 5], [1, 0, 5]])", "joints.tie.points",
     "two points apart"},
    // gears
    {R"("joints": ["hinge", "axle"])", R"("joints": ["hing", "axle"])", "joints.teeth.joints[0]",
     "did you mean \"hinge\"?"},
    {R"("joints": ["hinge", "axle"])", R"("joints": ["hinge", "teeth"])", "joints.teeth.joints[1]",
     "another joint than the gear itself"},
    {R"("joints": ["hinge", "axle"])", R"("joints": ["hinge", "weld"])", "joints.teeth.joints[1]",
     "a fixed joint has none"},
    {R"("joints": ["hinge", "axle"])", R"("joints": ["hinge", "tie"])", "joints.teeth.joints[1]",
     "a distance joint has none"},
    {R"("joints": ["hinge", "axle"])", R"("joints": ["hinge", "hinge"])", "joints.teeth.joints",
     "two different coordinates"},
    {R"("joints": ["hinge", "axle"])", R"("joints": ["hinge.0", "axle"])", "joints.teeth.joints[0]",
     "expected \"hinge\""},
    {R"("cardan.1")", R"("cardan")", "joints.worm.joints[1]", "\"cardan.0\" to \"cardan.1\""},
    {R"("cardan.1")", R"("cardan.2")", "joints.worm.joints[1]", "\"cardan.0\" to \"cardan.1\""},
    {R"("cardan.1")", R"("cardan.x")", "joints.worm.joints[1]", "\"cardan.0\" to \"cardan.1\""},
    {R"("cardan.1")", R"("socket.1")", "joints.worm.joints[1]", "rotation vector"},
    {R"("ratio": 3)", R"("ratio": 0)", "joints.worm.ratio", "other than zero"},
    {R"("bodies": ["table", "pinion"], "at": [0, 0, 9])",
     R"("bodies": ["table", "pinion"], "cut": true, "at": [0, 0, 9])", "joints.teeth.joints[1]", "not cut"},
    // forces
    {R"("bodies": ["ground", "arm"])", R"("bodies": ["ground", "harm"])", "forces.coil.bodies[1]",
     "did you mean \"arm\"?"},
    {R"("bodies": ["ground", "arm"])", R"("bodies": ["ground", "ground"])", "forces.coil.bodies", "twice"},
    {R"("points": [[0, 2, 0], [1, 1, 0]])", R"("points": [[1, 1, 0], [1, 1, 0]])", "forces.coil.points",
     "no direction"},
    {R"("free_length": 0.9)", R"("free_length": -0.9)", "forces.coil.free_length", "zero or more"},
    {R"("damping": 1.5)", R"("damping": -1.5)", "forces.coil.damping", "zero or more"},
    {R"("body": "ball")", R"("body": "bal")", "forces.air.body", "did you mean \"ball\"?"},
    {R"("body": "ball")", R"("body": "ground")", "forces.air.body", "the ground does not move"},
    {R"("linear": 0.125)", R"("linear": -1)", "forces.air.linear", "zero or more"},
    {R"("quadratic": 0.375)", R"("quadratic": -1)", "forces.air.quadratic", "zero or more"},
    // sliders, simulation, view
    {R"("parameter": "joints.spin.drive.speed")", R"("parameter": "joints.spin.drive.sped")",
     "sliders[0].parameter", "joints.spin.drive.sped: there is no \"sped\" here; what exists: speed"},
    {R"("range": [0, 30])", R"("range": [3, 3])", "sliders[0].range", "found 3 twice"},
    {R"("range": [10, 1000])", R"("range": [0, 1000])", "sliders[1].range", "the scale is log"},
    {R"("range": [10, 1000])", R"("range": [1000, -10])", "sliders[1].range", "the scale is log"},
    {R"("duration": 20)", R"("duration": 0)", "simulation.duration", "above zero"},
    {R"("distance": 4)", R"("distance": -4)", "view.camera.distance", "above zero"},
    // connections
    {R"({"name": "plate", "mass": "=2 kg)",
     R"({"name": "ball 2", "mass": 1, "position": [0, 0, 0]}, {"name": "plate", "mass": "=2 kg)",
     "bodies.ball 2", "ball 2 is not connected"},
    {R"("cut": false)", R"("cut": true)", "joints.slide.cut", "without this joint slider is not connected"},
    // drives
    {R"("speed": 10})", R"("speed": 10}, "spring": {"stiffness": 1})", "joints.spin.spring", "never settles"},
    {R"("speed": 10})", R"("speed": 10}, "stop": {"lower": 0, "stiffness": 1})", "joints.spin.stop",
     "never settles"},
    {R"("drive": [{"speed": 6}, null])", R"("drive": [null, {"speed": 6}])", "joints.thread.spring[1]",
     "never settles"},
    {R"("bodies": ["table", "pinion"], "at": [0, 0, 9])",
     R"("bodies": ["table", "pinion"], "drive": {"speed": 1}, "at": [0, 0, 9])", "joints.hinge.spring",
     "driven through the gear teeth"},
    {R"("at": [0, 0, 8]})",
     R"("at": [0, 0, 8]}, {"name": "lock", "type": "fixed", "bodies": ["ground", "plate"], "at": [0, 0, 0]})",
     "joints.spin.drive", "in the loop of spin, lock and weld"},
};

} // namespace

TEST_CASE("The scene with everything is right") {
  CHECK_NOTHROW(read_scene(everything));
}

TEST_CASE("Mistakes of form are told with their place") {
  for (const Mistake& mistake : mistakes_of_form) {
    INFO(mistake.find << "  ->  " << mistake.replace);
    check_mistake(edited(mistake.find, mistake.replace), mistake.where, mistake.expected);
  }
}

TEST_CASE("Mistakes of meaning are told with their place") {
  for (const Mistake& mistake : mistakes_of_meaning) {
    INFO(mistake.find << "  ->  " << mistake.replace);
    check_mistake(edited(mistake.find, mistake.replace), mistake.where, mistake.expected);
  }
}

TEST_CASE("Text that is not JSON is told with line and column") {
  check_mistake("", "", "empty");
  check_mistake(" \n\t ", "", "empty");
  check_mistake("[1, 2]", "", "expected an object, found an array of 2 elements");
  check_mistake("{\n  \"flyball\": 1,\n  \"name\" 3}", "line 3, column 10", "not JSON");
  check_mistake("{\"flyball\": 1", "line 1, column 14", "not JSON");
  check_mistake("{\"flyball\": NaN}", "line 1, column 13", "not JSON");
  check_mistake("{\"flyball\": Infinity}", "line 1, column 13", "not JSON");
  check_mistake("{\"flyball\": 1} x", "line 1, column 16", "not JSON");
  check_mistake("{\"flyball\": 1, // no\n}", "line 1, column 16", "not JSON");
  check_mistake("{\n\"name\": \"\xFF\"}", "line 2, column 10", "UTF-8");
  check_mistake("\xFF\xFE{", "line 1, column 1", "UTF-8");
  check_mistake("{\"name\": \"\xED\xA0\x80\"}", "line 1, column 11", "UTF-8");
}

TEST_CASE("JSON that other readers would let pass is refused") {
  check_mistake(edited(R"("mass": 2)", R"("mass": 1e999)"), "bodies.table.mass", "1e999 is too large");
  check_mistake(edited(R"([0, -9.80665, 0])", R"([0, -1e400, 0])"), "gravity[1]", "too large");
  check_mistake(edited(R"("mass": 2)", R"("mass": 2, "mass": 2)"), "bodies.table.mass", "twice");
  check_mistake(edited(R"("speed": 10)", R"("speed": 10, "speed": 10)"), "joints.spin.drive.speed", "twice");
  check_mistake(edited(R"("name": "Everything")", R"("name": "Everything", "name": "Everything")"), "name",
                "twice");
  const std::string depth(100000, '[');
  check_mistake(
      edited(R"("gravity": [0, -9.80665, 0])", R"("gravity": )" + depth),
      "gravity" +
          [] {
            std::string path;
            for (int i = 0; i < 31; ++i)
              path += "[0]";
            return path;
          }(),
      "expected at most 32 levels");
}

TEST_CASE("A byte order mark is no mistake") {
  CHECK_NOTHROW(read_scene("\xEF\xBB\xBF" + std::string(everything)));
}

namespace {

// Wheels a, b, c on axles of the same names.
Mechanism three_wheels() {
  Mechanism m;
  for (const char* name : {"a", "b", "c"}) {
    m.bodies.push_back(body(name));
    m.joints.push_back(revolute(name, "ground", name, {0, 0, 0}));
  }
  return m;
}

std::string text_of(const std::vector<SceneError>& mistakes) {
  std::string text;
  for (const SceneError& error : mistakes)
    text += error.what() + std::string("\n");
  return text;
}

std::string mistakes_of(const Mechanism& mechanism) {
  return text_of(find_mistakes(mechanism));
}

} // namespace

TEST_CASE("Drives that contradict each other through gears") {
  Mechanism m = three_wheels();
  m.joints.push_back(gear("ab", "a", "b", 2));
  m.joints.push_back(gear("bc", "b", "c", -3));
  CHECK(mistakes_of(m).empty());
  m.joints[0].coordinates[0].drive = Drive{5};
  CHECK(mistakes_of(m).empty());

  SECTION("agreeing drives are right, by a chain of gears too") {
    m.joints[2].coordinates[0].drive = Drive{-30};
    CHECK(mistakes_of(m).empty());
  }
  SECTION("by a chain of gears") {
    m.joints[2].coordinates[0].drive = Drive{30};
    CHECK_THAT(mistakes_of(m), ContainsSubstring("expected drives that agree: the drive of"));
    CHECK(find_mistakes(m).size() == 1);
  }
  SECTION("by gears in a circle") {
    m.joints.push_back(gear("ca", "c", "a", 1));
    CHECK_THAT(mistakes_of(m), ContainsSubstring("by another way"));
  }
  SECTION("a stop on a coordinate driven through two gears") {
    m.joints[2].coordinates[0].stop = Stop{0.0, std::nullopt, 10};
    CHECK_THAT(mistakes_of(m),
               ContainsSubstring("joints.c.stop") && ContainsSubstring("through the gear bc"));
  }
  SECTION("driven through a gear and held by a fixed joint") {
    Joint lock;
    lock.name = "lock";
    lock.type = JointType::fixed;
    lock.bodies = {"ground", "b"};
    m.joints.push_back(lock);
    CHECK_THAT(mistakes_of(m), ContainsSubstring("b drives b, which lock holds: expected no drive"));
  }
}

TEST_CASE("Drives that close a loop") {
  Mechanism m = three_wheels();
  m.joints[1].bodies = {"a", "b"};
  m.joints[2].bodies = {"b", "c"};
  m.joints.push_back(revolute("back", "c", "ground", {0, 0, 0}));
  for (std::size_t i = 0; i < 3; ++i)
    m.joints[i].coordinates[0].drive = Drive{1};
  CHECK(mistakes_of(m).empty());
  m.joints[3].coordinates[0].drive = Drive{-3};
  CHECK_THAT(mistakes_of(m),
             ContainsSubstring("joints.back.drive: expected a joint that is neither driven nor fixed "
                               "in the loop of back, c, b and a"));
}

TEST_CASE("Two drives of one shaft") {
  Mechanism m = three_wheels();
  m.joints.push_back(revolute("spin", "ground", "b", {0, 0, 0}));
  m.joints.back().coordinates[0].drive = Drive{1};
  m.joints[1].coordinates[0].drive = Drive{1};
  CHECK(mistakes_of(m) ==
        "joints.spin.drive: spin drives b, which b drives already: expected one drive for both\n");
  SECTION("by torque, too") {
    for (const std::size_t j : {std::size_t{1}, m.joints.size() - 1})
      m.joints[j].coordinates[0].drive->torque = 2;
    CHECK_THAT(mistakes_of(m), ContainsSubstring("spin drives b, which b drives already"));
  }
  SECTION("one of them by torque") {
    m.joints[1].coordinates[0].drive->torque = 2;
    CHECK_THAT(mistakes_of(m), ContainsSubstring("joints.b.drive: b drives b, which spin drives already"));
  }
}

TEST_CASE("What holds a body") {
  Mechanism m = three_wheels();
  m.joints.resize(2);
  m.joints[1].bodies = {"a", "b"};
  CHECK(mistakes_of(m) == "bodies.c: c is not connected\n");

  SECTION("a distance joint") {
    Joint tie;
    tie.name = "tie";
    tie.type = JointType::distance;
    tie.bodies = {"b", "c"};
    tie.length = 1;
    m.joints.push_back(tie);
    CHECK(mistakes_of(m).empty());
  }
  SECTION("a spring") {
    Force spring;
    spring.name = "spring";
    spring.bodies = {"c", "ground"};
    spring.points[1] = {1, 0, 0};
    m.forces.push_back(spring);
    CHECK(mistakes_of(m).empty());
    m.joints[1].cut = true;
    CHECK(mistakes_of(m) == "joints.b.cut: expected false, or the key left out: without this joint b is not "
                            "connected\n");
    m.forces[0].bodies = {"c", "b"};
    CHECK_THAT(mistakes_of(m),
               ContainsSubstring("c is not connected") || ContainsSubstring("b is not connected"));
    m.joints.push_back(revolute("second", "ground", "c", {0, 0, 0}));
    CHECK(mistakes_of(m).empty());
  }
  SECTION("only another body that hangs on nothing") {
    m.joints[1].bodies = {"b", "c"};
    CHECK(mistakes_of(m) == "bodies.b: b is not connected to the ground, nor is c\n");
    Body more;
    more.mass = 1;
    for (const char* name : {"d", "e", "f", "g"}) {
      more.name = name;
      m.bodies.push_back(more);
      m.joints.push_back(revolute(std::string("to_") + name, "c", name, {0, 0, 0}));
    }
    CHECK(mistakes_of(m) == "bodies.b: b is not connected to the ground, nor are c, d, e, f and 1 more\n");
  }
}

TEST_CASE("Numbers that are none are found wherever they stand") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Mechanism right = read_scene(everything);
  const auto check = [&](auto&& change, const std::string& where) {
    for (const double bad : {nan, infinity, -infinity}) {
      Mechanism m = right;
      change(m, bad);
      REQUIRE_FALSE(find_mistakes(m).empty());
      CHECK(find_mistakes(m).front().where() == where);
    }
  };
  check([](Mechanism& m, double x) { m.gravity.y() = x; }, "gravity[1]");
  check([](Mechanism& m, double x) { m.bodies[0].inertia[4] = x; }, "bodies.table.inertia[4]");
  check([](Mechanism& m, double x) { m.bodies[0].rotation.y() = x; }, "bodies.table.rotation");
  check([](Mechanism& m, double x) { m.bodies[0].shapes[0].radius = x; }, "bodies.table.shapes[0].radius");
  check([](Mechanism& m, double x) { m.bodies[0].shapes[0].at->z() = x; }, "bodies.table.shapes[0].at");
  check([](Mechanism& m, double x) { m.bodies[0].shapes[2].from.z() = x; }, "bodies.table.shapes[2].to");
  check([](Mechanism& m, double x) { m.joints[1].coordinates[0].spring->free = x; },
        "joints.hinge.spring.free");
  check([](Mechanism& m, double x) { m.joints[1].coordinates[0].stop->lower = x; },
        "joints.hinge.stop.lower");
  check([](Mechanism& m, double x) { m.joints[3].coordinates[0].drive->speed = x; },
        "joints.thread.drive[0].speed");
  check([](Mechanism& m, double x) { m.joints[4].axis2.x() = x; }, "joints.cardan.axes[1][0]");
  check([](Mechanism& m, double x) { m.joints[10].points[1].x() = x; }, "joints.tie.points[1][0]");
  check([](Mechanism& m, double x) { m.joints[11].ratio = x; }, "joints.teeth.ratio");
  check([](Mechanism& m, double x) { m.forces[0].points[0].x() = x; }, "forces.coil.points[0][0]");
  check([](Mechanism& m, double x) { m.forces[1].at->x() = x; }, "forces.push.at[0]");
  check([](Mechanism& m, double x) { m.sliders[0].to = x; }, "sliders[0].range");
  check([](Mechanism& m, double x) { m.simulation.duration = x; }, "simulation.duration");
  check([](Mechanism& m, double x) { m.view.camera->azimuth = x; }, "view.camera.azimuth");
}

TEST_CASE("After a number was set the mistakes are those that a look at all parts finds") {
  std::vector<Mechanism> mechanisms{read_scene(everything)};
  std::erase_if(mechanisms.emplace_back(mechanisms[0]).joints,
                [](const Joint& joint) { return joint.type == JointType::gear; });
  for (const std::string& file : shipped_files())
    mechanisms.push_back(load_scene(file));
  int wrong = 0;
  for (const Mechanism& right : mechanisms) {
    REQUIRE(mistakes_of(right).empty());
    for (const std::string& address : parameter_addresses(right)) {
      const double value = get_parameter(right, address);
      for (const double other : {0., 1e-300, -value, 0.5 * value + 0.1, 2e30, -2e30}) {
        Mechanism m = right;
        try {
          set_parameter(m, address, other);
        } catch (const SceneError&) { // expressions can make nothing of it
          REQUIRE(m == right);
          continue;
        }
        const std::string all = mistakes_of(m);
        INFO(m.name << " " << address << " " << other);
        CHECK(text_of(find_mistakes(m, address)) == all);
        wrong += !all.empty();
      }
    }
  }
  CHECK(wrong > 500);
}
