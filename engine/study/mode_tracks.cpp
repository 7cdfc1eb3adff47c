#include "engine/study/mode_tracks.hpp"

#include "engine/linear/assignment.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// A line as far as it is known.
struct Line {
  const VibrationMode *last = nullptr, *before = nullptr;
  double last_at = 0, before_at = 0;

  Complex foretold(double at) const {
    if (!before || !(last_at > before_at)) return last->eigenvalue;
    // Not much farther than what it is foretold from.
    const double ratio = std::min(2., (at - last_at) / (last_at - before_at));
    return last->eigenvalue + ratio * (last->eigenvalue - before->eigenvalue);
  }
  void go_on(const VibrationMode& mode, double at) {
    before = last;
    before_at = last_at;
    last = &mode;
    last_at = at;
  }
};

} // namespace

std::vector<std::vector<int>> track_modes(std::span<const std::vector<VibrationMode>> points,
                                          std::span<const double> positions) {
  std::size_t width = 0;
  double largest = 0;
  for (const std::vector<VibrationMode>& modes : points) {
    width = std::max(width, modes.size());
    for (const VibrationMode& mode : modes)
      largest = std::max(largest, std::abs(mode.eigenvalue));
  }
  std::vector<Line> lines(width);
  std::vector<std::vector<int>> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<VibrationMode>& modes = points[i];
    Eigen::MatrixXd cost(modes.size(), width);
    for (std::size_t k = 0; k < modes.size(); ++k)
      for (std::size_t l = 0; l < width; ++l) {
        // A line of its own only where none that is known is near.
        double& here = cost(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l));
        here = 10 + 1e-6 * static_cast<double>(l);
        if (!lines[l].last) continue;
        const Complex s = modes[k].eigenvalue, expected = lines[l].foretold(positions[i]);
        const double size = 0.2 * std::max(std::abs(s), std::abs(expected)) + 1e-6 * largest;
        const bool shapes = !modes[k].amplitudes.empty() && !lines[l].last->amplitudes.empty();
        here = std::min(9., size > 0 ? std::abs(s - expected) / size : 0) +
               (shapes ? 1 - modal_assurance(modes[k], *lines[l].last) : 0);
      }
    const std::vector<Eigen::Index> line = assign(cost);
    std::vector<int> row(width, -1);
    for (std::size_t k = 0; k < modes.size(); ++k) {
      row[static_cast<std::size_t>(line[k])] = static_cast<int>(k);
      lines[static_cast<std::size_t>(line[k])].go_on(modes[k], positions[i]);
    }
    out.push_back(std::move(row));
  }
  return out;
}

} // namespace flyball
