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

void Continuation::tied() {
  balance_ = BorderedBalance::make(family_, w_);
}

Eigen::Index Continuation::unknowns() const {
  return family_.problem().system.nv + (family_.ties() ? family_.ties()->along.cols() : 0) + 1;
}

void Continuation::move(const Eigen::VectorXd& step, BranchState& state) const {
  const Problem problem = family_.problem();
  const Eigen::Index n = problem.system.nv, last = step.size() - 1;
  const Eigen::VectorXd moved = step.head(n).cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, moved, state.z.q);
  if (last > n) turn_along(*family_.ties(), step.segment(n, last - n), state.starts);
  state.parameter += step[last] * family_.scale();
}

double Continuation::linearize(const BranchState& state) {
  family_.turn(state.starts);
  const double residual = balance_->linearize(state.z, state.parameter);
  if (state.still.cols() > 0 && std::isfinite(residual)) balance_->keep_still(state.still);
  return residual;
}

bool Continuation::correct(const BranchState& from, const Eigen::VectorXd& tangent, double length,
                           BranchState& to, int& iterations) {
  to = from;
  move(length * tangent, to);
  Eigen::VectorXd moved =
                      Eigen::VectorXd::Zero(tangent.size()), // corrections so far, orthogonal to the tangent
      step;
  for (iterations = 1; iterations <= 12; ++iterations) {
    if (!std::isfinite(linearize(to))) return false;
    if (!balance_->step(tangent, -tangent.dot(moved), step, to.z.lambda)) return false;
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size) || size > 1) return false;
    move(step, to);
    moved += step;
    if (size < tolerance::step) {
      family_.turn(to.starts);
      family_.set(to.parameter);
      family_.expect_possible();
      const Problem problem = family_.problem();
      evaluate(problem, to.z, 0, w_);
      return scaled_residual(problem, w_) < tolerance::balance;
    }
  }
  return false;
}

bool Continuation::find_tangent(BranchState& state, const Eigen::VectorXd& previous) {
  linearize(state);
  if (state.still.cols() > 0) {
    state.still = balance_->keep_still_there();
    state.drifts = state.drifts || balance_->hardly_resists();
  }
  if (!balance_->direction(previous, state.tangent)) return false;
  const double norm = state.tangent.norm();
  if (!std::isfinite(norm) || norm == 0) return false;
  state.tangent /= norm;
  state.turning = state.tangent[state.tangent.size() - 1];
  const auto determinant = balance_->determinant(state.tangent);
  if (!determinant) return false;
  state.determinant = *determinant;
  state.falling = balance_->falling();
  return true;
}

bool Continuation::start(BranchState& state, double direction) {
  Eigen::VectorXd along = Eigen::VectorXd::Zero(unknowns());
  along[along.size() - 1] = direction < 0 ? -1 : 1;
  return find_tangent(state, along);
}

bool Continuation::step(const BranchState& from, double length, BranchState& to, int& iterations) {
  return correct(from, from.tangent, length, to, iterations) && find_tangent(to, from.tangent);
}

bool Continuation::slide(BranchState& state, const Eigen::VectorXd& by) {
  BranchState moved = state, at;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(unknowns());
  step.head(state.still.rows()) = state.still * by;
  move(step, moved);
  int iterations = 0;
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(unknowns(), unknowns() - 1);
  if (!correct(moved, unit, 0, at, iterations) || !find_tangent(at, state.tangent)) return false;
  at.parameter = state.parameter; // without rounding
  state = std::move(at);
  return true;
}

bool Continuation::land(BranchState& state) {
  if (!family_.ties()) {
    family_.set(state.parameter);
    family_.expect_possible();
    return newton(family_.problem(), state.z, w_, {}, nullptr).converged;
  }
  BranchState at;
  int iterations = 0;
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(unknowns(), unknowns() - 1);
  if (!correct(state, unit, 0, at, iterations)) return false;
  at.parameter = state.parameter; // without rounding
  state = std::move(at);
  return true;
}

bool Continuation::switch_branch(const BranchState& at, double length, BranchState& to) {
  linearize(at);
  Eigen::VectorXd other;
  if (!balance_->second_direction(at.tangent, other)) return false;
  int iterations = 0;
  if (!correct(at, other, length, to, iterations)) return false;
  // What is symmetric about an axis leaves it to any side: then the family is larger than that of the
  // crossing.
  linearize(to);
  to.still = balance_->keep_null_space_still(other);
  to.drifts = balance_->hardly_resists();
  to.twofold = false;
  return find_tangent(to, length > 0 ? other : Eigen::VectorXd(-other));
}

} // namespace flyball
