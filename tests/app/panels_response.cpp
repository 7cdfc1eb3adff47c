// The response curve as a person uses it: it follows sliders, its marker can be dragged, design mode solves
// for a parameter, and sensitivities stand below pinned sliders.
#include "robot.hpp"
#include "session_wait.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/session/map.hpp"
#include "app/session/response.hpp"
#include "app/session/response_design.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/sensitivity_line.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize wide{1280, 900};
const std::string speed = "joints.spin.drive.speed", stiffness = "joints.slide.spring.stiffness";

double present(const App& app, const std::string& name) {
  REQUIRE(converged(app.session));
  return value(app.session.answer.solution, name);
}

// The response is asked for with the key C.
struct ResponseRobot : Robot {
  explicit ResponseRobot(const std::string& scene = "") : Robot(wide) {
    if (!scene.empty()) open_scene(app.session, shipped_file(scene));
    frames(2);
    key('C');
    frames(3);
  }

  ResponseState& state() { return app.session.study.response; }
  const ResponseView& drawn() { return app.panels->studies.shown().response; }
  const PlotLayout& layout() {
    REQUIRE(drawn().view.kept.layout);
    return *drawn().view.kept.layout;
  }
  // A place of the plot, in pixels of the window.
  ImVec2 place(double x, double y) {
    const WidgetRect area = widget("plot/response/area");
    const PlotLayout& l = layout();
    return {area.from.x + static_cast<float>(l.x.pixel(x) - l.area.left),
            area.from.y + static_cast<float>(l.y.pixel(y) - l.area.top)};
  }
  ImVec2 marker() {
    REQUIRE(drawn().plot.marker);
    return place(drawn().plot.marker->x, drawn().plot.marker->y);
  }
  // The marker's grip by so many pixels, in steps as of a hand.
  void pull(float across, float down, bool let_go = true) {
    const ImVec2 at = widget("plot/response/pull").center();
    point(at);
    press();
    for (int i = 1; i <= 10; ++i) {
      const float part = static_cast<float>(i) / 10;
      point({at.x + part * across, at.y + part * down});
    }
    frames(2);
    if (!let_go) return;
    release();
    frames(2);
  }
  double number(const std::string& address) { return get_parameter(app.session.mechanism(), address); }
};

// Where the curves of this name go through `x`.
std::vector<double> crossings(const Plot& plot, const std::string& name, double x) {
  std::vector<double> out;
  for (const PlotCurve& curve : plot.curves)
    for (std::size_t i = 1; curve.name == name && i < curve.points.size(); ++i) {
      const auto &a = curve.points[i - 1], &b = curve.points[i];
      if ((a[0] - x) * (b[0] - x) <= 0 && a[0] != b[0])
        out.push_back(a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
    }
  // Where x is that of a point, two pieces go through it.
  std::ranges::sort(out);
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  out.erase(std::unique(out.begin(), out.end(), near), out.end());
  return out;
}

} // namespace

TEST_CASE("without being asked for there is no response curve") {
  Robot robot(wide);
  CHECK_FALSE(robot.app.session.study.response.curve.asked);
  CHECK_FALSE(robot.app.session.study.response.curve.found);
  CHECK(robot.app.ui.widgets.count("plot/response/area") == 0);
}

TEST_CASE("a speed that follows from the drive's is not what the curve shows first") {
  ResponseRobot robot("governor_bearing"); // whose collar stands in a bearing on the turning sleeve
  CHECK(robot.state().choice.quantity == "value slide");
}

TEST_CASE("the curve of the governor goes through what solves find at several speeds") {
  ResponseRobot robot;
  ResponseState& state = robot.state();
  const ResponseView& drawn = robot.drawn();
  REQUIRE(state.curve.found);
  CHECK(state.choice.address == speed);
  CHECK(state.choice.quantity == "value slide");
  CHECK(drawn.plot.y.unit == "m");
  Analysis analysis(robot.app.session.mechanism());
  for (const double at : {2.0, 9.0, 11.0174, 16.0, 25.0}) {
    Mechanism mechanism = robot.app.session.mechanism();
    set_parameter(mechanism, speed, at);
    analysis.update(mechanism);
    const Solution solution = analysis.solve({});
    REQUIRE(solution.status == Status::converged);
    const std::vector<double> found =
        crossings(drawn.plot, solution.stable == true ? "stable" : "unstable", at);
    REQUIRE(found.size() == 1);
    CHECK(found[0] == Approx(value(solution.coordinates, "slide")).margin(5e-4));
  }
  // At its points the curve is exact.
  for (std::size_t i = 0; i < state.curve.found->result.lines[0].points.size(); i += 7) {
    const ResponsePoint& point = state.curve.found->result.lines[0].points[i];
    Mechanism mechanism = robot.app.session.mechanism();
    set_parameter(mechanism, speed, point.parameter);
    analysis.update(mechanism);
    CHECK(value(analysis.solve({}).coordinates, "slide") ==
          Approx(value(point.coordinates, "slide")).margin(1e-9));
  }
}

