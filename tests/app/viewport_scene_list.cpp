#include "app/viewport/primitives.hpp"
#include "app/viewport/scene_list.hpp"
#include "tests/app/viewport_mechanisms.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

int count(const SceneList& scene, PartId part) {
  return static_cast<int>(std::count_if(scene.instances.begin(), scene.instances.end(),
                                        [&](const Instance& i) { return i.part == part; }));
}

int count(const SceneList& scene, Role role) {
  return static_cast<int>(std::count_if(scene.instances.begin(), scene.instances.end(),
                                        [&](const Instance& i) { return i.role == role; }));
}

const Instance& spring_coil(const SceneList& scene) {
  const auto found = std::find_if(scene.instances.begin(), scene.instances.end(),
                                  [](const Instance& i) { return i.role == Role::spring; });
  REQUIRE(found != scene.instances.end());
  return *found;
}

} // namespace

TEST_CASE("every body and joint of a mechanism without shapes is drawn") {
  const Mechanism m = governor();
  const SceneList scene = build_scene(m, {});
  for (int i = 0; i < 4; ++i)
    CHECK(count(scene, {PartKind::body, i}) > 0);
  for (int i = 0; i < 6; ++i)
    CHECK(count(scene, {PartKind::joint, i}) > 0);
  CHECK(count(scene, Role::drive) == 2); // arc and head
  CHECK(count(scene, Role::damper) > 0);
  CHECK(count(scene, Role::cut_mark) == 0);
}

TEST_CASE("the governor's balls hang on rods to the spindle") {
  const SceneList scene = build_scene(governor(), {});
  int balls = 0, rods = 0;
  for (const Instance& i : scene.instances) {
    if (i.part != PartId{PartKind::body, 1}) continue;
    if (i.primitive == Primitive::sphere) {
      ++balls;
      CHECK((i.position - Vec3(-0.16, 0.2, 0)).norm() < 1e-12);
      CHECK(i.round > 1.5 * scene.scale.unit);
    }
    if (i.primitive == Primitive::capsule) {
      ++rods;
      CHECK(i.extent.z() == Approx(0.08));
    }
  }
  CHECK(balls == 1);
  CHECK(rods == 1);
}

TEST_CASE("the spring's colour tells pressed from stretched, and its length follows the collar") {
  const Mechanism m = governor();
  const Palette& colors = palette(Theme::light);
  const SceneList pressed = build_scene(m, {});
  CHECK(spring_coil(pressed).color == colors.compression);
  std::vector<Pose> poses = drawn_poses(m);
  poses[3].position.y() = 0.2 - 0.25;
  const SceneList stretched = build_scene(m, poses);
  CHECK(spring_coil(stretched).color == colors.tension);
  CHECK(spring_coil(stretched).extent.z() - spring_coil(pressed).extent.z() == Approx(0.25 - 0.0744));
  poses[3].position.y() = 0.2 - 0.15;
  const Color slack = spring_coil(build_scene(m, poses)).color;
  CHECK(std::abs(slack.b - colors.slack.b) < 0.01f);
}

namespace {

// A crank of radius 0.1 m pushes a block to and fro against a spring that ground holds.
Mechanism pushed_block() {
  Mechanism m;
  m.bodies = {body("crank", 0.2, {0.025, 0.0433, 0}), body("rod", 0.2, {0.205, 0.0433, 0}),
              body("block", 1, {0.36, 0, 0})};
  m.bodies[2].shapes.resize(1);
  m.bodies[2].shapes[0].type = ShapeType::box;
  m.bodies[2].shapes[0].size = {0.05, 0.05, 0.05};
  Joint spin = revolute("spin", "ground", "crank", {0, 0, 0}, {0, 0, 1});
  spin.coordinates[0].drive = Drive{15};
  Joint slide = prismatic("slide", "ground", "block", {0.36, 0, 0}, {1, 0, 0});
  slide.coordinates[0].spring = CoordinateSpring{2000, 0.005};
  m.joints = {spin, revolute("pin", "crank", "rod", {0.05, 0.0866, 0}, {0, 0, 1}),
              revolute("end", "rod", "block", {0.36, 0, 0}, {0, 0, 1}), slide};
  return m;
}

bool has_plate_at(const SceneList& scene, const Vec3& at) {
  return std::ranges::any_of(scene.instances, [&](const Instance& i) {
    return (i.role == Role::anchor || i.role == Role::spring) && i.primitive == Primitive::cylinder &&
           (i.position - at).norm() < 1e-9;
  });
}

} // namespace

