// Forces of springs and dampers as expressions: of a spring by its `deflection`, "=table(deflection, [0 mm,
// 0 N], [5 mm, 40 N], [9 mm, 200 N])", of a damper by its `rate`, "=40 N*tanh(rate/(0.1 m/s))"; and of vanes
// the coefficients of lift and drag by the `incidence`. Beside these they know parameters and coordinates of
// points. They have no value by themselves, but one at every state.
//
// The deflection is the coordinate less `free`, or the length less the free length (m or rad); the rate that
// of the coordinate or length. Both forces are counted against them, as stiffness times deflection is. The
// incidence is the angle from the chord to the flow, towards the normal, -pi to pi (see air_force.hpp).
#pragma once

#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

inline constexpr std::string_view spring_variable = "deflection", damper_variable = "rate",
                                  air_variable = "incidence";

// Whether an expression of a joint or force is such a law.
bool is_force_law(const Formula& formula);

// The law of a joint's coordinate `i`, or of a spring between points; null where a number or nothing does.
const Formula* spring_law(const Joint& joint, int i);
const Formula* damper_law(const Joint& joint, int i);
const Formula* spring_law(const Force& force);
const Formula* damper_law(const Force& force);
// The coefficients of a vane.
const Formula* lift_law(const Force& vane);
const Formula* drag_law(const Force& vane);

// A law as it is read, a function of one variable with numbers by name.
class ForceLaw {
 public:
  // Throws ExpressionError.
  ForceLaw(std::string_view text, std::string_view variable);

  const Expression& expression() const { return expression_; }
  // Which of the expression's names are numbers, in order.
  const std::vector<std::string>& names() const { return names_; }
  // `numbers`: by names(). No allocation. Not finite where it is undefined.
  Dual operator()(std::span<const Dual> numbers, Dual x) const;

 private:
  static constexpr std::size_t most_names = 32;
  Expression expression_;
  std::vector<std::string> names_;
  std::size_t variable_; // among the expression's names; their number where it is not mentioned
};

// Throws SceneError at `where`, naming what is wrong: a name that is unknown, a dimension that does not fit;
// of a damper a force at rest, where it would be no damper's, and an infinite slope there; of a vane's
// coefficient one that is not finite at some incidence, or another where the flow comes from behind on either
// side of the chord, and a drag below zero (looked at every few degrees).
void check_spring_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where);
void check_damper_law(const Mechanism& mechanism, const Formula& law, bool angle, const std::string& where);
void check_lift_law(const Mechanism& mechanism, const Formula& law, const std::string& where);
void check_drag_law(const Mechanism& mechanism, const Formula& law, const std::string& where);

} // namespace flyball
