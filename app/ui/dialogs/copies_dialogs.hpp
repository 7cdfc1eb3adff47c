// What Mirror and Circular copy ask for.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

// Of Mirror (the plane through the point at right angles to the axis) and Circular copy.
struct CopyChoice {
  int axis = 0;              // x, y or z
  Vec3 point = Vec3::Zero(); // m
  int count = 3;
};

class CopiesDialogs {
 public:
  void open_mirror(const Session& session, DialogState& dialog);
  void open_circular(const Session& session, DialogState& dialog);
  void draw(Session& session, Ui& ui, DialogState& dialog);
  const CopyChoice& choice() const { return choice_; }

 private:
  void draw_mirror(Session& session, Ui& ui, DialogState& dialog);
  void draw_circular(Session& session, Ui& ui, DialogState& dialog);

  CopyChoice choice_;
};

} // namespace flyball