TEST_CASE("everything that is offered is drawn, and the marker lies on it") {
  ResponseRobot robot;
  const ResponseView& drawn = robot.drawn();
  const std::vector<ResponseQuantity> offered = offered_quantities(robot.app.session);
  CHECK(offered.size() > 10);
  for (const ResponseQuantity& quantity : offered) {
    CAPTURE(quantity.key);
    choose_quantity(robot.app.session, quantity);
    robot.frames(2);
    CHECK(drawn.plot.y.label == quantity.title);
    CHECK((drawn.plot.y.si_unit.empty() ? drawn.plot.y.unit : drawn.plot.y.si_unit) == quantity.unit);
    CHECK_FALSE(quantity.unit.empty());
    REQUIRE(drawn.plot.marker);
    const double x = drawn.plot.marker->x, y = drawn.plot.marker->y;
    CHECK(x == 11.0174);
    double nearest = 1e300, lowest = 1e300, highest = -1e300;
    for (const PlotCurve& curve : drawn.plot.curves) {
      for (const double value : crossings(drawn.plot, curve.name, x))
        nearest = std::min(nearest, std::abs(value - y));
      for (const auto& point : curve.points) {
        lowest = std::min(lowest, point[1]);
        highest = std::max(highest, point[1]);
      }
    }
    CHECK(nearest <= 0.01 * (highest - lowest) + 1e-9);
  }
}

TEST_CASE("the varied slider moves the marker alone, another one the curve") {
  ResponseRobot robot;
  App& app = robot.app;
  ResponseState& state = robot.state();
  const ResponseView& drawn = robot.drawn();
  const double x = drawn.plot.marker->x;
  const auto curve = state.curve.found;
  const std::uint64_t version = drawn.plot.version;
  robot.drag("parameters/" + speed, {0.37f, 0.5f}, {0.6f, 0.5f});
  CHECK(state.curve.found == curve);
  CHECK(drawn.plot.version == version);
  CHECK(drawn.plot.marker->x > x + 2);
  CHECK(drawn.plot.marker->y == Approx(present(app, "slide")));

  const double before = crossings(drawn.plot, "stable", 20).at(0);
  robot.drag("parameters/" + stiffness, {0.5f, 0.5f}, {0.7f, 0.5f});
  CHECK(state.curve.found != curve);
  CHECK(drawn.plot.version > version);
  CHECK(std::abs(crossings(drawn.plot, "stable", 20).at(0) - before) > 1e-3);
  CHECK(crossings(drawn.plot, "stable", drawn.plot.marker->x).at(0) ==
        Approx(drawn.plot.marker->y).margin(5e-4));
  // Back with undo.
  undo(app.session);
  robot.frames(2);
  CHECK(crossings(drawn.plot, "stable", 20).at(0) == Approx(before).margin(1e-4));
}

TEST_CASE("the marker dragged along the curve moves parameter and mechanism as one step") {
  ResponseRobot robot;
  App& app = robot.app;
  const ResponseView& drawn = robot.drawn();
  const std::size_t steps = app.session.document.position();
  const double before = present(app, "slide");
  const double y = crossings(drawn.plot, "stable", 18).at(0);
  robot.drag(robot.marker(), robot.place(18, y));
  CHECK(app.session.document.position() == steps + 1);
  const double now = get_parameter(app.session.mechanism(), speed);
  CHECK(now == Approx(18).margin(0.3));
  CHECK(std::abs(present(app, "slide") - before) > 0.002);
  CHECK(present(app, "slide") == Approx(crossings(drawn.plot, "stable", now).at(0)).margin(5e-4));
  // What the hand sets has digits that a hand can mean.
  CHECK(now * 1000 == Approx(std::round(now * 1000)).margin(1e-9));
  undo(app.session);
  robot.frames(2);
  CHECK(get_parameter(app.session.mechanism(), speed) == 11.0174);
  CHECK(present(app, "slide") == Approx(before));
}

TEST_CASE("the point of the curve is pulled up, and the other pinned sliders bring it there") {
  ResponseRobot robot("governor_parametric");
  App& app = robot.app;
  choose_response(app.session, "parameters.w");
  robot.frames(3);
  const std::size_t steps = app.session.document.position();
  const double w = robot.number("parameters.w"), before = present(app, "slide");
  const std::string quantity = robot.state().choice.quantity;
  REQUIRE(quantity == "value slide");
  const auto curve = robot.state().curve.found;
  const ImVec2 from = robot.marker();
  robot.pull(3, -8); // a hand that trembles
  CHECK(robot.number("parameters.w") == w);
  CHECK(present(app, "slide") > before + 1e-3);
  // Where the hand was, seen on the axis as it stood, and exactly as much as a pixel tells.
  REQUIRE(sought(app.session));
  CHECK(sought(app.session)->reached);
  CHECK(present(app, "slide") == Approx(sought(app.session)->goals[0].goal).epsilon(1e-9));
  CHECK(robot.number("parameters.L") != 0.16);
  // The curve goes through it.
  CHECK(robot.state().curve.found != curve);
  CHECK(crossings(robot.drawn().plot, "stable", w).at(0) == Approx(present(app, "slide")).margin(5e-4));
  CHECK(robot.marker().x == Approx(from.x).margin(0.5));
  CHECK(app.session.document.position() == steps + 1);
  undo(app.session);
  robot.frames(3);
  CHECK(present(app, "slide") == Approx(before).epsilon(1e-9));
  CHECK(app.session.document.position() == steps);
}

