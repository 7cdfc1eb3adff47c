// What rests on dry friction in the window: its branches in the response curve, its states in the list.
#include "robot.hpp"

#include "app/session/friction.hpp"
#include "app/session/response.hpp"
#include "app/session/states.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <set>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinRel;

namespace {

const std::string damping = "joints.brake.damping";

// The clutch holds up to a damping of 0.025 N m s/rad and slips beyond.
struct ClutchRobot : Robot {
  explicit ClutchRobot(char study) : Robot({1280, 900}) {
    Mechanism m = clutch_and_brake(R"("friction": {"limit": 0.5})", R"("damping": 0.05)");
    m.sliders.push_back({.parameter = damping, .from = 0.01, .to = 0.1, .description = ""});
    open_document(app.session, Document(std::move(m)));
    frames(3);
    key(study);
    frames(3);
  }
  const Plot& plot() { return app.panels->studies.shown().response.plot; }
};

} // namespace

TEST_CASE("the response curve shows what friction holds and what slips, each in its own way") {
  ClutchRobot robot('C');
  Session& session = robot.app.session;
  choose_response(session, damping);
  robot.frames(3);
  const std::vector<ResponseQuantity> offered = offered_quantities(session);
  const auto speed = std::ranges::find(offered, "value clutch.speed", &ResponseQuantity::key);
  REQUIRE(speed != offered.end());
  CHECK(std::ranges::find(offered, "value clutch", &ResponseQuantity::key) != offered.end());
  choose_quantity(session, *speed);
  robot.frames(3);
  std::set<std::string> names;
  for (const PlotCurve& curve : robot.plot().curves) {
    names.insert(curve.name);
    REQUIRE(curve.notes.size() == curve.points.size());
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const auto [c, w] = curve.points[i];
      if (curve.name == "held as drawn") {
        CHECK(w == 0);
        CHECK(curve.notes[i].starts_with("clutch is held by "));
      } else {
        CHECK_THAT(w, WithinRel(0.5 / c - 20, 1e-9) || Catch::Matchers::WithinAbs(0, 1e-7));
        CHECK(curve.notes[i] == "clutch slips against 0.5 N m");
      }
    }
  }
  CHECK(names == std::set<std::string>{"held as drawn", "slips on friction"});
  REQUIRE(robot.plot().marks.size() == 1);
  CHECK(robot.plot().marks[0].label.starts_with("slip "));
  // Nothing is followed again before something has changed.
  const auto curve = session.study.response.curve.found;
  robot.frames(5);
  CHECK(session.study.response.curve.found == curve);
  CHECK(session.study.friction.ribbon.problem.empty());
  CHECK_FALSE(band_refusal(session).empty()); // of tolerances
  // The state goes along the branch that it is taken to.
  const auto& lines = session.study.response.curve.found->result.lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    go_to_response(session, i, 1, 1e-4, false);
    robot.frames(3);
    REQUIRE(session.answer.solution.status == Status::converged);
    CHECK(session.answer.solution.frictions.at(0).slips == lines[i].points[1].frictions.at(0).slips);
    CHECK(session.notice.empty());
  }
}

TEST_CASE("below the choice of the band it stands why there is no bound") {
  // Friction of 12 N m holds a pendulum of 10 N m at any angle.
  Robot robot({1280, 900});
  Session& session = robot.app.session;
  Mechanism m = rubbing_pendulum(12);
  m.sliders.push_back({.parameter = "bodies.bob.mass", .from = 1, .to = 2, .description = ""});
  open_document(session, Document(std::move(m)));
  robot.frames(3);
  robot.key('C');
  robot.frames(6);
  const auto& widgets = robot.app.ui.widgets;
  REQUIRE(widgets.count("response/ribbon") == 1);
  CHECK(widgets.count("response/ribbon/gap/1") == 1);
  const std::vector<RibbonGap> gaps = ribbon_gaps(session);
  REQUIRE(gaps.size() >= 1);
  CHECK_THAT(gaps[0].why, ContainsSubstring("Friction holds it at any angle"));
  CHECK(std::min(gaps[0].from, gaps[0].to) == 1);
  CHECK(std::max(gaps[0].from, gaps[0].to) == 2);
}

TEST_CASE("a state that slips is in the list of states, with its speed") {
  ClutchRobot robot('E');
  const Session& session = robot.app.session;
  REQUIRE(session.study.states.found);
  const std::vector<Solution>& all = session.study.states.found->result.equilibria;
  REQUIRE(all.size() == 1);
  CHECK(all[0].frictions.at(0).slips);
  CHECK(robot.app.ui.widgets.count("states/row/1/friction") == 1);
  CHECK(robot.app.ui.widgets.count("states/friction") == 1);
  CHECK(shown_state(session) == 0u);
  robot.click("states/row/1");
  robot.frames(3);
  CHECK(shown_state(session) == 0u);
}

TEST_CASE("a band that may go farther says so in its row") {
  Robot robot({1280, 1600}); // all rows in sight
  Session& session = robot.app.session;
  open_scene(session, shipped_file("governor_friction"));
  robot.frames(5);
  const FrictionReport* report = friction_report(session);
  REQUIRE(report);
  REQUIRE_FALSE(report->band.extents.empty());
  const std::string row = "results/friction/" + report->band.extents.front().name;
  const std::string whole = robot.copied(row);
  CHECK_THAT(whole, !ContainsSubstring("at least"));
  session.study.friction.report.found->result.band.at_least = true;
  robot.frames(2);
  CHECK(robot.copied(row) == "at least " + whole);
}
