#include "engine/continuation/branch_follower.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/largest.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/infinite_rate.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/kink_message.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/search/all_equilibria.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/existence.hpp"
#include "engine/solve/refine.hpp"
#include "engine/solve/singular_loops.hpp"
#include "engine/stability/sign_is_open.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <array>
#include <random>

namespace flyball {
namespace {

// Of the range: how far from where a number's rate is infinite a branch begins, and how near it comes to a
// border beyond which there is no mechanism.
constexpr double beside_infinite_rate = 1e-9, at_border = 1e-9;

bool turns_with_drives(const ResponsePoint& point) {
  return point.stability_reason == StabilityReason::floquet;
}

} // namespace

Mechanism with_parameter(const Mechanism& mechanism, const std::string& address, double value) {
  Mechanism m = mechanism;
  set_parameter(m, address, value);
  validate(m);
  return m;
}

namespace {

// A coordinate that touches its stop or leaves it there, as it moves along a branch.
struct AtStop {
  int q = 0, v = 0;
  double limit = 0; // rad or m
  bool grows = true;
};

std::optional<AtStop> stop_ahead(const Problem& problem, const BranchState& state) {
  constexpr double at = 1e-6, behind = -1e-10; // scaled lengths of the branch
  std::optional<AtStop> found;
  double least = at;
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0 || link.type == LinkType::spherical || finds_speed(link)) continue;
    const CoordinateForce& force = problem.parameters.links[l].force[0];
    const auto look = [&](double limit) {
      const double rate = state.tangent[link.v] * problem.scaling.column[link.v],
                   away = (limit - state.z.q[link.q]) / rate;
      if (!(away > behind && away < least)) return;
      least = away;
      found = {link.q, link.v, limit, rate > 0};
    };
    if (force.has_lower) look(force.lower);
    if (force.has_upper) look(force.upper);
  }
  return found;
}

// The largest of the speeds that are found, scaled.
double fastest_found(const Problem& problem, const Eigen::VectorXd& q) {
  double out = 0;
  for (const Link& link : problem.system.links)
    if (finds_speed(link)) out = std::max(out, std::abs(q[link.q]) / problem.scaling.column[link.v]);
  return out;
}

std::string infinite_rate_text(const InfiniteRate& error) {
  return std::string("a number changes at an infinite rate there: ") + error.what();
}

// At the beginning of the range. Where expressions make no mechanism there, as it is: then the curve ends
// within the range; a field itself must be one that is possible at both ends.
Mechanism begun(const Mechanism& mechanism, const std::string& address, double from, double to) {
  if (!makes_others(address)) {
    (void)with_parameter(mechanism, address, to);
    return with_parameter(mechanism, address, from);
  }
  try {
    return with_parameter(mechanism, address, from);
  } catch (const SceneError&) {
    const double present = get_parameter(mechanism, address);
    return with_parameter(mechanism, address, present);
  }
}

} // namespace

Eigen::VectorXd configuration_of(const Problem& problem, const std::vector<CoordinateSolution>& coordinates) {
  Eigen::VectorXd q;
  drawn_configuration(problem.system, problem.parameters, q);
  set_start(problem.system, problem.parameters, start_values(coordinates), q);
  return q;
}

Eigen::VectorXd starts_of(const Problem& problem, const std::vector<CoordinateSolution>& coordinates) {
  const System& system = problem.system;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.links.size()));
  for (const CoordinateInfo& info : system.coordinates) {
    if (system.links[static_cast<std::size_t>(info.link)].drive < 0) continue;
    const std::string& joint = system.tree_joints[static_cast<std::size_t>(info.tree_joint)].name;
    const auto at = std::ranges::find_if(
        coordinates, [&](const CoordinateSolution& c) { return c.joint == joint && c.index == info.index; });
    if (at != coordinates.end())
      out[info.link] = at->value - problem.parameters.links[static_cast<std::size_t>(info.link)].drawn;
  }
  return out;
}

