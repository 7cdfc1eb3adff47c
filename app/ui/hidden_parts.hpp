// Parts that the view leaves out, to see what lies behind them or what belongs together.
#pragma once

namespace flyball {

struct Session;
struct ViewState;

void hide_selected(Session& session, ViewState& view); // more of them
// All but those selected, and what joins selected bodies.
void isolate_selected(const Session& session, ViewState& view);
void show_hidden(ViewState& view);

} // namespace flyball
