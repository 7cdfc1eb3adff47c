// The modes of the state that is shown, moving in the view, and the Campbell diagram.
#include "robot.hpp"
#include "session_wait.hpp"
#include "slider_crank.hpp"

#include "app/document/formula_edits.hpp"
#include "app/session/campbell.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/session/modes.hpp"
#include "app/session/variable_numbers.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/modes/campbell_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize wide{1280, 900};

struct ModesRobot : Robot {
  explicit ModesRobot(const std::string& scene, PixelSize window = wide) : Robot(window) {
    open_scene(app.session, shipped_file(scene));
    frames(3);
    key('O');
    frames(5);
  }
  const std::vector<VibrationMode>& modes() { return app.session.study.modes.list.found->result.modes; }
  // The first that swings.
  std::size_t swinging() {
    const auto found = std::ranges::find_if(modes(), &VibrationMode::oscillates);
    REQUIRE(found != modes().end());
    return static_cast<std::size_t>(found - modes().begin());
  }
};

// How far the ends of a distance joint are from where they belong, in these poses (m).
double opened(const Mechanism& m, const std::vector<Pose>& drawn, const std::vector<Pose>& poses) {
  double worst = 0;
  for (const Joint& joint : m.joints) {
    if (joint.type != JointType::distance) continue;
    REQUIRE(joint.length);
    std::array<Vec3, 2> at;
    for (std::size_t end = 0; end < 2; ++end) {
      const int b = body_index(m, joint.bodies[end]);
      const auto i = static_cast<std::size_t>(b);
      at[end] = b < 0
                    ? joint.points[end]
                    : Vec3(poses[i].position + poses[i].rotation * (drawn[i].rotation.inverse() *
                                                                    (joint.points[end] - drawn[i].position)));
    }
    worst = std::max(worst, std::abs((at[1] - at[0]).norm() - *joint.length));
  }
  return worst;
}

} // namespace

TEST_CASE("lines of the Campbell diagram are called as the list's modes, circular whirls too") {
  ModesRobot robot("rotor_oil_whip");
  const Session& session = robot.app.session;
  const auto place = campbell_place(session);
  REQUIRE(place);
  std::set<std::string> names;
  for (const std::string& name : campbell_names(session, *place))
    if (name.starts_with("mode ")) names.insert(name);
  std::set<std::string> listed;
  for (std::size_t i = 0; i < robot.modes().size(); ++i)
    if (const VibrationMode& mode = robot.modes()[i]; mode.oscillates()) {
      REQUIRE(mode.leading());
      listed.insert("mode " + std::to_string(i + 1) + ", " + coordinate_words(*mode.leading()));
    }
  CHECK(listed.size() == 4);
  CHECK(names == listed);
}

TEST_CASE("in a small window every column of the list of modes is whole, and so are the diagram's choices") {
  ModesRobot robot("governor", {640, 480});
  const WidgetMap& widgets = robot.app.ui.widgets;
  CHECK_FALSE(widgets.contains("modes/title/[rad/s]")); // the same frequency again
  for (const char* title : {"Natural [Hz]", "Damping", "Real part [1/s]"}) {
    CAPTURE(title);
    const WidgetRect& rect = robot.widget("modes/title/" + std::string(title));
    CHECK(rect.to.x - rect.from.x >= ImGui::CalcTextSize(title).x - 0.5f); // as far as it can be seen
  }
  for (const char* unit : {"hertz", "radians"}) {
    CAPTURE(unit);
    const WidgetRect& rect = robot.widget("campbell/" + std::string(unit));
    const char* words = std::string_view(unit) == "hertz" ? "Hz" : "rad/s";
    CHECK(rect.to.x - rect.from.x >= ImGui::CalcTextSize(words).x);
    CHECK(rect.to.x <= 640);
  }
}

