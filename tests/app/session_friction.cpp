// What friction makes of the response curve, without a window.
#include "app/session/session.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace flyball;

namespace {

// A centrifugal clutch: two shoes of 0.2 kg, 0.1 m off the axis of a hub at a given speed, each held back by
// 20 kN/m and 50 N of friction, meet a drum at 0.02 m, which a load proportional to its speed holds.
const char* const clutch = R"~({
  "flyball": 2, "name": "Clutch", "gravity": [0, -9.80665, 0],
  "bodies": [
    {"name": "hub", "mass": 1, "position": [0, 0, 0], "inertia": [4e-4, 4e-4, 4e-4]},
    {"name": "shoe1", "mass": 0.2, "position": [0.1, 0, 0], "inertia": [8e-5, 8e-5, 8e-5]},
    {"name": "shoe2", "mass": 0.2, "position": [-0.1, 0, 0], "inertia": [8e-5, 8e-5, 8e-5]},
    {"name": "drum", "mass": 31, "position": [0, -0.06, 0], "inertia": [0.2, 0.4, 0.2]}
  ],
  "joints": [
    {"name": "input", "type": "revolute", "bodies": ["ground", "hub"], "at": [0, 0, 0], "axis": [0, 1, 0],
     "drive": {"speed": 150}},
    {"name": "slide1", "type": "prismatic", "bodies": ["hub", "shoe1"], "at": [0.1, 0, 0], "axis": [1, 0, 0],
     "spring": {"stiffness": 20000}, "damping": 10, "stop": {"lower": -0.01, "upper": 0.02, "stiffness": 1e7},
     "friction": {"limit": 50}},
    {"name": "slide2", "type": "prismatic", "bodies": ["hub", "shoe2"], "at": [-0.1, 0, 0], "axis": [-1, 0, 0],
     "spring": {"stiffness": 20000}, "damping": 10, "stop": {"lower": -0.01, "upper": 0.02, "stiffness": 1e7},
     "friction": {"limit": 50}},
    {"name": "output", "type": "revolute", "bodies": ["ground", "drum"], "at": [0, -0.06, 0], "axis": [0, 1, 0],
     "drive": {"torque": "=2*0.3*0.12 m*max(0 N, 1e7 N/m*(coordinate(slide1)-0.02 m))*tanh((rate(input)-rate(output))/(1 rad/s))",
               "load": "=0.05 N m s*rate(output)", "speed": 10}}
  ]
})~";

// The response over a number, with its ribbon of friction.
void follow_over(Session& session, const std::string& address, double from, double to) {
  open_study(session, StudyKind::response);
  update(session, 0);
  choose_response(session, address);
  choose_response_end(session, &ResponseChoice::from, from);
  choose_response_end(session, &ResponseChoice::to, to);
  for (int i = 0; i < 4; ++i)
    update(session, 0);
}

} // namespace

TEST_CASE("Session: a clutch engages along the edge of what friction holds, past the kink of the law") {
  Session session({.mode = LiveSolver::Mode::immediate});
  open_document(session, Document(parse_scene(clutch)));
  follow_over(session, "joints.input.drive.speed", 110, 160);
  const auto ribbon = shown_ribbon(session);
  REQUIRE(ribbon);
  const std::vector<RibbonPoint>& points = ribbon->result.points;
  REQUIRE(ribbon->result.stretches.size() == 1); // the kink without friction, at 129.1 rad/s, ends none
  CHECK(ribbon->result.stretches[0].count == points.size());
  // By hand: a shoe slides out where 0.2 w^2 (0.1 + s) is 20000 s + 50, and back where it is 20000 s - 50.
  const auto edge = [](double w, double friction) {
    return std::min(0.02, (0.02 * w * w - friction) / (20000 - 0.2 * w * w));
  };
  const std::vector<HysteresisPoint> slide = hysteresis(points, "slide1"),
                                     drum = hysteresis(points, "output.speed");
  REQUIRE(slide.size() == points.size());
  REQUIRE(drum.size() == points.size());
  int before = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double w = points[i].number;
    CAPTURE(w);
    const BandExtent* extent = find_extent(points[i], "slide1");
    REQUIRE(extent);
    CHECK(extent->low == Approx(edge(w, 50)).margin(2e-5));
    CHECK(extent->high == Approx(edge(w, -50)).margin(3e-5));
    CHECK(slide[i].back == Approx(edge(w, -50)).margin(3e-5));
    // It has come down to where it stands at 110 rad/s, and stays until the lower edge comes to it.
    CHECK(slide[i].forth == Approx(std::max(edge(110, -50), edge(w, 50))).margin(3e-5));
    if (w < std::sqrt(450 / 0.024) - 0.1) {
      CHECK(std::abs(drum[i].forth) < 1e-6);
      ++before;
    }
  }
  CHECK(before > 10);
}

