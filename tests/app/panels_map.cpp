// The map of two parameters, as a person uses it.
#include "robot.hpp"
#include "session_wait.hpp"

#include "app/plot/csv.hpp"
#include "app/session/map.hpp"
#include "app/session/number_text.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/parts.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>
#include <set>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize wide{1280, 900};

struct MapRobot : Robot {
  explicit MapRobot(const std::string& scene = "governor") : Robot(wide) {
    open_scene(app.session, shipped_file(scene));
    frames(3);
    key('P');
    frames(3);
  }
  MapState& map() { return app.session.study.map; }
};

double solved(Mechanism m, const MapChoice& choice, double x, double y) {
  set_parameter(m, choice.axes[0].address, x);
  set_parameter(m, choice.axes[1].address, y);
  const Solution solution = Analysis(m).solve();
  return solution.status == Status::converged ? value(solution, choice.shown) : NAN;
}

} // namespace

TEST_CASE("no map before it is asked for, and a closed one is gone but for what was chosen") {
  Robot robot(wide);
  CHECK_FALSE(robot.app.session.study.map.cells.asked);
  robot.key('P');
  robot.frames(2);
  REQUIRE(robot.app.session.study.map.cells.found);
  CHECK(robot.app.session.study.map.choice.shown == "slide"); // as the response shows it
  robot.app.session.study.map.choice.axes[0].count = 21;
  robot.click("study/close");
  CHECK_FALSE(robot.app.session.study.map.cells.asked);
  CHECK_FALSE(robot.app.session.study.map.curves.asked);
  CHECK_FALSE(robot.app.session.study.map.cells.found);
  CHECK_FALSE(robot.app.session.study.map.curves.found);
  CHECK(robot.app.session.study.map.choice.axes[0].count == 21);
}

TEST_CASE("every place of the map is what a solve of its own gives") {
  MapRobot robot;
  const MapCells& cells = robot.map().cells.found->result;
  const MapChoice& choice = robot.map().cells.found->of.choice;
  CHECK(choice.axes[0].address == "joints.spin.drive.speed");
  const auto columns = static_cast<std::size_t>(choice.axes[0].count);
  REQUIRE(cells.size() == columns * static_cast<std::size_t>(choice.axes[1].count));
  const Plot& plot = robot.app.panels->studies.shown().map.plot;
  REQUIRE(plot.heat);
  for (std::size_t i = 7; i < cells.size(); i += 173) {
    CAPTURE(i);
    const double x = plot.heat->x[i % columns], y = plot.heat->y[i / columns];
    const double expected = solved(robot.app.session.mechanism(), choice, x, y);
    if (std::isnan(expected)) {
      CHECK(std::isnan(cells[i].value));
    } else {
      CHECK(cells[i].value == Approx(expected).epsilon(1e-12));
      CHECK(plot.heat->values[i] == Approx(expected * (plot.heat->unit == "m" ? 1 : 57.29577951308232)));
    }
  }
  CHECK_FALSE(plot.heat->unit.empty());
  CHECK(plot.x.unit == "rad/s");
}

TEST_CASE("a value read off the map is told with the place it was computed at") {
  MapRobot robot;
  robot.map().choice.axes[0].count = robot.map().choice.axes[1].count = 6;
  robot.frames(4);
  const MapView& drawn = robot.app.panels->studies.shown().map;
  const PlotHeat& heat = *drawn.plot.heat;
  REQUIRE(heat.x.size() == 6);
  const WidgetRect area = robot.widget("plot/map/area");
  const PlotLayout& layout = *drawn.view.kept.layout;
  // Near the corner of a cell.
  const double x = heat.x[3] + 0.45 * (heat.x[4] - heat.x[3]), y = heat.y[2] - 0.4 * (heat.y[2] - heat.y[1]);
  robot.point({area.from.x + static_cast<float>(layout.x.pixel(x) - layout.area.left),
               area.from.y + static_cast<float>(layout.y.pixel(y) - layout.area.top)});
  robot.frames(2);
  const std::vector<PlotReadingLine>& card = drawn.view.card;
  REQUIRE(card.size() == 4);
  CHECK(card[0].name == drawn.plot.x.label);
  CHECK(card[1].name == drawn.plot.y.label);
  CHECK(card[2].name == heat.label);
  CHECK(std::stod(card[2].value) == Approx(heat.values[2 * 6 + 3]).epsilon(0.01));
  CHECK(card[3].name == "stable, computed at " + short_text(heat.x[3]) + " " + drawn.plot.x.unit + ", " +
                            short_text(heat.y[2]) + " " + drawn.plot.y.unit);
}

