// Asks before unsaved work is lost.
#pragma once

#include <optional>

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class UnsavedDialog {
 public:
  enum class Answer { save, discard, cancel };
  std::optional<Answer> draw(Session& session, Ui& ui, DialogState& dialog);

 private:
  int answer_ = 0; // that Enter means
};

} // namespace flyball
