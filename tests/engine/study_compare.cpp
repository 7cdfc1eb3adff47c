// Error against run time: what the comparison is made of. How the times compare is the benchmark's to say.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/compare.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

CompareOptions quick() {
  CompareOptions o;
  o.tolerances = {1e-3, 1e-5, 1e-7, 1e-9};
  o.repeats = 1;
  return o;
}

} // namespace

TEST_CASE(
    "the paper's scenes compared: a verified reference, quadratic iterations, and motions that come near") {
  for (const std::string name : {"pendulum", "governor"}) {
    CAPTURE(name);
    const Mechanism m = shipped(name);
    std::size_t seen = 0;
    CompareOptions options = quick();
    options.progress = [&](std::size_t done, std::size_t all) {
      CHECK(done == seen + 1);
      CHECK(all == 3 * 5 * 4);
      seen = done;
    };
    const Comparison c = compare(m, options);
    CHECK(c.status == Status::converged);
    CHECK(seen == 60);

    // The reference is the published steady state, known to more digits than a double has.
    CHECK(c.reference_error < 1e-18);
    CHECK(c.reference_residual < 1e-17);
    for (const auto& [joint, wanted] :
         name == "pendulum" ? std::vector<std::pair<std::string, double>>{{"theta", 0.45377171949723577},
                                                                          {"d", 1.0153129043019644}}
                            : std::vector<std::pair<std::string, double>>{{"slide", 0.1500174581252971}}) {
      const auto x = std::ranges::find(c.reference, joint, &CoordinateSolution::joint);
      REQUIRE(x != c.reference.end());
      CHECK(std::abs(x->value - wanted) < 3e-16);
      CHECK(x->error < 1e-17);
    }

    // One mark an iteration, from the drawn pose on; the last ones square the error.
    REQUIRE(c.direct.size() >= 5);
    CHECK(c.direct.front().iterations == 0);
    CHECK(c.direct.front().error > 0.05);
    CHECK(c.direct.back().error < 1e-14);
    CHECK(c.answer.error < 1e-15);
    int squared = 0;
    for (std::size_t i = 0; i + 1 < c.direct.size(); ++i) {
      CHECK(c.direct[i + 1].iterations == c.direct[i].iterations + 1);
      const double before = c.direct[i].error, after = c.direct[i + 1].error;
      if (before > 1e-2 || before < 1e-12) continue;
      ++squared;
      CHECK(after < std::max(10 * before * before, 1e-15));
    }
    CHECK(squared >= 2);
    for (const DirectMark& mark : c.direct)
      CHECK(mark.run_time_s > 0);

    // One curve an integrator and duration.
    REQUIRE(c.motion.size() == 15);
    for (const MotionCurve& curve : c.motion) {
      CAPTURE(word(curve.method), curve.duration);
      REQUIRE(curve.points.size() == 4);
      for (const MotionMark& p : curve.points) {
        CHECK(std::isfinite(p.error));
        CHECK(p.error > 0);
        CHECK(p.run_time_s > 0);
        CHECK(p.steps > 0);
        CHECK(p.status == RunStatus::completed);
      }
      CHECK(curve.points.back().steps > curve.points.front().steps);
    }
    // A longer motion with a tight tolerance comes nearer, down to what was asked for.
    for (std::size_t method = 0; method < 3; ++method) {
      const MotionMark &shorter = c.motion[5 * method].points.back(),
                       &longer = c.motion[5 * method + 4].points.back();
      CHECK(longer.error < 1e-3 * shorter.error);
      CHECK(longer.error < 1e-7);
    }
    REQUIRE(c.best);
    CHECK(c.best->error < 1e-8);
    CHECK(c.best->direct_s > 0);
    CHECK(c.best->ratio() == c.best->motion_s / c.best->direct_s);
    for (const MotionCurve& curve : c.motion)
      for (const MotionMark& p : curve.points)
        CHECK(p.error >= c.best->error);
  }
}

TEST_CASE("errors of measures are those that the coordinates' errors make") {
  Mechanism m = shipped("governor");
  m.measures = {{"lift", "", "coordinate(slide)", "m"},
                {"pull", "", "1000 N/m * (0.15 m - coordinate(slide))", "N"},
                {"spring", "", "reaction(slide)", "N"},
                {"none", "", "1 m / (coordinate(slide) - coordinate(slide)) * 1 m", "m"}};
  CompareOptions o = quick();
  o.integrators = {Integrator::bdf};
  o.durations = {4};
  const Comparison c = compare(m, o);
  INFO(c.message);
  REQUIRE(c.measures.size() == 4);
  const auto slide = std::ranges::find(c.reference, std::string("slide"), &CoordinateSolution::joint);
  CHECK(c.measures[0].value == Approx(slide->value).epsilon(1e-15));
  CHECK(c.measures[1].unit == "N");
  CHECK_FALSE(c.measures[3].value);
  // From where it is drawn, 0.0744 m down.
  REQUIRE(c.direct.size() > 3);
  CHECK(c.direct[0].measure_errors[0] == Approx(slide->value - 0.0744).epsilon(1e-12));
  for (const DirectMark& mark : c.direct) {
    REQUIRE(mark.measure_errors.size() == 4);
    CHECK(mark.measure_errors[1] == Approx(1000 * mark.measure_errors[0]).margin(1e-12));
    CHECK(std::isnan(mark.measure_errors[3]));
  }
  CHECK(c.answer.measure_errors[0] < 1e-16);
  CHECK(c.answer.measure_errors[2] < 1e-11);
  REQUIRE(c.motion.size() == 1);
  const MotionMark &rough = c.motion[0].points.front(), &fine = c.motion[0].points.back();
  CHECK(fine.measure_errors[0] < rough.measure_errors[0]);
  CHECK(fine.measure_errors[1] == Approx(1000 * fine.measure_errors[0]).epsilon(1e-6));
}

