// The 3-D view with what acts in it: what tools and what is drawn over the view take.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"

namespace flyball {

struct ViewContext {
  Session& session;
  Ui& ui;
  ToolState& tool;
  ViewState& view;
};

} // namespace flyball
