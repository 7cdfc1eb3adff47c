// Bands by where joints with friction stand: of several joints past folds and round, within the play of
// stops, and what jumps. Against closed forms and against places that are flooded one by one.
#include "engine/linear/uniform_random.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/friction_report.hpp"
#include "engine/study/friction_ribbon.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

using namespace flyball;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

// 1 kg at 0.5 m and 0.7 kg at 0.4 m from there, hanging: 8.5 N m sin h + 2.8 N m sin(h + k), and the latter
// alone, less what `h` and `k` say.
Mechanism two_hinges(const std::string& h, const std::string& k, double gravity = 10,
                     const std::string& measures = "") {
  return read_scene(R"json({"flyball": 2, "name": "Double pendulum", "gravity": [0, )json" +
                    number_text(-gravity) +
                    R"json(, 0], "bodies": [{"name": "p", "mass": 1, "position": [0, -0.5, 0]},
        {"name": "q", "mass": 0.7, "position": [0, -0.9, 0]}],
      "joints": [{"name": "h", "type": "revolute", "bodies": ["ground", "p"], "at": [0, 0, 0],
          "axis": [0, 0, 1])json" +
                    h + R"json(}, {"name": "k", "type": "revolute", "bodies": ["p", "q"], "at": [0, -0.5, 0],
          "axis": [0, 0, 1])json" +
                    k + R"json(}], "measures": {)json" + measures + "}}");
}

std::string rubs(double limit) {
  return R"(, "friction": {"limit": )" + number_text(limit) + "}";
}

std::string sprung(double stiffness, double free) {
  return R"(, "spring": {"stiffness": )" + number_text(stiffness) + R"(, "free": )" + number_text(free) + "}";
}

std::string plays(double play, double stiffness) {
  return R"(, "stop": {"lower": )" + number_text(-play) + R"(, "upper": )" + number_text(play) +
         R"(, "stiffness": )" + number_text(stiffness) + "}";
}

FrictionBand band_of(const Mechanism& m) {
  return report_friction(m, Analysis(m).solve()).band;
}

const BandExtent& extent_in(const FrictionBand& band, std::string_view name) {
  INFO(band.message);
  REQUIRE(band.found);
  const auto found = std::ranges::find(band.extents, name, &BandExtent::name);
  REQUIRE(found != band.extents.end());
  return *found;
}

// The extents in two angles of the places that hang together with one, by steps of 0.02 rad.
struct Flood {
  std::array<double, 2> low{}, high{};
};
constexpr double flood_step = 0.02, flood_range = 9;
Flood flood(const std::function<bool(double, double)>& holds, double step = flood_step) {
  Flood out;
  std::set<std::pair<int, int>> seen{{0, 0}};
  std::deque<std::pair<int, int>> next{{0, 0}};
  while (!next.empty()) {
    const auto [a, b] = next.front();
    next.pop_front();
    const std::array<double, 2> at{a * step, b * step};
    for (const std::size_t i : {0u, 1u}) {
      out.low[i] = std::min(out.low[i], at[i]);
      out.high[i] = std::max(out.high[i], at[i]);
    }
    for (int x = a - 1; x <= a + 1; ++x)
      for (int y = b - 1; y <= b + 1; ++y)
        if (std::max(std::abs(x), std::abs(y)) * step <= flood_range && seen.insert({x, y}).second &&
            holds(x * step, y * step))
          next.emplace_back(x, y);
  }
  return out;
}

} // namespace

TEST_CASE("two hinges of which friction holds one at any angle have no bound", "[placed-band]") {
  // Whichever it is, the other can turn against it.
  const bool first = GENERATE(true, false);
  const FrictionBand band = band_of(first ? two_hinges(rubs(20), rubs(0.3)) : two_hinges(rubs(2), rubs(5)));
  INFO(band.message);
  const BandExtent &h = extent_in(band, "h"), &k = extent_in(band, "k");
  if (first) {
    CHECK(h.low == -endless);
    CHECK(h.high == endless);
    CHECK_THAT(band.message, ContainsSubstring("h and k can go round"));
  } else {
    CHECK_THAT(h.high, WithinAbs(std::asin((2 + 2.8) / 8.5), 1e-9));
    CHECK_THAT(h.low, WithinAbs(-std::asin((2 + 2.8) / 8.5), 1e-9));
    CHECK_THAT(band.message, ContainsSubstring("k can go round"));
  }
  CHECK(k.low == -endless);
  CHECK(k.high == endless);
  CHECK_FALSE(band.whole);
}

