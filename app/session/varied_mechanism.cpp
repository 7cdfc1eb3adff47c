#include "app/session/varied_mechanism.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"

#include <utility>

namespace flyball {

const SharedMechanism& VariedMechanism::of(const std::shared_ptr<const Mechanism>& mechanism,
                                           const Explored& numbers) {
  if (from_ == mechanism && numbers_ == numbers) return varied_;
  Mechanism varied = *mechanism;
  for (const ExploredValue& number : numbers) {
    try {
      set_parameter(varied, number.address, number.value);
    } catch (const SceneError&) { // what cannot be varied counts as it is
    }
  }
  varied.sliders.clear();
  varied.view.camera.reset();
  varied.simulation = {};
  from_ = mechanism;
  numbers_ = numbers;
  // The same pointer as long as it is the same is found equal without a look.
  if (!varied_.pointer || *varied_.pointer != varied)
    varied_.pointer = std::make_shared<const Mechanism>(std::move(varied));
  return varied_;
}

} // namespace flyball
