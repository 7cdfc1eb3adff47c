// A report from the File menu: asked where to, written in the background, and told of.
#include "app/ui/commands.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/snapshot.hpp"
#include "engine/mechanism/file.hpp"
#include "robot.hpp"
#include "session_wait.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a report is exported of what is shown") {
  Robot robot;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flyball_exported_report.html";
  std::filesystem::remove(file);
  open_scene(robot.app.session, FLYBALL_ASSETS "/scenes/governor.json");
  robot.frames(3);
  change_parameter(robot.app.session, "joints.spin.drive.speed", 12.5); // explored, not stored
  const bool building = GENERATE(false, true);
  set_mode(robot.app.session, building ? Mode::build : Mode::explore);
  const Theme theme = robot.app.ui.theme;
  robot.app.commands.run("file.report");
  robot.app.panels->report.query().path = file.string(); // before the field has it
  robot.frames(3);
  robot.click("report/save");
  REQUIRE(robot.app.export_request);
  CHECK(robot.app.export_request->report);
  robot.app.export_request->width = 160;
  robot.app.export_request->height = 100;
  export_picture(robot.app, robot.size);
  robot.frames(2);
  CHECK(robot.app.session.notice == "Saved " + file.string());
  CHECK(robot.app.ui.theme == theme);
  CHECK(robot.app.session.mode == (building ? Mode::build : Mode::explore));
  const std::string page = read_bytes(file);
  CHECK(page.ends_with("</html>\n"));
  // While building, what is explored is put aside.
  CHECK(page.find(building ? "11.0174\u00a0rad/s" : "12.5\u00a0rad/s") != std::string::npos);
  CHECK(page.find("governor.json") != std::string::npos);
  CHECK((page.find("speed of spin 12.5\u00a0rad/s (in the file 11.0174\u00a0rad/s)") == std::string::npos) ==
        building);
  const std::size_t light = page.find("data:image/png;base64,"),
                    dark = page.find("data:image/png;base64,", light + 1);
  REQUIRE(dark != std::string::npos);
  CHECK(page.substr(light, 2000) != page.substr(dark, 2000));
  std::filesystem::remove(file);
}

TEST_CASE("a report that takes long is told of while it is written, and given up by a button") {
  Robot robot;
  App& app = robot.app;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flyball_given_up_report.html";
  std::filesystem::remove(file);
  open_document(app.session, Document(shipped("horizontal_rotor"))); // its curves are of many motions
  robot.frames(3);
  app.session.options.mode = LiveSolver::Mode::background;
  app.export_request = ExportRequest{.file = file, .width = 160, .height = 100, .report = true};
  export_picture(app, robot.size);
  const auto wait = [&](const auto& until) { REQUIRE(steps_until([&] { robot.frames(1); }, until)); };
  wait([&] { return app.ui.widgets.contains("banner/report/cancel"); });
  CHECK(next_progress(app) < 1);
  robot.click("banner/report/cancel");
  wait([&] { return !writing_report(app.report); });
  robot.frames(1);
  CHECK(app.session.notice == "The report was not written.");
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK_FALSE(app.ui.widgets.contains("banner/report/cancel"));
}

TEST_CASE("a report that cannot be written says so") {
  Robot robot;
  open_scene(robot.app.session, FLYBALL_ASSETS "/scenes/governor.json");
  robot.frames(3);
  robot.app.export_request =
      ExportRequest{.file = "/no/such/folder/report.html", .width = 160, .height = 100, .report = true};
  export_picture(robot.app, robot.size);
  robot.frames(2);
  CHECK(robot.app.session.notice.starts_with("Not saved: /no/such/folder"));
  CHECK(is_error(robot.app.session));
}
