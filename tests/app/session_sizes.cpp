// What a person sees of states is the same of a watch, of a machine and of a crane.
#include "app/session/session.hpp"
#include "app/session/state_words.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

// Von Mises' truss: a block on a slide between two springs that are too long to lie straight, 1 m each way,
// in another size. Unloaded it stands 0.458 m to either side.
Mechanism truss(double size) {
  Mechanism m;
  m.name = "truss";
  m.gravity = {0, 0, -0.2};
  m.bodies = {body("block", 1, {0, 0, 0.5}, {0.01, 0.01, 0.01})};
  m.joints = {prismatic("slide", "ground", "block", {0, 0, 0.5}, {0, 0, 1})};
  m.forces = {point_spring("left", "ground", "block", {-1, 0, 0}, {0, 0, 0.5}, 100, 1.1),
              point_spring("right", "ground", "block", {1, 0, 0}, {0, 0, 0.5}, 100, 1.1)};
  m = resized(std::move(m), size);
  m.gravity *= size;
  return m;
}

struct TrussSession : Session {
  explicit TrussSession(double chosen) : Session({.mode = LiveSolver::Mode::immediate}), size(chosen) {
    open_document(*this, Document(truss(size)));
    frames();
  }
  void frames() {
    for (int i = 0; i < 3; ++i)
      update(*this, 0);
  }
  // Parts of the truss above the drawn place.
  double place() const {
    REQUIRE(converged(*this));
    return value(answer.solution, "slide") / size;
  }
  double size;
};

} // namespace

TEST_CASE("Session: the response is followed anew beside the other side of a truss, in any size") {
  const double size = GENERATE(1e-3, 1., 100.);
  CAPTURE(size);
  TrussSession session(size);
  CHECK(std::abs(session.place() + 0.05) < 0.02);
  open_study(session, StudyKind::response);
  choose_response(session, "gravity.2");
  choose_response_end(session, &ResponseChoice::from, -0.5 * size);
  choose_response_end(session, &ResponseChoice::to, 0.5 * size);
  session.frames();
  const auto curve = session.study.response.curve.found;
  REQUIRE(curve);
  REQUIRE(curve->result.lines.size() == 1);
  // What moves along the curve stays on it.
  ++session.gesture;
  change_parameter(session, "gravity.2", 0.137 * size);
  session.frames();
  CHECK(session.place() > -0.1);
  CHECK(session.study.response.curve.found == curve);
  // The other side is on no curve.
  go_to_state(session, "", 0, {{"slide", -0.95 * size}});
  session.frames();
  CHECK(std::abs(session.place() + 0.95) < 0.03);
  const auto anew = session.study.response.curve.found;
  REQUIRE(anew);
  CHECK(anew != curve);
  CHECK(std::ranges::any_of(anew->result.lines, [&](const ResponseLine& line) {
    return value(line.points.front().coordinates, "slide") < -0.9 * size;
  }));
}

TEST_CASE("Session: the list of states marks the one that is shown, in any size") {
  const double size = GENERATE(1e-7, 1., 100.);
  CAPTURE(size);
  TrussSession session(size);
  open_study(session, StudyKind::states);
  session.frames();
  REQUIRE(session.study.states.found);
  const std::vector<Solution>& all = session.study.states.found->result.equilibria;
  REQUIRE(all.size() == 3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < all.size(); ++k)
      CHECK(same_state(all[i].coordinates, all[k].coordinates, {}) == (i == k));
    show_state(session, i);
    session.frames();
    CHECK(shown_state(session) == i);
  }
}
