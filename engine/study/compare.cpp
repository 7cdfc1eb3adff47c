#include "engine/study/compare.hpp"

#include "engine/dynamics/simulator.hpp"
#include "engine/dynamics/watch.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/search/turned_balance.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/refine.hpp"
#include "engine/stability/neutral_directions.hpp"
#include "engine/stability/stability.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

using ExtendedVector = Configuration<Extended>;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// What one run may take of the whole time, and from which part on it is not repeated.
constexpr double longest_run = 0.1, longest_repeated = 0.01;

// The clock and whether anybody still waits.
struct Time {
  Watch watch;
  double limit; // s, for everything

  bool is_long(double seconds) const { return seconds > longest_repeated * limit || watch.over(); }
};

// Median of the time that one call takes, over batches long enough for the clock.
template <class Work>
double time_of(int repeats, const Time& time, Work work) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [&](int count) {
    const auto begin = Clock::now();
    for (int i = 0; i < count; ++i)
      work();
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  int count = 1;
  double spent = seconds(1);
  if (time.is_long(spent)) return spent;
  for (; spent < 1e-3 && count < 1 << 20; spent = seconds(count))
    count *= 2;
  std::vector<double> times;
  for (int i = 0; i < repeats && !(i > 0 && time.watch.over()); ++i)
    times.push_back(seconds(count) / count);
  return median(std::move(times));
}

class Direct {
 public:
  Direct(const Mechanism& mechanism, const std::atomic<bool>* cancel)
      : mechanism_(mechanism), cancel_(cancel) {
    system_ = compile_for_drives(mechanism);
    bind(system_, mechanism, parameters_);
    set_scaling(system_, parameters_, scaling_);
    drawn_configuration(system_, parameters_, drawn_);
    measures_.bind(mechanism, system_, parameters_);
    as_drawn_ = parameters_;
  }

  const System& system() const { return system_; }
  const Scaling& scaling() const { return scaling_; }

  // From the drawn pose to an answer that is known to exist and be stable, as Analysis::solve does.
  bool answer(Unknowns& z) {
    parameters_ = as_drawn_;
    steady_.find(problem(), drawn_, drawn_, {.seconds = SolveOptions{}.search});
    if (!steady_.holds) return answer_turned(z);
    if (!steady_.found.minimum || !steady_.phases.empty())
      stability_ =
          steady_.stability ? *steady_.stability : find_stability(steady_.factored(classified()), false);
    z = steady_.found.z;
    return true;
  }
  int iterations() const { return turned_ ? turned_->iterations : steady_.found.iterations; }
  bool turned() const { return turned_.has_value(); }