TEST_CASE("the spring of a slide stands on its plate, which what slides never reaches") {
  const bool stopped = GENERATE(false, true); // far beyond, which is no reason to stand elsewhere
  Mechanism m = pushed_block();
  const Vec3 without = spring_coil(build_scene(m, {})).position;
  if (stopped) m.joints.back().coordinates[0].stop = Stop{.lower = -2, .upper = 0.1, .stiffness = 1e6};
  const Palette& colors = palette(Theme::light);
  const Vec3 foot = spring_coil(build_scene(m, {})).position;
  CHECK((foot - without).norm() < 1e-12);
  for (const double moved : {-0.17, -0.1, -0.05, -0.01, 0.03, 0.04}) {
    INFO(moved);
    std::vector<Pose> poses = drawn_poses(m);
    poses[2].position.x() += moved;
    const SceneList scene = build_scene(m, poses);
    const Instance& coil = spring_coil(scene);
    CHECK((coil.position - foot).norm() < 1e-12);
    CHECK(has_plate_at(scene, foot));
    CHECK(foot.x() < poses[2].position.x() - 0.025 - scene.scale.unit);
    CHECK((coil.rotation * Vec3::UnitZ()).x() > 0.99);
    const bool pressed = moved < 0.005;
    const Color full = pressed ? colors.compression : colors.tension;
    CHECK(std::abs(coil.color.r - full.r) <
          std::abs(coil.color.r - (pressed ? colors.tension : colors.compression).r));
  }
}

TEST_CASE("a spring whose ground is the joint's second body stands on the rail as well") {
  Mechanism m = pushed_block();
  m.joints[3].bodies = {"block", "ground"};
  m.joints[3].axis = {-1, 0, 0};
  const SceneList there = build_scene(m, {}), same = build_scene(pushed_block(), {});
  CHECK((spring_coil(there).position - spring_coil(same).position).norm() < 1e-9);
  CHECK(has_plate_at(there, spring_coil(there).position));
}

TEST_CASE("beyond all that was foreseen the plate of a spring gives way and never lies on the other side") {
  Mechanism m;
  m.bodies = {body("post", 1, {0, 0, 0}), body("weight", 1, {0, 0.1, 0})};
  Joint slide = prismatic("slide", "post", "weight", {0, 0.1, 0}, {0, 1, 0});
  slide.coordinates[0].spring = CoordinateSpring{10, 0};
  m.joints = {joint(JointType::fixed, "hold", "ground", "post", {0, -0.1, 0}, {0, 1, 0}), slide};
  std::vector<Pose> poses = drawn_poses(m);
  poses[1].position.y() = -3;
  const SceneList scene = build_scene(m, poses);
  const Instance& coil = spring_coil(scene);
  CHECK(coil.position.y() < -3);
  CHECK((coil.rotation * Vec3::UnitZ()).y() > 0.99);
  CHECK(coil.color == palette(Theme::light).compression);
  CHECK(has_plate_at(scene, coil.position));
}

namespace {

// A hub that turns about y, and a shoe beside it that slides to and from it along x.
Mechanism hub_and_shoe(double sense) {
  Mechanism m;
  m.gravity = {0, -9.80665, 0};
  m.bodies = {body("hub", 1, {0, 0, 0}), body("shoe", 0.2, {0.1, 0, 0})};
  Shape block;
  block.type = ShapeType::box;
  block.size = {0.05, 0.05, 0.05};
  for (Body& b : m.bodies)
    b.shapes = {block};
  Joint slide = prismatic("slide", "hub", "shoe", {0.1, 0, 0}, {sense, 0, 0});
  slide.coordinates[0].spring = CoordinateSpring{2e4, 0};
  m.joints = {revolute("input", "ground", "hub", {0, 0, 0}, {0, 1, 0}), slide};
  return m;
}

} // namespace

