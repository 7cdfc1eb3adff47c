// Bodies that are moved take their joints along, or say that they leave them.
#include "robot.hpp"

#include "app/document/transform.hpp"
#include "app/ui/camera_glide.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

struct Hand : Robot {
  Hand() : Robot({1280, 800}) {
    set_mode(app.session, Mode::build);
    look_from(app.view, 0, 0);
    frames(3);
  }
  const Joint& joint(const char* name) const {
    return app.session.mechanism().joints.at(
        static_cast<std::size_t>(joint_index(app.session.mechanism(), name)));
  }
  const Body& body(const char* name) const {
    return app.session.mechanism().bodies.at(
        static_cast<std::size_t>(body_index(app.session.mechanism(), name)));
  }
  void choose(const std::vector<Part>& parts) {
    select(app.session, {parts});
    frames(2);
  }
  void pull(const char* handle, float pixels) {
    const ImVec2 from = widget(handle).center();
    point(from);
    press();
    for (int i = 1; i <= 4; ++i)
      point({from.x + pixels * static_cast<float>(i) / 4, from.y});
  }
};

} // namespace

TEST_CASE("a body dragged by its arrow takes its bearing along, in one step") {
  Hand hand;
  const Mechanism before = hand.app.session.mechanism();
  const Vec3 spin = hand.joint("spin").at, spindle = hand.body("spindle").position;
  const Vec3 arm = hand.joint("arm1").at, link = hand.joint("link1").points[0];
  hand.choose({{PartKind::body, "spindle"}});
  hand.pull("gizmo/x", 80);
  const double by = hand.body("spindle").position.x() - spindle.x();
  REQUIRE(by > 0.01);
  CHECK((hand.joint("spin").at - spin - by * Vec3::UnitX()).norm() < 1e-12);
  CHECK((hand.joint("arm1").at - arm - by * Vec3::UnitX()).norm() < 1e-12);
  CHECK(hand.joint("link1").points[0] == link); // on a ball, which stays
  CHECK_THAT(hand.app.session.notice, ContainsSubstring("spin") && ContainsSubstring("went along"));
  SECTION("and leaves it with Shift") {
    hand.hold(false, true);
    hand.frames(2);
    CHECK(hand.joint("spin").at == spin);
    CHECK(hand.body("spindle").position.x() == Approx(spindle.x() + by));
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("spin") && ContainsSubstring("stay"));
    hand.hold(false, false);
    hand.frames(2);
    CHECK(hand.joint("spin").at != spin);
  }
  hand.release();
  CHECK(hand.app.session.document.position() == 1);
  undo(hand.app.session);
  CHECK(hand.app.session.mechanism() == before);
}

TEST_CASE("a typed position does the same, and a tick leaves joints behind") {
  Hand hand;
  hand.choose({{PartKind::body, "spindle"}});
  const Vec3 spin = hand.joint("spin").at;
  const bool leave = GENERATE(false, true);
  if (leave) {
    hand.click("inspector/leave joints");
    CHECK(hand.app.tool.leave_joints);
  }
  hand.click("inspector/position/x");
  hand.type("70 mm");
  hand.key(key_enter);
  CHECK(hand.body("spindle").position.x() == Approx(0.07));
  CHECK(hand.joint("spin").at.x() == Approx(leave ? spin.x() : spin.x() + 0.07));
  CHECK_THAT(hand.app.session.notice, ContainsSubstring(leave ? "stay" : "went along"));
  CHECK(hand.app.session.document.position() == 1);
}

TEST_CASE("everything selected moves as one, and only joints to the rest are told") {
  Hand hand;
  std::vector<Part> bodies;
  for (const Body& body : hand.app.session.mechanism().bodies)
    bodies.push_back({PartKind::body, body.name});
  const Mechanism before = hand.app.session.mechanism();
  hand.choose(bodies);
  hand.pull("gizmo/x", 80);
  hand.release();
  const double by = hand.body("spindle").position.x() - before.bodies[0].position.x();
  REQUIRE(by > 0.01);
  for (std::size_t i = 0; i < before.joints.size(); ++i) {
    const Joint &was = before.joints[i], &is = hand.app.session.mechanism().joints[i];
    if (has_at(was.type))
      CHECK((is.at - was.at - by * Vec3::UnitX()).norm() < 1e-12);
    else
      for (const std::size_t end : {0u, 1u})
        CHECK((is.points[end] - was.points[end] - by * Vec3::UnitX()).norm() < 1e-12);
  }
  CHECK(hand.app.session.notice == "Joint spin went along.");
  // It settles as it did: all of it went.
  CHECK(hand.app.session.answer.solution.status == Status::converged);
}

TEST_CASE("a body that is turned turns its joints' axes along") {
  Hand hand;
  hand.choose({{PartKind::body, "spindle"}});
  hand.app.ui.sections.open["inspector/rotation section"] = true;
  hand.frames(2);
  Mechanism m = hand.app.session.mechanism();
  rotate_parts(m, {{{PartKind::body, "spindle"}}}, m.bodies[0].position,
               Quat(Eigen::AngleAxisd(1, Vec3::UnitZ())), OuterJoints::follow);
  const Joint& spin = m.joints[static_cast<std::size_t>(joint_index(m, "spin"))];
  const Vec3 expected = Eigen::AngleAxisd(1, Vec3::UnitZ()) * hand.joint("spin").axis;
  CHECK((spin.axis - expected).norm() < 1e-14);
  CHECK(outer_joints(m, {{{PartKind::body, "spindle"}}}).size() >= 3);
  CHECK(outer_joints(m, {{{PartKind::body, "spindle"}, {PartKind::joint, "spin"}}}).size() + 1 ==
        outer_joints(m, {{{PartKind::body, "spindle"}}}).size());
}

TEST_CASE("what stays at the other side of joints that went along is told") {
  Hand hand;
  const auto move = [&](const char* body) {
    hand.choose({{PartKind::body, body}});
    hand.click("inspector/position/x");
    hand.type("300 mm");
    hand.key(key_enter);
  };
  move("ball1");
  CHECK(hand.app.session.notice ==
        "Joint arm1 went along; spindle stays where it was; link1 follows with one end.");
  open_scene(hand.app.session, shipped_file("watt_governor"));
  set_mode(hand.app.session, Mode::build);
  hand.frames(3);
  move("arm1");
  CHECK(hand.app.session.notice ==
        "Joints arm1 and knee1 went along; spindle and link1 stay where they were.");
}
