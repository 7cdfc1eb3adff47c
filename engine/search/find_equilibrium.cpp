#include "engine/search/find_equilibrium.hpp"

#include "engine/kkt/configuration_difference.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/solve/eigenvector_descent.hpp"
#include "engine/solve/homotopy.hpp"
#include "engine/solve/slow_motion.hpp"
#include "engine/solve/trust_region.hpp"
#include "engine/stability/gyroscopic_stability.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flyball {
namespace {

// Moves what hangs loose between its stops to those that the forces there push it to, into which it sinks as
// deep as holds them; false where there is nothing of the kind. Loops may open by that.
bool press_against_stops(const Problem& problem, Eigen::VectorXd& q, Workspace& w) {
  Unknowns z{q, {}};
  bool evaluated = false, pressed = false;
  double size = 0;
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0 || link.type == LinkType::spherical || finds_speed(link)) continue;
    const CoordinateForce& force = problem.parameters.links[l].force[0];
    if (!(force.stop_stiffness > 0) || force.has_spring() || force.touched(q[link.q])) continue;
    if (!evaluated) {
      evaluate_with_multipliers(problem, z, w);
      size = w.magnitudes.force.cwiseProduct(problem.scaling.column).lpNorm<Eigen::Infinity>();
      evaluated = true;
    }
    const double push = -w.residual.f[link.v];
    if (!(std::abs(push) * problem.scaling.column[link.v] > tolerance::neutral_force * size)) continue;
    if (push > 0 ? !force.has_upper : !force.has_lower) continue;
    q[link.q] = (push > 0 ? force.upper : force.lower) + push / force.stop_stiffness;
    pressed = true;
  }
  return pressed;
}

class EquilibriumSearch {
 public:
  EquilibriumSearch(const Problem& problem, const Eigen::VectorXd& start, bool nearest, bool warm,
                    bool newton_only, Workspace& w, std::vector<double>& history, Found& found)
      : p_(problem), start_(start), nearest_(nearest), warm_(warm), newton_only_(newton_only),
        large_(problem.form != KktForm::dense), descends_(!nearest && has_descent(problem)),
        at_speeds_(problem.symmetric_at_speeds()), w_(w), history_(history), found_(found) {
    found_.status = Status::not_converged;
    found_.remark = Remark::none;
    found_.fallback.reset();
    found_.iterations = 0;
    found_.open_cut = -1;
    found_.candidates = 0;
    found_.minimum = found_.unbounded = false;
    found_.descended = descends_ && !at_speeds_;
    history_.clear();
  }

  // True where an answer was found; else the status is infeasible or not_converged.
  bool run() {
    assemble_start(); // first, since closing loops takes the factors
    if (newton_raphson()) return true;
    if (newton_only_) return settle_for_unstable();
    if (!close_loops()) return false;
    if (against_stops()) return true;
    if (large_ && downhill()) return true;
    if (at_speeds_ && gives_up_ && plain_newton_raphson()) return true;
    if (damped_newton() || from_rest() || slow_motion()) return true;
    if (!large_ && downhill()) return true;
    return settle_for_unstable();
  }

 private:
  // The energy that no answer may exceed.
  void assemble_start() {
    if (!p_.system.conservative || nearest_ || warm_) return;
    w_.assembled = start_;
    if (assemble(p_, w_.assembled, 0, w_)) start_energy_ = energy_at(w_.assembled);
  }

  bool newton_raphson() {
    NewtonSettings plain;
    plain.impatient = large_;
    plain.trusting = warm_;
    // Where the descent comes next it leads to a minimum with fewer steps.
    plain.to_minimum = gives_up_ = descends_ && large_ && !warm_ && !(at_speeds_ && newton_only_);
    return attempt(start_, std::nullopt, [&](Unknowns& z) { return newton_as_begun(z, plain); });
  }

  // From the start all the way, where it was given up for a descent at given speeds that led to no answer.
  bool plain_newton_raphson() {
    NewtonSettings plain;
    plain.impatient = true;
    return !arrived_ && attempt(start_, std::nullopt, [&](Unknowns& z) { return newton_as_begun(z, plain); });
  }

  bool turned_round(const Link& link, const Eigen::VectorXd& q) const {
    return finds_speed(link) && start_[link.q] * q[link.q] < 0;
  }
  // How many speeds that are found became ones the other way.
  std::ptrdiff_t count_turned_round(const Eigen::VectorXd& q) const {
    return std::ranges::count_if(p_.system.links, [&](const Link& link) { return turned_round(link, q); });
  }