TEST_CASE("the spring of a slide stands on what it slides on, where the slide leads to that") {
  const double sense = GENERATE(1., -1.); // from the hub, or to it
  Mechanism m = hub_and_shoe(sense);
  const Instance coil = spring_coil(build_scene(m, {}));
  CHECK(coil.position.x() == Approx(0.025)); // the hub's face
  // Not where the shoe comes to it.
  Stop stop;
  (sense > 0 ? stop.lower : stop.upper) = -0.05 * sense;
  m.joints[1].coordinates[0].stop = stop;
  CHECK(std::abs(spring_coil(build_scene(m, {})).position.x() - 0.025) > 0.003);
}

TEST_CASE("what a drive is drawn with keeps its size when a joint is added to what turns") {
  Mechanism m;
  m.gravity = {0, -9.80665, 0};
  m.bodies = {body("rod1", 0.1, {0, 0, 0}), body("rod2", 0.1, {0.1, 0.05, 0})};
  const auto rod = [](const Vec3& from, const Vec3& to) {
    Shape shape;
    shape.type = ShapeType::cylinder;
    shape.radius = 0.005;
    shape.from = from;
    shape.to = to;
    return shape;
  };
  const Vec3 half = GENERATE(Vec3(0.1, 0, 0), Vec3(0.07, 0, 0.07));
  m.bodies[0].shapes = {rod(-half, half)};
  m.bodies[1].shapes = {rod(half, half + Vec3(0, 0.1, 0))};
  Joint table = revolute("table", "ground", "rod1", {0, 0, 0}, {0, 1, 0});
  table.coordinates[0].drive = Drive{6};
  m.joints = {table};
  const auto size_of = [](const SceneList& scene, Role role) {
    double most = 0;
    for (const Instance& i : scene.instances)
      if (i.role == role) most = std::max(most, instance_bounds(i).radius());
    return most;
  };
  const SceneList before = build_scene(m, {});
  m.joints.push_back(revolute("hinge", "rod1", "rod2", half, {0, 0, 1}));
  const SceneList after = build_scene(m, {});
  for (const Role role : {Role::drive, Role::anchor}) {
    REQUIRE(size_of(before, role) > 0);
    CHECK(size_of(after, role) / size_of(before, role) == Approx(1).margin(0.3));
  }
}

TEST_CASE("the joint and the drive of a disc that faces the eye are seen") {
  Mechanism m;
  m.bodies = {body("disc", 1)};
  Shape disc;
  disc.type = ShapeType::cylinder;
  disc.radius = 0.06;
  disc.from = {0, 0, -0.01};
  disc.to = {0, 0, 0.01};
  m.bodies[0].shapes = {disc};
  m.joints = {revolute("turn", "ground", "disc", {0, 0, 0}, {0, 0, 1})};
  const auto bounds_of_role = [&](Role role) {
    Bounds all;
    for (const Instance& i : build_scene(m, {}).instances)
      if (i.role == role) all.add(instance_bounds(i));
    return all;
  };
  CHECK(bounds_of_role(Role::joint).upper.z() > 0.011); // before its face
  m.joints[0].coordinates[0].drive = Drive{10};
  CHECK(bounds_of_role(Role::drive).upper.x() > 0.06); // round it
  // One with teeth has it before them.
  Mechanism geared = m;
  geared.bodies.push_back(body("other", 1, {0.2, 0, 0}));
  geared.joints.push_back(revolute("by", "ground", "other", {0.2, 0, 0}, {0, 0, 1}));
  geared.joints.push_back(gear("mesh", "turn", "by", -1));
  for (const Instance& i : build_scene(geared, {}).instances)
    if (i.role == Role::drive) CHECK(instance_bounds(i).upper.x() < 0.06);
  // As when it carries something.
  const double alone = bounds_of_role(Role::drive).upper.x();
  m.bodies.push_back(body("shoe", 0.1, {0.04, 0, 0}));
  m.joints.push_back(prismatic("slide", "disc", "shoe", {0.04, 0, 0}, {1, 0, 0}));
  CHECK(bounds_of_role(Role::drive).upper.x() == Approx(alone).epsilon(0.1));
}

