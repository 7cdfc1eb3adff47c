// Bodies pulled by hand: along their joints while building, by a spring while exploring.
#include "robot.hpp"

#include "app/document/redraw.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/grip.hpp"
#include "engine/solve/assembly_drag.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <numbers>
#include <random>

using namespace flyball;
using namespace flyball::test;

namespace {

struct Hand : Robot {
  explicit Hand(::flyball::Mode mode) : Robot({1280, 800}) { start(mode); }
  void start(::flyball::Mode mode) {
    set_mode(app.session, mode);
    look_from(app.view, 0, 0);
    frames(3);
  }
  // A bar with two stable states: a spring that is pressed together pushes it to either side.
  void open_toggle(::flyball::Mode mode) {
    Mechanism m;
    m.name = "Toggle";
    const double angle = 0.5;
    const Vec3 tip(std::sin(angle), std::cos(angle), 0);
    m.bodies = {{.name = "bar",
                 .description = {},
                 .mass = 1,
                 .position = tip,
                 .inertia = {0.1, 0.1, 0.1},
                 .shapes = {}}};
    Shape ball;
    ball.radius = 0.08;
    m.bodies[0].shapes = {ball};
    Joint hinge;
    hinge.name = "hinge";
    hinge.bodies = {"ground", "bar"};
    hinge.coordinates.resize(1);
    m.joints = {hinge};
    Force spring;
    spring.name = "spring";
    spring.bodies = {"ground", "bar"};
    spring.points = {Vec3(0, 2, 0), tip};
    spring.stiffness = 100;
    spring.free_length = 1.2;
    m.forces = {spring};
    open_document(app.session, Document(m));
    start(mode);
  }

  Vec3 drawn(const char* name) const {
    return app.session.mechanism()
        .bodies.at(static_cast<std::size_t>(body_index(app.session.mechanism(), name)))
        .position;
  }
  Vec3 shown(const char* name) const {
    return app.session.poses.at(static_cast<std::size_t>(body_index(app.session.mechanism(), name))).position;
  }
  double settled(const char* joint) const { return value(app.session.answer.solution, joint); }
  void take(const Vec3& at) {
    hold(false, false, true);
    point(pixel(at));
    press();
  }
  void pull_to(const Vec3& to, int steps = 8) {
    const ImVec2 from = ImGui::GetIO().MousePos, end = pixel(to);
    for (int i = 1; i <= steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps);
      point({from.x + t * (end.x - from.x), from.y + t * (end.y - from.y)});
    }
    frames(2);
  }
  void let_go() {
    release();
    hold(false, false, false);
    frames(3);
  }
};

Vec3 in_view(const Vec3& point) {
  return {point.x(), point.y(), 0};
}

} // namespace

