#include "engine/periodic/state_chart.hpp"

#include "engine/kkt/configuration_difference.hpp"
#include "engine/kkt/constraint_space.hpp"

namespace flyball {

StateChart::StateChart(const Problem& problem, FlowState base, double rate, const AlikeAngles& alike)
    : system_(&problem.system), parameters_(&problem.parameters), scaling_(&problem.scaling),
      base_(std::move(base)), rate_(rate), turns_(alike.turns), turning_(alike.drives) {
  const Eigen::Index n = system_->nv;
  rates_ = Eigen::MatrixXd::Identity(n, n);
  if (system_->rows > 0 && n > 0) {
    Kinematics<double> k;
    Linearization l;
    forward<double>(*system_, *parameters_, base_.q, base_.time, k);
    linearize_constraints(*system_, *parameters_, k, l);
    ConstraintSpace space;
    space.factor(scaling_->row.asDiagonal() * l.constraint * scaling_->column.asDiagonal(), 1e-9,
                 row_rounding);
    rates_ = space.basis();
  }
  places_ = rates_;
  left_out_.resize(n, 0);
  if (alike.anywhere.cols() == 0 || rates_.cols() == 0) return;
  // What of the free directions is at right angles to those left out.
  const Eigen::MatrixXd along = rates_.transpose() * alike.anywhere;
  ConstraintSpace rest;
  rest.factor(along.transpose(), 1e-9);
  places_ = rates_ * rest.basis();
  PivotedQr qr;
  if (!qr.compute(along)) return;
  left_out_ = rates_ * qr.q().leftCols(rest.rank());
}

FlowState StateChart::displaced(const Eigen::VectorXd& x) const {
  FlowState out = base_;
  if (size() == 0) return out;
  retract<double>(*system_, place_change(x), out.q);
  out.u += rate_ * scaling_->column.cwiseProduct(rates_ * x.tail(rates_.cols()));
  return out;
}

Eigen::VectorXd StateChart::place_change(const Eigen::VectorXd& x) const {
  return scaling_->column.cwiseProduct(places_ * x.head(places_.cols()));
}

Eigen::VectorXd StateChart::coordinates(const FlowState& state) const {
  Eigen::VectorXd x(size());
  if (size() == 0) return x;
  x << places_.transpose() * away(state),
      rates_.transpose() * (state.u - base_.u).cwiseQuotient(scaling_->column) / rate_;
  return x;
}

Eigen::VectorXd StateChart::away(const FlowState& state) const {
  if (left_out_.cols() == 0 && turning_.empty()) return scaled_difference(problem(), base_.q, state.q);
  // Along what is left out it goes on and on: by whole turns, which differ between wheels that turn together.
  Eigen::VectorXd gone = Eigen::VectorXd::Zero(system_->nv);
  for (const Link& link : system_->links)
    if (link.v >= 0 && link.type != LinkType::spherical)
      gone[link.v] = (state.q[link.q] - base_.q[link.q]) / scaling_->column[link.v];
  const Eigen::VectorXd raw = gone;
  gone = left_out_ * (left_out_.transpose() * raw);
  for (std::size_t i = 0; i < turning_.size(); ++i) {
    const auto way = turns_.col(static_cast<Eigen::Index>(i));
    gone += std::round((raw[turning_[i]] - gone[turning_[i]]) / way[turning_[i]]) * way;
  }
  Eigen::VectorXd beside = base_.q;
  retract<double>(*system_, scaling_->column.cwiseProduct(gone), beside);
  return scaled_difference(problem(), beside, state.q);
}

double StateChart::distance(const FlowState& state) const {
  if (size() == 0) return 0;
  Eigen::VectorXd places = away(state);
  places -= left_out_ * (left_out_.transpose() * places);
  return std::max(places.lpNorm<Eigen::Infinity>(),
                  (state.u - base_.u).cwiseQuotient(scaling_->column).lpNorm<Eigen::Infinity>() / rate_);
}

} // namespace flyball