TEST_CASE("pulled sideways the varied number goes along, and the place under the hand is the state's") {
  ResponseRobot robot("governor_parametric");
  App& app = robot.app;
  choose_response(app.session, "parameters.w");
  robot.frames(3);
  const ImVec2 from = robot.marker();
  const double w = robot.number("parameters.w");
  // A little above where the curve goes now.
  const auto area = robot.layout().x;
  const double there = area.value(area.pixel(w) + 40);
  const float down = robot.place(there, crossings(robot.drawn().plot, "stable", there).at(0)).y - from.y - 4;
  robot.pull(40, down, false);
  CHECK(std::hypot(robot.marker().x - from.x - 40, robot.marker().y - from.y - down) < 1.5f);
  CHECK(robot.number("parameters.w") > w);
  const double pulled = robot.number("parameters.w");
  robot.release();
  robot.frames(2);
  CHECK(robot.number("parameters.w") == pulled);

  SECTION("unless it is held") {
    undo(app.session);
    hold_number(app.session, "parameters.w", true);
    robot.frames(2);
    robot.pull(40, 4);
    CHECK(robot.number("parameters.w") == w);
    CHECK(present(app, "slide") == Approx(sought(app.session)->goals[0].goal).epsilon(1e-9));
  }
}

TEST_CASE("what a pull cannot reach is shown with the nearest that can be") {
  ResponseRobot robot("governor_parametric");
  App& app = robot.app;
  choose_response(app.session, "parameters.w");
  for (const ParameterControl& control : app.session.parameters)
    if (control.group == ParameterGroup::pinned && control.address != "parameters.w" &&
        control.address != "parameters.L")
      hold_number(app.session, control.address, true);
  robot.frames(3);
  const auto range = robot.drawn().plot.y.range;
  robot.pull(0, 400, false);
  REQUIRE(sought(app.session));
  CHECK_FALSE(sought(app.session)->reached);
  REQUIRE(robot.drawn().plot.marker);
  CHECK(robot.drawn().plot.marker->label == "the nearest");
  CHECK_THAT(app.session.notice, ContainsSubstring("The nearest that can be reached: slide = "));
  CHECK(robot.drawn().plot.y.range == range); // or the place under the hand would run away
  robot.release();
  robot.frames(2);
  CHECK(robot.drawn().plot.marker->label.empty());
}

TEST_CASE("where only the varied number may move a pull goes along the curve; keys pull, too") {
  ResponseRobot robot("governor_parametric");
  App& app = robot.app;
  choose_response(app.session, "parameters.w");
  for (const ParameterControl& control : app.session.parameters)
    if (control.group == ParameterGroup::pinned && control.address != "parameters.w")
      hold_number(app.session, control.address, true);
  robot.frames(3);
  const auto curve = robot.state().curve.found;
  const double w = robot.number("parameters.w"), before = present(app, "slide");
  focus_widget(app.ui, "plot/response/pull");
  robot.frames(2);
  const std::size_t steps = app.session.document.position();
  for (int i = 0; i < 3; ++i)
    robot.key(265); // up
  robot.frames(2);
  CHECK(present(app, "slide") > before);
  CHECK(robot.number("parameters.w") < w);
  CHECK(robot.state().curve.found == curve);
  CHECK(app.session.document.position() == steps + 1);
  hold_number(app.session, "parameters.w", true);
  robot.key(264);
  robot.frames(2);
  CHECK(is_error(app.session));
  CHECK_THAT(app.session.notice, ContainsSubstring("all pinned sliders are held"));
}

TEST_CASE("what is no goal has no grip") {
  ResponseRobot robot("governor_parametric");
  CHECK(robot.app.ui.widgets.count("plot/response/pull") == 1);
  for (const ResponseQuantity& quantity : offered_quantities(robot.app.session)) {
    choose_quantity(robot.app.session, quantity);
    robot.frames(2);
    const bool goal = quantity.group == "Coordinates" || quantity.group == "Measures";
    CHECK(robot.app.ui.widgets.count("plot/response/pull") == (goal ? 1 : 0));
  }
}

