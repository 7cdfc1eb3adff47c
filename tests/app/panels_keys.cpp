// Whose keys are: a click that missed a field does no harm, and what lies over the document keeps them.
#include "app/render/imgui_compat.hpp"
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/session/number_text.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* speed = "joints.spin.drive.speed";

// What keys could have changed.
struct Look {
  Mode mode;
  Tool tool;
  StudyKind study;
  double azimuth, elevation;
  bool playing, ghost, snap;
  std::size_t step;
  std::vector<Part> selected;
  bool operator==(const Look&) const = default;
};

Look look(const App& app) {
  return {app.session.mode,
          app.tool.tool,
          app.session.study.open,
          app.view.camera.azimuth,
          app.view.camera.elevation,
          app.session.playback.playing,
          app.view.ghost,
          app.tool.snap,
          app.session.document.position(),
          app.session.selection().parts};
}

struct Hand : Robot {
  Hand() : Robot({1280, 1100}) {
    imgui_compat::map_key(ImGuiKey_Tab, keys::tab);
    set_mode(app.session, Mode::build);
    app.sizes.inspector_share = 0.9f;
    select(app.session, {{{PartKind::joint, "spin"}}});
    frames(2);
  }
  // Beside everything in the inspector.
  void miss_in_inspector() {
    const WidgetRect name = widget("inspector/name");
    click(ImVec2{name.to.x + 3, name.to.y + 1});
    REQUIRE(app.ui.fields.typing.name.empty());
  }
};

} // namespace

TEST_CASE("what is typed after a click that missed a field changes nothing") {
  Hand hand;
  hand.miss_in_inspector();
  const Look before = look(hand.app);
  hand.strike("150 rpm");
  hand.strike("-2.5e3");
  hand.key(keys::backspace);
  hand.key(keys::del);
  hand.key('A', true);
  hand.key('X', true);
  CHECK(look(hand.app) == before);
  CHECK_THAT(hand.app.session.notice, ContainsSubstring("the panel has the keys"));

  SECTION("wherever the pointer goes then") {
    hand.point(hand.widget("view").center());
    hand.strike("rpm");
    CHECK(look(hand.app) == before);
  }
  SECTION("until Escape is pressed, which does nothing else") {
    hand.key(key_escape);
    CHECK(look(hand.app) == before);
    hand.key('R');
    CHECK(hand.app.tool.tool == Tool::rotate);
    hand.key('1');
    CHECK(hand.app.view.camera.azimuth == 0);
  }
  SECTION("or the view is clicked") {
    hand.click(ImVec2{hand.widget("view").from.x + 150, hand.widget("view").to.y - 60});
    hand.key('J');
    CHECK(hand.app.tool.tool == Tool::joint);
  }
  SECTION("but undo and the like go on working") {
    hand.click("inspector/drive");
    CHECK(hand.app.session.document.position() == 1);
    hand.key('Z', true);
    CHECK(hand.app.session.document.position() == 0);
  }
}

TEST_CASE("after a click on a button of a panel keys are commands") {
  Hand hand;
  hand.miss_in_inspector();
  hand.key('K', false, true);
  REQUIRE(hand.app.tool.tool == Tool::select);
  hand.click("inspector/drive");
  hand.point(ImVec2{hand.widget("inspector/name").to.x + 3, hand.widget("inspector/name").to.y + 1});
  hand.key('K', false, true);
  CHECK(hand.app.tool.tool == Tool::block);
}

TEST_CASE("after Enter in a field keys are commands at once") {
  Hand hand;
  hand.double_click("inspector/drive/speed");
  hand.key('A', true);
  hand.type("12");
  hand.key(key_enter);
  hand.frames(2);
  REQUIRE(get_parameter(hand.app.session.mechanism(), speed) == 12);
  const bool view = GENERATE(true, false);
  if (view) hand.point(hand.widget("view").center());
  hand.key('K', false, true);
  CHECK(hand.app.tool.tool == Tool::block);
}