TEST_CASE("no modes before they are asked for, and a closed study leaves nothing that moves") {
  Robot robot(wide);
  CHECK_FALSE(robot.app.session.study.modes.list.asked);
  CHECK_FALSE(robot.app.session.study.modes.campbell.diagram.asked);
  robot.key('O');
  robot.frames(2);
  REQUIRE(robot.app.session.study.modes.list.found);
  robot.click("modes/row/1");
  CHECK_FALSE(robot.app.session.study.modes.poses.empty());
  CHECK(in_motion(robot.app.session, robot.app.view));
  robot.click("study/close");
  const ModesState& modes = robot.app.session.study.modes;
  CHECK_FALSE(modes.list.asked);
  CHECK_FALSE(modes.list.found);
  CHECK_FALSE(modes.campbell.diagram.asked);
  CHECK(modes.poses.empty());
  CHECK_FALSE(in_motion(robot.app.session, robot.app.view));
  CHECK(view_frame(robot.app.session, robot.app.ui, robot.app.tool, robot.app.view).motion.empty());
}

TEST_CASE("the governor's modes are its eigenvalues, and agree with its potential") {
  ModesRobot robot("governor");
  const App& app = robot.app;
  REQUIRE(app.session.answer.solution.eigenvalues);
  for (const VibrationMode& mode : robot.modes()) {
    double nearest = 1e300;
    for (const std::complex<double>& s : *app.session.answer.solution.eigenvalues)
      nearest = std::min(nearest, std::abs(s - mode.eigenvalue));
    CHECK(nearest < 1e-6 * (1 + mode.natural_frequency));
    CHECK_FALSE(grows(mode));
  }
  REQUIRE(app.session.study.modes.list.found->result.evidence);
  CHECK(app.session.study.modes.list.found->result.evidence->agree);
  robot.widget("modes/verdict");
  robot.widget("modes/row/1");
}

TEST_CASE("a chosen mode moves about the steady state, and the governor's links keep their lengths") {
  ModesRobot robot("governor");
  App& app = robot.app;
  robot.click("modes/row/1");
  REQUIRE(moving_mode(app.session));
  const std::vector<Pose> drawn = drawn_poses(app.session.mechanism());
  double furthest = 0;
  std::vector<Vec3> seen;
  for (int i = 0; i < 40; ++i) {
    robot.frames(1, 0.05);
    const std::vector<Pose>& poses = app.session.study.modes.poses;
    REQUIRE(poses.size() == app.session.poses.size());
    CHECK(opened(app.session.mechanism(), drawn, poses) < 1e-9);
    for (std::size_t b = 0; b < poses.size(); ++b)
      furthest = std::max(furthest, (poses[b].position - app.session.poses[b].position).norm());
    seen.push_back(poses[1].position);
  }
  CHECK(furthest > 0.005);
  CHECK(furthest < 0.2);
  CHECK((seen.front() - seen[10]).norm() > 1e-4);
  // Amber beside the solid one.
  const ViewFrame frame = view_frame(app.session, app.ui, app.tool, app.view);
  CHECK(frame.motion.size() == app.session.poses.size());
  CHECK(frame.poses.size() == app.session.poses.size());
  CHECK(frame.ghost.empty());
  // A larger amplitude is more.
  app.session.study.modes.playing = false;
  app.session.study.modes.phase = 0;
  robot.frames(2);
  const double before = (app.session.study.modes.poses[1].position - app.session.poses[1].position).norm();
  robot.drag("modes/amplitude", {0.3f, 0.5f}, {0.6f, 0.5f});
  robot.frames(2);
  CHECK((app.session.study.modes.poses[1].position - app.session.poses[1].position).norm() > 1.5 * before);
  // The same row again: nothing moves.
  robot.click("modes/row/1");
  CHECK_FALSE(moving_mode(app.session));
  CHECK(app.session.study.modes.poses.empty());
}

