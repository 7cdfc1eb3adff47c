// The view tells which pose is drawn how.
#include "app/session/motion.hpp"
#include "app/session/periodic.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panels/legend.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_frame.hpp"
#include "robot.hpp"
#include "slider_crank.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <imgui_internal.h>

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

std::vector<std::string> words(App& app) {
  std::vector<std::string> all;
  for (const LegendRow& row : legend_rows(app.context()))
    all.push_back(row.words);
  return all;
}

using Words = std::vector<std::string>;

} // namespace

TEST_CASE("the legend names what is in the view, and no more") {
  Robot robot;
  App& app = robot.app;
  change_parameter(app.session, "joints.spin.drive.speed", 18);
  robot.frames(2);
  CHECK(words(app) == Words{"Steady state", "Drawn pose"});
  CHECK(legend_rows(app.context())[1].mark == LegendMark::dashed);
  app.view.ghost = false;
  robot.frames(1);
  CHECK(words(app) == Words{"Steady state"});
  app.view.ghost = true;
  set_mode(app.session, Mode::build);
  robot.frames(2);
  CHECK(words(app) == Words{"Drawn pose", "Steady state"}); // as the file says
  keep_explored(app.session);
  robot.frames(2);
  CHECK(words(app) == Words{"Drawn pose", "Steady state"});
  CHECK(legend_rows(app.context())[0].mark == LegendMark::outlined);
  CHECK(legend_rows(app.context())[1].mark == LegendMark::glass);
  set_mode(app.session, Mode::explore);
  app.session.motion.duration = 0.2;
  robot.key('M');
  robot.frames(3);
  CHECK(words(app) == Words{"Steady state", "Drawn pose", "Motion, damped"});
  open_document(app.session, Document());
  robot.frames(2);
  CHECK(words(app).empty());
  CHECK(app.ui.widgets.count("legend") == 0);
}

TEST_CASE("the legend names the periodic motion and the drawn pose beside it") {
  Robot robot;
  App& app = robot.app;
  Mechanism crank = Document::empty_mechanism();
  add_driven_slider_crank(crank, 10);
  open_document(app.session, Document(crank));
  robot.frames(3);
  REQUIRE(periodic_motion(app.session));
  CHECK(words(app).front() == "Periodic motion");
  play(app.session, true);
  robot.frames(3, 0.05);
  play(app.session, false);
  robot.frames(2);
  CHECK(words(app) == Words{"Periodic motion", "Drawn pose"});
  CHECK(legend_rows(app.context())[1].mark == LegendMark::dashed);
  set_mode(app.session, Mode::build);
  robot.frames(2);
  CHECK(words(app) == Words{"Drawn pose"}); // at its phase the crank stands as drawn
}

TEST_CASE("while a body is pulled along its joints the dashes are the pose before") {
  Robot robot({1280, 800});
  App& app = robot.app;
  set_mode(app.session, Mode::build);
  look_from(app.view, 0, 0);
  robot.frames(3);
  set_tool(app.session, app.ui, app.tool, Tool::pull);
  robot.frames(1);
  const auto ball = static_cast<std::size_t>(body_index(app.session.mechanism(), "ball1"));
  const Vec3 at = app.session.mechanism().bodies[ball].position;
  const ImVec2 from = robot.pixel(at);
  robot.point(from);
  robot.press();
  for (float by = 8; by < 60; by += 8)
    robot.point({from.x, from.y + by});
  robot.frames(2);
  REQUIRE(app.tool.assembly);
  CHECK(words(app) == Words{"Drawn pose", "Before the pull"});
  CHECK(legend_rows(app.context())[1].mark == LegendMark::dashed);
  robot.release();
  robot.frames(3);
  CHECK(words(app).front() == "Drawn pose");
  CHECK(words(app).back() != "Before the pull");
}

TEST_CASE("the legend's frame is as high as what is in it, at once") {
  Robot robot({1280, 900});
  App& app = robot.app;
  robot.frames(3);
  for (const bool loads : {true, false}) {
    app.commands.run("view.loads");
    for (int frame = 0; frame < 4; ++frame) {
      robot.frames(1);
      const ImGuiWindow* window = ImGui::FindWindowByName("legend");
      REQUIRE(window);
      std::size_t rows = 0; // drawn in this frame
      while (app.ui.widgets.contains("legend/" + std::to_string(rows)))
        ++rows;
      REQUIRE(rows > 0);
      const WidgetRect& last = robot.widget("legend/" + std::to_string(rows - 1));
      const float below = window->Pos.y + window->Size.y - last.to.y;
      CAPTURE(loads, frame, rows);
      CHECK(below > 0);
      CHECK(below < 0.5f * (last.to.y - last.from.y));
    }
    CHECK(app.view.loads == loads);
  }
}

