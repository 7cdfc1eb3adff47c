#include "app/ui/keyboard/focus_order.hpp"

#include "app/ui/commands.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace flyball {

namespace {

constexpr std::string_view over_view = "over the view", between = "splitters";
constexpr std::array<std::string_view, 11> region_order{"toolbar", "outline",   "parameters", view_region,
                                                        over_view, "inspector", "results",    "study",
                                                        "History", "Messages",  between};

std::ptrdiff_t rank_of_region(std::string_view region) {
  return std::ranges::find(region_order, region) - region_order.begin();
}

// Whether Tab stops at one of the two alone: rows of a list, tabs side by side.
bool in_one_stop(const KeyStop& a, const KeyStop& b) {
  return a.use == b.use && (a.use == KeyUse::row || a.use == KeyUse::tab) && a.window == b.window;
}

// Of a list only one row: the chosen one, that where the keyboard was, or the first.
std::vector<const KeyStop*> tab_stops(const KeyboardState& state, const std::string& region,
                                      const KeyStop* from) {
  std::vector<const KeyStop*> stops;
  const auto was = state.was.find(region);
  const auto worth = [&](const KeyStop& row) {
    if (&row == from) return 3;
    if (row.chosen) return 2;
    return was != state.was.end() && was->second == row.name ? 1 : 0;
  };
  for (const KeyStop& stop : state.stops) {
    if ((stop.use == KeyUse::aside && &stop != from) || region_of(stop) != region) continue;
    if (!stops.empty() && in_one_stop(stop, *stops.back())) {
      if (worth(stop) > worth(*stops.back())) stops.back() = &stop;
      continue;
    }
    stops.push_back(&stop);
  }
  return stops;
}

// How far it is to the other in this direction; sideways counts thrice. Negative: it is not there.
float way_to(const KeyStop& from, const KeyStop& to, int arrow) {
  const bool upright = arrow == keys::up || arrow == keys::down;
  const bool forward = arrow == keys::down || arrow == keys::right;
  const auto ends = [&](const KeyStop& stop, bool along) {
    const bool y = along == upright;
    return std::pair(y ? stop.from.y : stop.from.x, y ? stop.to.y : stop.to.x);
  };
  const auto [from_low, from_high] = ends(from, true);
  const auto [to_low, to_high] = ends(to, true);
  const float half = (from_high - from_low + to_high - to_low) / 4; // what may overlap
  const float gap = forward ? to_low - from_high : from_low - to_high;
  const float by = (to_low + to_high - from_low - from_high) / 2;
  if ((forward ? by : -by) <= 0 || gap < -half) return -1;
  const auto [from_left, from_right] = ends(from, false);
  const auto [to_left, to_right] = ends(to, false);
  const float beside = std::max({0.f, to_left - from_right, from_left - to_right});
  const float middle = std::abs(to_left + to_right - from_left - from_right) / 2;
  return std::max(gap, 0.f) + 3 * beside + 0.05f * middle;
}

} // namespace

const KeyStop* stop_named(std::span<const KeyStop> stops, std::string_view name) {
  const auto found = std::ranges::find(stops, name, &KeyStop::name);
  return name.empty() || found == stops.end() ? nullptr : &*found;
}

std::string region_of(const KeyStop& stop) {
  const ImGuiWindow& root = *stop.window->RootWindow;
  const std::string_view name = root.Name;
  if ((root.Flags & (ImGuiWindowFlags_Popup | ImGuiWindowFlags_Modal)) != 0 ||
      std::ranges::find(region_order, name) != region_order.end())
    return std::string(name);
  return std::string(name.starts_with("splitter/") ? between : over_view);
}

std::string popup_region() {
  const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
  return open.empty() || !open.back().Window ? std::string() : open.back().Window->Name;
}

std::string next_region(std::span<const KeyStop> stops, const std::string& region, int step) {
  std::set<std::ptrdiff_t> ranks{rank_of_region(view_region)};
  for (const KeyStop& stop : stops)
    if (stop.use != KeyUse::aside)
      if (const std::ptrdiff_t rank = rank_of_region(region_of(stop)); rank < std::ssize(region_order))
        ranks.insert(rank);
  const std::vector<std::ptrdiff_t> all(ranks.begin(), ranks.end());
  const auto now = std::ranges::find(all, rank_of_region(region)) - all.begin();
  const auto count = std::ssize(all);
  const auto next = (now + step + count) % count;
  return std::string(region_order[static_cast<std::size_t>(all[static_cast<std::size_t>(next)])]);
}

