// How smoothly the window goes on while the governor's stiffness slider is dragged with its response curve
// open: the interface and everything in the background, without the drawing of pixels, which is the graphics
// card's. And what a slider's move costs beside the solve in a net of 10 000 point masses.
#include "app/ui/panels.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "tests/bench/large_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

using namespace flyball;

namespace {

using Clock = std::chrono::steady_clock;

constexpr double wanted = 60;               // frames a second, as displays show them
constexpr double duration = 5;              // s
constexpr float width = 1280, height = 800; // pixels

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// In ms: what a move of the drive's slider takes on the thread of the window, and everything until the answer
// is there but for the solve, which Solution::run_time_s tells.
void move_in_large_net() {
  constexpr int moves = 12, side = 100;
  constexpr double speed = 3; // rad/s
  std::vector<double> window, beside;
  Mechanism net = bench::spring_net(side, speed);
  net.sliders = {{.parameter = "joints.spin.drive.speed", .from = 0, .to = 2 * speed, .description = {}}};
  for (const LiveSolver::Mode mode : {LiveSolver::Mode::background, LiveSolver::Mode::immediate}) {
    App app({.mode = mode, .on_news = {}, .scenes = {}, .numbers = {}});
    open_document(app, Document(net));
    app.mode = ::flyball::Mode::explore;
    for (int i = 0; i < moves; ++i) {
      while (solving(app)) {
        update(app, 0, {600, 400});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      const auto begin = Clock::now();
      change_parameter(app, "joints.spin.drive.speed", speed + 1e-3 * (i + 1));
      const double spent = seconds_since(begin);
      update(app, 0, {600, 400});
      if (mode == LiveSolver::Mode::background)
        window.push_back(1e3 * spent);
      else
        beside.push_back(1e3 * (spent - app.answer.solution.run_time_s));
    }
  }
  std::ranges::sort(window);
  std::ranges::sort(beside);
  std::printf("\nNet of %d springs, speed moved\n%-34s %8.2f ms\n%-34s %8.2f ms\n", 2 * side * (side + 1),
              "on the window's thread", window[window.size() / 2], "beside the solve, in all",
              beside[beside.size() / 2]);
}

} // namespace

int main() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {width, height};
  App app({.mode = LiveSolver::Mode::background, .on_news = {}, .scenes = {}, .numbers = {}});
  app.fonts = load_fonts(*io.Fonts, 16, 1);
  io.FontDefault = app.fonts.text;
  io.Fonts->Build();
  open_scene(app, FLYBALL_ASSETS "/scenes/governor.json");
  const auto frame = [&](double seconds) {
    update(app, seconds, {600, 400});
    io.DeltaTime = static_cast<float>(seconds);
    ImGui::NewFrame();
    build_gui(app);
    ImGui::Render();
  };
  frame(1 / wanted);
  open_study(app, Study::response);
  for (int i = 0; i < 30; ++i) {
    frame(1 / wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  std::vector<double> spent; // s, by frame
  std::size_t late = 0, curves = 0;
  const std::uint64_t first_answer = app.answer.ticket;
  std::uint64_t answers = 0, ticket = first_answer, version = app.study.response.version;
  const auto start = Clock::now();
  auto due = start;
  while (seconds_since(start) < duration) {
    const auto begin = Clock::now();
    change_parameter(app, "joints.slide.spring.stiffness",
                     1000 * std::exp(std::sin(3 * seconds_since(start))));
    frame(1 / wanted);
    spent.push_back(seconds_since(begin));
    answers += app.answer.ticket != ticket;
    ticket = app.answer.ticket;
    curves += app.study.response.version != version;
    version = app.study.response.version;
    due += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / wanted));
    if (Clock::now() > due) {
      ++late;
      due = Clock::now();
    }
    std::this_thread::sleep_until(due);
  }
  std::ranges::sort(spent);
  const auto at = [&](double share) {
    return 1e3 * spent[static_cast<std::size_t>(share * static_cast<double>(spent.size() - 1))];
  };
  std::printf("Governor, stiffness dragged, response curve open\n"
              "%-34s %8.1f of %.0f a second, %zu late\n%-34s %8.2f ms, 99 %% below %.2f ms\n"
              "%-34s %8.1f a second\n%-34s %8.1f a second\n",
              "frames", static_cast<double>(spent.size()) / duration, wanted, late, "interface, a frame",
              at(0.5), at(0.99), "curves shown anew", static_cast<double>(curves) / duration,
              "solutions shown anew", static_cast<double>(answers) / duration);
  move_in_large_net();
  ImGui::DestroyContext();
}
