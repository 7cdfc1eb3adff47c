#include "engine/continuation/extended_balance.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/address.hpp"

#include <utility>

namespace flyball {

Condition coordinate_is(const CoordinateInfo& coordinate, double value) {
  return [coordinate, value](const ExtendedBalance& balance, const ExtendedState& state, Workspace&) {
    const Problem p = balance.problem();
    const double now = coordinate_value(p.system, p.parameters, state.z.q, coordinate);
    return away_from(p.system, p.parameters, coordinate, now, value) /
           (coordinate.angle ? 1 : p.parameters.length);
  };
}

Condition balance_is_singular() {
  return [](const ExtendedBalance& balance, const ExtendedState&, Workspace& w) {
    return balance.singularity(w);
  };
}

Condition branches_cross(std::size_t parameter) {
  return [parameter](const ExtendedBalance& balance, const ExtendedState& state, Workspace& w) {
    return balance.transversality(state, parameter, w);
  };
}

ExtendedBalance::ExtendedBalance(const System& system, const Mechanism& mechanism,
                                 std::vector<std::string> addresses, Eigen::VectorXd scales,
                                 std::vector<Condition> conditions, bool unfolded)
    : system_(system), mechanism_(mechanism), addresses_(std::move(addresses)), scales_(std::move(scales)),
      conditions_(std::move(conditions)), unfolded_(unfolded) {
  bind(system_, mechanism_, parameters_);
  set_scaling(system_, parameters_, scaling_);
  left_ = right_ = Eigen::VectorXd::Zero(system_.nv);
}

// A state without loads has stiffness only, one without stiffness loads only.
double ExtendedBalance::force_size(const Workspace& w) const {
  if (system_.nv == 0) return 1;
  const double size = std::max(w.magnitudes.force.cwiseProduct(scaling_.column).maxCoeff(),
                               w.dense.stiffness().cwiseAbs().maxCoeff());
  return size > 0 ? size : 1;
}

void ExtendedBalance::set(const Eigen::VectorXd& parameters) {
  for (std::size_t i = 0; i < addresses_.size(); ++i)
    set_parameter(mechanism_, addresses_[i], parameters[static_cast<Eigen::Index>(i)]);
  bind(system_, mechanism_, parameters_);
}

void ExtendedBalance::move(ExtendedState& state, const Eigen::VectorXd& step) const {
  const Eigen::VectorXd way = step.head(system_.nv).cwiseProduct(scaling_.column);
  retract<double>(system_, way, state.z.q);
  state.parameters += step.tail(scales_.size()).cwiseProduct(scales_);
}

// Of the balance and the loops in one parameter over its scale, by central differences in numbers of their
// own; scaled.
void ExtendedBalance::rates(const ExtendedState& state, std::size_t index, Eigen::VectorXd& force,
                            Eigen::VectorXd& phi) const {
  const double h = 1e-6, value = state.parameters[static_cast<Eigen::Index>(index)];
  const double scale = scales_[static_cast<Eigen::Index>(index)];
  Mechanism varied = mechanism_;
  Parameters numbers;
  Workspace w;
  Eigen::VectorXd f[2], p[2];
  for (int i : {0, 1}) {
    set_parameter(varied, addresses_[index], value + (i == 0 ? h : -h) * scale);
    bind(system_, varied, numbers);
    evaluate({system_, numbers, scaling_}, state.z, 0, w);
    f[i] = w.residual.f;
    p[i] = w.residual.phi;
  }
  force = ((f[0] - f[1]) / (2 * h)).cwiseProduct(scaling_.column);
  phi = ((p[0] - p[1]) / (2 * h)).cwiseProduct(scaling_.row);
}

// Unknowns y, m (and the unfolding): the scaled step is r0 + N y + R m, and m for the parameters.
struct ExtendedBalance::Assembled {
  Eigen::MatrixXd columns; // [N R; 0 I]: (unknowns, k + parameters)
  Eigen::VectorXd r0;
  Eigen::MatrixXd matrix; // without the last row
  Eigen::VectorXd rhs;
  double residual = 0;
};

void ExtendedBalance::assemble(const ExtendedState& start, Assembled& out) {
  ExtendedState state = start;
  set(state.parameters);
  const Problem problem = this->problem();
  factor_with_multipliers(problem, state.z, w_);
  const Eigen::MatrixXd basis = w_.dense.constraints().basis(), stiffness = w_.dense.stiffness();
  const Eigen::Index n = system_.nv, k = basis.cols(), count = scales_.size();
  const auto conditions = static_cast<Eigen::Index>(conditions_.size());
  const double size = force_size(w_);

  out.columns = Eigen::MatrixXd::Zero(n + count, k + count);
  out.columns.topLeftCorner(n, k) = basis;
  out.columns.bottomRightCorner(count, count).setIdentity();
  out.r0 = Eigen::VectorXd::Zero(n);
  out.matrix = Eigen::MatrixXd::Zero(k + conditions, k + count + (unfolded_ ? 1 : 0));
  out.rhs.resize(k + conditions);
  // Forces and loops in extended precision: the last digits of the answer come from here.
  w_.q_extended = state.z.q.cast<Extended>();
  w_.lambda_extended = Eigen::VectorXd::Zero(system_.rows).cast<Extended>();
  forward<Extended>(system_, parameters_, w_.q_extended, 0, w_.kinematics_extended);
  evaluate_residual<Extended>(system_, parameters_, w_.q_extended, w_.lambda_extended, w_.kinematics_extended,
                              w_.residual_extended);
  const Eigen::VectorXd phi = w_.residual_extended.phi.cast<double>().cwiseProduct(scaling_.row);
  Eigen::VectorXd force = w_.residual_extended.f.cast<double>().cwiseProduct(scaling_.column);
  if (w_.dense.constraints().rank() > 0) w_.dense.constraints().solve(-phi, out.r0);
  out.matrix.topLeftCorner(k, k) = large::projected(stiffness, basis) / size;
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::VectorXd force_rate, phi_rate, r1 = Eigen::VectorXd::Zero(n);
    rates(state, static_cast<std::size_t>(i), force_rate, phi_rate);
    if (w_.dense.constraints().rank() > 0) w_.dense.constraints().solve(-phi_rate, r1);
    out.columns.col(k + i).head(n) = r1;
    out.matrix.col(k + i).head(k) = basis.transpose() * (stiffness * r1 + force_rate) / size;
  }
  out.rhs.head(k) = -basis.transpose() * (force + stiffness * out.r0) / size;
  if (unfolded_) {
    out.matrix.col(k + count).head(k) = basis.transpose() * left_;
    out.rhs.head(k) -= basis.transpose() * left_ * state.unfolding;
  }
  out.residual = 0;
  if (k > 0) out.residual = (basis.transpose() * force / size).lpNorm<Eigen::Infinity>();
  if (phi.size() > 0) out.residual = std::max(out.residual, phi.lpNorm<Eigen::Infinity>());

