#include "engine/solve/trust_region.hpp"

#include "engine/linear/largest.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/solve/tolerances.hpp"

namespace flyball {
namespace {

// rad. A body that turns further is nowhere near where the model puts it. As long as light bodies, the last
// links of a chain, leave the rest alone it is they that are limited and not the whole step that is
// shortened: so it takes no more iterations for many links than for few.
constexpr double farthest_turn = 1;

class TrustRegion {
 public:
  TrustRegion(const Problem& problem, Unknowns& z, Workspace& w, std::vector<double>* history)
      : p_(problem), z_(z), w_(w), kkt_(w.kkt(problem)), history_(history) {}

  DescentOutcome run(bool all_the_way, bool falls) {
    indefinite_ = falls;
    if (falls) {
      potential_ = lagrangian(z_.q);
      take_in();
    } else {
      linearize_here();
    }
    unit_ = std::sqrt(kkt_.mass()) * p_.parameters.length;
    radius_ = 0.5 * unit_;
    double travelled = 0;
    int shortened = 0;
    for (int i = 0; i < 1000; ++i) {
      if (p_.cancelled()) return {DescentEnd::cancelled, i};
      if (shortened == 0)
        choose_step();
      else
        shorten_step(0.25);
      const double size = step_.lpNorm<Eigen::Infinity>();
      if (shortened == 0 && (shift_ == 0 || prefers_short_step_) && size < tolerance::converged_step)
        return {DescentEnd::minimum, i, kkt_.shift() == 0 && !convex_model_tried_};
      if (!(predicted_ > 0) || !std::isfinite(size))
        return {size < tolerance::stalled_step ? DescentEnd::minimum : DescentEnd::stalled, i};
      Trial trial = move(1);
      // A long step for nothing: along what nothing resists, where rounding looks like curvature.
      if (!measurable(trial) && size > tolerance::short_step && small_forces())
        return {DescentEnd::minimum, i};
      if (p_.system.rows == 0) look_back(trial);
      const double rounding = trial.rounding, gain = potential_.value - trial.potential.value;
      // Where the potential cannot judge the model is as good as exact.
      const double ratio = measurable(trial) ? gain / predicted_ : 1;
      if (!measurable(trial) && std::abs(gain) > 10 * rounding)
        radius_ = length_ / 4;
      else if (!trial.closed || !(ratio > 0.25))
        radius_ = length_ / 4;
      else if (ratio > 0.7 && length_ > 0.8 * radius_)
        radius_ = std::min(2 * radius_, 2 * unit_);
      if (trial.closed && std::isfinite(trial.potential.value) && ratio > 0.1 && gain > -10 * rounding) {
        z_.q = moved_;
        travelled += length_;
        if (travelled > 400 * unit_) return {DescentEnd::unbounded, i};
        compression_decides_ = convex_model_tried_ && !(ratio > 0.8 && ratio < 1.25);
        const bool model_serves = shift_ == 0 && !convex_model_tried_ && std::abs(ratio - 1) < 0.1;
        if (!all_the_way && model_serves) {
          if (p_.system.rows > 0 && size < tolerance::newton_leads_step && newton_leads())
            return {DescentEnd::near, i + 1};
          // The speeds will be others, and the rest of the way goes elsewhere.
          if (!p_.system.torques.empty() && size < tolerance::speeds_lead_step)
            return {DescentEnd::minimum, i + 1};
        }
        arrive(trial.potential);
        shortened = 0;
      } else {
        if (radius_ < tolerance::least_radius * unit_) return {DescentEnd::stalled, i};
        // What is wrong with a step is mostly its length; in the end the direction has to turn, too.
        shortened = (shortened + 1) % 3;
        if (shortened == 0) evaluate(p_, z_, 0, w_);
      }
    }
    return {DescentEnd::stalled, 1000};
  }

