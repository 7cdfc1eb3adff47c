// A first mechanism step by step, as README has it, beside the view in which it is built.
#pragma once

#include <string_view>

namespace flyball {

struct PanelRect;
struct Ui;

// A step or paragraph each line; made from README by embed_tutorial.cmake.
std::string_view tutorial_text();

class TutorialPanel {
 public:
  bool open = false;
  void draw(Ui& ui, const PanelRect& view);
};

} // namespace flyball
