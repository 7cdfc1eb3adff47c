#include "app/ui/widgets/task_bar.hpp"

#include "app/ui/widgets/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flyball {

void task_bar(Ui& ui, const std::string& name, const Progress& progress, double seconds, float width) {
  const float part = std::clamp(static_cast<float>(progress.part), 0.f, 1.f);
  std::string words = progress.phase;
  if (part > 0) words += fmt::format("{}{:.0f} %", words.empty() ? "" : " ", std::floor(100 * part));
  if (seconds >= 1) words += fmt::format("{}{:.0f} s", words.empty() ? "" : ", ", std::floor(seconds));
  const float room = width > 0 ? width : ImGui::GetContentRegionAvail().x;
  if (ImGui::CalcTextSize(words.c_str()).x > room - 8 * ui.scale) words.clear(); // told by hovering
  ImGui::ProgressBar(part, {room, 0}, words.c_str());
  note_widget(ui.widgets, name);
  if (words.empty()) help_on_hover(progress.phase);
}

} // namespace flyball