ResponsePoint response_point(const Mechanism& mechanism, const Problem& problem, const Unknowns& z,
                             const Eigen::VectorXd& error, PointDetails details, Workspace& w) {
  ResponsePoint point;
  const FactoredState at = factor_at(problem, z, w);
  point.singular_loops = at_singular_loops(problem, z, w);
  Stability stability = find_stability(at, details.eigenvalues);
  if (sign_is_open(at, stability)) leave_open(stability);
  if (point.singular_loops) leave_out_modes(stability);
  point.stable = stability.stable;
  point.floquet = std::move(stability.floquet);
  point.stability_reason = stability.reason;
  point.kinks = kink_message(problem.system, mechanism, stability);
  if (stability.eigenvalues) point.eigenvalues = std::move(*stability.eigenvalues);
  Unknowns reported;
  const bool measured = details.measures && !mechanism.measures.empty();
  if (measured) details.measures->bind(mechanism, problem.system, problem.parameters);
  if (details.reactions || (measured && details.measures->needs_forces()))
    reported = evaluate_reported(problem, z.q, w);
  else
    forward<double>(problem.system, problem.parameters, z.q, 0, w.kinematics);
  point.coordinates = coordinate_solutions(
      problem.system, problem.parameters, z.q,
      error.size() > 0 ? error : Eigen::VectorXd::Zero(problem.system.nv).eval(), w.kinematics);
  if (measured) {
    if (reported.q.size() == 0) reported = z;
    point.measures = details.measures->solutions(problem, reported, error, w);
  }
  if (!details.reactions) return point;
  ReportedForces forces = report_forces(mechanism, problem, reported, w);
  point.reactions = std::move(forces.reactions);
  point.drive_torques = std::move(forces.drive_torques);
  return point;
}

BranchFollower::BranchFollower(const Mechanism& mechanism, const std::string& address, double from, double to,
                               const BranchOptions& options)
    : options_(options),
      system_(compile_for_drives(inside_ranges(mechanism, std::array{NumberRange{address, from, to}})
                                     .value_or(begun(mechanism, address, from, to)))),
      family_(system_, begun(mechanism, address, from, to), address, std::abs(to - from),
              system_.nv > options.dense_up_to && system_.conservative && system_.single_drives
                  ? system_.kkt_form
                  : KktForm::dense),
      continuation_(family_), from_(from), to_(to) {}

Problem BranchFollower::problem_at(double parameter) {
  family_.set(parameter);
  family_.expect_possible();
  Problem p = family_.problem();
  p.cancel = options_.cancel;
  return p;
}

Problem BranchFollower::problem_at(const BranchState& state) {
  family_.turn(state.starts);
  return problem_at(state.parameter);
}

std::optional<BranchState> BranchFollower::begin(Unknowns z, double parameter, bool forth) {
  return begin(BranchState{std::move(z), parameter, {}, 0, 0}, forth);
}

std::optional<BranchState> BranchFollower::begin(const TurnedState& turned, double parameter, bool forth) {
  family_.tie(turned.ties);
  continuation_.tied();
  return begin(BranchState{turned.z, parameter, {}, 0, 0, turned.starts}, forth);
}

void BranchFollower::untie() {
  if (!family_.ties()) return;
  family_.tie({});
  continuation_.tied();
}

std::optional<BranchState> BranchFollower::begin(BranchState state, bool forth) {
  const double way = (to_ > from_) == forth ? 1 : -1;
  try {
    if (!start(state, way)) return {};
  } catch (const InfiniteRate&) { // such as of a square root at zero: it begins beside
    state.parameter += way * beside_infinite_rate * family_.scale();
    if (!continuation_.land(state) || !start(state, way)) return {};
  }
  return state;
}

bool BranchFollower::start(BranchState& state, double way) {
  state.still.resize(system_.nv, 0);
  state.drifts = false;
  const Problem problem = problem_at(state);
  const Stability stability = find_stability(factor_at(problem, state.z, w_), false);
  if (stability.neutral.empty()) return continuation_.start(state, way);
  const Eigen::MatrixXd& directions = stability.neutral_directions;
  const bool known = problem.form == KktForm::dense && !family_.ties() && system_.nv < large::from;
  if (const auto span = known ? singular_vectors(directions) : std::nullopt) {
    state.still = span->left.leftCols(directions.cols());
    if (continuation_.start(state, way) && is_a_family(state)) return true;
    state.still.resize(system_.nv, 0);
  }
  state.drifts = true;
  return continuation_.start(state, way);
}

