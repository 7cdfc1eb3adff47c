// What is known of the selected parts, to be read and edited; of the whole scene where none is.
#pragma once

#include "app/ui/inspector/inspector_state.hpp"
#include "app/ui/layout.hpp"

namespace flyball {

class CommandRunner;
struct Session;
struct ToolState;
struct Ui;

class InspectorPanel {
 public:
  void draw(Session& session, Ui& ui, ToolState& tool, const CommandRunner& commands, const PanelRect& rect);
  const InspectorState& state() const { return state_; }

 private:
  InspectorState state_;
};

} // namespace flyball
