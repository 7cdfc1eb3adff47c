#include "app/ui/widgets/file_list.hpp"

#include "app/platform/access.hpp"
#include "app/render/icons.hpp"
#include "app/render/imgui_compat.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace flyball {

namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool may_write(const fs::path& folder) {
  return is_folder(folder) && !write_refusal(folder);
}

fs::path home_folder() {
  const char* home = std::getenv("HOME");
  return home ? fs::path(home) : fs::path("/");
}

std::string lower(std::string text) {
  for (char& c : text)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Its folders and files of the extension, by name.
std::vector<FolderEntry> entries_of(const fs::path& folder, const std::string& extension) {
  std::vector<FolderEntry> entries;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    std::error_code ignored;
    const bool inner = it->is_directory(ignored);
    if (it->path().filename().string().starts_with('.')) continue;
    if (inner || it->path().extension() == extension) entries.push_back({it->path(), inner});
  }
  std::ranges::sort(entries, [](const FolderEntry& a, const FolderEntry& b) {
    return a.folder != b.folder ? a.folder : a.path.filename() < b.path.filename();
  });
  return entries;
}

// Of a typed path the folder that is to be listed, and the rest, which filters.
struct Place {
  fs::path folder;
  std::string filter;
};
Place place_of(const FileQuery& query) {
  const fs::path path = typed_path(query);
  const bool ends_in_folder = query.path.ends_with('/') || query.path.ends_with("..");
  if (ends_in_folder && is_folder(path)) return {path, {}};
  const bool elsewhere = query.path.find('/') != std::string::npos;
  if (elsewhere && is_folder(path.parent_path())) return {path.parent_path(), path.filename().string()};
  return {query.list.shown, query.path};
}

std::vector<FolderEntry> shown_entries(const FileQuery& query, bool filtered) {
  std::vector<FolderEntry> shown = query.list.entries;
  const std::string filter = filtered ? lower(place_of(query).filter) : std::string();
  std::erase_if(shown, [&](const FolderEntry& entry) {
    return lower(entry.path.filename().string()).find(filter) == std::string::npos;
  });
  return shown;
}

} // namespace

fs::path typed_path(const FileQuery& query) {
  std::string typed = query.path;
  if (typed == "~" || typed.starts_with("~/")) typed = home_folder().string() + typed.substr(1);
  return resolved(query.list.shown / typed);
}

fs::path typed_file(const FileQuery& query, const std::string& extension) {
  fs::path path = typed_path(query);
  if (path.has_filename() && !is_folder(path) && path.extension() != extension) path += extension;
  return path;
}

void show_folder(FileQuery& query, const fs::path& folder) {
  query.list = {};
  query.list.shown = resolved(folder.empty() ? fs::path(".") : folder / ""); // where a link leads
  query.message.clear();
}

bool path_field(Ui& ui, FileQuery& query, const std::string& name, const char* hint) {
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = query.path;
  const bool entered = ImGui::InputTextWithHint(
      "##path", hint, &query.path, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  if (entered) ImGui::SetKeyboardFocusHere(-1);
  note_widget(ui.widgets, name + "/path", KeyUse::type);
  if (query.path != before) {
    query.message.clear();
    query.list.chosen = -1;
  }
  return entered;
}

void folder_line(Ui& ui, FileQuery& query, const std::string& name) {
  const fs::path folder = place_of(query).folder;
  const fs::path here = folder.has_filename() ? folder : folder.parent_path();
  ImGui::BeginDisabled(!here.has_relative_path());
  if (icon_button(ui, name + "/up", icon::folder_up, "The folder above")) {
    show_folder(query, here.parent_path());
    query.path = fs::path(query.path).filename().string();
  }
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).dim);
  clipped_text(here.string(), ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
}

