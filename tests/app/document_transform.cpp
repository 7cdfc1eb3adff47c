#include "app/document/isometry.hpp"
#include "app/document/remove.hpp"
#include "app/document/rename.hpp"
#include "app/document/transform.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/app/document_mechanisms.hpp"
#include "tests/engine/mechanism_everything.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

Part body(const std::string& name) {
  return {PartKind::body, name};
}
Part joint(const std::string& name) {
  return {PartKind::joint, name};
}
Part force(const std::string& name) {
  return {PartKind::force, name};
}

const Body& body_of(const Mechanism& m, std::string_view name) {
  return m.bodies[static_cast<std::size_t>(body_index(m, name))];
}
const Joint& joint_of(const Mechanism& m, std::string_view name) {
  return m.joints[static_cast<std::size_t>(joint_index(m, name))];
}
const Force& force_of(const Mechanism& m, const std::string& name) {
  return m.forces[static_cast<std::size_t>(force_index(m, name))];
}

std::string same(const std::string& name) {
  return name;
}

} // namespace

TEST_CASE("a body takes along what is its own") {
  const Mechanism before = read_scene(everything);
  Mechanism m = before;
  move_parts(m, {{body("arm")}}, {0, 0, 0.5});
  CHECK(body_of(m, "arm").position == Vec3(1, 0, 0.5));
  CHECK(joint_of(m, "hinge") == joint_of(before, "hinge")); // its other body stays
  CHECK(joint_of(m, "tie").points == std::array<Vec3, 2>{Vec3(1, 0, 0.5), Vec3(0, 0, 5)});
  CHECK(joint_of(m, "tie").length == 5.5);
  CHECK(force_of(m, "coil").points == std::array<Vec3, 2>{Vec3(0, 2, 0), Vec3(1, 1, 0.5)});
  CHECK(force_of(m, "push").at == Vec3(1, 2, 3.5));
  CHECK_FALSE(force_of(m, "turn").at);
  CHECK(body_of(m, "table") == body_of(before, "table"));

  Mechanism both = before;
  move_parts(both, {{body("arm"), body("table"), joint("hinge")}}, {0, 1, 0});
  CHECK(joint_of(both, "hinge").at == Vec3(1, 2, 0)); // once
  CHECK(joint_of(both, "spin") == joint_of(before, "spin"));
  CHECK(joint_of(both, "slide") == joint_of(before, "slide"));
  const Body& table = body_of(both, "table");
  CHECK(table.shapes[0].at == Vec3(0, 2, 0));
  CHECK_FALSE(table.shapes[1].at);
  CHECK(table.shapes[3].to == Vec3(0, 1, 2));
}

