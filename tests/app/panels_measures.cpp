// Measures by mouse and keys: added, changed, renamed, shown, plotted, wanted, removed.
#include "desk.hpp"

#include "app/document/measure_edits.hpp"
#include "app/document/rename.hpp"
#include "app/session/response_quantity.hpp"
#include "app/ui/commands.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;
using namespace flyball::test;

namespace {

struct MeasureDesk : Desk {
  explicit MeasureDesk(const char* scene = "governor") : Desk(scene, {1200, 1000}) {}
  void build() { // and nothing selected
    Desk::build();
    select(app.session, {});
    frames(2);
  }
  void solved() {
    for (int i = 0; i < 2000 && solving(app.session); ++i)
      frames(1);
    REQUIRE(converged(app.session));
  }
  double value(const std::string& name) {
    solved();
    const auto& all = app.session.answer.solution.measures;
    const auto found = std::ranges::find(all, name, &MeasureSolution::name);
    REQUIRE(found != all.end());
    REQUIRE(found->value.has_value());
    return *found->value;
  }
};

double slide_of(const Session& session) {
  const auto& all = session.answer.solution.coordinates;
  return std::ranges::find(all, "slide", &CoordinateSolution::joint)->value;
}

} // namespace

TEST_CASE("a measure is added, changed, renamed and removed by hand") {
  MeasureDesk d;
  d.build();
  d.click("inspector/measures section");
  d.frames(2);
  d.click("inspector/measures/add");
  d.frames(2);
  REQUIRE(d.m().measures.size() == 1);
  CHECK(d.m().measures[0].name == "height");
  CHECK(d.m().measures[0].text == "y(collar)");
  CHECK(std::abs(d.value("height") - (0.2 - slide_of(d.app.session))) < 1e-12);
  CHECK(d.app.ui.widgets.contains("results/measure/height"));

  d.enter("inspector/measure/height", "=coordinate(slide) - 0.1 m");
  CHECK(std::abs(d.value("height") - (slide_of(d.app.session) - 0.1)) < 1e-12);
  d.enter("inspector/measure/height/name", "rise");
  CHECK(d.m().measures[0].name == "rise");
  const std::size_t steps = d.app.session.document.position();

  SECTION("names and functions are offered while it is typed, for Tab and for a click") {
    const std::string field = "inspector/measure/rise";
    d.frames(60);
    d.click(field);
    d.type("=dist");
    d.frames(3);
    REQUIRE(d.app.ui.widgets.contains(field + "/completion/distance("));
    d.key(keys::tab);
    d.frames(2);
    CHECK(d.app.ui.fields.typing.text == "=distance(");
    d.type("ball");
    d.frames(3);
    d.click(field + "/completion/ball1"); // between the brackets bodies come first
    d.frames(4);
    CHECK(d.app.ui.fields.typing.text == "=distance(ball1");
    d.type(", ball2)");
    d.frames(2);
    d.key(key_enter);
    d.frames(3);
    CHECK(d.m().measures[0].text == "distance(ball1, ball2)");
  }
  SECTION("Escape ends what is offered, so that Tab goes on; a name has nothing offered") {
    d.frames(60);
    d.click("inspector/measure/rise");
    d.type("=dist");
    d.frames(3);
    REQUIRE(completes(d.app.ui.completion));
    d.key(key_escape);
    d.frames(2);
    CHECK_FALSE(completes(d.app.ui.completion));
    d.frames(60);
    d.click("inspector/measure/rise/name");
    d.type("=dist");
    d.frames(3);
    CHECK(d.app.ui.fields.typing.text == "=dist");
    CHECK(d.app.ui.completion.found.list.empty());
    d.key(key_escape);
  }
  SECTION("what is wrong with it is said while it is typed") {
    d.frames(60);
    d.click("inspector/measure/rise");
    d.type("=coordinate(slid)");
    d.frames(1);
    CHECK(d.app.ui.fields.typing.mistake.find("did you mean \"slide\"") != std::string::npos);
    d.key(key_escape);
    d.frames(2);
    CHECK(d.app.session.document.position() == steps);
    CHECK(d.m().measures[0].text == "coordinate(slide) - 0.1 m");
  }
  SECTION("its unit goes with the expression") {
    for (const auto& [text, unit] : {std::pair("torque(spin)", "N m"),
                                     {"rate(slide)", "m/s"},
                                     {"2*torque(spin)*speed(ball1)", "kg m^3/s^3"},
                                     {"coordinate(arm1)", "rad"},
                                     {"y(ball1)/y(ball2)", "rad"}}) {
      CAPTURE(text);
      d.enter("inspector/measure/rise", "=" + std::string(text));
      CHECK(d.m().measures[0].text == text);
      CHECK(d.m().measures[0].unit == unit);
      CHECK(find_mistakes(d.m()).empty());
    }
    d.enter("inspector/measure/rise", "=y(collar)");
    d.enter("inspector/measure/rise", "=y(ball1)/y(ball2)");
    CHECK(d.m().measures[0].unit == "");
    CHECK(find_mistakes(d.m()).empty());
  }
  SECTION("parts that are renamed are renamed in it") {
    edit(d.app.session, "rename", [](Mechanism& mechanism, Selection&) {
      rename_part(mechanism, {PartKind::joint, "slide"}, "the slide");
    });
    d.frames(2);
    CHECK(d.m().measures[0].text == "coordinate(\"the slide\") - 0.1 m");
    CHECK(d.value("rise") > 0);
    d.key('Z', true);
    d.frames(2);
    CHECK(d.m().measures[0].text == "coordinate(slide) - 0.1 m");
  }
  SECTION("it goes, and comes back") {
    d.click("inspector/measure/rise/more");
    d.frames(2);
    d.click("inspector/measure/rise/remove");
    d.frames(2);
    CHECK(d.m().measures.empty());
    d.key('Z', true);
    d.frames(2);
    CHECK(d.m().measures.size() == 1);
  }
  SECTION("units are as a person wants them") {
    d.app.session.units.length = LengthUnit::millimetre;
    d.frames(2);
    CHECK(d.app.ui.widgets.contains("results/measure/rise"));
  }
}