TEST_CASE("letters are commands while the pointer works in the view, digits only after a click there") {
  Hand hand;
  const double azimuth = hand.app.view.camera.azimuth;
  hand.miss_in_inspector();
  hand.key('J');
  CHECK(hand.app.tool.tool == Tool::select);
  hand.point(hand.widget("view").center());
  hand.key('J');
  CHECK(hand.app.tool.tool == Tool::joint);
  hand.key('1');
  CHECK(hand.app.view.camera.azimuth == azimuth);
}

TEST_CASE("among plots letters are commands, but not those of a number's unit") {
  Hand hand;
  open_study(hand.app.session, StudyKind::response);
  hand.frames(3);
  const WidgetRect close = hand.widget("study/close");
  hand.click(ImVec2{close.from.x - 30, close.center().y});
  SECTION("a letter") {
    hand.key('M');
    CHECK(hand.app.session.study.open == StudyKind::motion);
  }
  SECTION("a number") {
    const Look before = look(hand.app);
    hand.strike("150 rpm");
    hand.key(keys::del);
    CHECK(look(hand.app) == before);
  }
}

TEST_CASE("with the pointer still on a slider that it has moved letters are commands, a number is not") {
  Robot robot;
  robot.click(std::string("parameters/") + speed);
  robot.frames(30);
  REQUIRE(robot.app.session.document.position() == 1);
  SECTION("a letter") {
    robot.key('M');
    CHECK(robot.app.session.study.open == StudyKind::motion);
  }
  SECTION("a number") {
    for (const char key : {'1', '5', '0', ' ', 'R', 'P', 'M'})
      robot.key(key);
    CHECK(robot.app.session.study.open == StudyKind::none);
    CHECK(robot.app.session.document.position() == 1);
    CHECK_THAT(robot.app.session.notice, ContainsSubstring("the panel has the keys"));
  }
}

TEST_CASE("right after the start keys are commands wherever the pointer is") {
  Hand hand;
  hand.point(hand.widget("inspector/name").center());
  hand.key('J');
  CHECK(hand.app.tool.tool == Tool::joint);
}

TEST_CASE(
    "keys are commands for the part that was chosen in the list; beside its rows letters mean nothing") {
  Hand hand;
  float below = 0;
  for (const auto& [name, rect] : hand.app.ui.widgets)
    if (name.starts_with("outline/")) below = std::max(below, rect.to.y);
  const float x = hand.widget("outline/bodies/ball1").from.x;
  hand.click("outline/bodies/ball1");
  REQUIRE(hand.app.session.selection().parts == std::vector{Part{PartKind::body, "ball1"}});
  hand.click(ImVec2{x + 20, below + 15});
  hand.key('J');
  CHECK(hand.app.tool.tool == Tool::select);
  CHECK_THAT(hand.app.session.notice, ContainsSubstring("the panel has the keys"));
  hand.click("outline/bodies/ball1");
  const auto eye = hand.app.view.camera.eye();
  hand.key('1');
  hand.frames(60, 0.05);
  CHECK(hand.app.view.camera.eye() != eye);
  hand.key('H', false, true);
  CHECK_FALSE(hand.app.view.hidden.empty());
  hand.key('J');
  CHECK(hand.app.tool.tool == Tool::joint);
  hand.key(key_escape);
  hand.click("outline/bodies/ball1");
  hand.key(keys::del);
  CHECK(body_index(hand.app.session.mechanism(), "ball1") < 0);
}

TEST_CASE("a tick moves neither itself nor what was above it") {
  Hand hand;
  for (const char* joint : {"spin", "slide"}) {
    select(hand.app.session, {{{PartKind::joint, joint}}});
    hand.frames(3);
    for (const char* name : {"inspector/drive", "inspector/spring", "inspector/damper", "inspector/stop"}) {
      const std::map<std::string, WidgetRect, std::less<>> before(hand.app.ui.widgets.begin(),
                                                                  hand.app.ui.widgets.end());
      const float at = hand.widget(name).from.y;
      hand.click(name);
      hand.frames(3);
      INFO(joint << " " << name);
      CHECK(hand.widget(name).from.y == at);
      for (const auto& [other, rect] : hand.app.ui.widgets) {
        if (!other.starts_with("inspector/") || rect.from.y >= at) continue;
        INFO(other);
        const auto was = before.find(other);
        REQUIRE(was != before.end());
        CHECK(was->second.from.y == rect.from.y);
      }
      CHECK(hand.app.ui.widgets.contains("inspector/settles"));
    }
  }
}