TEST_CASE("Space pauses a mode and plays it on, at a pace that can be watched") {
  ModesRobot robot("governor");
  App& app = robot.app;
  const std::size_t swinging = robot.swinging();
  robot.click("modes/row/" + std::to_string(swinging + 1));
  const double period = shown_period(robot.modes()[swinging]);
  CHECK(period >= 0.8);
  CHECK(period <= 4);
  const double begin = app.session.study.modes.phase;
  robot.frames(5, period / 20);
  CHECK(std::remainder(app.session.study.modes.phase - begin - std::numbers::pi / 2, 2 * std::numbers::pi) ==
        Approx(0).margin(1e-9));
  robot.key(' ');
  CHECK_FALSE(app.session.study.modes.playing);
  CHECK_FALSE(app.session.playback.playing); // the drives did not start instead
  const double phase = app.session.study.modes.phase;
  robot.frames(3, 0.1);
  CHECK(app.session.study.modes.phase == phase);
  robot.key(' ');
  robot.frames(1, 0.1);
  CHECK(app.session.study.modes.phase != phase);
}

TEST_CASE("an unstable state's growing mode is marked") {
  ModesRobot robot("conical_pendulum");
  App& app = robot.app;
  CHECK(std::ranges::none_of(robot.modes(), grows));
  go_to_state(app.session, "", 0, {{"swing", 0}});
  robot.frames(3);
  REQUIRE(app.session.answer.solution.stable == false);
  CHECK(modes_are_current(app.session));
  CHECK(std::ranges::any_of(robot.modes(), grows));
}

TEST_CASE("Campbell lines are continuous, and agree with the modes where the mechanism is") {
  ModesRobot robot("rate_gyro");
  App& app = robot.app;
  const CampbellState& campbell = app.session.study.modes.campbell;
  const CampbellView& drawn = app.panels->studies.shown().campbell;
  REQUIRE(campbell.diagram.found);
  REQUIRE_FALSE(drawn.plot.curves.empty());
  double highest = 0;
  for (const PlotCurve& curve : drawn.plot.curves)
    for (const auto& p : curve.points)
      if (std::isfinite(p[1])) highest = std::max(highest, p[1]);
  int lines = 0;
  for (const PlotCurve& curve : drawn.plot.curves) {
    if (!curve.name.starts_with("mode")) continue;
    ++lines;
    for (std::size_t i = 1; i < curve.points.size(); ++i)
      if (std::isfinite(curve.points[i][1]) && std::isfinite(curve.points[i - 1][1]))
        CHECK(std::abs(curve.points[i][1] - curve.points[i - 1][1]) < 0.1 * highest);
  }
  CHECK(lines > 0);
  // Each mode that swings lies on a line at the present speed.
  const double speed = get_parameter(app.session.mechanism(), campbell.diagram.found->of.drive);
  for (const VibrationMode& mode : robot.modes()) {
    if (!mode.oscillates()) continue;
    double nearest = 1e300;
    for (const PlotCurve& curve : drawn.plot.curves)
      for (std::size_t i = 1; i < curve.points.size(); ++i) {
        const auto &a = curve.points[i - 1], &b = curve.points[i];
        if (!(std::min(a[0], b[0]) <= speed && speed <= std::max(a[0], b[0])) || a[0] == b[0]) continue;
        const double y = a[1] + (b[1] - a[1]) * (speed - a[0]) / (b[0] - a[0]);
        if (curve.name.starts_with("mode")) nearest = std::min(nearest, std::abs(y - hertz(mode.frequency)));
      }
    CHECK(nearest < 0.01 * highest);
  }
  // In rad/s the same lines are 2 pi times as high.
  robot.click("campbell/radians");
  robot.frames(2);
  CHECK(drawn.plot.y.unit == "rad/s");
  double angular = 0;
  for (const PlotCurve& curve : drawn.plot.curves)
    for (const auto& p : curve.points)
      if (std::isfinite(p[1])) angular = std::max(angular, p[1]);
  CHECK(angular == Approx(2 * std::numbers::pi * highest));
}