TEST_CASE("the drive of a thick disc in a housing is seen") {
  Mechanism m;
  m.bodies = {body("housing", 1), body("disc", 1)};
  Shape wheel;
  wheel.type = ShapeType::cylinder;
  wheel.radius = 0.1;
  wheel.from = {-0.03, 0, 0};
  wheel.to = {0.03, 0, 0};
  m.bodies[1].shapes = {wheel};
  m.joints = {prismatic("up", "ground", "housing", {0, -0.12, 0}, {0, 1, 0}),
              revolute("spin", "housing", "disc", {0, 0, 0}, {1, 0, 0})};
  m.joints[1].coordinates[0].drive = Drive{50};
  const auto sign = [&] {
    Bounds all;
    for (const Instance& i : build_scene(m, {}).instances)
      if (i.role == Role::drive) all.add(instance_bounds(i));
    return all;
  };
  CHECK(sign().upper.y() > 0.1); // round it
  // In a block it stands before that.
  wheel.type = ShapeType::box;
  wheel.size = {0.06, 0.2, 0.2};
  wheel.at = Vec3(0, 0, 0);
  m.bodies[1].shapes = {wheel};
  CHECK(sign().lower.x() > 0.03);
}

TEST_CASE("parts move with the poses and keep their size") {
  const Mechanism m = governor();
  std::vector<Pose> poses = drawn_poses(m);
  for (Pose& pose : poses) {
    pose.position = Vec3(-pose.position.z(), pose.position.y(), pose.position.x()) + Vec3(1, 2, 3);
    pose.rotation = Quat(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY()));
  }
  const SceneList still = build_scene(m, {}), moved = build_scene(m, poses);
  REQUIRE(still.instances.size() == moved.instances.size());
  CHECK(still.scale.unit == moved.scale.unit);
  for (std::size_t i = 0; i < still.instances.size(); ++i) {
    const Instance &a = still.instances[i], &b = moved.instances[i];
    if (a.role != Role::body) continue;
    const Vec3 expected = Vec3(-a.position.z(), a.position.y(), a.position.x()) + Vec3(1, 2, 3);
    CHECK((b.position - expected).norm() < 1e-12);
    CHECK(a.extent == b.extent);
  }
}

TEST_CASE("cut joints are marked when named") {
  const std::vector<std::string> cut{"link1", "arm2"};
  const SceneList scene = build_scene(governor(), {}, {.cut_joints = cut});
  const int marks = count(scene, Role::cut_mark);
  CHECK(marks == 3); // the double bar of a link, the broken ring of a joint
}

TEST_CASE("given shapes are drawn as given") {
  Mechanism m;
  Body box = body("box", 1, {1, 0, 0});
  box.shapes.resize(2);
  box.shapes[0].type = ShapeType::box;
  box.shapes[0].size = {1, 2, 3};
  box.shapes[0].color = {{1, 0, 0}};
  box.shapes[1].type = ShapeType::capsule;
  box.shapes[1].radius = 0.25;
  box.shapes[1].to = {0, 0, 4};
  m.bodies = {box};
  const SceneList scene = build_scene(m, {});
  REQUIRE(scene.instances.size() == 2);
  const Instance &first = scene.instances[0], &second = scene.instances[1];
  CHECK((first.extent + Vec3::Constant(first.round) - Vec3(0.5, 1, 1.5)).norm() < 1e-12);
  CHECK(first.color == Color{1, 0, 0, 1});
  CHECK(second.round == 0.25);
  CHECK(second.extent.z() == 2);
}

