// Springs and dampers by laws in scene files: read, written, refused with the reason.
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/catch.hpp"

using namespace flyball;

namespace {

std::string scene_with(const std::string& slide, const std::string& spring) {
  return R"~({"flyball": 2, "name": "t", "parameters": {"k": {"value": 3, "unit": "N/m"}},
    "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0]}],
    "joints": [{"name": "slide", "type": "prismatic", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [1, 0, 0],
    )~" + slide +
         R"~(}], "forces": [{"name": "f", "type": "spring", "bodies": ["ground", "a"],
    "points": [[0, 1, 0], [0, 0, 0]], )~" +
         spring + "}]}";
}

constexpr const char *plain_slide = R"~("damping": 0)~", *plain_spring = R"~("stiffness": 1)~";

std::string mistake(const std::string& slide, const std::string& spring) {
  try {
    read_scene(scene_with(slide, spring));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("laws of springs and dampers are read, found and written as they were") {
  const Mechanism m = read_scene(scene_with(
      R"~("spring": {"force": "=k*deflection + table(deflection, [0 mm, 0 N], [5 mm, 40 N], [9 mm, 200 N])",
          "free": 0.1}, "damping_force": "=4 N*tanh(rate/(2 m/s))")~",
      R"~("force": 20, "damping_force": "=3 N s/m*rate")~"));
  REQUIRE(spring_law(m.joints[0], 0));
  REQUIRE(damper_law(m.joints[0], 0));
  CHECK(damper_law(m.joints[0], 0)->text == "4 N*tanh(rate/(2 m/s))");
  CHECK(m.joints[0].coordinates[0].spring->free == 0.1);
  CHECK(m.forces[0].force == 20.0);
  CHECK_FALSE(spring_law(m.forces[0]));
  REQUIRE(damper_law(m.forces[0]));
  CHECK(read_scene(write_scene(m)) == m);
  CHECK_THAT(write_scene(m), ContainsSubstring("\"damping_force\": \"=3 N s/m*rate\""));
  CHECK_FALSE(has_number(m, "joints.slide.spring.stiffness"));
  CHECK(get_parameter(m, "forces.f.force") == 20);
  // Of several coordinates each has its own.
  const Mechanism several = read_scene(R"~({"flyball": 2, "name": "t",
    "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0]}],
    "joints": [{"name": "c", "type": "cylindrical", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [1, 0, 0],
    "spring": [null, {"force": "=100 N/m*deflection"}], "damping_force": ["=2 N m s*rate", null]}]})~");
  CHECK_FALSE(spring_law(several.joints[0], 0));
  REQUIRE(spring_law(several.joints[0], 1));
  REQUIRE(damper_law(several.joints[0], 0));
  CHECK(read_scene(write_scene(several)) == several);
}

TEST_CASE("a law's value and slope follow from its numbers") {
  const ForceLaw law("k*deflection + b*deflection^3", spring_variable);
  REQUIRE(law.names() == std::vector<std::string>{"k", "b"});
  const std::vector<Dual> numbers{Dual(3), Dual(2, 1)};
  const Dual force = law(numbers, 0.5);
  CHECK(force.value == Approx(1.5 + 0.25));
  CHECK(force.rate == Approx(0.125)); // by b
  CHECK(law(std::vector<Dual>{3, 2}, {0.5, 1}).rate == Approx(3 + 1.5));
}

TEST_CASE("what is wrong with a law is said at its place") {
  const auto of_slide = [](const std::string& slide) { return mistake(slide, plain_spring); };
  const auto of_spring = [](const std::string& spring) { return mistake(plain_slide, spring); };
  CHECK(of_slide(plain_slide) == "");
  CHECK_THAT(of_slide(R"~("spring": {"free": 1})~"),
             ContainsSubstring("joints.slide.spring.stiffness: missing"));
  CHECK_THAT(of_slide(R"~("spring": {"force": 1, "stiffness": 2})~"),
             ContainsSubstring("expected none beside"));
  CHECK_THAT(of_slide(R"~("spring": {"force": "=deflection"})~"), ContainsSubstring("expected N, found m"));
  CHECK_THAT(of_slide(R"~("spring": {"force": "=3 N/m*rate"})~"), ContainsSubstring("rate"));
  CHECK_THAT(of_slide(R"~("spring": {"force": "=sqrt(deflection/(1 m) - 1)*1 N"})~"),
             ContainsSubstring("expected a finite force at a deflection of 0"));
  CHECK_THAT(of_slide(R"~("damping_force": "=2 N + 3 N s/m*rate")~"),
             ContainsSubstring("expected no force at a rate of 0"));
  CHECK_THAT(of_slide(R"~("damping_force": 2)~"), ContainsSubstring("expected an expression of the rate"));
  CHECK_THAT(of_slide(R"~("damping": 1, "damping_force": "=3 N s/m*rate")~"),
             ContainsSubstring("joints.slide.damping: expected none beside `damping_force`"));
  CHECK_THAT(
      of_slide(
          R"~("damping_force": "=4 N*sqrt(abs(rate)/(1 m/s))*tanh(rate/(1 m/s))/abs(tanh(rate/(1 m/s)))")~"),
      ContainsSubstring("expected a finite force at a rate of 0"));
  CHECK_THAT(of_slide(R"~("damping_force": "=4 N*sqrt(abs(rate)/(1 m/s))")~"),
             ContainsSubstring("expected a finite slope at a rate of 0"));
  CHECK_THAT(of_slide(R"~("spring": {"force": "=3 N/m*coordinate(slide)"})~"),
             ContainsSubstring("joints.slide.spring.force: \"=3 N/m*coordinate(slide)\": column 7: expected "
                               "no results, as coordinate() is: it is given by the deflection alone"));
  CHECK_THAT(of_spring(R"~("damping": 1)~"), ContainsSubstring("forces.f.stiffness: missing"));
  CHECK_THAT(of_spring(R"~("force": "=2*depth")~"),
             ContainsSubstring("there is no parameter \"depth\"; expected one of deflection or k"));
  CHECK_THAT(of_spring(R"~("stiffness": 1, "damping_force": "=1 N")~"),
             ContainsSubstring("expected no force at a rate of 0"));
  std::string taken = scene_with(R"~("spring": {"force": "=k*deflection"})~", plain_spring);
  taken.replace(taken.find("\"k\""), 3, "\"deflection\"");
  try {
    read_scene(taken);
    FAIL("a parameter called deflection was taken");
  } catch (const SceneError& error) {
    CHECK_THAT(error.what(), ContainsSubstring("expected no parameter called deflection"));
  }
}
