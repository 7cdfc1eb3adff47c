// Numbers are shown in the units a person has chosen, in fields, results and plots alike; files stay in SI.
#include "app/document/formula_edits.hpp"
#include "app/plot/csv.hpp"
#include "app/session/quantity.hpp"
#include "app/session/settings.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "engine/mechanism/address.hpp"
#include "robot.hpp"
#include "temporary_folder.hpp"
#include "tests/catch.hpp"

#include <fstream>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* speed = "joints.spin.drive.speed";
constexpr DisplayUnits workshop{AngleUnit::degree, LengthUnit::millimetre, SpeedUnit::rpm};
constexpr DisplayUnits si{AngleUnit::radian, LengthUnit::metre, SpeedUnit::radian};

void enter_in(Robot& robot, const char* field, const std::string& text) {
  robot.frames(60); // no double click
  robot.click(field);
  robot.key('A', true);
  robot.type(text);
  robot.key(key_enter);
  robot.frames(2);
}

} // namespace

TEST_CASE("shown and typed back, a number is the same to the last digit") {
  for (const DisplayUnits& units : {workshop, si, DisplayUnits{}})
    for (const char* unit : {"m", "rad", "rad/s", "m/s", "N/m", "N s/m", "kg", "m/s^2", "deg", ""})
      for (const double value : {0.0011, 1.1, 0.7, -35e-4, 11.0174, 1e-9, 12345.678}) {
        CAPTURE(unit, value);
        const ShownUnit shown = shown_unit(unit, units);
        CHECK(shown.si(shown.shown(value)) == Approx(value).epsilon(1e-15));
        if (units.length == LengthUnit::millimetre && std::string(unit) == "m")
          CHECK(shown.si(shown.shown(value)) == value);
      }
  CHECK(shown_unit("m", workshop).shown(0.0011) == 1.1);
  CHECK(shown_unit("rad", workshop).shown(std::numbers::pi / 4) == 45);
  CHECK(shown_unit("rad/s", workshop).shown(2 * std::numbers::pi) == 60);
}

TEST_CASE("a plain number is in the unit shown, and any unit can be typed") {
  CHECK(parse_quantity("35", "m", "mm").value == 0.035);
  CHECK(parse_quantity("1.1", "m", "mm").value == 0.0011);
  CHECK(parse_quantity("0.2 m", "m", "mm").value == 0.2);
  CHECK(parse_quantity("30 + 0.1 m", "m", "mm").value == Approx(0.13));
  CHECK(parse_quantity("90", "rad", "°").value == std::numbers::pi / 2);
  CHECK(parse_quantity("60", "rad/s", "rpm").value == Approx(2 * std::numbers::pi).epsilon(1e-15));
  CHECK(parse_quantity("3 rad/s", "rad/s", "rpm").value == 3);
  CHECK(parse_quantity("2", "N/m", "N/mm").value == 2000);
  CHECK_FALSE(parse_quantity("2 kg", "m", "mm"));
  // A typed number of a smaller unit is the nearest there is, not its product with one that is rounded.
  CHECK(parse_quantity("5.1 mm", "m").value == 0.0051);
  CHECK(parse_quantity("1.1 g", "kg").value == 0.0011);
}

TEST_CASE("fields, sliders and results show one and the same unit") {
  Robot robot({1280, 900});
  App& app = robot.app;
  choose_units(app.session, app.ui, app.view, workshop);
  robot.frames(2);
  robot.click(std::string("parameters/") + speed + "/value");
  CHECK_THAT(app.ui.fields.typing.text, ContainsSubstring("rpm"));
  robot.type("120");
  robot.key(key_enter);
  CHECK(get_parameter(app.session.mechanism(), speed) == Approx(4 * std::numbers::pi).epsilon(1e-15));
  select(app.session, {{{PartKind::body, "collar"}}});
  set_mode(app.session, Mode::build);
  robot.frames(3);
  robot.click("inspector/position/x");
  CHECK_THAT(app.ui.fields.typing.text, ContainsSubstring("mm"));
  robot.type("12.5");
  robot.key(key_enter);
  CHECK(app.session.document.stored().bodies.back().position.x() == 0.0125);
  // Enter without typing changes nothing.
  const std::size_t steps = app.session.document.position();
  robot.click("inspector/position/y");
  robot.key(key_enter);
  CHECK(app.session.document.position() == steps);
}

TEST_CASE("the hand's steps on a slider are round in the unit shown") {
  Robot robot;
  App& app = robot.app;
  choose_units(app.session, app.ui, app.view, workshop);
  robot.frames(2);
  robot.drag(std::string("parameters/") + speed, {0.4f, 0.5f}, {0.71f, 0.5f});
  const double rpm = get_parameter(app.session.mechanism(), speed) * 30 / std::numbers::pi;
  CHECK(rpm == Approx(std::round(rpm)).margin(1e-9));
}

