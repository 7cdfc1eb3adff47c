// The parts of the mechanism as a list in three sections, in step with what is selected in the view.
#pragma once

#include "app/document/part.hpp"
#include "app/ui/layout.hpp"
#include "app/viewport/theme.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace flyball {

class CommandRunner;
struct Session;
struct Ui;
struct ViewState;

// Kept while the mechanism and what is searched for stay the same.
struct OutlineRows {
  std::uint64_t revision = 0; // of the document; 0: nothing is kept
  Theme theme = Theme::light;
  std::string search;
  std::vector<Color> colours;                // of the bodies
  std::array<std::vector<PartId>, 3> listed; // bodies, joints, forces
};

struct OutlineState {
  std::string search;
  OutlineRows rows;
  float missing_height = 0; // pixels, of what is missing below the list
  Part anchor, revealed;    // where a range of rows begins; the last one brought into view
};

class OutlinePanel {
 public:
  void draw(Session& session, Ui& ui, ViewState& view, const CommandRunner& commands, const PanelRect& rect);
  // Of the selected part, in its row, or in the inspector where there is no list.
  void start_rename(Session& session, Ui& ui);

 private:
  OutlineState state_;
};

} // namespace flyball