bool BranchFollower::is_a_family(const BranchState& state) {
  constexpr double away = 1e-3;      // scaled
  constexpr double singular = 1e-12; // determinant: other directions are singular, too
  const Eigen::Index count = state.still.cols();
  if (count == 0 || state.drifts || !(std::abs(state.determinant) > singular)) return false;
  // A balance that is special at this value, as of a shaft that stands, says nothing of those beside it.
  BranchState beside;
  int iterations = 0;
  try {
    if (!continuation_.step(state, options_.largest_step, beside, iterations) || beside.drifts ||
        beside.still.cols() < count)
      return false;
  } catch (const SceneError&) { // no mechanism can be made there
    return false;
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    BranchState moved = state;
    if (!continuation_.slide(moved, away * Eigen::VectorXd::Unit(count, i)) || moved.still.cols() < count)
      return false;
    const Eigen::VectorXd step = scaled_difference(family_.problem(), state.z.q, moved.z.q);
    if (!(state.still.col(i).dot(step) > away / 2)) return false;
  }
  return true;
}

std::vector<BranchState> BranchFollower::family(const BranchState& state) {
  std::vector<BranchState> out{state};
  constexpr double step = 0.7; // scaled
  std::mt19937 random(11);
  BranchState at = state;
  for (Eigen::Index i = 0; i < 16 * state.still.cols(); ++i) {
    Eigen::VectorXd by(at.still.cols());
    for (double& entry : by)
      entry = static_cast<double>(random()) / 2147483648. - 1;
    // Of one direction to the same side, so that a circle is gone all round.
    const double size = by.size() == 1 ? by[0] : by.norm();
    if (!(std::abs(size) > 0) || !continuation_.slide(at, step / size * by)) break;
    out.push_back(at);
  }
  return out;
}

BranchState BranchFollower::nearest_of_family(const std::vector<BranchState>& family, const BranchState& to) {
  constexpr double longest = 0.3, there = 1e-9; // scaled
  constexpr double level = 1e-3;                // of the distance: it hardly changes along the family
  constexpr int most = 60;
  if (family.size() == 1 && family.front().still.cols() == 0) return family.front();
  const auto distance = [&](const BranchState& s) {
    return scaled_difference(family_.problem(), s.z.q, to.z.q).norm();
  };
  BranchState state = *std::ranges::min_element(family, {}, distance);
  for (int i = 0; i < most; ++i) {
    const Eigen::VectorXd away = scaled_difference(family_.problem(), state.z.q, to.z.q);
    const Eigen::VectorXd by = state.still.transpose() * away;
    const double size = by.norm();
    if (!(size > std::max(there, level * away.norm()))) break;
    BranchState next = state;
    if (!continuation_.slide(next, std::min(1., longest / size) * by) || distance(next) >= away.norm()) break;
    state = std::move(next);
  }
  return state;
}

Eigen::VectorXd BranchFollower::error_of(const Problem& problem, const BranchState& state) {
  if (system_.torques.empty() || problem.form != KktForm::dense) return {};
  factor_at(problem, state.z, w_);
  Unknowns refined = state.z;
  NewtonOutcome outcome;
  outcome.converged = true;
  ErrorEstimate error;
  refine(problem, refined, outcome, w_, error);
  return error.solution.allFinite() ? error.solution : Eigen::VectorXd();
}

BranchFollower::Described BranchFollower::describe(const BranchState& state) {
  const Problem problem = problem_at(state);
  Described d;
  d.point = response_point(family_.mechanism(), problem, state.z, error_of(problem, state),
                           {options_.eigenvalues, options_.reactions, &measures_}, w_);
  d.point.parameter = state.parameter;
  // Exponents have their frequencies but for whole turns a period: multipliers tell what crosses.
  if (!turns_with_drives(d.point)) d.right = right_of_axis(d.point.eigenvalues, state.one_of_many());
  return d;
}

