// Lengths and sizes that are typed while the hand places or drags something.
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/tools/tools.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

// One metre in view: the grid's step is 0.05 m.
struct Drawing : Robot {
  Drawing() { begin_empty(1); }

  const Mechanism& m() const { return app.session.mechanism(); }
  // A line of text, as the window tells keys: letters as capitals.
  void strike(const std::string& text) {
    for (const char c : text)
      key(std::toupper(static_cast<unsigned char>(c)));
  }
  double rod_length() const {
    const Shape& shape = m().bodies.at(0).shapes.at(0);
    return (shape.to - shape.from).norm();
  }
};

} // namespace

TEST_CASE("the length of a rod is typed while it is placed") {
  Drawing d;
  const double azimuth = d.app.view.camera.azimuth;
  const auto [text, length] = GENERATE(std::pair("1.5", 1.5), std::pair("150 mm", 0.15), std::pair(".2", 0.2),
                                       std::pair("3/4", 0.75), std::pair("12 cm + 5 mm", 0.125));
  d.click("tools/rod");
  d.click_at({-0.1, 0, 0});
  d.point_at({0.2, 0.01, 0});
  d.strike(text);
  CHECK(d.app.tool.typed == text);
  CHECK(d.app.view.camera.azimuth == azimuth);
  CHECK(d.m().bodies.empty());
  SECTION("and taken by Enter") {
    d.key(key_enter);
  }
  SECTION("or by the second click") {
    d.click_at({0.2, 0.01, 0});
  }
  REQUIRE(d.m().bodies.size() == 1);
  CHECK(d.rod_length() == Approx(length).epsilon(1e-12));
  const Shape& shape = d.m().bodies[0].shapes[0];
  CHECK(shape.from == Vec3(-0.1, 0, 0));
  CHECK(shape.to.y() == 0);
  CHECK(d.app.tool.typed.empty());
  CHECK(d.app.tool.tool == Tool::select);
  CHECK(d.app.session.document.position() == 1);
}

TEST_CASE("a typed length goes towards the point that the cursor is at") {
  Drawing d;
  ++d.app.session.gesture;
  edit(d.app.session, "Add ball", [&](Mechanism& next, Selection&) {
    add_body(next, {.at = {0.3, 0.1, 0}});
  });
  d.frames(2);
  d.click("tools/rod");
  d.click_at({0, 0, 0});
  d.point_at({0.3, 0.1, 0});
  d.strike("0.2");
  d.key(key_enter);
  REQUIRE(d.m().bodies.size() == 2);
  const Shape& shape = d.m().bodies[1].shapes[0];
  CHECK((shape.to - 0.2 * Vec3(0.3, 0.1, 0).normalized()).norm() < 1e-12);
}

TEST_CASE("a typed length does not turn a rod") {
  Drawing d;
  d.click("tools/rod");
  d.click_at({0, 0.2, 0});
  d.point_at({0.2, 0.05, 0}); // 36.9 degrees down, which is no round angle
  d.strike("200 mm");
  d.key(key_enter);
  REQUIRE(d.m().bodies.size() == 1);
  const Shape& shape = d.m().bodies[0].shapes[0];
  CHECK((shape.to - Vec3(0.16, 0.08, 0)).norm() < 1e-12);
  CHECK_FALSE(d.app.ui.keyboard.ring); // the hand is in the view
}

TEST_CASE("what is typed can be mended, and what is no length is told") {
  Drawing d;
  d.click("tools/rod");
  d.click_at({0, 0, 0});
  d.point_at({0.2, 0, 0});
  SECTION("Backspace") {
    d.strike("0.25");
    d.key(keys::backspace);
    d.key(key_enter);
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.rod_length() == Approx(0.2));
  }
  SECTION("Escape takes the number back, then the end, then the tool") {
    d.strike("0.25");
    CHECK_THAT(tool_hint(d.app.session, d.app.tool), ContainsSubstring("Esc drops the number"));
    d.key(key_escape);
    CHECK(d.app.tool.typed.empty());
    CHECK(d.app.tool.first);
    CHECK_THAT(tool_hint(d.app.session, d.app.tool), ContainsSubstring("Esc drops the first"));
    d.key(key_escape);
    CHECK_FALSE(d.app.tool.first);
    CHECK(d.app.tool.tool == Tool::rod);
  }
  SECTION("no length") {
    d.strike(GENERATE("12 q", "0", "-1", "2 rad"));
    d.key(key_enter);
    CHECK(d.m().bodies.empty());
    CHECK_THAT(d.app.session.notice, ContainsSubstring("is no length"));
    CHECK(d.app.tool.first); // goes on
  }
}

