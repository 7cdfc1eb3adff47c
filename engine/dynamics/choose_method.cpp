#include "engine/dynamics/choose_method.hpp"

#include "engine/dynamics/fastest_rates.hpp"
#include "engine/linear/pencil.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/drive_rates.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

// Of the Runge-Kutta method of order 8: evaluations a step, and how long a step times an eigenvalue to the
// left may be.
constexpr double stages = 13, stable_step = 4.5;
// Steps that an oscillation needs a radian, times the tolerance to the power of one over the order.
constexpr double steps_explicit = 0.09, steps_implicit = 0.25;
// Coordinates up to which all rates are found.
constexpr int most_for_all_rates = 64;

} // namespace

MethodChoice choose_method(Equations& equations, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s,
                           double duration, double tolerance, Integrator wanted) {
  const MotionModel& model = equations.model();
  MethodChoice out;
  std::vector<std::complex<double>> rates;
  // What moves it and how it moves, in radians or reaches: modes of larger rates than these allow for are not
  // seen, and need not be followed.
  double push = 0, speed = 0;
  if (model.system.nv > 0) {
    push = equations.acceleration().cwiseQuotient(model.scaling.column).lpNorm<Eigen::Infinity>();
    speed = s.cwiseQuotient(model.scaling.column).lpNorm<Eigen::Infinity>();
  }
  const bool at_rest = push == 0 && speed == 0;
  if (model.system.nv > 0 && model.system.nv <= most_for_all_rates) {
    const Equations::Pencil p = equations.pencil();
    rates = pencil_eigenvalues(p.mass, p.velocity, p.stiffness).value_or(rates);
  } else if (model.system.nv > 0) {
    rates = fastest_rates(equations, t, q, s);
  }
  const double driven = fastest_given_rate(model.system, model.parameters);
  double fastest = 0, slowest = 0, explicit_cost = 0, implicit_cost = 0;
  std::complex<double> costly = 0;
  for (const std::complex<double>& rate : rates) {
    const double size = std::abs(rate);
    if (!(size > 0) || !std::isfinite(size)) continue;
    slowest = slowest == 0 ? size : std::min(slowest, size);
    fastest = std::max(fastest, size);
    // A motion is to be followed until it has died out, and held stable to the end.
    const double decay = std::max(0., -rate.real());
    const bool seen = at_rest || std::max(push / size, speed) / size > tolerance;
    const double alive = !seen ? 0 : decay > 0 ? std::min(duration, -std::log(tolerance) / decay) : duration;
    const double followed = size * alive * steps_explicit * std::pow(tolerance, -1. / 8);
    const double settled = size * (duration - alive) / stable_step;
    if (stages * (followed + settled) > explicit_cost) {
      explicit_cost = stages * (followed + settled);
      costly = rate;
    }
    implicit_cost = std::max(implicit_cost, 2 * size * alive * steps_implicit * std::pow(tolerance, -1. / 5));
  }
  out.fastest = fastest;
  // A slowest rate that is nothing but rounding says nothing beside how it moves and what moves it.
  out.rate_scale = std::max({driven, slowest, 1e-3 * std::max({fastest, speed, std::sqrt(push)})});
  if (!(out.rate_scale > 0)) out.rate_scale = 1;

  if (wanted != Integrator::automatic) {
    out.method = wanted;
    out.reason = "As asked for.";
    return out;
  }
  if (rates.empty()) {
    out.reason = model.system.nv > 0
                     ? "Runge-Kutta: the linearised motion was not found, so there is nothing to judge by."
                     : "Runge-Kutta: nothing moves but the drives.";
    return out;
  }
  if (explicit_cost > implicit_cost) {
    out.method = Integrator::bdf;
    const double decay = std::max(0., -costly.real()), span = -std::log(tolerance) / decay;
    out.reason = "BDF: a motion at " + rounded_text(std::abs(costly), 2) + " 1/s " +
                 (decay > 0 && span < duration ? "dies out within " + rounded_text(span, 2) + " s"
                                               : std::string("is too small to be seen")) +
                 ", but would keep explicit steps below " + rounded_text(stable_step / std::abs(costly), 2) +
                 " s.";
  } else {
    out.reason = "Runge-Kutta: no fast motion dies out early, so that explicit steps are held by accuracy "
                 "alone (fastest " +
                 (fastest > 0 ? rounded_text(fastest, 2) + " 1/s)." : std::string("0)."));
  }
  return out;
}

} // namespace flyball
