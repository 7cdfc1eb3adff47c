#include "app/cli/editor.hpp"

#include "app/cli/assets.hpp"
#include "app/cli/command.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/report_error.hpp"
#include "app/cli/state_folder.hpp"
#include "app/cli/window_keys.hpp"
#include "app/cli/window_state.hpp"
#include "app/panels/file_commands.hpp"
#include "app/panels/snapshot.hpp"
#include "app/panels/ui_style.hpp"
#include "app/render/window.hpp"
#include "engine/mechanism/file.hpp"

#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace flyball::cli {

namespace {

// Frames after the last thing that happened: what ImGui learns from one shows in the next.
constexpr int settling_frames = 6;
constexpr double idle = 3600; // s, to wait for something to happen

// Input from GLFW for the stage's ImGui context.
class Input {
 public:
  explicit Input(const Window& window) { ImGui_ImplGlfw_InitForOpenGL(window.handle(), true); }
  ~Input() { ImGui_ImplGlfw_Shutdown(); }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  // The interface counts in pixels; on some desktops the mouse counts in points. `keys` went down since the
  // last frame: Dear ImGui 1.86 would not see one that is up again by now.
  void read(const Window& window, const std::vector<KeyPress>& keys) {
    ImGui_ImplGlfw_NewFrame();
    hold(window, keys);
    look(keys);
    ImGuiIO& io = ImGui::GetIO();
    const auto points = window.size(), pixels = window.framebuffer_size();
    if (points.width <= 0 || points.width == pixels.width || !ImGui::IsMousePosValid()) return;
    const float ratio = static_cast<float>(pixels.width) / static_cast<float>(points.width);
    io.MousePos = {io.MousePos.x * ratio, io.MousePos.y * ratio};
  }
  // Whether the last read() found anything new.
  bool changed() const { return changed_; }

 private:
  void look(const std::vector<KeyPress>& keys) {
    const ImGuiIO& io = ImGui::GetIO();
    const std::array now{io.MousePos.x, io.MousePos.y, io.MouseDown[0] ? 1.f : 0.f,
                         io.MouseDown[1] ? 1.f : 0.f, io.MouseDown[2] ? 1.f : 0.f};
    changed_ = now != mouse_ || io.MouseWheel != 0 || io.InputQueueCharacters.Size > 0 || !keys.empty();
    mouse_ = now;
  }
  void hold(const Window& window, const std::vector<KeyPress>& keys) {
    ImGuiIO& io = ImGui::GetIO();
    for (const int key : held_)
      io.KeysDown[key] = glfwGetKey(window.handle(), key) == GLFW_PRESS;
    held_.clear();
    for (const KeyPress& press : keys) {
      const bool known = press.key >= GLFW_KEY_SPACE && press.key <= GLFW_KEY_LAST;
      if (!known || io.KeysDown[press.key]) continue;
      io.KeysDown[press.key] = true;
      held_.push_back(press.key);
    }
  }

  std::vector<int> held_; // shown as down for one frame
  std::array<float, 5> mouse_{};
  bool changed_ = false;
};

App& app_of(GLFWwindow* window) {
  return *static_cast<App*>(glfwGetWindowUserPointer(window));
}

void press_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  if (const auto press = pressed_key(key, scancode, action, modifiers)) app_of(window).keys.push_back(*press);
}

void type_character(GLFWwindow* window, unsigned character) {
  if (const auto press = typed_sign(character)) app_of(window).keys.push_back(*press);
}

void drop_file(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) open_file(app_of(window), paths[0]);
}

std::string title_of(const App& app) {
  return (has_unsaved_work(app) ? "● " : "") + document_name(app) + " - Flyball";
}

void open_first(App& app, const std::filesystem::path& scene) {
  if (scene.empty())
    open_scene(app, shipped_scenes() / "governor.json"); // not of the person's choice: not noted as recent
  else
    open_file(app, scene);
  begin_files(app);
}

