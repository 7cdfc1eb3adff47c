#include "engine/report/phase_range.hpp"

#include "engine/linear/golden_section.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/system/common_period.hpp"
#include "engine/system/reactions.hpp"

#include <algorithm>
#include <functional>
#include <numbers>

namespace flyball {
namespace {

// Drives (entries of System::drives) that return together in a state q, each with the whole turns it makes in
// a period; still ones are left out.
struct PhaseGroup {
  std::vector<int> drives, turns;
};

constexpr double turn = 2 * std::numbers::pi;

// Angles of the groups to torques of the motors.
class Torques {
 public:
  Torques(const Problem& problem, const Eigen::VectorXd& q, std::span<const int> motors,
          const std::vector<PhaseGroup>& groups, Workspace& w)
      : problem_(problem), q_(q), motors_(motors), groups_(groups), w_(w), turned_(problem.parameters) {}

  Eigen::VectorXd at(const Eigen::VectorXd& angles) {
    const System& system = problem_.system;
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t i = 0; i < groups_[g].drives.size(); ++i) {
        const auto l =
            static_cast<std::size_t>(system.drives[static_cast<std::size_t>(groups_[g].drives[i])].link);
        turned_.links[l].start =
            problem_.parameters.links[l].start + groups_[g].turns[i] * angles[static_cast<Eigen::Index>(g)];
      }
    const Problem there{system, turned_, problem_.scaling, problem_.cancel, problem_.form};
    const Unknowns z = with_reported_multipliers(there, q_, 0, w_);
    const TransmittedForces forces =
        transmitted_forces(system, turned_, z.lambda, w_.kinematics, w_.residual);
    Eigen::VectorXd out(static_cast<Eigen::Index>(motors_.size()));
    for (std::size_t m = 0; m < motors_.size(); ++m)
      out[static_cast<Eigen::Index>(m)] = forces.drives[static_cast<std::size_t>(motors_[m])];
    return out;
  }

 private:
  const Problem& problem_;
  const Eigen::VectorXd& q_;
  std::span<const int> motors_;
  const std::vector<PhaseGroup>& groups_;
  Workspace& w_;
  Parameters turned_;
};

// Torques on a grid of angles with as many values each.
struct Grid {
  int values = 0, dimensions = 0;
  std::vector<Eigen::VectorXd> torques; // the first angle moves fastest
  Eigen::VectorXd angles(std::size_t i) const {
    // Off the drawn phase by a part (golden, as good as any) of a step: loops are often drawn at right angles
    // and pass change points at others, where they lose a rank and multipliers jump.
    constexpr double beside = 0.38196601125;
    Eigen::VectorXd out(dimensions);
    for (int d = 0; d < dimensions; ++d, i /= static_cast<std::size_t>(values))
      out[d] = turn * (static_cast<double>(i % static_cast<std::size_t>(values)) + beside) / values;
    return out;
  }
};

// The greatest value of sign * torque near a grid point: searches along one angle after the other by golden
// sections, which needs no derivatives and cannot lose what it has.
double refined(Torques& torques, Eigen::Index motor, double sign, Eigen::VectorXd angles, double step,
               double value) {
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double before = value;
    for (Eigen::Index d = 0; d < angles.size(); ++d) {
      const auto at = [&](double x) {
        Eigen::VectorXd there = angles;
        there[d] = x;
        return sign * torques.at(there)[motor];
      };
      const Greatest found = golden_section(angles[d] - step, angles[d] + step, 1e-8, at);
      if (found.value > value) {
        value = found.value;
        angles[d] = found.at;
      }
    }
    if (angles.size() == 1 || value - before <= 1e-13 * std::abs(value)) break;
    step /= 2;
  }
  return value;
}

struct Peak {
  std::size_t point = 0;
  double bound = 0;
};

// Of each angle, whether the torque depends on it.
std::vector<bool> depends_on(const Grid& grid, Eigen::Index motor) {
  constexpr double rounding = 1e-12; // of the largest
  double largest = 0;
  for (const Eigen::VectorXd& torque : grid.torques)
    largest = std::max(largest, std::abs(torque[motor]));
  std::vector<bool> out;
  const auto n = static_cast<std::size_t>(grid.values);
  for (std::size_t d = 0, stride = 1; d < static_cast<std::size_t>(grid.dimensions); ++d, stride *= n) {
    bool depends = false;
    for (std::size_t i = 0; i < grid.torques.size() && !depends; ++i)
      depends = std::abs(grid.torques[i][motor] - grid.torques[i - i / stride % n * stride][motor]) >
                rounding * largest;
    out.push_back(depends);
  }
  return out;
}

