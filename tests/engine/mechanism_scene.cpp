// Scenes read and written.
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include "tests/catch.hpp"
#include "tests/engine/mechanism_everything.hpp"
#include "tests/engine/mechanism_random.hpp"
#include "tests/support/scenes.hpp"

#include <filesystem>
#include <limits>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("The paper's values are shipped") {
  const Mechanism pendulum = shipped("pendulum");
  CHECK(pendulum.gravity == Vec3::Zero());
  REQUIRE(pendulum.joints.size() == 3);
  CHECK(pendulum.joints[0].coordinates.at(0).drive == Drive{20});
  CHECK(pendulum.joints[1].coordinates.at(0).spring == CoordinateSpring{300, 1.0472});
  CHECK(pendulum.joints[2].coordinates.at(0).spring == CoordinateSpring{50000, 1});
  CHECK(pendulum.joints[2].coordinates.at(0).drawn == 1.1);
  CHECK(pendulum.bodies.at(1).mass == 0);

  const Mechanism governor = shipped("governor");
  CHECK(governor.gravity == Vec3(0, -9.80665, 0));
  REQUIRE(governor.joints.size() == 6);
  CHECK(governor.joints[0].coordinates.at(0).drive == Drive{11.0174});
  CHECK(governor.joints[3].coordinates.at(0).spring == CoordinateSpring{1000, 0.15});
  CHECK(governor.joints[3].coordinates.at(0).drawn == 0.0744);
  CHECK(governor.joints[5].length == 0.10922);
}

TEST_CASE("Every shipped scene is right, described, and written as the program writes it") {
  const std::vector<std::string> scenes = shipped_files();
  CHECK(scenes.size() >= 9);
  for (const std::string& file : scenes) {
    INFO(file);
    const Mechanism mechanism = load_scene(file);
    CHECK_FALSE(mechanism.name.empty());
    CHECK_FALSE(mechanism.description.empty());
    CHECK_FALSE(mechanism.sliders.empty());
    const std::string text = write_scene(mechanism);
    CHECK(text == read_bytes(file));
    CHECK(read_scene(text) == mechanism);
  }
}

TEST_CASE("Every key is read into its field") {
  const Mechanism m = read_scene(everything);
  CHECK(m.description == "all kinds of parts");
  const Body& table = m.bodies.at(0);
  CHECK(table.rotation.coeffs() == Quat(0.6, 0, 0.8, 0).coeffs());
  CHECK(table.inertia == std::array<double, 6>{1, 1.5, 1, 0, 0, 0});
  CHECK(m.bodies.at(1).inertia == std::array<double, 6>{0.5, 0.6, 0.7, 0.01, 0.02, 0.03});
  REQUIRE(table.shapes.size() == 4);
  CHECK(table.shapes[0].color == std::array<double, 3>{0.5, 0.25, 1});
  CHECK(table.shapes[0].at == Vec3(0, 1, 0));
  CHECK(table.shapes[1].size == Vec3(0.1, 0.2, 0.3));
  CHECK(table.shapes[3].type == ShapeType::capsule);
  CHECK(table.shapes[3].to == Vec3(0, 0, 2));

  const Coordinate& hinge = m.joints.at(1).coordinates.at(0);
  CHECK(hinge.drawn == 0.5);
  CHECK(hinge.spring == CoordinateSpring{300, 0.1, "coil"});
  CHECK(hinge.damping == 4);
  CHECK(hinge.stop == Stop{-1.0, 1.25, 900, "rubber"});
  CHECK(hinge.friction == Friction{{}, 0.125, 44.0, 0.0625, -0.375, "dry"});
  CHECK(m.joints.at(2).cut == false);
  CHECK_FALSE(m.joints.at(1).cut.has_value());
  const std::vector<Coordinate>& thread = m.joints.at(3).coordinates;
  REQUIRE(thread.size() == 2);
  CHECK(thread[1].drawn == 0.3);
  CHECK_FALSE(thread[0].spring.has_value());
  CHECK(thread[1].spring == CoordinateSpring{70, 0});
  CHECK(thread[0].damping == 5);
  CHECK(thread[1].damping == 0);
  CHECK(thread[0].drive == Drive{6});
  CHECK_FALSE(thread[1].drive.has_value());
  CHECK(m.joints.at(4).axis2 == Vec3(0, 1, 0));
  CHECK(m.joints.at(6).axis2 == Vec3(1, 0, 1));
  CHECK(m.joints.at(7).coordinates.size() == 6);
  CHECK(m.joints.at(10).points[1] == Vec3(0, 0, 5));
  CHECK(m.joints.at(10).length == 5.5);
  CHECK(m.joints.at(11).joints == std::array<std::string, 2>{"hinge", "axle"});
  CHECK(m.joints.at(11).ratio == -2);
  CHECK(m.joints.at(11).offset == 0.75);
  CHECK_FALSE(m.joints.at(12).offset.has_value());

  const Force& coil = m.forces.at(0);
  CHECK(coil.free_length == 0.9);
  CHECK(coil.damping == 1.5);
  CHECK(m.forces.at(1).frame == ForceFrame::body);
  CHECK(m.forces.at(1).at == Vec3(1, 2, 3));
  CHECK(m.forces.at(2).frame == ForceFrame::world);
  CHECK_FALSE(m.forces.at(2).at.has_value());
  CHECK(m.forces.at(3).quadratic == 0.375);
  CHECK(m.joints.at(13).radii == std::array{0.75, 0.5});
  CHECK(m.joints.at(13).crossed);
  CHECK(m.joints.at(14).radii[0] == -0.125);
  CHECK(m.joints.at(15).lead == 0.0625);
  CHECK(m.forces.at(5).chord == Vec3(1, 0, 0));
  CHECK(m.forces.at(5).area == 0.1);
  CHECK(m.air == Air{1.5, Vec3(1, 2.5, 0), "", "cold"});
  CHECK(m.sliders.at(0).description == "main");
  CHECK(m.sliders.at(1).scale == SliderScale::log);
  CHECK(m.simulation == Simulation{20, false, "long"});
  CHECK(m.view.camera == Camera{{0, 1, 0}, 4, 0.6, 0.3, "near"});
  CHECK(m.view.description == "side");
}

