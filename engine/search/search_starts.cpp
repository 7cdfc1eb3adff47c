#include "engine/search/search_starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace flyball {
namespace {

constexpr double pi = std::numbers::pi;

const Link& link_of(const Problem& problem, const CoordinateInfo& c) {
  return problem.system.links[static_cast<std::size_t>(c.link)];
}

const LinkParameters& parameters_of(const Problem& problem, const CoordinateInfo& c) {
  return problem.parameters.links[static_cast<std::size_t>(c.link)];
}

// The most by which gears multiply or divide an angle without spring: it takes so many turns before all that
// it drives has made one.
double turns_of(const Problem& problem, const Link& link) {
  double turns = 1;
  for (std::size_t c = 0; c < problem.system.cuts.size(); ++c) {
    const CutJoint& cut = problem.system.cuts[c];
    if (cut.type != JointType::gear) continue;
    const double ratio = std::abs(problem.parameters.cuts[c].ratio);
    if (cut.gear_vb == link.v) turns = std::max(turns, ratio);
    if (cut.gear_va == link.v && ratio > 0) turns = std::max(turns, 1 / ratio);
  }
  constexpr double most = 100;
  return std::min(turns, most);
}

// How far from zero the force of a law changes its direction, or begins: the furthest such deflection (m)
// below and above zero, to within the next sample; zero where there is none. Samples lie in every order of
// magnitude from 1e-4 to 1e6 of `reach`. Of a law that goes to and fro without end the first few count.
SearchRange zeros_of_law(const BoundLaw& law, double reach) {
  constexpr int a_decade = 32, decades = 10, near = 4, most = 8;
  const auto furthest = [&](double side) {
    double out = 0, before = law.value(0.);
    for (int i = 0, zeros = 0; i <= a_decade * decades && zeros < most; ++i) {
      const double x = side * reach * std::pow(10, static_cast<double>(i) / a_decade - near);
      const double force = law.value(x);
      if (!std::isfinite(force)) break;
      if (before * force < 0 || (before == 0 && force != 0 && i > 0)) {
        out = x;
        ++zeros;
      }
      before = force;
    }
    return out;
  };
  return {furthest(-1), furthest(1)};
}

// The next number of which no root of a smaller one is a multiple: a prime.
unsigned prime_after(unsigned n) {
  for (++n;; ++n) {
    bool prime = n > 1;
    for (unsigned d = 2; d * d <= n && prime; ++d)
      prime = n % d != 0;
    if (prime) return n;
  }
}

} // namespace

std::vector<SearchRange> search_ranges(const Problem& problem, const Eigen::VectorXd& drawn) {
  std::vector<SearchRange> ranges;
  for (const CoordinateInfo& c : problem.system.coordinates) {
    const Link& link = link_of(problem, c);
    const LinkParameters& lp = parameters_of(problem, c);
    const double value = coordinate_value(problem.system, problem.parameters, drawn, c);
    if (finds_speed(link)) {
      const double most = 3 * lp.speed;
      if (most == 0) // left to itself from rest
        ranges.push_back({-problem.scaling.column[link.v], problem.scaling.column[link.v]});
      else
        ranges.push_back({std::min(0., most), std::max(0., most)});
    } else if (link.drive >= 0) {
      ranges.push_back({value, value});
    } else if (c.angle) {
      const double half = link.type == LinkType::revolute ? pi * turns_of(problem, link) : pi;
      const bool elsewhere = link.type == LinkType::revolute &&
                             turns_matter(problem.system, problem.parameters, c.link) &&
                             std::abs(value) > half;
      const double middle = elsewhere ? value : 0;
      ranges.push_back({middle - half, middle + half});
    } else {
      // What floats may hang by something as long as the mechanism, above its anchor as well as below.
      const bool floats =
          problem.system.tree_joints[static_cast<std::size_t>(c.tree_joint)].type == JointType::free;
      const double reach = 2 * problem.parameters.length, around = (floats ? 2 : 1) * reach;
      SearchRange range{value - around, value + around};
      const CoordinateForce& f = lp.force[0];
      if (f.has_spring()) {
        const SearchRange zeros = f.laws && f.laws->spring
                                      ? zeros_of_law(f.laws->spring, problem.parameters.length)
                                      : SearchRange{};
        range = {std::min(range.lower, f.slack() + zeros.lower - reach),
                 std::max(range.upper, f.slack() + zeros.upper + reach)};
        // Else few starts would be left for what lies near.
        if (zeros.upper - zeros.lower > reach) range.even = std::abs(value) + around;
      }
      // What is pushed rests at a stop, which gives way by what its stiffness allows.
      const double before = range.upper - range.lower;
      if (f.has_lower) range.lower = f.lower - 0.5 * reach;
      if (f.has_upper) range.upper = f.upper + 0.5 * reach;
      if (range.upper < range.lower) range = {value - reach, value + reach};
      if (range.upper - range.lower > 2 * before) range.even = std::abs(value) + around;
      ranges.push_back(range);
    }
  }
  return ranges;
}

