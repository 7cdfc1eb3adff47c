#include "app/document/recent_files.hpp"

#include "app/document/file_watch.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace flyball {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path list_file(const fs::path& state_folder) {
  return state_folder / "recent.json";
}

} // namespace

std::vector<fs::path> read_recent_files(const fs::path& state_folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  if (!fs::is_regular_file(list_file(state_folder), ignored)) return files;
  try {
    const json list = json::parse(read_bytes(list_file(state_folder)), nullptr, false);
    if (!list.is_array()) return files;
    for (const json& entry : list) {
      if (!entry.is_string()) continue;
      fs::path file = entry.get<std::string>();
      if (files.size() < most_recent_files && fs::is_regular_file(file, ignored) &&
          std::ranges::find(files, file) == files.end())
        files.push_back(std::move(file));
    }
  } catch (const SceneError&) { // unreadable
  }
  return files;
}

std::vector<fs::path> add_recent_file(const fs::path& state_folder, const fs::path& file) {
  std::error_code ignored;
  const fs::path added = resolved(file);
  std::vector<fs::path> files = read_recent_files(state_folder);
  std::erase(files, added);
  files.insert(files.begin(), added);
  files.resize(std::min(files.size(), most_recent_files));
  json list = json::array();
  for (const fs::path& entry : files)
    list.push_back(entry.string());
  try {
    fs::create_directories(state_folder, ignored);
    // A name that is not UTF-8 is kept as one that does not exist.
    replace_file(list_file(state_folder), list.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  } catch (const SceneError&) { // the list is a convenience, no reason to disturb anybody
  }
  return files;
}

} // namespace flyball