  // Conditions and their rates along every column, by central differences: they steer, the conditions
  // themselves are exact.
  for (Eigen::Index c = 0; c < conditions; ++c) {
    const double value = conditions_[static_cast<std::size_t>(c)](*this, state, w_);
    out.rhs[k + c] = -value;
    out.residual = std::max(out.residual, std::abs(value));
  }
  const double h = 1e-5;
  for (Eigen::Index j = 0; j < k + count; ++j) {
    Eigen::VectorXd side[2];
    for (int i : {0, 1}) {
      ExtendedState moved = state;
      move(moved, (i == 0 ? h : -h) * out.columns.col(j));
      if (j >= k) set(moved.parameters);
      factor_with_multipliers(this->problem(), moved.z, probe_);
      side[i].resize(conditions);
      for (Eigen::Index c = 0; c < conditions; ++c)
        side[i][c] = conditions_[static_cast<std::size_t>(c)](*this, moved, probe_);
    }
    out.matrix.col(j).tail(conditions) = (side[0] - side[1]) / (2 * h);
    if (j >= k) set(state.parameters);
  }
  // Closing the loops moves the conditions, too: a step that does both is quadratic only with this.
  if (out.r0.size() > 0 && out.r0.lpNorm<Eigen::Infinity>() > 1e-12) {
    ExtendedState closed = state;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n + count);
    step.head(n) = out.r0;
    move(closed, step);
    factor_with_multipliers(problem, closed.z, probe_);
    for (Eigen::Index c = 0; c < conditions; ++c)
      out.rhs[k + c] = -conditions_[static_cast<std::size_t>(c)](*this, closed, probe_);
  }
}

