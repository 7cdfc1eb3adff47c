// How steady states scatter with tolerances, against closed forms and against solves one by one.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/study/spread_band.hpp"
#include "engine/study/spread_tally.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed";

SpreadAnswer spread_by(const Mechanism& m, const std::vector<Tolerance>& tolerances, std::size_t samples,
                       int threads = 1, std::uint64_t seed = 1) {
  SpreadOptions options;
  options.samples = samples;
  options.seed = seed;
  ThreadSharing sharing(threads);
  return spread(m, tolerances, options, sharing);
}

std::size_t count(const SpreadAnswer& answer, SampleFate fate) {
  return answer.counts[static_cast<std::size_t>(fate)];
}

} // namespace

TEST_CASE("samples have the moments of their distributions, and are independent") {
  const std::vector<double> nominal{5, -2, 0, 1};
  const std::vector<Tolerance> tolerances{{"a", Distribution::normal, 0.3},
                                          {"b", Distribution::uniform, 0.2},
                                          {"c", Distribution::triangular, 4},
                                          {"d", Distribution::normal, 1}};
  constexpr std::size_t n = 200'000;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero(), fourth = Eigen::Vector4d::Zero();
  Eigen::Matrix4d products = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<double> numbers = sampled_numbers(nominal, tolerances, 7, i);
    Eigen::Vector4d x;
    for (std::size_t k = 0; k < 4; ++k) {
      x[static_cast<Eigen::Index>(k)] = (numbers[k] - nominal[k]) / tolerances[k].deviation();
      if (tolerances[k].distribution != Distribution::normal)
        CHECK(std::abs(numbers[k] - nominal[k]) <= tolerances[k].width);
    }
    sum += x;
    products += x * x.transpose();
    fourth += x.cwiseAbs2().cwiseAbs2();
  }
  // Of five standard errors.
  const double chance = 5 / std::sqrt(static_cast<double>(n));
  CHECK((sum / n).cwiseAbs().maxCoeff() < chance);
  CHECK((products / n - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() < 2 * chance);
  // Kurtosis: 3, 9/5, 12/5.
  CHECK(fourth[0] / n == Approx(3).margin(12 * chance));
  CHECK(fourth[1] / n == Approx(1.8).margin(4 * chance));
  CHECK(fourth[2] / n == Approx(2.4).margin(6 * chance));
  CHECK(sampled_numbers(nominal, tolerances, 7, 3) == sampled_numbers(nominal, tolerances, 7, 3));
  CHECK(sampled_numbers(nominal, tolerances, 8, 3) != sampled_numbers(nominal, tolerances, 7, 3));
}

TEST_CASE("the lean of a conical pendulum scatters with its speed as its rate says") {
  // cos a = g / (w^2 L): da/dw = 2 / (w tan a).
  Mechanism m = conical(0.7, 0, 1);
  set_parameter(m, speed, 5);
  const double a = std::acos(standard_gravity / (25 * 0.7)), rate = 2 / (5 * std::tan(a));
  const std::vector<Tolerance> tolerances{{speed, Distribution::normal, 0.01}};
  const SpreadAnswer answer = spread_by(m, tolerances, 4000);
  INFO(answer.message);
  REQUIRE(answer.status == Status::converged);
  CHECK(count(answer, SampleFate::followed) == 4000);
  REQUIRE(answer.outputs.size() == 1);
  const SpreadOutput& swing = answer.outputs[0];
  CHECK(swing.nominal == Approx(a).epsilon(1e-12));
  CHECK(swing.linear_deviation == Approx(0.01 * rate).epsilon(1e-6));
  CHECK(swing.followed.deviation == Approx(0.01 * rate).epsilon(0.06));
  CHECK(swing.followed.mean == Approx(a).margin(5 * 0.01 * rate / std::sqrt(4000.)));
  CHECK(swing.linear_shares == std::vector<double>{1});
  CHECK(swing.sampled_shares[0] == Approx(1).margin(0.01));
  // Each by a solve of its own.
  for (std::size_t i = 0; i < 50; ++i) {
    Mechanism there = m;
    const double nominal[]{5.};
    set_parameter(there, speed, sampled_numbers(nominal, tolerances, 1, i)[0]);
    CHECK(answer.values[0][i] == Approx(value(solve(there), "swing")).epsilon(1e-12));
  }
}

