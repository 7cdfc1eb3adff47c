#include "engine/mechanism/gear_ratio.hpp"

namespace flyball {

bool wheels_turn_alike(const Mechanism& mechanism, const Joint& belt) {
  std::array<const Joint*, 2> joints{};
  std::array<Vec3, 2> axes;
  for (std::size_t end = 0; end < 2; ++end) {
    const auto [joint, i] = find_coordinate(mechanism, belt.joints[end]);
    if (joint < 0) return true;
    joints[end] = &mechanism.joints[static_cast<std::size_t>(joint)];
    axes[end] = joints[end]->type == JointType::universal && i == 1 ? joints[end]->axis2 : joints[end]->axis;
  }
  // The second body turns on the first: a carrier that is the second sees its wheel turn the other way.
  double sense = 1;
  for (const auto [a, b] : {std::array{0, 0}, {1, 0}, {0, 1}, {1, 1}})
    if (joints[0]->bodies[static_cast<std::size_t>(a)] == joints[1]->bodies[static_cast<std::size_t>(b)]) {
      sense = a == b ? 1 : -1;
      break;
    }
  constexpr double parallel = 0.99;
  return !(sense * axes[0].stableNormalized().dot(axes[1].stableNormalized()) < -parallel);
}

} // namespace flyball
