// The response where the balance turns: periodic motions over a number, as a person uses them; and the limit
// cycle beside a steady state that hunts.
#include "robot.hpp"
#include "slider_crank.hpp"

#include "app/plot/csv.hpp"
#include "app/session/resonance.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/panel_list.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

// The horizontal rotor's response, asked for with the key C: above its critical speeds at first, where it
// takes few points.
struct ResonanceRobot : Robot {
  explicit ResonanceRobot(double from = 50, double to = 80) : Robot({1280, 900}) {
    open_scene(app.session, shipped_file("horizontal_rotor"));
    frames(2);
    choose_response(app.session, "parameters.n");
    choose_response_end(app.session, &ResponseChoice::to, to);
    choose_response_end(app.session, &ResponseChoice::from, from);
    change_parameter(app.session, "parameters.n", 60);
    frames(2);
    key('C');
    frames(3);
  }
  ResponseState& state() { return app.session.study.response; }
  const Plot& plot() { return app.panels->studies.shown().response.plot; }
  ImVec2 place(double x, double y) {
    const WidgetRect area = widget("plot/response/area");
    REQUIRE(app.panels->studies.shown().response.view.kept.layout);
    const PlotLayout& l = *app.panels->studies.shown().response.view.kept.layout;
    return {area.from.x + static_cast<float>(l.x.pixel(x) - l.area.left),
            area.from.y + static_cast<float>(l.y.pixel(y) - l.area.top)};
  }
};

// A disc in a block that slides on springs without dampers; its mass centre beside its axis.
Mechanism undamped_rotor() {
  Mechanism m;
  m.name = "Undamped";
  m.gravity = {0, -9.81, 0};
  m.bodies = {body("block", 0), body("disc", 4, {1e-3, 0, 0}, {0.01, 0.01, 0.02})};
  m.joints = {sprung(prismatic("x", "ground", "block", {0, 0, 0}, {1, 0, 0}), 1e4),
              driven(revolute("spin", "block", "disc", {0, 0, 0}, {0, 0, 1}), 20)};
  return m;
}

} // namespace

TEST_CASE("the response of the horizontal rotor is its periodic motions, with the band they move in") {
  ResonanceRobot robot;
  App& app = robot.app;
  REQUIRE(is_resonance(app.session));
  REQUIRE(robot.state().resonance.found);
  CHECK_FALSE(robot.state().curve.found);
  CHECK(app.ui.widgets.count("response/found") == 1);
  CHECK(app.ui.widgets.count("response/problem") == 0);
  CHECK(app.ui.widgets.count("response/band") == 0); // of steady states
  robot.click("response/quantity");
  robot.click("response/quantity/measure whirl");
  robot.frames(2);
  CHECK(robot.plot().y.label == "whirl");
  CHECK(robot.plot().y.si_unit == "m");
  REQUIRE(robot.plot().curves.size() == 1);
  REQUIRE(robot.plot().bands.size() == 1);
  CHECK(robot.plot().curves[0].name == "mean, stable");
  CHECK(robot.plot().curves[0].line == PlotLine::solid);
  // At its points it is what a search finds there.
  const auto& points = robot.state().resonance.found->result.points;
  const double factor = robot.plot().y.factor;
  for (const std::size_t i : {std::size_t{0}, points.size() / 2, points.size() - 1}) {
    Mechanism m = app.session.mechanism();
    set_parameter(m, "parameters.n", points[i]->number);
    const PeriodicState motion = find_periodic_state(m);
    const auto whirl = std::ranges::find(motion.measures, "whirl", &PeriodicMeasure::name);
    REQUIRE(whirl != motion.measures.end());
    CHECK(robot.plot().curves[0].points[i][1] == Approx(factor * whirl->range.mean).epsilon(1e-9));
    CHECK(robot.plot().bands[0].points[i][1] == Approx(factor * whirl->range.least).epsilon(1e-9));
    CHECK(robot.plot().bands[0].points[i][2] == Approx(factor * whirl->range.most).epsilon(1e-9));
  }
  // The table has mean, least and most, in SI units.
  const std::string csv = to_csv(robot.plot());
  CHECK_THAT(csv, ContainsSubstring("whirl [m]"));
  CHECK_THAT(csv, ContainsSubstring("least to most, from"));
  // Everything that is offered is drawn, what joints bear among it.
  CHECK(std::ranges::count(offered_quantities(app.session), "force spin", &ResponseQuantity::key) == 1);
  CHECK(std::ranges::count(offered_quantities(app.session), "power spin", &ResponseQuantity::key) == 1);
  for (const ResponseQuantity& quantity : offered_quantities(app.session)) {
    CAPTURE(quantity.key);
    choose_quantity(app.session, quantity);
    robot.frames(2);
    CHECK(robot.plot().y.label == quantity.title);
    CHECK_FALSE(robot.plot().curves.empty());
    CHECK(robot.plot().marker);
  }
}

