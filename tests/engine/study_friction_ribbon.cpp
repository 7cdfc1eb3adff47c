// The bands of dry friction along a number that changes: where their edges bend, and how slow changes lead
// round loops.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/holding.hpp"
#include "engine/study/friction_ribbon.hpp"
#include "engine/study/ribbon_bends.hpp"
#include "engine/study/ribbon_meetings.hpp"
#include "engine/study/ribbon_tips.hpp"
#include "engine/study/slow_change.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

using namespace flyball;
using namespace flyball::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

// Two blocks on a line with friction of 4 and 2 N, displaced by u1 and u2 from where a spring of 100 N/m from
// a base, displaced by `base`, and one of 50 N/m between them are slack.
// A base that moves goes at `speed`.
Mechanism two_blocks(double base, double u1, double u2, std::optional<double> speed = {}) {
  const auto at = [](double x) { return "[" + number_text(x) + ", 0, 0]"; };
  const auto block = [&](const std::string& name, double x) {
    return R"({"name": ")" + name + R"(", "mass": 0.1, "position": )" + at(x) + "}";
  };
  const auto guide = [&](const std::string& name, const std::string& body, double x,
                         const std::string& more) {
    return R"({"name": ")" + name + R"(", "type": "prismatic", "bodies": ["ground", ")" + body +
           R"("], "at": )" + at(x) + R"(, "axis": [1, 0, 0], )" + more + "}";
  };
  const std::string drive = speed ? R"("drive": {"speed": )" + number_text(*speed) + "}" : "";
  return read_scene(
      R"({"flyball": 2, "name": "Two blocks", "bodies": [)" + (speed ? block("base", base - 1) + ", " : "") +
      block("b1", u1) + ", " + block("b2", 1 + u2) + R"(], "joints": [)" +
      (speed ? guide("base", "base", base - 1, drive) + ", " : "") +
      guide("g1", "b1", u1, R"("damping": 0.5, "friction": {"limit": 4})") + ", " +
      guide("g2", "b2", 1 + u2, R"("damping": 0.5, "friction": {"limit": 2})") + R"(],
      "forces": [{"name": "pull", "type": "spring", "bodies": [")" +
      (speed ? "base" : "ground") + R"(", "b1"], "points": [)" + at(base - 1) + ", " + at(u1) +
      R"(], "stiffness": 100, "free_length": 1}, {"name": "link", "type": "spring", "bodies": ["b1", "b2"], "points": [)" +
      at(u1) + ", " + at(1 + u2) + R"(], "stiffness": 50, "free_length": 1}]})");
}

// A pendulum of 1 kg and 1 m on an axle across a shaft that turns upright, with friction (N m), and with a
// soft spring wound so far that it pulls with 0.2 N m to one side where that is wanted.
Mechanism pendulum_on_shaft(double limit, bool tilted) {
  return read_scene(R"({"flyball": 1, "name": "Pendulum on a shaft", "gravity": [0, 0, -10],
    "bodies": [{"name": "hoop", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
      {"name": "bob", "mass": 1, "position": [0, 0, -1]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "hoop"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "drive": {"speed": 2}},
      {"name": "swing", "type": "revolute", "bodies": ["hoop", "bob"], "at": [0, 0, 0], "axis": [0, 1, 0],
      "damping": 0.2, )" +
                    std::string(tilted ? R"("spring": {"stiffness": 0.001, "free": 200}, )" : "") +
                    R"("friction": {"limit": )" + number_text(limit) + "}}]}");
}

// What holding it at an angle takes, in N m.
double holding_moment(double speed, double angle, bool tilted) {
  return 10 * std::sin(angle) - speed * speed * std::sin(angle) * std::cos(angle) +
         (tilted ? 0.001 * (angle - 200) : 0);
}

// The angles about one that friction holds without a gap, by steps and halvings.
std::pair<double, double> held_angles(double speed, double angle, double limit, bool tilted) {
  const auto end = [&](double step) {
    double held = angle;
    while (std::abs(holding_moment(speed, held + step, tilted)) <= limit)
      held += step;
    double beyond = held + step;
    for (int i = 0; i < 60; ++i) {
      const double middle = std::midpoint(held, beyond);
      (std::abs(holding_moment(speed, middle, tilted)) <= limit ? held : beyond) = middle;
    }
    return held;
  };
  return {end(-1e-4), end(1e-4)};
}

bool comes_back(double speed, double angle, bool tilted) {
  return holding_moment(speed, angle + 1e-5, tilted) > holding_moment(speed, angle - 1e-5, tilted);
}

// The speed from which some angles to one side take more than the limit, which so are held no longer.
double parting_speed(double limit, bool tilted, double side) {
  double below = 1, above = 6;
  for (int i = 0; i < 50; ++i) {
    const double speed = std::midpoint(below, above);
    double most = 0; // towards the side
    for (double angle = 0; angle < 1.5; angle += 1e-4)
      most = std::max(most, -side * holding_moment(speed, side * angle, tilted));
    (most > limit ? above : below) = speed;
  }
  return above;
}

// Numbers at which bands meet, each once, ascending.
std::vector<double> meeting_numbers(const std::vector<std::vector<RibbonPoint>>& ribbons) {
  std::vector<double> out;
  for (const std::vector<RibbonPoint>& ribbon : ribbons)
    for (const RibbonPoint& point : ribbon)
      if (point.meets &&
          std::ranges::none_of(out, [&](double other) { return std::abs(other - point.number) < 1e-3; }))
        out.push_back(point.number);
  std::ranges::sort(out);
  return out;
}

// A bead drawn at -1 on a line, which a spring beside the line pushes from its middle, and F.
Mechanism snapping_bead(double limit, bool measured) {
  return read_scene(
      R"({"flyball": 1, "name": "Snap", "gravity": [0, 0, 0], "parameters": {"F": {"value": -40, "unit": "N"}},
    "bodies": [{"name": "bead", "mass": 1, "position": [-1, 0, 0]}],
    "joints": [{"name": "slide", "type": "prismatic", "bodies": ["ground", "bead"], "at": [0, 0, 0],
      "axis": [1, 0, 0], "damping": 1, "friction": {"limit": )" +
      number_text(limit) + "}}], " +
      std::string(measured ? R"("measures": {"only": {"value": "=2*F", "unit": "N"}}, )" : "") +
      R"("forces": [{"name": "sp", "type": "spring", "bodies": ["ground", "bead"], "points": [[0, 0.5, 0], [-1, 0, 0]],
      "stiffness": 100, "free_length": 1},
      {"name": "push", "type": "force", "body": "bead", "at": [-1, 0, 0], "vector": ["=F", 0, 0]}]})");
}

// Of that spring at x, in N.
double spring(double x) {
  return 100 * (1 - 1 / std::hypot(x, 0.5)) * x;
}
const double snap_fold = std::sqrt(std::pow(0.25, 2. / 3) - 0.25); // where it is least, and largest at -that

// Where it is a force, between two x.
double spring_at(double force, double from, double to) {
  const bool rises = spring(to) > spring(from);
  for (int i = 0; i < 60; ++i) {
    const double middle = std::midpoint(from, to);
    ((spring(middle) < force) == rises ? from : to) = middle;
  }
  return from;
}

const std::string shaft_speed = "joints.spin.drive.speed";

} // namespace

TEST_CASE("bands of a pendulum on a shaft grow together past folds of the balance") {
  const bool tilted = GENERATE(false, true);
  const double limit = 0.5;
  const Mechanism m = pendulum_on_shaft(limit, tilted);
  BranchOptions options;
  options.all = true;
  const bool rising = GENERATE(true, false);
  const ResponseDiagram diagram = follow_branches(m, shaft_speed, rising ? 1 : 5, rising ? 5 : 1, options);
  std::vector<std::vector<RibbonPoint>> ribbons = friction_ribbons(m, shaft_speed, diagram);
  int folds = 0, without = 0;
  for (std::size_t k = 0; k < ribbons.size(); ++k) {
    for (std::size_t i = 0; i < ribbons[k].size(); ++i) {
      const ResponsePoint& state = diagram.branches[k].points[i];
      const BandExtent* swing = find_extent(ribbons[k][i], "swing");
      folds += ribbons[k][i].folds;
      without += !swing; // at the crossing the state is singular
      if (!swing) continue;
      const double angle = state.coordinates[1].value;
      const auto [low, high] = held_angles(state.parameter, angle, limit, tilted);
      CAPTURE(state.parameter, angle);
      CHECK_THAT(swing->low, WithinAbs(low, 1e-9));
      CHECK_THAT(swing->high, WithinAbs(high, 1e-9));
      // Beyond an edge it comes back to that where turning farther takes more, and runs away where it takes
      // less.
      CHECK(swing->stable_low == comes_back(state.parameter, low, tilted));
      CHECK(swing->stable_high == comes_back(state.parameter, high, tilted));
    }
    for (const auto& [begin, end] : slow_stretches(ribbons[k]))
      for (std::size_t i = begin; i < end; ++i)
        CHECK(diagram.branches[k].points[i].stable != false);
    // Where they meet the band of a branch jumps from one point to the next, which is told closely.
    std::vector<RibbonPoint>& points = ribbons[k];
    const std::size_t count = points.size();
    const std::atomic<bool> cancel = true;
    add_meetings(m, shaft_speed, ribbon_places(diagram.branches[k]), points, &cancel);
    CHECK(points.size() == count); // none that is not found
    add_meetings(m, shaft_speed, ribbon_places(diagram.branches[k]), points);
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (!points[i].meets) continue;
      CHECK(std::abs(points[i].number - points[i - 1].number) < 1e-4);
      const BandExtent &a = *find_extent(points[i - 1], "swing"), &b = *find_extent(points[i], "swing");
      CHECK(std::max(std::abs(a.low - b.low), std::abs(a.high - b.high)) > 0.1);
    }
  }
  CHECK(folds > 20);
  CHECK(without <= 2);
  std::vector<double> parting{parting_speed(limit, tilted, 1)};
  if (tilted) parting.push_back(parting_speed(limit, tilted, -1));
  const std::vector<double> meetings = meeting_numbers(ribbons);
  REQUIRE(meetings.size() == parting.size());
  for (std::size_t i = 0; i < meetings.size(); ++i)
    CHECK_THAT(meetings[i], WithinAbs(parting[i], 1e-4));
}