TEST_CASE("shares of several tolerances agree by rates and by samples; threads change no bit") {
  const Mechanism m = shipped("governor_parametric");
  const std::vector<Tolerance> tolerances{{"parameters.w", Distribution::uniform, 0.05},
                                          {"parameters.L", Distribution::normal, 2e-4},
                                          {"parameters.k", Distribution::triangular, 20}};
  const SpreadAnswer one = spread_by(m, tolerances, 3000, 1), two = spread_by(m, tolerances, 3000, 2);
  REQUIRE(one.status == Status::converged);
  CHECK(one.values == two.values);
  CHECK(one.fate == two.fate);
  CHECK(one.outputs.size() == 3 + m.measures.size());
  for (const SpreadOutput& output : one.outputs) {
    CAPTURE(output.name);
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += output.linear_shares[k];
      CHECK(output.sampled_shares[k] == Approx(output.linear_shares[k]).margin(0.06));
    }
    CHECK(sum == Approx(1).epsilon(1e-9));
    CHECK(output.followed.deviation == Approx(output.linear_deviation).epsilon(0.08));
    CHECK(output.followed.least <= output.followed.low);
    CHECK(output.followed.low < output.followed.median);
    CHECK(output.followed.median < output.followed.high);
    CHECK(output.followed.high <= output.followed.most);
  }
}

TEST_CASE("samples that do not follow are results, each with its fate") {
  SECTION("no mechanism can be made of a link that is too short") {
    Mechanism m = shipped("governor_parametric");
    set_parameter(m, "parameters.L", 0.21);
    const std::vector<Tolerance> tolerances{{"parameters.L", Distribution::uniform, 0.02}};
    const SpreadAnswer answer = spread_by(m, tolerances, 400);
    REQUIRE(answer.status == Status::converged);
    for (std::size_t i = 0; i < 400; ++i) {
      const double nominal[]{0.21};
      const double L = sampled_numbers(nominal, tolerances, 1, i)[0];
      // Twice the link.
      CHECK((answer.fate[i] == SampleFate::no_mechanism) == (L > 0.21844));
    }
    CHECK(count(answer, SampleFate::no_mechanism) > 50);
    CHECK(count(answer, SampleFate::followed) > 50);
  }
  SECTION("beyond a fold another state is found, and told apart") {
    // A pendulum hinged off the axis leans in where w^2 (o + L sin a) = g tan a, on a branch that folds where
    // that speed is least.
    const auto square = [](long double a) {
      return standard_gravity * std::tan(a) / (0.1L + 0.7L * std::sin(a));
    };
    long double from_a = -1.4L, to_a = -0.3L;
    for (int i = 0; i < 200; ++i) {
      const long double third = (to_a - from_a) / 3;
      if (square(from_a + third) < square(to_a - third))
        to_a -= third;
      else
        from_a += third;
    }
    const auto fold = static_cast<double>(std::sqrt(square(from_a)));
    const double nominal_speed = fold + 0.05;
    const long double lean = root(
        [&](long double a) { return square(a) - static_cast<long double>(nominal_speed) * nominal_speed; },
        -1.4L, from_a);
    Mechanism m = conical(0.7, 0.1, 1);
    set_parameter(m, speed, nominal_speed);
    const std::vector<Tolerance> tolerances{{speed, Distribution::uniform, 0.2}};
    SpreadOptions options;
    options.samples = 400;
    options.start = {{"swing", static_cast<double>(lean)}};
    ThreadSharing sharing(2);
    const SpreadAnswer answer = spread(m, tolerances, options, sharing);
    INFO(answer.message);
    REQUIRE(answer.status == Status::converged);
    for (std::size_t i = 0; i < 400; ++i) {
      const double nominal[]{nominal_speed};
      const double w = sampled_numbers(nominal, tolerances, 1, i)[0];
      CAPTURE(w, fold);
      CHECK((answer.fate[i] == SampleFate::elsewhere) == (w < fold));
      CHECK((answer.values[0][i] < -0.3) == (w > fold));
    }
    CHECK(answer.outputs[0].followed.most < -0.3);
    CHECK(answer.outputs[0].elsewhere.least > -0.3);
    CHECK_THAT(answer.message, ContainsSubstring("are in another"));
  }
  SECTION("without a nominal state there is nothing to scatter") {
    Mechanism m = conical(0.7, 0.1, 1);
    m.gravity = Vec3(3, -9, 0); // turns with the drive
    const SpreadAnswer answer = spread_by(m, {{speed, Distribution::normal, 0.1}}, 10);
    CHECK(answer.status == Status::no_steady_state);
    CHECK_FALSE(answer.message.empty());
  }
}

