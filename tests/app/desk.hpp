// A robot with a scene open, for the inspector of the scene.
#pragma once

#include "robot.hpp"

#include "engine/mechanism/scene.hpp"
#include "tests/support/scenes.hpp"

#include <string>

namespace flyball::test {

struct Desk : Robot {
  explicit Desk(const std::string& scene = "governor", PixelSize window = {1200, 900}) : Robot(window) {
    open_document(app.session, Document(shipped(scene), shipped_file(scene)));
    frames(3);
  }
  void pick(PartKind kind, const std::string& name) {
    select(app.session, {{{kind, name}}});
    frames(2);
  }
  void build() {
    key(258); // Tab
    frames(3);
  }
  void enter(const std::string& field, const std::string& text) {
    frames(60); // no double click
    click(field);
    type(text);
    key(key_enter);
    frames(2);
  }
  const Mechanism& m() const { return app.session.mechanism(); }
};

} // namespace flyball::test
