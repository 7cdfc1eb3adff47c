#include "engine/continuation/extended_balance.hpp"

#include "engine/continuation/family.hpp"
#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/measures.hpp"
#include "engine/search/turned_balance.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/stability.hpp"
#include "engine/system/balance_rate.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace flyball {

Condition coordinate_is(const CoordinateInfo& coordinate, double value) {
  const auto unit = [coordinate](const Problem& p) {
    return found_scale(p.system, p.parameters, coordinate);
  };
  return {[=](const ExtendedBalance& balance, const ExtendedState& state, Workspace&) {
            const Problem p = balance.problem();
            const double now = found_value(p.system, p.parameters, state.z.q, coordinate);
            return away_from(p.system, p.parameters, coordinate, now, value) / unit(p);
          },
          [=](const ExtendedBalance& balance, const ExtendedState& state,
              Workspace&) -> SingularityTest::Gradient {
            const Problem p = balance.problem();
            return {
                found_gradient(p.system, p.parameters, state.z.q, coordinate).cwiseProduct(p.scaling.column) /
                    unit(p),
                Eigen::VectorXd::Zero(p.system.rows)};
          }};
}

Condition measure_is(std::size_t measure, double value, double scale) {
  struct Taken {
    MeasureSet measures;
    Workspace at, beside;
  };
  const auto taken = std::make_shared<Taken>();
  const auto i = static_cast<Eigen::Index>(measure);
  const auto take = [=](const ExtendedBalance& balance, const ExtendedState& state) {
    const Problem p = balance.problem();
    taken->measures.bind(balance.mechanism(), p.system, p.parameters);
    return (taken->measures.evaluate_at(p, state.z.q, taken->at)[i] - value) / scale;
  };
  return {[=](const ExtendedBalance& balance, const ExtendedState& state, Workspace&) {
            return take(balance, state);
          },
          [=](const ExtendedBalance& balance, const ExtendedState& state,
              Workspace&) -> SingularityTest::Gradient {
            take(balance, state);
            const Problem p = balance.problem();
            const Eigen::MatrixXd& rates =
                taken->measures.gradient(p, state.z.q, taken->at, taken->beside, true);
            return {rates.row(i).transpose().cwiseProduct(p.scaling.column) / scale,
                    Eigen::VectorXd::Zero(p.system.rows)};
          }};
}

Condition balance_is_singular() {
  return {[](const ExtendedBalance& balance, const ExtendedState& state, Workspace& w) {
            return balance.ties() ? balance.turned_singularity(state, w)
                                  : balance.singularity().value(balance.problem(), state.z, w);
          },
          [](const ExtendedBalance& balance, const ExtendedState& state, Workspace& w) {
            return balance.singularity().gradient(balance.problem(), state.z, w);
          },
          true};
}

Condition branches_cross(std::size_t parameter) {
  return {[parameter](const ExtendedBalance& balance, const ExtendedState& state, Workspace& w) {
            return balance.transversality(state, parameter, w);
          },
          {},
          true};
}

ExtendedBalance::ExtendedBalance(const System& system, const Mechanism& mechanism,
                                 std::vector<std::string> addresses, Eigen::VectorXd scales,
                                 std::vector<Condition> conditions, bool unfolded,
                                 std::optional<AngleTies> ties)
    : system_(system), mechanism_(mechanism), addresses_(std::move(addresses)),
      numbers_(mechanism_, addresses_), scales_(std::move(scales)), conditions_(std::move(conditions)),
      unfolded_(unfolded), ties_(std::move(ties)), form_(KktForm::dense) {
  const bool gradients = std::ranges::all_of(conditions_, [](const Condition& c) { return !!c.gradient; });
  if (system.conservative && system.single_drives && gradients && !unfolded_ && !ties_)
    form_ = system.kkt_form;
  bind(system_, mechanism_, parameters_);
  set_scaling(system_, parameters_, scaling_);
}

Problem ExtendedBalance::judged() const {
  Problem p = problem();
  if (system_.nv <= largest_for_eigenvalues) p.form = KktForm::dense;
  return p;
}