std::string BranchFollower::limits() const {
  if (family_.problem().form == KktForm::dense || !options_.eigenvalues) return "";
  return "Of " + std::to_string(system_.nv) +
         " coordinates the signs of pivots tell the stability, not eigenvalues: whether pairs of these cross "
         "the imaginary axis (Hopf, flutter) was not looked for.";
}

ResponsePoint BranchFollower::point(const BranchState& state) {
  return describe(state).point;
}

Eigen::VectorXd BranchFollower::difference(const BranchState& a, const BranchState& b) const {
  const Eigen::VectorXd turned = angles(a, b);
  Eigen::VectorXd out(system_.nv + turned.size() + 1);
  out << scaled_difference(family_.problem(), a.z.q, b.z.q), turned,
      (b.parameter - a.parameter) / family_.scale();
  return out;
}

Eigen::VectorXd BranchFollower::angles(const BranchState& a, const BranchState& b) const {
  if (a.starts.size() == 0) return {};
  return angles_between(family_.problem(), *family_.ties(), a.starts, b.starts);
}

bool BranchFollower::same_place(const BranchState& a, const BranchState& b, double near) const {
  return a.starts.size() == b.starts.size() && same_pose(family_.problem(), a.z.q, b.z.q, near) &&
         largest_size(angles(a, b)) < near;
}

double BranchFollower::size_of(const BranchState& at, Eigen::VectorXd step) const {
  const Problem problem = family_.problem();
  for (const Link& link : system_.links)
    if (finds_speed(link))
      step[link.v] /= std::max(1., std::abs(at.z.q[link.q]) / problem.scaling.column[link.v]);
  return step.norm();
}

bool BranchFollower::same(const BranchState& a, const BranchState& b) {
  return std::abs(a.parameter - b.parameter) < tolerance::same_parameter * family_.scale() &&
         same_place(nearest_of_family({a}, b), b, tolerance::same_branch_pose);
}

bool BranchFollower::lies_on(const std::vector<BranchState>& family, const FollowedBranch& branch) {
  const double near = 2 * options_.largest_step;
  BranchState state = family.front();
  const BranchState* nearest = nullptr;
  Eigen::VectorXd offset;
  double least = near;
  for (const BranchState& s : branch.states) {
    if (s.starts.size() != state.starts.size() ||
        std::abs(s.parameter - state.parameter) > near * family_.scale())
      continue;
    const bool alike = s.still.cols() == family.front().still.cols();
    BranchState beside = alike ? nearest_of_family(family, s) : family.front();
    const Eigen::VectorXd d = difference(s, beside);
    if (const double size = size_of(s, d); size < least) {
      least = size;
      offset = d;
      nearest = &s;
      state = std::move(beside);
    }
  }
  if (!nearest) return false;
  if (same(*nearest, state)) return true;
  // Beyond its ends it may go on as another branch: the two halves of a pitchfork are one curve.
  const double along = nearest->tangent.dot(offset);
  if (nearest == &branch.states.front() && along < -branch.lead) return false;
  if (nearest == &branch.states.back() && along > 0 && !branch.closed) return false;
  BranchState there;
  int iterations = 0;
  try {
    return continuation_.step(*nearest, along, there, iterations) &&
           size_of(there, difference(there, nearest_of_family({state}, there))) < 1e-2 * least;
  } catch (const SceneError&) { // no mechanism can be made there
    return false;
  }
}

bool BranchFollower::holds_at_every_phase(const BranchState& s) {
  const Problem problem = problem_at(s);
  return check_existence(problem, s.z.q, sample_phases(problem.system, problem.parameters, s.z.q), w_).holds;
}

std::optional<BranchState> BranchFollower::beyond_stop(const BranchState& state) {
  const Problem problem = problem_at(state);
  const auto stop = stop_ahead(problem, state);
  if (!stop) return {};
  // Beside the stop the balance has the slope of its other side, on which the coordinate goes on as it did.
  constexpr double beside = 1e-9, first = 1e-7; // scaled
  const double way = stop->grows ? 1 : -1;
  BranchState corner = state, next;
  corner.z.q[stop->q] = stop->limit + way * beside * problem.scaling.column[stop->v];
  int iterations = 0;
  try {
    if (!continuation_.start(corner, way * Eigen::VectorXd::Unit(state.tangent.size(), stop->v)) ||
        !continuation_.step(corner, first, next, iterations) || next.tangent.dot(corner.tangent) < 0.97 ||
        (next.z.q[stop->q] - stop->limit) * way <= 0 || !holds_at_every_phase(next))
      return {};
  } catch (const SceneError&) { // no mechanism can be made there
    return {};
  }
  return next;
}

