// Branches over a grid, and all equilibria over one: against closed forms and against each place by itself.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/branch_grid.hpp"
#include "engine/study/fold_curve.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

} // namespace

TEST_CASE("a conical pendulum's fork over gravity and mass stands where w^2 L = g") {
  const Mechanism m = conical(0.7, 0, 1);
  const std::vector<Variation> over{{"gravity.1", -4, -16, 4}, {"bodies.bob.mass", 0.5, 2, 2}};
  const GridFollower follower(m, over, speed, 0, 10, {});
  for (std::size_t i = 0; i < grid_size(over); ++i) {
    const GridBranches place = follower.follow(i);
    CAPTURE(i, place.diagram.message);
    CHECK(place.parameters == grid_values(over, i));
    const auto& special = place.diagram.special;
    const auto fork = std::ranges::find(special, SpecialPointType::branch_point, &SpecialPoint::type);
    REQUIRE(fork != special.end());
    CHECK(fork->at.parameter == Approx(std::sqrt(-place.parameters[0] / 0.7)).epsilon(1e-9));
  }
}

TEST_CASE("folds over a grid lie on the curve that the plane's folds make") {
  // A pendulum hinged off the axis: two independent ways to its folds, which w^2 ~ g carries over gravity.
  const Mechanism m = conical(0.7, 0.1, 5);
  const std::vector<Variation> over{{"gravity.1", -6, -12, 4}};
  BranchOptions options;
  options.all = true;
  const GridFollower follower(m, over, speed, 1, 8, options);
  PlaneOptions curves;
  curves.all = true;
  const PlaneCurves plane = fold_curves(m, {speed, 1, 8}, {"gravity.1", -12, -6}, curves);
  double ratio = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const GridBranches place = follower.follow(i);
    CAPTURE(place.parameters[0], place.diagram.message);
    const auto& special = place.diagram.special;
    const auto fold = std::ranges::find(special, SpecialPointType::fold, &SpecialPoint::type);
    REQUIRE(fold != special.end());
    const double w = fold->at.parameter, g = place.parameters[0];
    if (i > 0) CHECK(w * w / g == Approx(ratio).epsilon(1e-9));
    ratio = w * w / g;
    double nearest = 1; // of the curve's points beside it, which lie on w^2 ~ g, too
    for (const PlaneCurve& curve : plane.curves)
      for (const auto& point : curve.points)
        nearest = std::min(nearest, std::abs(point.x * point.x / point.y / ratio - 1));
    CHECK(nearest < 1e-8);
  }
}

TEST_CASE("a place says the same as a diagram by itself, whatever was followed before") {
  const Mechanism m = shipped("governor_parametric");
  const std::vector<Variation> over{{"parameters.k", 500, 1500, 3}};
  BranchOptions options;
  options.all = true;
  options.all_at = {12};
  const GridFollower follower(m, over, "parameters.w", 5, 15, options);
  (void)follower.follow(0);
  const GridBranches place = follower.follow(2);
  Mechanism there = m;
  set_parameter(there, "parameters.k", 1500);
  const ResponseDiagram alone = follow_branches(there, "parameters.w", 5, 15, options);
  REQUIRE(place.diagram.branches.size() == alone.branches.size());
  for (std::size_t b = 0; b < alone.branches.size(); ++b) {
    REQUIRE(place.diagram.branches[b].points.size() == alone.branches[b].points.size());
    for (std::size_t i = 0; i < alone.branches[b].points.size(); ++i) {
      const ResponsePoint &one = alone.branches[b].points[i], &two = place.diagram.branches[b].points[i];
      CHECK(one.parameter == two.parameter);
      for (std::size_t c = 0; c < one.coordinates.size(); ++c)
        CHECK(one.coordinates[c].value == two.coordinates[c].value);
    }
  }
}

