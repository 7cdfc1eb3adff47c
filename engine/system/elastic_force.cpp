#include "engine/system/elastic_force.hpp"

#include "engine/system/bound_law.hpp"

namespace flyball {
namespace {

BoundLaw bound(const Mechanism& mechanism, const Formula& formula, std::string_view variable) {
  return bind_law(mechanism, std::make_shared<const ForceLaw>(formula.text, variable), {},
                  NumberReader<double>());
}

ElasticForce of_spring(const Mechanism& mechanism, const Formula* formula, const std::optional<double>& force,
                       double stiffness, double deflection) {
  if (!force) return {stiffness * deflection, stiffness * deflection * deflection / 2};
  if (!formula) return {*force, *force * deflection};
  const BoundLaw law = bound(mechanism, *formula, spring_variable);
  return {law.value(deflection), law.energy(deflection)};
}

} // namespace

ElasticForce elastic_force(const Mechanism& mechanism, const Joint& joint, int i, double deflection) {
  const CoordinateSpring& spring = *joint.coordinates[static_cast<std::size_t>(i)].spring;
  return of_spring(mechanism, spring_law(joint, i), spring.force, spring.stiffness, deflection);
}

ElasticForce elastic_force(const Mechanism& mechanism, const Force& spring, double deflection) {
  return of_spring(mechanism, spring_law(spring), spring.force, spring.stiffness, deflection);
}

double damping_force(const Mechanism& mechanism, const Force& spring, double rate) {
  const Formula* law = damper_law(spring);
  return law ? bound(mechanism, *law, damper_variable).value(rate) : spring.damping * rate;
}

} // namespace flyball
