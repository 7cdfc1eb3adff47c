// The outline, names, and the history list, used by a robot.
#include "inspector_hand.hpp"

#include "app/document/create.hpp"
#include "app/ui/panel_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("renaming takes every reference along and refuses names that are taken") {
  Hand hand;
  SECTION("in the outline, by a double click") {
    hand.double_click("outline/bodies/ball1");
    REQUIRE(hand.app.ui.fields.typing.name == "outline/bodies/ball1/name");
  }
  SECTION("in the outline, by F2") {
    hand.click("outline/bodies/ball1");
    hand.key(key_f2);
    REQUIRE(hand.app.ui.fields.typing.name == "outline/bodies/ball1/name");
  }
  SECTION("in the inspector") {
    hand.click("outline/bodies/ball1");
    hand.press_widget("inspector/name");
  }
  hand.frames(2);
  hand.type("ball2");
  hand.key(key_enter);
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("ball2"));
  hand.frames(3);
  hand.key('A', true);
  hand.type("a.b");
  hand.key(key_enter);
  CHECK_THAT(hand.app.ui.fields.typing.mistake, ContainsSubstring("dots"));
  hand.frames(3);
  hand.key('A', true);
  hand.type("left weight");
  hand.one_step([&] { hand.key(key_enter); });
  CHECK(hand.last_step() == "Rename ball1 to left weight");
  CHECK(hand.joint("arm1").bodies[1] == "left weight");
  CHECK(hand.app.session.selection().has({PartKind::body, "left weight"}));
  CHECK(hand.app.session.mistakes.empty());
}

TEST_CASE("a right click on a row brings the menu of the part, as in the view") {
  Hand hand;
  const WidgetRect row = hand.widget("outline/bodies/ball1");
  hand.click(row.center(), 1);
  hand.frames(3);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::body, "ball1"}});
  for (const char* item : {"edit.rename", "edit.copy", "view.hide", "view.fit_selected", "view.loads"})
    CHECK(hand.app.ui.widgets.contains(std::string("view/menu/") + item));
  hand.click("view/menu/view.hide");
  hand.frames(2);
  CHECK(hand.app.view.hidden == std::vector{Part{PartKind::body, "ball1"}});
}

TEST_CASE("the outline selects one, some and a range, and shows what is pointed at") {
  Hand hand;
  hand.click("outline/bodies/spindle");
  CHECK(hand.app.session.selection().parts == std::vector<Part>{{PartKind::body, "spindle"}});
  CHECK(hand.app.view.hovered.kind == PartKind::body); // the hand still lies on it
  hand.hold(false, true);
  hand.click("outline/joints/spin");
  hand.hold(false, false);
  CHECK(hand.app.session.selection().parts.size() == hand.mechanism().bodies.size() + 1);
  hand.hold(true, false);
  hand.click("outline/bodies/spindle");
  hand.hold(false, false);
  CHECK_FALSE(hand.app.session.selection().has({PartKind::body, "spindle"}));
  hand.click("outline/joints/spin");
  CHECK(hand.app.session.selection().parts.size() == 1);
  hand.click("outline/joints");
  CHECK_FALSE(hand.app.ui.widgets.contains("outline/joints/spin"));
}

TEST_CASE("two thousand bodies are listed a screenful at a time and searched") {
  Hand hand;
  Mechanism many;
  many.name = "Many";
  Body body;
  body.mass = 1;
  body.shapes.emplace_back().type = ShapeType::box; // is quickly drawn
  body.shapes[0].size = Vec3(0.1, 0.1, 0.1);
  for (int i = 0; i < 2000; ++i) {
    body.name = "body" + std::to_string(i);
    many.bodies.push_back(body);
  }
  open_document(hand.app.session, Document(many));
  set_mode(hand.app.session, Mode::build);
  hand.frames(2);
  const auto listed = [&] {
    return std::ranges::count_if(hand.app.ui.widgets,
                                 [](const auto& w) { return w.first.starts_with("outline/bodies/"); });
  };
  CHECK(listed() > 10);
  CHECK(listed() < 100);
  // What is selected elsewhere is brought into view.
  hand.choose(PartKind::body, "body1900");
  hand.frames(2);
  CHECK(hand.app.ui.widgets.contains("outline/bodies/body1900"));
  hand.click("outline/search");
  hand.type("ODY1777");
  hand.frames(2);
  CHECK(listed() == 1);
  CHECK(hand.app.ui.widgets.contains("outline/bodies/body1777"));
}

TEST_CASE("what is missing is told and leads to the part") {
  Hand hand;
  edit(hand.app.session, "Add", [](Mechanism& m, Selection& s) {
    add_body(m, {.form = BodyForm::ball, .at = {0.3, 0, 0}});
    add_body(m, {.form = BodyForm::ball, .at = {0.5, 0, 0}});
    s = {};
  });
  hand.frames(2);
  REQUIRE(hand.app.session.mistakes.size() == 2);
  const std::string second = hand.mechanism().bodies.back().name;
  SECTION("below the outline") {
    hand.click("mistakes/1");
  }
  SECTION("in place of results") {
    hand.click("results/mistakes/1");
  }
  CHECK(hand.app.session.selection().parts == std::vector<Part>{{PartKind::body, second}});
}

