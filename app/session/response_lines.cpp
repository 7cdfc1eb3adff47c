// A diagram's branches with their special points in their places.
#include "app/session/response.hpp"
#include "engine/solve/solution_difference.hpp"

#include <cmath>
#include <limits>

namespace flyball {

namespace {

// How far apart two points look: the parameter over `range`, coordinates scaled.
double distance(const ResponsePoint& a, const ResponsePoint& b, double range) {
  return std::sqrt(std::pow((a.parameter - b.parameter) / range, 2) +
                   squared_distance(a.coordinates, b.coordinates));
}

// Where a special point belongs in its branch: the gap that it lengthens least. 0: before all points, or at
// the first itself.
std::size_t gap_for(const ResponsePoint& point, const std::vector<ResponsePoint>& points, double range) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double longer = distance(points[i - 1], point, range) + distance(point, points[i], range) -
                          distance(points[i - 1], points[i], range);
    if (longer >= least) continue;
    least = longer;
    best = i;
  }
  return best;
}

} // namespace

std::vector<ResponseLine> response_lines(ResponseDiagram& diagram) {
  std::vector<ResponseLine> lines;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (ResponseBranch& branch : diagram.branches) {
    for (const ResponsePoint& p : branch.points) {
      low = std::min(low, p.parameter);
      high = std::max(high, p.parameter);
    }
    lines.push_back({std::move(branch.points), {}, branch.connected});
    lines.back().special.assign(lines.back().points.size(), 0);
    branch.points.clear();
  }
  const double range = high > low ? high - low : 1;
  for (const SpecialPoint& special : diagram.special) {
    if (special.branch < 0 || static_cast<std::size_t>(special.branch) >= lines.size()) continue;
    ResponseLine& line = lines[static_cast<std::size_t>(special.branch)];
    const std::size_t gap = gap_for(special.at, line.points, range);
    if (gap == 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(gap);
    line.points.insert(line.points.begin() + at, special.at);
    line.special.insert(line.special.begin() + at, 1);
  }
  return lines;
}

} // namespace flyball
