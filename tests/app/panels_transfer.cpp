// The linear model as a person uses it: an input and an output, Bode's plots, poles and zeros, and the file.
#include "app/ui/commands.hpp"
#include "app/ui/panel_list.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "robot.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <tuple>

using namespace flyball;
using namespace flyball::test;

namespace {

struct TransferRobot : Robot {
  explicit TransferRobot(const std::string& scene = "governor") : Robot({1400, 1000}) {
    open_scene(app.session, shipped_file(scene));
    frames(3);
    open_study(app.session, StudyKind::motion);
    frames(2);
    click("study/transfer");
    frames(3);
  }
  TransferState& state() { return app.session.study.transfer; }
  const FoundTransfer& found() {
    INFO(state().found.problem);
    REQUIRE(state().found.found);
    return state().found.found->result;
  }
  const TransferView& view() { return app.panels->studies.shown().transfer; }
};

// What stands at a frequency of a plot's only curve, between its points.
double read(const Plot& plot, double frequency) {
  const auto& points = plot.curves.at(0).points;
  const auto after = std::ranges::find_if(points, [&](const auto& p) { return p[0] >= frequency; });
  REQUIRE(after != points.begin());
  REQUIRE(after != points.end());
  const auto& [x, y] = *(after - 1);
  return y + (frequency - x) / ((*after)[0] - x) * ((*after)[1] - y);
}

} // namespace

TEST_CASE("without being asked for there is no linear model") {
  Robot robot;
  CHECK_FALSE(robot.app.session.study.transfer.found.asked);
  CHECK(robot.app.ui.widgets.count("plot/transfer magnitude/area") == 0);
}

TEST_CASE("the transfer function of what the response shows is drawn, with its poles") {
  TransferRobot robot;
  CHECK(robot.state().choice.input == "joints.spin.drive.speed");
  CHECK(robot.state().choice.output == "slide");
  const FoundTransfer& found = robot.found();
  for (const char* name :
       {"plot/transfer magnitude/area", "plot/transfer phase/area", "plot/poles and zeros/area",
        "transfer/gain", "transfer/reference", "transfer/poles", "transfer/save"})
    CHECK(robot.app.ui.widgets.count(name) == 1);
  const Solution& solution = robot.app.session.answer.solution;
  REQUIRE(solution.eigenvalues);
  REQUIRE(found.model.poles.size() == solution.eigenvalues->size());
  for (std::size_t i = 0; i < found.model.poles.size(); ++i)
    CHECK(std::abs(found.model.poles[i] - (*solution.eigenvalues)[i]) < 1e-9);
  // At low frequencies the static gain, at the natural one the peak.
  const double low = read(robot.view().magnitude, 0.15);
  CHECK(low == Approx(20 * std::log10(std::abs((*found.model.gain)(0, 0)))).margin(0.3));
  const double natural = std::abs(found.model.poles.front()) / 6.283185307179586;
  CHECK(read(robot.view().magnitude, natural) > low + 15);
  CHECK(read(robot.view().magnitude, natural) > read(robot.view().magnitude, 1.5 * natural) + 10);
  // The collar falls behind by a quarter turn there.
  CHECK(std::abs(read(robot.view().phase, 0.15) - read(robot.view().phase, natural)) == Approx(90).margin(6));
  CHECK(robot.view().roots.curves.at(0).points.size() == 2);
}

TEST_CASE("the plots are over hertz or radians a second") {
  TransferRobot robot;
  const double hertz = robot.view().magnitude.curves.at(0).points.front()[0];
  CHECK(robot.view().magnitude.x.unit == "Hz");
  robot.click("transfer/radians");
  robot.frames(2);
  CHECK(robot.view().magnitude.x.unit == "rad/s");
  CHECK(robot.view().phase.x.unit == "rad/s");
  CHECK(robot.view().magnitude.curves.at(0).points.front()[0] == Approx(6.283185307179586 * hertz));
}

