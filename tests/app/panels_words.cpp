// Words and numbers where they are read: whole, beside what they are about, and in the way of nothing.
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/document/formula_edits.hpp"
#include "app/session/periodic.hpp"
#include "app/session/state_words.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/report/messages.hpp"
#include "slider_crank.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <imgui_internal.h>

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

// The tooltip that is shown.
const ImGuiWindow* tooltip() {
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Active && (window->Flags & ImGuiWindowFlags_Tooltip)) return window;
  return nullptr;
}

int pixels_like(const Image& image, const WidgetRect& within, const ImVec4& color) {
  int count = 0;
  for (int y = static_cast<int>(within.from.y); y < static_cast<int>(within.to.y); ++y)
    for (int x = static_cast<int>(within.from.x); x < static_cast<int>(within.to.x); ++x) {
      const std::uint8_t* p = image.at(x, y);
      const auto near = [](std::uint8_t byte, float part) {
        return std::abs(static_cast<float>(byte) - 255 * part) < 12;
      };
      count += near(p[0], color.x) && near(p[1], color.y) && near(p[2], color.z);
    }
  return count;
}

} // namespace

TEST_CASE("where the engine names a command of the terminal the window names its own") {
  OtherStates none, few;
  few.searched = true;
  few.end = SearchEnd::time;
  for (const OtherStates& others : {none, few}) {
    Solution solution;
    solution.message = "Not converged. " + message(others, Status::not_converged);
    INFO(solution.message);
    REQUIRE(solution.message.find("--all") != std::string::npos);
    CHECK(window_message(solution).find("the tab States looks for") != std::string::npos);
    CHECK(window_message(solution).find("--") == std::string::npos);
  }
}

TEST_CASE("lines are broken at blanks, never within a number") {
  const Robot robot;
  const std::string text = "Dies out within 0.0046 s, below 0.0011 s;\nor it does not (1.5e-3).";
  for (float width = 10; width < 400; width += 3) {
    const std::string lines = in_lines(text, width);
    std::string back = lines;
    std::ranges::replace(back, '\n', ' ');
    std::string plain = text;
    std::ranges::replace(plain, '\n', ' ');
    CHECK(back == plain);
    // None is wider than asked for but words by themselves.
    for (std::size_t at = 0; at < lines.size();) {
      const std::size_t end = std::min(lines.find('\n', at), lines.size());
      const std::string line = lines.substr(at, end - at);
      if (line.find(' ') != std::string::npos) CHECK(ImGui::CalcTextSize(line.c_str()).x <= width + 1);
      at = end + 1;
    }
  }
  CHECK(in_lines(text, 1e6f) == text);
}

TEST_CASE("a slider's label is whole beside what its row needs, with a number that was moved, too") {
  Robot robot({1200, 760});
  App& app = robot.app;
  open_scene(app.session, shipped_file("governor_engine"));
  robot.frames(2);
  change_parameter(app.session, "joints.slide.damping", 15);
  robot.frames(3);
  const std::string slider = "parameters/joints.slide.damping";
  const float label = robot.widget(slider + "/reset").from.x - robot.widget(slider).from.x;
  CHECK(label >= ImGui::CalcTextSize("slide").x + 6 * app.ui.scale + ImGui::CalcTextSize("damping").x);
  CHECK(robot.widget(slider + "/value").from.x >= robot.widget(slider + "/reset").to.x);
  CHECK(robot.widget(slider + "/gear").from.x >= robot.widget(slider + "/value").to.x);
}

TEST_CASE("the help of a study's tab covers nothing of the study") {
  Robot robot({1280, 900});
  open_study(robot.app.session, StudyKind::response);
  robot.frames(3);
  const WidgetRect tab = robot.widget("study/states");
  robot.point(tab.center());
  robot.frames(200);
  REQUIRE(tooltip());
  CHECK(tooltip()->Pos.y + tooltip()->Size.y <= tab.from.y);
  // Pressed, it has said what there was to say, until the pointer comes again.
  robot.click("study/states");
  robot.frames(200);
  CHECK_FALSE(tooltip());
  robot.point({tab.center().x, tab.center().y + 200});
  robot.frames(2);
  robot.point(tab.center());
  robot.frames(200);
  CHECK(tooltip());
}

TEST_CASE("where nothing resists the chip says it as the results do") {
  Robot robot({1280, 900});
  App& app = robot.app;
  Mechanism m = Document::empty_mechanism();
  add_body(m, {.at = {0.2, 0, 0}});
  add_joint(m, JointType::revolute, {"ground", "ball1"}, Vec3::Zero(), Vec3::UnitY());
  open_document(app.session, Document(m));
  robot.frames(3);
  REQUIRE(converged(app.session));
  REQUIRE(app.session.answer.solution.stability_reason == StabilityReason::neutral);
  const Image picture = robot.picture();
  const WidgetRect& chip = robot.widget("status");
  CHECK(pixels_like(picture, chip, colors_of(app.ui).good) > 3);
  CHECK(pixels_like(picture, chip, colors_of(app.ui).warn) == 0);
}

