// Mass and inertia of solids of uniform density.
#pragma once

#include "engine/mechanism/number_rates.hpp"

#include <optional>

namespace flyball {

struct MassProperties {
  double mass = 0;             // kg
  Vec3 centre = Vec3::Zero();  // m, world
  Mat3 inertia = Mat3::Zero(); // kg m^2, world axes, about `centre`
};

// A shape along a line, which stands between two points.
inline bool is_rod(ShapeType type) {
  return type == ShapeType::cylinder || type == ShapeType::capsule;
}

// Volume of a shape (m^3). A body's shapes are added up, overlaps counted twice.
double volume(const Shape& shape);
// Of the body's shapes; nothing for a body without shapes (its form is then only a drawing of its joints) or
// with none that has a volume.
std::optional<MassProperties> mass_properties(const Body& body, double density);
// Mass, mass centre and inertia (in body axes) of its shapes, which stay where they are; false, and nothing
// changed, where there is nothing to take. The mass is told in 15 digits.
bool take_mass_properties(Body& body, double density);
// How fast they change with the numbers of a body with a density, whose mass centre they are at already.
void take_mass_rates(const Body& body, NumberRates& rates);
// The same of shapes of whatever density gives the body this mass, which it then has to the last digit.
bool take_uniform_mass(Body& body, double mass);
// kg/m^3: the mass by the volume of its shapes; nothing without a volume.
std::optional<double> density_of(const Body& body);

} // namespace flyball
