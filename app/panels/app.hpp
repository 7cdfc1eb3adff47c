// What the program has open and how it is shown: a plain state that update() moves on and build_gui()
// draws and edits. Neither needs OpenGL; see stage.hpp for what turns it into a picture.
#pragma once

#include "app/live/live_solver.hpp"
#include "app/panels/number_text.hpp"
#include "app/panels/parameter_list.hpp"
#include "app/panels/widget_map.hpp"
#include "app/render/fonts.hpp"
#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"
#include "app/viewport/view_renderer.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct AppOptions {
  LiveSolver::Mode mode = LiveSolver::Mode::background;
  std::function<void()> on_news; // from the background thread; see LiveSolver
  std::filesystem::path scenes;  // the shipped scenes; may be empty
  Theme theme = Theme::light;
  NumberStyle numbers;
};

struct Playback {
  bool playing = false;
  double time = 0;   // s after the drawn drive phase
  double factor = 1; // seconds shown a second; below one is slow motion
};

struct ViewState {
  ViewCamera camera;
  bool ghost = true, grid = true, shadow = true, solid = true; // solid: the equilibrium, else the drawn pose
  int samples = 4;                                             // 1: no anti-aliasing
  bool fit = true;                                             // wanted at the next update
  bool keep_direction = false; // fit as the camera stands, rather than start as the scene says
  PartId hovered;
  Vec2 pointed_at = Vec2::Constant(-1); // pixel of the view for which `hovered` was found
  unsigned texture = 0;                 // OpenGL's, with the picture of the view
};

// Sizes in points, so that they mean the same on every display.
struct PanelState {
  float parameters_width = 290, results_width = 345, stacked_width = 330;
  // Of the height, for the parameters above the results; 0 until the person chooses: as much as they need.
  float stacked_share = 0;
  float parameters_height = 0; // what they needed in the last frame
  bool springs = true, drives = true, others = true;
  bool torques = true, reactions = false, eigenvalues = false, system = false;
  std::string editing;      // address of the parameter whose value is being typed
  std::string typed;        // what was typed so far
  bool focus_typed = false; // the field has just appeared
};

// A key that went down. Kept as it happened: Dear ImGui 1.86 only sees which keys are down when a frame
// begins, and misses one that was tapped while a slow frame was drawn.
struct KeyPress {
  char letter = 0; // 'A' to 'Z' as the keyboard's layout has it, a digit or ' '
  bool ctrl = false;
};

enum class Dialog { none, open, export_picture };

struct DialogState {
  Dialog wanted = Dialog::none; // to be opened by the next frame
  bool showing = false;
  std::string path;                // typed
  int width = 1920, height = 1080; // pixels
  bool panels = false;
};

struct ExportRequest {
  std::filesystem::path file;
  int width = 1920, height = 1080; // pixels
  bool panels = false;
};

struct App {
  explicit App(AppOptions options);

  AppOptions options;
  // The open scene: as in its file, and with the numbers moved since.
  std::filesystem::path file;
  Mechanism original, mechanism;
  bool open = false;
  std::string problem; // why the file last asked for could not be opened
  std::vector<ParameterControl> parameters;

  LiveSolver live;
  LiveAnswer answer;
  std::vector<Pose> drawn, poses; // poses: of the answer at playback.time; empty where there is none
  bool moved_time = false;        // playback.time changed: poses are to be asked for

  Playback playback;
  ViewState view;
  PanelState panels;
  DialogState dialog;
  Theme theme = Theme::light;
  float scale = 1; // pixels a point has
  UiFonts fonts;
  WidgetMap widgets;
  std::vector<KeyPress> keys; // since the last frame; whoever runs the loop adds, build_gui() empties

  // Told to whoever runs the loop, who clears them.
  bool quit = false;
  std::optional<ExportRequest> export_request;
  std::string notice; // what was last done, in words: shown in the view
};

// Opens a mechanism, read from `file`.
void open_mechanism(App& app, Mechanism mechanism, const std::filesystem::path& file);
// Reads and opens a scene; where it cannot be read, says so in `problem` and leaves the open one as it is.
void open_scene(App& app, const std::filesystem::path& file);
void reload_scene(App& app);
// The same address as in a scene file; solves at once. Not finite values and unknown addresses are ignored.
void change_parameter(App& app, const std::string& address, double value);
void reset_parameters(App& app);
void solve_from_drawn_pose(App& app);

// The direction the view looks in, from azimuth and elevation (rad), with all in view.
void look_from(App& app, double azimuth, double elevation);
void play(App& app, bool playing);
void rewind(App& app);

// Takes what the background has found and moves the time on by `seconds`. `view` is the size of the 3-D view.
void update(App& app, double seconds, ViewSize view);
// The whole interface, between ImGui::NewFrame and ImGui::Render.
void build_gui(App& app);

// What the 3-D view shows. Refers to the app: use before it changes.
ViewFrame view_frame(const App& app);
// Whether anything moves by itself.
bool in_motion(const App& app);

} // namespace flyball
