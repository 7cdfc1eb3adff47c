// Numbers of a mechanism that are set again and again.
#pragma once

#include "engine/mechanism/formula_plan.hpp"
#include "engine/mechanism/numbers.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball {

class VariedNumbers {
 public:
  // Finds them, and what expressions make of them. The mechanism and its parts must stay where they are, and
  // its expressions as they are. Throws SceneError for an address that names no number or one that an
  // expression gives, and as FormulaPlan does.
  VariedNumbers(Mechanism& mechanism, std::span<const std::string> addresses);

  std::size_t size() const { return places_.size(); }
  // As they stand, by address.
  std::vector<double> values() const;

  // Sets them all, by address, and all that expressions make of them; several of the same address one after
  // the other. Throws SceneError for a value that is not finite or of which an expression can make nothing;
  // the mechanism is then as it was. Allocates nothing else (but see FormulaPlan).
  void set(std::span<const double> values);

  // How fast all numbers of the mechanism change when the number at address `i` does, at the numbers as they
  // stand. Throws SceneError for a rate that is not finite.
  void rates(std::size_t i, NumberRates& out) const;

 private:
  struct Place {
    std::string address;
    Number number; // `value` as it stands
  };
  std::vector<Place> places_;
  FormulaPlan plan_;
};

} // namespace flyball
