// The speed of a drive as a function of the number that a study varies.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>

namespace flyball {

// The drive whose turns orders count along the number at `address`: one that turns with this as its speed,
// else one whose speed an expression makes of it, and perhaps of others.
class DriveSpeed {
 public:
  DriveSpeed(const Mechanism& mechanism, std::string address);

  const std::string& joint() const { return joint_; } // empty: there is no such drive
  bool is_number() const { return !varied_; }         // the number itself is the speed
  // rad/s, where the number has that value. NaN where expressions make nothing of it.
  double at(double value);
  double rate(double value); // d at / d value; likewise

 private:
  bool set(double value);

  std::string address_, joint_, speed_, formula_; // the last two, the drive's, where it is not the number
  std::optional<Mechanism> varied_;               // where there is a formula
};

} // namespace flyball