TEST_CASE("a motion that does not come to the steady state is no measure of it") {
  CompareOptions o = quick();
  o.tolerances = {1e-4};
  o.durations = {0.05};
  o.integrators = {Integrator::bdf};
  const Comparison c = compare(shipped("governor"), o);
  CHECK(c.complete);
  REQUIRE(c.motion.size() == 1);
  CHECK(c.motion[0].points[0].error > 0.1);
  CHECK_FALSE(c.best);
  CHECK_THAT(
      c.message,
      ContainsSubstring("No motion comes to stand at this steady state: the nearest ends, or swings on,"));
}

TEST_CASE("a motion that swings through the steady state has not come there") {
  Mechanism m = shipped("conical_pendulum");
  for (Joint& j : m.joints)
    for (Coordinate& c : j.coordinates)
      c.damping = {};
  CompareOptions o = quick();
  o.tolerances = {1e-8};
  o.integrators = {Integrator::runge_kutta};
  for (int i = 0; i < 60; ++i)
    o.durations.push_back(3 + 0.1 * i);
  const Comparison c = compare(m, o);
  CAPTURE(c.message);
  REQUIRE(c.complete);
  // Some end near it, and go on.
  CHECK(std::ranges::any_of(c.motion, [](const MotionCurve& curve) { return curve.points[0].error < 0.01; }));
  CHECK_FALSE(c.best);
  CHECK_THAT(c.message, ContainsSubstring("swings on"));
}

TEST_CASE("what nothing resists is no error, and what else there is of that joint is one") {
  // The ball may turn about its string: its place and tilt are determined.
  CompareOptions o = quick();
  o.tolerances = {1e-6};
  o.integrators = {Integrator::runge_kutta};
  o.durations = {1};
  const Comparison c = compare(shipped("ball_on_string"), o);
  CAPTURE(c.message);
  REQUIRE(c.status == Status::converged);
  CHECK(c.answer.error < 1e-9);
  // The motion swings on, a tenth of a radian or more away, and not millions.
  const MotionMark& end = c.motion.at(0).points.at(0);
  CHECK(end.error > 1e-3);
  CHECK(end.goes_on < 100);
  CHECK_FALSE(c.best);
}

TEST_CASE("what is asked for is what is measured") {
  CompareOptions o = quick();
  o.tolerances = {1e-4, 1e-6};
  o.durations = {0.1, 0.2};
  o.integrators = {Integrator::runge_kutta};
  const Comparison c = compare(shipped("conical_pendulum"), o);
  REQUIRE(c.motion.size() == 2);
  CHECK(c.motion[1].duration == 0.2);
  CHECK(c.motion[1].points[1].tolerance == 1e-6);
}

TEST_CASE("a state that only a search finds is compared like any other") {
  CompareOptions o = quick();
  o.durations = {0.05};
  const Comparison c = compare(stored_case("five_bodies_from_afar"), o);
  CAPTURE(c.message);
  CHECK(c.status == Status::converged);
  CHECK(c.answer.error < 1e-9);
  CHECK_FALSE(c.motion.empty());
}

TEST_CASE("a comparison may be cancelled, and says where there is nothing to compare") {
  std::atomic<bool> cancel = false;
  CompareOptions o = quick();
  o.cancel = &cancel;
  o.progress = [&](std::size_t done, std::size_t) {
    if (done == 2) cancel = true;
  };
  const Comparison c = compare(shipped("governor"), o);
  CHECK_THAT(c.message, ContainsSubstring("Cancelled"));
  REQUIRE(c.motion.size() == 1);
  CHECK(c.motion[0].points.size() == 2);

  Mechanism slanted = shipped("conical_pendulum");
  slanted.gravity = {3, -9, 0};
  const Comparison none = compare(slanted, quick());
  CHECK(none.status == Status::no_steady_state);
  CHECK(none.motion.empty());
  CHECK_FALSE(none.best);
  CHECK_FALSE(none.message.empty());
}
