#include "engine/dynamics/singular_position.hpp"

namespace flyball {
namespace {

// Nearer than this the rounding grows past the tolerances in use; and the leap is short enough for its error,
// of fourth order, to be below them.
constexpr double near = 1e-3;

Eigen::Vector3d powers(Equations& equations) {
  const ForcePowers p = equations.powers();
  return {p.dissipated, equations.drive_power(), p.applied};
}

} // namespace

std::optional<Leap> leap(Equations& equations, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s,
                         double best, double rate_scale) {
  if (equations.has_massless() || !equations.evaluate(t, q, s)) return {};
  const System& system = equations.model().system;
  const double here = equations.independence();
  if (here > near * best) return {};
  // 1/s, of the motion as it is now, which may be far faster than what the run began with.
  const double rate =
      std::max(rate_scale, s.cwiseQuotient(equations.model().scaling.column).lpNorm<Eigen::Infinity>());
  const Eigen::VectorXd a = equations.acceleration();
  const Eigen::Vector3d before = powers(equations);
  // The state further on (s) by Taylor's series.
  const auto moved = [&](double span, const Eigen::VectorXd& jerk, Eigen::VectorXd& to_q,
                         Eigen::VectorXd& to_s) {
    const Eigen::VectorXd step = span * (s + span * (a / 2 + span / 6 * jerk));
    to_q = q;
    retract<double>(system, step, to_q);
    to_s = s + span * (a + span / 2 * jerk);
  };
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.nv);
  Leap out;
  const double probe = 1e-3 * near / rate;
  moved(probe, none, out.q, out.s);
  if (!equations.evaluate(t + probe, out.q, out.s)) return {};
  const double slope = (equations.independence() - here) / probe;
  if (slope >= 0) return {};
  const double half = -here / slope;
  if (half > 10 * near / rate) return {}; // it may well turn round before
  moved(-half, none, out.q, out.s);
  if (!equations.project(t - half, out.q, out.s) || !equations.evaluate(t - half, out.q, out.s)) return {};
  const Eigen::VectorXd jerk = (a - equations.acceleration()) / half;
  moved(2 * half, jerk, out.q, out.s);
  out.time = t + 2 * half;
  if (!equations.catch_up(out.time, out.q, out.s) || !equations.evaluate(out.time, out.q, out.s)) return {};
  out.energies = half * (before + powers(equations));
  return out;
}

} // namespace flyball
