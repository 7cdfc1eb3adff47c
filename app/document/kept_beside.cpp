#include "app/document/kept_beside.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <nlohmann/json.hpp>

namespace flyball {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path store_in(const fs::path& state_folder) {
  return state_folder / "beside.json";
}

// Of all files, the one that was kept last first.
json read_store(const fs::path& state_folder) {
  std::error_code ignored;
  if (!fs::is_regular_file(store_in(state_folder), ignored)) return json::array();
  try {
    json store = json::parse(read_bytes(store_in(state_folder)), nullptr, false);
    if (store.is_array()) return store;
  } catch (const SceneError&) { // unreadable
  }
  return json::array();
}

bool is_of(const json& entry, const fs::path& file) {
  if (!entry.is_object()) return false;
  const auto name = entry.find("file");
  return name != entry.end() && name->is_string() && name->get_ref<const std::string&>() == file.string();
}

} // namespace

KeptBeside read_beside(const fs::path& state_folder, const fs::path& file) {
  KeptBeside kept;
  if (state_folder.empty() || file.empty()) return kept;
  for (const json& entry : read_store(state_folder)) {
    if (!is_of(entry, file)) continue;
    if (const auto explored = entry.find("explored"); explored != entry.end() && explored->is_object())
      for (const auto& [address, value] : explored->items())
        if (value.is_number()) kept.explored.push_back({address, value.get<double>()});
    if (const auto hues = entry.find("colours"); hues != entry.end() && hues->is_object())
      for (const auto& [body, hue] : hues->items())
        if (hue.is_number_unsigned() && hue.get<std::uint64_t>() < body_hue_count * body_shade_count)
          kept.hues[body] = hue.get<std::uint8_t>();
    break;
  }
  return kept;
}

void keep_beside(const fs::path& state_folder, const fs::path& file, const KeptBeside& kept) {
  if (state_folder.empty() || file.empty()) return;
  json store = read_store(state_folder);
  json left = json::array();
  if (kept != KeptBeside()) {
    json& entry = left.emplace_back(json{{"file", file.string()}});
    for (const ExploredValue& each : kept.explored)
      entry["explored"][each.address] = each.value;
    for (const auto& [body, hue] : kept.hues)
      entry["colours"][body] = hue;
  }
  for (json& entry : store)
    if (left.size() < most_kept_beside && !is_of(entry, file)) left.push_back(std::move(entry));
  if (left == store) return;
  std::error_code ignored;
  fs::create_directories(state_folder, ignored);
  try {
    // A name that is not UTF-8 is kept as one that does not exist.
    write_bytes(store_in(state_folder), left.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  } catch (const SceneError&) { // a convenience
  }
}

} // namespace flyball
