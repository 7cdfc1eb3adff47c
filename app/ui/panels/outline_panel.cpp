#include "app/ui/panels/outline_panel.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/render/icons.hpp"
#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panels/context_menu.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/mistake_list.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/body_form.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>

namespace flyball {

namespace {

constexpr std::size_t most_mistakes = 4;

struct SectionWords {
  PartKind kind;
  const char *list, *title;
};
constexpr std::array outline_sections{SectionWords{PartKind::body, "bodies", "Bodies"},
                                      SectionWords{PartKind::joint, "joints", "Joints"},
                                      SectionWords{PartKind::force, "forces", "Forces"}};

std::string widget_of(const Part& part) {
  const auto* words = std::ranges::find(outline_sections, part.kind, &SectionWords::kind);
  return words == outline_sections.end() ? "" : std::string("outline/") + words->list + "/" + part.name;
}

bool matches(std::string_view name, std::string_view search) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(name.begin(), name.end(), search.begin(), search.end(), same) != name.end();
}

struct PartOrder {
  bool operator()(const Part& a, const Part& b) const {
    return a.kind != b.kind ? a.kind < b.kind : a.name < b.name;
  }
};

// What all rows of a frame share.
struct Outline {
  Session& session;
  Ui& ui;
  ViewState& view;
  OutlineState& state;
  const CommandRunner& commands;
  std::array<bool, 3> open{}; // sections
  std::map<Part, std::size_t, PartOrder> mistakes;
  float height = 0;

  const Mechanism& mechanism() const { return session.mechanism(); }
  const OutlineRows& kept() const { return state.rows; }
};

std::size_t count_of(const Mechanism& mechanism, PartKind kind) {
  if (kind == PartKind::body) return mechanism.bodies.size();
  return kind == PartKind::joint ? mechanism.joints.size() : mechanism.forces.size();
}

const std::string& name_of(const Mechanism& mechanism, PartId id) {
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::body) return mechanism.bodies[i].name;
  return id.kind == PartKind::joint ? mechanism.joints[i].name : mechanism.forces[i].name;
}

// "revolute", "1 kg"
std::string kind_words(const Mechanism& mechanism, PartId id) {
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::joint) {
    const Joint& joint = mechanism.joints[i];
    return std::string(joint.type == JointType::gear ? type_name(joint.kind) : type_name(joint.type));
  }
  if (id.kind == PartKind::body) return short_text(mechanism.bodies[i].mass, 4) + " kg";
  return force_noun(mechanism.forces[i]);
}

// In order, those of closed sections left out.
std::vector<PartId> open_rows(const Outline& outline) {
  std::vector<PartId> rows;
  for (std::size_t i = 0; i < outline_sections.size(); ++i)
    if (const std::vector<PartId>& listed = outline.kept().listed[i]; outline.open[i])
      rows.insert(rows.end(), listed.begin(), listed.end());
  return rows;
}

void keep_rows(const Session& session, const Ui& ui, OutlineState& state) {
  OutlineRows& kept = state.rows;
  const std::string& search = state.search;
  if (kept.revision == session.document.revision() && kept.theme == ui.theme && kept.search == search) return;
  kept.revision = session.document.revision();
  kept.theme = ui.theme;
  kept.search = search;
  kept.colours = body_colors(session.document.hues(), ui.theme);
  for (std::size_t i = 0; i < outline_sections.size(); ++i) {
    kept.listed[i].clear();
    const int count = static_cast<int>(count_of(session.mechanism(), outline_sections[i].kind));
    for (int k = 0; k < count; ++k)
      if (const PartId id{outline_sections[i].kind, k};
          search.empty() || matches(name_of(session.mechanism(), id), search))
        kept.listed[i].push_back(id);
  }
}

