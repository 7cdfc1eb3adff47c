#include "app/document/clipboard.hpp"
#include "app/document/coordinate_image.hpp"
#include "app/document/copies.hpp"
#include "app/document/isometry.hpp"
#include "app/document/remove.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/app/document_mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

// Spindle, collar, one ball.
Mechanism half_governor() {
  Mechanism m = shipped("governor");
  remove_parts(m, {{{PartKind::body, "ball2"}}});
  REQUIRE(m.joints.size() == 4);
  return m;
}

const Selection ball1{{{PartKind::body, "ball1"}}};

const Joint& joint(const Mechanism& m, std::string_view name) {
  const int i = joint_index(m, name);
  REQUIRE(i >= 0);
  return m.joints[static_cast<std::size_t>(i)];
}

bool has_negative_zero(const Mechanism& m) {
  const std::string text = write_scene(m);
  return text.find("-0.0,") != std::string::npos || text.find("-0.0]") != std::string::npos;
}

std::string copied(const std::string& name) {
  return name + "2";
}

// The mirror image alone.
Mechanism mirror_image(Mechanism m, const Vec3& point, const Vec3& normal) {
  const Selection all = everything_of(m);
  mirror_parts(m, all, point, normal);
  remove_parts(m, all);
  m.gravity = reflection(point, normal)->vector(m.gravity);
  return m;
}

} // namespace

TEST_CASE("the governor comes out of the mirror") {
  Mechanism m = half_governor();
  const Selection copies = mirror_parts(m, ball1, {0, 0, 0}, {3, 0, 0});
  CHECK(copies == Selection{{{PartKind::body, "ball2"}}});
  REQUIRE(find_mistakes(m).empty());
  CHECK_FALSE(has_negative_zero(m));

  // It is the shipped one, number for number.
  const Mechanism given = shipped("governor");
  REQUIRE(m.bodies.size() == 4);
  CHECK(m.bodies.back() == given.bodies[2]);
  for (const char* name : {"arm2", "link2"}) {
    Joint wanted = joint(given, name);
    wanted.description = joint(given, name == std::string("arm2") ? "arm1" : "link1").description;
    CHECK(joint(m, name) == wanted);
  }
  const Solution ours = Analysis(m).solve(), theirs = Analysis(given).solve();
  CHECK(std::abs(value(ours, "slide") - value(theirs, "slide")) < 1e-12);
  CHECK(std::abs(value(ours, "arm2") - value(ours, "arm1")) < 1e-12);
}

TEST_CASE("governors with three and four arms settle with all arms alike") {
  const double two_arms = value(Analysis(shipped("governor")).solve(), "arm1");
  for (const int count : {3, 4}) {
    Mechanism m = half_governor();
    const Selection copies = circular_copy(m, ball1, {0, 0.7, 0}, {0, -2, 0}, count);
    REQUIRE(copies.parts.size() == static_cast<std::size_t>(count - 1));
    CHECK(copies.parts.back() == Part{PartKind::body, "ball" + std::to_string(count)});
    // With a collar and a spring to match they stand as two do.
    set_parameter(m, "bodies.collar.mass", count / 2.0);
    set_parameter(m, "joints.slide.spring.stiffness", 1000 * count / 2.0);
    const Solution s = Analysis(m).solve();
    REQUIRE(s.status == Status::converged);
    for (int i = 1; i <= count; ++i)
      CHECK(std::abs(value(s, "arm" + std::to_string(i)) - two_arms) < 1e-10);
  }
  Mechanism two = half_governor();
  circular_copy(two, ball1, {0, 0, 0}, {0, 1, 0}, 2);
  CHECK(std::abs(value(Analysis(two).solve(), "slide") -
                 value(Analysis(shipped("governor")).solve(), "slide")) < 1e-12);
}

TEST_CASE("third and quarter turns leave no round-off where there need be none") {
  Mechanism m = half_governor();
  circular_copy(m, ball1, {0, 0, 0}, {0, 1, 0}, 4);
  CHECK(m.bodies[3].position == Vec3(0, 0.2, 0.16));
  CHECK(m.bodies[4].position == Vec3(0.16, 0.2, 0));
  CHECK(m.bodies[5].position == Vec3(0, 0.2, -0.16));
}

