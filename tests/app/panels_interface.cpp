// What a person does at the window, done by a robot off-screen.
#include "robot.hpp"
#include "temporary_folder.hpp"

#include "app/platform/access.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/snapshot.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/solutions.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

using namespace flyball;
using namespace flyball::test;

namespace {

double parameter(const App& app, const char* address) {
  return get_parameter(app.session.mechanism(), address);
}

constexpr const char* speed = "joints.spin.drive.speed";
constexpr const char* stiffness = "joints.slide.spring.stiffness";

} // namespace

TEST_CASE("a dragged slider solves at every move") {
  Robot robot;
  const double before = value(robot.app.session.answer.solution, "slide");
  const std::uint64_t answers = robot.app.session.answer.ticket;
  robot.drag(std::string("parameters/") + speed, {0.4f, 0.5f}, {0.8f, 0.5f});
  CHECK(parameter(robot.app, speed) > 20);
  CHECK(value(robot.app.session.answer.solution, "slide") != before);
  CHECK(robot.app.session.answer.ticket >= answers + 4);

  SECTION("and can be put back") {
    robot.click(std::string("parameters/") + speed + "/reset");
    CHECK(parameter(robot.app, speed) == 11.0174);
    CHECK(value(robot.app.session.answer.solution, "slide") == Approx(before).epsilon(1e-9));
  }
  SECTION("and back all at once") {
    robot.click("parameters/reset");
    CHECK(robot.app.session.mechanism() == robot.app.session.document.saved());
  }
}

TEST_CASE("a stiffness slider is logarithmic") {
  Robot robot;
  robot.drag(std::string("parameters/") + stiffness, {0.9f, 0.5f}, {0.5f, 0.5f});
  CHECK(parameter(robot.app, stiffness) == Approx(1000).epsilon(0.05)); // geometric mean of 50 and 20000
}

TEST_CASE("a value can be typed, with a unit") {
  Robot robot;
  robot.double_click(std::string("parameters/") + speed + "/value");
  CHECK(robot.app.ui.fields.typing.name == std::string("parameters/") + speed + "/value");
  robot.key('A', true);
  robot.type("120 rpm");
  robot.key(key_enter);
  CHECK(parameter(robot.app, speed) == Approx(4 * 3.141592653589793));
  CHECK(robot.app.ui.fields.typing.name.empty());
}

TEST_CASE("the view is steered with the mouse") {
  Robot robot;
  const ViewCamera before = robot.app.view.camera;
  SECTION("orbit") {
    robot.drag("view", {0.5f, 0.5f}, {0.6f, 0.5f});
    CHECK(robot.app.view.camera.azimuth != before.azimuth);
    CHECK(robot.app.view.camera.target == before.target);
  }
  SECTION("pan") {
    robot.drag("view", {0.5f, 0.5f}, {0.6f, 0.5f}, 1);
    CHECK(robot.app.view.camera.azimuth == before.azimuth);
    CHECK(robot.app.view.camera.target != before.target);
  }
  SECTION("zoom, and fit again") {
    robot.wheel("view", 2);
    CHECK(robot.app.view.camera.distance < before.distance);
    robot.key('F');
    CHECK(robot.app.view.camera.distance > before.distance * 0.8);
  }
  SECTION("from above") {
    robot.click("toolbar/top");
    CHECK(robot.app.view.camera.elevation == Approx(1.5707963267948966));
  }
}

TEST_CASE("a frame that shows nothing new is told from one that does, in the view and in the panels") {
  Robot robot;
  const auto has_news = [&] {
    robot.frames(1);
    return robot.stage.has_news();
  };
  const auto settles = [&] {
    for (int i = 0; i < 10; ++i) {
      if (!has_news()) return true;
      robot.picture();
    }
    return false;
  };
  REQUIRE(settles());
  robot.point(robot.widget("toolbar/top").center()); // which lights up
  CHECK(robot.stage.has_news());
  REQUIRE(settles());
  robot.app.view.camera.elevation += 0.1;
  CHECK(has_news());
  CHECK(robot.stage.has_news()); // not drawn yet
  robot.picture();
  CHECK_FALSE(robot.stage.has_news());
  robot.app.session.notice = "News";
  CHECK(has_news());
}