TEST_CASE("the sheet of keys has the keys, and goes with Escape") {
  Hand hand;
  hand.key('?');
  hand.frames(2);
  REQUIRE(hand.app.panels->shortcuts.open);
  const Look before = look(hand.app);
  hand.key('P', true);
  hand.strike("mrj1 ");
  hand.key(keys::del);
  hand.key(keys::tab);
  CHECK(look(hand.app) == before);
  CHECK_FALSE(hand.app.panels->palette.showing());
  REQUIRE(hand.app.panels->shortcuts.open);
  const auto way = GENERATE(0, 1, 2, 3);
  if (way == 0) hand.key(key_escape);
  if (way == 1) hand.key('?');
  if (way == 2) hand.click("shortcuts/close");
  if (way == 3) hand.click(ImVec2{5, 400}); // beside it: that closes it and selects nothing behind
  hand.frames(2);
  CHECK_FALSE(hand.app.panels->shortcuts.open);
  CHECK(look(hand.app) == before);
  hand.key('?'); // and comes again
  hand.frames(2);
  CHECK(hand.app.panels->shortcuts.open);
}

TEST_CASE("a menu has the keys, and goes with Escape") {
  Hand hand;
  hand.click("menu/Edit");
  hand.frames(2);
  REQUIRE(hand.app.ui.widgets.contains("menu/edit.delete"));
  const Look before = look(hand.app);
  hand.strike("j1m");
  hand.key(keys::del);
  CHECK(look(hand.app) == before);
  REQUIRE(hand.app.ui.widgets.contains("menu/edit.delete"));
  hand.key(key_escape);
  hand.frames(2);
  CHECK_FALSE(hand.app.ui.widgets.contains("menu/edit.delete"));
  CHECK(look(hand.app) == before); // the selection, too
}

TEST_CASE("a list of choices goes with Escape and chooses nothing") {
  Hand hand;
  hand.click("inspector/type");
  hand.frames(2);
  REQUIRE(hand.app.ui.widgets.contains("inspector/type/universal"));
  const Look before = look(hand.app);
  hand.key('U');
  hand.key(key_escape);
  hand.frames(2);
  CHECK_FALSE(hand.app.ui.widgets.contains("inspector/type/universal"));
  CHECK(look(hand.app) == before);
}

TEST_CASE("dialogs and the palette have the keys, and go with Escape") {
  Hand hand;
  const auto what = GENERATE(0, 1, 2, 3);
  const Look before = look(hand.app);
  if (what == 0) hand.key('P', true);
  if (what == 1) hand.key('O', true, true);
  if (what == 2) hand.key('E', true);
  if (what == 3) hand.key('O', true);
  hand.frames(3);
  const auto open = [&] { return hand.app.panels->palette.showing() || hand.app.dialog.showing; };
  REQUIRE(open());
  hand.strike("jm1");
  hand.key(keys::del);
  CHECK(look(hand.app) == before);
  REQUIRE(open());
  for (int i = 0; i < 3 && open(); ++i) { // the first may be the field's
    hand.key(key_escape);
    hand.frames(2);
  }
  CHECK_FALSE(open());
  CHECK(look(hand.app) == before);
}

