// A hand at the outline and the inspector.
#pragma once

#include "robot.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/layout.hpp"
#include "tests/catch.hpp"

#include <functional>

namespace flyball::test {

inline constexpr PixelSize window{1280, 900};
inline constexpr int key_tab = 258, key_up = 265, key_f2 = 291;

// In a window, with a scene open and being built.
struct Hand : Robot {
  explicit Hand(PixelSize in = window) : Robot(in) {
    imgui_compat::map_key(ImGuiKey_Tab, key_tab);
    imgui_compat::map_key(ImGuiKey_UpArrow, key_up);
    app.sizes.inspector_share = 0.85f;
    set_mode(app.session, Mode::build);
    frames(2);
  }

  const Mechanism& mechanism() const { return app.session.mechanism(); }
  const Body& body(const char* name) const {
    return mechanism().bodies.at(static_cast<std::size_t>(body_index(mechanism(), name)));
  }
  const Joint& joint(const char* name) const {
    return mechanism().joints.at(static_cast<std::size_t>(joint_index(mechanism(), name)));
  }
  const Force& force(const char* name) const {
    return mechanism().forces.at(static_cast<std::size_t>(force_index(mechanism(), name)));
  }

  void choose(PartKind kind, const char* name) {
    select(app.session, {{{kind, name}}});
    frames(2);
  }
  // Scrolls the inspector until all of the widget can be seen.
  void reveal(const std::string& name) {
    const PanelRect panel =
        layout_of(app, static_cast<float>(size.width), static_cast<float>(size.height)).inspector;
    const auto seen = [&] {
      const auto found = app.ui.widgets.find(name);
      return found != app.ui.widgets.end() && found->second.to.y - found->second.from.y >= 16;
    };
    for (const float notches : {20.f, -1.f})
      for (int i = 0; i < 40 && !seen(); ++i) {
        point({panel.x + 4, panel.y + panel.height / 2});
        ImGui::GetIO().MouseWheel = notches;
        frames(2);
      }
  }
  void press_widget(const std::string& name) {
    if (name.starts_with("inspector/")) reveal(name);
    click(name);
  }
  void fill(const std::string& field, const std::string& text) {
    press_widget(field);
    type(text);
    key(key_enter);
  }
  void choose_from(const std::string& list, const std::string& item) {
    press_widget(list);
    click(list + "/" + item);
  }
  std::string last_step() const { return app.session.document.steps()[app.session.document.position()].name; }
  // What `act` does is one step, and undoing it leaves nothing behind.
  void one_step(const std::function<void()>& act) {
    const Mechanism before = mechanism();
    const std::size_t position = app.session.document.position();
    act();
    REQUIRE(app.session.document.position() == position + 1);
    const Mechanism after = mechanism();
    undo(app.session);
    frames(2);
    CHECK(mechanism() == before);
    redo(app.session);
    frames(2);
    CHECK(mechanism() == after);
  }
};

} // namespace flyball::test