TEST_CASE("beyond a fold friction alone holds, up to where the edge of the band folds") {
  const double limit = 0.05;
  const Mechanism m = pendulum_on_shaft(limit, true);
  BranchOptions options;
  options.all = true;
  const ResponseDiagram diagram = follow_branches(m, shaft_speed, 2.8, 4.2, options);
  const auto fold = std::ranges::find(diagram.special, SpecialPointType::fold, &SpecialPoint::type);
  REQUIRE(fold != diagram.special.end());
  const std::vector<std::vector<RibbonPoint>> tips = ribbon_tips(m, shaft_speed, 2.8, 4.2, diagram);
  REQUIRE(tips.size() == 1);
  const std::vector<RibbonPoint>& tip = tips.front();
  REQUIRE(tip.size() > 5);
  CHECK(tip.front().number > fold->at.parameter);
  double last = tip.front().number + 1;
  for (const RibbonPoint& point : tip) {
    CHECK(point.number < last); // outwards
    last = point.number;
    if (&point == &tip.back()) break; // both ends are one there
    const BandExtent& swing = *find_extent(point, "swing");
    const auto [low, high] = held_angles(point.number, std::midpoint(swing.low, swing.high), limit, true);
    CAPTURE(point.number);
    CHECK_THAT(swing.low, WithinAbs(low, 1e-9));
    CHECK_THAT(swing.high, WithinAbs(high, 1e-9));
  }
  // A little farther nothing there is held.
  CHECK(last < fold->at.parameter - 0.02);
  double least = limit;
  for (double angle = -0.5; angle < 0; angle += 1e-5)
    least = std::min(least, std::abs(holding_moment(last - 1e-6, angle, true)));
  CHECK(least == limit);
  const BandExtent& end = *find_extent(tip.back(), "swing");
  CHECK(end.low == end.high);
  CHECK_THAT(std::abs(holding_moment(last, end.low, true)), WithinAbs(limit, 1e-9));
  // None where the band reaches the branch beyond.
  CHECK(ribbon_tips(pendulum_on_shaft(0.5, true), shaft_speed, 2.8, 4.2, diagram).empty());
}

