// Placing and joining in the 3-D view, done by a robot.
#include "drawing.hpp"

#include "app/document/create.hpp"
#include "app/ui/tools/tools.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace flyball;
using namespace flyball::test;

TEST_CASE("a ball is placed by a click, on the grid and with a round size") {
  Drawing d;
  d.click("tools/ball");
  CHECK(d.app.tool.tool == Tool::ball);
  d.click_at({0.11, 0.19, 0});
  REQUIRE(d.m().bodies.size() == 1);
  CHECK(d.m().bodies[0].position == Vec3(0.1, 0.2, 0));
  CHECK(d.m().bodies[0].shapes[0].radius == 0.05);
  CHECK(d.app.session.selection().parts == std::vector{body_part("ball1")});
  CHECK(d.app.tool.tool == Tool::select);
  CHECK(d.steps() == 1);
  CHECK(d.last_step() == "Add ball");
}

TEST_CASE("Shift keeps the tool for another one") {
  Drawing d;
  d.click("tools/ball");
  d.hold(false, true);
  d.click_at({-0.2, 0, 0});
  CHECK(d.app.tool.tool == Tool::ball);
  d.hold(false, false);
  d.click_at({0.2, 0, 0});
  CHECK(d.m().bodies.size() == 2);
  CHECK(d.app.tool.tool == Tool::select);
}

TEST_CASE("a drag draws the size of a body") {
  Drawing d;
  SECTION("a ball's radius") {
    d.click("tools/ball");
    d.drag(d.pixel({0.1, 0, 0}), d.pixel({0.1, 0.21, 0}));
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].position == Vec3(0.1, 0, 0));
    CHECK(d.m().bodies[0].shapes[0].radius == 0.2);
  }
  SECTION("a block's edges") {
    d.click("tools/block");
    d.drag(d.pixel({0, 0, 0}), d.pixel({0.2, 0.1, 0}));
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].size == Vec3(0.4, 0.2, 0.2));
  }
  SECTION("a plate's, thin across the view") {
    d.click("tools/plate");
    d.drag(d.pixel({0, 0, 0}), d.pixel({0.2, 0.1, 0}));
    REQUIRE(d.m().bodies.size() == 1);
    CHECK(d.m().bodies[0].shapes[0].size == Vec3(0.4, 0.2, 0.02));
  }
  SECTION("a disc's radius, its axis towards the eye") {
    d.click("tools/disc");
    d.drag(d.pixel({0.1, 0, 0}), d.pixel({0.1, 0.21, 0}));
    REQUIRE(d.m().bodies.size() == 1);
    const Body& disc = d.m().bodies[0];
    CHECK(disc.name == "disc1");
    CHECK(disc.position == Vec3(0.1, 0, 0));
    CHECK(disc.shapes[0].type == ShapeType::cylinder);
    CHECK(disc.shapes[0].radius == 0.2);
    CHECK(disc.shapes[0].from == Vec3(0.1, 0, -0.025));
    CHECK(disc.shapes[0].to == Vec3(0.1, 0, 0.025));
    CHECK(disc.inertia[2] == Approx(disc.mass * 0.02).epsilon(1e-12));
  }
  CHECK(d.app.view.camera.azimuth == 0);
  CHECK(d.steps() == 1);
}

TEST_CASE("a disc put onto a rod sits on it, one at its free end faces the eye") {
  Drawing d;
  edit(d.app.session, "Add rod", [](Mechanism& next, Selection& selection) {
    add_body(next, {.form = BodyForm::rod, .radius = 0.01, .from = {-0.2, 0, 0}, .to = {0.4, 0, 0}});
    selection.set({});
  });
  const auto place = [&](const Vec3& at) {
    d.frames(60); // no double click
    d.click("tools/disc");
    d.drag(d.pixel(at), d.pixel(at + Vec3(0, 0.21, 0)));
    return d.m().bodies.back().shapes.at(0);
  };
  const auto along = [](const Shape& shape) { return Vec3((shape.to - shape.from).normalized()); };
  const Shape on_rod = place({0, 0, 0}), at_end = place({0.4, 0, 0});
  REQUIRE(d.m().bodies.size() == 3);
  CHECK(along(on_rod) == Vec3::UnitX());
  CHECK(on_rod.radius == 0.2);
  CHECK((on_rod.from + on_rod.to).norm() < 1e-12);
  CHECK(along(at_end) == Vec3::UnitZ());
  // A shaft's end has a wheel across it.
  edit(d.app.session, "Add joint", [](Mechanism& next, Selection&) {
    add_joint(next, JointType::revolute, {std::string(ground_name), "rod1"}, {0, 0, 0}, Vec3::UnitX());
  });
  CHECK(along(place({-0.2, 0, 0})) == Vec3::UnitX());
}