TEST_CASE("what a stop ends one way has no bound the other way alone", "[placed-band]") {
  const FrictionBand band = band_of(
      two_hinges(R"(, "stop": {"lower": -0.1, "stiffness": 100})" + rubs(0.1), sprung(5, 0) + rubs(0.1), 0));
  CHECK_THAT(extent_in(band, "h").low, WithinAbs(-0.101, 1e-12));
  CHECK(extent_in(band, "h").high == endless);
  CHECK_THAT(extent_in(band, "k").low, WithinAbs(-0.02, 1e-12));
  CHECK_THAT(extent_in(band, "k").high, WithinAbs(0.02, 1e-12));
  CHECK_THAT(band.message, ContainsSubstring("no bound is told"));
}

TEST_CASE(
    "a joint that nothing presses may stand anywhere in its play and as far in its stop as friction holds",
    "[placed-band]") {
  const FrictionBand one = band_of(read_scene(
      R"({"flyball": 2, "name": "Play", "bodies": [{"name": "p", "mass": 1, "position": [1, 0, 0]}],
          "joints": [{"name": "h", "type": "revolute", "bodies": ["ground", "p"], "at": [0, 0, 0],
            "axis": [0, 0, 1])" +
      plays(0.1, 100) + rubs(0.1) + "}]}"));
  CHECK_THAT(extent_in(one, "h").low, WithinAbs(-0.101, 1e-12));
  CHECK_THAT(extent_in(one, "h").high, WithinAbs(0.101, 1e-12));
  const FrictionBand both = band_of(two_hinges(plays(0.1, 100) + rubs(0.1), plays(0.2, 50) + rubs(0.3), 0));
  CHECK_THAT(extent_in(both, "h").high, WithinAbs(0.101, 1e-12));
  CHECK_THAT(extent_in(both, "k").low, WithinAbs(-0.206, 1e-12));
  // Without friction of its own it stands anywhere, whatever friction does elsewhere.
  for (const std::string& none : {std::string(), rubs(0)}) {
    const FrictionBand loose = band_of(two_hinges(rubs(0.1), plays(0.1, 100) + none, 0));
    CHECK_FALSE(loose.found);
    CHECK(loose.message == "No band is told: nothing resists k, whatever friction does.");
  }
}

TEST_CASE("random hinges with springs and play have the band that places tell", "[placed-band]") {
  std::mt19937 random(5);
  int bounded = 0, past_stops = 0, round = 0;
  for (int trial = 0; trial < 24; ++trial) {
    std::array<double, 2> limit{uniform(random, 0.05, 1.3) * 11.3, uniform(random, 0.05, 1.3) * 2.8};
    std::array<double, 2> stiffness{}, play{endless, endless}, stop{};
    std::array<std::string, 2> more;
    for (const std::size_t i : {0u, 1u}) {
      if (trial % 3 == 0) {
        stiffness[i] = uniform(random, 0.3, 1) * (i == 0 ? 11.3 : 2.8);
        more[i] += sprung(stiffness[i], 0);
      }
      if (trial % 2 == 1) {
        play[i] = uniform(random, 0.1, 1.5);
        stop[i] = uniform(random, 20, 50);
        more[i] += plays(play[i], stop[i]);
      }
      more[i] += rubs(limit[i]);
    }
    const Flood expected = flood([&](double h, double k) {
      const std::array<double, 2> at{h, k};
      std::array<double, 2> load{8.5 * std::sin(h) + 2.8 * std::sin(h + k), 2.8 * std::sin(h + k)};
      for (const std::size_t i : {0u, 1u}) {
        load[i] += stiffness[i] * at[i];
        if (std::abs(at[i]) > play[i]) load[i] += stop[i] * (at[i] - std::copysign(play[i], at[i]));
        if (std::abs(load[i]) > limit[i]) return false;
      }
      return true;
    });
    const FrictionBand band = band_of(two_hinges(more[0], more[1]));
    CAPTURE(trial, limit, stiffness, play, stop, band.message, expected.low, expected.high);
    for (const std::size_t i : {0u, 1u}) {
      const BandExtent& found = extent_in(band, i == 0 ? "h" : "k");
      CAPTURE(i, found.low, found.high);
      const bool endless_there = expected.high[i] > flood_range - 2 * flood_step;
      CHECK((endless_there ? found.high > flood_range - 2 * flood_step
                           : std::abs(found.high - expected.high[i]) < 3 * flood_step));
      CHECK((endless_there ? found.low < 2 * flood_step - flood_range
                           : std::abs(found.low - expected.low[i]) < 3 * flood_step));
      round += endless_there;
      bounded += !endless_there;
      past_stops += found.high > play[i];
    }
  }
  CHECK(bounded > 20);
  CHECK(past_stops > 6);
  CHECK(round > 6);
}

namespace {

// Two links in a plane that turns about the upright through their hinge: masses at their ends.
struct TurningLinks {
  double speed = 0;
  std::array<double, 2> mass{}, length{};
  double slant = 0;                                               // of the first, from the upright as drawn
  double spring = 0, lower = -endless, upper = endless, stop = 0; // of the second; of the first
  std::array<double, 2> limit{};

  Mechanism scene() const {
    const double x = length[0] * std::sin(slant), y = -length[0] * std::cos(slant);
    std::string first = rubs(limit[0]);
    if (stop > 0)
      first += R"(, "stop": {"lower": )" + number_text(lower) + R"(, "upper": )" + number_text(upper) +
               R"(, "stiffness": )" + number_text(stop) + "}";
    const std::string second = rubs(limit[1]) + (spring > 0 ? sprung(spring, 0) : "");
    const auto at = [](double px, double py) {
      return "[" + number_text(px) + ", " + number_text(py) + ", 0]";
    };
    return read_scene(R"({"flyball": 2, "name": "Turning links", "gravity": [0, "=-g", 0],
      "parameters": {"g": {"value": 10, "unit": "m/s^2"}},
      "bodies": [{"name": "shaft", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
        {"name": "a", "mass": )" +
                      number_text(mass[0]) + R"(, "position": )" + at(x, y) + R"(},
        {"name": "b", "mass": )" +
                      number_text(mass[1]) + R"(, "position": )" + at(x, y - length[1]) + R"(}],
      "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0],
          "axis": [0, 1, 0], "drive": {"speed": )" +
                      number_text(speed) + R"(}},
        {"name": "h", "type": "revolute", "bodies": ["shaft", "a"], "at": [0, 0, 0], "axis": [0, 0, 1])" +
                      first + R"(},
        {"name": "k", "type": "revolute", "bodies": ["a", "b"], "axis": [0, 0, 1], "at": )" +
                      at(x, y) + second + "}]}");
  }

  // What friction would have to give.
  std::array<double, 2> loads(double g, double h, double k) const {
    const double x1 = length[0] * std::sin(h + slant), y1 = -length[0] * std::cos(h + slant);
    const double x2 = length[1] * std::sin(h + k), y2 = -length[1] * std::cos(h + k);
    const double n2 = speed * speed;
    double first = mass[0] * (g * x1 + n2 * x1 * y1) + mass[1] * (g * (x1 + x2) + n2 * (x1 + x2) * (y1 + y2));
    if (stop > 0) first += stop * (std::min(0., h - lower) + std::max(0., h - upper));
    return {first, mass[1] * (g * x2 + n2 * (x1 + x2) * y2) + spring * k};
  }
};

} // namespace

TEST_CASE("no band along a curve falls short of what places tell", "[placed-band]") {
  // Of the first one output rises, falls and rises again along an edge of the box of shares, past the kink of
  // a stop; the others are unstable, and the balance folds between the ways to corners.
  struct Case {
    TurningLinks links;
    double g, h, k;
    bool told;
  };
  const TurningLinks stopped{.speed = 3.887976970119407,
                             .mass = {0.92845, 1.19486},
                             .length = {0.503514, 0.234774},
                             .lower = -0.618933,
                             .upper = 0.982951,
                             .stop = 54.08313,
                             .limit = {10.89367, 2.553943}};
  const TurningLinks upright{.speed = 5.327550455,
                             .mass = {1.0858102, 0.5751492},
                             .length = {0.3832019, 0.205256},
                             .slant = -0.21672286,
                             .spring = 1.432808,
                             .limit = {6.0434687, 0.461335}};
  const auto each = GENERATE_COPY(Case{stopped, 10, 0, 0, true}, Case{upright, 10.22, -3.0784, 0.7696, false},
                                  Case{upright, 10.65, -3.0837, 0.8212, false});
  const RibbonPoint point =
      friction_ribbon(each.links.scene(), "parameters.g", {{{each.g, {{"h", each.h}, {"k", each.k}}}}})
          .front();
  CAPTURE(each.g, point.message);
  const BandExtent *h = find_extent(point, "h"), *k = find_extent(point, "k");
  CHECK((h && k) >= each.told);
  if (!h || !k) {
    CHECK_THAT(point.message, ContainsSubstring("the balance folds"));
    return;
  }
  constexpr double step = 0.005;
  const Flood expected = flood(
      [&](double a, double b) {
        const std::array<double, 2> load = each.links.loads(each.g, h->value + a, k->value + b);
        return std::abs(load[0]) <= each.links.limit[0] && std::abs(load[1]) <= each.links.limit[1];
      },
      step);
  CHECK_THAT(h->low - h->value, WithinAbs(expected.low[0], 3 * step));
  CHECK_THAT(h->high - h->value, WithinAbs(expected.high[0], 3 * step));
  CHECK_THAT(k->low - k->value, WithinAbs(expected.low[1], 3 * step));
  CHECK_THAT(k->high - k->value, WithinAbs(expected.high[1], 3 * step));
}

TEST_CASE("of three hinges on a shaft the first goes over to the other side, too", "[placed-band]") {
  // Alike to both sides, which a neck joins: flooded by 0.05 rad it reaches from -2.11 to 2.09 rad. Only one
  // side was found, down to -0.47 rad.
  const auto at = [](double y) { return "[0, " + number_text(y) + ", 0]"; };
  const auto hinge = [&](const char* name, const char* a, const char* b, double y, const std::string& more) {
    return R"(, {"name": ")" + std::string(name) + R"(", "type": "revolute", "bodies": [")" + a + R"(", ")" +
           b + R"("], "axis": [0, 0, 1], "at": )" + at(y) + more + "}";
  };
  const FrictionBand band = band_of(read_scene(
      R"({"flyball": 2, "name": "Three hinges", "gravity": [0, -10, 0],
      "bodies": [{"name": "shaft", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
        {"name": "a", "mass": 1.06, "position": )" +
      at(-0.529) + R"(}, {"name": "b", "mass": 0.54, "position": )" + at(-1.016) +
      R"(}, {"name": "c", "mass": 0.84, "position": )" + at(-1.597) +
      R"(}], "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0],
          "axis": [0, 1, 0], "drive": {"speed": 5.07}})" +
      hinge("h", "shaft", "a", 0, rubs(27.3)) + hinge("k", "a", "b", -0.529, sprung(5.81, 0) + rubs(3.8)) +
      hinge("l", "b", "c", -1.016, rubs(3.46)) + "]}"));
  INFO(band.message);
  CHECK(band.at_least);
  for (const auto& [name, most] : {std::pair("h", 2.1434), std::pair("k", 1.1668), std::pair("l", 1.8040)}) {
    CAPTURE(name);
    CHECK_THAT(extent_in(band, name).low, WithinAbs(-most, 1e-4));
    CHECK_THAT(extent_in(band, name).high, WithinAbs(most, 1e-4));
  }
}

