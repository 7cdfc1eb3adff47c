// The functions that expressions know.
#pragma once

#include "engine/mechanism/dual.hpp"

#include <span>
#include <string_view>

namespace flyball {

// How a function treats dimensions.
enum class DimensionRule {
  number, // of a number, a number
  same,   // of one or two of the same dimension, that dimension
  root,   // half the exponents
  ratio,  // of two of the same dimension, a number
};

struct ExpressionFunction {
  std::string_view name;
  int arguments;
  DimensionRule rule;
  Dual (*evaluate)(Dual a, Dual b);
};

std::span<const ExpressionFunction> expression_functions();

} // namespace flyball