TEST_CASE("the marker of periodic motions is dragged along them, and keys move it") {
  ResonanceRobot robot;
  App& app = robot.app;
  REQUIRE(robot.plot().marker);
  CHECK(robot.plot().marker->x == 60);
  CHECK(robot.plot().marker->pull.empty()); // pulled up it would need a steady state
  const auto found = robot.state().resonance.found;
  const double y = robot.plot().marker->y;
  robot.drag(robot.place(60, y), robot.place(70, y));
  const double now = get_parameter(app.session.mechanism(), "parameters.n");
  CHECK(now == Approx(70).margin(0.5));
  CHECK(now * 1000 == Approx(std::round(now * 1000)).margin(1e-9));
  CHECK(robot.plot().marker->x == now);
  CHECK(robot.state().resonance.found == found); // the same curve
  undo(app.session);
  robot.frames(2);
  CHECK(get_parameter(app.session.mechanism(), "parameters.n") == 60);
  robot.click(robot.place(55, robot.plot().curves[0].points[0][1]));
  robot.frames(2);
  CHECK(get_parameter(app.session.mechanism(), "parameters.n") == Approx(55).margin(0.5));
}

TEST_CASE("where there is no motion is told with the reason, and steady states are among them") {
  Robot robot({1280, 900});
  App& app = robot.app;
  open_document(app.session, Document(undamped_rotor()));
  set_mode(app.session, Mode::explore);
  robot.frames(2);
  choose_response(app.session, "joints.spin.drive.speed");
  choose_response_end(app.session, &ResponseChoice::from, 0);
  choose_response_end(app.session, &ResponseChoice::to, 200); // 50 is critical, slow ones take longest
  robot.key('C');
  robot.frames(3);
  REQUIRE(app.session.study.response.resonance.found);
  const ResonanceCurve& curve = app.session.study.response.resonance.found->result;
  CHECK(curve.points.front()->steady);
  const std::vector<ResonanceGap> gaps = resonance_gaps(curve);
  const auto critical =
      std::ranges::find_if(gaps, [](const ResonanceGap& gap) { return gap.from <= 50 && gap.to >= 50; });
  REQUIRE(critical != gaps.end());
  CHECK(critical->to - critical->from < 10);
  CHECK_THAT(critical->why, ContainsSubstring("No periodic motion"));
  CHECK(app.ui.widgets.count("response/gap/1") == 1);
  CHECK_THAT(resonance_words(app.session), ContainsSubstring("1 steady"));
  CHECK_THAT(resonance_words(app.session), ContainsSubstring("without a motion"));
}

