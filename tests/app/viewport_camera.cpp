#include "app/viewport/camera.hpp"
#include "tests/catch.hpp"

#include <numbers>

using namespace flyball;

namespace {

constexpr ViewSize view{800, 500};

Bounds unit_box() {
  Bounds bounds;
  bounds.add(Vec3(-1, -2, -0.5));
  bounds.add(Vec3(3, 1, 0.5));
  return bounds;
}

Vec2 through_matrices(const ViewCamera& camera, const Vec3& world) {
  const Mat4 m = camera.projection_matrix(view, camera.target, 10 * camera.distance) * camera.view_matrix();
  const Eigen::Vector4d clip = m * world.homogeneous();
  return {(clip.x() / clip.w() + 1) * 0.5 * view.width, (1 - clip.y() / clip.w()) * 0.5 * view.height};
}

} // namespace

TEST_CASE("up is against gravity, or y without it") {
  Mechanism m;
  CHECK(up_axis(m) == Vec3::UnitY());
  m.gravity = {0, 0, -9.81};
  CHECK((up_axis(m) - Vec3::UnitZ()).norm() < 1e-15);
}

TEST_CASE("the camera's axes are orthonormal and right-handed for every up") {
  for (const Vec3& up : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0),
                         Vec3(Vec3(1, 2, -3).normalized())})
    for (const double elevation : {-std::numbers::pi / 2, 0.0, 0.4, std::numbers::pi / 2}) {
      ViewCamera camera;
      camera.up = up;
      camera.elevation = elevation;
      CHECK(std::abs(camera.right().dot(up)) < 1e-12);
      CHECK((camera.right().cross(camera.screen_up()) - camera.backward()).norm() < 1e-12);
      CHECK(camera.screen_up().dot(up) > -1e-12);
    }
}

TEST_CASE("azimuth zero looks along -z with x to the right when y is up") {
  ViewCamera camera;
  camera.azimuth = camera.elevation = 0;
  CHECK((camera.right() - Vec3::UnitX()).norm() < 1e-12);
  CHECK((camera.backward() - Vec3::UnitZ()).norm() < 1e-12);
}

TEST_CASE("project agrees with the matrices and undoes ray") {
  for (const bool orthographic : {false, true}) {
    ViewCamera camera;
    camera.target = {1, 2, 3};
    camera.distance = 4;
    camera.orthographic = orthographic;
    const Vec3 point(1.3, 1.8, 2.2);
    const auto pixel = camera.project(point, view);
    REQUIRE(pixel);
    CHECK((*pixel - through_matrices(camera, point)).norm() < 1e-8);
    const Ray ray = camera.ray(*pixel, view);
    CHECK((point - ray.origin).cross(ray.direction).norm() < 1e-12);
  }
}

TEST_CASE("what is behind the eye has no pixel") {
  const ViewCamera camera;
  CHECK_FALSE(camera.project(camera.eye() + camera.backward(), view));
}

TEST_CASE("zoom keeps what is under the cursor") {
  for (const bool orthographic : {false, true}) {
    ViewCamera camera;
    camera.orthographic = orthographic;
    const Vec2 cursor(610, 120);
    const Ray before = camera.ray(cursor, view);
    const double along =
        (camera.target - before.origin).dot(camera.backward()) / before.direction.dot(camera.backward());
    const Vec3 point = before.origin + along * before.direction;
    camera.zoom(1.7, cursor, view);
    const auto after = camera.project(point, view);
    REQUIRE(after);
    CHECK((*after - cursor).norm() < 1e-9);
    CHECK(camera.distance == Approx(1 / 1.7));
  }
}

TEST_CASE("pan moves the target with the cursor") {
  ViewCamera camera;
  const Vec3 target = camera.target;
  camera.pan(30, -20, view);
  const auto pixel = camera.project(target, view);
  REQUIRE(pixel);
  CHECK((*pixel - Vec2(430, 230)).norm() < 1e-9);
}

TEST_CASE("orbit keeps the target and stops at the poles") {
  ViewCamera camera;
  camera.orbit(100, 1e6, view);
  CHECK(camera.elevation == Approx(std::numbers::pi / 2));
  CHECK((camera.eye() - camera.distance * camera.up).norm() < 1e-12);
}

TEST_CASE("fit shows the whole box, and not from too far") {
  for (const bool orthographic : {false, true}) {
    ViewCamera camera;
    camera.orthographic = orthographic;
    const Bounds box = unit_box();
    camera.fit(box, view);
    double nearest_edge = 1e9;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? box.upper.x() : box.lower.x(), i & 2 ? box.upper.y() : box.lower.y(),
                        i & 4 ? box.upper.z() : box.lower.z());
      const auto pixel = camera.project(corner, view);
      REQUIRE(pixel);
      for (const double gap : {pixel->x(), view.width - pixel->x(), pixel->y(), view.height - pixel->y()})
        nearest_edge = std::min(nearest_edge, gap);
    }
    CHECK(nearest_edge > 5);
    CHECK(nearest_edge < 70);
  }
}

TEST_CASE("a shaft seen from its end fits without its near end filling the picture") {
  Bounds shaft;
  shaft.add(Vec3(-0.4, -0.01, -0.01));
  shaft.add(Vec3(0.4, 0.01, 0.01));
  ViewCamera camera;
  camera.azimuth = std::numbers::pi / 2;
  camera.elevation = 0;
  camera.fit(shaft, view);
  const auto high = camera.project(Vec3(0.4, 0.01, 0), view), low = camera.project(Vec3(0.4, -0.01, 0), view),
             middle = camera.project(Vec3(0, 0.01, 0), view), below = camera.project(Vec3(0, -0.01, 0), view);
  REQUIRE((high && low && middle && below));
  CHECK(low->y() - high->y() < 2.001 * (below->y() - middle->y()));
  CHECK(low->y() - high->y() < 0.2 * view.height);
}

TEST_CASE("fitting nothing, a point and giant boxes gives a usable camera") {
  Bounds point, giant;
  point.add(Vec3(5, 5, 5));
  giant.add(Vec3(-1e12, 0, 0));
  giant.add(Vec3(1e12, 1, 1));
  for (const Bounds& bounds : {Bounds{}, point, giant}) {
    ViewCamera camera;
    camera.fit(bounds, view);
    CHECK(std::isfinite(camera.distance));
    CHECK(camera.distance > 0);
    CHECK(camera.target.allFinite());
  }
}

TEST_CASE("the scene file's camera comes back as it was") {
  Mechanism m;
  m.view.camera = Camera{{1, 2, 3}, 4, 0.5, 0.25};
  const ViewCamera camera = initial_camera(m, unit_box(), view);
  CHECK(Camera{camera.target, camera.distance, camera.azimuth, camera.elevation} == *m.view.camera);
}
