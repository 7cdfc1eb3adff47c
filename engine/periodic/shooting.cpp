#include "engine/periodic/shooting.hpp"

#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double closed = 1e-11;         // scaled gap: what is left is rounding
constexpr double nearly_closed = 1e-8;   // and so it is here, where an iteration makes it no less
constexpr double newton_step = 1e-3;     // scaled, of differences that only Newton's method rests on:
constexpr double newton_tolerance = 1e3; // times the tolerance is enough for them
constexpr double largest_step = 0.5;     // scaled, of the coordinates in an iteration
constexpr double straight = 0.1;         // of the gap: a step that leaves no more found the map nearly linear
constexpr double singular = 1e-7;        // of the largest singular value: differences are no better
constexpr double nearly_singular = 1e-4; // differences are to be better, to tell it from singular
constexpr double moves = 0.01;           // of what is asked: a state that changes by less does not
constexpr double unreachable = 0.1;      // of the gap: so much of it is no step's to close
constexpr double multiplier_step = 4e-3; // scaled, at first
constexpr double noise = 1;              // of the tolerance over a step: what is left in the best differences

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// By central differences over a step along each coordinate of `from`: rates of the coordinates at the end, of
// `to`, and at the beginning, where loops are closed again: a turn of one that moves changes the rates of
// others in first order.
struct Rates {
  Matrix begin, end;
};
std::optional<Rates> differences(Flow& flow, const StateChart& from, const StateChart& to, double duration,
                                 double tolerance, double step) {
  Rates out{Matrix(from.size(), from.size()), Matrix(to.size(), from.size())};
  for (Eigen::Index k = 0; k < from.size(); ++k) {
    const auto beside = [&](double h) {
      return flow.pass(from.displaced(h * Vector::Unit(from.size(), k)), duration, tolerance);
    };
    const auto forth = beside(step), back = forth ? beside(-step) : std::nullopt;
    if (!back) return {};
    out.begin.col(k) = (from.coordinates(forth->from) - from.coordinates(back->from)) / (2 * step);
    out.end.col(k) = (to.coordinates(forth->to) - to.coordinates(back->to)) / (2 * step);
  }
  return out;
}

// d(coordinates at the end) / d(those at the beginning). Rates of what has no momentum follow from the rest:
// along those nothing begins otherwise, and the derivative is zero.
std::optional<Matrix> derivative(const std::optional<Rates>& rates) {
  if (!rates) return {};
  if (rates->begin.size() == 0) return rates->end;
  const auto svd = singular_vectors(rates->begin);
  if (!svd) return {};
  const Eigen::Index rank = (svd->values.array() > moves).count();
  return Matrix(rates->end * svd->right.leftCols(rank) * svd->values.head(rank).cwiseInverse().asDiagonal() *
                svd->left.leftCols(rank).transpose());
}

class Shooter {
 public:
  Shooter(Flow& flow, const ShootingOptions& options) : flow_(flow), options_(options) {
    orbit_.period = options.period;
  }

  Orbit run(const std::vector<FlowState>& guess) {
    if (!place(guess, options_.tolerance)) return ended(end_of(flow_));
    for (;;) {
      const double gap = largest_gap();
      orbit_.residual = gap;
      orbit_.history.push_back(gap);
      const bool still = orbit_.iterations > 0 && gap > 0.5 * orbit_.history.end()[-2];
      // Without an iteration it is not known yet in how many directions others lie beside it.
      if (orbit_.iterations > 0 && (gap <= closed || (gap <= nearly_closed && still)))
        return ended(ShootingEnd::converged);
      if (orbit_.iterations == options_.iterations) return ended(ShootingEnd::diverged);
      if (!(nearly_linear_ && advance_again(gap))) {
        Vector step;
        bool reachable = true;
        if (!newton(step, reachable)) return ended(end_of(flow_));
        if (gap <= closed) return ended(ShootingEnd::converged);
        if (!reachable)
          return ended(gap <= nearly_closed && is_rounding() ? ShootingEnd::converged : ShootingEnd::pumped);
        if (!advance(step, gap))
          return ended(gap <= nearly_closed ? ShootingEnd::converged
                       : moved_             ? ShootingEnd::diverged
                                            : end_of(flow_));
        nearly_linear_ = largest_gap() <= straight * gap;
      }
      ++orbit_.iterations;
    }
  }

  std::optional<Orbit> beside(const Orbit& orbit, double coarser) {
    std::vector<FlowState> states;
    for (const StateChart& node : orbit.nodes)
      states.push_back(node.base());
    Vector step;
    bool reachable = true;
    if (!place(states, coarser * options_.tolerance) || !newton(step, reachable)) return {};
    if (!place(displaced(step, orbit_.nodes, orbit_.period), options_.tolerance)) return {};
    return std::move(orbit_);
  }

