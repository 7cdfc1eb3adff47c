// Every key and what it does.
#pragma once

#include "app/session/navigation.hpp"

namespace flyball {

struct Ui;

class ShortcutSheet {
 public:
  bool open = false;
  void draw(Ui& ui, Navigation navigation);
};

} // namespace flyball