  // Newton-Raphson may step over a standstill, and what depends on a speed through centrifugal forces alone
  // has a mirror image there: then once more from where speeds have the signs that they began with.
  NewtonOutcome newton_as_begun(Unknowns& z, const NewtonSettings& settings) {
    const NewtonOutcome outcome = newton(p_, z, w_, settings, &history_);
    const std::ptrdiff_t turned = outcome.converged ? count_turned_round(z.q) : 0;
    if (turned == 0) return outcome;
    Unknowns mirrored = z;
    for (const Link& link : p_.system.links)
      if (turned_round(link, z.q)) mirrored.q[link.q] = -z.q[link.q];
    const std::size_t recorded = history_.size();
    NewtonOutcome again = newton(p_, mirrored, w_, settings, &history_);
    if (again.converged && count_turned_round(mirrored.q) < turned && same_assembly_mode(p_, w_.kinematics)) {
      z = std::move(mirrored);
      again.iterations += outcome.iterations;
      again.largest_step = std::max(again.largest_step, outcome.largest_step);
      return again;
    }
    history_.resize(recorded);
    factor_at(p_, z, w_);
    return outcome;
  }

  // Within its play nothing holds a coordinate, and Newton's step along it means nothing.
  bool against_stops() {
    if (arrived_) return false;
    Eigen::VectorXd pressed = w_.assembled;
    return press_against_stops(p_, pressed, w_) &&
           attempt(pressed, Fallback::stops, [&](Unknowns& z) { return newton(p_, z, w_, {}, &history_); });
  }

  bool damped_newton() {
    return !arrived_ && attempt(w_.assembled, Fallback::damped, [&](Unknowns& z) {
      return newton(p_, z, w_, {200, true}, &history_);
    });
  }

  // By homotopy in the squared speeds.
  bool from_rest() {
    return !arrived_ && p_.parameters.moving && attempt(w_.assembled, Fallback::homotopy, [&](Unknowns& z) {
      return homotopy(p_, z, w_, &history_);
    });
  }

  // To where what torques drive goes from the start.
  bool slow_motion() {
    return !arrived_ && !p_.system.torques.empty() &&
           attempt(w_.assembled, Fallback::slow_motion,
                   [&](Unknowns& z) { return follow_slow_motion(p_, z, w_, &history_); });
  }

  bool downhill() {
    if (!descends_) return false;
    const auto by_trust_region = [&](bool all_the_way) {
      const bool indefinite = starts_indefinite_ && !all_the_way && w_.assembled == start_;
      return descend(p_, found_.z, w_, &history_, all_the_way, indefinite);
    };
    const auto by_eigenvectors = [&](bool) { return descend_by_eigenvectors(p_, found_.z, w_, &history_); };
    if (downhill(by_trust_region)) return true;
    throw_if_cancelled();
    if (!large_ && downhill(by_eigenvectors)) return true;
    throw_if_cancelled();
    return false;
  }

  // Solvers end early where they are cancelled, and what they leave is no result.
  void throw_if_cancelled() const {
    if (p_.cancelled()) throw Interrupted();
  }

  // Runs a solver from q; true when its answer is admissible.
  template <class Solver>
  bool attempt(const Eigen::VectorXd& q, std::optional<Fallback> fallback, Solver solver) {
    found_.z.q = q;
    found_.z.lambda.setZero(p_.system.rows);
    const NewtonOutcome outcome = solver(found_.z);
    found_.iterations += outcome.iterations;
    starts_indefinite_ = outcome.falls && outcome.iterations == 0;
    if (!outcome.converged || !same_assembly_mode(p_, w_.kinematics)) {
      throw_if_cancelled();
      return false;
    }
    arrived_ = true;
    found_.newton = outcome;
    found_.fallback = fallback;
    if (!is_admissible(outcome)) {
      throw_if_cancelled();
      if (candidate_.q.size() == 0) {
        candidate_ = found_.z;
        candidate_outcome_ = outcome;
        candidate_fallback_ = fallback;
      }
      return false;
    }
    found_.status = Status::converged;
    return true;
  }

  // Leaves the kinematics of q behind.
  Potential energy_at(const Eigen::VectorXd& q) {
    forward<double>(p_.system, p_.parameters, q, 0, w_.kinematics);
    return amended_potential(p_.system, p_.parameters, q, w_.kinematics);
  }

