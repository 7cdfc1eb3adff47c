// Modes followed over a drive's speed, their whirl and the critical speeds, against closed forms.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/campbell.hpp"
#include "engine/study/drive_speed.hpp"

#include <algorithm>
#include <numbers>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr double natural = 10, along = 14;
const std::string spin_speed = "joints.spin.drive.speed";

// A mass on equal springs across a turntable, which swings at natural +- speed, and another along its axis.
Mechanism turning_springs() {
  Mechanism m;
  m.bodies = {spindle(), body("x", 0, Vec3::Zero()), body("puck", 0.5, Vec3::Zero()),
              body("bell", 0.5, Vec3::Zero())};
  m.joints = {spin(1, {0, 0, 1}),
              sprung(prismatic("x", "spindle", "x", Vec3::Zero(), {1, 0, 0}), 0.5 * natural * natural),
              sprung(prismatic("y", "x", "puck", Vec3::Zero(), {0, 1, 0}), 0.5 * natural * natural),
              sprung(prismatic("z", "spindle", "bell", Vec3::Zero(), {0, 0, 1}), 0.5 * along * along)};
  return m;
}

CampbellDiagram diagram_of(const Mechanism& m, double from, double to, std::vector<double> orders) {
  return campbell_diagram(m, spin_speed, follow_branches(m, spin_speed, from, to), orders);
}

} // namespace

TEST_CASE("modes keep their lines where these cross, and whirl as the frame tells", "[campbell]") {
  for (const double way : {1., -1.}) {
    CAPTURE(way);
    const CampbellDiagram d = diagram_of(turning_springs(), way * 0.5, way * 9, {});
    REQUIRE(d.branches.size() == 1);
    const CampbellBranch& branch = d.branches[0];
    REQUIRE(branch.names.size() == 3);
    bool crossed = false;
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      const CampbellPoint& point = branch.points[i];
      const double speed = std::abs(d.response.branches[0].points[i].parameter);
      // By frequency at first: forward, which falls as seen from the frame, backward, along.
      const std::array wanted{natural - speed, natural + speed, along};
      for (std::size_t l = 0; l < 3; ++l) {
        REQUIRE(point.on(l));
        CHECK(std::abs(point.on(l)->eigenvalue - std::complex<double>(0, wanted[l])) < 1e-9);
        const std::optional<Whirl>& whirl = point.whirls[static_cast<std::size_t>(point.lines[l])];
        crossed = crossed || point.lines[l] != static_cast<int>(l);
        if (l == 2) {
          CHECK_FALSE(whirl); // nothing moves across the axis
          continue;
        }
        // At the crossing itself shapes of one frequency may be any mixture.
        if (std::abs(wanted[l] - along) < 1e-6) continue;
        REQUIRE(whirl);
        CHECK(whirl->turning);
        CHECK(std::abs(whirl->value - (l == 0 ? 1 : -1)) < 1e-9);
        const std::array seen = standing_frequencies(*whirl, wanted[l]);
        CHECK(std::abs(seen[l == 0 ? 0 : 1] - natural) < 1e-9);
      }
    }
    CHECK(crossed);
    CHECK(branch.names[2].ends_with("z"));
  }
}

TEST_CASE("critical speeds are where the closed forms have them", "[campbell]") {
  const CampbellDiagram d = diagram_of(turning_springs(), 0.5, 9, {1, 2});
  // natural - w = 2 w, natural - w = w, along = 2 w.
  const std::array speeds{natural / 3, natural / 2, along / 2};
  const std::array orders{2., 1., 2.};
  REQUIRE(d.critical.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(d.critical[i].speed - speeds[i]) < 1e-12 * speeds[i]);
    CHECK(std::abs(d.critical[i].speed - speeds[i]) <= 10 * d.critical[i].error);
    CHECK(d.critical[i].error < 1e-9);
    CHECK(d.critical[i].order == orders[i]);
    CHECK(std::abs(d.critical[i].frequency - orders[i] * speeds[i]) < 1e-11);
    CHECK(d.critical[i].stable);
  }
  CHECK(d.critical[0].whirl->value > 0.99);
  CHECK(d.critical[2].line == 2);
}