TEST_CASE("a bead that snaps through has tips up to the folds at friction's limit") {
  const double limit = GENERATE(2., 0.01, 0.001, 1e-5); // of 22.5 N at the fold
  const bool measured = GENERATE(false, true); // what does not depend on friction has a band without height
  const Mechanism m = snapping_bead(limit, measured);
  const double fold = spring(-std::sqrt(std::pow(0.25, 2. / 3) - 0.25)); // where it is largest
  const double from = GENERATE(-40., 40.);
  const ResponseDiagram diagram = follow_branches(m, "parameters.F", from, -from);
  const std::vector<std::vector<RibbonPoint>> tips = ribbon_tips(m, "parameters.F", from, -from, diagram);
  REQUIRE(tips.size() == 2);
  for (const std::vector<RibbonPoint>& tip : tips) {
    const double sense = tip.back().number > 0 ? 1 : -1;
    CAPTURE(from, sense);
    CHECK(sense * tip.front().number < fold);
    CHECK(tip.size() > 7);
    CHECK_THAT(sense * tip.back().number, WithinAbs(fold + limit, 1e-9));
    for (std::size_t i = 0; i < tip.size(); ++i) {
      const BandExtent& slide = *find_extent(tip[i], "slide");
      if (i > 0) CHECK(sense * (tip[i].number - tip[i - 1].number) > 0);
      CHECK(std::max(sense * (slide.low - 1), sense * (slide.high - 1)) < 0); // not the sheet beyond
      const double middle = 0.5 * (slide.low + slide.high) - 1;               // drawn at -1
      CHECK(sense * (tip[i].number - spring(middle)) < limit + 1e-9);
      for (const double end : {slide.low, slide.high})
        CHECK_THAT(tip[i].number - spring(end - 1), WithinAbs(sense * limit, 1e-6));
      // It stands on the edge of the stable sheet, and snaps through over the other.
      CHECK((sense > 0 ? slide.stable_low : slide.stable_high) == true);
      CHECK((sense > 0 ? slide.stable_high : slide.stable_low) == false);
    }
  }
  // What is cancelled is missing.
  const std::atomic<bool> cancel = true;
  CHECK(ribbon_tips(m, "parameters.F", from, -from, diagram, &cancel).empty());
  // Along a branch through folds a slow way is told of each stable stretch, and few meetings are.
  const std::vector<RibbonPlace> places = ribbon_places(diagram.branches.front());
  std::vector<RibbonPoint> ribbon = friction_ribbon(m, "parameters.F", places);
  if (limit == 2) REQUIRE(std::ranges::any_of(ribbon, &RibbonPoint::folds));
  CHECK(hysteresis(ribbon, "slide").empty());
  const std::vector<RibbonStretch> stretches = slow_stretches(ribbon);
  REQUIRE(stretches.size() == 2);
  for (const auto& [begin, end] : stretches) {
    for (std::size_t i = begin; i < end; ++i)
      CHECK(std::abs(find_extent(ribbon[i], "slide")->value - 1) > 0.38); // beyond the folds
    CHECK(hysteresis(std::span(ribbon).subspan(begin, end - begin), "slide").size() == end - begin);
  }
  add_meetings(m, "parameters.F", places, ribbon);
  CHECK(std::ranges::count(ribbon, true, &RibbonPoint::meets) <= 4);
}

