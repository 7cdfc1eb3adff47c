#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/text.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {
namespace {

// A cut of these leaves nothing in the tree, while those always cut hold a body by an implicit free joint.
bool is_cut_by_hand(const Joint& joint) {
  return joint.cut == true && joint.type != JointType::distance;
}

// "b is not connected to the ground, nor is c", which hangs together with it.
std::string not_connected(const Mechanism& mechanism, const std::vector<std::size_t>& bodies) {
  constexpr std::size_t most = 4; // named
  const std::string sentence = mechanism.bodies[bodies[0]].name + " is not connected";
  if (bodies.size() == 1) return sentence;
  std::vector<std::string_view> others;
  for (std::size_t k = 1; k < bodies.size() && k <= most; ++k)
    others.emplace_back(mechanism.bodies[bodies[k]].name);
  const std::string more = std::to_string(bodies.size() - 1 - others.size()) + " more";
  if (bodies.size() - 1 > most) others.emplace_back(more);
  return sentence + " to the ground, nor " + (bodies.size() == 2 ? "is " : "are ") + word_list(others, "and");
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
  // Those that hang together lack one connection, which is one mistake.
  std::map<std::size_t, std::vector<std::size_t>> loose;
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
    if (const std::size_t first = all.first_of(mechanism.bodies[i].name); first != 0)
      loose[first].push_back(i);
  for (const auto& [first, bodies] : loose)
    mistakes.add(part_path("bodies", bodies[0], mechanism.bodies[bodies[0]].name),
                 not_connected(mechanism, bodies));
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