TEST_CASE("a rod is drawn by two clicks or by a drag") {
  Drawing d;
  d.click("tools/rod");
  if (GENERATE(false, true)) {
    d.drag(d.pixel({-0.1, 0, 0}), d.pixel({0.2, 0.1, 0}));
  } else {
    d.click_at({-0.1, 0, 0});
    CHECK(d.m().bodies.empty());
    d.click_at({0.2, 0.1, 0});
  }
  REQUIRE(d.m().bodies.size() == 1);
  const Shape& shape = d.m().bodies[0].shapes[0];
  CHECK(shape.type == ShapeType::cylinder);
  CHECK(shape.from == Vec3(-0.1, 0, 0));
  CHECK(shape.to == Vec3(0.2, 0.1, 0));
  CHECK(d.steps() == 1);
}

TEST_CASE("the ends of a rod have to be apart") {
  Drawing d;
  d.click("tools/rod");
  d.click_at({0, 0, 0});
  d.frames(60); // no double click
  d.click_at({0, 0, 0});
  CHECK(d.m().bodies.empty());
  CHECK_THAT(d.app.session.notice, ContainsSubstring("apart"));
}

TEST_CASE("placing works on a plane through the last point") {
  Drawing d;
  d.have_ball({0, 0, 0.3});
  d.choose_nothing();
  d.click("tools/ball");
  d.click_at({0, 0, 0.3}); // snaps to the centre
  CHECK(d.m().bodies[1].position == Vec3(0, 0, 0.3));
  d.click("tools/ball");
  d.click_at({0.2, 0.1, 0.3});
  CHECK(d.m().bodies[2].position == Vec3(0.2, 0.1, 0.3));
}

TEST_CASE("Ctrl places without snapping") {
  Drawing d;
  d.click("tools/ball");
  d.hold(true, false);
  d.click_at({0.113, 0.187, 0});
  REQUIRE(d.m().bodies.size() == 1);
  CHECK((d.m().bodies[0].position - Vec3(0.113, 0.187, 0)).norm() < 0.002);
  CHECK(d.m().bodies[0].position != Vec3(0.1, 0.2, 0));
}

TEST_CASE("Escape drops what was begun, then the tool, then the selection") {
  Drawing d;
  d.have_ball({0.3, 0, 0});
  d.click("tools/rod");
  d.click_at({0, 0, 0});
  REQUIRE(d.app.tool.first);
  d.key(key_escape);
  CHECK_FALSE(d.app.tool.first);
  CHECK(d.app.tool.tool == Tool::rod);
  d.key(key_escape);
  CHECK(d.app.tool.tool == Tool::select);
  CHECK_FALSE(d.app.session.selection().empty());
  d.key(key_escape);
  CHECK(d.app.session.selection().empty());
  CHECK(d.steps() == 1);
}

