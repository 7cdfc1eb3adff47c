#include "engine/study/campbell.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/assignment.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/study/mode_tracks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr double along = 1e-10; // of its frequency: a mode that is no further away runs along an order's line

// How far apart two points of a branch are, by what moves: only ratios count.
double apart(const ResponsePoint& a, const ResponsePoint& b, double range) {
  return std::sqrt(std::pow((b.parameter - a.parameter) / range, 2) +
                   squared_distance(a.coordinates, b.coordinates));
}

// Floquet's exponents and what large mechanisms tell: eigenvalues alone.
std::vector<VibrationMode> without_shapes(const std::vector<std::complex<double>>& eigenvalues) {
  std::vector<VibrationMode> out;
  for (const std::complex<double> s : eigenvalues) {
    if (s.imag() < 0) continue;
    VibrationMode mode;
    mode.eigenvalue = s;
    mode.frequency = damped_frequency(s);
    mode.natural_frequency = natural_frequency(s);
    mode.damping_ratio = damping_ratio(s);
    out.push_back(std::move(mode));
  }
  sort_modes(out);
  return out;
}

// The coordinates between those of two points, as starts.
std::vector<std::pair<std::string, double>> between(const ResponsePoint& a, const ResponsePoint& b,
                                                    double part) {
  std::vector<std::pair<std::string, double>> start = start_values(a.coordinates);
  const std::vector<std::pair<std::string, double>> there = start_values(b.coordinates);
  for (std::size_t i = 0; i < start.size() && i < there.size(); ++i)
    start[i].second += part * (there[i].second - start[i].second);
  return start;
}

class Describer {
 public:
  Describer(const Mechanism& mechanism, const std::string& address, const std::atomic<bool>* cancel)
      : mechanism_(mechanism), address_(address), drive_(mechanism, address), analysis_(mechanism),
        cancel_(cancel) {
    analysis_.vary(std::vector{address});
  }

  bool turns() const { return !drive_.joint().empty(); }
  DriveSpeed& drive() { return drive_; }

  CampbellPoint describe(const ResponsePoint& point) {
    CampbellPoint out;
    if (point.singular_loops) return out;
    if (solve(point.parameter, start_values(point.coordinates), point.frictions) && same_as(point))
      out.modes = solved().modes();
    if (out.modes.empty()) out.modes = without_shapes(point.eigenvalues);
    for (const VibrationMode& mode : out.modes)
      out.whirls.push_back(whirl(mode));
    return out;
  }

  // Modes at a value between those of two points; none where there is no such state.
  std::vector<VibrationMode> modes_between(const ResponsePoint& a, const ResponsePoint& b, double value) {
    const double part = (value - a.parameter) / (b.parameter - a.parameter);
    if (!solve(value, between(a, b, part), a.frictions)) return {};
    return solved().modes();
  }
  std::optional<Whirl> whirl(const VibrationMode& mode) {
    return turns() ? solved().whirl(mode, drive_.joint()) : std::nullopt;
  }

 private:
  Analysis& solved() { return on_friction_ ? on_friction_->analysis : analysis_; }

  // `frictions`: of a state that rests on them.
  bool solve(double value, std::vector<std::pair<std::string, double>> start,
             const std::vector<FrictionForce>& frictions) {
    interruption_point();
    on_friction_.reset();
    try {
      SolveOptions options;
      options.nearest = true;
      options.details = false;
      options.start = std::move(start);
      options.cancel = cancel_;
      if (!frictions.empty()) {
        const Mechanism there = with_parameter(mechanism_, address_, value);
        on_friction_ = solve_with_parts(there, parts_of(there, frictions), options);
        if (!on_friction_) return false;
        solution_ = on_friction_->solution;
        return true;
      }
      analysis_.set({&value, 1});
      solution_ = analysis_.solve(options);
    } catch (const SceneError&) {
      return false;
    }
    return solution_.status == Status::converged;
  }
  // Beside a fold the nearest state may be of the other side.
  bool same_as(const ResponsePoint& point) const {
    return scaled_distance(point.coordinates, solution_.coordinates) <= 1e-5;
  }