TEST_CASE(
    "the Campbell diagram calls the modes by the list's numbers, and tells which critical speeds count") {
  // With speed the backward tilting mode falls below the two that are lowest at first.
  ModesRobot robot("rotor_oil_whip");
  App& app = robot.app;
  const CampbellView& drawn = app.panels->studies.shown().campbell;
  for (const double n : {20., 240.}) {
    change_parameter(app.session, "parameters.n", n);
    robot.frames(4);
    REQUIRE(modes_are_current(app.session));
    int told = 0;
    for (const PlotCurve& curve : drawn.plot.curves) {
      if (!curve.name.starts_with("mode ")) continue;
      const VibrationMode& mode = robot.modes().at(std::stoul(curve.name.substr(5)) - 1);
      for (std::size_t i = 1; i < curve.points.size(); ++i) {
        const auto &a = curve.points[i - 1], &b = curve.points[i];
        if (!(a[0] <= n && n < b[0]) || !std::isfinite(a[1] + b[1])) continue;
        ++told;
        CHECK(a[1] + (b[1] - a[1]) * (n - a[0]) / (b[0] - a[0]) ==
              Approx(hertz(mode.frequency)).epsilon(2e-3));
      }
    }
    CHECK(told == 4);
  }
  const auto width_of = [&](const char* line) {
    return std::ranges::find(drawn.plot.curves, line, &PlotCurve::name)->width;
  };
  CHECK(width_of("1× speed") < width_of("2× speed"));
  REQUIRE(drawn.critical);
  REQUIRE_FALSE(drawn.critical->empty());
  std::vector<double> unbalance;
  for (const CriticalRow& row : *drawn.critical) {
    CHECK(row.unbalance == (row.order == "1×" && row.whirl == "forward"));
    if (row.unbalance) unbalance.push_back(row.at);
  }
  REQUIRE(unbalance.size() == 1); // the next is beyond the slider's range
  CHECK(unbalance[0] == Approx(68.2320470519));
  CHECK(std::ranges::is_sorted(*drawn.critical, {}, &CriticalRow::order));
  robot.click("campbell/critical/1");
  robot.frames(2);
  CHECK(get_parameter(app.session.mechanism(), "parameters.n") == Approx(68.2320470519));
}

TEST_CASE("over half a drive's speed lines of excitation and critical speeds are of the drive") {
  Mechanism m = shipped("rotor_oil_whip");
  std::ranges::find(m.joints, "spin", &Joint::name)->formulas = {{"drive.speed", "2 * n"}};
  evaluate_formulas(m);
  Robot robot(wide);
  Session& session = robot.app.session;
  open_document(session, Document(m));
  robot.frames(3);
  robot.key('O');
  robot.frames(5);
  CHECK(campbell_drive(session, drive_speeds(session.mechanism())) == "parameters.n");
  const CampbellView& drawn = robot.app.panels->studies.shown().campbell;
  const auto line = std::ranges::find(drawn.plot.curves, "1× speed", &PlotCurve::name);
  REQUIRE(line != drawn.plot.curves.end());
  for (const auto& p : line->points)
    if (std::isfinite(p[1])) CHECK(p[1] == Approx(hertz(2 * p[0])));
  REQUIRE(drawn.critical);
  REQUIRE_FALSE(drawn.critical->empty());
  const CriticalRow row = drawn.critical->front();
  CHECK(std::stod(row.speed) == Approx(2 * row.at).epsilon(1e-5));
  CHECK(std::ranges::any_of(drawn.plot.marks, [&](const PlotMark& mark) {
    return mark.shape == PlotShape::circle && mark.at[0] == Approx(row.at);
  }));
  robot.click("campbell/critical/1");
  robot.frames(2);
  CHECK(get_parameter(session.mechanism(), "joints.spin.drive.speed") == Approx(2 * row.at));
}

TEST_CASE("where there is little room the Campbell diagram has it, and critical speeds stand below") {
  const PixelSize window = GENERATE(PixelSize{900, 600}, PixelSize{1100, 900});
  ModesRobot robot("rotor_oil_whip", window);
  const WidgetRect plot = robot.widget("plot/campbell/area");
  CHECK(plot.to.y - plot.from.y > 60); // its axes stand around it
  const auto& widgets = robot.app.ui.widgets;
  const auto row = widgets.find("campbell/critical/1");
  const bool below_list = row != widgets.end() && row->second.to.x <= plot.from.x;
  if (row != widgets.end() && !below_list) CHECK(row->second.from.y >= plot.to.y);
  if (window.height == 900) CHECK(row != widgets.end());
}