TEST_CASE("a joint is made by a click and the card beside it") {
  Drawing d;
  d.have_rod({0, 0, 0}, {0.3, 0, 0});
  d.choose_nothing();
  d.key('J');
  d.click_at({0.003, 0.002, 0});
  d.frames(2); // the card takes a moment to know its size
  REQUIRE(d.app.tool.joint);
  CHECK(d.app.tool.joint->bodies == std::array<std::string, 2>{"ground", "rod1"});
  CHECK(d.app.tool.joint->at == Vec3::Zero());
  CHECK(d.steps() == 1);

  SECTION("as offered: a hinge across the view") {
    d.click("tools/join");
    REQUIRE(d.m().joints.size() == 1);
    CHECK(d.m().joints[0].type == JointType::revolute);
    CHECK(d.m().joints[0].axis == Vec3::UnitZ());
    CHECK(d.m().joints[0].bodies == std::array<std::string, 2>{"ground", "rod1"});
    CHECK(d.app.session.selection().parts == std::vector{Part{PartKind::joint, d.m().joints[0].name}});
    CHECK(d.steps() == 2);
    CHECK(d.last_step() == "Join ground and rod1");
    CHECK(converged(d.app.session));
  }
  SECTION("a slide along the rod, by Enter") {
    d.click("tools/type/prismatic");
    CHECK(d.app.tool.joint->axis == Vec3::UnitX());
    d.key(key_enter);
    REQUIRE(d.m().joints.size() == 1);
    CHECK(d.m().joints[0].type == JointType::prismatic);
    CHECK(d.m().joints[0].axis == Vec3::UnitX());
  }
  SECTION("about a world axis") {
    d.click("tools/axis/y");
    d.click("tools/join");
    REQUIRE(d.m().joints.size() == 1);
    CHECK(d.m().joints[0].axis == Vec3::UnitY());
  }
  SECTION("about an axis through two points") {
    d.click("tools/axis/points");
    d.click_at({-0.3, -0.3, 0}); // the card is on the other side
    d.click_at({-0.1, -0.1, 0});
    CHECK_FALSE(d.app.tool.joint->picking_axis);
    d.click("tools/join");
    REQUIRE(d.m().joints.size() == 1);
    CHECK((d.m().joints[0].axis - Vec3(1, 1, 0).normalized()).norm() < 1e-12);
    CHECK(d.m().joints[0].at == Vec3::Zero());
  }
  SECTION("the other way round") {
    d.click("tools/swap");
    d.click("tools/join");
    REQUIRE(d.m().joints.size() == 1);
    CHECK(d.m().joints[0].bodies == std::array<std::string, 2>{"rod1", "ground"});
  }
  SECTION("with a second axis") {
    d.click("tools/type/universal");
    CHECK(std::abs(d.app.tool.joint->axis.dot(d.app.tool.joint->axis2)) < 1e-15);
    d.click("tools/axis2/y");
    d.click("tools/join");
    REQUIRE(d.m().joints.size() == 1);
    CHECK(d.m().joints[0].axis == Vec3::UnitZ());
    CHECK(d.m().joints[0].axis2 == Vec3::UnitY());
  }
  SECTION("not at all") {
    if (GENERATE(false, true))
      d.click("tools/cancel");
    else
      d.key(key_escape);
    CHECK_FALSE(d.app.tool.joint);
    CHECK(d.m().joints.empty());
    CHECK(d.app.session.selection().empty());
  }
}

TEST_CASE("the bodies of a joint are guessed") {
  Drawing d;
  d.have_rod({0, 0, 0}, {0, 0.4, 0});
  d.have_rod({0, 0.3, 0}, {0.3, 0.3, 0});
  edit(d.app.session, "Join", [](Mechanism& next, Selection&) {
    add_joint(next, JointType::revolute, {"ground", "rod2"}, {0.3, 0.3, 0}, Vec3::UnitZ());
  });
  d.choose_nothing();
  const auto guess = [&](const Vec3& at) {
    set_tool(d.app.session, d.app.ui, d.app.tool, Tool::joint);
    d.frames(1);
    d.click_at(at);
    REQUIRE(d.app.tool.joint);
    return d.app.tool.joint->bodies;
  };
  using Pair = std::array<std::string, 2>;
  SECTION("two at the point, the one that hangs on the ground first") {
    CHECK(guess({0, 0.3, 0}) == Pair{"rod2", "rod1"});
  }
  SECTION("one at the point, and the ground") {
    CHECK(guess({0, 0, 0}) == Pair{"ground", "rod1"});
  }
  SECTION("none at the point: the nearest") {
    CHECK(guess({-0.2, 0.1, 0}) == Pair{"ground", "rod1"});
  }
  SECTION("the one that is selected and hangs nowhere, rather than the ground once more") {
    edit(d.app.session, "Join", [](Mechanism& next, Selection&) {
      add_joint(next, JointType::revolute, {"ground", "rod1"}, {0, 0, 0}, Vec3::UnitZ());
    });
    d.have_rod({0.5, 0, 0}, {0.5, 0.4, 0});
    REQUIRE(d.app.session.selection().has(body_part("rod3")));
    CHECK(guess({0, 0, 0}) == Pair{"rod1", "rod3"});
  }
  SECTION("two that are selected, wherever the point is") {
    Selection both;
    both.add(body_part("rod1"));
    both.add(body_part("rod2"));
    select(d.app.session, both);
    CHECK(guess({-0.2, 0.1, 0}) == Pair{"rod2", "rod1"});
    // They stay the ones while the point is moved.
    CHECK(guess({-0.3, 0, 0}) == Pair{"rod2", "rod1"});
  }
}