  // q* by Newton's steps on the balance in extended precision, from an answer, until nothing moves.
  void settle_reference(const Unknowns& answer, Comparison& out) {
    if (turned_) return settle_turned_reference(out);
    Unknowns z = answer;
    take_neutral(z);
    factor_with_multipliers(problem(), z, w_);
    reference_ = z.q.cast<Extended>();
    ExtendedVector step, multipliers = z.lambda.cast<Extended>();
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

  // How far along V (AngleTies) what turned by `angles` (by link, of the motion, `time` s from its beginning)
  // is from q*, but for whole turns of each: rad, or parts of the reach. Takes these angles for
  // measure_errors.
  double take_angles(const Eigen::VectorXd& angles, double time) {
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

  // Whether q* leaves anything that errors are of: not where it may be turned or moved in every coordinate.
  bool determines_anything() const {
    for (std::size_t l = 0; l < system_.links.size(); ++l)
      if (system_.links[l].v >= 0 && arbitrary_[l].cols() < arbitrary_[l].rows()) return true;
    return false;
  }

  // The largest part of a change (nv, scaled) that is no turn or move along what is arbitrary.
  double size_of(const Eigen::VectorXd& change) const {
    double largest = 0;
    for (std::size_t l = 0; l < system_.links.size(); ++l) {
      const Eigen::MatrixXd& arbitrary = arbitrary_[l];
      if (system_.links[l].v < 0) continue;
      const auto of = change.segment(system_.links[l].v, arbitrary.rows());
      largest = std::max(largest, (of - arbitrary * (arbitrary.transpose() * of)).norm());
    }
    return largest;
  }

  // The largest difference from q*, in radians or relative to the reach, of what is not arbitrary.
  double error_of(const Eigen::VectorXd& q) const {
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

  // Of the measures, from what they are at q*.
  std::vector<double> measure_errors(const Eigen::VectorXd& q) {
    if (measures_.empty()) return {};
    const Eigen::VectorXd away = (measures_.evaluate_at(problem(), q, w_) - measured_).cwiseAbs();
    return {away.begin(), away.end()};
  }
  const Eigen::VectorXd& measured() const { return measured_; } // at q*

  // The state after so many plain iterations from the drawn pose, and whether more would change it.
  bool iterate(int count, Unknowns& z) {
    z.q = drawn_;
    z.lambda.setZero(system_.rows);
    return newton(problem(), z, w_, {count, false}, nullptr).converged;
  }

 private:
  Problem problem() const { return {system_, parameters_, scaling_, cancel_, system_.kkt_form}; }
  // By matrices as far as eigenvalues are found without being asked for.
  Problem classified() const {
    Problem p = problem();
    if (system_.nv <= largest_for_eigenvalues) p.form = KktForm::dense;
    return p;
  }

  bool answer_turned(Unknowns& z) {
    turned_ = find_turned_state({system_, parameters_, scaling_, cancel_}, drawn_, w_);
    if (!turned_) return false;
    parameters_ = at_angles_of(as_drawn_, *turned_);
    z = turned_->z;
    stability_ = find_stability(factor_at({system_, parameters_, scaling_, cancel_}, z, w_), false);
    return true;
  }

  // What nothing resists at z is no error: of a link's rotation the turns about these axes, of others all.
  void take_neutral(const Unknowns& z) {
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

  // By steps of the balance with the angles among its unknowns.
  void settle_turned_reference(Comparison& out) {
    Unknowns z = turned_->z;
    take_neutral(z);
    reference_ = z.q.cast<Extended>();
    ExtendedVector step;
    Eigen::VectorXd correction = Eigen::VectorXd::Zero(system_.nv);
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 12; ++i) {
      const Problem at{system_, parameters_, scaling_, cancel_};
      const TurnedBalance balance(at, z, turned_->ties, mechanism_, w_);
      if (!balance.usable()) break;
      w_.q_extended = reference_;
      w_.lambda_extended = ExtendedVector::Zero(system_.rows);
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

  void tell_reference(const Eigen::VectorXd& correction, Comparison& out) {
    const Eigen::VectorXd q = reference_.cast<double>();
    forward<double>(system_, parameters_, q, 0, w_.kinematics);
    out.reference = coordinate_solutions(system_, parameters_, q, correction.cwiseAbs(), w_.kinematics);
    measured_ = measures_.evaluate_at(problem(), q, w_);
  }

  const Mechanism& mechanism_;
  const std::atomic<bool>* cancel_;
  System system_;
  Parameters parameters_; // at the angles of a state that stands turned
  Parameters as_drawn_;
  std::optional<TurnedState> turned_;
  Scaling scaling_;
  Eigen::VectorXd drawn_;
  Workspace w_;
  SteadyState steady_;
  Stability stability_;
  std::vector<Eigen::MatrixXd> arbitrary_; // by link: orthonormal directions of its coordinates, by column
  ExtendedVector reference_;
  MeasureSet measures_;
  Eigen::VectorXd measured_;
};

// Long enough for the slowest motion about the steady state to shrink to 1e-2, 1e-4 ... 1e-10; s.
std::vector<double> natural_durations(const Solution& steady, const Mechanism& mechanism) {
  double slowest = std::numeric_limits<double>::infinity();
  double fastest = 0;
  if (steady.eigenvalues)
    for (const std::complex<double>& rate : *steady.eigenvalues) {
      fastest = std::max(fastest, std::abs(rate));
      if (rate.real() < -1e-9 * std::abs(rate)) slowest = std::min(slowest, -rate.real());
    }
  std::vector<double> out;
  if (std::isfinite(slowest) && slowest > 1e-9 * fastest) {
    for (int digits : {2, 4, 6, 8, 10}) {
      const double exact = digits * std::numbers::ln10 / slowest;
      const double unit = std::pow(10., std::floor(std::log10(exact)) - 1);
      out.push_back(std::ceil(exact / unit) * unit);
    }
  } else {
    for (double part : {0.25, 0.5, 1., 2., 4.})
      out.push_back(part * mechanism.simulation.duration);
  }
  return out;
}

// In radians or of the reach: what a motion ends farther away from it has not come to.
constexpr double comes_near = 1e-2;

// Leaves the message with what there is to say where no motion is one to compare with.
void find_best(Comparison& c) {
  const auto distance = [](const MotionMark& p) { return std::max(p.error, p.goes_on); };
  std::optional<std::pair<double, double>> nearest; // how far it is, or goes on, and after how long
  for (const MotionCurve& curve : c.motion)
    for (const MotionMark& p : curve.points) {
      if (p.status != RunStatus::completed) continue;
      if (!nearest || distance(p) < nearest->first) nearest = {distance(p), curve.duration};
      if (!(distance(p) <= comes_near) || (c.best && p.error >= c.best->error)) continue;
      c.best = {curve.method, curve.duration, p.tolerance, p.error, p.run_time_s, c.answer.run_time_s};
    }
  if (!nearest) return;
  if (!c.best) {
    if (c.complete) // else a longer one was not reached
      c.message += " No motion comes to stand at this steady state: the nearest ends, or swings on, " +
                   rounded_text(nearest->first, 2) +
                   " from it (in radians, and slides as parts of the mechanism's size), after " +
                   rounded_text(nearest->second, 4) +
                   " s simulated; it may need longer, or settle in another one.";
    return;
  }
  // The first iteration that comes as near; where a fallback was needed, the answer.
  for (const DirectMark& mark : c.direct)
    if (mark.iterations > 0 && mark.error <= c.best->error) {
      c.best->direct_s = mark.run_time_s;
      return;
    }
}

// The integrators look at the flag themselves, and nothing may be thrown through them.
Run simulated(const Mechanism& mechanism, const SimulationOptions& options) {
  const Uninterrupted scope;
  return simulate(mechanism, options);
}

// 1/s: of the slowest motion about the steady state; 0 where it is not known.
double slowest_rate(const Solution& steady) {
  constexpr double null = 1e-5; // of the fastest: a double zero is known to half of the digits
  if (!steady.eigenvalues) return 0;
  double fastest = 0, slowest = std::numeric_limits<double>::infinity();
  for (const std::complex<double>& s : *steady.eigenvalues)
    fastest = std::max(fastest, std::abs(s));
  for (const std::complex<double>& s : *steady.eigenvalues)
    if (std::abs(s) > null * fastest) slowest = std::min(slowest, std::abs(s));
  return std::isfinite(slowest) ? slowest : 0;
}

struct RunEnd {
  Eigen::VectorXd q, rates; // of what nothing drives, scaled; 0 of what torques drive
  Eigen::VectorXd angles;   // by link, of what torques drive
};

// Where a run ended.
RunEnd end_of(const Run& run, const Direct& direct) {
  const auto nq = static_cast<std::ptrdiff_t>(direct.system().nq);
  const auto sample =
      static_cast<std::ptrdiff_t>(run.states.size()) - (nq + static_cast<std::ptrdiff_t>(direct.system().nv));
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(run.states.data() + sample, nq);
  Eigen::VectorXd rates = Eigen::Map<const Eigen::VectorXd>(run.states.data() + sample + nq,
                                                            static_cast<Eigen::Index>(direct.system().nv))
                              .cwiseQuotient(direct.scaling().column);
  // What torques drive is compared by its speed; the motion's coordinates are in the same order.
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(direct.system().links.size()));
  for (std::size_t l = 0; l < direct.system().links.size(); ++l)
    if (const Link& link = direct.system().links[l]; finds_speed(link)) {
      angles[static_cast<Eigen::Index>(l)] = q[link.q];
      q[link.q] = run.states[static_cast<std::size_t>(sample + nq + link.v)];
      rates[link.v] = 0;
    }
  return {std::move(q), std::move(rates), std::move(angles)};
}

// One run and its repeats. Nothing where nobody waits for it any more.
std::optional<MotionMark> measure(const Mechanism& mechanism, const SimulationOptions& simulation,
                                  int repeats, const Time& time, Direct& direct, double slowest) {
  MotionMark point;
  point.tolerance = simulation.tolerance;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const Run run = simulated(mechanism, simulation);
    if (time.watch.over()) break;
    times.push_back(run.statistics.run_time_s);
    if (i == 0) {
      point.error = std::numeric_limits<double>::quiet_NaN();
      if (run.status == RunStatus::completed) {
        const auto [q, rates, angles] = end_of(run, direct);
        point.error = std::max(direct.error_of(q), direct.take_angles(angles, simulation.duration));
        if (slowest > 0) point.goes_on = direct.size_of(rates) / slowest;
        point.measure_errors = direct.measure_errors(q);
      }
      point.steps = run.statistics.steps;
      point.evaluations = run.statistics.evaluations;
      point.status = run.status;
    }
    if (run.status != RunStatus::completed || time.is_long(times.back())) break; // once is enough
  }
  if (times.empty()) return {};
  point.run_time_s = median(std::move(times));
  return point;
}

// One curve a method and duration, into out.motion. False where it was broken off.
bool measure_motions(const Mechanism& mechanism, const CompareOptions& options,
                     const std::vector<double>& durations, const Time& time, Direct& direct, double slowest,
                     Comparison& out) {
  const std::size_t all = options.integrators.size() * durations.size() * options.tolerances.size();
  std::size_t done = 0;
  for (Integrator method : options.integrators)
    for (double duration : durations) {
      MotionCurve& curve = out.motion.emplace_back(MotionCurve{method, duration, {}});
      bool too_long = false;
      for (double tolerance : options.tolerances) {
        if (!too_long) {
          SimulationOptions simulation;
          simulation.duration = duration;
          simulation.rate = 0;
          simulation.tolerance = tolerance;
          simulation.method = method;
          simulation.max_steps = options.max_steps;
          simulation.cancel = options.cancel;
          simulation.time_limit = longest_run * time.limit;
          const std::optional<MotionMark> point =
              measure(mechanism, simulation, options.repeats, time, direct, slowest);
          if (!point) return false;
          curve.points.push_back(*point);
          too_long = point->status == RunStatus::time_limit;
        }
        if (options.progress) options.progress(++done, all);
      }
    }
  return true;
}

void compare_through(const Mechanism& mechanism, const CompareOptions& options, const Time& time,
                     Comparison& out) {
  const auto broken_off = [&] {
    out.complete = false;
    out.message = !time.watch.out_of_time() ? "Cancelled."
                                            : "The time limit of " + rounded_text(options.time_limit, 4) +
                                                  " s was reached before all was measured.";
  };
  SolveOptions solve;
  solve.cancel = options.cancel;
  const Solution steady = Analysis(mechanism).solve(solve);
  out.status = steady.frictions.empty() ? steady.status : Status::no_steady_state;
  out.message = steady.frictions.empty() ? steady.message
                                         : rests_on_friction(steady, "Ways of finding it are compared");
  if (time.watch.over()) broken_off();
  if (out.status != Status::converged || !out.complete) return;
  Direct direct(mechanism, options.cancel);
  Unknowns answer;
  if (!direct.answer(answer)) { // found above, unless it is all too long
    broken_off();
    return;
  }
  direct.settle_reference(answer, out);
  if (!direct.determines_anything()) {
    out.complete = false;
    out.message = "Nothing resists any coordinate of its steady state, so there is no error to compare.";
    return;
  }
  out.answer = {direct.iterations(), direct.error_of(answer.q),
                time_of(options.repeats, time, [&] { direct.answer(answer); }),
                direct.measure_errors(answer.q)};
  for (std::size_t i = 0; i < mechanism.measures.size(); ++i) {
    MeasureSolution& measure = out.measures.emplace_back();
    measure.name = mechanism.measures[i].name;
    measure.unit = mechanism.measures[i].unit;
    const double value = direct.measured()[static_cast<Eigen::Index>(i)];
    if (std::isfinite(value)) measure.value = value;
  }
  // Where the angles are looked for, too, there is no one line of iterations.
  for (int i = 0; i <= 30 && !direct.turned() && !time.watch.over(); ++i) {
    Unknowns z;
    const bool converged = direct.iterate(i, z);
    const double error = direct.error_of(z.q);
    std::vector<double> measure_errors = direct.measure_errors(z.q);
    out.direct.push_back(
        {i, error, time_of(options.repeats, time, [&] { direct.iterate(i, z); }), std::move(measure_errors)});
    if (converged) break;
  }
  if (out.direct.empty() || !(out.direct.back().error < 1e-6)) out.direct.clear();

  const std::vector<double> durations =
      options.durations.empty() ? natural_durations(steady, mechanism) : options.durations;
  if (!measure_motions(mechanism, options, durations, time, direct, slowest_rate(steady), out)) broken_off();
  find_best(out);
  const bool any_end = std::ranges::any_of(out.motion, [](const MotionCurve& curve) {
    return std::ranges::any_of(curve.points,
                               [](const MotionMark& p) { return p.status == RunStatus::completed; });
  });
  if (out.complete && !any_end) {
    out.complete = false;
    out.message = "No motion went on to its end, so there is nothing to compare with.";
  }
}

} // namespace

Comparison compare(const Mechanism& mechanism, const CompareOptions& options) {
  Comparison out;
  Time time{Watch(options.cancel), options.time_limit};
  time.watch.allow(options.time_limit);
  const Interruptible scope(options.cancel);
  try {
    compare_through(mechanism, options, time, out);
  } catch (const Interrupted&) {
    out.complete = false;
    out.message = "Cancelled.";
    std::erase_if(out.motion, [](const MotionCurve& curve) { return curve.points.empty(); });
  }
  return out;
}

} // namespace flyball
