#include "app/session/coordinate_words.hpp"

#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/text.hpp"

#include <optional>
#include <string_view>

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

std::string speed_words(const std::string& coordinate) {
  return "speed of " + coordinate;
}

std::string label_words(const Mechanism& mechanism, const std::string& label) {
  constexpr std::string_view speed = ".speed";
  const auto words = [&](const std::string& joint, int count,
                         const auto& is_an_angle) -> std::optional<std::string> {
    if (!label.starts_with(joint)) return std::nullopt;
    for (int i = 0; i < count; ++i) {
      const std::string own = coordinate_label(joint, i, count);
      if (label == own) return coordinate_words(joint, i, count, is_an_angle(i));
      if (label == own + std::string(speed))
        return speed_words(coordinate_words(joint, i, count, is_an_angle(i)));
    }
    return std::nullopt;
  };
  for (const Joint& joint : mechanism.joints)
    if (const auto found =
            words(joint.name, coordinate_count(joint.type), [&](int i) { return is_angle(joint.type, i); }))
      return *found;
  for (const Body& body : mechanism.bodies)
    if (const auto found = words(body.name + std::string(implicit_joint), 6, [](int i) { return i > 2; }))
      return *found;
  return label;
}

std::string found_words(const CoordinateSolution& c) {
  return c.speed ? speed_words(coordinate_words(c)) : coordinate_words(c);
}

} // namespace flyball
