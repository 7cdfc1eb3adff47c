// Sliders in reverse, without a window.
#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"
#include "session_wait.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "parameters.w", arm = "parameters.L";

double number(const Session& session, const std::string& address) {
  return get_parameter(session.mechanism(), address);
}

} // namespace

TEST_CASE("Session: a goal moves the pinned sliders, as one step of the history") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, shipped_file("governor_parametric"));
  update(session, 0);
  REQUIRE(converged(session));
  const double w = number(session, speed), L = number(session, arm);
  const double collar = value(session.answer.solution, "slide");
  ++session.gesture;
  for (const double part : {0.3, 0.7, 1.}) { // a hand on its way
    seek(session, "Bring slide to a goal", {{"slide", collar - 0.01 * part}});
    update(session, 0);
    update(session, 0);
  }
  CHECK(value(session.answer.solution, "slide") == Approx(collar - 0.01).epsilon(1e-10));
  CHECK(number(session, speed) != w);
  CHECK(number(session, arm) != L);
  CHECK(session.notice.empty());
  CHECK(session.document.steps().size() == 2);
  CHECK(session.document.steps()[1].name == "Bring slide to a goal");
  // Explored, not stored.
  CHECK(get_parameter(session.document.stored(), speed) == w);
  REQUIRE(sought(session));
  CHECK(sought(session)->reached);
  // The least change from where the hand began, not from where it was last.
  const double direct_w = number(session, speed);
  undo(session);
  update(session, 0);
  CHECK(number(session, speed) == w);
  ++session.gesture;
  seek(session, "Bring slide to a goal", {{"slide", collar - 0.01}});
  update(session, 0);
  CHECK(number(session, speed) == Approx(direct_w).epsilon(1e-4));

  SECTION("what is held stays") {
    undo(session);
    hold_number(session, arm, true);
    CHECK(is_held(session, arm));
    ++session.gesture;
    seek(session, "Bring slide to a goal", {{"slide", collar - 0.01}});
    update(session, 0);
    update(session, 0);
    CHECK(number(session, arm) == L);
    CHECK(value(session.answer.solution, "slide") == Approx(collar - 0.01).epsilon(1e-10));
    hold_number(session, speed, true);
    ++session.gesture;
    seek(session, "Bring slide to a goal", {{"slide", collar}});
    CHECK(is_error(session));
    CHECK_THAT(session.notice, ContainsSubstring("all pinned sliders are held"));
  }
  SECTION("what cannot be reached is told with the nearest that can") {
    ++session.gesture;
    seek(session, "Bring slide to a goal", {{"slide", 0.05}});
    update(session, 0);
    update(session, 0);
    REQUIRE(sought(session));
    CHECK_FALSE(sought(session)->reached);
    CHECK_THAT(session.notice, ContainsSubstring("The nearest that can be reached: slide = "));
    CHECK_THAT(session.notice, ContainsSubstring(" m. At the end of its slider: "));
    CHECK(converged(session));
    CHECK(value(session.answer.solution, "slide") == Approx(sought(session)->goals[0].value).epsilon(1e-9));
  }
}

TEST_CASE("Session: without a pinned slider nothing can move, which is said") {
  Session session({.mode = LiveSolver::Mode::immediate});
  Mechanism m = shipped("governor_parametric");
  m.sliders.clear();
  open_document(session, Document(std::move(m)));
  update(session, 0);
  seek(session, "x", {{"slide", 0.14}});
  CHECK(is_error(session));
  CHECK_THAT(session.notice, ContainsSubstring("pin one"));
}

TEST_CASE("Session: goals of a hand that moves on are sought one after the other") {
  Session session({.mode = LiveSolver::Mode::background});
  open_scene(session, shipped_file("governor_parametric"));
  const auto wait = [&](const auto& done) { return wait_until(session, done); };
  REQUIRE(wait([&] { return converged(session) && !solving(session); }));
  const double collar = value(session.answer.solution, "slide");
  ++session.gesture;
  for (int i = 1; i <= 20; ++i) {
    seek(session, "Bring slide to a goal", {{"slide", collar - 0.0005 * i}});
    update(session, 0.01);
  }
  REQUIRE(wait([&] { return !session.goals.seeking.running() && !solving(session); }));
  update(session, 0.01);
  REQUIRE(wait([&] { return !solving(session); }));
  CHECK(value(session.answer.solution, "slide") == Approx(collar - 0.01).epsilon(1e-10));
}

TEST_CASE("Session: what was sought for another document, or before an undo, is not taken") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, shipped_file("governor_parametric"));
  update(session, 0);
  const double w = number(session, speed), collar = value(session.answer.solution, "slide");
  ++session.gesture;
  seek(session, "Bring slide to a goal", {{"slide", collar - 0.01}}); // found, and not taken yet
  SECTION("another document") {
    open_scene(session, shipped_file("governor_parametric"));
  }
  SECTION("a number set meanwhile") {
    change_parameter(session, "parameters.k", 1100);
  }
  SECTION("the hand has let go of it") {
    stop_seeking(session);
  }
  SECTION("building") {
    set_mode(session, Mode::build);
  }
  update(session, 0);
  update(session, 0);
  CHECK(number(session, speed) == w);
}
