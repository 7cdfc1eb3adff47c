#include "engine/study/direct_solution.hpp"

#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/report/report.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/neutral_directions.hpp"
#include "engine/stability/stability.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {

DirectSolution::DirectSolution(const Mechanism& mechanism, const std::atomic<bool>* cancel)
    : mechanism_(mechanism), cancel_(cancel) {
  system_ = compile_for_drives(mechanism);
  bind(system_, mechanism, parameters_);
  set_scaling(system_, parameters_, scaling_);
  drawn_configuration(system_, parameters_, drawn_);
  measures_.bind(mechanism, system_, parameters_);
  as_drawn_ = parameters_;
}

bool DirectSolution::answer(Unknowns& z) {
  parameters_ = as_drawn_;
  steady_.find(problem(), drawn_, drawn_, {.seconds = SolveOptions{}.search});
  if (!steady_.holds) return answer_turned(z);
  if (!steady_.found.minimum || !steady_.phases.empty())
    stability_ =
        steady_.stability ? *steady_.stability : find_stability(steady_.factored(classified()), false);
  z = steady_.found.z;
  return true;
}

void DirectSolution::settle_reference(const Unknowns& answer, Comparison& out) {
  if (turned_) return settle_turned_reference(out);
  Unknowns z = answer;
  take_neutral(z);
  factor_with_multipliers(problem(), z, w_);
  reference_ = z.q.cast<Extended>();
  Configuration<Extended> step, multipliers = z.lambda.cast<Extended>();
  Eigen::VectorXd correction;
  double previous = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 12; ++i) {
    w_.q_extended = reference_;
    w_.lambda_extended = multipliers;
    evaluate_extended(problem(), w_);
    w_.residual.f = w_.residual_extended.f.cast<double>();
    w_.residual.phi = w_.residual_extended.phi.cast<double>();
    newton_step(problem(), w_.residual.f, w_.residual.phi, w_, w_.scaled_step, z.lambda);
    const double size = w_.scaled_step.size() > 0 ? w_.scaled_step.lpNorm<Eigen::Infinity>() : 0;
    correction = w_.scaled_step.cwiseProduct(scaling_.column);
    out.reference_error = size;
    out.reference_residual = scaled_residual(problem(), w_);
    if (!std::isfinite(size) || (i > 1 && size >= previous / 2)) break; // rounding is all that is left
    step = correction.cast<Extended>();
    retract<Extended>(system_, step, reference_);
    multipliers += z.lambda.cast<Extended>(); // corrected like the rest
    previous = size;
  }
  if (correction.size() == 0) correction.setZero(system_.nv);
  tell_reference(correction, out);
}

double DirectSolution::take_angles(const Eigen::VectorXd& angles, double time) {
  if (!turned_) return 0;
  const AngleTies& ties = turned_->ties;
  Eigen::VectorXd away = Eigen::VectorXd::Zero(ties.along.cols());
  std::vector<Eigen::VectorXd> turns; // along V, of a whole one of each
  for (std::size_t i = 0; i < ties.found.size(); ++i) {
    const auto l = static_cast<std::size_t>(ties.found[i]);
    const bool revolute = system_.links[l].type == LinkType::revolute;
    const double unit = revolute ? 1 : parameters_.length;
    const Eigen::VectorXd moves = ties.along.row(static_cast<Eigen::Index>(i)).transpose() / unit;
    const double stood =
        turned_->starts[ties.found[i]] + static_cast<double>(reference_[system_.links[l].q]) * time;
    away += moves * (angles[ties.found[i]] - parameters_.links[l].drawn - stood) / unit;
    if (revolute && moves.squaredNorm() > 0) turns.push_back(2 * std::numbers::pi * moves);
  }
  constexpr int rounds = 4;
  for (int i = 0; i < rounds; ++i)
    for (const Eigen::VectorXd& turn : turns)
      away -= std::round(turn.dot(away) / turn.squaredNorm()) * turn;
  Eigen::VectorXd starts = turned_->starts;
  turn_along(ties, away, starts);
  for (const int link : ties.found)
    parameters_.links[static_cast<std::size_t>(link)].start = starts[link];
  return largest_size(away);
}

bool DirectSolution::determines_anything() const {
  for (std::size_t l = 0; l < system_.links.size(); ++l)
    if (system_.links[l].v >= 0 && arbitrary_[l].cols() < arbitrary_[l].rows()) return true;
  return false;
}

double DirectSolution::size_of(const Eigen::VectorXd& change) const {
  double largest = 0;
  for (std::size_t l = 0; l < system_.links.size(); ++l) {
    const Eigen::MatrixXd& arbitrary = arbitrary_[l];
    if (system_.links[l].v < 0) continue;
    const auto of = change.segment(system_.links[l].v, arbitrary.rows());
    largest = std::max(largest, (of - arbitrary * (arbitrary.transpose() * of)).norm());
  }
  return largest;
}

