// The card of a joint stays under the hand, keeps what was chosen, and hides nothing that is written.
#include "app/document/create.hpp"
#include "app/ui/tools/joint_guess.hpp"
#include "app/ui/tools/tools.hpp"
#include "robot.hpp"
#include "slider_crank.hpp"
#include "tests/catch.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <vector>

using namespace flyball;
using namespace flyball::test;

namespace {

using Pair = std::array<std::string, 2>;

// One metre in view, and the joint's tool in hand.
struct SliderCrank : Robot {
  explicit SliderCrank(PixelSize window = {1440, 900}) : Robot(window) {
    begin_empty(1);
    edit(app.session, "Build", [](Mechanism& next, Selection&) { add_slider_crank(next); });
    frames(2);
    key('J');
  }
  void begin(const Vec3& at) {
    click_at(at);
    frames(2); // the card takes a moment to know its size
    REQUIRE(app.tool.joint);
  }
  void choose(const std::string& combo, const std::string& item) {
    click(combo);
    click(combo + "/" + item);
    frames(2);
  }
};

bool under_card(Robot& robot, const Vec3& at) {
  const ImGuiWindow* card = ImGui::FindWindowByName("joint");
  REQUIRE(card);
  const ImVec2 point = robot.pixel(at);
  return point.x > card->Pos.x && point.x < card->Pos.x + card->Size.x && point.y > card->Pos.y &&
         point.y < card->Pos.y + card->Size.y;
}

// One of these that can be clicked.
Vec3 beside_card(Robot& robot, const std::vector<Vec3>& places) {
  const auto found = std::ranges::find_if(places, [&](const Vec3& at) { return !under_card(robot, at); });
  REQUIRE(found != places.end());
  return *found;
}

} // namespace

TEST_CASE("two bodies that are joined already are not offered again") {
  SliderCrank d;
  d.begin(slider_crank_pin);
  CHECK(d.app.tool.joint->bodies == Pair{"ground", "block1"});
}

TEST_CASE("a bearing may lie where a joint is") {
  SliderCrank d;
  set_tool(d.app.session, d.app.ui, d.app.tool, Tool::bearing);
  d.frames(1);
  d.begin(slider_crank_pin);
  CHECK(d.app.tool.joint->bodies == Pair{"rod2", "block1"});
}

TEST_CASE("the button of the card stays where it is when fewer axes are offered") {
  SliderCrank d;
  d.begin(slider_crank_pin);
  d.choose("tools/parent", "rod2");
  const WidgetRect join = d.widget("tools/join");
  d.choose("tools/parent", "ground");
  CHECK(d.app.tool.joint->bodies == Pair{"ground", "block1"});
  CHECK(d.widget("tools/join").from.x == join.from.x);
  CHECK(d.widget("tools/join").from.y == join.from.y);
  d.click(join.center());
  CHECK(d.app.session.mechanism().joints.size() == 4);
}

TEST_CASE("what was chosen in the card stays when its point is moved") {
  SliderCrank d;
  d.begin(slider_crank_pin);
  d.choose("tools/parent", "rod1");
  d.click("tools/axis/x");
  using Places = std::vector<Vec3>;
  for (const Places& places : {Places{{-0.2, -0.2, 0}, {-0.2, 0.3, 0}, {0.2, 0.4, 0}, {0.4, -0.3, 0}},
                               Places{slider_crank_pin, {0.4, 0.3, 0}, {-0.3, 0.4, 0}, {0.2, -0.4, 0}}}) {
    const Vec3 at = beside_card(d, places);
    d.begin(at);
    CHECK(d.app.tool.joint->bodies == Pair{"rod1", "block1"});
    CHECK(d.app.tool.joint->axis == Vec3::UnitX());
    CHECK((d.app.tool.joint->at - at).norm() < 1e-12);
  }
}

TEST_CASE("the keys stay in the view for whoever joins with the mouse and Enter") {
  SliderCrank d;
  d.begin(slider_crank_pin);
  d.key(key_enter);
  REQUIRE(d.app.session.mechanism().joints.size() == 4);
  d.frames(2);
  CHECK(d.app.ui.keyboard.at.empty());
  CHECK_FALSE(d.app.ui.keyboard.ring);
}

