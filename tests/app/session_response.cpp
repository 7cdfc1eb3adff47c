// The response's point, taken along its curve, without a window.
#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

// Run with -fsanitize=address or checked indices: what lies before a branch's first point is nobody's.
TEST_CASE("Session: the point of a response goes to a branch's very beginning") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, shipped_file("conical_pendulum"));
  open_study(session, StudyKind::response);
  for (int i = 0; i < 3; ++i)
    update(session, 0);
  const auto curve = session.study.response.curve.found;
  REQUIRE(curve);
  const std::string& address = curve->of.address;
  CHECK(address == "joints.spin.drive.speed");
  const double step = GENERATE(1e-3, 7.); // of which neither has a multiple between the first two points
  int begun_between = 0;
  for (std::size_t l = 0; l < curve->result.lines.size(); ++l) {
    const std::vector<ResponsePoint>& points = curve->result.lines[l].points;
    REQUIRE(points.size() > 2);
    const auto [low, high] = std::minmax({points[0].parameter, points[1].parameter, points[2].parameter});
    const double wanted = std::round(points[0].parameter / step) * step;
    begun_between += wanted < low || wanted > high;
    go_to_response(session, l, 0, step, false);
    update(session, 0);
    REQUIRE(converged(session));
    const double found = get_parameter(session.mechanism(), address);
    CHECK(found >= low);
    CHECK(found <= high);
    CHECK(session.answer.solution.coordinates.size() == points[0].coordinates.size());
  }
  CHECK(begun_between > 0);
}
