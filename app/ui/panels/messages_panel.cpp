// What was told before, the latest first; Enter or a click copies a line.
#include "app/ui/layout.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/notice.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <array>
#include <cmath>
#include <ctime>

namespace flyball {

namespace {

std::string clock_text(std::chrono::system_clock::time_point when) {
  const std::time_t time = std::chrono::system_clock::to_time_t(when);
  std::array<char, 16> text{};
  std::tm parts{};
  if (!::localtime_r(&time, &parts) || std::strftime(text.data(), text.size(), "%H:%M:%S", &parts) == 0)
    return "";
  return text.data();
}

void message_row(Ui& ui, NoticeLog& log, std::size_t i, float wrap) {
  const UiColors& colors = colors_of(ui);
  const PastNotice& notice = log.past[i];
  const float s = ui.scale, indent = ImGui::CalcTextSize("00:00:00").x + 10 * s;
  const std::string text = (notice.error ? "Error: " : "") + notice.text;
  const float height = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap - indent).y + 6 * s;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::PushID(static_cast<int>(i));
  if (ImGui::Selectable("##message", false, 0, {0, height})) ImGui::SetClipboardText(notice.text.c_str());
  ImGui::PopID();
  note_widget(ui.widgets, "messages/" + std::to_string(log.past.size() - i), KeyUse::row);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText({from.x, from.y + 3 * s}, packed(colors.dim), clock_text(notice.when).c_str());
  list.AddText(ui.fonts.text, ImGui::GetFontSize(), {from.x + indent, from.y + 3 * s},
               packed(notice.error ? colors.bad : colors.text), text.c_str(), nullptr, wrap - indent);
}

} // namespace

void messages_panel(Ui& ui, NoticeLog& log, const PanelRect& view) {
  if (!log.showing) return;
  const float s = ui.scale;
  const ImVec2 size(std::min(460 * s, view.width - 20 * s), std::min(300 * s, view.height - 20 * s));
  ImGui::SetNextWindowPos({view.x + view.width / 2, view.y + 10 * s}, ImGuiCond_FirstUseEver, {0.5f, 0});
  ImGui::SetNextWindowSize(size, ImGuiCond_FirstUseEver);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(s)));
  if (ImGui::Begin("Messages", &log.showing,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
    const float wrap = ImGui::GetContentRegionAvail().x;
    if (log.past.empty()) paragraph("Nothing has been told yet.", colors_of(ui).dim);
    for (std::size_t i = log.past.size(); i-- > 0;)
      message_row(ui, log, i, wrap);
    note_widget(ui.widgets, "messages", KeyUse::none);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

} // namespace flyball
