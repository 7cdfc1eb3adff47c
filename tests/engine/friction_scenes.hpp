// Mechanisms with dry friction whose closed forms are known.
#pragma once

#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "tests/support/scenes.hpp"

#include <string>

namespace flyball::test {

// A mass of 2 kg at 0.5 m on a hinge with friction (N m), drawn at an angle from hanging straight down.
inline Mechanism rubbing_pendulum(double limit, double angle = 0) {
  const double x = 0.5 * std::sin(angle), y = -0.5 * std::cos(angle);
  return read_scene(R"({"flyball": 1, "name": "Pendulum", "gravity": [0, -10, 0],
    "bodies": [{"name": "bob", "mass": 2, "position": [)" +
                    number_text(x) + ", " + number_text(y) + R"(, 0]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "coordinate": )" +
                    number_text(angle) + R"(, "friction": {"limit": )" + number_text(limit) + "}}]}");
}

// A bead of 0.5 kg on a rod that turns about y, held by a spring (400 N/m, slack at 0.2 m) and by friction.
inline Mechanism bead_on_rod(double speed, double limit) {
  return read_scene(R"({"flyball": 1, "name": "Bead", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "rod", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]},
      {"name": "bead", "mass": 0.5, "position": [0.25, 0, 0]}],
    "joints": [{"name": "spin", "type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0],
      "axis": [0, 1, 0], "drive": {"speed": )" +
                    number_text(speed) + R"(}},
      {"name": "slide", "type": "prismatic", "bodies": ["rod", "bead"], "at": [0.25, 0, 0], "axis": [1, 0, 0],
      "coordinate": 0.25, "spring": {"stiffness": 400, "free": 0.2}, "friction": {"limit": )" +
                    number_text(limit) + "}}]}");
}

// The shipped governor with friction in its collar (N) and in the hinges of its arms (N m).
inline Mechanism rubbing_governor(double collar, double hinges) {
  Mechanism m = shipped("governor");
  for (Joint& joint : m.joints) {
    if (joint.name == "slide") joint.coordinates[0].friction.emplace().limit = collar;
    if (hinges > 0 && (joint.name == "arm1" || joint.name == "arm2"))
      joint.coordinates[0].friction.emplace().limit = hinges;
  }
  return m;
}

// Two shafts, each in a bearing of its own, 5 N m - 1 N m s w and -0.2 N m s w, and a joint between them.
inline Mechanism motor_and_load(const std::string& coupling) {
  return read_scene(R"json({"flyball": 2, "name": "Motor and load",
    "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0], "inertia": [0.2, 0.3, 0.2]},
      {"name": "b", "mass": 1, "position": [0, 0.1, 0], "inertia": [0.2, 0.3, 0.2]}],
    "joints": [{"name": "pa", "type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=5 N m - 1 N m s*rate(pa)", "speed": 5}},
      {"name": "pb", "type": "revolute", "bodies": ["ground", "b"], "at": [0, 0.1, 0], "axis": [0, 1, 0],
        "drive": {"torque": "=-0.2 N m s*rate(pb)", "speed": 3}},
      {"name": "c", "type": "revolute", "bodies": ["a", "b"], "at": [0, 0.05, 0], "axis": [0, 1, 0], )json" +
                    coupling + "}]}");
}

// A block of 2 kg on a spring of 50 N/m, slack at zero, with friction of 4 N: it rests within 0.08 m.
inline Mechanism block_on_spring() {
  return read_scene(R"({"flyball": 1, "name": "Block",
    "bodies": [{"name": "block", "mass": 2, "position": [0, 0, 0]}],
    "joints": [{"name": "slide", "type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0],
      "axis": [1, 0, 0], "spring": {"stiffness": 50}, "friction": {"mu": 0.2, "preload": 20}}]})");
}

// A slider of 0.8 kg above a crank of 0.1 m by a link of 0.3 m, upright in gravity, with friction (N) in its
// guide: at most 22.55 N are needed, right beside the lower dead centre.
inline Mechanism rubbing_slider_crank(double limit) {
  return read_scene(R"({"flyball": 1, "name": "Slider-crank", "gravity": [0, -9.80665, 0],
    "bodies": [{"name": "crank", "mass": 1, "position": [0, 0.1, 0], "inertia": [0.001, 0.001, 0.002]},
      {"name": "slider", "mass": 0.8, "position": [0, 0.4, 0]}],
    "joints": [{"name": "a", "type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
        "axis": [0, 0, 1]},
      {"name": "d", "type": "prismatic", "bodies": ["ground", "slider"], "at": [0, 0.4, 0], "axis": [0, 1, 0],
        "friction": {"limit": )" +
                    number_text(limit) + R"(}},
      {"name": "link", "type": "distance", "bodies": ["crank", "slider"],
        "points": [[0, 0.1, 0], [0, 0.4, 0]]}]})");
}

inline constexpr double clutch_shaft_speed = 20; // rad/s

// A shaft, a clutch to a disc of 0.02 kg m^2, and a brake between disc and ground. With `hinge` a block of 2
// kg beside them, on an arm of 0.5 m that is drawn level.
inline Mechanism clutch_and_brake(const std::string& clutch, const std::string& brake,
                                  const std::string& hinge = "") {
  const auto turning = [](const std::string& name, const std::string& parent, const std::string& child,
                          const std::string& x, const std::string& more) {
    return R"({"name": ")" + name + R"(", "type": "revolute", "bodies": [")" + parent + R"(", ")" + child +
           R"("], "at": [)" + x + R"(, 0, 0], "axis": [0, 0, 1], )" + more + "}";
  };
  const auto body = [](const std::string& name) {
    return R"({"name": ")" + name + R"(", "mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.02]})";
  };
  return read_scene(R"({"flyball": 2, "name": "Clutch", "gravity": [0, -10, 0], "bodies": [)" +
                    body("shaft") + ", " + body("disc") +
                    (hinge.empty() ? "" : R"(, {"name": "block", "mass": 2, "position": [1, 0, 0]})") +
                    R"(], "joints": [)" +
                    turning("shaft", "ground", "shaft", "0",
                            R"("drive": {"speed": )" + number_text(clutch_shaft_speed) + "}") +
                    ", " + turning("clutch", "shaft", "disc", "0", clutch) + ", " +
                    turning("brake", "ground", "disc", "0", brake) +
                    (hinge.empty() ? "" : ", " + turning("hinge", "ground", "block", "0.5", hinge)) + "]}");
}

} // namespace flyball::test
