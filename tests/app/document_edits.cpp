#include "app/document/clipboard.hpp"
#include "app/document/create.hpp"
#include "app/document/document.hpp"
#include "app/document/remove.hpp"
#include "app/document/rename.hpp"
#include "app/document/snap_points.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/app/document_mechanisms.hpp"
#include "tests/engine/mechanism_everything.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

Mechanism everything_scene() {
  return read_scene(everything);
}

Part body(const std::string& name) {
  return {PartKind::body, name};
}
Part joint(const std::string& name) {
  return {PartKind::joint, name};
}
Part force(const std::string& name) {
  return {PartKind::force, name};
}

double value(const Mechanism& m, const std::string& joint) {
  return test::value(Analysis(m).solve(), joint);
}

std::vector<std::string> what_mistakes(const Mechanism& m) {
  std::vector<std::string> all;
  for (const SceneError& mistake : find_mistakes(m))
    all.emplace_back(mistake.what());
  return all;
}

} // namespace

TEST_CASE("the swing pendulum is built from nothing") {
  // Choi, Park and Yoo, section 3.1, in the numbers of assets/scenes/pendulum.json.
  const Mechanism given = shipped("pendulum");
  Mechanism m = Document::empty_mechanism();
  m.gravity = given.gravity;
  for (const Body& wanted : given.bodies) {
    const std::string name = add_body(m, {.form = BodyForm::block, .at = wanted.position});
    Body& made = m.bodies.back();
    made.mass = wanted.mass;
    made.inertia = wanted.inertia;
    rename_part(m, body(name), wanted.name);
  }
  for (const Joint& wanted : given.joints) {
    const std::string name = add_joint(m, wanted.type, wanted.bodies, wanted.at, wanted.axis);
    m.joints.back().coordinates = wanted.coordinates;
    rename_part(m, joint(name), wanted.name);
  }
  REQUIRE(what_mistakes(m).empty());
  const Solution ours = Analysis(m).solve(), theirs = Analysis(given).solve();
  REQUIRE(ours.coordinates.size() == theirs.coordinates.size());
  for (std::size_t i = 0; i < ours.coordinates.size(); ++i)
    CHECK(ours.coordinates[i].value == theirs.coordinates[i].value);
}

TEST_CASE("new parts have names nobody has, and are right at once") {
  Mechanism m = Document::empty_mechanism();
  CHECK(add_body(m, {.form = BodyForm::ball}) == "ball1");
  CHECK(add_body(m, {.form = BodyForm::ball, .at = {1, 0, 0}}) == "ball2");
  m.bodies[0].name = "ball3";
  CHECK(add_body(m, {.form = BodyForm::ball, .at = {2, 0, 0}}) == "ball1");
  CHECK(add_body(m, {.form = BodyForm::ball, .at = {3, 0, 0}}) == "ball4");
  CHECK(unused_name(m, PartKind::joint, "ball") == "ball1");
  CHECK(unused_name(m, PartKind::body, "M6") == "M61");

  // A universal or planar joint gets a second axis across the first.
  CHECK(add_joint(m, JointType::universal, {"ground", "ball1"}, {2, 0, 0}, {-2, 0, 0}) == "universal1");
  CHECK(add_joint(m, JointType::planar, {"ground", "ball2"}, {1, 0, 0}, {0, 1, 0}) == "planar1");
  CHECK(add_joint(m, JointType::fixed, {"ground", "ball3"}, {0, 0, 0}, {0, 1, 0}) == "fixed1");
  CHECK(add_distance(m, {"ball3", "ball4"}, {Vec3(0, 0, 0), Vec3(3, 0, 0)}) == "link1");
  CHECK(add_gear(m, {"universal1.0", "universal1.1"}, 2) == "gear1");
  CHECK(add_spring(m, {"ball1", "ball2"}, {Vec3(2, 0, 0), Vec3(1, 0, 0)}, 100, 1) == "spring1");
  CHECK(add_spring(m, {"ball1", "ball2"}, {Vec3(2, 0, 0), Vec3(1, 0, 0)}, 0, 1) == "damper1");
  CHECK(add_spring(m, {"ball1", "ball2"}, {Vec3(2, 0, 0), Vec3(2, 0, 0)}, 5, 0) == "spring2");
  CHECK(add_force(m, ForceType::force, "ball4", {3, 0, 0}, {1, 2, 3}) == "force1");
  CHECK(add_force(m, ForceType::torque, "ball4", {3, 0, 0}, {1, 2, 3}) == "torque1");
  CHECK(add_force(m, ForceType::drag, "ball4", {3, 0, 0}, {1, 2, 3}) == "drag1");
  CHECK(what_mistakes(m).empty());
  CHECK(parse_scene(write_scene(m)) == m);
}

