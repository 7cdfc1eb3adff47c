#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/mistakes.hpp"

namespace flyball {
namespace {

// A cut of these leaves nothing in the tree, while those always cut hold a body by an implicit free joint.
bool is_cut_by_hand(const Joint& joint) {
  return joint.cut == true && joint.type != JointType::distance;
}

} // namespace

void find_connection_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  const BodyNumbers numbers(mechanism);
  BodyGroups uncut(numbers), all(numbers);
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::gear) continue;
    all.join(joint.bodies);
    if (!is_cut_by_hand(joint)) uncut.join(joint.bodies);
  }
  for (const Force& force : mechanism.forces) {
    if (!acts_between(force.type)) continue;
    all.join(force.bodies);
    uncut.join(force.bodies);
  }
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const std::string& name = mechanism.bodies[i].name;
    if (!all.on_ground(name)) mistakes.add(part_path("bodies", i, name), name + " is not connected");
  }
  // A cut joint is seen once the chain to its own ground side is known, hence the rounds.
  for (bool again = true; again;) {
    again = false;
    for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
      const Joint& joint = mechanism.joints[j];
      if (joint.type == JointType::gear || !is_cut_by_hand(joint)) continue;
      const bool parent_held = uncut.on_ground(joint.bodies[0]);
      if (parent_held == uncut.on_ground(joint.bodies[1])) continue;
      mistakes.add(joint_path(mechanism, j) + ".cut",
                   "expected false, or the key left out: without this joint " +
                       joint.bodies[parent_held ? 1 : 0] + " is not connected");
      uncut.join(joint.bodies);
      again = true;
    }
  }
}

} // namespace flyball
