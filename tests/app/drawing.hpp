// A hand that draws in the 3-D view.
#pragma once

#include "robot.hpp"

#include "app/document/create.hpp"

namespace flyball::test {

// One metre in view: the grid's step is 0.05 m.
struct Drawing : Robot {
  explicit Drawing(PixelSize in = {900, 600}) : Robot(in) { begin_empty(1); }

  const Mechanism& m() const { return app.session.mechanism(); }
  std::size_t steps() const { return app.session.document.position(); }
  std::string last_step() const { return app.session.document.steps()[app.session.document.position()].name; }
  // A ball drawn before the test begins, selected.
  void have_ball(const Vec3& at, double radius = 0.05) {
    ++app.session.gesture;
    edit(app.session, "Add ball", [&](Mechanism& next, Selection& selection) {
      selection.set({PartKind::body, add_body(next, {.at = at, .radius = radius})});
    });
    frames(2);
  }
  void have_rod(const Vec3& from, const Vec3& to) {
    ++app.session.gesture;
    edit(app.session, "Add rod", [&](Mechanism& next, Selection& selection) {
      selection.set(
          {PartKind::body, add_body(next, {.form = BodyForm::rod, .radius = 0.01, .from = from, .to = to})});
    });
    frames(2);
  }
  void choose_nothing() {
    select(app.session, {});
    frames(1);
  }
};

inline Part body_part(const std::string& name) {
  return {PartKind::body, name};
}

} // namespace flyball::test