TEST_CASE("a measure that rests on a part goes with it") {
  Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/governor.json");
  m.measures = {{"a", "", "x(ball1)", "m"}, {"b", "", "2*a", "m"}, {"c", "", "y(collar)", "m"}};
  drop_lost_measures(m);
  CHECK(m.measures.size() == 3);
  m.bodies[1].name = "other";
  drop_lost_measures(m);
  REQUIRE(m.measures.size() == 1);
  CHECK(m.measures[0].name == "c");
}

TEST_CASE("what goes with a deleted part is told, measures too") {
  MeasureDesk d("governor");
  edit(d.app.session, "Measure", [](Mechanism& m, Selection&) {
    m.measures = {
        {"lift", "", "y(collar)", "m"}, {"height", "", "y(ball1)", "m"}, {"twice", "", "2*height", "m"}};
  });
  d.pick(PartKind::body, "ball1");
  d.key(keys::del);
  d.frames(2);
  CHECK(d.app.session.notice ==
        "Deleted ball1 together with joints arm1 and link1, measures height and twice.");
  REQUIRE(d.m().measures.size() == 1);
  undo(d.app.session);
  CHECK(d.m().measures.size() == 3);
}

TEST_CASE("without a measure others have its expression, without a parameter its value") {
  Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/governor_parametric.json");
  m.measures = {{"a", "", "x(ball1) + L", "m"}, {"b", "", "2*a", "m"}};
  remove_measure(m, "a");
  REQUIRE(m.measures.size() == 1);
  CHECK(m.measures[0].text == "2*(x(ball1) + L)");
  set_measure(m, "b", {"twice", "", "2*L", "m"});
  CHECK(m.measures[0].name == "twice");
  CHECK(measure_mistake(m, "twice", {"L", "", "2 m", "m"}).find("there is a \"L\" already") !=
        std::string::npos);
  CHECK(measure_mistake(m, "twice", {"twice", "", "2*L", "N"}).find("expected N, found m") !=
        std::string::npos);
}

TEST_CASE("measures are drawn over a number and wanted") {
  MeasureDesk d("governor_parametric");
  d.solved();
  const auto offered = response_quantities(response_point(d.app.session.answer.solution, 0));
  const auto quantity = std::ranges::find(offered, "measure ball_pull", &ResponseQuantity::key);
  REQUIRE(quantity != offered.end());
  CHECK(quantity->unit == "N");
  CHECK(quantity->group == "Measures");
  CHECK(quantity_values(response_point(d.app.session.answer.solution, 0), "measure ball_pull").size() == 1);
}
