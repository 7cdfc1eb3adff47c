#include "engine/continuation/bordered_balance.hpp"

#include "engine/continuation/dense_borders.hpp"
#include "engine/continuation/kkt_borders.hpp"
#include "engine/continuation/turned_borders.hpp"
#include "engine/solve/newton.hpp"

namespace flyball {

std::unique_ptr<BorderedBalance> BorderedBalance::make(Family& family, Workspace& w) {
  if (family.ties()) return std::make_unique<TurnedBorders>(family, w);
  if (family.problem().form == KktForm::dense) return std::make_unique<DenseBorders>(family, w);
  return std::make_unique<KktBorders>(family, w);
}

void BorderedBalance::find_rates(const Unknowns& z, double parameter) {
  const Problem problem = family_.problem();
  family_.set(parameter);
  rate_.evaluate(problem.system, family_.mechanism(), family_.rates(), problem.parameters, z.q, z.lambda);
  loop_rate_ = family_.scale() * rate_.phi().cwiseProduct(problem.scaling.row);
  force_rate_ = family_.scale() * rate_.force().cwiseProduct(problem.scaling.column);
  evaluate(problem, z, 0, w_);
}

void BorderedBalance::keep_still(const Eigen::MatrixXd&) {}

Eigen::MatrixXd BorderedBalance::keep_still_there() {
  return {};
}

Eigen::MatrixXd BorderedBalance::keep_null_space_still(const Eigen::VectorXd&) {
  return {};
}

bool BorderedBalance::off_tangent(const Eigen::MatrixXd& null_space, const Eigen::VectorXd& tangent,
                                  Eigen::VectorXd& out) {
  out = Eigen::VectorXd::Zero(tangent.size());
  for (const auto& direction : null_space.colwise()) {
    const Eigen::VectorXd v = direction - tangent * tangent.dot(direction);
    if (v.norm() > out.norm()) out = v;
  }
  if (out.norm() < 1e-6) return false;
  out.normalize();
  return true;
}

} // namespace flyball
