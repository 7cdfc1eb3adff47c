// Measures read, checked and written: what they ask for, mistakes by their place, names that change.
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include "tests/catch.hpp"
#include "tests/engine/mechanism_everything.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

Mechanism with_measures(std::vector<NamedMeasure> measures) {
  Mechanism m = read_scene(everything);
  m.measures = std::move(measures);
  return m;
}

std::vector<std::string> mistakes_of(const std::string& text, const std::string& unit) {
  std::vector<std::string> all;
  for (const SceneError& error : find_mistakes(with_measures({{"one", "", text, unit}})))
    all.push_back(error.what());
  return all;
}

} // namespace

TEST_CASE("A measure asks each quantity once, by places in the lists", "[measures]") {
  const Mechanism m = with_measures({{"twice", "", "2*once + x(arm@W)", "m"},
                                     {"once", "", "x(arm@W) - W.z + L", "m"},
                                     {"way", "", "distance(ground@E, 'ball')", "m"},
                                     {"turn", "", "torque(thread.0) / coordinate( thread.1 )", "N"},
                                     {"weight", "", "mass() * 9.80665 m/s^2", "N"}});
  validate(m);
  MeasurePlan plan(m);
  REQUIRE(plan.quantities().size() == 5);
  const ResultQuantity& x = plan.quantities()[0];
  CHECK(x.result == Result::x);
  CHECK(x.of[0].part == body_index(m, "arm"));
  CHECK(x.of[0].point == 0);
  CHECK(plan.quantities()[1].of[0].part == -1);
  CHECK(plan.quantities()[1].of[1].part == body_index(m, "ball"));
  CHECK(plan.quantities()[2].angle);
  CHECK_FALSE(plan.quantities()[3].angle);
  CHECK(plan.quantities()[3].of[0].coordinate == 1);
  CHECK(plan.users_of(0) == std::vector<bool>{true, true, false, false, false});

  const std::vector<Dual> found{{1, 1}, {2, 0}, {30, 0}, {10, 0}, {4, 0}};
  std::vector<Dual> values(5);
  plan.evaluate(found, values);
  CHECK(values[1].value == 1 - 8 + 5);
  CHECK(values[0].value == 2 * (1 - 8 + 5) + 1);
  CHECK(values[0].rate == 3); // through the other
  CHECK(values[3].value == 3);
  CHECK(values[4].value == 4 * 9.80665);
  CHECK(plan.fits(m));
  Mechanism other = m;
  other.parameters[0].value = 6;
  CHECK(plan.fits(other));
  plan.set_numbers(other);
  plan.evaluate(found, values);
  CHECK(values[1].value == 1 - 8 + 6);
  other.parameters[0].name = "M";
  CHECK_FALSE(plan.fits(other));
}

