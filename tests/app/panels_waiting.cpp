// A scene that takes long to solve: the interface does not wait for it.
#include "robot.hpp"

#include "tests/catch.hpp"
#include "tests/support/parts.hpp"

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
  chain.bodies = {body("hub")};
  chain.joints = {driven(revolute("spin", "ground", "hub", {0, 0, 0}, Vec3::UnitY()), 5)};
  const Vec3 along(1e-3 * length, -length, 0), inertia = mass * length * length / 12 * Vec3(1, 0, 1);
  std::string last = "hub";
  for (int i = 0; i < links; ++i) {
    const std::string number = std::to_string(i), name = "link" + number;
    chain.bodies.push_back(body(name, mass, (i + 0.5) * along, inertia));
    chain.joints.push_back(revolute("hinge" + number, last, name, i * along));
    last = name;
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
  Robot robot({900, 600}, LiveSolver::Mode::background);
  App& app = robot.app;
  const auto frame = [&] { robot.frames(1, 0.1); };
  open_document(app.session, Document(long_chain(190)));
  for (int i = 0; i < 4; ++i)
    frame();
  REQUIRE(solving(app.session));
  CHECK(app.session.waited > 0.15); // long enough to be told
  CHECK(app.ui.widgets.contains("status"));

  const Vec3 before = app.view.camera.target;
  const ImVec2 middle = robot.widget("view").center();
  robot.drag(middle, {middle.x + 60, middle.y}, 1);
  CHECK(solving(app.session)); // all this while
  CHECK((app.view.camera.target - before).norm() > 0);
}
