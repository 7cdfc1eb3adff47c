#include "robot.hpp"

#include "app/render/imgui_compat.hpp"

#include "app/ui/camera_glide.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <cctype>
#include <cmath>

namespace flyball::test {
namespace {

// Robots come one after the other.
KeptFonts& fonts() {
  static KeptFonts kept;
  return kept;
}

} // namespace

Robot::Robot(PixelSize wanted, const NumberStyle& numbers)
    : Robot(wanted, numbers, LiveSolver::Mode::immediate) {}

Robot::Robot(PixelSize wanted, LiveSolver::Mode solving) : Robot(wanted, NumberStyle(), solving) {}

Robot::Robot(PixelSize wanted, const NumberStyle& numbers, LiveSolver::Mode solving)
    : app({.mode = solving,
           .on_news = {},
           .scenes = FLYBALL_ASSETS "/scenes",
           .theme = Theme::light,
           .numbers = numbers}),
      stage(app.ui, 1, &fonts()), size(wanted) {
  app.view.samples = 1;
  imgui_compat::map_key(ImGuiKey_Enter, key_enter);
  imgui_compat::map_key(ImGuiKey_Escape, key_escape);
  imgui_compat::map_key(ImGuiKey_A, 'A');
  imgui_compat::take_events_at_once();
  open_scene(app.session, shipped_file("governor"));
  frames(3);
}

void Robot::frames(int count, double seconds) {
  for (int i = 0; i < count; ++i)
    stage.frame(app, size, seconds);
}

const WidgetRect& Robot::widget(const std::string& name) {
  const auto found = app.ui.widgets.find(name);
  INFO("widget " << name);
  REQUIRE(found != app.ui.widgets.end());
  return found->second;
}

void Robot::point(ImVec2 at) {
  ImGui::GetIO().MousePos = at;
  frames(1);
}

void Robot::press(int button) {
  ImGui::GetIO().MouseDown[button] = true;
  frames(1);
}

void Robot::release(int button) {
  ImGui::GetIO().MouseDown[button] = false;
  frames(2);
}

void Robot::click(ImVec2 at, int button) {
  point(at);
  press(button);
  release(button);
}

void Robot::click(const std::string& name) {
  click(widget(name).center());
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
  drag(at(from), at(to), button);
}

void Robot::drag(ImVec2 from, ImVec2 to, int button) {
  point(from);
  press(button);
  for (int i = 1; i <= 5; ++i) {
    const float t = static_cast<float>(i) / 5;
    point({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)});
  }
  release(button);
}

void Robot::pull(const std::string& handle, const Vec3& by) {
  const ImVec2 from = widget(handle).center(), to = pixel(by), zero = pixel(Vec3::Zero());
  point(from);
  press();
  for (int i = 1; i <= 4; ++i)
    point({from.x + (to.x - zero.x) * static_cast<float>(i) / 4,
           from.y + (to.y - zero.y) * static_cast<float>(i) / 4});
}

void Robot::wheel(const std::string& name, float notches) {
  point(widget(name).center());
  ImGui::GetIO().MouseWheel = notches;
  frames(2);
}

void Robot::key(int code, bool ctrl, bool shift) {
  imgui_compat::set_modifiers(ctrl, shift);
  imgui_compat::set_key(code, true);
  app.ui.keys.push_back({code, ctrl, shift});
  frames(1);
  imgui_compat::set_modifiers(ctrl_, shift_);
  imgui_compat::set_key(code, false);
  frames(2);
}

void Robot::alt(int code) {
  app.ui.keys.push_back({code, false, false, code != 342});
  frames(3);
}

void Robot::strike(const std::string& text) {
  for (const char c : text) {
    ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(c));
    key(std::toupper(static_cast<unsigned char>(c)));
  }
}

void Robot::hold(bool ctrl, bool shift, bool alt) {
  ctrl_ = ctrl;
  shift_ = shift;
  imgui_compat::set_modifiers(ctrl, shift, alt);
}

ImVec2 Robot::pixel(const Vec3& world) {
  const WidgetRect view = widget("view");
  const ViewSize view_size{static_cast<double>(view.to.x - view.from.x),
                           static_cast<double>(view.to.y - view.from.y)};
  const auto at = app.view.camera.project(world, view_size);
  REQUIRE(at);
  return {view.from.x + static_cast<float>(at->x()), view.from.y + static_cast<float>(at->y())};
}

void Robot::point_at(const Vec3& world) {
  point(pixel(world));
}

void Robot::click_at(const Vec3& world) {
  click(pixel(world));
}

void Robot::begin_empty(double height) {
  open_document(app.session, Document());
  look_from(app.view, 0, 0);
  frames(3);
  app.view.fit = false;
  app.view.camera.target = Vec3::Zero();
  app.view.camera.distance = height / (2 * std::tan(app.view.camera.field_of_view / 2));
  frames(1);
}

void Robot::type(const std::string& text) {
  ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
  frames(1);
}

std::string Robot::copied(const std::string& row) {
  ImGui::SetClipboardText("nothing");
  const WidgetRect at = widget(row);
  const ImVec2 left(at.from.x + 10, at.center().y);
  click(left, 1);
  frames(2);
  click(ImVec2{left.x + 20, left.y + 16});
  frames(2);
  return ImGui::GetClipboardText();
}

Image Robot::picture() {
  Framebuffer target(size.width, size.height, 1);
  stage.render(app.ui, target);
  return target.read();
}

} // namespace flyball::test
