// What the arrows of loads say: values beside those of a free-body diagram, and of the one pointed at.
#pragma once

#include "app/ui/panels/view_input.hpp"

namespace flyball {

// Names and values beside the arrows of a free-body diagram, where there is room for them.
void load_labels(Ui& ui, const ViewState& view, const PanelRect& rect);
// What is known of the arrow under the cursor, as a tooltip; false where there is none.
bool load_tooltip(const ViewContext& context, const ViewInput& input);

} // namespace flyball