TEST_CASE("a body pulled while building moves along its joints, in one step") {
  Hand hand(::flyball::Mode::build);
  const Mechanism before = hand.app.session.mechanism();
  const Vec3 ball = hand.drawn("ball1"), collar = hand.drawn("collar"), spindle = hand.drawn("spindle");
  const bool by_tool = GENERATE(false, true);
  if (by_tool) {
    hand.key('H');
    CHECK(hand.app.tool.tool == Tool::pull);
    CHECK(hand.app.session.mode == ::flyball::Mode::build);
    hand.point(hand.pixel(ball));
    hand.press();
  } else {
    hand.take(ball);
  }
  REQUIRE(hand.app.tool.assembly);
  CHECK(hand.app.session.document.position() == 0); // a press moves nothing
  const Vec3 pivot = before.joints[static_cast<std::size_t>(joint_index(before, "arm1"))].at;
  const Vec3 target = pivot + Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * (ball - pivot);
  hand.pull_to(target);
  CHECK((in_view(hand.drawn("ball1")) - in_view(target)).norm() < 0.003); // a pixel
  CHECK((hand.drawn("collar") - collar).norm() > 0.01);
  CHECK((hand.drawn("spindle") - spindle).norm() < 1e-9);
  // The start is seen beside it.
  const ViewFrame frame = view_frame(hand.app.session, hand.app.ui, hand.app.tool, hand.app.view);
  REQUIRE(frame.ghost.size() == before.bodies.size());
  CHECK(frame.ghost_pose == GhostPose::drawn);
  CHECK(frame.ghost[static_cast<std::size_t>(body_index(before, "ball1"))].position == ball);
  SECTION("let go, undone and done again") {
    hand.let_go();
    CHECK_FALSE(hand.app.tool.assembly);
    CHECK(hand.app.session.document.position() == 1);
    CHECK(hand.app.session.document.steps()[1].name == "Pull ball1");
    CHECK(hand.app.session.mistakes.empty());
    CHECK(converged(hand.app.session));
    // It is closed as it is drawn.
    CHECK(is_drawn_in(hand.app.session.mechanism(), AssemblyDrag(hand.app.session.mechanism()).pose()));
    const Mechanism moved = hand.app.session.mechanism();
    undo(hand.app.session);
    CHECK(hand.app.session.mechanism() == before);
    redo(hand.app.session);
    CHECK(hand.app.session.mechanism() == moved);
  }
  SECTION("taken back with Escape") {
    hand.key(key_escape);
    hand.let_go();
    CHECK(hand.app.session.mechanism() == before);
    CHECK_FALSE(hand.app.tool.assembly);
    CHECK(hand.app.session.selection().empty());
  }
  SECTION("pulled on where it cannot go") {
    hand.pull_to(pivot + 3 * (target - pivot));
    const Vec3 along = (in_view(target - pivot)).normalized();
    CHECK((in_view(hand.drawn("ball1") - pivot).normalized() - along).norm() < 0.02);
    hand.let_go();
    CHECK(is_drawn_in(hand.app.session.mechanism(), AssemblyDrag(hand.app.session.mechanism()).pose()));
  }
}

TEST_CASE("the same equilibrium follows a pull while building") {
  Hand hand(::flyball::Mode::build);
  const double arm = hand.settled("arm1"), slide = hand.settled("slide");
  hand.take(hand.drawn("ball1"));
  hand.pull_to(hand.drawn("ball1") + Vec3(0.02, 0.06, 0));
  hand.let_go();
  CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-9));
  CHECK(hand.settled("slide") == Approx(slide).epsilon(1e-9));
}

TEST_CASE("without a body under it the hand turns the view, and a click selects") {
  Hand hand(::flyball::Mode::build);
  hand.key('H');
  const double azimuth = hand.app.view.camera.azimuth;
  const WidgetRect view = hand.widget("view");
  hand.drag({view.to.x - 60, view.from.y + 120}, {view.to.x - 160, view.from.y + 120});
  CHECK(hand.app.view.camera.azimuth != azimuth);
  CHECK(hand.app.session.document.position() == 0);
  look_from(hand.app.view, 0, 0);
  hand.frames(3);
  hand.click_at(hand.drawn("ball1"));
  CHECK(hand.app.session.selection().parts == std::vector<Part>{{PartKind::body, "ball1"}});
  CHECK(hand.app.session.document.position() == 0);
  hand.key(key_escape);
  CHECK(hand.app.tool.tool == Tool::select);
}

TEST_CASE("a coordinate is moved to a number") {
  Hand hand(::flyball::Mode::build);
  select(hand.app.session, {{{PartKind::joint, "slide"}}});
  hand.frames(3);
  const Mechanism before = hand.app.session.mechanism();
  const double arm = hand.settled("arm1"),
               label =
                   before.joints[static_cast<std::size_t>(joint_index(before, "slide"))].coordinates[0].drawn;
  hand.click("inspector/move");
  hand.type(std::to_string(label + 0.03) + " m");
  hand.key(key_enter);
  const Mechanism& m = hand.app.session.mechanism();
  CHECK(m.joints[static_cast<std::size_t>(joint_index(m, "slide"))].coordinates[0].drawn ==
        Approx(label + 0.03).epsilon(1e-6));
  CHECK(
      (hand.drawn("collar") - before.bodies[static_cast<std::size_t>(body_index(before, "collar"))].position)
          .norm() == Approx(0.03).epsilon(1e-4));
  CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-9));
  CHECK(is_drawn_in(m, AssemblyDrag(m).pose()));
  undo(hand.app.session);
  CHECK(hand.app.session.mechanism() == before);
}