void choose(Outline& outline, const Part& part) {
  const ImGuiIO& io = ImGui::GetIO();
  Selection selection = outline.session.selection();
  OutlineState& state = outline.state;
  if (io.KeyShift && state.anchor.kind != PartKind::none) {
    const PartId anchor = find_part(outline.mechanism(), state.anchor);
    const std::vector<PartId> rows = open_rows(outline);
    const auto row = [&](PartId id) { return std::ranges::find(rows, id); };
    auto from = row(anchor), to = row(find_part(outline.mechanism(), part));
    if (from != rows.end() && to != rows.end()) {
      if (to < from) std::swap(from, to);
      if (!io.KeyCtrl) selection = {};
      // By hand, as asking for each whether it is there would take too long for thousands.
      for (; from <= to; ++from) {
        Part chosen{from->kind, name_of(outline.mechanism(), *from)};
        if (!io.KeyCtrl)
          selection.parts.push_back(std::move(chosen));
        else
          selection.add(std::move(chosen));
      }
    }
  } else {
    if (io.KeyCtrl)
      selection.toggle(part);
    else
      selection.set(part);
    state.anchor = part;
  }
  state.revealed = part; // it is under the hand
  later(outline.ui, [&session = outline.session, selection] { select(session, selection); });
}

// The same as in the view.
void row_menu(const Outline& outline, const Part& part) {
  Session& session = outline.session;
  const float s = outline.ui.scale;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * s, 8 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 6 * s}); // that of the rows is none
  if (ImGui::BeginPopupContextItem()) {
    if (ImGui::IsWindowAppearing() && !session.selection().has(part))
      later(outline.ui, [&session, part] { select(session, {{part}}); });
    if (session.selection().has(part)) part_items(session, outline.ui, outline.view, outline.commands);
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar(2);
}

// The body's colour, or what kind of part it is.
void draw_sign(const Outline& outline, PartId id, ImVec2 at) {
  const UiColors& colors = colors_of(outline.ui);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = 5 * outline.ui.scale;
  const ImVec2 middle(at.x + r, at.y);
  const auto i = static_cast<std::size_t>(id.index);
  if (id.kind == PartKind::body) {
    Color color = outline.kept().colours[i];
    const Body& body = outline.mechanism().bodies[i];
    if (!body.shapes.empty() && body.shapes.front().color) {
      const auto& own = *body.shapes.front().color;
      color = {static_cast<float>(own[0]), static_cast<float>(own[1]), static_cast<float>(own[2])};
    }
    list.AddCircleFilled(middle, r, packed(to_imgui(color)));
  } else if (id.kind == PartKind::joint) {
    const Joint& joint = outline.mechanism().joints[i];
    const bool driven =
        std::ranges::any_of(joint.coordinates, [](const Coordinate& c) { return c.drive.has_value(); });
    list.AddCircle(middle, r - outline.ui.scale, packed(driven ? colors.accent : colors.dim), 0,
                   2 * outline.ui.scale);
    if (driven) list.AddCircleFilled(middle, 2 * outline.ui.scale, packed(colors.accent));
  } else {
    const float h = 4 * outline.ui.scale;
    list.AddLine({middle.x - r, middle.y + h}, {middle.x + r, middle.y - h}, packed(colors.dim),
                 2 * outline.ui.scale);
    list.AddTriangleFilled({middle.x + r, middle.y - h}, {middle.x + r - 5 * outline.ui.scale, middle.y - h},
                           {middle.x + r, middle.y - h + 5 * outline.ui.scale}, packed(colors.dim));
  }
}

