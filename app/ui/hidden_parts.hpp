// Parts that the view leaves out, to see what lies behind them or what belongs together.
#pragma once

namespace flyball {

struct App;

void hide_selected(App& app);    // more of them
void isolate_selected(App& app); // all but those selected, and what joins selected bodies
void show_hidden(App& app);

} // namespace flyball