TEST_CASE("the Campbell diagram has the width beside the list, below which critical speeds stand") {
  ModesRobot robot("rotor_oil_whip", {1280, 900});
  const WidgetRect plot = robot.widget("plot/campbell/area"), mode = robot.widget("modes/row/4"),
                   speed = robot.widget("campbell/critical/1"), third = robot.widget("campbell/critical/3");
  CHECK(plot.to.x - plot.from.x > 700);
  CHECK(speed.to.x <= plot.from.x);
  CHECK(speed.from.y >= mode.to.y);
  CHECK(third.to.y <= 900);
  robot.click("campbell/critical/1");
  robot.frames(2);
  CHECK(get_parameter(robot.app.session.mechanism(), "parameters.n") ==
        Approx((*robot.app.panels->studies.shown().campbell.critical)[0].at));
}

TEST_CASE("in a low window the diagram has the width, and one chooses between modes and critical speeds") {
  ModesRobot robot("rotor_oil_whip", {1280, 720});
  const auto& widgets = robot.app.ui.widgets;
  const WidgetRect plot = robot.widget("plot/campbell/area");
  CHECK(plot.to.x - plot.from.x > 700);
  CHECK(plot.to.y - plot.from.y > 110);
  CHECK(widgets.contains("modes/row/1"));
  CHECK_FALSE(widgets.contains("campbell/critical/1"));
  robot.click("modes/show_critical");
  robot.frames(2);
  const WidgetRect speed = robot.widget("campbell/critical/1");
  CHECK(speed.to.x <= robot.widget("plot/campbell/area").from.x);
  CHECK_FALSE(widgets.contains("modes/row/1"));
  robot.click("campbell/critical/1");
  robot.frames(2);
  CHECK(get_parameter(robot.app.session.mechanism(), "parameters.n") ==
        Approx((*robot.app.panels->studies.shown().campbell.critical)[0].at));
  robot.click("modes/show_list");
  robot.frames(2);
  CHECK(widgets.contains("modes/row/1"));
}

TEST_CASE("in the lowest window modes are in sight, and the words about them below") {
  const char* scene = GENERATE("governor_engine", "rotor_oil_whip");
  ModesRobot robot(scene, {640, 360}); // 1280 x 720 where a point has two pixels
  for (const char* row : {"modes/row/1", "modes/row/2"})
    CHECK(robot.widget(row).to.y <= 360);
  CHECK(robot.widget("modes/verdict").from.y > robot.widget("modes/row/2").to.y);
  if (scene == std::string("rotor_oil_whip")) {
    const WidgetRect plot = robot.widget("plot/campbell/area");
    CHECK(plot.to.y - plot.from.y > 30);
  }
}

TEST_CASE("critical speeds have a place in a panel of any height, whatever is said above the diagram") {
  const int width = GENERATE(700, 820, 1280);
  ModesRobot robot("rotor_oil_whip", {width, 900});
  App& app = robot.app;
  REQUIRE(app.panels->studies.shown().campbell.critical);
  for (const bool remark : {false, true}) {
    app.session.study.modes.campbell.on_branch = !remark;
    for (float share = 0.3f; share < 0.62f; share += 0.02f) {
      app.sizes.study_chosen = true;
      app.sizes.study_share = share;
      robot.frames(3);
      INFO("share " << share << (remark ? ", with a remark" : ""));
      CHECK(app.ui.widgets.contains("campbell/critical/1") + app.ui.widgets.contains("modes/show_critical") >=
            1);
    }
  }
  // A row goes to its speed, in the narrow window after one has chosen that table.
  app.sizes.study_share = 0.3f;
  robot.frames(3);
  CHECK(app.ui.widgets.contains("modes/show_critical") == !app.ui.widgets.contains("campbell/critical/1"));
  if (width == 700) REQUIRE(app.ui.widgets.contains("modes/show_critical"));
  if (app.ui.widgets.contains("modes/show_critical")) robot.click("modes/show_critical");
  robot.frames(2);
  robot.click("campbell/critical/1");
  robot.frames(2);
  CHECK(get_parameter(app.session.mechanism(), "parameters.n") ==
        Approx((*app.panels->studies.shown().campbell.critical)[0].at));
}