TEST_CASE("tolerances that make no sense are refused") {
  const Mechanism m = shipped("governor_parametric");
  CHECK_THROWS_AS(spread_by(m, {{"parameters.w", Distribution::normal, 0}}, 5), SceneError);
  CHECK_THROWS_AS(spread_by(m, {{"parameters.none", Distribution::normal, 1}}, 5), SceneError);
  CHECK_THROWS_AS(spread_by(m, {{"parameters.c", Distribution::normal, 1}}, 5), SceneError);
  CHECK_THROWS_AS(spread_by(m, {}, 5), SceneError);
}

TEST_CASE("standard errors of mean and deviation are those of many repetitions") {
  // Of uniform numbers, whose fourth moment is not a normal one's.
  const std::vector<double> nominal{0};
  const std::vector<Tolerance> tolerances{{"a", Distribution::uniform, 1}};
  constexpr int repetitions = 400;
  constexpr std::size_t n = 500;
  double means = 0, deviations = 0, squares = 0, told_mean = 0, told_deviation = 0, mean_squares = 0;
  for (int r = 0; r < repetitions; ++r) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i)
      values.push_back(sampled_numbers(nominal, tolerances, static_cast<std::uint64_t>(r), i)[0]);
    const SpreadStatistics s = spread_statistics(values);
    CHECK(s.lowest < s.low);
    CHECK(s.high < s.highest);
    means += s.mean / repetitions;
    mean_squares += s.mean * s.mean / repetitions;
    deviations += s.deviation / repetitions;
    squares += s.deviation * s.deviation / repetitions;
    told_mean += s.mean_error / repetitions;
    told_deviation += s.deviation_error / repetitions;
  }
  CHECK(std::sqrt(mean_squares - means * means) == Approx(told_mean).epsilon(0.15));
  CHECK(std::sqrt(squares - deviations * deviations) == Approx(told_deviation).epsilon(0.15));
  // Of a normal distribution it would be 1.6 times as much.
  CHECK(told_deviation == Approx(std::sqrt(1 / 3. * 0.8 / (4. * n))).epsilon(0.03));
}

TEST_CASE("of more values than are kept quantiles come from bins that are finer than chance") {
  const std::vector<double> nominal{0};
  const std::vector<Tolerance> tolerances{{"a", Distribution::normal, 1}};
  for (const double offset : {0., 1e6}) {
    constexpr std::size_t n = 3 * ValueTally::kept;
    constexpr double size = 1e-3;
    std::vector<double> values;
    long double sum = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) {
      values.push_back(offset + size * sampled_numbers(nominal, tolerances, 7, i)[0]);
      sum += values.back() - static_cast<long double>(offset);
    }
    const SpreadStatistics s = spread_statistics(values);
    for (const double value : values) {
      const long double difference = value - static_cast<long double>(offset) - sum / n;
      squares += difference * difference;
    }
    std::ranges::sort(values);
    const auto at = [&](double share) { return values[static_cast<std::size_t>(share * (n - 1))]; };
    CAPTURE(offset);
    CHECK(s.count == n);
    CHECK(s.least == values.front());
    CHECK(s.most == values.back());
    CHECK(std::abs(s.mean - offset - static_cast<double>(sum / n)) < 1e-9 * size + 2e-16 * offset);
    CHECK(s.deviation == Approx(static_cast<double>(std::sqrt(squares / (n - 1)))).epsilon(1e-9));
    for (const auto& [share, found] :
         {std::pair(0.025, s.lowest), std::pair(0.05, s.low), std::pair(0.5, s.median),
          std::pair(0.95, s.high), std::pair(0.975, s.highest)})
      CHECK(std::abs(found - at(share)) < 3e-4 * size); // chance: 2e-3 of it and more
  }
}

TEST_CASE("a band has at each place the spread there, to the bit") {
  const Mechanism m = shipped("governor_parametric");
  const std::vector<Tolerance> tolerances{{"parameters.L", Distribution::normal, 2e-4},
                                          {"parameters.w", Distribution::uniform, 0.05}};
  SpreadOptions options;
  options.samples = 300;
  std::vector<BandPlace> places;
  for (const double w : {9., 11., 14.}) {
    Mechanism there = m;
    set_parameter(there, "parameters.w", w);
    places.push_back({w, start_values(solve(there).coordinates)});
  }
  ThreadSharing one(1), two(2);
  const SpreadBand band = spread_band(m, "parameters.w", places, tolerances, options, one),
                   again = spread_band(m, "parameters.w", places, tolerances, options, two);
  REQUIRE(band.points.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    Mechanism there = m;
    set_parameter(there, "parameters.w", places[i].number);
    options.start = places[i].start;
    const SpreadAnswer own = spread(there, tolerances, options, two);
    CHECK(band.points[i].counts == own.counts);
    CHECK(band.points[i].others() == 0);
    REQUIRE(band.points[i].outputs.size() == own.outputs.size());
    for (std::size_t k = 0; k < own.outputs.size(); ++k) {
      CHECK(band.outputs[k] == own.outputs[k].name);
      CHECK(band.points[i].outputs[k].low == own.outputs[k].followed.low);
      CHECK(band.points[i].outputs[k].high == own.outputs[k].followed.high);
      CHECK(band.points[i].outputs[k].mean == again.points[i].outputs[k].mean);
    }
  }
}

