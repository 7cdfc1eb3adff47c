#include "app/cli/hunting_told.hpp"

#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "app/plot/hunting_plot.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flyball::cli {

nlohmann::ordered_json hunting_json(const HopfPoint& p) {
  using Json = nlohmann::ordered_json;
  const bool any = p.lyapunov.has_value();
  return {{"frequency_rad_s", number_json(p.frequency)},
          {"loss", std::string(word(p.loss()))},
          {"lyapunov", any ? number_json(*p.lyapunov) : Json(nullptr)},
          {"error_estimate", any ? number_json(p.error) : Json(nullptr)},
          {"coordinate", any ? Json(coordinate_label(p.coordinate)) : Json(nullptr)},
          {"unit", any ? Json(p.coordinate.angle ? "1/rad^2" : "1/m^2") : Json(nullptr)},
          {"growing", p.growing},
          {"reason", p.reason}};
}

std::string hunting_text(const HopfPoint& p) {
  std::string out = frequency_text(p) + ", " + loss_text(p);
  if (p.lyapunov)
    out += fmt::format(": l1 = {:.6g} {} (\u00b1 {:.1g}) by the amplitude of {}", *p.lyapunov,
                       p.coordinate.angle ? "1/rad\u00b2" : "1/m\u00b2", p.error,
                       printable(coordinate_label(p.coordinate)));
  else if (!p.reason.empty())
    out += ": " + printable(p.reason);
  return out;
}

} // namespace flyball::cli
