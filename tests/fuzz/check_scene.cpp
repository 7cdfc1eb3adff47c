#include "tests/fuzz/check_scene.hpp"

#include "engine/equilibrium/analysis.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace flyball::fuzz {
namespace {

constexpr std::size_t most_bodies = 10, most_parts = 14;
constexpr int most_coordinates = 20;

bool small(const Mechanism& m) {
  int coordinates = 0;
  for (const Joint& joint : m.joints)
    coordinates += coordinate_count(joint.type);
  return m.bodies.size() <= most_bodies && m.joints.size() <= most_parts && m.forces.size() <= most_parts &&
         m.sliders.size() <= most_parts && coordinates <= most_coordinates;
}

// Sets a flag when the time is up.
class Watch {
 public:
  explicit Watch(std::chrono::milliseconds limit)
      : thread_([this, limit] {
          std::unique_lock lock(mutex_);
          if (!stop_.wait_for(lock, limit, [this] { return over_; })) expired_ = true;
        }) {}
  ~Watch() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    stop_.notify_one();
    thread_.join();
  }
  const std::atomic<bool>* expired() const { return &expired_; }

 private:
  std::atomic<bool> expired_ = false;
  bool over_ = false;
  std::mutex mutex_;
  std::condition_variable stop_;
  std::thread thread_;
};

bool finite(const Pose& pose) {
  return pose.position.allFinite() && pose.rotation.coeffs().allFinite();
}

// The first field with a number that is none.
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
    for (const std::complex<double>& value : *s.eigenvalues)
      if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) return "eigenvalue";
  for (const DriveTorque& torque : s.drive_torques)
    if (!std::isfinite(torque.value)) return "drive torque of " + torque.joint;
  for (const Reaction& reaction : s.reactions)
    if (!reaction.force.allFinite() || !reaction.torque.allFinite()) return "reaction of " + reaction.joint;
  for (const Pose& pose : s.poses)
    if (!finite(pose)) return "pose";
  for (const Sensitivity& sensitivity : s.sensitivities)
    for (const Sensitivity::Rate& rate : sensitivity.rates)
      if (!std::isfinite(rate.value)) return "sensitivity to " + sensitivity.address;
  if (s.potential && !std::isfinite(*s.potential)) return "potential";
  if (s.condition && std::isnan(*s.condition)) return "condition";
  return std::nullopt;
}

std::optional<std::string> check_saving(const Mechanism& m) {
  const std::string text = write_scene(m);
  try {
    const Mechanism again = parse_scene(text);
    if (!(again == m)) return "saved and loaded it is another mechanism:\n" + text;
    if (write_scene(again) != text) return "saved twice it is another text:\n" + text;
  } catch (const SceneError& error) {
    return std::string("what was saved does not load: ") + error.what();
  }
  return std::nullopt;
}

std::optional<std::string> check_solving(const Mechanism& m, std::chrono::milliseconds limit) {
  std::optional<Analysis> analysis;
  try {
    analysis.emplace(m);
  } catch (const SceneError& error) {
    if (error.expected().empty()) return "refused without a reason";
    return std::nullopt;
  }
  const Watch watch(limit);
  for (const bool nearest : {false, true}) {
    SolveOptions options;
    options.nearest = nearest;
    options.cancel = watch.expired();
    const Solution solution = analysis->solve(options);
    if (const auto field = not_finite(solution)) return "a number that is none: " + *field;
    if (solution.message.empty()) return "no message";
    if (solution.status == Status::converged && solution.poses.size() != m.bodies.size())
      return "converged without a pose for every body";
  }
  for (const Pose& pose : analysis->poses_at(0.3))
    if (!finite(pose)) return "a number that is none: pose at 0.3 s";
  return std::nullopt;
}

} // namespace

std::optional<std::string> check_scene(std::string_view bytes, std::chrono::milliseconds limit) {
  Mechanism m;
  try {
    m = parse_scene(bytes);
  } catch (const SceneError& error) {
    if (error.expected().empty()) return "refused without a reason";
    return std::nullopt;
  }
  if (auto complaint = check_saving(m)) return complaint;
  const std::vector<SceneError> mistakes = find_mistakes(m);
  for (const SceneError& mistake : mistakes)
    if (mistake.expected().empty()) return "a mistake without words";
  if (!mistakes.empty() || !small(m)) return std::nullopt;
  return check_solving(m, limit);
}

} // namespace flyball::fuzz
