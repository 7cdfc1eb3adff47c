// The spread as a person uses it: tolerances, the histogram, whose share it is, and the band around the
// response.
#include "robot.hpp"

#include "app/document/rename.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

struct SpreadRobot : Robot {
  explicit SpreadRobot(const std::string& scene = "governor_parametric") : Robot({1400, 1000}) {
    open_scene(app.session, shipped_file(scene));
    frames(3);
    open_study(app.session, StudyKind::motion);
    frames(2);
    click("study/spread");
    frames(3);
  }
  SpreadState& state() { return app.session.study.spread; }
  const Plot& plot() { return app.panels->studies.shown().spread.plot; }
  void retype(const std::string& field, const std::string& text) {
    click(field);
    key('A', true);
    type(text);
    key(key_enter);
    frames(3);
  }
};

double samples_in(const PlotBand& band) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < band.points.size(); i += 2)
    sum += band.points[i][2];
  return sum;
}

} // namespace

TEST_CASE("without being asked for there are no samples") {
  Robot robot;
  CHECK_FALSE(robot.app.session.study.spread.samples.asked);
  CHECK(robot.app.ui.widgets.count("plot/spread/area") == 0);
}

TEST_CASE("the histogram holds every sample, beside the numbers that say what it is") {
  SpreadRobot robot;
  REQUIRE(robot.state().samples.found);
  REQUIRE(robot.plot().bands.size() == 1);
  CHECK(samples_in(robot.plot().bands[0]) == 2000);
  CHECK(robot.plot().x.label == "slide");
  for (const char* name : {"plot/spread/area", "spread/mean", "spread/deviation", "spread/copy"})
    CHECK(robot.app.ui.widgets.count(name) == 1);
  CHECK(robot.plot().curves.size() == 1); // as the rates promise
  robot.click("spread/copy");
  const std::string csv = ImGui::GetClipboardText();
  CHECK(csv.starts_with("parameters.w,parameters.L,fate,arm1,"));
  CHECK(std::ranges::count(csv, '\n') == 2001);
}

TEST_CASE("numbers that change nothing spread nothing: all samples stand at one value") {
  SpreadRobot robot("governor_engine"); // gain and damping move its speed, but not the collar
  robot.state().output = "slide";
  robot.frames(4);
  REQUIRE(robot.state().samples.found);
  const Plot& plot = robot.plot();
  REQUIRE(plot.x.label == "slide");
  CHECK(plot.bands.empty());
  REQUIRE(plot.curves.size() == 1);
  CHECK(plot.curves[0].points[0][0] == plot.curves[0].points[1][0]);
  CHECK(plot.curves[0].points[1][1] == 2000);
  REQUIRE(plot.references.size() == 1); // no labels over each other
  CHECK(plot.references[0].label == "nominal");
  CHECK(plot.y.whole);
  CHECK(robot.app.ui.widgets.contains("spread/unmoved")); // and it is said
}

TEST_CASE("a width is typed in per cent or in the number's unit, and what it is scatters so") {
  SpreadRobot robot;
  const auto deviation = [&] { return shown_output(robot.app.session)->linear_deviation; };
  const double before = deviation();
  robot.retype("spread/parameters.w/width", "2 %");
  robot.retype("spread/parameters.L/width", "2");
  CHECK(deviation() == Approx(2 * before).epsilon(1e-6));
  robot.click("spread/parameters.L/unit");
  robot.frames(2);
  CHECK_FALSE(robot.state().choice.tolerances[1].percent);
  CHECK(robot.state().choice.tolerances[1].width == Approx(0.0032).epsilon(1e-12));
  CHECK(deviation() == Approx(2 * before).epsilon(1e-6));
  robot.retype("spread/parameters.L/width", "1.6 mm");
  CHECK(robot.state().choice.tolerances[1].width == Approx(0.0016).epsilon(1e-12));
  // A uniform one of that half width scatters less.
  const double normal = deviation();
  robot.click("spread/parameters.L/distribution");
  robot.click("spread/parameters.L/distribution/uniform");
  robot.frames(3);
  CHECK(robot.state().choice.tolerances[1].distribution == Distribution::uniform);
  CHECK(deviation() < normal);
  robot.click("spread/parameters.L/remove");
  robot.frames(3);
  REQUIRE(robot.state().choice.tolerances.size() == 1);
  CHECK(shown_output(robot.app.session)->linear_shares == std::vector<double>{1});
}

TEST_CASE("another number gets a tolerance, another output is shown, and more samples are made") {
  SpreadRobot robot;
  robot.click("spread/add");
  robot.click("spread/add/m");
  robot.frames(3);
  REQUIRE(robot.state().choice.tolerances.size() == 3);
  CHECK(robot.state().choice.tolerances[2].address == "parameters.m");
  CHECK(shown_output(robot.app.session)->linear_shares.size() == 3);
  robot.click("spread/output");
  robot.click("spread/output/height");
  robot.frames(2);
  CHECK(robot.plot().x.label == "height");
  robot.retype("spread/samples", "500");
  CHECK(samples_in(robot.plot().bands[0]) == 500);
}

TEST_CASE("samples of other numbers than now are said to be so in sight, and made again at a click") {
  SpreadRobot robot;
  robot.state().samples.found->run_time = 1; // s: not to be made anew at every move of a slider
  change_parameter(robot.app.session, "gravity.1", -9);
  robot.frames(3);
  CHECK(robot.state().stale);
  for (const char* name : {"spread/stale", "spread/again"})
    CHECK(robot.widget(name).to.y < robot.widget("spread/output").from.y); // whatever the panel's height
  robot.click("spread/copy");                                              // as they are, and that is told
  CHECK_THAT(std::string(ImGui::GetClipboardText()),
             Catch::Matchers::StartsWith("parameters.w,parameters.L,fate,"));
  CHECK_THAT(robot.app.session.notice, Catch::Matchers::Contains("out of date"));
  CHECK(robot.state().stale);
  robot.click("spread/again");
  robot.frames(3);
  CHECK_FALSE(robot.state().stale);
  CHECK_FALSE(robot.app.ui.widgets.contains("spread/again"));
}