 private:
  // Where a step, or a part of it, led to: moved_, with its kinematics.
  struct Trial {
    Potential potential;
    double rounding = 0; // of the difference of its potential and that here
    bool closed = false; // the loops followed
  };

  Trial move(double part) {
    Trial trial;
    moved_ = z_.q;
    w_.step = part * step_.cwiseProduct(p_.scaling.column);
    retract<double>(p_.system, w_.step, moved_);
    forward<double>(p_.system, p_.parameters, moved_, 0, w_.kinematics);
    trial.closed = close_loops();
    trial.potential = lagrangian(moved_);
    trial.rounding = tolerance::potential_rounding * (potential_.magnitude + trial.potential.magnitude);
    return trial;
  }

  // Below rounding the potential cannot judge.
  bool measurable(const Trial& trial) const { return predicted_ > 10 * trial.rounding; }

  // Those of a saddle, or of what nothing resists.
  bool small_forces() const { return gradient_.lpNorm<Eigen::Infinity>() < tolerance::small_force * force_; }

  // A step that gains clearly less than foreseen went too far: the parabola through the potential's value and
  // slope here and its value there tells how far, and where that is lower it is the step.
  void look_back(Trial& trial) {
    const double gain = potential_.value - trial.potential.value, slope = gradient_.dot(step_);
    if (!measurable(trial) || small_forces() || !(gain < 0.8 * predicted_)) return;
    const double lowest = slope / (2 * (slope + gain)); // of the parabola, as a part of the step
    if (!(lowest > 0.1 && lowest < 0.95)) return;
    const Trial nearer = move(lowest);
    if (nearer.potential.value < trial.potential.value) {
      trial = nearer;
      shorten_step(lowest);
    } else {
      trial = move(1);
    }
  }

  // The potential, and what the loops are still open by at the price of their multipliers.
  Potential lagrangian(const Eigen::VectorXd& q) {
    Potential out = amended_potential(p_.system, p_.parameters, q, w_.kinematics);
    if (p_.system.rows > 0) out.value += z_.lambda.dot(w_.residual.phi);
    return out;
  }

  // Steps along the loops open them by a little. By the factors at hand as long as they serve, and no further
  // than it takes to judge the step.
  bool close_loops() {
    if (p_.system.rows == 0) return true;
    double before = std::numeric_limits<double>::infinity();
    constraints_are_factored_ = false;
    int slow = 0;
    const double enough = 0.01 * predicted_;
    for (int i = 0; i < 30; ++i) {
      evaluate_constraints<double>(p_.system, p_.parameters, moved_, w_.kinematics, w_.residual.phi);
      const double open = w_.residual.phi.cwiseProduct(p_.scaling.row).lpNorm<Eigen::Infinity>();
      if (open < tolerance::closed_on_descent) return true;
      if (open < tolerance::almost_closed_on_descent &&
          w_.residual.phi.cwiseAbs().dot(z_.lambda.cwiseAbs()) < enough)
        return true;
      if (!(open < 2 * before) || (!(open < 0.5 * before) && ++slow > 3))
        return open <
               std::max(tolerance::slowly_closed, std::min(2 * open_, tolerance::slowly_closed_at_most));
      if (!(open < 0.1 * before) && i > 0) {
        factor_constraints(p_, w_);
        constraints_are_factored_ = true;
      }
      before = open;
      close(p_, w_, w_.scaled_step);
      if (!(w_.scaled_step.lpNorm<Eigen::Infinity>() < 1)) return false;
      w_.step = w_.scaled_step.cwiseProduct(p_.scaling.column);
      retract<double>(p_.system, w_.step, moved_);
      forward<double>(p_.system, p_.parameters, moved_, 0, w_.kinematics);
    }
    return false;
  }