TEST_CASE("of a measure that jumps within a band no extent is told", "[placed-band]") {
  const double limit = GENERATE(3., 12.);
  const auto upwards = [](const char* name, const char* factor) {
    return "\"" + std::string(name) + R"(": {"value": "=)" + factor +
           R"json(*atan2(-x(p), y(p))", "unit": "rad"})json";
  };
  const std::string measures =
      upwards("half", "0.5") + ", " + upwards("up", "1") + ", " + upwards("twice", "2");
  const bool two = GENERATE(false, true);
  const FrictionBand band = band_of(two_hinges(rubs(limit), two ? rubs(0.3) : "", 10, measures));
  CHECK_THAT(band.message, ContainsSubstring("No extent is told of half, which jumps within the band."));
  CHECK(std::ranges::find(band.extents, "half", &BandExtent::name) == band.extents.end());
  const BandExtent &h = extent_in(band, "h"), &up = extent_in(band, "up"), &twice = extent_in(band, "twice");
  CHECK((up.high - up.low == h.high - h.low || std::abs(up.high - up.low - h.high + h.low) < 1e-9));
  CHECK((twice.high - twice.low == h.high - h.low ||
         std::abs(twice.high - twice.low - 2 * (h.high - h.low)) < 1e-9));
}

TEST_CASE("brakes that gears tie hold by the sum of their limits, and others have their band beside them",
          "[placed-band]") {
  // 2 N m at rest against 1.2 N m and, through a gear of -2, 0.5 N m; a bob of 1 kg on 0.5 m beside them.
  const double second = GENERATE(0.5, 0.39);
  const Mechanism m =
      read_scene(R"json({"flyball": 2, "name": "Two brakes", "gravity": [0, -10, 0],
    "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.15, 0.1]},
      {"name": "c", "mass": 1, "position": [0.3, 0, 0], "inertia": [0.1, 0.15, 0.1]},
      {"name": "bob", "mass": 1, "position": [0.1, -0.5, 0]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=2 N m - 0.4 N m s*rate(spin)", "speed": 5
}
, "friction" : {
  "limit" : 1.2
}
}
, {"name": "pc", "type": "revolute", "bodies": ["ground", "c"], "at": [0.3, 0, 0], "axis": [0, 1, 0])json" +
                 rubs(second) +
                 R"json(}, {"name": "g", "type": "gear", "joints": ["spin", "pc"], "ratio": -2},
      {"name": "swing", "type": "revolute", "bodies": ["a", "bob"], "at": [0.1, 0, 0], "axis": [0, 0, 1],
        "friction": {"limit": 0.3}}]})json");
  const Solution s = Analysis(m).solve();
  REQUIRE(s.status == Status::converged);
  const FrictionBand band = report_friction(m, s).band;
  if (second == 0.5) {
    CHECK_THAT(find_holding(m, {}).takes.value(), WithinRel(2 / 2.2, 1e-12));
    CHECK_THAT(extent_in(band, "swing").high, WithinAbs(std::asin(0.3 / 5), 1e-12));
    CHECK(band.message == "It is the band while spin stands and pc stands.");
  } else {
    CHECK_THAT(extent_in(band, "spin.speed").high, WithinRel((2 - 1.2 - 2 * 0.39) / 0.4, 1e-9));
  }
}