void draw_row(const Outline& outline, PartId id, const Part& part, ImVec2 from, float width, bool hovered) {
  const UiColors& colors = colors_of(outline.ui);
  const float s = outline.ui.scale, height = outline.height;
  const ImVec2 to(from.x + width, from.y + height);
  const bool selected = outline.session.selection().has(part), pointed = outline.view.hovered == id;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImVec4 back = colors.accent;
  back.w = selected ? 0.22f : 0;
  if (selected) list.AddRectFilled(from, to, packed(back), ImGui::GetStyle().FrameRounding);
  if (hovered || pointed)
    list.AddRectFilled(from, to, packed(selected ? back : colors.raised), ImGui::GetStyle().FrameRounding);
  draw_sign(outline, id, {from.x + 10 * s, from.y + height / 2});

  float right = to.x - 6 * s;
  const float y = from.y + (height - ImGui::GetTextLineHeight()) / 2;
  if (const auto mistake = outline.mistakes.find(part); mistake != outline.mistakes.end()) {
    right -= ImGui::CalcTextSize(icon::warning).x;
    list.AddText({right, y}, packed(colors.warn), icon::warning);
    if (hovered) ImGui::SetTooltip("%s", words_for(outline.session.mistakes[mistake->second]).c_str());
    right -= 6 * s;
  }
  if (std::ranges::find(outline.view.hidden, part) != outline.view.hidden.end()) {
    right -= ImGui::CalcTextSize(icon::eye_off).x;
    list.AddText({right, y}, packed(colors.dim), icon::eye_off);
    if (hovered) ImGui::SetTooltip("Hidden in the view. Ctrl+Shift+H shows all.");
    right -= 6 * s;
  }
  const std::string words = kind_words(outline.mechanism(), id);
  const float name_width = ImGui::CalcTextSize(part.name.c_str()).x, left = from.x + 28 * s;
  const float words_width = ImGui::CalcTextSize(words.c_str()).x;
  // Where there is no room for both, the name goes first.
  if (left + name_width + 10 * s + words_width < right) {
    right -= words_width;
    list.AddText({right, y}, packed(colors.dim), words.c_str());
    right -= 10 * s;
  }
  ImGui::SetCursorScreenPos({left, y});
  clipped_text(part.name, right - left);
}

void part_row(Outline& outline, PartId id) {
  const Part part{id.kind, name_of(outline.mechanism(), id)};
  const std::string widget = widget_of(part), field = widget + "/name";
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 1.f);
  if (typing_in(outline.ui, field)) {
    draw_sign(outline, id, {from.x + 10 * outline.ui.scale, from.y + outline.height / 2});
    ImGui::SetCursorScreenPos({from.x + 22 * outline.ui.scale, from.y});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        {6 * outline.ui.scale, (outline.height - ImGui::GetFontSize()) / 2});
    name_field(outline.session, outline.ui, field, part, width - 22 * outline.ui.scale);
    ImGui::PopStyleVar();
    ImGui::SetCursorScreenPos({from.x, from.y + outline.height});
    return;
  }
  ImGui::PushID(id.index);
  if (ImGui::InvisibleButton("row", {width, outline.height})) choose(outline, part);
  note_widget(outline.ui.widgets, widget, KeyUse::row);
  if (outline.session.selection().has(part)) mark_chosen(outline.ui.widgets);
  const bool hovered = ImGui::IsItemHovered();
  if (hovered) outline.view.hovered = id;
  if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !ImGui::GetIO().KeyCtrl)
    later(outline.ui, [&session = outline.session, &ui = outline.ui, field, name = part.name] {
      start_typing(session, ui, field, name);
    });
  if (takes_menu_key(outline.ui, widget)) ImGui::OpenPopup(ImGui::GetItemID());
  row_menu(outline, part);
  ImGui::PopID();
  draw_row(outline, id, part, from, width, hovered);
  ImGui::SetCursorScreenPos({from.x, from.y + outline.height});
}

