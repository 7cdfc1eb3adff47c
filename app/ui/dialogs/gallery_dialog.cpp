#include "app/ui/dialogs/gallery_dialog.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/session/session.hpp"
#include "app/ui/scene_pictures.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr float card_pad = 8, card_gap = 12; // points
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
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().extension() != ".json") continue;
    try {
      Mechanism mechanism = load_scene(it->path());
      std::string about = first_sentence(mechanism.description);
      cards.push_back({it->path(), std::move(mechanism), std::move(about)});
    } catch (const SceneError&) { // an example that cannot be opened is none
    }
  }
  std::ranges::sort(cards, {}, [](const SceneCard& card) {
    return std::pair(card.mechanism.bodies.size() + card.mechanism.joints.size(), card.mechanism.name);
  });
  return cards;
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

// The arrow keys move from card to card; returns whether they did.
bool move_by_keys(int count, int columns, int& chosen) {
  const auto pressed = [](ImGuiKey key) { return imgui_compat::key_pressed(key); };
  const int step = pressed(ImGuiKey_RightArrow) - pressed(ImGuiKey_LeftArrow) +
                   columns * (pressed(ImGuiKey_DownArrow) - pressed(ImGuiKey_UpArrow));
  const int wanted = chosen + step;
  if (step == 0 || wanted < 0 || wanted >= count) return false;
  chosen = wanted;
  return true;
}

} // namespace

void GalleryDialog::open(const Session& session, DialogState& dialog) {
  cards_ = read_cards(session.options.scenes);
  chosen_ = 0;
  dialog.wanted = Dialog::gallery;
}

GalleryDialog::Answer GalleryDialog::draw(Ui& ui, DialogState& dialog) {
  Answer answer;
  const float s = ui.scale;
  showing_ = false;
  if (!begin_dialog(ui, dialog, Dialog::gallery, "Examples", 3 * scene_picture_width + 2 * card_gap + 47))
    return answer;
  showing_ = true;
  const int count = static_cast<int>(cards_.size());
  const float between = card_gap * s;
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
  const int columns =
      std::max(1, static_cast<int>((room + between) / (scene_picture_width * s * 0.8f + between)));
  const float width =
      std::min((room + between) / static_cast<float>(columns) - between, scene_picture_width * s);
  const float rows = std::ceil(static_cast<float>(count) / static_cast<float>(columns));
  const float height =
      std::min(rows * (card_height(ui) + between) - between, ImGui::GetIO().DisplaySize.y - 150 * s);
  const bool moved = move_by_keys(count, columns, chosen_);
  fs::path opened;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {between, between});
  ImGui::BeginChild("cards", {0, std::max(height, 60 * s)});
  if (count == 0) paragraph("There are no examples beside this program.", colors_of(ui).dim);
  for (int i = 0; i < count; ++i) {
    if (i % columns != 0) ImGui::SameLine();
    if (show_card(ui, cards_[static_cast<std::size_t>(i)], i, chosen_, width))
      opened = cards_[static_cast<std::size_t>(i)].file;
    if (moved && i == chosen_) ImGui::SetScrollHereY();
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  if (count > 0 && enter_pressed(ui)) opened = cards_[static_cast<std::size_t>(chosen_)].file;
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