TEST_CASE("Enter goes ahead in Mirror and Circular copy, and in their fields ends typing") {
  Hand hand;
  App& app = hand.app;
  select(app.session, {{{PartKind::body, "ball1"}}});
  hand.frames(2);
  const std::string which = GENERATE("mirror", "circular");
  app.commands.run("edit." + which);
  hand.frames(3);
  REQUIRE(app.dialog.showing);
  const std::size_t bodies = app.session.mechanism().bodies.size();
  if (GENERATE(false, true)) {
    hand.click(which + "/point/x");
    hand.key('A', true);
    hand.type("0.1");
    hand.key(key_enter);
    hand.frames(3);
    CHECK(app.panels->copies.choice().point.x() == 0.1);
    REQUIRE(app.dialog.showing);
    CHECK(app.session.mechanism().bodies.size() == bodies);
  }
  hand.key(key_enter);
  hand.frames(3);
  CHECK_FALSE(app.dialog.showing);
  CHECK(app.session.mechanism().bodies.size() == bodies + (which == "mirror" ? 1 : 2));
}

TEST_CASE("a text that was refused stays, and what is typed then goes on at its end") {
  Hand hand;
  App& app = hand.app;
  hand.click("inspector/drive/speed");
  hand.key('A', true);
  hand.type("=6*(1+");
  hand.key(key_enter);
  hand.frames(3);
  REQUIRE_FALSE(app.ui.fields.typing.mistake.empty());
  hand.type("1)");
  hand.frames(1);
  CHECK(app.ui.fields.typing.text == "=6*(1+1)");
  hand.key(key_enter);
  hand.frames(3);
  CHECK(app.ui.fields.typing.name.empty());
}

TEST_CASE("a circular copy of more or fewer than there may be is refused, not made of another number") {
  Hand hand;
  App& app = hand.app;
  select(app.session, {{{PartKind::body, "ball1"}}});
  hand.frames(2);
  app.commands.run("edit.circular");
  hand.frames(3);
  const std::size_t bodies = app.session.mechanism().bodies.size();
  const auto count = [&](const std::string& text) {
    hand.click("circular/count");
    hand.key('A', true);
    hand.type(text);
    hand.key(key_enter);
    hand.frames(3);
  };
  for (const char* impossible : {"1", "101", "-4"}) {
    CAPTURE(impossible);
    count(impossible);
    CHECK(app.ui.widgets.contains("circular/refusal"));
    hand.click("circular/ok");
    hand.frames(2);
    hand.key(key_enter);
    hand.frames(2);
    REQUIRE(app.dialog.showing);
    CHECK(app.session.mechanism().bodies.size() == bodies);
  }
  count("4");
  CHECK_FALSE(app.ui.widgets.contains("circular/refusal"));
  hand.click("circular/ok");
  hand.frames(3);
  CHECK_FALSE(app.dialog.showing);
  CHECK(app.session.mechanism().bodies.size() == bodies + 3);
}

TEST_CASE("a new document gives the keys to the view") {
  Hand hand;
  App& app = hand.app;
  const bool ring = GENERATE(false, true); // the keys are at a field, too
  hand.click("inspector/drive/speed");
  hand.key('A', true);
  hand.type("12");
  hand.key(key_enter);
  hand.frames(3);
  undo(app.session); // nothing is unsaved
  hand.frames(2);
  if (ring) focus_widget(app.ui, "inspector/name");
  hand.frames(2);
  hand.key('N', true);
  hand.frames(3);
  REQUIRE(app.session.mechanism().bodies.empty());
  hand.strike("1");
  ImGui::GetIO().AddInputCharacter('R');
  hand.key('R', false, true);
  CHECK(app.tool.tool == Tool::rod);
  CHECK(app.view.camera.azimuth == 0);
  CHECK(app.session.mechanism().name == Document::empty_mechanism().name);
  CHECK_FALSE(app.ui.keyboard.ring);
}

TEST_CASE("further frames in the place of one hold no key longer") {
  Hand hand;
  const double before = ImGui::GetTime();
  for (int i = 0; i < 10; ++i)
    hand.stage.frame(hand.app, hand.size, 0, true);
  CHECK(ImGui::GetTime() - before < 1e-4);
  hand.stage.frame(hand.app, hand.size, 0.02);
  CHECK(ImGui::GetTime() - before > 0.019);
}