TEST_CASE("unstable places are hatched, which is neither read off nor written to a file") {
  Robot plain(wide);
  open_scene(plain.app.session, shipped_file("watt_governor"));
  // A force that turns along has no potential: then the answer is the state nearest to the drawn pose, and
  // that is unstable at high speeds.
  edit(plain.app.session, "Follow", [](Mechanism& m, Selection&) {
    const Body& link = m.bodies[static_cast<std::size_t>(body_index(m, "link1"))];
    Force follower;
    follower.name = "follower";
    follower.type = ForceType::force;
    follower.body = link.name;
    follower.at = link.position;
    follower.vector = {1e-9, 0, 0};
    follower.frame = ForceFrame::body;
    m.forces.push_back(follower);
  });
  plain.frames(3);
  plain.key('P');
  plain.frames(3);
  const MapState& map = plain.app.session.study.map;
  REQUIRE(map.cells.found);
  const MapCells& cells = map.cells.found->result;
  const auto unstable = std::ranges::count(cells, std::optional(false), &MapCell::stable);
  REQUIRE(unstable > 0);
  const Plot& plot = plain.app.panels->studies.shown().map.plot;
  const auto hatch = std::ranges::find(plot.curves, std::string("unstable"), &PlotCurve::name);
  REQUIRE(hatch != plot.curves.end());
  // Lines through unstable places alone, not so many that they become one colour, and of each place at least
  // one in its row or column, not far.
  const std::vector<double>&x = plot.heat->x, &y = plot.heat->y;
  std::set<std::size_t> hatched;
  for (std::size_t k = 0; k + 1 < hatch->points.size(); k += 3) {
    const std::array<double, 2>&a = hatch->points[k], &b = hatch->points[k + 1];
    const auto i = static_cast<std::size_t>(std::lround(((a[0] + b[0]) / 2 - x[0]) / (x[1] - x[0]))),
               j = static_cast<std::size_t>(std::lround(((a[1] + b[1]) / 2 - y[0]) / (y[1] - y[0])));
    hatched.insert(j * x.size() + i);
  }
  CHECK(std::ranges::all_of(hatched, [&](std::size_t k) { return cells[k].stable == false; }));
  CHECK(2 * std::ssize(hatched) < unstable);
  const auto near_line = [&](std::size_t place) {
    const auto i = static_cast<long>(place % x.size()), j = static_cast<long>(place / x.size());
    return std::ranges::any_of(hatched, [&](std::size_t other) {
      const auto a = static_cast<long>(other % x.size()), b = static_cast<long>(other / x.size());
      return (a == i || b == j) && std::abs(a - i) + std::abs(b - j) < 3;
    });
  };
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (cells[k].stable == false) CHECK(near_line(k));
  const std::string table = to_csv(plot, {});
  CHECK(table.find("\nunstable,") == std::string::npos);
  // Each place has its stability beside its value.
  CHECK(table.substr(0, table.find("\r\n")).ends_with(",stability"));
  std::ptrdiff_t written = 0;
  for (std::size_t at = table.find(",unstable\r\n"); at != std::string::npos;
       at = table.find(",unstable\r\n", at + 1))
    ++written;
  CHECK(written == unstable);
  CHECK(to_csv(plot, {}).find("map,") != std::string::npos);
}