TEST_CASE("over Bode's plots gain and phase of the curve are read, wherever the pointer is") {
  TransferRobot robot;
  const TransferView& view = robot.view();
  for (const char* plot : {"magnitude", "phase"})
    for (const float height : {0.15f, 0.5f, 0.85f}) {
      CAPTURE(plot, height);
      const WidgetRect area = robot.widget("plot/transfer " + std::string(plot) + "/area");
      robot.point(
          {area.from.x + 0.4f * (area.to.x - area.from.x), area.from.y + height * (area.to.y - area.from.y)});
      robot.frames(2);
      const PlotLayout& layout = *view.magnitude_view.kept.layout;
      const double frequency = *(plot == std::string("phase") ? view.phase_view : view.magnitude_view).cursor;
      CHECK(layout.x.pixel(frequency) == Approx(layout.area.left + 0.4 * layout.area.width()).margin(1));
      for (const auto& [card, drawn, name] : {std::tuple(&view.magnitude_view.card, &view.magnitude, "gain"),
                                              std::tuple(&view.phase_view.card, &view.phase, "phase")}) {
        CAPTURE(name);
        REQUIRE(card->size() == 2); // of both plots at once
        CHECK((*card)[0].name == "frequency");
        CHECK((*card)[1].name == name);
        std::string number = (*card)[1].value;
        if (number.starts_with("−")) number.replace(0, std::string("−").size(), "-");
        const double step = std::abs(read(*drawn, frequency * 1.01) - read(*drawn, frequency));
        CHECK(std::stod(number) == Approx(read(*drawn, frequency)).margin(0.05 + 0.1 * step));
      }
    }
  // Both have their frequencies one above the other, and zoom along them together.
  const auto areas = [&] {
    return std::array{view.magnitude_view.kept.layout->area, view.phase_view.kept.layout->area};
  };
  CHECK(areas()[0].left == areas()[1].left);
  CHECK(areas()[0].right == areas()[1].right);
  robot.wheel("plot/transfer phase/axis/x", 3);
  robot.frames(2);
  CHECK(view.phase_view.kept.layout->x.upper < 0.9 * view.phase.curves[0].points.back()[0]);
  CHECK(view.magnitude_view.kept.layout->x.upper == view.phase_view.kept.layout->x.upper);
  CHECK(areas()[0].left == areas()[1].left);
  for (const PlotTick& tick : view.phase_view.kept.layout->y_ticks)
    CHECK(std::remainder(tick.value, 15) == Approx(0).margin(1e-9));
}

TEST_CASE("of joints with dry friction the model is of the motion once they slip, and says so") {
  TransferRobot free;
  CHECK(free.app.ui.widgets.count("transfer/friction") == 0);
  TransferRobot robot;
  edit(robot.app.session, "Add friction", [](Mechanism& m, Selection&) {
    for (Joint& joint : m.joints)
      if (joint.name == "slide") joint.coordinates[0].friction.emplace().limit = 3;
  });
  robot.frames(4);
  robot.widget("transfer/friction");
  REQUIRE(robot.found().model.gain);
  CHECK((*robot.found().model.gain)(0, 0) == Approx((*free.found().model.gain)(0, 0)));
  for (const auto& [tab, words] :
       {std::pair("study/modes", "modes/friction"), {"study/map", "map/friction"}}) {
    robot.click(tab);
    robot.frames(3);
    if (tab == std::string("study/map")) robot.click("map/hunting");
    robot.frames(3);
    robot.widget(words);
  }
}

TEST_CASE("where dry friction holds the state the model is of what it leaves free") {
  TransferRobot robot;
  edit(robot.app.session, "A block on a slope", [](Mechanism& m, Selection&) {
    m = read_scene(R"({"flyball": 2, "name": "Pendulum on a block on a slope", "gravity": [0, -10, 0],
      "bodies": [{"name": "block", "mass": 2, "position": [0, 0, 0]},
                 {"name": "bob", "mass": 1, "position": [0, -1, 0]}],
      "joints": [{"name": "slope", "type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0],
                  "axis": [1, 0.2, 0], "friction": {"limit": 20}},
                 {"name": "hinge", "type": "revolute", "bodies": ["block", "bob"], "at": [0, 0, 0],
                  "axis": [0, 0, 1], "damping": 0.2}]})");
  });
  robot.frames(8);
  REQUIRE_FALSE(robot.app.session.answer.solution.frictions.empty());
  CHECK(robot.found().model.held == std::vector<std::string>{"slope"});
  CHECK(robot.found().model.states.size() == 2); // of the pendulum
  robot.widget("transfer/friction");
}

TEST_CASE("another input and another output are chosen, and what has no model says why") {
  TransferRobot robot;
  robot.click("transfer/input"); // of many
  robot.frames(2);
  robot.type("torque(slide)");
  robot.frames(2);
  robot.click("transfer/input/torque(slide)");
  robot.frames(3);
  CHECK(robot.state().choice.input == "torque(slide)");
  const double compliance = (*robot.found().model.gain)(0, 0);
  CHECK(compliance > 0);
  robot.click("transfer/output");
  robot.click("transfer/output/rate(slide)");
  robot.frames(3);
  CHECK((*robot.found().model.gain)(0, 0) == Approx(0).margin(1e-12));
  REQUIRE(robot.found().has_zeros);
  REQUIRE(robot.found().zeros.size() == 1);
  CHECK(std::abs(robot.found().zeros[0]) < 1e-9);
  CHECK(robot.view().roots.curves.size() == 2);
  robot.click("transfer/output");
  robot.click("transfer/output/torque(spin)");
  robot.frames(3);
  CHECK(robot.found().model.outputs[0].unit == "N m");
  robot.state().choice.input = "joints.spin.drive.speed";
  robot.frames(3);
  CHECK_FALSE(robot.state().found.found);
  CHECK(robot.app.ui.widgets.count("transfer/problem") == 1);
  CHECK(robot.state().found.problem.find("feels the rate") != std::string::npos);
  CHECK(robot.app.ui.widgets.count("plot/transfer magnitude/area") == 0);
  robot.state().choice.output = "slide";
  robot.frames(3);
  CHECK(robot.found().model.refusal.empty());
}

