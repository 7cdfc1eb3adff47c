#include "engine/report/friction_implied.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/body_groups.hpp"
#include "engine/report/friction_attempt.hpp"

namespace flyball {

bool closes_a_loop(const Mechanism& mechanism, int joint) {
  const BodyNumbers numbers(mechanism);
  BodyGroups groups(numbers);
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    if (const Joint& other = mechanism.joints[j];
        other.type != JointType::gear && j != static_cast<std::size_t>(joint))
      groups.join(other.bodies);
  return !groups.join(mechanism.joints[static_cast<std::size_t>(joint)].bodies);
}

std::vector<std::vector<bool>> implied_ways(const Mechanism& mechanism,
                                            const std::vector<CoordinateReference>& frictions,
                                            const FrictionParts& parts) {
  constexpr std::size_t most = 6;
  std::vector<std::size_t> may_close;
  for (std::size_t i = 0; i < parts.size() && may_close.size() < most; ++i)
    if (is_slipping(parts[i]) && closes_a_loop(mechanism, frictions[i].joint)) may_close.push_back(i);
  std::vector<std::vector<bool>> out;
  for (std::size_t set = 0; set < std::size_t(1) << may_close.size(); ++set) {
    std::vector<bool>& implied = out.emplace_back(parts.size(), false);
    for (std::size_t k = 0; k < may_close.size(); ++k)
      implied[may_close[k]] = (set >> k & 1) != 0;
  }
  return out;
}

std::optional<StateOnFriction> let_slip(const Mechanism& mechanism,
                                        const std::vector<CoordinateReference>& frictions,
                                        const FrictionParts& parts, const SolveOptions& options, bool loose,
                                        int* attempts) {
  const std::vector<std::vector<bool>> ways = implied_ways(mechanism, frictions, parts);
  std::optional<StateOnFriction> first;
  for (const bool newton_only : {true, false}) {
    if (newton_only && ways.size() == 1) continue;
    if (!newton_only && options.newton_only && ways.size() > 1) break; // that has been
    SolveOptions now = options;
    now.newton_only = newton_only || options.newton_only;
    if (newton_only) now.search = 0;
    for (const std::vector<bool>& implied : ways) {
      if (is_cancelled(options.cancel)) return first;
      auto state = attempt_parts(mechanism, frictions, parts, now, nullptr, implied, loose);
      if (attempts) ++*attempts;
      if (state && (state->goes || !first)) first = std::move(state);
      if (first && first->goes) return first;
    }
    if (first) return first;
  }
  return std::nullopt;
}

} // namespace flyball
