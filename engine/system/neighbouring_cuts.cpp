#include "engine/system/joint_parts.hpp"

#include <algorithm>

namespace flyball {

std::vector<CutChoice> neighbouring_cuts(const Mechanism& mechanism, const System& system) {
  std::vector<int> chosen;
  for (const CutJoint& c : system.cuts) {
    const Joint& x = mechanism.joints[static_cast<std::size_t>(c.joint)];
    if (joins_trees(x.type) && x.cut != true) chosen.push_back(c.joint);
  }
  std::vector<CutChoice> result;
  for (int cut : chosen) {
    const auto c = std::ranges::find(system.cuts, cut, &CutJoint::joint);
    // The tree joints of the loop: those that are on one side's way to the root, but not on both.
    std::vector<int> loop;
    const auto walk = [&](int l) {
      for (int last = -1; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
        const int t = system.links[static_cast<std::size_t>(l)].tree_joint;
        if (t == last) continue;
        last = t;
        if (const auto it = std::ranges::find(loop, t); it != loop.end())
          loop.erase(it);
        else
          loop.push_back(t);
      }
    };
    walk(c->ends.a);
    walk(c->ends.b);
    for (int t : loop) {
      const TreeJoint& tree = system.tree_joints[static_cast<std::size_t>(t)];
      if (tree.joint < 0 || tree.closes_loop) continue;
      const Joint& x = mechanism.joints[static_cast<std::size_t>(tree.joint)];
      const auto moved = [&](const Link& l) { return l.tree_joint == t && l.drive >= 0; };
      if (x.cut == false || x.type == JointType::free || std::ranges::any_of(system.links, moved)) continue;
      CutChoice other{chosen};
      *std::ranges::find(other.cut, cut) = tree.joint;
      result.push_back(std::move(other));
    }
  }
  return result;
}

} // namespace flyball
