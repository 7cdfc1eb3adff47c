#include "engine/system/balance_rate.hpp"

namespace flyball {

void BalanceRate::evaluate(const System& system, const Mechanism& mechanism, const NumberRates& rates,
                           const Parameters& parameters, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& lambda, double t, const Eigen::VectorXd& starts) {
  bind(system, mechanism, rates, parameters, parameters_);
  for (const DrivenCoordinate& drive : system.drives) {
    const auto l = static_cast<std::size_t>(drive.link);
    BasicLinkParameters<Dual>& link = parameters_.links[l];
    link.start.rate -= link.speed.rate * t;
    if (!finds_speed(system.links[l])) continue;
    link.start.value = parameters.links[l].start; // where it stands
    if (starts.size() > 0) link.start.rate += starts[drive.link];
  }
  q_ = q.cast<Dual>();
  lambda_ = lambda.cast<Dual>();
  forward<Dual>(system, parameters_, q_, t, kinematics_);
  evaluate_residual<Dual>(system, parameters_, q_, lambda_, kinematics_, residual_);
  const auto take_rates = [](const Configuration<Dual>& from, Eigen::VectorXd& to) {
    to = from.unaryExpr([](const Dual& x) { return x.rate; });
  };
  take_rates(residual_.f, force_);
  take_rates(residual_.phi, phi_);
}

} // namespace flyball
