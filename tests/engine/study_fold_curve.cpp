// Curves in the plane of two parameters against closed forms.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/fold_curve.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

double first_coordinate(const PlanePoint& p) {
  for (const CoordinateSolution& c : p.coordinates)
    if (!c.driven) return c.value;
  return 0;
}

// A point mass 0.7 m below a hinge that is `offset` from the axis in the drawn pose; moving the hinge then
// changes length and zero of the angle, too.
Mechanism hinge_off_axis(double offset) {
  Mechanism m = conical(0.7, 0, 1);
  m.joints[1].at.x() = offset;
  return m;
}

} // namespace

TEST_CASE("the fold of the conical pendulum over its hinge's offset, through the cusp", "[plane]") {
  // w^2 = g / (L cos^3 a), sin^3 a = -o / L; L^2 = 0.7^2 + o^2.
  PlaneOptions options;
  options.all = true; // leaning in is not connected with the drawn pose
  const PlaneCurves plane =
      fold_curves(hinge_off_axis(0.1), {speed, 3, 8}, {"joints.swing.at.0", -0.2, 0.2}, options);
  INFO(plane.message);
  REQUIRE(plane.status == Status::converged);
  const auto folds =
      std::ranges::count_if(plane.curves, [](const PlaneCurve& c) { return c.type == PlaneCurveType::fold; });
  REQUIRE(folds == 1);
  const PlaneCurve& curve = *std::ranges::find(plane.curves, PlaneCurveType::fold, &PlaneCurve::type);
  REQUIRE(curve.points.size() > 20);
  for (const PlanePoint& p : curve.points) {
    const double o = p.y, length = std::hypot(0.7, o), sine = -std::cbrt(o / length);
    const double cosine = std::sqrt(1 - sine * sine);
    CAPTURE(p.x, p.y);
    CHECK(std::abs(p.x - std::sqrt(standard_gravity / (length * cosine * cosine * cosine))) < 1e-10);
    CHECK(std::abs(first_coordinate(p) - std::atan2(o, 0.7) - std::asin(sine)) < 1e-8);
  }
  CHECK(std::abs(std::abs(curve.points.front().y) - 0.2) < 1e-12);
  CHECK(std::abs(std::abs(curve.points.back().y) - 0.2) < 1e-12);
  CHECK(curve.points.front().y * curve.points.back().y < 0);
  CHECK(curve.begin == "the border of the plane");
  CHECK(curve.end == "the border of the plane");
  REQUIRE(curve.cusps.size() == 1);
  CHECK(std::abs(curve.cusps[0].x - std::sqrt(standard_gravity / 0.7)) < 1e-8);
  CHECK(std::abs(curve.cusps[0].y) < 1e-8);
}

TEST_CASE("a fold over gravity goes with its root, and has the reference's place", "[plane]") {
  const Mechanism m = conical(0.7, 0.1, 10, -0.9); // drawn leaning in
  PlaneOptions all;
  all.all = true;
  all.at = {-standard_gravity};
  const PlaneCurves searched = fold_curves(m, {speed, 2, 10}, {"gravity.1", -20, -2}, all);
  REQUIRE(searched.curves.size() == 1);
  const PlaneCurve& curve = searched.curves[0];
  REQUIRE(curve.points.size() > 10);
  for (const PlanePoint& p : curve.points) {
    CHECK(std::abs(p.x - 4.75536807929276 * std::sqrt(-p.y / standard_gravity)) < 1e-10);
    CHECK(std::abs(first_coordinate(p) + 0.5500829670481832) < 1e-8);
  }
}

TEST_CASE("the branch point of the conical pendulum over gravity", "[plane]") {
  const PlaneCurves plane = fold_curves(conical(0.7, 0, 1), {speed, 0, 10}, {"gravity.1", -20, -2});
  INFO(plane.message);
  REQUIRE(plane.curves.size() == 1);
  CHECK(plane.curves[0].type == PlaneCurveType::branch_point);
  REQUIRE(plane.curves[0].points.size() > 10);
  for (const PlanePoint& p : plane.curves[0].points) {
    CHECK(std::abs(p.x - std::sqrt(-p.y / 0.7)) < 1e-9);
    CHECK(std::abs(first_coordinate(p)) < 1e-9);
  }
}

TEST_CASE("the curve of a constant coordinate", "[plane]") {
  // cos(a) = g / (w^2 L)
  const PlaneCurves plane =
      value_curves(conical(0.7, 0, 1), {speed, 1, 10}, {"gravity.1", -30, -1}, "swing", 0.8);
  INFO(plane.message);
  REQUIRE(plane.status == Status::converged);
  REQUIRE(plane.curves.size() == 1);
  const PlaneCurve& curve = plane.curves[0];
  REQUIRE(curve.points.size() > 10);
  for (const PlanePoint& p : curve.points) {
    CHECK(std::abs(p.x - std::sqrt(-p.y / (0.7 * std::cos(0.8)))) < 1e-11);
    CHECK(std::abs(first_coordinate(p) - 0.8) < 1e-13);
    CHECK(p.stable == true);
  }
  CHECK(std::abs(curve.points.front().y - curve.points.back().y) == Approx(29).epsilon(1e-10));
}

TEST_CASE("the governor's collar at 0.12 m over speed and stiffness agrees with solves", "[plane]") {
  const Mechanism m = shipped("governor");
  const std::string stiffness = "joints.slide.spring.stiffness";
  const PlaneCurves plane = value_curves(m, {speed, 2, 20}, {stiffness, 200, 3000}, "slide", 0.12);
  INFO(plane.message);
  REQUIRE_FALSE(plane.curves.empty());
  for (const PlaneCurve& curve : plane.curves)
    for (std::size_t i = 0; i < curve.points.size(); i += 5) {
      const PlanePoint& p = curve.points[i];
      Mechanism there = m;
      set_parameter(there, speed, p.x);
      set_parameter(there, stiffness, p.y);
      SolveOptions options;
      options.nearest = true;
      for (const CoordinateSolution& c : p.coordinates)
        if (!c.driven) options.start.emplace_back(c.joint, c.value);
      const Solution s = Analysis(there).solve(options);
      REQUIRE(s.status == Status::converged);
      CHECK(std::abs(value(s, "slide") - 0.12) < 1e-12);
      CHECK(s.stable == p.stable);
    }
}

TEST_CASE("no folds is an answer, mistakes are refused and cancelling ends", "[plane]") {
  const PlaneCurves none =
      fold_curves(shipped("governor"), {speed, 8, 12}, {"joints.slide.spring.stiffness", 800, 1500});
  CHECK(none.status == Status::converged);
  CHECK(none.curves.empty());
  CHECK(none.message.find("No ") == 0);
  CHECK_THROWS_AS(fold_curves(shipped("governor"), {"no.thing", 8, 12}, {speed, 8, 15}), SceneError);
  CHECK_THROWS_AS(value_curves(shipped("governor"), {speed, 8, 12}, {"gravity.1", -9, -8}, "spin", 1),
                  SceneError);
  const std::atomic<bool> cancel = true;
  PlaneOptions options;
  options.cancel = &cancel;
  CHECK(fold_curves(conical(0.7, 0, 1), {speed, 0, 10}, {"gravity.1", -20, -2}, options).curves.empty());
}
