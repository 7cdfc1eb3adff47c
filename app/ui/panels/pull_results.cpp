// What a hand does to the steady state that is told of.
#include "app/ui/panels.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/widgets/widgets.hpp"

namespace flyball {

void pull_results(App& app) {
  const auto force = hand_force(app);
  if (!force) return;
  row(app, "A hand pulls " + app.tool.pull->grabbed.body, short_text(*force, 3), "N",
      "With this force, while it is held: the steady state is the one with the hand.");
  note_widget(app.widgets, "results/pull");
}

} // namespace flyball
