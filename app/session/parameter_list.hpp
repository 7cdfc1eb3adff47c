// Which numbers of a mechanism get a slider: those pinned in the scene, every named parameter, every drive's
// speed and every spring's stiffness; for the motion, every damper. None that an expression gives.
#pragma once

#include "app/session/units.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

enum class ParameterGroup { pinned, named, drives, springs, dampers };

struct ParameterControl {
  std::string address;
  ParameterGroup group = ParameterGroup::pinned;
  std::string name; // of the joint, body or force
  std::string what; // "speed", "stiffness", ...: what of it; see speed_kind()
  std::string unit; // "rad/s", "N/m", ...
  double value = 0;
  double from = 0, to = 1;
  bool log = false;
  double file_value = 0; // as read from the file
  double step = 0;       // values a slider stops at: multiples of it; 0 for log
};

// In groups; within a group in the scene's order. `file` is what the file says (of which the mechanism may
// have gone away by edits): file_value and an automatic slider's range come from there where it has the
// number. Ends of automatic sliders are round in `units`.
std::vector<ParameterControl> parameter_controls(const Mechanism& mechanism, const Mechanism& file,
                                                 const DisplayUnits& units = {});

// Of any number, with a range that suits it: as pinning it would make one. None where there is no such
// number, or an expression gives it.
std::optional<ParameterControl> number_control(const Mechanism& mechanism, const Mechanism& file,
                                               const std::string& address, const DisplayUnits& units);

// After the number at `address` was set in the mechanism and nowhere else: the same as parameter_controls()
// anew. False where that takes more than the value of one of them.
bool take_value(std::vector<ParameterControl>& controls, const Mechanism& mechanism, const Mechanism& file,
                const std::string& address);

// A slider with a range that suits the number's present value and is round in `units`. Throws SceneError for
// an unknown address.
Slider slider_for(const Mechanism& mechanism, const std::string& address, const DisplayUnits& units);
// Of a new drive that turns (rad/s): 10, or the next that is round as it is shown.
double new_drive_speed(const DisplayUnits& units);
// "speed of spin", "mass of ball1", "y of gravity".
std::string parameter_phrase(std::string_view address);
// What a drive's speed is that is not the one of the steady state: by which a drive keeps its momentum, that
// of the drawn pose, where the momentum is made; of a drive by torque the guess that the search begins at.
enum class SpeedKind { prescribed, drawn, guessed };
// Prescribed for all other numbers.
SpeedKind speed_kind(const Mechanism& mechanism, const std::string& address);
// As parameter_phrase(), but "drawn speed of spin" or "guessed speed of spin" where it is one.
std::string number_phrase(const Mechanism& mechanism, const std::string& address);
// The sentence with the number's phrase where it names the address.
std::string with_phrase(std::string sentence, const std::string& address);

// What a slider of a linear range stops at: about a two-hundredth of it, a power of ten.
double slider_step(double span);
// The control's place on a slider from 0 to 1, and back to a value rounded to what a hand can set.
double slider_place(const ParameterControl& control, double value);
double slider_value(const ParameterControl& control, double place, bool fine);

} // namespace flyball
