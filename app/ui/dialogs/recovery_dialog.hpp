// Offers what a crash has left.
#pragma once

#include "app/session/files.hpp"

#include <optional>

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class RecoveryDialog {
 public:
  // Returns what is to be recovered.
  std::optional<Leftover> draw(Session& session, Ui& ui, DialogState& dialog);

 private:
  int answer_ = 0; // that Enter means
  int chosen_ = 0; // leftover
};

} // namespace flyball