ExtendedOutcome ExtendedBalance::correct(ExtendedState& state, const Eigen::VectorXd& row) {
  ExtendedOutcome outcome;
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(unknowns());
  Assembled a;
  double previous = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i) { // a double solution halves its error only
    assemble(state, a);
    outcome.residual = a.residual;
    if (!std::isfinite(a.residual) || !a.matrix.allFinite()) return outcome;
    const bool last = row.size() > 0;
    Eigen::MatrixXd m(a.matrix.rows() + (last ? 1 : 0), a.matrix.cols());
    Eigen::VectorXd rhs(m.rows());
    m.topRows(a.matrix.rows()) = a.matrix;
    rhs.head(a.rhs.size()) = a.rhs;
    if (last) {
      m.bottomRows(1).setZero();
      m.bottomRows(1).leftCols(a.columns.cols()) = row.transpose() * a.columns;
      rhs[a.rhs.size()] = -row.head(system_.nv).dot(a.r0) - row.dot(moved);
    }
    if (m.rows() != m.cols()) return outcome;
    const auto solved = solve_square(m, rhs);
    if (!solved) return outcome;
    const Eigen::VectorXd& u = *solved;
    Eigen::VectorXd step = a.columns * u.head(a.columns.cols());
    step.head(system_.nv) += a.r0;
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(length) || length > 2) return outcome;
    // Converged before: these are the last digits, as long as they still get smaller.
    if (outcome.converged && !(length < 0.5 * previous)) break;
    move(state, step);
    moved += step;
    if (unfolded_) state.unfolding += u[u.size() - 1];
    outcome.step = step;
    outcome.iterations = i + 1;
    previous = length;
    if (length < 1e-9) {
      outcome.converged = true;
      if (length < 1e-15) break;
    }
  }
  if (outcome.converged) {
    set(state.parameters);
    factor_with_multipliers(problem(), state.z, w_);
    outcome.converged = outcome.residual < 1e-8;
  }
  return outcome;
}

Eigen::VectorXd ExtendedBalance::tangent(const ExtendedState& state, const Eigen::VectorXd& previous) {
  Assembled a;
  assemble(state, a);
  if (!a.matrix.allFinite()) return {};
  Eigen::MatrixXd m(a.matrix.rows() + 1, a.matrix.cols());
  m.topRows(a.matrix.rows()) = a.matrix;
  m.bottomRows(1).setZero();
  m.bottomRows(1).leftCols(a.columns.cols()) = previous.transpose() * a.columns;
  if (m.rows() != m.cols()) return {};
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(m.rows());
  rhs[m.rows() - 1] = 1;
  const auto solved = solve_square(m, rhs);
  if (!solved) return {};
  Eigen::VectorXd out = a.columns * solved->head(a.columns.cols());
  const double norm = out.norm();
  if (!std::isfinite(norm) || norm == 0) return {};
  return out / norm;
}

void ExtendedBalance::set_borders(const ExtendedState& state) {
  Unknowns z = state.z;
  set(state.parameters);
  factor_with_multipliers(problem(), z, w_);
  const Eigen::MatrixXd& basis = w_.dense.constraints().basis();
  if (basis.cols() == 0) return;
  const Eigen::MatrixXd reduced = large::projected(w_.dense.stiffness(), basis);
  if (reduced.rows() >= large::from) {
    const auto smallest = large::smallest_singular(reduced, 1);
    if (!smallest) return;
    left_ = basis * smallest->left;
    right_ = basis * smallest->right;
  } else {
    const auto svd = singular_vectors(reduced);
    if (!svd) return;
    left_ = basis * svd->left.rightCols(1);
    right_ = basis * svd->right.rightCols(1);
  }
  size_ = force_size(w_);
}

Eigen::MatrixXd ExtendedBalance::bordered(const Workspace& w) const {
  const Eigen::MatrixXd& basis = w.dense.constraints().basis();
  const Eigen::Index k = basis.cols();
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(k + 1, k + 1);
  m.topLeftCorner(k, k) = large::projected(w.dense.stiffness(), basis) / size_;
  m.col(k).head(k) = basis.transpose() * left_;
  m.row(k).head(k) = right_.transpose() * basis;
  return m;
}

double ExtendedBalance::singularity(Workspace& w) const {
  const Eigen::MatrixXd m = bordered(w);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(m.rows());
  rhs[m.rows() - 1] = 1;
  const auto solved = solve_square(m, rhs);
  return solved ? (*solved)[m.rows() - 1] : std::numeric_limits<double>::quiet_NaN();
}

double ExtendedBalance::transversality(const ExtendedState& state, std::size_t index, Workspace& w) const {
  const Eigen::MatrixXd m = bordered(w);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(m.rows());
  rhs[m.rows() - 1] = 1;
  const auto solved = solve_square(m.transpose(), rhs);
  if (!solved) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd across = solved->head(m.rows() - 1);
  Eigen::VectorXd force, phi, r1 = Eigen::VectorXd::Zero(system_.nv);
  rates(state, index, force, phi);
  if (w.dense.constraints().rank() > 0) w.dense.constraints().solve(-phi, r1);
  return across.dot(w.dense.constraints().basis().transpose() * (w.dense.stiffness() * r1 + force)) / size_;
}

} // namespace flyball