TEST_CASE("a mode that jumps over an order's line at a stop has no critical speed there", "[campbell]") {
  // A shoe on a spring along the radius of a hub comes to its stop where m w^2 (r + s) = k s.
  constexpr double m = 8, r = 0.3, k = 1000, s = 0.1, stiff = 1e5;
  Mechanism clutch;
  clutch.bodies = {spindle(), body("shoe", m, {r, 0, 0})};
  clutch.joints = {spin(1, {0, 0, 1}),
                   sprung(prismatic("guide", "spindle", "shoe", {r, 0, 0}, {1, 0, 0}), k)};
  clutch.joints[1].coordinates[0].stop = Stop{-s, s, stiff};
  const double contact = std::sqrt(k * s / (m * (r + s)));
  const CampbellDiagram d = diagram_of(clutch, 0.5, 12, {1, 2});
  // sqrt(k / m - w^2) = 2 w before it comes there; then it swings at more than 100 rad/s.
  const double twice = std::sqrt(k / m / 5);
  REQUIRE(twice < contact);
  REQUIRE(std::sqrt(k / m - contact * contact) < 2 * contact);
  REQUIRE(d.critical.size() == 1);
  CHECK(std::abs(d.critical[0].speed - twice) < 1e-9);
  CHECK(d.critical[0].frequency == Approx(2 * twice).epsilon(1e-9));
}

namespace {

const std::string speed = "parameters.w";

// A mass on a spring along the axis of a turntable, which stiffens with the speed so that it swings at
// w + curvature (w - touch)^2 + above, all in rad/s.
Mechanism stiffening(double curvature, double touch, double above) {
  Mechanism m;
  m.parameters = {{"w", "", 3, "rad/s", {}, {}},
                  {"curvature", "", curvature, "s", {}, {}},
                  {"touch", "", touch, "rad/s", {}, {}},
                  {"above", "", above, "rad/s", {}, {}}};
  m.bodies = {spindle(), body("bell", 0.5, Vec3::Zero())};
  m.joints = {spin(1, {0, 0, 1}), sprung(prismatic("z", "spindle", "bell", Vec3::Zero(), {0, 0, 1}), 1)};
  m.joints[0].formulas = {{"drive.speed", "w"}};
  m.joints[1].formulas = {{"spring.stiffness", "0.5 kg * (w + curvature * (w - touch)^2 + above)^2"}};
  evaluate_formulas(m);
  return m;
}

std::vector<CriticalSpeed> critical_speeds(const Mechanism& m, double from, double to) {
  const CampbellDiagram d =
      campbell_diagram(m, speed, follow_branches(m, speed, from, to), std::array{1., 2.});
  REQUIRE(d.response.branches.size() == 1);
  std::vector<CriticalSpeed> once;
  for (const CriticalSpeed& at : d.critical)
    if (at.order == 1) once.push_back(at);
  return once;
}

} // namespace

TEST_CASE("a mode that only touches an order's line is found at the double root", "[campbell]") {
  // Between the branch's points, from above and from below, and where the range ends beside it.
  for (const double curvature : {0.05, -0.05})
    for (const double touch : {3.0123, 4.777, 1.0001, 5.9999}) {
      CAPTURE(curvature, touch);
      const std::vector<CriticalSpeed> found = critical_speeds(stiffening(curvature, touch, 0), 1, 6);
      REQUIRE(found.size() == 1);
      CHECK(found[0].touches);
      CHECK(std::abs(found[0].speed - touch) <= found[0].error);
      CHECK(found[0].error < 1e-4);
      CHECK(std::abs(found[0].frequency - touch) < 1e-6);
    }
}