  // Whether the step left little of the forces with the multipliers that came with it, as Newton-Raphson's
  // do near a solution. Then they are z_'s.
  bool newton_leads() {
    const Eigen::VectorXd before = z_.lambda;
    z_.lambda += multipliers_.cwiseProduct(p_.scaling.row);
    evaluate_forces(p_, z_, w_);
    const double left = w_.residual.f.cwiseProduct(p_.scaling.column).lpNorm<Eigen::Infinity>();
    if (left < 0.3 * gradient_.lpNorm<Eigen::Infinity>()) return true;
    z_.lambda = before;
    return false;
  }

  // At z_, where the kinematics are those of the step taken there; with its potential. Constraints factored
  // to close the loops serve once more where they were of almost there: they are off by what the loops were
  // open, and the multipliers bend the model by as little. Each step finds their forces anew.
  void arrive(const Potential& here) {
    potential_ = here;
    if (p_.system.rows > 0) {
      z_.lambda.setZero();
      evaluate_residual<double>(p_.system, p_.parameters, z_.q, z_.lambda, w_.kinematics, w_.residual);
      if (!constraints_are_factored_) factor_constraints(p_, w_);
      best_multipliers(p_, w_, z_.lambda);
      potential_ = lagrangian(z_.q);
    }
    evaluate_forces(p_, z_, w_);
    linearize_evaluated();
  }

  void linearize_here() {
    evaluate_with_multipliers(p_, z_, w_);
    potential_ = lagrangian(z_.q);
    linearize_evaluated();
  }

  void linearize_evaluated() {
    take_in();
    kkt_.linearize(p_, z_, w_);
  }

  // What has been evaluated at z_.
  void take_in() {
    if (history_) history_->push_back(scaled_residual(p_, w_));
    gradient_ = w_.residual.f.cwiseProduct(p_.scaling.column);
    sizes_ = w_.magnitudes.force.cwiseProduct(p_.scaling.column);
    for (const DriveTorqueElement& torque : p_.system.torques) { // speeds stay as they are
      const int v = p_.system.links[static_cast<std::size_t>(torque.link)].v;
      gradient_[v] = sizes_[v] = 0;
    }
    force_ = largest(sizes_);
    open_ = p_.system.rows == 0 ? 0 : w_.residual.phi.cwiseProduct(p_.scaling.row).lpNorm<Eigen::Infinity>();
    convex_model_tried_ = false;
    least_shift_ = 0;
  }

  // The step for K + shift W; true where that is positive definite, apart from directions that nothing
  // resists and nothing pushes.
  bool solve_with(double shift) {
    kkt_.factor(shift);
    if (kkt_.negative_count() > 0) return false;
    for (const KktSystem::NullDirection& direction : kkt_.null_directions()) {
      double push = 0;
      for (const auto& [v, share] : direction)
        push += share * gradient_[v];
      if (std::abs(push) > tolerance::neutral_force * force_) return false;
    }
    shift_ = shift;
    rhs_ = -gradient_;
    kkt_.solve(rhs_, step_);
    multipliers_ = kkt_.multipliers();
    const bool limited = kkt_.limit_turns(farthest_turn, step_);
    length_ = std::sqrt(kkt_.metric_of_solution(step_, metric_step_));
    // Limited turns promise more; along the rest the model has come to its end.
    predicted_ = (-gradient_.dot(step_) + (limited ? 0 : shift * length_ * length_)) / 2;
    return std::isfinite(length_);
  }

  // The same direction, `t` as far.
  void shorten_step(double t) {
    const double slope = gradient_.dot(step_), curvature = -2 * (slope + predicted_);
    step_ *= t;
    multipliers_ *= t;
    length_ *= t;
    predicted_ = -t * (slope + t * curvature / 2);
  }