TEST_CASE("a part takes along what hangs on it") {
  Mechanism m = everything_scene();
  const Selection hinge = with_dependents(m, {{joint("hinge")}});
  CHECK(hinge == Selection{{joint("hinge"), joint("teeth"), joint("worm"), joint("strap")}});

  const Selection arm = with_dependents(m, {{body("arm")}});
  for (const Part& part : {joint("hinge"), joint("slide"), joint("tie"), joint("teeth"), joint("worm"),
                           force("coil"), force("push"), force("turn")})
    CHECK(arm.has(part));
  CHECK(arm.has(joint("strap")));
  CHECK(arm.parts.size() == 10);
  remove_parts(m, arm);
  CHECK(joint_index(m, "spin") == 0);
  CHECK(m.forces.size() == 4);
  // The slider of the hinge's spring went with the hinge.
  REQUIRE(m.sliders.size() == 1);
  CHECK(m.sliders[0].parameter == "joints.spin.drive.speed");
  CHECK(what_mistakes(m) == std::vector<std::string>{"bodies.slider: slider is not connected"});
}

TEST_CASE("a name is followed wherever it stands") {
  const Mechanism before = shipped("governor");
  Mechanism m = before;
  rename_part(m, body("spindle"), "joints");
  rename_part(m, joint("spin"), "collar");
  rename_part(m, joint("slide"), "球 \"1\"");
  CHECK(m.joints[0].bodies[1] == "joints");
  CHECK(m.sliders[0].parameter == "joints.collar.drive.speed");
  CHECK(m.sliders[1].parameter == "joints.球 \"1\".spring.stiffness");
  REQUIRE(what_mistakes(m).empty());
  CHECK(value(m, "球 \"1\"") == value(before, "slide"));

  Mechanism all = everything_scene();
  rename_part(all, joint("cardan"), "hook");
  rename_part(all, joint("hinge"), "worm wheel");
  rename_part(all, body("arm"), "lever");
  CHECK(all.joints[static_cast<std::size_t>(joint_index(all, "worm"))].joints ==
        std::array<std::string, 2>{"worm wheel", "hook.1"});
  CHECK(all.forces[1].body == "lever");
  CHECK(all.forces[0].bodies[1] == "lever");
  CHECK(what_mistakes(all).empty());
}

TEST_CASE("a name that cannot be is refused, and all stays as it was") {
  Mechanism m = everything_scene();
  const Mechanism before = m;
  for (const char* name : {"", "ground", "a.b", "tab\t", "slider", "\xff"}) {
    INFO(name);
    CHECK_THROWS_AS(rename_part(m, body("arm"), name), SceneError);
  }
  CHECK_THROWS_AS(rename_part(m, body("nobody"), "somebody"), SceneError);
  CHECK_THROWS_AS(rename_part(m, {}, "somebody"), SceneError);
  CHECK_NOTHROW(rename_part(m, body("arm"), "arm"));
  CHECK(m == before);
  CHECK_NOTHROW(rename_part(m, joint("tie"), "arm")); // names are of one list
}

TEST_CASE("copied and pasted into an empty document are the same parts") {
  for (const Mechanism& m : {shipped("governor"), everything_scene()}) {
    Mechanism pasted = Document::empty_mechanism();
    Selection bodies;
    for (const Body& b : m.bodies)
      bodies.add(body(b.name));
    const Selection added = paste_text(pasted, copy_text(m, bodies));
    CHECK(pasted.bodies == m.bodies);
    CHECK(pasted.joints == m.joints);
    CHECK(pasted.forces == m.forces);
    CHECK(pasted.sliders.empty());
    CHECK(added == everything_of(m));
    CHECK(pasted.name == "Untitled");
  }
}