TEST_CASE("where no speed of the range is critical one click follows on to one that may be") {
  ModesRobot robot("rotor_oil_whip");
  Session& session = robot.app.session;
  CHECK_FALSE(robot.app.ui.widgets.contains("campbell/farther"));
  change_parameter(session, "parameters.n", 3);
  session.study.modes.campbell.from = 1;
  session.study.modes.campbell.to = 5;
  robot.frames(5);
  robot.widget("campbell/no_critical");
  robot.click("campbell/farther");
  robot.frames(5);
  CHECK(session.study.modes.campbell.from == 1);
  CHECK(session.study.modes.campbell.to > 68.2320470519); // the unbalance's
  REQUIRE(robot.app.panels->studies.shown().campbell.critical);
  CHECK_FALSE(robot.app.panels->studies.shown().campbell.critical->empty());
  CHECK_FALSE(robot.app.ui.widgets.contains("campbell/farther"));
}

TEST_CASE("over a number that is no speed the Campbell diagram has the range of its slider") {
  Mechanism m = shipped("rotor_oil_whip");
  const double speed = get_parameter(m, "joints.spin.drive.speed");
  m.parameters.push_back({"factor", "", 2.5, "", {}, {}});
  std::ranges::find(m.joints, "spin", &Joint::name)->formulas = {
      {"drive.speed", rounded_text(speed / 2.5, 9) + " rad/s * factor"}};
  evaluate_formulas(m);
  Robot robot(wide);
  Session& session = robot.app.session;
  open_document(session, Document(m));
  robot.frames(3);
  const std::string address = "parameters.factor";
  REQUIRE(campbell_drive(session, drive_speeds(session.mechanism())) == address);
  const auto control = control_of(session, address);
  REQUIRE(control);
  const PlotRange range = campbell_range(session, address);
  CHECK(range == PlotRange{control->from, control->to});
  CHECK(range[0] <= 2.5);
  CHECK(range[1] >= 2.5);
  CHECK(range[1] < 10);
}

TEST_CASE("only of the branch that is shown is it said where it has no modes") {
  // The arms of the other branch hang straight down, and are without modes at every speed.
  ModesRobot robot("governor");
  REQUIRE(robot.app.session.study.modes.campbell.diagram.found->result.branches.size() == 2);
  CHECK(robot.app.panels->studies.shown().campbell.without_modes.empty());
  CHECK(robot.app.ui.widgets.count("campbell/without") == 0);
  go_to_state(robot.app.session, "", 0,
              {{"arm1", std::numbers::pi / 2}, {"arm2", std::numbers::pi / 2}, {"slide", 0.18922}});
  robot.frames(4);
  robot.widget("campbell/without");
  CHECK(robot.app.panels->studies.shown().campbell.without_modes.starts_with(
      "Without modes from 0 to 30 rad/s."));
}

TEST_CASE("why there is no Campbell diagram is said in the units and names that are shown") {
  ModesRobot robot("horizontal_rotor");
  robot.widget("campbell/problem");
  CHECK(campbell_problem(robot.app.session).starts_with("At n = 5 rad/s: No steady state"));
  robot.app.session.units.speed = SpeedUnit::rpm;
  CHECK(campbell_problem(robot.app.session).starts_with("At n = 47.7465 rpm: No steady state"));
}

namespace {

// By the button of the modes' panel.
void go_on_to_response(Robot& robot) {
  robot.key('O');
  REQUIRE(
      steps_until([&] { robot.frames(1); }, [&] { return robot.app.ui.widgets.contains("modes/response"); }));
  robot.click("modes/response");
  robot.frames(2);
  CHECK(robot.app.session.study.open == StudyKind::response);
}

} // namespace