TEST_CASE("the legend keeps clear of a status of several lines") {
  Robot robot({640, 480});
  App& app = robot.app;
  open_scene(app.session, shipped_file("governor_friction"));
  robot.frames(3);
  robot.key('C');
  robot.frames(5);
  const WidgetRect &legend = robot.widget("legend frame"), &status = robot.widget("status");
  CHECK(status.to.y - status.from.y > 2 * ImGui::GetTextLineHeight());
  CHECK((legend.to.y <= status.from.y || legend.to.x <= status.from.x));
  CHECK(app.session.problem.empty());
}

TEST_CASE("only dampers that act make a motion damped") {
  Robot robot;
  App& app = robot.app;
  edit_parameter(app.session, "joints.slide.damping", 0);
  app.session.motion.duration = 0.2;
  robot.key('M');
  robot.frames(3);
  REQUIRE(shown_motion(app.session));
  CHECK(words(app).back() == "Motion");
  for (const PlotCurve& curve : motion_plot(app.session, "value slide").curves)
    CHECK(curve.name == "motion");
  edit_parameter(app.session, "joints.slide.damping", 30);
  robot.frames(3);
  CHECK(words(app).back() == "Motion, damped");
  app.session.motion.runs[0].wanted = false;
  app.session.motion.runs[1].wanted = true;
  restart_motion(app.session);
  robot.frames(3);
  CHECK(words(app).back() == "Motion, without dampers");
}

TEST_CASE("the legend's amber is that of the motion, as pale as the glass in the view") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.session.motion.duration = 0.2;
  robot.key('M');
  robot.frames(3);
  const std::vector<LegendRow> rows = legend_rows(app.context());
  REQUIRE(rows.back().mark == LegendMark::motion);
  const WidgetRect row = robot.widget("legend/" + std::to_string(rows.size() - 1));
  const Image picture = robot.picture();
  const std::uint8_t* mark = picture.at(static_cast<int>(row.from.x + 10), static_cast<int>(row.center().y));
  const Color& amber = palette(app.ui.theme).motion;
  const auto over_white = [&](float part) { return 255 * (1 - amber.a * (1 - part)); };
  CHECK(static_cast<float>(mark[0]) == Approx(over_white(amber.r)).margin(12));
  CHECK(static_cast<float>(mark[1]) == Approx(over_white(amber.g)).margin(12));
  CHECK(static_cast<float>(mark[2]) == Approx(over_white(amber.b)).margin(12));
}

TEST_CASE("the time after the drawn phase stands on a plate") {
  Robot robot({1280, 900});
  CHECK_FALSE(robot.app.ui.widgets.contains("view/time"));
  robot.key(' ');
  robot.frames(20, 0.05);
  robot.key(' ');
  REQUIRE(robot.app.session.playback.time > 0);
  const WidgetRect plate = robot.widget("view/time");
  const Image picture = robot.picture();
  // Between its rim and the words there is but one colour.
  const int y = static_cast<int>(plate.from.y) + 1;
  const std::uint8_t* first = picture.at(static_cast<int>(plate.from.x) + 8, y);
  for (int x = static_cast<int>(plate.from.x) + 8; x < static_cast<int>(plate.to.x) - 8; ++x)
    for (int k = 0; k < 3; ++k)
      CHECK(std::abs(picture.at(x, y)[k] - first[k]) <= 6);
}

TEST_CASE("the legend folds") {
  Robot robot;
  REQUIRE(robot.app.ui.widgets.count("legend/0") == 1);
  robot.click("legend");
  CHECK_FALSE(robot.app.view.legend);
  CHECK(robot.app.ui.widgets.count("legend/0") == 0);
  robot.frames(30); // else it would be a double click
  robot.click("legend");
  CHECK(robot.app.ui.widgets.count("legend/0") == 1);
}