TEST_CASE("bodies that are joined have hues of their own") {
  const SceneList scene = build_scene(governor(), {}, {.joints = false, .drives = false, .forces = false});
  std::array<Color, 4> colors;
  for (const Instance& i : scene.instances)
    colors[static_cast<std::size_t>(i.part.index)] = i.color;
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::abs(colors[a].r - colors[b].r) + std::abs(colors[a].g - colors[b].g) +
           std::abs(colors[a].b - colors[b].b);
  };
  CHECK(apart(0, 1) > 0.5f);
  CHECK(apart(1, 3) > 0.5f);
}

TEST_CASE("every type of joint and force has a sign of its own") {
  for (const JointType type :
       {JointType::revolute, JointType::prismatic, JointType::cylindrical, JointType::universal,
        JointType::spherical, JointType::planar, JointType::fixed}) {
    Mechanism m;
    m.bodies = {body("a", 1, {0, 1, 0}), body("b", 1, {0, -1, 0})};
    m.joints = {joint(JointType::fixed, "hold", "ground", "a", {0, 2, 0}, {0, 1, 0}),
                joint(type, "j", "a", "b", {0, 0, 0}, {0, 1, 0})};
    INFO(type_name(type));
    const SceneList scene = build_scene(m, {});
    CHECK(count(scene, {PartKind::joint, 1}) > 0);
    CHECK(count(scene, {PartKind::body, 1}) > 0);
  }
  for (const ForceType type : {ForceType::spring, ForceType::force, ForceType::torque, ForceType::drag}) {
    Mechanism m;
    m.bodies = {body("a", 1, {0, 1, 0})};
    Force force;
    force.type = type;
    force.body = "a";
    force.bodies = {"ground", "a"};
    force.points = {Vec3(0, 0, 0), Vec3(0, 1, 0)};
    force.vector = {1, 0, 0};
    m.forces = {force};
    INFO(type_name(type));
    CHECK(count(build_scene(m, {}), {PartKind::force, 0}) > 0);
  }
}

namespace {

Mechanism meshing(double ratio, const Vec3& second) {
  Mechanism m;
  m.bodies = {body("a", 1, {0, 0, 0}), body("b", 1, second)};
  m.joints = {revolute("turn_a", "ground", "a", {0, 0, 0}, {0, 0, 1}),
              revolute("turn_b", "ground", "b", second, {0, 0, 1}), gear("mesh", "turn_a", "turn_b", ratio)};
  return m;
}

// m, how far a point is from the middles of the teeth about a centre, at the least.
double tooth_distance(const SceneList& scene, const Vec3& center, double radius, const Vec3& at) {
  double least = 1e9;
  bool own = false; // its teeth follow its rim
  for (const Instance& i : scene.instances) {
    if (i.part != PartId{PartKind::joint, 2}) continue;
    if (i.primitive == Primitive::ring) own = (i.position - center).head<2>().norm() < 1e-9;
    if (i.primitive != Primitive::box || !own) continue;
    Vec3 out = i.position - center;
    out.z() = 0;
    CHECK(std::abs(out.norm() - radius) < 0.1 * radius);
    least = std::min(least, (center + radius * out.normalized() - at).head<2>().norm());
  }
  return least;
}

} // namespace

TEST_CASE("gears are drawn as large as their pitch circles, tooth against gap, and go on so when they turn") {
  for (const double ratio : {-0.5, -3.0, 0.25, 4.0}) {
    INFO(ratio);
    const Vec3 second(0.3, 0.4, 0);
    const Mechanism m = meshing(ratio, second);
    const double q = std::abs(ratio), sum = ratio < 0 ? 1 + q : std::abs(1 - q);
    const double r_a = 0.5 * q / sum, r_b = 0.5 / sum;
    const Vec3 contact = (ratio < 0 || r_a > r_b ? 1 : -1) * r_a * second.normalized();
    for (const double turn : {0.0, 0.11, 1.0}) {
      std::vector<Pose> poses = drawn_poses(m);
      poses[0].rotation = Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
      poses[1].rotation = Quat(Eigen::AngleAxisd(ratio * turn, Vec3::UnitZ()));
      const SceneList scene = build_scene(m, poses);
      const double off_a = tooth_distance(scene, Vec3::Zero(), r_a, contact),
                   off_b = tooth_distance(scene, second, r_b, contact);
      // A pitch apart are teeth of one wheel, half of it a tooth from the next gap.
      const double pitch = 1.5 * scene.scale.unit;
      CHECK(off_a + off_b > 0.35 * pitch);
      CHECK(off_a + off_b < 0.9 * pitch);
    }
  }
}

