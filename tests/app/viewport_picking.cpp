#include "app/viewport/picking.hpp"
#include "tests/app/viewport_mechanisms.hpp"
#include "tests/catch.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr ViewSize view{800, 600};

struct Setup {
  Mechanism mechanism = governor();
  SceneList scene = build_scene(mechanism, {});
  ViewCamera camera;
  Setup() {
    camera.azimuth = camera.elevation = 0;
    camera.fit(scene.bounds, view);
  }
  std::optional<Hit> at(const Vec3& world, Vec2 moved = Vec2::Zero(), double slack = 4) const {
    const auto pixel = camera.project(world, view);
    REQUIRE(pixel);
    return pick(scene.instances, camera.ray(*pixel + moved, view), slack);
  }
};

} // namespace

TEST_CASE("the part under the cursor is found") {
  const Setup s;
  const auto ball = s.at({-0.16, 0.2, 0});
  REQUIRE(ball);
  CHECK(ball->part == PartId{PartKind::body, 1});
  CHECK((ball->point - Vec3(-0.16, 0.2, 0)).norm() < 3 * s.scene.scale.unit);
  const auto link = s.at({0.05, 0.1721, 0});
  REQUIRE(link);
  CHECK(link->part == PartId{PartKind::joint, 5});
}

TEST_CASE("the nearer of two parts is found") {
  Setup s;
  s.camera.azimuth = -std::numbers::pi / 2; // along the arms, ball1 in front
  const auto hit = s.at({-0.16, 0.2, 0});
  REQUIRE(hit);
  CHECK(hit->part == PartId{PartKind::body, 1});
}

TEST_CASE("thin parts are found from a few pixels away, and nothing from far") {
  const Setup s;
  const Vec3 on_link(0.05, 0.1721, 0);
  const double radius = 0.32 * s.scene.scale.unit / s.camera.pixel_size(view);
  const Vec2 beside = (radius + 2.5) * Vec2(0.68, 0.73);
  const auto near = s.at(on_link, beside);
  REQUIRE(near);
  CHECK(near->part == PartId{PartKind::joint, 5});
  CHECK_FALSE(s.at(on_link, beside, 0.5));
  CHECK_FALSE(pick(s.scene.instances, s.camera.ray({2, 2}, view)));
}

TEST_CASE("an orthographic view picks the same") {
  Setup s;
  s.camera.orthographic = true;
  const auto hit = s.at({0.16, 0.2, 0});
  REQUIRE(hit);
  CHECK(hit->part == PartId{PartKind::body, 2});
}

TEST_CASE("picking in nothing finds nothing") {
  CHECK_FALSE(pick({}, Ray{}));
}
