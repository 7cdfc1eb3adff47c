// The order in which the keyboard goes through widgets and regions, and the ring round the one it is at.
#pragma once

#include "app/ui/ui.hpp"

#include <span>
#include <string_view>

namespace flyball {

inline constexpr std::string_view view_region = "view";

const KeyStop* stop_named(std::span<const KeyStop> stops, std::string_view name);
// The panel or dialog of a widget; all that lies over the view is one.
std::string region_of(const KeyStop& stop);
// Of the list, menu or dialog that is open on top of all; empty: none is.
std::string popup_region();
// The region after this one (`step` -1: before), the view among them.
std::string next_region(std::span<const KeyStop> stops, const std::string& region, int step);

// The next widget for Tab after `from` in its region, the first without one; round and round. Null: none.
const KeyStop* tab_stop(const KeyboardState& state, const std::string& region, const KeyStop* from, int step);
// The first or last of the region, of a list the first or last row.
const KeyStop* last_stop(const KeyboardState& state, const KeyStop& from, bool last);
// The nearest in the direction of an arrow key, in the same region.
const KeyStop* nearest_stop(std::span<const KeyStop> stops, const KeyStop& from, int arrow);
// So many rows further in the list, or as far as there are rows.
const KeyStop* row_away(std::span<const KeyStop> stops, const KeyStop& from, int rows);

// Of stops of the frame that is being made.
void bring_into_sight(const Ui& ui, const KeyStop& stop);
void draw_focus_ring(const Ui& ui, const KeyStop& stop);
void draw_view_ring(const Ui& ui);

} // namespace flyball
