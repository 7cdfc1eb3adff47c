#include "app/session/settled_pose.hpp"

namespace flyball {

MechanismPose settled_pose(const Mechanism& mechanism, const Solution& solution) {
  MechanismPose pose;
  pose.bodies = solution.poses;
  pose.coordinates.resize(mechanism.joints.size());
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size() && i < 6; ++i)
      pose.coordinates[j][i] = mechanism.joints[j].coordinates[i].drawn;
  for (const CoordinateSolution& c : solution.coordinates)
    if (const int j = joint_index(mechanism, c.joint); j >= 0)
      pose.coordinates[static_cast<std::size_t>(j)][static_cast<std::size_t>(c.index)] = c.value;
  return pose;
}

} // namespace flyball
