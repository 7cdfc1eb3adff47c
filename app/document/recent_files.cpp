#include "app/document/recent_files.hpp"

#include "app/document/file_watch.hpp"
#include "app/document/state_file.hpp"

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
  const json list = read_state(list_file(state_folder));
  if (!list.is_array()) return files;
  std::error_code ignored;
  for (const json& entry : list) {
    if (!entry.is_string()) continue;
    fs::path file = entry.get<std::string>();
    if (files.size() < most_recent_files && fs::is_regular_file(file, ignored) &&
        std::ranges::find(files, file) == files.end())
      files.push_back(std::move(file));
  }
  return files;
}

std::vector<fs::path> add_recent_file(const fs::path& state_folder, const fs::path& file) {
  const fs::path added = resolved(file);
  std::vector<fs::path> files = read_recent_files(state_folder);
  std::erase(files, added);
  files.insert(files.begin(), added);
  files.resize(std::min(files.size(), most_recent_files));
  json list = json::array();
  for (const fs::path& entry : files)
    list.push_back(entry.string());
  write_state(list_file(state_folder), list); // a name that is not UTF-8 as one that does not exist
  return files;
}

} // namespace flyball
