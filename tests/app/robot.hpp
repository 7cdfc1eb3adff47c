// A hand at the interface: points at widgets by name and presses, one change of input a frame, as Dear ImGui
// 1.86 needs it. Frames are those of the program; they are drawn, off-screen, where a picture is asked for.
#pragma once

#include "app/render/offscreen.hpp"
#include "app/ui/app.hpp"
#include "app/ui/stage.hpp"

#include <string>

namespace flyball::test {

class Robot {
 public:
  explicit Robot(PixelSize size = {900, 600}, const NumberStyle& numbers = {});
  // In the background it solves as the program does, while frames go on.
  Robot(PixelSize size, LiveSolver::Mode solving);

  OffscreenContext context;
  App app;
  Stage stage;
  PixelSize size;

  void frames(int count, double seconds = 0.01);
  const WidgetRect& widget(const std::string& name);
  void point(ImVec2 at);
  void press(int button = 0);
  void release(int button = 0);
  void click(ImVec2 at, int button = 0);
  void click(const std::string& name);
  void double_click(const std::string& name);
  // From one place of the widget to another, both as shares of its size.
  void drag(const std::string& name, ImVec2 from, ImVec2 to, int button = 0);
  void drag(ImVec2 from, ImVec2 to, int button = 0); // pixels of the window
  // A handle in the view by so much of the world, with the button still down.
  void pull(const std::string& handle, const Vec3& by);
  void wheel(const std::string& name, float notches);
  // A key by its GLFW code, which for letters is ASCII.
  void key(int code, bool ctrl = false, bool shift = false);
  void alt(int code = 342);                           // a letter together with Alt, or Alt alone
  void strike(const std::string& text);               // each key also as a character, as a person types
  void hold(bool ctrl, bool shift, bool alt = false); // from now on

  // Places of the mechanism, in the 3-D view as its camera stands.
  ImVec2 pixel(const Vec3& world);
  void point_at(const Vec3& world);
  void click_at(const Vec3& world);
  // An empty document, looked at from the front, `height` (m) of it in view around the origin.
  void begin_empty(double height);
  void type(const std::string& text);
  // What the only entry of the row's menu, by a right click near its left end, puts on the clipboard.
  std::string copied(const std::string& row);
  Image picture();

 private:
  Robot(PixelSize size, const NumberStyle& numbers, LiveSolver::Mode solving);

  bool ctrl_ = false, shift_ = false; // held
};

inline constexpr int key_enter = 257, key_escape = 256;

} // namespace flyball::test