bool widen_speeds(const Problem& problem, double times, std::vector<SearchRange>& ranges) {
  bool any = false;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (!finds_speed(link_of(problem, problem.system.coordinates[i]))) continue;
    const double far = std::max(std::abs(ranges[i].lower), std::abs(ranges[i].upper)), most = times * far,
                 even = far / times;
    ranges[i] = SearchRange{-most, most, even};
    any = true;
  }
  return any;
}

void include(const Problem& problem, const Eigen::VectorXd& q, std::vector<SearchRange>& ranges) {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const CoordinateInfo& c = problem.system.coordinates[i];
    const Link& link = link_of(problem, c);
    if (link.v < 0 || link.type == LinkType::spherical) continue;
    if (c.angle && turns_freely(problem.system, problem.parameters, c.link)) continue;
    const double value =
        finds_speed(link) ? q[link.q] : coordinate_value(problem.system, problem.parameters, q, c);
    const double margin = finds_speed(link) ? 0.1 * problem.scaling.column[link.v]
                          : c.angle         ? 0.5
                                            : 0.1 * problem.parameters.length;
    if (value < ranges[i].lower) ranges[i].lower = value - margin;
    if (value > ranges[i].upper) ranges[i].upper = value + margin;
  }
}

Placement bring_within(const Problem& problem, const std::vector<SearchRange>& ranges, Eigen::VectorXd& q) {
  constexpr double slack = 1e-12; // rounding may put what lies on a border beyond it
  Placement placement = Placement::within;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const CoordinateInfo& c = problem.system.coordinates[i];
    const Link& link = link_of(problem, c);
    if (link.v < 0 || link.type == LinkType::spherical) continue;
    double& value = q[link.q];
    if (c.angle && turns_freely(problem.system, problem.parameters, c.link)) {
      value = std::remainder(value, 2 * pi);
      if (value <= -pi) value += 2 * pi;
    }
    const double room = slack * problem.scaling.column[link.v];
    const auto inside = [&] { return value >= ranges[i].lower - room && value <= ranges[i].upper + room; };
    if (inside()) continue;
    if (!c.angle || finds_speed(link) || !std::isfinite(value)) return Placement::outside;
    const double middle = (ranges[i].lower + ranges[i].upper) / 2;
    value = middle + std::remainder(value - middle, 2 * pi);
    if (!inside()) return Placement::outside;
    placement = Placement::turned;
  }
  return placement;
}

SearchStarts::SearchStarts(const Problem& problem, const std::vector<SearchRange>& ranges, std::uint32_t seed)
    : problem_(problem), ranges_(ranges) {
  std::mt19937 random(seed);
  unsigned prime = 1;
  for (int i = 0; i < problem.system.nv; ++i) {
    prime = prime_after(prime);
    const double root = std::sqrt(static_cast<double>(prime));
    stride_.push_back(root - std::floor(root));
    place_.push_back(static_cast<double>(random()) / 4294967296.);
  }
}

void SearchStarts::next(Eigen::VectorXd& q) {
  for (std::size_t i = 0; i < place_.size(); ++i) {
    place_[i] += stride_[i];
    place_[i] -= std::floor(place_[i]);
  }
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const CoordinateInfo& c = problem_.system.coordinates[i];
    const Link& link = link_of(problem_, c);
    if (link.v < 0) continue;
    const auto v = static_cast<std::size_t>(link.v);
    if (link.type != LinkType::spherical) {
      const SearchRange& range = ranges_[i];
      if (range.even > 0) {
        const double lower = std::asinh(range.lower / range.even),
                     upper = std::asinh(range.upper / range.even);
        q[link.q] = range.even * std::sinh(lower + (upper - lower) * place_[v]);
      } else {
        q[link.q] = range.lower + (range.upper - range.lower) * place_[v];
      }
    } else if (c.index == link.coordinate) {
      const double a = std::sqrt(1 - place_[v]), b = std::sqrt(place_[v]);
      const double x = 2 * pi * place_[v + 1], y = 2 * pi * place_[v + 2];
      q.segment<4>(link.q) << b * std::cos(y), a * std::sin(x), a * std::cos(x), b * std::sin(y);
    }
  }
}

} // namespace flyball
