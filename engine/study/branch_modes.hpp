// The modes of the states along a branch of a response, and between its points.
#pragma once

#include "engine/report/friction_parts.hpp"
#include "engine/study/campbell.hpp"
#include "engine/study/drive_speed.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

class BranchModes {
 public:
  // Over the number at `address`. Both must stay as they are.
  BranchModes(const Mechanism& mechanism, const std::string& address, const std::atomic<bool>* cancel);

  bool turns() const { return !drive_.joint().empty(); }
  DriveSpeed& drive() { return drive_; }

  // Of a point of the branch, with the whirl of each. No lines yet.
  CampbellPoint at(const ResponsePoint& point);
  // At a value between those of two points; none where there is no such state.
  std::vector<VibrationMode> between(const ResponsePoint& a, const ResponsePoint& b, double value);
  // Of a mode of the last state. Nothing without a drive that turns.
  std::optional<Whirl> whirl(const VibrationMode& mode);

 private:
  Analysis& solved() { return on_friction_ ? on_friction_->analysis : analysis_; }
  bool solve(double value, std::vector<std::pair<std::string, double>> start,
             const std::vector<FrictionForce>& frictions);
  bool same_as(const ResponsePoint& point) const;

  const Mechanism& mechanism_;
  const std::string& address_;
  DriveSpeed drive_;
  Analysis analysis_;
  std::optional<StateOnFriction> on_friction_; // of the last solve
  const std::atomic<bool>* cancel_;
  Solution solution_;
};

// How unlike a mode is to the one that is `part` of the way along a line from its mode `a` to its mode `b`:
// by eigenvalue, and by shape (modal_assurance()).
double unlikeness(const VibrationMode& mode, const VibrationMode& a, const VibrationMode& b, double part);

} // namespace flyball
