// Runs by name and as poses.
#include "engine/dynamics/motion_model.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>

namespace flyball {
namespace {

const MotionModel& model_of(const Run& run, std::size_t sample) {
  auto segment = run.segments.rbegin();
  while (segment->first > sample && segment + 1 != run.segments.rend())
    ++segment;
  return *segment->model;
}

struct Sample {
  Eigen::Map<const Eigen::VectorXd> q, u;
};

Sample sample_of(const Run& run, const MotionModel& model, std::size_t i) {
  const int nq = model.system.nq, nv = model.system.nv;
  const double* x = run.states.data() + i * static_cast<std::size_t>(nq + nv);
  return {{x, nq}, {x + nq, nv}};
}

Quat rotation_at(const Eigen::VectorXd& q, int at) {
  return Quat(q[at], q[at + 1], q[at + 2], q[at + 3]).normalized();
}

// The cubic through 0 and `end` with these slopes, over [0, 1].
template <class V>
V cubic(double x, const V& slope, const V& end, const V& end_slope) {
  return slope * (x * (1 - x) * (1 - x)) + end * (x * x * (3 - 2 * x)) + end_slope * (x * x * (x - 1));
}

} // namespace

std::string_view word(Integrator integrator) {
  switch (integrator) {
  case Integrator::automatic: return "automatic";
  case Integrator::bdf: return "bdf";
  case Integrator::adams: return "adams";
  case Integrator::runge_kutta: return "runge_kutta";
  }
  return "";
}

std::string_view word(Start start) {
  switch (start) {
  case Start::rest: return "rest";
  case Start::drawn: return "drawn";
  case Start::equilibrium: return "equilibrium";
  case Start::state: return "state";
  }
  return "";
}

std::string_view word(RunStatus status) {
  switch (status) {
  case RunStatus::completed: return "completed";
  case RunStatus::cancelled: return "cancelled";
  case RunStatus::time_limit: return "time_limit";
  case RunStatus::diverged: return "diverged";
  }
  return "";
}

std::vector<Pose> poses_at(const Run& run, double time) {
  std::vector<Pose> poses;
  if (run.time.empty()) return poses;
  const auto after = std::ranges::upper_bound(run.time, time);
  const std::size_t i =
      after == run.time.begin() ? 0 : static_cast<std::size_t>(after - run.time.begin()) - 1;
  time = std::clamp(time, run.time.front(), run.time.back());
  const MotionModel& model = model_of(run, i);
  const Sample from = sample_of(run, model, i);
  Eigen::VectorXd q = from.q;
  if (i + 1 < run.time.size() && time > run.time[i]) {
    const Sample to = sample_of(run, model, i + 1);
    const double span = run.time[i + 1] - run.time[i], x = (time - run.time[i]) / span;
    for (const Link& link : model.system.links) {
      if (link.v < 0) continue;
      if (link.type != LinkType::spherical) {
        q[link.q] +=
            cubic<double>(x, from.u[link.v] * span, to.q[link.q] - from.q[link.q], to.u[link.v] * span);
        continue;
      }
      const Quat d = rotation_at(from.q, link.q);
      const Vec3 turn = log_rotation<double>(rotation_at(to.q, link.q) * d.conjugate());
      const Vec3 slope = from.u.segment<3>(link.v) * span;
      const Vec3 end_slope = inverse_left_jacobian<double>(turn) * to.u.segment<3>(link.v) * span;
      const Quat now = exp_rotation<double>(cubic<Vec3>(x, slope, turn, end_slope)) * d;
      q.segment<4>(link.q) << now.w(), now.x(), now.y(), now.z();
    }
  }
  Kinematics<double> k;
  for (const Link& link : model.system.links)
    if (link.v >= 0 && link.type == LinkType::spherical) q.segment<4>(link.q).normalize();
  forward<double>(model.system, model.parameters, q, time, k);
  body_poses(model.system, model.mechanism, model.parameters, k, poses);
  return poses;
}

SimulationState state_at(const Run& run, std::size_t sample) {
  const MotionModel& model = model_of(run, sample);
  const Sample s = sample_of(run, model, sample);
  return name_state(model, run.time[sample], s.q, s.u);
}

} // namespace flyball