TEST_CASE("where the balance turns with the drives the modes' panel leads to the response") {
  Robot robot(wide, LiveSolver::Mode::background); // the curve that is led to takes seconds
  open_scene(robot.app.session, shipped_file("horizontal_rotor"));
  go_on_to_response(robot);
  ModesRobot steady("governor");
  CHECK_FALSE(steady.app.ui.widgets.contains("modes/response"));
}

TEST_CASE("where a torque drives what turns so the response is offered over what sets the torque") {
  Mechanism m = shipped("horizontal_rotor"); // under its weight
  set_expression(m, "joints.spin.drive.speed", "30");
  m.parameters.push_back({"T", "", 2, "N m", {}}); // the last
  m.joints.back().coordinates.front().drive->torque = 2;
  set_expression(m, "joints.spin.drive.torque", "T");
  set_expression(m, "joints.spin.drive.load", "0.06 N m s*rate(spin)");
  Robot robot(wide, LiveSolver::Mode::background);
  open_document(robot.app.session, Document(m));
  go_on_to_response(robot);
  CHECK(robot.app.session.study.response.choice.address == "parameters.T");
}

TEST_CASE(
    "where no steady state is found of what a torque drives the modes' panel leads to the limit cycle") {
  Robot robot(wide);
  Mechanism m = Document::empty_mechanism();
  add_driven_slider_crank(m, 20);
  const std::string crank = m.joints.front().name;
  m.joints.front().coordinates.front().drive->torque = 60;
  set_expression(m, "joints." + crank + ".drive.load", "3 N m s*rate(" + crank + ")");
  open_document(robot.app.session, Document(m));
  robot.frames(2);
  robot.key('O');
  robot.frames(2);
  REQUIRE(robot.app.session.answer.solution.status == Status::not_converged);
  robot.click("modes/cycle");
  robot.frames(3);
  REQUIRE(limit_cycle(robot.app.session));
  CHECK(limit_cycle(robot.app.session)->status == PeriodicStatus::found);
  CHECK_FALSE(robot.app.ui.widgets.contains("modes/cycle"));
}

TEST_CASE("a click in the Campbell diagram sets the speed") {
  ModesRobot robot("governor");
  App& app = robot.app;
  const std::string speed = "joints.spin.drive.speed";
  const PlotRange range = campbell_range(app.session, speed);
  const auto followed = app.session.study.modes.campbell.diagram.found;
  const WidgetRect area = robot.widget("plot/campbell/area");
  robot.click(
      ImVec2{area.from.x + 0.6f * (area.to.x - area.from.x), area.from.y + 0.2f * (area.to.y - area.from.y)});
  robot.frames(2);
  const double wanted = range[0] + 0.6 * (range[1] - range[0]);
  CHECK(get_parameter(app.session.mechanism(), speed) == Approx(wanted).margin(0.01 * (range[1] - range[0])));
  // The diagram still holds: only the speed has changed.
  CHECK(app.session.study.modes.campbell.current);
  CHECK(app.session.study.modes.campbell.diagram.found == followed);
  REQUIRE_FALSE(app.panels->studies.shown().campbell.plot.references.empty());
  CHECK(app.panels->studies.shown().campbell.plot.references[0].at ==
        get_parameter(app.session.mechanism(), speed));
  // Another number changes it.
  app.session.study.modes.campbell.diagram.found->run_time = 0; // whatever it took on a busy machine
  change_parameter(app.session, "joints.slide.spring.stiffness", 1500);
  robot.frames(3);
  CHECK(app.session.study.modes.campbell.diagram.found != followed);
}

TEST_CASE("in a small window the list of modes and the diagram's choices are whole") {
  ModesRobot robot("rotor_oil_whip", {800, 600});
  const WidgetRect list = robot.widget("modes/row/1"), drive = robot.widget("campbell/drive"),
                   last = robot.widget("campbell/radians"), area = robot.widget("plot/campbell/area");
  CHECK(list.to.x <= drive.from.x);
  CHECK(last.to.x <= 792);
  CHECK(last.to.x - last.from.x > ImGui::CalcTextSize("rad/s").x + 8); // not cut
  CHECK(area.to.y - area.from.y > 80);
}