  const Mechanism& mechanism_;
  const std::string& address_;
  DriveSpeed drive_;
  Analysis analysis_;
  std::optional<StateOnFriction> on_friction_; // of the last solve
  const std::atomic<bool>* cancel_;
  Solution solution_;
};

// How unlike a mode is to the one that is `part` of the way along a line from its mode `a` to its mode `b`.
double unlikeness(const VibrationMode& mode, const VibrationMode& a, const VibrationMode& b, double part) {
  const std::complex<double> expected = a.eigenvalue + part * (b.eigenvalue - a.eigenvalue);
  const double size = 0.2 * std::abs(expected) + std::abs(b.eigenvalue - a.eigenvalue) + 1e-300;
  return std::abs(mode.eigenvalue - expected) / size + 1 -
         std::max(modal_assurance(mode, a), modal_assurance(mode, b));
}

std::vector<std::string> names_of(const CampbellBranch& branch, std::size_t lines) {
  std::vector<std::string> names(lines);
  int number = 0;
  for (std::size_t l = 0; l < lines; ++l) {
    const auto swings = std::ranges::find_if(branch.points, [&](const CampbellPoint& point) {
      const VibrationMode* mode = point.on(l);
      return mode && mode->oscillates();
    });
    if (swings == branch.points.end()) continue;
    names[l] = "mode " + std::to_string(++number);
    if (const ModeAmplitude* most = swings->on(l)->leading()) names[l] += ", " + coordinate_label(*most);
  }
  return names;
}