TEST_CASE("a plot is in the units shown, and its CSV in SI") {
  Plot plot;
  plot.x = {.label = "speed", .unit = "rad/s", .range = PlotRange{0, 2 * std::numbers::pi}};
  plot.y = {.label = "slide", .unit = "m"};
  plot.curves.push_back({.name = "c", .points = {{std::numbers::pi, 0.25}}});
  plot.references.push_back({.axis = 1, .at = 0.5, .label = ""});
  show_axis(plot, 0, "rad/s", workshop);
  show_axis(plot, 1, "m", workshop);
  CHECK(plot.x.unit == "rpm");
  CHECK((*plot.x.range)[1] == Approx(60));
  CHECK(plot.curves[0].points[0][0] == Approx(30));
  CHECK(plot.curves[0].points[0][1] == Approx(250));
  CHECK(plot.references[0].at == Approx(500));
  const std::string csv = to_csv(plot, {});
  CHECK_THAT(csv, ContainsSubstring("curve,speed [rad/s],slide [m]"));
  CHECK_THAT(csv, ContainsSubstring(",0.25"));
}

TEST_CASE("what was chosen is there when the program starts again") {
  const TemporaryFolder folder;
  const AppOptions options{.mode = LiveSolver::Mode::immediate,
                           .on_news = {},
                           .scenes = {},
                           .numbers = {},
                           .state = folder.path()};
  {
    App app(options);
    CHECK(app.session.units == DisplayUnits{});
    choose_units(app.session, app.ui, app.view, workshop);
    open_legend(app.session, app.ui, app.view, false);
    app.commands.run("view.shadow");
  }
  App again(options);
  CHECK(again.session.units == workshop);
  CHECK_FALSE(again.view.legend);
  CHECK_FALSE(again.view.shadow);
  CHECK(again.view.grid);
}

TEST_CASE("settings that cannot be read are as at first") {
  const TemporaryFolder folder;
  for (const char* text : {"", "[]", "{\"angle\": 3, \"length\": \"parsec\"}", "{\"angle\": \"rad\""}) {
    std::ofstream(folder / "settings.json") << text;
    CHECK(read_settings(folder.path()) == Settings{});
  }
}

TEST_CASE("the lines below sliders change with the units at once") {
  Robot robot({1280, 900});
  App& app = robot.app;
  choose_units(app.session, app.ui, app.view, si);
  robot.frames(2);
  REQUIRE(robot.app.ui.widgets.contains(std::string("parameters/") + speed + "/rate"));
  const std::uint64_t ticket = app.session.answer.ticket;
  const auto shown = [&] { return app.panels->parameters.rates().at(speed).rates.front(); };
  REQUIRE(shown().unit == "rad/(rad/s)");
  const double value = shown().value;
  choose_units(app.session, app.ui, app.view, workshop);
  robot.frames(1);
  CHECK(app.session.answer.ticket == ticket);
  CHECK(shown().unit == "°/rpm");
  CHECK(shown().value == Approx(value * 6));
}

TEST_CASE("ends of sliders are round in the units shown, and so is a new drive") {
  Robot robot({1280, 900});
  App& app = robot.app;
  edit(app.session, "Unpin", [](Mechanism& m, Selection&) { m.sliders.clear(); });
  const auto end = [&] {
    for (const ParameterControl& control : app.session.parameters)
      if (control.address == speed) return control.to;
    return 0.;
  };
  CHECK(end() == 50);
  choose_units(app.session, app.ui, app.view, workshop);
  robot.frames(2);
  CHECK(shown_unit("rad/s", workshop).shown(end()) == 500);
  choose_units(app.session, app.ui, app.view, {.speed = SpeedUnit::degree});
  CHECK(shown_unit("rad/s", app.session.units).shown(end()) == 2000);
  CHECK(shown_unit("rad/s", workshop).shown(new_drive_speed(workshop)) == 100);
  CHECK(new_drive_speed(si) == 10);
  // A slider that is made for an angle of zero ends at half a turn.
  const Slider slider = slider_for(app.session.mechanism(), "joints.spin.coordinate", DisplayUnits{});
  CHECK(shown_unit("rad", DisplayUnits{}).shown(slider.to) == 180);
}

TEST_CASE("colours for one run are not kept with what is chosen in it") {
  const TemporaryFolder folder;
  AppOptions options{.mode = LiveSolver::Mode::immediate,
                     .on_news = {},
                     .scenes = {},
                     .numbers = {},
                     .state = folder.path()};
  options.theme_choice = ThemeChoice::high_contrast;
  {
    App app(options);
    CHECK(app.ui.theme == Theme::high_contrast);
    app.commands.run("view.shadow");
    CHECK(read_settings(folder.path()).theme == ThemeChoice::system);
    app.commands.run("view.theme_contrast"); // and those that are chosen are
  }
  CHECK(read_settings(folder.path()).theme == ThemeChoice::high_contrast);
}