TEST_CASE("what is unstable beside the joints that have friction has no band") {
  // Two rods of 1 kg and 1 m, one on the other, which stand upright.
  const auto upright = [](const std::string& lower, const std::string& upper) {
    return read_scene(R"({"flyball": 2, "name": "Upright", "gravity": [0, "=-g", 0],
      "parameters": {"g": {"value": 10, "unit": "m/s^2"}},
      "bodies": [{"name": "a", "mass": 1, "position": [0, 1, 0]}, {"name": "b", "mass": 1, "position": [0, 2, 0]}],
      "joints": [{"name": "low", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 0, 1],
          "damping": 0.1)" +
                      lower + R"(},
        {"name": "high", "type": "revolute", "bodies": ["a", "b"], "at": [0, 1, 0], "axis": [0, 0, 1],
          "damping": 0.1)" +
                      upper + "}]}");
  };
  const std::string rubs = R"(, "friction": {"limit": 2})";
  const std::vector<RibbonPlace> places{{10, {{"low", 0}, {"high", 0}}}};
  for (const auto& [lower, upper] : {std::pair(rubs, std::string()), std::pair(std::string(), rubs)}) {
    const RibbonPoint point = friction_ribbon(upright(lower, upper), "parameters.g", places).front();
    CHECK(point.extents.empty());
    CHECK_THAT(point.message,
               ContainsSubstring("what is free beside the joints that have friction leaves it"));
    CHECK_THAT(find_holding(upright(lower, upper), places[0].start).message,
               ContainsSubstring("unstable there"));
  }
  // Friction in both holds it, up to where the lower one or the upper one gives way: 20 sin a + 10 sin (a +
  // b) and 10 sin (a + b) of 2 N m.
  const RibbonPoint held = friction_ribbon(upright(rubs, rubs), "parameters.g", places).front();
  const BandExtent* low = find_extent(held, "low");
  INFO(held.message);
  REQUIRE(low);
  CHECK_THAT(low->high, WithinAbs(std::asin(0.2), 1e-9));
  CHECK_THAT(low->low, WithinAbs(-std::asin(0.2), 1e-9));
  CHECK(low->stable_high == false);
  CHECK(low->stable_low == false);
}