TEST_CASE("two crossings between two points of a branch are found, and none where it stays away",
          "[campbell]") {
  for (const double off : {1e-8, 1e-6, 1e-4}) {
    CAPTURE(off);
    const std::vector<CriticalSpeed> found = critical_speeds(stiffening(0.05, 3.0123, -off), 1, 6);
    REQUIRE(found.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK_FALSE(found[i].touches);
      const double wanted = 3.0123 + (i == 0 ? -1 : 1) * std::sqrt(off / 0.05);
      CHECK(std::abs(found[i].speed - wanted) < 1e-9);
      CHECK(std::abs(found[i].speed - wanted) <= 10 * found[i].error);
      CHECK(found[i].error < 1e-9);
    }
    CHECK(critical_speeds(stiffening(0.05, 3.0123, off), 1, 6).empty());
  }
}

TEST_CASE("a critical speed at the very end of the range counts, once", "[campbell]") {
  // natural - w = w at 5; the end of one range and the beginning of the other.
  const CampbellDiagram below = diagram_of(turning_springs(), 1, natural / 2, {1}),
                        above = diagram_of(turning_springs(), natural / 2, 9, {1}),
                        back = diagram_of(turning_springs(), 9, natural / 2, {1});
  for (const CampbellDiagram* d : {&below, &above, &back}) {
    REQUIRE(d->critical.size() == 1);
    CHECK(std::abs(d->critical[0].speed - natural / 2) <= std::max(d->critical[0].error, 1e-14));
    CHECK(d->critical[0].error < 1e-11);
    CHECK_FALSE(d->critical[0].touches);
  }
  // At the end it only touches nothing tells from a crossing: it counts all the same.
  CHECK(critical_speeds(stiffening(0.05, 1, 0), 1, 6).size() == 1);
}

TEST_CASE("a tuned centrifugal pendulum runs along its order's line, which is told once", "[campbell]") {
  // Of length l at the radius R of a disc it swings at w sqrt(R / l), whatever the speed w.
  const auto tuned = [](double radius, double length) {
    Mechanism m;
    m.bodies = {spindle(), body("bob", 0.2, {radius + length, 0, 0})};
    m.joints = {spin(1, {0, 0, 1}), revolute("swing", "spindle", "bob", {radius, 0, 0}, {0, 0, 1})};
    return m;
  };
  for (const auto& [from, to] : {std::pair(1., 50.), std::pair(50., 1.), std::pair(-50., -1.)}) {
    CAPTURE(from, to);
    const CampbellDiagram d = diagram_of(tuned(0.08, 0.02), from, to, {1, 2, 3});
    REQUIRE(d.critical.size() == 1);
    CHECK(d.critical[0].order == 2);
    REQUIRE(d.critical[0].until);
    CHECK(d.critical[0].speed == std::min(from, to));
    CHECK(*d.critical[0].until == std::max(from, to));
    CHECK(d.critical[0].error == 0);
    CHECK(std::abs(d.critical[0].frequency - 2 * std::abs(d.critical[0].speed)) < 1e-10);
  }
  // From standstill, where nothing swings, it begins at the next point of the branch.
  const CampbellDiagram still = diagram_of(tuned(0.08, 0.02), 0, 50, {2});
  REQUIRE(still.critical.size() == 1);
  CHECK(still.critical[0].speed <= still.critical[0].error);
  CHECK(*still.critical[0].until == 50);
  // A little out of tune it never meets the line.
  CHECK(diagram_of(tuned(0.08, 0.02001), 1, 50, {1, 2, 3}).critical.empty());
}