TEST_CASE("the length of links, springs and dampers is typed as well") {
  Drawing d;
  ++d.app.session.gesture;
  edit(d.app.session, "Add block", [&](Mechanism& next, Selection&) {
    add_body(next, {.form = BodyForm::block, .at = {0.2, 0, 0}, .size = {0.3, 0.3, 0.1}});
  });
  d.frames(2);
  const Tool tool = GENERATE(Tool::spring, Tool::damper, Tool::distance);
  set_tool(d.app.session, d.app.ui, d.app.tool, tool);
  d.frames(1);
  d.click_at({-0.2, 0, 0});
  d.point_at({0.15, 0, 0});
  d.strike("300 mm");
  d.key(key_enter);
  const std::array<Vec3, 2>& points =
      tool == Tool::distance ? d.m().joints.at(0).points : d.m().forces.at(0).points;
  CHECK((points[1] - points[0]).norm() == Approx(0.3));
}

TEST_CASE("the size of balls, discs, blocks and plates is typed before or while they are placed") {
  Drawing d;
  SECTION("a ball's radius, then a click") {
    d.click("tools/ball");
    d.point_at({0.1, 0.1, 0});
    d.strike("80 mm");
    d.click_at({0.1, 0.1, 0});
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].radius == Approx(0.08));
    CHECK(d.m().bodies[0].position == Vec3(0.1, 0.1, 0));
  }
  SECTION("a block's edge, by Enter where the cursor is") {
    d.click("tools/block");
    d.point_at({0.1, 0.1, 0});
    d.strike("0.3");
    d.key(key_enter);
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].size == Vec3(0.3, 0.3, 0.3));
  }
  SECTION("a disc's radius, chosen by its key") {
    d.key('D', false, true);
    d.point_at({0.1, 0.1, 0});
    d.strike("80 mm");
    d.click_at({0.1, 0.1, 0});
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].radius == Approx(0.08));
    CHECK((d.m().bodies[0].shapes[0].to - d.m().bodies[0].shapes[0].from - Vec3(0, 0, 0.02)).norm() < 1e-15);
  }
  SECTION("a disc's while it is drawn out is what it is a quarter as thick as") {
    d.click("tools/disc");
    d.point_at({0, 0, 0});
    d.press();
    d.point_at({0.08, 0, 0});
    d.strike("60 mm");
    d.key(key_enter);
    d.release();
    REQUIRE(d.m().bodies.size() == 1);
    const Shape& disc = d.m().bodies[0].shapes[0];
    CHECK(disc.radius == Approx(0.06));
    CHECK((disc.to - disc.from - Vec3(0, 0, 0.015)).norm() < 1e-15);
  }
  SECTION("while a ball is drawn out") {
    d.click("tools/ball");
    d.point_at({0, 0, 0});
    d.press();
    d.point_at({0.1, 0, 0});
    d.strike("0.033");
    d.key(key_enter);
    d.release();
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].radius == 0.033);
    CHECK(d.m().bodies[0].position == Vec3(0, 0, 0));
  }
  SECTION("a plate stays thin") {
    d.click("tools/plate");
    d.point_at({0, 0, 0});
    d.strike("0.4");
    d.click_at({0, 0, 0});
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].size == Vec3(0.4, 0.4, 0.04));
  }
  CHECK(d.app.tool.tool == Tool::select);
  CHECK(d.app.session.document.position() == 1);
}

TEST_CASE("a drag takes a number with a unit, and Enter ends it") {
  Drawing d;
  ++d.app.session.gesture;
  edit(d.app.session, "Add ball", [&](Mechanism& next, Selection& selection) {
    selection.set({PartKind::body, add_body(next, {.at = {0, 0, 0}})});
  });
  d.frames(2);
  SECTION("along an arrow") {
    d.point(d.widget("gizmo/x").center());
    d.press();
    d.strike("150 mm");
    CHECK(d.m().bodies[0].position.x() == Approx(0.15));
    d.key(key_enter);
    CHECK_FALSE(d.app.tool.grab);
    d.release();
    CHECK((d.m().bodies[0].position - Vec3(0.15, 0, 0)).norm() < 1e-12);
  }
  SECTION("freely: as far as is typed, the way the hand went") {
    const ImVec2 from = d.widget("gizmo/centre").center();
    d.point(from);
    d.press();
    for (int i = 1; i <= 4; ++i)
      d.point({from.x + 20.f * static_cast<float>(i), from.y});
    d.strike("0.07");
    d.key(key_enter);
    d.release();
    CHECK(d.m().bodies[0].position.norm() == Approx(0.07));
  }
  SECTION("round a ring, in degrees or radians") {
    d.key('R');
    d.point(d.widget("gizmo/ring/z").center());
    d.press();
    const bool radians = GENERATE(false, true);
    d.strike(radians ? "0.5 rad" : "45");
    d.key(key_enter);
    d.release();
    const double angle = 2 * std::acos(d.m().bodies[0].rotation.w());
    CHECK(angle == Approx(radians ? 0.5 : std::numbers::pi / 4));
  }
  CHECK(d.app.session.document.position() == 2);
}