TEST_CASE("the conical pendulum: drawn as a fork, and dragged onto the unstable branch") {
  ResponseRobot robot("conical_pendulum");
  App& app = robot.app;
  ResponseState& state = robot.state();
  const ResponseView& drawn = robot.drawn();
  REQUIRE(state.curve.found);
  REQUIRE(drawn.plot.marks.size() == 1);
  CHECK_THAT(drawn.plot.marks[0].label, ContainsSubstring("branch point 3.742"));
  CHECK_THAT(drawn.plot.marks[0].label, ContainsSubstring("rad/s"));
  CHECK(crossings(drawn.plot, "stable", 2).size() == 1);
  CHECK(crossings(drawn.plot, "stable", 6).size() == 2);
  REQUIRE(crossings(drawn.plot, "unstable", 6).size() == 1);
  CHECK(crossings(drawn.plot, "undecided", 6).empty());
  // Stable as solved at first; dragged along to the straight state above the branch point.
  CHECK(app.session.answer.solution.stable == true);
  robot.drag(robot.marker(), robot.place(6, 0));
  CHECK(get_parameter(app.session.mechanism(), speed) == Approx(6).margin(0.1));
  CHECK(present(app, "swing") == Approx(0).margin(1e-9));
  CHECK(app.session.answer.solution.stable == false);
  CHECK(app.session.on_branch);

  SECTION("sliders follow the branch, until the drawn pose is started from again") {
    change_parameter(app.session, speed, 8);
    robot.frames(2);
    CHECK(present(app, "swing") == Approx(0).margin(1e-9));
    CHECK(app.session.answer.solution.stable == false);
    change_parameter(app.session, "bodies.bob.mass", 2);
    robot.frames(2);
    CHECK(present(app, "swing") == Approx(0).margin(1e-9));
    robot.click("parameters/restart");
    CHECK_FALSE(app.session.on_branch);
    CHECK(std::abs(present(app, "swing")) > 0.5);
    CHECK(app.session.answer.solution.stable == true);
  }
  SECTION("a click jumps to another branch") {
    const std::vector<double> bent = crossings(drawn.plot, "stable", 8);
    REQUIRE(bent.size() == 2);
    for (const double y : bent) {
      robot.click(robot.place(8, y));
      CHECK(present(app, "swing") * 180 / std::numbers::pi == Approx(y).margin(1));
      CHECK(app.session.answer.solution.stable == true);
      CHECK(get_parameter(app.session.mechanism(), speed) == Approx(8).margin(0.1));
    }
  }
  SECTION("undo leaves the branch") {
    undo(app.session);
    robot.frames(2);
    CHECK_FALSE(app.session.on_branch);
    CHECK(app.session.answer.solution.stable == true);
  }
}

TEST_CASE("where a branch ends an ordinary state is shown, and told") {
  ResponseRobot robot("conical_pendulum");
  App& app = robot.app;
  const double y = crossings(robot.drawn().plot, "stable", 8).at(0);
  robot.click(robot.place(8, y));
  REQUIRE(app.session.on_branch);
  // Below the branch point there is no bent state.
  change_parameter(app.session, speed, 1);
  robot.frames(2);
  CHECK(present(app, "swing") == Approx(0).margin(1e-6));
  CHECK(app.session.answer.solution.stable == true);
}

TEST_CASE("another parameter, its own range, and a logarithmic axis") {
  ResponseRobot robot;
  App& app = robot.app;
  ResponseState& state = robot.state();
  const ResponseView& drawn = robot.drawn();
  robot.click("response/parameter");
  robot.click("response/parameter/stiffness of slide");
  CHECK(state.choice.address == stiffness);
  CHECK(drawn.plot.x.logarithmic);
  CHECK(drawn.plot.x.unit == "N/m");
  CHECK(state.choice.from == 50);
  CHECK(state.choice.to == 20000);
  CHECK(drawn.plot.marker->x == 1000);
  // A click between two points of the curve is one on the curve.
  const double y = crossings(drawn.plot, "stable", 3000).at(0);
  robot.click(robot.place(3000, y));
  CHECK(get_parameter(app.session.mechanism(), stiffness) == Approx(3000).epsilon(0.05));
  // A narrower range is typed.
  robot.click("response/to");
  robot.key('A', true);
  robot.type("5 kN/m");
  robot.key(key_enter);
  robot.frames(2);
  CHECK(state.choice.to == 5000);
  for (const PlotCurve& curve : drawn.plot.curves)
    for (const auto& point : curve.points)
      CHECK(point[0] <= 5000 * (1 + 1e-12));
}

TEST_CASE("another range has an axis of its own, also while a key is held") {
  ResponseRobot robot("governor");
  choose_response_end(robot.app.session, &ResponseChoice::to, 30);
  robot.frames(3);
  REQUIRE(robot.drawn().plot.y.range);
  const PlotRange all = *robot.drawn().plot.y.range;
  const std::uint64_t gesture = robot.app.session.gesture;
  choose_response_end(robot.app.session, &ResponseChoice::to, 9);
  robot.frames(3);
  REQUIRE(robot.app.session.gesture == gesture);
  REQUIRE(robot.drawn().plot.y.range);
  const PlotRange part = *robot.drawn().plot.y.range;
  CHECK(part[1] - part[0] < 0.7 * (all[1] - all[0]));
}