TEST_CASE("the history goes to any step") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  hand.fill("inspector/mass", "2");
  hand.fill("inspector/mass", "3");
  hand.fill("inspector/mass", "4");
  hand.app.panels->history.open = true;
  hand.frames(3);
  hand.click("history/1");
  CHECK(hand.body("ball1").mass == 2);
  CHECK(hand.app.session.document.steps().size() == 4);
  hand.click("history/3");
  CHECK(hand.body("ball1").mass == 4);
  hand.click("history/0");
  CHECK(hand.mechanism() == hand.app.session.document.saved());
}

TEST_CASE("undo leaves the rows where they are, and a second edit at the same place means the same number") {
  Hand hand;
  open_scene(hand.app.session, shipped_file("watt_governor"));
  set_mode(hand.app.session, Mode::build);
  hand.frames(3);
  hand.click("outline/bodies/arm1");
  const Mechanism before = hand.mechanism();
  const ImVec2 at = hand.widget("inspector/position/x").center();
  const auto edit_there = [&] {
    hand.click(at);
    hand.type("300 mm");
    hand.key(key_enter);
  };
  edit_there();
  CHECK(hand.body("arm1").position.x() == 0.3);
  hand.key('Z', true);
  CHECK(hand.mechanism() == before);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::body, "arm1"}});
  CHECK(hand.widget("inspector/position/x").center().y == at.y);
  edit_there();
  CHECK(hand.body("arm1").position.x() == 0.3);
  CHECK(hand.mechanism().gravity == before.gravity);
  hand.key('Z', true);
  hand.key('Z', true, true);
  CHECK(hand.body("arm1").position.x() == 0.3);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::body, "arm1"}});
}

TEST_CASE("deleting says what goes along though it was not selected") {
  Hand hand;
  open_scene(hand.app.session, shipped_file("watt_governor"));
  set_mode(hand.app.session, Mode::build);
  hand.choose(PartKind::body, "arm1");
  hand.key(261); // Delete
  CHECK(hand.app.session.notice == "Deleted arm1 together with joints arm1 and knee1.");
  hand.choose(PartKind::joint, "foot1");
  hand.key(261);
  CHECK(hand.app.session.notice.empty());
  undo(hand.app.session);
  CHECK(hand.app.session.selection().parts == std::vector{Part{PartKind::joint, "foot1"}});
}

TEST_CASE("the search is there whatever is listed: no row moves when a part is added") {
  Hand hand;
  REQUIRE(hand.app.ui.widgets.contains("outline/search"));
  const float before = hand.widget("outline/bodies/spindle").from.y;
  edit(hand.app.session, "Add", [](Mechanism& m, Selection&) {
    for (int i = 0; i < 12; ++i)
      add_body(m, {.form = BodyForm::ball, .at = {0.1 * i, 1, 0}});
  });
  hand.frames(2);
  CHECK(hand.widget("outline/bodies/spindle").from.y == before);
  hand.click("outline/search");
  hand.type("spind");
  hand.frames(2);
  CHECK(hand.app.ui.widgets.contains("outline/bodies/spindle"));
  CHECK_FALSE(hand.app.ui.widgets.contains("outline/bodies/ball1"));
}

TEST_CASE("the title of the results moves the line above it") {
  Hand hand;
  hand.choose(PartKind::body, "ball1");
  const WidgetRect title = hand.widget("results/title");
  hand.drag({title.center().x, title.center().y}, {title.center().x, title.center().y - 80});
  hand.frames(2);
  CHECK(hand.widget("results/title").from.y == Approx(title.from.y - 80).margin(2));
}

TEST_CASE("while numbers are typed no section opens above them") {
  Hand hand;
  edit(hand.app.session, "Add", [](Mechanism& m, Selection& s) {
    s.set({PartKind::body,
           add_body(m, {.form = BodyForm::rod, .radius = 0.05, .from = {0, 0.5, 0}, .to = {0, 0.6, 0}})});
  });
  hand.frames(3);
  const std::string body = hand.app.session.selection().parts.back().name;
  hand.press_widget("inspector/shapes/0/from/x");
  hand.frames(2);
  const float before = hand.widget("inspector/shapes section").from.y;
  hand.key('A', true);
  hand.type("0.03"); // skew, as both its products of inertia and its turn tell
  hand.key(key_enter);
  edit(hand.app.session, "Turn", [&](Mechanism& m, Selection&) {
    m.bodies[static_cast<std::size_t>(body_index(m, body))].rotation =
        Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  });
  hand.frames(3);
  CHECK(hand.widget("inspector/shapes section").from.y == before);
  // Looked at anew it is as it should be.
  hand.choose(PartKind::body, "ball1");
  hand.choose(PartKind::body, body.c_str());
  hand.frames(2);
  CHECK(hand.widget("inspector/shapes section").from.y > before);
}
