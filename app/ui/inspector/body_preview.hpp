// The outline of a body that is not there yet, over the picture.
#pragma once

#include "app/document/create.hpp"
#include "app/ui/panels/view_input.hpp"

namespace flyball {

void draw_body_outline(const Ui& ui, const ViewInput& input, const NewBody& body);

} // namespace flyball