TEST_CASE("a mechanism whose balance turns has periodic motions for a curve, and steady states again") {
  ResponseRobot robot("conical_pendulum");
  App& app = robot.app;
  choose_response_end(app.session, &ResponseChoice::to, 1);
  choose_response_end(app.session, &ResponseChoice::from, 0.5); // slower, periods are long
  robot.frames(2);
  REQUIRE(robot.state().curve.found);
  edit(app.session, "Tilt", [](Mechanism& mechanism, Selection&) { mechanism.gravity = {3, -9, 0}; });
  robot.frames(3);
  CHECK_FALSE(robot.state().curve.found);
  REQUIRE(robot.state().resonance.found);
  CHECK(app.ui.widgets.count("response/find") == 0);
  undo(app.session);
  robot.frames(3);
  CHECK_FALSE(robot.state().resonance.found);
  REQUIRE(robot.state().curve.found);
  CHECK(response_refusal(app.session).empty());
  CHECK(app.ui.widgets.count("plot/response/area") == 1);
}

TEST_CASE("where nothing moves periodically either, the response says why") {
  ResponseRobot robot("conical_pendulum");
  App& app = robot.app;
  choose_response_end(app.session, &ResponseChoice::to, 1);
  choose_response_end(app.session, &ResponseChoice::from, 0.5); // it would stand where nothing turns
  edit(app.session, "Tilt", [](Mechanism& mechanism, Selection&) {
    mechanism.gravity = {3, -9, 0};
    for (Joint& joint : mechanism.joints) // it sticks and slips
      for (Coordinate& coordinate : joint.coordinates)
        if (!coordinate.drive) coordinate.friction.emplace().limit = 1e-3;
  });
  robot.frames(3);
  REQUIRE(app.session.answer.solution.status == Status::no_steady_state);
  CHECK_THAT(response_refusal(app.session), ContainsSubstring("dry friction"));
  CHECK(app.ui.widgets.count("response/problem") == 1);
  CHECK(app.ui.widgets.count("plot/response/area") == 0);
}

TEST_CASE("a closed response takes everything with it but what was chosen") {
  ResponseRobot robot;
  ResponseState& state = robot.state();
  const ResponseView& drawn = robot.drawn();
  robot.click("response/quantity");
  robot.click("response/quantity/value arm1");
  robot.click("study/close");
  CHECK(robot.app.session.study.open == StudyKind::none);
  CHECK_FALSE(state.curve.asked);
  CHECK_FALSE(state.curve.found);
  CHECK(drawn.plot.curves.empty());
  CHECK(drawn.pieces.empty());
  change_parameter(robot.app.session, stiffness, 900);
  robot.frames(2);
  CHECK_FALSE(state.curve.asked);
  robot.key('C');
  robot.frames(2);
  CHECK(state.choice.quantity == "value arm1");
  CHECK_FALSE(drawn.plot.curves.empty());
}

TEST_CASE("measures are drawn over the parameter, and wanted") {
  ResponseRobot robot("governor_parametric");
  App& app = robot.app;
  ResponseState& state = robot.state();
  choose_response(app.session, "parameters.w");
  robot.frames(3);
  for (const ResponseQuantity& quantity : offered_quantities(app.session)) {
    if (quantity.group != "Measures") continue;
    CAPTURE(quantity.key);
    choose_quantity(app.session, quantity);
    robot.frames(2);
    CHECK(robot.drawn().plot.y.label == quantity.title);
    REQUIRE(robot.drawn().plot.marker);
    CHECK(robot.drawn().plot.marker->x == 11.0174);
    CHECK_FALSE(robot.drawn().plot.curves.empty());
  }
  state.design.coordinate = "ball_pull";
  robot.frames(2);
  robot.click("response/value");
  robot.key('A', true);
  robot.type("20 N");
  robot.key(key_enter);
  robot.frames(2);
  REQUIRE(state.design.answer.found);
  REQUIRE_FALSE(state.design.answer.found->result.solutions.empty());
  robot.click("response/solution/1");
  robot.frames(3);
  const auto pull =
      std::ranges::find(app.session.answer.solution.measures, "ball_pull", &MeasureSolution::name)->value;
  REQUIRE(pull.has_value());
  CHECK(*pull == Approx(20).epsilon(1e-10));
}