TEST_CASE("periodic motions are found one by one while the window goes on, until they are stopped") {
  Robot robot({1280, 900}, LiveSolver::Mode::background);
  App& app = robot.app;
  const auto frame = [&] {
    robot.frames(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  open_scene(app.session, shipped_file("horizontal_rotor"));
  frame();
  open_study(app.session, StudyKind::response);
  std::vector<std::size_t> sizes;
  const auto& study = app.session.study.response.resonance;
  for (int i = 0; i < 4000 && sizes.size() < 5; ++i) {
    frame();
    if (!study.found) continue;
    const std::size_t now = study.found->result.points.size();
    if (sizes.empty() || now != sizes.back()) sizes.push_back(now);
  }
  REQUIRE(sizes.size() == 5);
  CHECK(std::ranges::is_sorted(sizes));
  CHECK(study.running());
  CHECK(app.ui.widgets.contains("plot/response/area"));
  for (int i = 0; i < 200 && !app.ui.widgets.contains("response/cancel"); ++i)
    frame();
  REQUIRE(app.ui.widgets.contains("response/cancel"));
  robot.click("response/cancel");
  for (int i = 0; i < 400 && study.running(); ++i)
    frame();
  frame();
  CHECK_FALSE(study.running());
  CHECK_FALSE(study.found->result.whole);
  CHECK_THAT(resonance_words(app.session), ContainsSubstring("stopped"));
  CHECK(app.ui.widgets.contains("plot/response/area"));
  // What is there stays when it goes on.
  const std::shared_ptr<const ResonancePoint> first = study.found->result.points.front();
  const std::size_t before = study.found->result.points.size();
  REQUIRE(app.ui.widgets.contains("response/go_on"));
  robot.click("response/go_on");
  CHECK(study.running());
  for (int i = 0; i < 20 && app.ui.widgets.contains("response/go_on"); ++i)
    frame();
  CHECK_FALSE(app.ui.widgets.contains("response/go_on"));
  for (int i = 0; i < 4000 && study.found->result.points.size() <= before; ++i)
    frame();
  CHECK(study.found->result.points.size() > before);
  CHECK(study.found->result.points.front() == first);
}

namespace {

// The governor with its engine and so little damping that it hunts.
struct HuntingRobot : Robot {
  explicit HuntingRobot(double damping = 15) : Robot({1280, 1400}) {
    open_scene(app.session, shipped_file("governor_engine"));
    frames(2);
    change_parameter(app.session, "joints.slide.damping", damping);
    frames(3);
  }
};

} // namespace

TEST_CASE("the limit cycle of a governor that hunts is found when it is asked for") {
  HuntingRobot robot;
  App& app = robot.app;
  REQUIRE(hunts(app.session));
  CHECK_FALSE(app.session.study.periodic.cycle.asked);
  robot.click("results/cycle");
  robot.frames(3);
  const PeriodicState* cycle = limit_cycle(app.session);
  REQUIRE(cycle);
  REQUIRE(cycle->status == PeriodicStatus::found);
  CHECK(cycle->stable == true);
  CHECK(cycle->period == Approx(1.74484).epsilon(1e-5));
  for (const char* name : {"results/cycle/message", "results/cycle/slide", "results/cycle/speed of spin",
                           "results/cycle/motion"})
    CHECK(app.ui.widgets.count(name) == 1);
  CHECK(converged(app.session)); // the steady state stays what is shown
  CHECK_FALSE(periodic_motion(app.session));
  robot.click("results/cycle");
  robot.frames(2);
  CHECK_FALSE(limit_cycle(app.session));
  CHECK_FALSE(app.session.study.periodic.cycle.asked);
}

TEST_CASE("while the limit cycle is looked for, what is done is told in words") {
  HuntingRobot robot;
  App& app = robot.app;
  app.session.options.mode = LiveSolver::Mode::background;
  robot.click("results/cycle");
  const auto& search = app.session.study.periodic.cycle;
  std::set<std::string> phases;
  bool bar = false;
  for (int i = 0; i < 20000 && search.running(); ++i) {
    const std::string phase = search.progress().phase;
    if (!phase.empty()) phases.insert(phase);
    robot.frames(1);
    bar = bar || app.ui.widgets.contains("results/cycle/running");
    std::this_thread::sleep_for(std::chrono::milliseconds(5)); // as a display would
  }
  REQUIRE_FALSE(search.running());
  robot.frames(2);
  CHECK(bar);
  CHECK(phases.contains("following a motion"));
  REQUIRE(limit_cycle(app.session));
  CHECK(limit_cycle(app.session)->status == PeriodicStatus::found);
}

TEST_CASE("the limit cycle is asked for by the palette, and goes where the damper holds") {
  HuntingRobot robot(20);
  App& app = robot.app;
  robot.key('P', true);
  robot.type("limit cycle");
  robot.frames(2);
  robot.key(key_enter);
  robot.frames(3);
  CHECK(app.session.study.periodic.cycle_wanted);
  const PeriodicState* cycle = limit_cycle(app.session);
  REQUIRE(cycle);
  CHECK(cycle->status == PeriodicStatus::found);
  CHECK(app.commands.enabled(command("study.cycle")));
  change_parameter(app.session, "joints.slide.damping", 30);
  robot.frames(3);
  CHECK_FALSE(hunts(app.session));
  CHECK_FALSE(limit_cycle(app.session));
  CHECK_FALSE(app.commands.enabled(command("study.cycle")));
  CHECK(app.ui.widgets.count("results/cycle") == 0);
}

TEST_CASE("the motion of a crank that a torque drives is found when it is asked for") {
  Robot robot({1280, 1400});
  App& app = robot.app;
  Mechanism m = Document::empty_mechanism();
  add_slider_crank_by_torque(m);
  open_document(app.session, Document(m));
  set_mode(app.session, Mode::explore);
  robot.frames(3);
  REQUIRE(app.session.answer.solution.status == Status::not_converged);
  REQUIRE(app.commands.enabled(command("study.cycle")));
  robot.click("results/cycle");
  robot.frames(3);
  const PeriodicState* cycle = limit_cycle(app.session);
  REQUIRE(cycle);
  CHECK(cycle->status == PeriodicStatus::found);
  CHECK(cycle->period == Approx(2 * std::numbers::pi / 20).epsilon(0.05));
  CHECK(app.ui.widgets.contains("results/cycle/motion"));
}