TEST_CASE("a limit cycle found in a steady state's place is what the chip and the results begin with") {
  Robot robot({1280, 900});
  App& app = robot.app;
  Mechanism m = Document::empty_mechanism();
  add_driven_slider_crank(m, 20);
  const std::string crank = m.joints.front().name;
  m.joints.front().coordinates.front().drive->torque = 60;
  set_expression(m, "joints." + crank + ".drive.load", "3 N m s*rate(" + crank + ")");
  open_document(app.session, Document(m));
  robot.frames(3);
  const auto pixels = [&](const char* widget, const ImVec4& color) {
    return pixels_like(robot.picture(), robot.widget(widget), color);
  };
  const ImVec4 good = colors_of(app.ui).good, bad = colors_of(app.ui).bad;
  REQUIRE(pixels("status", bad) > 3);
  REQUIRE(pixels("results/verdict", bad) > 3);
  robot.click("results/cycle");
  robot.point({1, 1});
  robot.frames(3);
  REQUIRE(cycle_instead(app.session));
  REQUIRE(cycle_instead(app.session)->stable == true);
  CHECK(pixels("status", good) > 3);
  CHECK(pixels("status", bad) == 0);
  CHECK(pixels("results/verdict", good) > 3);
  CHECK(pixels("results/verdict", bad) == 0);
  robot.click("results/cycle");
  robot.frames(3);
  CHECK_FALSE(cycle_instead(app.session));
  CHECK(pixels("status", bad) > 3);
}

TEST_CASE("all types of a joint are in sight in their list") {
  Robot robot({1280, 900});
  set_mode(robot.app.session, Mode::build);
  select(robot.app.session, {{{PartKind::joint, "arm1"}}});
  robot.frames(3);
  robot.click("inspector/type");
  robot.frames(2);
  const WidgetRect &first = robot.widget("inspector/type/revolute"),
                   &last = robot.widget("inspector/type/distance");
  CHECK(last.to.y - last.from.y == Approx(first.to.y - first.from.y));
}

TEST_CASE("the buttons of the motion's line stand in one line") {
  Robot robot({1280, 900});
  robot.app.session.motion.duration = 0.2;
  open_study(robot.app.session, StudyKind::response);
  robot.frames(3);
  const float top = robot.widget("study/close").from.y;
  robot.key('M');
  robot.frames(3);
  CHECK(robot.widget("study/close").from.y == top);
  CHECK(robot.widget("motion/first").from.y == top);
}

TEST_CASE("the toolbar's views stay where they are between Build and Explore") {
  Robot robot({1280, 900});
  const float explore = robot.widget("toolbar/front").from.x;
  set_mode(robot.app.session, Mode::build);
  robot.frames(2);
  CHECK(robot.widget("toolbar/front").from.x == explore);
}

TEST_CASE("in a small window the theme's button stays, and what is left out is in the menu") {
  const int width = GENERATE(640, 800, 900, 1280);
  Robot robot({width, 600});
  const auto within = [&](const WidgetRect& rect, float size) {
    return rect.to.x <= static_cast<float>(width) && rect.to.x - rect.from.x >= size;
  };
  CHECK(within(robot.widget("toolbar/theme"), 20));
  for (const char* name : {"toolbar/ghost", "toolbar/grid", "toolbar/shadow", "toolbar/front", "toolbar/iso"})
    if (robot.app.ui.widgets.contains(name)) {
      INFO(name);
      CHECK(robot.widget(name).to.x <= robot.widget("toolbar/theme").from.x);
    }
  CHECK(robot.app.ui.widgets.contains("toolbar/shadow") == (width >= 900));
}

TEST_CASE("where the legend would cover a fifth of the view, it folds until it is asked for") {
  Robot robot({800, 600});
  App& app = robot.app;
  app.view.loads = true;
  open_study(app.session, StudyKind::response);
  robot.frames(3);
  CHECK_FALSE(app.ui.widgets.contains("legend/0"));
  robot.click("legend");
  robot.frames(2);
  CHECK(app.ui.widgets.contains("legend/0"));
  robot.frames(30); // else it would be a double click
  robot.click("legend");
  robot.frames(2);
  CHECK_FALSE(app.ui.widgets.contains("legend/0"));
  CHECK(app.view.legend); // of larger views
}

TEST_CASE("a number and its unit stand on one line, however narrow a paragraph is") {
  Robot robot;
  robot.frames(2);
  const std::string text =
      "It hunts: swings at 6.02 Hz double every 0.0349 s. Damping of 1e-3 N m s, not 5\nm or 7 of it.";
  std::size_t fewest = text.size(), most = 0;
  for (float width = 90; width < 600; width += 3) {
    const std::string lines = in_lines(text, width);
    CAPTURE(width, lines);
    for (const char* whole : {"6.02 Hz", "0.0349 s.", "1e-3 N m s,", "5\nm"})
      CHECK(lines.find(whole) != std::string::npos);
    const auto count = static_cast<std::size_t>(std::ranges::count(lines, '\n'));
    fewest = std::min(fewest, count);
    most = std::max(most, count);
  }
  CHECK(fewest <= 2);
  CHECK(most >= 8);
}
