// Named points in the view: marked, selected, dragged, picked for a vector, and snapped to for good.
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/document/formula_edits.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/tools/tools.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

const Vec3 place_a(0.15, 0.1, 0), place_b(-0.2, -0.13, 0);

// One metre in view, with points A and B and a ball on a hinge away from both.
struct Sheet : Robot {
  Sheet() : Robot({1200, 1200}) {
    begin_empty(1);
    change("Begin", [](Mechanism& next) {
      for (const auto& [name, at] : {std::pair("A", place_a), std::pair("B", place_b)}) {
        NamedPoint point;
        point.name = name;
        point.at = at;
        next.points.push_back(point);
      }
      add_body(next, {.at = {0.1, -0.2, 0}, .radius = 0.05});
      add_joint(next, JointType::revolute, {"ground", "ball1"}, {0.1, -0.35, 0}, Vec3::UnitZ());
    });
  }
  const Mechanism& m() const { return app.session.mechanism(); }
  const Joint& joint() const { return m().joints.back(); }
  std::size_t steps() const { return app.session.document.position(); }
  void change(const char* step, const std::function<void(Mechanism&)>& act) {
    ++app.session.gesture;
    edit(app.session, step, [&](Mechanism& next, Selection& selection) {
      act(next);
      selection = {};
    });
    frames(3);
  }
  void pick(Part part) {
    select(app.session, {{std::move(part)}});
    frames(3);
  }
  void ask(const std::string& field) {
    frames(60);
    click(ImVec2(widget(field).from.x + 10, widget(field).from.y + 8), 1);
    frames(2);
  }
  std::string at_of(const std::string& vector) const {
    return formula_at(m(), vector + ".0").value_or("") + " " + formula_at(m(), vector + ".1").value_or("") +
           " " + formula_at(m(), vector + ".2").value_or("");
  }
};

constexpr const char* hinge = "revolute1";
const Part the_hinge{PartKind::joint, hinge};
const std::string vector = "joints.revolute1.at";

} // namespace

TEST_CASE("named points are marked where they are of use, and no others' business elsewhere") {
  Sheet s;
  CHECK(s.app.ui.widgets.contains("point/A"));
  s.pick(the_hinge);
  CHECK_FALSE(s.app.ui.widgets.contains("point/A"));
  s.click("tools/force");
  s.frames(2);
  CHECK(s.app.ui.widgets.contains("point/B"));
  s.key(key_escape);
  set_mode(s.app.session, Mode::explore);
  select(s.app.session, {});
  s.frames(3);
  CHECK_FALSE(s.app.ui.widgets.contains("point/A"));
}

TEST_CASE("a named point is selected by its name and dragged with all that stands there, in one step") {
  Sheet s;
  s.change("Stand", [](Mechanism& next) { stand_at_point(next, vector, "A"); });
  const std::size_t before = s.steps();
  s.click("point/A");
  CHECK(s.app.tool.point == "A");
  s.frames(2);
  s.frames(60);
  s.pull("gizmo/centre", Vec3(0.052, 0.198, 0));

  s.release();
  INFO(s.app.session.notice);
  CHECK((s.m().points[0].at - Vec3(0.2, 0.3, 0)).norm() < 1e-15);
  CHECK((s.joint().at - Vec3(0.2, 0.3, 0)).norm() < 1e-15);
  CHECK(s.steps() == before + 1);
  CHECK(s.app.session.document.steps().back().name == "Move A");
  CHECK(s.app.tool.point == "A");
  s.key('Z', true);
  CHECK(s.m().points[0].at == place_a);
  CHECK(s.joint().at == place_a);
  // Escape drops it, as does selecting a part.
  s.key(key_escape);
  s.frames(1);
  CHECK(s.app.tool.point.empty());
  s.click("point/B");
  CHECK(s.app.tool.point == "B");
  s.key(261); // Delete: what stood there stays
  s.frames(2);
  CHECK(point_index(s.m(), "B") < 0);
  s.key('Z', true);
  s.click("point/B");
  s.pick(the_hinge);
  CHECK(s.app.tool.point.empty());
}

