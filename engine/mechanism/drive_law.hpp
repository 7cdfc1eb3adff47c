// Torques and loads of drives as expressions of the state: "7500 N * (0.15 m - coordinate(slide))". Of what
// measures may ask they know what follows from where parts are and how they move alone: coordinate(joint), in
// rad or m as the joint labels it, rate(joint), places and velocities of points, distances, angles between
// three points, lengths of springs and what springs and bearings exert; and the measures that are made of
// these and of parameters, by name. Their derivatives enter the balance. They have no value by themselves,
// but one at every state. Nothing that they ask for may change as the drives turn (law_phase.hpp).
#pragma once

#include "engine/mechanism/measure_plan.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// Whether an expression asks for results, or names a measure; and is of a drive.
bool is_of_state(const Mechanism& mechanism, std::string_view expression);
bool is_drive_law(const Mechanism& mechanism, const Formula& formula);

// The expression of the state for "torque" or "load" of a joint's coordinate `i`; null where a number does.
const Formula* drive_law(const Mechanism& mechanism, const Joint& joint, int i, std::string_view which);

// A law with the expressions of the measures that it names in their places. Throws ExpressionError where it
// cannot be read, and for measures that go in a circle or ask for other results than a law may.
std::string with_measures(const Mechanism& mechanism, std::string_view text);
// A law as it is read, its measures in their places. Throws ExpressionError.
Expression read_drive_law(const Mechanism& mechanism, std::string_view text);

// What a law asks for. Throws ExpressionError where there is no such part, and where no law may ask for it.
ResultQuantity find_law_quantity(const Mechanism& mechanism, const ResultCall& call);
// Whether it is a coordinate, its rate or its spring, and which. Throws ExpressionError where there is none.
bool asks_for_coordinate(const ResultCall& call);
CoordinateReference find_coordinate(const Mechanism& mechanism, const ResultCall& call);

// Throws SceneError at `where`, naming what is wrong: a name that is unknown or a dimension that does not
// fit.
void check_drive_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where);

// The number that is a parameter's value or a point's coordinate: "L", "A.x". Throws ExpressionError where
// there is none.
const double& named_number(const Mechanism& mechanism, std::string_view name);
// Of several, in this order, read as the reader does. Throws as that.
template <class N>
void read_named(const Mechanism& mechanism, const std::vector<std::string>& names,
                const NumberReader<N>& read, std::vector<Dual>& out) {
  out.clear();
  for (const std::string& name : names)
    out.push_back(read(named_number(mechanism, name)));
}

} // namespace flyball
