// How smoothly the window goes on while the governor's stiffness slider is dragged with its response curve
// open: the interface and everything in the background, without the drawing of pixels, which is the graphics
// card's.
#include "app/panels/panels.hpp"
#include "app/panels/study_panels.hpp"

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
  ImGui::DestroyContext();
}