// Grid points higher than their neighbours, by what may be there between them, the highest first: along each
// angle a peak rises above its point by no more than twice what a parabola through the neighbours says; on a
// narrow ridge across several angles it may be more. Along an angle on which nothing depends one point stands
// for all.
std::vector<Peak> peaks_of(const Grid& grid, Eigen::Index motor, double sign) {
  std::vector<Peak> out;
  const std::vector<bool> depends = depends_on(grid, motor);
  const auto n = static_cast<std::size_t>(grid.values);
  for (std::size_t i = 0; i < grid.torques.size(); ++i) {
    const double here = sign * grid.torques[i][motor];
    Peak peak{i, here};
    bool highest = true;
    std::size_t stride = 1;
    for (int d = 0; d < grid.dimensions && highest; ++d, stride *= n) {
      const std::size_t k = i / stride % n, base = i - k * stride;
      const double left = sign * grid.torques[base + (k + n - 1) % n * stride][motor];
      const double right = sign * grid.torques[base + (k + 1) % n * stride][motor];
      highest = depends[static_cast<std::size_t>(d)] ? here >= left && here >= right : k == 0;
      if (const double bend = 2 * here - left - right; bend > 0)
        peak.bound += (right - left) * (right - left) / (4 * bend);
    }
    if (highest) out.push_back(peak);
  }
  std::ranges::stable_sort(out, std::greater<>(), &Peak::bound);
  return out;
}

// Of sign * torque. Every peak is looked at that may be higher than the highest so far: where drives take
// many turns to return together, many are nearly alike.
double greatest(Torques& torques, const Grid& grid, Eigen::Index motor, double sign) {
  double value = -std::numeric_limits<double>::infinity();
  for (const Peak& peak : peaks_of(grid, motor, sign)) {
    if (!(peak.bound > value)) break;
    value = std::max(value, refined(torques, motor, sign, grid.angles(peak.point), turn / grid.values,
                                    sign * grid.torques[peak.point][motor]));
  }
  return value;
}

// Nothing where a drive slides: it never returns.
std::optional<std::vector<PhaseGroup>> phase_groups(const System& system, const Parameters& p,
                                                    const Eigen::VectorXd& q) {
  struct Group {
    std::vector<int> drives;
    std::vector<double> speeds; // rad/s
    double period = 0;          // s
  };
  std::vector<Group> groups;
  for (int d = 0; d < static_cast<int>(system.drives.size()); ++d) {
    const auto l = static_cast<std::size_t>(system.drives[static_cast<std::size_t>(d)].link);
    const Link& link = system.links[l];
    const double speed = finds_speed(link) ? q[link.q] : p.links[l].speed;
    if (speed == 0) continue;
    if (link.type != LinkType::revolute) return std::nullopt;
    bool found = false;
    for (Group& g : groups) {
      std::vector<double> speeds = g.speeds;
      speeds.push_back(speed);
      const auto period = common_period(speeds, followed_turns);
      if (!period) continue;
      g.drives.push_back(d);
      g.speeds = std::move(speeds);
      g.period = *period;
      found = true;
      break;
    }
    if (!found) groups.push_back({{d}, {speed}, turn / std::abs(speed)});
  }
  std::vector<PhaseGroup> out;
  for (const Group& g : groups) {
    out.push_back({g.drives, {}});
    for (double speed : g.speeds)
      out.back().turns.push_back(static_cast<int>(std::lround(speed * g.period / turn)));
  }
  return out;
}

} // namespace

std::vector<std::optional<PhaseRange>> drive_ranges(const Problem& problem, const Eigen::VectorXd& q,
                                                    std::span<const int> motors, Workspace& w) {
  std::vector<std::optional<PhaseRange>> out(motors.size());
  const auto groups = phase_groups(problem.system, problem.parameters, q);
  if (!groups || groups->empty() || groups->size() > 3) return out;
  Torques torques(problem, q, motors, *groups, w);
  Grid grid;
  grid.dimensions = static_cast<int>(groups->size());
  // Products of what turns once make the harmonics: several of the fastest drive's.
  int fastest = 1;
  for (const PhaseGroup& g : *groups)
    for (int turns : g.turns)
      fastest = std::max(fastest, std::abs(turns));
  constexpr std::size_t most_points = 30000;
  grid.values = grid.dimensions == 1   ? 32 + 16 * fastest
                : grid.dimensions == 2 ? std::max(40, 16 * fastest)
                                       : std::max(14, 10 * fastest);
  std::size_t count = 1;
  for (int d = 0; d < grid.dimensions; ++d)
    count *= static_cast<std::size_t>(grid.values);
  if (count > most_points) return out;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(motors.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (problem.cancelled()) return out;
    grid.torques.push_back(torques.at(grid.angles(i)));
    sum += grid.torques.back();
  }
  for (std::size_t m = 0; m < motors.size(); ++m) {
    const auto motor = static_cast<Eigen::Index>(m);
    PhaseRange range;
    range.mean = sum[motor] / static_cast<double>(count);
    range.most = greatest(torques, grid, motor, 1);
    range.least = -greatest(torques, grid, motor, -1);
    out[m] = range;
  }
  return out;
}

} // namespace flyball