TEST_CASE("a click in the map sets both numbers as one step, and the answer is the map's") {
  MapRobot robot;
  App& app = robot.app;
  const MapChoice choice = robot.map().choice;
  const WidgetRect area = robot.widget("plot/map/area");
  const std::size_t steps = app.session.document.position();
  robot.click(
      ImVec2{area.from.x + 0.7f * (area.to.x - area.from.x), area.from.y + 0.4f * (area.to.y - area.from.y)});
  robot.frames(2);
  CHECK(app.session.document.position() == steps + 1);
  std::array<double, 2> place{};
  for (std::size_t k = 0; k < 2; ++k) {
    const MapAxis& axis = choice.axes[k];
    place[k] = get_parameter(app.session.mechanism(), axis.address);
    const double share = k == 0 ? 0.7 : 0.6;
    CHECK(place[k] == Approx(axis.from + share * (axis.to - axis.from)).margin(0.01 * (axis.to - axis.from)));
  }
  REQUIRE(robot.app.panels->studies.shown().map.plot.marker);
  CHECK(robot.app.panels->studies.shown().map.plot.marker->x == place[0]);
  CHECK(robot.app.panels->studies.shown().map.plot.marker->y == place[1]);
  const std::optional<MapQuantity> shown = map_quantity(app.session);
  REQUIRE(shown);
  CHECK(shown->value.value() ==
        Approx(solved(app.session.mechanism(), choice, place[0], place[1])).epsilon(1e-9));
  // Moving in its own plane does not compute the map anew.
  CHECK_FALSE(robot.map().stale);
  undo(app.session);
  CHECK(get_parameter(app.session.mechanism(), choice.axes[0].address) != place[0]);
}

TEST_CASE("a map of other numbers than now says so in sight, and is computed again at a click") {
  MapRobot robot;
  robot.map().cells.found->run_time = 1; // s: not to be made anew at every move of a slider
  change_parameter(robot.app.session, "gravity.1", -9);
  robot.frames(3);
  CHECK(robot.map().stale);
  const auto& choices = robot.widget("study/map"); // its tab, below which the choices begin
  for (const char* name : {"map/stale", "map/again"}) {
    CHECK(robot.widget(name).from.y > choices.to.y);
    CHECK(robot.widget(name).to.y < robot.widget("map/x").from.y); // whatever the panel's height
  }
  robot.click("map/again");
  robot.frames(3);
  CHECK_FALSE(robot.map().stale);
  CHECK_FALSE(robot.app.ui.widgets.contains("map/again"));
}

TEST_CASE("what is chosen is computed; a value that a number cannot have is refused in words") {
  MapRobot robot;
  App& app = robot.app;
  robot.map().choice.axes[0].count = 5;
  robot.map().choice.axes[1].count = 4;
  robot.frames(2);
  CHECK(robot.map().cells.found->result.size() == 20);
  change_parameter(app.session, "joints.slide.spring.stiffness", 1234);
  robot.frames(3); // an axis of the map: the same map
  const std::vector<MapCell> before = robot.map().cells.found->result;
  // Whatever it took on a busy machine.
  robot.map().cells.found->run_time = robot.map().curves.found->run_time = 0;
  edit(app.session, "Heavier", [](Mechanism& m, Selection&) { set_parameter(m, "bodies.collar.mass", 3); });
  robot.frames(3);
  CHECK(robot.map().cells.found->result[10].value != before[10].value);
  robot.map().choice.axes[1] = {"joints.slide.spring.stiffness", -100, 100, 3};
  robot.frames(2);
  const bool refused = !map_problem(robot.app.session).empty();
  const bool solved_all = robot.map().cells.found->of.choice.axes[1].from == -100;
  CHECK(refused != solved_all);
}

TEST_CASE("the curve on which the conical pendulum lifts is where speed^2 length = gravity") {
  MapRobot robot("conical_pendulum");
  App& app = robot.app;
  // One slider alone: gravity is the other axis.
  const MapChoice& choice = robot.map().choice;
  CHECK(choice.axes[0].address == "joints.spin.drive.speed");
  CHECK(choice.axes[1].address == "gravity.1");
  REQUIRE(robot.map().curves.found);
  REQUIRE(robot.map().curves.found->result.folds);
  const Body& ball = app.session.mechanism().bodies[1];
  const double length = std::hypot(ball.position.x(), 1 - ball.position.y());
  std::size_t points = 0;
  for (const PlaneCurve& curve : robot.map().curves.found->result.folds->curves)
    for (const PlanePoint& p : curve.points) {
      if (std::abs(p.y) < 0.5 || std::abs(p.x) < 0.5) continue;
      CHECK(p.x * p.x * length == Approx(std::abs(p.y)).epsilon(1e-6));
      ++points;
    }
  CHECK(points > 10);
  CHECK(std::ranges::any_of(robot.app.panels->studies.shown().map.plot.curves,
                            [](const PlotCurve& c) { return c.name == "crossings"; }));
}