  // Whether the evaluated state found has no more energy than another, within rounding.
  bool below(const Potential& begin) const {
    const Potential end = amended_potential(p_.system, p_.parameters, found_.z.q, w_.kinematics);
    return end.value <= begin.value + tolerance::energy_rounding * (begin.magnitude + end.magnitude);
  }

  bool below_assembled() {
    const Potential begin = energy_at(w_.assembled);
    evaluate(p_, found_.z, 0, w_);
    return below(begin);
  }

  // A minimum not above the assembled start, reached without a leap that may have crossed a ridge. Systems
  // without a potential have no such order; their eigenvalues judge.
  bool is_admissible(const NewtonOutcome& outcome) {
    classify(!found_.fallback && still_factored(outcome));
    if (nearest_ || !potential_) return true;
    if (unstable_) return drawn_at_gyroscopic_state();
    if (outcome.largest_step > 1) return false;
    return !start_energy_ || below(*start_energy_);
  }

  // A mechanism drawn at a state from which the potential falls, but that gyroscopic forces keep, stays
  // there.
  bool drawn_at_gyroscopic_state() {
    if (found_.fallback || !start_energy_ || !same(found_.z.q, w_.assembled)) return false;
    return is_gyroscopically_stable(p_, found_.z, w_.elsewhere());
  }

  // Whether Newton-Raphson's last step was rounding, and taken from a balance with these multipliers: then
  // the factors that it used are those of the state found.
  bool still_factored(const NewtonOutcome& outcome) const {
    const double rounding = large_ ? tolerance::still_factored_large : tolerance::still_factored;
    return !outcome.linear && outcome.last_step < rounding && history_.size() >= 2 &&
           history_[history_.size() - 2] < rounding;
  }

  // Whether the state found is a minimum, from the balance factored at it.
  void classify(bool factored = false) {
    if (!factored) factor(p_, found_.z, w_);
    if (p_.symmetric()) {
      potential_ = true;
      KktSystem& kkt = w_.kkt(p_);
      set_minimum(kkt.positive_definite() && kkt.inertia_is_certain(p_, w_));
      unstable_ = !least_ && !only_null_directions();
      return;
    }
    if (large_) {
      set_minimum(p_.symmetric_at_speeds() && w_.speeds.keeps_minimum());
      return;
    }
    potential_ = !nearest_ && has_potential(p_, found_.z, w_.dense.stiffness(), w_.elsewhere());
    set_minimum(false);
    unstable_ = false;
    if (!potential_) return;
    ReducedHessian energy;
    energy.factor(w_.dense.reduced(), w_.dense.noise(), true);
    set_minimum(energy.positive_definite());
    unstable_ = !least_ && !only_null_directions(energy);
  }

  // Whether the potential is least here; a damper that drives may make that unstable all the same.
  void set_minimum(bool least) {
    least_ = least;
    found_.minimum = least && !p_.parameters.dampers_drive;
  }

  static bool only_null_directions(const ReducedHessian& hessian) {
    return hessian.singular() && hessian.eigenvalues()[0] > -ReducedHessian::zero;
  }

  // A curvature (1/s^2) of the size of those that the potential has for moving the mechanism as a whole.
  double curvature() const {
    const double reach = p_.parameters.length;
    return amended_potential(p_.system, p_.parameters, found_.z.q, w_.kinematics).magnitude /
           (w_.kkt(p_).mass() * reach * reach);
  }

  // Rounding makes some of many directions that nothing resists a little stiff, either way, and along loops
  // they bend. Then this leaves the balance factored with what keeps them still.
  bool only_null_directions() {
    KktSystem& kkt = w_.kkt(p_);
    const int negative = kkt.negative_count(), null = kkt.null_count();
    if (kkt.exact_inertia()) return negative == 0;
    if (negative == 0 && (p_.system.rows == 0 || null == kkt.force_free_count())) return true;
    kkt.factor(tolerance::inertia_shift * curvature());
    const bool none_falls = kkt.negative_count() == 0;
    const bool needs_shift = negative > 0 || kkt.null_count() < null; // the rest feels nothing at all
    kkt.factor(none_falls && needs_shift ? tolerance::proximal_shift * curvature() : 0);
    return none_falls;
  }

