#include "app/cli/editor.hpp"

#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/report_error.hpp"
#include "app/cli/state_folder.hpp"
#include "app/cli/window_input.hpp"
#include "app/cli/window_state.hpp"
#include "app/platform/data_folder.hpp"
#include "app/platform/end_signals.hpp"
#include "app/platform/system_colors.hpp"
#include "app/render/imgui_compat.hpp"
#include "app/render/window.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/snapshot.hpp"
#include "app/ui/widgets/ui_style.hpp"
#include "engine/mechanism/file.hpp"

#include <backends/imgui_impl_glfw.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace flyball::cli {

namespace {

// Frames after the last thing that happened: what ImGui learns from one shows in the next.
constexpr int settling_frames = 6;
constexpr double idle = 3600;     // s, to wait for something to happen
constexpr double still = 1. / 60; // s, after a frame that showed nothing new: no display holds up the next

// What GLFW's callbacks find at the window.
struct Desk {
  App* app;
  WindowInput* input;
  std::atomic<bool>* stirred; // something has happened that may show: set from any thread
  SystemColors* colors = nullptr;
  std::optional<std::filesystem::path> dropped{}; // to be opened once the keys before it were seen
  bool uncovered = true;                          // what was drawn may be gone
};

Desk& desk_of(GLFWwindow* window) {
  return *static_cast<Desk*>(glfwGetWindowUserPointer(window));
}

// A callback that takes note of the event and nothing else.
template <class... Arguments>
void stir(GLFWwindow* window, Arguments...) {
  *desk_of(window).stirred = true;
}

template <class... Arguments>
void uncover(GLFWwindow* window, Arguments...) {
  stir(window);
  desk_of(window).uncovered = true;
}

void press_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  stir(window);
  desk_of(window).input->note({.kind = WindowEvent::Kind::key,
                               .code = key,
                               .scancode = scancode,
                               .action = action,
                               .modifiers = modifiers});
}

void type_character(GLFWwindow* window, unsigned character) {
  stir(window);
  desk_of(window).input->note({.kind = WindowEvent::Kind::character, .character = character});
}

void press_button(GLFWwindow* window, int button, int action, int modifiers) {
  stir(window);
  desk_of(window).input->note(
      {.kind = WindowEvent::Kind::button, .code = button, .action = action, .modifiers = modifiers});
}

void turn_wheel(GLFWwindow* window, double x, double y) {
  stir(window);
  ImGui_ImplGlfw_ScrollCallback(window, x, y);
}

void move_cursor(GLFWwindow* window, double x, double y) {
  stir(window);
  desk_of(window).input->move_to(x, y);
}

void enter_window(GLFWwindow* window, int entered) {
  stir(window);
  ImGui_ImplGlfw_CursorEnterCallback(window, entered);
  if (!entered) desk_of(window).input->leave();
}

// It may have been night, or the settings, that came meanwhile.
void focus_window(GLFWwindow* window, int focused) {
  stir(window);
  ImGui_ImplGlfw_WindowFocusCallback(window, focused);
  if (focused && desk_of(window).colors) desk_of(window).colors->ask();
}

void drop_file(GLFWwindow* window, int count, const char** paths) {
  stir(window);
  if (count > 0) desk_of(window).dropped = paths[0];
}

// Those that Dear ImGui's backend would set, too, which are called from these.
void set_callbacks(GLFWwindow* window, Desk& desk) {
  glfwSetWindowUserPointer(window, &desk);
  glfwSetDropCallback(window, drop_file);
  glfwSetKeyCallback(window, press_key);
  glfwSetCharCallback(window, type_character);
  glfwSetCursorPosCallback(window, move_cursor);
  glfwSetCursorEnterCallback(window, enter_window);
  glfwSetMouseButtonCallback(window, press_button);
  glfwSetScrollCallback(window, turn_wheel);
  glfwSetWindowFocusCallback(window, focus_window);
  glfwSetWindowCloseCallback(window, stir);
  glfwSetWindowSizeCallback(window, uncover);
  glfwSetWindowRefreshCallback(window, uncover);
  glfwSetWindowIconifyCallback(window, uncover);
  glfwSetWindowContentScaleCallback(window, uncover);
  glfwSetFramebufferSizeCallback(window, uncover);
}

Theme theme_of(DesktopColors colors) {
  switch (colors) {
  case DesktopColors::light: return Theme::light;
  case DesktopColors::dark: return Theme::dark;
  case DesktopColors::high_contrast: break;
  }
  return Theme::high_contrast;
}

std::string title_of(const App& app) {
  return (has_unsaved_work(app.session) ? "● " : "") + document_name(app.session) + " - Flyball";
}