TEST_CASE("Mistakes of measures are told with their place", "[measures]") {
  struct Mistake {
    std::string text, unit, said;
  };
  for (const auto& [text, unit, said] : std::vector<Mistake>{
           {"x(arn)", "m", "column 3: no body is called \"arn\"; did you mean \"arm\"?"},
           {"1 m + x(arm@Q)", "m", "no point is called \"Q\""},
           {"coordinate(slid)", "m", "no joint is called \"slid\"; did you mean \"slide\"?"},
           {"coordinate(thread)", "m", "expected a coordinate of the cylindrical joint \"thread\": .0 to .1"},
           {"coordinate(slide.1)", "m", "which has one alone"},
           {"coordinate(weld)", "m", "has no coordinate"},
           {"tension(push)", "N", "expected a spring; \"push\" is a force"},
           {"force(push)", "N", "expected a spring or a bearing; \"push\" is a force"},
           {"tension(journal)", "N", "expected a spring; \"journal\" is a bearing"},
           {"couple_x(coil)", "N m", "expected a bearing; \"coil\" is a spring"},
           {"moment(journal)", "N m",
            "expected a joint; \"journal\" is a bearing, of which force() and couple() tell"},
           {"couple(journal)", "N", "expected N, found N m"},
           {"reaction(teeth)", "N", "is a gear"},
           {"torque(hinge)", "N m", "\"hinge\" has no drive"},
           {"clearance(slide)", "m", "\"slide\" has no stop"},
           {"spring(slide)", "m", "\"slide\" has no spring"},
           {"clearance(arm, table)", "m", "\"arm\" has no shapes"},
           {"x(ground)", "m", "expected a named point of the ground"},
           {"x(arm)", "N", "expected N, found m"},
           {"x(arm) + vx(arm)", "m", "cannot add"},
           {"x(arm)", "mm", "expected an SI unit"},
           {"distance(arm)", "m", "expected 2 arguments of distance, as in"},
           {"x(arm, ball)", "m", "expected 1 argument of x"},
           {"x(arm.1)", "m", "found a coordinate"},
           {"coordinate(slide@W)", "m", "found a point"},
           {"x('arm)", "m", "the end of a name in quotes"},
           {"x(sun shaft 2) + 1 m", "m", "a name that is no word stands in quotes, as 'sun shaft 2'"},
           {"x(2)", "m", "column 3: expected the name of a part"},
           {"hinge", "rad",
            "hinge is a joint, whose results are written as coordinate(hinge) or rate(hinge)"},
           {"arm", "m", "arm is a body, whose results are written as x(arm) or vx(arm)"},
           {"journal", "N", "of a part results are asked for"},
           {"2*x(arm)", "N", "expected N, found m; a factor in N/m is missing"},
           {"W", "m", "expected a coordinate of the point"},
           {"one", "", "expected no circle of measures; this one goes through one, and back"},
           {"xx(arm)", "m", "there is no function \"xx\""},
           {"", "m", "found the end"}}) {
    CAPTURE(text, unit);
    const std::vector<std::string> all = mistakes_of(text, unit);
    REQUIRE_FALSE(all.empty());
    CAPTURE(all.front());
    CHECK(all.front().starts_with("measures.one"));
    CHECK(all.front().find(said) != std::string::npos);
  }
  // All at once.
  const Mechanism m =
      with_measures({{"a", "", "x(nobody)", "m"}, {"b", "", "x(arm", "m"}, {"c", "", "x(arm)", "m"}});
  CHECK(find_mistakes(m).size() == 2);
  CHECK_THROWS_AS(MeasurePlan(m), SceneError);
  // Names of their own.
  for (const char* name : {"L", "W", "sin", "a b"})
    CHECK_FALSE(find_mistakes(with_measures({{name, "", "x(arm)", "m"}})).empty());
}

TEST_CASE("A circle through several measures names them", "[measures]") {
  const Mechanism m =
      with_measures({{"a", "", "b + x(arm)", "m"}, {"b", "", "2*c", "m"}, {"c", "", "a", "m"}});
  const std::vector<SceneError> mistakes = find_mistakes(m);
  REQUIRE(mistakes.size() == 1);
  CHECK(std::string(mistakes[0].what()).find("goes through a, b, c, and back") != std::string::npos);
}

TEST_CASE("Only measures ask for results", "[measures]") {
  for (const auto& [find, replace] : std::vector<std::pair<std::string, std::string>>{
           {R"("value": "=L/2")", R"-("value": "=x(arm)")-"}, {R"("=W.y")", R"-("=speed(arm)*1 s")-"}}) {
    try {
      read_scene(edited(find, replace));
      FAIL("no mistake");
    } catch (const SceneError& error) {
      CHECK(std::string(error.what()).find("only measures and laws of drives can use results") !=
            std::string::npos);
    }
  }
}

TEST_CASE("Measures are written as they are read", "[measures]") {
  const Mechanism m =
      with_measures({{"far", "how far", "distance(arm@W, ball)", "m"}, {"n", "", "x(arm) / L", ""}});
  const std::string text = write_scene(m);
  CHECK(text.find("\"flyball\": 2") != std::string::npos);
  CHECK(text.find("\"value\": \"=distance(arm@W, ball)\"") != std::string::npos);
  CHECK(read_scene(text) == m);
}

TEST_CASE("Names inside measures change with what they name", "[measures]") {
  const std::string text = "L + x(L@L) + L.x - reaction(L) + distance( \"L\" , other@W)";
  CHECK(renamed_in(text, "L", "length") ==
        "length + x(L@length) + length.x - reaction(L) + distance( \"L\" , other@W)");
  CHECK(part_renamed_in(text, ResultPart::body, "L", "left ball") ==
        "L + x(\"left ball\"@L) + L.x - reaction(L) + distance( \"left ball\" , other@W)");
  CHECK(part_renamed_in(text, ResultPart::joint, "L", "a\"b") ==
        "L + x(L@L) + L.x - reaction('a\"b') + distance( \"L\" , other@W)");
  CHECK(part_renamed_in("x(", ResultPart::body, "x", "y") == "x("); // no expression
  CHECK(part_renamed_in("clearance(a) + clearance(a, b)", ResultPart::joint, "a", "c") ==
        "clearance(c) + clearance(a, b)");
}
