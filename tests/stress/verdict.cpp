#include "tests/stress/verdict.hpp"

#include "tests/stress/numbers.hpp"
#include "tests/stress/reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball::stress {
namespace {

double last_place(double value) {
  const double size = std::abs(value);
  return std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
}

std::string label(const CoordinateSolution& c) {
  return c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index);
}

std::string other_starts(const Mechanism& mechanism, const SolveOptions& options,
                         const std::atomic<bool>& cancel) {
  Analysis analysis(mechanism);
  Dice dice(7);
  for (int i = 0; i < 4; ++i) {
    SolveOptions moved = options;
    moved.cancel = &cancel;
    moved.start = random_start(analysis, mechanism, dice);
    moved.details = false;
    const Solution s = analysis.solve(moved);
    if (s.status == Status::converged && s.stable == true) return " (another start finds a stable state)";
  }
  return "";
}

void fail(Verdict& out, const std::string& why) {
  out.outcome = Outcome::failed;
  out.remark = out.remark.empty() ? why : out.remark + "; " + why;
}

} // namespace

bool all_finite(const Solution& s) {
  bool ok = std::isfinite(s.residual) && std::isfinite(s.run_time_s);
  for (const CoordinateSolution& c : s.coordinates)
    ok = ok && std::isfinite(c.value) && std::isfinite(c.error) && c.error >= 0;
  for (const Pose& p : s.poses)
    ok = ok && p.position.allFinite() && p.rotation.coeffs().allFinite();
  for (const JointMultipliers& x : s.multipliers)
    ok = ok && std::ranges::all_of(x.values, [](double v) { return std::isfinite(v); });
  for (const DriveTorque& x : s.drive_torques)
    ok = ok && std::isfinite(x.value);
  for (const Reaction& x : s.reactions)
    ok = ok && x.force.allFinite() && x.torque.allFinite();
  for (const double x : s.history)
    ok = ok && !std::isnan(x);
  if (s.eigenvalues)
    for (const std::complex<double> x : *s.eigenvalues)
      ok = ok && std::isfinite(x.real()) && std::isfinite(x.imag());
  for (const Sensitivity& x : s.sensitivities)
    for (const Sensitivity::Rate& r : x.rates)
      ok = ok && std::isfinite(r.value);
  return ok && (!s.potential || std::isfinite(*s.potential)) && (!s.condition || *s.condition >= 1);
}

Verdict judge(const Mechanism& mechanism, const SolveOptions& options, const Expectation& expected,
              const std::atomic<bool>& cancel) {
  Verdict out;
  SolveOptions cancellable = options;
  cancellable.cancel = &cancel;
  const Solution s = Analysis(mechanism).solve(cancellable);
  out.iterations = s.iterations;
  out.net = s.fallback ? std::string(word(*s.fallback)) : "";
  out.time_s = s.run_time_s;
  if (!all_finite(s)) {
    fail(out, "not everything is finite");
    return out;
  }
  if (s.message.empty()) {
    fail(out, "no message");
    return out;
  }
  if (s.status != Status::converged) {
    out.remark = std::string(word(s.status)) + ": " + s.message;
    if (!s.coordinates.empty())
      fail(out, "a refusal with coordinates");
    else if (expected.must)
      fail(out, "there has to be an answer here");
    else
      out.outcome = Outcome::refused;
    return out;
  }

  const ReferenceState reference = Reference(mechanism).settle(s);
  out.outcome = Outcome::solved;
  const bool known = !reference.converged && !expected.known.empty();
  bool unclear = !reference.converged && !known;
  std::string worst_name;
  for (std::size_t i = 0; i < s.coordinates.size() && !unclear; ++i) {
    const CoordinateSolution& c = s.coordinates[i];
    // Along what nothing resists the answer is one of many, and said to be.
    if (c.driven || c.dependent || std::ranges::find(s.neutral, c.joint) != s.neutral.end()) continue;
    ReferenceCoordinate r = reference.coordinates[i];
    if (known) {
      const auto at = std::ranges::find(expected.known, label(c), &std::pair<std::string, double>::first);
      if (at == expected.known.end()) continue;
      r.away = std::abs(c.value - at->second);
      r.uncertainty = 0;
    }
    if (r.uncertainty > 0.1 * std::max(c.error, r.away)) {
      unclear = true;
      break;
    }
    const double least = std::max(r.away, last_place(c.value));
    ++out.judged;
    out.bounded += c.error >= least;
    out.caution.push_back(c.error / std::max(least, last_place(r.unit)));
    const double ratio = r.away > 0 ? r.away / c.error : 0;
    if (out.judged == 1 || ratio > out.worst) {
      out.worst = ratio;
      out.true_error = r.away;
      out.estimate = c.error;
      worst_name = label(c);
    }
  }
  if (out.bounded < out.judged)
    out.remark =
        "\"" + worst_name + "\" over its estimate, " +
        (s.stability_reason ? std::string(word(*s.stability_reason)) : std::string("stability unknown"));
  if (unclear) {
    // Far from any balance is wrong, whatever the reference makes of it.
    if (!expected.half_digits && reference.imbalance > 1e-8)
      fail(out,
           "called a steady state, but " + digits(reference.imbalance) + " of the forces are unbalanced");
    else {
      out.outcome = Outcome::unclear;
      out.remark = "the reference did not settle (moved " + digits(reference.distance) + ", imbalance " +
                   digits(reference.imbalance) + ", softest " + digits(reference.softest) + ")";
    }
    return out;
  }
  if (out.worst > 100)
    fail(out, "\"" + worst_name + "\" is off by " + digits(out.worst) + " times its estimate (imbalance " +
                  digits(reference.imbalance) + ", opening " + digits(reference.opening) + ", softest " +
                  digits(reference.softest) + ")");
  if (expected.half_digits) {
    double largest = 0;
    for (const CoordinateSolution& c : s.coordinates)
      largest = std::max(largest, c.error);
    if (s.stability_reason != StabilityReason::marginal && s.stability_reason != StabilityReason::neutral)
      fail(out, "said to be " +
                    (s.stability_reason ? std::string(word(*s.stability_reason)) : std::string("nothing")) +
                    " where double precision cannot tell");
    if (largest < 1e-10)
      fail(out, "an estimate of " + digits(largest) + " where only half of the digits exist");
  }
  return out;
}

Case solve_case(std::string family, std::string name, Mechanism mechanism, Expectation expected,
                SolveOptions options) {
  return {std::move(family), std::move(name),
          [mechanism, expected = std::move(expected), options](const std::atomic<bool>& cancel) {
            return judge(mechanism, options, expected, cancel);
          },
          [mechanism, options](const std::atomic<bool>& cancel) {
            return other_starts(mechanism, options, cancel);
          }};
}

} // namespace flyball::stress
