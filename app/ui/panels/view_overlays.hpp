// What is written over the 3-D view.
#pragma once

#include "app/ui/layout.hpp"
#include "app/ui/view_context.hpp"

namespace flyball {

class CommandRunner;
struct DialogState;
struct NoticeAge;
struct NoticeLog;

// In the view's window: what the picture shows, in its upper left corner, and the same of the view beside it.
void caption(const Session& session, Ui& ui, const PanelRect& rect);
void motion_caption(const Session& session, const Ui& ui, const PanelRect& rect);
// What to do next with the tool, and what was last done.
void view_lines(const ViewContext& context, NoticeAge& age, NoticeLog& log, const PanelRect& rect);
// Windows of their own. "arm1", and what it is, beside the cursor.
void part_label(const ViewContext& context);
// A notice of what went wrong, until it is put away.
void error_line(Session& session, Ui& ui, const ViewState& view, const PanelRect& rect);
// What is tried and not stored: keep it, or go back.
void explored_chip(Session& session, Ui& ui, const DialogState& dialog, const PanelRect& rect);
// A scene that cannot be read.
void problem_banner(Session& session, Ui& ui, const CommandRunner& commands, const PanelRect& rect);

} // namespace flyball
