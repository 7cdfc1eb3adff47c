#include "engine/periodic/drive_period.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/system/common_period.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

void DrivePeriod::find_common() {
  period = common_period(speeds, followed_turns).value_or(0);
  trouble.clear();
  if (period > 0) return;
  const std::vector<std::string_view> all(names.begin(), names.end());
  trouble = "The speeds of " + word_list(all, "and") + " have no common period of at most " +
            std::to_string(followed_turns) +
            " turns: their motion is quasi-periodic, or comes back after more turns.";
}

DrivePeriod drive_period(const MotionModel& model) {
  DrivePeriod out;
  for (const DrivenCoordinate& d : model.system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    const Link& link = model.system.links[l];
    const double speed = model.parameters.links[l].speed;
    if (speed == 0) continue;
    out.names.push_back(coordinate_label(model.system, link));
    if (link.type != LinkType::revolute) {
      out.trouble = out.names.back() + " slides on and on: no motion with it comes back.";
      out.speeds.clear();
      return out;
    }
    out.speeds.push_back(speed);
    out.fastest = std::max(out.fastest, std::abs(speed));
  }
  if (!out.speeds.empty())
    out.find_common();
  else if (std::ranges::none_of(model.system.torques, [](const DriveTorqueElement& drive) {
             return !drive.keeps_momentum && !drive.implied;
           }))
    out.trouble = "Nothing is driven at a speed or by a torque, so that there is no period to look for.";
  return out;
}

} // namespace flyball
