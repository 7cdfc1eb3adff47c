// Expressions, as they stand where a number could: "L*cos(a) + 20 mm".
//
// Numbers with or without units, names, + - * / ^ (to the right first), parentheses, pi, and functions of the
// usual names (see the README of this folder). Values are in SI units and radians. Dimensions are checked;
// a number without unit counts as whatever it is added to, compared with or assigned to.
#pragma once

#include "engine/mechanism/dual.hpp"
#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/unit.hpp"
#include "engine/mechanism/value_table.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// What is wrong with an expression, in one sentence.
class ExpressionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Of a value: its dimension, or that it is a plain number, which fits any.
struct ValueDimension {
  Dimension dimension;
  bool plain = false;
};

// What a measure asks of results: "distance(ball1@A, collar)".
struct ResultCall {
  struct Argument {
    std::string name;  // of a body, joint or force, without quotes
    std::string point; // of "ball@A" A, else empty
    int index = -1;    // of "ball.1" 1
    // Where the name stands in the text, with its quotes, and the point.
    std::size_t begin = 0, length = 0, point_begin = 0;
  };
  Result result{};
  std::vector<Argument> arguments;
  std::size_t begin = 0;
};

class Expression {
 public:
  // Whether results may be asked for: of measures alone.
  enum class Results { refused, allowed };

  // Throws ExpressionError that names the column.
  explicit Expression(std::string_view text, Results results = Results::refused);

  // A place in the text where a name stands.
  struct Mention {
    std::size_t name = 0;  // among names()
    std::size_t begin = 0; // of the name's first byte; a point's coordinate "A.x" is mentioned as "A"
  };

  // Each once, as they first appear: "L", "A.x".
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<Mention>& mentions() const { return mentions_; }
  // As they appear, each time.
  const std::vector<ResultCall>& results() const { return results_; }

  // The value of name i is values[places[i]], by default values[i]; that of result i
  // results[result_places[i]]. No allocation. Not finite where it is undefined.
  Dual evaluate(std::span<const Dual> values, std::span<const std::size_t> places = {},
                std::span<const Dual> results = {}, std::span<const std::size_t> result_places = {}) const;
  // Throws ExpressionError where dimensions do not fit.
  ValueDimension dimension(std::span<const ValueDimension> names,
                           std::span<const ValueDimension> results = {}) const;

 private:
  friend class ExpressionParser;
  enum class Operation : std::uint8_t {
    number,
    name,
    result,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    call,
    table
  };
  // One of a stack machine's: operands are taken from the stack, the result is put there.
  struct Step {
    Operation operation = Operation::number;
    std::uint16_t index = 0;    // of the name, result, function or table
    double value = 0;           // of the number, in SI units
    ValueDimension dimension{}; // of the number
  };
  static constexpr std::size_t most_values = 64; // on the stack at a time

  struct Table {
    ValueTable values;
    ValueDimension of, dimension; // of what it is looked up by; of what stands there
  };

  std::vector<Step> steps_;
  std::vector<Table> tables_;
  std::vector<std::string> names_;
  std::vector<Mention> mentions_;
  std::vector<ResultCall> results_;
};

// Whether a parameter or point may be called so: a letter or _, then letters, figures and _; no function's
// name and not pi.
bool is_expression_name(std::string_view name);

// The text with another name for a parameter, point or measure; the text as it is where it is no expression.
std::string renamed_in(std::string_view text, std::string_view from, std::string_view to);

// The same for a part that results are asked of.
enum class ResultPart { body, joint, force };
std::string part_renamed_in(std::string_view text, ResultPart part, std::string_view from,
                            std::string_view to);
// For many at once: `renamed` tells what each is called from now on.
std::string parts_renamed_in(std::string_view text, ResultPart part,
                             const std::function<std::string(const std::string&)>& renamed);
ResultPart part_of(ArgumentKind kind);

} // namespace flyball