TEST_CASE("duplicates stand beside and share what was not selected") {
  Mechanism m = shipped("governor");
  const Selection copies = duplicate_parts(m, ball1, {0, 0, 0.5});
  CHECK(copies == Selection{{{PartKind::body, "ball3"}}});
  CHECK(m.bodies.back().position == Vec3(-0.16, 0.2, 0.5));
  CHECK(joint(m, "arm3").bodies == std::array<std::string, 2>{"spindle", "ball3"});
  CHECK(joint(m, "arm3").at == Vec3(0, 0.2, 0.5));
  CHECK(joint(m, "link3").bodies == std::array<std::string, 2>{"ball3", "collar"});
  CHECK(m.bodies.size() == 5);
  CHECK(m.joints.size() == 8);
}

TEST_CASE("parts selected by themselves are copied between the same bodies") {
  Mechanism m = shipped("governor");
  const Selection link{{{PartKind::joint, "link1"}}};
  CHECK(mirror_parts(m, link, {0, 0, 0}, {1, 0, 0}) == Selection{{{PartKind::joint, "link3"}}});
  CHECK(joint(m, "link3").bodies == joint(m, "link1").bodies);
  CHECK(joint(m, "link3").points[0] == Vec3(0.08, 0.2, 0));
  CHECK(m.bodies.size() == 4);
}

TEST_CASE("gears are copied with both their joints, and keep their meaning") {
  Mechanism m = parse_scene(R"({"flyball": 1, "name": "gears",
    "bodies": [{"name": "screw", "mass": 1, "position": [1, 0, 0]}, {"name": "wheel", "mass": 1, "position": [1, 1, 0]}],
    "joints": [
      {"name": "mesh", "type": "gear", "joints": ["thread.0", "axle"], "ratio": 3, "offset": 0.5},
      {"name": "thread", "type": "cylindrical", "bodies": ["ground", "screw"], "at": [1, 0, 0], "axis": [1, 2, 0],
       "coordinate": [0.1, 0.2], "stop": [{"lower": -1, "stiffness": 5}, {"lower": -2, "stiffness": 6}],
       "drive": [{"speed": 4}, {"speed": 5}]},
      {"name": "axle", "type": "revolute", "bodies": ["ground", "wheel"], "at": [1, 1, 0], "axis": [1, 2, 0]}]})");
  mirror_parts(m, {{{PartKind::body, "screw"}}}, {0, 0, 0}, {1, 0, 0});
  CHECK(joint_index(m, "mesh2") == -1);
  mirror_parts(m, {{{PartKind::body, "screw"}, {PartKind::body, "wheel"}}}, {0, 0, 0}, {1, 0, 0});
  const Joint& mesh = joint(m, "mesh2");
  CHECK(mesh.joints == std::array<std::string, 2>{"thread3.0", "axle2"});
  // The slide keeps its numbers and the angle changes its sign.
  CHECK(mesh.ratio == -3);
  CHECK(mesh.offset == 0.5);
  const Joint& thread = joint(m, "thread3");
  CHECK(thread.axis == Vec3(-1, 2, 0));
  CHECK(thread.coordinates[0].drawn == -0.1);
  CHECK(thread.coordinates[0].stop->upper == 1);
  CHECK_FALSE(thread.coordinates[0].stop->lower);
  CHECK(thread.coordinates[0].drive->speed == -4);
  CHECK(thread.coordinates[1] == joint(m, "thread").coordinates[1]);
  CHECK(joint(m, "axle2").axis == Vec3(1, -2, 0));
}

TEST_CASE("random mechanisms in the mirror settle as mirror images, at planes across the world's axes") {
  int settled = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    CAPTURE(seed);
    const Mechanism m = random_mechanism(seed);
    const int axis = static_cast<int>(seed % 3);
    const Vec3 point(0.3, -0.2, 0.1);
    const Mechanism image = mirror_image(m, point, Vec3::Unit(axis));
    settled += check_settles_as_image(m, image, *reflection(point, Vec3::Unit(axis)), copied);
  }
  CHECK(settled > 120);
}

