// A session shown in a window: how it is looked at, and what a hand is about to do. update() moves it on,
// build_gui() draws and edits it. Neither needs OpenGL; see stage.hpp for what turns it into a picture.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/session.hpp"
#include "app/session/settings.hpp"
#include "app/ui/command_state.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/export_request.hpp"
#include "app/ui/file_dialog_state.hpp"
#include "app/ui/inspector_state.hpp"
#include "app/ui/panel_state.hpp"
#include "app/ui/report_export.hpp"
#include "app/ui/studies/motion/movie_state.hpp"
#include "app/ui/studies/study_views.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/notice.hpp"
#include "app/viewport/view_renderer.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct AppOptions {
  LiveSolver::Mode mode = LiveSolver::Mode::background;
  std::function<void()> on_news; // from the background thread; see LiveSolver
  std::filesystem::path scenes;  // the shipped scenes; may be empty
  Theme theme = Theme::light;    // until the desktop has been asked
  NumberStyle numbers;
  bool animated = false;         // the camera glides to where commands put it
  std::filesystem::path state{}; // folder for recent files and autosaves; empty: nothing is kept anywhere
  // Of the command line, for this run; none: as it was kept.
  std::optional<ThemeChoice> theme_choice{};
};

struct App {
  explicit App(AppOptions options);

  Session session;
  Ui ui;
  ToolState tool;
  InspectorState inspector;
  CommandState commands;
  FileDialogState file_dialogs;
  StudyViews plots;
  MovieState movie;
  ReportExport report;
  ViewState view;
  PanelState panels;
  DialogState dialog;
  Theme system_theme = Theme::light;
  ThemeChoice theme_choice = ThemeChoice::system;
  Navigation navigation = Navigation::own;

  // Told to whoever runs the loop, who clears them.
  bool quit = false;
  std::optional<ExportRequest> export_request;
  NoticeAge notice_age; // of `notice`, which is shown in the view for a while, see notice.hpp
  NoticeLog notice_log;
};

void set_tool(App& app, Tool tool);
// The direction the view looks in, from azimuth and elevation (rad), with all in view.
void look_from(ViewState& view, double azimuth, double elevation);

// The session's update(), and the camera follows. `view` is the size of the 3-D view.
void update(App& app, double seconds, ViewSize view);
// The whole interface, between ImGui::NewFrame and ImGui::Render.
void build_gui(App& app);

// The mechanism that the 3-D view shows.
const std::shared_ptr<const Mechanism>& shown_mechanism(const Session& session, const ToolState& tool);
// What the 3-D view shows. Refers to the app: use before it changes. The stage makes one a frame; what is
// drawn over the view reads app.view.scene, which was made of it.
ViewFrame view_frame(const App& app);
// What the view beside it shows: the motion alone.
ViewFrame motion_frame(const Session& session, ViewFrame frame);

} // namespace flyball
