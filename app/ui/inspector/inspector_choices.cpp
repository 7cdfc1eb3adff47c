// Choices of the inspector: one of several words or names, in a list that opens or side by side.
#include "app/ui/inspector/inspector_rows.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/session/parameter_list.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <unordered_set>
#include <utility>

namespace flyball {

namespace {

constexpr std::size_t searchable = 15; // names, from which on a choice is searched rather than looked through

bool contains(const std::string& text, const std::string& part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

// Begins the list of a choice beside the label.
bool begin_choice(Ui& ui, const std::string& name, const std::string& label, const std::string& chosen,
                  const char* help) {
  ImGui::SetNextItemWidth(row_label(ui, label, help));
  ImGui::PushStyleColor(ImGuiCol_Button, colors_of(ui).raised);
  const bool open = ImGui::BeginCombo(("##" + name).c_str(), chosen.c_str(), ImGuiComboFlags_HeightLarge);
  ImGui::PopStyleColor();
  if (!open) {
    note_widget(ui.widgets, name);
    help_on_hover(help);
  }
  return open;
}

// The field above a long list; true where Enter takes what is marked.
bool search_field(Ui& ui, const std::string& name, ChoiceSearch& search) {
  if (ImGui::IsWindowAppearing() || std::exchange(search.wants_keys, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = search.text;
  const bool entered =
      ImGui::InputTextWithHint("##search", "Search", &search.text, ImGuiInputTextFlags_EnterReturnsTrue);
  note_widget(ui.widgets, name + "/search", KeyUse::type);
  if (search.text != before) search.marked = search.text.empty() ? -1 : 0;
  search.wants_keys = entered; // should there be nothing to take
  return entered;
}

// While one types in the field above; returns whether another row is marked.
bool move_by_arrows(ChoiceSearch& search, int rows) {
  const bool down = imgui_compat::key_pressed(ImGuiKey_DownArrow),
             up = imgui_compat::key_pressed(ImGuiKey_UpArrow);
  if (down == up || rows == 0 || !ImGui::GetIO().WantTextInput) return false;
  search.marked = down ? std::min(search.marked + 1, rows - 1) : std::max(search.marked - 1, 0);
  return true;
}

// The rows of a long list, which go on below the field while it stays.
void begin_rows(const Ui& ui, std::span<const std::string> options) {
  constexpr float most_rows = 18;
  float width = ImGui::GetContentRegionAvail().x;
  for (const std::string& option : options)
    width = std::max(width,
                     ImGui::CalcTextSize(option.c_str()).x + ImGui::GetStyle().ScrollbarSize + 8 * ui.scale);
  const float rows = std::min(static_cast<float>(options.size()), most_rows);
  ImGui::BeginChild("rows", {width, rows * ImGui::GetTextLineHeightWithSpacing()});
}

} // namespace

std::optional<std::size_t> choice_row(Ui& ui, const std::string& name, const std::string& label,
                                      std::span<const std::string_view> options, std::size_t chosen,
                                      const char* help, bool various) {
  std::optional<std::size_t> other;
  if (!begin_choice(ui, name, label, various ? "various" : std::string(options[chosen]), help)) return other;
  for (std::size_t i = 0; i < options.size(); ++i) {
    const std::string option(options[i]);
    const bool present = i == chosen && !various;
    if (ImGui::Selectable(option.c_str(), present) && !present) other = i;
    note_widget(ui.widgets, name + "/" + option);
    if (present) mark_chosen(ui.widgets);
  }
  ImGui::EndCombo();
  return other;
}

std::optional<std::size_t> side_by_side_row(Ui& ui, const std::string& name, const std::string& label,
                                            std::span<const SideOption> options,
                                            std::optional<std::size_t> chosen, const char* help) {
  const float gap = 2 * ui.scale, least_padding = 4 * ui.scale;
  const auto count = static_cast<float>(options.size());
  float words = gap * (count - 1);
  for (const SideOption& option : options)
    words += ImGui::CalcTextSize(option.title).x;
  float room = row_label(ui, label, help);
  if (words + 2 * least_padding * count > room) room += margin_width(ui);
  if (words + 2 * least_padding * count > room) { // below the label, from the left
    ImGui::NewLine();
    room = ImGui::GetContentRegionAvail().x;
  }
  const float padding = std::max((room - words) / count, 0.f);
  std::optional<std::size_t> other;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, ImGui::GetStyle().FramePadding.y});
  for (std::size_t i = 0; i < options.size(); ++i) {
    const SideOption& option = options[i];
    const bool on = i == chosen;
    const char* refused = on ? nullptr : option.refused;
    if (i > 0) ImGui::SameLine(0, gap);
    ImGui::BeginDisabled(refused != nullptr);
    if (option_button(ui, name + "/" + option.name, option.title, on, refused ? refused : option.help,
                      ImGui::CalcTextSize(option.title).x + padding, KeyUse::tab) &&
        !on)
      other = i;
    ImGui::EndDisabled();
    if (on) mark_chosen(ui.widgets);
  }
  ImGui::PopStyleVar();
  return other;
}

namespace {

// The list of a choice that is open; ends it.
std::optional<std::string> choose_among(Ui& ui, const std::string& name, std::span<const std::string> options,
                                        const std::string& chosen) {
  std::optional<std::string> other;
  ChoiceSearch& search = ui.fields.choice_search;
  const bool appearing = ImGui::IsWindowAppearing(), searched = options.size() > searchable;
  if (appearing) search = {};
  const bool entered = searched && search_field(ui, name, search);
  std::vector<const std::string*> shown;
  for (const std::string& option : options)
    if (search.text.empty() || contains(option, search.text)) shown.push_back(&option);
  const auto present = std::ranges::find_if(shown, [&](const std::string* each) { return *each == chosen; });
  const bool moved = searched && move_by_arrows(search, static_cast<int>(shown.size()));
  // None where what is chosen is not among them, such as "another number…".
  const int present_row = present == shown.end() ? -1 : static_cast<int>(present - shown.begin());
  const int marked = search.marked >= 0 ? search.marked : present_row;
  if (searched) begin_rows(ui, options);
  if (appearing || moved) { // what is marked, which else may not even be drawn
    const float row = ImGui::GetTextLineHeightWithSpacing();
    ImGui::SetScrollFromPosY(ImGui::GetCursorPosY() - ImGui::GetScrollY() +
                             row * (static_cast<float>(std::max(marked, 0)) + 0.5f));
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(shown.size()));
  std::optional<std::string> taken;
  if (entered && marked < static_cast<int>(shown.size()) && search.marked >= 0)
    taken = *shown[static_cast<std::size_t>(marked)];
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const std::string& option = *shown[static_cast<std::size_t>(i)];
      ImGui::PushID(i);
      if (ImGui::Selectable(option.c_str(), i == marked)) taken = option;
      ImGui::PopID();
      note_widget(ui.widgets, name + "/" + option);
      if (option == chosen) mark_chosen(ui.widgets);
    }
  if (searched) ImGui::EndChild();
  if (taken) {
    ImGui::CloseCurrentPopup();
    if (*taken != chosen) other = taken;
  }
  ImGui::EndCombo();
  return other;
}

} // namespace

std::optional<std::string> name_choice_row(Ui& ui, const std::string& name, const std::string& label,
                                           std::span<const std::string> options, const std::string& chosen,
                                           const char* help) {
  if (!begin_choice(ui, name, label, chosen, help)) return std::nullopt;
  return choose_among(ui, name, options, chosen);
}

std::optional<std::string> number_choice_row(const Mechanism& mechanism, Ui& ui, const std::string& name,
                                             const std::string& label,
                                             const std::function<std::vector<std::string>()>& addresses,
                                             const std::string& chosen, const char* help) {
  if (!begin_choice(ui, name, label, chosen, help)) return std::nullopt;
  const std::vector<std::string> all = addresses();
  std::vector<std::string> phrases;
  phrases.reserve(all.size());
  std::unordered_set<std::string> taken;
  for (const std::string& address : all) {
    // Numbers that would be called the same go by their address.
    std::string phrase = number_phrase(mechanism, address);
    phrases.push_back(taken.insert(phrase).second ? std::move(phrase) : address);
  }
  const auto other = choose_among(ui, name, phrases, chosen);
  if (!other) return std::nullopt;
  return all[static_cast<std::size_t>(std::ranges::find(phrases, *other) - phrases.begin())];
}

} // namespace flyball
