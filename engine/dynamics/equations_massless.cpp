// Bodies that move without momentum: their null directions, and the velocities that the balance of forces
// gives them.
#include "engine/dynamics/equations.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>

namespace flyball {

// Y, with M Y = 0 and Phi_q Y = 0, from the factors of the regular part.
bool Equations::find_null_directions() {
  const auto regular = static_cast<Eigen::Index>(regular_.size());
  const Eigen::VectorXd& column = model_.scaling.column;
  null_.setZero(n_, static_cast<Eigen::Index>(idle_.size()));
  null_mass_ = 0;
  target_force_.resize(regular);
  const MassMatrix& m = dense_.mass();
  for (std::size_t k = 0; k < idle_.size(); ++k) {
    const int v = idle_[k];
    for (Eigen::Index i = 0; i < regular; ++i) {
      const int w = regular_[static_cast<std::size_t>(i)];
      target_force_[i] = -m.mass(w, v) * column[w] * column[v];
    }
    target_rows_ = -dense_.gradient().col(v) * column[v];
    dense_.saddle().solve(target_force_, target_rows_, scaled_a_, scaled_lambda_);
    if (!scaled_a_.allFinite()) return false;
    const auto c = static_cast<Eigen::Index>(k);
    double left = m.mass(v, v) * column[v] * column[v];
    for (Eigen::Index i = 0; i < regular; ++i) {
      null_(regular_[static_cast<std::size_t>(i)], c) = scaled_a_[i];
      left -= target_force_[i] * scaled_a_[i];
    }
    null_(v, c) = 1;
    const double size = m.size[v] * column[v] * column[v];
    if (size > 0) null_mass_ = std::max(null_mass_, std::abs(left) / size);
  }
  return true;
}

// The forces at the state along the null directions, N m.
Eigen::VectorXd Equations::null_force() const {
  return null_.transpose() * dense_.force().head(n_).cwiseProduct(model_.scaling.column);
}

Eigen::VectorXd Equations::null_motion(const Eigen::VectorXd& idle) const {
  return (null_ * idle).cwiseProduct(model_.scaling.column);
}

// Derivative of all damping and drag forces with u.
void Equations::evaluate_damping(Eigen::MatrixXd& out) const {
  out.setZero(system_.nv, system_.nv);
  add_damping(system_, parameters_, q_, kinematics_, out);
}

// Newton on the balance along the damped directions; one step where dampers are linear.
bool Equations::find_damped_velocity() {
  const auto count = static_cast<Eigen::Index>(idle_.size());
  idle_velocity_.setZero(count);
  if (kinds_.rows() != count) kinds_ = Eigen::MatrixXd::Identity(count, count);
  if (damped_ == 0) return true;
  double previous = 0;
  for (int i = 0; i < 50 && !watch_.over(); ++i) {
    u_.head(n_) = s_.head(n_) + null_motion(idle_velocity_);
    place();
    dense_.evaluate_forces(point());
    evaluate_damping(damping_);
    const auto& column = model_.scaling.column;
    null_damping_.noalias() = null_.transpose() * column.asDiagonal() * damping_.topLeftCorner(n_, n_) *
                              column.asDiagonal() * null_;
    if (!sort_kinds(null_damping_)) return false;
    const auto kinds = kinds_.leftCols(damped_);
    const Eigen::VectorXd step =
        kinds * -(kinds.transpose() * null_force()).cwiseQuotient(kind_sizes_.head(damped_));
    idle_velocity_ += step;
    const double size = step.norm();
    if (!std::isfinite(size)) return false;
    // Rounding in the balance leaves steps that shrink no more.
    if (i > 0 && (size <= 1e-14 * idle_velocity_.norm() || size > 0.1 * previous)) {
      if (size < 1e-6 * (idle_velocity_.norm() + previous) || size == 0 || balanced_to_rounding())
        return set_velocity();
    }
    previous = size;
  }
  return false;
}

// Whether the damped directions balance as far as the terms allow that their forces are made of: so it is
// where next to nothing moves, and large forces cancel.
bool Equations::balanced_to_rounding() {
  const auto kinds = kinds_.leftCols(damped_);
  evaluate_magnitudes(system_, parameters_, q_, zero_lambda_, kinematics_, magnitudes_);
  const Eigen::VectorXd size =
      (null_ * kinds).cwiseAbs().transpose() * magnitudes_.force.head(n_).cwiseProduct(model_.scaling.column);
  const Eigen::VectorXd left = kinds.transpose() * null_force();
  return (left.cwiseAbs().array() <= 1e-13 * size.array()).all();
}

bool Equations::set_velocity() {
  u_.head(n_) = s_.head(n_) + null_motion(idle_velocity_);
  return true;
}

// Directions that are damped first, the most damped of all at the front.
bool Equations::sort_kinds(const Eigen::MatrixXd& damping) {
  SymmetricEigen eigen;
  if (!eigen.compute((damping + damping.transpose()) / 2)) return false;
  kinds_ = eigen.vectors().rowwise().reverse();
  kind_sizes_ = eigen.values().reverse();
  return true;
}

// What stands in balance keeps in balance: d/dt (Y^T F) = Y^T (F_q u + F_q_D q_D') = 0, F being the whole
// balance at the motion's own accelerations and multipliers. Y removes all that has mass or is damped, so
// the balance of forces stays as it is along these directions, and the motion of the rest is known already.
// Here its stiffness along them, and how fast the balance changes while they stand still.
bool Equations::find_standing_stiffness() {
  place();
  if (!dense_.accelerate(point(), a_, lambda_)) return false;
  full_a_.head(n_) = a_;
  place(nullptr, &full_a_);
  evaluate_residual<double>(system_, parameters_, q_, lambda_, kinematics_, moving_residual_);
  linearize(system_, parameters_, q_, lambda_, kinematics_, moving_residual_, linearization_);
  add_coordinate_damping_stiffness(system_, parameters_, q_, u_, linearization_.stiffness);
  const auto& column = model_.scaling.column;
  const Eigen::Index rest = kinds_.cols() - damped_;
  const Eigen::MatrixXd directions = column.asDiagonal() * null_ * kinds_.rightCols(rest);
  const Eigen::MatrixXd rows = directions.transpose() * linearization_.stiffness.topRows(n_);
  if (standing_ < rest) { // distinguish them from those that feel nothing
    const Eigen::MatrixXd local = rows.leftCols(n_) * directions;
    SymmetricEigen eigen;
    if (!eigen.compute((local + local.transpose()) / 2)) return false;
    std::vector<Eigen::Index> order(static_cast<std::size_t>(rest));
    for (Eigen::Index i = 0; i < rest; ++i)
      order[static_cast<std::size_t>(i)] = i;
    std::ranges::sort(order, [&](Eigen::Index i, Eigen::Index j) {
      return std::abs(eigen.values()[i]) > std::abs(eigen.values()[j]);
    });
    const Eigen::MatrixXd turned = kinds_.rightCols(rest) * eigen.vectors()(Eigen::all, order);
    kinds_.rightCols(rest) = turned;
  }
  const auto kinds = kinds_.middleCols(damped_, standing_);
  const Eigen::MatrixXd standing = column.asDiagonal() * null_ * kinds;
  const Eigen::MatrixXd change = standing.transpose() * linearization_.stiffness.topRows(n_);
  standing_stiffness_ = change.leftCols(n_) * standing;
  standing_rate_ = change * u_;
  return standing_stiffness_.allFinite() && standing_rate_.allFinite();
}

bool Equations::find_standing_velocity() {
  if (!find_standing_stiffness()) return false;
  Lu lu;
  if (!lu.compute(standing_stiffness_)) return false;
  const Eigen::VectorXd step = lu.solve(-standing_rate_);
  if (!step.allFinite()) return false;
  idle_velocity_ += kinds_.middleCols(damped_, standing_) * step;
  return set_velocity();
}

} // namespace flyball
