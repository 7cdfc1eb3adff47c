#include "engine/report/friction_implied.hpp"

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

} // namespace flyball