int run_window(Window& window, const std::filesystem::path& scene, const EditorOptions& options) {
  App app({.mode = LiveSolver::Mode::background,
           .on_news = glfwPostEmptyEvent,
           .scenes = shipped_scenes(),
           .theme = options.dark ? Theme::dark : Theme::light,
           .numbers = {},
           .state = state_folder()});
  const auto scale = [&] { return options.scale.value_or(std::max(window.content_scale(), 1.f)); };
  Stage stage(app, scale());
  stage.draft_while_moving(true);
  ImGui::GetIO().ConfigInputTextCursorBlink = false;
  glfwSetWindowUserPointer(window.handle(), &app);
  glfwSetDropCallback(window.handle(), drop_file);
  glfwSetKeyCallback(window.handle(), press_key); // before ImGui's, which call these in turn
  glfwSetCharCallback(window.handle(), type_character);
  Input input(window);
  open_first(app, scene);

  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  int settling = settling_frames;
  std::string title, state;
  while (!app.quit) {
    const bool waits = settling == 0 && !in_motion(app);
    const double longest =
        waits ? std::min({idle, next_file_update(app), next_notice_change(app), app.tooltip.due}) : 0;
    window.wait_events(longest);
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - last).count();
    last = now;
    const bool help = app.tooltip.due <= elapsed; // is due, and takes a frame more to find its size
    const bool news = update_files(app, elapsed) || help;
    age_notice(app, elapsed);
    // One frame is enough where it was only time to look at the disk.
    settling = waits ? (elapsed < longest || news ? settling_frames : 0) : std::max(settling - 1, 0);
    // Time spent waiting is no time of the motion's.
    const double seconds = waits ? 0 : std::min(elapsed, 0.1);
    app.tooltip.clock += elapsed - seconds; // which passes in the window, moving or not
    if (window.should_close()) {
      window.set_should_close(false);
      quit(app);
      settling = settling_frames;
    }

    const auto pixels = window.framebuffer_size();
    const PixelSize size{pixels.width, pixels.height};
    if (size.width <= 0 || size.height <= 0) {
      settling = 0;
      continue;
    }
    if (app.scale != scale()) stage.set_scale(app, scale());
    input.read(window, app.keys);
    // What comes while the last thing settles has to settle, too.
    if (input.changed()) settling = settling_frames;
    stage.frame(app, size, seconds);
    bind_window_framebuffer(size.width, size.height);
    stage.render(app, size);
    window.swap();
    if (app.export_request) {
      export_picture(app, size);
      settling = settling_frames;
    }
    if (ImGui::IsAnyItemActive() || app.files.gallery.drawing || app.movie.progress || stage.resting())
      settling = std::max(settling, 1);
    if (title_of(app) != title) window.set_title(title = title_of(app));
    if (!options.state_file.empty()) {
      std::string now_shown = window_state(app);
      if (now_shown != state) write_bytes(options.state_file, state = std::move(now_shown));
    }
  }
  return exit_done;
}

int run_without_display(const std::filesystem::path& scene, const EditorOptions& options,
                        const std::string& reason) {
  fmt::print(stderr, "flyball: {}; drawing the interface into a picture instead\n", reason);
  PictureOptions wanted;
  wanted.scale = options.scale.value_or(1.f);
  wanted.width = static_cast<int>(static_cast<float>(options.width) * wanted.scale);
  wanted.height = static_cast<int>(static_cast<float>(options.height) * wanted.scale);
  wanted.interface = true;
  wanted.theme = options.dark ? Theme::dark : Theme::light;
  const Picture picture = draw_picture(scene, wanted);
  const std::filesystem::path file =
      std::filesystem::current_path() / ("flyball-" + scene.stem().string() + ".png");
  write_png(file, picture.image);
  fmt::print("{}\n", file.string());
  if (picture.answer.solution.status == Status::converged) return exit_done;
  report_error(scene.string() + ": " + picture.answer.error.value_or(picture.answer.solution.message));
  return exit_no_result;
}

} // namespace

int run_editor(const std::filesystem::path& scene, const EditorOptions& options) {
  std::string reason;
  std::optional<Window> window;
  if (display_available(&reason)) {
    try {
      window.emplace("Flyball", options.width, options.height);
    } catch (const GlError& error) {
      reason = error.what();
    }
  }
  if (window) return run_window(*window, scene, options);
  return run_without_display(scene.empty() ? shipped_scenes() / "governor.json" : scene, options, reason);
}

} // namespace flyball::cli
