// Sweeps: rows equal single solves, whatever the threads.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/sweep.hpp"
#include "engine/system/system.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

void check_same(const Solution& a, const Solution& b) {
  CHECK(a.status == b.status);
  CHECK(a.message == b.message);
  CHECK(a.stable == b.stable);
  CHECK(a.stability_reason == b.stability_reason);
  CHECK(a.iterations == b.iterations);
  CHECK(a.residual == b.residual);
  REQUIRE(a.coordinates.size() == b.coordinates.size());
  for (std::size_t i = 0; i < a.coordinates.size(); ++i) {
    CHECK(a.coordinates[i].joint == b.coordinates[i].joint);
    CHECK(a.coordinates[i].value == b.coordinates[i].value);
    CHECK(a.coordinates[i].error == b.coordinates[i].error);
  }
}

} // namespace

TEST_CASE("a variation goes from end to end") {
  const Variation v{"gravity.1", -1, 2, 7};
  CHECK(v.value(0) == -1);
  CHECK(v.value(2) == 0);
  CHECK(v.value(6) == 2);
  CHECK(Variation{"gravity.1", 3, 9, 1}.value(0) == 3);
}

TEST_CASE("every row of a sweep equals a solve of its own") {
  // Through a fold and a pitchfork, where the way of coming there could matter.
  const std::vector<std::pair<Mechanism, Variation>> cases{
      {shipped("governor"), {"joints.spin.drive.speed", 4, 20, 9}},
      {shipped("pendulum"), {"joints.theta.spring.stiffness", 10, 1000, 7}},
      {shipped("conical_pendulum"), {"joints.spin.drive.speed", 0, 9, 13}},
      {conical(0.7, 0.1, 1, -1.2), {"joints.spin.drive.speed", 3, 8, 11}},
      {shipped("governor"), {"joints.link1.length", 0.05, 0.4, 6}}, // infeasible at the far end
      {shipped("governor"), {"joints.slide.damping", 0, 20, 3}},    // compiled without dampers, and with
      {shipped("governor_parametric"), {"parameters.L", 0.1, 0.2, 9}},
  };
  for (const auto& [m, variation] : cases) {
    const std::vector<SweepPoint> points = sweep(m, std::span(&variation, 1), 1);
    REQUIRE(points.size() == static_cast<std::size_t>(variation.count));
    for (int i = 0; i < variation.count; ++i) {
      const SweepPoint& point = points[static_cast<std::size_t>(i)];
      CAPTURE(m.name, variation.address, variation.value(i));
      REQUIRE(point.parameters.size() == 1);
      CHECK(point.parameters[0] == variation.value(i));
      Mechanism there = m;
      set_parameter(there, variation.address, variation.value(i));
      SolveOptions options;
      options.details = false;
      check_same(point.solution, Analysis(there).solve(options));
    }
  }
}

TEST_CASE("the number of threads changes nothing") {
  const std::vector<Variation> variations{{"joints.spin.drive.speed", 2, 25, 6},
                                          {"bodies.collar.mass", 0.5, 3, 5}};
  const Mechanism m = shipped("governor");
  const std::vector<SweepPoint> one = sweep(m, variations, 1);
  for (const int threads : {0, 2, 3, 64}) {
    std::size_t last = 0;
    bool falling = false;
    const std::vector<SweepPoint> many =
        sweep(m, variations, threads, [&](std::size_t done, std::size_t all) {
          falling = falling || done < last || all != 30;
          last = done;
        });
    CHECK_FALSE(falling);
    CHECK(last == 30);
    REQUIRE(many.size() == one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      CAPTURE(threads, i);
      CHECK(many[i].parameters == one[i].parameters);
      check_same(many[i].solution, one[i].solution);
    }
  }
}

// The sparse solver behind them is not made for several threads.
TEST_CASE("large nets are swept on several threads, too") {
  for (const Mechanism& m : {bench::spring_net(8, 3), bench::cable_net(8, 3)}) {
    REQUIRE(compile(m).kkt_form == KktForm::sparse);
    const Variation speed{"joints.spin.drive.speed", 2, 4, 8};
    const std::vector<SweepPoint> one = sweep(m, std::span(&speed, 1), 1);
    const std::vector<SweepPoint> many = sweep(m, std::span(&speed, 1), 4);
    REQUIRE(many.size() == one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      CAPTURE(m.name, i);
      CHECK(one[i].solution.status == Status::converged);
      check_same(many[i].solution, one[i].solution);
    }
  }
}

TEST_CASE("a grid has every combination, the last variation fastest") {
  const std::vector<Variation> variations{
      {"joints.spin.drive.speed", 10, 12, 3}, {"gravity.1", -9, -10, 2}, {"bodies.collar.mass", 1, 2, 2}};
  const std::vector<SweepPoint> points = sweep(shipped("governor"), variations, 2);
  REQUIRE(points.size() == 12);
  std::size_t i = 0;
  for (const double speed : {10., 11., 12.})
    for (const double gravity : {-9., -10.})
      for (const double mass : {1., 2.}) {
        CHECK(points[i].parameters == std::vector<double>{speed, gravity, mass});
        CHECK(points[i].solution.status == Status::converged);
        ++i;
      }
  // And nothing varied is one solve.
  const std::vector<SweepPoint> single = sweep(shipped("governor"), {}, 2);
  REQUIRE(single.size() == 1);
  CHECK(single[0].parameters.empty());
  CHECK(single[0].solution.status == Status::converged);
}

TEST_CASE("what a sweep cannot vary is an error, from any thread") {
  const Mechanism m = shipped("governor");
  for (const int threads : {1, 4}) {
    const auto run = [&](const Variation& v) { return sweep(m, std::span(&v, 1), threads); };
    CHECK_THROWS_AS(run({"joints.spin.drive.sped", 1, 2, 3}), SceneError);
    CHECK_THROWS_AS(run({"bodies.nobody.mass", 1, 2, 3}), SceneError);
    CHECK_THROWS_AS(run({"bodies.ball1.mass", 1, -1, 9}), SceneError);
    CHECK_THROWS_WITH(run({"bodies.ball1.mass", 1, -1, 9}), ContainsSubstring("bodies.ball1.mass"));
    CHECK_THROWS_AS(run({"joints.spin.drive.speed", 1, std::numeric_limits<double>::infinity(), 3}),
                    SceneError);
  }
  const std::vector<Variation> twice(2, {"joints.spin.drive.speed", 1, 2, 3});
  CHECK_THROWS_WITH(sweep(m, twice, 1), ContainsSubstring("varied already"));
}