TEST_CASE("a number that has no place in a model is told by its words") {
  TransferRobot robot("differential");
  robot.state().choice.input = "joints.case.drive.load";
  robot.frames(3);
  REQUIRE(robot.state().found.problem.find("joints.case.drive.load") != std::string::npos);
  CHECK(transfer_problem(robot.app.session).starts_with("The input load on case has no place"));
}

TEST_CASE("the model follows a number that a hand moves") {
  TransferRobot robot;
  const auto before = robot.found().model.poles.front();
  change_parameter(robot.app.session, "joints.slide.damping", 60);
  robot.frames(4);
  CHECK(robot.found().model.poles.front().real() < 1.8 * before.real());
  // Without a steady state there is none to be made; what was chosen stays.
  robot.app.session.study.transfer.choice.output = "rate(slide)";
  robot.click("study/close");
  robot.frames(2);
  CHECK_FALSE(robot.state().found.found);
  open_study(robot.app.session, StudyKind::transfer);
  robot.frames(3);
  CHECK(robot.state().choice.output == "rate(slide)");
  CHECK(robot.found().model.outputs[0].name == "rate(slide)");
}

TEST_CASE("an engine's governor has its shaft among the states") {
  TransferRobot robot("governor_engine");
  robot.state().choice = {"torque(spin)", "rate(spin)"};
  robot.frames(3);
  CHECK(robot.found().model.states.size() == 3);
  CHECK(robot.found().zeros.size() == 2);
  // Crosses on top of circles, which would hide them where one cancels the other.
  REQUIRE(robot.view().roots.curves.size() == 2);
  CHECK(robot.view().roots.curves[1].name == "poles");
}

TEST_CASE("the File menu exports the model of what is shown, whichever panel is open") {
  Robot robot({1400, 1000});
  App& app = robot.app;
  robot.frames(2);
  REQUIRE(app.session.study.open == StudyKind::none);
  REQUIRE(app.commands.enabled(command("file.model")));
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flyball_model_of_file_menu.m";
  std::filesystem::remove(file);
  app.commands.run("file.model");
  app.panels->model.query().path = file.string(); // before the field has it
  robot.frames(3);
  REQUIRE(app.dialog.showing);
  CHECK(app.session.study.open == StudyKind::transfer);
  CHECK(app.ui.widgets.contains("model/of"));
  robot.click("model/save");
  robot.frames(2);
  CHECK(app.session.notice == "Saved " + file.string());
  std::filesystem::remove(file);
}

TEST_CASE("the model is exported, by the ending of its name") {
  TransferRobot robot;
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  for (const char* name :
       {"flyball_model.m", "flyball_model.py", "flyball_model.json", "flyball_model.npz"}) {
    const std::filesystem::path file = folder / name;
    std::filesystem::remove(file);
    CHECK(robot.app.commands.enabled(command("file.model")));
    robot.app.commands.run("file.model");
    robot.app.panels->model.query().path = file.string(); // before the field has it
    robot.frames(3);
    robot.click("model/save");
    robot.frames(2);
    CHECK(robot.app.session.notice == "Saved " + file.string());
    CHECK(std::filesystem::file_size(file) > 200);
    std::filesystem::remove(file);
  }
  // Another ending gets MATLAB's.
  const std::filesystem::path file = folder / "flyball_model.x";
  robot.click("transfer/save");
  robot.click("model/cancel");
  robot.frames(2);
  robot.app.commands.run("file.model");
  robot.app.panels->model.query().path = file.string();
  robot.frames(3);
  robot.click("model/save");
  robot.frames(2);
  const std::string script = read_bytes(file.string() + ".m");
  CHECK(script.find("input_names = {'joints.spin.drive.speed'};") != std::string::npos);
  std::filesystem::remove(file.string() + ".m");
}

TEST_CASE("of what has no effect no gain and no phase are shown") {
  TransferRobot robot("governor");
  robot.state().choice = {"force_z(collar)", "slide"};
  robot.frames(3);
  REQUIRE(robot.found().model.inputs[0].name == "force_z(collar)");
  CHECK(robot.app.ui.widgets.contains("transfer/no effect"));
  CHECK_FALSE(robot.app.ui.widgets.contains("transfer/gain"));
  for (const Plot* plot : {&robot.view().magnitude, &robot.view().phase})
    for (const auto& point : plot->curves.at(0).points)
      CHECK(std::isnan(point[1]));
  CHECK_FALSE(robot.view().roots.curves.at(0).points.empty()); // the mechanism has its poles
}