TEST_CASE("what is bounded is told beside what friction holds anywhere") {
  const Mechanism m = read_scene(R"~({"flyball": 2, "name": "Round", "gravity": [0, "=-g", 0],
    "parameters": {"g": {"value": 10, "unit": "m/s^2"}},
    "bodies": [{"name": "bob", "mass": 1, "position": [0, -1, 0]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "friction": {"limit": 12}}],
    "measures": {"aside": {"value": "=1 m*sin(coordinate(hinge))", "unit": "m"}}})~");
  const std::vector<RibbonPlace> places{{8, {{"hinge", 0}}}, {10, {{"hinge", 0}}}};
  for (const RibbonPoint& point : friction_ribbon(m, "parameters.g", places)) {
    CHECK_THAT(point.message, ContainsSubstring("Friction holds it at any angle"));
    const BandExtent *hinge = find_extent(point, "hinge"), *aside = find_extent(point, "aside");
    REQUIRE(hinge);
    REQUIRE(aside);
    CHECK(std::isinf(hinge->low));
    CHECK(std::isinf(hinge->high));
    CHECK_THAT(aside->low, WithinAbs(-1, 1e-9));
    CHECK_THAT(aside->high, WithinAbs(1, 1e-9));
  }
  // Few points do for it.
  std::vector<RibbonPlace> many;
  for (int i = 0; i <= 64; ++i)
    many.push_back({5 + i / 16., {{"hinge", 0}}});
  const std::vector<std::size_t> ends{0, 16, 32, 48, 64};
  CHECK(friction_ribbon_at_bends(m, "parameters.g", many, ends).size() == 5);
}

TEST_CASE("a speed that rises and falls slowly leads a bead round a loop") {
  const double m = 0.5, k = 400, r0 = 0.2, limit = 1.25;
  const auto edge = [&](double n, double sense) { return (k * r0 + sense * limit) / (k - m * n * n); };
  std::vector<double> speeds;
  for (int i = 0; i <= 40; ++i)
    speeds.push_back(6 + 0.2 * i);
  const Mechanism bead = bead_on_rod(10, limit);
  std::vector<RibbonPlace> places;
  for (const double speed : speeds)
    places.push_back({speed, start_values(Analysis(bead_on_rod(speed, limit)).solve().coordinates)});
  const std::vector<HysteresisPoint> way =
      hysteresis(friction_ribbon(bead, "joints.spin.drive.speed", places), "slide");
  REQUIRE(way.size() == speeds.size());
  // Rising it lags behind, along the lower edge; turning back it stays where it is, then goes along the
  // upper.
  CHECK_THAT(way.back().forth, WithinRel(edge(14, -1), 1e-12));
  CHECK_THAT(way.front().back, WithinRel(edge(6, 1), 1e-12));
  for (std::size_t i = 0; i < way.size(); ++i) {
    CHECK_THAT(way[i].forth, WithinRel(std::max(edge(6, 1), edge(speeds[i], -1)), 1e-12));
    CHECK_THAT(way[i].back, WithinRel(std::min(edge(14, -1), edge(speeds[i], 1)), 1e-12));
  }
}