TEST_CASE("a wheel in two meshes is drawn once") {
  Mechanism m = meshing(-0.5, {0.3, 0, 0});
  const SceneList once = build_scene(m, {});
  Joint again = m.joints[2];
  again.name = "again";
  m.joints.push_back(again);
  CHECK(count(build_scene(m, {}), {PartKind::joint, 3}) == 0);
  m.joints[3].joints = {"turn_b", "turn_a"};
  m.joints[3].ratio = -2;
  CHECK(build_scene(m, {}).instances.size() == once.instances.size());
}

TEST_CASE("a torque's arc is seen before the plate it turns") {
  Mechanism m;
  m.bodies = {body("plate", 1, {0, 0, 0})};
  m.bodies[0].shapes.resize(1);
  m.bodies[0].shapes[0].type = ShapeType::box;
  m.bodies[0].shapes[0].size = {0.5, 0.5, 0.1};
  Force torque;
  torque.type = ForceType::torque;
  torque.body = "plate";
  for (const double sense : {1.0, -1.0}) {
    torque.vector = {0, 0, sense};
    m.forces = {torque};
    const SceneList scene = build_scene(m, {});
    const auto arc = std::ranges::find(scene.instances, Primitive::arc, &Instance::primitive);
    REQUIRE(arc != scene.instances.end());
    CHECK(arc->position.z() - arc->round > 0.05);
  }
}

TEST_CASE("nothing lies below the floor, at any phase of a drive") {
  const Mechanism m = governor();
  const SceneList scene = build_scene(m, {});
  CHECK(scene.floor < scene.bounds.lower.y());
  CHECK(scene.floor > scene.bounds.lower.y() - scene.scale.unit);

  Mechanism wheel;
  wheel.bodies = {body("arm", 1, {1, 0, 0})};
  wheel.joints = {revolute("spin", "ground", "arm", {0, 0, 0}, {0, 0, 1})};
  wheel.joints[0].coordinates[0].drive = Drive{20};
  CHECK(build_scene(wheel, {}).floor < -1);
}

TEST_CASE("extreme and degenerate mechanisms give finite lists") {
  CHECK(build_scene(Mechanism{}, {}).instances.empty());
  Mechanism m;
  m.bodies = {body("tiny", 1e-30, {1e-12, 0, 0}), body("far", 1e30, {1e15, 0, 0}),
              body("same", 0, {1e-12, 0, 0})};
  m.joints = {revolute("a", "ground", "tiny", {0, 0, 0}, {0, 0, 0}),
              prismatic("b", "tiny", "far", {0, 0, 0}, {1e-200, 0, 0}),
              distance("c", "tiny", "same", {1e-12, 0, 0}, {1e-12, 0, 0})};
  std::vector<Pose> poses = drawn_poses(m);
  for (const bool broken : {false, true}) {
    if (broken) poses[1].position.x() = std::numeric_limits<double>::quiet_NaN();
    const SceneList scene = build_scene(m, poses);
    for (const Instance& i : scene.instances) {
      CHECK(i.position.allFinite());
      CHECK(i.extent.allFinite());
      CHECK(i.rotation.coeffs().allFinite());
    }
    CHECK(scene.bounds.lower.allFinite());
    CHECK(std::isfinite(scene.floor));
  }
}