// Where one line of a branch meets the line of one order: crossings, and double roots where it only touches.
// They are sought over the number along the axis, and told as speeds of the drive.
class CrossingFinder {
 public:
  CrossingFinder(Describer& describer, const ResponseBranch& followed, const CampbellBranch& branch,
                 std::size_t line, double order)
      : describer_(describer), order_(order) {
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      const VibrationMode* mode = branch.points[i].on(line);
      if (mode && mode->shape.empty()) mode = nullptr;
      samples_.push_back({&followed.points[i], mode, mode ? off(*mode, followed.points[i].parameter) : 0});
    }
  }

  std::vector<CriticalSpeed> find() {
    find_runs();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (stands_on(i) && !samples_[i].runs) add_sample(i);
      if (i + 1 == samples_.size() || !samples_[i].mode || !samples_[i + 1].mode) continue;
      if (is_told(i) || is_told(i + 1)) continue;
      const Way way{samples_[i], samples_[i + 1]};
      if ((way.a.off < 0) != (way.b.off < 0))
        add_crossing(way, {way.a.value(), way.a.off}, {way.b.value(), way.b.off});
      else if (may_touch(i))
        look_between(way);
    }
    return std::move(found_);
  }

 private:
  struct Sample {
    const ResponsePoint* at = nullptr;
    const VibrationMode* mode = nullptr; // null: not known
    double off = 0;                      // rad/s, above the order's line
    bool runs = false;                   // along it, from here or to here
    double value() const { return at->parameter; }
  };
  // From one point of the branch to the next.
  struct Way {
    const Sample &a, &b;
    double slope() const { return (b.off - a.off) / (b.value() - a.value()); }
  };
  struct Place {
    double value = 0, off = 0;
  };

  // rad/s, the drive's at a value.
  double speed(double value) { return describer_.drive().at(value); }
  double speed(const Sample& sample) { return speed(sample.value()); }
  double off(const VibrationMode& mode, double value) {
    return mode.frequency - order_ * std::abs(speed(value));
  }
  // Of off(), rad/s.
  static double rounding(const VibrationMode& mode) {
    return (mode.residual + 1e-13) * mode.natural_frequency;
  }
  bool stands_on(std::size_t i) const {
    const Sample& s = samples_[i];
    return s.mode && s.mode->oscillates() && std::abs(s.off) <= rounding(*s.mode);
  }

  bool is_told(std::size_t i) const { return samples_[i].runs || stands_on(i); }

  bool runs_along(const VibrationMode& mode, double value) {
    return mode.oscillates() && std::abs(off(mode, value)) <= along * mode.natural_frequency;
  }
  bool runs_along(std::size_t i) {
    const Sample& s = samples_[i];
    return s.mode && runs_along(*s.mode, s.value());
  }
  bool runs_along(const Sample& a, const Sample& b) {
    const double middle = (a.value() + b.value()) / 2;
    const std::optional<VibrationMode> mode = nearest({a, b}, middle);
    return mode && runs_along(*mode, middle);
  }

  // Where one point of the branch after another lies on the order's line, and what is between them, too.
  void find_runs() {
    for (std::size_t first = 0; first < samples_.size(); ++first) {
      std::size_t last = first;
      while (last + 1 < samples_.size() && runs_along(last) && runs_along(last + 1) &&
             runs_along(samples_[last], samples_[last + 1]))
        ++last;
      if (last == first) continue;
      add_run(first, last);
      for (std::size_t i = first; i <= last; ++i)
        samples_[i].runs = true;
      first = last;
    }
  }

  void add_run(std::size_t first, std::size_t last) {
    // It leaves the line before the next point of the branch, if it does.
    double error = 0;
    if (first > 0) error = std::abs(speed(samples_[first]) - speed(samples_[first - 1]));
    if (last + 1 < samples_.size())
      error = std::max(error, std::abs(speed(samples_[last + 1]) - speed(samples_[last])));
    const auto [low, high] = std::minmax({speed(samples_[first]), speed(samples_[last])});
    const Sample& slowest = samples_[speed(samples_[first]) == low ? first : last];
    add(*slowest.mode, slowest.value(), 0, false);
    found_.back().error = error;
    found_.back().until = high;
  }

  // Whether the line may come nearest to the order's between points i and i + 1: its distance does not go on
  // falling on either side, and is no more than it changes by hereabouts.
  bool may_touch(std::size_t i) const {
    const auto distance = [&](std::size_t k) { return std::abs(samples_[k].off); };
    double low = std::min(distance(i), distance(i + 1)), high = std::max(distance(i), distance(i + 1));
    const double least = low;
    if (i > 0 && samples_[i - 1].mode) {
      if (distance(i - 1) < distance(i)) return false;
      high = std::max(high, distance(i - 1));
    }
    if (i + 2 < samples_.size() && samples_[i + 2].mode) {
      if (distance(i + 2) < distance(i + 1)) return false;
      high = std::max(high, distance(i + 2));
    }
    return low != high && least <= high - low;
  }

  // `error`: of the value.
  void add(const VibrationMode& mode, double value, double error, bool touches) {
    found_.push_back({.order = order_,
                      .value = value,
                      .speed = speed(value),
                      .frequency = mode.frequency,
                      .until = {},
                      .error = error == 0 ? 0 : error * std::abs(describer_.drive().rate(value)),
                      .damping_ratio = mode.damping_ratio,
                      .touches = touches,
                      .whirl = describer_.whirl(mode)});
  }

  // A point of the branch that stands on the order's line, as its ends may.
  void add_sample(std::size_t i) {
    const Sample& here = samples_[i];
    const Sample* before = i > 0 && samples_[i - 1].mode ? &samples_[i - 1] : nullptr;
    const Sample* after = i + 1 < samples_.size() && samples_[i + 1].mode ? &samples_[i + 1] : nullptr;
    const double uncertain = std::abs(here.off) + rounding(*here.mode);
    double steepest = 0;
    for (const Sample* other : {before, after})
      if (other && other->value() != here.value())
        steepest = std::max(steepest, std::abs(Way{here, *other}.slope()));
    const bool touches = before && after && (before->off < 0) == (after->off < 0);
    if (steepest == 0) return add(*here.mode, here.value(), 0, false);
    const double width =
        touches ? std::max(std::abs(before->value() - here.value()), std::abs(after->value() - here.value()))
                : 0;
    // Of a double root off = curvature / 2 (value - here)^2.
    add(*here.mode, here.value(), touches ? std::sqrt(uncertain * width / steepest) : uncertain / steepest,
        touches);
  }

  // Between two places of unlike signs.
  void add_crossing(const Way& way, const Place& from, const Place& to) {
    if (from.value == to.value || (!way.a.mode->oscillates() && !way.b.mode->oscillates())) return;
    RootBracket bracket(from.value, from.off, to.value, to.off);
    const double narrow = 1e-14 * (bracket.width() + std::abs(from.value) + std::abs(to.value));
    std::optional<VibrationMode> last;
    double value = from.value;
    for (int i = 0; i < 60 && bracket.width() > narrow; ++i) {
      value = bracket.next();
      last = nearest(way, value);
      if (!last) return;
      const double f = off(*last, value);
      if (std::abs(f) <= 1e-15 * std::max(last->natural_frequency, order_ * std::abs(speed(value)))) break;
      bracket.take(value, f);
    }
    if (!last || !last->oscillates()) return;
    // It jumps over the order's line, as where a coordinate comes to its stop: nothing swings in time with
    // it.
    constexpr double meets = 1e-3; // of the frequency
    if (std::abs(off(*last, value)) > meets * last->natural_frequency) return;
    // Beside a double root the chord from there is the flatter one, half as steep as the line at the
    // crossing.
    double slope = std::numeric_limits<double>::infinity();
    for (const Place& end : {from, to})
      if (end.value != value) slope = std::min(slope, std::abs(end.off / (end.value - value)));
    add(*last, value,
        (std::abs(off(*last, value)) + (last->residual + 1e-15) * last->natural_frequency) /
            std::max(slope, 1e-300),
        false);
  }

  // Both ends stand on one side: by golden sections to where the line comes nearest to the order's, until it
  // is on the other side, touches, or is seen not to come there.
  void look_between(const Way& way) {
    constexpr double golden = 0.3819660112501051;
    const double side = way.a.off < 0 ? -1 : 1;
    Place low{way.a.value(), way.a.off}, high{way.b.value(), way.b.off};
    const double width = std::abs(high.value - low.value);
    std::optional<VibrationMode> mode;
    const auto look = [&](double value) {
      mode = nearest(way, value);
      return Place{value, mode ? off(*mode, value) : 0};
    };
    Place middle = look(low.value + golden * (high.value - low.value));
    while (mode && mode->oscillates()) {
      const double distance = side * middle.off;
      if (distance < -rounding(*mode)) {
        add_crossing(way, {way.a.value(), way.a.off}, middle);
        add_crossing(way, middle, {way.b.value(), way.b.off});
        return;
      }
      const double ends = std::max(side * low.off, side * high.off);
      // Bent one way only it lies above the line from an end through the middle, and the parts are as 1 to
      // 1.62.
      if (distance > rounding(*mode) && distance > 1.7 * (ends - distance)) return;
      if (std::abs(high.value - low.value) <= 1e-8 * width) {
        if (distance <= rounding(*mode)) add_touch(way, *mode, middle);
        return;
      }
      const bool left = std::abs(middle.value - low.value) > std::abs(high.value - middle.value);
      const std::optional<VibrationMode> kept = mode;
      const Place other = look(left ? middle.value + golden * (low.value - middle.value)
                                    : middle.value + golden * (high.value - middle.value));
      if (!mode) return;
      if (side * other.off < side * middle.off) {
        (left ? high : low) = middle;
        middle = other;
      } else {
        (left ? low : high) = other;
        mode = kept;
      }
    }
  }

  void add_touch(const Way& way, const VibrationMode& mode, const Place& at) {
    // off = curvature / 2 (value - at)^2, as the farther end tells.
    const Sample& far =
        std::abs(way.a.value() - at.value) > std::abs(way.b.value() - at.value) ? way.a : way.b;
    const double uncertain = std::abs(at.off) + rounding(mode);
    add(mode, at.value, std::abs(far.value() - at.value) * std::sqrt(uncertain / std::abs(far.off)), true);
  }

  std::optional<VibrationMode> nearest(const Way& way, double value) {
    const double part = (value - way.a.value()) / (way.b.value() - way.a.value());
    std::optional<VibrationMode> best;
    double least = 0;
    for (VibrationMode& mode : describer_.modes_between(*way.a.at, *way.b.at, value)) {
      const double cost = unlikeness(mode, *way.a.mode, *way.b.mode, part);
      if (best && cost >= least) continue;
      least = cost;
      best = std::move(mode);
    }
    return best;
  }

  Describer& describer_;
  double order_;
  std::vector<Sample> samples_;
  std::vector<CriticalSpeed> found_;
};