TEST_CASE("keys that come with the one that opens something do not pass it") {
  Hand hand;
  const Look before = look(hand.app);
  hand.app.ui.keys = {{'P', true, false}, {'J', false, false}, {'M', false, false}};
  hand.frames(3);
  CHECK(hand.app.panels->palette.showing());
  CHECK(look(hand.app) == before);
}

TEST_CASE("a double click on a slider types, and does not move the knob") {
  Robot robot;
  const std::string slider = std::string("parameters/") + speed;
  const std::uint64_t answers = robot.app.session.answer.ticket;
  robot.double_click(slider); // in the middle, away from the knob
  robot.frames(30);           // longer than a second click may take
  CHECK(get_parameter(robot.app.session.mechanism(), speed) == 11.0174);
  CHECK(robot.app.session.document.position() == 0);
  CHECK(robot.app.session.answer.ticket == answers);
  REQUIRE(robot.app.ui.fields.typing.name == slider + "/value");
  robot.type("120 rpm");
  robot.key(key_enter);
  CHECK(get_parameter(robot.app.session.mechanism(), speed) == Approx(4 * 3.141592653589793));
  CHECK(robot.app.session.document.position() == 1);
}

TEST_CASE("one click on a slider's track moves the knob there once it cannot become two") {
  Robot robot;
  const std::string slider = std::string("parameters/") + speed;
  robot.click(slider);
  CHECK(get_parameter(robot.app.session.mechanism(), speed) == 11.0174);
  robot.frames(30);
  CHECK(get_parameter(robot.app.session.mechanism(), speed) == Approx(15).epsilon(0.02));
  CHECK(robot.app.session.document.position() == 1);
  // On the knob a click moves nothing, not by the pixels between it and the middle either.
  const WidgetRect rect = robot.widget(slider);
  const double value = get_parameter(robot.app.session.mechanism(), speed);
  robot.click(ImVec2{rect.center().x + 3, rect.center().y});
  robot.frames(30);
  CHECK(get_parameter(robot.app.session.mechanism(), speed) == value);
}

TEST_CASE("a double click in a field selects the number and not its unit") {
  Hand hand;
  select(hand.app.session, {{{PartKind::body, "ball1"}}});
  hand.frames(2);
  const std::string field = "inspector/position/y";
  REQUIRE(hand.app.session.mechanism().bodies[1].position.y() != 0.5);
  const WidgetRect rect = hand.widget(field);
  // On the digits, beyond them, where the unit is shown: anywhere in the field.
  const float share = GENERATE(0.03f, 0.1f, 0.2f, 0.5f, 0.97f);
  hand.point({rect.from.x + share * (rect.to.x - rect.from.x), rect.center().y});
  for (int i = 0; i < 4; ++i) {
    ImGui::GetIO().MouseDown[0] = i % 2 == 0;
    hand.frames(1);
  }
  hand.frames(2);
  hand.type("0.5");
  CHECK(hand.app.ui.fields.typing.text == "0.5 m");
  hand.key(key_enter);
  const int ball = body_index(hand.app.session.mechanism(), "ball1");
  CHECK(hand.app.session.mechanism().bodies[static_cast<std::size_t>(ball)].position.y() == 0.5);
}

TEST_CASE("the number that is meant in a typed quantity") {
  const auto meant = [](std::string_view text, std::size_t at) {
    const auto [from, to] = number_at(text, at);
    return std::string(text.substr(from, to - from));
  };
  CHECK(meant("2 m", 0) == "2");
  CHECK(meant("2 m", 3) == "2");
  CHECK(meant("-0.25 m", 6) == "-0.25");
  CHECK(meant("9.80665 m/s^2", 13) == "9.80665");
  CHECK(meant("1.5e-3 kg m^2", 9) == "1.5e-3");
  CHECK(meant("160 mm + 20 mm", 5) == "160");
  CHECK(meant("160 mm + 20 mm", 14) == "20");
  CHECK(meant("2*-3 m", 6) == "-3");
  CHECK(meant("m", 1).empty());
  CHECK(meant("", 0).empty());
}

