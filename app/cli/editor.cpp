#include "app/cli/editor.hpp"

#include "app/cli/assets.hpp"
#include "app/cli/command.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/report_error.hpp"
#include "app/cli/window_state.hpp"
#include "app/panels/snapshot.hpp"
#include "app/panels/ui_style.hpp"
#include "app/render/window.hpp"
#include "engine/mechanism/file.hpp"

#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <chrono>

namespace flyball::cli {

namespace {

// Frames after the last thing that happened: what ImGui learns from one shows in the next.
constexpr int settling_frames = 3;
constexpr double idle = 3600; // s, to wait for something to happen

// Input from GLFW for the stage's ImGui context.
class Input {
 public:
  explicit Input(const Window& window) { ImGui_ImplGlfw_InitForOpenGL(window.handle(), true); }
  ~Input() { ImGui_ImplGlfw_Shutdown(); }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  // The interface counts in pixels; on some desktops the mouse counts in points.
  void read(const Window& window) {
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    const auto points = window.size(), pixels = window.framebuffer_size();
    if (points.width <= 0 || points.width == pixels.width || !ImGui::IsMousePosValid()) return;
    const float ratio = static_cast<float>(pixels.width) / static_cast<float>(points.width);
    io.MousePos = {io.MousePos.x * ratio, io.MousePos.y * ratio};
  }
};

App& app_of(GLFWwindow* window) {
  return *static_cast<App*>(glfwGetWindowUserPointer(window));
}

void press_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  if (action != GLFW_PRESS) return;
  const bool ctrl = modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER);
  const char* name = key == GLFW_KEY_SPACE ? " " : glfwGetKeyName(key, scancode);
  if (!name || name[0] == 0 || name[1] != 0) return;
  app_of(window).keys.push_back({static_cast<char>(std::toupper(static_cast<unsigned char>(name[0]))), ctrl});
}

void drop_file(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) open_scene(app_of(window), paths[0]);
}

std::string title_of(const App& app) {
  return app.open ? app.mechanism.name + " - Flyball" : "Flyball";
}

int run_window(Window& window, const std::filesystem::path& scene, const EditorOptions& options) {
  App app({.mode = LiveSolver::Mode::background,
           .on_news = glfwPostEmptyEvent,
           .scenes = shipped_scenes(),
           .theme = options.dark ? Theme::dark : Theme::light,
           .numbers = {}});
  const auto scale = [&] { return options.scale.value_or(std::max(window.content_scale(), 1.f)); };
  Stage stage(app, scale());
  ImGui::GetIO().ConfigInputTextCursorBlink = false;
  glfwSetWindowUserPointer(window.handle(), &app);
  glfwSetDropCallback(window.handle(), drop_file);
  glfwSetKeyCallback(window.handle(), press_key); // before ImGui's, which calls it in turn
  Input input(window);
  open_scene(app, scene);

  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  int settling = settling_frames;
  std::string title, state;
  while (!app.quit && !window.should_close()) {
    const bool waits = settling == 0 && !in_motion(app);
    window.wait_events(waits ? idle : 0);
    settling = waits ? settling_frames : std::max(settling - 1, 0);
    const auto now = Clock::now();
    // Time spent waiting is no time of the motion's.
    const double seconds = waits ? 0 : std::min(std::chrono::duration<double>(now - last).count(), 0.1);
    last = now;

    const auto pixels = window.framebuffer_size();
    const PixelSize size{pixels.width, pixels.height};
    if (size.width <= 0 || size.height <= 0) {
      settling = 0;
      continue;
    }
    if (app.scale != scale()) stage.set_scale(app, scale());
    input.read(window);
    stage.frame(app, size, seconds);
    bind_window_framebuffer(size.width, size.height);
    stage.render(app, size);
    window.swap();
    if (app.export_request) {
      export_picture(app, size);
      settling = settling_frames;
    }
    if (ImGui::IsAnyItemActive()) settling = std::max(settling, 1);
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
  const std::filesystem::path file = scene.empty() ? shipped_scenes() / "governor.json" : scene;
  std::string reason;
  std::optional<Window> window;
  if (display_available(&reason)) {
    try {
      window.emplace("Flyball", options.width, options.height);
    } catch (const GlError& error) {
      reason = error.what();
    }
  }
  return window ? run_window(*window, file, options) : run_without_display(file, options, reason);
}

} // namespace flyball::cli
