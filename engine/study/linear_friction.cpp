#include "engine/study/linear_friction.hpp"

#include "engine/dynamics/friction_modes.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/study/input_effect.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace flyball {
namespace {

// What friction gives is a number once it slips, and so is what a load by an expression, or a damper where
// the drives give the rate, gives beside it.
void refuse_as_input(Mechanism& mechanism, std::span<const LinearInput> inputs, CoordinateReference at,
                     bool implied) {
  const Friction& friction = friction_at(mechanism, at);
  const Joint& joint = joint_of(mechanism, at);
  const Coordinate& c = joint.coordinates[static_cast<std::size_t>(at.coordinate)];
  const bool load = c.drive && !drive_law(mechanism, joint, at.coordinate, "load");
  for (const LinearInput& input : inputs) {
    if (input.address.empty()) continue;
    const VariedNumbers number(mechanism, {&input.address, 1});
    NumberRates rates;
    number.rates(0, rates);
    const auto moves = [&](const auto& other) { return rates.find(place_of(other)).value_or(0) != 0; };
    for (const std::optional<double>* of_limit :
         {&friction.limit, &friction.mu, &friction.preload, &friction.radius})
      if (moves(*of_limit))
        throw Refusal{"The input " + input.name + " has no place in a linear model: it is in the limit of " +
                      joint.name + ", which slips."};
    if ((implied && moves(c.damping)) || (load && moves(c.drive->load)))
      throw Refusal{"The input " + input.name +
                    " has no place in a linear model: it is in the load or the damping of " + joint.name +
                    ", where friction slips."};
  }
}

} // namespace

Mechanism driven_by_slipping(const LinearSignals& signals, const StateOnFriction& state) {
  Mechanism mechanism = signals.mechanism;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  FrictionParts slips = state.parts;
  for (std::size_t i = 0; i < slips.size(); ++i)
    if (is_slipping(slips[i]))
      refuse_as_input(mechanism, signals.inputs, frictions[i], i < state.implied.size() && state.implied[i]);
    else
      slips[i] = FrictionPart::none;
  if (std::ranges::none_of(slips, is_slipping)) return mechanism;
  Mechanism driven = driven_by_parts(mechanism, frictions, slips, state.implied);
  if (driven.measures.size() != mechanism.measures.size())
    throw Refusal{"A measure is not told of joints on which friction slips."};
  return driven;
}

std::vector<HeldCoordinate> held_by_friction(const Mechanism& mechanism, const MotionModel& model,
                                             const Solution& steady) {
  std::vector<HeldCoordinate> held;
  for (const FrictionElement& element : list_frictions(model)) {
    const Link& link = model.system.links[static_cast<std::size_t>(element.link)];
    const std::string name = coordinate_label(model.system, link);
    double part = std::abs(friction_at(mechanism, find_coordinate(mechanism, name)).share);
    for (const FrictionForce& force : steady.frictions)
      if (force.value && coordinate_label(force) == name) part = std::abs(*force.value) / element.limit;
    if (part >= 1 / slipping_by)
      throw Refusal{"Dry friction in " + name +
                    " is at its limit: it holds small motions to one side and lets those to the other go, "
                    "of which nothing linear tells."};
    held.push_back({name, link.v});
  }
  return held;
}

} // namespace flyball
