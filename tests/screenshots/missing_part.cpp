// The tolerance must not hide what matters: a missing part fails the comparison.
#include "stored_picture.hpp"

#include "app/render/offscreen.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

// The governor's view, drawn with a change that leaves camera and poses alone.
template <class Change>
Image changed_governor(const Change& change) {
  App app(steady_options());
  app.view.samples = 1;
  open_scene(app.session, FLYBALL_ASSETS "/scenes/governor.json");
  update(app, 0, {view_size.width, view_size.height}); // places the camera
  ViewFrame frame = view_frame(app.session, app.ui, app.tool, app.view);
  Mechanism mechanism = *frame.mechanism;
  std::vector<Pose> poses(frame.poses.begin(), frame.poses.end()),
      ghost(frame.ghost.begin(), frame.ghost.end());
  change(mechanism, poses, ghost, frame);
  frame.mechanism = &mechanism;
  frame.poses = poses;
  frame.ghost = ghost;
  ViewRenderer renderer;
  Framebuffer target(view_size.width, view_size.height, 1);
  renderer.draw(frame, target);
  return target.read();
}

} // namespace

TEST_CASE("a missing part is seen, and nothing else is", "[egl]") {
  const OffscreenContext context;
  const Image stored = stored_picture("governor-view");
  const auto unchanged = [](auto&...) {};
  CHECK(compare(stored, changed_governor(unchanged)).same);

  SECTION("a body") {
    const Image image = changed_governor([](Mechanism& m, auto& poses, auto& ghost, ViewFrame&) {
      const int collar = body_index(m, "collar");
      REQUIRE(collar >= 0);
      std::erase_if(m.joints,
                    [](const Joint& j) { return j.bodies[0] == "collar" || j.bodies[1] == "collar"; });
      m.bodies.erase(m.bodies.begin() + collar);
      poses.erase(poses.begin() + collar);
      ghost.erase(ghost.begin() + collar);
    });
    CHECK_FALSE(compare(stored, image).same);
  }
  SECTION("the arrow of the drive") {
    const Image image =
        changed_governor([](auto&, auto&, auto&, ViewFrame& frame) { frame.options.drives = false; });
    CHECK_FALSE(compare(stored, image).same);
  }
  SECTION("the signs of the joints") {
    const Image image =
        changed_governor([](auto&, auto&, auto&, ViewFrame& frame) { frame.options.joints = false; });
    CHECK_FALSE(compare(stored, image).same);
  }
  SECTION("the ghost") {
    const Image image = changed_governor([](auto&, auto&, auto& ghost, ViewFrame&) { ghost.clear(); });
    CHECK_FALSE(compare(stored, image).same);
  }
}

TEST_CASE("where letters differ other states of the interface are told apart") {
  for (const auto& [one, other] : {std::pair{"no-steady-state", "pendulum-interface"},
                                   {"governor-interface", "governor_bearing-interface"},
                                   {"inspector-body", "inspector-joint"},
                                   {"study-motion", "study-response"},
                                   {"unreadable-scene", "governor-interface"},
                                   {"tutorial-empty", "tutorial-bodies"}}) {
    CAPTURE(one, other);
    CHECK_FALSE(compare_but_for_letters(stored_picture(one), stored_picture(other)).same);
    CHECK(compare_but_for_letters(stored_picture(one), stored_picture(one)).same);
  }
}
