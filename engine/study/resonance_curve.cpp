#include "engine/study/resonance_curve.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/sweep.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace flyball {
namespace {

constexpr double finest = 1. / 1024; // of the range: points are no nearer

using Outputs = std::vector<ResonanceOutput>;

PeriodicRange standing(double value, double error = std::nan("")) {
  return {value, value, value, error};
}

class Curve {
 public:
  Curve(const Mechanism& mechanism, std::string address, double from, double to,
        const ResonanceOptions& options)
      : options_(options), mechanism_(mechanism), address_(std::move(address)), from_(from), to_(to),
        analysis_(mechanism) {
    analysis_.vary(std::vector{address_});
  }

  ResonanceCurve run() {
    const auto begin = std::chrono::steady_clock::now();
    if (options_.begun) curve_ = *options_.begun;
    for (const auto& point : curve_.points)
      evaluations_ += point->evaluations;
    const int coarse = std::max(2, options_.coarse);
    for (int i = 0; i < coarse && goes_on(); ++i)
      if (const double part = static_cast<double>(i) / (coarse - 1);
          !std::ranges::binary_search(places(), part))
        add(part, coarse - i);
    while (goes_on()) {
      const Rough rough = find_rough();
      if (rough.count == 0) break;
      add((places()[rough.worst] + places()[rough.worst + 1]) / 2, rough.count);
    }
    const std::chrono::duration<double> run_time = std::chrono::steady_clock::now() - begin;
    curve_.run_time_s = run_time.count();
    curve_.whole = !cancelled() && find_rough().count == 0;
    return std::move(curve_);
  }

 private:
  bool cancelled() const { return options_.cancel && options_.cancel->load(std::memory_order_relaxed); }
  bool goes_on() const {
    return !cancelled() && curve_.points.size() < static_cast<std::size_t>(options_.most) &&
           evaluations_ < options_.most_evaluations;
  }

  // At a part of the range.
  double number_at(double part) const {
    if (part <= 0) return from_;
    if (part >= 1) return to_;
    return options_.logarithmic ? from_ * std::pow(to_ / from_, part) : from_ + part * (to_ - from_);
  }

  ResonancePoint find(double number) {
    try {
      analysis_.set(std::vector{number});
      SolveOptions solve;
      solve.search = point_search;
      solve.cancel = options_.cancel;
      const Solution solution = analysis_.solve(solve);
      if (solution.status != Status::no_steady_state && !solution.varies)
        return resonance_point(solution, number);
      const std::vector<ParameterValue> numbers{{address_, number}};
      set_parameters(mechanism_, numbers);
      PeriodicOptions periodic;
      periodic.cancel = options_.cancel;
      const PeriodicState motion = find_periodic_state(mechanism_, periodic);
      if (solution.varies && motion.status != PeriodicStatus::found) return resonance_point(solution, number);
      return resonance_point(motion, number);
    } catch (const SceneError& error) { // no mechanism can be made with this number
      ResonancePoint point;
      point.number = number;
      point.trouble = error.what();
      return point;
    }
  }

  const std::vector<double>& places() const { return curve_.places; }

  // `wanted`: points, this one included, that are known to be missing.
  void add(double part, int wanted) {
    const auto done = static_cast<double>(curve_.points.size());
    progress_ = std::max(progress_, done / (done + wanted));
    report_progress(options_.progress, "finding periodic motions", progress_);
    auto point = std::make_shared<const ResonancePoint>(find(number_at(part)));
    if (cancelled()) return; // what was found may be for want of time
    evaluations_ += point->evaluations;
    const auto at = std::ranges::lower_bound(places(), part) - places().begin();
    curve_.places.insert(curve_.places.begin() + at, part);
    curve_.points.insert(curve_.points.begin() + at, std::move(point));
    if (options_.publish) options_.publish(curve_);
  }