const KeyStop* tab_stop(const KeyboardState& state, const std::string& region, const KeyStop* from,
                        int step) {
  const std::vector<const KeyStop*> stops = tab_stops(state, region, from);
  if (stops.empty()) return nullptr;
  const auto count = std::ssize(stops);
  const auto now = std::ranges::find(stops, from);
  if (now == stops.end()) return step > 0 ? stops.front() : stops.back();
  return stops[static_cast<std::size_t>((now - stops.begin() + step + count) % count)];
}

const KeyStop* last_stop(const KeyboardState& state, const KeyStop& from, bool last) {
  const KeyStop* found = nullptr;
  const std::string region = region_of(from);
  for (const KeyStop& stop : state.stops) {
    const bool same_list = stop.use == KeyUse::row && stop.window == from.window;
    if (from.use == KeyUse::row ? !same_list : stop.use == KeyUse::aside || region_of(stop) != region)
      continue;
    if (!found || last) found = &stop;
  }
  return found;
}

const KeyStop* nearest_stop(std::span<const KeyStop> stops, const KeyStop& from, int arrow) {
  const std::string region = region_of(from);
  const KeyStop* nearest = nullptr;
  float least = 0;
  for (const KeyStop& stop : stops) {
    if (&stop == &from || region_of(stop) != region) continue;
    const float way = way_to(from, stop, arrow);
    if (way < 0 || (nearest && way >= least)) continue;
    nearest = &stop;
    least = way;
  }
  return nearest;
}

const KeyStop* row_away(std::span<const KeyStop> stops, const KeyStop& from, int rows) {
  std::vector<const KeyStop*> list;
  for (const KeyStop& stop : stops)
    if (stop.use == KeyUse::row && stop.window == from.window) list.push_back(&stop);
  const auto now = std::ranges::find(list, &from) - list.begin();
  return list[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(now + rows, 0, std::ssize(list) - 1))];
}

void bring_into_sight(const Ui& ui, const KeyStop& stop) {
  ImVec2 from = stop.from, to = stop.to;
  // So that the next one of a list that draws only what is in sight is drawn, too.
  const float more = 2.5f * ImGui::GetTextLineHeight() + 20 * ui.scale;
  for (ImGuiWindow* window = stop.window; window; window = window->ParentWindow) {
    const ImRect& inner = window->InnerRect;
    const float room = std::min(more, std::max(0.f, (inner.GetHeight() - (to.y - from.y)) / 2));
    const float above = inner.Min.y + room - from.y, below = to.y + room - inner.Max.y;
    const float by = std::round(above > 0 ? -above : below > 0 ? below : 0);
    const float scroll = std::clamp(window->Scroll.y + by, 0.f, window->ScrollMax.y);
    const float done = scroll - window->Scroll.y;
    if (done != 0) ImGui::SetScrollY(window, scroll);
    from.y -= done;
    to.y -= done;
    if ((window->Flags & ImGuiWindowFlags_ChildWindow) == 0) break;
  }
}

void draw_focus_ring(const Ui& ui, const KeyStop& stop) {
  if (!ui.keyboard.ring) return;
  const float s = ui.scale, gap = std::round(2 * s), thick = std::max(2.f, std::round(2 * s));
  ImDrawList& list = *stop.window->DrawList;
  const ImRect clip = stop.window->OuterRectClipped;
  // Whole where the widget touches the rim of its window.
  const ImVec2 from(std::max(stop.from.x - gap, clip.Min.x + thick / 2),
                    std::max(stop.from.y - gap, clip.Min.y + thick / 2));
  const ImVec2 to(std::min(stop.to.x + gap, clip.Max.x - thick / 2),
                  std::min(stop.to.y + gap, clip.Max.y - thick / 2));
  if (from.x >= to.x || from.y >= to.y) return;
  const UiColors& colors = colors_of(ui);
  list.PushClipRect(clip.Min, clip.Max, false);
  // On a rim of the panel's colour, so that it stands out from what has the accent's.
  list.AddRect(from, to, packed(colors.panel), 4 * s, 0, thick + std::max(2.f, std::round(2 * s)));
  list.AddRect(from, to, packed(colors.focus), 4 * s, 0, thick);
  list.PopClipRect();
}

void draw_view_ring(const Ui& ui) {
  if (!ui.keyboard.ring) return;
  ImGuiWindow* window = ImGui::FindWindowByName("view");
  if (!window) return;
  const float thick = std::max(2.f, std::round(2 * ui.scale));
  const ImRect rect = window->Rect();
  window->DrawList->PushClipRect(rect.Min, rect.Max, false);
  window->DrawList->AddRect({rect.Min.x + thick, rect.Min.y + thick},
                            {rect.Max.x - thick, rect.Max.y - thick}, packed(colors_of(ui).focus), 0, 0,
                            thick);
  window->DrawList->PopClipRect();
}

} // namespace flyball
