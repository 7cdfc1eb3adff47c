// What the steady state is: verdict, coordinates, forces, stability.
#pragma once

#include "app/ui/panels/result_sections.hpp"
#include "app/ui/remedies.hpp"

namespace flyball {

struct PanelRect;

class ResultsPanel {
 public:
  // `below_inspector`: with a title of its own.
  void draw(Session& session, Ui& ui, const ToolState& tool, const PanelRect& rect, bool below_inspector);
  ResultSections& sections() { return open_; }

 private:
  ResultSections open_;
  InBearings in_bearings_;
};

} // namespace flyball