TEST_CASE("a governor's critical speed is where its eigenvalue says", "[campbell]") {
  // Independently: the eigenvalues of plain solves, halved into.
  Mechanism m = load_scene(FLYBALL_ASSETS "/scenes/governor.json");
  const CampbellDiagram d = diagram_of(m, 1, 20, {1});
  REQUIRE_FALSE(d.critical.empty());
  for (const CriticalSpeed& at : d.critical) {
    const auto off = [&](double speed) {
      set_parameter(m, spin_speed, speed);
      const Solution s = Analysis(m).solve();
      double best = 1e300;
      for (const std::complex<double> e : s.eigenvalues.value())
        if (e.imag() > 0 && std::abs(e.imag() - speed) < std::abs(best)) best = e.imag() - speed;
      return best;
    };
    CHECK(std::abs(off(at.speed)) < 1e-8);
    CHECK(off(at.speed - 1e-3) * off(at.speed + 1e-3) < 0);
  }
}

TEST_CASE("orders are of speeds that are given", "[campbell]") {
  const auto drive_of = [](const Mechanism& m, const std::string& address) {
    return DriveSpeed(m, address).joint();
  };
  Mechanism m = turning_springs();
  CHECK(drive_of(m, spin_speed) == "spin");
  CHECK(drive_of(m, "joints.x.spring.stiffness").empty());
  // One that is kept by its momentum only turns as fast as that in the drawn pose.
  m.joints[0].coordinates[0].drive->keeps = DriveKeeps::momentum;
  CHECK(drive_of(m, spin_speed).empty());
}

TEST_CASE("over a number of which a drive's speed is an expression orders count the drive's turns",
          "[campbell]") {
  // As over the speed itself, and where the number makes it.
  struct Case {
    const char* speed;
    double from, to;
    double (*value)(double speed);
    double rate;
  };
  const std::string n = "parameters.n";
  for (const Case& c : {Case{"2 * n", 0.25, 4.5, [](double w) { return w / 2; }, 2},
                        Case{"-n", -9, -0.5, [](double w) { return -w; }, -1},
                        Case{"n - 5 rad/s", 5.5, 14, [](double w) { return w + 5; }, 1},
                        Case{"n^2 / (1 rad/s)", 0.7, 3, [](double w) { return std::sqrt(w); }, 4}}) {
    CAPTURE(c.speed);
    Mechanism m = turning_springs();
    m.parameters = {{"n", "", c.from, "rad/s", {}, {}}};
    m.joints[0].formulas = {{"drive.speed", c.speed}};
    evaluate_formulas(m);
    DriveSpeed drive(m, n);
    CHECK(drive.joint() == "spin");
    CHECK(drive.at(c.value(3)) == Approx(3).epsilon(1e-14));
    CHECK(drive.rate(2) == Approx(c.rate).epsilon(1e-14));
    const CampbellDiagram d = campbell_diagram(m, n, follow_branches(m, n, c.from, c.to), std::array{1., 2.});
    REQUIRE(d.critical.size() == 3);
    const std::array speeds{natural / 3, natural / 2, along / 2};
    const std::array orders{2., 1., 2.};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(d.critical[i].order == orders[i]);
      CHECK(std::abs(d.critical[i].speed - speeds[i]) < 1e-12 * speeds[i]);
      CHECK(std::abs(d.critical[i].speed - speeds[i]) <= 10 * d.critical[i].error);
      CHECK(d.critical[i].error < 1e-9);
      CHECK(std::abs(d.critical[i].value - c.value(speeds[i])) < 1e-12 * std::abs(c.value(speeds[i])));
      CHECK(d.critical[i].stable);
    }
    // About the drive's axis, as it turns.
    REQUIRE(d.critical[0].whirl);
    CHECK(d.critical[0].whirl->value > 0.99);
  }
}