TEST_CASE("springs, dampers and links go from one click to another") {
  Drawing d;
  d.have_ball({0.2, 0, 0});
  d.choose_nothing();
  const Tool tool = GENERATE(Tool::spring, Tool::damper, Tool::distance);
  d.click(tool == Tool::spring ? "tools/spring" : tool == Tool::damper ? "tools/damper" : "tools/distance");
  d.click_at({-0.2, 0.1, 0});
  d.click_at({0.203, 0.002, 0});
  const std::array<Vec3, 2> points{Vec3(-0.2, 0.1, 0), Vec3(0.2, 0, 0)};
  const std::array<std::string, 2> bodies{"ground", "ball1"};
  if (tool == Tool::distance) {
    REQUIRE(d.m().joints.size() == 1);
    CHECK(d.m().joints[0].bodies == bodies);
    CHECK(d.m().joints[0].points == points);
  } else {
    REQUIRE(d.m().forces.size() == 1);
    CHECK(d.m().forces[0].bodies == bodies);
    CHECK(d.m().forces[0].points == points);
    CHECK(d.m().forces[0].stiffness == (tool == Tool::spring ? 1000 : 0));
    CHECK(d.m().forces[0].damping == (tool == Tool::damper ? 10 : 0));
  }
  CHECK(d.steps() == 2);
}

TEST_CASE("a spring on one body alone is refused in words") {
  Drawing d;
  d.have_ball({0, 0, 0}, 0.2);
  d.choose_nothing();
  d.click("tools/spring");
  d.drag(d.pixel({-0.1, 0, 0}), d.pixel({0.1, 0, 0}));
  CHECK(d.m().forces.empty());
  CHECK_THAT(d.app.session.notice, ContainsSubstring("ball1"));
  // The tool is still there for another try.
  d.drag(d.pixel({-0.1, 0, 0}), d.pixel({0.3, 0, 0}));
  CHECK(d.m().forces.size() == 1);
}

TEST_CASE("forces, torques and drag act on the body that is clicked") {
  Drawing d;
  d.have_ball({0.2, 0, 0});
  d.choose_nothing();
  SECTION("a force, downwards") {
    d.click("tools/force");
    d.click_at({0.2, 0, 0});
    REQUIRE(d.m().forces.size() == 1);
    CHECK(d.m().forces[0].vector == Vec3(0, -1, 0));
  }
  SECTION("a torque, about the line of sight") {
    d.click("tools/torque");
    d.click_at({0.2, 0, 0});
    REQUIRE(d.m().forces.size() == 1);
    CHECK(d.m().forces[0].vector == Vec3(0, 0, 1));
  }
  SECTION("drag") {
    d.click("tools/drag");
    d.click_at({0.2, 0, 0});
    REQUIRE(d.m().forces.size() == 1);
    CHECK(d.m().forces[0].linear == 1);
  }
  SECTION("a vane, square to the line of sight") {
    d.click("tools/vane");
    d.click_at({0.2, 0, 0});
    REQUIRE(d.m().forces.size() == 1);
    CHECK(d.m().forces[0].type == ForceType::vane);
    CHECK(d.m().forces[0].normal == Vec3(0, 0, 1));
  }
  SECTION("not on nothing") {
    d.click("tools/force");
    d.click_at({-0.2, 0, 0});
    CHECK(d.m().forces.empty());
    CHECK(d.app.tool.tool == Tool::force);
    return;
  }
  CHECK(d.m().forces[0].body == "ball1");
  CHECK(d.m().forces[0].at == Vec3(0.2, 0, 0));
}

