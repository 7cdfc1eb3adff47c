// Every shipped scene, as the view and as the whole interface.
#include "stored_picture.hpp"

#include "app/render/offscreen.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/panels.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

void check_stored(const std::string& name, const Image& image) {
  const ImageComparison comparison = compare_with_stored(name, image);
  INFO(name << ": " << comparison.message);
  CHECK(comparison.same);
}

} // namespace

TEST_CASE("every shipped scene looks as it did") {
  const OffscreenContext context;
  for (const std::filesystem::path scene : shipped_files()) {
    const std::string name = scene.stem().string();
    DYNAMIC_SECTION(name) {
      App app(steady_options());
      app.view.samples = 1;
      open_scene(app.session, scene);
      REQUIRE(app.session.problem.empty());
      check_stored(name + "-view", view_picture(app, view_size));
      app.view.fit = true;
      check_stored(name + "-interface", interface_picture(app, interface_size, 1));
    }
  }
}

TEST_CASE("dark colours and twice the scale look as they did", "[egl]") {
  const OffscreenContext context;
  App app(steady_options(Theme::dark));
  open_scene(app.session, FLYBALL_ASSETS "/scenes/governor.json");
  app.panels->results.sections().reactions = app.panels->results.sections().eigenvalues =
      app.panels->results.sections().system = true;
  check_stored("governor-dark-2x", interface_picture(app, {2400, 1700}, 2));
}

TEST_CASE("a scene without a steady state says so beside its drawn pose", "[egl]") {
  const OffscreenContext context;
  App app(steady_options());
  app.view.samples = 1;
  open_scene(app.session, FLYBALL_ASSETS "/scenes/pendulum.json");
  // Gravity across the crank's axis.
  change_parameter(app.session, "gravity.1", -9.80665);
  check_stored("no-steady-state", interface_picture(app, interface_size, 1));
  CHECK(app.session.answer.solution.status == Status::no_steady_state);
}

TEST_CASE("the dialog for pictures looks as it did") {
  const OffscreenContext context;
  App app(steady_options());
  app.view.samples = 1;
  open_scene(app.session, FLYBALL_ASSETS "/scenes/rate_gyro.json");
  app.commands.run("file.export");
  app.panels->picture.query().path = "/home/somebody/rate_gyro.png";
  check_stored("export-dialog", interface_picture(app, interface_size, 1));
}

TEST_CASE("a scene that cannot be read shows its message") {
  const OffscreenContext context;
  App app(steady_options());
  app.view.samples = 1;
  open_scene(app.session, FLYBALL_ASSETS "/scenes/governor.json");
  app.session.problem = "mistaken.json: joints.spin.axis: expected three numbers, found \"up\"";
  check_stored("unreadable-scene", interface_picture(app, interface_size, 1));
}
