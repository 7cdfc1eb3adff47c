// How a body moves is told of its mass centre, and of one more point that a person types.
#include "robot.hpp"

#include "app/document/remove.hpp"
#include "app/session/motion.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* body = "ball1";

// The results have all of the window's height below the inspector.
struct Hand : Robot {
  Hand() : Robot({1280, 1600}) {
    app.sizes.inspector_share = 0.4f;
    select(app.session, {{{PartKind::body, body}}});
    frames(3);
  }
  const PointSolution* told() const {
    const auto& points = app.session.answer.solution.points;
    const auto found = std::ranges::find(points, body, [](const PointSolution& p) { return p.point.body; });
    return found == points.end() ? nullptr : &*found;
  }
  const PointMotion& centre() const {
    return app.session.answer.solution.centres.at(
        static_cast<std::size_t>(body_index(app.session.mechanism(), body)));
  }
  void fill(const char* field, const char* text) {
    click(field);
    type(text);
    key(key_enter);
  }
};

} // namespace

TEST_CASE("a point of the selected body is told of beside its mass centre once it is asked for") {
  Hand hand;
  App& app = hand.app;
  CHECK(app.ui.widgets.contains("results/position/ball1"));
  CHECK_FALSE(app.ui.widgets.contains("results/point/x"));
  hand.click("results/point/on");
  hand.frames(2);
  // It begins as the mass centre.
  REQUIRE(hand.told());
  CHECK((hand.told()->motion.position - hand.centre().position).norm() < 1e-12);
  CHECK((hand.told()->motion.velocity - hand.centre().velocity).norm() < 1e-12);
  CHECK(app.ui.widgets.contains("results/point/acceleration/ball1"));

  hand.fill("results/point/x", "0 mm"); // of the drawn pose: on the axis, from which the arm swings away
  hand.fill("results/point/y", "0.3 m");
  REQUIRE(hand.told());
  const Vec3 at = app.session.points.at(body);
  CHECK(at.x() == 0);
  CHECK(at.y() == 0.3);
  CHECK(hand.told()->point.at == at);
  // A point fixed in the body moves with it, and round the spindle at the drive's speed.
  const auto b = static_cast<std::size_t>(body_index(app.session.mechanism(), body));
  const Pose& pose = app.session.answer.solution.poses[b];
  const Body& drawn = app.session.mechanism().bodies[b];
  const Vec3 moved = pose.position + pose.rotation * (drawn.rotation.conjugate() * (at - drawn.position));
  const PointMotion& motion = hand.told()->motion;
  CHECK((motion.position - moved).norm() < 1e-12);
  const double speed = 11.0174;
  CHECK((motion.velocity - (speed * Vec3::UnitY()).cross(moved)).norm() < 1e-9);
  CHECK((motion.acceleration + speed * speed * Vec3(moved.x(), 0, moved.z())).norm() < 1e-7);
  CHECK(app.session.document.position() == 0); // no edit

  SECTION("and stays for the session, with its body's name") {
    select(app.session, {});
    hand.frames(2);
    CHECK_FALSE(app.ui.widgets.contains("results/point/x"));
    select(app.session, {{{PartKind::body, body}}});
    hand.frames(2);
    CHECK(app.ui.widgets.contains("results/point/x"));
    hand.fill("inspector/name", "weight");
    hand.frames(2);
    CHECK(app.session.points.contains("weight"));
    CHECK(app.session.answer.solution.points.size() == 1);
    open_scene(app.session, shipped_file("pendulum"));
    CHECK(app.session.points.empty());
  }
  SECTION("until it is taken away") {
    hand.click("results/point/on");
    hand.frames(2);
    CHECK(app.session.points.empty());
    CHECK(app.session.answer.solution.points.empty());
    CHECK_FALSE(app.ui.widgets.contains("results/point/x"));
  }
  SECTION("a body that is deleted is not asked for, and its point is there again with it") {
    edit(app.session, "Delete", [](Mechanism& m, Selection& selection) {
      remove_parts(m, selection);
      selection = {};
    });
    CHECK(told_points(app.session).empty());
    undo(app.session);
    hand.frames(2);
    CHECK(told_points(app.session).size() == 1);
    CHECK(hand.told());
    CHECK(app.ui.widgets.contains("results/point/x")); // it is selected as it was
  }
}

TEST_CASE("a point can be typed for the motion where there is no steady state") {
  Hand hand;
  App& app = hand.app;
  open_scene(app.session, FLYBALL_CASES "/no_equilibrium.json");
  REQUIRE_FALSE(app.session.mechanism().bodies.empty());
  select(app.session, {{{PartKind::body, app.session.mechanism().bodies.front().name}}});
  set_mode(app.session, Mode::explore);
  hand.frames(3);
  REQUIRE_FALSE(converged(app.session));
  hand.click("results/point/on");
  hand.frames(2);
  CHECK(app.ui.widgets.contains("results/point/x"));
  CHECK(told_points(app.session).size() == 1);
}

TEST_CASE("plots of the motion offer the point beside the mass centre") {
  Hand hand;
  App& app = hand.app;
  app.session.motion.duration = 0.3;
  hand.key('M');
  hand.frames(3);
  REQUIRE(shown_motion(app.session));
  const auto offered = [&](const char* key) {
    const std::vector<MotionQuantity> all = motion_quantities(*shown_motion(app.session)->run);
    return std::ranges::find(all, key, &MotionQuantity::key) != all.end();
  };
  CHECK(offered("position.x ball1"));
  CHECK_FALSE(offered("point position.x ball1"));
  tell_point(app.session, body, Vec3(0, 0.3, 0));
  hand.frames(3);
  REQUIRE(shown_motion(app.session));
  CHECK(offered("position.x ball1"));
  for (const char* key :
       {"point position.x ball1", "point velocity.size ball1", "point acceleration.z ball1"})
    CHECK(offered(key));
  const Plot plot = motion_plot(app.session, "point position.y ball1");
  REQUIRE_FALSE(plot.curves.empty());
  CHECK(plot.y.label == "y position of the point of ball1");
  CHECK(plot.curves.back().points.front()[1] == Approx(0.3));
  CHECK(motion_plot(app.session, "position.y ball1").curves.back().points.front()[1] != Approx(0.3));
}

TEST_CASE("results below an inspector have a title of their own that stays") {
  Robot robot({1280, 900});
  CHECK_FALSE(robot.app.ui.widgets.contains("results/title"));
  select(robot.app.session, {{{PartKind::body, body}}});
  robot.frames(3);
  const WidgetRect title = robot.widget("results/title");
  CHECK(title.to.y <= robot.widget("results/verdict").from.y);
  const float before = robot.widget("results/verdict").from.y;
  robot.point({title.center().x, title.to.y + 60});
  for (int i = 0; i < 6; ++i) {
    ImGui::GetIO().MouseWheel = -3;
    robot.frames(2);
  }
  CHECK(robot.widget("results/title").from.y == title.from.y);
  const auto verdict = robot.app.ui.widgets.find("results/verdict");
  CHECK((verdict == robot.app.ui.widgets.end() || verdict->second.from.y < before));
}