double DirectSolution::error_of(const Eigen::VectorXd& q) const {
  double worst = 0;
  for (std::size_t l = 0; l < system_.links.size(); ++l) {
    const Link& link = system_.links[l];
    const Eigen::MatrixXd& arbitrary = arbitrary_[l];
    if (link.v < 0 || arbitrary.cols() == arbitrary.rows()) continue;
    if (link.type == LinkType::spherical) {
      const auto rotation = [&](const auto& x) {
        return Eigen::Quaternion<Extended>(x[link.q], x[link.q + 1], x[link.q + 2], x[link.q + 3])
            .normalized();
      };
      const auto turn = rotation(q) * rotation(reference_).conjugate();
      Eigen::VectorXd away = log_rotation<Extended>(turn).template cast<double>();
      away -= arbitrary * (arbitrary.transpose() * away);
      worst = std::max(worst, away.norm());
      continue;
    }
    Extended away = Extended(q[link.q]) - reference_[link.q];
    if (turns_freely(system_, parameters_, static_cast<int>(l))) {
      constexpr Extended turn = 2 * std::numbers::pi_v<Extended>;
      away -= turn * std::round(static_cast<double>(away / turn));
    }
    worst = std::max(worst, std::abs(static_cast<double>(away)) / scaling_.column[link.v]);
  }
  return worst;
}

std::vector<double> DirectSolution::measure_errors(const Eigen::VectorXd& q) {
  if (measures_.empty()) return {};
  const Eigen::VectorXd away = (measures_.evaluate_at(problem(), q, w_) - measured_).cwiseAbs();
  return {away.begin(), away.end()};
}

bool DirectSolution::iterate(int count, Unknowns& z) {
  z.q = drawn_;
  z.lambda.setZero(system_.rows);
  return newton(problem(), z, w_, {count, false}, nullptr).converged;
}

Problem DirectSolution::classified() const {
  Problem p = problem();
  if (system_.nv <= largest_for_eigenvalues) p.form = KktForm::dense;
  return p;
}

bool DirectSolution::answer_turned(Unknowns& z) {
  turned_ = find_turned_state({system_, parameters_, scaling_, cancel_}, drawn_, w_);
  if (!turned_) return false;
  parameters_ = at_angles_of(as_drawn_, *turned_);
  z = turned_->z;
  stability_ = find_stability(factor_at({system_, parameters_, scaling_, cancel_}, z, w_), false);
  return true;
}

void DirectSolution::take_neutral(const Unknowns& z) {
  arbitrary_.clear();
  for (const Link& link : system_.links)
    arbitrary_.emplace_back(link.type == LinkType::spherical ? 3 : 1, 0);
  if (stability_.neutral.empty()) return;
  NeutralDirections neutral;
  if (const Problem p = classified(); p.form == KktForm::dense) {
    const FactoredState at = factor_at(p, z, w_);
    neutral = neutral_directions(at, w_.dense.constraints().basis() * w_.dense.hessian().null_basis());
  }
  const bool directed = neutral.coordinates == stability_.neutral;
  for (std::size_t l = 0; l < system_.links.size(); ++l) {
    const int v = system_.links[l].v;
    Eigen::MatrixXd& arbitrary = arbitrary_[l];
    const auto count = static_cast<int>(arbitrary.rows());
    if (v < 0 || std::ranges::none_of(stability_.neutral, [&](int i) { return i >= v && i < v + count; }))
      continue;
    arbitrary = Eigen::MatrixXd::Identity(count, count);
    if (!directed) continue;
    if (const auto turns = singular_vectors(neutral.directions.middleRows(v, count).transpose()))
      arbitrary = turns->right.leftCols((turns->values.array() > tolerance::takes_part).count());
  }
}

void DirectSolution::settle_turned_reference(Comparison& out) {
  Unknowns z = turned_->z;
  take_neutral(z);
  reference_ = z.q.cast<Extended>();
  Configuration<Extended> step;
  Eigen::VectorXd correction = Eigen::VectorXd::Zero(system_.nv);
  double previous = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 12; ++i) {
    const Problem at{system_, parameters_, scaling_, cancel_};
    const TurnedBalance balance(at, z, turned_->ties, mechanism_, w_);
    if (!balance.usable()) break;
    w_.q_extended = reference_;
    w_.lambda_extended = Configuration<Extended>::Zero(system_.rows);
    evaluate_extended(at, w_);
    const auto solved =
        solve_square(balance.matrix(), -balance.left_of(w_.residual_extended.f.cast<double>(),
                                                        w_.residual_extended.phi.cast<double>()));
    if (!solved) break;
    const Eigen::Index angles = balance.angles();
    const double size = largest_size(solved->head(system_.nv + angles));
    out.reference_error = size;
    out.reference_residual = balance.residual();
    if (!std::isfinite(size) || (i > 1 && size >= previous / 2)) break; // rounding is all that is left
    correction = solved->head(system_.nv).cwiseProduct(scaling_.column);
    step = correction.cast<Extended>();
    retract<Extended>(system_, step, reference_);
    turn_along(turned_->ties, solved->segment(system_.nv, angles), turned_->starts);
    parameters_ = at_angles_of(as_drawn_, *turned_);
    z = {reference_.cast<double>(), balance.lambda_of(solved->tail(balance.multipliers()))};
    previous = size;
  }
  tell_reference(correction, out);
}

void DirectSolution::tell_reference(const Eigen::VectorXd& correction, Comparison& out) {
  const Eigen::VectorXd q = reference_.cast<double>();
  forward<double>(system_, parameters_, q, 0, w_.kinematics);
  out.reference = coordinate_solutions(system_, parameters_, q, correction.cwiseAbs(), w_.kinematics);
  measured_ = measures_.evaluate_at(problem(), q, w_);
}

} // namespace flyball
