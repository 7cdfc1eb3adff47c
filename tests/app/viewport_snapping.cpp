#include "app/viewport/bodies_near.hpp"
#include "app/viewport/snapping.hpp"
#include "app/viewport/work_plane.hpp"
#include "tests/app/viewport_mechanisms.hpp"
#include "tests/catch.hpp"

#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr ViewSize view{800, 600};

ViewCamera front() {
  ViewCamera camera;
  camera.azimuth = camera.elevation = 0;
  camera.distance = 2;
  return camera;
}

} // namespace

TEST_CASE("the point nearest to the cursor catches it, within reach") {
  const ViewCamera camera = front();
  const std::vector<SnapPoint> points{{{0, 0, 0}, {}, "a"}, {{0.02, 0, 0}, {}, "b"}, {{0.5, 0, 0}, {}, "c"}};
  const auto at = [&](double x, double reach = 10) {
    const SnapPoint* found = snap_point(points, camera, view, *camera.project({x, 0, 0}, view), reach);
    return found ? found->what : std::string();
  };
  CHECK(at(0.004) == "a");
  CHECK(at(0.016) == "b");
  CHECK(at(0.49) == "c");
  CHECK(at(0.25).empty());
  CHECK(at(0.49, 2).empty());
}

TEST_CASE("of points behind each other the nearest one to the eye is meant") {
  const ViewCamera camera = front();
  for (const bool reversed : {false, true}) {
    std::vector<SnapPoint> points{{{0, 0, -0.3}, {}, "behind"}, {{0, 0, 0.3}, {}, "before"}};
    if (reversed) std::swap(points[0], points[1]);
    const SnapPoint* found = snap_point(points, camera, view, {400, 300}, 10);
    REQUIRE(found);
    CHECK(found->what == "before");
  }
  const std::vector<SnapPoint> unseen{{camera.eye() + Vec3(0, 0, 1), {}, "behind the eye"}};
  CHECK_FALSE(snap_point(unseen, camera, view, {400, 300}, 1e9));
}

TEST_CASE("from the front a disc is caught by its centre, off that by its face") {
  const ViewCamera camera = front();
  for (const double x : {0., 0.3}) { // seen in perspective the face is beside the centre
    const std::vector<SnapPoint> points{{{x, 0, 0}, {}, "centre"}, {{x, 0, 0.005}, {}, "face", {}, true}};
    for (const SnapPoint& each : points) {
      const SnapPoint* found = snap_point(points, camera, view, *camera.project(each.point, view), 10);
      REQUIRE(found);
      CHECK(found->what == "centre");
    }
  }
  // Obliquely it is a place of its own.
  ViewCamera side = front();
  side.azimuth = 1;
  const std::vector<SnapPoint> points{{{0, 0, 0}, {}, "centre"}, {{0, 0, 0.05}, {}, "face", {}, true}};
  const SnapPoint* found = snap_point(points, side, view, *side.project({0, 0, 0.05}, view), 10);
  REQUIRE(found);
  CHECK(found->what == "face");
}

TEST_CASE("grid steps are 1, 2 or 5 of a power of ten") {
  CHECK(step_above(0.011) == 0.02);
  CHECK(step_above(0.01) == 0.01);
  CHECK(step_above(0.03) == 0.05);
  CHECK(step_above(0.06) == 0.1);
  CHECK(step_above(7) == 10);
  CHECK(step_above(1) == 1);
  CHECK(step_above(2.5e-7) == 5e-7);
  CHECK(nearest_step(0.011) == 0.01);
  CHECK(nearest_step(0.017) == 0.02);
  CHECK(nearest_step(0.09) == 0.1);
  CHECK(nearest_step(4) == 5);
  CHECK(nearest_step(3) == 2);
}

TEST_CASE("rounded numbers are those a person would type") {
  CHECK(round_to(0.1172, 0.02) == 0.12);
  CHECK(round_to(0.3000001, 0.1) == 0.3);
  CHECK(round_to(-0.0449, 0.005) == -0.045);
  CHECK(round_to(17.4, 5) == 15);
  CHECK_FALSE(std::signbit(round_to(-0.001, 0.1)));
  for (int i = -300; i <= 300; ++i) {
    INFO(i);
    CHECK(round_to(i * 0.01 + 1e-4, 0.01) == i / 100.0);
  }
  CHECK(on_grid({0.113, 0.0744, -0.2}, {true, false, false}, 0.02) == Vec3(0.12, 0.0744, -0.2));
}

TEST_CASE("angles are rounded to 15 degrees") {
  constexpr double degree = std::numbers::pi / 180;
  CHECK(round_angle(50 * degree) == Approx(45 * degree));
  CHECK(round_angle(-88 * degree) == Approx(-90 * degree));
  CHECK(round_angle(7 * degree) == 0);
}

TEST_CASE("the work plane is the one that is seen best, and its coordinate is exact") {
  ViewCamera camera = front();
  CHECK(axis_in_view(camera) == 2);
  camera.azimuth = std::numbers::pi / 2;
  CHECK(axis_in_view(camera) == 0);
  camera.elevation = 1.5;
  CHECK(axis_in_view(camera) == 1);
  // From the corner between them, drawings are in the plane of x and y.
  camera.azimuth = std::numbers::pi / 4;
  camera.elevation = std::atan(std::sqrt(0.5));
  CHECK(axis_in_view(camera) == 2);

  const WorkPlane plane = work_plane(camera, {5, 6, 0.0744});
  const Vec3 point(0.1, 0.2, 0.0744);
  const auto met = meet(plane, camera.ray(*camera.project(point, view), view));
  REQUIRE(met);
  CHECK((*met - point).norm() < 1e-9);
  CHECK(met->z() == 0.0744);
}

TEST_CASE("a plane behind the eye, or seen edge-on, is not met") {
  const ViewCamera camera = front();
  CHECK_FALSE(meet({{0, 0, 10}, 2}, camera.ray({400, 300}, view)));
  CHECK_FALSE(meet({{0, 0, 0}, 0}, camera.ray({400, 300}, view)));
}

TEST_CASE("bodies at a point are found, the nearest first") {
  const Mechanism m = governor();
  const SceneList scene = build_scene(m, {});
  const auto near = bodies_near(m, scene.instances, {-0.16, 0.2, 0});
  REQUIRE(near.size() == 4);
  CHECK(near[0].body == 1);
  CHECK(near[0].distance < 0);
  CHECK(near[3].body == 2);
  // Both arms and the spindle meet at the top.
  const auto top = bodies_near(m, scene.instances, {0, 0.2, 0});
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(top[i].distance <= 0);
  CHECK(top[3].body == 3);
  CHECK(top[3].distance > 0.01);
}