TEST_CASE("the legend leaves the drawn pose in sight, and stays where it is while something moves") {
  Robot robot({1280, 800});
  App& app = robot.app;
  robot.key('C');
  robot.frames(3);
  const auto middle = [&](const char* widget) {
    const WidgetRect at = app.ui.widgets.at(widget);
    return (at.from.y + at.to.y) / 2;
  };
  CHECK(middle("legend") < middle("view"));
  // One ball of the drawn pose goes under it.
  const WidgetRect legend = robot.widget("legend frame");
  const auto& m = app.session.mechanism();
  const Vec3 ball = m.bodies[static_cast<std::size_t>(body_index(m, "ball2"))].position;
  const ImVec2 from = robot.pixel(ball);
  robot.drag(from, {(legend.from.x + legend.to.x) / 2 - 20, (legend.from.y + legend.to.y) / 2}, 1);
  robot.frames(3);
  CHECK(middle("legend") > middle("view"));
  const float low = middle("legend");
  // The motion keeps it there even where nothing is under its upper place any more.
  robot.key(' ');
  robot.frames(1, 0.03);
  REQUIRE(in_motion(app.session, app.view));
  app.view.camera.zoom(0.2, {0, 800}, {1280, 800});
  for (int i = 0; i < 20; ++i) {
    robot.frames(1, 0.03);
    CHECK(middle("legend") == low);
  }
  robot.key(' ');
  robot.frames(3);
  CHECK(middle("legend") == low); // nor does it come back while it hides nothing there
}

TEST_CASE("in a narrow view the legend is folded where it would lie over the tools") {
  Robot robot({640, 480});
  App& app = robot.app;
  app.commands.run("view.loads");
  set_mode(app.session, Mode::build);
  robot.frames(3);
  const WidgetRect tools = robot.widget("tool strip"), legend = robot.widget("legend");
  CHECK(legend.from.x >= tools.to.x);
}

TEST_CASE("an open legend leaves the caption in sight where the view is narrow") {
  Robot robot({1280, 800});
  App& app = robot.app;
  edit(app.session, "Rename",
       [](Mechanism& next, Selection&) { next.name = "A governor with a name as long as half of the view"; });
  robot.key('M');
  robot.frames(3);
  robot.click("motion/beside");
  app.commands.run("view.loads");
  robot.frames(3);
  robot.click("legend");
  robot.frames(3);
  const WidgetRect name = robot.widget("view/name"), legend = robot.widget("legend frame");
  REQUIRE(app.ui.widgets.contains("legend/0"));
  REQUIRE(name.to.x > legend.from.x);
  CHECK(legend.from.y > name.to.y);
}

TEST_CASE("the tools keep clear of the cube however high the window is") {
  const int height = GENERATE(768, 743, 735, 700, 600);
  Robot robot({1366, height});
  set_mode(robot.app.session, Mode::build);
  robot.frames(3);
  // Above it is the letter of an axis.
  const WidgetRect tools = robot.widget("tool strip"), cube = robot.widget("view/cube");
  CHECK(tools.to.y < cube.from.y - 7);
}

TEST_CASE("drawn pose and steady state are drawn in different ways") {
  Robot robot;
  App& app = robot.app;
  change_parameter(app.session, "joints.spin.drive.speed", 18);
  keep_explored(app.session);
  robot.frames(2);
  const ViewScene exploring = view_scene(view_frame(app.session, app.ui, app.tool, app.view));
  CHECK(exploring.ghost.empty());
  CHECK_FALSE(exploring.drawn.empty());
  CHECK_FALSE(exploring.drawn_is_solid);
  // The spindle stands where it was drawn: there is nothing to outline.
  const auto outlined = [&](const ViewScene& scene, const char* body) {
    return std::ranges::any_of(scene.drawn, [&](const Instance& i) {
      return i.part == PartId{PartKind::body, body_index(app.session.mechanism(), body)};
    });
  };
  CHECK_FALSE(outlined(exploring, "spindle"));
  CHECK(outlined(exploring, "collar"));
  set_mode(app.session, Mode::build);
  robot.frames(2);
  const ViewScene building = view_scene(view_frame(app.session, app.ui, app.tool, app.view));
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

TEST_CASE("the legend does not hop from corner to corner while the wheel zooms") {
  Robot robot({1280, 800});
  App& app = robot.app;
  const char* scene = GENERATE("governor", "centrifugal_clutch", "rate_gyro", "fourbar_turntable");
  CAPTURE(scene);
  open_document(app.session, Document(shipped(scene)));
  app.commands.run("view.loads");
  robot.frames(3);
  const WidgetRect view = robot.widget("view");
  int hops = 0;
  bool low = robot.widget("legend frame").center().y > view.center().y;
  for (const ImVec2 share : {ImVec2(0.5f, 0.5f), ImVec2(0.3f, 0.4f), ImVec2(0.6f, 0.7f)}) {
    robot.point({view.from.x + share.x * (view.to.x - view.from.x),
                 view.from.y + share.y * (view.to.y - view.from.y)});
    for (int notch = 0; notch < 24; ++notch) {
      ImGui::GetIO().MouseWheel = notch < 12 ? 1.f : -1.f;
      robot.frames(1);
      const bool now = robot.widget("legend frame").center().y > view.center().y;
      hops += now != low;
      low = now;
    }
  }
  CHECK(hops <= 2);
}
