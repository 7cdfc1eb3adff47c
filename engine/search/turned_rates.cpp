#include "engine/search/turned_rates.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/balance_rate.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Of forces and loops, scaled.
Eigen::VectorXd scaled_rate(const Problem& problem, const BalanceRate& balance) {
  Eigen::VectorXd out(problem.system.nv + problem.system.rows);
  out << balance.force().cwiseProduct(problem.scaling.column),
      balance.phi().cwiseProduct(problem.scaling.row);
  return out;
}

bool is_finite_rate(const VariedNumbers& numbers, std::size_t i, NumberRates& out) try {
  numbers.rates(i, out);
  return true;
} catch (const SceneError&) { // such as of a square root at zero
  return false;
}

} // namespace

std::vector<TurnedRate> turned_rates(const Problem& problem, const Unknowns& z, const AngleTies& ties,
                                     const Mechanism& mechanism, const VariedNumbers& numbers, Workspace& w) {
  const System& system = problem.system;
  const Eigen::VectorXd &column = problem.scaling.column, &row = problem.scaling.row;
  const Eigen::Index n = system.nv, rows = system.rows, count = ties.of_found.cols();
  evaluate(problem, z, 0, w);
  Linearization l;
  linearize(system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual, l);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + rows + count, n + rows + count);
  all.topLeftCorner(n, n) = column.asDiagonal() * l.stiffness * column.asDiagonal();
  if (rows > 0) {
    const Eigen::MatrixXd of_motion =
        constraints_of_motion(system, problem.parameters, w.kinematics, l.constraint);
    all.block(0, n, n, rows) = column.asDiagonal() * of_motion.transpose() * row.asDiagonal();
    all.block(n, 0, rows, n) = row.asDiagonal() * l.constraint * column.asDiagonal();
  }
  BalanceRate balance;
  const NumberRates none;
  const auto links = static_cast<Eigen::Index>(system.links.size());
  // Links along V.
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(links, count);
  double fastest = 0;
  for (std::size_t i = 0; i < ties.found.size(); ++i) {
    const auto link = static_cast<std::size_t>(ties.found[i]);
    const Eigen::VectorXd tie = ties.of_found.row(static_cast<Eigen::Index>(i)).transpose();
    const double unit = system.links[link].type == LinkType::revolute ? 1 : problem.parameters.length;
    along.row(ties.found[i]) = ties.along.row(static_cast<Eigen::Index>(i));
    const int v = system.links[link].v;
    fastest = std::max(fastest, std::abs(z.q[system.links[link].q]) / unit);
    all.block(n + rows, v, count, 1) = tie * column[v];
  }
  if (!(fastest > 0)) return {};
  all.bottomRows(count) /= fastest;
  for (Eigen::Index k = 0; k < count; ++k) {
    balance.evaluate(system, mechanism, none, problem.parameters, z.q, z.lambda, 0, along.col(k));
    all.col(n + rows + k).head(n + rows) = scaled_rate(problem, balance);
  }
  std::vector<TurnedRate> out(numbers.size());
  NumberRates rates;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!is_finite_rate(numbers, i, rates)) continue;
    balance.evaluate(system, mechanism, rates, problem.parameters, z.q, z.lambda);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n + rows + count);
    rhs.head(n + rows) = -scaled_rate(problem, balance);
    for (std::size_t g = 0; g < ties.given.size(); ++g)
      rhs.tail(count) -= ties.of_given.row(static_cast<Eigen::Index>(g)).transpose() *
                         balance.parameters().links[static_cast<std::size_t>(ties.given[g])].speed.rate /
                         fastest;
    const auto found = least_squares(all, rhs);
    if (!found || !found->allFinite()) continue;
    out[i] = {found->head(n).cwiseProduct(column), along * found->tail(count)};
  }
  return out;
}

} // namespace flyball
