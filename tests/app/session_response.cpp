// The response's point, taken along its curve, without a window.
#include "app/session/response_design.hpp"
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

namespace {

// The governor with a parameter that nothing rests on.
struct SpareSession : Session {
  SpareSession() : Session({.mode = LiveSolver::Mode::immediate}) {
    open_scene(*this, shipped_file("governor"));
    frames();
    edit(*this, "Spare", [](Mechanism& m, Selection&) {
      NamedParameter spare;
      spare.name = "spare";
      spare.value = 3;
      m.parameters.push_back(std::move(spare));
    });
    frames();
  }
  void frames() {
    for (int i = 0; i < 3; ++i)
      update(*this, 0);
  }
};

// Of the drive's speed and the number that nothing uses.
void open_map(Session& session) {
  open_study(session, StudyKind::map);
  session.study.map.choice.axes = {map_axis(session, "joints.spin.drive.speed"),
                                   map_axis(session, "parameters.spare")};
  for (MapAxis& axis : session.study.map.choice.axes)
    axis.count = 3;
}

} // namespace

TEST_CASE("Session: a curve over a number that an undo has taken away is not gone along") {
  SpareSession session;
  open_study(session, StudyKind::response);
  choose_response(session, "parameters.spare");
  session.frames();
  REQUIRE(session.study.response.curve.found);
  undo(session);
  // In the same frame, before the session is updated, and while the hand goes on.
  go_to_response(session, 0, 1, 1e-3, true);
  go_to_response(session, 0, 1.5, 1e-3, true);
  CHECK_FALSE(session.on_branch);
  CHECK_FALSE(is_error(session));
  session.frames();
  REQUIRE(session.study.response.curve.found);
  CHECK(session.study.response.curve.found->of.address == "joints.spin.drive.speed");
}

TEST_CASE("Session: a map over a number that is gone goes with it, also while the document has mistakes") {
  SpareSession session;
  open_map(session);
  session.study.map.choice.folds = true;
  session.frames();
  REQUIRE(session.study.map.cells.found);
  REQUIRE(session.study.map.cells.found->of.choice.axes[1].address == "parameters.spare");
  edit(session, "Lost", [](Mechanism& m, Selection&) {
    m.parameters.clear();
    m.bodies.front().mass = -1;
  });
  REQUIRE_FALSE(session.mistakes.empty());
  session.frames();
  CHECK_FALSE(session.study.map.cells.found);
  CHECK_FALSE(session.study.map.curves.found);
}

TEST_CASE("Session: a map takes another number where an expression has come to give the one it was over") {
  SpareSession session;
  open_map(session);
  session.frames();
  edit(session, "Given", [](Mechanism& m, Selection&) {
    m.parameters.front().formulas = {{"value", "2+2"}};
  });
  session.frames();
  CHECK(session.study.map.choice.axes[0].address == "joints.spin.drive.speed");
  CHECK(session.study.map.choice.axes[1].address == "joints.slide.spring.stiffness");
  CHECK(map_problem(session).empty());
}

TEST_CASE("Session: a state that is refused puts nothing on a branch") {
  SpareSession session;
  edit(session, "Inverse", [](Mechanism& m, Selection&) {
    NamedParameter inverse;
    inverse.name = "inverse";
    inverse.formulas = {{"value", "1/spare"}};
    m.parameters.push_back(std::move(inverse));
  });
  session.frames();
  REQUIRE(converged(session));
  go_to_state(session, "parameters.spare", 0, start_values(session.answer.solution.coordinates));
  CHECK(is_error(session));
  CHECK_FALSE(session.on_branch);
  CHECK(get_parameter(session.mechanism(), "parameters.spare") == 3);
  go_to_state(session, "parameters.spare", 4, start_values(session.answer.solution.coordinates));
  CHECK(session.on_branch);
}

TEST_CASE("Session: what friction holds is one band past a kink, at which stability is open") {
  ResponseCurve::Found curve;
  curve.of.from = 0;
  curve.of.to = 1;
  ResponseLine line;
  for (int i = 0; i <= 4; ++i) {
    ResponsePoint point;
    point.parameter = i / 4.;
    if (i != 2) point.stable = true; // on the kink it is not known
    line.points.push_back(std::move(point));
  }
  line.special.assign(line.points.size(), 0);
  curve.result.lines = {line};
  const std::vector<BandRun> held = band_runs(curve, BandOf::any);
  REQUIRE(held.size() == 1); // or the slow rise and fall would jump from one to the next
  CHECK(held[0].states.size() == 5);
  CHECK(held[0].apart == std::vector<std::size_t>{0, 1, 2, 3, 4});
  CHECK(band_runs(curve, BandOf::stable).size() == 2);
}

TEST_CASE("Session: Find tells what the curve crosses before it looks for other poses") {
  std::vector<std::size_t> told; // solutions, each time there was news of them
  Session* seen = nullptr;
  Session session({.mode = LiveSolver::Mode::immediate, .on_news = [&] {
                     if (!seen) return;
                     take_design(*seen);
                     const auto& found = seen->study.response.design.answer.found;
                     if (found) told.push_back(found->result.solutions.size());
                   }});
  open_scene(session, shipped_file("governor"));
  open_study(session, StudyKind::response);
  for (int i = 0; i < 3; ++i)
    update(session, 0);
  ResponseDesign& design = session.study.response.design;
  design.coordinate = "slide";
  design.value = 0.12;
  seen = &session;
  find_design(session);
  seen = nullptr;
  REQUIRE(told.size() == 2);
  CHECK(told[0] >= 1);
  CHECK(told[1] >= told[0]);
  CHECK(design.answer.found->result.solutions.front().parameter > 0);
}