void ExtendedBalance::set(const ExtendedState& state) {
  numbers_.set({state.parameters.data(), addresses_.size()});
  bind(system_, mechanism_, parameters_);
  if (ties_)
    for (const int link : ties_->found)
      parameters_.links[static_cast<std::size_t>(link)].start = state.starts[link];
}

void ExtendedBalance::move(ExtendedState& state, const Eigen::VectorXd& step) const {
  const Eigen::VectorXd unscaled = step.head(system_.nv).cwiseProduct(scaling_.column);
  retract<double>(system_, unscaled, state.z.q);
  if (ties_) turn_along(*ties_, step.segment(system_.nv, tied()), state.starts);
  state.parameters += step.tail(scales_.size()).cwiseProduct(scales_);
}

void ExtendedBalance::rates(const ExtendedState& state, std::size_t index, Eigen::VectorXd& force,
                            Eigen::VectorXd& phi) const {
  const double scale = scales_[static_cast<Eigen::Index>(index)];
  NumberRates numbers;
  numbers_.rates(index, numbers);
  BalanceRate balance;
  balance.evaluate(system_, mechanism_, numbers, parameters_, state.z.q, state.z.lambda);
  force = scale * balance.force().cwiseProduct(scaling_.column);
  phi = scale * balance.phi().cwiseProduct(scaling_.row);
}

void ExtendedBalance::evaluate_extended(const Unknowns& z, Eigen::VectorXd& force, Eigen::VectorXd& phi) {
  flyball::evaluate_extended(problem(), z, w_);
  phi = w_.residual_extended.phi.cast<double>().cwiseProduct(scaling_.row);
  force = w_.residual_extended.f.cast<double>().cwiseProduct(scaling_.column);
}

double ExtendedBalance::linearize(const ExtendedState& state) try {
  if (form_ != KktForm::dense) return border(state);
  if (ties_)
    assemble_turned(state, assembled_);
  else
    assemble(state, assembled_);
  return assembled_.matrix.allFinite() ? assembled_.residual : std::numeric_limits<double>::infinity();
} catch (const SceneError&) { // expressions make no mechanism of these numbers
  return std::numeric_limits<double>::infinity();
}

void ExtendedBalance::assemble(const ExtendedState& start, Assembled& out) {
  ExtendedState state = start;
  set(state);
  const Problem problem = this->problem();
  factor_with_multipliers(problem, state.z, w_);
  const Eigen::MatrixXd basis = w_.dense.constraints().basis(), stiffness = w_.dense.stiffness();
  const Eigen::Index n = system_.nv, k = basis.cols(), count = scales_.size();
  const auto conditions = static_cast<Eigen::Index>(conditions_.size());
  const double size = force_size(problem, w_);

  out.columns = Eigen::MatrixXd::Zero(n + count, k + count);
  out.columns.topLeftCorner(n, k) = basis;
  out.columns.bottomRightCorner(count, count).setIdentity();
  out.r0 = Eigen::VectorXd::Zero(n);
  out.matrix = Eigen::MatrixXd::Zero(k + conditions, k + count + (unfolded_ ? 1 : 0));
  out.rhs.resize(k + conditions);
  Eigen::VectorXd force, phi;
  evaluate_extended({state.z.q, Eigen::VectorXd::Zero(system_.rows)}, force, phi);
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
    out.matrix.col(k + count).head(k) = basis.transpose() * singularity_.left();
    out.rhs.head(k) -= basis.transpose() * singularity_.left() * state.unfolding;
  }
  out.residual = 0;
  if (k > 0) out.residual = (basis.transpose() * force / size).lpNorm<Eigen::Infinity>();
  if (phi.size() > 0) out.residual = std::max(out.residual, phi.lpNorm<Eigen::Infinity>());

  assemble_conditions(state, k, out);
  // Closing the loops moves the conditions, too: a step that does both is quadratic only with this.
  if (out.r0.size() > 0 && out.r0.lpNorm<Eigen::Infinity>() > 1e-12) {
    ExtendedState closed = state;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n + count);
    step.head(n) = out.r0;
    move(closed, step);
    if (any_of_matrix()) factor_with_multipliers(problem, closed.z, probe_);
    for (Eigen::Index c = 0; c < conditions; ++c)
      out.rhs[k + c] = -conditions_[static_cast<std::size_t>(c)].value(*this, closed, probe_);
  }
}

