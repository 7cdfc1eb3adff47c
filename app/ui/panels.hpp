// Parts of the interface that keep nothing from frame to frame, one file each.
#pragma once

#include "app/ui/layout.hpp"

namespace flyball {

class CommandRunner;
struct DialogState;
struct NoticeLog;
struct ReportExport;
struct ToolState;
struct ViewState;

void toolbar_panel(Session& session, Ui& ui, ViewState& view, const CommandRunner& commands,
                   const PanelRect& rect);
void menu_bar(const Session& session, Ui& ui, const CommandRunner& commands);
// Over the view of an empty document: what to do first.
void welcome(const Session& session, Ui& ui, const ToolState& tool, const DialogState& dialog,
             const CommandRunner& commands, const PanelRect& view);
// Seconds shown a second; width in pixels.
void factor_combo(Session& session, Ui& ui, const char* name, float width);
// Solved, solving, or what is missing.
void status_chip(const Session& session, Ui& ui, const PanelRect& view);
void messages_panel(Ui& ui, NoticeLog& log, const PanelRect& view); // what was told before, where it is open
// Over the view: what happened to the file on disk, or how far a report is that is being written.
void file_banner(Session& session, Ui& ui, DialogState& dialog, ReportExport& report,
                 const CommandRunner& commands, const PanelRect& view);

// Elevation (rad) from which three axes at right angles look alike.
inline constexpr double isometric_elevation = 0.6154797086703873;

} // namespace flyball
