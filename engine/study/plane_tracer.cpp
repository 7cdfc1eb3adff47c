#include "engine/study/plane_tracer.hpp"

#include "engine/continuation/continuation.hpp"
#include "engine/continuation/crossing_pair.hpp"
#include "engine/search/all_equilibria.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/linear_motion.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

bool PlaneTracer::start(ExtendedState& state, int fixed) {
  const ExtendedState near = state;
  prepare(near);
  return balance_.correct(state, unit(fixed)).converged && intact(state) && finish_step(near, state);
}

TracedCurve PlaneTracer::both_ways(const ExtendedState& state, int fixed, std::string& begin) {
  Eigen::VectorXd tangent = balance_.tangent(state, unit(fixed));
  if (tangent.size() == 0) tangent = balance_.tangent(state, unit(1 - fixed));
  if (tangent.size() == 0) return {};
  TracedCurve ahead = follow(state, tangent);
  if (ahead.closed) return ahead;
  TracedCurve out = follow(state, -tangent);
  begin = out.end;
  std::ranges::reverse(out.states);
  std::ranges::reverse(out.tangents);
  std::ranges::reverse(out.cusps);
  for (Eigen::VectorXd& t : out.tangents)
    t = -t;
  out.states.insert(out.states.end(), ahead.states.begin() + 1, ahead.states.end());
  out.tangents.insert(out.tangents.end(), ahead.tangents.begin() + 1, ahead.tangents.end());
  out.cusps.insert(out.cusps.end(), ahead.cusps.begin(), ahead.cusps.end());
  out.takens.insert(out.takens.end(), ahead.takens.begin(), ahead.takens.end());
  out.end = ahead.end;
  return out;
}

bool PlaneTracer::lies_on(const ExtendedState& state, const TracedCurve& curve) {
  std::size_t nearest = 0;
  double least = 2 * options_.largest_step;
  Eigen::VectorXd away;
  for (std::size_t i = 0; i < curve.states.size(); ++i) {
    if (curve.states[i].starts.size() != state.starts.size())
      continue; // these stand turned, or the other does
    const Eigen::VectorXd d = difference(curve.states[i], state);
    const double pair = std::max(std::abs(curve.states[i].pair), std::abs(state.pair));
    if (d.norm() >= least || std::abs(curve.states[i].pair - state.pair) > 0.3 * pair) continue;
    least = d.norm();
    away = d;
    nearest = i;
  }
  if (away.size() == 0) return false;
  if (least < 1e-6) return true;
  ExtendedState there;
  return step(curve.states[nearest], curve.tangents[nearest], curve.tangents[nearest].dot(away), there) > 0 &&
         difference(there, state).norm() < 1e-2 * least;
}

Eigen::VectorXd PlaneTracer::unit(int parameter) const {
  return Eigen::VectorXd::Unit(balance_.unknowns(), balance_.unknowns() - 2 + parameter);
}

Eigen::Vector2d PlaneTracer::position(const ExtendedState& s) const {
  return (s.parameters - low_).cwiseQuotient(high_ - low_);
}

bool PlaneTracer::inside(const ExtendedState& s) const {
  const Eigen::Vector2d p = position(s);
  return p.minCoeff() >= -1e-12 && p.maxCoeff() <= 1 + 1e-12;
}

Eigen::VectorXd PlaneTracer::difference(const ExtendedState& a, const ExtendedState& b) const {
  Eigen::VectorXd out(balance_.unknowns()), turned;
  if (balance_.ties()) turned = angles_between(balance_.problem(), *balance_.ties(), a.starts, b.starts);
  out << scaled_difference(balance_.problem(), a.z.q, b.z.q), turned,
      (b.parameters - a.parameters).cwiseQuotient(balance_.scales());
  return out;
}

void PlaneTracer::prepare(const ExtendedState& state) {
  if (type_ == PlaneCurveType::fold || type_ == PlaneCurveType::branch_point) balance_.set_borders(state);
}

// Of a pair of eigenvalues: the same pair is followed on. False where it changed too much to be sure of that.
bool PlaneTracer::finish_step(const ExtendedState& from, ExtendedState& to) {
  if (type_ != PlaneCurveType::hopf) return true;
  const auto product = pair_product(balance_, to);
  if (!product) return false;
  to.pair = *product;
  pair_scale_ = std::max(pair_scale_, std::abs(to.pair));
  return std::abs(to.pair - from.pair) <= 0.3 * std::max(std::abs(from.pair), 0.1 * pair_scale_);
}

int PlaneTracer::step(const ExtendedState& from, const Eigen::VectorXd& tangent, double length,
                      ExtendedState& to) {
  prepare(from);
  to = from;
  balance_.move(to, length * tangent);
  balance_.set(to);
  const ExtendedOutcome outcome = balance_.correct(to, tangent);
  return outcome.converged && finish_step(from, to) ? std::max(1, outcome.iterations) : 0;
}

