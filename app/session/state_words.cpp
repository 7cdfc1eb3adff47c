#include "app/session/state_words.hpp"

#include "app/session/coordinate_words.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/periodic/limit_cycle.hpp"
#include "engine/solve/solution_difference.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string_view>

namespace flyball {

const char* reason_text(StabilityReason reason) {
  switch (reason) {
  case StabilityReason::minimum: return "A minimum of the amended potential.";
  case StabilityReason::asymptotic: return "Every disturbance dies out.";
  case StabilityReason::gyroscopic_only:
    return "Held by gyroscopic effects alone; any damping destabilises it.";
  case StabilityReason::neutral: return "Stable but for directions that nothing resists.";
  case StabilityReason::marginal: return "Too close to the limit of stability to tell.";
  case StabilityReason::unstable: return "Disturbances grow.";
  case StabilityReason::floquet:
    return "By the Floquet multipliers: the linearised motion turns with the drives.";
  case StabilityReason::varying:
    return "The linearised motion turns with the drives, and no multipliers tell of it.";
  }
  return "";
}

std::string growth_words(const Solution& solution) {
  if (solution.stable != false || !solution.eigenvalues || solution.eigenvalues->empty()) return {};
  const std::complex<double> fastest = *std::ranges::max_element(
      *solution.eigenvalues, {}, [](const std::complex<double>& each) { return each.real(); });
  if (!(fastest.real() > 0)) return {};
  const std::string doubled = rounded_text(std::numbers::ln2 / fastest.real(), 3) + " s.";
  if (fastest.imag() == 0) return "It is left without a swing: disturbances double every " + doubled;
  return std::string(hunts(solution) ? "It hunts: swings" : "Swings") + " at " +
         rounded_text(std::abs(fastest.imag()) / (2 * std::numbers::pi), 3) + " Hz double every " + doubled;
}

std::string undamped_words(const Solution& solution) {
  if (solution.stability_reason != StabilityReason::marginal || !solution.eigenvalues) return {};
  constexpr double undamped = 1e-9; // of its frequency, what is rounding in a rate of decay
  double slowest = 0;               // rad/s
  bool several = false;
  for (const std::complex<double>& each : *solution.eigenvalues) {
    if (each.real() > undamped * std::abs(each)) return {}; // something else is near the limit
    const double frequency = std::abs(each.imag());
    if (!(frequency > 0) || each.real() < -undamped * frequency) continue;
    several = several || (slowest > 0 && std::abs(frequency - slowest) > 1e-3 * slowest);
    slowest = slowest > 0 ? std::min(slowest, frequency) : frequency;
  }
  if (slowest == 0) return {};
  return "Nothing damps " + std::string(several ? "swings, the slowest at " : "the swing at ") +
         rounded_text(slowest / (2 * std::numbers::pi), 4) +
         " Hz: " + (several ? "they neither grow nor die out." : "it neither grows nor dies out.");
}

std::string window_message(const Solution& solution) {
  constexpr std::string_view command = "solve --all looks", own = "the tab States looks";
  std::string text = solution.message;
  if (const std::size_t at = text.find(command); at != std::string::npos)
    text.replace(at, command.size(), own);
  for (const CoordinateSolution& c : solution.coordinates)
    if (const std::string name = joint_words(c.joint); c.index == 0 && name != c.joint)
      for (std::size_t at = text.find(c.joint); at != std::string::npos; at = text.find(c.joint, at + 1))
        text.replace(at, c.joint.size(), name);
  return text;
}

bool same_state(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b,
                const std::vector<std::string>& neutral) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].joint != b[i].joint || a[i].index != b[i].index) return false;
    if (a[i].speed && b[i].speed &&
        !(std::abs(*a[i].speed - *b[i].speed) <=
          1e-6 * std::abs(*a[i].speed) + 10 * (a[i].speed_error + b[i].speed_error)))
      return false;
    if (a[i].driven || std::ranges::find(neutral, a[i].joint) != neutral.end()) continue;
    if (!(std::abs(value_difference(a[i], b[i])) <= 1e-6 + 10 * (a[i].error + b[i].error) / a[i].scale))
      return false;
  }
  return true;
}

std::optional<DriveTorque::Given> told_torque(const Solution& solution, const DriveTorque& drive) {
  if (!drive.given) return std::nullopt;
  double size = 0; // m
  for (const Pose& pose : solution.poses)
    size = std::max(size, (pose.position - solution.poses.front().position).norm());
  double largest = 0;
  for (const Reaction& r : solution.reactions)
    largest =
        std::max(largest, drive.angle ? std::max(r.torque.norm(), size * r.force.norm()) : r.force.norm());
  const auto told = [&](double value) { return std::abs(value) < 1e-12 * largest ? 0 : value; };
  return DriveTorque::Given{told(drive.given->torque), told(drive.given->load)};
}

} // namespace flyball
