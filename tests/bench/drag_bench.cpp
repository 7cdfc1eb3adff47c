// How smoothly the window goes on while the governor's stiffness slider is dragged with its response curve
// open: the interface and everything in the background, without the drawing of pixels, which is the graphics
// card's. What a slider's move costs beside the solve in a net of 10 000 point masses. And what a mouse event
// costs while a body is pulled by hand.
#include "app/render/imgui_compat.hpp"
#include "app/ui/app.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/solve/assembly_drag.hpp"
#include "tests/bench/large_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>
#include <tuple>

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
    open_document(app.session, Document(net));
    app.session.mode = ::flyball::Mode::explore;
    for (int i = 0; i < moves; ++i) {
      while (solving(app.session)) {
        update(app, 0, {600, 400});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      const auto begin = Clock::now();
      change_parameter(app.session, "joints.spin.drive.speed", speed + 1e-3 * (i + 1));
      const double spent = seconds_since(begin);
      update(app, 0, {600, 400});
      if (mode == LiveSolver::Mode::background)
        window.push_back(1e3 * spent);
      else
        beside.push_back(1e3 * (spent - app.session.answer.solution.run_time_s));
    }
  }
  std::ranges::sort(window);
  std::ranges::sort(beside);
  std::printf("\nNet of %d springs, speed moved\n%-34s %8.2f ms\n%-34s %8.2f ms\n", 2 * side * (side + 1),
              "on the window's thread", window[window.size() / 2], "beside the solve, in all",
              beside[beside.size() / 2]);
}

double median(std::vector<double> all) {
  std::ranges::sort(all);
  return all[all.size() / 2];
}

using Frame = std::function<void(double)>;

// The body's mass centre is pulled round a circle on the screen, a mouse event a frame.
void pull_by_hand(App& app, const Frame& frame, const char* title, const Mechanism& m,
                  const std::string& body, ::flyball::Mode mode, bool by_sliders = false) {
  constexpr int events = 60;
  constexpr float radius = 40; // pixels
  const auto b = static_cast<std::size_t>(body_index(m, body));
  open_document(app.session, Document(m));
  set_mode(app.session, mode);
  look_from(app.view, 0, 0);
  const auto settle = [&] {
    frame(1 / wanted);
    while (solving(app.session)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      update(app, 0, {600, 400});
    }
    frame(1 / wanted);
  };
  for (int i = 0; i < 5; ++i) // until the camera has all in view
    settle();
  ImGuiIO& io = ImGui::GetIO();
  const WidgetRect view = app.ui.widgets.at("view");
  const Vec3 at = mode == ::flyball::Mode::build ? m.bodies[b].position : app.session.poses.at(b).position;
  const auto pixel = app.view.camera.project(
      at, {static_cast<double>(view.to.x - view.from.x), static_cast<double>(view.to.y - view.from.y)});
  const ImVec2 from(view.from.x + static_cast<float>(pixel->x()),
                    view.from.y + static_cast<float>(pixel->y()));
  io.MousePos = from;
  imgui_compat::set_modifiers(false, by_sliders, true);
  settle();
  io.MouseDown[0] = true;
  settle();
  std::vector<double> event, shown;
  for (int i = 1; i <= events; ++i) {
    const float angle = 0.1f * static_cast<float>(i);
    io.MousePos = {from.x + radius * std::sin(angle), from.y + radius * (1 - std::cos(angle))};
    const auto begin = Clock::now();
    frame(1 / wanted);
    event.push_back(1e3 * seconds_since(begin));
    while (solving(app.session) || app.session.goals.seeking.running()) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      update(app, 0, {600, 400});
    }
    shown.push_back(1e3 * seconds_since(begin));
  }
  const bool held = app.tool.assembly || app.tool.pull || app.tool.reach;
  io.MouseDown[0] = false;
  imgui_compat::set_modifiers(false, false);
  settle();
  settle();
  std::printf("%-34s %8.2f ms, until it is solved %.2f ms%s\n", title, median(event), median(shown),
              held ? "" : " (nothing was held)");
}

// The same movement without an interface.
void drag_alone(const char* title, const Mechanism& m, const std::string& body) {
  constexpr int events = 60;
  AssemblyDrag drag(m);
  const BodyPoint grabbed{body};
  const Vec3 from = drag.position(grabbed);
  const double radius = 0.05; // m
  std::vector<double> spent;
  for (int i = 1; i <= events; ++i) {
    const Vec3 target = from + radius * Vec3(std::sin(0.1 * i), 1 - std::cos(0.1 * i), 0);
    const auto begin = Clock::now();
    drag.pull(grabbed, {.at = target, .sight = Vec3::UnitZ()});
    spent.push_back(1e3 * seconds_since(begin));
  }
  std::printf("%-34s %8.3f ms\n", title, median(spent));
}

