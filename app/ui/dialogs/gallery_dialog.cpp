#include "app/ui/dialogs/gallery_dialog.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/session/session.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/scene_pictures.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr float card_pad = 8, card_gap = 12; // points
constexpr float around_cards = 186;          // points that the window has beside them, up and down
constexpr int about_lines = 3;               // below a name
constexpr float about_size = 0.88f;          // of the text's

// An initial, as in "E. J. Haug", ends none.
std::string first_sentence(const std::string& text) {
  std::size_t end = text.find(". ");
  while (end != std::string::npos && (end == 1 || (end > 1 && text[end - 2] == ' ')))
    end = text.find(". ", end + 1);
  return text.substr(0, std::min(end, text.size()) + 1);
}

std::vector<SceneCard> read_cards(const fs::path& folder) {
  std::vector<SceneCard> cards;
  for (Example& example : read_examples(folder)) {
    std::string about = first_sentence(example.mechanism.description);
    cards.push_back({std::move(example), std::move(about)});
  }
  return cards;
}

// A line of cards, all of one group where nothing is typed.
struct CardRow {
  std::vector<int> cards;
  bool begins_group = false;
};

// Those that are found by what is typed, by their titles first.
std::vector<int> found_cards(const std::vector<SceneCard>& cards, const std::string& typed) {
  std::vector<std::pair<int, int>> found; // with their ranks
  for (int i = 0; i < static_cast<int>(cards.size()); ++i)
    if (const auto rank = found_rank(cards[static_cast<std::size_t>(i)], typed)) found.emplace_back(*rank, i);
  std::ranges::sort(found);
  std::vector<int> out;
  for (const auto& [rank, i] : found)
    out.push_back(i);
  return out;
}

// In groups as long as nothing is typed.
std::vector<CardRow> card_rows(const std::vector<SceneCard>& cards, const std::string& typed, int columns) {
  std::vector<CardRow> rows;
  const std::string* group = nullptr;
  for (const int i : found_cards(cards, typed)) {
    const SceneCard& card = cards[static_cast<std::size_t>(i)];
    const bool begins = typed.empty() && (!group || *group != card.group);
    if (rows.empty() || begins || static_cast<int>(rows.back().cards.size()) == columns)
      rows.push_back({{}, begins});
    rows.back().cards.push_back(i);
    group = &card.group;
  }
  return rows;
}

float about_height(const Ui& ui) {
  return about_lines * std::round(about_size * ui.fonts.text->FontSize);
}

float card_height(const Ui& ui) {
  return (scene_picture_height + 2 * card_pad) * ui.scale + ImGui::GetTextLineHeight() + about_height(ui);
}

// As many words as there is room for.
std::string fitting(const Ui& ui, const std::string& text, float size, float width) {
  const ImFont* font = ui.fonts.text;
  const auto fits = [&](const std::string& part) {
    return font->CalcTextSizeA(size, FLT_MAX, width, part.c_str()).y <= about_height(ui) + 1;
  };
  std::string part = text;
  while (!fits(part)) {
    const std::size_t space = part.find_last_of(' ');
    if (space == std::string::npos) break;
    part = part.substr(0, space) + "…";
  }
  return part;
}

// Returns whether it was clicked.
bool show_card(Ui& ui, const SceneCard& card, int i, int& chosen_card, float width) {
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const ImVec2 to(from.x + width, from.y + card_height(ui));
  const std::string name = "gallery/" + card.file.filename().string();
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {width, to.y - from.y});
  note_widget(ui.widgets, name, KeyUse::none); // has its own arrows and Enter, see below
  const bool hovered = ImGui::IsItemHovered();
  if (hovered && (ImGui::GetIO().MouseDelta.x != 0 || ImGui::GetIO().MouseDelta.y != 0)) chosen_card = i;
  const bool chosen = i == chosen_card;

  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float bottom = from.y + scene_picture_height * s * width / (scene_picture_width * s);
  list.AddRectFilled(from, to, packed(chosen ? colors.raised : colors.panel), 6 * s);
  if (card.picture)
    list.AddImageRounded(imgui_compat::texture_id(card.picture), from, {to.x, bottom}, {0, 1}, {1, 0},
                         IM_COL32_WHITE, 6 * s, ImDrawFlags_RoundCornersTop);
  list.AddRect(from, to, packed(chosen ? colors.accent : colors.border), 6 * s, 0,
               std::max(1.f, std::round((chosen ? 2.f : 1.f) * s)));
  const ImVec2 text(from.x + card_pad * s, bottom + 5 * s);
  const float room = width - 2 * card_pad * s;
  ImFont* font = ui.fonts.text;
  const float size = std::round(about_size * font->FontSize);
  list.PushClipRect(from, {to.x - card_pad * s, to.y}, true);
  list.AddText(ui.fonts.strong, ui.fonts.strong->FontSize, text, packed(colors.text),
               card.mechanism.name.c_str());
  const ImVec2 about(text.x, text.y + ImGui::GetTextLineHeight() + 2 * s);
  const std::string shown = fitting(ui, card.about, size, room);
  list.AddText(font, size, about, packed(colors.dim), shown.c_str(), nullptr, room);
  list.PopClipRect();
  if (hovered && shown != card.about) help_on_hover(card.about.c_str());
  return clicked;
}