CampbellBranch describe_branch(Describer& describer, const ResponseBranch& followed) {
  CampbellBranch branch;
  std::vector<std::vector<VibrationMode>> modes;
  std::vector<double> positions;
  const double whole = std::abs(followed.points.back().parameter - followed.points.front().parameter);
  const double range = whole > 0 ? whole : 1;
  for (std::size_t i = 0; i < followed.points.size(); ++i) {
    branch.points.push_back(describer.describe(followed.points[i]));
    modes.push_back(branch.points.back().modes);
    positions.push_back(i == 0 ? 0
                               : positions.back() + apart(followed.points[i - 1], followed.points[i], range));
  }
  std::vector<std::vector<int>> lines = track_modes(modes, positions);
  for (std::size_t i = 0; i < lines.size(); ++i)
    branch.points[i].lines = std::move(lines[i]);
  branch.names = names_of(branch, branch.points.front().lines.size());
  return branch;
}

// Not known to be unstable at a point of the branch beside the critical speed.
bool stable_at(DriveSpeed& drive, const ResponseBranch& followed, const CriticalSpeed& critical) {
  for (std::size_t i = 1; i < followed.points.size(); ++i) {
    const ResponsePoint &a = followed.points[i - 1], &b = followed.points[i];
    const auto [low, high] = std::minmax({a.parameter, b.parameter});
    bool beside = critical.value >= low && critical.value <= high;
    if (critical.until) {
      const auto [slow, fast] = std::minmax({drive.at(a.parameter), drive.at(b.parameter)});
      beside = *critical.until >= slow && critical.speed <= fast;
    }
    if (beside && (a.stable == false || b.stable == false)) return false;
  }
  return true;
}

