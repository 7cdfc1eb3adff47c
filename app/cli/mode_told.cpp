#include "app/cli/mode_told.hpp"

#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flyball::cli {

using Json = nlohmann::ordered_json;

Json whirl_json(const std::optional<Whirl>& whirl, double frequency) {
  if (!whirl) return nullptr;
  Json out = {{"value", whirl->value},
              {"direction", word(whirl->direction())},
              {"seen_from", whirl->turning ? "drive" : "ground"}};
  if (whirl->turning) out["from_ground_rad_s"] = standing_frequencies(*whirl, frequency);
  return out;
}

std::string whirl_text(const std::optional<Whirl>& whirl) {
  if (!whirl) return "";
  return fmt::format("  whirl {:+.3f} {}{}", whirl->value, word(whirl->direction()),
                     whirl->turning ? ", seen from the drive" : "");
}

Json mode_json(const VibrationMode& mode, const std::optional<Whirl>& whirl) {
  Json out = {{"eigenvalue", {mode.eigenvalue.real(), mode.eigenvalue.imag()}},
              {"frequency_hz", hertz(mode.frequency)},
              {"damping_ratio", mode.damping_ratio},
              {"whirl", whirl_json(whirl, mode.frequency)}};
  Json& shape = out["shape"] = Json::object();
  for (const ModeAmplitude& a : mode.amplitudes)
    shape[coordinate_label(a)] = {a.value.real(), a.value.imag()};
  return out;
}

} // namespace flyball::cli