TEST_CASE("a number that an undo takes away has no tolerance until it is back, while its row is shown") {
  SpreadRobot robot;
  App& app = robot.app;
  const std::size_t before = chosen_tolerances(app.session).size();
  edit(app.session, "Name a number", [](Mechanism& m, Selection&) {
    m.parameters.push_back({"extra", "", 1, "", {}});
  });
  robot.frames(2);
  add_tolerance(app.session, "parameters.extra");
  robot.frames(3);
  CHECK(app.ui.widgets.count("spread/parameters.extra/width") == 1);
  robot.key('Z', true);
  robot.frames(3);
  CHECK(app.session.mechanism().parameters.back().name != "extra");
  CHECK(chosen_tolerances(app.session).size() == before);
  CHECK(app.ui.widgets.count("spread/parameters.extra/width") == 0);
  redo(app.session);
  robot.frames(3);
  CHECK(chosen_tolerances(app.session).size() == before + 1);
  CHECK(app.ui.widgets.count("spread/parameters.extra/width") == 1);
}

TEST_CASE("the spread is reached by keys") {
  SpreadRobot robot;
  focus_widget(robot.app.ui, "spread/parameters.w/width");
  robot.frames(2);
  robot.key(257);
  robot.key('A', true);
  robot.type("3");
  robot.key(key_enter);
  robot.frames(3);
  CHECK(robot.state().choice.tolerances[0].width == 3);
}

TEST_CASE("samples beyond a fold are told apart, in words and in the histogram") {
  SpreadRobot robot("conical_pendulum");
  // The straight state is left by those that turn faster than sqrt(g / L).
  change_parameter(robot.app.session, "joints.spin.drive.speed", 3.7);
  robot.state().choice.tolerances = {{"joints.spin.drive.speed", Distribution::uniform, 0.1, false}};
  robot.frames(4);
  REQUIRE(robot.state().samples.found);
  const SpreadAnswer& answer = robot.state().samples.found->result;
  const auto elsewhere = answer.counts[static_cast<std::size_t>(SampleFate::elsewhere)];
  CHECK(elsewhere > 200);
  CHECK(robot.app.ui.widgets.count("spread/fate/elsewhere") == 1);
  const auto& bands = robot.plot().bands;
  const auto band = std::ranges::find(bands, "in another steady state", &PlotBand::name);
  REQUIRE(band != bands.end());
  CHECK(samples_in(*band) == static_cast<double>(elsewhere));
}

TEST_CASE("from the spread to the band around the response, which is switched off there") {
  SpreadRobot robot;
  robot.click("spread/band");
  robot.frames(4);
  CHECK(robot.app.session.study.open == StudyKind::response);
  choose_response(robot.app.session, "parameters.w");
  robot.frames(4);
  const Plot& plot = robot.app.panels->studies.shown().response.plot;
  REQUIRE_FALSE(plot.bands.empty());
  CHECK(plot.bands[0].name == "5 % to 95 % of samples");
  // The state that is shown lies within.
  REQUIRE(plot.marker);
  double lower = 0, upper = 0;
  for (const PlotBand& band : plot.bands)
    for (std::size_t i = 1; i < band.points.size(); ++i)
      if (band.points[i - 1][0] <= plot.marker->x && plot.marker->x <= band.points[i][0]) {
        lower = std::min(band.points[i - 1][1], band.points[i][1]);
        upper = std::max(band.points[i - 1][2], band.points[i][2]);
      }
  CHECK(lower < plot.marker->y);
  CHECK(plot.marker->y < upper);
  CHECK(robot.app.ui.widgets.count("plot/response/legend/5 % to 95 % of samples") == 1);
  CHECK(robot.app.ui.widgets.count("response/band/words") == 1);
  robot.click("response/band");
  robot.frames(3);
  CHECK(robot.app.panels->studies.shown().response.plot.bands.empty());
  CHECK_FALSE(robot.app.session.study.band.computed.found);
}

TEST_CASE("the unit in which a tolerance could be told keeps clear of the button beside it") {
  SpreadRobot d("pendulum");
  Session& session = d.app.session;
  d.state().choice.samples = 20; // made anew for each number; the rows do not depend on how many
  std::size_t told = 0;
  for (const std::string& address : numbers_without_tolerance(session)) {
    add_tolerance(session, address);
    d.frames(2);
    const auto unit = d.app.ui.widgets.find("spread/" + address + "/unit"),
               cross = d.app.ui.widgets.find("spread/" + address + "/remove");
    if (unit == d.app.ui.widgets.end() || cross == d.app.ui.widgets.end()) continue; // below the panel
    ++told;
    INFO(address);
    CHECK(unit->second.to.x <= cross->second.from.x + 4); // the cross stands in the middle of its button
    std::erase_if(session.study.spread.choice.tolerances,
                  [&](const ChosenTolerance& each) { return each.address == address; });
  }
  CHECK(told > 10);
}

TEST_CASE("the name of what scatters keeps clear of the plot however long it is") {
  SpreadRobot robot("conical_pendulum");
  edit(robot.app.session, "Long", [](Mechanism& m, Selection&) {
    rename_part(m, {PartKind::joint, "swing"}, std::string(90, 'w'));
  });
  robot.frames(3);
  REQUIRE(robot.state().samples.found);
  CHECK(robot.widget("spread/of").to.x <= robot.widget("plot/spread/area").from.x);
}