TEST_CASE("on the curve of a constant value the coordinate has it") {
  MapRobot robot;
  App& app = robot.app;
  robot.click("map/level");
  robot.frames(3);
  REQUIRE(robot.map().choice.level);
  REQUIRE(robot.map().curves.found);
  REQUIRE(robot.map().curves.found->result.level);
  const double level = *robot.map().choice.level;
  std::size_t points = 0;
  for (const PlaneCurve& curve : robot.map().curves.found->result.level->curves)
    for (const PlanePoint& p : curve.points)
      for (const CoordinateSolution& c : p.coordinates)
        if (c.joint == robot.map().choice.shown) {
          CHECK(c.value == Approx(level).epsilon(1e-9));
          ++points;
        }
  CHECK(points > 5);
  // It is drawn, with its value and unit in the legend.
  CHECK(std::ranges::any_of(robot.app.panels->studies.shown().map.plot.curves,
                            [&](const PlotCurve& c) { return c.name.starts_with("slide = "); }));
  CHECK(app.ui.widgets.count("map/level/value") == 1);
}

TEST_CASE("a map shows a measure, and the curve on which it keeps its value") {
  MapRobot robot("governor_parametric");
  MapChoice& choice = robot.map().choice;
  choice.axes[0].count = choice.axes[1].count = 9;
  choice.shown = "height";
  robot.frames(2);
  const MapQuantity now = map_quantity(robot.app.session).value();
  CHECK(now.unit == "m");
  REQUIRE(robot.map().cells.found);
  const auto& cells = robot.map().cells.found->result;
  std::size_t solved_cells = 0;
  for (const MapCell& cell : cells)
    solved_cells += std::isfinite(cell.value);
  CHECK(solved_cells > 20);
  robot.click("map/level");
  robot.frames(3);
  REQUIRE(robot.map().curves.found);
  REQUIRE(robot.map().curves.found->result.level);
  const double level = robot.map().choice.level.value();
  CHECK(level == now.value);
  std::size_t points = 0;
  for (const PlaneCurve& curve : robot.map().curves.found->result.level->curves)
    for (std::size_t i = 0; i < curve.points.size(); i += 10) {
      Mechanism m = robot.app.session.mechanism();
      const std::array<ParameterValue, 2> place{
          {{choice.axes[0].address, curve.points[i].x}, {choice.axes[1].address, curve.points[i].y}}};
      set_parameters(m, place);
      SolveOptions options;
      options.nearest = true;
      for (const CoordinateSolution& c : curve.points[i].coordinates)
        if (!c.driven && !c.dependent) options.start.emplace_back(c.joint, c.value);
      const Solution s = Analysis(m).solve(options);
      REQUIRE(s.status == Status::converged);
      CHECK(s.measures.front().name == "height");
      CHECK(s.measures.front().value.value() == Approx(level).epsilon(1e-9));
      ++points;
    }
  CHECK(points > 2);
}

TEST_CASE("a map over a number that an undo takes away is over another, while its axis is shown") {
  MapRobot robot("governor_parametric");
  App& app = robot.app;
  edit(app.session, "Name a number", [](Mechanism& m, Selection&) {
    m.parameters.push_back({"extra", "", 1, "", {}});
  });
  robot.frames(2);
  robot.map().choice.axes[1] = {"parameters.extra", 0, 2, 5};
  robot.frames(3);
  CHECK(app.ui.widgets.count("map/y/to") == 1);
  robot.key('Z', true);
  robot.frames(3);
  CHECK(robot.map().choice.axes[1].address != "parameters.extra");
}