// By central differences: they steer, the conditions themselves are exact.
void ExtendedBalance::assemble_conditions(const ExtendedState& state, Eigen::Index k, Assembled& out) {
  const auto conditions = static_cast<Eigen::Index>(conditions_.size());
  const Eigen::Index moving = system_.nv;
  for (Eigen::Index c = 0; c < conditions; ++c) {
    const double value = conditions_[static_cast<std::size_t>(c)].value(*this, state, w_);
    out.rhs[k + c] = -value;
    out.residual = std::max(out.residual, std::abs(value));
  }
  const double h = 1e-5;
  for (Eigen::Index j = 0; j < out.columns.cols(); ++j) {
    if (out.columns.col(j).isZero(0)) continue; // of multipliers, on which none depends
    const bool set_again = !out.columns.col(j).tail(out.columns.rows() - moving).isZero(0);
    Eigen::VectorXd side[2];
    for (int i : {0, 1}) {
      ExtendedState moved = state;
      move(moved, (i == 0 ? h : -h) * out.columns.col(j));
      if (set_again) set(moved);
      if (any_of_matrix()) factor_with_multipliers(this->problem(), moved.z, probe_);
      side[i].resize(conditions);
      for (Eigen::Index c = 0; c < conditions; ++c)
        side[i][c] = conditions_[static_cast<std::size_t>(c)].value(*this, moved, probe_);
    }
    out.matrix.col(j).tail(conditions) = (side[0] - side[1]) / (2 * h);
    if (set_again) set(state);
  }
}

void ExtendedBalance::assemble_turned(const ExtendedState& start, Assembled& out) {
  ExtendedState state = start;
  set(state);
  const Problem problem = this->problem();
  factor_with_multipliers(problem, state.z, w_);
  const TurnedBalance balance(problem, state.z, *ties_, mechanism_, probe_);
  const Eigen::Index moving = system_.nv + tied(), count = scales_.size();
  const Eigen::Index k = moving + balance.multipliers();
  const auto conditions = static_cast<Eigen::Index>(conditions_.size());
  out.columns = Eigen::MatrixXd::Zero(moving + count, k + count);
  out.columns.topLeftCorner(moving, moving).setIdentity();
  out.columns.bottomRightCorner(count, count).setIdentity();
  out.r0 = Eigen::VectorXd::Zero(system_.nv);
  out.matrix = Eigen::MatrixXd::Zero(k + conditions, k + count);
  out.rhs = Eigen::VectorXd::Zero(k + conditions);
  out.residual = std::numeric_limits<double>::infinity();
  if (!balance.usable()) return;
  out.matrix.topLeftCorner(k, k) = balance.matrix();
  NumberRates numbers;
  for (Eigen::Index i = 0; i < count; ++i) {
    numbers_.rates(static_cast<std::size_t>(i), numbers);
    out.matrix.col(k + i).head(k) = scales_[i] * balance.rate(numbers);
  }
  flyball::evaluate_extended(problem, {state.z.q, Eigen::VectorXd::Zero(system_.rows)}, w_);
  out.rhs.head(k) =
      -balance.left_of(w_.residual_extended.f.cast<double>(), w_.residual_extended.phi.cast<double>());
  out.residual = balance.residual();
  assemble_conditions(state, k, out);
}