TEST_CASE("What is read is written back, descriptions too") {
  const Mechanism m = read_scene(everything);
  const std::string text = write_scene(m);
  CHECK(read_scene(text) == m);
  for (const char* description : {"all kinds of parts", "turns", "knob", "motor", "sprung", "coil", "rubber",
                                  "dry", "holds", "main", "long", "side", "near", "cold"})
    CHECK_THAT(text, ContainsSubstring("\"description\": \"" + std::string(description) + "\""));
}

TEST_CASE("Seeded random mechanisms read back as they were written") {
  RandomMechanism random(20260101);
  for (int i = 0; i < 500; ++i) {
    const Mechanism m = random();
    const std::string text = write_scene(m);
    INFO(text);
    REQUIRE(parse_scene(text) == m);
    REQUIRE(write_scene(parse_scene(text)) == text);
  }
}

TEST_CASE("Keys at their default are left out and numbers are as short as they can be") {
  Mechanism m;
  m.name = "Small";
  m.gravity = {0, -0.1, 1e-5};
  Body body;
  body.name = "b";
  body.mass = 200;
  m.bodies.push_back(body);
  Joint joint;
  joint.name = "j";
  joint.type = JointType::cylindrical;
  joint.bodies = {"ground", "b"};
  joint.coordinates.resize(2);
  joint.coordinates[1].drive = Drive{1.0 / 3};
  m.joints.push_back(joint);
  CHECK(write_scene(m) == R"({
  "flyball": 1,
  "name": "Small",
  "gravity": [0, -0.1, 1e-05],
  "bodies": [
    {"name": "b", "mass": 200, "position": [0, 0, 0]}
  ],
  "joints": [
    {
      "name": "j",
      "type": "cylindrical",
      "bodies": ["ground", "b"],
      "at": [0, 0, 0],
      "axis": [0, 0, 1],
      "drive": [null, {"speed": 0.3333333333333333}]
    }
  ]
}
)");
}

TEST_CASE("What JSON cannot hold is not written") {
  Mechanism m = read_scene(everything);
  m.joints[1].coordinates[0].spring->stiffness = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(write_scene(m),
                    "joints.hinge.spring.stiffness: expected a finite number; JSON has no other");
  m = read_scene(everything);
  m.bodies[0].description = "\xFF";
  CHECK_THROWS_WITH(write_scene(m), "bodies.table.description: expected UTF-8 text");
}

TEST_CASE("An unfinished mechanism can be parsed, its mistakes told together") {
  const std::string text = edited(R"("mass": 2)", R"("mass": -2)");
  const Mechanism m = parse_scene(text);
  CHECK(m.bodies.at(0).mass == -2);
  CHECK(find_mistakes(m).size() == 1);
  CHECK_THROWS_AS(validate(m), SceneError);
}

TEST_CASE("The version comes before all else") {
  CHECK_THROWS_WITH(read_scene(R"({"wheels": 3, "flyball": 7})"),
                    "flyball: expected 1 or 2, the versions of the format that this program reads, found 7");
}
