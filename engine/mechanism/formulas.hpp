// Numbers that are given by expressions, and what they are given by.
//
// How geometry hangs together: all numbers of a mechanism are in world coordinates of the drawn pose, and a
// part is moved by its numbers alone. What shall move together refers to the same named point or parameter,
// so that moving the point moves all that stands there. A new value draws the mechanism in another pose; its
// coordinates are measured from that pose as ever, q = the label of the drawn pose + the displacement, so a
// state of one value is taken to the next by its coordinates.
#pragma once

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

struct Number; // numbers.hpp

// Sets every number that an expression gives, dependent parameters and points first, and what follows from
// densities. Throws SceneError that names the place: an expression that cannot be read, an unknown name, a
// dimension that does not fit, a circle of parameters, a value that is not finite. What was set before stays
// set then. Nothing is done for a mechanism without expressions and densities.
void evaluate_formulas(Mechanism& mechanism);

// The expression that gives the number at an address, without its "="; nothing for a number by itself.
std::optional<std::string> formula_at(const Mechanism& mechanism, std::string_view address);

// A number that has an address, or one of a shape ("bodies.arm.shapes.0.radius") or rotation
// ("bodies.arm.rotation.0"), which only expressions may give; valid as long as its part. Throws SceneError
// where there is none.
Number expressible_number(Mechanism& mechanism, std::string_view address);

// Where such a number keeps its expression; null where there is no such part.
struct FormulaPlace {
  Formulas* formulas = nullptr;
  std::string_view key; // a part of the address
};
FormulaPlace formula_place(Mechanism& mechanism, std::string_view address);

// Every number that is given by an expression, as it stands.
struct GivenNumber {
  std::string part; // "bodies.arm", "bodies.arm.shapes.0", "parameters.L", "points.A"; empty: the mechanism
  std::string address; // of the number
  std::string text;    // the expression
  double value = 0;
  std::string unit;
};
std::vector<GivenNumber> given_numbers(const Mechanism& mechanism);

// Drops the expressions of numbers that are no longer there, as after a joint has become one of another type.
void drop_lost_formulas(Mechanism& mechanism);

// Addresses of the numbers by themselves that an expression rests on, through dependent parameters and
// points: "parameters.L", "points.A.0".
std::vector<std::string> sources_of(const Mechanism& mechanism, std::string_view expression);

// How fast an expression's value changes with each of these numbers, which no expression gives; by
// forward-mode differentiation, through dependent parameters and points. Throws SceneError as
// evaluate_formulas does.
std::vector<double> expression_gradient(const Mechanism& mechanism, std::string_view expression,
                                        const std::vector<std::string>& sources);

// The value of an expression, in SI units, whose unit shall be `unit`. Throws SceneError at `where`.
double evaluate_expression(const Mechanism& mechanism, std::string_view expression, std::string_view unit,
                           const std::string& where);

// What an expression calls coordinate 0, 1 or 2 of a named point: "A.x".
std::string point_coordinate(std::string_view point, int i);

int parameter_index(const Mechanism& mechanism, std::string_view name); // -1: none
int point_index(const Mechanism& mechanism, std::string_view name);

// The place of something that only the second version of the format has, or empty.
std::string used_of_version_2(const Mechanism& mechanism);

} // namespace flyball
