#include "app/ui/widgets/task_bar.hpp"

#include "app/ui/widgets/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// "75 s left", in steps that do not flicker; "" where too little is done to tell.
std::string time_left(double part, double seconds) {
  constexpr double least_part = 0.02, least_time = 2; // s
  if (part < least_part || part >= 1 || seconds < least_time) return "";
  const double left = seconds * (1 - part) / part;
  if (left >= 90) return fmt::format("{:.0f} min left", std::ceil(left / 60));
  return fmt::format("{:.0f} s left", left < 10 ? std::ceil(left) : 5 * std::ceil(left / 5));
}

} // namespace

void bar_with_words(const Ui& ui, float part, float width, const std::string& words) {
  ImGui::ProgressBar(part, {width, 0}, "");
  // Where it stands while the bar grows.
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  ImGui::GetWindowDrawList()->AddText(
      {std::round(from.x + 8 * ui.scale), std::round((from.y + to.y - size.y) / 2)},
      ImGui::GetColorU32(ImGuiCol_Text), words.c_str());
}

void task_bar(Ui& ui, const std::string& name, const Progress& progress, double seconds, float width) {
  const double part = std::clamp(progress.part, 0., 1.);
  const std::string percent = part > 0 ? fmt::format("{:.0f} %", std::floor(100 * part)) : "";
  std::string time = time_left(part, seconds);
  if (time.empty() && seconds >= 1) time = fmt::format("{:.0f} s", std::floor(seconds));
  const std::string phase = progress.phase;
  const std::string numbers = percent + (percent.empty() || time.empty() ? "" : ", ") + time;
  const std::string gap = phase.empty() || numbers.empty() ? "" : percent.empty() ? ", " : " ";
  const float room = width > 0 ? width : ImGui::GetContentRegionAvail().x;
  // As much of it as there is room for; the rest is told by hovering.
  const std::string whole = phase + gap + numbers;
  std::string words;
  for (const std::string& each : {whole, numbers, percent})
    if (words.empty() && ImGui::CalcTextSize(each.c_str()).x <= room - 14 * ui.scale) words = each;
  bar_with_words(ui, static_cast<float>(part), room, words);
  note_widget(ui.widgets, name);
  if (words != whole) help_on_hover(whole.c_str());
}

} // namespace flyball