void open_first(App& app, const std::filesystem::path& scene) {
  if (scene.empty())
    open_scene(app.session,
               data_folder() / "scenes" / "governor.json"); // not of the person's choice: not noted as recent
  else
    open_file(app, scene);
  begin_files(app.session, app.dialog, !scene.empty());
}

// What the window shows, for tests outside the program.
class ShownState {
 public:
  explicit ShownState(std::filesystem::path file) : file_(std::move(file)) {}
  void tell(const App& app) {
    if (file_.empty()) return;
    std::string now = window_state(app);
    if (now != told_) write_bytes(file_, told_ = std::move(now));
  }

 private:
  std::filesystem::path file_;
  std::string told_;
};

// Frames until all that was done at the window has been seen, of which the last is to be drawn. Whether
// anything was new.
bool take_input(WindowInput& input, App& app, Stage& stage, PixelSize size, double seconds) {
  input.read(app.ui.keys);
  bool changed = input.changed();
  stage.frame(app, size, seconds);
  while (input.pending() && !app.quit && !app.export_request) {
    for (int i = 1; i < WindowInput::frames_each; ++i) {
      input.rest();
      stage.frame(app, size, 0, true);
    }
    input.read(app.ui.keys);
    changed = true;
    stage.frame(app, size, 0, true);
  }
  if (stage.behind(app, size)) {
    input.rest();
    stage.frame(app, size, 0, true);
  }
  return changed;
}

// Pixels a point: as the display or the command line has it, times what the person has chosen.
float window_scale(const Window& window, const App& app, const EditorOptions& options) {
  return options.scale.value_or(std::max(window.content_scale(), 1.f)) * static_cast<float>(app.ui.zoom);
}

// Until the person quits or `ends` says so.
void run_loop(Window& window, App& app, Stage& stage, WindowInput& input, Desk& desk,
              const EditorOptions& options, SystemColors& colors, std::atomic<bool>& stirred,
              const std::function<bool()>& ends) {
  const auto scale = [&] { return window_scale(window, app, options); };
  ShownState shown(options.state_file);
  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  int settling = settling_frames;
  bool drew = true; // the last frame
  std::string title;
  while (!app.quit && !ends()) {
    // A film is drawn all the same.
    const bool hidden = !app.movie.progress && !window.visible();
    const bool waits = hidden || (settling == 0 && !in_motion(app.session, app.view));
    const double longest =
        waits
            ? std::min({idle, next_file_update(app.session), next_notice_change(app.session, app.notice_age),
                        app.ui.tooltip.due, next_progress(app)})
        : drew ? 0
               : still;
    window.wait_events(longest);
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - last).count();
    last = now;
    const bool help = app.ui.tooltip.due <= elapsed; // is due, and takes a frame more to find its size
    const bool fades = next_notice_change(app.session, app.notice_age) <= elapsed;
    if (const auto found = colors.take()) take_system_theme(app.ui, theme_of(*found));
    const bool news = update_files(app.session, elapsed) || help || fades;
    age_notice(app.session, app.notice_age, elapsed);
    const bool something = stirred.exchange(false) || news || (hidden && window.visible());
    // Otherwise it was only time to look at the disk.
    settling = something ? settling_frames : std::max(settling - 1, 0);
    // What moves but a number asks for one frame.
    if (waits && elapsed >= next_progress(app)) settling = std::max(settling, 1);
    // Time spent waiting is no time of the motion's.
    const double seconds = waits ? 0 : std::min(elapsed, 0.1);
    app.ui.tooltip.clock += elapsed - seconds; // which passes in the window, moving or not
    const bool closes = window.should_close();
    if (closes) {
      window.set_should_close(false);
      settling = settling_frames;
    }

    const auto pixels = window.framebuffer_size();
    const PixelSize size{pixels.width, pixels.height};
    if (size.width <= 0 || size.height <= 0) settling = 0;
    if (size.width <= 0 || size.height <= 0 || hidden || (waits && settling == 0)) {
      if (closes) quit(app);
      shown.tell(app);
      continue;
    }
    if (app.ui.scale != scale()) stage.set_scale(app.ui, scale());
    // What comes while the last thing settles has to settle, too.
    if (take_input(input, app, stage, size, seconds)) settling = settling_frames;
    // After what was typed before.
    if (const auto dropped = std::exchange(desk.dropped, std::nullopt)) open_file(app, *dropped);
    if (closes) quit(app);
    if (!app.quit) note_unsaved_work(app.session);
    const bool uncovered = std::exchange(desk.uncovered, false);
    drew = stage.has_news() || uncovered;
    if (drew) {
      stage.render(app.ui, size);
      window.swap();
    }
    if (app.export_request) {
      export_picture(app, size);
      settling = settling_frames;
    }
    if (ImGui::IsAnyItemActive() || app.panels->gallery.drawing || app.movie.progress || stage.resting() ||
        app.ui.slider_press.place)
      settling = std::max(settling, 1);
    if (title_of(app) != title) window.set_title(title = title_of(app));
    shown.tell(app);
  }
}

