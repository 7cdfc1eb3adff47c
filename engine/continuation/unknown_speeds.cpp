#include "engine/continuation/unknown_speeds.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/report/report.hpp"

namespace flyball {

std::string unknown_speeds(const ResponseDiagram& diagram, const std::string& address) {
  std::string first;
  double parameter = 0;
  int count = 0;
  for (const ResponseBranch& branch : diagram.branches)
    for (const ResponsePoint& point : branch.points) {
      std::string why = unknown_coordinate_message(point.coordinates);
      if (why.empty() || count++ > 0) continue;
      first = std::move(why);
      parameter = point.parameter;
    }
  if (count == 0) return "";
  return "At " + address + " = " + rounded_text(parameter, 6) +
         (count > 1 ? " and " + std::to_string(count - 1) + " more points: " : ": ") + first;
}

} // namespace flyball
