// What the view shows, named: which pose is drawn how.
#pragma once

#include "app/ui/layout.hpp"
#include "app/ui/view_context.hpp"
#include "app/viewport/camera.hpp"
#include "app/viewport/load_arrows.hpp"

#include <imgui.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

// scale: a length of the view; note: words alone.
enum class LegendMark { solid, outlined, dashed, glass, motion, load, scale, note };

struct LegendRow {
  LegendMark mark = LegendMark::solid;
  std::string words{}; // "Steady state"
  LoadKind load = LoadKind::reaction;
  bool moment = false;
  float length = 0;                     // pixels, of an arrow
  std::string help{};                   // where it is pointed at
  std::optional<LoadLengths> chooses{}; // what a click makes of arrows
};
// What is in the view now; nothing for an empty document.
std::vector<LegendRow> legend_rows(const ViewContext& context);

// A small window in a right corner of the view, the upper one at first; it goes to the other where it hides
// less there of bodies, of the drawn pose and of loads' arrows. A click on its title folds it.
class Legend {
 public:
  void draw(const ViewContext& context, const PanelRect& view, bool folds = true);

 private:
  float top(const ViewContext& context, const PanelRect& view, ImVec2 size, std::size_t rows);

  bool low_ = false;                                         // in the lower corner
  std::optional<std::pair<ViewCamera, std::size_t>> zoomed_; // camera and rows when the wheel last turned
  bool anyway_ = false;                                      // open also where it covers much of the view
};

} // namespace flyball