  // Newton-Raphson from near a minimum. False, and back there, where it goes off.
  bool polish(NewtonOutcome& outcome) {
    const Eigen::VectorXd near = found_.z.q;
    NewtonSettings few;
    few.impatient = large_;
    few.max_iterations = 10;
    outcome = newton(p_, found_.z, w_, few, &history_);
    found_.iterations += outcome.iterations;
    if (outcome.converged && outcome.largest_step < 0.01) return true;
    found_.z.q = near;
    return false;
  }

  // Newton-Raphson from where the descent ended, at last with neutral directions kept still.
  NewtonOutcome solve_from_bottom(bool factored) {
    const Eigen::VectorXd bottom = found_.z.q;
    NewtonSettings free;
    free.impatient = large_;
    free.factored = factored;
    const NewtonOutcome plain = newton(p_, found_.z, w_, free, &history_);
    found_.iterations += plain.iterations;
    if (!large_ || unbounded_ || p_.cancelled() || (plain.converged && plain.largest_step <= 0.2))
      return plain;
    found_.z.q = bottom;
    found_.z.lambda.setZero(p_.system.rows);
    evaluate(p_, found_.z, 0, w_);
    NewtonSettings settings;
    settings.impatient = large_;
    settings.proximal = tolerance::proximal_shift * curvature();
    const NewtonOutcome shifted = newton(p_, found_.z, w_, settings, &history_);
    found_.iterations += shifted.iterations;
    return shifted;
  }

  // Fills w_.assembled, or finds that it cannot be done and which cut joint stays open.
  bool close_loops() {
    if (close_loops_near_start()) return true;
    throw_if_cancelled();
    if (!arrived_) {
      found_.status = Status::infeasible;
      return false;
    }
    w_.assembled = candidate_.q; // Newton-Raphson found a way that Gauss-Newton did not
    return true;
  }

  bool close_loops_near_start() {
    if (!start_energy_) w_.assembled = start_;
    if (assembled()) return true;
    // Gauss-Newton can stall: try from a few places around the start before calling it infeasible.
    record_opening();
    std::mt19937 random(12345);
    for (int i = 0; i < 12 && !p_.cancelled(); ++i) {
      w_.assembled = start_;
      w_.step.resize(p_.system.nv);
      for (Eigen::Index k = 0; k < w_.step.size(); ++k)
        w_.step[k] = uniform(random, -0.7, 0.7) * p_.scaling.column[k];
      retract<double>(p_.system, w_.step, w_.assembled);
      if (assembled()) return true;
    }
    return false;
  }

  bool assembled() { return assemble(p_, w_.assembled, 0, w_) && same_assembly_mode(p_, w_.kinematics); }

  void record_opening() {
    for (std::size_t c = 0; c < p_.system.cuts.size(); ++c) {
      const CutJoint& cut = p_.system.cuts[c];
      for (std::size_t r = 0; r < cut.rows.size(); ++r) {
        const auto row = static_cast<Eigen::Index>(cut.first_row) + static_cast<Eigen::Index>(r);
        const double open = std::abs(w_.residual.phi[row]) * p_.scaling.row[row];
        if (open <= found_.opening && found_.open_cut >= 0) continue;
        found_.opening = open;
        found_.open_cut = static_cast<int>(c);
      }
    }
  }

  template <class Descent>
  bool downhill(Descent descend_from_here) {
    found_.fallback = Fallback::descent;
    found_.z.q = w_.assembled;
    DescentOutcome descent = descend_from_here(false);
    found_.iterations += descent.iterations;
    NewtonOutcome outcome;
    if (descent.end == DescentEnd::near && !polish(outcome)) {
      descent = descend_from_here(true);
      found_.iterations += descent.iterations;
    }
    // A soft spring may hold a long way down: Newton's method takes that in a stride.
    unbounded_ = descent.end == DescentEnd::unbounded && !at_speeds_;
    if (descent.end == DescentEnd::minimum || unbounded_)
      outcome = solve_from_bottom(descent.factored);
    else if (descent.end != DescentEnd::near)
      return false;
    if (!outcome.converged || (outcome.largest_step > 0.2 && !unbounded_ && !at_speeds_) ||
        !same_assembly_mode(p_, w_.kinematics) || (unbounded_ && !below_assembled()))
      return false;
    found_.unbounded = unbounded_;
    unbounded_ = false;
    found_.newton = outcome;
    if (at_speeds_) return stays_by_descent(outcome);
    const bool left_unstable = arrived_ && unstable_;
    classify(w_.kkt(p_).shift() == 0 && still_factored(outcome));
    if (potential_ && unstable_) return false;
    // Newton may have been right all along, by a way that had to be checked.
    if (arrived_ && !left_unstable && candidate_.q.size() > 0 && same(candidate_.q, found_.z.q)) {
      found_.fallback = candidate_fallback_;
      found_.newton = candidate_outcome_;
    }
    if (left_unstable)
      found_.remark =
          same(candidate_.q, w_.assembled) ? Remark::left_unstable_start : Remark::left_unstable_equilibrium;
    found_.status = Status::converged;
    return true;
  }