TEST_CASE("the steady state can become the drawn pose") {
  Hand hand(::flyball::Mode::build);
  const Mechanism before = hand.app.session.mechanism();
  const double arm = hand.settled("arm1");
  hand.app.commands.run("edit.settle");
  hand.frames(2);
  CHECK(hand.app.session.mechanism() != before);
  CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-12));
  const Mechanism& m = hand.app.session.mechanism();
  CHECK(m.joints[static_cast<std::size_t>(joint_index(m, "arm1"))].coordinates[0].drawn == Approx(arm));
  for (std::size_t i = 0; i < m.bodies.size(); ++i)
    CHECK((hand.app.session.answer.solution.poses[i].position - m.bodies[i].position).norm() < 1e-10);
  CHECK(hand.app.session.document.position() == 1);
  hand.app.commands.run("edit.settle");
  CHECK(hand.app.session.document.position() == 1);
  undo(hand.app.session);
  CHECK(hand.app.session.mechanism() == before);
}

TEST_CASE("a pull while exploring is a spring that turns with the spindle") {
  Hand hand(::flyball::Mode::explore);
  const Mechanism before = hand.app.session.mechanism();
  const std::uint64_t revision = hand.app.session.document.revision();
  const Vec3 ball = hand.shown("ball1");
  const double arm = hand.settled("arm1");
  hand.take(ball);
  REQUIRE(hand.app.tool.pull);
  hand.frames(1);
  REQUIRE(hand.app.tool.pull->grip);
  CHECK(hand.app.tool.pull->grip->holder == "spindle");
  hand.pull_to(ball + Vec3(0, 0.06, 0));
  REQUIRE(hand.app.tool.pull->pull);
  const Pull pull = *hand.app.tool.pull->pull;
  CHECK(hand.shown("ball1").y() - ball.y() > 0.015); // a visible part of it
  CHECK(hand.app.session.document.revision() == revision);
  CHECK(hand.app.session.mechanism() == before);
  // What an ordinary scene with that spring settles in.
  Mechanism with = before;
  Force spring;
  spring.name = "pulls";
  spring.bodies = {"spindle", "ball1"};
  spring.points = {pull.hand, pull.at};
  spring.stiffness = pull.stiffness;
  spring.free_length = 0;
  with.forces.push_back(spring);
  SolveOptions options;
  options.start = start_values(hand.app.session.answer.solution.coordinates);
  const Solution expected = Analysis(with).solve(options);
  REQUIRE(expected.status == Status::converged);
  REQUIRE(converged(hand.app.session));
  for (std::size_t i = 0; i < expected.coordinates.size(); ++i)
    CHECK(std::abs(expected.coordinates[i].value - hand.app.session.answer.solution.coordinates[i].value) <
          1e-12);
  // Its force is told.
  const auto force = hand_force(hand.app.session, hand.app.tool);
  REQUIRE(force);
  const Vec3 stretched = carried_point(with, expected.poses, body_index(with, "spindle"), pull.hand) -
                         carried_point(with, expected.poses, body_index(with, "ball1"), pull.at);
  CHECK(*force == Approx(pull.stiffness * stretched.norm()));
  CHECK(hand.app.ui.widgets.contains("results/pull"));
  SECTION("and is gone with the hand") {
    hand.let_go();
    CHECK_FALSE(hand.app.tool.pull);
    CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-10));
    CHECK((hand.shown("ball1") - ball).norm() < 1e-9);
    CHECK(hand.app.session.answer.mechanism->forces.size() == before.forces.size());
    CHECK(hand.app.session.notice.empty());
    CHECK_FALSE(hand.app.session.document.can_undo());
  }
  SECTION("and is as stiff as the wheel makes it") {
    const double distance = hand.app.view.camera.distance;
    const double reached = hand.shown("ball1").y();
    ImGui::GetIO().MouseWheel = 4;
    hand.frames(2);
    CHECK(hand.app.view.camera.distance == distance);
    CHECK(hand.app.tool.pull->pull->stiffness == Approx(pull.stiffness * std::pow(1.25, 4)));
    CHECK(hand.shown("ball1").y() > reached);
    hand.let_go();
    CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-10));
  }
  SECTION("and is taken back with Escape") {
    hand.key(key_escape);
    CHECK_FALSE(hand.app.tool.pull);
    CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-10));
    hand.let_go();
  }
}