TEST_CASE("random mechanisms in the mirror settle as mirror images, at any plane") {
  int settled = 0;
  for (std::uint32_t seed = 1000; seed < 1150; ++seed) {
    CAPTURE(seed);
    Dice dice(seed);
    const Vec3 point = dice.box(1);
    // Every third one also trades two world axes.
    const Vec3 normal = seed % 3 == 0 ? Vec3(0, 1, -1) : dice.direction();
    const Mechanism m = random_mechanism(seed, {.alike = seed % 3 != 0});
    settled += check_settles_as_image(m, mirror_image(m, point, normal), *reflection(point, normal), copied);
  }
  CHECK(settled > 120);
}

TEST_CASE("mirrored twice is what it was") {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    Dice dice(seed);
    const Mechanism m = random_mechanism(seed, {.alike = true});
    const Vec3 point = dice.box(1);
    const Vec3 normal = seed % 2 == 0 ? Vec3(Vec3::Unit(dice.below(3))) : dice.direction();
    const Mechanism twice = mirror_image(mirror_image(m, point, normal), point, normal);
    REQUIRE(twice.bodies.size() == m.bodies.size());
    REQUIRE(twice.joints.size() == m.joints.size());
    REQUIRE(twice.forces.size() == m.forces.size());
    const auto near = [](const auto& a, const auto& b) { return (a - b).norm() < 1e-13; };
    for (std::size_t i = 0; i < m.bodies.size(); ++i) {
      const Body &a = m.bodies[i], &b = twice.bodies[i];
      CHECK(near(a.position, b.position));
      CHECK(a.rotation.angularDistance(b.rotation) < 1e-7);
      CHECK(a.inertia == b.inertia);
      REQUIRE(a.shapes.size() == b.shapes.size());
      for (std::size_t k = 0; k < a.shapes.size(); ++k) {
        CHECK(near(a.shapes[k].from, b.shapes[k].from));
        CHECK(near(a.shapes[k].to, b.shapes[k].to));
        CHECK(near(a.shapes[k].at.value_or(Vec3::Zero()), b.shapes[k].at.value_or(Vec3::Zero())));
      }
    }
    for (std::size_t i = 0; i < m.joints.size(); ++i) {
      const Joint &a = m.joints[i], &b = twice.joints[i];
      CHECK(near(a.at, b.at));
      CHECK(near(a.axis, b.axis));
      CHECK(near(a.axis2, b.axis2));
      CHECK(near(a.points[0], b.points[0]));
      CHECK(a.ratio == b.ratio);
      CHECK(a.offset == b.offset);
      for (std::size_t k = 0; k < a.coordinates.size(); ++k) {
        CHECK(std::abs(a.coordinates[k].drawn - b.coordinates[k].drawn) < 1e-15);
        CHECK(a.coordinates[k].stop == b.coordinates[k].stop);
        CHECK(a.coordinates[k].drive == b.coordinates[k].drive);
      }
    }
    for (std::size_t i = 0; i < m.forces.size(); ++i) {
      CHECK(near(m.forces[i].points[1], twice.forces[i].points[1]));
      CHECK(near(m.forces[i].vector, twice.forces[i].vector));
    }
  }
}

TEST_CASE("a copy turned by any angle settles as the turned image") {
  int settled = 0;
  for (std::uint32_t seed = 2000; seed < 2060; ++seed) {
    CAPTURE(seed);
    Dice dice(seed);
    const Mechanism m = random_mechanism(seed, {.alike = true});
    const Vec3 point = dice.box(1), axis = dice.direction();
    const int count = 2 + dice.below(5);
    Mechanism image = m;
    const Selection all = everything_of(m);
    const Selection copies = circular_copy(image, all, point, axis, count);
    CHECK(copies.parts.size() == all.parts.size() * static_cast<std::size_t>(count - 1));
    Selection others = all;
    for (std::size_t i = all.parts.size(); i < copies.parts.size(); ++i)
      others.add(copies.parts[i]);
    remove_parts(image, others);
    const auto isometry = rotation_about(point, axis, 2 * M_PI / count);
    image.gravity = isometry->vector(image.gravity);
    settled += check_settles_as_image(m, image, *isometry, copied);
  }
  CHECK(settled > 45);
}

