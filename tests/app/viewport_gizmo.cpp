#include "app/viewport/box_select.hpp"
#include "app/viewport/gizmo.hpp"
#include "app/viewport/work_plane.hpp"
#include "tests/app/viewport_mechanisms.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr ViewSize view{800, 600};

Gizmo oblique(GizmoKind kind, bool orthographic = false) {
  Gizmo gizmo;
  gizmo.kind = kind;
  gizmo.centre = {0.1, -0.05, 0.2};
  gizmo.camera.distance = 3;
  gizmo.camera.azimuth = 0.5;
  gizmo.camera.elevation = 0.4;
  gizmo.camera.orthographic = orthographic;
  gizmo.normal = axis_in_view(gizmo.camera);
  gizmo.view = view;
  return gizmo;
}

const HandleShape* find(const std::vector<HandleShape>& shapes, Handle handle) {
  const auto found = std::ranges::find(shapes, handle, &HandleShape::handle);
  return found == shapes.end() ? nullptr : &*found;
}

Ray ray_to(const Gizmo& gizmo, const Vec3& world) {
  const auto pixel = gizmo.camera.project(world, view);
  REQUIRE(pixel);
  return gizmo.camera.ray(*pixel, view);
}

} // namespace

TEST_CASE("every handle is found at its grip, and nothing away from them") {
  for (const GizmoKind kind : {GizmoKind::arrows, GizmoKind::rings})
    for (const bool orthographic : {false, true}) {
      const auto shapes = handle_shapes(oblique(kind, orthographic));
      CHECK(shapes.size() == (kind == GizmoKind::arrows ? 7 : 3));
      for (const HandleShape& shape : shapes) {
        INFO(handle_name(shape.handle));
        CHECK(handle_at(shapes, shape.grip, 1) == shape.handle);
      }
      CHECK(handle_at(shapes, {5, 5}, 1) == Handle::none);
    }
}

TEST_CASE("the gizmo keeps its size in the picture") {
  Gizmo near = oblique(GizmoKind::arrows, true), far = near;
  far.camera.distance *= 10;
  far.centre *= 10;
  const auto length = [](const Gizmo& gizmo) {
    const auto shapes = handle_shapes(gizmo);
    const HandleShape* x = find(shapes, Handle::x);
    REQUIRE(x);
    return (x->line[1] - x->line[0]).norm();
  };
  CHECK(length(near) == Approx(length(far)).epsilon(1e-9));
  far.point = 2;
  CHECK(length(far) == Approx(2 * length(near)).epsilon(1e-9));
}

TEST_CASE("handles that point at the viewer are left out") {
  Gizmo gizmo = oblique(GizmoKind::arrows);
  gizmo.centre = gizmo.camera.target;
  gizmo.camera.azimuth = gizmo.camera.elevation = 0;
  const auto shapes = handle_shapes(gizmo);
  CHECK(find(shapes, Handle::x));
  CHECK(find(shapes, Handle::xy));
  CHECK_FALSE(find(shapes, Handle::z));
  CHECK_FALSE(find(shapes, Handle::yz));
  gizmo.centre = gizmo.camera.eye() + gizmo.camera.backward();
  CHECK(handle_shapes(gizmo).empty());
}

TEST_CASE("dragging along an axis moves exactly along it, as far as the cursor") {
  for (const bool orthographic : {false, true}) {
    const Gizmo gizmo = oblique(GizmoKind::arrows, orthographic);
    for (const auto& [handle, axis] :
         {std::pair(Handle::x, 0), std::pair(Handle::y, 1), std::pair(Handle::z, 2)}) {
      const Vec3 from = gizmo.centre + 0.05 * Vec3::Unit(axis), to = gizmo.centre + 0.31 * Vec3::Unit(axis);
      const auto by = dragged(gizmo, handle, ray_to(gizmo, from), ray_to(gizmo, to));
      REQUIRE(by);
      CHECK((*by)[axis] == Approx(0.26));
      CHECK((*by)[(axis + 1) % 3] == 0);
      CHECK((*by)[(axis + 2) % 3] == 0);
    }
  }
}

TEST_CASE("dragging a patch or the ball stays in its plane") {
  const Gizmo gizmo = oblique(GizmoKind::arrows);
  const Vec3 by(0.2, -0.1, 0);
  for (const Handle handle : {Handle::xy, Handle::plane}) {
    const auto moved =
        dragged(gizmo, handle, ray_to(gizmo, gizmo.centre), ray_to(gizmo, Vec3(gizmo.centre + by)));
    REQUIRE(moved);
    CHECK((*moved - by).norm() < 1e-9);
    CHECK(moved->z() == 0);
  }
  CHECK(free_coordinates(Handle::plane, 2) == std::array{true, true, false});
  CHECK(free_coordinates(Handle::yz, 2) == std::array{false, true, true});
  CHECK(free_coordinates(Handle::y, 2) == std::array{false, true, false});
}