TEST_CASE("pulled beyond all that stands near, a mechanism stays as it was") {
  Hand hand(::flyball::Mode::explore);
  Session& session = hand.app.session;
  open_scene(session, shipped_file("governor_engine"));
  hand.start(::flyball::Mode::explore);
  const Vec3 ball = hand.shown("ball1");
  const double arm = hand.settled("arm1"), speed = *coordinate(session.answer.solution, "spin").speed;
  hand.take(ball);
  hand.pull_to(ball + Vec3(0, 0.01, 0));
  CHECK(hand_force(session, hand.app.tool));
  bool refused = false;
  for (int notch = 0; notch < 30; ++notch) {
    ImGui::GetIO().MouseWheel = 1;
    hand.frames(2);
    REQUIRE(converged(session));
    REQUIRE(session.answer.solution.stable == true);
    REQUIRE(std::abs(hand.settled("arm1") - arm) < 0.5); // not through the spindle
    refused = refused || session.pulled_too_far;
    CHECK(session.pulled_too_far == !hand_force(session, hand.app.tool));
  }
  CHECK(refused);
  hand.let_go();
  CHECK_FALSE(session.pulled_too_far);
  CHECK(hand.settled("arm1") == Approx(arm).epsilon(1e-9));
  CHECK(*coordinate(session.answer.solution, "spin").speed == Approx(speed).epsilon(1e-9));
  CHECK(session.notice.empty());
}

TEST_CASE("a turning mechanism stands while it is pulled") {
  Hand hand(::flyball::Mode::explore);
  play(hand.app.session, true);
  hand.frames(20, 0.02);
  const double time = hand.app.session.playback.time;
  REQUIRE(time > 0.1);
  const Vec3 ball = hand.shown("ball1");
  hand.take(ball);
  REQUIRE(hand.app.tool.pull);
  CHECK_FALSE(hand.app.session.playback.playing);
  const double at = hand.app.session.playback.time;
  hand.pull_to(ball + Vec3(0, 0.06, 0));
  CHECK(hand.app.session.playback.time == at);
  // It gives way to where the hand is seen, at the phase shown.
  CHECK(hand.shown("ball1").y() > ball.y() + 0.015);
  hand.let_go();
  CHECK(hand.app.session.playback.playing);
  hand.frames(3, 0.02);
  CHECK(hand.app.session.playback.time > at);
}

TEST_CASE("a pull can bring a mechanism over to its other stable state") {
  Hand hand(::flyball::Mode::explore);
  hand.open_toggle(::flyball::Mode::explore);
  const double angle = hand.settled("hinge"), over = 0.5 + std::acos(0.89); // from where it is drawn
  REQUIRE(std::abs(angle) < 0.1);
  const Vec3 tip = hand.shown("bar");
  SECTION("a little is not enough") {
    hand.take(tip);
    hand.pull_to(tip + Vec3(0.1, 0, 0));
    CHECK(std::abs(hand.settled("hinge") - angle) > 0.01);
    hand.let_go();
    CHECK(hand.settled("hinge") == Approx(angle).margin(1e-9));
    CHECK(hand.app.session.notice.empty());
  }
  SECTION("enough is") {
    hand.take(tip);
    hand.pull_to(Vec3(-0.9, 0.9, 0), 40);
    hand.let_go();
    CHECK(hand.settled("hinge") == Approx(over).epsilon(1e-9));
    CHECK_THAT(hand.app.session.notice, ContainsSubstring("another steady state"));
    CHECK_FALSE(hand.app.session.document.can_undo());
    solve_from_drawn_pose(hand.app.session);
    hand.frames(2);
    CHECK(hand.settled("hinge") == Approx(angle).margin(1e-9));
  }
}

