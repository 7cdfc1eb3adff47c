#include "engine/solve/slow_motion.hpp"

#include "engine/kkt/speed_time.hpp"
#include "engine/linear/interruption.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

class SlowMotion {
 public:
  SlowMotion(const Problem& problem, Unknowns& z, Workspace& w) : p_(problem), z_(z), w_(w) {
    const double unit = speed_time(p_);
    weight_.setOnes(p_.system.nv);
    for (const Link& link : p_.system.links)
      if (link.v >= 0 && finds_speed(link)) weight_[link.v] = unit;
    square_ = unit * unit;
    time_ = first_time * square_;
  }

  // To where it all but rests, or as far as it is followed; whether it got there.
  bool run() {
    evaluate_with_multipliers(p_, z_, w_);
    for (iterations_ = 0; iterations_ < most_steps() && !p_.cancelled(); ++iterations_) {
      if (!std::isfinite(scaled_residual(p_, w_)) || runs_away()) return false;
      interruption_point();
      w_.kkt(p_).linearize(p_, z_, w_);
      if (!take_step()) return false;
      if (rests_) return true;
    }
    return false;
  }

  int iterations() const { return iterations_; }

 private:
  static constexpr double longest = 0.3;     // scaled, or of the speed
  static constexpr double first_time = 1e-3; // of the square of speed_time()

  // Bounded so that a refusal takes no more than a second or so.
  int most_steps() const { return p_.system.nv <= 30 || p_.form != KktForm::dense ? 3000 : 300; }

  // It may go far beyond where it comes to: its steps are parts of the speed.
  bool runs_away() const {
    constexpr double beyond = 1e4;
    return std::ranges::any_of(p_.system.links, [&](const Link& link) {
      return finds_speed(link) && std::abs(z_.q[link.q]) > beyond * largest_found_speed(p_, link);
    });
  }

  Eigen::VectorXd energies(const Eigen::VectorXd& f) const {
    return f.cwiseProduct(p_.scaling.column).cwiseProduct(weight_);
  }

  // Of a step, each speed by how large it is already.
  double length(const Eigen::VectorXd& step) const {
    double most = 0;
    for (const Link& link : p_.system.links) {
      if (link.v < 0) continue;
      const int n = link.type == LinkType::spherical ? 3 : 1;
      const double unit =
          finds_speed(link) ? std::max(1., std::abs(z_.q[link.q]) / p_.scaling.column[link.v]) : 1;
      most = std::max(most, step.segment(link.v, n).lpNorm<Eigen::Infinity>() / unit);
    }
    return most;
  }

  // From a linearised state. Shortens the time of the step until the balance beyond is what the model says,
  // and lengthens that of the next where it was so with ease.
  bool take_step() {
    KktSystem& kkt = w_.kkt(p_);
    const Eigen::VectorXd f = w_.residual.f, phi = w_.residual.phi;
    const Unknowns begin = z_;
    const double least_time = 1e-30 * square_, most_time = 1e12 * square_;
    constexpr double least_size =
        1e-12; // scaled: what is not as the model says so near is not to be followed
    for (; time_ > least_time; time_ /= 4) {
      kkt.factor(1 / time_);
      if (!kkt.known() || (p_.symmetric_at_speeds() && !w_.speeds.is_definite())) continue;
      newton_step(p_, f, phi, w_, w_.scaled_step, w_.trial.lambda);
      const double size = length(w_.scaled_step);
      if (!(size <= longest)) continue;
      kkt.metric_of_solution(w_.scaled_step, resisted_);
      resisted_ = resisted_.cwiseProduct(weight_);
      const double inertia = resisted_.dot(w_.scaled_step), pulled = -energies(f).dot(w_.scaled_step);
      if (pulled < inertia / (2 * time_)) continue; // see slow_motion.hpp
      w_.step = w_.scaled_step.cwiseProduct(p_.scaling.column);
      z_.q = begin.q;
      retract<double>(p_.system, w_.step, z_.q);
      z_.lambda = begin.lambda + w_.trial.lambda;
      evaluate(p_, z_, 0, w_);
      // By the model -W x / h is left of the balance.
      const Eigen::VectorXd left = energies(w_.residual.f), model = -resisted_ / time_;
      const double before = energies(f).norm();
      const double wrong = (left - model).norm() / std::max(before, 1e-300);
      const bool at_rest = size < 1e-6 && scaled_residual(p_, w_) < tolerance::near_balance;
      if (wrong > 0.3 && !at_rest) {
        if (size < least_size) return false;
        continue;
      }
      if (wrong < 0.1 && size < longest / 3) time_ = std::min(3 * time_, most_time);
      rests_ = at_rest;
      return true;
    }
    return false;
  }

  const Problem& p_;
  Unknowns& z_;
  Workspace& w_;
  Eigen::VectorXd weight_;   // what makes energies of the rows: 1, of speeds a time
  Eigen::VectorXd resisted_; // W x of a step, as energies
  double square_ = 1;        // s^2, of that time
  double time_ = 0;          // s^2, as W is an inertia: pseudo-time of the next step
  int iterations_ = 0;
  bool rests_ = false;
};

} // namespace

NewtonOutcome follow_slow_motion(const Problem& problem, Unknowns& z, Workspace& w,
                                 std::vector<double>* history) {
  NewtonOutcome outcome;
  if (!assemble(problem, z.q, 0, w)) return outcome;
  SlowMotion motion(problem, z, w);
  const bool rests = motion.run();
  if (rests) outcome = newton(problem, z, w, {}, history);
  outcome.iterations += motion.iterations();
  outcome.converged = outcome.converged && outcome.largest_step < 0.1;
  return outcome;
}

} // namespace flyball