void add_critical(Describer& describer, const ResponseBranch& followed, const CampbellBranch& branch,
                  int number, std::span<const double> orders, std::vector<CriticalSpeed>& out) {
  std::vector<CriticalSpeed> critical;
  for (std::size_t l = 0; describer.turns() && l < branch.names.size(); ++l)
    for (const double order : orders)
      for (CriticalSpeed& found : CrossingFinder(describer, followed, branch, l, order).find()) {
        found.branch = number;
        found.line = static_cast<int>(l);
        found.stable = stable_at(describer.drive(), followed, found);
        critical.push_back(std::move(found));
      }
  std::ranges::stable_sort(critical, {}, &CriticalSpeed::speed);
  out.insert(out.end(), critical.begin(), critical.end());
}

} // namespace

DriveSpeed::DriveSpeed(const Mechanism& mechanism, std::string address) : address_(std::move(address)) {
  const std::vector<PrescribedSpeed> speeds = prescribed_speeds(mechanism);
  for (const PrescribedSpeed& speed : speeds)
    if (speed.angle && (speed.address == address_ || number_alone(mechanism, speed.address) == address_)) {
      joint_ = speed.joint;
      return;
    }
  for (const PrescribedSpeed& speed : speeds) {
    const std::optional<std::string> formula = formula_at(mechanism, speed.address);
    if (!speed.angle || !formula) continue;
    const std::vector<std::string> sources = sources_of(mechanism, *formula);
    if (std::ranges::find(sources, address_) == sources.end()) continue;
    joint_ = speed.joint;
    speed_ = speed.address;
    formula_ = *formula;
    varied_ = mechanism;
    return;
  }
}