TEST_CASE("play turns the mechanism at the drives' speed, and nothing is drawn while nothing changes") {
  Robot robot;
  robot.frames(2);
  const int drawn = robot.stage.views_changed();
  robot.frames(5);
  CHECK(robot.stage.views_changed() == drawn);
  robot.key(' ');
  CHECK(robot.app.session.playback.playing);
  const double from = robot.app.session.playback.time;
  robot.frames(10, 0.02);
  CHECK(robot.app.session.playback.time - from == Approx(0.2));
  CHECK(robot.stage.views_changed() >= drawn + 10);
  robot.key(' ');
  const double stopped = robot.app.session.playback.time;
  robot.frames(3, 0.02);
  CHECK(robot.app.session.playback.time == stopped);
  robot.click("toolbar/rewind");
  CHECK(robot.app.session.playback.time == 0);
}

TEST_CASE("a part under the cursor is named") {
  Robot robot;
  const int ball = body_index(robot.app.session.mechanism(), "ball1");
  const WidgetRect view = robot.widget("view");
  const ViewSize size{static_cast<double>(view.to.x - view.from.x),
                      static_cast<double>(view.to.y - view.from.y)};
  const auto at =
      robot.app.view.camera.project(robot.app.session.poses[static_cast<std::size_t>(ball)].position, size);
  REQUIRE(at);
  robot.point({view.from.x + static_cast<float>(at->x()), view.from.y + static_cast<float>(at->y())});
  robot.frames(1);
  CHECK(robot.app.view.hovered == PartId{PartKind::body, ball});
}

TEST_CASE("a scene that cannot be read says so and leaves the open one") {
  Robot robot;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flyball_mistaken_scene.json";
  std::ofstream(file) << R"({"flyball": 1, "name": "x", "bodies": [], "joints": [], "colour": 1})";
  open_scene(robot.app.session, file);
  robot.frames(3);
  CHECK_THAT(robot.app.session.problem, ContainsSubstring("colour"));
  CHECK(robot.app.session.mechanism().name == "Governor");
  robot.key(258); // Tab: the tools of Build stay in reach
  robot.frames(2);
  REQUIRE(robot.app.session.mode == Mode::build);
  const ImGuiWindow* card = ImGui::FindWindowByName("problem");
  REQUIRE(card);
  CHECK(card->Pos.x >= robot.widget("tool strip").to.x);
  if (GENERATE(false, true))
    robot.key(key_escape);
  else
    robot.click("problem/close");
  CHECK(robot.app.session.problem.empty());
  std::filesystem::remove(file);
}

TEST_CASE("the open dialog lists scenes and opens one") {
  Robot robot;
  robot.key('O', true);
  robot.frames(2);
  REQUIRE(robot.app.dialog.showing);
  robot.type("pend"); // the list is longer than its window
  robot.frames(2);
  robot.click("open/pendulum.json");
  robot.frames(2);
  CHECK_FALSE(robot.app.dialog.showing);
  CHECK(robot.app.session.document.file().filename() == "pendulum.json");
  CHECK(robot.app.session.answer.solution.status == Status::converged);
}

TEST_CASE("a picture that was cancelled leaves nothing in the next dialog, one that was saved its size") {
  Robot robot;
  App& app = robot.app;
  const auto shown = [&](const char* how) {
    robot.key('E', true);
    robot.frames(2);
    robot.click("export/loads"); // leaves the field of the path
    app.panels->picture.query().path =
        (std::filesystem::temp_directory_path() / "flyball_never_drawn.png").string();
    robot.click(how);
    robot.frames(2);
    return std::exchange(app.export_request, {});
  };
  const auto choose = [&] {
    robot.key('E', true);
    robot.frames(2);
    robot.click("export/720p");
    robot.click("export/panels");
  };
  choose();
  CHECK_FALSE(shown("export/cancel"));
  const auto fresh = shown("export/save");
  REQUIRE(fresh);
  CHECK(fresh->width == 1920);
  CHECK_FALSE(fresh->panels);
  choose();
  app.panels->picture.query().path = fresh->file.string();
  robot.click("export/save");
  robot.frames(2);
  REQUIRE(app.export_request);
  const auto again = shown("export/save");
  REQUIRE(again);
  CHECK(again->width == 1280);
  CHECK(again->panels);
}