TEST_CASE("a joint or force selected by itself moves and turns its own") {
  const Mechanism before = read_scene(everything);
  Mechanism m = before;
  const Quat quarter(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
  rotate_parts(m, {{joint("ice"), joint("cardan"), joint("tie"), force("turn"), force("push")}}, {0, 0, 0},
               quarter);
  CHECK(m.bodies == before.bodies);
  CHECK(joint_of(m, "ice").at == Vec3(0, -6, 0));
  CHECK(joint_of(m, "ice").axis == Vec3(0, 0, 3));
  CHECK(joint_of(m, "ice").axis2 == Vec3(1, -1, 0));
  CHECK(joint_of(m, "cardan").axis == Vec3(1, 0, 0));
  CHECK(joint_of(m, "cardan").axis2 == Vec3(0, 0, 1));
  CHECK(joint_of(m, "tie").points == std::array<Vec3, 2>{Vec3(1, 0, 0), Vec3(0, -5, 0)});
  CHECK(force_of(m, "turn").vector == Vec3(7, -9, 8));
  CHECK(force_of(m, "turn").at == Vec3(1, 0, 0)); // it was at the arm's mass centre, and that is on the axis
  CHECK(force_of(m, "push").vector == Vec3(4, -6, 5)); // in the arm's axes, which are the world's
  CHECK(force_of(m, "push").at == Vec3(1, -3, 2));
}

TEST_CASE("a turned body keeps what is in its own axes") {
  const Mechanism before = read_scene(everything);
  Mechanism m = before;
  const Quat quarter(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));
  rotate_parts(m, {{body("arm"), body("table"), force("push")}}, {1, 0, 0}, quarter);
  const Body& arm = body_of(m, "arm");
  CHECK(arm.position == Vec3(1, 0, 0));
  CHECK((arm.rotation * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-15);
  CHECK(arm.inertia == body_of(before, "arm").inertia);
  CHECK(force_of(m, "push").vector == Vec3(4, 5, 6));
  CHECK(force_of(m, "turn").vector == Vec3(7, 8, 9)); // in the world's axes
  CHECK(joint_of(m, "hinge").axis == Vec3(0, 0, 2));
  CHECK(joint_of(m, "hinge").at == Vec3(0, 0, 0));
}

TEST_CASE("components of a free joint trade places as the world's axes do, followed by what refers to them") {
  Mechanism m = read_scene(everything);
  m.joints.push_back(m.joints[12]);
  m.joints.back().name = "belt";
  m.joints.back().joints = {"axle", "flight.0"};
  m.joints.back().offset = 0.5;
  m.sliders = {{"joints.flight.drive.0.speed", 1, 9, SliderScale::log, ""},
               {"joints.flight.at.0", 1, 9, SliderScale::log, ""},
               {"joints.socket.damping.0", 1, 9, SliderScale::log, ""}};
  rotate_parts(m, {{joint("flight"), joint("socket")}}, {0, 0, 0},
               Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY())));
  const auto& flight = joint_of(m, "flight").coordinates;
  CHECK_FALSE(flight[0].drive);
  CHECK(flight[2].drive->speed == -8);
  const auto& socket = joint_of(m, "socket").coordinates;
  CHECK(socket[0].damping == 3);
  CHECK(socket[1].damping == 2);
  CHECK(socket[2].damping == 1);
  const Joint& belt = joint_of(m, "belt");
  CHECK(belt.joints == std::array<std::string, 2>{"axle", "flight.2"});
  CHECK(belt.ratio == -3);
  CHECK(belt.offset == -0.5);
  CHECK(m.sliders == std::vector<Slider>{{"joints.flight.drive.2.speed", -9, -1, SliderScale::linear, ""},
                                         {"joints.flight.at.0", 1, 9, SliderScale::log, ""},
                                         {"joints.socket.damping.2", 1, 9, SliderScale::log, ""}});
}