TEST_CASE("design mode: at which speed is the governor's collar at 0.12 m?") {
  ResponseRobot robot;
  App& app = robot.app;
  ResponseState& state = robot.state();
  CHECK(state.design.coordinate == "slide");
  robot.click("response/value");
  robot.key('A', true);
  robot.type("0.12 m");
  robot.key(key_enter);
  robot.frames(2);
  REQUIRE(state.design.answer.found);
  const DesignAnswer& answer = state.design.answer.found->result;
  // Arms that point up have such speeds of their own; first comes what is stable and like the present state.
  REQUIRE_FALSE(answer.solutions.empty());
  CHECK(answer.solutions[0].at.stable == true);
  for (const char* arm : {"arm1", "arm2"})
    CHECK(value(answer.solutions[0].at.coordinates, arm) == Approx(present(app, arm)).margin(0.5));
  // What is told ends where the fields do.
  for (const char* told : {"response/solution/1", "response/run time"})
    CHECK(robot.widget(told).to.x <= robot.widget("response/find").to.x + 1);
  const double found = answer.solutions[0].parameter;
  // Solved at that speed, the collar is there.
  Mechanism mechanism = app.session.mechanism();
  set_parameter(mechanism, speed, found);
  Analysis analysis(mechanism);
  CHECK(value(analysis.solve({}).coordinates, "slide") == Approx(0.12).margin(1e-12));
  robot.click("response/solution/1");
  CHECK(get_parameter(app.session.mechanism(), speed) == found);
  CHECK(present(app, "slide") == Approx(0.12).margin(1e-12));
  // With another spring there is another answer, without asking again.
  change_parameter(app.session, stiffness, 800);
  robot.frames(3);
  REQUIRE_FALSE(state.design.answer.found->result.solutions.empty());
  CHECK(std::abs(state.design.answer.found->result.solutions[0].parameter - found) > 0.1);
  // What is never reached is told.
  state.design.value = 5;
  robot.click("response/find");
  CHECK(state.design.answer.found->result.solutions.empty());
  CHECK(app.ui.widgets.count("response/never") == 1);
  CHECK_THAT(design_words(app.session),
             ContainsSubstring("with speed of spin from 0 to") && ContainsSubstring(" rad/s:"));
}

TEST_CASE("of an engine its speed over the load is drawn at first: the droop curve") {
  ResponseRobot robot("governor_engine");
  REQUIRE(robot.state().choice.address == "joints.spin.drive.load");
  CHECK(robot.state().choice.quantity == "value spin.speed");
  CHECK(robot.drawn().plot.y.label == "speed of spin"); // as everywhere in the window
  const std::vector<PlotCurve>& curves = robot.drawn().plot.curves;
  REQUIRE_FALSE(curves.empty());
  std::vector<std::array<double, 2>> points = curves.front().points;
  REQUIRE(points.size() > 2);
  std::ranges::sort(points);
  CHECK(points.front()[0] == Approx(-25));
  CHECK(points.front()[1] == Approx(11.74560).epsilon(1e-6));
  CHECK(points.back()[0] == Approx(25));
  CHECK(points.back()[1] == Approx(10.29396).epsilon(1e-6));
}

TEST_CASE("Find asks for a speed that is found: under which load does the engine turn at 12 rad/s?") {
  ResponseRobot robot("governor_engine");
  App& app = robot.app;
  choose_response(app.session, "joints.spin.drive.load");
  robot.frames(2);
  robot.click("response/design");
  robot.frames(2);
  robot.click("response/design/speed of spin");
  robot.frames(2);
  REQUIRE(robot.state().design.coordinate == "spin.speed");
  CHECK(robot.state().design.value == Approx(11.0)); // three digits of the present one
  // Typed with its unit; the answer's place is told to nobody who looks elsewhere.
  robot.click("response/value");
  robot.key('A', true);
  robot.type("11.5 rad/s");
  robot.key(key_enter);
  robot.frames(2);
  REQUIRE(robot.state().design.answer.found);
  const DesignAnswer& answer = robot.state().design.answer.found->result;
  REQUIRE_FALSE(answer.solutions.empty());
  Mechanism mechanism = app.session.mechanism();
  set_parameter(mechanism, "joints.spin.drive.load", answer.solutions[0].parameter);
  CHECK(*coordinate(Analysis(mechanism).solve({}), "spin").speed == Approx(11.5).epsilon(1e-10));
}

TEST_CASE("torque and load of a drive by torque are drawn, not only what the one exceeds the other by") {
  ResponseRobot robot("governor_engine");
  App& app = robot.app;
  change_parameter(app.session, "joints.spin.drive.load", 20);
  robot.frames(2);
  const std::vector<DriveTorque>& torques = app.session.answer.solution.drive_torques;
  REQUIRE(torques.size() == 1);
  REQUIRE(torques[0].given);
  CHECK(torques[0].given->load == 20);
  CHECK(torques[0].given->torque == Approx(20).epsilon(1e-10));
  for (const char* key : {"given spin", "load spin"}) {
    const std::vector<ResponseQuantity> offered = offered_quantities(app.session);
    const auto found = std::ranges::find(offered, std::string(key), &ResponseQuantity::key);
    REQUIRE(found != offered.end());
    choose_quantity(app.session, *found);
    robot.frames(3);
    REQUIRE(robot.drawn().plot.marker);
    CHECK(robot.drawn().plot.marker->y == Approx(20).epsilon(1e-9));
  }
}