  // Minimises the model within the radius, by 25 % of it: the exact one where it is convex, else the convex
  // one as long as that leads somewhere. Where only the lowest curvature prevents a longer step, the
  // shorter one has to do.
  void choose_step() {
    double low = least_shift_, high = 0; // the shift sought lies between, once high is known
    bool low_definite = false, sought = false;
    prefers_short_step_ = false;
    // Where the convex model was far off the exact one still is not convex, as a rule.
    const bool in_vain = indefinite_ || (compression_decides_ && exact_model_skips_ < 2);
    exact_model_skips_ = in_vain ? exact_model_skips_ + 1 : 0;
    indefinite_ = false;
    if (low == 0 && !in_vain && solve_with(0)) {
      if (length_ <= 1.25 * radius_) return;
      low_definite = true;
    } else if (!convex_model_tried_ && kkt_.linearize_convex(p_, z_, w_)) {
      convex_model_tried_ = true;
      least_shift_ = low = 0;
      low_definite = solve_with(0);
      if (low_definite && step_.lpNorm<Eigen::Infinity>() < tolerance::saddle_step) {
        kkt_.linearize(p_, z_, w_);
        low_definite = false;
      } else if (low_definite && length_ <= 1.25 * radius_) {
        return;
      }
    }
    double shift = low_definite ? low + newton_on_length()
                   : last_shift_ > 0
                       ? std::max(last_shift_, 2 * low)
                       : std::max(std::max(potential_.magnitude, force_) / (unit_ * unit_), 1e-300);
    for (int tries = 0; tries < 100; ++tries) {
      if (!solve_with(shift)) {
        least_shift_ = low = std::max(low, shift);
        low_definite = false;
      } else if (length_ > 1.25 * radius_) {
        low = shift;
        low_definite = true;
      } else if (length_ < 0.75 * radius_) {
        high = shift;
        // The curvature along the step is not below the lowest.
        if (const double least = shift + gradient_.dot(step_) / (length_ * length_); least > low) {
          low = least;
          low_definite = false;
        }
      } else {
        break;
      }
      // Close above the lowest curvature a longer step would go along it, and that is a motion of some corner
      // of the mechanism rather than of the forces, or of none at all.
      if (high > 0 && !low_definite && high < 4 * low && shift_ == high) {
        if (length_ > 0.01 * radius_ && !small_forces()) break;
        // To look here spares nets some factors.
        if (p_.system.rows > 0 && !sought) {
          sought = true;
          find_lowest_direction();
          prefers_short_step_ = falls_by_coordinates();
          if (prefers_short_step_) break;
        }
      }
      // Without forces to speak of it is the direction to take, if there is one.
      if (high > 0 && !low_definite && high < 1.2 * low) {
        if (shift_ != high || shift != high) solve_with(high);
        last_shift_ = high;
        find_lowest_direction();
        prefers_short_step_ = falls_by_coordinates();
        if (!prefers_short_step_) add_negative_curvature();
        return;
      }
      const double next = shift_ == shift ? shift + newton_on_length() : 0;
      if (high == 0)
        shift = next > shift ? std::min(next, 100 * shift) : 8 * shift;
      else if (next > low && next < high && tries % 3 != 2)
        shift = next;
      else
        shift = low > 0 && high > 4 * low   ? std::sqrt(low * high)
                : low == 0 && !low_definite ? high / 16
                                            : (low + high) / 2;
    }
    last_shift_ = shift_;
  }

  // What to add to the shift for a step as long as the radius, by Newton's method on 1/length.
  double newton_on_length() {
    kkt_.solve(metric_step_, other_);
    const double decline = metric_step_.dot(other_);
    return decline > 0 ? length_ * length_ / decline * (length_ - radius_) / radius_ : 0;
  }

  // The direction of lowest curvature, of metric length 1, by inverse iteration with the factor at hand,
  // which is nearly singular.
  void find_lowest_direction() {
    std::mt19937 random(7);
    lowest_.resize(step_.size());
    for (double& x : lowest_)
      x = uniform(random, -1, 1);
    double size = std::sqrt(kkt_.metric(lowest_, other_));
    for (int i = 0; i < 6; ++i) {
      lowest_image_ = other_ / size;
      kkt_.solve(lowest_image_, lowest_);
      size = std::sqrt(kkt_.metric_of_solution(lowest_, other_));
    }
    lowest_ /= size;
    lowest_image_ /= size;
  }