void part_section(Outline& outline, std::size_t section) {
  const SectionWords& words = outline_sections[section];
  const std::size_t count = count_of(outline.mechanism(), words.kind);
  if (count == 0) return;
  const std::vector<PartId>& shown = outline.kept().listed[section];
  const std::string title = std::string(words.title) + "   " + std::to_string(count);
  const Part& last = outline.session.selection().empty() ? Part{} : outline.session.selection().parts.back();
  const bool reveal = last.kind == words.kind && last != outline.state.revealed;
  if (reveal) outline.ui.sections.open[std::string("outline/") + words.list] = true;
  if (!inspector_section(outline.session, outline.ui, std::string("outline/") + words.list, title.c_str(),
                         true))
    return;
  outline.open[section] = true;
  if (reveal) {
    const auto row = std::ranges::find(shown, find_part(outline.mechanism(), last));
    const float y = ImGui::GetCursorPosY() + static_cast<float>(row - shown.begin()) * outline.height;
    const float top = ImGui::GetScrollY(), room = ImGui::GetWindowHeight();
    if (row != shown.end() && (y < top || y + 2 * outline.height > top + room))
      ImGui::SetScrollY(std::max(y - room / 2, 0.f));
    outline.state.revealed = last;
  }
  ImGui::PushID(words.list);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(shown.size()), outline.height);
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      part_row(outline, shown[static_cast<std::size_t>(i)]);
  ImGui::PopID();
}

// There whatever there is to search, so that no row moves when a part is added.
void search_field(Ui& ui, OutlineState& state) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "Search", &state.search);
  note_widget(ui.widgets, "outline/search", KeyUse::type);
  ImGui::Dummy({0, 4 * ui.scale});
}

void what_is_missing(Session& session, Ui& ui, OutlineState& state) {
  const float top = ImGui::GetCursorPosY();
  ImGui::Dummy({0, 6 * ui.scale});
  heading(ui, "What is missing");
  mistake_rows(session, ui, "mistakes", 0, most_mistakes);
  state.missing_height = ImGui::GetCursorPosY() - top;
}

} // namespace

void OutlinePanel::start_rename(Session& session, Ui& ui) {
  if (session.selection().parts.size() != 1) return;
  const Part& part = session.selection().parts.front();
  const bool listed = session.mode == Mode::build;
  state_.revealed = {}; // bring its row into view
  start_typing(session, ui, listed ? widget_of(part) + "/name" : "inspector/name", part.name);
}

void OutlinePanel::draw(Session& session, Ui& ui, ViewState& view, const CommandRunner& commands,
                        const PanelRect& rect) {
  begin_panel("outline", rect);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * ui.scale, 0});
  search_field(ui, state_);
  // What is missing stays in view below the list.
  const float footer = session.mistakes.empty() ? 0 : state_.missing_height;
  const float room = ImGui::GetContentRegionAvail().y;
  ImGui::BeginChild("parts", {0, std::max(room - footer, room / 3)}, false);
  keep_rows(session, ui, state_);
  Outline outline{session, ui, view, state_, commands, {}, {}, 0};
  outline.height = ImGui::GetTextLineHeight() + 8 * ui.scale;
  for (std::size_t i = 0; i < session.mistakes.size(); ++i)
    if (Part part = part_of(session.mechanism(), session.mistakes[i]); part.kind != PartKind::none)
      outline.mistakes.emplace(std::move(part), i);
  for (std::size_t i = 0; i < outline_sections.size(); ++i)
    part_section(outline, i);
  const bool none = session.mechanism().bodies.empty() && session.mechanism().joints.empty();
  if (none) paragraph("The parts of the mechanism are listed here.", colors_of(ui).dim);
  const bool found =
      std::ranges::any_of(outline.kept().listed, [](const auto& rows) { return !rows.empty(); });
  if (!none && !found && !state_.search.empty()) paragraph("No part is called so.", colors_of(ui).dim);
  // A click beside the rows selects nothing.
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !ImGui::IsAnyItemHovered())
    later(ui, [&session] { select(session, {}); });
  ImGui::EndChild();
  if (!none && !session.mistakes.empty()) what_is_missing(session, ui, state_);
  ImGui::PopStyleVar();
  ImGui::End();
}

} // namespace flyball
