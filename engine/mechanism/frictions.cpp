#include "engine/mechanism/frictions.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/referred_to.hpp"

namespace flyball {

std::vector<CoordinateReference> find_frictions(const Mechanism& mechanism) {
  std::vector<CoordinateReference> all;
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size(); ++i)
      if (mechanism.joints[j].coordinates[i].friction)
        all.push_back({static_cast<int>(j), static_cast<int>(i)});
  return all;
}

const Friction& friction_at(const Mechanism& mechanism, CoordinateReference at) {
  return *coordinate_of(mechanism, at).friction;
}

std::string share_address(const Mechanism& mechanism, CoordinateReference at) {
  const Joint& joint = joint_of(mechanism, at);
  return "joints." + joint.name + "." +
         coordinate_key(joint, static_cast<std::size_t>(at.coordinate), "friction") + ".share";
}

} // namespace flyball