TEST_CASE("points of a ribbon lie close where its edges bend") {
  const double m = 0.5, k = 400, r0 = 0.2, limit = 4, upper = 0.26;
  const auto on_bead = [&](double speed) {
    Mechanism out = bead_on_rod(speed, limit);
    out.joints[1].coordinates[0].stop = Stop{.lower = {}, .upper = upper, .stiffness = 1e9};
    return out;
  };
  const auto edge = [&](double n, double sense) {
    return std::min((k * r0 + sense * limit) / (k - m * n * n), upper);
  };
  std::vector<RibbonPlace> places;
  for (int i = 0; i <= 200; ++i) {
    const double speed = 0.12 * i;
    places.push_back({speed, start_values(Analysis(on_bead(speed)).solve().coordinates)});
  }
  const std::vector<std::size_t> first{0, 50, 100, 150, 200};
  const std::vector<RibbonPoint> ribbon =
      friction_ribbon_at_bends(on_bead(10), "joints.spin.drive.speed", places, first);
  CHECK(ribbon.size() < 60); // of 201
  std::size_t after = 1;
  for (const RibbonPlace& place : places) {
    while (after + 1 < ribbon.size() && ribbon[after].number < place.number)
      ++after;
    const RibbonPoint &a = ribbon[after - 1], &b = ribbon[after];
    const double part = (place.number - a.number) / (b.number - a.number);
    CAPTURE(place.number, a.number, b.number);
    const BandExtent &at_a = *find_extent(a, "slide"), &at_b = *find_extent(b, "slide");
    CHECK_THAT(std::lerp(at_a.low, at_b.low, part), WithinAbs(edge(place.number, -1), 0.02 * (upper - 0.19)));
    CHECK_THAT(std::lerp(at_a.high, at_b.high, part),
               WithinAbs(edge(place.number, 1), 0.02 * (upper - 0.21)));
  }
}

TEST_CASE("points of a ribbon lie close on each sheet of a branch that turns back") {
  const double limit = 0.5;
  const Mechanism m = snapping_bead(limit, false);
  const ResponseDiagram diagram = follow_branches(m, "parameters.F", -40, 40);
  const std::vector<RibbonPlace> places = ribbon_places(diagram.branches.front());
  const std::vector<std::size_t> ends{0, places.size() / 2, places.size() - 1};
  const std::vector<RibbonPoint> ribbon = friction_ribbon_at_bends(m, "parameters.F", places, ends);
  CHECK(ribbon.size() < 100); // of 269
  std::array<int, 3> compared{};
  for (std::size_t i = 1; i < ribbon.size(); ++i) {
    const RibbonPoint &a = ribbon[i - 1], &b = ribbon[i];
    if (a.folds || b.folds) continue;
    const BandExtent &at_a = *find_extent(a, "slide"), &at_b = *find_extent(b, "slide");
    const double x = std::midpoint(at_a.value, at_b.value) - 1;
    const std::size_t sheet = x < -snap_fold ? 0 : x < snap_fold ? 1 : 2;
    const std::array<double, 4> between{-2, -snap_fold, snap_fold, 2};
    const std::array<double, 3> height{0.95, 2 * snap_fold, 0.95};
    for (const double part : {0.25, 0.5, 0.75}) {
      const double force = std::lerp(a.number, b.number, part);
      for (const double sense : {-1., 1.}) {
        const double edge = spring_at(force + sense * limit, between[sheet], between[sheet + 1]) + 1;
        const bool lower = (sense < 0) == (sheet != 1);
        CAPTURE(force, sense, sheet, a.number, b.number);
        CHECK_THAT(lower ? std::lerp(at_a.low, at_b.low, part) : std::lerp(at_a.high, at_b.high, part),
                   WithinAbs(edge, 0.02 * height[sheet]));
        ++compared[sheet];
      }
    }
  }
  for (const int each : compared)
    CHECK(each > 20);
}

