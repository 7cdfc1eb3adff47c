#include "engine/study/fold_curve.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/extended_balance.hpp"
#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/search/all_equilibria.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/study/design.hpp"
#include "engine/study/wanted.hpp"

#include <algorithm>
#include <chrono>

namespace flyball {
namespace {

// Curves of crossings go by matrices, with four factorizations for each coordinate a step.
constexpr int largest_for_crossings = 100;

// One of the curves, as it is solved for.
struct Traced {
  std::vector<ExtendedState> states;
  std::vector<Eigen::VectorXd> tangents;
  std::vector<ExtendedState> cusps;
  std::string end;
  bool closed = false;
};

// Follows the solutions of one balance with its conditions through the box of the plane.
class Tracer {
 public:
  Tracer(ExtendedBalance& balance, const PlaneAxis& x, const PlaneAxis& y, PlaneCurveType type,
         const PlaneOptions& options)
      : balance_(balance), low_(x.from, y.from), high_(x.to, y.to), type_(type), options_(options) {}

  // A point of the curve near `state` with parameter `fixed` as it is. False where there is none.
  bool start(ExtendedState& state, int fixed) {
    if (type_ != PlaneCurveType::value) balance_.set_borders(state);
    return balance_.correct(state, unit(fixed)).converged && intact(state);
  }

  // Both ways from a point of the curve, joined to one; `fixed` is the parameter to move off first.
  Traced both_ways(const ExtendedState& state, int fixed, std::string& begin) {
    Eigen::VectorXd tangent = balance_.tangent(state, unit(fixed));
    if (tangent.size() == 0) tangent = balance_.tangent(state, unit(1 - fixed));
    if (tangent.size() == 0) return {};
    Traced ahead = follow(state, tangent);
    if (ahead.closed) return ahead;
    Traced out = follow(state, -tangent);
    begin = out.end;
    std::ranges::reverse(out.states);
    std::ranges::reverse(out.tangents);
    std::ranges::reverse(out.cusps);
    for (Eigen::VectorXd& t : out.tangents)
      t = -t;
    out.states.insert(out.states.end(), ahead.states.begin() + 1, ahead.states.end());
    out.tangents.insert(out.tangents.end(), ahead.tangents.begin() + 1, ahead.tangents.end());
    out.cusps.insert(out.cusps.end(), ahead.cusps.begin(), ahead.cusps.end());
    out.end = ahead.end;
    return out;
  }

  bool lies_on(const ExtendedState& state, const Traced& curve) {
    std::size_t nearest = 0;
    double least = 2 * options_.largest_step;
    Eigen::VectorXd away;
    for (std::size_t i = 0; i < curve.states.size(); ++i) {
      const Eigen::VectorXd d = difference(curve.states[i], state);
      if (d.norm() >= least) continue;
      least = d.norm();
      away = d;
      nearest = i;
    }
    if (away.size() == 0) return false;
    if (least < 1e-6) return true;
    ExtendedState there;
    return step(curve.states[nearest], curve.tangents[nearest], curve.tangents[nearest].dot(away), there) >
               0 &&
           difference(there, state).norm() < 1e-2 * least;
  }

 private:
  Eigen::VectorXd unit(int parameter) const {
    return Eigen::VectorXd::Unit(balance_.unknowns(), balance_.unknowns() - 2 + parameter);
  }
  bool intact(const ExtendedState& s) const { return std::abs(s.unfolding) < 1e-7; }
  Eigen::Vector2d position(const ExtendedState& s) const {
    return (s.parameters - low_).cwiseQuotient(high_ - low_);
  }
  bool inside(const ExtendedState& s) const {
    const Eigen::Vector2d p = position(s);
    return p.minCoeff() >= -1e-12 && p.maxCoeff() <= 1 + 1e-12;
  }
  Eigen::VectorXd difference(const ExtendedState& a, const ExtendedState& b) const {
    Eigen::VectorXd out(balance_.unknowns());
    out << scaled_difference(balance_.problem(), a.z.q, b.z.q),
        (b.parameters - a.parameters).cwiseQuotient(balance_.scales());
    return out;
  }

  // `length` further along; the number of iterations, 0 where it fails.
  int step(const ExtendedState& from, const Eigen::VectorXd& tangent, double length, ExtendedState& to) {
    if (type_ != PlaneCurveType::value) balance_.set_borders(from);
    to = from;
    balance_.move(to, length * tangent);
    balance_.set(to.parameters);
    const ExtendedOutcome outcome = balance_.correct(to, tangent);
    return outcome.converged ? std::max(1, outcome.iterations) : 0;
  }

  Traced follow(ExtendedState state, Eigen::VectorXd tangent) {
    Traced out;
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
      if (far(next)) {
        out.end = "a coordinate leaves all bounds";
        break;
      }
      state = std::move(next);
      tangent = std::move(onward);
      length = std::min(options_.largest_step, length * (iterations <= 4 ? 1.5 : iterations > 6 ? 0.6 : 1.));
    }
    return out;
  }