TEST_CASE("near a fold a band tells how many samples leave the branch") {
  // A pendulum hinged off the axis, leaning in: w^2 (o + L sin a) = g tan a folds at 4.7554 rad/s (README).
  const double fold = 4.75536807929276;
  const Mechanism m = conical(0.7, 0.1, 1);
  const long double folds_at = -std::asin(std::cbrt(0.1L / 0.7L));
  const auto lean = [&](double w) {
    return static_cast<double>(root(
        [&](long double a) {
          return standard_gravity * std::tan(a) / (0.1L + 0.7L * std::sin(a)) -
                 w * static_cast<long double>(w);
        },
        -1.4L, folds_at));
  };
  std::vector<BandPlace> places;
  for (const double w : {fold + 0.05, fold + 1})
    places.push_back({w, {{"swing", lean(w)}}});
  const std::vector<Tolerance> tolerances{{speed, Distribution::uniform, 0.1}};
  SpreadOptions options;
  options.samples = 400;
  ThreadSharing sharing(1);
  const SpreadBand band = spread_band(m, speed, places, tolerances, options, sharing);
  REQUIRE(band.points.size() == 2);
  CHECK(band.points[0].samples() == 400);
  CHECK(static_cast<double>(band.points[0].others()) == Approx(100).margin(45)); // a quarter is slower
  CHECK(band.points[0].outputs[0].count == 400 - band.points[0].others());
  CHECK(band.points[1].others() == 0);
  // Where branches cross none is followed.
  const std::vector<BandPlace> crossing{{std::sqrt(standard_gravity / 0.7), {{"swing", 0}}}};
  const SpreadBand none = spread_band(conical(0.7, 0, 1), speed, crossing, tolerances, options, sharing);
  CHECK(none.points[0].samples() == 0);
  CHECK(none.points[0].outputs.empty());
}

TEST_CASE("what hangs on a ball joint scatters as on a hinge, but for its turning", "[families]") {
  // A bob at 0.7 m below a point 0.1 m beside the shaft's axis: nothing resists its turning about its rod.
  const auto pendulum = [](JointType type) {
    Mechanism m;
    m.gravity = {0, -standard_gravity, 0};
    m.bodies = {body("hub", 1, Vec3::Zero()), body("bob", 1, {0.1, -0.7, 0}, {1e-3, 1e-3, 1e-3})};
    m.joints = {joint(JointType::revolute, "spin", "ground", "hub", Vec3::Zero(), Vec3::UnitY()),
                joint(type, "swing", "hub", "bob", {0.1, 0, 0})};
    m.joints[0].coordinates[0].drive = Drive{3};
    m.measures = {{"height", "", "y(bob)", "m"}};
    return m;
  };
  const std::vector<Tolerance> tolerances{{speed, Distribution::normal, 0.05},
                                          {"bodies.bob.mass", Distribution::uniform, 0.2}};
  const SpreadAnswer hinge = spread_by(pendulum(JointType::revolute), tolerances, 500),
                     ball = spread_by(pendulum(JointType::spherical), tolerances, 500);
  INFO(ball.message);
  REQUIRE(ball.status == Status::converged);
  CHECK(count(ball, SampleFate::followed) == 500);
  const SpreadOutput &expected = hinge.outputs.back(), &height = ball.outputs.back();
  REQUIRE(height.name == "height");
  CHECK(height.nominal == Approx(expected.nominal).epsilon(1e-12));
  CHECK(height.linear_deviation == Approx(expected.linear_deviation).epsilon(1e-9));
  CHECK(height.followed.count == 500);
  CHECK(height.followed.deviation == Approx(expected.followed.deviation).epsilon(1e-9));
  CHECK(height.followed.most == Approx(expected.followed.most).epsilon(1e-12));
  for (const SpreadOutput& turn : std::span(ball.outputs).first(3)) {
    CAPTURE(turn.name);
    CHECK(turn.followed.count == 0);
    CHECK(turn.linear_shares.empty());
  }
}