 private:
  Orbit ended(ShootingEnd end) {
    orbit_.end = end;
    return std::move(orbit_);
  }
  std::size_t segments() const { return orbit_.nodes.size(); }
  double duration() const { return orbit_.period / static_cast<double>(segments()); }
  const StateChart& after(std::size_t i) const { return orbit_.nodes[(i + 1) % segments()]; }

  // Takes states as the nodes, their loops closed, and looks where each segment ends.
  bool place(const std::vector<FlowState>& states, double tolerance) {
    std::vector<StateChart> nodes;
    std::vector<FlowState> ends;
    for (const FlowState& state : states) {
      const auto passage = flow_.pass(state, orbit_.period / static_cast<double>(states.size()), tolerance);
      if (!passage) return false;
      nodes.emplace_back(flow_.problem(), passage->from, options_.rate, options_.alike);
      ends.push_back(passage->to);
    }
    orbit_.nodes = std::move(nodes);
    ends_ = std::move(ends);
    return true;
  }

  double largest_gap() const {
    double gap = 0;
    for (std::size_t i = 0; i < segments(); ++i)
      gap = std::max(gap, after(i).distance(ends_[i]));
    return gap;
  }

  void take_gaps() {
    const Eigen::Index n = orbit_.nodes.front().size();
    gaps_.setZero(n * static_cast<Eigen::Index>(segments()) + (options_.find_period ? 1 : 0));
    for (std::size_t i = 0; i < segments(); ++i)
      gaps_.segment(n * static_cast<Eigen::Index>(i), n) = after(i).coordinates(ends_[i]);
  }

  // The step of Newton's method, by coarse differences where these are enough. False where the flow leads
  // nowhere.
  bool newton(Vector& step, bool& reachable) {
    for (const double coarser : {newton_tolerance, 1.}) {
      if (!linearise(coarser * options_.tolerance)) return false;
      reachable = solve(step);
      if (!doubtful_) break;
    }
    return true;
  }

