// The laws of springs and dampers (force_law.hpp) with their numbers.
#pragma once

#include "engine/mechanism/force_law.hpp"
#include "engine/system/spatial.hpp"

#include <memory>
#include <type_traits>
#include <vector>

namespace flyball {

class BoundLaw {
 public:
  BoundLaw() = default; // none: no force
  // `numbers`: by names of the law, with or without rates; of no law the constant force.
  BoundLaw(std::shared_ptr<const ForceLaw> law, std::vector<Dual> numbers);

  explicit operator bool() const { return law_ || !numbers_.empty(); }

  Dual operator()(Dual x) const;
  // Evaluated in double precision: what a law rounds is no more than the numbers it is given by. What S has
  // beyond that goes on along the slope.
  template <class S>
  S value(const S& x) const {
    if constexpr (std::is_same_v<S, Dual>) {
      return (*this)(x);
    } else if constexpr (std::is_same_v<S, double>) {
      return (*this)(Dual(x)).value;
    } else {
      const auto rounded = static_cast<double>(x);
      const Dual there = (*this)(Dual(rounded, 1));
      return S(there.value) + S(there.rate) * (x - S(rounded));
    }
  }
  double slope(double x) const { return (*this)(Dual(x, 1)).rate; }
  // The integral from 0 to x (J).
  double energy(double x) const;

 private:
  std::shared_ptr<const ForceLaw> law_;
  std::vector<Dual> numbers_;
};

// Of a spring and damper; most have none.
template <class N>
struct BasicForceLaws {
  BoundLaw spring, damper;
  N free = 0; // m or rad, from which the deflection is counted
};

} // namespace flyball
