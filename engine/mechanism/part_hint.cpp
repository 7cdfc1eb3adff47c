#include "engine/mechanism/part_hint.hpp"

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/text.hpp"

namespace flyball {

std::string part_hint(const Mechanism& mechanism, std::string_view name) {
  const std::string is_a = "; " + std::string(name) + " is a ", written = ", whose results are written as ";
  const int joint = joint_index(mechanism, name);
  if (joint >= 0 && !mechanism.joints[static_cast<std::size_t>(joint)].coordinates.empty()) {
    const auto count = mechanism.joints[static_cast<std::size_t>(joint)].coordinates.size();
    const std::string of =
        coordinate_argument(coordinate_label(std::string(name), 0, static_cast<int>(count)));
    return is_a + "joint" + written + "coordinate(" + of + ") or rate(" + of + ")";
  }
  if (body_index(mechanism, name) >= 0)
    return is_a + "body" + written + "x(" + argument_text(name) + ") or vx(" + argument_text(name) + ")";
  if (joint >= 0 || force_index(mechanism, name) >= 0)
    return "; of a part results are asked for, as in coordinate(slide) or x(ball)";
  return "";
}

} // namespace flyball
