// Times at which drives are looked at: all round every rate, beat and low combination of rates.
#include "tests/catch.hpp"

#include "engine/system/drive_rates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace flyball;

namespace {

std::vector<DriveRate> turning(const std::vector<double>& rates) {
  std::vector<DriveRate> out;
  for (const double rate : rates)
    out.push_back({rate, true});
  return out;
}

// rad: the widest part of a turn at this rate that these times and 0 leave out.
double widest_gap(const std::vector<double>& times, double rate) {
  constexpr double turn = 2 * std::numbers::pi;
  std::vector<double> angles{0, turn};
  for (const double time : times)
    angles.push_back(std::fmod(rate * time, turn));
  std::ranges::sort(angles);
  double widest = 0;
  for (std::size_t i = 1; i < angles.size(); ++i)
    widest = std::max(widest, angles[i] - angles[i - 1]);
  return widest;
}

// Of |k a + l b| with these factors at most, where it is more than rounding.
double widest_gap_of_pairs(const std::vector<double>& rates, int most) {
  const std::vector<double> times = phase_times(turning(rates));
  double widest = 0;
  for (std::size_t i = 0; i < rates.size(); ++i)
    for (std::size_t j = i + 1; j < rates.size(); ++j)
      for (int k = 1; k <= most; ++k)
        for (int l = -most; l <= most; ++l) {
          const double sum = std::abs(k * rates[i] + l * rates[j]);
          if (l == 0 || sum < 1e-6 * rates[i]) continue;
          widest = std::max(widest, widest_gap(times, sum));
        }
  return widest;
}

constexpr double half_a_turn = 3.; // rad, a little less

} // namespace

TEST_CASE("one drive is looked at four times", "[phases]") {
  const std::vector<double> times = phase_times(turning({10}));
  REQUIRE(times.size() == 4);
  CHECK(times[0] == 1.0 / 10);
  CHECK(times[3] == 5.2 / 10);
  CHECK(phase_times({}).empty());
  CHECK(phase_times({{2, false}}).front() == 1. / 6); // a third of the reach
}

TEST_CASE("beats and low combinations of rates are looked at all round", "[phases]") {
  for (const std::vector<double>& rates :
       {std::vector{10., 10.00003}, std::vector{10., 20.00001}, std::vector{30.00001, 10.},
        std::vector{100., 200., 300., 400., 1e-3}, std::vector{1., std::numbers::sqrt2, std::numbers::pi}}) {
    CAPTURE(rates);
    CHECK(widest_gap_of_pairs(rates, 3) < half_a_turn);
    for (const double rate : rates)
      CHECK(widest_gap(phase_times(turning(rates)), rate) < half_a_turn);
  }
  // Three at once: a + b - c.
  CHECK(widest_gap(phase_times(turning({10, 17, 27.00001})), 1e-5) < half_a_turn);
}

TEST_CASE("many drives take few times", "[phases]") {
  std::mt19937 random(5);
  for (const int count : {12, 60, 200}) {
    std::vector<double> rates;
    for (int i = 0; i < count; ++i)
      rates.push_back(1 + static_cast<double>(random()) / 4294967296. * (i % 2 == 0 ? 1000 : 1e-3));
    CAPTURE(count);
    CHECK(phase_times(turning(rates)).size() < 100);
    CHECK(widest_gap_of_pairs(rates, 1) < half_a_turn);
  }
}