TEST_CASE("a dialog stays open, and says why, where nothing can be written into the folder") {
  const TemporaryFolder folder;
  const std::filesystem::path sealed = folder / "sealed";
  std::filesystem::create_directory(sealed);
  std::filesystem::permissions(sealed,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  if (!write_refusal(sealed)) return; // nothing is refused to who may do all
  Robot robot;
  robot.key('E', true);
  robot.frames(2);
  robot.click("export/720p");
  robot.app.panels->picture.query().path = (sealed / "picture.png").string();
  robot.click("export/save");
  robot.frames(2);
  CHECK_FALSE(robot.app.export_request);
  CHECK(robot.app.dialog.showing);
  CHECK_THAT(robot.app.panels->picture.query().message, ContainsSubstring("written into"));
}

TEST_CASE("a picture that could not be written is asked for again, as it was, and why") {
  const TemporaryFolder folder;
  Robot robot;
  App& app = robot.app;
  robot.key('E', true);
  robot.frames(2);
  robot.click("export/720p");
  robot.click("export/panels");
  const std::string name = (folder / (std::string(300, 'a') + ".png")).string(); // longer than names may be
  app.panels->picture.query().path = name;
  robot.click("export/save");
  REQUIRE(app.export_request);
  app.export_request->width = 320;
  app.export_request->height = 200;
  export_picture(app, robot.size);
  robot.frames(3);
  REQUIRE(app.dialog.showing);
  CHECK_THAT(app.panels->picture.query().message, ContainsSubstring("Not saved"));
  CHECK(app.panels->picture.query().path == name);
  robot.type((folder / "short.png").string()); // in the field's place
  robot.key(key_enter);
  REQUIRE(app.export_request);
  CHECK(app.export_request->width == 1280);
  CHECK(app.export_request->panels);
}

TEST_CASE("a plot's picture that could not be written is asked for again, and why") {
  const TemporaryFolder folder;
  Robot robot({1280, 900});
  App& app = robot.app;
  robot.key('C');
  robot.frames(3);
  robot.click(robot.widget("plot/response/area").center(), 1);
  robot.frames(2);
  robot.click("plot/response/menu/png");
  robot.frames(2);
  REQUIRE(app.dialog.showing);
  robot.click("save_plot/width"); // leaves the field of the path
  const std::string name = (folder / (std::string(300, 'a') + ".png")).string();
  app.panels->plot.query().path = name;
  robot.click("save_plot/save");
  REQUIRE(app.export_request);
  const int width = app.export_request->width;
  export_picture(app, robot.size);
  robot.frames(3);
  REQUIRE(app.dialog.showing);
  CHECK_THAT(app.panels->plot.query().message, ContainsSubstring("Not saved"));
  CHECK(app.panels->plot.query().path == name);
  robot.type((folder / "short.png").string());
  robot.key(key_enter);
  REQUIRE(app.export_request);
  CHECK(app.export_request->width == width);
  export_picture(app, robot.size);
  CHECK(read_png(folder / "short.png").width == width);
}

TEST_CASE("a picture is exported with and without the panels") {
  Robot robot;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flyball_exported.png";
  std::filesystem::remove(file);
  robot.key('E', true);
  robot.frames(2);
  REQUIRE(robot.app.dialog.showing);
  robot.click("export/720p"); // leaves the field of the path
  robot.app.panels->picture.query().path = file.string();
  const bool panels = GENERATE(false, true);
  if (panels) robot.click("export/panels");
  robot.click("export/save");
  REQUIRE(robot.app.export_request);
  CHECK(robot.app.export_request->panels == panels);
  robot.app.export_request->width = 320;
  robot.app.export_request->height = 200;
  export_picture(robot.app, robot.size);
  CHECK_THAT(robot.app.session.notice, ContainsSubstring("Saved"));
  const Image image = read_png(file);
  CHECK(image.width == 320);
  CHECK(image.height == 200);
  // The window goes on as before.
  robot.frames(1);
  CHECK(robot.app.ui.scale == 1);
  CHECK(robot.widget("view").to.x > 320);
  std::filesystem::remove(file);
}

TEST_CASE("nothing is drawn outside a tiny or a huge window") {
  for (const PixelSize size :
       {PixelSize{1, 1}, PixelSize{120, 90}, PixelSize{800, 600}, PixelSize{2600, 1400}}) {
    Robot robot(size);
    const Image image = robot.picture();
    CHECK(image.width == size.width);
  }
}

TEST_CASE("the tutorial of the README is in Help, without its marks") {
  Robot robot({1280, 800});
  robot.app.commands.run("help.tutorial");
  robot.frames(3);
  CHECK(robot.app.ui.widgets.contains("tutorial/1"));
  const std::string text(tutorial_text());
  CHECK(text.starts_with("1. Ctrl+N begins an empty document"));
  CHECK(std::ranges::count(text, '\n') == 6); // six steps and a word on undoing
  CHECK_THAT(text, ContainsSubstring("=2*L + 5 mm") && !ContainsSubstring("`") && !ContainsSubstring("**"));
  robot.app.commands.run("help.tutorial");
  robot.frames(2);
  CHECK_FALSE(robot.app.ui.widgets.contains("tutorial/1"));
  robot.app.commands.run("help.about");
  CHECK_THAT(robot.app.session.notice, ContainsSubstring("Flyball ") && ContainsSubstring("MIT license"));
}

TEST_CASE("over an empty document either the first steps are shown or the tutorial") {
  Robot robot({1280, 800});
  robot.begin_empty(1);
  robot.frames(2);
  CHECK(robot.app.ui.widgets.contains("welcome/examples"));
  robot.app.commands.run("help.tutorial");
  robot.frames(2);
  CHECK(robot.app.ui.widgets.contains("tutorial/1"));
  CHECK_FALSE(robot.app.ui.widgets.contains("welcome/examples"));
}

TEST_CASE("in a small window the first steps lie beside the tools, and what cannot be opened is told whole") {
  Robot robot({640, 480});
  robot.begin_empty(1);
  robot.frames(4);
  const WidgetRect tools = robot.widget("tool strip"), view = robot.widget("view");
  const ImGuiWindow* steps = ImGui::FindWindowByName("welcome");
  REQUIRE((steps && steps->WasActive));
  CHECK(steps->Pos.x >= tools.to.x);
  CHECK(steps->Pos.y >= view.from.y);
  CHECK(steps->Pos.y + steps->Size.y <= view.to.y);
  const auto whole = [&](const char* name, const char* words, const ImGuiWindow& card) {
    const WidgetRect& rect = robot.widget(name);
    CAPTURE(words);
    CHECK(rect.to.x - rect.from.x >= ImGui::CalcTextSize(words).x);
    CHECK(rect.to.x < card.Pos.x + card.Size.x);
    CHECK(rect.to.y < card.Pos.y + card.Size.y);
  };
  whole("welcome/examples", "Start from an example…", *steps);
  whole("welcome/open", "Open…", *steps);
  open_scene(robot.app.session, "there_is_none.json");
  robot.frames(4);
  CHECK_FALSE(robot.app.ui.widgets.contains("welcome/examples")); // they would lie over each other
  const ImGuiWindow* problem = ImGui::FindWindowByName("problem");
  REQUIRE((problem && problem->WasActive));
  whole("problem/close", "Keep the open scene", *problem);
  whole("problem/open", "Open another…", *problem);
}

TEST_CASE("a menu taller than the window opens below its title and scrolls") {
  Robot robot({640, 480});
  App& app = robot.app;
  robot.frames(2);
  const Mode mode = app.session.mode;
  const WidgetRect title = robot.widget("menu/View");
  robot.click("menu/View");
  robot.frames(3);
  CHECK(app.session.mode == mode); // the click pressed nothing but the title
  float top = 1e9f;
  for (const auto& [name, rect] : app.ui.widgets)
    if (name.starts_with("menu/view.")) top = std::min(top, rect.from.y);
  CHECK(top >= title.to.y);
  CHECK(top < 480);
  REQUIRE_FALSE(app.ui.widgets.contains("menu/view.theme_contrast")); // below the window's end
  robot.point({title.center().x, 300});
  for (int i = 0; i < 8; ++i) {
    ImGui::GetIO().MouseWheel = -5;
    robot.frames(2);
  }
  robot.click("menu/view.theme_contrast");
  robot.frames(3);
  CHECK(app.ui.theme == Theme::high_contrast);
}
