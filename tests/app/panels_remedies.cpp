// Where there is no steady state the panel says why and offers what mends it.
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/document/remedies.hpp"
#include "tests/catch.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// A block on a vertical slide.
struct Falling : Robot {
  Falling() : Robot({1280, 800}) {
    begin_empty(2);
    make([](Mechanism& m) {
      add_body(m, {.form = BodyForm::block, .at = {0.5, 0, 0}, .size = {0.2, 0.2, 0.2}});
      add_joint(m, JointType::prismatic, {"ground", "block1"}, {0, 0, 0}, Vec3::UnitY());
    });
  }
  void make(const std::function<void(Mechanism&)>& change) {
    ++app.session.gesture;
    edit(app.session, "Make", [&](Mechanism& m, Selection&) { change(m); });
    frames(3);
  }
  const Solution& solution() const { return app.session.answer.solution; }
  bool offers(const std::string& remedy) const { return app.ui.widgets.contains("results/remedy/" + remedy); }
};

} // namespace

TEST_CASE("a slide that nothing holds is offered a spring, a stop or no gravity") {
  Falling robot;
  REQUIRE(robot.solution().status == Status::not_converged);
  REQUIRE(robot.solution().unheld.size() == 1);
  CHECK(robot.offers("motion"));
  const std::size_t steps = robot.app.session.document.position();
  const auto remedy = GENERATE("spring", "stop", "gravity off");
  robot.click(std::string("results/remedy/") + remedy);
  robot.frames(3);
  CHECK(robot.app.session.document.position() == steps + 1);
  CHECK(robot.solution().status == Status::converged);
  CHECK_FALSE(robot.offers("motion"));
  if (remedy == std::string("spring")) {
    // It gives way by some of the mechanism's size, not by all of it or nothing.
    const double sag = robot.solution().coordinates.at(0).value;
    CHECK(sag < -0.03);
    CHECK(sag > -0.3);
  }
  undo(robot.app.session);
  robot.frames(2);
  CHECK(robot.solution().unheld.size() == 1);
}

TEST_CASE("one button shows how it moves instead") {
  Falling robot;
  REQUIRE(robot.offers("motion"));
  robot.click("results/remedy/motion");
  robot.frames(5);
  CHECK(robot.app.session.mode == Mode::explore);
  CHECK(robot.app.session.study.open == StudyKind::motion);
  CHECK(robot.app.session.motion.on);
}

TEST_CASE("weight that turns with the drive is offered gravity along the axis, or none") {
  Falling robot;
  robot.make([](Mechanism& m) {
    m.joints.clear();
    m.gravity = {0, -9.80665, 0};
    add_joint(m, JointType::revolute, {"ground", "block1"}, {0, 0, 0}, Vec3::UnitZ());
    m.joints[0].coordinates[0].drive.emplace().speed = 5;
    add_body(m, {.at = {1, 0, 0}});
    add_joint(m, JointType::revolute, {"block1", "ball1"}, {0.6, 0, 0}, Vec3::UnitZ());
  });
  REQUIRE(robot.solution().status == Status::no_steady_state);
  REQUIRE(robot.solution().weight_turns);
  CHECK(robot.offers("motion"));
  const bool along = GENERATE(true, false);
  robot.click(along ? "results/remedy/gravity along" : "results/remedy/gravity off");
  robot.frames(3);
  CHECK(robot.app.session.mechanism().gravity == (along ? Vec3(0, 0, -9.80665) : Vec3(0, 0, 0)));
  CHECK(robot.solution().status == Status::converged);
}