TEST_CASE("Session: the ribbon is about unstable states, too, and it is told where there is none") {
  // Two rods of 1 kg and 1 m hang one from the other across a shaft, or stand upright; the upper has
  // friction.
  const auto rods = [](double down) {
    const auto at = [&](double way) { return "[0, " + std::to_string(way * down) + ", 0]"; };
    return R"~({"flyball": 2, "name": "Rods", "gravity": [0, "=-g", 0],
      "parameters": {"g": {"value": 10, "unit": "m/s^2"}},
      "bodies": [{"name": "a", "mass": 1, "position": )~" +
           at(1) + R"~(},
        {"name": "b", "mass": 1, "position": )~" +
           at(2) + R"~(}],
      "joints": [{"name": "first", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0],
          "axis": [0, 0, 1], "damping": 0.1, "friction": {"limit": 2}},
        {"name": "second", "type": "revolute", "bodies": ["a", "b"], "at": )~" +
           at(1) + R"~(,
          "axis": [0, 0, 1], "damping": 0.1}]})~";
  };
  for (const double down : {-1., 1.}) {
    Session session({.mode = LiveSolver::Mode::immediate});
    open_document(session, Document(parse_scene(rods(down))));
    follow_over(session, "parameters.g", 5, 8);
    const auto ribbon = shown_ribbon(session);
    REQUIRE(ribbon);
    CAPTURE(down, session.study.response.choice.quantity);
    const std::vector<RibbonGap> gaps = ribbon_gaps(session);
    if (down < 0) {
      CHECK(gaps.empty());
      continue;
    }
    // Upright it falls by the second rod, which no friction holds.
    REQUIRE_FALSE(gaps.empty());
    for (const RibbonGap& gap : gaps)
      CHECK_THAT(gap.why, ContainsSubstring("what is free beside the joints that have friction leaves it"));
  }
}

TEST_CASE("Session: the Campbell diagram follows what friction holds") {
  // On a hub a rider that friction alone holds, up to 20 rad/s, and 1 kg on a spring of 400 N/m.
  const char* const hub = R"~({
    "flyball": 1, "name": "Hub", "gravity": [0, 0, 0],
    "bodies": [
      {"name": "hub", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
      {"name": "rider", "mass": 0.5, "position": [0.1, 0, 0]},
      {"name": "swinger", "mass": 1, "position": [0, 0, 0]}
    ],
    "joints": [
      {"name": "spin", "type": "revolute", "bodies": ["ground", "hub"], "at": [0, 0, 0], "axis": [0, 1, 0],
       "drive": {"speed": 5}},
      {"name": "hold", "type": "prismatic", "bodies": ["hub", "rider"], "at": [0.1, 0, 0], "axis": [1, 0, 0],
       "friction": {"limit": 20}},
      {"name": "slide", "type": "prismatic", "bodies": ["hub", "swinger"], "at": [0, 0, 0], "axis": [0, 0, 1],
       "spring": {"stiffness": 400}}
    ]
  })~";
  Session session({.mode = LiveSolver::Mode::immediate});
  open_document(session, Document(parse_scene(hub)));
  CampbellState& campbell = session.study.modes.campbell;
  campbell.from = 1;
  campbell.to = 8;
  open_study(session, StudyKind::modes);
  for (int i = 0; i < 4; ++i)
    update(session, 0);
  REQUIRE(campbell.diagram.found);
  const CampbellDiagram& diagram = campbell.diagram.found->result;
  REQUIRE(diagram.branches.size() == 1);
  CHECK(campbell.on_branch);
  const std::vector<CampbellPoint>& points = diagram.branches[0].points;
  CHECK(points.size() > 10);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double w = diagram.response.branches[0].points[i].parameter;
    CAPTURE(w);
    int named = 0; // the others do not swing
    for (std::size_t l = 0; l < points[i].lines.size(); ++l) {
      const VibrationMode* mode = points[i].on(l);
      if (!mode || diagram.branches[0].names[l].empty()) continue;
      ++named;
      CHECK(mode->frequency == Approx(std::sqrt(400 - w * w)).epsilon(1e-9));
    }
    CHECK(named == 1);
  }
}