  // What each output goes through over the range: from least to most, of those of all points.
  Outputs spans() const {
    Outputs all;
    for (const auto& point : curve_.points)
      for (const ResonanceOutput& output : point->outputs) {
        if (output.kind == OutputKind::motion || !std::isfinite(output.range.mean)) continue;
        const auto same = std::ranges::find_if(
            all, [&](const ResonanceOutput& other) { return other.is(output.kind, output.name); });
        if (same == all.end()) {
          all.push_back(output);
          continue;
        }
        same->range.least = std::min(same->range.least, output.range.least);
        same->range.most = std::max(same->range.most, output.range.most);
        same->range.error = std::max(same->range.error, output.range.error);
      }
    return all;
  }

  // How far point i is off the line through its neighbours, of what each output goes through.
  double bend(std::size_t i, const Outputs& spans) const {
    const ResonancePoint &before = *curve_.points[i - 1], &here = *curve_.points[i],
                         &after = *curve_.points[i + 1];
    const double part = (places()[i] - places()[i - 1]) / (places()[i + 1] - places()[i - 1]);
    double most = 0;
    for (const ResonanceOutput& span : spans) {
      const PeriodicRange *a = before.range_of(span.kind, span.name),
                          *b = here.range_of(span.kind, span.name), *c = after.range_of(span.kind, span.name);
      const double height = span.range.most - span.range.least;
      const double rounding = 1e-12 * std::max(std::abs(span.range.most), std::abs(span.range.least));
      if (!a || !b || !c || !(height > 100 * std::max(span.range.error, rounding))) continue;
      for (const auto value : {&PeriodicRange::mean, &PeriodicRange::least, &PeriodicRange::most})
        if (const double off = std::abs(a->*value + part * (c->*value - a->*value) - b->*value) / height;
            std::isfinite(off))
          most = std::max(most, off);
    }
    return most;
  }

  static bool alike(const ResonancePoint& a, const ResonancePoint& b) {
    return a.found() == b.found() && a.steady == b.steady && a.stable == b.stable;
  }

  // The gaps between neighbours that are to be halved.
  struct Rough {
    int count = 0;         // none where all is smooth
    std::size_t worst = 0; // of them, with the point before it
  };
  Rough find_rough() const {
    Rough out;
    const std::size_t count = curve_.points.size();
    if (count < 2) return out;
    const Outputs all = spans();
    std::vector<double> bends(count, 0);
    for (std::size_t i = 1; i + 1 < count; ++i)
      bends[i] = bend(i, all);
    double most = options_.tolerance;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      if (places()[i + 1] - places()[i] <= finest) continue;
      double rough = std::max(bends[i], bends[i + 1]);
      if (!alike(*curve_.points[i], *curve_.points[i + 1])) rough = 1; // where it changes is told
      if (rough <= options_.tolerance) continue;
      ++out.count;
      if (rough <= most) continue;
      most = rough;
      out.worst = i;
    }
    return out;
  }

  const ResonanceOptions& options_;
  Mechanism mechanism_;
  std::string address_;
  double from_, to_;
  Analysis analysis_;
  ResonanceCurve curve_;
  long evaluations_ = 0;
  double progress_ = 0; // told last: it does not go back
};

} // namespace

const PeriodicRange* ResonancePoint::range_of(OutputKind kind, std::string_view name) const {
  const auto found =
      std::ranges::find_if(outputs, [&](const ResonanceOutput& output) { return output.is(kind, name); });
  return found == outputs.end() ? nullptr : &found->range;
}