TEST_CASE("what is held by bodies that are not copied stays behind, unless it is selected") {
  const Mechanism m = shipped("governor");
  Mechanism to = Document::empty_mechanism();
  CHECK(paste_text(to, copy_text(m, {{body("ball1")}})) == Selection{{body("ball1")}});
  CHECK(paste_text(to, copy_text(m, {{body("ball1"), joint("arm1")}})) == Selection{{body("ball2")}});

  // Into where the spindle is, the arm finds it by name; what is taken is called otherwise.
  Mechanism same = m;
  const Selection added = paste_text(same, copy_text(m, {{body("ball1"), joint("arm1"), joint("link1")}}));
  CHECK(added == Selection{{body("ball3"), joint("arm3"), joint("link3")}});
  CHECK(same.joints[6].bodies == std::array<std::string, 2>{"spindle", "ball3"});
  CHECK(same.joints[7].bodies == std::array<std::string, 2>{"ball3", "collar"});
  CHECK(what_mistakes(same).empty());
  CHECK(value(same, "arm3") == Approx(value(same, "arm1")).epsilon(1e-9));
}

TEST_CASE("a pasted text may be as unfinished as it likes") {
  Mechanism m = Document::empty_mechanism();
  m.bodies.resize(1);
  m.bodies[0].name = "old";
  add_joint(m, JointType::revolute, {"ground", "old"}, {0, 0, 0}, {0, 0, 1});
  m.joints[0].name = "axle";
  m.joints.push_back(m.joints[0]);
  m.joints[1].name = "lost"; // not the one that the text means
  const Selection added = paste_text(m, R"({"flyball": 1, "name": "odd", "bodies": [
      {"name": "old", "mass": 1, "position": [1, 0, 0]}, {"name": "old", "mass": 2, "position": [2, 0, 0]},
      {"name": "", "mass": 3, "position": [3, 0, 0]}, {"name": "ground", "mass": 4, "position": [4, 0, 0]},
      {"name": "a.b", "mass": 5, "position": [5, 0, 0]}],
    "joints": [
      {"name": "mesh", "type": "gear", "joints": ["hinge", "axle"], "ratio": 2},
      {"name": "lost mesh", "type": "gear", "joints": ["lost", "hinge"], "ratio": 2},
      {"name": "hinge", "type": "revolute", "bodies": ["ground", "old"], "at": [0, 0, 0], "axis": [0, 0, 1]},
      {"name": "lost", "type": "revolute", "bodies": ["nobody", "old"], "at": [0, 0, 0], "axis": [0, 0, 1]},
      {"name": "far", "type": "revolute", "bodies": ["a.b", ""], "at": [0, 0, 0], "axis": [0, 0, 1]}],
    "forces": [{"name": "push", "type": "force", "body": "ground", "vector": [1, 0, 0]},
      {"name": "pull", "type": "force", "body": "nobody", "vector": [1, 0, 0]}]})");
  CHECK(added == Selection{{body("old2"), body("old3"), body("body1"), body("body2"), body("body3"),
                            joint("mesh"), joint("hinge"), joint("far"), force("push")}});
  REQUIRE(m.joints.size() == 5);
  CHECK(m.joints[2].joints == std::array<std::string, 2>{"hinge", "axle"});
  CHECK(m.joints[3].bodies == std::array<std::string, 2>{"ground", "old2"}); // the text's own, the first
  CHECK(m.joints[4].bodies == std::array<std::string, 2>{"body3", "body1"});

  const Mechanism before = m;
  for (const char* text :
       {"", "hello", "{}", "[1, 2]", R"({"flyball": 3, "name": "", "bodies": [], "joints": []})"})
    CHECK_THROWS_AS(paste_text(m, text), SceneError);
  CHECK(m == before);
}

TEST_CASE("snap points are each told once, joints first") {
  const Mechanism m = shipped("governor");
  const std::vector<SnapPoint> points = snap_points(m);
  const auto find = [&](const std::string& what) {
    return std::ranges::find(points, what, &SnapPoint::what);
  };
  REQUIRE(find("spin") != points.end());
  CHECK(find("spin")->point == Vec3(0, 0.2, 0));
  CHECK(find("spin")->part == joint("spin"));
  for (const char* hidden : {"arm1", "arm2", "centre of spindle", "centre of collar"})
    CHECK(find(hidden) == points.end()); // where a joint is told already
  CHECK(find("slide")->point == Vec3(0, 0.1256, 0));
  CHECK(find("centre of ball1")->part == body("ball1"));
  CHECK(find("end of link1")->point == Vec3(-0.08, 0.2, 0));
  CHECK(find("end of spindle")->point == Vec3(0, -0.06, 0));
  CHECK(find("origin")->part.kind == PartKind::none);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      CHECK((points[i].point - points[j].point).norm() > 1e-9);
  const auto origin_alone = snap_points(Document::empty_mechanism());
  REQUIRE(origin_alone.size() == 1);
  CHECK(origin_alone[0].point == Vec3::Zero());
}
