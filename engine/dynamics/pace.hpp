// How long the steps of an integrator are, and whether as many as are allowed could ever do.
#pragma once

#include "engine/mechanism/text.hpp"

#include <string>

namespace flyball {

class Pace {
 public:
  explicit Pace(long max_steps) : max_steps_(max_steps) {}

  long taken = 0; // steps

  // From t (s) on.
  void judge_from(double t) {
    judged_at_ = taken;
    judged_from_ = t;
  }

  // As a clause; empty before there are enough of them. `fastest` (1/s): of the linearised motion about the
  // start, 0: not known.
  std::string text(double t, double fastest) const {
    if (taken - judged_at_ < 10) return "";
    std::string out = "; its last steps took " +
                      rounded_text((t - judged_from_) / static_cast<double>(taken - judged_at_), 2) +
                      " s each";
    if (fastest > 0) out += ", the fastest motion about the start is at " + rounded_text(fastest, 2) + " 1/s";
    return out;
  }

  // Steps so short that the way from t to `end` (s) would never be done, however many were allowed: reported
  // at once.
  bool is_hopeless(double t, double end) {
    constexpr long judged_steps = 5000;
    if (taken - judged_at_ < judged_steps) return false;
    if (end - t > given_up_at() * (t - judged_from_) / judged_steps) return true;
    judge_from(t);
    return false;
  }
  // Steps that the rest may need, far more than are allowed.
  double given_up_at() const { return 100 * static_cast<double>(max_steps_); }

 private:
  long max_steps_;
  long judged_at_ = 0;
  double judged_from_ = 0; // s
};

} // namespace flyball