  // E_i s_i - B_(i+1) s_(i+1) + p_i dT = -r_i, where steps s_i begin with B_i s_i and end with E_i s_i, and
  // the phase of a motion without one of its own.
  bool linearise(double tolerance) {
    const Eigen::Index n = orbit_.nodes.front().size(), m = static_cast<Eigen::Index>(segments());
    const Eigen::Index extra = options_.find_period ? 1 : 0;
    matrix_.setZero(n * m + extra, n * m + extra);
    begin_.clear();
    take_gaps();
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto rates = differences(flow_, orbit_.nodes[at], after(at), duration(), tolerance, newton_step);
      if (!rates) return false;
      matrix_.block(n * i, n * i, n, n) += rates->end;
      matrix_.block(n * ((i + m - 1) % m), n * i, n, n) -= rates->begin;
      begin_.push_back(rates->begin);
      if (!options_.find_period) continue;
      const auto going = velocity(ends_[at], after(at));
      if (!going) return false;
      matrix_.block(n * i, n * m, n, 1) = *going / static_cast<double>(m);
    }
    if (extra == 0) return true;
    const auto begin = velocity(orbit_.nodes.front().base(), orbit_.nodes.front());
    if (!begin) return false;
    matrix_.block(n * m, 0, 1, n) = begin->transpose() / std::max(begin->norm(), 1e-300);
    return true;
  }

  // The rate at which a chart's coordinates change there, in the motion.
  std::optional<Vector> velocity(const FlowState& state, const StateChart& chart) {
    const double dt = 1e-4 / options_.rate;
    const auto once = flow_.pass(state, dt, options_.tolerance),
               twice = once ? flow_.pass(state, 2 * dt, options_.tolerance) : std::nullopt;
    if (!twice) return {};
    const Vector x = chart.coordinates(once->from);
    return (4 * (chart.coordinates(once->to) - x) - (chart.coordinates(twice->to) - x)) / (2 * dt);
  }

  // In how many of the directions (by column) the states move: rates of what has no momentum follow from the
  // rest whatever they are asked to be.
  int moving(const Matrix& directions) const {
    if (directions.cols() == 0) return 0;
    const Eigen::Index n = orbit_.nodes.front().size();
    Matrix moved(n * static_cast<Eigen::Index>(segments()), directions.cols());
    for (std::size_t i = 0; i < segments(); ++i) {
      const Eigen::Index at = n * static_cast<Eigen::Index>(i);
      moved.middleRows(at, n) = begin_[i] * directions.middleRows(at, n);
    }
    const auto svd = singular_vectors(moved);
    return svd ? static_cast<int>((svd->values.array() > moves).count()) : 0;
  }

  // The shortest step that closes the gaps, as far as steps do. False where no step closes much of them.
  bool solve(Vector& step) {
    step.setZero(matrix_.cols());
    doubtful_ = false;
    if (matrix_.size() == 0) return true;
    const auto svd = singular_vectors(matrix_);
    if (!svd) return false;
    const double least = singular * std::max(1., svd->values[0]);
    const Eigen::Index rank = (svd->values.array() > least).count();
    doubtful_ = (svd->values.array() < least / singular * nearly_singular).any();
    orbit_.neutral = moving(svd->right.rightCols(svd->values.size() - rank));
    const Vector along = svd->left.transpose() * gaps_;
    unclosed_ = svd->left.rightCols(along.size() - rank);
    step = -svd->right.leftCols(rank) * along.head(rank).cwiseQuotient(svd->values.head(rank));
    return along.tail(along.size() - rank).norm() <= unreachable * gaps_.norm();
  }

  // Whether the part of the gaps that no step closes is no more than the error of the motion's steps: steps
  // of a hundred times the tolerance change it by as much.
  bool is_rounding() {
    const Vector fine = unclosed_.transpose() * gaps_;
    if (fine.norm() <= 100 * options_.tolerance) return true;
    Vector coarse = Vector::Zero(gaps_.size());
    const Eigen::Index n = orbit_.nodes.front().size();
    for (std::size_t i = 0; i < segments(); ++i) {
      const auto passage = flow_.pass(orbit_.nodes[i].base(), duration(), 100 * options_.tolerance);
      if (!passage) return false;
      coarse.segment(n * static_cast<Eigen::Index>(i), n) = after(i).coordinates(passage->to);
    }
    return (unclosed_.transpose() * coarse - fine).norm() >= 0.5 * fine.norm();
  }

  // The nodes moved by a step, and the period with it.
  std::vector<FlowState> displaced(const Vector& step, const std::vector<StateChart>& nodes, double period) {
    const Eigen::Index n = nodes.front().size();
    if (options_.find_period) orbit_.period = period + step[step.size() - 1];
    std::vector<FlowState> states;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      states.push_back(nodes[i].displaced(step.segment(n * static_cast<Eigen::Index>(i), n)));
      if (options_.find_period)
        states.back().time = orbit_.period * static_cast<double>(i) / static_cast<double>(nodes.size());
    }
    return states;
  }

  // How far a step goes along the coordinates: rad of what turns, scaled of what slides.
  struct Extent {
    double turned = 0, slid = 0;
  };
  Extent extent(const Vector& step) const {
    const Problem problem = flow_.problem();
    const StateChart& chart = orbit_.nodes.front();
    Extent out;
    for (std::size_t i = 0; i < segments(); ++i) {
      const Vector change = orbit_.nodes[i].place_change(
          step.segment(chart.size() * static_cast<Eigen::Index>(i), chart.size()));
      for (const Link& link : problem.system.links) {
        if (link.v < 0) continue;
        const int count = link.type == LinkType::spherical ? 3 : 1;
        const double moved = change.segment(link.v, count)
                                 .cwiseQuotient(problem.scaling.column.segment(link.v, count))
                                 .lpNorm<Eigen::Infinity>();
        double& most = link.type == LinkType::prismatic ? out.slid : out.turned;
        most = std::max(most, moved);
      }
    }
    return out;
  }

  // The longest of the parts 1, 1/2, ... of a step after which the gaps are less. Where slides alone go far
  // all of it is tried first: a motion may be many times as large as the mechanism, and the map linear.
  bool advance(const Vector& step, double gap) {
    const Extent far = extent(step);
    const double longest = std::max(far.turned, far.slid), period = orbit_.period;
    const std::vector<StateChart> nodes = orbit_.nodes;
    const std::vector<FlowState> ends = ends_;
    double part = longest > largest_step ? largest_step / longest : 1;
    if (options_.find_period)
      part = std::min(part, 0.2 * period / std::max(std::abs(step[step.size() - 1]), 1e-300));
    else if (part < 1 && far.turned <= largest_step &&
             place(displaced(step, nodes, period), options_.tolerance) && largest_gap() <= straight * gap)
      return true;
    moved_ = false;
    for (int halved = 0; halved < 6; ++halved, part /= 2) {
      if (place(displaced(part * step, nodes, period), options_.tolerance)) {
        moved_ = true;
        if (largest_gap() < gap) return true;
      } else if (flow_.spent() || flow_.cancelled()) {
        moved_ = false;
        break;
      }
    }
    orbit_.period = period;
    orbit_.nodes = nodes;
    ends_ = ends;
    return false;
  }

  // A step by the matrix of the last one, which takes one motion a segment instead of two for each
  // coordinate (simplified Newton method). False where it leaves more than a tenth of the gap; nothing has
  // moved then.
  bool advance_again(double gap) {
    take_gaps();
    Vector step;
    if (!solve(step)) return false;
    const std::vector<StateChart> nodes = orbit_.nodes;
    const std::vector<FlowState> ends = ends_;
    const double period = orbit_.period;
    if (place(displaced(step, nodes, period), options_.tolerance) && largest_gap() <= straight * gap)
      return true;
    orbit_.period = period;
    orbit_.nodes = nodes;
    ends_ = ends;
    return false;
  }

  Flow& flow_;
  const ShootingOptions& options_;
  Orbit orbit_;
  std::vector<FlowState> ends_; // of the segments
  Matrix matrix_;
  Vector gaps_;
  std::vector<Matrix> begin_;  // by segment: how its states move as their coordinates do
  Matrix unclosed_;            // by column: parts of the gaps that no step closes
  bool doubtful_ = false;      // the matrix may be singular, but for the errors of differences
  bool nearly_linear_ = false; // the last step left no more than a tenth of the gap
  bool moved_ = false;         // some part of the last step led to motions that last
};

