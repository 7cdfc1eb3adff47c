#pragma once
// The greatest value of a function of one variable on an interval, without derivatives.

namespace flyball {

struct Greatest {
  double at = 0, value = 0;
};

// By golden sections (Kiefer 1953) until the interval is not wider than `width`. A function with several
// crests gives one of them.
template <class Function>
Greatest golden_section(double low, double high, double width, const Function& f) {
  constexpr double golden = 0.6180339887498949;
  Greatest x{high - golden * (high - low), 0}, y{low + golden * (high - low), 0};
  x.value = f(x.at);
  y.value = f(y.at);
  while (high - low > width) {
    if (x.value > y.value) {
      high = y.at;
      y = x;
      x.at = high - golden * (high - low);
      x.value = f(x.at);
    } else {
      low = x.at;
      x = y;
      y.at = low + golden * (high - low);
      y.value = f(y.at);
    }
  }
  return x.value > y.value ? x : y;
}

} // namespace flyball
