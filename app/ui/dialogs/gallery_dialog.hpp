// The shipped scenes with pictures, in groups, and a field that finds some of them.
#pragma once

#include "app/session/examples.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

// A shipped scene in the gallery.
struct SceneCard : Example {
  std::string about;    // the first sentence of its description
  unsigned picture = 0; // OpenGL's; 0 until it is drawn
};

class GalleryDialog {
 public:
  void open(const Session& session, DialogState& dialog);
  struct Answer {
    std::filesystem::path file; // to be opened; empty: none
    bool other = false;         // another file is asked for instead
  };
  Answer draw(Ui& ui, DialogState& dialog);
  // For whoever draws the pictures; none are wanted while it is not open.
  std::vector<SceneCard>& cards() { return cards_; }
  bool showing() const { return showing_; } // in the last frame
  bool drawing = false;                     // pictures are still to be drawn

 private:
  std::vector<SceneCard> cards_;
  std::string search_;
  int chosen_ = 0; // among the cards
  bool showing_ = false;
};

} // namespace flyball
