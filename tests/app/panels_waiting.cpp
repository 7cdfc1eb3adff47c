// A scene that takes long to solve: the interface does not wait for it.
#include "robot.hpp"

#include "tests/catch.hpp"

#include <string>

using namespace flyball;
using namespace flyball::test;

namespace {

// A straight, tilted chain above its critical speed. The drag at its tip, which has no potential, makes it
// take seconds: its equations are dense up to 200 coordinates.
Mechanism long_chain(int links) {
  Mechanism chain;
  chain.name = "Long chain";
  chain.gravity = {0, -9.80665, 0};
  const double length = 1.0 / links, mass = 1.0 / links;
  Body& hub = chain.bodies.emplace_back();
  hub.name = "hub";
  hub.mass = 1;
  Joint& spin = chain.joints.emplace_back();
  spin.name = "spin";
  spin.bodies = {"ground", "hub"};
  spin.axis = Vec3::UnitY();
  spin.coordinates.resize(1);
  spin.coordinates[0].drive = Drive{.speed = 5, .description = {}};
  std::string last = "hub";
  for (int i = 0; i < links; ++i) {
    const Vec3 along(1e-3 * length, -length, 0);
    Body& link = chain.bodies.emplace_back();
    link.name = "link" + std::to_string(i);
    link.mass = mass;
    link.position = (i + 0.5) * along;
    link.inertia = {mass * length * length / 12, 0, mass * length * length / 12, 0, 0, 0};
    Joint& hinge = chain.joints.emplace_back();
    hinge.name = "hinge" + std::to_string(i);
    hinge.bodies = {last, link.name};
    hinge.at = i * along;
    hinge.coordinates.resize(1);
    last = link.name;
  }
  Force& drag = chain.forces.emplace_back();
  drag.name = "air";
  drag.type = ForceType::drag;
  drag.body = last;
  drag.linear = 1e-6;
  return chain;
}

} // namespace

TEST_CASE("while a long solve runs the view moves and says that it is solving") {
  const OffscreenContext context;
  App app({.mode = LiveSolver::Mode::background,
           .on_news = {},
           .scenes = {},
           .theme = Theme::light,
           .numbers = {},
           .state = {}});
  app.view.samples = 1;
  Stage stage(app, 1);
  const PixelSize size{900, 600};
  const auto frame = [&] { stage.frame(app, size, 0.1); };
  open_document(app, Document(long_chain(190)));
  for (int i = 0; i < 4; ++i)
    frame();
  REQUIRE(solving(app));
  CHECK(app.waited > 0.15); // long enough to be told
  CHECK(app.widgets.contains("status"));

  const Vec3 before = app.view.camera.target;
  const ImVec2 middle = app.widgets.at("view").center();
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = middle;
  frame();
  io.MouseDown[1] = true;
  frame();
  io.MousePos = {middle.x + 60, middle.y};
  frame();
  io.MouseDown[1] = false;
  frame();
  CHECK(solving(app)); // all this while
  CHECK((app.view.camera.target - before).norm() > 0);
}
