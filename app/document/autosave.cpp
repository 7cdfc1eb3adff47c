#include "app/document/autosave.hpp"

#include "app/document/file_watch.hpp"
#include "app/document/state_file.hpp"
#include "app/platform/access.hpp"
#include "app/platform/process.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <optional>

namespace flyball {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kept = ".flyball-autosave";
constexpr const char* aside = ".flyball-discarded";

fs::path folder_in(const fs::path& state_folder) {
  return state_folder / "autosave";
}

// What the name begins with; beside a file it is hidden.
std::string name_beside(const fs::path& file) {
  return "." + file.filename().string() + ".";
}
std::string name_in_state(const fs::path& file) {
  return (file.empty() ? std::string("untitled") : file.filename().string()) + ".";
}

fs::path free_name(const fs::path& folder, const std::string& begin) {
  const std::string name = begin + std::to_string(process_number());
  std::error_code ignored;
  fs::path path = folder / (name + kept);
  for (int n = 2; fs::exists(path, ignored); ++n) // of a former process with our number
    path = folder / (name + "-" + std::to_string(n) + kept);
  return path;
}

// Of a document's file and a number, and nothing else: "a.json.12.autosave" but not
// "a.json.b.json.12.autosave".
bool is_named(const std::string& name, const std::string& begin, const std::string& end) {
  if (!name.starts_with(begin) || !name.ends_with(end) || name.size() <= begin.size() + end.size())
    return false;
  const std::string middle = name.substr(begin.size(), name.size() - begin.size() - end.size());
  return middle.find_first_not_of("0123456789-") == std::string::npos;
}

void for_each_file(const fs::path& folder, const std::function<void(const fs::path&)>& visit) {
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored)) visit(it->path());
  }
}

std::optional<Autosave> read_autosave(const fs::path& path) {
  try {
    return parse_autosave(read_bytes(path));
  } catch (const SceneError&) {
    return std::nullopt; // not ours to judge, and never to remove
  }
}

fs::path rename_end(const fs::path& path, std::string_view from, std::string_view to) {
  const std::string name = path.string();
  fs::path renamed = name.substr(0, name.size() - (name.ends_with(from) ? from.size() : 0)) + std::string(to);
  std::error_code failed;
  fs::rename(path, renamed, failed);
  if (failed) throw SceneError(path.string(), failed.message());
  return renamed;
}

// Whether an autosave in the state folder is of the file: its name alone does not tell the folder.
bool is_of(const fs::path& path, const fs::path& file) {
  const std::optional<Autosave> autosave = read_autosave(path);
  return autosave && autosave->file == file;
}

// All files of that kind (kept or aside) of the document's file.
std::vector<fs::path> files_of(const fs::path& file, const fs::path& state_folder, const char* kind) {
  std::vector<fs::path> found;
  if (!file.empty())
    for_each_file(file.parent_path(), [&](const fs::path& path) {
      if (is_named(path.filename().string(), name_beside(file), kind)) found.push_back(path);
    });
  for_each_file(folder_in(state_folder), [&](const fs::path& path) {
    if (is_named(path.filename().string(), name_in_state(file), kind) && is_of(path, file))
      found.push_back(path);
  });
  return found;
}

} // namespace

std::string write_autosave(const Autosave& autosave) {
  const std::string file = autosave.file.string();
  json line = {{"flyball_autosave", 1},         {"file", file},
               {"name", autosave.name},         {"owner", autosave.owner},
               {"based_on", autosave.based_on}, {"made", autosave.made}};
  write_hues(line, autosave.hues);
  // Text of JSON is UTF-8, which names of files need not be.
  if (find_invalid_utf8(file) != std::string::npos)
    line["file_bytes"] = std::vector<unsigned char>(file.begin(), file.end());
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n" + autosave.scene;
}

Autosave parse_autosave(std::string_view text) {
  const std::size_t end = text.find('\n');
  const json line = json::parse(text.substr(0, end), nullptr, false);
  if (end == std::string_view::npos || !line.is_object() || line.value("flyball_autosave", json()) != 1)
    throw SceneError("", "expected an autosave of version 1");
  try {
    Autosave autosave;
    autosave.file = line.at("file").get<std::string>();
    if (line.contains("file_bytes")) {
      const auto bytes = line["file_bytes"].get<std::vector<unsigned char>>();
      autosave.file = std::string(bytes.begin(), bytes.end());
    }
    autosave.name = line.at("name").get<std::string>();
    autosave.owner = line.at("owner").get<std::string>();
    autosave.based_on = line.at("based_on").get<std::uint64_t>();
    autosave.made = line.at("made").get<std::int64_t>();
    autosave.hues = read_hues(line);
    autosave.scene = text.substr(end + 1);
    return autosave;
  } catch (const json::exception& error) {
    throw SceneError("", error.what());
  }
}

std::vector<fs::path> autosave_places(const fs::path& file, const fs::path& state_folder) {
  std::vector<fs::path> places;
  // A folder that may not be written to is left alone; one that turns out so is found when writing.
  if (!file.empty() && !write_refusal(file.parent_path()))
    places.push_back(free_name(file.parent_path(), name_beside(file)));
  places.push_back(free_name(folder_in(state_folder), name_in_state(file)));
  return places;
}

std::vector<Leftover> find_leftovers(const fs::path& file, const fs::path& state_folder) {
  std::vector<Leftover> leftovers;
  std::string text;
  try {
    if (!file.empty() && stamp_of(file)) text = read_bytes(file);
  } catch (const SceneError&) { // gone: all the more reason to look
  }
  for (const fs::path& path : files_of(file, state_folder, kept)) {
    std::optional<Autosave> autosave = read_autosave(path);
    if (!autosave || is_running(autosave->owner)) continue;
    if (!file.empty() && autosave->scene == text) {
      std::error_code ignored;
      fs::remove(path, ignored);
      continue;
    }
    autosave->file = file; // the folder may have been moved since
    const bool outdated = !file.empty() && autosave->based_on != text_hash(text);
    leftovers.push_back({path, std::move(*autosave), outdated});
  }
  std::ranges::sort(leftovers, std::greater(), [](const Leftover& one) { return one.autosave.made; });
  return leftovers;
}

fs::path put_aside(const fs::path& leftover) {
  return rename_end(leftover, kept, aside);
}

fs::path bring_back(const fs::path& path) {
  return rename_end(path, aside, kept);
}

void remove_aside(const fs::path& file, const fs::path& state_folder) {
  std::error_code ignored;
  for (const fs::path& path : files_of(file, state_folder, aside))
    fs::remove(path, ignored);
}

void remove_old_aside(const fs::path& state_folder) {
  const auto month_ago = fs::file_time_type::clock::now() - std::chrono::hours(24 * 30);
  std::vector<fs::path> old;
  for_each_file(folder_in(state_folder), [&](const fs::path& path) {
    std::error_code failed;
    const auto written = fs::last_write_time(path, failed);
    if (!failed && path.string().ends_with(aside) && written < month_ago) old.push_back(path);
  });
  std::error_code ignored;
  for (const fs::path& path : old)
    fs::remove(path, ignored);
}

} // namespace flyball