  bool far(const ExtendedState& s) const {
    const Problem p = balance_.problem();
    return std::ranges::any_of(p.system.links, [&](const Link& link) {
      return link.type == LinkType::prismatic && link.q >= 0 &&
             std::abs(s.z.q[link.q]) > 100 * p.parameters.length;
    });
  }

  // Where the curve turns round in the plane: its direction there changes sign.
  ExtendedState cusp(const ExtendedState& state, const Eigen::VectorXd& tangent, double length) {
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

  void land_on_border(const ExtendedState& state, const Eigen::VectorXd& tangent, double length,
                      const ExtendedState& next, Traced& out) {
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
    if (type_ != PlaneCurveType::value) balance_.set_borders(state);
    ExtendedState last = state;
    balance_.move(last, part * length * tangent);
    last.parameters[border] = there[border] > 1 ? high_[border] : low_[border];
    balance_.set(last.parameters);
    if (!balance_.correct(last, unit(border)).converged || !inside(last)) return;
    if (difference(state, last).norm() > 2 * length) return;
    out.states.push_back(last);
    out.tangents.push_back(tangent);
  }

  ExtendedBalance& balance_;
  Eigen::Vector2d low_, high_;
  PlaneCurveType type_;
  const PlaneOptions& options_;
};

// Gathers the curves of a plane.
class Plane {
 public:
  Plane(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y, const PlaneOptions& options)
      : mechanism_(mechanism), x_(x), y_(y), options_(options), begin_(std::chrono::steady_clock::now()),
        system_(compile_for_drives(at_corner())) {
    const double present = std::clamp(get_parameter(mechanism, y.address), y.from, y.to);
    if (!options.at.empty()) {
      for (double value : options.at)
        lines_.push_back({0, value});
      return;
    }
    for (double value : {present, y.from, y.to})
      if (std::ranges::find(lines_, value, &Line::value) == lines_.end()) lines_.push_back({0, value});
    lines_.push_back({1, x.from});
    lines_.push_back({1, x.to});
  }

  // Lines across the plane on which starts are looked for.
  struct Line {
    int varied = 0; // 0: x moves and y stays
    double value = 0;
  };
  const std::vector<Line>& lines() const { return lines_; }
  const System& system() const { return system_; }
  bool cancelled() const { return options_.cancel && options_.cancel->load(std::memory_order_relaxed); }
  const PlaneAxis& moving(const Line& line) const { return line.varied == 0 ? x_ : y_; }
  Mechanism on(const Line& line) const {
    return with_parameter(mechanism_, line.varied == 0 ? y_.address : x_.address, line.value);
  }
  // Until it is cancelled; what was found until then stays.
  template <class Search>
  void for_lines(const Search& search) {
    const Interruptible scope(options_.cancel);
    try {
      for (std::size_t i = 0; i < lines_.size() && !cancelled(); ++i) {
        line_ = i;
        report_progress(options_.progress, "following", part_before());
        search(lines_[i]);
      }
    } catch (const Interrupted&) {
    }
  }
  // Of following the branches along the line that is searched: a part of the whole.
  ReportProgress along_line() const {
    return [this](const Progress& now) {
      const double share = std::clamp(now.part, 0., 1.) / static_cast<double>(lines_.size());
      report_progress(options_.progress, now.phase, part_before() + share);
    };
  }

  ExtendedBalance balance(std::vector<Condition> conditions, bool unfolded = false) const {
    return {system_,
            at_corner(),
            {x_.address, y_.address},
            Eigen::Vector2d(x_.to - x_.from, y_.to - y_.from),
            std::move(conditions),
            unfolded};
  }

  // The curve through a point on a line, if it is not known yet.
  void add(ExtendedBalance& balance, PlaneCurveType type, const Line& line, double varied,
           const std::vector<CoordinateSolution>& coordinates) {
    if (static_cast<int>(out_.curves.size()) >= options_.max_curves || cancelled()) return;
    Tracer tracer(balance, x_, y_, type, options_);
    ExtendedState state;
    state.parameters =
        line.varied == 0 ? Eigen::Vector2d(varied, line.value) : Eigen::Vector2d(line.value, varied);
    balance.set(state.parameters);
    state.z.q = configuration_of(balance.problem(), coordinates);
    if (!tracer.start(state, 1 - line.varied)) return;
    for (std::size_t i = 0; i < traced_.size(); ++i)
      if (out_.curves[i].type == type && tracer.lies_on(state, traced_[i])) return;
    PlaneCurve curve;
    curve.type = type;
    Traced traced = tracer.both_ways(state, 1 - line.varied, curve.begin);
    if (traced.states.empty()) return;
    curve.closed = traced.closed;
    curve.end = traced.end;
    for (const ExtendedState& s : traced.states)
      curve.points.push_back(point(balance, type, s));
    for (const ExtendedState& s : traced.cusps)
      curve.cusps.push_back(point(balance, type, s));
    traced_.push_back(std::move(traced));
    out_.curves.push_back(std::move(curve));
  }

  // Counts a crossing that is not followed for the size of the system.
  void leave_out_crossing() { ++left_out_; }

  void heard(Status status, const std::string& message) {
    if (out_.status == Status::converged) return;
    out_.status = status;
    out_.message = message;
  }