TEST_CASE("an axis that points at the viewer, or a cursor above the horizon, moves nothing") {
  Gizmo gizmo = oblique(GizmoKind::arrows);
  gizmo.camera.azimuth = gizmo.camera.elevation = 0;
  gizmo.centre = Vec3::Zero();
  const Ray middle = gizmo.camera.ray({400, 300}, view);
  CHECK_FALSE(dragged(gizmo, Handle::z, middle, middle));
  CHECK_FALSE(dragged(gizmo, Handle::yz, middle, middle));
  gizmo.camera.elevation = 0.1;
  gizmo.centre = {0, -0.5, 0};
  CHECK_FALSE(
      dragged(gizmo, Handle::zx, gizmo.camera.ray({400, 400}, view), gizmo.camera.ray({400, 0}, view)));
}

TEST_CASE("a ring turns by the angle that the cursor goes round") {
  const Gizmo gizmo = oblique(GizmoKind::rings);
  for (int axis = 0; axis < 3; ++axis) {
    const Handle ring =
        std::array{Handle::ring_x, Handle::ring_y, Handle::ring_z}[static_cast<std::size_t>(axis)];
    const Vec3 a = Vec3::Unit((axis + 1) % 3), b = Vec3::Unit((axis + 2) % 3);
    const Vec3 from = gizmo.centre + 0.2 * a;
    for (const double angle : {0.6, -1.9, 3.0}) {
      const Vec3 to = gizmo.centre + 0.3 * (std::cos(angle) * a + std::sin(angle) * b);
      const auto by = turned(gizmo, ring, ray_to(gizmo, from), ray_to(gizmo, to));
      REQUIRE(by);
      CHECK(*by == Approx(angle));
    }
  }
}

TEST_CASE("a ring seen from the side turns with the cursor along it") {
  Gizmo gizmo = oblique(GizmoKind::rings);
  gizmo.centre = Vec3::Zero();
  gizmo.camera.azimuth = gizmo.camera.elevation = 0;
  // About y, what is in front goes to the right.
  const auto right =
      turned(gizmo, Handle::ring_y, gizmo.camera.ray({400, 300}, view), gizmo.camera.ray({434, 300}, view));
  REQUIRE(right);
  CHECK(*right == Approx(0.5));
  // About x, it goes down.
  const auto down =
      turned(gizmo, Handle::ring_x, gizmo.camera.ray({400, 300}, view), gizmo.camera.ray({400, 334}, view));
  REQUIRE(down);
  CHECK(*down == Approx(0.5));
}

TEST_CASE("a frame holds the parts whose points are seen within it") {
  const Mechanism m = governor();
  ViewCamera camera;
  camera.azimuth = camera.elevation = 0;
  camera.target = {0, 0.15, 0};
  camera.distance = 2;
  const auto corner = [&](double x, double y) { return *camera.project({x, y, 0}, view); };
  const auto anchors = part_anchors(m, {});
  const auto left = parts_in_frame(anchors, camera, view, {corner(-0.03, 0.25), corner(-0.2, 0.15)});
  // ball1, and link1 by its middle.
  CHECK(left == std::vector<PartId>{{PartKind::body, 1}, {PartKind::joint, 4}});
  CHECK(parts_in_frame(anchors, camera, view, {corner(-1, -1), corner(1, 1)}).size() == anchors.size());
  CHECK(parts_in_frame(anchors, camera, view, {corner(0.3, 0.3), corner(0.4, 0.4)}).empty());
}

TEST_CASE("a frame sees parts where they are in the poses") {
  const Mechanism m = governor();
  std::vector<Pose> poses = drawn_poses(m);
  poses[1].position += Vec3(0, -0.1, 0);
  const auto anchors = part_anchors(m, poses);
  CHECK((anchors[1].at - Vec3(-0.16, 0.1, 0)).norm() < 1e-15);
  const auto link = std::ranges::find(anchors, PartId{PartKind::joint, 4}, &PartAnchor::part);
  REQUIRE(link != anchors.end());
  CHECK((link->at - (0.5 * Vec3(-0.08, 0.1, 0) + 0.5 * Vec3(0, 0.1256, 0))).norm() < 1e-15);
}