TEST_CASE("the interface has sizes, by command and key, which are kept") {
  const TemporaryFolder folder;
  {
    Robot robot;
    App& app = robot.app;
    app.session.options.state = folder.path();
    robot.key('+', true);
    CHECK(app.ui.zoom == 1.1);
    robot.key('=', true, true); // as it is typed on an English keyboard
    CHECK(app.ui.zoom == 1.25);
    robot.key('-', true);
    CHECK(app.ui.zoom == 1.1);
    for (int i = 0; i < 20; ++i)
      app.commands.run("view.larger");
    CHECK(app.ui.zoom == most_zoom);
    CHECK_FALSE(app.commands.enabled(command("view.larger")));
    for (int i = 0; i < 20; ++i)
      app.commands.run("view.smaller");
    CHECK(app.ui.zoom == least_zoom);
    robot.key('0', true);
    CHECK(app.ui.zoom == 1);
    app.commands.run("view.larger");
  }
  CHECK(read_settings(folder.path()).zoom == 1.1);
  std::ofstream(folder / "settings.json") << "{\"zoom\": 100}";
  CHECK(read_settings(folder.path()).zoom == most_zoom);
}

TEST_CASE("a file of what an axis shows names the unit of its numbers, whoever tells the axis its own") {
  Plot plot;
  plot.x = {.label = "speed", .unit = "rad/s"};
  plot.y = {.label = "slide", .unit = "m"};
  plot.curves.push_back({.name = "collar", .points = {{2, 0.25}}});
  show_axis(plot, 0, plot.x.unit, workshop);
  show_axis(plot, 1, plot.y.unit, workshop);
  CHECK(plot.x.unit == "rpm");
  CHECK(plot.curves[0].points[0][1] == Approx(250));
  CHECK_THAT(to_csv(plot, {}), ContainsSubstring("curve,speed [rad/s],slide [m]\r\ncollar,"));
}

TEST_CASE("an expression of numbers alone is in the unit of its field") {
  Robot robot({1280, 900});
  App& app = robot.app;
  choose_units(app.session, app.ui, app.view, workshop);
  set_mode(app.session, Mode::build);
  const auto enter = [&](const char* field, const char* text) { enter_in(robot, field, text); };
  const auto collar = [&] { return app.session.document.stored().bodies.back(); };
  select(app.session, {{{PartKind::body, "collar"}}});
  robot.frames(3);
  enter("inspector/position/x", "=60");
  CHECK(collar().position.x() == Approx(0.06).epsilon(1e-14));
  enter("inspector/position/x", "=2*(30 - 5)");
  CHECK(collar().position.x() == Approx(0.05).epsilon(1e-14));
  enter("inspector/position/x", "=0.02 m");
  CHECK(collar().position.x() == 0.02);
  enter("inspector/inertia/xx", "=0.25 kg m²"); // as units are shown
  CHECK(collar().inertia[0] == 0.25);
  select(app.session, {{{PartKind::joint, "spin"}}});
  robot.frames(3);
  enter("inspector/drive/speed", "=60");
  CHECK(get_parameter(app.session.document.stored(), speed) == Approx(2 * std::numbers::pi).epsilon(1e-14));
  enter("inspector/drive/speed", "=exp(0)*60"); // a function that is known in expressions alone
  CHECK(get_parameter(app.session.document.stored(), speed) == Approx(2 * std::numbers::pi).epsilon(1e-14));
}

TEST_CASE("numbers have the same value with and without the sign of an expression") {
  Robot robot({1280, 1500});
  App& app = robot.app;
  choose_units(app.session, app.ui, app.view, workshop); // mm, degrees, rpm
  set_mode(app.session, Mode::build);
  select(app.session, {{{PartKind::body, "collar"}}});
  robot.frames(3);
  const auto entered = [&](const char* field, const std::string& text) {
    enter_in(robot, field, text);
    return app.session.document.stored();
  };
  for (const char* text : {"10*pi", "10 + 5 mm", "1/2 in", "sqrt(2)", "-3", "2*0.1 m", "0.03"}) {
    INFO(text);
    const double plain = entered("inspector/position/x", text).bodies.back().position.x();
    entered("inspector/position/x", "1");
    CHECK(entered("inspector/position/x", "=" + std::string(text)).bodies.back().position.x() ==
          Approx(plain).epsilon(1e-14));
  }
  robot.click("inspector/rotation section");
  robot.frames(2);
  for (const char* text : {"pi/18", "10", "2*asin(0.5)", "1/8 turn"}) {
    INFO(text);
    const Eigen::Quaterniond plain = entered("inspector/rotation/z", text).bodies.back().rotation;
    entered("inspector/rotation/z", "1");
    CHECK(entered("inspector/rotation/z", "=" + std::string(text))
              .bodies.back()
              .rotation.isApprox(plain, 1e-13));
  }
}

TEST_CASE("an expression of a file is in SI units, and is shown so where it is typed at") {
  Robot robot({1280, 900});
  App& app = robot.app;
  choose_units(app.session, app.ui, app.view, workshop);
  set_mode(app.session, Mode::build);
  edit(app.session, "Place", [](Mechanism& mechanism, Selection& selection) {
    set_expression(mechanism, "bodies.collar.position.0", "2*0.05");
    selection.set({PartKind::body, "collar"});
  });
  robot.frames(3);
  robot.click("inspector/position/x");
  robot.frames(2);
  CHECK(app.ui.fields.typing.text == "=(2*0.05)*1 m");
  robot.key(key_enter);
  robot.frames(2);
  CHECK(formula_at(app.session.document.stored(), "bodies.collar.position.0") == "2*0.05");
}