TEST_CASE("a long list is searched by keys: arrows mark, Enter takes") {
  ResponseRobot robot("chain20");
  App& app = robot.app;
  imgui_compat::map_key(ImGuiKey_DownArrow, keys::down);
  robot.click("response/design");
  robot.frames(3);
  const std::string before = robot.state().design.coordinate;
  SECTION("the first of what is found") {
    robot.type("12");
    robot.frames(2);
    robot.key(key_enter);
    robot.frames(3);
    CHECK_THAT(robot.state().design.coordinate, ContainsSubstring("12"));
    CHECK_FALSE(app.ui.widgets.contains("response/design/search"));
  }
  SECTION("the second") {
    robot.key(keys::down);
    robot.key(keys::down);
    robot.key(key_enter);
    robot.frames(3);
    CHECK(robot.state().design.coordinate != before);
    CHECK_FALSE(app.ui.widgets.contains("response/design/search"));
  }
  SECTION("nothing is found, and nothing taken") {
    robot.type("zzz");
    robot.frames(2);
    robot.key(key_enter);
    robot.frames(3);
    CHECK(robot.state().design.coordinate == before);
    CHECK(app.ui.widgets.contains("response/design/search"));
  }
}

TEST_CASE("a list that is opened shows what is chosen, however far down it stands") {
  ResponseRobot robot("chain20");
  App& app = robot.app;
  const std::vector<ResponseQuantity> offered = offered_quantities(app.session);
  REQUIRE(offered.size() > 40);
  const ResponseQuantity& last = offered[offered.size() - 5];
  choose_quantity(app.session, last);
  robot.frames(2);
  robot.click("response/quantity");
  robot.frames(2);
  CHECK(app.ui.widgets.contains("response/quantity/" + last.key));
  CHECK_FALSE(app.ui.widgets.contains("response/quantity/" + offered.front().key));
}

TEST_CASE("with branches apart what there is shows before the search for them ends") {
  Robot robot(wide, LiveSolver::Mode::background);
  App& app = robot.app;
  open_scene(app.session, shipped_file("governor_watt"));
  app.session.study.response.choice.all = true;
  open_study(app.session, StudyKind::response);
  const ResponseCurve& curve = app.session.study.response.curve;
  REQUIRE(wait_until(app.session, [&] { return curve.found != nullptr; }));
  CHECK(curve.running());
  CHECK_FALSE(curve.found->result.lines.empty());
  CHECK(curve.found->result.diagram.searched.size() < 2);
}

TEST_CASE("sensitivities below pinned sliders agree with two solves beside") {
  Robot robot(wide);
  App& app = robot.app;
  for (const std::string& address : {speed, stiffness}) {
    CAPTURE(address);
    CHECK(app.ui.widgets.count("parameters/" + address + "/rate") == 1);
    const std::vector<ShownRate> rates = shown_rates(app.session, address);
    REQUIRE(rates.size() == 3);
    CHECK(rates[0].share >= (1 - 1e-6) * rates[1].share); // alike: the first is named
    const double at = get_parameter(app.session.mechanism(), address), step = 1e-4 * at;
    const auto solved = [&](double value) {
      Mechanism mechanism = app.session.mechanism();
      set_parameter(mechanism, address, value);
      Analysis analysis(mechanism);
      return analysis.solve({}).coordinates;
    };
    const auto above = solved(at + step), below = solved(at - step);
    for (const ShownRate& rate : rates) {
      const bool angle = rate.name != "slide";
      const double expected = (value(above, rate.name) - value(below, rate.name)) / (2 * step) *
                              (angle ? 180 / std::numbers::pi : 1);
      CHECK(rate.value == Approx(expected).epsilon(1e-6));
      CHECK(rate.unit == std::string(angle ? "°" : "m") + (address == speed ? "/(rad/s)" : "/(N/m)"));
    }
  }
  // Where there is no steady state there is nothing to tell.
  open_scene(app.session, shipped_file("conical_pendulum"));
  robot.frames(2);
  CHECK_FALSE(shown_rates(app.session, speed).empty());
  CHECK(app.ui.widgets.count("parameters/" + speed + "/rate") == 1);
  edit(app.session, "Tilt", [](Mechanism& mechanism, Selection&) { mechanism.gravity = {3, -9, 0}; });
  robot.frames(2);
  REQUIRE_FALSE(converged(app.session));
  CHECK(shown_rates(app.session, speed).empty());
  CHECK(app.ui.widgets.count("parameters/" + speed + "/rate") == 0);
}

TEST_CASE("the response varies every number that the map does, whether it has a slider or none") {
  ResponseRobot robot;
  Session& session = robot.app.session;
  for (const std::string& address : map_addresses(session)) {
    CAPTURE(address);
    choose_response(session, address);
    REQUIRE(robot.state().choice.address == address);
    CHECK(robot.state().choice.from != robot.state().choice.to);
  }
  robot.click("response/parameter");
  robot.frames(2);
  robot.type("mass of ball1");
  robot.frames(2);
  robot.key(key_enter);
  robot.frames(3);
  CHECK(robot.state().choice.address == "bodies.ball1.mass");
  CHECK(robot.drawn().plot.x.label == "mass of ball1");
  CHECK_FALSE(robot.drawn().plot.curves.empty());
  REQUIRE(robot.drawn().plot.marker);
  CHECK_FALSE(robot.app.ui.widgets.contains("response/outside"));
  // Where the present state is not in the plot that is told.
  choose_response_end(session, &ResponseChoice::to, 0.5);
  robot.frames(3);
  CHECK(robot.app.ui.widgets.contains("response/outside"));
}

