// The cube in the corner of the view: its faces, edges and corners are directions to look from.
#include "app/ui/camera_glide.hpp"
#include "app/ui/panels/view_cube.hpp"
#include "robot.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <numbers>
#include <set>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double quarter = std::numbers::pi / 2;

ImVec2 on_cube(Robot& robot, double right, double up) { // in half edges
  const WidgetRect cube = robot.widget("view/cube");
  const float edge = (cube.to.x - cube.from.x) / 3.5f;
  return {cube.center().x + edge * static_cast<float>(right),
          cube.center().y - edge * static_cast<float>(up)};
}

} // namespace

TEST_CASE("the cube's parts are where they are seen") {
  ViewCamera camera;
  camera.azimuth = camera.elevation = 0;
  CHECK(cube_direction_at(camera, 0, 0) == CubeDirection{0, 0, 1});
  CHECK(cube_direction_at(camera, 0.8, 0) == CubeDirection{1, 0, 1});
  CHECK(cube_direction_at(camera, -0.8, 0.9) == CubeDirection{-1, 1, 1});
  CHECK_FALSE(cube_direction_at(camera, 1.2, 0));
  camera.azimuth = quarter;
  CHECK(cube_direction_at(camera, 0, 0) == CubeDirection{1, 0, 0});
  camera.azimuth = quarter / 2;
  camera.elevation = 0.6154797086703873;
  CHECK(cube_direction_at(camera, 0, 0.8) == CubeDirection{0, 1, 0});
  CHECK(cube_direction_at(camera, -0.6, -0.4) == CubeDirection{0, 0, 1});
  CHECK(cube_direction_at(camera, 0.6, -0.4) == CubeDirection{1, 0, 0});
  CHECK(cube_direction_at(camera, 0, 0) == CubeDirection{1, 1, 1});
}

TEST_CASE("looking from where a part of the cube points shows that part in its middle") {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        ViewCamera camera;
        camera.up = Vec3(0.2, 0.3, 0.9).normalized();
        const auto [azimuth, elevation] = cube_angles({x, y, z}, 0.3);
        camera.azimuth = azimuth;
        camera.elevation = elevation;
        INFO(x << " " << y << " " << z);
        CHECK(cube_direction_at(camera, 0, 0) == CubeDirection{x, y, z});
      }
}

TEST_CASE("a click on the cube looks from there, a drag turns the view") {
  Robot robot;
  App& app = robot.app;
  robot.key('1');
  robot.point(on_cube(robot, 0, 0));
  CHECK(app.view.cube.hovered == CubeDirection{0, 0, 1});
  robot.click(on_cube(robot, 0.8, 0)); // the edge between front and right
  robot.frames(2);
  CHECK(app.view.camera.azimuth == Approx(quarter / 2));
  CHECK(app.view.camera.elevation == Approx(0));
  CHECK(app.session.selection().empty()); // the view below it was not meant
  robot.key('1');
  robot.click(on_cube(robot, 0, 0.8)); // the edge above
  robot.frames(2);
  CHECK(app.view.camera.elevation == Approx(quarter / 2));
  const double azimuth = app.view.camera.azimuth;
  robot.drag(on_cube(robot, 0, 0), on_cube(robot, 2, 0));
  CHECK(std::abs(app.view.camera.azimuth - azimuth) > 0.1);
  robot.point({450, 300});
  robot.frames(1);
  CHECK_FALSE(app.view.cube.hovered);
}

TEST_CASE("what the hand is over lights up on the cube") {
  Robot robot;
  robot.key('4');
  robot.point({450, 300});
  robot.frames(2);
  const Image before = robot.picture();
  const ImVec2 at = on_cube(robot, 0, 0.8);
  const ImVec2 beside = on_cube(robot, 0, 0.6);
  robot.point(at);
  const Image lit = robot.picture();
  const int x = static_cast<int>(beside.x), y = static_cast<int>(beside.y);
  CHECK(!std::equal(before.at(x, y), before.at(x, y) + 4, lit.at(x, y)));
}

TEST_CASE("the camera glides to where a command puts it, within a fifth of a second") {
  Robot robot;
  App& app = robot.app;
  robot.key('1');
  REQUIRE(app.view.camera.azimuth == Approx(0).margin(1e-12)); // at once where nothing is animated
  app.view.animated = true;
  robot.key('2');
  CHECK(app.view.glide);
  CHECK(in_motion(app.session, app.view));
  std::set<double> seen;
  double seconds = 0;
  while (app.view.glide && seconds < 1) {
    seen.insert(app.view.camera.azimuth);
    robot.frames(1, 0.016);
    seconds += 0.016;
  }
  CHECK(seconds < 0.2);
  CHECK(seen.size() > 6);
  CHECK(app.view.camera.azimuth == Approx(quarter));
  CHECK_FALSE(in_motion(app.session, app.view));
  // A hand on the camera ends it.
  robot.key('1');
  REQUIRE(app.view.glide);
  robot.wheel("view", 1);
  CHECK_FALSE(app.view.glide);
}

TEST_CASE("the camera takes as long however few frames there are") {
  Robot robot;
  App& app = robot.app;
  app.view.animated = true;
  robot.frames(2);
  app.commands.run("view.front");
  // An idle window counts little of its first frame, then time is time.
  robot.frames(1, 0.5);
  CHECK(app.view.glide);
  robot.frames(1, 0.5);
  CHECK_FALSE(app.view.glide);
}
