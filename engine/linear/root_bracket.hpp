#pragma once
// A root of a continuous function of one variable between two places at which its signs differ.
#include <cmath>

namespace flyball {

// By the method of false position with the Illinois modification (Dowell and Jarratt 1971): where one end
// stays, its value counts half. A function that steps, or is infinite at an end, has its bracket halved. The
// ends may stand in either order.
class RootBracket {
 public:
  RootBracket(double low, double at_low, double high, double at_high)
      : low_(low), at_low_(at_low), high_(high), at_high_(at_high) {}

  double low() const { return low_; }
  double high() const { return high_; }
  double width() const { return std::abs(high_ - low_); }
  double middle() const { return low_ + (high_ - low_) / 2; }

  // Where to look next: strictly between the ends, unless no number is.
  double next() const {
    const double x = low_ - at_low_ * (high_ - low_) / (at_high_ - at_low_);
    return (x - low_) * (high_ - x) > 0 ? x : middle();
  }

  // The value there (not zero), which takes the place of the end of the same sign.
  void take(double x, double value) {
    if ((value < 0) == (at_high_ < 0)) {
      high_ = x;
      at_high_ = value;
      if (kept_ == -1) at_low_ /= 2;
      kept_ = -1;
    } else {
      low_ = x;
      at_low_ = value;
      if (kept_ == 1) at_high_ /= 2;
      kept_ = 1;
    }
  }

 private:
  double low_, at_low_, high_, at_high_;
  int kept_ = 0; // which end stayed the last time: -1 low, 1 high
};

} // namespace flyball