  // Away from balance curvatures of the size of the forces come and go with the choice of coordinates, as
  // along turns that nothing resists: bent coordinates q = r + C(r, r) / 2 add C of the gradient to them.
  bool falls_by_coordinates() const {
    const double fall = kkt_.shift() - lowest_image_.dot(lowest_);
    return fall < 2 * gradient_.norm() * lowest_.squaredNorm();
  }

  // To the edge of the region along the direction of lowest curvature.
  void add_negative_curvature() {
    const Eigen::VectorXd &v = lowest_, &image = lowest_image_;
    const double along = v.dot(metric_step_);
    const double room = std::sqrt(along * along + std::max(0., radius_ * radius_ - length_ * length_));
    // The two steps to the edge of the region: the lower one, or where they are alike the one that takes the
    // coordinate that moves most up.
    double steps[2] = {-along + room, -along - room};
    Eigen::Index most = 0;
    v.cwiseAbs().maxCoeff(&most);
    if (v[most] < 0) std::swap(steps[0], steps[1]);
    const double slope = gradient_.dot(v);
    double best = 0, most_gained = -std::numeric_limits<double>::infinity();
    const double stiffness = image.dot(v); // of v in K + shift W
    const double image_step = image.dot(step_);
    for (double t : steps) {
      const double quadratic =
          -gradient_.dot(step_) + 2 * t * image_step + t * t * stiffness - shift_ * radius_ * radius_;
      const double gained = -(gradient_.dot(step_) + t * slope) - quadratic / 2;
      if (gained > most_gained + 1e-9 * std::abs(gained)) {
        most_gained = gained;
        best = t;
      }
    }
    step_ += best * v;
    length_ = radius_;
    predicted_ = most_gained;
  }

  const Problem& p_;
  Unknowns& z_;
  Workspace& w_;
  KktSystem& kkt_;
  std::vector<double>* history_;
  Eigen::VectorXd gradient_, sizes_, rhs_, step_, metric_step_, other_, moved_;
  Eigen::VectorXd multipliers_;           // their change by the step, scaled
  Eigen::VectorXd lowest_, lowest_image_; // of lowest curvature, and what was factored times it
  Potential potential_;
  double open_ = 0; // the loops, at z_, scaled
  double force_ = 0, unit_ = 1, radius_ = 0, length_ = 0, predicted_ = 0;
  double shift_ = 0, last_shift_ = 0;
  double least_shift_ = 0;           // below this K + shift W is known not to be positive definite
  bool convex_model_tried_ = false;  // the convex model was tried here
  bool indefinite_ = false;          // the exact model is known not to be convex here
  bool compression_decides_ = false; // in the last step, by the convex model, which leaves it out
  int exact_model_skips_ = 0;        // times in a row that the exact model was not tried
  bool constraints_are_factored_ =
      false; // the constraints were factored on the way of closing the last step's loops
  bool prefers_short_step_ = false; // to a longer one along a negative curvature that coordinates make
};

} // namespace

bool has_descent(const Problem& problem) {
  return (problem.system.conservative && (problem.symmetric() || problem.form == KktForm::dense)) ||
         problem.symmetric_at_speeds();
}

DescentOutcome descend(const Problem& problem, Unknowns& z, Workspace& w, std::vector<double>* history,
                       bool all_the_way, bool falls) {
  Problem potential = problem;
  potential.as_gradient = true;
  // Which limits turns, and keeps light parts beside heavy ones apart.
  if (is_plain_tree(problem.system) && problem.system.single_drives) potential.form = KktForm::tree;
  DescentOutcome outcome = TrustRegion(potential, z, w, history).run(all_the_way, falls);
  outcome.factored = outcome.factored && potential.form == problem.form && problem.symmetric();
  return outcome;
}

} // namespace flyball
