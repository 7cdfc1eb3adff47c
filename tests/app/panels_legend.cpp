// The view tells which pose is drawn how.
#include "app/panels/legend.hpp"
#include "app/panels/motion_control.hpp"
#include "robot.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

std::vector<std::string> words(App& app) {
  std::vector<std::string> all;
  for (const LegendRow& row : legend_rows(app))
    all.push_back(row.words);
  return all;
}

using Words = std::vector<std::string>;

} // namespace

TEST_CASE("the legend names what is in the view, and no more") {
  Robot robot;
  App& app = robot.app;
  change_parameter(app, "joints.spin.drive.speed", 18);
  robot.frames(2);
  CHECK(words(app) == Words{"Steady state", "Drawn pose"});
  CHECK(legend_rows(app)[1].mark == LegendMark::dashed);
  app.view.ghost = false;
  CHECK(words(app) == Words{"Steady state"});
  app.view.ghost = true;
  set_mode(app, Mode::build);
  robot.frames(2);
  CHECK(words(app) == Words{"Drawn pose", "Steady state"}); // as the file says
  keep_explored(app);
  robot.frames(2);
  CHECK(words(app) == Words{"Drawn pose", "Steady state"});
  CHECK(legend_rows(app)[0].mark == LegendMark::outlined);
  CHECK(legend_rows(app)[1].mark == LegendMark::glass);
  set_mode(app, Mode::explore);
  app.motion.duration = 0.2;
  robot.key('M');
  robot.frames(3);
  CHECK(words(app) == Words{"Steady state", "Drawn pose", "Motion, damped"});
  open_document(app, Document());
  robot.frames(2);
  CHECK(words(app).empty());
  CHECK(app.widgets.count("legend") == 0);
}

TEST_CASE("the legend folds") {
  Robot robot;
  REQUIRE(robot.app.widgets.count("legend/0") == 1);
  robot.click("legend");
  CHECK_FALSE(robot.app.panels.legend);
  CHECK(robot.app.widgets.count("legend/0") == 0);
  robot.frames(30); // else it would be a double click
  robot.click("legend");
  CHECK(robot.app.widgets.count("legend/0") == 1);
}

TEST_CASE("drawn pose and steady state are drawn in different ways") {
  Robot robot;
  App& app = robot.app;
  change_parameter(app, "joints.spin.drive.speed", 18);
  keep_explored(app);
  robot.frames(2);
  const ViewScene exploring = view_scene(view_frame(app));
  CHECK(exploring.ghost.empty());
  CHECK_FALSE(exploring.drawn.empty());
  CHECK_FALSE(exploring.drawn_is_solid);
  // The spindle stands where it was drawn: there is nothing to outline.
  const auto outlined = [&](const ViewScene& scene, const char* body) {
    return std::ranges::any_of(scene.drawn, [&](const Instance& i) {
      return i.part == PartId{PartKind::body, body_index(app.mechanism(), body)};
    });
  };
  CHECK_FALSE(outlined(exploring, "spindle"));
  CHECK(outlined(exploring, "collar"));
  set_mode(app, Mode::build);
  robot.frames(2);
  const ViewScene building = view_scene(view_frame(app));
  CHECK_FALSE(building.ghost.empty());
  CHECK(building.drawn_is_solid);
  CHECK(outlined(building, "collar"));
  // The steady state has the bodies' colours, as it has while exploring.
  for (const Instance& ghost : building.ghost) {
    if (ghost.part.kind != PartKind::body) continue;
    const auto solid = std::ranges::find_if(exploring.solid.instances,
                                            [&](const Instance& i) { return i.part == ghost.part; });
    REQUIRE(solid != exploring.solid.instances.end());
    CHECK(Color{ghost.color.r, ghost.color.g, ghost.color.b} == solid->color);
  }
  for (const Theme theme : {Theme::light, Theme::dark})
    for (const Color& body : palette(theme).bodies) {
      const Color& motion = palette(theme).motion;
      CHECK(std::abs(body.r - motion.r) + std::abs(body.g - motion.g) + std::abs(body.b - motion.b) > 0.25f);
    }
}