TEST_CASE("a map in the background tells its progress, can be stopped, and goes with its tab") {
  App app({.mode = LiveSolver::Mode::background, .on_news = {}, .scenes = {}, .numbers = {}});
  open_scene(app.session, shipped_file("governor"));
  const auto wait = [&](const auto& until) {
    REQUIRE(steps_until([&] { update(app, 0.01, {400, 300}); }, until));
  };
  wait([&] { return app.session.answer.ticket != 0; });
  app.session.study.map.choice.folds = false;
  open_study(app.session, StudyKind::map);
  wait([&] { return app.session.study.map.cells.found != nullptr; });
  CHECK(map_progress(app.session).part == 1);
  for (MapAxis& axis : app.session.study.map.choice.axes)
    axis.count = 401; // 160 801 solves: some seconds
  update(app, 0.01, {400, 300});
  CHECK(computing_map(app.session));
  CHECK(studying(app.session));
  wait([&] { return map_progress(app.session).part < 1; });
  cancel_map(app.session);
  wait([&] { return !computing_map(app.session) && !map_problem(app.session).empty(); });
  CHECK(map_problem(app.session) == "Computing the map was stopped.");
  CHECK(app.session.study.map.cells.found->result.size() == 41 * 41); // what there was stays
  compute_map(app.session);
  open_study(app.session, StudyKind::none); // does not wait for the end
  CHECK_FALSE(app.session.study.map.cells.asked);
}

TEST_CASE("the boundary of hunting shows in the map, hard parts told from soft ones, with the frequency") {
  MapRobot robot("governor_engine");
  App& app = robot.app;
  robot.click("map/hunting");
  robot.frames(2);
  robot.map().choice.axes = {MapAxis{"joints.slide.damping", 5, 60, 9},
                             MapAxis{"parameters.gain", 1000, 20000, 9}};
  robot.frames(3);
  REQUIRE(robot.map().curves.found);
  REQUIRE(robot.map().curves.found->result.hunting);
  const PlaneCurves& found = *robot.map().curves.found->result.hunting;
  REQUIRE(found.curves.size() == 1);
  const Plot& plot = app.panels->studies.shown().map.plot;
  const auto drawn = std::ranges::find(plot.curves, std::string("hunting begins, hard"), &PlotCurve::name);
  REQUIRE(drawn != plot.curves.end());
  REQUIRE(drawn->points.size() == found.curves[0].points.size());
  REQUIRE(drawn->along);
  REQUIRE(drawn->along->values.size() == drawn->points.size());
  CHECK(drawn->along->values[3] == Approx(1.04339).epsilon(1e-5));
  // Between two points it is read between.
  const std::array<double, 2> a = drawn->points[3], b = drawn->points[4];
  const MapView& shown = robot.app.panels->studies.shown().map;
  const PlotLayout& layout = *shown.view.kept.layout;
  const WidgetRect area = robot.widget("plot/map/area");
  robot.point({area.from.x + static_cast<float>(layout.x.pixel((a[0] + b[0]) / 2) - layout.area.left),
               area.from.y + static_cast<float>(layout.y.pixel((a[1] + b[1]) / 2) - layout.area.top)});
  robot.frames(2);
  const auto told = std::ranges::find(shown.view.card, "hunts at", &PlotReadingLine::name);
  REQUIRE(told != shown.view.card.end());
  CHECK(told->unit == "Hz");
  const auto [low, high] = std::minmax(drawn->along->values[3], drawn->along->values[4]);
  CHECK(std::stod(told->value) == Approx((low + high) / 2).margin(1e-5 + (high - low)));
  for (const auto& [damping, gain] : drawn->points)
    CHECK(gain / damping == Approx(7500 / 21.5343400233).epsilon(1e-9));
  // On the unstable side of it the cells are hatched.
  CHECK(std::ranges::any_of(plot.curves, &PlotCurve::hatching));
  robot.click("map/hunting");
  robot.frames(3);
  CHECK_FALSE(robot.map().curves.found->result.hunting);
}

TEST_CASE("where a torque turns it the map begins with the damper's slider, on which the speed depends") {
  Mechanism m;
  m.name = "Braked";
  m.bodies = {body("wheel", 1, {0, 0, 0}, {0.1, 0.1, 0.1})};
  m.joints = {dampened(driven(revolute("spin", "ground", "wheel", {0, 0, 0}), 50), 0.5)};
  m.joints[0].coordinates[0].drive->torque = 0;
  m.joints[0].formulas = {{"drive.torque", "10 N m - 0.1 N m s*rate(spin)"}};
  Robot robot(wide);
  open_document(robot.app.session, Document(m));
  robot.frames(3);
  robot.key('P');
  robot.frames(3);
  CHECK(robot.app.session.study.map.choice.axes[0].address == "joints.spin.damping");
}
