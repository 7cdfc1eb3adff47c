// The expressions of a mechanism, read, checked and put in order once, to be evaluated again and again as its
// numbers change.
#pragma once

#include "engine/mechanism/number_rates.hpp"

#include <memory>

namespace flyball {

class FormulaPlan {
 public:
  // Of the mechanism as it stands: it and its parts must stay where they are, and its expressions as they
  // are. Throws SceneError that names the place: an expression that cannot be read, an unknown name, a
  // dimension that does not fit, a circle of parameters.
  explicit FormulaPlan(Mechanism& mechanism);
  ~FormulaPlan();
  FormulaPlan(FormulaPlan&&) noexcept;
  FormulaPlan& operator=(FormulaPlan&&) noexcept;

  // Sets every number that an expression gives, dependent parameters and points first, and what follows from
  // densities. Throws SceneError for a value that is not finite and for a density without a volume; what was
  // set before stays set then. Allocates nothing but for bodies with a density and what it throws.
  void evaluate();

  // With the rates of numbers that no expression gives also those of all that expressions and densities make
  // of them, by forward-mode differentiation, at the numbers as they stand after `evaluate`. Throws
  // SceneError for a rate that is not finite.
  void differentiate(NumberRates& rates) const;

 private:
  struct State;
  std::unique_ptr<State> state_; // null where there is nothing to evaluate
};

} // namespace flyball
