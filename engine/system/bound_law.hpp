// The laws of springs and dampers (force_law.hpp) with their numbers.
#pragma once

#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/system/spatial.hpp"

#include <memory>
#include <optional>
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
  // Of a damper's law, by its rate: whether it takes up energy where it hardly moves.
  bool resists_at_rest() const;

 private:
  std::shared_ptr<const ForceLaw> law_;
  std::vector<Dual> numbers_;
};

// A straight line that meets the law at x, of this slope.
BoundLaw line_through(const BoundLaw& law, double x, double slope);

// Of a spring and damper; most have none.
template <class N>
struct BasicForceLaws {
  BoundLaw spring, damper;
  N free = 0; // m or rad, from which the deflection is counted, whatever else the coordinate's springs do
};
using ForceLaws = BasicForceLaws<double>;

// The coefficients of a vane's lift and drag by its incidence.
struct Polar {
  BoundLaw lift, drag;
};

// A law, or where there is none a number in its place, with the numbers of a mechanism as they are read.
template <class N>
BoundLaw bind_law(const Mechanism& mechanism, std::shared_ptr<const ForceLaw> law,
                  const std::optional<double>& number, const NumberReader<N>& read) {
  std::vector<Dual> numbers;
  if (law)
    read_named(mechanism, law->names(), read, numbers);
  else if (number)
    numbers = {Dual(read(*number))};
  return {std::move(law), std::move(numbers)};
}

} // namespace flyball