TEST_CASE("slowly pulled to and fro, two blocks stick and slip one after the other") {
  // u pulls the first block with 100 (u - u1), as a base that moves by u would, or a spring that is slack
  // earlier.
  constexpr int count = 61;
  constexpr double most = 0.3;
  std::vector<RibbonPlace> places;
  for (int i = 0; i < count; ++i) {
    const double u = most * i / (count - 1);
    places.push_back({1 + u, {{"g1", u}, {"g2", u}}});
  }
  const Mechanism m = two_blocks(0, 0, 0);
  const std::vector<RibbonPoint> ribbon = friction_ribbon(m, "forces.pull.free_length", places);
  INFO(ribbon.front().no_way);
  const std::vector<HysteresisPoint> first = hysteresis(ribbon, "g1"), second = hysteresis(ribbon, "g2");
  REQUIRE(first.size() == count);
  REQUIRE(second.size() == count);

  // By small steps, each a minimum of energy and what friction takes from where it was (Mielke 2005).
  double x1 = 0, x2 = 0;
  const auto step = [&](double u) {
    const double from1 = x1, from2 = x2;
    const auto moved = [](double from, double force_there, double stiffness, double limit) {
      const double excess = std::abs(force_there) - limit;
      return excess > 0 ? from + std::copysign(excess, force_there) / stiffness : from;
    };
    for (int i = 0; i < 400; ++i) {
      x1 = moved(from1, 100 * (u - from1) + 50 * (x2 - from1), 150, 4);
      x2 = moved(from2, 50 * (x1 - from2), 50, 2);
    }
  };
  constexpr int fine = 20;
  double largest = 0;
  for (int round = 0; round < 3; ++round) {
    for (int i = 1; i < count * fine; ++i) {
      step(most * std::min(1., i / static_cast<double>((count - 1) * fine)));
      if (i % fine == 0 && round == 2) {
        const auto k = static_cast<std::size_t>(i / fine);
        largest = std::max({largest, std::abs(first[k].forth - x1), std::abs(second[k].forth - x2)});
      }
    }
    for (int i = (count - 1) * fine; i-- > 0;) {
      step(most * i / static_cast<double>((count - 1) * fine));
      if (i % fine == 0 && round == 2) {
        const auto k = static_cast<std::size_t>(i / fine);
        largest = std::max({largest, std::abs(first[k].back - x1), std::abs(second[k].back - x2)});
      }
    }
  }
  CHECK(largest < 1e-4); // of a way of 0.24 m
  CHECK(first.back().forth - first.front().back > 0.1);

  // The same as the base moves slowly to and fro.
  const double speed = 0.01;
  double base = 0, u1 = 0, u2 = 0;
  for (const double sense : {1., -1., 1.}) {
    SimulationOptions options;
    options.duration = most / speed;
    const Run run = simulate(two_blocks(base, u1, u2, sense * speed), options);
    INFO(run.message);
    const auto last = [&](const char* joint) {
      return std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint)->value.back();
    };
    base += sense * most;
    u1 += last("g1");
    u2 += last("g2");
    if (base > most / 2) {
      CHECK_THAT(u1, WithinAbs(first.back().forth, 1e-3));
      CHECK_THAT(u2, WithinAbs(second.back().forth, 1e-3));
    } else {
      CHECK_THAT(u1, WithinAbs(first.front().back, 1e-3));
      CHECK_THAT(u2, WithinAbs(second.front().back, 1e-3));
    }
  }
}

TEST_CASE("friction in several joints of one motion leads it round a loop, too") {
  const Mechanism m = rubbing_governor(1.5, 0.04);
  std::vector<RibbonPlace> places;
  for (const double speed : {9., 10., 11., 12., 13.}) {
    Mechanism there = m;
    set_parameter(there, "joints.spin.drive.speed", speed);
    places.push_back({speed, start_values(Analysis(there).solve().coordinates)});
  }
  const std::vector<RibbonPoint> ribbon = friction_ribbon(m, "joints.spin.drive.speed", places);
  const std::vector<HysteresisPoint> way = hysteresis(ribbon, "slide");
  REQUIRE(way.size() == places.size());
  CHECK(ribbon.front().slow.empty());
  CHECK(std::abs(way[2].forth - way[2].back) > 1e-3);
  for (std::size_t i = 0; i < way.size(); ++i) {
    const BandExtent& slide = *find_extent(ribbon[i], "slide");
    CHECK(std::min(way[i].forth, way[i].back) >= slide.low);
    CHECK(std::max(way[i].forth, way[i].back) <= slide.high);
  }
}

TEST_CASE("a slow change that is not determined is refused with the reason") {
  const std::vector<std::string> names{"g1", "g2"};
  const Mechanism m = two_blocks(0, 0, 0);
  const auto place = [](double u) { return RibbonPlace{1 + u, {{"g1", u}, {"g2", u}}}; };
  const std::vector<RibbonPlace> turning{place(0), place(0.1), place(0.05)};
  CHECK_THAT(find_slow_change(m, "forces.pull.free_length", turning, names).message,
             ContainsSubstring("turns back"));
  Mechanism loops = rubbing_governor(15, 0.4);
  const std::vector<RibbonPlace> tied{{11, {}}, {12, {}}};
  CHECK_THAT(find_slow_change(loops, "joints.spin.drive.speed", tied, {"slide"}).message,
             ContainsSubstring("Loops tie joints with friction"));
}
