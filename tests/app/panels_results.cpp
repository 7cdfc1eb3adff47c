// What the list of results says, and does not say twice.
#include "app/session/periodic.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "robot.hpp"
#include "slider_crank.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

float width(const WidgetRect& rect) {
  return rect.to.x - rect.from.x;
}

} // namespace

TEST_CASE("a number is told in SI below only where that is another unit") {
  Robot robot({1280, 900});
  App& app = robot.app;
  // "0.78561568149 rad  +- 1.8e-15 rad" beside "+- 2.7e-16 m"
  CHECK(width(robot.widget("results/slide/error")) < 0.6f * width(robot.widget("results/arm1/error")));
  choose_units(app.session, app.ui, app.view, {AngleUnit::radian, LengthUnit::millimetre, SpeedUnit::radian});
  robot.frames(2);
  CHECK(width(robot.widget("results/arm1/error")) < 0.6f * width(robot.widget("results/slide/error")));
}

TEST_CASE("words that are too long for their place are cut, whole characters at a time") {
  Robot robot;
  const std::string law = "0.8 N m − gain·coordinate(slide)";
  CHECK(cut_to(law, 1000) == law);
  for (const float room : {40.f, 80.f, 120.f}) {
    const std::string cut = cut_to(law, room);
    CHECK(ImGui::CalcTextSize(cut.c_str()).x <= room);
    CHECK(cut.ends_with("…"));
    CHECK(law.starts_with(cut.substr(0, cut.size() - std::string("…").size())));
  }
}

TEST_CASE("what a coordinate goes on by in a period is told beside its range") {
  Robot robot({1280, 1800}); // all rows in sight
  App& app = robot.app;
  Mechanism crank = Document::empty_mechanism();
  add_driven_slider_crank(crank, 10);
  crank.joints.front().coordinates.front().damping = 0.1; // of the crankshaft
  open_document(app.session, Document(crank));
  robot.frames(3);
  const PeriodicState* motion = periodic_motion(app.session);
  REQUIRE(motion);
  int going = 0;
  for (const PeriodicCoordinate& c : motion->coordinates) {
    const std::string row = "results/periodic/" + c.joint;
    CAPTURE(row);
    REQUIRE(app.ui.widgets.contains(row));
    CHECK(app.ui.widgets.contains(row + "/less") == c.goes_on());
    going += c.goes_on();
  }
  CHECK(going > 0);
  // What its joints bear, where it is asked for.
  app.panels->results.sections().reactions = app.panels->results.sections().springs = true;
  robot.frames(2);
  REQUIRE(motion->springs.size() == 1);
  CHECK(app.ui.widgets.contains("results/periodic/" + motion->springs[0].joint + ", damper"));
  REQUIRE_FALSE(motion->reactions.empty());
  for (const PeriodicReaction& reaction : motion->reactions)
    CHECK(app.ui.widgets.contains("results/periodic/" + reaction.name + ", force") ==
          (reaction.force.size.most > reaction.force.size.error));
  CHECK(std::ranges::any_of(motion->reactions, [](const PeriodicReaction& reaction) {
    return reaction.force.size.most > reaction.force.size.error;
  }));
}

TEST_CASE("a right click copies a result, and of a reaction all its components") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.panels->results.sections().reactions = true;
  robot.frames(3);
  CHECK(robot.copied("results/slide").starts_with("0.15001745"));
  robot.wheel("results/slide", -60); // what bears the joints lies below
  robot.frames(3);
  const std::string bears = robot.copied("results/reaction/spin");
  CHECK(bears.starts_with("0\t1990.7"));
  CHECK(bears.ends_with("\tN"));
}

TEST_CASE(
    "joints that nothing resists are all told, in lines below where they find no room beside the words") {
  Robot robot({1280, 800});
  Mechanism wheels = Document::empty_mechanism();
  const int count = GENERATE(1, 5);
  for (int i = 0; i < count; ++i) {
    const Vec3 at(0.5 * i, 0, 0);
    const std::string wheel = add_body(wheels, {.form = BodyForm::ball, .at = at, .radius = 0.1});
    add_joint(wheels, JointType::revolute, {"ground", wheel}, at, Vec3::UnitY());
  }
  open_document(robot.app.session, Document(wheels));
  robot.frames(3);
  REQUIRE(robot.app.session.answer.solution.neutral.size() == static_cast<std::size_t>(count));
  const WidgetRect told = robot.widget("results/neutral");
  CHECK(told.to.x <= 1280);
  CHECK((told.to.y - told.from.y > 2.5f * ImGui::GetFontSize()) == (count > 1));
}
