// The bands of dry friction along a number that changes: where their edges bend, and how slow changes lead
// round loops.
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/friction_ribbon.hpp"
#include "engine/study/slow_change.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <cmath>

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

} // namespace

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
