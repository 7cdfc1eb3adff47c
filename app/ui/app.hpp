// A session shown in a window: how it is looked at, and what a hand is about to do. update() moves it on,
// build_gui() draws and edits it. Neither needs OpenGL; see stage.hpp for what turns it into a picture.
#pragma once

#include "app/session/session.hpp"
#include "app/session/settings.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/export_request.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/report_export.hpp"
#include "app/ui/studies/motion/movie_state.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/notice.hpp"
#include "app/viewport/view_renderer.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

namespace flyball {

struct Panels; // see panel_list.hpp

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

// Its parts are given to what touches them. All of it is taken by what assembles the frame (build_gui.cpp,
// stage.hpp, snapshot.hpp) and by what carries out commands.
struct App {
  explicit App(AppOptions options);
  ~App();

  Session session;
  Ui ui;
  ToolState tool;
  ViewState view;
  PanelSizes sizes;
  DialogState dialog;
  MovieState movie;
  ReportExport report;
  NoticeAge notice_age; // of `session.notice`, which is shown in the view for a while, see notice.hpp
  NoticeLog notice_log;
  std::unique_ptr<Panels> panels;
  CommandRunner commands{*this};
  std::function<void(App&)> leaving; // what leaving the document is for, while it is asked about

  // Told to whoever runs the loop, who clears them.
  bool quit = false;
  std::optional<ExportRequest> export_request;

  ViewContext context() { return {session, ui, tool, view}; }
};

// The session's update(), and the camera follows. `view` is the size of the 3-D view.
void update(App& app, double seconds, ViewSize view);
// s, until the progress of what is computed in the background is worth another look; infinite where nothing
// is.
double next_progress(const App& app);
// The whole interface, between ImGui::NewFrame and ImGui::Render.
void build_gui(App& app);
// Where the panels are in a window of this size (pixels).
Layout layout_of(const App& app, float width, float height);

} // namespace flyball