void BranchFollower::land_on_border(const BranchState& state, double border, FollowedBranch& out) {
  if (std::abs(state.parameter - border) < 1e-12 * family_.scale()) return;
  constexpr int most_tries = 200;
  BranchState near = state; // and nearer, where the state changes too much on the way
  double step = border - state.parameter;
  for (int i = 0; i < most_tries; ++i) {
    const bool whole = std::abs(step) >= std::abs(border - near.parameter);
    BranchState last = near;
    last.parameter = whole ? border : near.parameter + step;
    if (!continuation_.land(last) || !same_place(last, near, 0.2)) {
      step = (last.parameter - near.parameter) / 2;
    } else if (whole) {
      out.points.push_back(point(last));
      out.states.push_back(std::move(last));
      return;
    } else {
      near = std::move(last);
      step *= 2;
    }
  }
}

FollowedBranch BranchFollower::follow(BranchState state, bool tell_progress) {
  FollowedBranch out;
  const Interruptible scope(options_.cancel);
  try {
    follow(state, tell_progress, out);
    if (out.drifts && state.still.cols() > 0) { // what it was followed across resists after all
      const Eigen::VectorXd along = state.tangent;
      state.still.resize(system_.nv, 0);
      state.drifts = true;
      if (continuation_.start(state, along)) {
        out = {};
        follow(std::move(state), tell_progress, out);
      }
    }
  } catch (const Interrupted&) {
    out.end = "cancelled"; // what was found until then stays
    if (out.points.empty()) throw;
    out.states.resize(std::min(out.points.size(), out.states.size()));
    out.points.resize(out.states.size());
  }
  return out;
}

