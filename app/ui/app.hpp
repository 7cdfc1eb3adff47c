// A session shown in a window: how it is looked at, and what a hand is about to do. update() moves it on,
// build_gui() draws and edits it. Neither needs OpenGL; see stage.hpp for what turns it into a picture.
#pragma once

#include "app/session/navigation.hpp"
#include "app/session/session.hpp"
#include "app/session/settings.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/command_state.hpp"
#include "app/ui/file_dialog_state.hpp"
#include "app/ui/inspector_state.hpp"
#include "app/ui/panels/view_cube.hpp"
#include "app/ui/report_export.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/studies/motion/movie_state.hpp"
#include "app/ui/studies/study_views.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/notice.hpp"
#include "app/ui/widgets/shown_rate.hpp"
#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"
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

struct ViewState {
  ViewCamera camera;
  ViewSize size;                    // pixels, of the last update
  std::optional<CameraGlide> glide; // while the camera is on its way
  bool animated = false;            // commands make it glide
  ViewCubeState cube;
  std::vector<Part> hidden;    // not drawn, nor to be pointed at
  int menu_in = 0;             // frames until the context menu opens, as panels settle first; 0: it does not
  std::optional<Vec2> menu_at; // where, in pixels of the window; none: where its part is
  bool menu_of_part = false;   // it is that of the selected parts
  bool ghost = true, grid = true, shadow = true;
  bool loads = false;          // arrows of what acts; see load_view.hpp
  bool alone = false;          // no panels round it, for pictures
  int samples = 4;             // 1: no anti-aliasing
  bool fit = true;             // wanted at the next update
  bool fit_loads = false;      // wanted where arrows that come leave a view that held everything
  bool keep_direction = false; // fit as the camera stands, rather than start as the scene says
  PartId hovered;
  Vec2 pointed_at = Vec2::Constant(-1); // pixel of the view for which `hovered` was found
  ShownScene scene, scene_beside;       // see shown_scene()
  unsigned texture = 0;                 // OpenGL's, with the picture of the view
  unsigned texture_beside = 0;          // the same of the motion, where it has a view of its own
  float lines_top = 0;                  // pixels of the window: above what is written at the view's foot
};

// The button on a slider: a click moves the knob only once it is known not to be the first of two, which
// type.
struct SliderPress {
  std::string name;                       // of the slider
  float from = 0;                         // pixel of the window where the button went down
  float grip = 0;                         // pixels from the knob's middle, where it was taken by the knob
  bool on_knob = false, dragging = false; // dragging: the hand has moved, and the knob follows
  bool typing = false;                    // it asked for typing; nothing moves any more
  std::optional<double> place{}, since{}; // of a click beside the knob: share of the track; s of ImGui's
};

// Sizes in points, so that they mean the same on every display.
struct PanelState {
  float parameters_width = 290, results_width = 345, stacked_width = 330;
  // Of the height, for the parameters above the results; 0 until the person chooses: as much as they need.
  float stacked_share = 0;
  float parameters_height = 0; // what they needed in the last frame
  float inspector_share =
      0.55f; // of the height, for the inspector above the results, or the outline above it
  bool pinned = true, named = true, springs = true, drives = true;
  float study_share = 0.42f; // of the height, for the studies below the view
  bool dampers = true;
  bool legend = true;      // of the view
  bool legend_low = false; // in the lower corner, where it hides fewer arrows
  bool torques = true, reactions = false, eigenvalues = false, system = false;
  std::map<std::string, KeptRates> rates; // by the slider's address
  SliderPress slider_press;
};

enum class Dialog {
  none,
  open,
  save,
  gallery,
  unsaved,
  recover,
  export_picture,
  export_report,
  export_model,
  save_plot,
  export_run,
  mirror,
  circular
};

struct PlotSave; // see plot_save.hpp

struct DialogState {
  Dialog wanted = Dialog::none; // to be opened by the next frame
  bool showing = false;
  std::string path;                // typed
  int width = 1920, height = 1080; // pixels
  bool panels = false, loads = false;
  std::shared_ptr<PlotSave> plot; // while one is being saved
};

struct ExportRequest {
  std::filesystem::path file;
  int width = 1920, height = 1080; // pixels
  bool panels = false, loads = false;
  std::shared_ptr<const PlotSave> plot{}; // this instead of the window or the view
  bool report = false;                    // a page with the view in it
};

struct App : Session, Ui {
  explicit App(AppOptions options);

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

 protected:
  void document_opened(bool same_file) override;
  void mode_chosen() override;
};

void set_tool(App& app, Tool tool);
// The direction the view looks in, from azimuth and elevation (rad), with all in view.
void look_from(App& app, double azimuth, double elevation);

// The session's update(), and the camera follows. `view` is the size of the 3-D view.
void update(App& app, double seconds, ViewSize view);
// The whole interface, between ImGui::NewFrame and ImGui::Render.
void build_gui(App& app);

// The mechanism that the 3-D view shows.
const std::shared_ptr<const Mechanism>& shown_mechanism(const App& app);
// What the 3-D view shows. Refers to the app: use before it changes. The stage makes one a frame; what is
// drawn over the view reads app.view.scene, which was made of it.
ViewFrame view_frame(const App& app);
// What the view beside it shows: the motion alone.
ViewFrame motion_frame(const App& app, ViewFrame frame);

} // namespace flyball
