#include "app/document/kept_beside.hpp"

#include "app/document/state_file.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>

namespace flyball {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path store_in(const fs::path& state_folder) {
  return state_folder / "beside.json";
}

// Of all files, the one that was kept last first.
json read_store(const fs::path& state_folder) {
  json store = read_state(store_in(state_folder));
  return store.is_array() ? store : json::array();
}

Explored read_numbers(const json& entry, const char* key) {
  Explored out;
  if (const auto numbers = entry.find(key); numbers != entry.end() && numbers->is_object())
    for (const auto& [address, value] : numbers->items())
      if (value.is_number()) out.push_back({address, value.get<double>()});
  return out;
}

// Nothing where there is none, or an expression gives it.
std::optional<double> own_number(const Mechanism& mechanism, const std::string& address) {
  return formula_at(mechanism, address) ? std::nullopt : find_number(mechanism, address);
}

// In JSON, which has UTF-8 alone.
bool can_be_named(const fs::path& file) {
  return !file.empty() && find_invalid_utf8(file.string()) == std::string::npos;
}

bool is_of(const json& entry, const fs::path& file) {
  if (!entry.is_object()) return false;
  const auto name = entry.find("file");
  return name != entry.end() && name->is_string() && name->get_ref<const std::string&>() == file.string();
}

} // namespace

void keep_explored(KeptBeside& kept, const Mechanism& stored, const Explored& explored) {
  kept.explored = explored;
  kept.stored.clear();
  for (const ExploredValue& each : explored)
    if (const auto beneath = own_number(stored, each.address))
      kept.stored.push_back({each.address, *beneath});
}

Explored still_explored(const KeptBeside& kept, const Mechanism& mechanism) {
  Explored out;
  for (const ExploredValue& each : kept.explored) {
    const auto beneath = std::ranges::find(kept.stored, each.address, &ExploredValue::address);
    if (beneath != kept.stored.end() && own_number(mechanism, each.address) == beneath->value)
      out.push_back(each);
  }
  return out;
}

KeptBeside read_beside(const fs::path& state_folder, const fs::path& file) {
  KeptBeside kept;
  if (state_folder.empty() || !can_be_named(file)) return kept;
  for (const json& entry : read_store(state_folder)) {
    if (!is_of(entry, file)) continue;
    kept.explored = read_numbers(entry, "explored");
    kept.stored = read_numbers(entry, "stored");
    kept.hues = read_hues(entry);
    break;
  }
  return kept;
}

void keep_beside(const fs::path& state_folder, const fs::path& file, const KeptBeside& kept) {
  if (state_folder.empty() || !can_be_named(file)) return;
  const json store = read_store(state_folder);
  json left = json::array();
  if (kept != KeptBeside()) {
    json& entry = left.emplace_back(json{{"file", file.string()}});
    for (const ExploredValue& each : kept.explored)
      entry["explored"][each.address] = each.value;
    for (const ExploredValue& each : kept.stored)
      entry["stored"][each.address] = each.value;
    write_hues(entry, kept.hues);
  }
  for (const json& entry : store)
    if (left.size() < most_kept_beside && !is_of(entry, file)) left.push_back(entry);
  if (left != store) write_state(store_in(state_folder), left);
}

} // namespace flyball