void pull_all(App& app, const Frame& frame) {
  constexpr int links = 100;
  const Mechanism chain = bench::springy_chain(links, 1, 1, 0.1);
  const Mechanism governor = load_scene(FLYBALL_ASSETS "/scenes/governor.json");
  const std::string tip = chain.bodies.back().name;
  std::printf("\nPulled by hand, a mouse event\n");
  drag_alone("governor, along its joints alone", governor, "ball1");
  drag_alone("chain of 100, likewise", chain, tip);
  pull_by_hand(app, frame, "governor while building", governor, "ball2", ::flyball::Mode::build);
  pull_by_hand(app, frame, "chain of 100 while building", chain, tip, ::flyball::Mode::build);
  pull_by_hand(app, frame, "governor while exploring", governor, "ball1", ::flyball::Mode::explore);
  pull_by_hand(app, frame, "chain of 100 while exploring", chain, tip, ::flyball::Mode::explore);
  Mechanism pinned = governor; // speed, spring and a ball, which move so that the collar follows the hand
  pinned.sliders.clear();
  for (const auto& [address, from, to] :
       {std::tuple{"joints.spin.drive.speed", 0., 30.},
        std::tuple{"joints.slide.spring.stiffness", 100., 5000.}, std::tuple{"bodies.ball1.mass", 0.2, 5.}})
    pinned.sliders.push_back({.parameter = address, .from = from, .to = to, .description = {}});
  pull_by_hand(app, frame, "governor's sliders by the collar", pinned, "collar", ::flyball::Mode::explore,
               true);
}

// In ms: from a slider's event to the answer, with a session alone: no window, no pixels.
void move_in_session(const char* name, const Mechanism& mechanism, const std::string& address) {
  constexpr int moves = 25;
  std::vector<double> event, answer;
  Session session({.mode = LiveSolver::Mode::background});
  open_document(session, Document(mechanism));
  session.mode = ::flyball::Mode::explore;
  const auto wait = [&] {
    do {
      update(session, 0);
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    } while (solving(session));
  };
  wait();
  const double start = get_parameter(mechanism, address);
  for (int i = 0; i < moves; ++i) {
    const auto begin = Clock::now();
    change_parameter(session, address, start * (1 + 1e-3 * (i + 1)));
    event.push_back(1e3 * seconds_since(begin));
    wait();
    answer.push_back(1e3 * seconds_since(begin));
  }
  std::ranges::sort(event);
  std::ranges::sort(answer);
  std::printf("%-34s %8.3f ms, answered after %.3f ms\n", name, event[moves / 2], answer[moves / 2]);
}

} // namespace

int main() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {width, height};
  App app({.mode = LiveSolver::Mode::background, .on_news = {}, .scenes = {}, .numbers = {}});
  app.ui.fonts = load_fonts(*io.Fonts, 16, 1);
  io.FontDefault = app.ui.fonts.text;
  io.Fonts->Build();
  open_scene(app.session, FLYBALL_ASSETS "/scenes/governor.json");
  const auto frame = [&](double seconds) {
    update(app, seconds, {600, 400});
    io.DeltaTime = static_cast<float>(seconds);
    ImGui::NewFrame();
    build_gui(app);
    ImGui::Render();
  };
  frame(1 / wanted);
  open_study(app.session, StudyKind::response);
  for (int i = 0; i < 30; ++i) {
    frame(1 / wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  std::vector<double> spent; // s, by frame
  std::size_t late = 0, curves = 0;
  const std::uint64_t first_answer = app.session.answer.ticket;
  std::uint64_t answers = 0, ticket = first_answer;
  auto curve = app.session.study.response.curve.found;
  const auto start = Clock::now();
  auto due = start;
  while (seconds_since(start) < duration) {
    const auto begin = Clock::now();
    change_parameter(app.session, "joints.slide.spring.stiffness",
                     1000 * std::exp(std::sin(3 * seconds_since(start))));
    frame(1 / wanted);
    spent.push_back(seconds_since(begin));
    answers += app.session.answer.ticket != ticket;
    ticket = app.session.answer.ticket;
    curves += app.session.study.response.curve.found != curve;
    curve = app.session.study.response.curve.found;
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
  pull_all(app, frame);
  std::printf("\nA slider's move, a session without a window\n");
  move_in_session("governor, stiffness", load_scene(FLYBALL_ASSETS "/scenes/governor.json"),
                  "joints.slide.spring.stiffness");
  move_in_session("chain of 1000 links, speed", bench::chain(1000, 2), "joints.spin.drive.speed");
  move_in_large_net();
  ImGui::DestroyContext();
}