void BranchFollower::follow(BranchState state, bool tell_progress, FollowedBranch& out) {
  const BranchState origin = state;
  Described now = describe(state);
  out.points.push_back(now.point);
  out.states.push_back(state);
  out.drifts = state.drifts;
  drifting_ = drifting_ || out.drifts;
  constexpr int most_leaps = 64;
  int leaps = 0;
  // A shorter step from the same state meets it again.
  std::optional<Crossing> crossing;
  double length = options_.largest_step / 4;
  // Where the number changed last, and the largest of the speeds that are found there.
  double changed = state.parameter, fastest = fastest_found(family_.problem(), state.z.q);
  out.end = "the largest number of points";
  while (out.points.size() < static_cast<std::size_t>(options_.max_points)) {
    if (cancelled()) {
      out.end = "cancelled";
      break;
    }
    BranchState next;
    int iterations = 0;
    bool stepped = false;
    std::string impossible; // of what the parameter would make
    try {
      stepped = continuation_.step(state, length, next, iterations);
    } catch (const InfiniteRate& error) {
      impossible = infinite_rate_text(error);
    } catch (const SceneError& error) {
      impossible = std::string("beyond it no mechanism can be made: ") + error.what();
    }
    const bool straight = stepped && next.tangent.dot(state.tangent) >= 0.97;
    const bool corner =
        stepped && !straight && length < tolerance::longest_corner; // no shorter step is straight
    if (!straight && !corner) {
      length /= 2;
      if (length > tolerance::least_branch_step) continue;
      if (std::optional<BranchState> beyond; impossible.empty() && (beyond = beyond_stop(state))) {
        if (state.turning * beyond->turning < 0) out.special.emplace_back(SpecialPointType::fold, now.point);
        state = std::move(*beyond);
        now = describe(state);
        out.points.push_back(now.point);
        out.states.push_back(state);
        crossing.reset();
        length = options_.largest_step / 4;
        continue;
      }
      const bool ends = position(state.parameter) > 0.5;
      const double border = ends ? to_ : from_;
      if (impossible.empty()) {
        out.end = stop_ahead(family_.problem(), state)
                      ? "the corrector fails at a stop"
                      : "the corrector fails: the loops lock or a part of the mechanism becomes singular";
      } else if (std::abs(state.parameter - border) < at_border * family_.scale()) {
        land_on_border(state, border, out);
        out.end = ends ? "the end of the range" : "the beginning of the range";
      } else {
        out.end = impossible;
      }
      break;
    }
    try {
      const bool known = crossing && crossing->along <= length && state.determinant * next.determinant < 0;
      if (!known) crossing = find_crossing(state, next, length);
    } catch (const SceneError&) { // at a place between them: told below
    }
    const double shortest = options_.largest_step / 64;
    if (straight && length >= shortest && crossing && crossing->leaps) {
      if (++leaps == most_leaps) { // the determinant's sign is rounding
        state.drifts = drifting_ = true;
        crossing.reset();
        continue;
      }
      do
        length /= 2;
      while (length >= shortest && length > crossing->along);
      continue;
    }
    const double p = position(next.parameter);
    if (p > 1 || p < 0) {
      find_specials_inside(state, next, length, now, crossing, out);
      land_on_border(state, p > 1 ? to_ : from_, out);
      out.end = p > 1 ? "the end of the range" : "the beginning of the range";
      break;
    }
    if (!holds_at_every_phase(next)) {
      out.end = "beyond it the balance turns with the drives: there is no steady state";
      break;
    }
    Described then = describe(next);
    try {
      find_specials(state, next, length, now, then, crossing, out);
      if (turns_with_drives(now.point) && turns_with_drives(then.point))
        find_multiplier_crossing(state, next, length, out);
    } catch (const InfiniteRate& error) { // at a place between them
      out.end = infinite_rate_text(error);
      break;
    } catch (const SceneError&) { // no mechanism can be made a little beyond: the next step ends there
    }
    out.points.push_back(then.point);
    out.states.push_back(next);
    out.drifts = out.drifts || next.drifts || next.still.cols() != state.still.cols();
    drifting_ = drifting_ || out.drifts;
    if (out.drifts && origin.still.cols() > 0) return; // to be followed otherwise
    report_progress(options_.progress, tell_progress ? "following" : "following another branch", p);
    if (out.points.size() > 6 && std::abs(next.parameter - origin.parameter) < length * family_.scale()) {
      const BranchState last = nearest_of_family({next}, origin);
      if (same_place(last, origin, length) && last.tangent.dot(origin.tangent) > 0.9) {
        out.end = closed_branch;
        out.closed = true;
        break;
      }
    }
    if (out_of_reach(family_.problem(), next.z.q)) {
      out.end = "a coordinate or a speed leaves all bounds";
      break;
    }
    // As towards the load that a torque comes to only at any speed: beyond, the number is rounding.
    constexpr double without_end = 1000, stands = 1e-8;
    if (const double now_fastest = fastest_found(family_.problem(), next.z.q);
        std::abs(next.parameter - changed) > stands * family_.scale()) {
      changed = next.parameter;
      fastest = now_fastest;
    } else if (now_fastest > without_end * (1 + fastest)) {
      out.end = "a speed grows more than a thousandfold there, while the number stays where it is";
      break;
    }
    state = std::move(next);
    now = std::move(then);
    crossing.reset();
    // Bands in which the drives pump a motion up are narrow.
    const double longest =
        options_.largest_step / size_of(state, state.tangent) * (turns_with_drives(now.point) ? 0.25 : 1);
    if (corner)
      length = options_.largest_step / 4;
    else
      length = std::min(longest, length * (iterations <= 3 ? 1.5 : iterations > 5 ? 0.6 : 1.));
  }
}

std::optional<BranchState> BranchFollower::off(const BranchState& crossing, double length) {
  BranchState first;
  try {
    if (!continuation_.switch_branch(crossing, length, first)) return {};
  } catch (const SceneError&) { // no mechanism can be made there
    return {};
  }
  if (position(first.parameter) < 0 || position(first.parameter) > 1) return {};
  return first;
}

} // namespace flyball
