#include "engine/dynamics/choose_method.hpp"

#include "engine/equilibrium/pencil.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Of the Runge-Kutta method of order 8: evaluations a step, and how long a step times an eigenvalue to the
// left may be.
constexpr double stages = 13, stable_step = 4.5;
// Steps that an oscillation needs a radian, times the tolerance to the power of one over the order.
constexpr double steps_explicit = 0.09, steps_implicit = 0.25;

} // namespace

MethodChoice choose_method(Equations& equations, double duration, double tolerance, Integrator wanted) {
  const MotionModel& model = equations.model();
  MethodChoice out;
  std::vector<std::complex<double>> rates;
  if (model.system.nv > 0 && model.system.nv <= 150) {
    const Equations::Pencil p = equations.pencil();
    rates = pencil_eigenvalues(p.mass, p.velocity, p.stiffness).value_or(rates);
  }
  double driven = 0;
  for (const DrivenCoordinate& d : model.system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    const double unit = model.system.links[l].type == LinkType::revolute ? 1 : model.parameters.length;
    driven = std::max(driven, std::abs(model.parameters.links[l].speed) / unit);
  }
  double fastest = 0, slowest = 0, explicit_cost = 0, implicit_cost = 0;
  std::complex<double> costly = 0;
  for (const std::complex<double>& rate : rates) {
    const double size = std::abs(rate);
    if (!(size > 0) || !std::isfinite(size)) continue;
    slowest = slowest == 0 ? size : std::min(slowest, size);
    fastest = std::max(fastest, size);
    // A motion is to be followed until it has died out, and held stable to the end.
    const double decay = std::max(0., -rate.real());
    const double alive = std::min(duration, decay > 0 ? -std::log(tolerance) / decay : duration);
    const double followed = size * alive * steps_explicit * std::pow(tolerance, -1. / 8);
    const double held = decay > 0 ? size * (duration - alive) / stable_step : 0;
    if (stages * (followed + held) > explicit_cost) {
      explicit_cost = stages * (followed + held);
      costly = rate;
    }
    implicit_cost = std::max(implicit_cost, 2 * size * alive * steps_implicit * std::pow(tolerance, -1. / 5));
  }
  out.rate_scale = std::max({driven, slowest, 1e-3 * fastest});
  if (!(out.rate_scale > 0)) out.rate_scale = 1;

  if (wanted != Integrator::automatic) {
    out.method = wanted;
    out.reason = "As asked for.";
    return out;
  }
  if (rates.empty()) {
    out.reason = "Runge-Kutta: there is no linearised motion to judge by.";
    return out;
  }
  if (explicit_cost > implicit_cost) {
    out.method = Integrator::bdf;
    out.reason = "BDF: a motion at " + rounded_text(std::abs(costly), 2) + " 1/s dies out within " +
                 rounded_text(-std::log(tolerance) / std::max(1e-300, -costly.real()), 2) +
                 " s, but would keep explicit steps below " +
                 rounded_text(stable_step / std::abs(costly), 2) + " s.";
  } else {
    out.reason = "Runge-Kutta: no fast motion dies out early, so that explicit steps are held by accuracy "
                 "alone (fastest " +
                 (fastest > 0 ? rounded_text(fastest, 2) + " 1/s)." : std::string("0)."));
  }
  return out;
}

} // namespace flyball
