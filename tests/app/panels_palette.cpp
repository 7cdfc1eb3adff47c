// The palette finds commands, parts and numbers, and sets numbers.
#include "robot.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/session/fuzzy_match.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/panels/palette_entries.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* spin_speed = "joints.spin.drive.speed";

struct Finder : Robot {
  Finder() : Robot({1280, 900}) {}
  void find(const std::string& text) {
    key('P', true);
    frames(2);
    REQUIRE(app.panels->palette.showing());
    type(text);
    frames(2);
  }
  const PaletteEntry& entry(std::size_t i = 0) {
    const std::vector<PaletteEntry>& found = app.panels->palette.found();
    REQUIRE(found.size() > i);
    return found[i];
  }
};

std::string marked(std::string_view typed, const std::string& name) {
  std::string letters;
  for (const std::size_t i : fuzzy_match(typed, name).marks)
    letters += name[i];
  return letters;
}

} // namespace

TEST_CASE("names answer by beginnings, initials and words in any order") {
  const auto score = [](const char* typed, const char* name) { return fuzzy_match(typed, name).score; };
  CHECK(score("ball1", "ball1") > score("ball1", "mass of ball1"));
  CHECK(score("spe", "speed of spin") > score("spe", "free speed"));
  CHECK(score("spin", "speed of spin") > score("spin", "spindle"));
  CHECK(score("spin", "spindle") > score("spin", "mass of spindle"));
  CHECK(fuzzy_match("spin", "spindle and spin").marks == std::vector<std::size_t>{12, 13, 14, 15});
  CHECK(score("spin speed", "speed of spin") > 0);
  CHECK(score("sos", "speed of spin") > 0);
  CHECK(score("SPIN", "speed of spin") == score("spin", "speed of spin"));
  CHECK(score("in", "spin") < score("in", "insert"));
  CHECK(score("xyz", "speed of spin") < 0);
  CHECK(score("nips", "speed of spin") < 0);
  CHECK(score("", "anything") == 0);
  CHECK(fuzzy_match("spring stiffness of slide", "stiffness of slide", "joints slide spring stiffness"));
  CHECK(marked("sos", "speed of spin") == "sos");
  CHECK(fuzzy_match("sos", "speed of spin").marks == std::vector<std::size_t>{0, 6, 9});
  CHECK(marked("slide stiff", "stiffness of slide") == "stiffslide");
}

TEST_CASE("a part that is found is selected and brought into view") {
  Finder robot;
  App& app = robot.app;
  const ViewCamera before = app.view.camera;
  robot.find("ball1");
  CHECK(robot.entry().name == "part/body/ball1");
  robot.key(key_enter);
  robot.frames(2);
  CHECK_FALSE(app.panels->palette.showing());
  CHECK(app.session.selection().parts == std::vector{Part{PartKind::body, "ball1"}});
  CHECK(app.view.camera.distance <= before.distance * (1 + 1e-9));
  const int ball = body_index(app.session.mechanism(), "ball1");
  const ImVec2 at = robot.pixel(app.session.poses[static_cast<std::size_t>(ball)].position);
  const WidgetRect view = robot.widget("view");
  const ImVec2 middle = view.center();
  CHECK(std::abs(at.x - middle.x) < 160); // its arm, too, is in view
  CHECK(std::abs(at.y - middle.y) < 160);
  // And the spindle that it hangs on, from end to end.
  for (const double height : {0.23, -0.08}) {
    const ImVec2 end = robot.pixel(Vec3(0, height, 0));
    CHECK((end.x > view.from.x && end.x < view.to.x));
    CHECK((end.y > view.from.y && end.y < view.to.y));
  }
}

TEST_CASE("a small part that is found stands in the middle of what it is joined to") {
  Finder robot;
  robot.find("arm1");
  REQUIRE(robot.entry().name == "part/joint/arm1");
  robot.key(key_enter);
  robot.frames(3);
  const WidgetRect view = robot.widget("view");
  const ImVec2 at = robot.pixel(Vec3(0, 0.2, 0));
  CHECK(at.x == Approx(view.center().x).margin(20));
  CHECK(at.y == Approx(view.center().y).margin(20));
  const ImVec2 foot = robot.pixel(Vec3(0, -0.08, 0));
  CHECK(foot.y > view.center().y + 50);
  CHECK(foot.y < view.to.y);
}

TEST_CASE("the number that one moves comes right after the part, before parts that begin alike") {
  Finder robot;
  robot.find("spin"); // "spindle" begins so, too
  CHECK(robot.entry().name == "part/joint/spin");
  CHECK(robot.entry(1).address == spin_speed);
  robot.key(key_escape);
  robot.frames(2);
  robot.find("slide"); // of its numbers those with sliders
  CHECK(robot.entry().name == "part/joint/slide");
  for (std::size_t i = 1; i <= 2; ++i)
    CHECK(std::ranges::find(robot.app.session.parameters, robot.entry(i).address,
                            &ParameterControl::address) != robot.app.session.parameters.end());
}