  PlaneCurves finish(const char* what) {
    if (out_.status == Status::converged) {
      const std::size_t n = out_.curves.size();
      out_.message = (n == 0 ? std::string("No ") + what + " curve"
                             : std::to_string(n) + " " + what + (n == 1 ? " curve" : " curves")) +
                     " through the " + std::to_string(lines_.size()) +
                     " lines searched; there may be others between.";
      if (left_out_ > 0)
        out_.message += " Branches cross at " + std::to_string(left_out_) +
                        " more points; curves of crossings are followed up to " +
                        std::to_string(largest_for_crossings) + " coordinates.";
      if (cancelled()) out_.message = "Cancelled. " + out_.message;
    } else if (out_.message.empty()) { // before anything was found
      out_.message = "Cancelled.";
    }
    out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    return std::move(out_);
  }

 private:
  double part_before() const { return static_cast<double>(line_) / static_cast<double>(lines_.size()); }

  Mechanism at_corner() const {
    return with_parameter(with_parameter(mechanism_, x_.address, x_.from), y_.address,
                          std::clamp(get_parameter(mechanism_, y_.address), y_.from, y_.to));
  }

  static PlanePoint point(ExtendedBalance& balance, PlaneCurveType type, const ExtendedState& s) {
    balance.set(s.parameters);
    ResponsePoint p =
        response_point(balance.mechanism(), balance.judged(), s.z, {}, {false, false}, balance.workspace());
    PlanePoint out{s.parameters[0], s.parameters[1], std::move(p.coordinates), {}};
    if (type == PlaneCurveType::value) out.stable = p.stable;
    return out;
  }

  const Mechanism& mechanism_;
  const PlaneAxis &x_, &y_;
  const PlaneOptions& options_;
  std::chrono::steady_clock::time_point begin_;
  System system_;
  std::vector<Line> lines_;
  std::size_t line_ = 0; // that is searched
  int left_out_ = 0;
  std::vector<Traced> traced_;
  PlaneCurves out_;
};

} // namespace

std::string_view word(PlaneCurveType type) {
  switch (type) {
  case PlaneCurveType::fold: return "fold";
  case PlaneCurveType::branch_point: return "branch_point";
  case PlaneCurveType::value: return "value";
  }
  return "";
}

PlaneCurves fold_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                        const PlaneOptions& options) {
  Plane plane(mechanism, x, y, options);
  ExtendedBalance folds = plane.balance({balance_is_singular()});
  plane.for_lines([&](const Plane::Line& line) {
    const PlaneAxis& along = plane.moving(line);
    BranchOptions follow;
    follow.largest_step = options.largest_step;
    follow.eigenvalues = false;
    follow.all = options.all;
    follow.cancel = options.cancel;
    follow.progress = plane.along_line();
    const ResponseDiagram d = follow_branches(plane.on(line), along.address, along.from, along.to, follow);
    plane.heard(d.status, d.message);
    ExtendedBalance crossings =
        plane.balance({balance_is_singular(), branches_cross(static_cast<std::size_t>(line.varied))}, true);
    for (const SpecialPoint& s : d.special) {
      // Where a branch turns back because another crosses it there is no fold.
      const bool at_crossing = std::ranges::any_of(d.special, [&](const SpecialPoint& other) {
        return other.type == SpecialPointType::branch_point &&
               std::abs(other.at.parameter - s.at.parameter) < 1e-6 * (along.to - along.from);
      });
      if (s.type == SpecialPointType::fold && !at_crossing)
        plane.add(folds, PlaneCurveType::fold, line, s.at.parameter, s.at.coordinates);
      else if (s.type == SpecialPointType::branch_point && plane.system().nv > largest_for_crossings)
        plane.leave_out_crossing();
      else if (s.type == SpecialPointType::branch_point)
        plane.add(crossings, PlaneCurveType::branch_point, line, s.at.parameter, s.at.coordinates);
    }
  });
  return plane.finish("fold or crossing");
}

PlaneCurves value_curves(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                         const std::string& name, double value, const PlaneOptions& options) {
  Plane plane(mechanism, x, y, options);
  const Wanted wanted = find_wanted(mechanism, plane.system(), name);
  plane.for_lines([&](const Plane::Line& line) {
    const PlaneAxis& along = plane.moving(line);
    DesignOptions ask;
    ask.all = options.all;
    ask.largest_step = options.largest_step;
    ask.cancel = options.cancel;
    ask.progress = plane.along_line();
    const DesignAnswer answer = design(plane.on(line), along.address, along.from, along.to, name, value, ask);
    // Not reaching the value on one line is no failure.
    const bool solved = answer.lowest <= answer.highest && answer.highest != 0;
    plane.heard(solved ? Status::converged : answer.status, answer.message);
    ExtendedBalance balance = plane.balance({wanted_is(wanted, value, answer.lowest, answer.highest)});
    for (const DesignSolution& s : answer.solutions)
      plane.add(balance, PlaneCurveType::value, line, s.parameter, s.at.coordinates);
  });
  return plane.finish("such");
}

} // namespace flyball