TEST_CASE("typing in the list selects the point in the view") {
  Sheet s;
  s.click("inspector/point/B/y");
  s.frames(2);
  CHECK(s.app.tool.point == "B");
  CHECK(s.app.ui.widgets.contains("gizmo/centre"));
}

TEST_CASE("a vector takes a named point that is clicked in the view") {
  Sheet s;
  s.pick(the_hinge);
  const std::size_t before = s.steps();
  s.ask("inspector/at/y");
  s.click("inspector/at/y/pick");
  s.frames(2);
  REQUIRE(s.app.tool.tool == Tool::point);
  CHECK(s.app.ui.widgets.contains("point/A"));
  CHECK(tool_hint(s.app.session, s.app.tool).find("Click the named point") != std::string::npos);
  SECTION("by its place") {
    s.click_at(place_a);
  }
  SECTION("by its name") {
    s.click("point/A");
  }
  SECTION("nothing beside one") {
    s.click_at({0, 0.3, 0});
    CHECK(s.app.tool.tool == Tool::point);
    CHECK(s.app.session.notice.find("no named point here") != std::string::npos);
    s.key(key_escape);
    s.frames(1);
    CHECK(s.app.tool.tool == Tool::select);
    CHECK(s.steps() == before);
    return;
  }
  CHECK(s.app.tool.tool == Tool::select);
  CHECK(s.at_of(vector) == "A.x A.y A.z");
  CHECK(s.joint().at == place_a);
  CHECK(s.app.session.selection().parts == std::vector{the_hinge});
  CHECK(s.steps() == before + 1);
  s.key('Z', true);
  CHECK(s.at_of(vector) == "  ");
}

TEST_CASE("without a mouse the point is in the field's menu, and the cursor of the pick goes to it") {
  Sheet s;
  s.pick(the_hinge);
  focus_widget(s.app.ui, "inspector/at/x");
  s.frames(3);
  const auto choose = [&](const std::string& entry) {
    s.key(348); // the menu key
    s.frames(3);
    for (int i = 0; i < 8 && s.app.ui.keyboard.at != "inspector/at/x/" + entry; ++i)
      s.key(264); // Down
    REQUIRE(s.app.ui.keyboard.at == "inspector/at/x/" + entry);
    s.key(key_enter);
    s.frames(3);
  };
  choose("at B");
  CHECK(s.at_of(vector) == "B.x B.y B.z");
  choose("pick");
  REQUIRE(s.app.tool.tool == Tool::point);
  for (int i = 0; i < 3 && s.app.tool.hovered_name != "A"; ++i) { // Page Down goes from point to point
    s.key(267);
    s.frames(2);
  }
  REQUIRE(s.app.tool.hovered_name == "A");
  s.key(key_enter);
  s.frames(3);
  CHECK(s.at_of(vector) == "A.x A.y A.z");
}

TEST_CASE("a place is named in one gesture") {
  Sheet s;
  s.pick(the_hinge);
  s.ask("inspector/at/z");
  s.click("inspector/at/z/name point");
  s.frames(2);
  CHECK(s.at_of(vector) == "A2.x A2.y A2.z");
  CHECK(s.m().points.back().at == Vec3(0.1, -0.35, 0));
}

TEST_CASE("what is placed on a named point stands there, undone whole; with Ctrl it does not") {
  Sheet s;
  const bool freely = GENERATE(false, true);
  s.change("Ball", [](Mechanism& next) { next.bodies[0].position = place_a; });
  const Mechanism begun = s.m();
  SECTION("a force") {
    s.click("tools/force");
    s.hold(freely, false);
    s.click_at(place_a);
    s.hold(false, false);
    REQUIRE(s.m().forces.size() == 1);
    CHECK((s.at_of("forces.force1.at") == "A.x A.y A.z") == !freely);
  }
  SECTION("a joint") {
    s.click("tools/joint");
    s.hold(freely, false);
    s.point_at(place_a);
    s.frames(1);
    CHECK((tool_hint(s.app.session, s.app.tool).find("It stands at A then") != std::string::npos) == !freely);
    s.click_at(place_a);
    s.hold(false, false);
    s.key(key_enter);
    s.frames(2);
    REQUIRE(s.m().joints.size() == 2);
    CHECK((s.at_of("joints.revolute2.at") == "A.x A.y A.z") == !freely);
  }
  SECTION("both ends of a spring") {
    s.click("tools/spring");
    s.hold(freely, false);
    s.click_at(place_b);
    s.click_at(place_a);
    s.hold(false, false);
    s.frames(2);
    REQUIRE(s.m().forces.size() == 1);
    CHECK((s.at_of("forces.spring1.points.0") == "B.x B.y B.z") == !freely);
    CHECK((s.at_of("forces.spring1.points.1") == "A.x A.y A.z") == !freely);
  }
  s.key('Z', true);
  CHECK(s.m() == begun);
}