TEST_CASE("what a drive turns does not give way, and says so") {
  Hand hand(::flyball::Mode::explore);
  // The lower end of the spindle.
  const Mechanism& m = hand.app.session.mechanism();
  Vec3 at = hand.shown("spindle");
  for (const Shape& shape : m.bodies[static_cast<std::size_t>(body_index(m, "spindle"))].shapes)
    if (shape.type == ShapeType::capsule || shape.type == ShapeType::cylinder)
      at = shape.from.y() < shape.to.y() ? shape.from : shape.to;
  hand.take(at + Vec3(0, 0.01, 0));
  hand.frames(2);
  CHECK_FALSE(hand.app.tool.pull);
  CHECK_THAT(hand.app.session.notice, ContainsSubstring("no other body turns with it"));
  hand.let_go();
}

TEST_CASE("whatever is pulled in whatever way, the mechanism stays whole") {
  std::mt19937 dice(3);
  const auto below = [&](int n) { return static_cast<int>(dice() % static_cast<unsigned>(n)); };
  Hand hand(::flyball::Mode::explore);
  hand.app.commands.run("edit.settle"); // drawn with its loops closed to the last digit
  hand.frames(2);
  const Mechanism first = hand.app.session.mechanism();
  for (int i = 0; i < 40; ++i) {
    INFO(i);
    if (below(4) == 0) {
      hand.start(below(2) == 0 ? ::flyball::Mode::build : ::flyball::Mode::explore);
      look_from(hand.app.view, 0.3 * below(20), 0.2 * below(7));
      hand.frames(2);
    }
    const bool build = hand.app.session.mode == ::flyball::Mode::build;
    const auto body =
        static_cast<std::size_t>(below(static_cast<int>(hand.app.session.mechanism().bodies.size())));
    REQUIRE(hand.app.session.poses.size() == hand.app.session.mechanism().bodies.size());
    hand.take(build ? hand.app.session.mechanism().bodies[body].position
                    : hand.app.session.poses[body].position);
    for (int k = below(5); k >= 0; --k) {
      const ImVec2 at = ImGui::GetIO().MousePos;
      hand.point({at.x + static_cast<float>(below(121) - 60), at.y + static_cast<float>(below(121) - 60)});
    }
    if (below(5) == 0) hand.key(key_escape);
    hand.let_go();
    CHECK_FALSE(hand.app.tool.assembly);
    CHECK_FALSE(hand.app.tool.pull);
    CHECK(hand.app.session.mistakes.empty());
    REQUIRE(converged(hand.app.session));
    CHECK(is_drawn_in(hand.app.session.mechanism(), AssemblyDrag(hand.app.session.mechanism()).pose()));
    if (below(6) == 0 && hand.app.session.document.position() > 1) {
      undo(hand.app.session);
      hand.frames(2);
    }
  }
  for (std::size_t i = 0; i < first.bodies.size(); ++i)
    CHECK(hand.app.session.mechanism().bodies[i].mass == first.bodies[i].mass);
}

TEST_CASE("a hand pulls no harder where an engine's law holds what is pulled") {
  const Mechanism engine = shipped("governor_engine");
  const Solution state = Analysis(engine).solve({});
  REQUIRE(state.status == Status::converged);
  const int ball = body_index(engine, "ball1");
  const BodyPoint point{"ball1", engine.bodies[static_cast<std::size_t>(ball)].position};
  const Grip held = find_grip(engine, state, point);
  // The same governor at a given speed, which gives way to the hand.
  Mechanism given = engine;
  given.sliders.clear();
  for (Joint& joint : given.joints)
    for (Coordinate& c : joint.coordinates)
      if (c.drive && c.drive->torque) {
        c.drive->torque.reset();
        c.drive->load.reset();
        c.drive->speed = *coordinate(state, joint.name).speed;
        joint.formulas.clear();
      }
  const Solution steady = Analysis(given).solve({});
  REQUIRE(steady.status == Status::converged);
  const Grip free = find_grip(given, steady, point);
  CHECK(held.stiffness < 10 * free.stiffness);
  CHECK(held.stiffness > 0);
}