TEST_CASE("the ghost holds bodies and links only, in its colour") {
  const Mechanism m = governor();
  const Color grey{0.5f, 0.5f, 0.5f, 0.3f};
  const std::vector<Instance> ghost = build_ghost(m, drawn_poses(m), grey);
  CHECK_FALSE(ghost.empty());
  for (const Instance& i : ghost) {
    CHECK((i.role == Role::body || i.role == Role::link));
    CHECK(i.color == grey);
  }
}

TEST_CASE("unit solids are closed and face outwards") {
  for (int p = 0; p < primitive_count; ++p)
    for (int detail = 0; detail < detail_levels; ++detail) {
      if (is_flat(static_cast<Primitive>(p), detail)) continue;
      const PrimitiveMesh mesh = primitive_mesh(static_cast<Primitive>(p), detail);
      INFO("primitive " << p << " detail " << detail);
      const auto at = [&](std::uint32_t i) -> Vec3 {
        const PrimitiveVertex& v = mesh.vertices[i];
        return Vec3(v.core[0], v.core[1], v.core[2]) + 0.1 * Vec3(v.normal[0], v.normal[1], v.normal[2]);
      };
      // A closed surface that faces outwards has a volume, by the divergence theorem, and no net area.
      double volume = 0;
      Vec3 area = Vec3::Zero();
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3 a = at(mesh.indices[i]), b = at(mesh.indices[i + 1]), c = at(mesh.indices[i + 2]);
        volume += a.dot(b.cross(c)) / 6;
        area += (b - a).cross(c - a) / 2;
      }
      CHECK(volume > 1e-3);
      if (static_cast<Primitive>(p) != Primitive::sphere)
        CHECK(area.norm() < 0.04); // sharp rims, never drawn with a radius, open a little
    }
}

TEST_CASE("a mass centre a little beside the only joint makes no glyph vanish") {
  Mechanism m;
  for (const char* name : {"rotor", "sleeve"}) {
    Body& body = m.bodies.emplace_back();
    body.name = name;
    body.mass = 1;
    Shape& rod = body.shapes.emplace_back();
    rod.type = ShapeType::cylinder;
    rod.radius = 0.02;
    rod.from = {-0.3, 0, 0};
    rod.to = {0.3, 0, 0};
  }
  Joint& spin = m.joints.emplace_back();
  spin.name = "spin";
  spin.bodies = {"sleeve", "rotor"};
  spin.axis = Vec3::UnitX();
  spin.coordinates.resize(1);
  const double balanced = build_scene(m, {}).scale.unit;
  for (Body& body : m.bodies)
    body.position.y() = 1e-4; // unbalance
  CHECK(build_scene(m, {}).scale.unit > 0.5 * balanced);
}

TEST_CASE("a rack goes with what slides, and stays in mesh") {
  Mechanism m;
  m.bodies = {body("wheel"), body("block", 1, {0, -0.1, 0})};
  Joint rack = gear("rack", "turn", "slide", 0.05);
  rack.kind = GearKind::rack;
  rack.radii[0] = 0.05;
  m.joints = {revolute("turn", "ground", "wheel", {0, 0, 0}, {0, 0, 1}),
              prismatic("slide", "ground", "block", {0, -0.1, 0}, {1, 0, 0}), rack};
  const auto bar = [&](double gone) {
    std::vector<Pose> poses = drawn_poses(m);
    poses[1].position.x() += gone;
    const SceneList scene = build_scene(m, poses);
    const auto found = std::ranges::find_if(scene.instances, [](const Instance& i) {
      return i.part == PartId{PartKind::joint, 2} && i.primitive == Primitive::box;
    });
    REQUIRE(found != scene.instances.end());
    return instance_bounds(*found);
  };
  const Bounds drawn = bar(0), gone = bar(0.02), far = bar(-0.5);
  CHECK(gone.lower.x() - drawn.lower.x() == Approx(0.02));
  CHECK(gone.upper.x() - drawn.upper.x() == Approx(0.02));
  CHECK(far.lower.x() - drawn.lower.x() == Approx(-0.5));
  CHECK(far.upper.x() > 0); // below the wheel
}
