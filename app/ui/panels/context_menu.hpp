// What a right click in the 3-D view brings: what can be done with the selected parts, or with the view.
#pragma once

#include "app/ui/panels/view_input.hpp"
#include "app/ui/view_context.hpp"

namespace flyball {

class CommandRunner;

// The lines of the menu of the selected parts, of which there are some, wherever that opens.
void part_items(Session& session, Ui& ui, ViewState& view, const CommandRunner& commands);

class ContextMenu {
 public:
  // In the view's window. A part under the cursor is selected first.
  void draw(const ViewContext& context, const CommandRunner& commands, const ViewInput& input);
  // As a key asks for it.
  void open(const Session& session);

 private:
  int in_ = 0;             // frames until it opens, as panels settle first; 0: it does not
  std::optional<Vec2> at_; // where, in pixels of the window; none: where its part is
  bool of_part_ = false;   // it is that of the selected parts
};

} // namespace flyball
