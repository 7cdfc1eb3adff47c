#include "engine/mechanism/expression_functions.hpp"

#include <array>

namespace flyball {
namespace {

template <Dual (*function)(Dual)>
Dual of_one(Dual a, Dual) {
  return function(a);
}

constexpr std::array functions{
    ExpressionFunction{"sin", 1, DimensionRule::number, of_one<sin>},
    ExpressionFunction{"cos", 1, DimensionRule::number, of_one<cos>},
    ExpressionFunction{"tan", 1, DimensionRule::number, of_one<tan>},
    ExpressionFunction{"asin", 1, DimensionRule::number, of_one<asin>},
    ExpressionFunction{"acos", 1, DimensionRule::number, of_one<acos>},
    ExpressionFunction{"atan", 1, DimensionRule::number, of_one<atan>},
    ExpressionFunction{"atan2", 2, DimensionRule::ratio, atan2},
    ExpressionFunction{"sinh", 1, DimensionRule::number, of_one<sinh>},
    ExpressionFunction{"cosh", 1, DimensionRule::number, of_one<cosh>},
    ExpressionFunction{"tanh", 1, DimensionRule::number, of_one<tanh>},
    ExpressionFunction{"exp", 1, DimensionRule::number, of_one<exp>},
    ExpressionFunction{"log", 1, DimensionRule::number, of_one<log>},
    ExpressionFunction{"log10", 1, DimensionRule::number, of_one<log10>},
    ExpressionFunction{"sqrt", 1, DimensionRule::root, of_one<sqrt>},
    ExpressionFunction{"abs", 1, DimensionRule::same, of_one<abs>},
    ExpressionFunction{"min", 2, DimensionRule::same, min},
    ExpressionFunction{"max", 2, DimensionRule::same, max},
    ExpressionFunction{"hypot", 2, DimensionRule::same, hypot},
};

} // namespace

std::span<const ExpressionFunction> expression_functions() {
  return functions;
}

} // namespace flyball