TEST_CASE("a number typed with its unit over the number alone drives the former unit out") {
  Hand hand;
  select(hand.app.session, {{{PartKind::body, "ball1"}}});
  hand.frames(2);
  const auto ball = [&] { return hand.app.session.mechanism().bodies[1]; };
  REQUIRE(ball().name == "ball1");
  const auto type_over = [&](const char* field, const char* typed) {
    hand.frames(40); // or it would be a triple click
    hand.point({hand.widget(field).from.x + 8, hand.widget(field).center().y});
    for (int i = 0; i < 4; ++i) {
      ImGui::GetIO().MouseDown[0] = i % 2 == 0;
      hand.frames(1);
    }
    hand.frames(2);
    hand.type(typed);
  };
  type_over("inspector/mass", "1 kg");
  CHECK(hand.app.ui.fields.typing.text == "1 kg kg");
  CHECK(hand.app.ui.fields.typing.mistake.empty());
  hand.key(key_enter);
  CHECK(ball().mass == 1);
  type_over("inspector/mass", "1500 g");
  hand.key(key_enter);
  CHECK(ball().mass == 1.5);
  type_over("inspector/position/y", "21 cm");
  hand.key(key_enter);
  CHECK(ball().position.y() == Approx(0.21));
  // What makes no sense without it either is still refused.
  type_over("inspector/mass", "2 m");
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("Expected a mass"));
  hand.key(key_escape);
  CHECK(ball().mass == 1.5);
}

TEST_CASE(
    "after a key that was a command in the view the next is one, too, whatever came under the pointer") {
  Robot robot({1280, 900});
  App& app = robot.app;
  robot.key(keys::tab);
  REQUIRE(app.session.mode == Mode::build);
  float below = 0;
  for (const auto& [name, rect] : robot.app.ui.widgets)
    if (name.starts_with("outline/")) below = std::max(below, rect.to.y);
  robot.click(ImVec2{robot.widget("outline/bodies/ball1").center().x, below + 15});
  // Where the motion's panel will be.
  const WidgetRect view = robot.widget("view");
  robot.point({view.center().x, view.to.y - 60});
  robot.key('M');
  REQUIRE(app.session.study.open == StudyKind::motion);
  REQUIRE(app.session.playback.playing);
  robot.key(' ');
  CHECK_FALSE(app.session.playback.playing);
  CHECK(app.session.notice.find("the panel has the keys") == std::string::npos);
  // A number that is begun among its fields is none all the same.
  robot.key('1');
  robot.key('M');
  CHECK(app.session.study.open == StudyKind::motion);
  CHECK_THAT(app.session.notice, ContainsSubstring("the panel has the keys"));
}

TEST_CASE("no line of the sheet of keys is cut") {
  const int width = GENERATE(1280, 1060, 900, 800, 480);
  Robot robot({width, 800});
  robot.key('?');
  robot.frames(3);
  const auto window = static_cast<float>(width);
  const float right = window / 2 + std::min(1180.f, window - 20) / 2; // the sheet's
  int lines = 0;
  for (const auto& [name, rect] : robot.app.ui.widgets)
    if (name.starts_with("shortcuts/") && name != "shortcuts/close") {
      INFO(name);
      CHECK(rect.to.x <= right - 21);       // what is cut ends at the rim
      CHECK(rect.to.y - rect.from.y < 101); // five lines: no word is broken
      ++lines;
    }
  if (width < 900) return; // the rest is scrolled to
  CHECK(lines > 40);
  CHECK(robot.widget("shortcuts/Digits while placing").to.y < robot.widget("shortcuts/close").to.y);
}

TEST_CASE("in a small window the words beside keys are whole") {
  Robot robot({900, 600});
  robot.app.panels->shortcuts.open = true;
  robot.frames(4);
  int seen = 0;
  for (const auto& [name, rect] : robot.app.ui.widgets) {
    if (!name.starts_with("shortcuts/") || name == "shortcuts/close") continue;
    CAPTURE(name);
    ++seen;
    CHECK(rect.to.y - rect.from.y < 3.7f * ImGui::GetFontSize()); // three lines at most
  }
  CHECK(seen > 20);
}
