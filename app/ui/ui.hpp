// What widgets are drawn with, where they note themselves, and the keys that reach them: all of a window that
// they touch.
#pragma once

#include "app/render/fonts.hpp"
#include "app/session/settings.hpp"
#include "app/ui/keyboard/keyboard_state.hpp"
#include "app/ui/widgets/completion_list.hpp"
#include "app/ui/widgets/field_state.hpp"
#include "app/ui/widgets/section_state.hpp"
#include "app/ui/widgets/slider_press.hpp"
#include "app/ui/widgets/tooltip.hpp"
#include "app/ui/widgets/widget_map.hpp"
#include "app/viewport/theme.hpp"

#include <memory>
#include <vector>

namespace flyball {

struct PlotToSave;   // see plot_save.hpp
enum class PlotFile; // see plot_view.hpp

// A key that went down. Kept as it happened: Dear ImGui 1.86 only sees which keys are down when a frame
// begins, and misses one that was tapped while a slow frame was drawn.
struct KeyPress {
  int key = 0; // 'A' to 'Z' as the keyboard's layout has it, a digit, ' ', a sign, or from 256 on GLFW's code
  bool ctrl = false, shift = false, alt = false;
  bool operator==(const KeyPress&) const = default;
};

struct Ui {
  Theme theme = Theme::light; // that is shown
  ThemeChoice theme_choice = ThemeChoice::system;
  ThemeChoice theme_kept = ThemeChoice::system; // for every run: not one that was asked for this run alone
  Theme system_theme = Theme::light;            // that the desktop has
  float scale = 1;                              // pixels a point has
  double zoom = 1;                              // that a person has chosen, times what the display has
  UiFonts fonts;
  WidgetMap widgets;
  KeyboardState keyboard;
  std::vector<KeyPress> keys; // since the last frame; whoever runs the loop adds, build_gui() empties
  TooltipState tooltip;
  FieldState fields;
  CompletionState completion; // of the field that is typed in
  SectionState sections;
  SliderPress slider_press;
  PlotFile plot_file_wanted{}; // by a command, of the first plot that is drawn next
  // A plot was drawn in the open study when that was drawn last.
  bool plot_drawn = false;
  std::shared_ptr<PlotToSave> plot_to_save; // asked for in a plot's menu, until the dialog takes it
};

} // namespace flyball
