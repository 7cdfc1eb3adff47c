// What a mechanism's equations of motion are made of, found at one state: independent constraints, directions
// without mass, and what moves along those.
#include "engine/dynamics/equations.hpp"

#include "engine/kkt/constraint_space.hpp"
#include "engine/mechanism/error.hpp"

#include "engine/linear/large.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <numeric>

namespace flyball {
namespace {

constexpr double no_mass = 1e-13;     // relative to what moves with a coordinate
constexpr double dependent = 1e-9;    // pivots of the constraint rows, of the largest
constexpr double no_stiffness = 1e-9; // relative to the mechanism's stiffest
constexpr double no_force = 1e-8;     // relative to the terms it is made of

} // namespace

// "the massless motion of a, b and c", of the coordinates that take part.
std::string Equations::motion_of(const Eigen::MatrixXd& kinds) const {
  if (kinds.size() == 0) return "the motion of massless bodies";
  const Eigen::MatrixXd directions = null_ * kinds;
  std::vector<std::string> names;
  const double largest = directions.cwiseAbs().maxCoeff();
  for (int v = 0; v < n_; ++v)
    if (directions.row(v).cwiseAbs().maxCoeff() > 1e-3 * largest)
      names.push_back(name_of_coordinate(model_, v));
  std::string out = "the massless motion of ";
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

void Equations::refuse(const std::string& what) const {
  int first = 0;
  if (!idle_.empty()) first = idle_.front();
  throw SceneError("joints." + name_of_coordinate(model_, first), what);
}

void Equations::refuse_numbers() const {
  throw SceneError("", "the forces are too large for the computer's numbers");
}

void Equations::choose_rows() {
  rows_.clear();
  if (system_.rows == 0) return;
  linearize_constraints(system_, parameters_, kinematics_, linearization_);
  const Eigen::MatrixXd scaled = model_.scaling.row.asDiagonal() * linearization_.constraint.leftCols(n_) *
                                 model_.scaling.column.asDiagonal();
  if (largest_size(scaled) <= row_rounding) return; // nothing is held that could move
  PivotedQr qr;
  if (!qr.compute(scaled.transpose())) refuse_numbers();
  for (Eigen::Index i = 0; i < qr.rank(dependent); ++i)
    rows_.push_back(qr.permutation()[i]);
  std::ranges::sort(rows_);
}

// Directions of the null space of Phi_q along which nothing that has mass moves, and coordinates that stand
// for them.
void Equations::choose_idle() {
  idle_.clear();
  dense_.evaluate_mass(point());
  const MassMatrix& m = dense_.mass();
  interruption_point();
  // In units in which every coordinate alone would have mass one or less.
  double largest = 0;
  for (int v = 0; v < n_; ++v)
    largest = std::max(largest, m.size[v] * model_.scaling.column[v] * model_.scaling.column[v]);
  Eigen::VectorXd unit(n_);
  for (int v = 0; v < n_; ++v)
    unit[v] = m.size[v] > 0 ? 1 / std::sqrt(m.size[v])
                            : model_.scaling.column[v] / std::sqrt(largest > 0 ? largest : 1);
  ConstraintSpace space;
  Eigen::MatrixXd scaled(static_cast<Eigen::Index>(rows_.size()), n_);
  for (std::size_t r = 0; r < rows_.size(); ++r)
    scaled.row(static_cast<Eigen::Index>(r)) =
        linearization_.constraint.row(rows_[r]).head(n_) * model_.scaling.row[rows_[r]];
  scaled = scaled * unit.asDiagonal();
  space.factor(scaled, 1e-14);
  interruption_point();
  const Eigen::MatrixXd basis = unit.asDiagonal() * space.basis();
  interruption_point();
  const Eigen::MatrixXd weighed = unit.asDiagonal() * m.mass.topLeftCorner(n_, n_) * unit.asDiagonal();
  const Eigen::MatrixXd reduced = large::projected(weighed, space.basis());
  if (reduced.rows() > 0) {
    SymmetricEigen eigen;
    interruption_point();
    if (!eigen.compute((reduced + reduced.transpose()) / 2)) refuse_numbers();
    Eigen::Index count = 0;
    while (count < reduced.rows() && eigen.values()[count] < no_mass)
      ++count;
    if (count > 0) {
      Eigen::MatrixXd directions =
          model_.scaling.column.cwiseInverse().asDiagonal() * basis * eigen.vectors().leftCols(count);
      const auto orthonormal = orthonormal_completion(directions);
      PivotedQr pivots;
      if (!orthonormal || !pivots.compute(orthonormal->leftCols(count).transpose())) refuse_numbers();
      for (Eigen::Index i = 0; i < count; ++i)
        idle_.push_back(pivots.permutation()[i]);
      std::ranges::sort(idle_);
    }
  }
  regular_.clear();
  for (int v = 0; v < n_; ++v)
    if (std::ranges::find(idle_, v) == idle_.end()) regular_.push_back(v);
}

// Which null directions are damped, stand in balance, or feel nothing.
void Equations::choose_kinds() {
  damped_ = standing_ = 0;
  const auto count = static_cast<Eigen::Index>(idle_.size());
  if (count == 0) return;
  // Drag that grows with the square of the speed alone holds nothing at rest.
  const std::vector<BodyForceParameters> forces = parameters_.body_forces, turning = parameters_.turning_air;
  const auto change_air = [&](const auto& change) {
    for (BodyForceParameters& f : parameters_.body_forces)
      if (is_of_air(f.type)) change(f);
    std::ranges::for_each(parameters_.turning_air, change);
  };
  change_air([](BodyForceParameters& f) { f.quadratic = f.normal_quadratic = 0; });
  evaluate_damping(damping_);
  parameters_.body_forces = forces;
  parameters_.turning_air = turning;
  change_air([](BodyForceParameters& f) {
    f.type = ForceType::drag;
    if (f.linear == 0) f.linear = f.quadratic + f.normal_quadratic;
  });
  Eigen::MatrixXd any_drag;
  evaluate_damping(any_drag);
  parameters_.body_forces = forces;
  parameters_.turning_air = turning;
  const Eigen::MatrixXd motion = model_.scaling.column.asDiagonal() * null_;
  if (!sort_kinds(motion.transpose() * damping_.topLeftCorner(n_, n_) * motion)) refuse_numbers();
  while (damped_ < count && kind_sizes_[damped_] > 1e-12 * kind_sizes_[0] && kind_sizes_[damped_] > 0)
    ++damped_;
  least_damping_ = damped_ > 0 ? kind_sizes_[damped_ - 1] : 0;
  if (damped_ == count) return;
  const Eigen::MatrixXd rest = kinds_.rightCols(count - damped_);
  if ((rest.transpose() * motion.transpose() * any_drag.topLeftCorner(n_, n_) * motion * rest)
          .cwiseAbs()
          .maxCoeff() > 1e-12 * any_drag.cwiseAbs().maxCoeff())
    refuse(motion_of(rest) + " is held by nothing but a drag that grows with the square of the speed; give "
                             "it mass or linear drag");
}

bool Equations::analyse(double t, Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  const std::vector<int> rows = rows_, idle = idle_;
  if (!choose_tree(t, q, u) && !choose_sparse(t, q, u)) choose_structure(t, q, u);
  return rows_ != rows || idle_ != idle;
}

// Along the tree, if all that moves has mass.
bool Equations::choose_tree(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  if (!tree_) return false;
  load(t, q, u);
  place();
  if (!tree_->factor(point()) || !tree_->carries_all()) return false;
  solver_ = &*tree_;
  take_all();
  return true;
}

// By sparse equations, if all that moves has mass.
bool Equations::choose_sparse(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  if (!sparse_) return false;
  load(t, q, u);
  place();
  if (!sparse_->analyse(point())) return false;
  solver_ = &*sparse_;
  take_all();
  return true;
}

// All coordinates carry mass, and all rows are taken.
void Equations::take_all() {
  damped_ = standing_ = 0;
  idle_.clear();
  regular_.resize(static_cast<std::size_t>(n_));
  std::iota(regular_.begin(), regular_.end(), 0);
  rows_.resize(static_cast<std::size_t>(system_.rows));
  std::iota(rows_.begin(), rows_.end(), 0);
}

void Equations::choose_structure(double t, Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  solver_ = &dense_;
  load(t, q, u);
  place();
  choose_rows();
  choose_idle();
  chosen_independence_ = dense_.factor_constraints(point()) ? independence() : 0;
  damped_ = standing_ = 0;
  const auto count = static_cast<Eigen::Index>(idle_.size());
  null_.setZero(n_, count);
  kinds_.setIdentity(count, count);
  kind_sizes_.setZero(count);
  if (count == 0) return;
  Eigen::VectorXd s;
  if (!reduce(t, q, u, s)) refuse(unsolved());
  choose_kinds();
  const auto rest = static_cast<Eigen::Index>(idle_.size()) - damped_;
  if (rest == 0) return;
  // Balance of what is neither massive nor damped.
  standing_ = static_cast<int>(rest);
  load(t, q, s);
  s_ = u_;
  place();
  if (!dense_.factor(point()) || !find_null_directions()) refuse(unsolved());
  if (!find_damped_velocity()) refuse(motion_of(kinds_) + " gets no velocity from the balance of forces");
  if (!find_standing_stiffness()) refuse(unsolved());
  const Eigen::MatrixXd column = model_.scaling.column.asDiagonal();
  const Eigen::MatrixXd scaled = column * linearization_.stiffness.topLeftCorner(n_, n_) * column;
  const double stiffest = scaled.cwiseAbs().maxCoeff();
  const Eigen::MatrixXd local = (standing_stiffness_ + standing_stiffness_.transpose()) / 2;
  const auto stiffnesses = symmetric_eigenvalues(local);
  if (!stiffnesses) refuse_numbers();
  standing_ = 0;
  for (Eigen::Index i = 0; i < rest; ++i)
    standing_ += std::abs((*stiffnesses)[i]) > no_stiffness * stiffest;
  if (!find_standing_balance(t, q, s, 200))
    refuse(standing_ == 0
               ? unsolved()
               : motion_of(kinds_.middleCols(damped_, standing_)) + " comes to no balance of forces");
  if (const std::string what = trouble(); !what.empty()) refuse(what);
}

// Newton's step; where the balance would not be stable, one that goes downhill.
std::optional<Eigen::VectorXd> Equations::balancing_step() const {
  SymmetricEigen eigen;
  if (!eigen.compute((standing_stiffness_ + standing_stiffness_.transpose()) / 2)) return {};
  if (Lu lu; eigen.values()[0] > 0 && lu.compute(standing_stiffness_)) return lu.solve(-standing_force_);
  const Eigen::VectorXd along = eigen.vectors().transpose() * standing_force_;
  return Eigen::VectorXd(-eigen.vectors() * along.cwiseQuotient(eigen.values().cwiseAbs()));
}

bool Equations::find_standing_balance(double t, Eigen::VectorXd& q, const Eigen::VectorXd& s, int limit) {
  double previous = 0;
  for (int i = 0; i < limit; ++i) {
    if (!evaluate(t, q, s)) return false;
    if (standing_ == 0) return true;
    const auto balancing = balancing_step();
    if (!balancing) return false;
    const Eigen::VectorXd step = kinds_.middleCols(damped_, standing_) * *balancing;
    const Eigen::VectorXd scaled = null_ * step;
    const double size = scaled.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) return false;
    const Eigen::VectorXd motion = null_motion(step) * std::min(1., 0.3 / std::max(size, 1e-300));
    retract<double>(model_.system, motion, q);
    if (size < 1e-14 || (i > 2 && size < 1e-9 && size > 0.3 * previous)) return evaluate(t, q, s);
    previous = size;
  }
  return previous < 1e-9;
}

bool Equations::structure_changed() const {
  if (is_sparse()) return sparse_->structure_changed();
  if (static_cast<int>(rows_.size()) < system_.rows) {
    if (independence() < 1e-3 * chosen_independence_) return true;
    // Rows that followed from the others may do so no longer.
    if (dense_.phi().cwiseProduct(model_.scaling.row).lpNorm<Eigen::Infinity>() > 1e-7) return true;
  }
  if (solver_ != &dense_) return !tree_->carries_all();
  if (idle_.empty()) return false;
  return null_mass_ > 1e-9 || null_.cwiseAbs().maxCoeff() > 1e3;
}

std::string Equations::trouble() const {
  if (idle_.empty()) return "";
  if (damped_ > 0 && !(kind_sizes_[damped_ - 1] > 1e-9 * least_damping_))
    return motion_of(kinds_.middleCols(damped_ - 1, 1)) + " comes to a place where its dampers hold nothing";
  if (standing_ > 0) {
    const auto stiffnesses =
        symmetric_eigenvalues((standing_stiffness_ + standing_stiffness_.transpose()) / 2);
    if (!stiffnesses || !((*stiffnesses)[0] > 0))
      return motion_of(kinds_.middleCols(damped_, standing_)) + " stands in no stable balance: it would jump";
  }
  const Eigen::Index unresisted = null_.cols() - damped_ - standing_;
  if (unresisted == 0) return "";
  const Eigen::MatrixXd directions = null_ * kinds_.rightCols(unresisted);
  const Eigen::VectorXd force = dense_.force().head(n_).cwiseProduct(model_.scaling.column);
  Magnitudes sizes;
  evaluate_magnitudes(system_, parameters_, q_, lambda_, kinematics_, sizes);
  const Eigen::VectorXd size =
      directions.cwiseAbs().transpose() * sizes.force.head(n_).cwiseProduct(model_.scaling.column);
  const Eigen::VectorXd left = directions.transpose() * force;
  for (Eigen::Index i = 0; i < unresisted; ++i)
    if (std::abs(left[i]) > no_force * size[i])
      return motion_of(kinds_.rightCols(unresisted)) + " is resisted by nothing, and a force acts along it";
  return "";
}

} // namespace flyball
