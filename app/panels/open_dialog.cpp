#include "app/panels/dialog.hpp"
#include "app/panels/panels.hpp"
#include "app/panels/widgets.hpp"
#include "app/render/icons.hpp"

#include <imgui_stdlib.h>

#include <algorithm>

namespace flyball {

namespace {

namespace fs = std::filesystem;

struct Entry {
  fs::path path;
  bool folder = false;
};

// The folder that is being looked in: what was typed, or the folder of the file that was typed.
fs::path folder_of(const std::string& typed) {
  std::error_code ignored;
  const fs::path path(typed);
  return fs::is_directory(path, ignored) ? path : path.parent_path();
}

// Its folders and scenes, by name.
std::vector<Entry> entries_of(const fs::path& folder) {
  std::vector<Entry> entries;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    std::error_code ignored;
    const bool is_folder = it->is_directory(ignored);
    const std::string name = it->path().filename().string();
    if (name.starts_with('.') || (!is_folder && it->path().extension() != ".json")) continue;
    entries.push_back({it->path(), is_folder});
  }
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    return a.folder != b.folder ? a.folder : a.path.filename() < b.path.filename();
  });
  return entries;
}

void choose(App& app, const fs::path& path) {
  open_scene(app, path);
  // Where it cannot be read the view says why.
  close_dialog();
}

void list(App& app) {
  ImGui::BeginChild("files", {0, 230 * app.scale});
  const fs::path folder = folder_of(app.dialog.path);
  const fs::path shown = folder.empty() ? fs::path(".") : folder;
  fs::path entered;
  std::error_code ignored;
  const fs::path above = fs::absolute(shown, ignored).lexically_normal();
  const fs::path trimmed = above.has_filename() ? above : above.parent_path();
  if (trimmed.has_relative_path() && ImGui::Selectable((std::string(icon::folder_open) + "  ..").c_str(),
                                                       false, ImGuiSelectableFlags_DontClosePopups))
    entered = trimmed.parent_path();
  for (const Entry& entry : entries_of(shown)) {
    const std::string name = entry.path.filename().string();
    const std::string text = std::string(entry.folder ? icon::folder_open : icon::file) + "  " + name;
    if (ImGui::Selectable(text.c_str(), entry.path == app.dialog.path,
                          ImGuiSelectableFlags_DontClosePopups)) {
      if (entry.folder)
        entered = entry.path;
      else
        choose(app, entry.path);
    }
    note_widget(app.widgets, "open/" + name);
  }
  if (!entered.empty()) app.dialog.path = entered.string();
  ImGui::EndChild();
}

} // namespace

void show_open_dialog(App& app) {
  app.dialog.wanted = Dialog::open;
  app.dialog.path = app.file.empty() ? app.options.scenes.string() : app.file.string();
}

void open_dialog(App& app) {
  if (!begin_dialog(app, Dialog::open, "Open a scene", 560)) return;
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputText(
      "##path", &app.dialog.path, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  note_widget(app.widgets, "open/path");
  list(app);
  ImGui::Dummy({0, 2 * app.scale});
  std::error_code ignored;
  const bool usable = !app.dialog.path.empty() && !std::filesystem::is_directory(app.dialog.path, ignored);
  ImGui::BeginDisabled(!usable);
  const bool pressed = text_button(app, "open/open", "Open", true);
  ImGui::EndDisabled();
  if (usable && (entered || pressed)) choose(app, app.dialog.path);
  ImGui::SameLine();
  if (text_button(app, "open/cancel", "Cancel") || escape_pressed()) close_dialog();
  if (!app.options.scenes.empty()) {
    ImGui::SameLine();
    if (text_button(app, "open/shipped", "Shipped scenes")) app.dialog.path = app.options.scenes.string();
  }
  end_dialog();
}

} // namespace flyball
