// What a hand does to the steady state that is told of.
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

void pull_results(const Session& session, Ui& ui, const ToolState& tool) {
  const auto force = hand_force(session, tool);
  if (!force) return;
  row(ui, "A hand pulls " + tool.pull->grabbed.body, short_text(*force, 3), "N",
      "With this force, while it is held: the steady state is the one with the hand.");
  note_widget(ui.widgets, "results/pull");
}

} // namespace flyball