TEST_CASE("a loop that its drive turns has no steady state, and is shown moving") {
  Falling robot;
  robot.make([](Mechanism& m) {
    m = Mechanism{};
    m.name = "Slider-crank";
    add_body(m, {.form = BodyForm::rod, .radius = 0.02, .from = {0, 0, 0}, .to = {0.2, 0.1, 0}});
    add_body(m, {.form = BodyForm::rod, .radius = 0.02, .from = {0.2, 0.1, 0}, .to = {0.8, 0, 0}});
    add_body(m, {.form = BodyForm::block, .at = {0.8, 0, 0}, .size = {0.1, 0.1, 0.1}});
    add_joint(m, JointType::revolute, {"ground", "rod1"}, {0, 0, 0}, Vec3::UnitZ());
    add_joint(m, JointType::revolute, {"rod1", "rod2"}, {0.2, 0.1, 0}, Vec3::UnitZ());
    add_joint(m, JointType::revolute, {"rod2", "block1"}, {0.8, 0, 0}, Vec3::UnitZ());
    add_joint(m, JointType::prismatic, {"ground", "block1"}, {0.8, 0, 0}, Vec3::UnitX());
    m.joints[0].coordinates[0].drive.emplace().speed = 5;
  });
  REQUIRE(robot.solution().status == Status::no_steady_state);
  CHECK_FALSE(robot.solution().weight_turns);
  CHECK_FALSE(robot.offers("gravity off"));
  REQUIRE(robot.offers("motion"));
  robot.click("results/remedy/motion");
  robot.frames(5);
  CHECK(robot.app.session.motion.on);
  // Building ends it, and the same button has it back.
  set_mode(robot.app.session, Mode::build);
  robot.frames(3);
  robot.click("results/remedy/motion");
  robot.frames(3);
  CHECK(robot.app.session.motion.on);
}

TEST_CASE("remedies fit what they are for") {
  Mechanism m;
  add_body(m, {.at = {0, 0, 0}});
  add_body(m, {.at = {2, 0, 0}});
  add_joint(m, JointType::prismatic, {"ground", "ball1"}, {0, 0, 0}, Vec3::UnitX());
  const RunawayCoordinate right{m.joints[0].name, 0, 40}, left{m.joints[0].name, 0, -40};
  SECTION("a stop is on the side that it is pushed to") {
    Mechanism one = m;
    add_holding_stop(one, right);
    CHECK(one.joints[0].coordinates[0].stop->upper == 0.5);
    CHECK_FALSE(one.joints[0].coordinates[0].stop->lower);
    add_holding_stop(m, left);
    CHECK(m.joints[0].coordinates[0].stop->lower == -0.5);
  }
  SECTION("a spring is as stiff as the force asks") {
    add_holding_spring(m, right);
    CHECK(m.joints[0].coordinates[0].spring->stiffness == 100);
    CHECK_FALSE(can_hold(m, right));
  }
  SECTION("what is not there is left alone") {
    const Mechanism before = m;
    for (const RunawayCoordinate& none :
         {RunawayCoordinate{"ball1.free", 0, 1}, RunawayCoordinate{right.joint, 3, 1}}) {
      CHECK_FALSE(can_hold(m, none));
      add_holding_spring(m, none);
      add_holding_stop(m, none);
    }
    CHECK(m == before);
  }
  SECTION("gravity goes along the axis of all drives, or stays") {
    CHECK_FALSE(gravity_along_drives(m)); // no drive
    m.gravity = {0, -10, 0};
    add_joint(m, JointType::revolute, {"ground", "ball2"}, {2, 0, 0}, Vec3(0, 3, 4));
    m.joints[1].coordinates[0].drive.emplace().speed = 1;
    REQUIRE(gravity_along_drives(m));
    CHECK((*gravity_along_drives(m) - Vec3(0, -6, -8)).norm() < 1e-14);
    m.joints[1].axis = {0, 1, 0};
    CHECK_FALSE(gravity_along_drives(m)); // along it already
    add_joint(m, JointType::revolute, {"ball1", "ball2"}, {2, 0, 0}, Vec3::UnitX());
    m.joints[2].coordinates[0].drive.emplace().speed = 1;
    CHECK_FALSE(gravity_along_drives(m)); // two axes
  }
}