TEST_CASE("a place of which no mechanism can be made says so") {
  const Mechanism m = shipped("governor_parametric");
  SECTION("an arm longer than twice its link") {
    const std::vector<Variation> over{{"parameters.L", 0.2, 0.24, 2}};
    const GridFollower follower(m, over, "parameters.w", 5, 15, {});
    CHECK_FALSE(follower.follow(0).diagram.branches.empty());
    const ResponseDiagram far = follower.follow(1).diagram;
    CHECK(far.branches.empty());
    CHECK(far.status == Status::infeasible);
    CHECK_FALSE(far.message.empty());
  }
  SECTION("a mass below zero") {
    const std::vector<Variation> over{{"bodies.collar.mass", -1, 1, 2}};
    const GridFollower follower(shipped("governor"), over, speed, 5, 15, {});
    const ResponseDiagram none = follower.follow(0).diagram;
    CHECK(none.status == Status::infeasible);
    CHECK_THAT(none.message, ContainsSubstring("bodies.collar.mass"));
    CHECK_FALSE(follower.follow(1).diagram.branches.empty());
  }
  SECTION("what is wrong with every place is refused") {
    const auto make = [&](const std::string& address) {
      const std::vector<Variation> over{{address, 0, 1, 2}};
      return GridFollower(m, over, "parameters.w", 5, 15, {});
    };
    CHECK_THROWS_AS(make("parameters.none"), SceneError);
    CHECK_THROWS_AS(make("parameters.w"), SceneError);
    CHECK_NOTHROW(make("parameters.L"));
  }
}

TEST_CASE("all equilibria over a grid are those of each point by itself") {
  // Hanging and standing, and leaning to either side beyond w^2 L = g.
  const Mechanism m = conical(0.7, 0, 1);
  const std::vector<Variation> speeds{{speed, 1, 8, 8}};
  GridSolver solver(m, speeds);
  const double fork = std::sqrt(standard_gravity / 0.7);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::vector<SweepPoint> points = solver.solve_all(i, {});
    const double w = points.front().parameters[0];
    CAPTURE(w);
    CHECK(points.size() == (w < fork ? 2u : 4u));
    for (std::size_t k = 0; k < points.size(); ++k) {
      CHECK(points[k].equilibria == points.size());
      CHECK(points[k].equilibrium == k);
    }
    const double lean = w < fork ? 0 : std::acos(standard_gravity / (w * w * 0.7));
    CHECK(std::abs(value(points.front().solution, "swing")) == Approx(lean).margin(1e-9));
    CHECK(points.front().solution.stable == true);
    CHECK(points.back().solution.stable == false);
  }
  // Where no mechanism can be made there is none, and why.
  const std::vector<Variation> arms{{"parameters.L", 0.2, 0.24, 2}};
  GridSolver arm_solver(shipped("governor_parametric"), arms);
  CHECK(arm_solver.solve_all(0, {}).front().equilibria > 0);
  const std::vector<SweepPoint> none = arm_solver.solve_all(1, {});
  REQUIRE(none.size() == 1);
  CHECK(none.front().equilibria == 0);
  CHECK(none.front().solution.status == Status::infeasible);
  CHECK_FALSE(none.front().solution.message.empty());
}

TEST_CASE("branches over a grid have the bands of dry friction at all their points") {
  const std::vector<Variation> over{{"parameters.F", 6, 12, 2}};
  const GridFollower follower(shipped("governor_friction"), over, "parameters.w", 15.5, 16.5, {});
  std::array<double, 2> width{};
  for (std::size_t place = 0; place < 2; ++place) {
    const GridBranches at = follower.follow(place);
    REQUIRE(at.diagram.branches.size() == 1);
    REQUIRE(at.ribbons.size() == 1);
    const ResponseBranch& branch = at.diagram.branches[0];
    REQUIRE(at.ribbons[0].size() == branch.points.size());
    const std::size_t middle = branch.points.size() / 2;
    const BandExtent* lift = find_extent(at.ribbons[0][middle], "lift");
    REQUIRE(lift);
    // As of that mechanism by itself.
    const FrictionBand band =
        find_friction_band(shipped("governor_friction", {{"parameters.F", at.parameters[0]},
                                                         {"parameters.w", branch.points[middle].parameter}}));
    const auto alone = std::ranges::find(band.extents, "lift", &BandExtent::name);
    REQUIRE(alone != band.extents.end());
    CHECK(std::abs(lift->low - alone->low) < 1e-10);
    CHECK(std::abs(lift->high - alone->high) < 1e-10);
    width[place] = lift->high - lift->low;
  }
  CHECK(width[1] > 1.9 * width[0]);
  CHECK(GridFollower(shipped("governor"), std::array{Variation{"gravity.1", -10, -9, 2}},
                     "joints.spin.drive.speed", 10, 12, {})
            .follow(0)
            .ribbons.empty());
}
