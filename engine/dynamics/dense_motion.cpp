#include "engine/dynamics/dense_motion.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/system/constraint_row.hpp"

namespace flyball {

DenseMotion::DenseMotion(const MotionModel& model, const std::vector<int>& rows,
                         const std::vector<int>& regular)
    : model_(model), system_(model.released), rows_(rows), regular_(regular), n_(model.system.nv) {
  zero_lambda_.setZero(system_.rows);
}

bool DenseMotion::factor_constraints(const MotionPoint& point) {
  gradient_.setZero(static_cast<Eigen::Index>(rows_.size()), system_.nv);
  std::size_t next = 0;
  for (std::size_t c = 0; c < system_.cuts.size() && next < rows_.size(); ++c) {
    const CutJoint& cut = system_.cuts[c];
    const int end = cut.first_row + static_cast<int>(cut.rows.size());
    for (; next < rows_.size() && rows_[next] < end; ++next) {
      const auto at = static_cast<Eigen::Index>(next);
      row_gradient(cut, point.parameters.cuts[c],
                   cut.rows[static_cast<std::size_t>(rows_[next] - cut.first_row)], point.kinematics,
                   [&](int v, double g) { gradient_(at, v) += g; });
      gradient_.row(at) *= model_.scaling.row[rows_[next]];
    }
  }
  const auto regular = static_cast<Eigen::Index>(regular_.size());
  scaled_gradient_.resize(gradient_.rows(), regular);
  for (Eigen::Index j = 0; j < regular; ++j) {
    const int v = regular_[static_cast<std::size_t>(j)];
    scaled_gradient_.col(j) = gradient_.col(v) * model_.scaling.column[v];
  }
  return saddle_.factor_constraints(scaled_gradient_);
}

void DenseMotion::evaluate_mass(const MotionPoint& point) {
  flyball::evaluate_mass(system_, point.parameters, point.kinematics, mass_);
}

bool DenseMotion::factor(const MotionPoint& point) {
  evaluate_mass(point);
  const bool independent = factor_constraints(point);
  const auto regular = static_cast<Eigen::Index>(regular_.size());
  const Eigen::VectorXd& column = model_.scaling.column;
  scaled_mass_.resize(regular, regular);
  for (Eigen::Index j = 0; j < regular; ++j) {
    const int v = regular_[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < regular; ++i) {
      const int w = regular_[static_cast<std::size_t>(i)];
      scaled_mass_(i, j) = mass_.mass(w, v) * column[w] * column[v];
    }
  }
  return independent && saddle_.factor_mass(scaled_mass_);
}

void DenseMotion::evaluate_forces(const MotionPoint& point) {
  evaluate_residual<double>(system_, point.parameters, point.q, zero_lambda_, point.kinematics, residual_);
  force_ = residual_.f;
  add_coordinate_damping(system_, point.parameters, point.q, point.u, force_);
}

bool DenseMotion::solve(const Eigen::VectorXd& force, const Eigen::VectorXd& bias, Eigen::VectorXd& a,
                        Eigen::VectorXd& lambda) {
  const Eigen::VectorXd& column = model_.scaling.column;
  target_force_.resize(static_cast<Eigen::Index>(regular_.size()));
  target_rows_.resize(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t i = 0; i < regular_.size(); ++i)
    target_force_[static_cast<Eigen::Index>(i)] = -force[regular_[i]] * column[regular_[i]];
  for (std::size_t r = 0; r < rows_.size(); ++r)
    target_rows_[static_cast<Eigen::Index>(r)] = -bias[rows_[r]] * model_.scaling.row[rows_[r]];
  saddle_.solve(target_force_, target_rows_, scaled_a_, scaled_lambda_);
  a.setZero(n_);
  lambda.setZero(system_.rows);
  for (std::size_t i = 0; i < regular_.size(); ++i)
    a[regular_[i]] = scaled_a_[static_cast<Eigen::Index>(i)] * column[regular_[i]];
  for (std::size_t r = 0; r < rows_.size(); ++r)
    lambda[rows_[r]] = scaled_lambda_[static_cast<Eigen::Index>(r)] * model_.scaling.row[rows_[r]];
  return a.allFinite() && lambda.allFinite();
}

bool DenseMotion::accelerate(const MotionPoint& point, Eigen::VectorXd& a, Eigen::VectorXd& lambda) {
  evaluate_forces(point);
  constraint_accelerations(system_, point.parameters, point.kinematics, point.carried, bias_);
  const bool solved = solve(force_, bias_, a, lambda);
  a_ = a;
  return solved;
}

double DenseMotion::drive_force(int d) const {
  double force = force_[n_ + d];
  for (int i = 0; i < n_; ++i)
    force += mass_.mass(n_ + d, i) * a_[i];
  for (Eigen::Index r = 0; r < gradient_.rows(); ++r)
    force += gradient_(r, n_ + d) * scaled_lambda_[r];
  return force;
}

std::string DenseMotion::unsolved() const {
  if (!mass_.mass.allFinite()) return "the numbers overflow";
  if (!(saddle_.independence() > 1e-12))
    return "the equations of its loops are not independent to rounding at this position";
  int light = -1, heavy = -1;
  const auto inertia = [&](int v) {
    return mass_.mass(v, v) * model_.scaling.column[v] * model_.scaling.column[v];
  };
  for (const int v : regular_) {
    if (light < 0 || inertia(v) < inertia(light)) light = v;
    if (heavy < 0 || inertia(v) > inertia(heavy)) heavy = v;
  }
  if (light < 0 || !(inertia(light) < 1e-10 * inertia(heavy)))
    return "the mass matrix is singular to rounding";
  return "the inertias that move with " + name_of_coordinate(model_, heavy) + " and with " +
         name_of_coordinate(model_, light) + " are " + rounded_text(inertia(heavy), 2) + " and " +
         rounded_text(inertia(light), 2) +
         " kg m^2, too far apart for double precision; masses and lengths of like sizes mend that";
}

// The rates of the constraints' own curvature are left out: they are no stiffness, and cost third
// derivatives.
bool DenseMotion::linearise(const MotionPoint& point, const Eigen::VectorXd& lambda) {
  evaluate_residual<double>(system_, point.parameters, point.q, lambda, point.kinematics, moving_residual_);
  linearize(system_, point.parameters, point.q, lambda, point.kinematics, moving_residual_, linearization_);
  linearize_motion(system_, point.parameters, point.q, point.kinematics, linearization_);
  add_coordinate_damping_stiffness(system_, point.parameters, point.q, point.u, linearization_.stiffness);
  const auto column = model_.scaling.column.asDiagonal();
  const auto respond = [&](const Eigen::MatrixXd& change, Eigen::MatrixXd& out) {
    out = -(column * change.topLeftCorner(n_, n_));
    saddle_.respond(out);
    out = column * out;
  };
  respond(linearization_.stiffness, with_q_);
  respond(linearization_.velocity, with_s_);
  return with_q_.allFinite() && with_s_.allFinite();
}

// I - gamma s'_s - gamma^2 s'_q N, the matrix above times M^-1.
bool DenseMotion::factor_step(double gamma, const std::vector<Mat3>& turns) {
  gamma_ = gamma;
  Eigen::MatrixXd matrix = -gamma * with_s_;
  std::size_t turn = 0;
  for (const Link& link : model_.system.links) {
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical)
      matrix.middleCols<3>(link.v) -= gamma * gamma * with_q_.middleCols<3>(link.v) * turns[turn++];
    else
      matrix.col(link.v) -= gamma * gamma * with_q_.col(link.v);
  }
  matrix.diagonal().array() += 1;
  return matrix.size() == 0 || step_.compute(matrix);
}

void DenseMotion::solve_step(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) {
  if (s.size() > 0) s = step_.solve(s + gamma_ * (with_q_ * b_q));
}

} // namespace flyball
