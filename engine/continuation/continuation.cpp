#include "engine/continuation/continuation.hpp"

#include "engine/solve/newton.hpp"

#include <algorithm>

namespace flyball {

bool out_of_reach(const Problem& problem, const Eigen::VectorXd& q) {
  return std::ranges::any_of(problem.system.links, [&](const Link& link) {
    if (finds_speed(link)) return std::abs(q[link.q]) > largest_found_speed(problem, link);
    return link.type == LinkType::prismatic && link.q >= 0 &&
           std::abs(q[link.q]) > 100 * problem.parameters.length;
  });
}

Continuation::Continuation(Family& family) : family_(family), balance_(BorderedBalance::make(family, w_)) {}

bool Continuation::correct(const Unknowns& from, double parameter, const Eigen::VectorXd& tangent,
                           double length, BranchState& to, int& iterations) {
  const Problem problem = family_.problem();
  const Eigen::Index n = problem.system.nv;
  to.z = from;
  to.parameter = parameter + length * tangent[n] * family_.scale();
  Eigen::VectorXd predicted = length * tangent.head(n).cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, predicted, to.z.q);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(n + 1), // corrections so far, kept orthogonal to the tangent
      step;
  for (iterations = 1; iterations <= 12; ++iterations) {
    if (!std::isfinite(balance_->linearize(to.z, to.parameter))) return false;
    if (!balance_->step(tangent, -tangent.dot(moved), step, to.z.lambda)) return false;
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size) || size > 1) return false;
    Eigen::VectorXd move = step.head(n).cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, move, to.z.q);
    to.parameter += step[n] * family_.scale();
    moved += step;
    if (size < tolerance::step) {
      family_.set(to.parameter);
      evaluate(problem, to.z, 0, w_);
      return scaled_residual(problem, w_) < tolerance::balance;
    }
  }
  return false;
}

bool Continuation::find_tangent(BranchState& state, const Eigen::VectorXd& previous) {
  balance_->linearize(state.z, state.parameter);
  if (!balance_->direction(previous, state.tangent)) return false;
  const double norm = state.tangent.norm();
  if (!std::isfinite(norm) || norm == 0) return false;
  state.tangent /= norm;
  state.turning = state.tangent[state.tangent.size() - 1];
  const auto determinant = balance_->determinant(state.tangent);
  if (!determinant) return false;
  state.determinant = *determinant;
  return true;
}

bool Continuation::start(BranchState& state, double direction) {
  Eigen::VectorXd along = Eigen::VectorXd::Zero(family_.problem().system.nv + 1);
  along[along.size() - 1] = direction < 0 ? -1 : 1;
  return find_tangent(state, along);
}

bool Continuation::step(const BranchState& from, double length, BranchState& to, int& iterations) {
  return correct(from.z, from.parameter, from.tangent, length, to, iterations) &&
         find_tangent(to, from.tangent);
}

bool Continuation::land(BranchState& state) {
  family_.set(state.parameter);
  return newton(family_.problem(), state.z, w_, {}, nullptr).converged;
}

bool Continuation::switch_branch(const BranchState& at, double length, BranchState& to) {
  balance_->linearize(at.z, at.parameter);
  Eigen::VectorXd other;
  if (!balance_->second_direction(at.tangent, other)) return false;
  int iterations = 0;
  if (!correct(at.z, at.parameter, other, length, to, iterations)) return false;
  return find_tangent(to, length > 0 ? other : Eigen::VectorXd(-other));
}

} // namespace flyball