TEST_CASE("what is dragged onto a named point stands there, in the same step") {
  Sheet s;
  s.pick(the_hinge);
  const std::size_t before = s.steps();
  const Vec3 from = s.joint().at;
  SECTION("snapped") {
    s.pull("gizmo/centre", place_b - from + Vec3(0.004, -0.003, 0));
    REQUIRE(s.app.tool.grab);
    CHECK(s.app.tool.grab->stands == "B");
    CHECK(tool_hint(s.app.session, s.app.tool).find("It stands at B then") != std::string::npos);
    s.release();
    CHECK(s.at_of(vector) == "B.x B.y B.z");
    CHECK(s.joint().at == place_b);
    CHECK(s.steps() == before + 1);
    // From there it takes the point along, and does not snap back to it.
    s.frames(60);
    s.pull("gizmo/centre", Vec3(0.1, 0.2, 0));
    s.release();
    CHECK(s.m().points[1].at == s.joint().at);
    INFO(s.app.session.notice);
    REQUIRE((s.joint().at - place_b).norm() > 0.1);
    s.key('Z', true);
    s.key('Z', true);
    CHECK(s.at_of(vector) == "  ");
    CHECK(s.joint().at == from);
  }
  SECTION("passing over it leaves nothing") {
    s.pull("gizmo/centre", place_b - from);
    s.point_at(place_b + Vec3(0.2, 0.3, 0));
    s.release();
    CHECK(s.at_of(vector) == "  ");
  }
  SECTION("freely with Ctrl") {
    s.hold(true, false);
    s.pull("gizmo/centre", place_b - from);
    s.release();
    s.hold(false, false);
    CHECK(s.at_of(vector) == "  ");
  }
}

TEST_CASE("a body that is placed on a named point stands there with all of it") {
  Sheet s;
  const bool freely = GENERATE(false, true);
  const Mechanism begun = s.m();
  const auto moved = [&] {
    s.change("Move A", [](Mechanism& next) {
      next.points[0].at += Vec3(0.1, 0.05, 0.02);
      evaluate_formulas(next);
    });
    return s.m().bodies.back();
  };
  SECTION("a ball, a block, a plate, a disc") {
    for (const std::string tool : {"ball", "block", "plate", "disc"}) {
      CAPTURE(tool, freely);
      s.click("tools/" + tool);
      s.hold(freely, false);
      s.point_at(place_a);
      s.frames(1);
      CHECK((tool_hint(s.app.session, s.app.tool).find("It stands at A then") != std::string::npos) ==
            !freely);
      s.click_at(place_a);
      s.hold(false, false);
      s.frames(2);
      REQUIRE(s.m().bodies.size() == 2);
      const Body placed = s.m().bodies.back();
      if (tool != "disc") CHECK((s.at_of("bodies." + placed.name + ".position") == "A.x A.y A.z") == !freely);
      CHECK(((placed.position - place_a).norm() < 1e-15 || freely));
      const Body after = moved();
      const Vec3 by = freely ? Vec3(0, 0, 0) : Vec3(0.1, 0.05, 0.02);
      CHECK((after.position - placed.position - by).norm() < 1e-15);
      CHECK((after.shapes[0].from - placed.shapes[0].from - (tool == "disc" ? by : Vec3(0, 0, 0))).norm() <
            1e-15);
      s.key('Z', true);
      s.key('Z', true);
      CHECK(s.m() == begun);
    }
  }
  SECTION("a rod goes from point to point and weighs what its length makes of it") {
    s.click("tools/rod");
    s.hold(freely, false);
    s.click_at(place_b);
    s.click_at(place_a);
    s.hold(false, false);
    s.frames(2);
    REQUIRE(s.m().bodies.size() == 2);
    const Body placed = s.m().bodies.back();
    const std::string shape = "bodies." + placed.name + ".shapes.0.";
    CHECK((s.at_of(shape + "from") == "B.x B.y B.z") == !freely);
    CHECK((s.at_of(shape + "to") == "A.x A.y A.z") == !freely);
    CHECK(placed.density.has_value() == !freely);
    const double before = (placed.shapes[0].to - placed.shapes[0].from).norm();
    const Body after = moved();
    const double length = (after.shapes[0].to - after.shapes[0].from).norm();
    CHECK(after.mass == Approx(placed.mass * length / before).epsilon(1e-12));
    CHECK((after.position - 0.5 * (after.shapes[0].to + after.shapes[0].from)).norm() < 1e-15);
    CHECK((after.shapes[0].to != placed.shapes[0].to) == !freely);
    s.key('Z', true);
    s.key('Z', true);
    CHECK(s.m() == begun);
  }
}

