#include "engine/stability/kink_stability.hpp"

#include "engine/stability/moved_inputs.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// What holds on the softer and the stiffer side of all kinks of springs holds in between: of a minimum; of
// directions that nothing resists; and at rest, where nothing but a potential and dampers act, of a potential
// that falls. Eigenvalues of either side alone prove nothing of a motion that goes to and fro between them.
Stability common_stability(const FactoredState& at, const std::vector<Kink>& kinks) {
  const auto on_side = [&](KinkSide side) {
    const Parameters numbers = straightened(at.problem, kinks, side);
    Problem problem{at.problem.system, numbers, at.problem.scaling, at.problem.cancel, at.problem.form};
    problem.as_gradient = at.problem.as_gradient;
    Workspace w;
    return find_smooth_stability(factor_at(problem, at.z, w), false);
  };
  const Stability softer = on_side(KinkSide::softer);
  if (softer.reason == StabilityReason::minimum) return softer;
  Stability common = on_side(KinkSide::stiffer);
  const Parameters& p = at.problem.parameters;
  const bool proven =
      softer.reason == StabilityReason::neutral ||
      (softer.reason == StabilityReason::unstable && at.problem.symmetric() && !p.moving && !p.dampers_drive);
  if (proven && softer.reason == common.reason && softer.neutral == common.neutral) return common;
  common.stable.reset();
  common.reason = StabilityReason::marginal;
  common.kinks_leave_open = true;
  return common;
}

// On the kink of a drive's law alone the linearised motion has two sides, which meet where that input is as
// it is. A real eigenvalue that grows on either side proves that the state is unstable: of its direction and
// the opposite one either lies on that side, and the motion along it stays there. That both die out proves
// that the state is stable where there is one eigenvalue, so that a motion stays on its side; with more of
// them one that goes to and fro may grow all the same.
//
// Where the input itself has no slope, as an angle of 0, but one direction alone moves it, the sides are
// looked at a little beside the state.
std::optional<bool> stable_on_both_sides(const FactoredState& at, const std::vector<Kink>& of_drives) {
  constexpr double beside = 1e-6; // scaled
  const Kink& of_drive = of_drives.front();
  const bool own = of_drive.gradients[0].empty();
  std::optional<Eigen::VectorXd> across;
  if (own) {
    const DriveTorqueElement& e = at.problem.system.torques[of_drive.entry];
    const DriveTorqueParameters& numbers = at.problem.parameters.torques[of_drive.entry];
    const bool torque = of_drive.law == Kink::Law::torque;
    across = single_motion(at.problem, torque ? e.torque : e.load, torque ? numbers.torque : numbers.load,
                           of_drive.input, at.z.q, at.w.kinematics);
    if (!across) return {};
  }
  std::size_t dying = 0;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    Parameters numbers = at.problem.parameters;
    for (const Kink& kink : of_drives)
      if (!own) numbers = beside_kink({at.problem.system, numbers, at.problem.scaling}, kink, side);
    const Problem problem{at.problem.system, numbers, at.problem.scaling, at.problem.cancel};
    Workspace w;
    Unknowns z = at.z;
    if (own) {
      const Eigen::VectorXd step =
          (side == 0 ? -beside : beside) * across->cwiseProduct(problem.scaling.column);
      retract<double>(problem.system, step, z.q);
    }
    const Stability there = find_smooth_stability(factor_at(problem, z, w), true);
    if (!there.eigenvalues || there.floquet) return {};
    if (there.reason == StabilityReason::unstable &&
        std::ranges::any_of(*there.eigenvalues, [](Complex s) { return s.imag() == 0 && s.real() > 0; }))
      return false;
    if (there.reason == StabilityReason::asymptotic && there.eigenvalues->size() == 1) ++dying;
  }
  if (dying == 2) return true;
  return {};
}

// Whether all are of laws that cross theirs as the same input does.
bool cross_together(const System& system, const std::vector<Kink>& kinks) {
  const auto input_of = [&](const Kink& kink) -> const DriveLaw::Input& {
    const DriveTorqueElement& e = system.torques[kink.entry];
    return (kink.law == Kink::Law::torque ? e.torque : e.load).inputs[kink.input];
  };
  return !kinks.empty() && std::ranges::all_of(kinks, [&](const Kink& kink) {
    if (kink.of != Kink::Of::drive) return false;
    return kinks.size() == 1 || (!kink.gradients[0].empty() && input_of(kink) == input_of(kinks.front()));
  });
}

bool judge_kink_of_drive(const FactoredState& at, Stability& out) {
  if (!cross_together(at.problem.system, out.kinks)) return false;
  const std::optional<bool> stable = stable_on_both_sides(at, out.kinks);
  if (!stable) return false;
  out.stable = stable;
  out.reason = *stable ? StabilityReason::asymptotic : StabilityReason::unstable;
  return true;
}

} // namespace

void judge_kinks(const FactoredState& at, Stability& out) {
  out.kinks = find_kinks(at.problem, at.z.q, at.w.kinematics);
  if (judge_kink_of_drive(at, out)) return;
  if (std::ranges::any_of(out.kinks, [](const Kink& kink) { return kink.law == Kink::Law::spring; })) {
    const Stability common = common_stability(at, out.kinks);
    out.stable = common.stable;
    out.reason = common.reason;
    out.neutral = common.neutral;
    out.neutral_directions = common.neutral_directions;
    out.kinks_leave_open = common.kinks_leave_open;
  }
  const bool by_eigenvalues =
      out.reason != StabilityReason::minimum && out.reason != StabilityReason::neutral;
  const bool others =
      std::ranges::any_of(out.kinks, [](const Kink& kink) { return kink.law != Kink::Law::spring; });
  // What torques keep at a minimum they keep by their slopes on one side.
  const bool kept = out.reason == StabilityReason::minimum &&
                    std::ranges::any_of(out.kinks, [](const Kink& k) { return k.of == Kink::Of::drive; });
  if ((others && by_eigenvalues) || kept) { // of one side of it
    out.stable.reset();
    out.reason = StabilityReason::marginal;
    out.kinks_leave_open = true;
  }
}

} // namespace flyball
