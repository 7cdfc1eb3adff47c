#include "engine/search/turned_balance.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/system/balance_rate.hpp"

#include <algorithm>
#include <limits>

namespace flyball {
namespace {

constexpr double independent_loops = 1e-9; // of the largest singular value

// By link of the system, along V.
Eigen::MatrixXd links_along(const System& system, const AngleTies& ties) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(system.links.size()), ties.along.cols());
  for (std::size_t i = 0; i < ties.found.size(); ++i)
    out.row(ties.found[i]) = ties.along.row(static_cast<Eigen::Index>(i));
  return out;
}

// M w + h, 1/s.
Eigen::VectorXd drift_of(const Problem& problem, const AngleTies& ties, const Eigen::VectorXd& q) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(ties.along.cols());
  for (std::size_t i = 0; i < ties.found.size(); ++i)
    out += ties.of_found.row(static_cast<Eigen::Index>(i)).transpose() *
           q[problem.system.links[static_cast<std::size_t>(ties.found[i])].q];
  for (std::size_t g = 0; g < ties.given.size(); ++g)
    out += ties.of_given.row(static_cast<Eigen::Index>(g)).transpose() *
           problem.parameters.links[static_cast<std::size_t>(ties.given[g])].speed;
  return out;
}

} // namespace

TurnedBalance::TurnedBalance(const Problem& problem, const Unknowns& z, const AngleTies& ties,
                             const Mechanism& mechanism, Workspace& w)
    : problem_(problem), z_(z), ties_(ties), mechanism_(mechanism) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  const Eigen::VectorXd &column = problem.scaling.column, &row = problem.scaling.row;
  const Eigen::Index n = system.nv, rows = system.rows, count = angles();
  evaluate(problem, z, 0, w);
  Linearization l;
  linearize(system, p, z.q, z.lambda, w.kinematics, w.residual, l);
  const Eigen::MatrixXd stiffness = column.asDiagonal() * l.stiffness * column.asDiagonal();
  size_ = std::max(largest(w.magnitudes.force.cwiseProduct(column)), largest_size(stiffness));
  if (!(size_ > 0)) size_ = 1;
  Eigen::MatrixXd of_motion(rows, n);
  if (rows > 0)
    of_motion =
        row.asDiagonal() * constraints_of_motion(system, p, w.kinematics, l.constraint) * column.asDiagonal();
  range_ = Eigen::MatrixXd(rows, 0);
  if (rows > 0) {
    const auto parts = singular_vectors(of_motion);
    if (!parts) return;
    Eigen::Index rank = 0;
    while (rank < parts->values.size() && parts->values[rank] > independent_loops * parts->values[0])
      ++rank;
    range_ = parts->left.leftCols(rank);
  }
  const Eigen::Index r = range_.cols();
  matrix_ = Eigen::MatrixXd::Zero(n + r + count, n + count + r);
  matrix_.topLeftCorner(n, n) = stiffness / size_;
  matrix_.topRightCorner(n, r) = of_motion.transpose() * range_;
  if (r > 0)
    matrix_.block(n, 0, r, n) =
        range_.transpose() * (row.asDiagonal() * l.constraint * column.asDiagonal()).eval();
  for (std::size_t i = 0; i < ties.found.size(); ++i) {
    const Link& link = system.links[static_cast<std::size_t>(ties.found[i])];
    const double unit = link.type == LinkType::revolute ? 1 : p.length;
    fastest_ = std::max(fastest_, std::abs(z.q[link.q]) / unit);
    matrix_.block(n + r, link.v, count, 1) =
        ties.of_found.row(static_cast<Eigen::Index>(i)).transpose() * column[link.v];
  }
  if (!(fastest_ > 0)) return;
  matrix_.bottomRows(count) /= fastest_;
  const Eigen::MatrixXd along = links_along(system, ties);
  const NumberRates none;
  BalanceRate balance;
  for (Eigen::Index k = 0; k < count; ++k) {
    balance.evaluate(system, mechanism, none, p, z.q, z.lambda, 0, along.col(k));
    matrix_.col(n + k).head(n + r) = left_of(balance.force(), balance.phi()).head(n + r);
  }
  const Eigen::VectorXd force = w.residual.f.cwiseProduct(column);
  const Eigen::VectorXd multipliers = z.lambda.cwiseQuotient(row);
  left_ = left_of(w.residual.f, w.residual.phi);
  if (rows > 0) left_.head(n) -= of_motion.transpose() * multipliers / size_;
  residual_ = std::max(
      {largest_size(force) / size_, largest_size(left_.segment(n, r)), largest_size(left_.tail(count))});
  usable_ = matrix_.allFinite() && left_.allFinite();
}

Eigen::VectorXd TurnedBalance::left_of(const Eigen::VectorXd& force, const Eigen::VectorXd& phi) const {
  const Eigen::Index n = problem_.system.nv, r = range_.cols();
  Eigen::VectorXd out(n + r + angles());
  out.head(n) = force.cwiseProduct(problem_.scaling.column) / size_;
  if (r > 0) out.segment(n, r) = range_.transpose() * phi.cwiseProduct(problem_.scaling.row);
  out.tail(angles()) = drift_of(problem_, ties_, z_.q) / fastest_;
  return out;
}

Eigen::VectorXd TurnedBalance::rate(const NumberRates& numbers) const {
  BalanceRate balance;
  balance.evaluate(problem_.system, mechanism_, numbers, problem_.parameters, z_.q, z_.lambda);
  Eigen::VectorXd out = left_of(balance.force(), balance.phi());
  out.tail(angles()).setZero();
  for (std::size_t g = 0; g < ties_.given.size(); ++g)
    out.tail(angles()) += ties_.of_given.row(static_cast<Eigen::Index>(g)).transpose() *
                          balance.parameters().links[static_cast<std::size_t>(ties_.given[g])].speed.rate /
                          fastest_;
  return out;
}

Eigen::VectorXd TurnedBalance::lambda_of(const Eigen::VectorXd& mu) const {
  if (range_.cols() == 0) return Eigen::VectorXd::Zero(problem_.system.rows);
  return size_ * (range_ * mu).cwiseProduct(problem_.scaling.row);
}

} // namespace flyball
