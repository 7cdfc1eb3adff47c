#include "engine/system/drive_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr double alike = 1e-7; // of the faster: rates so near are one, given with seven digits
constexpr double rest = 1e-9;  // of the fastest: what is found so slow stands

double unit_of(const Link& link, const Parameters& p) {
  return link.type == LinkType::revolute ? 1 : p.length;
}

std::vector<DriveRate> rates_at(const System& system, const Parameters& p, const Eigen::VectorXd* q) {
  const auto given = [&](const Link& link, std::size_t l) {
    const double speed = std::abs(p.links[l].speed) / unit_of(link, p);
    return speed == 0 && finds_speed(link) ? 1 : speed;
  };
  const auto found = [&](const Link& link) {
    return q && q->size() == system.nq && finds_speed(link) ? std::abs((*q)[link.q]) / unit_of(link, p) : 0;
  };
  double fastest = 0;
  for (const DrivenCoordinate& d : system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    fastest = std::max({fastest, given(system.links[l], l), found(system.links[l])});
  }
  std::vector<DriveRate> out;
  for (const DrivenCoordinate& d : system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    const Link& link = system.links[l];
    const double there = found(link);
    const bool goes = std::isfinite(there) && there > rest * fastest;
    const DriveRate one{goes ? there : given(link, l), link.type == LinkType::revolute};
    if (one.rate == 0) continue;
    if (std::ranges::none_of(out, [&](const DriveRate& other) {
          return other.turns == one.turns && std::abs(other.rate - one.rate) < alike * one.rate;
        }))
      out.push_back(one);
  }
  return out;
}

// rad/s, of what changes with several angles: |k w_1 + l w_2| to the third harmonic of either, and the sums
// of three, of few rates; of many the plain sums and differences.
std::vector<double> combinations(const std::vector<double>& rates) {
  constexpr std::size_t few = 8;
  constexpr int harmonics = 3;
  std::vector<double> out;
  const auto add = [&](double a, double b, double c) {
    const double size = std::abs(a) + std::abs(b) + std::abs(c), sum = std::abs(a + b + c);
    if (sum > alike * size) out.push_back(sum);
  };
  const std::size_t count = rates.size();
  const int most = count <= few ? harmonics : 1;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) {
      for (int k = 1; k <= most; ++k)
        for (int l = 1; l <= most; ++l)
          for (const double sign : {-1., 1.})
            add(k * rates[i], sign * l * rates[j], 0);
      for (std::size_t n = j + 1; n < count && count <= few; ++n)
        for (const double second : {-1., 1.})
          for (const double third : {-1., 1.})
            add(rates[i], second * rates[j], third * rates[n]);
    }
  std::ranges::sort(out); // the slowest asks for times of its own that do for many others
  return out;
}

// Whether a turn at this rate is looked at all round, at these times and at 0.
bool covers(const std::vector<double>& times, double rate) {
  constexpr unsigned parts = 16;
  constexpr std::uint32_t all = (1U << parts) - 1;
  std::uint32_t seen = 1;
  // No six neighbours of them are empty: no more than 7/16 of a turn is not looked at.
  const auto all_round = [&] {
    std::uint32_t empty = ~seen & all;
    empty |= empty << parts;
    std::uint32_t run = empty;
    for (int i = 1; i < 6; ++i)
      run &= empty >> i;
    return (run & all) == 0;
  };
  for (const double time : times) {
    const double turns = rate * time / (2 * std::numbers::pi);
    const auto part = static_cast<unsigned>((turns - std::floor(turns)) * parts);
    seen |= 1U << std::min(part, parts - 1);
    if (all_round()) return true;
  }
  return false;
}

} // namespace

std::vector<DriveRate> drive_rates(const System& system, const Parameters& p) {
  return rates_at(system, p, nullptr);
}

std::vector<DriveRate> drive_rates(const System& system, const Parameters& p, const Eigen::VectorXd& q) {
  return rates_at(system, p, &q);
}

double fastest_rate(const std::vector<DriveRate>& rates) {
  double fastest = 0;
  for (const DriveRate& one : rates)
    fastest = std::max(fastest, one.rate);
  return fastest;
}

double fastest_given_rate(const System& system, const Parameters& p) {
  double fastest = 0;
  for (const DrivenCoordinate& d : system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    fastest = std::max(fastest, std::abs(p.links[l].speed) / unit_of(system.links[l], p));
  }
  return fastest;
}

std::vector<double> phase_times(const std::vector<DriveRate>& rates) {
  std::vector<double> times, turning;
  const auto look_at = [&](double rate) {
    for (const double angle : std::array{1.0, 2.3, 3.9, 5.2}) // where no low harmonic vanishes at all of them
      times.push_back(angle / rate);
  };
  for (const DriveRate& one : rates)
    if (!one.turns)
      look_at(3 * one.rate);
    else
      turning.push_back(one.rate);
  for (const double rate : turning)
    if (!covers(times, rate)) look_at(rate);
  for (const double rate : combinations(turning))
    if (!covers(times, rate)) look_at(rate);
  return times;
}

double angle_rounding(const std::vector<DriveRate>& rates, double time) {
  return std::numeric_limits<double>::epsilon() * fastest_rate(rates) * std::abs(time);
}

} // namespace flyball
