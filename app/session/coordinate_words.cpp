#include "app/session/coordinate_words.hpp"

#include "engine/mechanism/result_functions.hpp"

namespace flyball {

std::string joint_words(const std::string& joint) {
  return joint.ends_with(implicit_joint) ? joint.substr(0, joint.size() - implicit_joint.size()) : joint;
}

std::string coordinate_words(const std::string& joint, int index, int count, bool angle) {
  const std::string name = joint_words(joint);
  if (count == 1) return name;
  // A universal joint has two angles, a cylindrical one an angle and a slide.
  if (count == 2) return name + (index == 0 ? ", angle" : angle ? ", angle at the child" : ", slide");
  return name + (angle ? ", rotation " : ", shift ") + "xyz"[index % 3];
}

std::string found_words(const CoordinateSolution& c) {
  return coordinate_words(c) + (c.speed ? ".speed" : "");
}

} // namespace flyball
