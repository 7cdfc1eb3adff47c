// What the program has open and how it is shown: a plain state that update() moves on and build_gui()
// draws and edits. Neither needs OpenGL; see stage.hpp for what turns it into a picture.
#pragma once

#include "app/document/document.hpp"
#include "app/live/live_solver.hpp"
#include "app/render/fonts.hpp"
#include "app/session/number_text.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/units.hpp"
#include "app/ui/command_state.hpp"
#include "app/ui/file_state.hpp"
#include "app/ui/inspector_state.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/studies/motion/motion_state.hpp"
#include "app/ui/studies/motion/movie_state.hpp"
#include "app/ui/studies/study_state.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/widgets/notice.hpp"
#include "app/ui/widgets/shown_rate.hpp"
#include "app/ui/widgets/tooltip.hpp"
#include "app/ui/widgets/widget_map.hpp"
#include "app/viewport/camera.hpp"
#include "app/viewport/scene_list.hpp"
#include "app/viewport/view_renderer.hpp"
#include "engine/mechanism/error.hpp"

#include <filesystem>
#include <functional>
#include <limits>
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
  Theme theme = Theme::light;
  NumberStyle numbers;
  std::filesystem::path state{}; // folder for recent files and autosaves; empty: nothing is kept anywhere
};

struct Playback {
  bool playing = false;
  double time = 0;   // s after the drawn drive phase
  double factor = 1; // seconds shown a second; below one is slow motion
};

struct ViewState {
  ViewCamera camera;
  bool ghost = true, grid = true, shadow = true;
  int samples = 4;             // 1: no anti-aliasing
  bool fit = true;             // wanted at the next update
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
  bool pinned = true, springs = true, drives = true;
  float study_share = 0.42f; // of the height, for the studies below the view
  bool dampers = true;
  bool legend = true; // of the view
  bool torques = true, reactions = false, eigenvalues = false, system = false;
  std::map<std::string, KeptRates> rates; // by the slider's address
  SliderPress slider_press;
};

// A key that went down. Kept as it happened: Dear ImGui 1.86 only sees which keys are down when a frame
// begins, and misses one that was tapped while a slow frame was drawn.
struct KeyPress {
  int key = 0; // 'A' to 'Z' as the keyboard's layout has it, a digit, ' ', a sign, or from 256 on GLFW's code
  bool ctrl = false, shift = false;
  bool operator==(const KeyPress&) const = default;
};

enum class Dialog {
  none,
  open,
  save,
  gallery,
  unsaved,
  recover,
  export_picture,
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
  bool panels = false;
  std::shared_ptr<PlotSave> plot; // while one is being saved
};

struct ExportRequest {
  std::filesystem::path file;
  int width = 1920, height = 1080; // pixels
  bool panels = false;
  std::shared_ptr<const PlotSave> plot{}; // this instead of the window or the view
};

// Building shows the drawn pose, which is what is edited, with the equilibrium beside it as a ghost;
// exploring shows the equilibrium, which is what sliders move.
enum class Mode { explore, build };

struct App {
  explicit App(AppOptions options);

  AppOptions options;
  Document document;
  std::string problem; // why the file last asked for could not be opened
  std::vector<ParameterControl> parameters;
  std::vector<SceneError> mistakes; // of the document; while there are any it is not solved
  std::vector<SceneError> warnings; // of the document; where there are no mistakes

  LiveSolver live;
  LiveAnswer answer;
  std::vector<Pose> drawn, poses; // drawn: of the document; poses: of the answer at playback.time; empty
                                  // where there is none
  bool moved_time = false;        // playback.time changed: poses are to be asked for
  // Tickets: of the newest request (the largest number where the document is not fit to be solved), of the
  // last that was asked, and of the first since the document was opened.
  std::uint64_t awaited = std::numeric_limits<std::uint64_t>::max(), asked = 0, opened = 0;
  double waited = 0;         // s for an answer to it; 0 where there is one
  bool on_branch = false;    // a hand has chosen the equilibrium: sliders follow its branch, stable or not
  std::uint64_t gesture = 1; // of the hand: rises with every press of a button or key

