#include "app/document/state_file.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <nlohmann/json.hpp>

namespace flyball {

namespace fs = std::filesystem;
using nlohmann::json;

json read_state(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return nullptr;
  try {
    json state = json::parse(read_bytes(file), nullptr, false);
    if (!state.is_discarded()) return state;
  } catch (const SceneError&) { // unreadable
  }
  return nullptr;
}

void write_state(const fs::path& file, const json& state) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  try {
    replace_file(file, state.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  } catch (const SceneError&) { // it stays as it was
  }
}

NamedHues read_hues(const json& entry) {
  NamedHues named;
  if (const auto hues = entry.find("colours"); hues != entry.end() && hues->is_object())
    for (const auto& [body, hue] : hues->items())
      if (hue.is_number_unsigned() && hue.get<std::uint64_t>() < body_hue_count * body_shade_count)
        named[body] = hue.get<std::uint8_t>();
  return named;
}

void write_hues(json& entry, const NamedHues& hues) {
  for (const auto& [body, hue] : hues)
    entry["colours"][body] = hue;
}

} // namespace flyball
