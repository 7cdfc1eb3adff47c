#include "app/ui/dialogs/recovery_dialog.hpp"

#include "app/session/session.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <array>
#include <ctime>

namespace flyball {

namespace {

constexpr std::array answers{Choice{"recover/recover", "Recover"}, Choice{"recover/discard", "Discard"},
                             Choice{"recover/later", "Not now"}};

// "today, 14:03" or "3 November, 14:03".
std::string time_text(std::int64_t seconds) {
  const auto when = static_cast<std::time_t>(seconds), now = std::time(nullptr);
  std::tm then{}, today{};
  ::localtime_r(&when, &then);
  ::localtime_r(&now, &today);
  const bool same_day = then.tm_year == today.tm_year && then.tm_yday == today.tm_yday;
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), same_day ? "today, %H:%M" : "%e %B, %H:%M", &then);
  return text.data();
}

std::string title(const Leftover& leftover) {
  const std::filesystem::path& file = leftover.autosave.file;
  return file.empty() ? leftover.autosave.name + " (no file yet)" : file.filename().string();
}

void leftover_row(Session& session, Ui& ui, int i, int& chosen) {
  const Leftover& leftover = session.files.leftovers[static_cast<std::size_t>(i)];
  const UiColors& colors = colors_of(ui);
  ImGui::PushID(i);
  const float left = ImGui::GetCursorPosX();
  if (ImGui::Selectable("##leftover", chosen == i, ImGuiSelectableFlags_DontClosePopups,
                        {0, ImGui::GetTextLineHeight()}))
    chosen = i;
  note_widget(ui.widgets, "recover/" + std::to_string(i), KeyUse::row);
  if (chosen == i) mark_chosen(ui.widgets);
  help_on_hover(leftover.autosave.file.c_str());
  ImGui::SameLine(left + 4 * ui.scale);
  clipped_text(title(leftover), 260 * ui.scale);
  ImGui::SameLine(290 * ui.scale);
  ImGui::TextColored(colors.dim, "%s", time_text(leftover.autosave.made).c_str());
  ImGui::PopID();
}

} // namespace

std::optional<Leftover> RecoveryDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  std::optional<Leftover> wanted;
  if (!begin_dialog(ui, dialog, Dialog::recover, "Unsaved work was found", 500)) return wanted;
  FileState& files = session.files;
  const UiColors& colors = colors_of(ui);
  const int count = static_cast<int>(files.leftovers.size());
  if (ImGui::IsWindowAppearing()) chosen_ = 0;
  paragraph("The program ended before this was saved:", colors.dim);
  ImGui::PushStyleColor(ImGuiCol_Header, colors.raised);
  for (int i = 0; i < count; ++i)
    leftover_row(session, ui, i, chosen_);
  ImGui::PopStyleColor();
  const auto chosen = static_cast<std::size_t>(chosen_);
  if (chosen < files.leftovers.size() && files.leftovers[chosen].outdated)
    paragraph("Its file has changed since. Recovering does not touch the file, and Undo goes back to what it "
              "says.",
              colors.warn);
  const int answer = choice_buttons(ui, answers, answer_);
  const bool escaped = escape_pressed();
  if (chosen < files.leftovers.size() && (answer == 0 || answer == 1)) {
    const Leftover leftover = files.leftovers[chosen];
    if (answer == 0) {
      files.leftovers.clear();
      wanted = leftover;
    } else {
      discard(session, leftover);
      chosen_ = 0;
    }
  }
  if (answer == 2 || escaped || files.leftovers.empty()) close_dialog();
  end_dialog();
  return wanted;
}

} // namespace flyball