TEST_CASE("no copies at a plane or about an axis that is none") {
  Mechanism m = shipped("governor");
  const Mechanism before = m;
  CHECK(mirror_parts(m, ball1, {0, 0, 0}, {0, 0, 0}).empty());
  CHECK(circular_copy(m, ball1, {0, 0, 0}, {0, NAN, 0}, 3).empty());
  CHECK(circular_copy(m, ball1, {0, 0, 0}, {0, 1, 0}, 1).empty());
  CHECK(duplicate_parts(m, {{{PartKind::body, "nobody"}}}, {0, 0, 1}).empty());
  CHECK(m == before);
}

TEST_CASE("the torque of a copied drive is one of the copies' coordinates") {
  Mechanism m = shipped("governor_engine");
  const auto law = [&](const std::string& name) {
    const Joint& found = joint(m, name);
    REQUIRE(found.formulas.size() == 1);
    return found.formulas[0].text;
  };
  const Selection bodies{{{PartKind::body, "spindle"},
                          {PartKind::body, "ball1"},
                          {PartKind::body, "ball2"},
                          {PartKind::body, "collar"}}};
  SECTION("duplicated") {
    duplicate_parts(m, bodies, {1, 0, 0});
    CHECK(law("spin2") == "gain * (coordinate(slide2) - 0.15 m)");
    CHECK(law("spin") == "gain * (coordinate(slide) - 0.15 m)");
    REQUIRE(find_mistakes(m).empty());
  }
  SECTION("pasted") {
    paste_text(m, copy_text(m, bodies));
    CHECK(law("spin2") == "gain * (coordinate(slide2) - 0.15 m)");
    REQUIRE(find_mistakes(m).empty());
  }
  SECTION("the shaft alone, between the same bodies") {
    duplicate_parts(m, {{{PartKind::joint, "spin"}}}, {1, 0, 0});
    CHECK(law("spin2") == "gain * (coordinate(slide) - 0.15 m)");
  }
  SECTION("by places and measures") {
    m.points.push_back({"top", {0, 0.2, 0}});
    m.measures.push_back({"height", "", "y(collar)", "m"});
    const auto give = [&](const std::string& text) {
      m.joints[static_cast<std::size_t>(joint_index(m, "spin"))].formulas[0].text = text;
    };
    give("gain*(0.05 m - height) - 1 N*x(ball1) + 1 N*distance(ball1, ball2) + 1 N*distance(collar, "
         "ground@top)");
    duplicate_parts(m, bodies, {1, 0.5, 0});
    CHECK(law("spin2") == "gain*(0.05 m - ((y(collar2) - 0.5 m))) - 1 N*(x(ball3) - 1 m) + "
                          "1 N*distance(ball3, ball4) + 1 N*distance(collar2, ground@top2)");
    CHECK(find_mistakes(m).empty());
    CHECK(m.points.back().at == Vec3(1, 0.7, 0));
    // A quarter of a turn about the vertical.
    m = shipped("governor_engine");
    give("1 N*x(ball1) - 1 N s*vz(ball1)");
    circular_copy(m, bodies, {0, 0, 0}, {0, 1, 0}, 4);
    CHECK(law("spin2") == "1 N*(-z(ball3)) - 1 N s*vx(ball3)");
    // Elsewhere there may be no such measure.
    m = shipped("governor_engine");
    m.measures.push_back({"height", "", "y(collar)", "m"});
    give("gain*(0.05 m - height)");
    Mechanism other = shipped("governor_engine");
    paste_text(other, copy_text(m, bodies));
    CHECK(joint(other, "spin2").formulas[0].text == "gain*(0.05 m - (y(collar2)))");
    CHECK(find_mistakes(other).empty());
  }
  SECTION("in the mirror a cylindrical joint's angle turns the other way") {
    Joint& spin = m.joints[static_cast<std::size_t>(joint_index(m, "spin"))];
    spin.type = JointType::cylindrical;
    spin.coordinates.resize(2);
    spin.formulas[0].key = "drive.0.torque";
    mirror_parts(m, bodies, {1, 0, 0}, {1, 0, 0});
    CHECK(law("spin2") == "-(gain * (coordinate(slide2) - 0.15 m))");
    CHECK(joint(m, "spin2").coordinates[0].drive->speed == -11);
  }
}
