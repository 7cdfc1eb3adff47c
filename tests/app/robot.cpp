#include "robot.hpp"

#include "tests/catch.hpp"

namespace flyball::test {

Robot::Robot(PixelSize wanted)
    : app({.mode = LiveSolver::Mode::immediate,
           .on_news = {},
           .scenes = FLYBALL_ASSETS "/scenes",
           .theme = Theme::light,
           .numbers = {}}),
      stage(app, 1), size(wanted) {
  app.view.samples = 1;
  ImGuiIO& io = ImGui::GetIO();
  io.KeyMap[ImGuiKey_Enter] = key_enter;
  io.KeyMap[ImGuiKey_Escape] = key_escape;
  io.KeyMap[ImGuiKey_A] = 'A';
  open_scene(app, FLYBALL_ASSETS "/scenes/governor.json");
  frames(3);
}

void Robot::frames(int count, double seconds) {
  for (int i = 0; i < count; ++i)
    stage.frame(app, size, seconds);
}

const WidgetRect& Robot::widget(const std::string& name) {
  const auto found = app.widgets.find(name);
  INFO("widget " << name);
  REQUIRE(found != app.widgets.end());
  return found->second;
}

void Robot::point(ImVec2 at) {
  ImGui::GetIO().MousePos = at;
  frames(1);
}

void Robot::click(const std::string& name) {
  point(widget(name).center());
  ImGui::GetIO().MouseDown[0] = true;
  frames(1);
  ImGui::GetIO().MouseDown[0] = false;
  frames(2);
}

void Robot::double_click(const std::string& name) {
  point(widget(name).center());
  for (int i = 0; i < 4; ++i) {
    ImGui::GetIO().MouseDown[0] = i % 2 == 0;
    frames(1);
  }
  frames(1);
}

void Robot::drag(const std::string& name, ImVec2 from, ImVec2 to, int button) {
  const WidgetRect rect = widget(name);
  const auto at = [&](ImVec2 share) {
    return ImVec2(rect.from.x + share.x * (rect.to.x - rect.from.x),
                  rect.from.y + share.y * (rect.to.y - rect.from.y));
  };
  point(at(from));
  ImGui::GetIO().MouseDown[button] = true;
  frames(1);
  for (int i = 1; i <= 5; ++i) {
    const float t = static_cast<float>(i) / 5;
    point(at({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}));
  }
  ImGui::GetIO().MouseDown[button] = false;
  frames(2);
}

void Robot::wheel(const std::string& name, float notches) {
  point(widget(name).center());
  ImGui::GetIO().MouseWheel = notches;
  frames(2);
}

void Robot::key(int code, bool ctrl) {
  ImGuiIO& io = ImGui::GetIO();
  io.KeyCtrl = ctrl;
  io.KeysDown[code] = true;
  if (code < 128) app.keys.push_back({static_cast<char>(code), ctrl});
  frames(1);
  io.KeyCtrl = false;
  io.KeysDown[code] = false;
  frames(2);
}

void Robot::type(const std::string& text) {
  ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
  frames(1);
}

Image Robot::picture() {
  Framebuffer target(size.width, size.height, 1);
  target.bind();
  stage.render(app, size);
  return target.read();
}

} // namespace flyball::test
