#include "app/session/varied_mechanism.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"

#include <utility>

namespace flyball {

const SharedMechanism& VariedMechanism::of(const std::shared_ptr<const Mechanism>& mechanism,
                                           const Explored& numbers) {
  if (from_ == mechanism && numbers_ == numbers) return varied_;
  Mechanism varied = *mechanism;
  std::vector<ParameterValue> values;
  for (const ExploredValue& number : numbers)
    values.push_back({number.address, number.value});
  try {
    set_parameters(varied, values);
  } catch (const SceneError&) { // what cannot be varied counts as it is
    for (const ParameterValue& each : values) {
      try {
        set_parameter(varied, each.address, each.value);
      } catch (const SceneError&) {
      }
    }
  }
  varied.name.clear();
  varied.description.clear();
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
