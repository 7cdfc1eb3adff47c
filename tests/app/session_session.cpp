// A session without a window: this program is linked without Dear ImGui and without OpenGL.
#include "app/session/session.hpp"
#include "app/document/create.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/state_words.hpp"
#include "app/session/variable_numbers.hpp"
#include "engine/mechanism/address.hpp"
#include "session_wait.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>

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
  CHECK(session.study.states.found); // behind another tab it stays
  open_study(session, StudyKind::none);
  CHECK_FALSE(session.study.states.found);
}

TEST_CASE("Session: a Campbell diagram over another range does not wait for the one before") {
  Session session({.mode = LiveSolver::Mode::background});
  open_scene(session, test::shipped_file("chain20"));
  REQUIRE(test::wait_until(session, [&] { return converged(session) && !solving(session); }));
  open_study(session, StudyKind::modes);
  CampbellState& campbell = session.study.modes.campbell;
  REQUIRE(test::wait_until(session, [&] { return campbell.diagram.running(); }));
  const double before = campbell.diagram.asked->to;
  campbell.from = 0;
  campbell.to = before / 8;
  update(session, 0);
  CHECK(campbell.diagram.asked->to == before / 8);
  REQUIRE(test::wait_until(session, [&] { return campbell.diagram.found && !campbell.diagram.running(); }));
  CHECK(campbell.diagram.found->of.to == before / 8);
}

TEST_CASE("Session: of more coordinates than modes are found of no Campbell diagram is begun") {
  for (const auto& [count, begun] : {std::pair{20, true}, std::pair{310, false}}) {
    CAPTURE(count);
    Session session({.mode = LiveSolver::Mode::background});
    open_document(session, Document(test::hanging_chain(count, 3)));
    open_study(session, StudyKind::modes);
    REQUIRE(test::wait_until(session, [&] { return converged(session) && !solving(session); }));
    const ModesState& modes = session.study.modes;
    REQUIRE(test::wait_until(session, [&] { return modes.list.found || !modes.list.problem.empty(); }));
    CHECK(modes_refusal(session).empty() == begun);
    CHECK(modes.list.problem == modes_refusal(session));
    CHECK(modes.campbell.diagram.asked.has_value() == begun);
  }
}

TEST_CASE("Session: a slider's move hands one mechanism on, from the document to the answer") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, governor);
  ++session.gesture;
  change_parameter(session, speed, 12);
  update(session, 0);
  CHECK(session.answer.mechanism.get() == session.document.shared().get());
}

TEST_CASE("Session: where a torque acts is no number to vary") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, governor);
  edit(session, "Add", [](Mechanism& mechanism, Selection&) {
    for (const ForceType type : {ForceType::torque, ForceType::force})
      add_force(mechanism, type, "collar", {0, 0.1, 0}, Vec3::UnitY());
  });
  const std::vector<std::string> all = variable_numbers(session, Dampers::with);
  const auto has = [&](const char* address) { return std::ranges::find(all, address) != all.end(); };
  CHECK(has("forces.torque1.vector.2"));
  CHECK(has("forces.force1.at.0"));
  CHECK_FALSE(has("forces.torque1.at.0"));
}

TEST_CASE("Session: every number is called by what it is and what it is of") {
  CHECK(parameter_phrase("joints.spin.drive.speed") == "speed of spin");
  CHECK(parameter_phrase("gravity.1") == "y of gravity");
  CHECK(parameter_phrase("air.wind.0") == "wind x of air");
  CHECK(parameter_phrase("air.density") == "density of air");
  CHECK(parameter_phrase("simulation.duration") == "duration of simulation");
  CHECK(parameter_phrase("forces.sail.normal.2") == "normal z of sail");
  CHECK(parameter_phrase("forces.sail.chord.1") == "chord y of sail");
  CHECK(parameter_phrase("forces.twist.vector.2") == "component z of twist");
  CHECK(parameter_phrase("forces.film.stiffness.0.1") == "stiffness x by y of film");
  CHECK(parameter_phrase("forces.film.damping.5.2") == "damping turn z by z of film");
  CHECK(parameter_phrase("joints.ball.damping.2") == "damping 2 of ball");
  CHECK(parameter_phrase("joints.cross.axes.1.0") == "axes 1 x of cross");

  Mechanism m = test::shipped("governor");
  for (const char* address : {"air.wind.0", "gravity.2", "simulation.duration"})
    m.sliders.push_back({address, 0, 1, SliderScale::linear, ""});
  std::vector<std::string> names;
  for (const ParameterControl& control : parameter_controls(m, m))
    if (control.group == ParameterGroup::pinned) names.push_back(control.name + ": " + control.what);
  CHECK(std::ranges::count(names, "air: wind x") == 1);
  CHECK(std::ranges::count(names, "gravity: z") == 1);
  CHECK(std::ranges::count(names, "simulation: duration") == 1);
}

TEST_CASE("Session: a study that building has put out of sight is shown again") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, governor);
  update(session, 0);
  open_study(session, StudyKind::response);
  set_mode(session, Mode::build);
  CHECK_FALSE(study_shown(session, StudyKind::response));
  open_study(session, StudyKind::response);
  CHECK(session.mode == Mode::explore);
  CHECK(study_shown(session, StudyKind::response));
  open_study(session, StudyKind::response);
  CHECK(session.study.open == StudyKind::none);
}

TEST_CASE("Session: a torque that is rounding beside what the joints bear is told as zero") {
  // Without load the law's collar stands where it gives nothing.
  Session session({.mode = LiveSolver::Mode::immediate});
  open_scene(session, test::shipped_file("governor_engine"));
  change_parameter(session, "joints.spin.drive.load", 0);
  update(session, 0);
  REQUIRE(converged(session));
  Solution solution = session.answer.solution;
  REQUIRE(solution.drive_torques.size() == 1);
  DriveTorque& drive = solution.drive_torques[0];
  for (const double rounding : {1e-16, -1e-16}) {
    drive.given->torque = rounding;
    CHECK(told_torque(solution, drive)->torque == 0);
  }
  drive.given->torque = 1e-6;
  CHECK(told_torque(solution, drive)->torque == 1e-6);
}