std::optional<fs::path> file_list(Ui& ui, FileQuery& query, const std::string& name,
                                  const std::string& extension, bool filtered, float height) {
  FolderList& list = query.list;
  const fs::path folder = place_of(query).folder;
  if (ImGui::IsWindowAppearing() || list.read != folder) {
    list.entries = entries_of(folder, extension);
    list.read = folder;
  }
  const std::vector<FolderEntry> shown = shown_entries(query, filtered);
  const int count = static_cast<int>(shown.size());
  bool moved = false;
  if (filtered && count > 0) {
    const auto pressed = [](ImGuiKey key) { return imgui_compat::key_pressed(key); };
    const int step = pressed(ImGuiKey_DownArrow) - pressed(ImGuiKey_UpArrow);
    moved = step != 0;
    list.chosen = std::min(list.chosen, count - 1);
    if (moved) list.chosen = list.chosen < 0 ? 0 : (list.chosen + step + count) % count;
  }

  std::optional<fs::path> clicked;
  ImGui::PushStyleColor(ImGuiCol_Header, colors_of(ui).raised);
  ImGui::BeginChild((name + "/files").c_str(), {0, height});
  for (int i = 0; i < count; ++i) {
    const FolderEntry& entry = shown[static_cast<std::size_t>(i)];
    const std::string file = entry.path.filename().string();
    const std::string text = std::string(entry.folder ? icon::folder : icon::file) + "  " + file;
    const bool chosen = filtered ? i == list.chosen : entry.path == typed_path(query);
    if (ImGui::Selectable(text.c_str(), chosen, ImGuiSelectableFlags_DontClosePopups)) clicked = entry.path;
    if (chosen && moved) ImGui::SetScrollHereY();
    note_widget(ui.widgets, name + "/" + file, KeyUse::row);
  }
  if (shown.empty())
    paragraph(list.entries.empty() ? "No " + extension + " files here." : "Nothing of that name here.",
              colors_of(ui).dim);
  ImGui::EndChild();
  ImGui::PopStyleColor();
  if (!clicked || !is_folder(*clicked)) return clicked;
  const std::string kept = filtered ? std::string() : fs::path(query.path).filename().string();
  show_folder(query, *clicked);
  query.path = kept;
  return std::nullopt;
}

std::optional<fs::path> entered_file(FileQuery& query, bool filtered) {
  const std::vector<FolderEntry> shown = shown_entries(query, filtered);
  const auto chosen = static_cast<std::size_t>(std::max(query.list.chosen, 0));
  std::error_code ignored;
  fs::path path = typed_path(query);
  if (filtered && query.list.chosen >= 0 && chosen < shown.size())
    path = shown[chosen].path;
  else if (query.path.empty())
    return std::nullopt;
  else if (filtered && !fs::exists(path, ignored) && !shown.empty())
    path = shown.front().path;
  if (!is_folder(path)) return path;
  show_folder(query, path);
  query.path.clear();
  return std::nullopt;
}

const char* asked_before_writing(Ui& ui, const FileQuery& query, const fs::path& file) {
  if (file != query.asked) return nullptr;
  const bool folder = is_folder(file.parent_path());
  paragraph(folder ? file.filename().string() + " is there already. Replace it?"
                   : "There is no folder " + file.parent_path().string() + " yet. Make it?",
            colors_of(ui).warn);
  note_widget(ui.widgets, "file question");
  return folder ? "Replace" : "Make the folder";
}

bool may_write_to(const Session& session, FileQuery& query, const fs::path& file) {
  std::error_code failed;
  const bool asked = file == query.asked, folder = is_folder(file.parent_path());
  if (folder && file != session.document.file()) {
    const fs::path target = fs::weakly_canonical(file, failed); // through links
    const fs::path written_to = (failed ? file : target).parent_path();
    if (const std::error_code refusal = write_refusal(written_to)) {
      query.message = "Nothing can be written into " + written_to.string() + ": " + refusal.message() + ".";
      query.asked.clear();
      return false;
    }
  }
  if (folder && (asked || !fs::exists(file, failed) || file == session.document.file())) return true;
  if (!asked) {
    query.asked = file;
    return false;
  }
  fs::create_directories(file.parent_path(), failed);
  query.list.read.clear(); // it has another entry now
  if (!failed && file.has_filename()) return true;
  if (!failed) { // a folder alone was typed
    show_folder(query, file.parent_path());
    query.path.clear();
    query.asked.clear();
    return false;
  }
  query.message = "The folder " + file.parent_path().string() + " cannot be made: " + failed.message() + ".";
  query.asked.clear();
  return false;
}

fs::path usual_folder(const Session& session) {
  std::error_code ignored;
  std::vector<fs::path> folders;
  if (!is_example(session)) folders.push_back(session.document.file().parent_path());
  for (const fs::path& recent : session.files.recent) // the shipped scenes may lie behind a link
    if (!fs::equivalent(recent.parent_path(), session.options.scenes, ignored))
      folders.push_back(recent.parent_path());
  folders.push_back(fs::current_path(ignored));
  for (const fs::path& folder : folders)
    if (may_write(folder)) return folder;
  return home_folder();
}

std::string file_stem(const std::string& words) {
  std::string stem;
  for (const char c : lower(words))
    stem += c == ' ' || c == '/' ? '_' : c;
  return stem.empty() ? "untitled" : stem;
}

std::string file_stem(const Session& session) {
  const fs::path& file = session.document.file();
  if (file.empty()) return file_stem(session.mechanism().name);
  const fs::path stem = file.stem();
  return (stem.extension() == ".flyball" ? stem.stem() : stem).string();
}

} // namespace flyball