TEST_CASE("a spring that only damps is called a damper") {
  Finder robot;
  edit(robot.app.session, "Build", [](Mechanism& next, Selection&) {
    Force& force = next.forces.emplace_back();
    force.name = "dashpot";
    force.type = ForceType::spring;
    force.bodies = {"ground", "ball1"};
    force.points = {Vec3(0, 1, 0), Vec3(0, 0, 0)};
    force.damping = 2;
  });
  robot.find("dashpot");
  CHECK(robot.entry().about.starts_with("damper:"));
}

TEST_CASE("the speed that a torque is searched from is found as what it is") {
  Finder robot;
  open_document(robot.app.session, Document(shipped("governor_engine")));
  robot.frames(2);
  robot.find("guessed speed");
  CHECK(robot.entry().title == "guessed speed of spin");
  CHECK(robot.entry().address == spin_speed);
}

TEST_CASE("in another document its own parts and numbers are found") {
  Finder robot;
  App& app = robot.app;
  robot.find("ball1");
  robot.key(key_escape);
  robot.frames(2);
  const auto revision = app.session.document.revision();
  open_document(app.session, Document(shipped("pendulum")));
  REQUIRE(app.session.document.revision() == revision); // they begin anew
  robot.frames(2);
  robot.find("arm");
  CHECK(robot.entry().name.starts_with("part/"));
  for (const PaletteEntry& entry : app.panels->palette.found())
    CHECK(entry.name.find("ball") == std::string::npos);
}

TEST_CASE("a number that is found has its value and unit, and its slider or field gets the keys") {
  Finder robot;
  App& app = robot.app;
  SECTION("a slider") {
    robot.find("spring stiffness of slide");
    CHECK(robot.entry().address == "joints.slide.spring.stiffness");
    CHECK(robot.entry().right == "1000 N/m");
    robot.key(key_enter);
    robot.frames(6);
    CHECK(app.ui.keyboard.at == "parameters/joints.slide.spring.stiffness");
    CHECK(has_keyboard(app.ui, app.ui.keyboard.at));
  }
  SECTION("a slider of a group that was closed, whichever it is") {
    const auto [group, words, address] = GENERATE(table<const char*, const char*, const char*>(
        {{"parameters/drives", "speed of spin", spin_speed},
         {"parameters/springs", "spring stiffness of slide", "joints.slide.spring.stiffness"}}));
    edit(app.session, "Unpin", [](Mechanism& mechanism, Selection&) { mechanism.sliders.clear(); });
    robot.frames(2);
    robot.click(group);
    robot.frames(2);
    const std::string slider = std::string("parameters/") + address;
    REQUIRE_FALSE(app.ui.widgets.contains(slider));
    robot.find(words);
    REQUIRE(robot.entry().address == address);
    robot.key(key_enter);
    robot.frames(6);
    CHECK(app.ui.widgets.contains(slider));
    CHECK(app.ui.keyboard.at == slider);
  }
  SECTION("a field of a part that was not selected, in a section that was closed") {
    robot.find("mass of ball1");
    CHECK(robot.entry().right == "1 kg");
    robot.key(key_enter);
    robot.frames(8);
    CHECK(app.ui.keyboard.at == "inspector/mass");
    CHECK(app.session.selection().parts == std::vector{Part{PartKind::body, "ball1"}});
  }
}

TEST_CASE("a number behind its name is shown as what would be set, and set by Enter") {
  Finder robot;
  App& app = robot.app;
  const auto [typed, wanted] = GENERATE(table<const char*, double>(
      {{"speed of spin 15 rad/s", 15.0}, {"spin 15", 15.0}, {"spin 150 rpm", 5 * 3.14159265358979}}));
  const double before = get_parameter(app.session.mechanism(), spin_speed);
  robot.find(typed);
  CHECK(robot.entry().address == spin_speed);
  REQUIRE(robot.entry().value);
  CHECK(*robot.entry().value == Approx(wanted));
  CHECK_THAT(robot.entry().right, ContainsSubstring("→"));
  CHECK(get_parameter(app.session.mechanism(), spin_speed) == before); // not yet
  robot.key(key_enter);
  robot.frames(2);
  CHECK(get_parameter(app.session.mechanism(), spin_speed) == Approx(wanted));
  CHECK_THAT(app.session.notice, ContainsSubstring("speed of spin"));
  robot.key('Z', true);
  CHECK(get_parameter(app.session.mechanism(), spin_speed) == before);
}

