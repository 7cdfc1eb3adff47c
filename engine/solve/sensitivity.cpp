#include "engine/solve/sensitivity.hpp"

#include "engine/mechanism/address.hpp"

namespace flyball {

Eigen::VectorXd sensitivity(const Problem& problem, const Mechanism& mechanism, const Unknowns& z,
                            const std::string& address, Workspace& w) {
  const System& system = problem.system;
  const double value = get_parameter(mechanism, address);
  const double h = 1e-6 * (std::abs(value) > 1e-100 ? std::abs(value) : 1.);
  Mechanism varied = mechanism;
  Parameters numbers;
  Eigen::VectorXd f[2], phi[2];
  for (int i : {0, 1}) {
    set_parameter(varied, address, i == 0 ? value + h : value - h);
    bind(system, varied, numbers);
    const Problem there{system, numbers, problem.scaling};
    evaluate(there, z, 0, w);
    f[i] = w.residual.f;
    phi[i] = w.residual.phi;
  }
  const Eigen::VectorXd f_rate = (f[0] - f[1]) / (2 * h), phi_rate = (phi[0] - phi[1]) / (2 * h);
  evaluate(problem, z, 0, w);
  factor(problem, z, w);
  if (singular(problem, w)) return {};
  Eigen::VectorXd step, multipliers;
  newton_step(problem, f_rate, phi_rate, w, step, multipliers);
  return step.cwiseProduct(problem.scaling.column);
}

} // namespace flyball
