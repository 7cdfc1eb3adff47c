#include "engine/study/order_crossings.hpp"

#include "engine/linear/root_bracket.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr double along = 1e-10; // of its frequency: a mode that is no further away runs along an order's line

// Where one line of a branch meets the line of one order: crossings, and double roots where it only touches.
// They are sought over the number along the axis, and told as speeds of the drive.
class CrossingFinder {
 public:
  CrossingFinder(BranchModes& modes, const ResponseBranch& followed, const CampbellBranch& branch,
                 std::size_t line, double order)
      : modes_(modes), order_(order) {
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
  double speed(double value) { return modes_.drive().at(value); }
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
                      .error = error == 0 ? 0 : error * std::abs(modes_.drive().rate(value)),
                      .damping_ratio = mode.damping_ratio,
                      .touches = touches,
                      .whirl = modes_.whirl(mode)});
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
    for (VibrationMode& mode : modes_.between(*way.a.at, *way.b.at, value)) {
      const double cost = unlikeness(mode, *way.a.mode, *way.b.mode, part);
      if (best && cost >= least) continue;
      least = cost;
      best = std::move(mode);
    }
    return best;
  }

  BranchModes& modes_;
  double order_;
  std::vector<Sample> samples_;
  std::vector<CriticalSpeed> found_;
};

} // namespace

std::vector<CriticalSpeed> order_crossings(BranchModes& modes, const ResponseBranch& followed,
                                           const CampbellBranch& branch, std::size_t line, double order) {
  return CrossingFinder(modes, followed, branch, line, order).find();
}

} // namespace flyball
