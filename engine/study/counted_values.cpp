#include "engine/study/counted_values.hpp"

#include "engine/mechanism/measure_plan.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

// Rotation vectors do not count turns.
bool counts_turns(const Mechanism& mechanism, const ResponsePoint& state, const std::string& name) {
  if (const int measure = measure_index(mechanism, name); measure >= 0)
    return mechanism.measures[static_cast<std::size_t>(measure)].unit == "rad";
  return std::ranges::any_of(state.coordinates, [&](const CoordinateSolution& c) {
    const auto number = found_number(c);
    if (!number || number->name != name || number->unit != "rad") return false;
    const auto joint = std::ranges::find(mechanism.joints, c.joint, &Joint::name);
    return joint != mechanism.joints.end() && !is_rotation_vector(joint->type, c.index);
  });
}

std::size_t nearest(const ResponseBranch& branch, const ResponsePoint& to) {
  const auto distance = [&](const ResponsePoint& point) {
    return scaled_distance(point.coordinates, to.coordinates);
  };
  return static_cast<std::size_t>(std::ranges::min_element(branch.points, {}, distance) -
                                  branch.points.begin());
}

} // namespace

double told_value(const ResponsePoint& point, const std::string& name) {
  for (const CoordinateSolution& c : point.coordinates)
    if (const auto number = found_number(c); number && number->name == name) return number->value;
  for (const MeasureSolution& m : point.measures)
    if (m.name == name) return m.value.value_or(std::nan(""));
  return std::nan("");
}

double counted_on(double angle, double from) {
  return from + std::remainder(angle - from, 2 * std::numbers::pi);
}

CountedValues counted_values(const Mechanism& mechanism, const ResponseDiagram& diagram,
                             const ResponsePoint& state, const std::string& name, double value) {
  CountedValues out;
  const bool counts = counts_turns(mechanism, state, name);
  out.special.assign(diagram.special.size(), std::numeric_limits<double>::quiet_NaN());
  for (const ResponseBranch& branch : diagram.branches) {
    const std::size_t index = out.branches.size();
    std::vector<double>& values = out.branches.emplace_back();
    if (!branch.connected) continue;
    for (const ResponsePoint& point : branch.points) {
      const double told = told_value(point, name);
      values.push_back(counts && !values.empty() ? counted_on(told, values.back()) : told);
    }
    if (counts && !values.empty()) {
      // The first passes the state; any other begins in a crossing on one before.
      double from = value, at = index == 0 ? values[nearest(branch, state)] : values.front();
      for (std::size_t s = 0; s < diagram.special.size() && index > 0; ++s)
        if (diagram.special[s].type == SpecialPointType::branch_point && std::isfinite(out.special[s]) &&
            diagram.special[s].at.parameter == branch.points.front().parameter)
          from = out.special[s];
      const double turned = counted_on(at, from) - at;
      for (double& v : values)
        v += turned;
      out.goes_round = out.goes_round || (branch.end == closed_branch &&
                                          std::abs(values.back() - values.front()) > std::numbers::pi);
    }
    for (std::size_t s = 0; s < diagram.special.size(); ++s) {
      const SpecialPoint& special = diagram.special[s];
      if (static_cast<std::size_t>(special.branch) != index || values.empty()) continue;
      const double told = told_value(special.at, name);
      out.special[s] = counts ? counted_on(told, values[nearest(branch, special.at)]) : told;
    }
  }
  return out;
}

} // namespace flyball