TEST_CASE("what Find offers is made once for each answer") {
  ResponseRobot robot("pendulum");
  App& app = robot.app;
  robot.frames(2);
  const DesignGoal* const first = design_goals(app.session).goals.data();
  const double value = design_goals(app.session).goals.front().value.value();
  robot.frames(5);
  CHECK(design_goals(app.session).goals.data() == first);
  change_parameter(app.session, "joints.spin.drive.speed", 12);
  robot.frames(3);
  CHECK(design_goals(app.session).goals.front().value.value() != value);
  CHECK(design_goals(app.session).titles.size() == design_goals(app.session).goals.size());
}

TEST_CASE("Find asks for torques and forces, too, and tells what it found in the units shown") {
  ResponseRobot robot("pendulum");
  App& app = robot.app;
  choose_response(app.session, "joints.spin.drive.speed");
  robot.frames(2);
  for (const DesignGoal& goal : design_goals(app.session).goals) {
    if (goal.expression.empty()) continue;
    CAPTURE(goal.key);
    REQUIRE(goal.value);
    if (std::abs(*goal.value) < 1e-6) continue; // rounding, at every speed
    robot.state().design.coordinate = goal.key;
    robot.state().design.value = *goal.value; // that of the present state is found at its speed
    find_design(app.session);
    REQUIRE(robot.state().design.answer.problem.empty());
    REQUIRE(robot.state().design.answer.found);
    const DesignAnswer& answer = robot.state().design.answer.found->result;
    const double speed_now = get_parameter(app.session.mechanism(), "joints.spin.drive.speed");
    const bool constant = answer.end == DesignEnd::constant;
    CHECK((constant || std::ranges::any_of(answer.solutions, [&](const DesignSolution& s) {
             return std::abs(s.parameter - speed_now) < 1e-6 * speed_now;
           })));
    CHECK_THAT(design_words(app.session), ContainsSubstring(constant ? goal.title : "solution"));
  }
  app.session.units = {AngleUnit::degree, LengthUnit::millimetre, SpeedUnit::rpm};
  robot.state().design.coordinate = "reaction(spin)";
  robot.state().design.value = 1e9;
  find_design(app.session);
  CHECK_THAT(design_words(app.session),
             ContainsSubstring("force through spin never is 1e+09 N with speed of spin from 0 to") &&
                 ContainsSubstring(" rpm: it covers"));
}

TEST_CASE("a number that several poses have is told once") {
  ResponseRobot robot("governor_engine");
  App& app = robot.app;
  choose_response(app.session, "joints.spin.drive.load");
  robot.state().design.coordinate = "spin.speed";
  robot.state().design.value = 11.5;
  robot.frames(2);
  find_design(app.session);
  robot.frames(2);
  const DesignAnswer& answer = robot.state().design.answer.found->result;
  std::set<std::pair<long, int>> different;
  for (const DesignSolution& s : answer.solutions)
    different.insert({std::lround(s.parameter * 1e6), s.at.stable ? *s.at.stable : 2});
  REQUIRE(answer.solutions.size() > different.size());
  std::size_t rows = 0;
  while (app.ui.widgets.contains("response/solution/" + std::to_string(rows + 1)))
    ++rows;
  CHECK(rows == different.size());
}

TEST_CASE("a command saves the plot that is shown, as a right click on it does") {
  Robot robot({1280, 900});
  App& app = robot.app;
  CHECK_FALSE(app.commands.enabled(command("study.save_csv"))); // there is none
  robot.key('C');
  robot.frames(4);
  REQUIRE(app.commands.enabled(command("study.save_csv")));
  app.commands.run("study.save_csv");
  robot.frames(4);
  CHECK(app.ui.widgets.contains("save_plot/save"));
  robot.key(key_escape);
  robot.frames(2);
  open_study(app.session, StudyKind::states); // a list
  robot.frames(2);
  CHECK_FALSE(app.commands.enabled(command("study.save_csv")));
}

TEST_CASE("the marker's grip gives way to labels") {
  ResponseRobot robot("rotor_oil_whip");
  int beside_label = 0;
  for (int n = 20; n <= 240; n += 10) {
    change_parameter(robot.app.session, "parameters.n", n);
    robot.frames(2);
    const WidgetRect grip = robot.widget("plot/response/pull"), area = robot.widget("plot/response/area");
    const PlotLayout& l = robot.layout();
    const double x = static_cast<double>(area.from.x) - l.area.left,
                 y = static_cast<double>(area.from.y) - l.area.top;
    const PlotBox box{static_cast<double>(grip.from.x) - x, static_cast<double>(grip.from.y) - y,
                      static_cast<double>(grip.to.x) - x, static_cast<double>(grip.to.y) - y};
    for (const PlotPlaced& mark : l.marks)
      if (mark.label) {
        INFO(n << ": " << mark.label->text);
        CHECK_FALSE(mark.label->box.overlaps(box));
        beside_label += box.left < mark.label->box.right && mark.label->box.left < box.right;
      }
  }
  CHECK(beside_label > 0); // it is put to the test
}
