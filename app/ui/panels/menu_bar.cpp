#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cfloat>

namespace flyball {

namespace {

struct Menu {
  const char* title;
  std::string_view prefix; // of its commands' ids
};
constexpr std::array menus{Menu{"File", "file."}, Menu{"Edit", "edit."},   Menu{"Insert", "insert."},
                           Menu{"View", "view."}, Menu{"Units", "units."}, Menu{"Study", "study."},
                           Menu{"Help", "help."}};

void recent_menu(const Session& session, Ui& ui, const CommandRunner& commands) {
  const auto& files = session.files.recent;
  if (files.empty()) return;
  const bool open = ImGui::BeginMenu("Open recent");
  if (!open) note_widget(ui.widgets, "menu/recent");
  if (!open) return;
  std::filesystem::path chosen;
  for (const std::filesystem::path& file : files) {
    ImGui::PushID(file.c_str());
    if (ImGui::MenuItem(file.filename().c_str(), nullptr)) chosen = file;
    note_widget(ui.widgets, "menu/recent/" + file.string());
    help_on_hover(file.c_str());
    ImGui::PopID();
  }
  ImGui::EndMenu();
  if (!chosen.empty()) commands.open(chosen);
}

void items(const Session& session, Ui& ui, const CommandRunner& commands, const Menu& menu) {
  for (const Command& command : flyball::commands()) {
    if (!std::string_view(command.id).starts_with(menu.prefix)) continue;
    if (command.separated) ImGui::Separator();
    const bool on = commands.checked(command);
    ImGui::PushID(command.id);
    if (ImGui::MenuItem(commands.label(command).c_str(), key_text(command.key).c_str(), on,
                        commands.enabled(command)))
      commands.run(command);
    ImGui::PopID();
    note_widget(ui.widgets, std::string("menu/") + command.id);
    help_on_hover(commands.about(command).c_str());
    if (command.id == std::string_view("file.open")) recent_menu(session, ui, commands);
  }
}

} // namespace

std::span<const char* const> menu_titles() {
  static constexpr auto titles = [] {
    std::array<const char*, menus.size()> all{};
    for (std::size_t i = 0; i < menus.size(); ++i)
      all[i] = menus[i].title;
    return all;
  }();
  return titles;
}

void menu_bar(const Session& session, Ui& ui, const CommandRunner& commands) {
  if (!ImGui::BeginMenuBar()) return;
  // A menu taller than the window scrolls below its title: over it, the click that opens it would press an
  // entry.
  const float foot = ImGui::GetCursorScreenPos().y + ImGui::GetFrameHeight();
  const float room = ImGui::GetIO().DisplaySize.y - foot - 8 * ui.scale;
  for (const Menu& menu : menus) {
    if (ui.keyboard.open_menu == menu.title) ImGui::OpenPopup(menu.title);
    ImGui::SetNextWindowSizeConstraints({0, 0}, {FLT_MAX, std::max(room, 60 * ui.scale)});
    const bool open = ImGui::BeginMenu(menu.title);
    if (!open) ImGui::GetCurrentContext()->NextWindowData.ClearFlags();       // it was for no other window
    note_widget(ui.widgets, std::string("menu/") + menu.title, KeyUse::none); // Alt and its letter
    if (!open) continue;
    items(session, ui, commands, menu);
    ImGui::EndMenu();
  }
  ImGui::EndMenuBar();
}

} // namespace flyball
