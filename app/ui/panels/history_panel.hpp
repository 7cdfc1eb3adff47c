// Every step since the document was opened, to go back to.
#pragma once

namespace flyball {

struct PanelRect;
struct Session;
struct Ui;

class HistoryPanel {
 public:
  bool open = false;
  void forget() { shown_ = -1; }                              // another document is open
  void draw(Session& session, Ui& ui, const PanelRect& view); // where it is open

 private:
  int shown_ = -1; // the step last brought into view
};

} // namespace flyball
