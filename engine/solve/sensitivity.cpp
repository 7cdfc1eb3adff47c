#include "engine/solve/sensitivity.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/varied_numbers.hpp"

#include <array>

namespace flyball {
namespace {

// The part with the number at `address` is again as it was, and all where expressions take from it.
void put_back(const Mechanism& mechanism, const std::string& address, Mechanism& varied) {
  if (!mechanism.parameters.empty() || !mechanism.points.empty()) {
    varied = mechanism;
    return;
  }
  const std::size_t dot = std::min(address.find('.'), address.size() - 1);
  const std::string name = address.substr(dot + 1, address.find('.', dot + 1) - dot - 1);
  const auto copy = [](int part, const auto& from, auto& to) {
    if (part >= 0) to[static_cast<std::size_t>(part)] = from[static_cast<std::size_t>(part)];
  };
  copy(body_index(mechanism, name), mechanism.bodies, varied.bodies);
  copy(joint_index(mechanism, name), mechanism.joints, varied.joints);
  copy(force_index(mechanism, name), mechanism.forces, varied.forces);
  varied.gravity = mechanism.gravity;
  varied.simulation = mechanism.simulation;
}

} // namespace

std::vector<Eigen::VectorXd> sensitivities(const FactoredState& at, const Mechanism& mechanism,
                                           std::span<const std::string> addresses) {
  if (at.kkt().singular()) return {};
  const System& system = at.problem.system;
  Mechanism varied;
  varied.parameters = mechanism.parameters;
  varied.points = mechanism.points;
  varied.formulas = mechanism.formulas;
  varied.gravity = mechanism.gravity;
  varied.bodies = mechanism.bodies;
  varied.joints = mechanism.joints;
  varied.forces = mechanism.forces;
  varied.simulation = mechanism.simulation;
  Parameters numbers;
  const Problem there{system, numbers, at.problem.scaling};
  Workspace& varied_balance = at.w.elsewhere();
  std::vector<Eigen::VectorXd> rates;
  Eigen::VectorXd f[2], phi[2], step, multipliers;
  for (const std::string& address : addresses) {
    const double value = get_parameter(mechanism, address);
    const double h = 1e-6 * (std::abs(value) > 1e-100 ? std::abs(value) : 1.);
    VariedNumbers number(varied, {&address, 1});
    for (int i : {0, 1}) {
      number.set(std::array{i == 0 ? value + h : value - h});
      bind(system, varied, numbers);
      evaluate(there, at.z, 0, varied_balance);
      f[i] = varied_balance.residual.f;
      phi[i] = varied_balance.residual.phi;
    }
    put_back(mechanism, address, varied);
    newton_step(at.problem, (f[0] - f[1]) / (2 * h), (phi[0] - phi[1]) / (2 * h), at.w, step, multipliers);
    rates.push_back(step.cwiseProduct(at.problem.scaling.column));
  }
  return rates;
}

} // namespace flyball
