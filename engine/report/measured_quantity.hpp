// The quantities that measures ask of results, as far as positions and motions tell them. N: double, or Dual
// for the numbers with their rates.
#pragma once

#include "engine/mechanism/measure_plan.hpp"
#include "engine/report/clearance.hpp"

namespace flyball {

// The numbers of the mechanism that a quantity rests on.
template <class N>
struct BasicQuantityNumbers {
  std::array<BasicTrackedPoint<N>, 3> points;
  N stiffness = 0, free = 0;                        // of a coordinate's spring
  BoundLaw law{};                                   // in place of its stiffness
  std::optional<N> lower, upper;                    // of a coordinate's stops
  N mass = 0;                                       // kg
  std::array<std::vector<BasicSolid<N>>, 2> solids; // of the two bodies of a clearance

  // Of the coordinate's spring, along it, and to the nearer of its stops.
  N spring(N q) const { return law ? -law.value(N(q - free)) : -stiffness * (q - free); }
  double spring_slope(double q) const {
    return law ? -law.slope(q - static_cast<double>(free)) : -static_cast<double>(stiffness);
  }
  N clearance(N q) const;
  double clearance_slope(double q) const; // 1 or -1
};
using QuantityNumbers = BasicQuantityNumbers<double>;

template <class N>
void take_numbers(const ResultQuantity& quantity, const System& system, const BasicParameters<N>& parameters,
                  const Mechanism& mechanism, const NumberReader<N>& read, BasicQuantityNumbers<N>& out);

// Of what acts between two bodies: in System::springs or System::bearings, else -1.
struct ElasticPlace {
  int spring = -1, bearing = -1;
};

// A position, velocity or acceleration, a distance or angle, mass, what a spring or bearing exerts. Throws
// nothing; not finite where it is undefined.
template <class N>
N quantity_value(const ResultQuantity& quantity, const BasicQuantityNumbers<N>& numbers,
                 const ElasticPlace& elastic, const System& system, const BasicParameters<N>& parameters,
                 const Kinematics<N>& kinematics);

bool is_clearance_of_bodies(const ResultQuantity& quantity);

} // namespace flyball