TEST_CASE("a bearing is put on a shaft by a click and the card beside it") {
  Drawing d;
  d.have_rod({0, 0, 0}, {0.3, 0, 0});
  d.choose_nothing();
  if (GENERATE(false, true))
    d.click("tools/bearing");
  else
    d.key('J', false, true);
  REQUIRE(d.app.tool.tool == Tool::bearing);
  d.click_at({0.302, 0.003, 0});
  d.frames(2);
  REQUIRE(d.app.tool.joint);
  CHECK(d.app.tool.joint->bodies == std::array<std::string, 2>{"ground", "rod1"});
  CHECK(d.app.tool.joint->at == Vec3(0.3, 0, 0));
  CHECK(d.app.tool.joint->axis == Vec3::UnitX()); // along the rod
  CHECK(d.app.ui.widgets.count("tools/type/revolute") == 0);
  CHECK(d.steps() == 1);
  if (GENERATE(false, true)) {
    d.key(key_escape);
    CHECK_FALSE(d.app.tool.joint);
    CHECK(d.m().forces.empty());
    return;
  }
  if (GENERATE(false, true))
    d.click("tools/join");
  else
    d.key(key_enter);
  REQUIRE(d.m().forces.size() == 1);
  const Force& bearing = d.m().forces[0];
  CHECK(bearing.type == ForceType::bearing);
  CHECK(bearing.bodies == std::array<std::string, 2>{"ground", "rod1"});
  CHECK(bearing.at == Vec3(0.3, 0, 0));
  CHECK(bearing.axis == Vec3::UnitX());
  CHECK(bearing.bearing_stiffness == BearingMatrix{1e6, 0, 0, 1e6});
  CHECK(bearing.bearing_damping == BearingMatrix{1000, 0, 0, 1000});
  CHECK(d.m().joints.empty());
  CHECK(d.app.session.selection().parts == std::vector{Part{PartKind::force, "bearing1"}});
  CHECK(d.steps() == 2);
  CHECK(d.app.session.mistakes.empty());
  // It is moved as what has one point, and goes with the shaft as a joint does.
  d.pull("gizmo/y", {0.3, 0.2, 0});
  d.release();
  CHECK(d.m().forces[0].at->y() > 0.05);
  undo(d.app.session);
  select(d.app.session, {{{PartKind::body, "rod1"}}});
  d.frames(2);
  const Vec3 before = d.m().bodies[0].position;
  d.pull("gizmo/y", before + Vec3(0, 0.2, 0));
  d.release();
  const Vec3 by = d.m().bodies[0].position - before;
  CHECK(by.y() > 0.05);
  CHECK((*d.m().forces[0].at - Vec3(0.3, 0, 0) - by).norm() < 1e-12);
  undo(d.app.session);
  undo(d.app.session);
  CHECK(d.m().forces.empty());
}

TEST_CASE("a bearing lies along the axis that a body turns about") {
  Drawing d;
  d.have_rod({0, 0, 0}, {0.3, 0, 0});
  d.choose_nothing();
  d.key('J');
  d.click_at({0, 0, 0});
  d.frames(2);
  d.click("tools/join"); // a hinge across the view
  REQUIRE(d.m().joints.size() == 1);
  d.choose_nothing();
  d.click("tools/bearing");
  d.click_at({0.3, 0, 0});
  d.frames(2);
  REQUIRE(d.app.tool.joint);
  CHECK(d.app.tool.joint->axis == Vec3::UnitZ());
}