  // What Newton-Raphson makes of the bottom at the speeds of the start counts where it is stable, the speeds
  // near these, and the rest not far from the bottom.
  bool stays_by_descent(const NewtonOutcome& outcome) {
    constexpr double near = 0.5; // scaled
    classify(w_.kkt(p_).shift() == 0 && still_factored(outcome));
    if (!found_.minimum || outcome.largest_step > near || count_turned_round(found_.z.q) > 0) return false;
    found_.status = Status::converged;
    return true;
  }

  bool same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return same_pose(p_, a, b, tolerance::same_state);
  }

  // Nothing better was found: an unstable answer is an answer, said to be one.
  bool settle_for_unstable() {
    if (candidate_.q.size() == 0) {
      found_.status = Status::not_converged;
      found_.fallback.reset();
      found_.remark = unbounded_ ? Remark::exhausted_and_unbounded : Remark::exhausted;
      return false;
    }
    found_.z = candidate_;
    evaluate(p_, found_.z, 0, w_);
    classify();
    found_.newton = candidate_outcome_;
    found_.fallback = candidate_fallback_;
    found_.status = Status::converged;
    found_.unbounded = unbounded_;
    found_.remark = !unstable_   ? Remark::basin_uncertain
                    : unbounded_ ? Remark::unstable_and_unbounded
                                 : Remark::unstable;
    return true;
  }

  const Problem& p_;
  const Eigen::VectorXd& start_;
  const bool nearest_, warm_, newton_only_;
  const bool large_;     // many bodies: what leads to a minimum in few iterations comes first
  const bool descends_;  // there is a potential to go down by
  const bool at_speeds_; // it is one at given speeds, and torques drive
  Workspace& w_;
  std::vector<double>& history_;
  Found& found_;
  std::optional<Potential>
      start_energy_; // of the start with its loops closed, w_.assembled, where it matters
  Unknowns candidate_;
  NewtonOutcome candidate_outcome_;
  std::optional<Fallback> candidate_fallback_;
  bool gives_up_ = false;          // Newton-Raphson did or would, for the descent
  bool arrived_ = false;           // some solver converged, at an admissible state or not
  bool potential_ = false;         // what was found last has one
  bool least_ = false;             // and is a strict minimum of it
  bool unstable_ = false;          // or falls from there
  bool unbounded_ = false;         // the last descent found no bottom
  bool starts_indefinite_ = false; // says Newton-Raphson, which leaves the balance linearised there
};

} // namespace

bool same_assembly_mode(const Problem& problem, const Kinematics<double>& k) {
  for (std::size_t c = 0; c < problem.system.cuts.size(); ++c) {
    const CutJoint& cut = problem.system.cuts[c];
    for (const ConstraintRow& row : cut.rows) {
      if (row.type != RowType::direction || row.w == 3) continue;
      const Mat3 r = k.at(cut.ends.a).R.transpose() * k.at(cut.ends.b).R;
      const auto& f = problem.parameters.cuts[c].frame;
      for (int axis : {row.u, row.w}) {
        const Vec3& e = f[static_cast<std::size_t>(axis)];
        // Where all three axes are held, the rows vanish a third of a turn round, too.
        if ((axis == 2 || cut.type == JointType::fixed || cut.type == JointType::prismatic) &&
            e.dot(r * e) < 0.5)
          return false;
      }
    }
  }
  return true;
}

void find_equilibrium(const Problem& problem, const Eigen::VectorXd& start, bool nearest, bool warm,
                      Workspace& w, std::vector<double>& history, Found& found, bool newton_only) {
  const Interruptible scope(problem.cancel);
  try {
    EquilibriumSearch(problem, start, nearest, warm, newton_only, w, history, found).run();
  } catch (const Interrupted&) {
    found.status = Status::not_converged;
    found.remark = Remark::cancelled;
  }
}

} // namespace flyball