bool DriveSpeed::set(double value) {
  try {
    set_parameter(*varied_, address_, value);
  } catch (const SceneError&) {
    return false;
  }
  return true;
}

double DriveSpeed::at(double value) {
  if (!varied_) return value;
  return set(value) ? get_parameter(*varied_, speed_) : std::numeric_limits<double>::quiet_NaN();
}

double DriveSpeed::rate(double value) {
  if (!varied_) return 1;
  return set(value) ? expression_gradient(*varied_, formula_, {address_}).front()
                    : std::numeric_limits<double>::quiet_NaN();
}

std::vector<int> modes_on_lines(const ResponseBranch& followed, const CampbellBranch& branch,
                                std::size_t after, double value, std::span<const VibrationMode> modes) {
  constexpr double none = 2, most = 9; // unlikeness of what lies on no line, and of what is farthest from one
  const std::size_t lines = branch.names.size();
  const double from = followed.points[after].parameter, to = followed.points[after + 1].parameter;
  const double part = from == to ? 0 : (value - from) / (to - from);
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(modes.size()),
                                                   static_cast<Eigen::Index>(lines + modes.size()), none);
  for (std::size_t l = 0; l < lines; ++l) {
    const VibrationMode *a = branch.points[after].on(l), *b = branch.points[after + 1].on(l);
    for (std::size_t k = 0; k < modes.size(); ++k)
      cost(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) =
          a || b ? std::min(most, unlikeness(modes[k], a ? *a : *b, b ? *b : *a, part)) : most;
  }
  const std::vector<Eigen::Index> line = assign(cost);
  std::vector<int> out(lines, -1);
  for (std::size_t k = 0; k < modes.size(); ++k)
    if (line[k] < static_cast<Eigen::Index>(lines))
      out[static_cast<std::size_t>(line[k])] = static_cast<int>(k);
  return out;
}

bool unbalance_excites(const CriticalSpeed& critical) {
  constexpr double circle = 0.999; // as of Whirl::direction()
  return critical.order == 1 && critical.whirl && !critical.whirl->turning && critical.whirl->value > -circle;
}

std::string left_out(const ResponseBranch& branch, const std::function<std::string(double)>& speed_text,
                     const std::string& unit) {
  constexpr std::size_t most_told = 4;
  std::vector<std::string> at;
  const std::vector<ResponsePoint>& points = branch.points;
  for (std::size_t first = 0; first < points.size(); ++first) {
    if (!points[first].singular_loops) continue;
    std::size_t last = first;
    while (last + 1 < points.size() && points[last + 1].singular_loops)
      ++last;
    const auto [low, high] = std::minmax(points[first].parameter, points[last].parameter);
    at.push_back(low == high ? "at " + speed_text(low) + " " + unit
                             : "from " + speed_text(low) + " to " + speed_text(high) + " " + unit);
    first = last;
  }
  if (at.empty()) return {};
  std::string out = "Without modes ";
  for (std::size_t i = 0; i < std::min(at.size(), most_told); ++i)
    out += (i > 0 ? ", " : "") + at[i];
  if (at.size() > most_told) out += " and " + std::to_string(at.size() - most_told) + " more";
  return out + ". " + std::string(singular_loops_message);
}

CampbellDiagram campbell_diagram(const Mechanism& mechanism, const std::string& address,
                                 ResponseDiagram response, std::span<const double> orders,
                                 const std::atomic<bool>* cancel) {
  const auto begin = std::chrono::steady_clock::now();
  const Interruptible scope(cancel);
  CampbellDiagram out;
  out.response = std::move(response);
  if (out.response.branches.empty()) return out;
  Describer describer(mechanism, address, cancel);
  try {
    for (const ResponseBranch& followed : out.response.branches) {
      CampbellBranch branch = describe_branch(describer, followed);
      add_critical(describer, followed, branch, static_cast<int>(out.branches.size()), orders, out.critical);
      out.branches.push_back(std::move(branch));
    }
  } catch (const Interrupted&) {
  }
  out.run_time_s = out.response.run_time_s +
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

} // namespace flyball