TEST_CASE("what torques give against each other on brakes that gears tie is held as their sum",
          "[placed-band]") {
  // 2 N m at rest against 1.2 N m and, through a gear of -2, 0.5 N m. Where the bob stands, within asin(0.3 /
  // 5), torques of both shafts are others: they cancel, or do so but for 6 N m/rad.
  const double left = GENERATE(0., 0.1);
  const Mechanism m = read_scene(R"json({"flyball": 2, "name": "Two brakes", "gravity": [0, -10, 0],
    "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0], "inertia": [0.1, 0.15, 0.1]},
      {"name": "c", "mass": 1, "position": [0.3, 0, 0], "inertia": [0.1, 0.15, 0.1]},
      {"name": "bob", "mass": 1, "position": [0.1, -0.5, 0]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=2 N m + )json" +
                                 number_text(20 - left * 60) +
                                 R"json( N m/rad*coordinate(swing) - 0.4 N m s*rate(spin)", "speed": 5},
        "friction": {"limit": 1.2}},
      {"name": "pc", "type": "revolute", "bodies": ["ground", "c"], "at": [0.3, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=10 N m/rad*coordinate(swing)", "speed": 1}, "friction": {"limit": 0.5}},
      {"name": "g", "type": "gear", "joints": ["spin", "pc"], "ratio": -2},
      {"name": "swing", "type": "revolute", "bodies": ["a", "bob"], "at": [0.1, 0, 0], "axis": [0, 0, 1],
        "friction": {"limit": 0.3}}]})json");
  const FrictionBand band = band_of(m);
  CAPTURE(band.message);
  if (left == 0) {
    CHECK_THAT(extent_in(band, "swing").high, WithinAbs(std::asin(0.3 / 5), 1e-12));
    CHECK(band.message == "It is the band while spin stands and pc stands.");
  } else { // 6 N m/rad at 0.06 rad are more than 0.2 N m
    CHECK_FALSE(band.found);
    CHECK_THAT(band.message, ContainsSubstring("may have to hold more than its limit"));
  }
}