double ExtendedBalance::border(const ExtendedState& start) {
  ExtendedState state = start;
  set(state);
  const Problem problem = this->problem();
  const Eigen::Index n = system_.nv, count = scales_.size();
  const auto conditions = static_cast<Eigen::Index>(conditions_.size());
  evaluate_with_multipliers(problem, state.z, w_);
  const double left = scaled_residual(problem, w_);
  if (!std::isfinite(left)) return left;
  bordered_.matrix.linearize(problem, state.z, w_);
  Eigen::VectorXd force, phi;
  Eigen::MatrixXd force_rates(n, count), phi_rates(system_.rows, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    rates(state, static_cast<std::size_t>(i), force, phi);
    force_rates.col(i) = force;
    phi_rates.col(i) = phi;
  }
  bordered_.matrix.set_columns(force_rates, phi_rates);
  evaluate_extended(state.z, force, phi);
  double residual = n > 0 ? force.lpNorm<Eigen::Infinity>() / bordered_.matrix.force_size() : 0;
  if (phi.size() > 0) residual = std::max(residual, phi.lpNorm<Eigen::Infinity>());

  // Conditions and their rates in the parameters at the same unknowns, in a workspace of their own: what is
  // factored at the state is solved with.
  BorderedKkt::Rows& rows = bordered_.rows;
  rows = {Eigen::MatrixXd(conditions, n), Eigen::MatrixXd(conditions, system_.rows),
          Eigen::MatrixXd(conditions, count)};
  bordered_.rhs = {-force, -phi, Eigen::VectorXd(conditions)};
  const auto value_of = [&](const Condition& condition) {
    evaluate(this->problem(), state.z, 0, probe_);
    return condition.value(*this, state, probe_);
  };
  const double h = 1e-5;
  for (Eigen::Index c = 0; c < conditions; ++c) {
    const Condition& condition = conditions_[static_cast<std::size_t>(c)];
    const double value = value_of(condition);
    bordered_.rhs.m[c] = -value;
    residual = std::max(residual, std::abs(value));
    const SingularityTest::Gradient gradient = condition.gradient(*this, state, probe_);
    rows.x.row(c) = gradient.x.transpose();
    rows.lambda.row(c) = gradient.lambda.transpose();
    for (Eigen::Index i = 0; i < count; ++i) {
      double sides[2];
      for (const int side : {0, 1}) {
        const double step = (side == 0 ? h : -h) * scales_[i];
        ExtendedState moved = state;
        moved.parameters[i] += step;
        set(moved);
        sides[side] = value_of(condition);
      }
      rows.m(c, i) = (sides[0] - sides[1]) / (2 * h);
    }
    set(state);
  }
  return residual;
}

std::optional<ExtendedBalance::Step> ExtendedBalance::solve(Rhs rhs, const Eigen::VectorXd& row,
                                                            double along) {
  return form_ == KktForm::dense ? solve_assembled(rhs, row, along) : solve_bordered(rhs, row, along);
}

std::optional<ExtendedBalance::Step> ExtendedBalance::solve_assembled(Rhs rhs, const Eigen::VectorXd& row,
                                                                      double along) const {
  const Assembled& a = assembled_;
  const bool last = row.size() > 0;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(a.matrix.rows() + (last ? 1 : 0), a.matrix.cols());
  if (m.rows() != m.cols()) return {};
  m.topRows(a.matrix.rows()) = a.matrix;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(m.rows());
  if (rhs == Rhs::balance) b.head(a.rhs.size()) = a.rhs;
  if (last) {
    m.bottomRows(1).leftCols(a.columns.cols()) = row.transpose() * a.columns;
    b[a.rhs.size()] = along;
    if (rhs == Rhs::balance) b[a.rhs.size()] -= row.head(system_.nv).dot(a.r0);
  }
  const auto solved = solve_square(m, b);
  if (!solved) return {};
  Step step{a.columns * solved->head(a.columns.cols())};
  if (rhs == Rhs::balance) step.scaled.head(system_.nv) += a.r0;
  if (unfolded_) step.unfolding = (*solved)[solved->size() - 1];
  return step;
}

std::optional<ExtendedBalance::Step> ExtendedBalance::solve_bordered(Rhs rhs, const Eigen::VectorXd& row,
                                                                     double along) {
  const Eigen::Index n = system_.nv, count = scales_.size(), conditions = bordered_.rows.m.rows();
  const bool last = row.size() > 0;
  if (conditions + (last ? 1 : 0) != count) return {};
  BorderedKkt::Rows rows = bordered_.rows;
  BorderedKkt::Vector b{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(system_.rows),
                        Eigen::VectorXd::Zero(count)};
  if (rhs == Rhs::balance) {
    b.x = bordered_.rhs.x;
    b.lambda = bordered_.rhs.lambda;
    b.m.head(conditions) = bordered_.rhs.m;
  }
  if (last) {
    rows.x.conservativeResize(count, n);
    rows.lambda.conservativeResize(count, system_.rows);
    rows.m.conservativeResize(count, count);
    rows.x.bottomRows(1) = row.head(n).transpose();
    rows.lambda.bottomRows(1).setZero();
    rows.m.bottomRows(1) = row.tail(count).transpose();
    b.m[conditions] = along;
  }
  bordered_.matrix.set_rows(std::move(rows));
  BorderedKkt::Vector out;
  if (!bordered_.matrix.solve(b, out)) return {};
  Step step{Eigen::VectorXd(n + count)};
  step.scaled << out.x, out.m;
  return step;
}