TEST_CASE("no button of the card is cut, and it covers nothing that is written below it") {
  SliderCrank d;
  d.app.view.camera.azimuth = 0.6;
  d.app.view.camera.elevation = 0.4;
  d.frames(1);
  d.begin({0.3, -0.4, 0});
  REQUIRE(d.app.ui.widgets.contains("tools/axis/view"));
  const WidgetRect points = d.widget("tools/axis/points");
  CHECK(points.to.x - points.from.x >= ImGui::CalcTextSize("Two points…").x + 2);
  const ImGuiWindow* card = ImGui::FindWindowByName("joint");
  REQUIRE(card);
  CHECK(card->Pos.y + card->Size.y <= d.app.view.lines_top);
  CHECK(card->Pos.y + card->Size.y <= d.widget("status").from.y);
}

TEST_CASE("a point that is on no body is told, and how far the one offered is") {
  SliderCrank d;
  d.begin({0.3, -0.4, 0});
  CHECK(d.app.ui.widgets.contains("tools/away"));
  d.key(key_escape);
  d.key('J');
  d.begin(slider_crank_pin);
  CHECK_FALSE(d.app.ui.widgets.contains("tools/away"));
}

TEST_CASE("a slide is offered from the one body to the other, not along a disc's axis") {
  Mechanism m;
  add_body(m, {.form = BodyForm::rod, .radius = 0.1, .from = {0, 0, -0.02}, .to = {0, 0, 0.02}}); // a drum
  add_body(m, {.form = BodyForm::block, .at = {0.2, 0, 0}});
  CHECK((guess_axis(m, JointType::prismatic, {"rod1", "block1"}, 2) - Vec3::UnitX()).norm() < 1e-12);
  // A collar slides along its rod.
  add_body(m, {.form = BodyForm::rod, .radius = 0.01, .from = {0, -1, 0}, .to = {0, 1, 0}});
  CHECK((guess_axis(m, JointType::prismatic, {"rod2", "block1"}, 2) - Vec3::UnitY()).norm() < 1e-12);
  CHECK(guess_axis(m, JointType::revolute, {"rod1", "block1"}, 2) == Vec3::UnitZ());
}

TEST_CASE("the slide of a crank's block is offered from the crank's pivot to the block") {
  Mechanism m = Document::empty_mechanism();
  add_slider_crank(m);
  CHECK((guess_axis(m, JointType::prismatic, {"ground", "block1"}, 2) - Vec3::UnitX()).norm() < 1e-12);
  // One that runs a little beside the pivot goes along the world's axis, another slantwise.
  const auto moved_to = [&](const Vec3& at) {
    m.bodies[2].position = at;
    return guess_axis(m, JointType::prismatic, {"ground", "block1"}, 2);
  };
  CHECK((moved_to({0.3, 0.04, 0.2}) - Vec3::UnitX()).norm() < 1e-12); // what lies along the hinges is nothing
  CHECK((moved_to({-0.3, 0, 0}) - Vec3::UnitX()).norm() < 1e-12);
  CHECK((moved_to({0.3, 0.4, 0}) - Vec3(0.6, 0.8, 0)).norm() < 1e-12);
  // Of what hangs on nothing else it goes upwards, as ever.
  add_body(m, {.form = BodyForm::block, .at = {1, 0, 0}});
  CHECK((guess_axis(m, JointType::prismatic, {"ground", "block2"}, 2) - Vec3::UnitY()).norm() < 1e-12);
}

TEST_CASE("the card of a joint does not hide its point") {
  const bool small = GENERATE(false, true); // too small a view for both
  CAPTURE(small);
  Robot d(small ? PixelSize{853, 533} : PixelSize{1280, 720});
  d.begin_empty(1);
  edit(d.app.session, "Build", [](Mechanism& next, Selection&) {
    const auto rod = [&](const Vec3& from, const Vec3& to) {
      add_body(next, {.form = BodyForm::rod, .radius = 0.01, .from = from, .to = to});
    };
    rod({0, 0, 0}, {0, 0.1, 0});
    rod({0, 0.1, 0}, {0.4, 0.26, 0});
    rod({0.4, 0.26, 0}, {0.4, 0, 0});
  });
  d.frames(2);
  for (const Vec3& at : {Vec3(0, 0.1, 0), Vec3(0.4, 0.26, 0), Vec3(0, 0, 0), Vec3(0.4, 0, 0)}) {
    CAPTURE(at.transpose());
    d.key('J');
    d.click_at(at);
    d.frames(2);
    REQUIRE(d.app.tool.joint);
    CHECK_FALSE(under_card(d, at));
    d.key(key_escape);
  }
}

