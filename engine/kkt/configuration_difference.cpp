#include "engine/kkt/configuration_difference.hpp"

#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

constexpr double turn = 2 * std::numbers::pi;

// std::remainder(angle, turn), whose division takes many times as long as the rest: up to two turns less one
// is exact.
double without_turns(double angle) {
  const double size = std::abs(angle);
  if (size <= turn / 2) return angle;
  const double less_one = size - turn;
  if (std::abs(less_one) < turn / 2) return angle < 0 ? -less_one : less_one;
  return std::remainder(angle, turn);
}

bool leaves_turns_out(const Problem& problem, std::size_t l) {
  const Link& link = problem.system.links[l];
  return link.type == LinkType::revolute && !finds_speed(link) &&
         !turns_matter(problem.system, problem.parameters, static_cast<int>(l));
}

// `without(l)`: whether turns of the link do not count.
template <class Without>
void take_difference(const Problem& problem, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                     const Without& without, Eigen::VectorXd& out) {
  out.setZero(problem.system.nv);
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical) {
      const auto rotation = [&](const Eigen::VectorXd& q) {
        return Quat(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
      };
      out.segment<3>(link.v) = log_rotation<double>(rotation(to) * rotation(from).conjugate());
      continue;
    }
    double d = to[link.q] - from[link.q];
    if (without(l)) d = without_turns(d);
    out[link.v] = d / problem.scaling.column[link.v];
  }
}

// Visits the scaled distances (v, entries, distance) coordinate by coordinate. `all_turns`: whole turns of
// sprung angles are left out, too.
template <class Visit>
void distances(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b, bool all_turns,
               Visit visit) {
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical) {
      const double cosine = std::abs(a.segment<4>(link.q).dot(b.segment<4>(link.q)));
      // By the sine, too: the cosine of a small angle has lost half its digits.
      const double sine = std::min((a.segment<4>(link.q) - b.segment<4>(link.q)).norm(),
                                   (a.segment<4>(link.q) + b.segment<4>(link.q)).norm());
      visit(link.v, 3,
            cosine > 0.9 ? 4 * std::asin(std::min(1., sine / 2)) : 2 * std::acos(std::min(1., cosine)));
      continue;
    }
    double d = a[link.q] - b[link.q];
    if (link.type == LinkType::revolute && !finds_speed(link) && (all_turns || leaves_turns_out(problem, l)))
      d = without_turns(d);
    visit(link.v, 1, d / problem.scaling.column[link.v]);
  }
}

} // namespace

bool same_pose(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance,
               const std::vector<int>& ignore) {
  bool same = true;
  distances(problem, a, b, false, [&](int v, int count, double d) {
    for (int i = v; i < v + count; ++i)
      if (std::ranges::find(ignore, i) != ignore.end()) return;
    if (!(std::abs(d) <= tolerance)) same = false;
  });
  return same;
}

bool same_but_for_turns(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                        double tolerance) {
  bool same = true;
  distances(problem, a, b, true, [&](int, int, double d) {
    if (!(std::abs(d) <= tolerance)) same = false;
  });
  return same;
}

Eigen::VectorXd scaled_difference(const Problem& problem, const Eigen::VectorXd& from,
                                  const Eigen::VectorXd& to) {
  Eigen::VectorXd out;
  take_difference(
      problem, from, to, [&](std::size_t l) { return leaves_turns_out(problem, l); }, out);
  return out;
}

ScaledDifference::ScaledDifference(const Problem& problem) : problem_(problem) {
  for (std::size_t l = 0; l < problem.system.links.size(); ++l)
    without_turns_.push_back(leaves_turns_out(problem, l));
}

void ScaledDifference::take(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                            Eigen::VectorXd& out) const {
  take_difference(
      problem_, from, to, [&](std::size_t l) { return without_turns_[l] != 0; }, out);
}

double squared_distance(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  distances(problem, a, b, false, [&](int, int, double d) { sum += d * d; });
  return sum;
}

} // namespace flyball
