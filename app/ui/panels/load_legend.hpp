// What the arrows of loads mean: what an arrow of a certain length stands for, and the largest of each kind.
#pragma once

#include "app/ui/panels/legend.hpp"

namespace flyball {

// Rows for the legend; nothing where no loads are wanted.
void add_load_rows(const ViewContext& context, std::vector<LegendRow>& rows);
// The row's arrow, in a space as high as text.
void draw_load_mark(const Ui& ui, const LegendRow& row, ImVec2 from, float height);

} // namespace flyball
