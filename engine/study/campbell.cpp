#include "engine/study/campbell.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/mode_tracks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace flyball {
namespace {

// How far apart two points of a branch are, by what moves: only ratios count.
double apart(const ResponsePoint& a, const ResponsePoint& b, double range) {
  double sum = std::pow((b.parameter - a.parameter) / range, 2);
  for (std::size_t i = 0; i < a.coordinates.size() && i < b.coordinates.size(); ++i)
    sum += std::pow(b.coordinates[i].value - a.coordinates[i].value, 2);
  return std::sqrt(sum);
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
      : joint_(driven_joint(mechanism, address)), analysis_(mechanism), cancel_(cancel) {
    analysis_.vary(std::vector{address});
  }

  bool turns() const { return !joint_.empty(); }

  CampbellPoint describe(const ResponsePoint& point) {
    CampbellPoint out;
    if (solve(point.parameter, start_values(point.coordinates)) && same_as(point))
      out.modes = analysis_.modes();
    if (out.modes.empty()) out.modes = without_shapes(point.eigenvalues);
    for (const VibrationMode& mode : out.modes)
      out.whirls.push_back(whirl(mode));
    return out;
  }

  // Modes at a value between those of two points; none where there is no such state.
  std::vector<VibrationMode> modes_between(const ResponsePoint& a, const ResponsePoint& b, double value) {
    const double part = (value - a.parameter) / (b.parameter - a.parameter);
    if (!solve(value, between(a, b, part))) return {};
    return analysis_.modes();
  }
  std::optional<Whirl> whirl(const VibrationMode& mode) {
    return turns() ? analysis_.whirl(mode, joint_) : std::nullopt;
  }

 private:
  bool solve(double value, std::vector<std::pair<std::string, double>> start) {
    interruption_point();
    try {
      analysis_.set({&value, 1});
      SolveOptions options;
      options.nearest = true;
      options.details = false;
      options.start = std::move(start);
      options.cancel = cancel_;
      solution_ = analysis_.solve(options);
    } catch (const SceneError&) {
      return false;
    }
    return solution_.status == Status::converged;
  }
  // Beside a fold the nearest state may be of the other side.
  bool same_as(const ResponsePoint& point) const {
    for (std::size_t i = 0; i < point.coordinates.size() && i < solution_.coordinates.size(); ++i) {
      const double value = point.coordinates[i].value;
      if (std::abs(solution_.coordinates[i].value - value) > 1e-5 * (1 + std::abs(value))) return false;
    }
    return true;
  }

  std::string joint_;
  Analysis analysis_;
  const std::atomic<bool>* cancel_;
  Solution solution_;
};

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

// The crossings of one line with one order on the way from one point to the next.
class CrossingFinder {
 public:
  CrossingFinder(Describer& describer, double order) : describer_(describer), order_(order) {}

  std::optional<CriticalSpeed> find(const ResponsePoint& a, const VibrationMode& at_a, const ResponsePoint& b,
                                    const VibrationMode& at_b) {
    if (!at_a.oscillates() && !at_b.oscillates()) return {};
    double low = a.parameter, high = b.parameter;
    double f_low = off(at_a, low), f_high = off(at_b, high);
    if ((f_low < 0) == (f_high < 0) || low == high) return {};
    const double width = std::abs(high - low);
    std::optional<VibrationMode> last;
    double speed = low;
    // Regula falsi that halves the end that stays (Illinois).
    int kept = 0;
    for (int i = 0; i < 60 && std::abs(high - low) > 1e-14 * (width + std::abs(low) + std::abs(high)); ++i) {
      speed = low + (high - low) * std::clamp(f_low / (f_low - f_high), 0.01, 0.99);
      last = nearest(a, at_a, b, at_b, speed);
      if (!last) return {};
      const double f = off(*last, speed);
      if (f == 0) {
        low = high = speed;
      } else if ((f < 0) == (f_low < 0)) {
        low = speed;
        f_low = f;
        if (kept == 1) f_high /= 2;
        kept = 1;
      } else {
        high = speed;
        f_high = f;
        if (kept == -1) f_low /= 2;
        kept = -1;
      }
      if (std::abs(f) <= 1e-15 * std::max(last->natural_frequency, std::abs(order_ * speed))) break;
    }
    if (!last || !last->oscillates()) return {};
    CriticalSpeed out;
    out.order = order_;
    out.speed = speed;
    out.frequency = last->frequency;
    out.damping_ratio = last->damping_ratio;
    out.whirl = describer_.whirl(*last);
    const double slope = (off(at_b, b.parameter) - off(at_a, a.parameter)) / (b.parameter - a.parameter);
    out.error = (std::abs(off(*last, speed)) + last->residual * last->natural_frequency +
                 1e-15 * last->natural_frequency) /
                std::max(std::abs(slope), 1e-300);
    return out;
  }

 private:
  double off(const VibrationMode& mode, double speed) const {
    return mode.frequency - order_ * std::abs(speed);
  }
  std::optional<VibrationMode> nearest(const ResponsePoint& a, const VibrationMode& at_a,
                                       const ResponsePoint& b, const VibrationMode& at_b, double speed) {
    const double part = (speed - a.parameter) / (b.parameter - a.parameter);
    const std::complex<double> expected = at_a.eigenvalue + part * (at_b.eigenvalue - at_a.eigenvalue);
    const double size = 0.2 * std::abs(expected) + std::abs(at_b.eigenvalue - at_a.eigenvalue) + 1e-300;
    std::optional<VibrationMode> best;
    double least = 0;
    for (VibrationMode& mode : describer_.modes_between(a, b, speed)) {
      const double cost = std::abs(mode.eigenvalue - expected) / size + 1 -
                          std::max(modal_assurance(mode, at_a), modal_assurance(mode, at_b));
      if (best && cost >= least) continue;
      least = cost;
      best = std::move(mode);
    }
    return best;
  }

  Describer& describer_;
  double order_;
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

void add_critical(Describer& describer, const ResponseBranch& followed, const CampbellBranch& branch,
                  int number, std::span<const double> orders, std::vector<CriticalSpeed>& out) {
  std::vector<CriticalSpeed> critical;
  for (std::size_t i = 1; describer.turns() && i < branch.points.size(); ++i)
    for (std::size_t l = 0; l < branch.names.size(); ++l) {
      const VibrationMode *a = branch.points[i - 1].on(l), *b = branch.points[i].on(l);
      if (!a || !b || a->shape.empty() || b->shape.empty()) continue;
      for (const double order : orders) {
        std::optional<CriticalSpeed> found =
            CrossingFinder(describer, order).find(followed.points[i - 1], *a, followed.points[i], *b);
        if (!found) continue;
        found->branch = number;
        found->line = static_cast<int>(l);
        found->stable = followed.points[i].stable != false && followed.points[i - 1].stable != false;
        critical.push_back(std::move(*found));
      }
    }
  std::ranges::stable_sort(critical, {}, &CriticalSpeed::speed);
  out.insert(out.end(), critical.begin(), critical.end());
}

} // namespace

std::string driven_joint(const Mechanism& mechanism, const std::string& address) {
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      if (!joint.coordinates[i].drive || finds_speed(*joint.coordinates[i].drive)) continue;
      const std::string speed = drive_speed_address(joint, i);
      if (parameter_unit(mechanism, speed) != "rad/s") continue;
      std::string formula = formula_at(mechanism, speed).value_or("");
      std::erase(formula, ' ');
      if (speed == address || "parameters." + formula == address) return joint.name;
    }
  return {};
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
