#include "app/ui/widgets/mistake_list.hpp"

#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cstdlib>

namespace flyball {

namespace {

PartKind kind_of(const std::string& path) {
  if (path.starts_with("bodies")) return PartKind::body;
  if (path.starts_with("joints")) return PartKind::joint;
  return path.starts_with("forces") ? PartKind::force : PartKind::none;
}

// "joints.spin.axis" has the name "spin" and the rest "axis"; "bodies[2].name" has no name.
std::pair<std::string, std::string> name_and_rest(const std::string& path) {
  const std::size_t from = path.find('.');
  if (kind_of(path) == PartKind::none || from == std::string::npos || path.find('[') < from)
    return {"", path};
  const std::size_t to = path.find('.', from + 1);
  return {path.substr(from + 1, to == std::string::npos ? to : to - from - 1),
          to == std::string::npos ? "" : path.substr(to + 1)};
}

} // namespace

Part part_of(const Mechanism& mechanism, const SceneError& mistake) {
  const std::string& path = mistake.where();
  const PartKind kind = kind_of(path);
  if (std::string name = name_and_rest(path).first; !name.empty()) return {kind, std::move(name)};
  if (const std::size_t index = path.find('['); kind != PartKind::none && index != std::string::npos)
    return part_of(mechanism, PartId{kind, std::atoi(path.c_str() + index + 1)});
  return {};
}

std::string words_for(const SceneError& mistake) {
  const auto [name, rest] = name_and_rest(mistake.where());
  if (!name.empty() && mistake.expected().starts_with(name + " ")) return mistake.expected();
  std::string words = name;
  if (!rest.empty()) words += (words.empty() ? "" : ", ") + rest;
  return words.empty() ? mistake.expected() : words + ": " + mistake.expected();
}

std::string advice_for(const SceneError& mistake) {
  const std::string& expected = mistake.expected();
  if (expected.ends_with(" is not connected"))
    return "Join it to another body or to the ground, by a joint or a spring.";
  return expected.find(" is not connected to the ground, nor ") != std::string::npos
             ? "Join one of them to the ground, or to a body that is, by a joint or a spring."
             : "";
}

namespace {

void part_row(Session& session, Ui& ui, const std::string& widget, const SceneError& about,
              const ImVec4& color) {
  const Part part = part_of(session.mechanism(), about);
  const std::string words = words_for(about);
  const float width = std::max(ImGui::GetContentRegionAvail().x, 1.f);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float height = ImGui::CalcTextSize(words.c_str(), nullptr, false, width).y + 4 * ui.scale;
  if (ImGui::InvisibleButton(widget.c_str(), {width, height}) && part.kind != PartKind::none)
    later(ui, [&session, part] { select(session, {{part}}); });
  note_widget(ui.widgets, widget, KeyUse::row);
  const bool lit = ImGui::IsItemHovered() && part.kind != PartKind::none;
  if (lit) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {from.x, from.y + 2 * ui.scale},
                                      packed(lit ? colors_of(ui).accent : color), words.c_str(), nullptr,
                                      width);
}

} // namespace

void mistake_row(Session& session, Ui& ui, const std::string& name, std::size_t index, const ImVec4& color) {
  part_row(session, ui, name + "/" + std::to_string(index), session.mistakes[index], color);
}

void warning_rows(Session& session, Ui& ui, const std::string& name, std::size_t most) {
  for (std::size_t i = 0; i < std::min(session.warnings.size(), most); ++i)
    part_row(session, ui, name + "/" + std::to_string(i), session.warnings[i], colors_of(ui).warn);
  if (session.warnings.size() > most)
    paragraph("and " + std::to_string(session.warnings.size() - most) + " more like it", colors_of(ui).dim);
}

void mistake_rows(Session& session, Ui& ui, const std::string& name, std::size_t first, std::size_t most) {
  const std::size_t end = std::min(session.mistakes.size(), first + most);
  for (std::size_t i = first; i < end; ++i) {
    mistake_row(session, ui, name, i, colors_of(ui).text);
    if (const std::string advice = advice_for(session.mistakes[i]); !advice.empty())
      help_on_hover(advice.c_str());
  }
  if (end < session.mistakes.size())
    paragraph("and " + std::to_string(session.mistakes.size() - end) + " more", colors_of(ui).dim);
}

} // namespace flyball