ResonancePoint resonance_point(const PeriodicState& motion, double number) {
  ResonancePoint point;
  point.number = number;
  point.evaluations = motion.evaluations;
  if (motion.status != PeriodicStatus::found) {
    point.trouble = motion.message;
    return point;
  }
  point.stable = motion.stable;
  for (const PeriodicCoordinate& c : motion.coordinates) {
    const std::string label = coordinate_label(c);
    point.outputs.push_back({OutputKind::coordinate, label, c.angle ? "rad" : "m", c.range});
    if (c.goes_on())
      point.outputs.push_back({OutputKind::coordinate, label + ".speed", c.angle ? "rad/s" : "m/s", c.rate});
  }
  for (const PeriodicMeasure& m : motion.measures)
    point.outputs.push_back({OutputKind::measure, m.name, m.unit, m.range});
  for (const PeriodicTorque& t : motion.drive_torques) {
    const std::string label = coordinate_label(t);
    point.outputs.push_back({OutputKind::drive, label, t.angle ? "N m" : "N", t.range});
    point.outputs.push_back({OutputKind::power, label, "W", t.power});
  }
  for (const PeriodicReaction& r : motion.reactions) {
    point.outputs.push_back({OutputKind::force, r.name, "N", r.force.size});
    point.outputs.push_back({OutputKind::moment, r.name, "N m", r.torque.size});
  }
  for (const PeriodicReaction& b : motion.bearings) {
    point.outputs.push_back({OutputKind::bearing_force, b.name, "N", b.force.size});
    point.outputs.push_back({OutputKind::bearing_moment, b.name, "N m", b.torque.size});
  }
  point.outputs.push_back({OutputKind::motion, "period", "s", standing(motion.period, motion.period_error)});
  if (!motion.floquet.multipliers.empty())
    point.outputs.push_back({OutputKind::motion, "largest multiplier", "",
                             standing(std::abs(motion.floquet.multipliers.front()), motion.floquet.error)});
  return point;
}

ResonancePoint resonance_point(const Solution& solution, double number) {
  ResonancePoint point;
  point.number = number;
  if (solution.status != Status::converged) {
    point.trouble = solution.message;
    return point;
  }
  point.steady = true;
  point.stable = solution.stable;
  for (const CoordinateSolution& c : solution.coordinates)
    if (const auto found = found_number(c))
      point.outputs.push_back({OutputKind::coordinate, found->name, std::string(found->unit),
                               standing(found->value, found->error)});
  for (const MeasureSolution& m : solution.measures)
    if (m.value) point.outputs.push_back({OutputKind::measure, m.name, m.unit, standing(*m.value)});
  for (const DriveTorque& d : solution.drive_torques) {
    const PeriodicRange range =
        d.range ? PeriodicRange{d.range->mean, d.range->least, d.range->most, std::nan("")}
                : standing(d.value);
    if (d.range || !d.varying)
      point.outputs.push_back({OutputKind::drive, coordinate_label(d), d.angle ? "N m" : "N", range});
  }
  const auto add_loads = [&](const auto& loads, auto name, OutputKind force, OutputKind moment) {
    for (const auto& load : loads) {
      if (load.varying) continue; // it is at the drawn phase
      point.outputs.push_back({force, load.*name, "N", standing(load.force.norm())});
      point.outputs.push_back({moment, load.*name, "N m", standing(load.torque.norm())});
    }
  };
  add_loads(solution.reactions, &Reaction::joint, OutputKind::force, OutputKind::moment);
  add_loads(solution.bearings, &BearingForce::bearing, OutputKind::bearing_force, OutputKind::bearing_moment);
  return point;
}

std::vector<ResonanceGap> resonance_gaps(const ResonanceCurve& curve) {
  std::vector<ResonanceGap> gaps;
  bool open = false;
  for (const auto& point : curve.points) {
    if (point->found()) {
      open = false;
      continue;
    }
    if (!open) gaps.push_back({point->number, point->number, point->trouble});
    gaps.back().to = point->number;
    open = true;
  }
  return gaps;
}

ResonanceCurve resonance_curve(const Mechanism& mechanism, const std::string& address, double from, double to,
                               const ResonanceOptions& options) {
  return Curve(mechanism, address, from, to, options).run();
}

} // namespace flyball