bool ExtendedBalance::is_possible() const try {
  if (std::ranges::any_of(addresses_, makes_others)) validate_numbers(mechanism_);
  return true;
} catch (const SceneError&) {
  return false;
}

ExtendedOutcome ExtendedBalance::correct(ExtendedState& state, const Eigen::VectorXd& row) {
  ExtendedOutcome outcome;
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(unknowns());
  double previous = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i) { // a double solution halves its error only
    outcome.residual = linearize(state);
    if (!std::isfinite(outcome.residual)) break;
    const auto solved = solve(Rhs::balance, row, row.size() > 0 ? -row.dot(moved) : 0);
    if (!solved) break;
    const Eigen::VectorXd& step = solved->scaled;
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(length) || length > 2) break;
    // Converged before: these are the last digits, as long as they still get smaller.
    if (outcome.converged && !(length < 0.5 * previous)) break;
    move(state, step);
    moved += step;
    state.unfolding += solved->unfolding;
    outcome.step = step;
    outcome.iterations = i + 1;
    previous = length;
    if (length < 1e-9) {
      outcome.converged = true;
      if (length < 1e-15) break;
    }
  }
  if (outcome.converged) {
    set(state);
    factor_with_multipliers(problem(), state.z, w_);
    outcome.converged = outcome.residual < 1e-8 && is_possible();
  }
  return outcome;
}

Eigen::VectorXd ExtendedBalance::tangent(const ExtendedState& state, const Eigen::VectorXd& previous) {
  if (!std::isfinite(linearize(state))) return {};
  const auto solved = solve(Rhs::none, previous, 1);
  if (!solved) return {};
  const double norm = solved->scaled.norm();
  if (!std::isfinite(norm) || norm == 0) return {};
  return solved->scaled / norm;
}

void ExtendedBalance::set_borders(const ExtendedState& state) {
  Unknowns z = state.z;
  set(state);
  if (form_ == KktForm::dense)
    factor_with_multipliers(problem(), z, w_);
  else
    evaluate_with_multipliers(problem(), z, w_);
  if (!ties_) return singularity_.set_borders(problem(), z, w_);
  turned_row_.resize(0); // without them turned_singularity() is none
  const TurnedBalance balance(problem(), z, *ties_, mechanism_, probe_);
  const auto svd = balance.usable() ? singular_vectors(balance.matrix()) : std::nullopt;
  if (!svd) return;
  const Eigen::Index n = system_.nv, loops = balance.multipliers();
  turned_column_ = svd->left.rightCols(1);
  turned_column_.segment(n, loops).setZero();
  turned_row_ = svd->right.rightCols(1);
  turned_row_.tail(loops).setZero();
}

double ExtendedBalance::turned_singularity(const ExtendedState& state, Workspace& w) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const TurnedBalance balance(problem(), state.z, *ties_, mechanism_, w);
  const Eigen::Index size = balance.matrix().rows();
  if (!balance.usable() || turned_row_.size() != size) return none;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(size + 1, size + 1);
  m.topLeftCorner(size, size) = balance.matrix();
  m.col(size).head(size) = turned_column_;
  m.row(size).head(size) = turned_row_.transpose();
  const auto solved = solve_square(m, Eigen::VectorXd::Unit(size + 1, size));
  return solved ? (*solved)[size] : none;
}

double ExtendedBalance::transversality(const ExtendedState& state, std::size_t index, Workspace& w) const {
  Eigen::VectorXd force, phi;
  rates(state, index, force, phi);
  return singularity_.leaving(force, phi, w);
}

} // namespace flyball