TEST_CASE("components of a free joint mix where what acts along them is alike, and stay where it is not") {
  Mechanism m = read_scene(everything);
  Joint& flight = m.joints[7];
  REQUIRE(flight.name == "flight");
  for (std::size_t i = 0; i < 3; ++i) {
    flight.coordinates[i].drive = Drive{static_cast<double>(i)};
    flight.coordinates[i + 3].spring = CoordinateSpring{i == 1 ? 5.0 : 7.0, 0.3};
    flight.coordinates[i + 3].drawn = 0.1 * static_cast<double>(i);
  }
  flight.coordinates[5].stop = Stop{-0.3, {}, 9};
  const auto component = [&](std::size_t first, auto number) {
    const std::vector<Coordinate>& all = m.joints[7].coordinates;
    return Vec3(number(all[first]), number(all[first + 1]), number(all[first + 2]));
  };
  const auto speed = [](const Coordinate& c) { return c.drive->speed; };
  const auto drawn = [](const Coordinate& c) { return c.drawn; };
  const auto free = [](const Coordinate& c) { return c.spring->free; };
  // About y the springs along x and z mix, which are alike; the one along y does not take part.
  const Quat about_y(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
  rotate_parts(m, {{joint("flight")}}, {0, 0, 0}, about_y);
  CHECK((component(0, speed) - about_y * Vec3(0, 1, 2)).norm() < 1e-15);
  CHECK((component(3, drawn) - about_y * Vec3(0, 0.1, 0.2)).norm() < 1e-15);
  CHECK((component(3, free) - about_y * Vec3(0.3, 0.3, 0.3)).norm() < 1e-15);
  // About x they are not.
  const Vec3 stretch_before = component(3, drawn) - component(3, free), drawn_before = component(3, drawn);
  const Quat about_x(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  rotate_parts(m, {{joint("flight")}}, {0, 0, 0}, about_x);
  CHECK((component(3, drawn) - component(3, free) - stretch_before).norm() < 1e-15);
  CHECK(std::abs(component(3, drawn).z() - *m.joints[7].coordinates[5].stop->lower - 0.5) < 1e-15);
  CHECK((component(3, drawn) - about_x * drawn_before).norm() < 1e-15);
}

TEST_CASE("single points are taken hold of") {
  Mechanism m = read_scene(everything);
  const auto check_moves = [&](const PointId& point, const Vec3& from) {
    CAPTURE(point.part.name, point.end);
    CHECK(point_position(m, point) == from);
    const Vec3 to(0.1, 0.2, 0.3);
    set_point(m, point, to);
    CHECK(point_position(m, point) == to);
  };
  check_moves({joint("hinge"), 0}, {1, 1, 0});
  check_moves({joint("tie"), 0}, {1, 0, 0});
  check_moves({joint("tie"), 1}, {0, 0, 5});
  check_moves({force("coil"), 1}, {1, 1, 0});
  check_moves({force("turn"), 0}, {1, 0, 0});
  check_moves({body("arm"), 0}, {1, 0, 0});
  CHECK(joint_of(m, "tie").points[0] == Vec3(0.1 - 0.9, 0.2 + 0.2, 0.3 + 0.3)); // taken along by the arm
  CHECK(joint_of(m, "tie").length == 5.5);
  CHECK(force_of(m, "coil").free_length == 0.9);

  const Mechanism before = m;
  for (const PointId& none : {PointId{joint("hinge"), 1}, PointId{joint("tie"), 2},
                              PointId{joint("teeth"), 0}, PointId{body("arm"), 1}, PointId{body("nobody"), 0},
                              PointId{joint("tie"), -1}, PointId{force("air"), 1}, PointId{}}) {
    CHECK_FALSE(point_position(m, none));
    set_point(m, none, {9, 9, 9});
  }
  set_point(m, {body("arm"), 0}, {NAN, 0, 0});
  CHECK(m == before);
}

TEST_CASE("the centre of a selection is the mean of its points") {
  const Mechanism m = read_scene(everything);
  CHECK(centre_of(m, {{body("arm"), joint("tie")}}) == Vec3(2, 0, 5) / 3);
  CHECK(centre_of(m, {{force("turn")}}) == Vec3(1, 0, 0));
  CHECK_FALSE(centre_of(m, {}));
  CHECK_FALSE(centre_of(m, {{joint("teeth"), body("nobody")}}));
}

TEST_CASE("everything moved and turned together settles as it did") {
  int settled = 0;
  for (std::uint32_t seed = 3000; seed < 3150; ++seed) {
    CAPTURE(seed);
    Dice dice(seed);
    const bool moved = seed % 3 == 0, quarter = seed % 3 == 1;
    const Mechanism before = random_mechanism(seed, {.alike = !moved && !quarter});
    Mechanism m = before;
    Isometry isometry;
    if (moved) {
      isometry = translation(dice.box(2));
      move_parts(m, everything_of(m), isometry.shift);
    } else {
      const Vec3 centre = dice.box(1);
      const Quat rotation =
          quarter ? Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::Unit(dice.below(3)))) : dice.rotation();
      isometry = *rotation_about(centre, rotation);
      rotate_parts(m, everything_of(m), centre, rotation);
      m.gravity = isometry.vector(m.gravity);
    }
    settled += check_settles_as_image(before, m, isometry, same);
  }
  CHECK(settled > 120);
}

TEST_CASE("other names change nothing else") {
  int settled = 0;
  for (std::uint32_t seed = 4000; seed < 4040; ++seed) {
    CAPTURE(seed);
    const Mechanism before = random_mechanism(seed);
    Mechanism m = before;
    for (const Part& part : everything_of(before).parts)
      rename_part(m, part, "the new " + part.name);
    settled +=
        check_settles_as_image(before, m, {}, [](const std::string& name) { return "the new " + name; });
  }
  CHECK(settled > 30);
}

TEST_CASE("whatever is removed, nothing refers to it any more") {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Dice dice(seed);
    Mechanism m = random_mechanism(seed);
    const Selection all = everything_of(m);
    for (const std::string& address : parameter_addresses(m))
      if (dice.chance(0.1)) m.sliders.push_back({address, 0, 1, SliderScale::linear, ""});
    Selection some;
    for (int i = 1 + dice.below(3); i > 0; --i)
      some.add(dice.one_of(all.parts));
    const Selection gone = with_dependents(m, some);
    remove_parts(m, some);
    CHECK(existing(gone, m).empty());
    CHECK(everything_of(m).parts.size() == all.parts.size() - gone.parts.size());
    for (const SceneError& mistake : find_mistakes(m))
      CHECK_THAT(mistake.what(), ContainsSubstring("is not connected"));
  }
}
