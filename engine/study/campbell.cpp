#include "engine/study/campbell.hpp"

#include "engine/linear/assignment.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/study/mode_tracks.hpp"
#include "engine/study/order_crossings.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace flyball {
namespace {

// How far apart two points of a branch are, by what moves: only ratios count.
double apart(const ResponsePoint& a, const ResponsePoint& b, double range) {
  return std::sqrt(std::pow((b.parameter - a.parameter) / range, 2) +
                   squared_distance(a.coordinates, b.coordinates));
}

std::vector<std::string> names_of(const CampbellBranch& branch, std::size_t lines) {
  std::vector<std::string> names(lines);
  int number = 0;
  for (std::size_t l = 0; l < lines; ++l) {
    const auto swings = std::ranges::find_if(branch.points, [&](const CampbellPoint& point) {
      const VibrationMode* mode = point.on(l);
      return mode && mode->oscillates();
    });
    if (swings == branch.points.end()) continue;
    names[l] = "mode " + std::to_string(++number);
    if (const ModeAmplitude* most = swings->on(l)->leading()) names[l] += ", " + coordinate_label(*most);
  }
  return names;
}

CampbellBranch describe_branch(BranchModes& along, const ResponseBranch& followed) {
  CampbellBranch branch;
  std::vector<std::vector<VibrationMode>> modes;
  std::vector<double> positions;
  const double whole = std::abs(followed.points.back().parameter - followed.points.front().parameter);
  const double range = whole > 0 ? whole : 1;
  for (std::size_t i = 0; i < followed.points.size(); ++i) {
    branch.points.push_back(along.at(followed.points[i]));
    modes.push_back(branch.points.back().modes);
    positions.push_back(i == 0 ? 0
                               : positions.back() + apart(followed.points[i - 1], followed.points[i], range));
  }
  std::vector<std::vector<int>> lines = track_modes(modes, positions);
  for (std::size_t i = 0; i < lines.size(); ++i)
    branch.points[i].lines = std::move(lines[i]);
  branch.names = names_of(branch, branch.points.front().lines.size());
  return branch;
}

// Not known to be unstable at a point of the branch beside the critical speed.
bool stable_at(DriveSpeed& drive, const ResponseBranch& followed, const CriticalSpeed& critical) {
  for (std::size_t i = 1; i < followed.points.size(); ++i) {
    const ResponsePoint &a = followed.points[i - 1], &b = followed.points[i];
    const auto [low, high] = std::minmax({a.parameter, b.parameter});
    bool beside = critical.value >= low && critical.value <= high;
    if (critical.until) {
      const auto [slow, fast] = std::minmax({drive.at(a.parameter), drive.at(b.parameter)});
      beside = *critical.until >= slow && critical.speed <= fast;
    }
    if (beside && (a.stable == false || b.stable == false)) return false;
  }
  return true;
}

void add_critical(BranchModes& modes, const ResponseBranch& followed, const CampbellBranch& branch,
                  int number, std::span<const double> orders, std::vector<CriticalSpeed>& out) {
  std::vector<CriticalSpeed> critical;
  for (std::size_t l = 0; modes.turns() && l < branch.names.size(); ++l)
    for (const double order : orders)
      for (CriticalSpeed& found : order_crossings(modes, followed, branch, l, order)) {
        found.branch = number;
        found.line = static_cast<int>(l);
        found.stable = stable_at(modes.drive(), followed, found);
        critical.push_back(std::move(found));
      }
  std::ranges::stable_sort(critical, {}, &CriticalSpeed::speed);
  out.insert(out.end(), critical.begin(), critical.end());
}

} // namespace

std::vector<int> modes_on_lines(const ResponseBranch& followed, const CampbellBranch& branch,
                                std::size_t after, double value, std::span<const VibrationMode> modes) {
  constexpr double none = 2, most = 9; // unlikeness of what lies on no line, and of what is farthest from one
  const std::size_t lines = branch.names.size();
  const double from = followed.points[after].parameter, to = followed.points[after + 1].parameter;
  const double part = from == to ? 0 : (value - from) / (to - from);
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(modes.size()),
                                                   static_cast<Eigen::Index>(lines + modes.size()), none);
  for (std::size_t l = 0; l < lines; ++l) {
    const VibrationMode *a = branch.points[after].on(l), *b = branch.points[after + 1].on(l);
    for (std::size_t k = 0; k < modes.size(); ++k)
      cost(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) =
          a || b ? std::min(most, unlikeness(modes[k], a ? *a : *b, b ? *b : *a, part)) : most;
  }
  const std::vector<Eigen::Index> line = assign(cost);
  std::vector<int> out(lines, -1);
  for (std::size_t k = 0; k < modes.size(); ++k)
    if (line[k] < static_cast<Eigen::Index>(lines))
      out[static_cast<std::size_t>(line[k])] = static_cast<int>(k);
  return out;
}

bool unbalance_excites(const CriticalSpeed& critical) {
  constexpr double circle = 0.999; // as of Whirl::direction()
  return critical.order == 1 && critical.whirl && !critical.whirl->turning && critical.whirl->value > -circle;
}

std::string left_out(const ResponseBranch& branch, const std::function<std::string(double)>& speed_text,
                     const std::string& unit) {
  constexpr std::size_t most_told = 4;
  std::vector<std::string> at;
  const std::vector<ResponsePoint>& points = branch.points;
  for (std::size_t first = 0; first < points.size(); ++first) {
    if (!points[first].singular_loops) continue;
    std::size_t last = first;
    while (last + 1 < points.size() && points[last + 1].singular_loops)
      ++last;
    const auto [low, high] = std::minmax(points[first].parameter, points[last].parameter);
    at.push_back(low == high ? "at " + speed_text(low) + " " + unit
                             : "from " + speed_text(low) + " to " + speed_text(high) + " " + unit);
    first = last;
  }
  if (at.empty()) return {};
  std::string out = "Without modes ";
  for (std::size_t i = 0; i < std::min(at.size(), most_told); ++i)
    out += (i > 0 ? ", " : "") + at[i];
  if (at.size() > most_told) out += " and " + std::to_string(at.size() - most_told) + " more";
  return out + ". " + std::string(singular_loops_message);
}

CampbellDiagram campbell_diagram(const Mechanism& mechanism, const std::string& address,
                                 ResponseDiagram response, std::span<const double> orders,
                                 const std::atomic<bool>* cancel) {
  const auto begin = std::chrono::steady_clock::now();
  const Interruptible scope(cancel);
  CampbellDiagram out;
  out.response = std::move(response);
  if (out.response.branches.empty()) return out;
  BranchModes modes(mechanism, address, cancel);
  try {
    for (const ResponseBranch& followed : out.response.branches) {
      CampbellBranch branch = describe_branch(modes, followed);
      add_critical(modes, followed, branch, static_cast<int>(out.branches.size()), orders, out.critical);
      out.branches.push_back(std::move(branch));
    }
  } catch (const Interrupted&) {
  }
  out.run_time_s = out.response.run_time_s +
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

} // namespace flyball