// For one who finds the window gone.
void tell_kept(const std::string& problem, const AutosaveSlot& slot) {
  if (!problem.empty())
    report_error("unsaved work could not be kept: " + problem);
  else if (!slot.path().empty())
    report_error("unsaved work is kept in " + slot.path().string() + " and offered at the next start");
}

// Keeps unsaved work when the display goes, for as long as it lives.
class LostDisplay {
 public:
  explicit LostDisplay(std::shared_ptr<AutosaveSlot> slot) {
    on_lost_display([slot = std::move(slot)] {
      report_error("the display is gone");
      tell_kept(slot->write(), *slot);
    });
  }
  ~LostDisplay() { on_lost_display({}); }
  LostDisplay(const LostDisplay&) = delete;
  LostDisplay& operator=(const LostDisplay&) = delete;
};

Ending run_window(Window& window, const std::filesystem::path& scene, const EditorOptions& options) {
  // These two last longer than the app, of which the end may take its time.
  std::optional<LostDisplay> lost_display;
  std::optional<EndSignals> signals;
  // Shared, as a computation that was given up may still tell its news after the window has gone.
  const auto stirred = std::make_shared<std::atomic<bool>>(true);
  App app({.mode = LiveSolver::Mode::background,
           .on_news =
               [stirred] {
                 *stirred = true;
                 glfwPostEmptyEvent();
               },
           .scenes = data_folder() / "scenes",
           .theme = Theme::light,
           .numbers = {},
           .animated = true,
           .state = state_folder(),
           .theme_choice = options.theme});
  app.session.files.changes = ChangeWatch(glfwPostEmptyEvent);
  Stage stage(app.ui, window_scale(window, app, options));
  stage.draft_while_moving(true);
  ImGui::GetIO().ConfigInputTextCursorBlink = false;
  SystemColors colors([stirred] {
    *stirred = true;
    glfwPostEmptyEvent();
  });
  colors.ask();
  WindowInput input(window);
  Desk desk{.app = &app, .input = &input, .stirred = stirred.get(), .colors = &colors};
  set_callbacks(window.handle(), desk);
  open_first(app, scene);
  const std::shared_ptr<AutosaveSlot> slot = app.session.files.autosave.slot();
  lost_display.emplace(slot);
  signals.emplace(glfwPostEmptyEvent, [slot] { tell_kept(slot->write(), *slot); });
  try {
    run_loop(window, app, stage, input, desk, options, colors, *stirred,
             [&] { return signals->came() != 0; });
  } catch (...) {
    tell_kept(keep_unsaved_work(app.session), *slot);
    throw;
  }
  if (!app.quit) tell_kept(keep_unsaved_work(app.session), *slot);
  keep_beside_now(app.session);
  return {};
}

Ending run_without_display(const std::filesystem::path& scene, const EditorOptions& options,
                           const std::string& reason) {
  report_error(reason + "; drawing the interface into a picture instead");
  PictureOptions wanted;
  wanted.scale = options.scale.value_or(1.f);
  wanted.width = static_cast<int>(static_cast<float>(options.width) * wanted.scale);
  wanted.height = static_cast<int>(static_cast<float>(options.height) * wanted.scale);
  wanted.interface = true;
  const ThemeChoice theme = options.theme.value_or(ThemeChoice::light);
  wanted.theme = theme_of(theme, Theme::light);
  const Picture picture = draw_picture(scene, wanted);
  const std::filesystem::path file =
      std::filesystem::current_path() / ("flyball-" + scene.stem().string() + ".png");
  write_png(file, picture.image);
  print_text(file.string() + "\n");
  return end_with(picture.answer.solution.status == Status::converged, scene,
                  picture.answer.error ? picture.answer.error->what() : picture.answer.solution.message);
}

} // namespace

Ending run_editor(const std::filesystem::path& scene, const EditorOptions& options) {
  std::string reason;
  std::optional<Window> window;
  try { // once: a bare X server starts anew when its last client has gone
    window.emplace("Flyball", options.width, options.height);
  } catch (const GlError& error) {
    reason = error.what();
  }
  if (window) return run_window(*window, scene, options);
  return run_without_display(scene.empty() ? data_folder() / "scenes" / "governor.json" : scene, options,
                             reason);
}

} // namespace flyball::cli
