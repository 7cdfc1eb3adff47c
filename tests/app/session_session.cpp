// A session without a window: this program is linked without Dear ImGui and without OpenGL.
#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"
#include "session_wait.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* speed = "joints.spin.drive.speed";
const std::string governor = test::shipped_file("governor");

double collar(const Session& session) {
  REQUIRE(converged(session));
  return test::value(session.answer.solution, "slide");
}

} // namespace

TEST_CASE("Session: opens a scene, follows a slider and takes it back") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, governor);
  update(session, 0);
  REQUIRE(session.problem.empty());
  const double at_rest = collar(session), before = get_parameter(session.mechanism(), speed);
  ++session.gesture;
  change_parameter(session, speed, before + 3);
  update(session, 0);
  CHECK(get_parameter(session.mechanism(), speed) == before + 3);
  CHECK(get_parameter(session.document.stored(), speed) == before);
  CHECK(std::abs(collar(session) - at_rest) > 1e-3); // faster balls move the collar
  undo(session);
  update(session, 0);
  CHECK(get_parameter(session.mechanism(), speed) == before);
  CHECK(std::abs(collar(session) - at_rest) < 1e-9);
}

TEST_CASE("Session: solves and studies in the background") {
  Session session({.mode = LiveSolver::Mode::background});
  open_scene(session, governor);
  REQUIRE(test::wait_until(session, [&] { return converged(session) && !solving(session); }));
  open_study(session, StudyKind::states);
  REQUIRE(test::wait_until(session, [&] { return session.study.states.found && !studying(session); }));
  REQUIRE_FALSE(session.study.states.found->result.equilibria.empty());
  CHECK(states_are_current(session));
  CHECK(shown_state(session).has_value());
  open_study(session, StudyKind::response);
  REQUIRE(
      test::wait_until(session, [&] { return session.study.response.curve.found && !studying(session); }));
  CHECK_FALSE(session.study.response.curve.found->result.lines.empty());
  CHECK_FALSE(session.study.states.found); // gone with its tab
}

TEST_CASE("Session: a slider's move hands one mechanism on, from the document to the answer") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, governor);
  ++session.gesture;
  change_parameter(session, speed, 12);
  update(session, 0);
  CHECK(session.answer.mechanism.get() == session.document.shared().get());
}