// Extrapolated differences of a segment, and the same by as much off as their error may be, in the way in
// which the last extrapolation changed them: by that, and by no less than the motion's tolerance leaves in
// differences over the shortest step. Of a linear map two steps tell as much as three.
struct Extrapolated {
  Matrix best, off;
  double error = 0; // estimated, of each entry
};
std::optional<Extrapolated> extrapolate(Flow& flow, const StateChart& from, const StateChart& to,
                                        double duration, double tolerance) {
  std::optional<Extrapolated> out;
  // Shorter steps where the map is too bent for longer ones.
  for (const double h : {multiplier_step, multiplier_step / 100}) {
    const auto map = [&](double step) {
      return derivative(differences(flow, from, to, duration, tolerance, step));
    };
    const auto d1 = map(h), d2 = d1 ? map(h / 2) : std::nullopt;
    if (!d2) return out;
    const Matrix bend = (*d2 - *d1) / 3, once = *d2 + bend;
    if (const double left = noise * tolerance / (h / 2), bent = largest_size(bend); bent <= left)
      return Extrapolated{once, bent > 0 ? Matrix(once + left / bent * bend) : once, left};
    const auto d3 = map(h / 4);
    if (!d3) return out;
    const Matrix twice = (4 * *d3 - *d2) / 3, change = (twice - once) / 15;
    const double changed = largest_size(change), floor = noise * tolerance / (h / 4);
    const double error = std::max(changed, floor);
    const Matrix best = twice + change;
    if (!out || error < out->error)
      out = {best, changed > 0 ? Matrix(best + error / changed * change) : best, error};
    if (out->error <= std::max(floor, 1e-7 * std::max(1., largest_size(twice)))) break;
  }
  return out;
}

} // namespace

ShootingEnd end_of(const Flow& flow) {
  return flow.cancelled() ? ShootingEnd::cancelled
         : flow.spent()   ? ShootingEnd::spent
                          : ShootingEnd::no_motion;
}

Orbit shoot(Flow& flow, const std::vector<FlowState>& guess, const ShootingOptions& options) {
  return Shooter(flow, options).run(guess);
}

std::optional<Orbit> orbit_beside(Flow& flow, const Orbit& orbit, const ShootingOptions& options,
                                  double coarser) {
  ShootingOptions at = options;
  at.period = orbit.period;
  return Shooter(flow, at).beside(orbit, coarser);
}

std::optional<Monodromy> monodromy(Flow& flow, const Orbit& orbit, const ShootingOptions& options) {
  const std::size_t m = orbit.nodes.size();
  const double duration = orbit.period / static_cast<double>(m);
  const Eigen::Index n = orbit.nodes.front().size();
  Monodromy out;
  Matrix best = Matrix::Identity(n, n), off = best;
  for (std::size_t i = 0; i < m; ++i) {
    const auto segment =
        extrapolate(flow, orbit.nodes[i], orbit.nodes[(i + 1) % m], duration, options.tolerance);
    if (!segment) return {};
    best = (segment->best * best).eval();
    off = (segment->off * off).eval();
    out.error = std::max(out.error, segment->error);
  }
  out.matrix = best;
  if (n == 0) return out;
  auto multipliers = eigenvalues(best);
  const auto others = eigenvalues(off);
  if (!multipliers || !others) return {};
  std::ranges::sort(*multipliers, [](const auto& a, const auto& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  for (const auto& mu : *multipliers) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& other : *others)
      nearest = std::min(nearest, std::abs(mu - other));
    out.error = std::max(out.error, nearest);
  }
  out.multipliers = std::move(*multipliers);
  return out;
}

} // namespace flyball
