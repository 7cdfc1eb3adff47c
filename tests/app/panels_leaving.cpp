// Studies of a large mechanism are left while they compute: the window does not wait for them.
#include "large_mechanisms.hpp"
#include "robot.hpp"
#include "session_wait.hpp"

#include "app/live/worker.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "tests/catch.hpp"

#include <chrono>
#include <thread>

using namespace flyball;
using namespace flyball::test;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// A window on a mechanism, with its computations in the background.
class Window {
 public:
  explicit Window(Mechanism mechanism)
      : app_({.mode = LiveSolver::Mode::background,
              .on_news = {},
              .scenes = {},
              .theme = Theme::light,
              .numbers = {},
              .state = {}}),
        stage_(app_.ui, 1) {
    app_.view.samples = 1;
    open_document(app_.session, Document(std::move(mechanism)));
    wait([&] { return converged(app_.session) && !solving(app_.session); });
  }

  App& app() { return app_; }
  void frame() { stage_.frame(app_, {900, 600}, 0.02); }
  // A key pressed, and the frame that sees it.
  void key(int code) {
    app_.ui.keys.push_back({code, false, false});
    frame();
  }
  template <class Until>
  void wait(const Until& until) {
    REQUIRE(steps_until([&] { frame(); }, until));
  }

 private:
  OffscreenContext context_;
  App app_;
  Stage stage_;
};

} // namespace

TEST_CASE("a study of a long chain is left in the frame that asks for it, and keys act in the next") {
  // Following its branches takes minutes, and what is waited for is less than the time one frame may take on
  // a machine that is busy with other things.
  constexpr double frame_limit = 2; // s
  Window window(hanging_chain(600));
  struct Key {
    int code;
    StudyKind study;
  };
  for (const Key& key :
       {Key{'C', StudyKind::response}, Key{'E', StudyKind::states}, Key{'P', StudyKind::map}}) {
    INFO("key " << static_cast<char>(key.code));
    window.key(key.code);
    REQUIRE(window.app().session.study.open == key.study);
    window.wait([&] { return studying(window.app().session); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    window.frame();
    CHECK(studying(window.app().session)); // it is in the midst of it
    auto begin = Clock::now();
    window.key('M');
    CHECK(seconds_since(begin) < frame_limit);
    CHECK(window.app().session.study.open == StudyKind::motion);
    begin = Clock::now();
    window.key('M'); // and away again
    CHECK(window.app().session.study.open == StudyKind::none);
    CHECK_FALSE(studying(window.app().session));
    CHECK(seconds_since(begin) < frame_limit);
  }
  // What was left behind ends by itself, soon.
  CHECK(join_left_behind(60));
}
