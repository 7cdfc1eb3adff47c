// The critical speeds of the branch that a Campbell diagram shows, as a table.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/study_views.hpp"
#include "app/ui/ui.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball {

// Of a branch whose lines have these names: by order, then by speed, which has this unit.
std::vector<CriticalRow> critical_rows(const CampbellDiagram& diagram, std::size_t branch,
                                       std::span<const std::string> names, const ShownUnit& unit);
// Pixels, of all columns.
float critical_table_width(const Ui& ui);
// Pixels that the bar below it takes where it has this width.
float critical_table_bar(const Ui& ui, float width);
// From here on, `height` (pixels) of it, the bar included; narrower where there is less room: names of modes
// are cut, and below the least width of its columns the table scrolls sideways. A click on a row sets the
// number at `address` so that the drive has its speed.
void critical_table(Session& session, Ui& ui, const std::vector<CriticalRow>& rows, const ShownUnit& unit,
                    const std::string& address, float height);

} // namespace flyball
