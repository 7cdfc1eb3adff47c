// Back onto the constraints by shortest steps, in position and velocity, down to rounding.
#include "engine/dynamics/equations.hpp"

#include "engine/system/constraint_row.hpp"

namespace flyball {

double Equations::open_rows() {
  row_values_.resize(static_cast<Eigen::Index>(rows_.size()));
  std::size_t next = 0;
  for (std::size_t c = 0; c < system_.cuts.size(); ++c) {
    const CutJoint& cut = system_.cuts[c];
    const int end = cut.first_row + static_cast<int>(cut.rows.size());
    for (; next < rows_.size() && rows_[next] < end; ++next)
      row_values_[static_cast<Eigen::Index>(next)] =
          -model_.scaling.row[rows_[next]] *
          row_value<double>(cut, parameters_.cuts[c],
                            cut.rows[static_cast<std::size_t>(rows_[next] - cut.first_row)], q_, kinematics_);
  }
  return row_values_.lpNorm<Eigen::Infinity>();
}

bool Equations::factor_constraints() {
  if (!is_sparse()) return dense_.factor_constraints(point());
  sparse_->factor_constraints(point());
  return true;
}

// The shortest scaled step of the regular coordinates that changes the rows by `closing`.
void Equations::shortest(const Eigen::VectorXd& closing, Eigen::VectorXd& step) {
  if (is_sparse())
    sparse_->close(closing, step);
  else
    dense_.saddle().shortest(closing, step);
}

bool Equations::close_loops(double t, Eigen::VectorXd& q, const Eigen::VectorXd& s, double& shift) {
  double previous = 0;
  for (int i = 0; i < 12 && !watch_.over(); ++i) {
    load(t, q, s);
    place();
    const double open = open_rows();
    if (!std::isfinite(open)) return false;
    // Sparse factors cost more than another step, and the loops are all but closed.
    if ((i == 0 || !is_sparse()) && !factor_constraints()) return false;
    // Rounding leaves a few units in the last place, and further steps only stir them.
    if (open < 2e-16 || (i > 0 && open < 1e-13 && open > 0.3 * previous)) return true;
    shortest(row_values_, scaled_a_);
    for (std::size_t j = 0; j < regular_.size(); ++j)
      step_[regular_[j]] = scaled_a_[static_cast<Eigen::Index>(j)] * model_.scaling.column[regular_[j]];
    shift += scaled_a_.lpNorm<Eigen::Infinity>();
    retract<double>(model_.system, step_, q);
    previous = open;
  }
  return !watch_.over() && previous < 1e-10;
}

bool Equations::catch_up(double t, Eigen::VectorXd& q, Eigen::VectorXd& s) {
  double moved = 0;
  step_.setZero(n_);
  if (!close_loops(t, q, s, moved)) return false;
  load(t, q, s);
  place();
  if (!dense_.factor(point())) return false;
  constraint_rates(system_, parameters_, u_, kinematics_, carried_, bias_);
  if (!dense_.solve(Eigen::VectorXd::Zero(system_.nv), bias_, a_, lambda_)) return false;
  s += a_;
  return project(t, q, s);
}

bool Equations::project(double t, Eigen::VectorXd& q, Eigen::VectorXd& s, double* shift) {
  double moved = 0;
  step_.setZero(n_);
  for (const Link& link : model_.system.links)
    if (link.v >= 0 && link.type == LinkType::spherical) q.segment<4>(link.q).normalize();
  if (standing_ > 0) {
    const Eigen::VectorXd before = q;
    if (!rows_.empty() && !close_loops(t, q, s, moved)) return false;
    if (!find_standing_balance(t, q, s, 20)) return false;
    moved += (q - before).lpNorm<Eigen::Infinity>();
  }
  if (!rows_.empty()) {
    if (!close_loops(t, q, s, moved)) return false;
    // The rates are linear in s; the second pass takes the first one's rounding.
    for (int pass = 0; pass < 2; ++pass) {
      load(t, q, s);
      place();
      constraint_rates(system_, parameters_, u_, kinematics_, carried_, bias_);
      row_values_.resize(static_cast<Eigen::Index>(rows_.size()));
      for (std::size_t r = 0; r < rows_.size(); ++r)
        row_values_[static_cast<Eigen::Index>(r)] = -bias_[rows_[r]] * model_.scaling.row[rows_[r]];
      shortest(row_values_, scaled_a_);
      for (std::size_t j = 0; j < regular_.size(); ++j)
        s[regular_[j]] += scaled_a_[static_cast<Eigen::Index>(j)] * model_.scaling.column[regular_[j]];
    }
  }
  if (shift) *shift = moved;
  return q.allFinite() && s.allFinite();
}

} // namespace flyball