TEST_CASE("Enter does nothing before something is typed or an arrow chooses") {
  Finder robot;
  App& app = robot.app;
  const auto revision = app.session.document.revision();
  robot.find("");
  SECTION("at first") {
    robot.key(key_enter);
    CHECK(app.panels->palette.showing());
    CHECK(app.session.document.revision() == revision);
    CHECK_FALSE(app.session.mechanism().bodies.empty()); // the first row is "New"
  }
  SECTION("nor where all that was typed is gone again") {
    imgui_compat::map_key(ImGuiKey_Backspace, keys::backspace);
    robot.type("g");
    robot.frames(2);
    REQUIRE(app.panels->palette.chosen() == 0);
    imgui_compat::set_key(keys::backspace, true);
    robot.frames(2);
    imgui_compat::set_key(keys::backspace, false);
    robot.frames(2);
    REQUIRE(robot.entry().name == "file.new");
    robot.key(key_enter);
    CHECK(app.panels->palette.showing());
    CHECK_FALSE(app.session.mechanism().bodies.empty());
  }
  SECTION("an arrow down chooses the first, up the last") {
    const bool down = GENERATE(true, false);
    const std::vector<PaletteEntry>& found = app.panels->palette.found();
    robot.key(down ? keys::down : keys::up);
    robot.frames(2);
    CHECK(app.panels->palette.chosen() == (down ? 0 : static_cast<int>(found.size()) - 1));
    if (!down) return; // what cannot be done now is left alone
    robot.key(key_enter);
    CHECK_FALSE(app.panels->palette.showing());
    CHECK(app.session.mechanism().bodies.empty()); // "New"
  }
}

TEST_CASE("what is typed and Enter in one frame takes what was typed, not what was listed before") {
  Finder robot;
  App& app = robot.app;
  robot.find("");
  const bool grid = app.view.grid;
  ImGui::GetIO().AddInputCharactersUTF8("grid");
  robot.key(key_enter);
  CHECK_FALSE(app.panels->palette.showing());
  CHECK(app.view.grid != grid);
  CHECK_FALSE(app.session.mechanism().bodies.empty());
}

TEST_CASE("commands are found by what they show, and what is not possible says what it waits for") {
  Finder robot;
  const auto asked = GENERATE(table<const char*, const char*>({{"hunting", "study.map"},
                                                               {"droop", "study.response"},
                                                               {"eigenvalues", "study.modes"},
                                                               {"resonance", "study.response"},
                                                               {"tutorial", "file.examples"}}));
  const char* const command = std::get<1>(asked);
  robot.find(std::get<0>(asked));
  const std::vector<PaletteEntry>& found = robot.app.panels->palette.found();
  CHECK(std::ranges::any_of(found, [&](const PaletteEntry& entry) { return entry.name == command; }));
  robot.key(key_escape);
  robot.frames(2);
  robot.find("Export the run");
  REQUIRE(robot.entry().name == "study.export");
  CHECK(robot.entry().about == "Not now: no motion is shown; M computes one.");
}

TEST_CASE("what was used last comes first, and all commands without a word") {
  Finder robot;
  robot.find("");
  const std::vector<PaletteEntry> all = robot.app.panels->palette.found();
  for (const Command& command : commands())
    CHECK(std::ranges::any_of(all, [&](const PaletteEntry& entry) { return entry.name == command.id; }));
  robot.key(key_escape);
  robot.frames(2);
  robot.find("ghost");
  REQUIRE(robot.entry().name == "view.ghost");
  robot.key(key_enter);
  robot.frames(2);
  robot.find("ball1");
  robot.key(key_enter);
  robot.frames(2);
  robot.find("");
  CHECK(robot.entry(0).name == "part/body/ball1");
  CHECK(robot.entry(1).name == "view.ghost");
}

TEST_CASE("gears are among what can be inserted, and say what to select for them") {
  Robot robot;
  for (const char* id : {"insert.gear", "insert.belt", "insert.rack", "insert.screw"}) {
    const Command& gear = command(id);
    CHECK_FALSE(robot.app.commands.enabled(gear));
    CHECK_THAT(robot.app.commands.about(gear), ContainsSubstring("Not now: select "));
  }
  CHECK(robot.app.commands.about(command("insert.ball")) == command("insert.ball").help);
}

TEST_CASE("a whole word of what a command does goes before letters that are scattered over a name") {
  const int word = fuzzy_match("free", "Forces", "with one body chosen, its free-body diagram").score,
            scattered = fuzzy_match("free", "From the side", "Look from the right.").score;
  CHECK(word > scattered);
  // First letters of words are no scattered ones.
  CHECK(fuzzy_match("sos", "speed of spin", "").score > word);
}

TEST_CASE("a command that is not possible now comes before what has its letters somewhere") {
  Finder robot;
  REQUIRE_FALSE(robot.app.commands.enabled(command("study.cycle")));
  robot.find("limit");
  CHECK(robot.entry().name == "study.cycle");
  robot.key(key_escape);
  robot.frames(2);
  robot.find("save"); // what is possible comes first among what answers alike
  CHECK(robot.entry().enabled);
}