TEST_CASE("modal assurance of shapes", "[campbell]") {
  Analysis analysis(turning_springs());
  REQUIRE(analysis.solve().status == Status::converged);
  const std::vector<VibrationMode> modes = analysis.modes();
  REQUIRE(modes.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(std::abs(modal_assurance(modes[i], modes[k]) - (i == k ? 1 : 0)) < 1e-9);
  // How the bodies move: the puck in a circle, the bell along the axis.
  const std::vector<BodyAmplitude> moved = analysis.body_amplitudes(modes[0]);
  REQUIRE(moved.size() == 4);
  CHECK(std::abs(std::abs(moved[2].displacement.x()) - std::abs(moved[2].displacement.y())) < 1e-12);
  CHECK(moved[3].displacement.norm() < 1e-9);
  CHECK(moved[0].displacement.norm() == 0);
}

TEST_CASE("a point whose loops are singular belongs to no mode", "[campbell]") {
  // At rest arms and links hang straight. A moment later both arms swing alike.
  const Mechanism m = shipped("governor_friction");
  const std::string w = "parameters.w";
  const CampbellDiagram d = campbell_diagram(m, w, follow_branches(m, w, 0, 30), {});
  bool left = false;
  for (std::size_t b = 0; b < d.branches.size(); ++b) {
    const CampbellBranch& branch = d.branches[b];
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      const ResponsePoint& at = d.response.branches[b].points[i];
      CAPTURE(b, i, at.parameter);
      if (at.singular_loops) {
        left = true;
        CHECK(branch.points[i].modes.empty());
        continue;
      }
      for (std::size_t l = 0; i > 0 && l < branch.names.size(); ++l) {
        const VibrationMode *mode = branch.points[i].on(l), *before = branch.points[i - 1].on(l);
        if (!mode || !before || !mode->oscillates() || !before->oscillates()) continue;
        if (at.parameter < 1) CHECK(mode->frequency == Approx(before->frequency).epsilon(0.02));
      }
    }
  }
  CHECK(left);
  CHECK(std::ranges::any_of(d.response.branches, [](const ResponseBranch& branch) {
    return left_out(branch, number_text, "rad/s").starts_with("Without modes at 0 rad/s. The loops");
  }));
  const Mechanism turning = turning_springs();
  for (const ResponseBranch& branch : diagram_of(turning, 0, 9, {}).response.branches)
    CHECK(left_out(branch, number_text, "rad/s").empty());
}

TEST_CASE("each branch tells of its own points without modes alone", "[campbell]") {
  // Arms that hang straight may do so at all speeds; beside these is the branch of those that swing out.
  const Mechanism m = shipped("governor");
  const CampbellDiagram d = diagram_of(m, 0, 30, {});
  REQUIRE(d.response.branches.size() == 2);
  std::size_t straight = 0;
  for (const ResponseBranch& branch : d.response.branches) {
    const auto arm = std::ranges::find(branch.points.back().coordinates, "arm1", &CoordinateSolution::joint);
    REQUIRE(arm != branch.points.back().coordinates.end());
    const bool hangs = std::abs(arm->value - std::numbers::pi / 2) < 1e-6;
    straight += hangs ? 1 : 0;
    const std::string text = left_out(
        branch, [](double speed) { return number_text(2 * speed); }, "half-turns");
    if (hangs)
      CHECK(text.starts_with("Without modes from 0 to 60 half-turns. The loops"));
    else
      CHECK(text.empty());
  }
  CHECK(straight == 1);
}

TEST_CASE("a steady state whose loops are singular has no modes, one beside it has", "[modes]") {
  for (const bool straight : {true, false}) {
    const Mechanism m = shipped("governor_friction", {{"parameters.w", straight ? 0. : 1.}});
    Analysis analysis(m);
    const Solution s = analysis.solve();
    REQUIRE(s.status == Status::converged);
    CAPTURE(s.message);
    CHECK(s.singular_loops == straight);
    CHECK(analysis.modes().empty() == straight);
    CHECK(s.eigenvalues.has_value() != straight);
    CHECK((s.message.find(singular_loops_message) != std::string::npos) == straight);
  }
  // Redundant everywhere: a linkage in a plane that is no singular pose.
  Analysis planar(shipped("fourbar_turntable"));
  CHECK_FALSE(planar.solve().singular_loops);
}