  Mode mode = Mode::explore;
  ToolState tool;
  FileState files;
  InspectorState inspector;
  CommandState commands;
  Playback playback;
  StudyState study;
  MotionState motion;
  MovieState movie;
  ViewState view;
  PanelState panels;
  DialogState dialog;
  Theme theme = Theme::light;
  DisplayUnits units;
  float scale = 1; // pixels a point has
  UiFonts fonts;
  WidgetMap widgets;
  std::vector<KeyPress> keys; // since the last frame; whoever runs the loop adds, build_gui() empties

  // Told to whoever runs the loop, who clears them.
  bool quit = false;
  std::optional<ExportRequest> export_request;
  std::string notice; // what was last done, in words: shown in the view for a while, see notice.hpp
  NoticeAge notice_age;
  TooltipState tooltip;

  const Mechanism& mechanism() const { return document.mechanism(); }
  const Selection& selection() const { return document.selection(); }
};

// Takes a document's place; what was open is gone (see file_commands.hpp for asking first).
void open_document(App& app, Document document);
// Reads and opens a scene, finished or not; where it cannot be read, says so in `problem` and leaves the open
// one as it is.
void open_scene(App& app, const std::filesystem::path& file);

// An edit: a step that can be undone, solved at once. `change` gets the mechanism as it is stored and the
// selection, and may throw SceneError: then nothing has changed and the notice says why. Edits of the same
// name while a button is held (app.gesture) are one step.
void edit(App& app, const std::string& name, const std::function<void(Mechanism&, Selection&)>& change);
void undo(App& app);
void redo(App& app);
void go_to_step(App& app, std::size_t step);
void select(App& app, Selection selection);
// An edit of one number at an address as in a scene file; while exploring, solved from the last answer.
void edit_parameter(App& app, const std::string& address, double value);
// Tries a number while exploring, which changes nothing of what is stored; solves at once from the last
// answer. While building it is an edit. Not finite values and unknown addresses are ignored.
void change_parameter(App& app, const std::string& address, double value);
// The same of several, as one step of this name.
void change_parameters(App& app, const std::string& step, const Explored& values);
// What is explored becomes the document's, or goes back to what is stored. Both can be undone.
void keep_explored(App& app);
void drop_explored(App& app);
// "speed of spin 15 rad/s": each value that is explored, and what is stored of it.
std::vector<std::string> explored_words(const App& app);
// The same with the mechanism in the equilibrium nearest to these coordinates ("joint" or "joint.index" and
// rad or m), on whatever branch, stable or not. Sliders then follow that branch, until it ends, the drawn
// pose is started from again or something else is edited. Without an address no number is changed.
void go_to_state(App& app, const std::string& address, double value,
                 std::vector<std::pair<std::string, double>> start);
void solve_from_drawn_pose(App& app);
// A point of the body that is told of beside its mass centre, in the results and in the motion (see
// ToldPoints); none: its mass centre alone. No edit.
void tell_point(App& app, const std::string& body, const std::optional<Vec3>& at);
// Those of the bodies that there are.
std::vector<BodyPoint> told_points(const App& app);

void set_mode(App& app, Mode mode);
void set_tool(App& app, Tool tool);
// The direction the view looks in, from azimuth and elevation (rad), with all in view.
void look_from(App& app, double azimuth, double elevation);
void play(App& app, bool playing);
void rewind(App& app);

// Takes what the background has found and moves the time on by `seconds`. `view` is the size of the 3-D view.
void update(App& app, double seconds, ViewSize view);
// The whole interface, between ImGui::NewFrame and ImGui::Render.
void build_gui(App& app);

// Whether the last answer is a steady state; whether the one to the newest request is still to come.
bool converged(const App& app);
bool solving(const App& app);
// What the 3-D view shows. Refers to the app: use before it changes.
ViewFrame view_frame(const App& app);
// What the view beside it shows: the motion alone.
ViewFrame motion_frame(const App& app);
// Whether the motion has a view of its own.
bool motion_beside(const App& app);
// Whether anything moves by itself.
bool in_motion(const App& app);

} // namespace flyball