TEST_CASE("a body that is dragged onto a named point by its middle stands there") {
  Sheet s;
  const Part ball{PartKind::body, "ball1"};
  SECTION("all of it") {
    s.pick(ball);
    s.pull("gizmo/centre", place_b - s.m().bodies[0].position + Vec3(0.004, -0.003, 0));
    REQUIRE(s.app.tool.grab);
    CHECK(s.app.tool.grab->stands == "B");
    s.release();
    CHECK(s.at_of("bodies.ball1.position") == "B.x B.y B.z");
    // From there it takes the point along.
    s.frames(60);
    s.pull("gizmo/centre", Vec3(0.1, 0.2, 0));
    s.release();
    INFO(s.app.session.notice);
    CHECK(s.m().points[1].at == s.m().bodies[0].position);
    CHECK((s.m().points[1].at - place_b).norm() > 0.1);
  }
  SECTION("its shape, of which mass and mass centre follow") {
    s.change("By density", [](Mechanism& next) { next.bodies[0].density = 7850; });
    s.pick(ball);
    s.pull("gizmo/centre", place_b - s.m().bodies[0].position);
    s.release();
    CHECK(s.at_of("bodies.ball1.shapes.0.at") == "B.x B.y B.z");
    CHECK((s.m().bodies[0].position - place_b).norm() < 1e-15);
  }
  SECTION("but not where shapes have places of their own") {
    s.change("Rod", [](Mechanism& next) { next.bodies[0].shapes[0].at = next.bodies[0].position; });
    s.pick(ball);
    s.pull("gizmo/centre", place_b - s.m().bodies[0].position);
    REQUIRE(s.app.tool.grab);
    CHECK(s.app.tool.grab->stands.empty());
    s.release();
    CHECK(s.at_of("bodies.ball1.position") == "  ");
    CHECK((s.m().bodies[0].position - place_b).norm() < 1e-15);
  }
}

TEST_CASE("a point that expressions give moves what determines it, or says what holds it") {
  Sheet s;
  s.change("Depend", [](Mechanism& next) {
    NamedParameter length;
    length.name = "L";
    length.unit = "m";
    length.value = 0.15;
    next.parameters.push_back(length);
    set_expression(next, "points.A.0", "L");
  });
  s.click("point/A");
  s.frames(2);
  s.pull("gizmo/x", Vec3(0.15, 0, 0));
  s.release();
  CHECK(std::abs(get_parameter(s.m(), "parameters.L") - s.m().points[0].at.x()) < 1e-12);
  CHECK(get_parameter(s.m(), "parameters.L") > 0.25);
  s.change("Fix", [](Mechanism& next) { set_expression(next, "points.A.0", "0.15 m"); });
  s.click("point/A");
  s.frames(2);
  s.pull("gizmo/x", Vec3(0.15, 0, 0));
  s.release();
  CHECK(s.m().points[0].at.x() == 0.15);
  CHECK(s.app.session.notice.find("given by \"=0.15 m\"") != std::string::npos);
}
