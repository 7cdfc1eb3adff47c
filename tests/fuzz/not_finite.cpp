#include "tests/fuzz/not_finite.hpp"

#include <algorithm>
#include <cmath>

namespace flyball::fuzz {
namespace {

bool is_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

bool is_finite(const std::vector<std::complex<double>>& values) {
  return std::ranges::all_of(values,
                             [](auto x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); });
}

} // namespace

bool finite(const Pose& pose) {
  return pose.position.allFinite() && pose.rotation.coeffs().allFinite();
}

std::optional<std::string> not_finite(const Solution& s) {
  for (const CoordinateSolution& c : s.coordinates)
    if (!std::isfinite(c.value) || !std::isfinite(c.error)) return "coordinate " + c.joint;
  for (const JointMultipliers& m : s.multipliers)
    for (const double value : m.values)
      if (!std::isfinite(value)) return "multiplier of " + m.joint;
  if (std::isnan(s.residual)) return "residual";
  for (const double residual : s.history)
    if (std::isnan(residual)) return "history";
  if (s.eigenvalues)
    if (!is_finite(*s.eigenvalues)) return "eigenvalue";
  for (const DriveTorque& torque : s.drive_torques)
    if (!std::isfinite(torque.value) ||
        (torque.given && (!std::isfinite(torque.given->torque) || !std::isfinite(torque.given->load))))
      return "drive torque of " + torque.joint;
  for (const Reaction& reaction : s.reactions)
    if (!reaction.force.allFinite() || !reaction.torque.allFinite()) return "reaction of " + reaction.joint;
  for (const Pose& pose : s.poses)
    if (!finite(pose)) return "pose";
  for (const MeasureSolution& measure : s.measures)
    if (!std::isfinite(measure.value.value_or(0) + measure.error.value_or(0)))
      return "measure " + measure.name;
  for (const Sensitivity& sensitivity : s.sensitivities)
    for (const Sensitivity::Rate& rate : sensitivity.rates)
      if (!std::isfinite(rate.value)) return "sensitivity to " + sensitivity.address;
  if (s.potential && !std::isfinite(*s.potential)) return "potential";
  if (s.condition && std::isnan(*s.condition)) return "condition";
  return std::nullopt;
}

std::optional<std::string> not_finite(const ResponsePoint& point) {
  if (!std::isfinite(point.parameter)) return "parameter";
  for (const CoordinateSolution& c : point.coordinates)
    if (!std::isfinite(c.value) || !std::isfinite(c.error)) return "coordinate " + c.joint;
  if (!is_finite(point.eigenvalues)) return "eigenvalue";
  for (const DriveTorque& torque : point.drive_torques)
    if (!std::isfinite(torque.value)) return "drive torque of " + torque.joint;
  for (const Reaction& reaction : point.reactions)
    if (!reaction.force.allFinite() || !reaction.torque.allFinite()) return "reaction of " + reaction.joint;
  return std::nullopt;
}

std::optional<std::string> not_finite(const Run& run) {
  if (!is_finite(run.time)) return "time";
  for (const CoordinateTrack& track : run.coordinates)
    if (!is_finite(track.value) || !is_finite(track.rate)) return "coordinate " + track.joint;
  for (const DriveTrack& track : run.drives)
    if (!is_finite(track.torque)) return "drive torque of " + track.joint;
  for (const auto* energy :
       {&run.energy.kinetic, &run.energy.potential, &run.energy.jacobi, &run.energy.balance})
    if (!is_finite(*energy)) return "energy";
  return std::nullopt;
}

} // namespace flyball::fuzz