TracedCurve PlaneTracer::follow(ExtendedState state, Eigen::VectorXd tangent) {
  TracedCurve out;
  out.states.push_back(state);
  out.tangents.push_back(tangent);
  const ExtendedState origin = state;
  const Eigen::VectorXd first = tangent;
  double length = options_.largest_step / 4;
  out.end = "the largest number of points";
  for (int i = 1; i < options_.max_points; ++i) {
    if (options_.cancel && options_.cancel->load(std::memory_order_relaxed)) {
      out.end = "cancelled";
      break;
    }
    ExtendedState next;
    const int iterations = step(state, tangent, length, next);
    Eigen::VectorXd onward;
    if (iterations > 0) onward = balance_.tangent(next, tangent);
    if (onward.size() == 0 || onward.dot(tangent) < 0.97) {
      length /= 2;
      if (length > 1e-7) continue;
      out.end = "the corrector fails";
      break;
    }
    if (!intact(next)) {
      out.end = "the crossing comes apart";
      break;
    }
    if (!one_motion(next)) {
      out.end = "beyond it the motion turns with the drives";
      break;
    }
    if (type_ == PlaneCurveType::hopf && !(next.pair > 0)) {
      ExtendedState zero;
      if (!double_zero(state, tangent, length, zero)) {
        out.end = "the corrector fails where the frequency goes to zero";
        break;
      }
      if (inside(zero)) {
        out.takens.push_back(zero);
        out.states.push_back(std::move(zero));
        out.tangents.push_back(tangent);
        out.end = "the frequency goes to zero: a point of Bogdanov and Takens";
        break;
      }
      next = std::move(zero);
    }
    if (!inside(next)) {
      land_on_border(state, tangent, length, next, out);
      out.end = "the border of the plane";
      break;
    }
    if (type_ == PlaneCurveType::fold && onward.tail<2>().dot(tangent.tail<2>()) < 0)
      out.cusps.push_back(cusp(state, tangent, length));
    out.states.push_back(next);
    out.tangents.push_back(onward);
    if (i > 5 && difference(origin, next).norm() < length && onward.dot(first) > 0.9) {
      out.states.push_back(origin);
      out.tangents.push_back(first);
      out.end = "closed";
      out.closed = true;
      break;
    }
    if (out_of_reach(balance_.problem(), next.z.q)) {
      out.end = "a coordinate or a speed leaves all bounds";
      break;
    }
    state = std::move(next);
    tangent = std::move(onward);
    length = std::min(options_.largest_step, length * (iterations <= 4 ? 1.5 : iterations > 6 ? 0.6 : 1.));
  }
  return out;
}

// Eigenvalues tell of a motion that is the same at every phase of the drives, about a state that holds at
// each.
bool PlaneTracer::one_motion(const ExtendedState& s) {
  if (type_ != PlaneCurveType::hopf) return true;
  balance_.set(s);
  const Problem p = balance_.problem();
  const std::vector<double> phases = sample_phases(p.system, p.parameters, s.z.q);
  return check_existence(p, s.z.q, phases, balance_.workspace()).holds &&
         !motion_varies(p, s.z.q, phases, balance_.workspace());
}

// Where the curve turns round in the plane: its direction there changes sign.
ExtendedState PlaneTracer::cusp(const ExtendedState& state, const Eigen::VectorXd& tangent, double length) {
  double low = 0, high = length;
  ExtendedState at = state, probe;
  while (high - low > 1e-10) {
    const double middle = (low + high) / 2;
    if (step(state, tangent, middle, probe) == 0) break;
    const Eigen::VectorXd there = balance_.tangent(probe, tangent);
    if (there.size() == 0) break;
    at = probe;
    (there.tail<2>().dot(tangent.tail<2>()) < 0 ? high : low) = middle;
  }
  return at;
}

// Where the product of the pair goes through zero along a step.
bool PlaneTracer::double_zero(const ExtendedState& state, const Eigen::VectorXd& tangent, double length,
                              ExtendedState& out) {
  double low = 0, high = length;
  ExtendedState probe;
  out = state;
  while (high - low > 1e-14) {
    const double middle = (low + high) / 2;
    if (step(state, tangent, middle, probe) == 0) return false;
    out = probe;
    (out.pair > 0 ? low : high) = middle;
  }
  out.pair = 0;
  return true;
}

void PlaneTracer::land_on_border(const ExtendedState& state, const Eigen::VectorXd& tangent, double length,
                                 const ExtendedState& next, TracedCurve& out) {
  const Eigen::Vector2d here = position(state), there = position(next);
  int border = 0;
  double part = 2;
  for (int i : {0, 1}) {
    if (there[i] >= 0 && there[i] <= 1) continue;
    const double to_border = ((there[i] > 1 ? 1 : 0) - here[i]) / (there[i] - here[i]);
    if (to_border < part) {
      part = to_border;
      border = i;
    }
  }
  if (part < 1e-9) return; // stands on it
  prepare(state);
  ExtendedState last = state;
  balance_.move(last, part * length * tangent);
  const double at_border = there[border] > 1 ? high_[border] : low_[border];
  last.parameters[border] = at_border;
  balance_.set(last);
  if (!balance_.correct(last, unit(border)).converged) return;
  last.parameters[border] = at_border; // without the rounding of the corrections
  if (!inside(last)) return;
  if (difference(state, last).norm() > 2 * length || !finish_step(state, last)) return;
  out.states.push_back(last);
  out.tangents.push_back(tangent);
}

} // namespace flyball