TEST_CASE("a bearing's card is no taller than what is in it") {
  SliderCrank d;
  d.begin(slider_crank_pin);
  const ImGuiWindow* card = ImGui::FindWindowByName("joint");
  REQUIRE(card);
  const float joint = card->Size.y;
  d.key(key_escape);
  set_tool(d.app.session, d.app.ui, d.app.tool, Tool::bearing);
  d.frames(1);
  d.begin(slider_crank_pin);
  const ImGuiWindow* bearing = ImGui::FindWindowByName("bearing");
  REQUIRE(bearing);
  CHECK(bearing->Size.y < joint - 60);
}

TEST_CASE("the card lies neither over the tools nor over the legend") {
  SliderCrank d({1280, 800});
  const Vec3 at = GENERATE(Vec3(0, 0, 0), Vec3(0.1, 0.1, 0), Vec3(0.25, 0.35, 0), Vec3(-0.3, 0.2, 0));
  CAPTURE(at.transpose());
  d.begin(at);
  const ImGuiWindow* card = ImGui::FindWindowByName("joint");
  REQUIRE(card);
  const ImVec2 from = card->Pos, to(from.x + card->Size.x, from.y + card->Size.y);
  for (const char* name : {"tool strip", "legend frame"}) {
    CAPTURE(name);
    const WidgetRect other = d.widget(name);
    CHECK_FALSE((from.x < other.to.x && other.from.x < to.x && from.y < other.to.y && other.from.y < to.y));
  }
}

TEST_CASE(
    "a disc on a shaft is offered to be held on it, and the type chosen before is the next joint's again") {
  Robot d({1280, 800});
  d.begin_empty(1);
  const Vec3 middle(0, 0, 0), end(-0.3, 0, 0);
  edit(d.app.session, "Build", [&](Mechanism& next, Selection&) {
    add_body(next, {.form = BodyForm::rod, .radius = 0.01, .from = end, .to = {0.3, 0, 0}});
    add_body(next, {.form = BodyForm::disc, .radius = 0.1, .from = {-0.01, 0, 0}, .to = {0.01, 0, 0}});
    add_joint(next, JointType::revolute, {"ground", "rod1"}, end, Vec3::UnitX());
  });
  d.frames(2);
  const auto begin = [&](const Vec3& at) {
    d.key('J');
    d.click_at(at);
    d.frames(2);
    REQUIRE(d.app.tool.joint);
  };
  begin(middle);
  CHECK(d.app.tool.joint->bodies == Pair{"rod1", "disc1"});
  CHECK(d.app.tool.joint_type == JointType::fixed);
  d.key(key_escape);
  begin({0.3, 0, 0});
  CHECK(d.app.tool.joint_type == JointType::revolute);
  d.key(key_escape);
  // It goes with the bodies and the place that it was offered for.
  begin(middle);
  d.click("tools/parent");
  d.click("tools/parent/ground");
  d.frames(2);
  CHECK(d.app.tool.joint->bodies == Pair{"ground", "disc1"});
  CHECK(d.app.tool.joint_type == JointType::revolute);
  d.key(key_escape);
  begin(middle);
  CHECK(d.app.tool.joint_type == JointType::fixed);
  d.click_at(beside_card(d, {{0.3, 0.15, 0}, {-0.3, 0.15, 0}, {0.3, -0.3, 0}, {-0.3, -0.3, 0}}));
  d.frames(2);
  CHECK(d.app.tool.joint_type == JointType::revolute);
  d.key(key_escape);
  // Chosen by hand it stays.
  begin(middle);
  d.click("tools/type/cylindrical");
  d.frames(1);
  d.click("tools/join");
  CHECK(d.app.session.mechanism().joints.back().type == JointType::cylindrical);
  begin({0.3, 0, 0});
  CHECK(d.app.tool.joint_type == JointType::cylindrical);
}