// The arrow keys move from card to card, up and down within the column as far as there is one; returns
// whether they did. What is chosen is in a row, if there is any.
bool move_by_keys(const std::vector<CardRow>& rows, int& chosen) {
  const auto pressed = [](ImGuiKey key) { return imgui_compat::key_pressed(key); };
  const int along = pressed(ImGuiKey_RightArrow) - pressed(ImGuiKey_LeftArrow);
  const int down = pressed(ImGuiKey_DownArrow) - pressed(ImGuiKey_UpArrow);
  std::vector<int> all;
  for (const CardRow& row : rows)
    all.insert(all.end(), row.cards.begin(), row.cards.end());
  const int before = chosen;
  if (const auto next = std::ranges::find(all, chosen) - all.begin() + along; along != 0)
    if (next >= 0 && next < std::ssize(all)) chosen = all[static_cast<std::size_t>(next)];
  for (std::size_t i = 0; down != 0 && i < rows.size(); ++i) {
    const auto at = std::ranges::find(rows[i].cards, before) - rows[i].cards.begin();
    const auto next = static_cast<std::ptrdiff_t>(i) + down;
    if (at == std::ssize(rows[i].cards) || next < 0 || next >= std::ssize(rows)) continue;
    const std::vector<int>& cards = rows[static_cast<std::size_t>(next)].cards;
    chosen = cards[static_cast<std::size_t>(std::min(at, std::ssize(cards) - 1))];
  }
  return chosen != before;
}

// Has the keys as long as nothing else takes them; returns whether Enter was pressed there.
bool search_field(Ui& ui, std::string& search) {
  if (!ImGui::IsAnyItemActive() && !enter_is_taken(ui)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool entered =
      ImGui::InputTextWithHint("##search", "Find by title, description or part: Porter, friction, belt",
                               &search, ImGuiInputTextFlags_EnterReturnsTrue);
  note_widget(ui.widgets, "gallery/search", KeyUse::type);
  return entered;
}

void group_title(const Ui& ui, const std::string& title) {
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextUnformatted(title.c_str());
  ImGui::PopFont();
}

// With the distance between cards as that of all items.
float full_height(const Ui& ui, const std::vector<CardRow>& rows) {
  float height = 0;
  for (const CardRow& row : rows)
    height += (row.begins_group ? ImGui::GetTextLineHeightWithSpacing() : 0) + card_height(ui) +
              ImGui::GetStyle().ItemSpacing.y;
  return height;
}

} // namespace

void GalleryDialog::open(const Session& session, DialogState& dialog) {
  cards_ = read_cards(session.options.scenes);
  search_.clear();
  chosen_ = -1; // the first then, which comes into sight
  dialog.wanted = Dialog::gallery;
}

GalleryDialog::Answer GalleryDialog::draw(Ui& ui, DialogState& dialog) {
  Answer answer;
  const float s = ui.scale;
  showing_ = false;
  if (!begin_dialog(ui, dialog, Dialog::gallery, "Examples", 3 * scene_picture_width + 2 * card_gap + 47))
    return answer;
  showing_ = true;
  const std::string searched = search_;
  const bool entered = search_field(ui, search_);
  const float between = card_gap * s;
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
  const int columns =
      std::max(1, static_cast<int>((room + between) / (scene_picture_width * s * 0.8f + between)));
  const float width =
      std::min((room + between) / static_cast<float>(columns) - between, scene_picture_width * s);
  const std::vector<CardRow> rows = card_rows(cards_, search_, columns);
  // What is typed chooses anew: what answers it best is opened by Enter.
  const bool found = search_ == searched && std::ranges::any_of(rows, [&](const CardRow& row) {
                       return std::ranges::count(row.cards, chosen_) > 0;
                     });
  if (!found && !rows.empty()) chosen_ = rows[0].cards[0];
  const bool moved = move_by_keys(rows, chosen_) || !found;
  fs::path opened;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {between, between});
  // As high as all of them, so that the dialog keeps its size while one types.
  ImGui::BeginChild("cards", {0, std::clamp(full_height(ui, card_rows(cards_, {}, columns)), 60 * s,
                                            ImGui::GetIO().DisplaySize.y - around_cards * s)});
  if (cards_.empty())
    paragraph("There are no examples beside this program.", colors_of(ui).dim);
  else if (rows.empty())
    paragraph("No example has these words in its title or description, or such parts.", colors_of(ui).dim);
  for (const CardRow& row : rows) {
    const SceneCard& first = cards_[static_cast<std::size_t>(row.cards[0])];
    const float top = ImGui::GetCursorPosY();
    if (row.begins_group && !first.group.empty()) group_title(ui, first.group);
    for (const int i : row.cards) {
      if (i != row.cards[0]) ImGui::SameLine();
      const SceneCard& card = cards_[static_cast<std::size_t>(i)];
      if (show_card(ui, card, i, chosen_, width)) opened = card.file;
      if (!moved || i != chosen_) continue;
      // With the title of its group, if it is of the first row.
      const float seen = ImGui::GetScrollY(), bottom = ImGui::GetCursorPosY() - between;
      if (top < seen) ImGui::SetScrollY(top);
      if (bottom > seen + ImGui::GetWindowHeight()) ImGui::SetScrollY(bottom - ImGui::GetWindowHeight());
    }
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  if ((entered || enter_pressed(ui)) && !rows.empty())
    opened = cards_[static_cast<std::size_t>(chosen_)].file;
  if (text_button(ui, "gallery/cancel", "Cancel") || escape_pressed() || !opened.empty()) close_dialog();
  ImGui::SameLine();
  if (text_button(ui, "gallery/open", "Open a file…")) {
    close_dialog();
    answer.other = true;
  }
  answer.file = opened;
  end_dialog();
  return answer;
}

} // namespace flyball
